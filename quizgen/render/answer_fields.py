"""Where an answer is written on paper: ticks in columns, boxes with units, room to work in.

In: a part of a question in the languages of a paper. Out: calls of ``pages/paper.typ``. Sizes are
estimated here from the length of texts; Typst does the rest.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple, TypeVar

import msgspec

from quizgen.figures import Figure
from quizgen.question.compose import AnswerField, Question, QuestionPart
from quizgen.question.interpolation import PlacedPicture, inlines_to_text
from quizgen.question.solution import PartSolution
from quizgen.render.layouts import count_working_rows
from quizgen.render.text import blocks_to_plain_text
from quizgen.render.typst_document import (
    GAP,
    blocks_to_typst,
    inlines_to_typst,
    join_languages,
    stack_languages,
    translate_all,
    typst_literal,
)
from quizgen.typeset.prose import (
    Emphasis,
    Inline,
    InlineCode,
    ListBlock,
    Paragraph,
    PlacedField,
    PlainText,
    TableBlock,
    name_inline,
)

TEXT_MM = 155.0
"""Width of the text in millimetres."""
CHARACTERS = 100
"""About as many stand in a line of that width."""
MOST_COLUMNS = 5
WIDEST_BESIDE, GUTTER = 92.0, 5.0
"""Millimetres up to which a figure stands beside text, and between both."""
BOARD_SCALE = 0.73
"""Size of a field to draw in: 64 mm wide."""


class PaperPart(NamedTuple):
    """A part of a question in each language of the paper, with its solutions.

    ``less`` is the width in millimetres that a figure beside it takes.
    """

    langs: tuple[str, ...]
    parts: tuple[QuestionPart, ...]
    solved: tuple[PartSolution, ...]
    less: float = 0.0

    @property
    def first(self) -> QuestionPart:
        """Return the part in the leading language."""
        return self.parts[0]

    @property
    def fields(self) -> list[AnswerField]:
        """Return the field in each language."""
        return [part.field for part in self.parts]

    @property
    def share(self) -> float:
        """Return what share of the text's width the part has."""
        return 1 - self.less / TEXT_MM

    def join(self, texts: Sequence[tuple[Inline, ...]]) -> str:
        """Return the same words in each language, in one line."""
        return join_languages(
            self.langs,
            [inlines_to_typst(t, lang) for t, lang in zip(texts, self.langs, strict=True)],
        )

    def list_options(self, side: str) -> list[str]:
        """Return the options of a side with their marks, all languages in one line."""
        return [
            f"({typst_literal(mark)}, [{self.join([getattr(f, side)[n][1] for f in self.fields])}])"
            for n, (mark, _) in enumerate(getattr(self.first.field, side))
        ]

    def count_option_characters(self, side: str) -> int:
        """Return the length of the longest option, all languages together."""
        count = len(getattr(self.first.field, side))
        return max(
            sum(_count_characters(getattr(field, side)[place][1]) for field in self.fields)
            for place in range(count)
        )


Prose = TypeVar("Prose")


def typeset_letters(said: Prose) -> Prose:
    """Return prose with program text that is one letter, such as ``p_x``, as a formula.

    On a screen it says what to type; on paper a letter is a letter.
    """
    return _rewrite(said, _typeset_letter)


def name_fields(said: Prose) -> Prose:
    """Return prose of a further language, whose fields stand in the words of the first."""
    return _rewrite(said, _name_field)


def _typeset_letter(piece: Any) -> Any:
    """Return program text that is one letter as a formula, all else as it is."""
    if isinstance(piece, InlineCode) and _LETTER.fullmatch(piece.text):
        return name_inline(piece.text)
    return piece


def _name_field(piece: Any) -> Any:
    """Return a field as one that stands elsewhere, a gap as dots, all else as it is."""
    if isinstance(piece, PlacedField):
        return msgspec.structs.replace(piece, elsewhere=True)
    if isinstance(piece, PlainText):
        return PlainText(GAP.sub("…", piece.text))
    return piece


def _rewrite(said: Any, change: Callable[[Any], Any]) -> Any:
    """Return the same structure with its pieces changed, whatever it is made of."""
    if isinstance(said, Paragraph | ListBlock | TableBlock | Emphasis):
        fields = {name: _rewrite(getattr(said, name), change) for name in said.__struct_fields__}
        return msgspec.structs.replace(said, **fields)
    if isinstance(said, tuple):
        return tuple(_rewrite(piece, change) for piece in said)
    return change(said)


_LETTER = re.compile(r"[A-Za-z]'?(_\w{1,3})?")


def _count_characters(text: tuple[Inline, ...]) -> int:
    """Return about how many characters a text is wide; a picture is as wide as it is."""
    wide = sum(part.picture.width_pt for part in text if isinstance(part, PlacedPicture))
    words = inlines_to_text(part for part in text if not isinstance(part, PlacedPicture))
    return len(words) + math.ceil(wide / mm_to_pt(TEXT_MM) * CHARACTERS)


