"""Figures with photographs: pixels, histograms and keys beside numbers worked out elsewhere."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from figure_cases import draw, module
from skimage.color import hsv2rgb, rgb2hsv, rgb2lab
from svg_reader import read_labels, read_parts, read_pictures
from sweep import spread, together

from quizgen.bank.variant import draw_variant
from quizgen.camera import picture_sets
from quizgen.core.errors import BankError, QuizgenError
from quizgen.figures import complete_parameters, svg
from quizgen.figures.svg import encode_png
from quizgen.question.part_context import ask_part

artefacts = module("artefacts")
depth_of_field = module("depth_of_field")
focus_photos = module("focus_photos")
grey_edits = module("grey_edits")
hsv_edits = module("hsv_edits")
noise = module("noise")
_scene = module("_scene")

SEEDS = spread(range(60), 6)


def read_photos(name, values):
    return [photo.astype(float) for photo in read_pictures(draw(name, values, quiz=True))]


@pytest.mark.parametrize("shape", [(5, 7), (1, 1), (5, 7, 3), (96, 144, 3)])
def test_png_is_read_back_by_opencv(shape):
    codes = np.random.Generator(np.random.SFC64(3)).integers(0, 256, shape, np.uint8)
    read = cv2.imdecode(np.frombuffer(encode_png(codes), np.uint8), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(read if codes.ndim == 2 else read[..., ::-1], codes)


def test_grey_pictures_are_stored_with_one_channel():
    codes = np.repeat(np.arange(20, dtype=np.uint8).reshape(4, 5, 1), 3, axis=2)
    read = cv2.imdecode(np.frombuffer(encode_png(codes), np.uint8), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(read, codes[..., 0])


def test_question_and_solution_pack_a_photograph_once():
    svg._encode_colours.cache_clear()
    depth_of_field._take_photos.cache_clear()
    values = {"f": 51, "N_2": 2.1}
    photos = [read_pictures(draw("depth_of_field", values, quiz=quiz)) for quiz in (True, False)]
    assert np.array_equal(*photos)
    assert depth_of_field._take_photos.cache_info().misses <= 1
    assert svg._encode_colours.cache_info().misses <= 2


# Colours


@together(
    ("name", "values", "needed"),
    [
        *(("artefacts", {"kind": kind}, kind in (4, 9)) for kind in range(12)),
        ("hsv_edits", {"a": 0.4, "b": 0.2, "delta": 120}, True),
        ("depth_of_field", {}, False),
        ("noise", {}, False),
    ],
)
def test_what_shows_only_in_colour_says_so(name, values, needed):
    assert draw(name, values, quiz=True).needs_colour == needed


def test_the_moving_box_is_seen_on_a_grey_print():
    (scene, _) = read_photos("artefacts", {"kind": 2})
    lightness = rgb2lab(scene / 255)[..., 0]
    box, wall = lightness[110, 108], lightness[20, 108]
    assert abs(box - wall) > 30


@pytest.mark.parametrize("name", ["depth_of_field", "focus_photos"])
def test_models_stand_out_on_a_grey_print(name):
    photo = read_photos(name, {"N_1": 64} if name == "depth_of_field" else {"order": 23})[0]
    lightness = rgb2lab(photo / 255)[..., 0]
    for columns in np.array_split(lightness, 3, axis=1):
        assert np.ptp(columns[len(columns) // 4 : len(columns) // 2]) > 40


# Blur


def test_blur_discs_are_those_of_the_curriculum():
    # X-C03: f = 50, N = 2, s = 2.05 m, z = 4.1 m gives 0.3125 mm
    values = {"f": 50, "N_1": 2, "N_2": 8, "s": 2.05, "z_1": 2.05, "z_2": 4.1, "z_3": 4.1}
    full = complete_parameters(depth_of_field, values)
    assert depth_of_field.measure_discs(full, 2) == pytest.approx((0, 0.3125, 0.3125))
    assert depth_of_field.measure_discs(full, 8) == pytest.approx((0, 0.078125, 0.078125))


def measure_edges(photo):
    """Strength of the edges of house, balloon and sun: mean square step from pixel to pixel."""
    wide = photo.shape[1]
    steps = np.square(np.diff(photo[..., 1], axis=1))[wide // 8 : wide // 2]
    return np.array([part.mean() for part in np.array_split(steps, 3, axis=1)])


def test_models_are_equally_large():
    """Nothing but blur tells how far away they are."""
    photo = read_photos("depth_of_field", {"N_1": 64})[0]
    areas = []
    for columns in np.array_split(photo[:85], 3, axis=1):  # above the hills
        drawn = np.abs(columns - columns[2, 2]).max(axis=2) > 40
        areas.append([np.flatnonzero(drawn.any(axis=0)).size, np.flatnonzero(drawn.any(axis=1))[0]])
    wide, top = np.transpose(areas)
    assert wide.max() < 1.15 * wide.min()
    assert np.ptp(top) < 0.15 * len(photo)


@pytest.mark.parametrize("order", [0, 1])
def test_the_wide_aperture_blurs_only_what_is_out_of_focus(order):
    small, wide = read_photos("depth_of_field", {"order": order})[:: -1 if order else 1]
    left, middle, right = measure_edges(wide) / measure_edges(small)
    assert max(left, right) < 0.6
    assert middle > 0.97
    assert np.array_equal(small[60:85, 90:126], wide[60:85, 90:126])  # inside the balloon


# The least that the question draws: f^2/(N s) is 0.8 mm; z = 2 s is the weakest place of all.
@pytest.mark.parametrize(
    "values",
    [
        {"f": 40, "N_2": 1, "s": 2, "z_1": 1, "z_2": 2, "z_3": 8},
        {"f": 50, "N_2": 1.4, "s": 2, "z_1": 2, "z_2": 4, "z_3": 12},
        {"f": 60, "N_2": 1.8, "s": 2.5, "z_1": 0.75, "z_2": 1.5, "z_3": 2.5},
        {"f": 40, "N_2": 1, "s": 2, "z_1": 2, "z_2": 4, "z_3": 8},
    ],
)
def test_blur_is_clearly_seen_on_each_model(values):
    small, wide = read_photos("depth_of_field", {"N_1": 16, **values})
    left = measure_edges(wide) / measure_edges(small)
    sharp = [values[name] == values["s"] for name in ("z_1", "z_2", "z_3")]
    assert ((left > 0.97) == sharp).all()
    assert (left[np.logical_not(sharp)] < 0.7).all()


def test_the_model_in_focus_is_sharp_and_a_small_hole_sharpens_all():
    values = complete_parameters(focus_photos, {})
    found = [
        (setting, measure_edges(photo))
        for order in (0, 9, 23)  # every setting at one place at least
        for setting, photo in zip(
            focus_photos.order_settings({**values, "order": order}),
            read_photos("focus_photos", {"order": order}),
            strict=True,
        )
    ]
    sharpest = np.max([edges for _, edges in found], axis=0)
    assert len({setting for setting, _ in found}) == 4
    for (s, number), edges in found:
        clear = np.array([s == values[name] for name in ("z_1", "z_2", "z_3")])
        assert ((edges > 0.6 * sharpest) == (clear | (number == values["N_s"]))).all()


@pytest.mark.parametrize(
    ("values", "message"),
    [({"f": 200, "s": 0.3}, "exceed 2 f"), ({"N_1": 4, "N_2": 4}, "must differ"),
     ({"f": 200, "z_1": 0.35}, "beyond 2 f")],
)  # fmt: skip
def test_what_no_lens_can_show_is_refused_in_a_line(values, message):
    with pytest.raises(BankError, match=message) as caught:
        draw("depth_of_field", values)
    assert "\n" not in str(caught.value)


def test_photographs_keep_their_brightness():
    small, wide = read_photos("depth_of_field", {})
    assert small.mean() == pytest.approx(wide.mean(), rel=0.02)


# Artefacts


@together("kind", range(12))
@together("variant", range(4))
def test_every_artefact_is_seen(kind, variant):
    ideal, photo = read_photos("artefacts", {"kind": kind, "variant": variant})
    changed = np.abs(photo - ideal).max(axis=2) > 12
    assert changed.mean() > (0.002 if artefacts.KINDS[kind] == "hot pixels" else 0.02)


def test_what_blooms_ends_inside_the_picture_and_a_streak_does_not():
    def rows(kind):
        ideal, photo = read_photos("artefacts", {"kind": kind})
        return np.flatnonzero((np.abs(photo - ideal).max(axis=2) > 12).any(axis=1))

    blob, streak = rows(0), rows(1)
    assert 4 < blob.min() < blob.max() < 138
    assert blob.size > 30
    assert (streak.min(), streak.max()) == (0, 143)


def test_what_is_too_bright_is_evenly_white():
    ideal, photo = read_photos("artefacts", {"kind": 10, "variant": 1})
    cloud = np.s_[8:30, 70:95]
    assert np.ptp(ideal[cloud], axis=(0, 1)).min() > 25
    white = (photo[cloud] == 255).all(axis=2)
    assert white.mean() > 0.5
    assert white[(ideal[cloud] > 200).all(axis=2)].all()


def to_linear(code):
    """Light of codes in sRGB (IEC 61966-2-1)."""
    share = code / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def test_corners_fall_off_with_the_fourth_power_of_the_cosine():
    ideal, photo = read_photos("artefacts", {"kind": 3})
    tangent = np.hypot(107.5, 71.5) * (36 / 216) / 18  # a sensor of 36 mm behind a lens of 18 mm
    fall_off = to_linear(photo[0, 0]) / to_linear(ideal[0, 0])
    assert fall_off == pytest.approx(1 / (1 + tangent**2) ** 2, rel=0.02)


def test_false_colour_comes_from_a_grey_scene():
    ideal, photo = read_photos("artefacts", {"kind": 9})
    assert np.ptp(ideal, axis=2).max() == 0
    assert np.ptp(photo, axis=2).max() > 60


def find_box(photo):
    """Where the moving box is orange."""
    return (photo[..., 0] - photo[..., 2]) > 100


@pytest.mark.parametrize(("variant", "way"), [(0, -1), (1, 1)])
def test_rolling_shutter_leans_towards_the_movement(variant, way):
    _, photo = read_photos("artefacts", {"kind": 2, "variant": variant})
    columns = [np.flatnonzero(row).mean() for row in find_box(photo)[45:120] if row.any()]
    # rows are read from the top: lower rows see the box later
    assert way * (columns[-1] - columns[0]) > 4


@pytest.mark.parametrize(("way", "lean", "longer"), [(1, 1, 0), (2, -1, 0), (3, 0, -1), (4, 0, 1)])
def test_rolling_shutter_leans_stretches_or_squeezes(way, lean, longer):
    # X-B09 and X-D18: read from the top, 0.225 rows a row: 84 rows become 84/1.225 or 84/0.775
    _, photo = read_photos("artefacts", {"kind": 2, "way": way})
    box = find_box(photo)
    rows = np.flatnonzero(box.any(axis=1))
    ends = [np.flatnonzero(box[row]).mean() for row in (rows[2], rows[-3])]
    assert ends[1] - ends[0] == pytest.approx(lean * 0.225 * (rows[-3] - rows[2]), abs=1.5)
    assert len(rows) == pytest.approx({0: 84, -1: 68.6, 1: 108.4}[longer], abs=2.1)


def test_no_artefact_is_named_in_the_question():
    words = "bloom|streak|vignett|barrel|pincushion|blur|focus|hot pix|clip|moir"
    names = re.compile(words, re.IGNORECASE)
    for kind in range(12):
        assert not names.search(draw("artefacts", {"kind": kind}, quiz=True).alt)
        assert names.search(draw("artefacts", {"kind": kind}).alt) or kind in (2, 4)


# Noise and grey levels


@together("order", range(6))
def test_noise_stands_where_the_order_says(order):
    sigma, share = 0.05, 0.1
    shown = read_photos("noise", {"order": order, "sigma": sigma, "p": share})
    photos = [photo for photo in shown if photo.shape[:2] == (72, 96)]
    whole = dict(zip(noise.order_noises(order), photos, strict=True))
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


def test_the_detail_is_what_its_frame_surrounds():
    figure = draw("noise", {"order": 4}, quiz=True)
    detail, whole = read_pictures(figure)[:2]
    frame, photo = read_parts(figure)["detail"][0], read_parts(figure)["frames"][1]
    size = np.ptp(photo, axis=0)
    left, low = np.rint((frame.min(axis=0) - photo.min(axis=0)) / size * (96, 72)).astype(int)
    right, top = np.rint((frame.max(axis=0) - photo.min(axis=0)) / size * (96, 72)).astype(int)
    assert np.array_equal(whole[72 - top : 72 - low, left:right], detail)


def test_edited_levels_are_those_of_the_curriculum():
    # X-A08: I = 220 rounded to 8 levels, squeezed into 70 to 180, raised by 60 and clamped
    values = {"n": 8, "low": 70, "high": 180, "s": 60}
    edited = [float(grey_edits.edit_levels(edit, np.array([220.0]), values)[0])
              for edit in grey_edits.EDITS[1:]]  # fmt: skip
    assert np.rint(edited).tolist() == [219, 165, 255]


def test_photo_of_soft_shades_has_every_level():
    levels = np.bincount(grey_edits.take_photo().ravel(), minlength=256)
    assert (levels > 0).mean() > 0.95


@pytest.mark.parametrize("order", [0, 9, 23])
def test_bars_count_the_pixels_above_them(order):
    figure = draw("grey_edits", {"n": 8, "low": 70, "high": 180, "s": 60, "order": order})
    bars = read_parts(figure)["histogram"]
    for photo, outline in zip(read_pictures(figure), bars, strict=True):
        counts, _ = np.histogram(photo[..., 0], 128, (0, 256))
        heights = outline[1:-2:2, 1] - outline[:, 1].min()
        second, most = np.sort(counts)[-2:]
        shown = np.minimum(counts, 4 * second)  # the tallest is cut where it dwarfs the others
        expected = shown / shown.max() * heights.max()
        assert heights == pytest.approx(expected, abs=0.02)
        assert (most > 4 * second) == (photo.max() == 255 and photo.min() == 60)
    assert len(read_parts(figure)["break"]) == 3  # paper and two strokes, on one bar


def test_axes_of_histograms_have_names_and_ticks():
    labels = read_labels(draw("noise", {}, quiz=True))
    assert labels.count("I") == labels.count("h(I)") == labels.count("128") == 3


# Edits of colours


def read_edits(**values):
    order = hsv_edits.order_edits(values.get("order", 0))
    return dict(zip(order, read_pictures(draw("hsv_edits", values, quiz=True)), strict=True))


@pytest.mark.parametrize("values", [(0.4, 0.2, 120.0), (0.6, 0.5, -75.0)])
def test_hsv_edits_are_the_cameras(values):
    shown = read_edits(**dict(zip(("a", "b", "delta"), values, strict=True)))
    original = (shown["original"] / 255).astype(np.float32)
    for ours, theirs in zip(
        shown.values(), picture_sets.make_hsv_edits(original, *values), strict=True
    ):
        assert np.abs(ours - picture_sets.to_codes(theirs).astype(float)).max() <= 1


@pytest.mark.parametrize("order", spread([0, 13, 23], 1))
def test_edits_are_those_of_scikit_image(order):
    got = read_edits(a=0.4, b=0.2, delta=120, order=order, scene=order % 8)
    hsv = rgb2hsv(got["original"])
    for edit, change in (
        ("V", hsv * [1, 1, 0.4]),
        ("S", hsv * [1, 0.2, 1]),
        ("H", np.dstack([(hsv[..., 0] + 1 / 3) % 1, hsv[..., 1:]])),
    ):
        assert got[edit] == pytest.approx(hsv2rgb(change) * 255, abs=0.6)


@together(("scene", "delta"), spread(itertools.product(range(8), (60, 90, 120, 180, 240)), 12))
def test_edits_can_be_told_apart(scene, delta):
    """Curriculum Q1a: V kept within 1 % by S and H edits, 12 grey levels RMS between any two."""
    for a, b in itertools.product((0.35, 0.55), (0.1, 0.3)):
        got = read_edits(a=a, b=b, delta=delta, scene=scene)
        value = {edit: picture.max(axis=2).mean() for edit, picture in got.items()}
        assert value["S"] == pytest.approx(value["original"], rel=0.01)
        assert value["H"] == pytest.approx(value["original"], rel=0.01)
        for one, other in itertools.combinations(got.values(), 2):
            assert np.sqrt(np.mean((one.astype(float) - other) ** 2)) > 12


def test_order_of_edits_is_not_told():
    drawn = [
        draw("hsv_edits", {"a": 0.5, "b": 0.3, "delta": 90, "order": order}, quiz=True)
        for order in range(24)
    ]
    assert len({figure.alt for figure in drawn}) == 1
    assert len({figure.inline_svg for figure in drawn}) == 24


@together("scene", range(8))
def test_scene_has_hues_greys_and_whites(scene):
    indices, palette = _scene.paint_scene(scene)
    assert len(palette) <= 256
    used, counts = np.unique(indices, return_counts=True)
    hue, saturation, value = rgb2hsv(np.array(palette)[used][None] / 255)[0].T
    vivid = (hue * 6).astype(int)[(saturation > 0.5) & (value > 0.5)]
    assert set(vivid) >= {0, 1, 2, 3, 5}  # all but violet, from 240 to 300 degrees
    grey = (saturation == 0) & (value > 0.3) & (value < 0.7)
    white = (saturation < 0.06) & (value > 0.95)
    assert min(counts[grey].sum(), counts[white].sum()) > 300


def test_scenes_differ():
    assert len({_scene.paint_scene(scene)[0].tobytes() for scene in range(8)}) == 8


# The same everywhere

DIGESTS = """
import sys
if sys.argv[1] == "without":
    sys.modules["cv2"] = None
