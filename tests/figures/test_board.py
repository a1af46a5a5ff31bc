"""A field to draw in, told in words."""

from __future__ import annotations

from quizgen.figures import Board, Drawing


def test_marks_are_named_as_in_the_text():
    board = Board((-4, 4, -3, 3), (1, 1), marks=(("F", (-1.5, 0)), ("F'", (1.5, 0))))
    assert Drawing(board, "en").alt.endswith(" Marked: F (−1.5; 0); F′ (1.5; 0).")


def test_a_field_with_the_wanted_lines_is_not_called_empty():
    board = Board((-4, 4, -3, 3), (1, 1))
    empty, solved = (Drawing(board, "en", lines).alt for lines in ((), (((0, 0), (1, 1)),)))
    assert empty.startswith("An empty field to draw in: x from −4 to 4")
    assert solved.startswith("The drawing that was wanted: x from −4 to 4")
    assert solved.endswith(" The wanted lines: (0; 0), (1; 1).")
    assert "ফাঁকা" not in Drawing(board, "bn", (((0, 0), (1, 1)),)).alt


def test_numbers_are_written_as_the_language_does():
    board = Board((0, 2, 0, 1), (0.5, 0.5), marks=(("F", (1.5, 0)),))
    german, english = Drawing(board, "de"), Drawing(board, "en")
    assert "Gitterlinien alle 0,5 und 0,5" in german.alt
    assert "F (1,5; 0)" in german.alt
    assert "0.5" in english.alt
    labels = {lang.lang: [label.text for label in lang.figure.canvas.labels]
              for lang in (german, english)}  # fmt: skip
    assert {"0,5", "1,5"} <= set(labels["de"])
    assert {"0.5", "1.5"} <= set(labels["en"])
