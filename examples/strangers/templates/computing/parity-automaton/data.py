"""Five words over two letters; some are accepted."""


def draw(rng):
    sizes = rng.integers(4, 8, 5)
    words = ["".join(rng.choice(["a", "b"], size)) for size in sizes]
    states = [2 * (word.count("a") % 2) + word.count("b") % 2 for word in words]
    goal = int(rng.integers(0, 4))
    if len(set(words)) < 5 or not 1 <= states.count(goal) <= 4:
        return None
    return {"goal": goal, "state": states} | dict(zip("uvwyz", words, strict=True))
