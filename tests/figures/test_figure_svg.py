"""Every figure: bytes, markup, words, hidden answers, legibility, errors."""

from __future__ import annotations

import hashlib
import itertools
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import ClassVar
from xml.etree import ElementTree as ET

import pytest
from figure_cases import FIGURES, HIDDEN, REFERENCE, draws, module, outline, render

from quizgen.bank.folder import builtin
from quizgen.errors import BankError
from quizgen.figures import _pen as pens
from quizgen.figures._canvas import Canvas
from quizgen.figures._letters import SUBSCRIPT
from quizgen.figures._parameters import complete

BOTH = list(itertools.product(FIGURES, (False, True)))
NUMBER = re.compile(r"\d+(?:\.\d+)?")
HERE = Path(__file__).parent

DIGESTS = """
import hashlib, json, sys
sys.path.insert(0, sys.argv[1])
from figure_cases import REFERENCE, render
print(json.dumps({f"{name} {quiz} {lang}": hashlib.sha256(
    render(name, values, quiz=quiz, lang=lang).svg).hexdigest()
    for name, values in REFERENCE.items() for quiz in (False, True) for lang in ("en", "bn")}))
"""

HOSTILE = """
savefig.bbox: tight
savefig.facecolor: red
savefig.transparent: True
figure.constrained_layout.use: True
figure.dpi: 300
lines.scale_dashes: True
path.simplify: True
path.sketch: 3, 100, 2
svg.fonttype: none
svg.hashsalt: other
font.family: monospace
patch.linewidth: 5
"""


def test_every_figure_has_a_reference():
    assert set(FIGURES) == set(REFERENCE)


def test_bytes_are_equal_in_every_process(tmp_path):
    settings = tmp_path / "matplotlibrc"
    settings.write_text(HOSTILE)
    outputs = [
        subprocess.run(
            [sys.executable, "-c", DIGESTS, str(HERE)],
            env={"PYTHONHASHSEED": seed, "PATH": "", "HOME": str(tmp_path), **extra},
            cwd=HERE.parents[1],
            capture_output=True,
            check=True,
            text=True,
        ).stdout
        for seed, extra in (("0", {}), ("4711", {"MATPLOTLIBRC": str(settings)}))
    ]
    assert outputs[0] == outputs[1]
    here = {
        f"{name} {quiz} {lang}": hashlib.sha256(
            render(name, values, quiz=quiz, lang=lang).svg
        ).hexdigest()
        for name, values in REFERENCE.items()
        for quiz in (False, True)
        for lang in ("en", "bn")
    }
    assert json.loads(outputs[0]) == here
    assert len(set(here.values())) == len(here)


def test_nothing_heavy_is_imported_before_the_first_figure():
    code = (
        "import sys; from quizgen import builtin; [builtin().figure(n) for n in builtin().figures]; "
        "print([m for m in ('numpy', 'matplotlib', 'PIL', 'sympy') if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        check=True,
        text=True,
        cwd=HERE.parents[1],
    )
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(("name", "quiz"), BOTH)
def test_svg_stands_inside_html(name, quiz):
    figure = render(name, REFERENCE[name], quiz=quiz, lang="bn")
    text = figure.svg.decode()
    root = ET.fromstring(text)
    assert text.startswith("<svg ")
    assert text.endswith("</svg>")
    assert root.attrib["role"] == "img"
    assert root.attrib["lang"] == "bn"
    assert root[0].tag.endswith("title")
    assert root[0].text == figure.alt
    assert root.attrib["viewBox"] == f"0 0 {figure.width_pt:g} {figure.height_pt:g}"
    assert not re.search(
        r"\bid=|<style|<script|<text|url\(|<!--|<metadata|http(?!://www\.w3\.org/)", text
    )


@pytest.mark.parametrize(("name", "quiz"), BOTH)
def test_line_art_is_transparent_and_pictures_are_on_white(name, quiz):
    figure = render(name, REFERENCE[name], quiz=quiz, lang="en")
    white = f'd="M 0 {figure.height_pt:g} L {figure.width_pt:g} {figure.height_pt:g} L'
    assert (white in figure.svg.decode()) == (figure.dark == "keep")
    pictures = {
            "artefacts", "depth_of_field", "fall_off", "focus_photos", "grey_edits", "hsv_edits",
            "luminosity", "noise",
        }  # fmt: skip
    assert figure.dark == ("keep" if name in pictures else "invert")


