"""Sentences of a template with their blanks filled from a draw."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator
from functools import lru_cache

from quizgen import typeset
from quizgen.bank.markdown import (
    TABLE_MARK,
    Block,
    ConditionalSentence,
    Emphasis,
    Inline,
    Paragraph,
    PictureLink,
    PlainText,
    RoundedMarker,
    Slot,
    TableBlock,
    Unfilled,
    fill_blocks,
    fill_inlines,
    fill_text,
    slot_names,
)
from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError
from quizgen.core.positions import TEXT
from quizgen.kinds.contract import LabelledName
from quizgen.maths.notation import format_tree, pretty
from quizgen.maths.numbers import MINUS, format_exact, format_rounded
from quizgen.maths.tree import Expr
from quizgen.maths.units import format_unit
from quizgen.maths.values import Values
from quizgen.question.inlines import PlacedPicture, TypesetMaths, name_inline, to_inlines

NBSP = "\u00a0"
LIST_SEPARATOR = "; "
"""Between the numbers of a list: a comma would be a decimal sign in some languages."""
SHORT = 16
"""Characters up to which a formula is held together with what stands beside it."""
_TAIL = re.compile(r"[^ \n]*(?: [=≈<>≤≥≠] [^ \n]*)?")
"""What belongs to a formula: punctuation, and the value that it is said to have."""


class Interpolator:
    """Puts the numbers and phrases of a draw into the sentences of one language.

    Parameters
    ----------
    drawn : Draw
    lang : str
    hidden : bool
        Refuse quantities that are solved for, so that a stem cannot give an answer away.
    """

    def __init__(self, drawn: Variant, lang: str, *, hidden: bool = False) -> None:
        self.drawn, self.lang, self.hidden = drawn, lang, hidden
        self.own: dict[str, LabelledName] = {}
        self.known: Values = drawn.shown if hidden else drawn.shown_values
        self.text = drawn.template.texts[lang]

    def blocks(self, parts: tuple[Block, ...]) -> tuple[Block, ...]:
        """Blocks with their slots filled.

        Raises
        ------
        BankError
            If a slot names nothing that may stand there.
        """
        if self.drawn.lists:
            parts = tuple(map(self._build_data_table, parts))
        return fill_blocks(parts, self._fill_value, self._fill_program)

    def _build_data_table(self, block: Block) -> Block:
        """A paragraph that is ``{{ table: x y }}`` alone, as the table of these lists."""
        match block:
            case Paragraph((Slot(text),)) if text.startswith(TABLE_MARK):
                names = text.removeprefix(TABLE_MARK).split()
            case _:
                return block
        for name in names:
            self._require_list(name, text)
        columns = [self.drawn.format_list(name) for name in names]
        if len({len(column) for column in columns}) != 1:
            raise self._format_problem("the lists differ in length", "QG158", TEXT, text)
        rows = tuple(
            tuple(to_inlines(pretty.format_number(cell)) for cell in row)
            for row in zip(*columns, strict=True)
        )
        return TableBlock(tuple(self._name_column(name) for name in names), rows)

    def _name_column(self, name: str) -> tuple[Inline, ...]:
        """The head of a column: the list's letter, and its unit behind a slash."""
        unit = format_unit(self.drawn.template.units.get(name, ""))
        return (name_inline(name), *to_inlines(f"{NBSP}/{NBSP}{unit}" if unit else ""))

    def _require_list(self, name: str, blank: str) -> None:
        if name not in self.drawn.lists:
            what = f"{{{{ {blank} }}}}: {name} is not a drawn list"
            raise self._format_problem(what, "QG158", TEXT, f"{{{{ {blank} }}}}")

    def section(self, name: str) -> tuple[Block, ...]:
        """A section of the language file, filled; empty if there is none."""
        return self.blocks(self.text.sections.get(name, ()))

    def sentence(self, section: str, name: str) -> tuple[Inline, ...]:
        """A named sentence, filled.

        Raises
        ------
        BankError
            If the language file lacks it, or a slot names nothing that may stand there.
        """
        place = section, name
        if place in self.text.unslotted_sentences:
            return self.text.unslotted_sentences[place]
        written = self.raw_sentence(section, name)
        filled = fill_inlines(written, self._fill_value, self._fill_program)
        if place not in self.text.cases and not any(slot_names(written)):
            self.text.unslotted_sentences[place] = filled
        return filled

    def raw_sentence(self, section: str, name: str) -> tuple[Inline, ...]:
        """A named sentence as it is written; of several cases the one that fits the draw.

        Raises
        ------
        BankError
            If the language file lacks it.
        """
        cases = self.text.cases.get((section, name))
        found = self._choose_sentence(cases) if cases else self.text.sentence(section, name)
        if found is None:
            lacks = "has no case of" if cases else "lacks"
            raise self._format_problem(
                f"section {section!r} {lacks} {name!r}", "QG157", section, name
            )
        return found

    def _choose_sentence(self, cases: tuple[ConditionalSentence, ...]) -> tuple[Inline, ...] | None:
        """The first sentence whose condition holds, else the one without a condition."""
        for condition, sentence in sorted(cases, key=lambda case: not case[0]):
            if not condition or self.drawn.evaluate(condition):
                return sentence
        return None

    def with_sentence(self, name: str, section: str, sentence: str) -> Interpolator:
        """The same with a blank that a named sentence fills."""
        filler = Interpolator(self.drawn, self.lang, hidden=self.hidden)
        filler.own[name] = (section, sentence)
        return filler

    def _fill_value(self, part: Unfilled) -> tuple[Inline, ...]:
        if isinstance(part, PictureLink):
            picture = self.drawn.template.pictures[part.file]
            return (
                PlacedPicture(
                    picture, fill_inlines(part.alt, self._fill_value, self._fill_program)
                ),
            )
        return self._fill_slot(part.name) if isinstance(part, Slot) else (_inline_maths(part.expr),)

    def _fill_slot(self, name: str) -> tuple[Inline, ...]:
        drawn = self.drawn
        if name in self.own:
            return self.sentence(*self.own[name])
        if name in drawn.lists or name.startswith(TABLE_MARK) or name.endswith("]"):
            return self._fill_list_slot(name)
        if name in drawn.words:
            own = name in drawn.template.rules.data  # a text of data.py stands for itself
            text = drawn.words[name]
            return to_inlines(text) if own else self.sentence("words", text)
        if not self.hidden and ("words", name) in self.text.cases:
            return self.sentence("words", name)
        return self._fill_number(name)

    def _fill_number(self, name: str) -> tuple[Inline, ...]:
        drawn = self.drawn
        if name not in self.known:
            what, blank = f"{{{{ {name} }}}} is not a drawn quantity", f"{{{{ {name} }}}}"
            raise self._format_problem(what, "QG158", TEXT, blank)
        if not drawn.is_rounded(name):
            return to_inlines(format_quantity(drawn, name))
        rounded = format_rounded(self.known[name])
        return (
            RoundedMarker(),
            *to_inlines(join_unit(rounded, drawn.template.units.get(name, ""))),
        )

    def _fill_list_slot(self, name: str) -> tuple[Inline, ...]:
        """A list with its unit once, or one of its values."""
        drawn, (listed, _, place) = self.drawn, name.partition("[")
        if name.startswith(TABLE_MARK):
            what = "stands alone in a paragraph, in a question that draws lists"
            blank = f"{{{{ {name} }}}}"
            raise self._format_problem(f"{blank} {what}", "QG158", TEXT, blank)
        self._require_list(listed, name)
        texts, unit = drawn.format_list(listed), drawn.template.units.get(listed, "")
        if not place:
            numbers = LIST_SEPARATOR.join(map(pretty.format_number, texts))
            shown = format_unit(unit)
            return to_inlines(f"{numbers}{NBSP}{shown}" if shown else numbers)
        index = int(place.rstrip("]"))
        if not 1 <= index <= len(texts):
            what = f"{{{{ {name} }}}}: the list has {len(texts)} values, and the first is 1"
            raise self._format_problem(what, "QG158", TEXT, f"{{{{ {name} }}}}")
        return to_inlines(join_unit(texts[index - 1], unit))

    def _fill_program(self, text: str) -> str:
        return fill_program(text, self.drawn, self.known)

    def _format_problem(self, what: str, rule: str, *place: str) -> BankError:
        file = self.drawn.template.path / f"{self.lang}.md"
        return BankError(what, rule=rule, file=file, place=place)


