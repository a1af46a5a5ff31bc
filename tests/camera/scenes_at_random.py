"""Random small scenes and cameras, from nearly ideal to strongly flawed."""

import math

import numpy as np

from quizgen.camera import Camera, Length, Scene, SceneObject


def _texture(source, height, width):
    kind = source.integers(5)
    rows, columns = np.mgrid[0:height, 0:width]
    if kind == 0:
        return source.random((height, width, 3))
    if kind == 1:
        angle, period = source.uniform(0, math.pi), source.uniform(6, 80)
        wave = np.cos(2 * math.pi * (rows * math.sin(angle) + columns * math.cos(angle)) / period)
        return 0.5 + 0.5 * wave[..., None] * source.random(3)
    if kind == 2:
        return np.where(
            columns[..., None] < source.integers(1, width), source.random(3), source.random(3)
        )
    if kind == 3:
        return np.broadcast_to(source.random(3), (height, width, 3))
    image = np.zeros((height, width, 3))
    image[source.integers(height), source.integers(width)] = 1
    return image


def _picture(source, height, width):
    contrast = 10 ** source.uniform(-3.5, 0)
    floor = source.uniform(0, 1 - contrast)
    return (floor + contrast * _texture(source, height, width)).astype(np.float32)


def _depth(source, height, width):
    rows = np.mgrid[0:height, 0:width][0]
    depth = np.where(rows < height // 2, source.uniform(1, 5), source.uniform(2, 50))
    return (depth + source.uniform(0, 1) * rows / height).astype(np.float32)


def _thing(source, height, width):
    shape = source.choice(
        ["box", "disc", "ellipse", "grid", "blades", "polygon", "full"],
        p=[0.2, 0.2, 0.1, 0.1, 0.2, 0.1, 0.1],
    )
    moving = source.random() < 0.3
    return SceneObject(
        str(shape),
        Length(source.uniform(-width / 2, width / 2)),
        Length(source.uniform(-height / 2, height / 2)),
        Length(source.uniform(2, width)),
        Length(source.uniform(2, height)),
        Length(source.uniform(1, height / 2)),
        Length(source.uniform(3, 12)),
        Length(source.uniform(1, 4)),
        depth=source.uniform(0.5, 30),
        colour=tuple(source.random(3)),
        other=tuple(source.random(3)),
        texture=str(source.choice(["plain", "checker", "stripes", "ramp", "rings"])),
        angle=source.uniform(0, 3),
        velocity=(Length(moving * source.normal() * 200), Length(moving * source.normal() * 200)),
        spin=float(moving * source.normal() * 60 * (shape in ("blades", "box"))),
        count=int(source.integers(2, 5)),
        points=tuple((float(x), float(y)) for x, y in source.normal(0, height / 3, (4, 2))),
    )


def scene(source) -> Scene:
    height, width = (int(side) for side in source.integers(8, 34, 2))
    seed = int(source.integers(1 << 30))
    kind = source.integers(3)
    if kind == 0:
        image = _picture(source, height, width)
        return Scene(width, height, image=image, depth=float(source.uniform(0.5, 30)), seed=seed)
    if kind == 1:
        depth = _depth(source, height, width)
        return Scene(width, height, image=_picture(source, height, width), depth=depth, seed=seed)
    things = tuple(_thing(source, height, width) for _ in range(source.integers(1, 4)))
    background = tuple(source.random(3))
    return Scene(width, height, things, background, float(source.uniform(5, 60)), seed=seed)


def camera(source, *, noise: bool) -> Camera:
    def maybe(chance, value, otherwise):
        return value() if source.random() < chance else otherwise

    def small(low, high):
        return float(10 ** source.uniform(low, high))

    def signed(low, high):
        return float(small(low, high) * source.choice([-1, 1]))

    well = maybe(0.5 if not noise else 1.0, lambda: small(2.5, 5), None)
    pitch = 0.05 / source.uniform(12, 60)
    number = maybe(0.4, lambda: small(-1, 3) * 0.05 / pitch / 40, None)
    hole = maybe(0.1, lambda: small(-2, 0.5) * pitch, None) if number is None else None
    opening = hole if number is None else 0.05 / number
    shutter = maybe(0.5, lambda: small(-5, -1), 0.0)
    light = math.log2((0.05 / opening) ** 2 / shutter) if opening and shutter else None
    return Camera(
        focal_length=0.05,
        pixel_pitch=float(pitch),
        f_number=number,
        pinhole=hole,
        focus_distance=math.inf if hole else maybe(0.8, lambda: source.uniform(0.5, 30), math.inf),
        wavelength=maybe(0.3, lambda: min(1e-3, small(-2, 0.5) * pitch * opening / 0.05), None)
        if opening
        else None,
        flare=maybe(0.1, lambda: small(-5, 0), 0.0),
        light_value=maybe(0.3, lambda: light + signed(-3, 0.3), None)
        if light and -19 < light < 29
        else None,
        iso=maybe(0.2, lambda: 100.0 * 2 ** signed(-3, 0.6), 100.0),
        fixed_pattern=maybe(0.2, lambda: small(-2, 1.5), 0.0) if noise else 0.0,
        bias=maybe(0.2, lambda: small(-2, 2), 0.0) if well else 0.0,
        dark_frames=maybe(0.2, lambda: int(source.integers(1, 30)), 0) if noise else 0,
        binning=maybe(0.1, lambda: int(source.integers(2, 6)), 1),
        k1=maybe(0.3, lambda: signed(-6, -1), 0.0),
        k2=maybe(0.1, lambda: signed(-6, -2), 0.0),
        lateral_colour=maybe(0.2, lambda: signed(-5, 0.3), 0.0),
        natural_vignetting=bool(source.random() < 0.3),
        mechanical_vignetting=maybe(0.2, lambda: min(0.9, small(-4, 0)), 0.0),
        shutter=shutter,
        velocity=maybe(0.2, lambda: (signed(0, 2.5), signed(0, 2.5)), (0.0, 0.0)),
        row_time=maybe(0.3, lambda: small(-7, -3), 0.0),
        exposure=maybe(0.3, lambda: signed(-4, 0.5), 0.0),
        full_well=well,
        shot_noise=noise and bool(source.random() < 0.7),
        read_noise=maybe(0.5, lambda: small(-2, 1.5), 0.0) if noise else 0.0,
        dark_current=maybe(0.3, lambda: small(0, 4), 0.0) if noise else 0.0,
        blooming=well is not None and bool(source.random() < 0.2),
        smear=maybe(0.2, lambda: small(-5, -1), 0.0) if well else 0.0,
        bit_depth=maybe(0.4, lambda: int(source.integers(4, 17)), None),
        mosaic=maybe(0.2, lambda: str(source.choice(["RGGB", "BGGR", "GRBG", "GBRG"])), ""),
        flat_field=bool(source.random() < 0.2),
        white_balance=maybe(
            0.2, lambda: tuple(1 + source.normal(0, 0.1, 3).clip(-0.5, 0.5)), (1.0, 1.0, 1.0)
        ),
        gamma=maybe(0.3, lambda: source.choice(["srgb", "2.2"]), "linear").replace("2.2", "srgb"),
        hue=maybe(0.1, lambda: signed(-3, 0), 0.0),
        saturation=maybe(0.1, lambda: float(source.uniform(0, 2)), 1.0),
        value=maybe(0.1, lambda: float(source.uniform(0.5, 1.5)), 1.0),
        normalise=maybe(0.1, lambda: (0.1, 0.9, 0.0, 1.0), None),
        axial_colour=maybe(0.4, lambda: 0.05 * signed(-5, -1.5), 0.0) if number else 0.0,
        light=maybe(0.2, lambda: float(source.uniform(2000, 12000)), None),
        infrared_filter=bool(source.random() < 0.7),
    )