def test_what_holds_a_picture_is_a_photograph_unless_it_is_painted():
    shown = {name for name in FIGURES
             if b"<image" in render(name, REFERENCE[name], quiz=True, lang="en").svg}  # fmt: skip
    assert shown - {"hsv_edits", "luminosity"} == builtin().about.photographs


def _labels(name, values, *, quiz):
    canvas = Canvas()
    full = complete(name, module(name).PARAMETERS, values)
    module(name).draw(canvas, full, quiz=quiz)
    return "\n".join(label.text for label in canvas.labels)


@pytest.mark.parametrize("name", FIGURES)
def test_quiz_hides_the_answer(name):
    values = REFERENCE[name]
    normal = _labels(name, values, quiz=False)
    normal += render(name, values, quiz=False, lang="en").alt
    hidden = _labels(name, values, quiz=True)
    hidden += "".join(render(name, values, quiz=True, lang=lang).alt for lang in ("en", "bn"))
    for answer in HIDDEN[name]:
        word = re.compile(rf"(?<![\d.]){re.escape(answer)}(?![\d.]*\d)")
        assert word.search(normal), answer
        assert not word.search(hidden), answer


@pytest.mark.parametrize("k1", [-0.2, 0.2])
def test_the_kind_of_distortion_is_not_told(k1):
    quiz = [
        render("distorted_grid", {"k1": k1, "extent": 0.5}, quiz=True, lang=lang).alt
        for lang in ("en", "bn")
    ]
    other = [
        render("distorted_grid", {"k1": -k1, "extent": 0.5}, quiz=True, lang=lang).alt
        for lang in ("en", "bn")
    ]
    assert quiz == other


def test_order_of_edits_is_not_told():
    values = {"a": 0.5, "b": 0.3, "delta": 90}
    texts = {
        render("hsv_edits", {**values, "order": i}, quiz=True, lang="en").alt for i in range(24)
    }
    pictures = {
        render("hsv_edits", {**values, "order": i}, quiz=True, lang="en").svg for i in range(24)
    }
    assert (len(texts), len(pictures)) == (1, 24)


@pytest.mark.parametrize(("name", "quiz"), BOTH)
def test_alt_texts_hold_the_same_numbers(name, quiz):
    english, bangla = (
        render(name, REFERENCE[name], quiz=quiz, lang=lang).alt for lang in ("en", "bn")
    )
    assert sorted(NUMBER.findall(english)) == sorted(NUMBER.findall(bangla))
    assert re.search("[\u0985-\u09b9]", bangla)
    assert not re.search("[\u0980-\u09ff{}]", english)
    assert not re.search("[{}০-৯]", bangla)


def test_alt_texts_of_all_draws_hold_the_same_numbers():
    for name, values in draws():
        full = complete(name, module(name).PARAMETERS, values)
        alt = module(name).alt
        for quiz in (False, True):
            texts = [alt(full, lang, quiz=quiz) for lang in ("en", "bn")]
            found = [sorted(NUMBER.findall(text)) for text in texts]
            assert found[0] == found[1], texts
            assert "nan" not in texts[0]


class _Recorder(pens.Pen):
    """A pen that keeps the boxes of its labels."""

    made: ClassVar[list[_Recorder]] = []

    def __init__(self, *args, **named):
        super().__init__(*args, **named)
        self.boxes = []
        self.made.append(self)

    def label(self, at, text, anchor="c", size=pens.LABEL):
        super().label(at, text, anchor, size)
        points, _, width = outline(text)
        shift = {"c": 0.5, "l": 0, "r": 1}[anchor] * width * size
        x = [at[0] - shift + size * point[0] for point in points]
        y = [at[1] - 0.33 * size + size * point[1] for point in points]
        self.boxes.append((text, size, min(x), min(y), max(x), max(y)))


