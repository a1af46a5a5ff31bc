"""Two numbers, as they are written in binary, and what comes out where carries are lost."""


def draw(rng):
    a, b = (int(rng.integers(33, 64)) for _ in range(2))
    lost, longest = a ^ b, a | b
    if len({a + b, lost, longest}) < 3:
        return None
    return {"a": a, "b": b, "w": lost, "o": longest, "p": f"{a:b}", "q": f"{b:b}"}
