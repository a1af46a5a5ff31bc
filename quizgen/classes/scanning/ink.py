"""What a pen left on a straightened page, in boxes and on lines.

Measured, not learned: how much ink lies in a box, how dark, how far it reaches and how sharp its
edges are. What lies between the limits is neither, and a person is asked.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quizgen.classes.scanning.pictures import SHARP
from quizgen.classes.scanning.registration import PlacedFrames, bend_page

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from quizgen.render.answer_sheet import SheetField

EMPTY, CROSSED, WITHDRAWN, DOUBTFUL = "empty", "crossed", "withdrawn", "doubtful"

HALF = 0.5
"""Scale of the page on which ink outside boxes is looked for: 4 pixels a millimetre."""
FRAME = 0.55
"""Millimetres inside a box that its frame may take."""
WEAK, CLEAR = 0.10, 0.18
"""Darkness from which something may be ink, and which a stroke of a pen has."""
SPECK, GRAIN, NOTHING = 0.008, 0.02, 0.003
"""Share of a box that a speck may cover; darkness above that of the page's empty boxes which grain
has, and mean darkness above that, up to which a box is empty."""
SHADED = 0.15
"""Darkness up to which the lightest fifth of a box is taken for its paper, near a fold."""
REACH = 0.38
"""Share of the box that a cross reaches over along both axes at least."""
THICKEST, FAINTEST, BROADEST = 0.55, 0.75, 0.12
"""Share of the box that a cross covers at most, with all that is dark at all, and with what is
broader than ``PEN``: a shadow, a stain, or strokes so close that they may be meant to fill."""
PEN, BAND = 11, 7
"""Pixels that no stroke is broader than: 1.4 mm; and one that goes straight through all of a box,
as the shadow of a fold does."""
FULL, FULL_EVERYWHERE = 0.85, 0.55
"""Share that a filled box covers at least, and a sixteenth of it."""
STEEP = 0.28
"""Rise over two pixels, as a share of the darkness of a stroke, that the edge of one has."""
NOISY = 0.035
"""Median difference of neighbouring pixels of paper, above which a picture is too dark to trust."""
PRINT = 235
"""Grey of a blank page below which something is printed."""
MARGIN = (5.2, 2.4)
"""Millimetres left of a box, and on its other sides, where ink beside it may mean it."""
LETTER_AT = (0.4, 5.0)
"""Millimetres right of a box between which its letter stands."""
FEWEST_PIXELS, LONGEST_SPECK = 12, 5
"""Half pixels of ink beside all fields, and how long it is, that are no dirt."""
WRITTEN = 2
"""Half pixels of ink on a line that are no dirt; blank lines of simulated scans have none."""
OVERHANG = 5
"""Half pixels that ink which is fast to the frame of an empty box may hang out."""


class BoxReading(NamedTuple):
    """What is in a box, and how far it is from being something else, from 0 to 1."""

    state: str
    confidence: float


class InkMap(NamedTuple):
    """Ink on a page, apart from print, at half scale.

    Parameters
    ----------
    labels : array
        Which piece of ink each pixel belongs to; 0 is none.
    stats : array
        Left, top, width, height and pixels of each piece.
    loose : set of int
        Pieces that touch no field.
    noise : float
    """

    labels: NDArray[np.int32]
    stats: NDArray[np.int32]
    loose: frozenset[int]
    noise: float


def map_ink(
    page: NDArray[np.uint8],
    blank: NDArray[np.uint8],
    fields: Sequence[SheetField],
    shift: NDArray[np.float32],
) -> InkMap:
    """Return the ink on a page that was not printed."""
    import cv2

    small = bend_page(page, shift, HALF)
    plain = cv2.resize(blank, small.shape[::-1], interpolation=cv2.INTER_AREA)
    noise = float(np.median(cv2.absdiff(page[:-1:4, ::4], page[1::4, ::4]))) / 255
    printed = cv2.erode(plain, np.ones((5, 5), np.uint8)) < PRINT
    zone = np.zeros(small.shape, np.uint8)
    for field in fields:
        left, top, right, bottom = _bound_pixels(field, 0.4, SHARP * HALF)
        zone[top:bottom, left:right] = 1
    least = max(1.3 * WEAK, 5 * noise)
    dark = small < round(250 - 255 * least)
    inner = zone.astype(bool)
    for field in fields:  # a frame joins what is within to what hangs out
        if field.kind == "box":
            left, top, right, bottom = _bound_pixels(field, 0.5, SHARP * HALF)
            printed[top:bottom, left:right] = False
    mask = (dark & ~printed).astype(np.uint8)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    touching = np.zeros(count, bool)
    touching[np.unique(labels[inner])] = True
    loose = frozenset(
        int(n)
        for n in range(1, count)
        if not touching[n]
        and stats[n, cv2.CC_STAT_AREA] >= FEWEST_PIXELS
        and max(stats[n, 2:4]) >= LONGEST_SPECK
    )
    return InkMap(labels, stats, loose, noise)


def _bound_pixels(field: SheetField, more: float, scale: float) -> tuple[int, int, int, int]:
    """Return left, top, right and bottom of a field that is made larger by ``more`` mm."""
    return (
        max(0, round((field.x - more) * scale)),
        max(0, round((field.y - more) * scale)),
        round((field.x + field.w + more) * scale),
        round((field.y + field.h + more) * scale),
    )


def read_boxes(
    page: NDArray[np.uint8], boxes: Sequence[SheetField], frames: PlacedFrames, ink: InkMap
) -> list[BoxReading]:
    """Return what is in each box of a page: the first of the frames."""
    if not boxes:
        return []
    cuts = [
        _cut_inside(page, box, middle)
        for box, middle in zip(boxes, frames.middles[: len(boxes)], strict=True)
    ]
    means = np.array([cut.mean() for cut in cuts])
    base = float(np.median(means[means <= np.median(means)]))
    floor = max(WEAK, 5 * ink.noise)
    found = [_judge_box(cut, base, floor) for cut in cuts]
    for place, box in enumerate(boxes):
        if found[place].state == EMPTY and _has_ink_beside(box, ink, boxes, found):
            found[place] = BoxReading(DOUBTFUL, 0.0)
    return found


def _cut_inside(
    page: NDArray[np.uint8], box: SheetField, middle: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Return the darkness, from 0 to 1, within the frame of a box."""
    import cv2

    side = round((box.w - 2 * FRAME) * SHARP)
    cut = cv2.getRectSubPix(page, (side, side), (float(middle[0]) - 0.5, float(middle[1]) - 0.5))
    return np.clip((250.0 - cut.astype(np.float32)) / 250.0, 0.0, 1.0)


