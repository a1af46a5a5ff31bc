"""A field to draw in, told in words."""

from __future__ import annotations

from quizgen.figures import Board, Drawing


def test_marks_are_named_as_in_the_text():
    board = Board((-4, 4, -3, 3), (1, 1), marks=(("F", (-1.5, 0)), ("F'", (1.5, 0))))
    assert Drawing(board, "en").alt.endswith(" Marked: F (−1.5; 0); F′ (1.5; 0).")
