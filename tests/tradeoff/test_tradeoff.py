"""The demonstration stays true: textbook forms fail, stable ones do not, oracles agree."""

from __future__ import annotations

import csv
import json
import math
import xml.etree.ElementTree as ET
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from click.testing import CliRunner

from quizgen.cli.tradeoff import tradeoff
from quizgen.locale import languages
from quizgen.maths.systems import arrays, compile_expr, multiprecision, symbolic
from quizgen.tradeoff import ladder, measure, report
from quizgen.tradeoff.data import words
from quizgen.tradeoff.digits import digits
from quizgen.tradeoff.families import BY_NAME, FAMILIES
from quizgen.tradeoff.knobs import KNOBS, coverage
from quizgen.tradeoff.measure import QUICK, Bench, bits_of, pareto, spread, steps
from quizgen.tradeoff.peers import peers

SAFE = {"hue"}
"""Families whose printed formula is safe in float64 (the page says so)."""

DECIMAL = {"pixel"}
"""Families whose digits only numbers that are read as decimals have: arrays take the formula."""

PROVEN = {"exact", "arb"}


@pytest.fixture(scope="module")
def measured():
    effort = replace(QUICK, slow=True)
    return {family.name: {m.key: m for m in Bench(family, effort).run()} for family in FAMILIES}


@pytest.mark.parametrize("name", sorted(BY_NAME.keys() - DECIMAL))
def test_stable_rung_holds(measured, name):
    stable = measured[name]["stable"]
    assert stable.exam.max_steps <= 4
    assert stable.hard.max_steps <= 4


@pytest.mark.parametrize("name", DECIMAL)
def test_arrays_of_decimals_are_no_better_than_the_textbook(measured, name):
    rungs = measured[name]
    assert rungs["stable"].hard.digits <= 8
    assert rungs["exact"].hard.digits > 16


@pytest.mark.parametrize("name", [name for name in BY_NAME if name not in SAFE])
def test_textbook_rung_fails_where_the_page_says_so(measured, name):
    rung = measured[name]["float64"]
    assert rung.hard.max_steps > 1e9
    assert measured[name]["float32"].hard.lost > 0.5


@pytest.mark.parametrize("name", SAFE)
def test_safe_family_is_safe_in_float64_and_not_in_float32(measured, name):
    assert measured[name]["float64"].hard.max_steps <= 4
    assert math.isinf(measured[name]["float32"].hard.max_steps)


@pytest.mark.parametrize("name", list(BY_NAME))
def test_proven_rungs_are_correctly_rounded(measured, name):
    rungs = [measured[name][key] for key in PROVEN & set(measured[name])]
    assert rungs
    for rung in rungs:
        assert rung.exam.max_steps == rung.hard.max_steps == 0


@pytest.mark.parametrize("name", list(BY_NAME))
def test_many_digits_are_right_to_the_last_double(measured, name):
    for key in ("mpmath", "sympy"):
        assert measured[name][key].exam.max_steps <= 1


def test_a_quick_look_loads_nothing_slow():
    for family in FAMILIES:
        assert "sympy" not in {rung.key for rung in ladder.rungs(family, slow=False)}
    assert peers("poisson").keys() - peers("poisson", slow=False).keys() == {
        "SciPy stats.poisson.pmf"
    }


@pytest.mark.parametrize(("patience", "passes"), [(math.inf, 4), (-1, 1)])
def test_inputs_are_timed_one_by_one_until_it_takes_long(monkeypatch, patience, passes):
    monkeypatch.setattr(measure, "PATIENCE", patience)
    tried = []
    found, results = measure.timed_each(lambda one: tried.append(one) or -one, [1, 2, 3], 4)
    assert (tried, results) == ([1, 2, 3] * passes, [-1, -2, -3])
    assert found.low <= found.median <= found.high


@pytest.mark.slow
def test_ladder_of_a_question_costs_less_than_a_millisecond(measured):
    for rungs in measured.values():
        assert sum(rungs[key].nanoseconds for key in PROVEN & set(rungs)) < 1e6


def test_disagreeing_oracles_are_an_error(monkeypatch):
    family = BY_NAME["thin-lens"]
    first, second = ladder.oracles(family)
    with mp.workdps(80):
        slip = 1 + mp.mpf(2) ** -60  # in the 19th digit
        monkeypatch.setattr(ladder, "oracles", lambda _: (first, lambda row: second(row) * slip))
    with pytest.raises(ladder.OraclesDisagree, match="thin-lens"):
        ladder.truths(family, [(50.0, 60.0)])


