"""From a picture of a scanner to what stands on the sheets in it, a few pictures a job.

Pure: a job returns what was read and the pictures to keep, and writes nothing.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import numpy as np

from quizgen.classes.class_folder import PAPERS, SHEETS, ClassFolder
from quizgen.classes.roster import RosterStudent
from quizgen.classes.scanning.digits import has_ink, propose_number
from quizgen.classes.scanning.ink import (
    CROSSED,
    DOUBTFUL,
    NOISY,
    WITHDRAWN,
    BoxReading,
    InkMap,
    has_loose_ink,
    is_written_on,
    map_ink,
    read_boxes,
)
from quizgen.classes.scanning.pictures import (
    SHARP,
    ScanFileError,
    ScannedPicture,
    draw_blank_page,
    iter_pictures,
    open_pdf,
)
from quizgen.classes.scanning.registration import (
    FoundMark,
    SheetCode,
    bend_page,
    find_codes,
    find_homography,
    find_marks,
    flatten_paper,
    pick_anchors,
    place_frames,
    straighten_page,
)
from quizgen.classes.sheet_codes import SheetIndex
from quizgen.core.decoding import json_decoder
from quizgen.core.errors import ClassError
from quizgen.render.answer_sheet import PAPER_VERSION, POWER, SheetField, SheetPlaces

if TYPE_CHECKING:
    from numpy.typing import NDArray

FOREIGN, NO_CODE, EMPTY_PAGE, UNREADABLE = "foreign", "no_code", "empty", "unreadable"
"""Why a picture is of no sheet: another code, marks without a code, nothing on it, damaged."""
BILEVEL, CROOKED, DARK = "bilevel", "crooked", "dark"
"""Why a person is asked about a whole page."""
SEVERAL, WRITTEN, BESIDE, UNCLEAR = "several", "written", "beside", "unclear"
"""Why a person is asked about a part."""
ONE, MANY, PAIRS = "one", "many", "pairs"
LIKE = 0.45
"""Least likeness of frames on a page that was straightened."""
SMALLEST = 4.0
"""Pixels a millimetre, below which a picture is too coarse: 100 dpi."""
INKY = 0.0005
"""Share of a page that ink covers, if there is more on it than dust."""
CROP = 2.0
"""Millimetres around the fields of a part on its picture."""
SHORTEST, LONGEST = 100.0, 450.0
"""Sides of paper in mm."""
EDGE = 2.5
"""Millimetres of margin that a box keeps."""
LABEL = 11.0
"""Millimetres left of the fields that the name of the part takes."""
PAGE = "page"
"""Stands for a part in what the picture of the whole page is called."""
WHOLE, THUMB, KEPT = 4.0, 1000, 2400
"""Pixels a millimetre of a page's picture; of the longer side of one that is of no sheet; and of
one without a code, which a person may assign to a page, so that it is read after all."""


class PartReading(msgspec.Struct, frozen=True, omit_defaults=True):
    """What was read of a part.

    Parameters
    ----------
    answer : str or None
        As it would be typed; None if a person is to say.
    confidence : float
        Of the box that is read with the least, from 0 to 1.
    page : int
        Of the sheet, from 1.
    box : tuple of float
        Left, top, width and height on that page in millimetres.
    why : str
        Why a person is asked.
    proposal : str
        What it may be, where a person is asked.
    """

    answer: str | None
    confidence: float
    page: int
    box: tuple[float, float, float, float]
    why: str = ""
    proposal: str = ""


class PageReading(msgspec.Struct, frozen=True, omit_defaults=True):
    """What a picture shows of a sheet: a line of ``scans/pages.jsonl``.

    Parameters
    ----------
    file, digest : str
        Name and digest of the scanner's file.
    number : int
        Of the picture in it, from 1.
    student : str
        The id; empty if the picture is of no sheet of the class.
    paper : str
        The code of the paper, which names the folder of its pictures.
    page : int
        Of the sheet, from 1.
    fault : str
        Why it is of no sheet, or why all of it is asked.
    said : str
        What the code says that is not of this class, or what is damaged.
    parts : mapping of str to PartReading
    boxes, doubtful : int
        Boxes on the page, and how many of them were not read.
    copy : int
        1 if no sound picture of this page of this sheet came before.
    assigned : str
        When a person said whose page it is, or that it is of nobody after all. All earlier lines
        of the picture are void then.
    """

    file: str
    digest: str
    number: int
    student: str = ""
    paper: str = ""
    page: int = 0
    fault: str = ""
    said: str = ""
    parts: Mapping[str, PartReading] = {}
    boxes: int = 0
    doubtful: int = 0
    copy: int = 1
    assigned: str = ""


@dataclass(frozen=True)
class ReadingJob:
    """Pictures of one file that are read together.

    Parameters
    ----------
    folder : pathlib.Path
        That of the class.
    path : pathlib.Path
    digest : str
    numbers : tuple of int
        Of the pictures, from 0.
    """

    folder: Path
    path: Path
    digest: str
    numbers: tuple[int, ...]


class ReadPicture(NamedTuple):
    """What was read of a sheet in a picture, and what to keep by its name.

    That is ``PAGE`` for the whole page, or the name of a part.
    """

    reading: PageReading
    pictures: dict[str, bytes]


class _SheetSpec(msgspec.Struct):
    """The kind of a specification."""

    kind: str


class _SheetPart(msgspec.Struct):
    """A part's id and specification."""

    id: str
    spec: _SheetSpec


