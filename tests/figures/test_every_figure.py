"""Every built-in figure: bytes, markup, words, hidden answers, legibility, errors, snapshots."""

from __future__ import annotations

import hashlib
import itertools
import json
import multiprocessing
import os
import re
import subprocess
import sys
import threading
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from xml.etree import ElementTree as ET

import html5lib
import pytest
from figure_cases import FIGURES, HIDDEN, REFERENCE, draw, draws, module
from svg_reader import SVG, read_labels
from sweep import together

from quizgen import figures
from quizgen.bank.bank import builtin_bank
from quizgen.core.errors import BankError
from quizgen.figures import describe_figure, engine
from quizgen.figures.alt_text import strip_mathtext
from quizgen.locale import list_languages

BOTH = list(itertools.product(FIGURES, (True, False)))
NUMBER = re.compile(r"\d+(?:\.\d+)?")
HERE = Path(__file__).parent
SMALLEST = 7.0
"""Points of the smallest letters that a printed paper can hold."""
THINNEST = 0.4
"""Points of the thinnest line."""
TOUCH = 0.5
"""Points that boxes of labels may overlap by: they are drawn generously."""


def test_every_figure_has_a_reference_and_knows_what_it_hides():
    assert set(FIGURES) == set(REFERENCE) == set(HIDDEN)


# Bytes


def digest(name, *, quiz, lang="en"):
    return hashlib.sha256(draw(name, REFERENCE[name], quiz=quiz, lang=lang).inline_svg).hexdigest()


def digests(names):
    """Digests of reference figures, drawn by this process and not found among what is kept."""
    figures._draw_items.cache_clear()
    return [digest(name, quiz=quiz) for name in names for quiz in (True, False)]


CODE = """
import json, os, sys
sys.path[:0] = sys.argv[1], os.path.dirname(sys.argv[1])
from test_every_figure import digests
print(json.dumps(digests(sys.argv[2].split(","))))
"""
HOSTILE = """
figure.dpi: 300
lines.linewidth: 7
lines.scale_dashes: True
path.sketch: 3, 100, 2
font.family: monospace
mathtext.fontset: cm
axes.prop_cycle: cycler(color=['k'])
image.cmap: jet
patch.linewidth: 5
"""


def in_another_process(folder, names, **environment):
    folder.mkdir()
    done = subprocess.run(
        [sys.executable, "-c", CODE, str(HERE), ",".join(names)],
        env={"PATH": "", "HOME": str(folder), "XDG_CACHE_HOME": str(folder), **environment},
        cwd=HERE.parents[1], check=True, capture_output=True, text=True,
    )  # fmt: skip
    return json.loads(done.stdout)


@pytest.mark.slow
def test_bytes_are_equal_in_every_process(tmp_path, empty_cache):
    rc = tmp_path / "matplotlibrc"
    rc.write_text(HOSTILE)
    here = digests(FIGURES)
    usual = in_another_process(tmp_path / "usual", FIGURES, PYTHONHASHSEED="0")
    hostile = in_another_process(
        tmp_path / "hostile", FIGURES, PYTHONHASHSEED="4711", LC_ALL="C", MATPLOTLIBRC=str(rc)
    )
    assert here == usual == hostile
    assert len(set(here)) > len(FIGURES)


FEW = ("thin_lens", "gaussian", "hsv_edits", "luminosity")
"""A sketch, a plot, pictures, and a plot with a picture."""


@pytest.fixture
def nothing_kept(monkeypatch):
    """All is drawn: neither found in the cache, nor put there."""
    monkeypatch.setattr(engine, "read_cached", lambda *_: None)
    monkeypatch.setattr(engine, "write_cached", lambda *_: None)


def test_sixteen_threads_draw_what_one_does(nothing_kept, monkeypatch):
    jobs = [(name, quiz) for name in FEW for quiz in (True, False)] * 3
    alone = [digest(name, quiz=quiz) for name, quiz in jobs]
    drawn = figures._draw_items.__wrapped__  # the cache would draw each once
    monkeypatch.setattr(figures, "_draw_items", drawn)
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        with ThreadPoolExecutor(16) as threads:
            together = threads.map(lambda job: digest(job[0], quiz=job[1]), jobs)
            assert list(together) == alone
    finally:
        sys.setswitchinterval(before)


