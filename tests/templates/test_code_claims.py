"""Code questions with choices: every claim of the key is tried out."""

from __future__ import annotations

import subprocess
import sys

import cv2
import numpy as np
import pytest

from quizgen.bank.prose import CodeBlock
from quizgen.maths.numbers import to_float
from quizgen.question.compose import compose
from quizgen.question.kinds import build

SEEDS = ["reference", *range(8)]


def asked(bank, name, seed=0, part=0):
    """Program of the stem, name to right or wrong, the draw and the composed part."""
    question, key = compose(bank.template(name), seed, "en", figures=False)
    (source,) = [b.text for b in question.stem if isinstance(b, CodeBlock)] or [""]
    built = build(key.draw, part)
    right = {name for _, name in built.right}
    truth = {name: name in right for _, name in built.options}
    return source, truth, key, question.parts[part]


def run(source):
    scope = {"__name__": "snippet"}
    exec(compile(source, "snippet", "exec"), scope)
    return scope


def pairs(bank, name, part=0):
    """Left name to right name of a matching, as the key says."""
    answer = bank.template(name).rules.part[part].answer
    return answer["pairs"]


@pytest.mark.parametrize("seed", SEEDS)
def test_k06_only_widening_before_the_sum_gives_255(bank, seed):
    source, truth, key, part = asked(bank, "uint8-sum-repair", seed)
    scope = run(source)
    texts = dict(zip(truth, [said[0].text for _, said in part.field.options], strict=True))
    for name, right in truth.items():
        assert (eval(texts[name], scope)[0] == 255) == right
    assert key.specs[0].kind == "choice"


@pytest.mark.parametrize("seed", SEEDS)
def test_k08_wrong_order_of_indices(bank, seed):
    source, truth, key, _ = asked(bank, "pixel-indexing-outcome", seed)
    try:
        run(source)
        happened = "other-pixel"
    except IndexError:
        happened = "index-error"
    assert [name for name, right in truth.items() if right] == [happened]
    assert key.draw.shown["x"] != key.draw.shown["y"]


def test_k12_both_repairs_exchange_red_and_blue(bank):
    _, truth, _, part = asked(bank, "opencv-image-in-matplotlib", part=1)
    texts = dict(zip(truth, [said[0].text for _, said in part.field.options], strict=True))
    image = np.arange(60, dtype=np.uint8).reshape(4, 5, 3)
    wanted = np.stack([image[..., 2], image[..., 1], image[..., 0]], axis=-1)
    for name, right in truth.items():
        got = eval(texts[name], {"cv2": cv2, "image": image})
        assert (got.shape == wanted.shape and bool(np.all(got == wanted))) == right


HAPPENED = {AttributeError: "attribute-error", TypeError: "type-error", cv2.error: "cv-error"}


@pytest.mark.parametrize("seed", range(24))
def test_k14_a_missing_file_is_none(bank, tmp_path, monkeypatch, seed):
    monkeypatch.chdir(tmp_path)
    source, truth, key, _ = asked(bank, "imread-missing-file", seed)
    said = bank.template("imread-missing-file").texts["en"].named["words"]
    scope = run(source)
    assert scope["image"] is None
    happened = "runs"
    try:
        exec(said[key.draw.words["line"]][0].text, scope)
    except tuple(HAPPENED) as error:
        happened = HAPPENED[type(error)]
    assert [name for name, right in truth.items() if right] == [happened]


@pytest.mark.parametrize("seed", range(24))
def test_k09_the_colour_is_where_opencv_puts_it(bank, tmp_path, seed):
    _, truth, key, _ = asked(bank, "red-of-bgr-pixel", seed)
    wanted = {"red": (0, 0, 255), "green": (0, 255, 0), "blue": (255, 0, 0)}[
        key.draw.words["colour"]
    ]
    assert cv2.imwrite(str(tmp_path / "photo.png"), np.array([[wanted]], np.uint8))
    image = cv2.imread(str(tmp_path / "photo.png"))
    if key.draw.shown["converted"]:
        image = cv2.cvtColor(image, cv2.COLOR_BGR2RGB)
    place = ("first", "second", "third")[image[0, 0].tolist().index(255)]
    assert [name for name, right in truth.items() if right] == [place]


@pytest.mark.parametrize("seed", range(24))
def test_s02_an_index_outside_stops_and_a_negative_one_counts_from_below(bank, seed):
    _, truth, key, _ = asked(bank, "pixel-index-and-shape", seed, part=2)
    rows, columns, i, j = (int(key.draw.shown[name].p) for name in ("H", "W", "i", "j"))
    image = np.broadcast_to(np.arange(rows, dtype=np.uint16)[:, None], (rows, columns))
    try:
        happened = "inside" if image[i, j] == i else "from-the-end"
        if happened == "from-the-end":
            assert image[i, j] == key.draw.shown["from_below"]
    except IndexError as error:
        happened = "row-error" if "axis 0" in str(error) else "column-error"
    assert [name for name, right in truth.items() if right] == [happened]