class _SheetQuestion(msgspec.Struct):
    """The parts of a question."""

    parts: list[_SheetPart]


class _SheetKey(msgspec.Struct):
    """The questions of a key."""

    questions: list[_SheetQuestion]


class _SheetLine(msgspec.Struct):
    """What a line of ``keys.jsonl`` says of a sheet."""

    key: _SheetKey
    sheet: SheetPlaces | None = None


_LINE = json_decoder(_SheetLine).decode


class StudentSheet(NamedTuple):
    """The sheet of a student: its places, the kinds of the parts in the order of the paper."""

    places: SheetPlaces
    kinds: dict[str, str]


def read_student_sheet(path: Path, at: int) -> StudentSheet:
    """Return the sheet in the line of ``keys.jsonl`` that begins at a byte.

    Raises
    ------
    ClassError
        If the paper has none, or places that lie on no page.
    """
    with path.open("rb") as stream:
        stream.seek(at)
        try:
            found = _LINE(stream.readline())
        except msgspec.DecodeError as error:
            raise ClassError(f"{path}: byte {at}: {error}") from None
    if found.sheet is None:
        raise ClassError(
            f"{path.parent}: has no papers or sheets to read (quizgen class make --scan, --sheet)"
        )
    if not _is_on_page(found.sheet):
        raise ClassError(f"{path}: byte {at}: places of a sheet that lie on no page; make it again")
    kinds = {part.id: part.spec.kind for one in found.key.questions for part in one.parts}
    return StudentSheet(found.sheet, kinds)


def _is_on_page(places: SheetPlaces) -> bool:
    """Return whether a sheet is as large as paper and has its marks, code and fields on it.

    Boxes keep a margin: their frames are looked for around the place where they should be.
    """
    width, height = places.size
    squares = ((x, y, side, side, 0.0) for x, y, side in (*places.marks, places.code))
    fields = ((f.x, f.y, f.w, f.h, EDGE if f.kind == "box" else 0.0) for f in places.fields)
    return all(SHORTEST <= side <= LONGEST for side in places.size) and all(
        edge <= x and edge <= y and w > 0 and h > 0 and x + w <= width - edge
        and y + h <= height - edge
        for x, y, w, h, edge in (*squares, *fields)
    )  # fmt: skip


@lru_cache(maxsize=1)
def _open_index(folder: Path, _stamp: int) -> SheetIndex:
    """Return the codes of a class, read once in a process while its keys do not change."""
    return SheetIndex(ClassFolder(folder))


