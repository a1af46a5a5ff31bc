"""Figures that are photographs of the camera simulator: what their pixels and curves must show."""

from __future__ import annotations

import base64
import re
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from figure_cases import module, render

from quizgen.camera import pictures
from quizgen.figures._parameters import complete
from quizgen.png import encode

artefacts = module("artefacts")
bayer = module("bayer")
depth_of_field = module("depth_of_field")
focus_photos = module("focus_photos")
luminosity = module("luminosity")
noise = module("noise")
normalisation = module("normalisation")


def _decoded(data: bytes):
    """A PNG as RGB, read by OpenCV."""
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)[..., ::-1].astype(float)


def _pictures(name, values, *, quiz):
    svg = render(name, values, quiz=quiz, lang="en").svg.decode()
    found = re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", svg)
    return [_decoded(base64.b64decode(text)) for text in found]


@pytest.mark.parametrize("shape", [(5, 7), (1, 1), (5, 7, 3), (96, 144, 3)])
def test_png_is_read_back_by_opencv(shape):
    codes = np.random.Generator(np.random.SFC64(3)).integers(0, 256, shape, np.uint8)
    read = cv2.imdecode(np.frombuffer(encode(codes), np.uint8), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(read if codes.ndim == 2 else read[..., ::-1], codes)


def test_grey_pictures_are_stored_with_one_channel():
    codes = np.repeat(np.arange(20, dtype=np.uint8).reshape(4, 5, 1), 3, axis=2)
    read = cv2.imdecode(np.frombuffer(encode(codes), np.uint8), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(read, codes[..., 0])


@pytest.mark.parametrize("order", range(6))
def test_noise_stands_where_the_order_says(order):
    sigma, share = 0.05, 0.1
    shown = _pictures("noise", {"order": order, "sigma": sigma, "p": share}, quiz=True)
    whole = dict(zip(noise.noise_order(order), shown[1::2], strict=True))
    clean = whole["clean"]
    _, counts = np.unique(clean, return_counts=True)
    assert sorted(counts)[-4] > 0.02 * clean.size
    assert sum(sorted(counts)[-4:]) > 0.98 * clean.size  # the rest is the rim of the disc
    middle = (clean > 60) & (clean < 200)  # far from both ends: no clipping
    change = (whole["gaussian"] - clean)[middle]
    # 255 sigma, standard error of a standard deviation sigma/sqrt(2n), n about 4000
    assert change.std() == pytest.approx(255 * sigma, rel=0.06)
    assert abs(change.mean()) < 4 * 255 * sigma / 60
    hit = (whole["impulse"] != clean)[..., 0]
    assert set(np.unique(whole["impulse"][hit])) == {0, 255}
    assert hit.mean() == pytest.approx(share, abs=4 * np.sqrt(share / hit.size))


def test_blur_discs_are_those_of_the_curriculum():
    # X-C03: f = 50, N = 2, s = 2.05 m, z = 4.1 m gives 0.3125 mm
    values = {"f": 50, "N_1": 2, "N_2": 8, "s": 2.05, "z_1": 2.05, "z_2": 4.1, "z_3": 4.1}
    full = complete("depth_of_field", depth_of_field.PARAMETERS, values)
    assert depth_of_field.discs(full, 2) == pytest.approx((0, 0.3125, 0.3125))
    assert depth_of_field.discs(full, 8) == pytest.approx((0, 0.078125, 0.078125))


@pytest.mark.parametrize("order", [0, 1])
def test_the_wide_aperture_blurs_only_what_is_out_of_focus(order):
    small, wide = _pictures("depth_of_field", {"order": order}, quiz=True)[:: -1 if order else 1]
    edges = [np.diff(photo, axis=1).max(axis=2) ** 2 for photo in (small, wide)]
    left, middle, right = (slice(2, 46), slice(54, 90), slice(98, 142))
    for columns in (left, right):
        assert edges[1][20:76, columns].mean() < 0.8 * edges[0][20:76, columns].mean()
    assert np.array_equal(small[30:66, middle], wide[30:66, middle])


def test_the_object_in_focus_is_sharp_and_a_small_hole_sharpens_all():
    columns = [slice(1, 31), slice(36, 60), slice(65, 95)]
    values = complete("focus_photos", focus_photos.PARAMETERS, {})
    found = [
        (setting, [(np.diff(photo, axis=1).max(axis=2) ** 2)[13:51, c].mean() for c in columns])
        for order in (0, 9, 23)  # every setting at one place at least
        for setting, photo in zip(
            focus_photos.settings({**values, "order": order}),
            _pictures("focus_photos", {"order": order}, quiz=True),
            strict=True,
        )
    ]
    sharpest = np.max([edges for _, edges in found], axis=0)
    assert len({setting for setting, _ in found}) == 4
    for (s, number), edges in found:
        clear = np.array([s == values[name] for name in ("z_1", "z_2", "z_3")])
        assert ((edges > 0.6 * sharpest) == (clear | (number == values["N_s"]))).all()


def test_pictures_keep_their_brightness():
    small, wide = _pictures("depth_of_field", {}, quiz=True)
    assert small.mean() == pytest.approx(wide.mean(), rel=0.02)


@pytest.mark.parametrize(
    ("wavelength", "night", "value"),
    # CIE 1924 and 1951 tables
    [(530, False, 0.862), (655, False, 0.0816), (650, False, 0.107), (700, False, 0.004102), (507, True, 1.0),
     (650, True, 0.000677), (555, False, 1.0)],
)  # fmt: skip
def test_curves_are_read_at_the_tables_values(wavelength, night, value):
    assert luminosity.read(wavelength, night=night) == pytest.approx(value)


def test_clamping_gathers_what_lies_above():
    image = normalisation.sample(60.0, 180.0, 0.0, 1)
    levels = image * 255
    assert levels.min() == pytest.approx(60)
    assert levels.max() == pytest.approx(180)
    _, before, after = pictures.normalised(image, 60 / 255, 140 / 255, normalisation.BINS)
    assert before.sum() == after.sum() == image.size
    # the last bin holds what is clamped, and what fell into it anyway
    last = 60 + (140 - 60) * (normalisation.BINS - 1) / normalisation.BINS
    assert after[-1] == (levels >= last).sum()
    assert after[-1] > 5 * after[:-1].max()


def test_outliers_have_their_share():
    levels = normalisation.sample(100.0, 140.0, 0.1, 5) * 255
    outside = ((levels < 100) | (levels > 140)).mean()
    assert outside == pytest.approx(0.1 * (1 - 40 / 255), abs=4 * np.sqrt(0.1 / levels.size))


@pytest.mark.parametrize("kind", range(12))
@pytest.mark.parametrize("variant", range(4))
def test_every_artefact_is_seen(kind, variant):
    ideal, photo = _pictures("artefacts", {"kind": kind, "variant": variant}, quiz=True)
    changed = np.abs(photo - ideal).max(axis=2) > 12
    assert changed.mean() > (0.002 if artefacts.KINDS[kind] == "hot pixels" else 0.02)


def test_what_blooms_ends_inside_the_picture_and_a_streak_does_not():
    def rows(kind):
        ideal, photo = _pictures("artefacts", {"kind": kind}, quiz=True)
        return np.flatnonzero((np.abs(photo - ideal).max(axis=2) > 12).any(axis=1))

    blob, streak = rows(0), rows(1)
    assert 3 < blob.min() < blob.max() < 92
    assert blob.size > 20
    assert (streak.min(), streak.max()) == (0, 95)


def test_corners_fall_off_with_the_fourth_power_of_the_cosine():
    ideal, photo = _pictures("artefacts", {"kind": 3}, quiz=True)

    def linear(code):
        share = code / 255
        return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)

    tangent = np.hypot(71.5, 47.5) * 0.25 / 18  # pixels of 0.25 mm behind a lens of 18 mm
    fall_off = linear(photo[0, 0]) / linear(ideal[0, 0])
    assert fall_off == pytest.approx(1 / (1 + tangent**2) ** 2, rel=0.02)


# X-C15: cos^4 for tan = 3/4, 5/12, 8/15, 1
@pytest.mark.parametrize(
    ("f", "r", "light"), [(20, 15, 0.4096), (24, 10, 0.7260), (15, 8, 0.6061), (20, 20, 0.25)]
)
def test_the_wall_falls_with_the_fourth_power_of_the_cosine(f, r, light):
    (photo,) = _pictures("fall_off", {"f": f, "r": 0, "extent": r}, quiz=True)
    linear = ((photo[36, :, 0] / 255 + 0.055) / 1.055) ** 2.4
    assert linear[-1] / linear[48] == pytest.approx(light, abs=0.02)


def test_false_colour_comes_from_a_grey_scene():
    ideal, photo = _pictures("artefacts", {"kind": 9}, quiz=True)
    assert np.ptp(ideal, axis=2).max() == 0
    assert np.ptp(photo, axis=2).max() > 60


def test_rolling_shutter_leans_towards_the_movement():
    for variant, way in ((0, -1), (1, 1)):
        _, photo = _pictures("artefacts", {"kind": 2, "variant": variant}, quiz=True)
        orange = (photo[..., 0] - photo[..., 2]) > 100
        columns = [np.flatnonzero(row).mean() for row in orange[30:80] if row.any()]
        # rows are read from the top: lower rows see the box later
        assert way * (columns[-1] - columns[0]) > 3


@pytest.mark.parametrize(("way", "lean", "longer"), [(1, 1, 0), (2, -1, 0), (3, 0, -1), (4, 0, 1)])
def test_rolling_shutter_leans_stretches_or_squeezes(way, lean, longer):
    # X-B09 and X-D18: read from the top, 0.225 rows a row: 56 rows become 56/1.225 or 56/0.775
    _, photo = _pictures("artefacts", {"kind": 2, "way": way}, quiz=True)
    orange = (photo[..., 0] - photo[..., 2]) > 100
    rows = np.flatnonzero(orange.any(axis=1))
    ends = [np.flatnonzero(orange[row]).mean() for row in (rows[2], rows[-3])]
    assert ends[1] - ends[0] == pytest.approx(lean * 0.225 * (rows[-3] - rows[2]), abs=1.5)
    assert len(rows) == pytest.approx({0: 56, -1: 45.7, 1: 72.3}[longer], abs=2.1)


def test_no_artefact_is_named_in_the_question():
    words = "bloom|streak|vignett|barrel|pincushion|blur|focus|hot pix|clip|moir"
    names = re.compile(words, re.IGNORECASE)
    for kind in range(12):
        assert not names.search(render("artefacts", {"kind": kind}, quiz=True, lang="en").alt)
        shown = render("artefacts", {"kind": kind}, quiz=False, lang="en").alt
        assert names.search(shown) or kind in (2, 4)


@pytest.mark.parametrize("values", [(0.4, 0.2, 120.0), (0.6, 0.5, -75.0)])
def test_hsv_edits_are_the_cameras(values):
    factor, less, turn = values
    shown = _pictures("hsv_edits", {"a": factor, "b": less, "delta": turn}, quiz=True)
    original = (shown[0] / 255).astype(np.float32)
    made = pictures.hsv_edits(original, factor, less, turn)
    for ours, theirs in zip(shown, made, strict=True):
        # the figure edits its palette before rounding to codes, the camera edits the codes
        assert np.abs(ours - pictures.codes(theirs)).max() <= 1


WITHOUT_OPENCV = """
import sys
if sys.argv[1] == "without":
    sys.modules["cv2"] = None
import hashlib
sys.path.insert(0, sys.argv[2])
from figure_cases import render
for name, values in (
    ("depth_of_field", {"f": 50, "N_1": 1.8, "N_2": 16, "s": 3, "z_1": 1.5, "z_2": 3, "z_3": 8}),
    ("noise", {"sigma": 0.08, "p": 0.08, "order": 1, "seed": 3}),
    *(("artefacts", {"kind": kind, "variant": 1}) for kind in range(12)),
):
    print(hashlib.sha256(render(name, values, quiz=True, lang="en").svg).hexdigest())
"""


def test_photographs_are_the_same_bytes_with_and_without_opencv():
    found = [
        subprocess.run([sys.executable, "-c", WITHOUT_OPENCV, how, str(Path(__file__).parent)], capture_output=True, text=True,
                       check=True).stdout
        for how in ("with", "without")
    ]  # fmt: skip
    assert found[0] == found[1]
    assert len(found[0].split()) == 14


@pytest.mark.parametrize("phase", range(4))
@pytest.mark.parametrize("site", [(2, 2), (3, 2), (2, 3), (3, 3)])
def test_the_bayer_diagram_averages_the_sites_that_the_camera_does(phase, site):
    """The figure's neighbours give what the simulator's demosaicing gives at the same site."""
    raw = np.random.Generator(np.random.SFC64(7)).integers(20, 236, (6, 6)).astype(np.float32)
    _, _, full = pictures.bayer(np.repeat(raw[..., None], 3, axis=2), bayer.PATTERNS[phase])
    x, y = site
    values = {"phase": phase, "size": 6, "x": x, "y": y}
    for index, channel in enumerate("RGB"):
        if channel == bayer.letter(values, x, y):
            continue
        mean = np.mean([raw[v, u] for u, v in bayer.neighbours(values, channel)])
        assert full[y, x, index] == pytest.approx(mean, abs=1e-4)