def unbreakable_groups(parts: Iterable[Inline]) -> Iterator[tuple[Inline, ...]]:
    """Cut a sentence into pieces of which no line may end inside: ``f`` and ``= 6 mm`` are one.

    Browsers and Typst break a line on either side of a formula, even before a comma.
    """
    rest = deque(parts)
    while rest:
        group = [rest.popleft()]
        if not isinstance(group[0], TypesetMaths):
            yield (group[0],)
            continue
        while isinstance(last := group[-1], TypesetMaths) and len(last.typed) <= SHORT:
            tail = _take_formula_tail(rest)
            if not tail:
                break
            group.append(PlainText(tail))
            if tail.endswith(" ") and rest and isinstance(rest[0], TypesetMaths):
                group.append(rest.popleft())
        yield tuple(group)


def _take_formula_tail(rest: deque[Inline]) -> str:
    """Take away what belongs to a formula in front."""
    text = ""
    while rest and isinstance(words := rest[0], PlainText):
        text += words.text
        rest.popleft()
    found = _TAIL.match(text)
    tail = found[0] if found and len(found[0]) <= SHORT else ""
    if text[len(tail) :]:
        rest.appendleft(PlainText(text[len(tail) :]))
    return tail


@lru_cache(maxsize=4096)
def _inline_maths(expr: Expr) -> TypesetMaths:
    return TypesetMaths(typeset.lay_out(expr, inline=True), format_tree(expr))