def _draw_few():
    return digests(FEW)


@pytest.mark.parametrize(
    "way",
    [
        "fork",
        pytest.param("spawn", marks=pytest.mark.slow),
        pytest.param("forkserver", marks=pytest.mark.slow),
    ],
)
def test_four_workers_draw_what_one_process_does(nothing_kept, way, monkeypatch):
    if way not in multiprocessing.get_all_start_methods():
        pytest.skip(f"this system starts no process by {way}")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(HERE), str(HERE.parents[1])]))
    expected = _draw_few()
    with ProcessPoolExecutor(4, mp_context=multiprocessing.get_context(way)) as workers:
        done = [workers.submit(_draw_few) for _ in range(4)]
        assert [one.result(timeout=120) for one in done] == [expected] * 4


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_a_worker_that_is_forked_while_a_thread_draws_does_not_hang(nothing_kept):
    expected, stop = _draw_few(), threading.Event()

    def keep_drawing():
        while not stop.is_set():
            digests(FEW[:1])

    thread = threading.Thread(target=keep_drawing)
    thread.start()
    try:
        context = multiprocessing.get_context("fork")
        for _ in range(3):
            answers = context.SimpleQueue()
            worker = context.Process(target=lambda q=answers: q.put(_draw_few()))
            worker.start()
            worker.join(60)
            assert worker.exitcode == 0
            assert answers.get() == expected
    finally:
        stop.set()
        thread.join()


@pytest.mark.parametrize("name", FIGURES)
def test_the_drawing_is_the_kept_one(snapshots, name):
    """As its solution shows it, an element a line: on every machine the same."""
    figure = draw(name, REFERENCE[name], quiz=False, lang="en")
    text = re.sub(r"(?<=>)(?=<)", "\n", figure.inline_svg.decode()) + "\n"
    snapshots.check(f"figures/{name}.svg", text)


def test_there_is_no_kept_drawing_without_a_figure(snapshots):
    snapshots.check_names("figures", (f"{name}.svg" for name in FIGURES))


# Markup


@together(("name", "quiz"), BOTH)
def test_svg_stands_inside_html(name, quiz):
    figure = draw(name, REFERENCE[name], quiz=quiz, lang="bn")
    text = figure.inline_svg.decode()
    html5lib.HTMLParser(strict=True).parse(f"<!DOCTYPE html><title>x</title>{text}")
    root = ET.fromstring(text)
    assert text.startswith("<svg ")
    assert (root.get("role"), root.get("lang")) == ("img", "bn")
    assert root[0].tag == f"{SVG}title"
    told = " ".join(one.text for one in root if one.tag in (f"{SVG}title", f"{SVG}desc"))
    assert told.split() == figure.alt.split()
    ids = re.findall(r'\bid="([^"]*)"', text)
    assert len(ids) == len(set(ids))
    plain = re.sub(r'href="data:image/png;base64,[^"]*"', "", text)
    assert not re.search(r"<style|<script|<text|<!--|<metadata|http(?!://www\.w3\.org/)", plain)
    assert b"var(" not in figure.standalone_svg
    assert b"currentColor" not in figure.standalone_svg


@together("name", FIGURES)
def test_a_figure_fits_a_column_and_a_page(name):
    figure = draw(name, REFERENCE[name])
    assert figure.width_pt <= 420
    assert figure.height_pt <= 420
    assert len(figure.inline_svg) < 120_000


def test_what_holds_a_picture_is_a_photograph_unless_it_is_painted():
    shown = {name for name in FIGURES if b"<image" in draw(name, REFERENCE[name]).inline_svg}
    assert builtin_bank().metadata.photographs <= shown


# Words, and what a quiz hides


def labels(figure):
    return "\n".join(read_labels(figure))