def test_truth_of_the_lens_is_the_printed_one():
    z = math.nextafter(50, 60)
    assert ladder.truths(BY_NAME["thin-lens"], [(50.0, z)]) == [351843720888320050.0]


@pytest.mark.parametrize(
    ("value", "truth", "count"),
    [
        (1.0, 1.0, 0),
        (-0.0, 0.0, 0),
        (math.nextafter(1, 2), 1.0, 1),
        (5e-324, -5e-324, 2),
        (math.inf, 1.7976931348623157e308, 1),
        (math.nan, 1.0, math.inf),
    ],
)
def test_steps_between_doubles(value, truth, count):
    assert steps(value, truth) == count


@pytest.mark.parametrize(
    ("value", "truth", "count"),
    [
        (2.0, 2.0, 17),
        (1.001, 1.0, 3),
        (0.0, 3.0, 0),
        (5.0, 1.0, 0),
        (1e-300, 0.0, 0),
        (math.nan, 1.0, 0),
        (math.inf, 1.0, 0),
        (math.inf, math.inf, 17),
    ],
)
def test_correct_decimal_digits(value, truth, count):
    assert round(digits(value, truth), 6) == count


def test_a_double_beside_the_right_one_keeps_fifteen_digits():
    assert 15 < digits(math.nextafter(1, 2), 1.0) < 16


def test_digits_of_an_angle_are_those_of_the_turn():
    assert digits(359.64, 0.0, 360.0) == pytest.approx(3)  # 0.36 of 360
    assert digits(360.0, 0.0, 360.0) == 17


def test_the_spread_is_median_and_quartiles():
    found = spread([5.0, 1.0, 4.0, 2.0, 3.0])
    assert (found.low, found.median, found.high) == (2.0, 3.0, 4.0)
    assert found.per(2).median == 1.5


@pytest.mark.parametrize("name", [name for name, family in BY_NAME.items() if family.one_line])
def test_a_plain_line_is_as_accurate_as_a_function_could_be(measured, name):
    assert measured[name]["stable"].hard.digits >= 15


EXTREME = [
    ("stops", (1e-300, 1e7)), ("stops", (1e300, 1e-7)), ("stops", (5e-324, 1e-20)),
    ("stops", (1.0, 1e-20)), ("stops", (1e-300, 1.0000001e-300)), ("stops", (22.0, 22.0)),
    ("vignetting", (1e200, 50.0)), ("vignetting", (1e160, 1e160)), ("vignetting", (1e-170, 1e-170)),
    ("vignetting", (1e-100, 50.0)), ("vignetting", (1.0, 1e-200)), ("vignetting", (0.0, 50.0)),
]  # fmt: skip


def in_many_digits(name, a, b):
    with mp.workdps(700):
        a, b = mp.mpf(a), mp.mpf(b)
        return 2 * mp.log(b / a, 2) if name == "stops" else 1 - (b * b / (a * a + b * b)) ** 2


@pytest.mark.parametrize(("name", "args"), EXTREME)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_plain_lines_hold_at_extremes_too(name, args):
    found = float(BY_NAME[name].stable(*(np.array([arg, arg]) for arg in args))[0])
    assert digits(found, float(in_many_digits(name, *args))) >= 15


def test_the_textbook_hue_is_the_known_one():
    import colorsys

    rgb = np.random.default_rng(4).integers(0, 256, (300, 3)) / 255
    rgb = rgb[np.ptp(rgb, axis=1) > 0]
    expected = [360 * colorsys.rgb_to_hsv(*one)[0] for one in rgb.tolist()]
    assert BY_NAME["hue"].printed(*rgb.T) == pytest.approx(expected)


def test_bits_are_herbies():
    assert [bits_of(count) for count in (0, 1, 3, math.inf)] == [0, 1, 2, 64]


def test_pareto_keeps_what_nothing_beats():
    assert pareto([(1, 9), (2, 5), (3, 7), (4, 5), (5, 0)]) == [0, 1, 4]


def test_every_field_computes_the_same():
    import sympy

    formula = BY_NAME["far-limit"].formula
    inputs = {"f": 50, "N": 8, "c": 0.03125, "s": 3000}
    expected = 3000 * 10000 / (10000 + 50 - 3000)
    array = compile_expr(formula, arrays(64))({k: np.float64(v) for k, v in inputs.items()})
    precise = compile_expr(formula, multiprecision())({k: mp.mpf(v) for k, v in inputs.items()})
    symbol = compile_expr(formula, symbolic())({k: sympy.Rational(v) for k, v in inputs.items()})
    for value in (array, precise, symbol):
        assert float(value) == pytest.approx(expected, rel=1e-12)


