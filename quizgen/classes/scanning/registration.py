"""Where a sheet lies in a picture, and the sheet straightened.

Marks and code give a homography, frames of boxes what is left of bends and folds.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from quizgen.classes.scanning.pictures import SHARP
from quizgen.render.answer_sheet import SheetField

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from quizgen.render.answer_sheet import SheetPlaces

FOUND_AT = 1800
"""Pixels of the longer side at which marks are looked for."""
STRAY = 0.3
"""How far from where the code says a mark may be, as a share of their distance."""
FEWEST_MARKS = 2
ANCHOR, EDGE, CELLS = (6.0, 4.0), 16.0, (6, 10)
"""Width and height of a place of print, how far it is from the edge of the page at least, and in
how many parts across and down one is looked for."""
FAINT = 0.05
"""Share of the strongest place of print that another has at least."""
REACH = 8
"""Pixels that a frame may be off after straightening by four marks: a millimetre."""
TRUSTED, OFF = 0.75, 4.0
"""Likeness from which a frame's own place is taken, if it is so many pixels off the smooth one."""

COARSE = 24
"""Places along each side at which a bend is worked out."""


class SheetCode(NamedTuple):
    """A code in a picture: what it says, and its corners clockwise from its upper left."""

    text: str
    corners: NDArray[np.float32]


class FoundMark(NamedTuple):
    """A corner mark in a picture: which, and its corners clockwise from its upper left."""

    number: int
    corners: NDArray[np.float32]


class PlacedFrames(NamedTuple):
    """Where the boxes of a straightened page are.

    Parameters
    ----------
    middles : array
        Of each box, in pixels.
    shift : array
        Coefficients of how far print is off along x and y, over the page.
    likeness : float
        Of the frames to what was printed, from 0 to 1.
    """

    middles: NDArray[np.float32]
    shift: NDArray[np.float32]
    likeness: float


def find_codes(grey: NDArray[np.uint8]) -> list[SheetCode]:
    """Return all QR codes in a picture."""
    import zxingcpp

    found = []
    kinds = zxingcpp.BarcodeFormat.QRCode
    for one in zxingcpp.read_barcodes(grey, formats=kinds, try_invert=False):
        at = one.position
        corners = (at.top_left, at.top_right, at.bottom_right, at.bottom_left)
        found.append(SheetCode(one.text, np.array([(p.x, p.y) for p in corners], np.float32)))
    return sorted(found, key=lambda code: (code.text, *map(float, code.corners[0])))


@cache
def _open_detector() -> Any:
    """Return OpenCV's detector of the marks that answer sheets have."""
    import cv2

    wished = cv2.aruco.DetectorParameters()
    wished.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_NONE
    wished.adaptiveThreshWinSizeMin, wished.adaptiveThreshWinSizeMax = 11, 31
    wished.adaptiveThreshWinSizeStep = 10
    wished.minMarkerPerimeterRate = 0.03
    return cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50), wished)


def find_marks(grey: NDArray[np.uint8]) -> list[FoundMark]:
    """Return the corner marks in a picture; there may be those of several sheets."""
    import cv2

    scale = min(1.0, FOUND_AT / max(grey.shape))
    small = (
        cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
        if scale < 1
        else grey
    )
    places, numbers, _ = _open_detector().detectMarkers(small)
    found = []
    for place, number in zip(places, () if numbers is None else numbers.ravel(), strict=True):
        if number > 3:
            continue
        corners = np.ascontiguousarray((place.reshape(4, 2) + 0.5) / scale - 0.5, np.float32)
        near = max(2, int(np.ptp(corners[:, 0]) / 14))
        limits = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 20, 0.05)
        found.append(
            FoundMark(int(number), cv2.cornerSubPix(grey, corners, (near, near), (-1, -1), limits))
        )
    return found


def find_homography(
    places: SheetPlaces, code: SheetCode | None, marks: Sequence[FoundMark]
) -> tuple[NDArray[np.float64] | None, int]:
    """Return the homography from millimetres of a sheet to pixels, and by how many marks.

    None if too few marks are there. Without a code all marks are taken for those of one sheet.
    """
    import cv2

    own = _select_marks(places, code, marks)
    if len(own) < (FEWEST_MARKS if code else 3):
        return None, len(own)
    source = [_list_corners(places.marks[one.number]) for one in own]
    target = [one.corners for one in own]
    if code and len(own) < len(places.marks):
        source.append(_list_corners(places.code))
        target.append(code.corners)
    found, _ = cv2.findHomography(np.concatenate(source), np.concatenate(target), cv2.RANSAC, 4.0)
    return found, len(own)


