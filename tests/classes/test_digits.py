"""Numbers that a hand writes into cells are proposed as they were meant, or not at all."""

from __future__ import annotations

import numpy as np
from paper_and_pen import PER_MM, Pen
from PIL import Image

from quizgen.classes.scanning.digits import propose_number
from quizgen.render.answer_sheet import SheetField

FIELD = SheetField(1, "1a", "line", 5.0, 5.0, 32.0, 7.6, is_number=True)
CELLS = 8
NUMBERS = ("0.47", "-3.25", "128", "7", "1960", "0.05", "-12", "36.8", "4.91", "523.7")


def write_signs(text: str, seed: int, *, cells: int = CELLS, struck: bool = False) -> np.ndarray:
    """A straightened page, 8 pixels a millimetre, on which a hand wrote a sign in each cell."""
    page, pen = Image.new("L", (round(45 * PER_MM), round(20 * PER_MM)), 250), Pen(seed)
    pen.dark = max(pen.dark, 0.6)
    place = {name: getattr(FIELD, name) for name in "xywh"}
    pen.write_in_cells(page, place, text, cells)
    if struck:
        y = FIELD.y + FIELD.h * 0.55
        pen.draw(page, [[(FIELD.x + 0.5, y), (FIELD.x + len(text) * FIELD.w / CELLS, y)]])
    return np.asarray(page.resize((360, 160), Image.Resampling.BILINEAR)).copy()


def propose(page: np.ndarray) -> str:
    return propose_number(page, np.full_like(page, 250), FIELD)


def test_most_numbers_are_proposed_and_nine_of_ten_proposals_are_right():
    found = [(text, propose(write_signs(text, seed))) for seed in range(6) for text in NUMBERS]
    proposed = [pair for pair in found if pair[1]]
    assert len(proposed) >= 0.6 * len(found)
    assert sum(text == said for text, said in proposed) >= 0.9 * len(proposed), proposed


def test_what_is_struck_out_no_number_or_joined_is_no_proposal():
    for seed in range(6):
        assert not propose(write_signs("47.5", seed, struck=True))
        assert not propose(write_signs("net", seed))
        assert not propose(write_signs("1.2.3", seed))
        assert not propose(write_signs("3888", seed, cells=20))
    assert not propose(np.full((160, 360), 250, np.uint8))


def test_a_divider_between_cells_is_no_sign_and_parts_none():
    page, blank = write_signs("128", 1), np.full((160, 360), 250, np.uint8)
    for column in range(72, 296, 32):
        for one in (page, blank):
            one[80:100, column] = np.minimum(one[80:100, column], 120)
    assert propose_number(page, blank, FIELD) == "128"
