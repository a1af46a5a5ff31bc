"""Drawings by hundreds of simulated hands, judged by what makes them right."""

from __future__ import annotations

import math
from fractions import Fraction
from random import Random

import pytest
from sweep import together

from quizgen.core.errors import KeyFileError
from quizgen.kinds.grade import grade_answer, load_spec, show_key
from tests.grading.hands import along, drawings, moved, text, turned, waved

WIDE = 2.8
EDGES = ("top", "bottom", "left", "right")


def bent(k: float) -> dict[str, list[tuple[float, float]]]:
    """Square and cross under radial distortion, point by point."""

    def out(x: float, y: float) -> tuple[float, float]:
        return x * (1 + k * (x * x + y * y)), y * (1 + k * (x * x + y * y))

    run = [i / 10 for i in range(-10, 11)]
    return {
        "top": [out(t, 1) for t in run],
        "bottom": [out(t, -1) for t in run],
        "left": [out(-1, t) for t in run],
        "right": [out(1, t) for t in run],
        "across": [out(-1, 0), out(1, 0)],
        "down": [out(0, -1), out(0, 1)],
    }


def typed(k: float) -> dict[str, str]:
    return {name: text([line]) for name, line in bent(k).items()}


def grid(k: float):
    return load_spec({
        "kind": "sketch", "view": [-1.4, 1.4, -1.4, 1.4], "lines": typed(k),
        "traps": {"reversed": typed(-k)},
        "features": {
            "outer": {"reads": "line", "of": EDGES, "worth": 2, "bend": True},
            "corners": {"reads": "line", "of": EDGES, "worth": 2, "circle": [0, 0, math.sqrt(2)]},
            "radial": {"reads": "line", "of": ["across", "down"], "bend": True, "on": True},
        },
    })  # fmt: skip


BARREL, PINCUSHION = grid(-0.15), grid(0.15)


def because(verdict) -> tuple[str, ...]:
    return verdict.fields["because"]


@pytest.mark.parametrize(("spec", "sign"), [(BARREL, -1), (PINCUSHION, 1)], ids=["in", "out"])
def test_hands_that_draw_it_right(spec, sign):
    failed = {}
    for seed in range(110):
        strength = sign * Random(seed).uniform(0.12, 0.19)
        verdict = grade_answer(spec, drawings(list(bent(strength).values()), seed, WIDE))
        if verdict.verdict != "correct":
            failed[seed] = (strength, because(verdict))
    assert not failed


def test_hands_that_draw_the_other_distortion_are_told_its_name():
    for seed in range(60):
        strength = Random(seed).uniform(0.12, 0.19)
        verdict = grade_answer(BARREL, drawings(list(bent(strength).values()), seed, WIDE))
        assert (verdict.note, verdict.credit) == ("trap:reversed", Fraction(1, 5)), seed


def test_hands_that_trace_the_grey_lines_earn_the_straight_ones_alone():
    for seed in range(40):
        verdict = grade_answer(BARREL, drawings(list(bent(0).values()), seed, WIDE))
        assert (verdict.note, verdict.credit) == ("sketch", Fraction(1, 5)), seed
        assert because(verdict) == ("outer", "corners")


