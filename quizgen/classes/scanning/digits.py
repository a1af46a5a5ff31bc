"""What a number in a field may say, as a proposal to a person who sees the picture.

Signs are parted by the paper between them, described by the directions of their edges, and told
apart by a small net that `tools/train_digits.py` trains. Whatever is struck out, joined or unclear
is no proposal.
"""

from __future__ import annotations

import re
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quizgen.classes.scanning.pictures import SHARP

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from quizgen.render.answer_sheet import SheetField

SIGNS = "0123456789-./?"
"""What the net tells apart; the last one stands for all that is none of them."""
WEIGHTS = Path(__file__).with_name("digits.npz")
SIDE, INNER, CELL = 24, 20, 4
"""Pixels of a described sign, of its longer side, and of a square whose edges are counted."""
DIRECTIONS = 8
SURE = 0.8
"""Least probability that each sign of a proposal has."""
FRAME = 0.25
"""Millimetres of a field's edge that its frame takes."""
FAINT, HALF, LIGHT = 0.14, 0.4, 0.2
"""Darkness below which nothing is ink; the share of that of the darkest ink which is, and which is
where none is darker."""
SPECK, SMALLEST, WIDEST, GAP = 5, 8, 5.5, 4.0
"""Pixels of ink that are dirt, of light ink that are none; millimetres of a sign, and of the paper
between two, at most."""
OVERLAP = 0.45
"""Share of its width that a piece of ink has below another of the same sign."""
PRINT = 235
"""Grey of a blank page below which something is printed."""
NEAR, BESIDE, DARKER = 3, 7, 1.4
"""Pixels by which print may lie beside its place, beyond which paper is looked at, and how much
darker than print something written on it is."""
_NUMBER = re.compile(r"-?\d{1,7}(\.\d{1,6}|/\d{1,4})?")


class Sign(NamedTuple):
    """Ink of one sign, and its height, width and the paper below it in millimetres."""

    ink: NDArray[np.float32]
    size: tuple[float, float, float]


def propose_number(page: NDArray[np.uint8], blank: NDArray[np.uint8], field: SheetField) -> str:
    """Return what is written in a field, if it is a number that reads well; else nothing.

    Parameters
    ----------
    page, blank : array
        The straightened page, and as it was printed.
    field : SheetField
    """
    signs = part_signs(cut_ink(page, blank, field))
    if not signs:
        return ""
    found = judge_signs(describe_signs(signs))
    if float(found.max(axis=1).min()) < SURE:
        return ""
    said = "".join(SIGNS[place] for place in found.argmax(axis=1))
    return said if _NUMBER.fullmatch(said) else ""


def has_ink(page: NDArray[np.uint8], blank: NDArray[np.uint8], field: SheetField) -> bool:
    """Return whether anything is written in a field, be it a number or not."""
    return _find_peak(cut_ink(page, blank, field)) >= FAINT


def _find_peak(ink: NDArray[np.float32]) -> float:
    """Return how dark the darkest ink is, but for a few pixels."""
    return float(np.partition(ink.ravel(), -12)[-12])


def cut_ink(
    page: NDArray[np.uint8], blank: NDArray[np.uint8], field: SheetField
) -> NDArray[np.float32]:
    """Return the darkness of what was written in a field.

    What is printed there goes: the frame, and the lines between cells but where something darker,
    or on both sides of them, is written.
    """
    import cv2

    left, top = (round((value + FRAME) * SHARP) for value in (field.x, field.y))
    right, bottom = (
        round((value - FRAME) * SHARP) for value in (field.x + field.w, field.y + field.h)
    )
    ink = np.clip((245.0 - page[top:bottom, left:right].astype(np.float32)) / 245.0, 0, 1)
    around = np.ones((2 * NEAR + 1, 2 * NEAR + 1), np.uint8)
    print_ = cv2.erode(blank, around)[top:bottom, left:right]
    printed, dark = print_ < PRINT, (250.0 - print_.astype(np.float32)) / 250.0
    beside = np.zeros_like(ink)
    beside[:, BESIDE:-BESIDE] = np.minimum(ink[:, : -2 * BESIDE], ink[:, 2 * BESIDE :])
    beside[cv2.erode(printed.astype(np.uint8), np.ones((1, 4 * BESIDE), np.uint8)) > 0] = 0
    return np.where(printed & (ink < DARKER * dark), np.minimum(ink, beside), ink)


