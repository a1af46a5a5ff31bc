"""Code questions with choices: every claim of the key is tried out."""

from __future__ import annotations

import subprocess
import sys

import cv2
import numpy as np
import pytest
from sweep import together

from quizgen.maths.numbers import to_float
from quizgen.question.compose import compose_question
from quizgen.question.part_context import ask_part
from quizgen.typeset.prose import CodeBlock

SEEDS = ["reference", *range(8)]


def asked(bank, name, seed=0, part=0):
    """Program of the stem, name to right or wrong, the draw and the composed part."""
    question, key = compose_question(bank.template(name), seed, "en", figures=False)
    (source,) = [b.text for b in question.stem if isinstance(b, CodeBlock)] or [""]
    built = ask_part(key.draw, part)
    right = {name for _, name in built.right}
    truth = {name: name in right for _, name in built.options}
    return source, truth, key, question.parts[part]


def run(source):
    scope = {"__name__": "snippet"}
    exec(compile(source, "snippet", "exec"), scope)
    return scope


def said(bank, name, key, phrase):
    """The program line behind a drawn phrase."""
    return bank.template(name).texts["en"].named["words"][key.draw.words[phrase]][0].text


def pairs(bank, name, part=0):
    """Left name to right name of a matching, as the key says."""
    answer = bank.template(name).rules.part[part].answer
    return answer["pairs"]


@together("seed", SEEDS)
def test_k06_only_widening_before_the_sum_gives_255(bank, seed):
    source, truth, key, part = asked(bank, "uint8-sum-repair", seed)
    scope = run(source)
    texts = dict(zip(truth, [words[0].text for _, words in part.field.options], strict=True))
    for name, right in truth.items():
        assert (eval(texts[name], scope)[0] == 255) == right
    assert key.specs[0].kind == "choice"


@together("seed", ["reference", *range(24)])
def test_k08_wrong_order_of_indices(bank, seed):
    source, truth, key, _ = asked(bank, "pixel-indexing-outcome", seed)
    scope = run(source)
    wanted = scope["image"]
    wanted[scope["y"], scope["x"]] = 1
    try:
        exec(said(bank, "pixel-indexing-outcome", key, "index"), scope)
        seen = scope["value"]
        happened = ("right-pixel" if seen.all() else "other-pixel") if seen.size else "no-pixel"
    except IndexError:
        happened = "index-error"
    assert [name for name, right in truth.items() if right] == [happened]


@together("seed", range(8))
def test_k12_repairs_exchange_red_and_blue(bank, seed):
    _, truth, _, part = asked(bank, "opencv-image-in-matplotlib", seed, part=1)
    texts = dict(zip(truth, [words[0].text for _, words in part.field.options], strict=True))
    image = np.arange(60, dtype=np.uint8).reshape(4, 5, 3)
    wanted = np.stack([image[..., 2], image[..., 1], image[..., 0]], axis=-1)
    for name, right in truth.items():
        got = eval(texts[name], {"cv2": cv2, "image": image})
        assert (got.shape == wanted.shape and bool(np.all(got == wanted))) == right


LOOKS = {
    "right-look": lambda x: x,
    "swapped": lambda x: np.stack([x[..., 2], x[..., 1], x[..., 0]], axis=-1),
    "below": np.flipud,
    "sideways": np.fliplr,
    "turned": lambda x: np.stack([x[..., k].T for k in range(3)], axis=-1),
    "inverted": lambda x: 1 - x,
    "white": lambda x: np.where(x > 0, 1, 0),
}


@together("seed", range(24))
def test_k12_the_picture_looks_as_the_key_says(bank, seed):
    _, truth, key, _ = asked(bank, "opencv-image-in-matplotlib", seed)
    (look,) = [name for name, right in truth.items() if right]
    rgb = np.random.default_rng(5).integers(0, 256, (4, 5, 3), dtype=np.uint8)
    scope = {"cv2": cv2, "rgb": rgb, "image": rgb[..., ::-1].copy()}
    line = said(bank, "opencv-image-in-matplotlib", key, "shown")
    drawn = eval(line.removeprefix("pyplot.imshow(").removesuffix(")"), scope)
    seen = np.clip(drawn if drawn.dtype.kind == "f" else drawn / 255.0, 0, 1)
    if look == "map":
        assert seen.ndim == 2
    else:
        assert np.allclose(seen, LOOKS[look](rgb / 255.0))


HAPPENED = {AttributeError: "attribute-error", TypeError: "type-error", cv2.error: "cv-error"}


@pytest.mark.parametrize("seed", range(24))
def test_k14_a_missing_file_is_none(bank, tmp_path, monkeypatch, seed):
    monkeypatch.chdir(tmp_path)
    source, truth, key, _ = asked(bank, "imread-missing-file", seed)
    scope = run(source)
    assert scope["image"] is None
    happened = "runs"
    try:
        exec(said(bank, "imread-missing-file", key, "line"), scope)
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


@together("seed", range(24))
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