def read_job(job: ReadingJob) -> list[ReadPicture]:
    """Return what the pictures of a job show; the same in any process."""
    import cv2

    cv2.setNumThreads(1)
    index = _open_index(job.folder, (job.folder / "keys.jsonl").stat().st_mtime_ns)
    found = []
    for number, picture in iter_pictures(job.path, job.numbers):
        base = PageReading(job.path.name, job.digest, number + 1)
        if isinstance(picture, ScanFileError):
            said = picture.message
            lost = msgspec.structs.replace(base, fault=UNREADABLE, said=said)
            found.append(ReadPicture(lost, {}))
        else:
            found += _read_picture(picture, index, base)
    return found


def read_assigned_picture(folder: ClassFolder, base: PageReading, path: Path) -> ReadPicture:
    """Return what a picture that was kept shows, as the page of a student that a person says it is.

    Raises
    ------
    ScanFileError
        If the picture cannot be read any more.
    """
    _, picture = next(iter_pictures(path, (0,)))
    if isinstance(picture, ScanFileError):
        raise picture
    _, at = folder.places()[base.student]
    return _SheetReader(folder, base, at).read(picture, None, find_marks(picture.grey))


def _read_picture(
    picture: ScannedPicture, index: SheetIndex, base: PageReading
) -> list[ReadPicture]:
    """Return what a picture shows: each sheet in it, or why it is of none."""
    grey = picture.grey
    codes = find_codes(grey)
    ours = [(code, page) for code in codes if (page := index.find_page(code.text))]
    marks = find_marks(grey) if ours or not codes else []
    if not ours and not codes and len({one.number for one in marks}) >= 3:
        ours = [*_search_code(grey, marks, index)]
    if not ours:
        return [_describe_stray_picture(grey, codes, marks, base)]
    return [
        _SheetReader(
            index.folder,
            msgspec.structs.replace(base, student=head.id, paper=head.code, page=page),
            at,
        ).read(picture, code, marks)
        for code, (head, at, page) in ours
    ]


def _search_code(
    grey: NDArray[np.uint8], marks: Sequence[FoundMark], index: SheetIndex
) -> Iterator[tuple[SheetCode, Any]]:
    """Yield the code of a page whose marks alone were found, looked for where it must be."""
    import cv2

    _, at = next(iter(index.folder.places().values()))
    places = read_student_sheet(index.folder.path / "keys.jsonl", at).places
    homography, _ = find_homography(places, None, marks)
    if homography is None:
        return
    x, y, side = places.code
    scale, around = 14.0, 4.0
    offset = np.array([[1 / scale, 0, x - around], [0, 1 / scale, y - around], [0, 0, 1]])
    size = round((side + 2 * around) * scale)
    cut = cv2.warpPerspective(
        grey, homography @ offset, (size, size), flags=cv2.INTER_CUBIC | cv2.WARP_INVERSE_MAP,
        borderValue=255,
    )  # fmt: skip
    for code in find_codes(cut):
        page = index.find_page(code.text)
        if page:
            there = cv2.perspectiveTransform(code.corners[None], homography @ offset)[0]
            yield SheetCode(code.text, there.astype(np.float32)), page
            return


def _describe_stray_picture(
    grey: NDArray[np.uint8],
    codes: Sequence[SheetCode],
    marks: Sequence[FoundMark],
    base: PageReading,
) -> ReadPicture:
    """Return why a picture is of no sheet of the class, and a small copy to look at."""
    flat = flatten_paper(grey)
    edge = [round(side * 0.06) for side in flat.shape]
    inside = flat[edge[0] : -edge[0] or None, edge[1] : -edge[1] or None]
    fault = FOREIGN
    if not codes:
        dark = float((inside < 170).mean())
        fault = NO_CODE if marks or dark > INKY else EMPTY_PAGE
    said = codes[0].text[:80] if codes else ""
    longest = KEPT if fault == NO_CODE else THUMB
    kept = {} if fault == EMPTY_PAGE else {PAGE: _encode_small_picture(grey, longest)}
    return ReadPicture(msgspec.structs.replace(base, fault=fault, said=said), kept)