def part_signs(ink: NDArray[np.float32]) -> list[Sign]:
    """Return the signs in a field from left to right; none if they cannot be parted."""
    import cv2

    peak = _find_peak(ink)
    if peak < FAINT:
        return []
    dark = (ink > max(FAINT * 0.8, HALF * peak)).astype(np.uint8)
    faint = (ink > max(FAINT * 0.8, LIGHT * peak)).astype(np.uint8)
    _, labels, stats, _ = cv2.connectedComponentsWithStats(faint, connectivity=8)
    large = stats[:, cv2.CC_STAT_AREA] >= SMALLEST
    large[np.unique(labels[dark > 0])] = False
    dark |= (large[labels] & (labels > 0)).astype(np.uint8)  # a light mark, which must not be lost
    _, labels, stats, _ = cv2.connectedComponentsWithStats(dark, connectivity=8)
    pieces = sorted(
        (int(x), int(x + w), n) for n, (x, _, w, _, area) in enumerate(stats) if n and area >= SPECK
    )
    groups = _join_pieces(pieces)
    if any(right - left > WIDEST * SHARP for left, right, _ in groups) or any(
        after[0] - before[1] > GAP * SHARP for before, after in pairwise(groups)
    ):
        return []
    return [_cut_sign(ink / peak, np.isin(labels, numbers)) for _, _, numbers in groups]


def _join_pieces(pieces: list[tuple[int, int, int]]) -> list[tuple[int, int, list[int]]]:
    """Return left, right and the pieces of each sign: those that stand above each other."""
    groups: list[tuple[int, int, list[int]]] = []
    for left, right, number in pieces:
        if groups:
            begin, end, numbers = groups[-1]
            if end - left >= OVERLAP * min(right - left, end - begin):
                groups[-1] = begin, max(end, right), [*numbers, number]
                continue
        groups.append((left, right, [number]))
    return groups


def _cut_sign(ink: NDArray[np.float32], where: NDArray[np.bool_]) -> Sign:
    """Return one sign of a field."""
    import cv2

    rows, columns = np.flatnonzero(where.any(axis=1)), np.flatnonzero(where.any(axis=0))
    around = cv2.dilate(where.astype(np.uint8), np.ones((3, 3), np.uint8))
    top, bottom, left, right = rows[0], rows[-1] + 1, columns[0], columns[-1] + 1
    cut = np.clip(ink * around, 0, 1)[top:bottom, left:right]
    below = (len(ink) - bottom) / SHARP
    return Sign(cut, ((bottom - top) / SHARP, (right - left) / SHARP, below))


def describe_signs(signs: list[Sign]) -> NDArray[np.float32]:
    """Return a row for each sign: how much edge it has in each direction where, and its size."""
    return np.stack([_describe_sign(one) for one in signs])


def _describe_sign(sign: Sign) -> NDArray[np.float32]:
    """Return what the net knows of a sign."""
    import cv2

    high, wide = sign.ink.shape
    scale = INNER / max(high, wide)
    small = cv2.resize(
        sign.ink, (max(1, round(wide * scale)), max(1, round(high * scale))),
        interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR,
    )  # fmt: skip
    field = np.zeros((SIDE, SIDE), np.float32)
    top, left = (SIDE - small.shape[0]) // 2, (SIDE - small.shape[1]) // 2
    field[top : top + small.shape[0], left : left + small.shape[1]] = small
    field = cv2.GaussianBlur(field, (0, 0), 0.7)
    along_x, along_y = cv2.Sobel(field, -1, 1, 0), cv2.Sobel(field, -1, 0, 1)
    steep = np.hypot(along_x, along_y)
    turn = (np.arctan2(along_y, along_x) / (2 * np.pi) * DIRECTIONS) % DIRECTIONS
    low = np.floor(turn).astype(int) % DIRECTIONS
    rest = turn - np.floor(turn)
    planes = np.zeros((DIRECTIONS, SIDE, SIDE), np.float32)
    rows, columns = np.indices(field.shape)
    planes[low, rows, columns] = steep * (1 - rest)
    planes[(low + 1) % DIRECTIONS, rows, columns] += steep * rest
    count = SIDE // CELL
    sums = planes.reshape(DIRECTIONS, count, CELL, count, CELL).sum(axis=(2, 4)).ravel()
    sums = np.sqrt(sums / (np.linalg.norm(sums) + 1e-6))
    grey = cv2.resize(field, (8, 8), interpolation=cv2.INTER_AREA).ravel()
    return np.concatenate([sums, grey, np.array(sign.size, np.float32) / 4])


@cache
def _load_weights() -> list[NDArray[np.float32]]:
    """Return weights and offsets of each layer, read once."""
    with np.load(WEIGHTS) as stored:
        return [stored[name].astype(np.float32) for name in sorted(stored.files)]


def judge_signs(rows: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return how likely each of ``SIGNS`` is, for each row."""
    *layers, weights, offsets = _load_weights()
    for weight, offset in zip(layers[::2], layers[1::2], strict=True):
        rows = np.maximum(rows @ weight + offset, 0)
    found = rows @ weights + offsets
    found = np.exp(found - found.max(axis=1, keepdims=True))
    return found / found.sum(axis=1, keepdims=True)