def test_k20_assertion_division_mirror(bank):
    source, _, _, _ = asked(bank, "projection-non-positive-depth")
    assert pairs(bank, "projection-non-positive-depth") == {
        "zero": "assertion", "optimised": "division", "behind": "mirrored",
    }  # fmt: skip
    project = run(source)["project_pinhole"]
    with pytest.raises(AssertionError):
        project((1, 2, 0), 2)
    assert project((1, 3, -2), 2) == (-1.0, -3.0)
    done = subprocess.run(
        [sys.executable, "-O", "-c", source + "\nproject_pinhole((1, 2, 0), 2)"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "ZeroDivisionError" in done.stderr


def test_k21_the_order_gives_a_clean_uint8_image(bank):
    answer = bank.template("add-noise-to-uint8-order").rules.part[0].answer
    words = bank.template("add-noise-to-uint8-order").texts["en"].named["options"]
    scope = {
        "np": np, "image": np.full((50, 50), 250, np.uint8),
        "rng": np.random.default_rng(1), "sigma": 20.0,
    }  # fmt: skip
    for step in answer["steps"]:
        exec(words[step][0].text, scope)
    assert scope["x"].dtype == np.uint8
    assert scope["x"].min() > 150
    assert scope["x"].max() == 255


@pytest.mark.parametrize("seed", range(24))
def test_k21_the_pixel_is_what_the_program_stores(bank, seed):
    template = bank.template("add-noise-to-uint8-order")
    words, answer = template.texts["en"].named["options"], template.rules.part[0].answer
    key = asked(bank, "add-noise-to-uint8-order", seed)[2]
    value, noise = (to_float(key.draw.shown[name]) for name in ("g", "d"))

    class Fixed:
        def normal(self, _mean, _sigma, shape):
            return np.full(shape, noise)

    scope = {"np": np, "image": np.full((2, 2), value, np.uint8), "rng": Fixed(), "sigma": 9.0}
    for step in answer["steps"]:
        exec(words[step][0].text, scope)
    assert key.specs[1].output == str(scope["x"][0, 0])


def test_k22_calls_share_one_generator(bank):
    source, truth, _, _ = asked(bank, "random-generator-default-argument")
    scope = run(source)
    assert not np.array_equal(scope["first"], scope["second"])
    assert truth["differ"]


def test_k23_types_and_ranges(bank):
    source, _, _, _ = asked(bank, "noise-function-return-types")
    scope = run(source)
    image = np.random.default_rng(2).integers(0, 256, (64, 64), dtype=np.uint8)
    soft = scope["gaussian"](image, 0.3, np.random.default_rng(3))
    hard = scope["impulse"](image, 0.2, np.random.default_rng(3))
    assert pairs(bank, "noise-function-return-types") == {
        "gaussian": "float-unit",
        "impulse": "uint8-full",
    }
    assert (soft.dtype, soft.min(), soft.max()) == (np.float64, 0.0, 1.0)
    assert (hard.dtype, hard.min(), hard.max()) == (np.uint8, 0, 255)


@pytest.mark.parametrize("seed", SEEDS)
def test_k26_borders(bank, seed):
    source, _, key, _ = asked(bank, "demosaic-at-border", seed)
    width = int(key.draw.shown["W"].p)
    scope = run(source)
    assert scope["neighbours"](0) == (scope["row"][-1] + scope["row"][1]) / 2
    assert scope["neighbours"](1) == 10.0
    with pytest.raises(IndexError):
        scope["neighbours"](width - 1)
    assert pairs(bank, "demosaic-at-border")["right"] == "index-error"


PLACE = {"R": 2, "G": 1, "B": 0}


@pytest.mark.parametrize("seed", range(12))
def test_k27_the_constant_keeps_a_red_scene_red(bank, seed):
    _, truth, key, part = asked(bank, "opencv-bayer-constant", seed)
    tile = key.draw.words["tile"].upper()
    rows = (tile[:2], tile[2:])
    mosaic = np.array(
        [[255 * (rows[y % 2][x % 2] == "R") for x in range(8)] for y in range(8)], np.uint8
    )
    texts = dict(zip(truth, [said[0].text for _, said in part.field.options], strict=True))
    for name, right in truth.items():
        code = getattr(cv2, texts[name].removeprefix("cv2."))
        seen = cv2.cvtColor(mosaic, code)[4, 4].tolist()
        assert (seen == [0, 0, 255]) == right
