"""Counterexamples are tested, never compared: against a criterion derived by other means."""

from __future__ import annotations

import itertools
import math
import random
from fractions import Fraction

import pytest
from sweep import together

from quizgen.bank.variant import draw_variant, reference_variant
from quizgen.kinds.grade import grade_answer
from quizgen.question.part_context import ask_part


def spec_of(bank, name, seed="reference", part=0):
    template = bank.template(name)
    one = reference_variant(template) if seed == "reference" else draw_variant(template, seed)
    return ask_part(one, part).spec, one


def typed(values):
    return "; ".join(str(v) for v in values)


@together("seed", ["reference", *range(12)])
def test_hsv_value_fails_additivity_exactly_without_a_common_largest_channel(bank, seed):
    spec, one = spec_of(bank, "hsv-nonlinearity-counterexample", seed)
    a = [Fraction(int(one.shown[f"a_{i}"].p), int(one.shown[f"a_{i}"].q)) for i in (1, 2, 3)]
    chosen = random.Random(5)
    for _ in range(60):
        b = [Fraction(chosen.randint(0, 10), 10) * (1 - channel) for channel in a]
        largest = [{i for i, v in enumerate(c) if v == max(c)} for c in (a, b)]
        refutes = not largest[0] & largest[1]
        verdict = grade_answer(spec, typed(b))
        assert (verdict.verdict == "correct") == refutes
        assert refutes or verdict.note == "predicate"


def test_a_multiple_of_the_colour_refutes_nothing(bank):
    spec, _ = spec_of(bank, "hsv-nonlinearity-counterexample")
    verdict = grade_answer(spec, "b = (0; 0; 0)")
    assert (verdict.verdict, verdict.note) == ("wrong", "predicate")


def test_colours_out_of_range_are_told_so(bank):
    spec, _ = spec_of(bank, "hsv-nonlinearity-counterexample")
    assert grade_answer(spec, "b = (0.5; 1; 0)").note == "constraint"


def bent(points, k):
    moved = [(x * (1 + k * (x * x + y * y)), y * (1 + k * (x * x + y * y))) for x, y in points]
    (ax, ay), (bx, by), (cx, cy) = moved
    return (bx - ax) * (cy - ay) != (cx - ax) * (by - ay)


@pytest.mark.parametrize("seed", range(5))
def test_three_points_of_a_line_are_a_witness_exactly_if_their_images_are_not_in_line(bank, seed):
    spec, one = spec_of(bank, "straight-line-counterexample", seed)
    k = Fraction(int(one.shown["k"].p), int(one.shown["k"].q))
    steps = [Fraction(i, 4) for i in (-2, 0, 3)]
    for x, slope in itertools.product((Fraction(0), Fraction(1, 2), Fraction(-1, 4)), (0, 1)):
        line = [(x + slope * t / 2, t) for t in steps]
        verdict = grade_answer(spec, typed(v for point in line for v in point))
        assert (verdict.verdict == "correct") == bent(line, k)


def test_points_that_are_not_in_line_are_told_so(bank):
    spec, _ = spec_of(bank, "straight-line-counterexample")
    assert grade_answer(spec, "A = (0; 0); B = (0.5; 0.5); C = (0.2; 1)").note == "constraint"


@together("seed", range(6))
def test_encoding_is_refuted_by_any_two_positive_intensities(bank, seed):
    spec, _ = spec_of(bank, "gamma-linearity-counterexample", seed, part=1)
    assert grade_answer(spec, "0.25; 0.25").verdict == "correct"
    assert grade_answer(spec, "a = 0.1; b = 0.6").verdict == "correct"
    assert grade_answer(spec, "0; 0.5").note in {"predicate", "undecided"}


def blur(f, n, s, z):
    """Thin lens: sensor where s is sharp, cone of a point at z; all in metres."""
    sensor, sharp = f * s / (s - f), f * z / (z - f)
    return f / n * abs(sensor - sharp) / sharp


def near_exposure(n, t, iso, given):
    n_0, t_0, iso_0 = given
    return abs(math.log2(t * iso / n**2 / (t_0 * iso_0 / n_0**2))) <= 0.34


