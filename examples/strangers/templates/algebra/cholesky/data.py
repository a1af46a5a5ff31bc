"""A Cholesky factor with a positive diagonal, and numbers to compare its entries with."""


def draw(rng):
    x = rng.integers(-4, 5, 10)
    x[[0, 4, 7, 9]] = rng.integers(1, 6, 4)
    bounds = x[[0, 1, 5, 7]] + rng.choice([-1, 0, 0, 1], 4)
    if bounds[2] <= x[5] and x[1] != bounds[1] and x[0] != bounds[0]:
        return None
    return {"n": int(rng.integers(3, 5)), "x": x, "b": bounds}
