"""Two binary numbers, their sum, and what comes out where carries are lost."""


def draw(rng):
    a, b = (int(rng.integers(33, 64)) for _ in range(2))
    lost, longest = a ^ b, a | b
    if len({a + b, lost, longest}) < 3:
        return None
    return {
        name: f"{n:b}" for name, n in {"a": a, "b": b, "s": a + b, "w": lost, "o": longest}.items()
    }
