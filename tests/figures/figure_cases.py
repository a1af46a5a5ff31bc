"""What the figure tests share: the figures of the built-in bank, reference instances of them, and
the ends of the draw ranges."""

from __future__ import annotations

import random

from quizgen import figures
from quizgen.bank.bank import builtin_bank
from quizgen.bank.solvers import import_module_file

FIGURES = builtin_bank().figures
FOLDER = builtin_bank().folder / "figures"


def module(name):
    """What draws a figure, or what these share."""
    return import_module_file(FOLDER, name) if name.startswith("_") else builtin_bank().figure(name)


def draw(name, values, *, quiz=False, lang="en", marks=None):
    """A figure by its name."""
    return figures.draw_figure(module(name), values, quiz=quiz, lang=lang, marks=marks)


MOSAIC = {
    "v00": 60,
    "v01": 100,
    "v02": 64,
    "v10": 120,
    "v12": 110,
    "v20": 70,
    "v21": 130,
    "v22": 66,
}

REFERENCE = {
    "pinhole": {"f": 2, "p_z": 3, "p_y": 5},
    "distorted_grid": {"k1": -0.1},
    "hsv_edits": {"a": 0.4, "b": 0.2, "delta": 120, "order": 9},
    "focus_photos": {"order": 9},
    "gaussian": {"sigma": 2, "k": 2},
    "thin_lens": {"f": 50, "z": 200},
    "bayer": MOSAIC,
    "blur_curve": {"f": 50, "s": 3, "N_1": 8, "N_2": 2, "c": 30, "high": 300},
    "blur_disc": {"D": 25, "z_p": 60, "z_s": 61},
    "artefacts": {"kind": 2},
    "depth_of_field": {"N_1": 16, "N_2": 1.8, "order": 1},
    "luminosity": {"m_1": 530, "m_2": 650},
    "noise": {"sigma": 0.04, "p": 0.09, "order": 4},
    "normalisation": {"low": 60, "high": 140},
    "fall_off": {"f": 20, "r": 15},
    "staircase": {"n": 8},
    "grey_edits": {"n": 8, "low": 70, "high": 180, "s": 60, "order": 9},
    "field_of_view": {"W": 36, "H": 24, "f": 50, "Z": 10},
    "rolling_shutter_skew": {"v": 500, "t_r": 20, "n": 1000},
    "pixel_grid": {"W": 640, "H": 480, "o_x": 310, "o_y": 250, "u": 430, "v": 170},
    "vanishing_point": {
        "f": 500, "W": 640, "H": 480, "o_x": 320, "o_y": 240, "a": (-2, 2, 4), "d": (1, 2, 4),
    },
    "ccd_streak": {"F": 20000, "Q": 200000, "b": 2000, "h": 3, "t": 10, "t_r": 5},
    "reflectance_spectra": {
        "L_r": 0.8, "L_g": 0.5, "L_b": 1, "R_r": 0.9, "R_g": 0.3, "R_b": 0.6,
    },
    "gaussian_contours": {"covariances": ((4, 0, 9),), "x": 1, "y": 2},
    "lamp_and_surface": {
        "L_400": 0.1, "L_500": 0.3, "L_600": 0.7, "L_700": 1, "R_400": 0.8, "R_500": 0.2, "R_600": 0.4, "R_700": 0.9,
    },
    "photon_transfer": {"v_0": 49, "mu_s": 600, "v_s": 289, "top": 400},
    "plate_camera": {"L": 3.5, "v": 10, "w": 100},
    "book_scanner": {"room": 600, "c": 10},
    "imaging_pipeline": {},
    "bayer_counts": {"W": 5, "H": 5},
    "formula_sketch": {"formula": 5},
}  # fmt: skip

HIDDEN = {
    # what a question asks for, as the normal figure prints it: 5 * 2/3, curriculum C13, D17a, S14
    "pinhole": ["3.333"],
    "distorted_grid": ["−0.1", "barrel"],
    "hsv_edits": ["0.4", "0.2", "120"],
    "focus_photos": ["22", "f/2"],
    "gaussian": ["0.1995", "4.55"],
    "thin_lens": ["66.67"],
    "bayer": ["115", "65"],
    "blur_curve": ["2.338", "4.185"],  # X-C01
    "blur_disc": ["0.4167"],
    "artefacts": ["t_0"],
    "depth_of_field": ["16", "1.8"],
    "luminosity": ["0.862", "0.107"],
    "noise": ["0.04", "0.09"],
    "normalisation": ["140"],
    "fall_off": ["0.4096"],
    "staircase": ["0.1429"],
    "grey_edits": ["≤", "…"],
    "field_of_view": ["39.6", "46.79", "7.2"],  # tan(α/2) = 36/100, 10·36/50
    "rolling_shutter_skew": ["10 px", "0.5729"],
    "pixel_grid": ["430", "170", "120"],
    "vanishing_point": ["445", "490"],  # 320 + 500/4, 240 + 500·2/4
    "ccd_streak": ["30", "300"],
    "reflectance_spectra": ["0.72", "0.15"],
    "gaussian_contours": ["0.6944", "0.01874"],
    "imaging_pipeline": ["demosaicing", "gamma"],
    "bayer_counts": ["12", "9"],
    "formula_sketch": [],
    "lamp_and_surface": ["third"],
    "photon_transfer": ["line through"],
    "plate_camera": [],
    "book_scanner": [],
}


