"""Pictures and sensors where counts are few: even, dim, starved, tall and wide ones."""

import numpy as np

from quizgen.camera import Camera, Scene

SHAPES = ((24, 40), (2, 600), (600, 2), (40, 24), (3, 3))


def _levels(source, height, width):
    kind = source.integers(4)
    level = 10 ** source.uniform(-4, 0)
    if kind == 0:
        return np.full((height, width, 3), level)
    if kind == 1:
        return level * np.broadcast_to(source.random(3), (height, width, 3))
    ramp = np.linspace(0, 1, height * width).reshape(height, width, 1)
    if kind == 2:
        return level * np.repeat(ramp, 3, axis=2)
    return np.where(source.random((height, width, 1)) < 0.1, 1.0, level) * np.ones(3)


def scene(source):
    height, width = SHAPES[source.integers(len(SHAPES))]
    image = _levels(source, height, width).astype(np.float32)
    return Scene(width, height, image=image, seed=int(source.integers(1 << 40)))


def camera(source):
    def maybe(chance, value, otherwise):
        return value() if source.random() < chance else otherwise

    def between(low, high):
        return float(10 ** source.uniform(low, high))

    return Camera(
        0.05, 0.05 / source.uniform(20, 200),
        natural_vignetting=bool(source.random() < 0.2),
        mechanical_vignetting=maybe(0.2, lambda: float(source.uniform(0, 0.6)), 0.0),
        flat_field=bool(source.random() < 0.5),
        exposure=maybe(0.3, lambda: float(source.uniform(-2, 2)), 0.0),
        full_well=max(1.0, between(0, 5)),
        shot_noise=bool(source.random() < 0.85),
        shutter=1.0,
        dark_current=maybe(0.3, lambda: between(-2, 3), 0.0),
        read_noise=maybe(0.5, lambda: between(-1.5, 1.5), 0.0),
        blooming=bool(source.random() < 0.15),
        smear=maybe(0.3, lambda: between(-3, 0), 0.0),
        bit_depth=maybe(0.4, lambda: int(source.integers(1, 15)), None),
        mosaic=maybe(0.2, lambda: "RGGB", ""),
        white_balance=maybe(0.5, lambda: tuple(source.uniform(0.3, 3, 3)), (1.0, 1.0, 1.0)),
        gamma=maybe(0.4, lambda: "srgb", "linear"),
        hue=maybe(0.1, lambda: float(source.uniform(0, 6)), 0.0),
        saturation=maybe(0.1, lambda: float(source.uniform(0, 2)), 1.0),
        gaussian_noise=maybe(0.2, lambda: between(-4, -0.5), 0.0),
        normalise=maybe(0.1, lambda: (0.1, 0.9, 0.0, 1.0), None),
        iso=maybe(0.2, lambda: 100.0 * between(-0.5, 1.2), 100.0),
        fixed_pattern=maybe(0.2, lambda: between(-1.5, 1.5), 0.0),
        bias=maybe(0.2, lambda: between(-1, 2), 0.0),
        dark_frames=maybe(0.2, lambda: int(source.integers(1, 30)), 0),
        binning=maybe(0.15, lambda: int(source.integers(2, 5)), 1),
        light=maybe(0.15, lambda: float(source.uniform(2000, 12000)), None),
        infrared_filter=bool(source.random() < 0.7),
    )  # fmt: skip
