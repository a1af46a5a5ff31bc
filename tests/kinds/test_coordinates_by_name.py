"""A coordinate that carries its name is judged by its name, wherever it stands."""

from __future__ import annotations

import pytest
from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.bank.variant import draw_variant
from quizgen.kinds.grade import grade_answer
from quizgen.question.part_context import ask_part

RIGHT = {"p'_x": "-2", "p'_y": "6"}
IMAGE_POINT = {"kind": "point", "of": list(RIGHT), "values": list(RIGHT.values()), "exact": True}
PIXEL = {"kind": "point", "of": ["u", "v"], "values": ["576", "700"], "unit": "px", "exact": True}
COLOUR = {"kind": "point", "of": ["R_H", "G_H", "B_H"], "values": ["0.42", "0.56", "0.7"],
          "exact": True}  # fmt: skip
INKS = {"kind": "table", "values": {"C_0": "0.1", "M_0": "0.2", "Y_0": "0"}, "exact": True}


@together(
    ("spec", "typed"),
    [
        (IMAGE_POINT, "p'_y = 6, p'_x = -2"),
        (IMAGE_POINT, "x = -2, y = 6"),
        (IMAGE_POINT, "y: 6; x: -2"),
        (IMAGE_POINT, "(y, x) = (6, -2)"),
        (IMAGE_POINT, "-2 (x), 6 (y)"),
        (IMAGE_POINT, "p' = (-2; 6)"),
        (PIXEL, "v = 700, u = 576"),
        (PIXEL, "row 700, column 576"),
        (PIXEL, "Zeile 700; Spalte 576"),
        (PIXEL, "সারি ৭০০, কলাম ৫৭৬"),
        (COLOUR, "B=0.7 G=0.56 R=0.42"),
        (COLOUR, "B 0.7, R 0.42, G 0.56"),
        (COLOUR, "0.7 blue, 0.42 red, 0.56 green"),
        (COLOUR, "rot = 0,42; grün = 0,56; blau = 0,7"),
        (COLOUR, "নীল ০.৭, লাল ০.৪২, সবুজ ০.৫৬"),
        (INKS, "yellow 0, cyan 0.1, magenta 0.2"),
        (INKS, "Y = 0; M = 0.2; C = 0.1"),
    ],
)
def test_named_coordinates_may_stand_in_any_order(spec, typed):
    assert grade_answer(spec, typed).verdict == "correct"


@pytest.mark.parametrize(
    ("spec", "typed"),
    [
        (IMAGE_POINT, "y = -2; x = 6"),
        (PIXEL, "v = 576, u = 700"),
        (COLOUR, "red 0.7, green 0.56, blue 0.42"),
        (INKS, "cyan 0, magenta 0.2, yellow 0.1"),
    ],
)
def test_numbers_under_the_wrong_names_are_wrong(spec, typed):
    assert grade_answer(spec, typed).credit < 1


@pytest.mark.parametrize(
    ("spec", "typed", "note"),
    [
        (IMAGE_POINT, "z = -2, q = 6", "unknown-name"),
        (IMAGE_POINT, "x = -2, x = 6", "used-twice"),
        (COLOUR, "H = 0.42, S = 0.56, V = 0.7", "unknown-name"),
    ],
)
def test_a_name_that_is_not_asked_is_asked_back(spec, typed, note):
    verdict = grade_answer(spec, typed)
    assert (verdict.verdict, verdict.note) == ("unreadable", note)


POINTS = [
    (name, index)
    for name in builtin_bank().template_paths
    for index, part in enumerate(builtin_bank().template(name).rules.part)
    if part.answer["kind"] == "point"
]


@together(("name", "index"), POINTS)
def test_every_point_of_the_bank_goes_by_its_names(name, index):
    """Typed from the last to the first, each with its name; the key says which is which."""
    spec = ask_part(draw_variant(builtin_bank().template(name), 3), index).spec
    pairs = list(zip(spec.of, spec.values, strict=True))
    assert grade_answer(spec, "; ".join(f"{n} = {v}" for n, v in pairs[::-1])).credit == 1
    if len(set(spec.values)) == len(pairs):
        exchanged = zip([n for n, _ in pairs], [v for _, v in pairs[::-1]], strict=True)
        assert grade_answer(spec, "; ".join(f"{n} = {v}" for n, v in exchanged)).credit < 1