def _pinhole(rng: random.Random):
    f = rng.randint(2, 6)
    depth = rng.choice([z for z in range(2, 13) if z != f])
    height = rng.choice([-1, 1]) * rng.randint(1, 15)
    sides = {"physical": rng.randint(0, 1), "y_down": rng.randint(0, 1)}
    yield {"f": f, "p_z": depth, "p_y": height, **sides}
    yield {
        "f": rng.choice([12, 35, 50, 200]),
        "p_z": rng.choice([20, 75, 2000]),
        "p_y": rng.choice([2, 12.5, 150]),
        "metric": 1,
        **sides,
    }
    yield {
        "f": rng.choice([3, 6, 200]),
        "p_z": rng.choice([1.5, 10]),
        "p_y": rng.choice([-2, -0.1, 0.3]),
        "metric": 1,
        **sides,
    }


def _bayer(rng: random.Random):
    size = rng.choice([3, 4, 5, 6, 8])
    x, y = rng.randrange(size), rng.randrange(size)
    values = {f"v{b}{a}": rng.randint(20, 235) for a in range(size) for b in range(size)}
    yield {"size": size, "phase": rng.randrange(4), "x": x, "y": y, **values}


def camera_draws():
    """Values of the figures that the camera simulator takes, all over their ranges."""
    for kind, way in (*zip(range(12), [0] * 12, strict=True), (2, 1), (2, 2), (2, 3), (2, 4)):
        yield "artefacts", {"kind": kind, "variant": kind % 4, "way": way}
    for first, second in ((380, 780), (480, 488), (507, 555), (555, 560), (700, 400), (604, 458)):
        for log in (0, 1):
            yield "luminosity", {"m_1": first, "m_2": second, "log": log, "night": log}
    yield "luminosity", {}
    for order in range(6):
        yield "noise", {"order": order, "sigma": 0.02 + 0.05 * order, "p": 0.05, "seed": order}
    for low, high in ((0, 255), (60, 180), (80, 180), (60, 150), (90, 150), (-255, 510)):
        yield "normalisation", {"low": low, "high": high, "share": 0.01 * (low == 80)}
    for order in range(24):
        yield "grey_edits", {"n": 4, "low": 40, "high": 200, "s": 90, "order": order}
    for n in (2, 4, 8, 16):
        for rule in range(4):
            yield "staircase", {"n": n, "rule": rule}
    for f, s, z in ((50, 2, (1.2, 2, 6)), (85, 3, (1.5, 3, 12)), (35, 10, (2.5, 10, 400))):
        near, middle, far = z
        depths = {"z_1": near, "z_2": middle, "z_3": far}
        yield "depth_of_field", {"f": f, "s": s, "N_1": 2.8, "N_2": 22, **depths}


def curve_draws():
    """Plots of the blur disc: one and two curves, limits on the axis, beyond it and at infinity."""
    for f, s, number in ((35, 2, 1.4), (50, 3, 8), (100, 6, 16), (40, 2.5, 22)):
        for c, high in ((20, 100), (60, 150), (80, 200)):
            yield (
                "blur_curve",
                {"f": f, "s": s, "N_1": number, "N_2": number / 2, "c": c, "high": high},
            )
        yield "blur_curve", {"f": f, "s": s, "N_1": number, "far": 20, "high": 1000}
    for order, (f, z_1, z_2, z_3) in enumerate(
        ((50, 1, 1.5, 3), (100, 2, 4, 15), (70, 1.2, 2.4, 7.2))
    ):
        yield (
            "focus_photos",
            {"f": f, "z_1": z_1, "z_2": z_2, "z_3": z_3, "order": 7 * order, "N_w": 2.8},
        )