class _SheetReader:
    """Reads one sheet in a picture.

    Parameters
    ----------
    folder : ClassFolder
    base : PageReading
        Whose page it is.
    at : int
        Where the line of its key begins.
    """

    def __init__(self, folder: ClassFolder, base: PageReading, at: int) -> None:
        self.folder, self.base = folder, base
        self.sheet = read_student_sheet(folder.path / "keys.jsonl", at)
        fields = self.sheet.places.fields
        self.fields = [one for one in fields if one.page == base.page and one.kind != "points"]
        self.is_paper = self.sheet.places.version == PAPER_VERSION
        self.boxes = [one for one in self.fields if one.kind == "box"]

    def read(
        self, picture: ScannedPicture, code: SheetCode | None, marks: Sequence[FoundMark]
    ) -> ReadPicture:
        """Return what the sheet says, and its pictures."""
        places = self.sheet.places
        homography, _ = find_homography(places, code, marks)
        if homography is None:
            return self._ask_unstraightened(picture.grey)
        page = straighten_page(picture.grey, places, homography)
        blank = self._draw_blank()
        anchors = pick_anchors(blank, self.fields) if self.is_paper else []
        placed = (*self.boxes, *anchors)
        frames = place_frames(page, blank, placed) if placed else None
        shift = frames.shift if frames else np.zeros((1, 2), np.float32)
        ink = map_ink(page, blank, self.fields, shift)
        fault = self._find_fault(picture, homography, frames.likeness if frames else 1.0, ink)
        read = read_boxes(page, self.boxes, frames, ink) if frames else []
        if fault:
            read = [BoxReading(DOUBTFUL, 0.0) for _ in self.boxes]
        shown = bend_page(page, shift, 1.0)
        parts = dict(self._iter_parts(dict(zip(self.boxes, read, strict=True)), ink, fault))
        if not fault:
            parts = {part: self._propose(part, one, shown, blank) for part, one in parts.items()}
        pictures = {PAGE: _draw_readings(shown, self.boxes, read, parts)} | {
            part: _cut_part(shown, one.box) for part, one in parts.items() if one.answer is None
        }
        made = msgspec.structs.replace(
            self.base,
            fault=fault,
            parts=parts,
            boxes=len(read),
            doubtful=sum(one.state == DOUBTFUL for one in read),
        )
        return ReadPicture(made, pictures)

    def _propose(
        self, part: str, read: PartReading, page: NDArray[np.uint8], blank: NDArray[np.uint8]
    ) -> PartReading:
        """Return what was read of a part, with the number that may be written there."""
        fields = [one for one in self.fields if one.part == part and one.kind == "line"]
        if read.why != WRITTEN or not all(one.is_number for one in fields):
            return read
        said = [*_iter_proposals(page, blank, fields)]
        if not all(said):
            return read
        pairs = [one.option for one in fields if one.option != POWER]
        joined = ", ".join(map(":".join, zip(pairs, said, strict=True)))
        made = joined if self.sheet.kinds[part] == "match" else "; ".join(said)
        return msgspec.structs.replace(read, proposal=made)

    def _draw_blank(self) -> NDArray[np.uint8]:
        """Return the page as it was printed.

        Raises ``ScanFileError`` if its file is not there or damaged.
        """
        kind = PAPERS if self.is_paper else SHEETS
        path = self.folder.path / kind / f"{RosterStudent(self.base.student).file}.pdf"
        try:
            with open_pdf(path) as document:
                return draw_blank_page(document[self.base.page - 1])
        except (ScanFileError, RuntimeError, IndexError, ValueError):
            said = "is missing or damaged; quizgen class make makes it again"
            raise ScanFileError(said, rule="QG610", file=path) from None

    def _find_fault(
        self,
        picture: ScannedPicture,
        homography: NDArray[np.float64],
        likeness: float,
        ink: InkMap,
    ) -> str:
        """Return why a person is asked about all of the page; empty if it reads well."""
        if picture.bilevel:
            return BILEVEL
        width, height = self.sheet.places.size
        corners = homography @ np.array([[0, width, 0], [0, 0, height], [1, 1, 1]])
        corners = corners[:2] / corners[2]
        scale = min(
            float(np.hypot(*(corners[:, 1] - corners[:, 0]))) / width,
            float(np.hypot(*(corners[:, 2] - corners[:, 0]))) / height,
        )
        if ink.noise > NOISY or scale < SMALLEST * 0.95:
            return DARK
        return CROOKED if likeness < LIKE else ""

    def _ask_unstraightened(self, grey: NDArray[np.uint8]) -> ReadPicture:
        """Return that all of a page is asked whose marks were not found."""
        parts = {
            part: PartReading(None, 0.0, self.base.page, _bound_fields(fields), CROOKED)
            for part, fields in self._group_fields().items()
        }
        made = msgspec.structs.replace(
            self.base, fault=CROOKED, parts=parts,
            boxes=len(self.boxes), doubtful=len(self.boxes),
        )  # fmt: skip
        whole = _encode_picture(_shrink_picture(grey, THUMB), ".png", PNG)
        return ReadPicture(made, {PAGE: _encode_small_picture(grey), **dict.fromkeys(parts, whole)})

    def _group_fields(self) -> dict[str, list[SheetField]]:
        """Return the fields of each part on the page."""
        found: dict[str, list[SheetField]] = {}
        for one in self.fields:
            found.setdefault(one.part, []).append(one)
        return found

    def _iter_parts(
        self, read: Mapping[SheetField, BoxReading], ink: InkMap, fault: str
    ) -> Iterator[tuple[str, PartReading]]:
        """Yield what was read of each part."""
        for part, fields in self._group_fields().items():
            place = self.base.page, _bound_fields(fields)
            boxes = [one for one in fields if one.kind == "box"]
            if boxes:
                way = _find_way(boxes, self.sheet.kinds.get(part, ""))
                answer, why = _join_crosses(boxes, [read[one] for one in boxes], way)
                sure = min(read[one].confidence for one in boxes)
                asked = fault or why
            else:
                answer, sure, asked = "", 1.0, fault
                room = [one for one in fields if one.kind == "room"]
                lines = [one for one in fields if one.kind == "line"]
                if any(is_written_on(one, ink) for one in lines):
                    asked = asked or WRITTEN
                elif has_loose_ink(lines, ink) or any(is_written_on(one, ink) for one in room):
                    asked = asked or BESIDE
            if asked:
                yield part, PartReading(None, 0.0, *place, asked, "" if fault else answer)
            else:
                yield part, PartReading(answer, sure, *place)