def count_columns(longest: int, count: int, share: float = 1.0) -> int:
    """Return in how many columns options stand: as many as the longest one leaves room for."""
    fitting = [
        columns
        for columns in range(1, min(MOST_COLUMNS, count) + 1)
        if (longest + 7) * columns <= CHARACTERS * share
    ]
    columns = max(fitting, default=1)
    return math.ceil(count / math.ceil(count / columns))


def count_rows(one: PaperPart) -> int:
    """Return the rows to work in below a part."""
    return count_working_rows(one.first, one.solved[0])


def is_ticked(field: AnswerField) -> bool:
    """Return whether nothing is written into a field, only ticked."""
    return field.control.form in {"one", "many", "truth"}


def typeset_text(one: PaperPart, *, hint: bool = False) -> str:
    """Return what a part asks, in all languages; ``hint`` adds what is said beside the field."""
    texts = []
    for part, lang in zip(one.parts, one.langs, strict=True):
        said = inlines_to_typst(part.field.hint_on_paper, lang) if hint else ""
        texts.append(blocks_to_typst(part.body, lang) + (f" #hint[{said}]" if said else ""))
    return stack_languages(one.langs, texts)


def typeset_part(one: PaperPart, drawing: str) -> str:
    """Return a part with its field, as the content of a Typst block.

    Parameters
    ----------
    one : PaperPart
    drawing : str
        The picture of a field to draw in; empty without one.
    """
    form, text = one.first.field.control.form, typeset_text(one)
    if form in {"one", "many"}:
        return f"{typeset_text(one, hint=True)}\n{_typeset_choices(one)}"
    if form == "pairs":
        return f"{text}\n{_typeset_pairs(one)}"
    if drawing:
        return _put_beside(one, text, drawing)
    if form == "order":
        return f"{text}\n{_typeset_steps(one)}"
    return _typeset_written(one, text)


def _typeset_written(one: PaperPart, text: str) -> str:
    """Return a part whose answer is ticked as true or false, or written."""
    field = one.first.field
    if field.control.form == "truth":
        ways = [f"[{translate_all(one.langs, f'ask.{way}')}]" for way in ("true", "false")]
        return _put_beside(one, text, f"truth({', '.join(ways)})")
    if field.control.form == "gaps":
        return text if "#gap;" in text else _put_beside(one, text, _typeset_values(one))
    if field.control.form == "line" or field.control.boxes:
        return _put_beside(one, text, _typeset_values(one))
    return typeset_text(one, hint=True)


def typeset_ruled_lines(one: PaperPart, *, hold: bool) -> str:
    """Return the lines to write on below a part; empty where nothing longer is written.

    ``hold`` keeps all of them on the page of what follows.
    """
    control = one.first.field.control
    if control.form != "lines" or control.boxes or control.board:
        return ""
    return f"#space({control.lines}, hold: {str(hold).lower()})"


def _put_beside(one: PaperPart, text: str, answer: str) -> str:
    """Return a part with its field at the right of a short text, else below it."""
    is_short = all(isinstance(block, Paragraph) for part in one.parts for block in part.body)
    is_row = len(one.first.field.control.boxes) >= MOST_BOXES
    if is_short and not one.less and not is_row:
        return f"#ask[{text}][#{answer}]"
    return f"{text}\n#under({answer})"


def typeset_hint(one: PaperPart) -> str:
    """Return what is said beside the field, in small letters after the question."""
    said = _join_hints(one)
    return f" #hint[{said}]" if said else ""


def _join_hints(one: PaperPart) -> str:
    """Return what is said beside the field in all languages, in one line."""
    if not any(field.on_paper for field in one.fields):
        return ""
    return one.join([field.hint_on_paper for field in one.fields])


def _typeset_choices(one: PaperPart) -> str:
    """Return the options to tick, in columns where they are short."""
    longest, rows = one.count_option_characters("options"), one.list_options("options")
    return f"#choices({count_columns(longest, len(rows), one.share)}, {', '.join(rows)})"


def _typeset_pairs(one: PaperPart) -> str:
    """Return both sides of a matching beside each other, a box for a number before each left."""
    sides, widths = [], []
    for side in ("options", "targets"):
        sides.append(f"({', '.join(one.list_options(side))},)")
        widths.append(one.count_option_characters(side))
    left, right = max(widths[0] + 12, 30), max(widths[1] + 4, 22)
    return f"#pairs(({left}fr, {right}fr), {', '.join(sides)})"


def _typeset_steps(one: PaperPart) -> str:
    """Return lettered steps, and a box for each letter in order."""
    options = one.first.field.options
    columns = count_columns(one.count_option_characters("options"), len(options), one.share)
    rows = one.list_options("options")
    order = f"letters-in-order({len(options)})"
    said = _join_hints(one)
    return f"#steps({min(columns, 2)}, {', '.join(rows)})\n#ask[#hint[{said}]][#{order}]"


