"""Sentences of a template with their blanks filled from a variant."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator
from functools import lru_cache, partial
from itertools import chain, groupby

import msgspec
from flint import fmpq

from quizgen import typeset
from quizgen.bank.markdown import (
    FIELD_MARK,
    TABLE_MARK,
    ConditionalSentence,
    fill_blocks,
    fill_inlines,
    fill_text,
    slot_names,
)
from quizgen.bank.pictures import PictureFile
from quizgen.bank.rules import PART_LABELS
from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError
from quizgen.core.positions import TEXT
from quizgen.kinds.contract import VALUE_OPTION, LabelledName, asked_form
from quizgen.maths.notation import format_tree, pretty
from quizgen.maths.numbers import MINUS, format_exact, format_rounded, to_float
from quizgen.maths.tree import Expr
from quizgen.maths.units import format_unit
from quizgen.maths.values import Value, Values
from quizgen.typeset.leaves import LeafValue, fill_leaves, list_leaf_names, make_leaf_value
from quizgen.typeset.nodes import MathRow, Node, Phrase
from quizgen.typeset.prose import (
    Block,
    Emphasis,
    Inline,
    InlineFormula,
    LaidOutFormula,
    Paragraph,
    PictureLink,
    PlacedField,
    PlainText,
    RoundedMarker,
    Slot,
    TableBlock,
    TypesetLayout,
    TypesetMaths,
    Unfilled,
    name_inline,
    to_inlines,
    typeset_layout,
)

NBSP = "\u00a0"
LIST_SEPARATOR = "; "
"""Between the numbers of a list: a comma would be a decimal sign in some languages."""
TEXT_SEPARATOR = ", "
"""Between the texts of a list."""
SHORT = 16
"""Characters up to which a formula is held together with what stands beside it."""
_TAIL = re.compile(r"[^ \n]*(?: [=≈<>≤≥≠] [^ \n]*)?")
"""What belongs to a formula: punctuation, and the value that it is said to have."""


class PlacedPicture(msgspec.Struct, frozen=True):
    """A picture in a sentence, and what it shows in words whose blanks are filled."""

    picture: PictureFile
    told: tuple[Inline, ...]

    @property
    def alt(self) -> str:
        """Return what it shows in words, for those who cannot see it."""
        return "".join(part.text for part in self.told)  # type: ignore[union-attr]

    @property
    def text(self) -> str:
        """Return what stands in its place in plain text."""
        return f"[{self.alt}]"

    @property
    def typed_text(self) -> str:
        """Return the same as ``text``: nobody types a picture."""
        return self.text


class Interpolator:
    """Puts the numbers and phrases of a variant into the sentences of one language.

    Parameters
    ----------
    drawn : Variant
    lang : str
    hidden : bool
        Refuse quantities that are solved for, so that a stem cannot give an answer away.
    """

    def __init__(self, drawn: Variant, lang: str, *, hidden: bool = False) -> None:
        """Take the prose of one language; ``hidden`` makes only drawn values known.

        A question must not print what is solved; a solution may.
        """
        self.drawn, self.lang, self.hidden = drawn, lang, hidden
        self.own: dict[str, LabelledName] = {}
        self.fields: dict[str, PlacedField] = {}
        self.known: Values = drawn.shown if hidden else drawn.shown_values
        self.text = drawn.template.texts[lang]

    def blocks(self, parts: tuple[Block, ...]) -> tuple[Block, ...]:
        """Return blocks with their slots filled.

        Raises
        ------
        BankError
            If a slot names nothing that may stand there.
        """
        if self.drawn.lists or any(name.endswith("]") for name in self.drawn.words):
            parts = tuple(chain.from_iterable(map(self._place_data_tables, parts)))
        return fill_blocks(parts, self._fill_value, self._fill_program)

    def _place_data_tables(self, block: Block) -> Iterator[Block]:
        """Yield a paragraph in pieces where it has ``{{ table: x y }}``, and any other block."""
        if not isinstance(block, Paragraph):
            yield block
            return
        for is_table, inlines in groupby(block.children, _is_data_table):
            pieces = tuple(inlines)
            if is_table:
                yield from (self._build_data_table(one) for one in slot_names(pieces))
            elif any(not isinstance(one, PlainText) or one.text.strip() for one in pieces):
                yield Paragraph(pieces)

    def _build_data_table(self, text: str) -> Block:
        """Return the table of the lists that a slot names."""
        names = text.removeprefix(TABLE_MARK).split()
        for name in names:
            self._require_list(name, text)
        columns = [self.drawn.list_texts(name) for name in names]
        if len({len(column) for column in columns}) != 1:
            raise self.format_problem("the lists differ in length", "QG158", TEXT, text)
        rows = tuple(
            tuple(
                to_inlines(pretty.format_number(cell) if name in self.drawn.lists else cell)
                for name, cell in zip(names, row, strict=True)
            )
            for row in zip(*columns, strict=True)
        )
        return TableBlock(tuple(self._name_column(name) for name in names), rows)

    def _name_column(self, name: str) -> tuple[Inline, ...]:
        """Return the head of a column: the list's letter, and its unit after a slash."""
        unit = format_unit(self.drawn.template.units.get(name, ""))
        return (name_inline(name), *to_inlines(f"{NBSP}/{NBSP}{unit}" if unit else ""))

    def _require_list(self, name: str, blank: str) -> None:
        """Raise the problem QG158 if a blank names a list that is not drawn."""
        if not self.drawn.list_texts(name):
            what = f"{{{{ {blank} }}}}: {name} is not a drawn list"
            raise self.format_problem(what, "QG158", TEXT, f"{{{{ {blank} }}}}")

    def section(self, name: str) -> tuple[Block, ...]:
        """Return a section of the language file, filled; empty if there is none."""
        return self.blocks(self.text.sections.get(name, ()))

    def sentence(self, section: str, name: str) -> tuple[Inline, ...]:
        """Return a named sentence, filled.

        Raises
        ------
        BankError
            If the language file lacks it, or a slot names nothing that may stand there.
        """
        if section == "options" and name.startswith(VALUE_OPTION):
            return to_inlines(name.removeprefix(VALUE_OPTION))
        place = section, name
        if place in self.text.unslotted_sentences:
            return self.text.unslotted_sentences[place]
        written = self.raw_sentence(section, name)
        filled = fill_inlines(written, self._fill_value, self._fill_program)
        if place not in self.text.cases and not any(slot_names(written)):
            self.text.unslotted_sentences[place] = filled
        return filled

    def step_idea(self, name: str) -> tuple[Inline, ...]:
        """Return the sentence of a step with its name in place of its value, for a hint."""
        written = self.raw_sentence("steps", name)
        if name not in slot_names(written):
            return self.sentence("steps", name)
        return fill_inlines(written, partial(self._fill_without, name), self._fill_program)

    def _fill_without(self, hidden: str, part: Unfilled) -> tuple[Inline, ...]:
        """Return what a slot or a formula is replaced by where one value is not said."""
        if isinstance(part, Slot) and part.name.partition(":")[0] == hidden:
            return (name_inline(hidden),)
        if isinstance(part, LaidOutFormula) and hidden in (names := _list_names_in_layout(part)):
            own = LeafValue(typeset.lay_out_name(hidden))
            filled = {n: own if n == hidden else self._fill_leaf(n) for n in names}
            return (typeset_layout(fill_leaves(part.node, filled)),)
        return self._fill_value(part)

    def raw_sentence(self, section: str, name: str) -> tuple[Inline, ...]:
        """Return a named sentence as it is written; of several cases the one that fits.

        Raises
        ------
        BankError
            If the language file lacks it.
        """
        cases = self.text.cases.get((section, name))
        found = self._choose_sentence(cases) if cases else self.text.sentence(section, name)
        if found is None:
            lacks = "has no case of" if cases else "lacks"
            raise self.format_problem(
                f"section {section!r} {lacks} {name!r}", "QG157", section, name
            )
        return found

    def _choose_sentence(self, cases: tuple[ConditionalSentence, ...]) -> tuple[Inline, ...] | None:
        """Return the first sentence whose condition holds, else the one without a condition."""
        for condition, sentence in sorted(cases, key=lambda case: not case[0]):
            if not condition or self.drawn.evaluate(condition):
                return sentence
        return None

    def with_fields(self, fields: Iterable[PlacedField]) -> Interpolator:
        """Return a copy that knows the fields of parts, which may then stand in its blocks."""
        filler = Interpolator(self.drawn, self.lang, hidden=self.hidden)
        filler.fields = {FIELD_MARK + (field.label or PART_LABELS[0]): field for field in fields}
        return filler

    def with_sentence(self, name: str, section: str, sentence: str) -> Interpolator:
        """Return a copy with a slot that a named sentence fills."""
        filler = self.with_fields(self.fields.values())
        filler.own[name] = (section, sentence)
        return filler

    def _fill_value(self, part: Unfilled) -> tuple[Inline, ...]:
        """Return what a slot, a formula or a picture is replaced by."""
        if isinstance(part, PictureLink):
            picture = self.drawn.template.pictures[part.file]
            return (
                PlacedPicture(
                    picture, fill_inlines(part.alt, self._fill_value, self._fill_program)
                ),
            )
        if isinstance(part, Slot):
            return self._fill_slot(part.name)
        if isinstance(part, InlineFormula):
            return (_inline_maths(part.expr),)
        names = _list_names_in_layout(part)
        if not names:
            return (_typeset_inline_layout(part),)
        return (typeset_layout(fill_leaves(part.node, {n: self._fill_leaf(n) for n in names})),)

    def _fill_leaf(self, name: str) -> LeafValue:
        """Return what stands for a quantity, a formula or a phrase inside a formula."""
        if name not in self.own and (formula := self._find_formula(name)) is not None:
            return make_leaf_value(formula)
        if name not in self.own and name.endswith("]"):
            return make_leaf_value(*self._find_list_value(name))
        if name in self.own or name not in self.known or name in self.drawn.words:
            return LeafValue(_inlines_to_node(self._fill_slot(name)))
        value, unit = self.known[name], self.drawn.template.units.get(name, "")
        rounded = self.drawn.is_rounded(name)
        text = format_rounded(value) if rounded else self.drawn.format_value(name)
        return make_leaf_value(text, unit, is_rounded=rounded)

    def _fill_slot(self, name: str) -> tuple[Inline, ...]:
        """Return the value, formula, phrase or sentence for a slot.

        Raises ``BankError`` at the slot if its name is none of these.
        """
        drawn = self.drawn
        if name in self.own:
            return self.sentence(*self.own[name])
        if name.startswith(FIELD_MARK):
            return (self._get_field(name),)
        if (said := self._find_words(name)) is not None:
            return said
        if name in drawn.lists or name.startswith(TABLE_MARK) or name.endswith("]"):
            return self._fill_list_slot(name)
        if (formula := self._find_formula(name)) is not None:
            return (_inline_maths(formula),)
        return self._fill_number(name)

    def _find_words(self, name: str) -> tuple[Inline, ...] | None:
        """Return the text, phrase or case of a phrase that a slot stands for, if it is one."""
        drawn = self.drawn
        if (text := _get_own_text(drawn, name)) is not None:
            return to_inlines(text)
        if name in drawn.words:
            return self.sentence("words", drawn.words[name])
        if not self.hidden and name not in drawn.lists and ("words", name) in self.text.cases:
            return self.sentence("words", name)
        return None

    def _get_field(self, name: str) -> PlacedField:
        """Return the field of a part; raise the problem QG160 where none can stand."""
        if name in self.fields:
            return self.fields[name]
        blank = f"{{{{ {name} }}}}"
        what = f"{blank} is the field of a part, and stands in the section of a part alone"
        if self.fields:
            what = f"{blank}: there is no such part, or its field is more than a line or a choice"
        raise self.format_problem(what, "QG160", TEXT, blank)

    def _fill_number(self, name: str) -> tuple[Inline, ...]:
        """Return a quantity with its unit; ≈ goes before a rounded value.

        One with a format, as ``{{ h:02 }}``, is the number alone, as Python prints it.
        """
        if ":" in name:
            return to_inlines(pretty.format_number(self._format_as_python(name)))
        if name not in self.known:
            what, blank = f"{{{{ {name} }}}} is not a drawn quantity", f"{{{{ {name} }}}}"
            raise self.format_problem(what, "QG158", TEXT, blank)
        if not self.drawn.is_rounded(name):
            return to_inlines(format_quantity(self.drawn, name))
        rounded = format_rounded(self.known[name])
        return (
            RoundedMarker(),
            *to_inlines(join_unit(rounded, self.drawn.template.units.get(name, ""))),
        )

    def _format_as_python(self, slot: str) -> str:
        """Return a quantity as Python's ``format`` prints it, such as ``{{ h:02 }}``."""
        name, _, spec = slot.partition(":")
        if name not in self.known:
            self._fill_number(name)  # which raises
        try:
            return format_as_python(self.known[name], spec)
        except ValueError as error:
            blank = f"{{{{ {slot} }}}}"
            raise self.format_problem(f"{blank}: {error}", "QG158", TEXT, blank) from error

    def _fill_list_slot(self, name: str) -> tuple[Inline, ...]:
        """Return a list with its unit once, or one of its values."""
        drawn, (listed, _, place) = self.drawn, name.partition("[")
        if name.startswith(TABLE_MARK):
            what = "stands in a paragraph, in a question that draws lists"
            blank = f"{{{{ {name} }}}}"
            raise self.format_problem(f"{blank} {what}", "QG158", TEXT, blank)
        if place:
            return to_inlines(join_unit(*self._find_list_value(name)))
        self._require_list(listed, name)
        numbers = LIST_SEPARATOR.join(map(pretty.format_number, drawn.list_texts(listed)))
        shown = format_unit(drawn.template.units.get(listed, ""))
        return to_inlines(f"{numbers}{NBSP}{shown}" if shown else numbers)

    def _find_list_value(self, name: str) -> tuple[str, str]:
        """Return one value of a list, ``x[3]``, as it is shown, and its unit."""
        listed, _, place = name.partition("[")
        self._require_list(listed, name)
        texts, index = self.drawn.list_texts(listed), int(place.rstrip("]"))
        if not 1 <= index <= len(texts):
            what = f"{{{{ {name} }}}}: the list has {len(texts)} values, and the first is 1"
            raise self.format_problem(what, "QG158", TEXT, f"{{{{ {name} }}}}")
        return texts[index - 1], self.drawn.template.units.get(listed, "")

    def _find_formula(self, name: str) -> Expr | None:
        """Return the formula that a step stands for, with the drawn numbers in it, if it is one.

        None in a stem for a formula that is asked for.
        """
        parts = self.drawn.template.rules.part
        if name not in self.drawn.template.chain.form_by_name:
            return None
        if self.hidden and any(asked_form(part.answer) == name for part in parts):
            return None
        return self.drawn.form(name)

    def _fill_program(self, text: str) -> str:
        """Return program text with the known values in place."""
        return fill_program(text, self.drawn, self.known)

    def format_problem(self, what: str, rule: str, *place: str) -> BankError:
        """Return an error at a place of the language file."""
        file = self.drawn.template.path / f"{self.lang}.md"
        return BankError(what, rule=rule, file=file, place=place)