def _select_marks(
    places: SheetPlaces, code: SheetCode | None, marks: Sequence[FoundMark]
) -> list[FoundMark]:
    """Return one mark of each number: that which lies nearest to where the code says."""
    import cv2

    if code is None:
        return [next(m for m in marks if m.number == n) for n in sorted({m.number for m in marks})]
    corners = _list_corners(places.code)
    guess, _ = cv2.estimateAffinePartial2D(corners, code.corners)
    if guess is None:
        return []
    scale = float(np.hypot(guess[0, 0], guess[1, 0]))
    found = []
    for number in sorted({one.number for one in marks}):
        middle = _list_corners(places.marks[number]).mean(axis=0)
        expected = guess[:, :2] @ middle + guess[:, 2]
        off, nearest = min(
            (float(np.hypot(*(one.corners.mean(axis=0) - expected))), place)
            for place, one in enumerate(marks)
            if one.number == number
        )
        if off < STRAY * scale * max(40.0, float(np.hypot(*(middle - corners.mean(axis=0))))):
            found.append(marks[nearest])
    return found


def _list_corners(place: tuple[float, float, float]) -> NDArray[np.float32]:
    """Return the corners of a square, clockwise from its upper left."""
    x, y, side = place
    return np.array([(x, y), (x + side, y), (x + side, y + side), (x, y + side)], np.float32)


def straighten_page(
    grey: NDArray[np.uint8], places: SheetPlaces, homography: NDArray[np.float64]
) -> NDArray[np.uint8]:
    """Return the sheet upright at ``SHARP``, its paper white everywhere."""
    import cv2

    width, height = (round(side * SHARP) for side in places.size)
    there = homography @ np.diag([1 / SHARP, 1 / SHARP, 1.0])
    page = cv2.warpPerspective(
        grey,
        there,
        (width, height),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_CONSTANT,
        borderValue=255,
    )
    return flatten_paper(page)