POINTS = {
    "zero": "({x}, {y}, 0)", "optimised": "({x}, {y}, 0)", "behind": "({x}, {y}, -{m})",
    "front": "({x}, {y}, {m})", "unknown": "({x}, {y}, float('nan'))",
    "wide": "({x}, {y}, np.float64(0))", "absent": "({x}, {y}, None)", "flat": "({x}, {y})",
}  # fmt: skip
ERRORS = {
    "assertion": "AssertionError", "division": "ZeroDivisionError", "type": "TypeError",
    "value": "ValueError",
}  # fmt: skip


def called(source, point, f, optimised):
    """Print the two numbers of a call, or the name of the error that stops it."""
    flags = ["-O"] if optimised else []
    line = f"a, b = project_pinhole({point}, {f})\nprint(float(a), float(b))"
    done = subprocess.run(
        [sys.executable, *flags, "-c", f"{source}\n{line}"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    return done.stdout.strip() or done.stderr.strip().splitlines()[-1].split(":")[0]


@together("name", POINTS)
def test_k20_each_call_does_what_the_key_says(bank, name):
    source, _, key, _ = asked(bank, "projection-non-positive-depth", 3)
    drawn = {k: int(key.draw.shown[k].p) for k in ("x", "y", "m", "f", "u", "v")}
    point = POINTS[name].format(**drawn)
    u, v = float(drawn["u"]), float(drawn["v"])
    printed = {
        "picture": f"{u} {v}", "mirrored": f"{-u} {-v}", "nan": "nan nan", "inf": "inf inf",
    } | ERRORS  # fmt: skip
    outcome = pairs(bank, "projection-non-positive-depth")[name]
    optimised = name in {"optimised", "wide"}
    assert called(source, point, drawn["f"], optimised) == printed[outcome]


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


@together("seed", range(24))
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


@together("seed", range(24))
def test_k22_what_two_calls_and_two_runs_give(bank, seed):
    source, truth, key, _ = asked(bank, "random-generator-default-argument", seed)
    head, line = (
        said(bank, "random-generator-default-argument", key, name) for name in ("head", "line")
    )
    program = "\n".join((
        "import numpy as np, secrets, time", head, f"    {line}",
        "    return image + rng.normal(0, 1, image.shape)", source,
    ))  # fmt: skip
    runs = [run(program) for _ in range(2)]
    calls = "equal" if np.array_equal(runs[0]["first"], runs[0]["second"]) else "differ"
    again = "same" if np.array_equal(runs[0]["first"], runs[1]["first"]) else "new"
    assert [name for name, right in truth.items() if right] == [f"{calls}-{again}"]


def test_k23_types_and_ranges(bank):
    image = np.random.default_rng(2).integers(0, 256, (256, 256), dtype=np.uint8)
    source = asked(bank, "noise-function-return-types")[0]
    scope = {"image": image}
    exec(source, scope)
    words = bank.template("noise-function-return-types").texts["en"].named["options"]
    for left, right in pairs(bank, "noise-function-return-types").items():
        got = eval(words[left][0].text, scope)
        ends = {
            "float-unit": (0, 1), "float-full": (0, 255), "uint8-full": (0, 255),
            "uint8-unit": (0, 1), "int16": (-128, 127), "bool": (0, 1),
        }  # fmt: skip
        assert words[right][0].text == got.dtype.name
        if right == "float-open":
            assert got.min() < 0
            assert got.max() > 1
        else:
            assert (got.min(), got.max()) == ends[right]
        assert right != "uint8-unit" or set(np.unique(got)) == {0, 1}


@together("seed", SEEDS)
def test_k26_borders(bank, seed):
    source, _, key, _ = asked(bank, "demosaic-at-border", seed)
    neighbours = run(source)["neighbours"]
    drawn = {name: int(value.p) for name, value in key.draw.shown.items()}
    assert pairs(bank, "demosaic-at-border") == {
        "left": "wraps", "right": "index-error", "inside": "fine", "minus": "wraps-too",
    }  # fmt: skip
    assert neighbours(0) == drawn["mean_left"]
    assert neighbours(drawn["k"]) == drawn["mean_inside"]
    assert neighbours(-1) == drawn["mean_minus"]
    assert len({5, 10, *(drawn[f"mean_{name}"] for name in ("left", "inside", "minus"))}) == 5
    with pytest.raises(IndexError):
        neighbours(drawn["last"])


CUT = {"whole": (0, 0), "row": (1, 0), "column": (0, 1), "both": (1, 1)}


@together("seed", range(24))
def test_k27_the_constant_keeps_a_red_scene_red(bank, seed):
    _, truth, key, part = asked(bank, "opencv-bayer-constant", seed)
    tile = key.draw.words["tile"].upper()
    rows = (tile[:2], tile[2:])
    raw = np.array(
        [[255 * (rows[y % 2][x % 2] == "R") for x in range(9)] for y in range(9)], np.uint8
    )
    top, left = CUT[key.draw.words["view"]]
    mosaic = np.ascontiguousarray(raw[top : top + 8, left : left + 8])
    texts = dict(zip(truth, [words[0].text for _, words in part.field.options], strict=True))
    for name, right in truth.items():
        code = getattr(cv2, texts[name].removeprefix("cv2."))
        seen = cv2.cvtColor(mosaic, code)[4, 4].tolist()
        assert (seen == [0, 0, 255]) == right
