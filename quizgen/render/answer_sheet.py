"""The compact answer sheet of a paper: boxes and lines whose places are known to the millimetre.

Each page has a mark in every corner, by which a reader finds and straightens it, and a code that
says whose it is and which page. Sizes are those that a reader of simulated scans found safe.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Sequence

import msgspec

from quizgen.locale import load_words, translate
from quizgen.paper.paper import Paper
from quizgen.question.compose import AnswerField
from quizgen.render.typst_document import (
    compile_pdf,
    document_files,
    inlines_to_typst,
    replace_unprintable,
    typst_literal,
)
from quizgen.typeset.prose import name_inline

VERSION, PAPER_VERSION = 1, 2
"""Of the layouts: the compact sheet, and a whole paper."""
SIZE = (210.0, 297.0)
MARK, INSET = 8.5, 7.0
"""Side of a corner mark, and its distance from the edges."""
MARKS = (
    ("1011", "0101", "0011", "0010"),
    ("0000", "1111", "1001", "1010"),
    ("0011", "0011", "0010", "1101"),
    ("1001", "1001", "0100", "0110"),
)
"""White cells of the marks 0 to 3 of ArUco's dictionary 4x4_50, clockwise from the upper left."""
CODE = (166.0, 7.0, 22.0)
"""Place and side of the code."""
TOP, BOTTOM = 44.0, 277.0
PITCH = 9.4
"""From row to row."""
COLUMNS, WIDTH = (18.0, 108.0), 84.0
LABEL = 12.0
"""What the name of a part takes before its fields."""
BOX, GAP, STEP, WIDE_STEP = 4.6, 2.4, 12.6, 14.2
"""Side of a box, from the word before it to the box, from box to box, and the same where no letter
stands before all of them."""
LETTER, WORD, HEAD = 2.6, 16.0, 8.0
"""What a letter before a box takes, or a word, or a letter before all boxes of a row."""
WORD_STEP = 34.0
BESIDE = 4.0
"""Between two lines of one row."""
MOST_LINES, MOST_BOXES = 3, 6
"""Lines of a text, and values that have a line each: more than that are written in one go."""
LINE, CELL = 7.5, 4.6
"""Height of what is written on a line, and width of what a sign of a number takes at least."""


class SheetField(msgspec.Struct, frozen=True, omit_defaults=True):
    """A place on an answer sheet, in millimetres from the upper left corner of its page.

    Parameters
    ----------
    page : int
        From 1.
    part : str
        As it is printed.
    kind : str
        ``box`` to be ticked, ``line`` to be written on; on a whole paper also ``room`` to work in,
        and ``points`` for what the part earns.
    x, y, w, h : float
    option : str
        What a box that is ticked says, as it is typed: ``A``, ``true``, ``A:2``.
    is_number : bool
        Whether a number is written there, a sign in each cell.
    """

    page: int
    part: str
    kind: str
    x: float
    y: float
    w: float
    h: float
    option: str = ""
    is_number: bool = False


POWER = "^"
"""Option of a field for the power of ten of the number before it."""


class SheetPlaces(msgspec.Struct, frozen=True):
    """What a reader needs of a sheet: layout, pages, where marks, code and fields stand."""

    version: int
    pages: int
    size: tuple[float, float]
    marks: tuple[tuple[float, float, float], ...]
    code: tuple[float, float, float]
    fields: tuple[SheetField, ...]


class _Row(msgspec.Struct, frozen=True):
    """A row of the sheet: boxes with words, or one or two lines.

    Lines have a name as Typst code, or none; those of numbers have cells.
    """

    part: str
    head: str = ""
    lines: tuple[tuple[str, str], ...] = ()
    boxes: tuple[tuple[str, str], ...] = ()
    step: float = STEP
    word: float = LETTER
    note: str = ""
    is_number: bool = False