def _iter_proposals(
    page: NDArray[np.uint8], blank: NDArray[np.uint8], fields: Sequence[SheetField]
) -> Iterator[str]:
    """Yield what may be written as each number, empty if it reads badly; powers of ten with it."""
    for field, after in zip(fields, (*fields[1:], None), strict=True):
        if field.option == POWER:
            continue
        said = propose_number(page, blank, field)
        if said and after is not None and after.option == POWER and has_ink(page, blank, after):
            power = propose_number(page, blank, after)
            said = f"{said}·10^{power}" if _WHOLE.fullmatch(power) else ""
        yield said


_WHOLE = re.compile(r"-?\d{1,2}")
"""What stands in a field for a power of ten."""


def _find_way(fields: Sequence[SheetField], kind: str) -> str:
    """Return how many boxes of a part may be crossed: one, many, or one in each row of pairs."""
    if ":" in fields[0].option:
        return PAIRS
    return MANY if kind == "multi" else ONE


def _join_crosses(
    fields: Sequence[SheetField], read: Sequence[BoxReading], way: str
) -> tuple[str, str]:
    """Return the boxes that are crossed, as one would type it, and why a person is asked."""
    crossed = [box.option for box, one in zip(fields, read, strict=True) if one.state == CROSSED]
    why = UNCLEAR if any(one.state == DOUBTFUL for one in read) else ""
    rows = [option.partition(":")[0] if way == PAIRS else "" for option in crossed]
    if way != MANY and len({*rows}) < len(rows):
        why = SEVERAL
    return ", ".join(crossed), why