def flatten_paper(page: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return a page whose paper is white: shadows and stains that are wider than strokes go."""
    import cv2

    small = cv2.resize(page, None, fx=0.125, fy=0.125, interpolation=cv2.INTER_AREA)
    paper = cv2.dilate(small, np.ones((7, 7), np.uint8))
    paper = cv2.GaussianBlur(paper, (0, 0), 2.5)
    whole = cv2.resize(paper, page.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return cv2.divide(page, cv2.max(whole, 40), scale=250)


def pick_anchors(blank: NDArray[np.uint8], fields: Sequence[SheetField]) -> list[SheetField]:
    """Return places of print on a page that lie still on paper: one in each part of the page.

    Print with corners, where nobody is to write: by it a page without boxes is straightened, too.
    """
    import cv2

    scale = 0.25
    small = cv2.resize(blank, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    shape = tuple(round(side * SHARP * scale) for side in ANCHOR)
    found = cv2.cornerMinEigenVal(small, 3)
    found = cv2.boxFilter(found, -1, shape)
    for one in fields:
        x, y = ((one.x - ANCHOR[0]) * SHARP * scale, (one.y - ANCHOR[1]) * SHARP * scale)
        right, bottom = (one.x + one.w + ANCHOR[0], one.y + one.h + ANCHOR[1])
        found[max(0, round(y)) : round(bottom * SHARP * scale),
              max(0, round(x)) : round(right * SHARP * scale)] = 0  # fmt: skip
    edge = round(EDGE * SHARP * scale)
    anchors = []
    rows = np.linspace(edge, small.shape[0] - edge, CELLS[1] + 1).astype(int)
    columns = np.linspace(edge, small.shape[1] - edge, CELLS[0] + 1).astype(int)
    least = float(found[edge:-edge, edge:-edge].max()) * FAINT
    for top, bottom in pairwise(rows):
        for left, right in pairwise(columns):
            _, best, _, (x, y) = cv2.minMaxLoc(found[top:bottom, left:right])
            if best > least:
                middle = (left + x + 0.5) / scale / SHARP, (top + y + 0.5) / scale / SHARP
                place = (middle[0] - ANCHOR[0] / 2, middle[1] - ANCHOR[1] / 2, *ANCHOR)
                anchors.append(SheetField(0, "", "anchor", *place))
    return anchors


def place_frames(
    page: NDArray[np.uint8],
    blank: NDArray[np.uint8],
    boxes: Sequence[SheetField],
    reach: int = REACH,
) -> PlacedFrames:
    """Return where the boxes of a straightened page are, by their frames.

    Each frame is looked for where it should be; a smooth surface through all of them tells what a
    frame that is hidden by ink cannot.
    """
    import cv2

    nominal = np.array([(b.x + b.w / 2, b.y + b.h / 2) for b in boxes], np.float32) * SHARP
    offs = np.zeros((len(boxes), 2), np.float32)
    likeness = np.zeros(len(boxes), np.float32)
    for place, box in enumerate(boxes):
        left, top, right, bottom = (
            round(v * SHARP) for v in (box.x - 1, box.y - 1, box.x + box.w + 1, box.y + box.h + 1)
        )
        window = page[top - reach : bottom + reach, left - reach : right + reach]
        scores = cv2.matchTemplate(window, blank[top:bottom, left:right], cv2.TM_CCOEFF_NORMED)
        _, best, _, (x, y) = cv2.minMaxLoc(scores)
        likeness[place] = best
        offs[place] = (
            x - reach + _refine_peak(scores[y], x),
            y - reach + _refine_peak(scores[:, x], y),
        )
    shift = _fit_surface(nominal, offs, likeness, page.shape)
    smooth = _expand_terms(nominal, len(shift), page.shape) @ shift
    near = (likeness > TRUSTED) & (np.hypot(*(offs - smooth).T) < OFF)
    middles = nominal + np.where(near[:, None], offs, smooth)
    return PlacedFrames(middles.astype(np.float32), shift, float(np.median(likeness)))


def _refine_peak(scores: NDArray[np.float32], at: int) -> float:
    """Return how far beside a whole pixel the peak of three neighbours lies."""
    if not 0 < at < len(scores) - 1:
        return 0.0
    before, peak, after = map(float, scores[at - 1 : at + 2])
    bend = before - 2 * peak + after
    return 0.5 * (before - after) / bend if bend < -1e-6 else 0.0


def _expand_terms(
    points: NDArray[np.float32], count: int, shape: tuple[int, ...]
) -> NDArray[np.float32]:
    """Return the first terms of a polynomial in x and y at some points of a page."""
    x, y = points[:, 0] / shape[1] * 2 - 1, points[:, 1] / shape[0] * 2 - 1
    terms = [np.ones_like(x), x, y, x * y, x * x, y * y, y**3, x * y * y]
    return np.stack(terms[:count], axis=1).astype(np.float32)


def _fit_surface(
    points: NDArray[np.float32],
    offs: NDArray[np.float32],
    likeness: NDArray[np.float32],
    shape: tuple[int, ...],
) -> NDArray[np.float32]:
    """Return the coefficients of a smooth surface through offsets, some of which are far off."""
    count = 8 if len(points) >= 24 else 3 if len(points) >= 8 else 1
    terms = _expand_terms(points, count, shape)
    trust = np.maximum(likeness - 0.3, 0.01) ** 2
    weights = trust
    shift = np.zeros((count, 2), np.float32)
    for _ in range(6):
        shift = np.linalg.lstsq(terms * weights[:, None], offs * weights[:, None], rcond=None)[0]
        rest = np.hypot(*(offs - terms @ shift).T)
        weights = trust / (1 + (rest / max(0.6, float(np.median(rest)))) ** 2)
    return shift.astype(np.float32)


def bend_page(
    page: NDArray[np.uint8], shift: NDArray[np.float32], scale: float
) -> NDArray[np.uint8]:
    """Return a page made smaller, with print where it was printed."""
    import cv2

    height, width = (round(side * scale) for side in page.shape)
    middles = (np.arange(COARSE) + 0.5) / COARSE
    columns, rows = np.meshgrid(middles * page.shape[1], middles * page.shape[0])
    points = np.stack([columns.ravel(), rows.ravel()], axis=1).astype(np.float32)
    offs = (_expand_terms(points, len(shift), page.shape) @ shift).reshape(COARSE, COARSE, 2)
    offs = cv2.resize(np.ascontiguousarray(offs, np.float32), (width, height))
    along_x = offs[..., 0] + (np.arange(width, dtype=np.float32) + 0.5)[None, :] / scale - 0.5
    along_y = offs[..., 1] + (np.arange(height, dtype=np.float32) + 0.5)[:, None] / scale - 0.5
    smooth = cv2.blur(page, (2, 2))
    return cv2.remap(
        smooth,
        along_x,
        along_y,
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_CONSTANT,
        borderValue=250,
    )