def test_coverage_is_the_area_under_an_edge():
    assert coverage(1.0, 1.0, 1.0) == 0.5
    assert coverage(1.0, 1.0, 0.5) == 0.125
    assert coverage(1.0, 2.0, 3.0) == 1.0


def test_work_precision_curves_fall():
    curves = {knob.key: list(knob.measure(QUICK)) for knob in KNOBS}
    kernel = [p.error for p in curves["kernel"][0].points]
    assert kernel == sorted(kernel, reverse=True)
    assert kernel[4] == pytest.approx(0.31, abs=0.06)  # three sigma
    inverse_z, in_z = curves["layers"]
    assert [round(p.error, -1) for p in inverse_z.points][:3] == [70, 30, 20]
    assert all(a.error < b.error for a, b in zip(inverse_z.points, in_z.points, strict=True))
    landscape, texture = curves["camera"]
    assert texture.label == "texture"
    single, double = landscape.points[:4], landscape.points[4:]
    for kind, points in (("float32", single), ("float64", double)):
        assert {point.precision for point in points} == {kind}
        assert [p.label for p in points] == ["=", "0.1", "0.5", "8"]  # 2 is as 0.5, 32 as 8
        for point in points[1:]:
            assert point.error <= float(point.label)
        assert points[0].note.startswith("defocus, motion blur, shot noise")
        assert points[-1].note == (
            "−defocus, −motion blur, −shot noise, −dark current, −full well, −read noise, "
            "−quantisation, gamma (table)"
        )
    assert double[0].error == 0 < single[0].error < 1
    normal = [p.error for p in curves["photons"][0].points]
    assert normal == sorted(normal, reverse=True)


def test_words_are_complete_in_every_language():
    shapes = []
    for lang in languages():
        text = words(lang)
        assert set(text["family"]) == set(BY_NAME)
        assert set(text["knob"]) == {knob.key for knob in KNOBS}
        shapes.append({key: sorted(value) for key, value in text.items()})
    assert len(shapes) >= 3
    assert all(shape == shapes[0] for shape in shapes)


def test_command_writes_page_plots_and_data(tmp_path):
    done = CliRunner().invoke(tradeoff, ["thin-lens", "--quick", "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert done.output.startswith(f"{tmp_path / 'tradeoff.html'}: 1 formula, ")
    page = (tmp_path / "tradeoff.html").read_text("utf-8")
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    assert "src=" not in page.replace("src:url(data:", "").replace("src=data:", "")
    panels = 2 * 2 + 1 + 1  # overview and family, twice each; the steps; the family along its input
    assert page.count("<svg") == panels * len(languages())
    data = json.loads((tmp_path / "tradeoff.json").read_text("utf-8"))
    assert [rung["key"] for rung in data["families"][0]["rungs"]][:3] == [
        "float32",
        "float64",
        "stable",
    ]
    assert data["date"]
    assert data["effort"]["repeats"] == 3
    for name in ("thin-lens", "thin-lens-input", "overview"):
        svg = ET.parse(tmp_path / f"{name}.svg").getroot()
        assert svg.find("{http://www.w3.org/2000/svg}title").text
    short = (tmp_path / "tradeoff.md").read_text("utf-8").split("\n\n")
    assert short[1].startswith("> On hard inputs the printed formula has 2 of 16 digits right")
    assert "| Image distance of a thin lens | × " in short[2]
    assert (tmp_path / "overview.png").read_bytes().startswith(b"\x89PNG")
    with (tmp_path / "tradeoff.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["way"]: row for row in csv.DictReader(file)}
    assert rows["exact"]["hard_digits"] == "17"
    assert float(rows["float64"]["hard_digits"]) < 4
    assert float(rows["stable"]["low_ns"]) <= float(rows["stable"]["median_ns"])


def test_every_measurement_draws_figures_that_nothing_has_kept(monkeypatch):
    drawn = []
    monkeypatch.setattr(
        "quizgen.figures.draw_figure", lambda _, given, **__: drawn.append(given["sigma"])
    )
    report._figure()
    report._figure()
    assert len(drawn) == len(set(drawn)) == 12


def test_unknown_family_is_one_line():
    done = CliRunner().invoke(tradeoff, ["thin-lense"])
    assert done.exit_code != 0
    assert "thin-lens" in str(done.exception)