def textbook_draws(rng: random.Random):
    """Figures of projection, sensor and noise that a textbook has, all over their ranges."""
    for _ in range(12):
        f, width = rng.choice([4, 12, 50, 200]), rng.choice([(36, 24), (8.8, 6.6), (24, 16)])
        yield "field_of_view", {"W": width[0], "H": width[1], "f": f, "Z": rng.randint(2, 20)}
        speed, rows = rng.choice([400, 2500, 8000]), rng.choice([300, 1000, 2000])
        yield "rolling_shutter_skew", {"v": speed, "t_r": rng.choice([10, 30]), "n": rows}
        plane = {"W": 640, "H": 480, "o_x": 310, "o_y": 250}
        pixel = {"u": rng.randrange(-320, 960, 10), "v": rng.randrange(-240, 720, 10)}
        yield "pixel_grid", plane | pixel | {"given": rng.randint(0, 1)}
        ways = {"a": (rng.randint(-4, 4), 2, rng.choice([2, 8])),
                "d": (rng.choice([-3, 1, 2]), rng.choice([-2, 1]), rng.choice([2, 10]))}  # fmt: skip
        yield "vanishing_point", plane | {"f": rng.choice([400, 1000])} | ways
        lamp = {"Q": rng.randrange(60000, 400000, 10000), "h": rng.randint(2, 9)}
        yield (
            "ccd_streak",
            {"F": 10000, "b": rng.randrange(1000, 6000, 500), "t": 5, "t_r": 10} | lamp,
        )
        yield (
            "reflectance_spectra",
            {f"{letter}_{band}": rng.randint(0, 10) / 10 for letter in "LR" for band in "rgb"},
        )
        row = (rng.randint(1, 5) ** 2, 0, rng.randint(1, 5) ** 2)
        yield "gaussian_contours", {"covariances": (row,), "x": rng.randint(1, 6), "y": 3}
        sensor = {"W": rng.randint(3, 12), "H": rng.randint(3, 12), "phase": rng.randrange(4)}
        yield "bayer_counts", sensor
        heights = {
            f"{letter}_{place}": rng.randint(0, 10) / 10
            for letter in "LR"
            for place in (400, 500, 600, 700)
        }
        yield "lamp_and_surface", heights
        low, full = rng.randint(16, 64), rng.choice([400, 600, 800])
        yield "photon_transfer", {"v_0": low, "mu_s": full, "v_s": low + full / 4, "top": 300}
    for one in range(2):
        yield "plate_camera", {"L": 3 + one / 2, "v": 8 + 2 * one, "w": 90 + 10 * one}
        yield "book_scanner", {"room": 600 + 50 * one, "c": 8 + 2 * one}
    yield "gaussian_contours", {}
    for step in range(11):
        yield "imaging_pipeline", {"left_out": step}
    for numbers, _ in module("formula_sketch").SKETCHES.values():
        yield "formula_sketch", {"formula": numbers[0]}


def hue_draws():
    """Edits of a picture's hues, in other orders and scenes."""
    for order in range(0, 24, 2):
        edits = {"a": 0.3 + 0.02 * order, "b": 0.1 + 0.03 * order, "delta": 30 + 12 * order}
        yield "hsv_edits", {**edits, "order": order, "scene": order % 8}


def draws():  # noqa: C901 - one loop a figure
    """Figure names and values all over the ranges of the curriculum (A3, C11-C14, D17a, S11, S14)."""
    rng = random.Random(20)
    yield from camera_draws()
    yield from curve_draws()
    yield from textbook_draws(rng)
    yield from hue_draws()
    for _ in range(25):
        yield from (("pinhole", values) for values in _pinhole(rng))
    for _ in range(12):
        yield from (("bayer", values) for values in _bayer(rng))
    for ratio in (5 / 4, 4 / 3, 3 / 2, 5 / 2, 3, 4, 5, 6, 11, 21, 41, 0.2, 0.5, 0.75, 0.9, 1):
        for f in (20, 135, 200):
            yield "thin_lens", {"f": f, "z": round(f * ratio, 3)}
    for sigma in (0.05, 0.25, 1.5, 2, 5, 8):
        for k in (0, 1, 1.5, 2, 3):
            for tails in (-1, 0, 1, 2):
                yield (
                    "gaussian",
                    {"sigma": sigma, "k": k, "tails": tails, "mu": rng.choice([0, 128, -3])},
                )
    yield "gaussian", {"sigma": 0.5, "sigma2": 1, "sigma3": 2}
    yield "fall_off", {"f": 12, "r": 8}
    yield "fall_off", {"f": 36, "r": 21, "rim": 0.8}
    for diameter in (3.125, 25):
        for sharp in (50, 60):
            for shift in (-2, -0.1, 0, 0.1, 2, 15, 40):
                yield "blur_disc", {"D": diameter, "z_p": sharp, "z_s": sharp + shift}
    for k1 in (-0.3, -0.15, -0.05, 0, 0.05, 0.3):
        for k2 in (0, 0.05):
            yield "distorted_grid", {"k1": k1, "k2": k2, "c_x": rng.choice([0, 0.2]), "c_y": 0.1}
