"""Three samples of fifty lengths; one of them is asked about."""


def draw(rng):
    samples = {n: rng.normal(rng.uniform(40, 60), rng.uniform(2, 6), 50) for n in "xyz"}
    return samples | {"k": int(rng.integers(0, 3))}