@together("name", FIGURES)
def test_quiz_hides_the_answer(name):
    values = REFERENCE[name]
    solved, asked = (draw(name, values, quiz=quiz) for quiz in (False, True))
    normal = labels(solved) + solved.alt
    hidden = labels(asked) + "".join(
        describe_figure(module(name), values, quiz=True, lang=lang) for lang in ("en", "bn")
    )
    for answer in HIDDEN[name]:
        word = re.compile(rf"(?<![\d.]){re.escape(answer)}(?![\d.]*\d)")
        assert word.search(normal), answer
        assert not word.search(hidden), answer


@together("name", FIGURES)
def test_a_quiz_and_its_solution_differ_where_something_is_asked(name):
    asked, solved = (draw(name, REFERENCE[name], quiz=quiz) for quiz in (True, False))
    assert (asked != solved) == bool(HIDDEN[name])
    assert (asked.alt != solved.alt) == bool(HIDDEN[name])


@pytest.mark.parametrize("k1", [-0.2, 0.2])
def test_the_kind_of_distortion_is_not_told(k1):
    told = [
        [describe_figure(module("distorted_grid"), {"k1": sign * k1, "extent": 0.5},
                         quiz=True, lang=lang) for lang in ("en", "bn")]
        for sign in (1, -1)
    ]  # fmt: skip
    assert told[0] == told[1]


def test_the_order_of_edits_is_not_told():
    values = {"a": 0.5, "b": 0.3, "delta": 90}
    drawn = [draw("hsv_edits", {**values, "order": order}, quiz=True) for order in range(24)]
    assert len({figure.alt for figure in drawn}) == 1
    assert len({figure.inline_svg for figure in drawn}) == 24


def described(name, values, quiz):
    return {
        lang: describe_figure(module(name), values, quiz=quiz, lang=lang)
        for lang in list_languages()
    }


def numbers(texts):
    """Numbers in each language, written with a point."""
    plain = {lang: text if lang != "de" else re.sub(r"(?<=\d),(?=\d)", ".", text)
             for lang, text in texts.items()}  # fmt: skip
    return [sorted(NUMBER.findall(text)) for text in plain.values()]


@together(("name", "quiz"), BOTH)
def test_alt_texts_hold_the_same_numbers(name, quiz):
    texts = described(name, REFERENCE[name], quiz)
    first, *others = numbers(texts)
    assert all(other == first for other in others), texts
    assert {"en", "bn", "de"} <= set(texts)
    assert re.search("[\u0985-\u09b9]", texts["bn"])
    assert not re.search("[\u0980-\u09ff{}$]", texts["en"] + texts["de"])
    assert not re.search("[{}$০-৯]", texts["bn"])
    assert texts["de"] != texts["en"]


def test_alt_texts_of_all_draws_hold_the_same_numbers():
    for name, values in draws():
        for quiz in (False, True):
            texts = described(name, values, quiz)
            first, *others = numbers(texts)
            assert all(other == first for other in others), (name, values, texts)
            assert "nan" not in texts["en"]


# Legibility


def overlap(one, other):
    wide = min(one.right, other.right) - max(one.left, other.left)
    high = min(one.bottom, other.bottom) - max(one.top, other.top)
    return wide > TOUCH and high > TOUCH


def illegible(name, values, quiz):
    """What nobody could read in a figure."""
    figure = draw(name, values, quiz=quiz)
    (left, top), (wide, high) = figure.origin_pt, (figure.width_pt, figure.height_pt)
    for label in figure.labels:
        if label.size < SMALLEST:
            yield f"{label.text!r} has {label.size:.1f} pt"
        if not (left <= label.left and label.right <= left + wide
                and top <= label.top and label.bottom <= top + high):  # fmt: skip
            yield f"{label.text!r} is cut off"
    for one, other in itertools.combinations(figure.labels, 2):
        if overlap(one, other):
            yield f"{one.text!r} and {other.text!r} overlap"
    if figure.outside:
        yield f"{figure.outside} markers are outside"


CASES = [*REFERENCE.items(), *draws()]


def check_labels(cases):
    wrong = [
        (name, values, quiz, what)
        for name, values in cases
        for quiz in (False, True)
        for what in illegible(name, values, quiz)
    ]
    assert wrong == []


def test_labels_are_inside_apart_and_large_enough():
    check_labels(CASES[::5])