def fill_program(text: str, drawn: Variant, known: Values) -> str:
    """Program text or its output with the drawn values in place, as a program writes them.

    Parameters
    ----------
    text : str
    drawn : Draw
    known : mapping of str to number
        The quantities that may stand there, in shown units.

    Raises
    ------
    BankError
        If a blank names another quantity, or one that is not a short decimal.
    """

    def value(name: str) -> str:
        listed, _, place = name.partition("[")
        if listed in drawn.lists:
            texts = [text.replace(MINUS, "-") for text in drawn.format_list(listed)]
            if not place:
                return ", ".join(texts)
            if 1 <= int(place.rstrip("]")) <= len(texts):
                return texts[int(place.rstrip("]")) - 1]
        written = format_exact(known[name], minus="-") if name in known else None
        if written is None:
            what = f"{{{{ {name} }}}} cannot stand in a program"
            raise BankError(what, rule="QG158", file=drawn.template.file)
        return written

    return fill_text(text, value)


def format_quantity(drawn: Variant, name: str) -> str:
    """A quantity of a draw with its unit as text, exact if that is short."""
    return join_unit(drawn.format_value(name), drawn.template.units.get(name, ""))


def join_unit(text: str, unit: str) -> str:
    """A number and its unit; only the degree sign stands close."""
    shown = format_unit(unit)
    return f"{pretty.format_number(text)}{'' if shown in {'', '°'} else NBSP}{shown}"


def inlines_to_text(parts: Iterable[Inline]) -> str:
    """Text of a filled sentence, for people.

    Raises
    ------
    BankError
        If a blank is left.
    """
    return "".join(map(_get_plain_text, parts))


def _get_plain_text(part: Inline) -> str:
    if isinstance(part, Emphasis):
        return inlines_to_text(part.children)
    if isinstance(part, Unfilled | RoundedMarker):
        raise BankError("a sentence was used before its blanks were filled")
    return part.text


def inlines_as_typed(parts: Iterable[Inline]) -> str:
    """Text of a filled sentence as it would be typed, to compare with what was."""
    return "".join(
        inlines_as_typed(part.children)
        if isinstance(part, Emphasis)
        else part.typed
        if isinstance(part, TypesetMaths)
        else _get_plain_text(part)
        for part in parts
    )