def _is_data_table(inline: Inline) -> bool:
    """Return whether a piece of a paragraph stands for a table of lists."""
    return isinstance(inline, Slot) and inline.name.startswith(TABLE_MARK)


def unbreakable_groups(parts: Iterable[Inline]) -> Iterator[tuple[Inline, ...]]:
    """Yield the pieces of a sentence inside which no line may end.

    ``f`` and ``= 6 mm`` are one. Browsers and Typst break a line on either side of a formula, even
    before a comma.
    """
    rest = deque(parts)
    while rest:
        group = [rest.popleft()]
        if not isinstance(group[0], TypesetMaths):
            yield (group[0],)
            continue
        while isinstance(last := group[-1], TypesetMaths) and len(last.typed_text) <= SHORT:
            tail = _take_formula_tail(rest)
            if not tail:
                break
            group.append(PlainText(tail))
            if tail.endswith(" ") and rest and isinstance(rest[0], TypesetMaths):
                group.append(rest.popleft())
        yield tuple(group)


def _take_formula_tail(rest: deque[Inline]) -> str:
    """Remove from the pieces what belongs to the formula in front, and return it."""
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
    """Return a formula typeset for a sentence."""
    return TypesetMaths(typeset.lay_out(expr, inline=True), format_tree(expr))


