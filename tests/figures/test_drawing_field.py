"""A field to draw in, told in words."""

from __future__ import annotations

from svg_reader import read_labels, read_parts

from quizgen.figures import FieldPicture
from quizgen.kinds.contract import DrawingField

FIELD = DrawingField((-4, 4, -3, 3), (1, 1))
SOLVED = FieldPicture(FIELD, "en", (((0, 0), (1, 1)),))


def test_marks_are_named_as_in_the_text():
    field = DrawingField((-4, 4, -3, 3), (1, 1), marks=(("F", (-1.5, 0)), ("F'", (1.5, 0))))
    assert FieldPicture(field, "en").alt.endswith(" Marked: F (−1.5; 0); F′ (1.5; 0).")


def test_a_field_with_the_wanted_lines_is_not_called_empty():
    empty = FieldPicture(FIELD, "en").alt
    assert empty.startswith("An empty field to draw in: x from −4 to 4")
    assert SOLVED.alt.startswith("The drawing that was wanted: x from −4 to 4")
    assert SOLVED.alt.endswith(" The wanted lines: (0; 0), (1; 1).")
    assert "ফাঁকা" not in FieldPicture(FIELD, "bn", SOLVED.lines).alt


def test_numbers_are_written_as_the_language_does():
    field = DrawingField((0, 2, 0, 1), (0.5, 0.5), marks=(("F", (1.5, 0)),))
    german, english = FieldPicture(field, "de"), FieldPicture(field, "en")
    assert "Gitterlinien alle 0,5 und 0,5" in german.alt
    assert "F (1,5; 0)" in german.alt
    assert "0.5" in english.alt
    assert german.figure != english.figure


def test_axes_have_names_with_units():
    field = DrawingField((400, 700, 0, 1), (100, 0.5), 0.4, axes=(r"$\lambda$ / nm", "$V$"))
    picture = FieldPicture(field, "en")
    assert {"λ / nm", "V"} <= set(read_labels(picture.figure))
    assert "λ / nm" in picture.alt


def test_the_wanted_lines_are_drawn_where_the_page_draws_them():
    (line,) = read_parts(SOLVED.figure)["wanted"]
    wide, tall = FIELD.size
    left, top, *_ = FIELD.frame
    assert line[0].tolist() == [round(left + wide / 2, 2), round(-(top + tall / 2), 2)]
    step = (wide / 8, tall / 6)
    assert (line[1] - line[0]).round(1).tolist() == [round(one, 1) for one in step]