def make_answer_sheet(paper: Paper, code_of: Callable[[int], str]) -> tuple[bytes, SheetPlaces]:
    """Return the answer sheet of a student's paper as a PDF file, and its places.

    Parameters
    ----------
    paper : Paper
        Of a holder.
    code_of : callable
        What the code of a page says, by its number from 1.
    """
    lang = paper.langs[0]
    rows = [row for item in paper.items for part in item.questions[0].parts
            for row in _iter_rows(part.field, lang)]  # fmt: skip
    fields, drawn, pages = _place_rows(rows)
    codes = [code_of(page) for page in range(1, pages + 1)]
    body = []
    for page in range(1, pages + 1):
        body += [*_iter_head(paper, page, pages, codes[page - 1]), *drawn[page]]
        body += ["#pagebreak()"] if page < pages else []
    opening = (
        f"#show: sheet.with(title: {typst_literal(paper.title(lang))}, lang: {typst_literal(lang)})"
    )
    files = document_files("answer-sheet.typ", "\n".join([opening, *body]) + "\n")
    files |= {f"code-{page}.svg": draw_page_code(text) for page, text in enumerate(codes, 1)}
    places = SheetPlaces(
        VERSION, pages, SIZE, tuple(iter_mark_places(INSET, MARK)), CODE, tuple(fields)
    )
    return compile_pdf(files), places


def _iter_rows(field: AnswerField, lang: str) -> Iterator[_Row]:
    """Yield the rows in which a part is answered."""
    control = field.control
    marks = [mark for mark, _ in field.options]
    if control.board or control.rows:
        yield _Row(field.id, note=load_words(lang, "classes")["sheet"]["on_paper"])
    elif control.form in {"one", "many"}:
        yield from _split_boxes(field.id, "", [(mark, mark) for mark in marks])
    elif control.form == "truth":
        ways = [(way, translate(lang, f"ask.{way}")) for way in ("true", "false")]
        yield _Row(field.id, boxes=tuple(ways), step=WORD_STEP, word=WORD)
    elif control.form == "pairs":
        for mark in marks:
            targets = [(f"{mark}:{target}", target) for target, _ in field.targets]
            yield from _split_boxes(field.id, mark, targets)
    elif 1 < len(control.boxes) <= MOST_BOXES:
        named = [
            (f"[{inlines_to_typst(name_inline(box.name or str(n)), lang)}]", str(n))
            for n, box in enumerate(control.boxes, 1)
        ]
        for at in range(0, len(named), 2):
            yield _Row(field.id, lines=tuple(named[at : at + 2]), is_number=field.is_number)
    else:
        count = 2 if len(control.boxes) > MOST_BOXES else min(control.lines or 1, MOST_LINES)
        for number in range(1, count + 1):
            yield _Row(field.id, lines=(("", str(number)),), is_number=field.is_number)