@lru_cache(maxsize=4096)
def _typeset_inline_layout(part: LaidOutFormula) -> TypesetLayout:
    """Return a formula's layout as it stands in a line, cached: sentences are filled often."""
    return typeset_layout(part.node)


@lru_cache(maxsize=4096)
def _list_names_in_layout(part: LaidOutFormula) -> frozenset[str]:
    """Return the names of the values that a formula has places for, cached."""
    return list_leaf_names(part.node)


def _inlines_to_node(parts: Iterable[Inline]) -> Node:
    """Return pieces of a sentence inside a formula: formulas as they are, all else as words."""
    nodes = [
        part.node if isinstance(part, TypesetMaths) else Phrase(_get_plain_text(part))
        for part in parts
    ]
    return nodes[0] if len(nodes) == 1 else MathRow(tuple(nodes))


def _write_short(drawn: Variant, known: Values, name: str) -> str | None:
    """Return a text, a form or a short number as it is typed; None if it is none of these."""
    if (text := _get_own_text(drawn, name)) is not None:
        return text
    if name in drawn.template.rules.data and name in drawn.words:
        return drawn.words[name]
    if name in drawn.template.chain.form_by_name:
        return pretty.format_formula(format_tree(drawn.form(name))).replace(MINUS, "-")
    return format_exact(known[name], minus="-") if name in known else None