def plates(v, one):
    f, n, t, iso, s = one
    f /= 1000
    return {
        "plate": f * 0.52 / 40 >= v["w"] * 5e-6,
        "lane": f * v["L"] / 20 <= 2048 * 5e-6,
        "blur": f * v["v"] * t / 20 <= v["b"] * 5e-6,
        "disc": max(blur(f, n, s, 20), blur(f, n, s, 40)) <= 5e-6,
        "exposure": near_exposure(n, t, iso, (8, 1 / 250, 100)),
        "gain": iso <= 1600,
    }


def hall(v, one):
    n, t, iso = one
    return {
        "blur": 0.085 * v["v"] * t / v["z"] <= v["b"] * 6e-6,
        "exposure": near_exposure(n, t, iso, (4, 1 / 60, 800)),
        "disc": blur(0.085, n, v["z"], v["z"] - v["d"] / 2) <= 4 * 6e-6,
        "gain": iso <= v["g"],
    }


def books(v, one):
    f, z, n = one
    f, z = f / 1000, z / 1000
    m = f / (z - f)
    return {
        "page": m * v["W"] <= 23.4 and m * v["H"] <= 15.6,
        "fine": m * 0.0254 / 3.9e-6 >= v["d"],
        "room": z * 1000 <= v["room"],
        "disc": blur(f, n, z, z - v["c"] / 1000) <= 1.5 * 3.9e-6,
        "airy": 2.44 * 550e-9 * n * (1 + m) <= 3 * 3.9e-6,
    }


def nebula(v, one):
    t, n = one
    variance = n * (v["S"] * t + v["D"] * t + 9)
    return {
        "full": 900 * t <= v["F"],
        "trail": t <= 8,
        "snr": n * v["S"] * t / math.sqrt(variance) >= v["R"],
        "time": n * (t + 2) <= 60,
    }


TIMES = [1 / 60, 1 / 250, 1 / 1000, 1 / 1600, 1 / 2500, 1 / 4000]
APERTURES = [1.8, 2.8, 4, 5.6, 8, 11]
DESIGNS = {
    "design-number-plate-camera": (plates, [[30, 40, 50, 55, 70], APERTURES[1:], TIMES,
                                            [100, 400, 1000, 1600, 3200], [24, 26.7, 30, 35]]),
    "design-settings-for-hall-sport": (hall, [[1.4, *APERTURES[:4]], TIMES,
                                              [800, 1600, 4000, 5000, 6400, 12800]]),
    "design-book-scanner": (books, [[18, 24, 28, 35, 50], [300, 400, 500, 600, 640, 700],
                                    APERTURES[1:]]),
    "design-frames-of-a-nebula": (nebula, [[1, 2, 4, 5, 6, 8, 10, 13], [1, 3, 4, 5, 6, 9, 20]]),
}  # fmt: skip


@together("seed", range(4))
@together("name", DESIGNS)
def test_a_design_is_judged_demand_by_demand(bank, name, seed):
    spec, one = spec_of(bank, name, seed)
    demanded, choices = DESIGNS[name]
    v = {quantity: float(value) for quantity, value in one.shown_values.items()}
    met = 0
    for setting in random.Random(seed).sample(list(itertools.product(*choices)), 40):
        verdict = grade_answer(spec, "; ".join(str(Fraction(value).limit_denominator(5000))
                                               for value in setting))  # fmt: skip
        missed = {demand for demand, held in demanded(v, setting).items() if not held}
        assert set(verdict.fields["because"]) == missed, (v, setting)
        met += not missed
    example = [float(Fraction(str(value))) for value in spec.example.values()]
    assert all(demanded(v, example).values())
    assert met < 10, "guessing must not pay"


def test_a_design_says_what_was_missed_and_not_what_is_right(bank):
    spec, _ = spec_of(bank, "design-number-plate-camera", 1)
    verdict = grade_answer(spec, "f = 30 mm; N = f/8; t = 0.4 ms; ISO = 1000; d = 26.7 m")
    assert (verdict.verdict, verdict.note, verdict.credit) == ("partial", "demands", Fraction(5, 6))
    assert verdict.message.startswith("Met: 5 of 6 conditions. Not met: 78 ≥ ")
    middle = grade_answer(spec, "f = 50 mm; N = 8; t = 1/2500 s; ISO = 1000; d = 30 m")
    assert middle.note == "trap:in-the-middle"
    other = grade_answer(spec, "f = 50 s; N = 8; t = 1/2500 s; ISO = 1000; d = 30 m")
    assert (other.verdict, other.note) == ("unreadable", "unit-other")