def _bound_fields(fields: Sequence[SheetField]) -> tuple[float, float, float, float]:
    """Return left, top, width and height of some fields."""
    left, top = min(one.x for one in fields), min(one.y for one in fields)
    right = max(one.x + one.w for one in fields)
    bottom = max(one.y + one.h for one in fields)
    return round(left, 2), round(top, 2), round(right - left, 2), round(bottom - top, 2)


def _cut_part(page: NDArray[np.uint8], box: tuple[float, float, float, float]) -> bytes:
    """Return the picture of a part, with its name, as PNG of 16 greys."""
    import cv2

    x, y, w, h = box
    left, top = max(0, round((x - LABEL) * SHARP)), max(0, round((y - CROP) * SHARP))
    right, bottom = round((x + w + 2 * CROP) * SHARP), round((y + h + CROP) * SHARP)
    cut = cv2.resize(page[top:bottom, left:right], None, fx=0.75, fy=0.75,
                     interpolation=cv2.INTER_AREA)  # fmt: skip
    return _encode_picture((cut & 0xF0) | (cut >> 4), ".png", PNG)


PNG = (16, 6)
"""OpenCV's number of the compression of PNG, and how much."""
COLOURS = {CROSSED: (60, 150, 20), WITHDRAWN: (160, 120, 120), DOUBTFUL: (0, 90, 230)}
"""Blue, green and red of the frame around a box that is not empty."""


def _draw_readings(
    page: NDArray[np.uint8],
    boxes: Sequence[SheetField],
    read: Sequence[BoxReading],
    parts: Mapping[str, PartReading],
) -> bytes:
    """Return a page as JPEG, with frames around what was read and what is asked."""
    import cv2

    scale = WHOLE / SHARP
    small = cv2.resize(page, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    shown = cv2.cvtColor(small, cv2.COLOR_GRAY2BGR)

    def frame(box: tuple[float, float, float, float], colour: tuple[int, int, int]) -> None:
        """Draw a frame around a place."""
        x, y, w, h = (value * WHOLE for value in box)
        cv2.rectangle(
            shown, (round(x) - 4, round(y) - 4), (round(x + w) + 4, round(y + h) + 4), colour, 2
        )

    for box, one in zip(boxes, read, strict=True):
        if one.state in COLOURS:
            frame((box.x, box.y, box.w, box.h), COLOURS[one.state])
    for asked in (one.box for one in parts.values() if one.answer is None):
        frame(asked, COLOURS[DOUBTFUL])
    return _encode_picture(shown, ".jpg", (cv2.IMWRITE_JPEG_QUALITY, 60))


def _encode_small_picture(grey: NDArray[np.uint8], longest: int = THUMB) -> bytes:
    """Return a picture of a scanner, made small, as JPEG."""
    import cv2

    return _encode_picture(_shrink_picture(grey, longest), ".jpg", (cv2.IMWRITE_JPEG_QUALITY, 60))


def _shrink_picture(grey: NDArray[np.uint8], longest: int) -> NDArray[np.uint8]:
    """Return a picture whose longer side has no more than so many pixels."""
    import cv2

    scale = min(1.0, longest / max(grey.shape))
    return cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)


def _encode_picture(image: NDArray[np.uint8], suffix: str, how: tuple[int, int]) -> bytes:
    """Return a picture as the bytes of a file."""
    import cv2

    _, data = cv2.imencode(suffix, image, how)
    return data.tobytes()