@pytest.fixture
def drawn(monkeypatch):
    for name in FIGURES:
        monkeypatch.setattr(module(name), "Pen", _Recorder)

    def draw(name, values, *, quiz):
        _Recorder.made.clear()
        module(name).draw(Canvas(), complete(name, module(name).PARAMETERS, values), quiz=quiz)
        return _Recorder.made[0]

    return draw


def test_labels_are_inside_apart_and_large_enough(drawn):
    for name, values in draws():
        for quiz in (False, True):
            pen = drawn(name, values, quiz=quiz)
            for text, size, left, low, right, top in pen.boxes:
                assert 0 < left < right < pen.width, (name, values, text)
                assert 0 < low < top < pen.height, (name, values, text)
                assert size * (SUBSCRIPT if "_" in text else 1) >= 7, (name, text)
            for one, other in itertools.combinations(pen.boxes, 2):
                apart = (
                    one[2] >= other[4]
                    or other[2] >= one[4]
                    or one[3] >= other[5]
                    or other[3] >= one[5]
                )
                assert apart, (name, values, one[0], other[0])


def test_no_line_is_thinner_than_print_can_hold(drawn):
    for name, values in REFERENCE.items():
        widths = {style.width for _, style in drawn(name, values, quiz=False).paths}
        assert min(width for width in widths if width) >= 0.6


@pytest.mark.parametrize(
    ("name", "values", "lang", "message"),
    [
        ("pinhol", {}, "en", "unknown figure 'pinhol'"),
        ("pinhole", {"f": 2, "p_z": 3}, "en", "missing parameter 'p_y'"),
        ("pinhole", {"f": 2, "p_z": 3, "p_y": 1, "q": 1}, "en", "unknown parameter 'q'"),
        ("pinhole", {"f": 2, "p_z": 0, "p_y": 1}, "en", "p_z = 0"),
        ("pinhole", {"f": 2, "p_z": 2, "p_y": 1}, "en", "p_z must not be f"),
        ("pinhole", {"f": 2, "p_z": float("nan"), "p_y": 1}, "en", "p_z = nan"),
        ("pinhole", {"f": 2, "p_z": float("inf"), "p_y": 1}, "en", "p_z = inf"),
        ("pinhole", {"f": 2, "p_z": "3", "p_y": 1}, "en", "'3' is not a number"),
        ("pinhole", {"f": 2, "p_z": 3, "p_y": 1}, "xx", "'xx'"),
        ("bayer", {"x": 4}, "en", "outside the tile"),
        ("bayer", {"channel": 3}, "en", "is B itself"),
        ("bayer", {"phase": 0.5}, "en", "not whole"),
        ("distorted_grid", {"k1": -60}, "en", "folds over"),
        ("distorted_grid", {"k1": -2, "c_x": 0.8}, "en", "folds over|outside"),
        ("gaussian", {"sigma": 1, "sigma2": 2, "k": 1}, "en", "single curve"),
        ("thin_lens", {"f": 0, "z": 1}, "en", "f = 0"),
        ("luminosity", {"m_1": 500, "m_2": 502}, "en", "5 nm apart"),
        ("depth_of_field", {"f": 200, "s": 0.3}, "en", "exceed 2 f"),
        ("depth_of_field", {"N_1": 4, "N_2": 4}, "en", "must differ"),
        ("normalisation", {"low": 9, "high": 9}, "en", "larger than low"),
    ],
)
def test_bad_values_get_one_line(name, values, lang, message):
    with pytest.raises(BankError, match=message) as caught:
        render(name, values, quiz=False, lang=lang)
    assert "\n" not in str(caught.value)


def test_same_figure_is_drawn_once():
    one = render("pinhole", {"f": 2, "p_z": 3, "p_y": 5}, quiz=True, lang="en")
    assert render("pinhole", {"p_y": 5.0, "f": 2.0, "p_z": 3.0}, quiz=True, lang="en") is one


@pytest.mark.parametrize("name", FIGURES)
def test_every_parameter_is_documented(name):
    text = (HERE.parents[1] / "docs/figures.md").read_text(encoding="utf-8")
    row = next(line for line in text.splitlines() if line.startswith(f"| `{name}`"))
    for parameter in module(name).PARAMETERS:
        shown = parameter if not re.fullmatch(r"v\d\d", parameter) else "v00"
        assert f"`{shown}`" in row, parameter