def fill_program(text: str, drawn: Variant, known: Values) -> str:
    """Return program text, or its output, with the drawn values as a program writes them.

    Parameters
    ----------
    text : str
    drawn : Variant
    known : mapping of str to number
        The quantities that may stand there, in shown units.

    Raises
    ------
    BankError
        If a blank names another quantity, or one that is not a short decimal.
    """

    def value(name: str) -> str:
        """Return a value as a program writes it; raise ``BankError`` if it is not exact."""
        listed, _, place = name.partition("[")
        bare, _, spec = name.partition(":")
        if spec and bare in known:
            try:
                return format_as_python(known[bare], spec)
            except ValueError as error:
                what, file = f"{{{{ {name} }}}}: {error}", drawn.template.file
                raise BankError(what, rule="QG158", file=file) from error
        if listed in drawn.lists:
            texts = [text.replace(MINUS, "-") for text in drawn.format_list(listed)]
            if not place:
                return ", ".join(texts)
            if 1 <= int(place.rstrip("]")) <= len(texts):
                return texts[int(place.rstrip("]")) - 1]
        written = _write_short(drawn, known, name)
        if written is None:
            what = f"{{{{ {name} }}}} cannot stand in a program"
            raise BankError(what, rule="QG158", file=drawn.template.file)
        return written

    return fill_text(text, value)


