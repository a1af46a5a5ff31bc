"""The page: its numbers are what was measured, and are what an independent script finds."""

from __future__ import annotations

import json
import math
import re
import xml.etree.ElementTree as ET

import numpy as np
import printed_by_hand
import pytest
from click.testing import CliRunner
from sweep import together

from quizgen.cli.tradeoff import tradeoff
from quizgen.locale import list_languages
from quizgen.tradeoff import page
from quizgen.tradeoff.formulas import BY_NAME, FORMULAS
from quizgen.tradeoff.page import (
    pieces,
    render_tradeoff_fragment,
    short,
    time_text,
    whole_page,
    write_page,
)
from quizgen.tradeoff.questions import load_recorded_counts
from quizgen.tradeoff.texts import words

SHOWN = [formula.name for formula in FORMULAS if formula.shown]


@pytest.fixture(scope="module")
def english(report):
    return render_tradeoff_fragment(report, "quizgen tradeoff", "en")


def rival(report, formula, name):
    match = next(match for match in report.matches if match.formula == formula)
    return next(one for one in match.rivals if one.name == name)


def test_the_sentence_on_exams_is_what_python_and_mpmath_find(english):
    rng = np.random.default_rng(77)  # other exams than those of the page
    worst = []
    for formula in FORMULAS:
        rows = zip(*(np.asarray(column).tolist() for column in formula.exam(rng, 100)), strict=True)
        worst.append(int(min(printed_by_hand.printed_digits(formula.name, row) for row in rows)))
    first, second, *_ = sorted(worst)
    kept, left = re.search(
        r"In an exam 13 of 14 printed formulas keep (\d+) digits or more.* and keeps (\d+)\.",
        english,
    ).groups()
    assert abs(int(kept) - second) <= 1
    assert abs(int(left) - first) <= 1


def test_the_sentence_on_questions_is_what_was_counted(english):
    counted = load_recorded_counts()
    wrong = counted.wrong["rounded"]
    assert (
        f"would have got {sum(wrong.values())} of 10\u202f000 questions wrong, "
        f"all from {len(wrong)} of {counted.templates} templates."
    ) in english
    for system in ("float64", "balls"):
        hit = counted.wrong[system]
        assert f"<td>{sum(hit.values())} ({len(hit)})</td>" in english


def test_a_question_costs_what_was_measured(english, report):
    cost = report.questions.costs["exact"]
    assert f"Exactness costs a question {time_text(cost.more)}, ×\xa0" in english
    assert report.questions.costs["float64"].seconds < cost.seconds


def newton(r_d, k1):
    r = r_d
    for _ in range(4):
        r -= (r * (1 + k1 * r * r) - r_d) / (1 + 3 * k1 * r * r)
    return r


def test_digits_of_arrays_are_those_of_python_loops(report):
    rng = np.random.default_rng(78)
    rows = list(
        zip(*(c.tolist() for c in BY_NAME["inverse-distortion"].exam(rng, 60)), strict=True)
    )
    right = [printed_by_hand.truth("inverse-distortion", row) for row in rows]
    for name, compute in (
        ("newton", newton),
        ("fixed-point", printed_by_hand.undistort_in_five_steps),
    ):
        found = min(
            printed_by_hand.digits_of("", compute(*row), r)
            for row, r in zip(rows, right, strict=True)
        )
        assert rival(report, "inverse-distortion", name).exam == pytest.approx(found, abs=1)
    assert rival(report, "inverse-distortion", "quizgen").hard > 15
    assert rival(report, "inverse-distortion", "newton").hard < 3
    assert rival(report, "vignetting", "line").hard > 15
    assert rival(report, "vignetting", "printed").hard < 2
    assert 6 < rival(report, "hue", "OpenCV cvtColor, float32").exam < 9


def test_every_way_of_a_match_is_timed_and_named(report):
    names = words("en")["way"]
    for match in report.matches:
        assert match.rivals[0].name in names
        for one in match.rivals:
            assert 0 < one.time.least <= one.time.median
            assert one.name in names or " " in one.name  # a library is called by its own name


@pytest.mark.slow
def test_opencv_is_faster_at_hues_and_newton_at_undistorting(report):
    """What the page says; by ratios within one run, with room for a busy machine."""
    pytest.importorskip("cv2")
    fast, line = (rival(report, "hue", name) for name in ("OpenCV cvtColor, float32", "printed"))
    assert fast.time.least < line.time.least / 2
    quick, sure = (rival(report, "inverse-distortion", name) for name in ("newton", "quizgen"))
    assert quick.time.least < sure.time.least / 2