import hashlib
sys.path.insert(0, sys.argv[2])
from figure_cases import draw
for name, values in (
    ("depth_of_field", {"f": 50, "N_1": 1.8, "N_2": 16, "s": 3, "z_1": 1.5, "z_2": 3, "z_3": 8}),
    ("noise", {"sigma": 0.08, "p": 0.08, "order": 1, "seed": 3}),
    *(("artefacts", {"kind": kind, "variant": 1}) for kind in range(12)),
):
    print(hashlib.sha256(draw(name, values, quiz=True).inline_svg).hexdigest())
"""


@pytest.mark.slow
def test_photographs_are_the_same_bytes_with_and_without_opencv(tmp_path):
    found = [
        subprocess.run(
            [sys.executable, "-c", DIGESTS, how, str(Path(__file__).parent)],
            env={**os.environ, "XDG_CACHE_HOME": str(tmp_path / how)},
            capture_output=True, text=True, check=True,
        ).stdout
        for how in ("with", "without")
    ]  # fmt: skip
    assert found[0] == found[1]
    assert len(found[0].split()) == 14


# Keys of questions

NAMES = {
    "blooming": "blooming",
    "streak": "streak",
    "rolling": "rolling shutter",
    "vignetting": "vignetting",
    "lateral": "lateral colour",
    "barrel": "barrel",
    "pincushion": "pincushion",
    "motion": "motion blur",
    "defocus": "defocus",
    "moire": "false colour",
    "clipping": "clipping",
    "hot": "hot pixels",
}


def draw_key(bank, name, seed, part=0):
    """Drawn numbers and the name of the right option of a part."""
    drawn = draw_variant(bank.template(name), seed)
    ((_, right),) = ask_part(drawn, part).right
    return {key: float(value) for key, value in drawn.shown.items()}, right


@together("seed", SEEDS)
def test_the_named_artefact_is_the_one_shown(bank, seed):
    given, key = draw_key(bank, "name-artefact-from-photo", seed)
    assert artefacts.KINDS[int(given["k"])] == NAMES[key]


@together("seed", SEEDS)
def test_the_noise_asked_for_stands_where_the_key_says(bank, seed):
    given, key = draw_key(bank, "recognise-noise-from-histograms", seed)
    place = ("left", "middle", "right").index(key)
    asked = ("clean", "gaussian", "impulse")[int(given["asked"])]
    assert noise.order_noises(given["order"])[place] == asked


@together("seed", SEEDS)
def test_the_wide_aperture_stands_where_the_key_says(bank, seed):
    given, key = draw_key(bank, "which-photo-which-f-number", seed)
    shown = {"N_1": given["N_b"], "N_2": given["N_a"], "order": given["order"]}
    pair = depth_of_field.order_f_numbers(shown)
    assert pair[("left", "right").index(key)] == min(pair) == given["N_a"]


@together("seed", SEEDS)
def test_the_object_in_focus_is_the_one_of_the_key(bank, seed):
    given, key = draw_key(bank, "which-photo-which-f-number", seed, part=1)
    objects = [given[name] for name in ("z_1", "z_2", "z_3")]
    assert objects == sorted(objects)
    assert objects[("nearer", "middle", "farther").index(key)] == given["s"]


@together("seed", SEEDS)
def test_the_edits_stand_where_the_key_says(bank, seed):
    drawn = draw_variant(bank.template("edit-from-photo-and-histogram"), seed)
    given = {key: float(value) for key, value in drawn.shown.items()}
    order = grey_edits.order_edits(given["order"])
    places = [order.index(edit) for edit in ("coarse", "squeezed", "brightened")]
    assert [given[name] for name in ("p_n", "p_r", "p_s")] == places
    assert [drawn.words[name] for name in ("place_n", "place_r", "place_s")] == [
        f"picture-{place + 1}" for place in places
    ]


@together("seed", SEEDS)
def test_each_photo_was_taken_with_the_setting_of_the_key(bank, seed):
    drawn = draw_variant(bank.template("which-photo-which-focus"), seed)
    given = {key: float(value) for key, value in drawn.shown.items()}
    built = ask_part(drawn, 0)
    settings = {
        "focus-near": (given["z_1"], given["N_w"]),
        "focus-middle": (given["z_2"], given["N_w"]),
        "focus-far": (given["z_3"], given["N_w"]),
        "stopped": (given["z_2"], given["N_s"]),
    }
    targets = dict(built.targets)
    key = [settings[targets[place]] for _, place in sorted(built.spec.pairs.items())]
    assert [name for _, name in built.options] == ["one", "two", "three"]
    assert key == list(focus_photos.order_settings(given))


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("fall_off", {"f": 1000, "r": 5}, "vignetting cannot be seen"),
        ("hsv_edits", {"a": 1, "b": 0.2, "delta": 120}, "the edit of V cannot be seen"),
        ("grey_edits", {"n": 8, "low": 70, "high": 180, "s": 1}, "the edit brightened cannot"),
    ],
)
def test_a_picture_that_does_not_show_what_it_asks_about_is_refused(name, values, message):
    with pytest.raises(QuizgenError, match=message):
        draw(name, values, quiz=True)