@pytest.mark.slow
@pytest.mark.parametrize("fifth", range(1, 5))
def test_labels_of_all_draws_are_inside_apart_and_large_enough(fifth):
    check_labels(CASES[fifth::5])


@together("name", FIGURES)
def test_no_line_is_thinner_than_print_can_hold(name):
    for quiz in (False, True):
        svg = draw(name, REFERENCE[name], quiz=quiz).inline_svg.decode()
        widths = {float(width) for width in re.findall(r'stroke-width="([^"]*)"', svg)}
        assert min(widths, default=1) >= THINNEST


def test_labels_are_told_as_they_are_read():
    assert strip_mathtext(r"$\lambda$ = 550 nm") == "λ = 550 nm"


# Errors


@together(
    ("name", "values", "message"),
    [
        ("pinhol", {}, "unknown figure 'pinhol'"),
        ("pinhole", {"f": 2, "p_z": 3}, "missing parameter 'p_y'"),
        ("pinhole", {"f": 2, "p_z": 3, "p_y": 1, "q": 1}, "unknown parameter 'q'"),
        ("pinhole", {"f": 2, "p_z": 0, "p_y": 1}, "p_z = 0"),
        ("pinhole", {"f": 2, "p_z": 2, "p_y": 1}, "p_z must not be f"),
        ("pinhole", {"f": 2, "p_z": float("nan"), "p_y": 1}, "p_z = nan"),
        ("pinhole", {"f": 2, "p_z": "3", "p_y": 1}, "'3' is not a number"),
        ("bayer", {"x": 4}, "outside the tile"),
        ("bayer", {"channel": 3}, "is B itself"),
        ("bayer", {"phase": 0.5}, "not whole"),
        ("distorted_grid", {"k1": -60}, "folds over"),
        ("distorted_grid", {"k1": -2, "c_x": 0.8}, "folds over|outside"),
        ("gaussian", {"sigma": 1, "sigma2": 2, "k": 1}, "single curve"),
        ("thin_lens", {"f": 0, "z": 1}, "f = 0"),
        ("luminosity", {"m_1": 500, "m_2": 502}, "5 nm apart"),
        ("depth_of_field", {"f": 200, "s": 0.3}, "exceed 2 f"),
        ("depth_of_field", {"N_1": 4, "N_2": 4}, "must differ"),
        ("normalisation", {"low": 9, "high": 9}, "larger than low"),
    ],
)
def test_bad_values_get_one_line(name, values, message):
    with pytest.raises(BankError, match=message) as caught:
        draw(name, values)
    assert "\n" not in str(caught.value)


def test_the_same_figure_is_drawn_once():
    one = draw("pinhole", {"f": 2, "p_z": 3, "p_y": 5}, quiz=True)
    assert draw("pinhole", {"p_y": 5.0, "f": 2.0, "p_z": 3.0}, quiz=True) is one


# What is loaded


def loaded(code):
    done = subprocess.run([sys.executable, "-c", f"import sys\n{code}\nprint(*sys.modules)"],
                          cwd=HERE.parents[1], check=True, capture_output=True, text=True)  # fmt: skip
    return set(done.stdout.split())


QUESTION = """
from quizgen import builtin_bank
from quizgen.question.compose import draw_instance
from quizgen.question.figure import describe_question_figure, draw_question_figure
bank = builtin_bank()
name = next(n for n in bank.template_paths if bank.rules(n).figure and bank.rules(n).figure.name == "noise")
drawn = draw_instance(bank.template(name), 1)
describe_question_figure(drawn, "en", quiz=True)
"""


@pytest.mark.slow
def test_the_first_figure_of_a_question_loads_matplotlib_and_its_words_do_not():
    assert not {"matplotlib", "PIL"} & loaded(QUESTION)
    drawing = loaded(f'{QUESTION}\ndraw_question_figure(drawn, "en", quiz=True)')
    assert {"matplotlib", "quizgen.figures.engine"} <= drawing
    assert not {"matplotlib.pyplot", "PIL.ImageShow", "tkinter"} & drawing


def test_nothing_heavy_is_imported_before_the_first_figure():
    code = "from quizgen import builtin_bank\nlist(builtin_bank())"
    assert not {"matplotlib", "numpy", "PIL"} & loaded(code)