def _split_boxes(part: str, head: str, boxes: Sequence[tuple[str, str]]) -> Iterator[_Row]:
    """Yield rows with as many boxes as fit beside each other; ``head`` names what they are of."""
    step = STEP if head else WIDE_STEP
    fit = int((WIDTH - LABEL - (HEAD if head else 0.0)) // step)
    for at in range(0, len(boxes), fit):
        yield _Row(part, head=head, boxes=tuple(boxes[at : at + fit]), step=step)


def _place_rows(rows: Sequence[_Row]) -> tuple[list[SheetField], dict[int, list[str]], int]:
    """Return all fields, the Typst source of each page, and the number of pages.

    The rows of a part stay in one column.
    """
    fields: list[SheetField] = []
    drawn: dict[int, list[str]] = {1: []}
    fit, column, row = int((BOTTOM - TOP) // PITCH), 0, 0
    for place, one in enumerate(rows):
        is_first = not place or rows[place - 1].part != one.part
        own = sum(other.part == one.part for other in rows)
        if row >= fit or (is_first and row + min(own, fit) > fit):
            column, row = column + 1, 0
        page, left = column // len(COLUMNS) + 1, COLUMNS[column % len(COLUMNS)]
        y = TOP + row * PITCH
        shown = drawn.setdefault(page, [])
        if is_first:
            shown.append(_typeset_word(left, y + 1.0, one.part, bold=True))
        fields += _place_row(one, page, left + LABEL, y, shown)
        row += 1
    return fields, drawn, column // len(COLUMNS) + 1


def _place_row(
    row: _Row, page: int, left: float, y: float, shown: list[str]
) -> Iterator[SheetField]:
    """Yield the fields of a row, and add its Typst source to ``shown``."""
    if row.note:
        shown.append(_typeset_word(left, y + 1.0, row.note))
    if row.head:
        shown.append(_typeset_word(left, y + 1.0, row.head))
        left += HEAD
    for number, (option, word) in enumerate(row.boxes):
        x = round(left + number * row.step + row.word + GAP, 3)
        shown.append(f"#before({round(x - GAP, 3)}, {y + 1.0}, {row.word}, {_typeset_text(word)})")
        shown.append(f"#tick({x}, {y}, {BOX})")
        yield SheetField(page, row.part, "box", x, y, BOX, BOX, option)
    whole = WIDTH - LABEL
    step = (whole + BESIDE) / 2 if len(row.lines) > 1 or any(h for h, _ in row.lines) else whole
    for number, (head, option) in enumerate(row.lines):
        x = left + number * step + (HEAD if head else 0.0)
        width = step - (HEAD + BESIDE if head else 0.0)
        base = y + LINE - 1.0
        if head:
            shown.append(f"#word({round(left + number * step, 3)}, {round(y + 1.0, 3)}, {head})")
        cells = f", cells: {int(width // CELL)}" if row.is_number else ""
        shown.append(f"#rule({round(x, 3)}, {round(base, 3)}, {round(width, 3)}{cells})")
        place = round(x, 3), round(base - LINE, 3), round(width, 3), LINE
        yield SheetField(page, row.part, "line", *place, option, row.is_number)


def _iter_head(paper: Paper, page: int, pages: int, code: str) -> Iterator[str]:
    """Yield the Typst source of what stands above the rows of a page, and of its marks."""
    lang = paper.langs[0]
    words = load_words(lang, "classes")["sheet"]
    for rows, (x, y, side) in zip(MARKS, iter_mark_places(INSET, MARK), strict=True):
        shown = ", ".join(typst_literal(bits) for bits in rows)
        yield f"#corner({x}, {y}, {side}, ({shown}))"
    x, y, side = CODE
    yield f'#code({x}, {y}, {side}, "code-{page}.svg", {typst_literal(code)})'
    title = paper.title(lang)
    if page == 1:
        yield f"#at(22, 8, heading(level: 1, {_typeset_text(title)}))"
    else:
        yield _typeset_word(22, 8, title, bold=True)
    holder = paper.holder
    known = (holder.name, holder.id) if holder and not holder.hidden else ()
    yield _typeset_word(22, 16, " · ".join(filter(None, (*known, paper.code))))
    yield _typeset_word(22, 21.5, translate(lang, "paper.page", page=page, pages=pages))
    yield f"#at(22, 28, block(width: 138mm, text(9pt, {_typeset_text(words['rules'])})))"


def iter_mark_places(inset: float, side: float) -> Iterator[tuple[float, float, float]]:
    """Yield place and side of the corner marks, clockwise from the upper left."""
    right, low = SIZE[0] - inset - side, SIZE[1] - inset - side
    for x, y in ((inset, inset), (right, inset), (right, low), (inset, low)):
        yield x, y, side


def _typeset_word(x: float, y: float, text: str, *, bold: bool = False) -> str:
    """Return Typst source of a text at a place."""
    weight = ', weight: "bold"' if bold else ""
    return f"#word({round(x, 3)}, {round(y, 3)}, {_typeset_text(text)}{weight})"


def _typeset_text(text: str) -> str:
    """Return a text as a Typst literal, with ``?`` for what no font has."""
    return typst_literal(replace_unprintable(text))


def draw_page_code(text: str) -> bytes:
    """Return a QR code as SVG, without a border: the page around it is white."""
    import segno

    out = io.BytesIO()
    found = segno.make(text, error="q", boost_error=False, micro=False)
    found.save(out, kind="svg", border=0, xmldecl=False)
    return out.getvalue()