@pytest.mark.slow
def test_one_value_takes_an_array_function_longer_than_a_question(report):
    exact = report.questions.costs["exact"].seconds
    assert all(one.least > exact for one in report.questions.alone)


def read(parts):
    """A number of the slider, as a program reads it."""
    text = "".join(parts).replace("·10", "e")
    return float(text.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")))


def test_the_slider_shows_right_values_and_strikes_out_wrong_digits(report):
    shown = {one["name"]: one for one in page.describe_formulas(report, "en")}
    assert list(shown) == SHOWN
    for name, one in shown.items():
        formula = BY_NAME[name]
        columns = [np.asarray(c, float) for c in formula.path(formula.places(len(one["places"])))]
        rows = zip(*(column.tolist() for column in columns), strict=True)
        for row, (_, _, exact, printed, _, _) in zip(rows, one["places"], strict=True):
            right = printed_by_hand.truth(name, row)
            assert read(exact) == pytest.approx(float(right), rel=1e-15)
            kept, _, power = printed
            if len(kept) > 3:  # what is not struck out is right, to two units of its last digit
                last = 2 * 10.0 ** (2 - len(kept.lstrip("-"))) * read(("1", "", power))
                off = abs(read((kept, "", power)) - right)
                assert off <= last + 1e-15 * abs(right), (name, row, printed)


def test_the_slider_says_how_far_an_exam_goes(report):
    for one in page.describe_formulas(report, "en"):
        said = [place[1] for place in one["places"]]
        assert said == sorted(said)  # "An exam ..." before "No exam ..."
        assert {said[0], said[-1]} == {"An exam goes this far.", "No exam goes this far."}


@together(
    ("value", "right", "written"),
    [
        (0.5, 17, ("5.0000000000000000", "", "·10⁻¹")),
        (-1.25, 3, ("-1.25", "00000000000000", "")),
        (3.0, 1, ("3", ".0000000000000000", "")),
        (6e-16, 0, ("", "5.9999999999999999", "·10⁻¹⁶")),
        (0.0, 0, ("", "0", "")),
        (math.nan, 0, ("", "", "–")),
    ],
)
def test_right_digits_stand_apart_from_wrong_ones(value, right, written):
    assert pieces(value, right) == written


def test_numbers_are_written_for_people():
    assert [short(x) for x in (4.25, 0.003, 3.2e-7, 1e18)] == [
        "4.25",
        "0.003",
        "3.2·10⁻⁷",
        "1.0·10¹⁸",
    ]
    assert [time_text(x) for x in (3e-9, 4.44e-6, 0.123)] == ["3\xa0ns", "4.4\xa0µs", "120\xa0ms"]


def test_german_numbers_have_a_comma(report):
    german = render_tradeoff_fragment(report, "quizgen tradeoff", "de")
    assert "84,375 wird 84,37" in german
    assert re.findall(r">[^<]*\d\.\d+ (?:µs|ns)", german) == []


def shape(told):
    return (
        {key: shape(value) for key, value in told.items()} if isinstance(told, dict) else type(told)
    )


def test_words_are_complete_in_every_language():
    shapes = [shape(words(lang)) for lang in list_languages()]
    assert len(shapes) >= 3
    assert all(one == shapes[0] for one in shapes)
    assert {name for name, said in words("en")["formula"].items() if "lesson" in said} == set(SHOWN)


def test_the_page_is_one_file_that_asks_for_nothing(report):
    made = whole_page(report, "quizgen tradeoff")
    assert made.count("<svg") == len(list_languages())
    assert re.findall(r"(?:src|href)=\"|url\((?!data:)|@import", made) == []


def test_page_plot_and_numbers_are_written(report, tmp_path):
    write_page(report, tmp_path, "quizgen tradeoff")
    svg = ET.parse(tmp_path / "digits.svg").getroot()
    assert len(svg.findall("{http://www.w3.org/2000/svg}path")) > 14
    data = json.loads((tmp_path / "tradeoff.json").read_text("utf-8"))
    assert data["questions"]["counted"]["drawn"] == 10_000
    assert len(data["sweeps"]) == 14


def test_the_command_says_where_the_page_is(report, tmp_path, monkeypatch):
    monkeypatch.setattr("quizgen.tradeoff.report.measure_tradeoff", lambda _bank: report)
    done = CliRunner().invoke(tradeoff, ["--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert done.output.startswith(f"{tmp_path / 'tradeoff.html'}: ")
    assert (tmp_path / "tradeoff.html").exists()
