"""The scanned pages of a student with marks on them: what was read, and what each part earned."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from quizgen.classes.class_folder import KEYS, ClassFolder, PrintedHead
from quizgen.classes.grading import GradedClassPart, StudentMarks
from quizgen.classes.rulings import is_on_paper
from quizgen.classes.scanning.pages import WHOLE, StudentSheet, read_student_sheet
from quizgen.classes.scanning.scan_folder import find_page_pictures
from quizgen.core.errors import ClassError
from quizgen.locale import format_amount
from quizgen.render.answer_sheet import SheetField
from quizgen.render.fonts import PRINT

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw
    from PIL.ImageFont import FreeTypeFont

FULL, SOME, NONE, READ = (20, 112, 74), (160, 96, 0), (179, 48, 42), (30, 70, 160)
"""Colours of all points, of some, of none, and of what was read."""
HIGH, SMALL = 4.4, 3.0
"""Millimetres that points and answers are high."""
LONGEST = 26
"""Signs of an answer that are written beside it."""
ROOM = 24.0
"""Millimetres above and right of the last field of a part, where a page has no box for points."""


def draw_marked_pages(
    folder: ClassFolder, head: PrintedHead, at: int, marks: StudentMarks
) -> list[bytes]:
    """Return the scanned pages of a student as JPEG, with marks on them.

    Parameters
    ----------
    folder : ClassFolder
    head : PrintedHead
    at : int
        Where the line of the key begins.
    marks : StudentMarks

    Raises
    ------
    ClassError
        If a picture is damaged.
    """
    pictures = find_page_pictures(folder, head)
    if not pictures:
        return []
    sheet = read_student_sheet(folder.path / KEYS, at)
    parts = {one.id: one for one in marks.parts}
    return [_draw_marks(path, sheet, parts, marks.lang) for path in pictures]


def _draw_marks(
    path: Path, sheet: StudentSheet, parts: Mapping[str, GradedClassPart], lang: str
) -> bytes:
    """Return the picture of a page with marks; as it is if it could not be straightened."""
    from PIL import Image, ImageDraw, ImageFont

    out = io.BytesIO()
    try:
        with Image.open(path, formats=("JPEG",)) as picture:
            shown = picture.convert("RGB")
        if all(abs(a - b * WHOLE) < 2 for a, b in zip(shown.size, sheet.places.size, strict=True)):
            pen = ImageDraw.Draw(shown)
            fonts = [ImageFont.truetype(FONT, round(size * WHOLE)) for size in (HIGH, SMALL)]
            page = int(path.stem.split("-")[1])
            for part, field in _find_spots(sheet, page).items():
                if part in parts:
                    _write_mark(pen, fonts, parts[part], field, lang)
        shown.save(out, "JPEG", quality=70)
    except (OSError, ValueError) as error:
        raise ClassError(f"{path}: is damaged ({error})") from None
    return out.getvalue()


FONT = str(PRINT / "source-sans-3-600.ttf")


def _find_spots(sheet: StudentSheet, page: int) -> dict[str, SheetField]:
    """Return where marks stand on a page, by the part: in its box for points, or beside it."""
    found: dict[str, SheetField] = {}
    for one in sheet.places.fields:
        if one.page == page and (one.kind == "points" or found.get(one.part) is None
                                 or found[one.part].kind != "points"):  # fmt: skip
            found[one.part] = one
    return found


def _write_mark(
    pen: ImageDraw,
    fonts: Sequence[FreeTypeFont],
    part: GradedClassPart,
    field: SheetField,
    lang: str,
) -> None:
    """Write what a part earned, and below it what was read, from the right end of its field."""
    right = field.x + field.w
    earned = "?" if part.marks is None else format_amount(part.marks, lang)
    colour = NONE
    if part.marks is None or 0 < part.marks < part.points:
        colour = SOME
    elif part.marks or not part.points:
        colour = FULL
    if field.kind != "points":
        earned, right = f"{earned} / {format_amount(part.points, lang)}", right + ROOM
    pen.text(
        ((right - (5.5 if field.kind == "points" else 0)) * WHOLE, field.y * WHOLE),
        earned, fill=colour, font=fonts[0], anchor="ra",
    )  # fmt: skip
    typed = "" if is_on_paper(part.typed) else " ".join(part.typed.split())
    if typed:
        said = typed if len(typed) <= LONGEST else f"{typed[: LONGEST - 1]}…"
        pen.text((right * WHOLE, (field.y + field.h + 0.3) * WHOLE), said, fill=READ,
                 font=fonts[1], anchor="ra")  # fmt: skip