WRONG = {
    "an S": lambda line: waved(line, 0.14, 1),
    "a zigzag": lambda line: waved(line, 0.14, 6),
    "turned by thirty degrees": lambda line: turned(line, 30),
    "turned by forty-five degrees": lambda line: turned(line, 45),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_shapes_are_not_right(name):
    for seed in range(12):
        wrong = [WRONG[name](line) for line in bent(0).values()]
        verdict = grade_answer(PINCUSHION, drawings(wrong, 5 * seed, WIDE))
        assert {"outer", "radial"} <= {*because(verdict)}, seed
        assert verdict.credit <= Fraction(2, 5)


def test_a_cross_beside_the_centre_is_not_through_it():
    for seed in range(40):
        right = bent(-0.15)
        for name in ("across", "down"):
            right[name] = moved(right[name], (0.25, 0.25))
        assert because(grade_answer(BARREL, drawings(list(right.values()), seed, WIDE))) == (
            "radial",
        )


def test_the_outline_may_be_one_stroke_from_corner_to_corner():
    right = bent(-0.15)
    outline = [*right["top"], *right["right"][::-1], *right["bottom"][::-1], *right["left"]]
    drawn = [outline, right["down"], right["across"][::-1]]
    assert grade_answer(BARREL, text(drawn)).verdict == "correct"
    assert grade_answer(BARREL, text([*drawn, *drawn])).verdict == "correct"


def test_what_is_missing_earns_nothing_and_is_named():
    right = bent(-0.15)
    three = text([line for name, line in right.items() if name != "left"])
    verdict = grade_answer(BARREL, three)
    assert (verdict.credit, because(verdict)) == (Fraction(4, 5), ("outer", "corners"))
    assert verdict.fields["right"] == 1
    half = text([*list(right.values())[:5], along(right["down"], 9)[:4]])
    assert because(grade_answer(BARREL, half)) == ("radial",)


def test_lines_elsewhere_are_told_as_such():
    assert grade_answer(BARREL, "1.3,1.3 1.35,1.35").note == "sketch-elsewhere"


HOSTILE = {
    "0,0": ("unreadable", "two-points"),
    "0,0; 1,1; 0,1": ("unreadable", "two-points"),
    "0,0 0,0": ("unreadable", "two-points"),
    "": ("unreadable", "no-answer"),
    ";;;": ("unreadable", "two-points"),
    "0,5,1 1": ("unreadable", "outside-field"),
    "a barrel": ("unreadable", "points-expected"),
    "0,0 1e99,0": ("unreadable", "outside-field"),
    "0,0 9,9": ("unreadable", "outside-field"),
    "0,0 1e999,0": ("unreadable", "points-expected"),
    "0,0 nan,inf": ("unreadable", "points-expected"),
    "0,0 " * 2000: ("unreadable", "too-long"),
    "0,0\u202e 1,1": ("unreadable", "bad-character"),
}


@together("typed", HOSTILE)
def test_what_is_no_drawing_is_asked_back(typed):
    verdict = grade_answer(BARREL, typed)
    assert (verdict.verdict, verdict.note) == HOSTILE[typed]
    assert verdict.credit == 0


def test_scribbles_over_the_whole_field_are_judged_soon_and_earn_nothing_for_the_outline():
    rng = Random(1)
    scribble = [(rng.uniform(-1.4, 1.4), rng.uniform(-1.4, 1.4)) for _ in range(330)]
    verdict = grade_answer(BARREL, text([scribble]))
    assert "outer" in because(verdict)
    assert verdict.verdict != "correct"


@pytest.mark.parametrize(
    "typed",
    [
        "line: 0,0 1,0.2; 0,1 1,1",
        "(0, 0) (1, 0.2); (0, 1), (1, 1)",
        "\u09e6,\u09e6 \u09e7,\u09e6.\u09e8\n0,1 1,1",
        "0,0 1,.2\n0,1 1,1.",
        "\u0985: 0|0 1|0.2; 0|1 1|1",
    ],
)
def test_points_may_be_written_as_people_write_them(typed):
    assert grade_answer(BARREL, typed).read_as == "0,0 1,0.2; 0,1 1,1"


def test_the_printed_key_is_right_and_a_minus_sign_is_one():
    for spec in (BARREL, PINCUSHION):
        assert grade_answer(spec, show_key(spec)).verdict == "correct"
        assert grade_answer(spec, show_key(spec).replace("\u2212", "-")).verdict == "correct"


MOVED = {"reads": "moved", "of": ["l"], "circle": [0, 0, 1], "within": 2}
TOP = {"reads": "curve", "of": ["l"], "top": True}
ABOVE = {"features": {"a": TOP}, "view": [-1, 1, 0, 1]}


@together(
    ("change", "said"),
    [
        ({"view": [1, -1, 0, 1]}, "view"),
        ({"features": {}}, "features"),
        ({"features": {"a": {"reads": "line", "of": ["nowhere"], "bend": True}}}, "of names lines"),
        ({"features": {"a": {"reads": "line", "of": ["l"], "worth": 0}}}, "worth"),
        ({"lines": {"l": "0,0"}}, "two ends"),
        ({"lines": {"l": "0,0 1,1 0,0"}}, "two ends"),
        ({"traps": {"t": {"m": "0,0 1,1"}}}, "lines that the key has"),
        ({"cuts": ["1e999"]}, "beyond all floats"),
        ({"features": {"a": {"reads": "line", "of": ["l"], "circle": [0, 0, 0]}}}, "radius"),
        ({"features": {"a": {**MOVED, "circle": [0, 0, 0]}}}, "radius"),
        ({"features": {"a": {**MOVED, "within": 1}}}, "within"),
        ({"features": {"a": {"reads": "curve", "of": ["l"]}}}, "must be asked"),
        ({"features": {"a": TOP}}, "begins at 0"),
        ({**ABOVE, "lines": {"l": "0,0 0,1"}}, "one height"),
        ({**ABOVE, "lines": {"l": "-1,0 1,0"}}, "one height"),
        ({**ABOVE, "lines": {"l": "-1,0 1,0 1,1 -1,1"}}, "one height"),
    ],
)
def test_a_key_that_cannot_be_judged_by_is_refused(change, said):
    table = {"kind": "sketch", "view": [-1, 1, -1, 1], "lines": {"l": "0,0 1,1"},
             "features": {"a": {"reads": "line", "of": ["l"], "bend": True}}}  # fmt: skip
    load_spec(table)
    with pytest.raises(KeyFileError, match=said):
        load_spec({**table, **change})


@pytest.mark.parametrize(
    ("lines", "feature"),
    [
        ({"l": "-1,0 1,0"}, MOVED),  # its ends have not left the circle
        ({"l": "-1,0 0,1 1,0", "beside": "0,0 0,1"}, TOP),
    ],
)
def test_wanted_lines_that_a_feature_cannot_read_are_no_failure(lines, feature):
    table = {"kind": "sketch", "view": [-1, 1, 0, 1], "lines": lines, "features": {"a": feature}}
    for typed in [*lines.values(), "-1,0 1,0.1", "0,0 0,1"]:
        assert grade_answer(table, typed).verdict in {"correct", "wrong"}


def field(features, lines, traps=None):
    """A sketch over a field from 0 to 10 both ways."""
    return load_spec({"kind": "sketch", "view": [0, 10, 0, 10], "lines": lines,
                      "features": features, "traps": traps or {}})  # fmt: skip


RING = " ".join(
    f"{5 + 3 * math.cos(math.pi * i / 16):.4f},{5 + 2 * math.sin(math.pi * i / 16):.4f}"
    for i in range(33)
)


@pytest.mark.parametrize(
    ("feature", "line", "said"),
    [
        ({"reads": "height", "at": [11], "within": "0.1"}, "0,1 10,5", "inside the field"),
        ({"reads": "height", "at": [5], "within": 2}, "0,1 10,5", "share above 0"),
        ({"reads": "loop", "centre": True}, "0,1 10,5", "ends where it begins"),
        ({"reads": "loop"}, RING, "must be asked of a loop"),
        ({"reads": "empty", "box": [1, 2]}, "0,1 10,5", "from and to along x"),
    ],
)
def test_features_that_can_never_be_judged_are_refused(feature, line, said):
    with pytest.raises(KeyFileError, match=said):
        field({"one": {"of": ["line"], **feature}}, {"line": line})


def test_heights_are_read_where_they_are_asked():
    spec = field({"high": {"reads": "height", "of": ["line"], "at": [2, 8], "within": "0.2"}},
                 {"line": "0,1 5,6 10,1"})  # fmt: skip
    for typed, credit in (("0,1 5,6 10,1", 1), ("0,1 5,9 10,1", 0), ("0,1 5,6", 0),
                          ("0,1.2 2,3.2 5,3.2 8,3 10,1", 1), ("0,3 10,3; 0,1 10,1", 0)):  # fmt: skip
        assert grade_answer(spec, typed).credit == credit, typed


def test_a_loop_is_read_by_its_width_its_height_and_its_shape():
    spec = field({"size": {"reads": "loop", "of": ["line"], "within": "0.15"},
                  "shape": {"reads": "loop", "of": ["line"], "form": True}}, {"line": RING})  # fmt: skip
    assert grade_answer(spec, RING).credit == 1
    assert because(grade_answer(spec, "8,7 2,7 2,3 8,3 8,7")) == ("shape",)
    smaller = " ".join(
        f"{5 + 2 * math.cos(i / 3):.3f},{5 + 1.3 * math.sin(i / 3):.3f}" for i in range(20)
    )
    assert because(grade_answer(spec, smaller)) == ("size",)
    half = " ".join(RING.split()[:17])
    assert because(grade_answer(spec, half)) == ("size", "shape")


def test_what_has_to_stay_empty_is_looked_at():
    spec = field({"right": {"reads": "empty", "of": ["line"], "box": [6, 10, 1, 10]},
                  "line": {"reads": "line", "of": ["line"], "on": True}}, {"line": "1,0 1,5"})  # fmt: skip
    assert grade_answer(spec, "1,0 1,5").credit == 1
    assert because(grade_answer(spec, "1,0 1,5; 8,0 8,5")) == ("right",)