def _judge_box(cut: NDArray[np.float32], base: float, floor: float) -> BoxReading:
    """Return what is in a box by its darkness within the frame.

    Parameters
    ----------
    cut : array
    base : float
        Mean darkness of the page's empty boxes.
    floor : float
        Darkness from which something is no noise.
    """
    import cv2

    paper = float(np.partition(cut.ravel(), cut.size // 5)[cut.size // 5])
    base = max(base, paper) if paper < SHADED else base
    smooth = cv2.blur(cut, (3, 3))
    weak = float((smooth > base + floor).mean())
    ink = float(np.maximum(smooth - base - GRAIN, 0).mean())
    if weak <= SPECK and ink <= NOTHING:
        return BoxReading(EMPTY, round(1 - weak / SPECK / 2, 2))
    smooth -= base
    peak = float(np.partition(smooth.ravel(), -12)[-12])
    if peak < CLEAR:
        return BoxReading(DOUBTFUL, 0.0)
    dark = (smooth > max(0.5 * peak, floor)).astype(np.uint8)
    covered, side = float(dark.mean()), len(dark) // 4
    cells = dark[: 4 * side, : 4 * side].reshape(4, side, 4, side)
    if covered >= FULL and float(cells.mean(axis=(1, 3)).min()) >= FULL_EVERYWHERE:
        return BoxReading(WITHDRAWN, round(covered, 2))
    reach = _measure_reach(dark)
    broad = float(cv2.morphologyEx(dark, cv2.MORPH_OPEN, np.ones((PEN, PEN), np.uint8)).mean())
    band = max(int((dark.mean(axis=axis) > 0.95).sum()) for axis in (0, 1))
    rise = max(float(np.abs(one[2:] - one[:-2]).max()) for one in (smooth, smooth.T))
    if (
        covered <= THICKEST
        and weak <= FAINTEST
        and broad <= BROADEST
        and band <= BAND
        and reach >= REACH
        and rise >= STEEP * peak
    ):
        return BoxReading(CROSSED, round(min(1.0, 0.5 + reach / 2), 2))
    return BoxReading(DOUBTFUL, 0.0)


def _measure_reach(dark: NDArray[np.uint8]) -> float:
    """Return how far ink reaches along that axis along which it reaches less, from 0 to 1."""
    import cv2

    count, labels, stats, _ = cv2.connectedComponentsWithStats(dark)
    kept = [n for n in range(1, count) if stats[n, cv2.CC_STAT_AREA] >= 6]
    seen = np.isin(labels, kept)
    spans = (np.flatnonzero(seen.any(axis=axis)) for axis in (0, 1))
    return min((float(np.ptp(span)) + 1 if len(span) else 0.0) / len(dark) for span in spans)


def _has_ink_beside(
    box: SheetField, ink: InkMap, boxes: Sequence[SheetField], found: Sequence[BoxReading]
) -> bool:
    """Return whether ink beside an empty box may mean it: beside all fields, or out of its frame.

    Ink that goes through another box which is not empty belongs to that one.
    """
    scale = SHARP * HALF
    left, top, right, bottom = _bound_pixels(box, MARGIN[1], scale)
    left = max(0, round((box.x - MARGIN[0]) * scale))
    around = ink.labels[top:bottom, left:right]
    if ink.loose.intersection(map(int, np.unique(around))):
        return True
    if _is_letter_crossed(box, ink):
        return True
    x, y, right, bottom = _bound_pixels(box, 0.4, scale)
    for piece in np.unique(ink.labels[y:bottom, x:right]):
        if piece:
            a, b, w, h, _ = ink.stats[piece]
            out = max(x - a, y - b, a + w - right, b + h - bottom)
            if out >= OVERHANG and not _goes_through(int(piece), box, ink, boxes, found):
                return True
    return False


def _is_letter_crossed(box: SheetField, ink: InkMap) -> bool:
    """Return whether ink is left around the letter that is printed right of a box.

    Print hides most of a cross over it: what sticks out are specks, which count together.
    """
    scale = SHARP * HALF
    left, right = (round((box.x + box.w + more) * scale) for more in LETTER_AT)
    top, bottom = (round(y * scale) for y in (box.y - LETTER_AT[0], box.y + box.h + LETTER_AT[0]))
    return int((ink.labels[top:bottom, left:right] > 0).sum()) >= FEWEST_PIXELS


def _goes_through(
    piece: int,
    box: SheetField,
    ink: InkMap,
    boxes: Sequence[SheetField],
    found: Sequence[BoxReading],
) -> bool:
    """Return whether a piece of ink goes through the inside of another box that is not empty."""
    for other, read in zip(boxes, found, strict=True):
        if other is not box and read.state in {CROSSED, WITHDRAWN}:
            left, top, right, bottom = _bound_pixels(other, -FRAME, SHARP * HALF)
            if (ink.labels[top:bottom, left:right] == piece).any():
                return True
    return False


def is_written_on(line: SheetField, ink: InkMap) -> bool:
    """Return whether something is written on a line."""
    left, top, right, bottom = _bound_pixels(line, 0.6, SHARP * HALF)
    pieces = np.unique(ink.labels[top:bottom, left:right])
    return any(piece and ink.stats[piece, 4] >= WRITTEN for piece in pieces)


def has_loose_ink(fields: Sequence[SheetField], ink: InkMap) -> bool:
    """Return whether ink that touches no field is near some fields."""
    for field in fields:
        left, top, right, bottom = _bound_pixels(field, MARGIN[1], SHARP * HALF)
        if ink.loose.intersection(map(int, np.unique(ink.labels[top:bottom, left:right]))):
            return True
    return False