def format_as_python(value: Value, spec: str) -> str:
    """Return a number as Python's ``format`` prints it.

    Raises
    ------
    ValueError
        If it is no whole number, where only these can be printed so.
    """
    if spec.endswith("f"):
        return format(to_float(value), spec)
    if not isinstance(value, fmpq) or value.q != 1:
        raise ValueError(f"{spec} prints whole numbers")
    return format(int(value.p), spec)


def _get_own_text(drawn: Variant, name: str) -> str | None:
    """Return a text of a table or of ``data.py``, or such a list, as it stands; else None."""
    rule = drawn.template.rules.draw.get(name)
    if name in drawn.words and not (rule and rule.words):
        return drawn.words[name]
    return TEXT_SEPARATOR.join(drawn.text_list(name)) or None


def format_quantity(drawn: Variant, name: str) -> str:
    """Return a quantity of a variant with its unit as text, exact if that is short."""
    return join_unit(drawn.format_value(name), drawn.template.units.get(name, ""))


def join_unit(text: str, unit: str) -> str:
    """Return a number and its unit with a blank between; only the degree sign stands close."""
    shown = format_unit(unit)
    return f"{pretty.format_number(text)}{'' if shown in {'', '°'} else NBSP}{shown}"


def inlines_to_text(parts: Iterable[Inline]) -> str:
    """Return the text of a filled sentence, for people.

    Raises
    ------
    BankError
        If a blank is left.
    """
    return "".join(map(_get_plain_text, parts))


def _get_plain_text(part: Inline) -> str:
    """Return the text of one piece for people; raise ``BankError`` if it is still a slot."""
    if isinstance(part, Emphasis):
        return inlines_to_text(part.children)
    if isinstance(part, Unfilled | RoundedMarker):
        raise BankError("a sentence was used before its blanks were filled")
    return part.text


def inlines_as_typed(parts: Iterable[Inline]) -> str:
    """Return a filled sentence as it would be typed, to compare with what was typed."""
    return "".join(
        inlines_as_typed(part.children)
        if isinstance(part, Emphasis)
        else part.typed_text
        if isinstance(part, TypesetMaths)
        else _get_plain_text(part)
        for part in parts
    )