def _typeset_values(one: PaperPart) -> str:
    """Return a box for each value, with its name and unit."""
    field = one.first.field
    boxes = field.boxes
    rows = [
        f"([{inlines_to_typst((name_inline(box.name),), one.langs[0]) if box.name else ''}], "
        f"[#{typst_literal(box.unit)};])"
        for box in boxes
    ]
    named = any(box.name or box.unit for box in boxes)
    width = 24 if len(boxes) > 1 else 32 if field.is_number else 58
    columns = min(len(boxes), MOST_BOXES if named else MOST_BOXES + 1) if _is_row(field) else 1
    if not named and len(boxes) > 1:
        width = 32 if field.control.form == "gaps" else 18
    cells = f", cells: {_measure_cells(one, columns, width)}mm" if field.is_number else ""
    cells += ", power: true" if field.has_power else ""
    return f"values({columns}, {width}mm, [{_join_hints(one)}]{cells}, {', '.join(rows)})"


def _measure_cells(one: PaperPart, columns: int, width: int) -> int:
    """Return the millimetres of a box with a cell a sign: ``-0.745`` has six, ``0.000679`` eight.

    Where boxes stand in a row there is room for fewer.
    """
    room = 32 if columns == 1 else 28 if columns <= MOST_BOXES and not one.less else 24
    named = any(box.name for box in one.first.field.boxes)
    return width if named and columns > 1 else max(width, room)


MOST_BOXES = 3
"""Boxes with names that stand in a row."""


def _is_row(field: AnswerField) -> bool:
    """Return whether the boxes of an answer stand in a row: those without names, and many."""
    boxes = field.control.boxes
    return len(boxes) >= MOST_BOXES or not any(box.name for box in boxes)


def typeset_room(rows: int, points: Fraction, *, hold: bool) -> str:
    """Return room to work in, and its share of what is left of the page; "" without rows."""
    if not rows:
        return ""
    return f"#room({rows}, hold: {str(hold).lower()})\n#more({float(points):g})"


def choose_scale(figure: Figure) -> float:
    """Return the size of a figure: a small one beside text, a large one across the page."""
    if figure.width_pt < SMALL:
        fitting = min(mm_to_pt(88) / figure.width_pt, mm_to_pt(HIGH) / figure.height_pt)
        return min(0.9, max(fitting, LEAST_SCALE))
    return min(0.86, mm_to_pt(150) / figure.width_pt)


HIGH, LEAST_SCALE = 64, 0.68
"""Millimetres that a figure beside text is high, as long as its letters stay readable."""
SMALL = 330
"""Points up to which a figure is made small enough to stand beside text."""


def mm_to_pt(length: float) -> float:
    """Return a length in millimetres in points."""
    return length / 25.4 * 72


def count_beside(
    parts: Sequence[PaperPart], questions: Sequence[Question], wide: float, high: float
) -> int:
    """Return how many first parts stand beside a figure: those that are ticked, while they fit.

    ``wide`` and ``high`` are those of the figure in millimetres.
    """
    used, count = _estimate_stem(questions, 1 - (wide + GUTTER) / TEXT_MM), 0
    for part in parts:
        one = part._replace(less=wide + GUTTER)
        if not _fits_beside(one):
            break
        used += estimate_height(one)
        if used > high + SLACK:
            break
        count += 1
    return count


def _fits_beside(one: PaperPart) -> bool:
    """Return whether a part fits the column beside a figure: what is ticked, or read off it."""
    field = one.first.field
    if field.near is not None or field.control.board:
        return False
    is_read = field.control.form == "line" and not count_rows(one)
    return is_ticked(field) or (is_read and len(field.control.boxes) < MOST_BOXES)


SLACK = 8.0
"""Millimetres that parts beside a figure may be higher than it."""


def _estimate_stem(questions: Sequence[Question], share: float) -> float:
    """Return about how high the stem is in a share of the width, in millimetres."""
    lines = sum(
        math.ceil(len(line) / (CHARACTERS * share))
        for question in questions
        for line in blocks_to_plain_text(question.stem)
    )
    return 4.4 * lines


def estimate_height(one: PaperPart) -> float:
    """Return about how high a part is beside a figure, in millimetres."""
    wide = CHARACTERS * one.share
    length = sum(_estimate_length(part) for part in one.parts)
    high = 3 + 4.4 * math.ceil(length / wide)
    field = one.first.field
    if field.control.form == "truth":
        return high + 5
    if not field.options:
        return high + 12 * max(len(field.control.boxes), 1)
    count, longest = len(field.options), one.count_option_characters("options")
    rows = math.ceil(count / count_columns(longest, count, one.share))
    return high + rows * 5.6 * math.ceil((longest + 7) / wide)


def _estimate_length(part: QuestionPart) -> int:
    """Return the characters of what a part asks."""
    return sum(
        len(inlines_to_text(block.children)) for block in part.body if isinstance(block, Paragraph)
    )
