"""Sentences of a template with their blanks filled from a draw."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator
from functools import lru_cache

from quizgen import typeset
from quizgen.bank.markdown import (
    Block,
    ConditionalSentence,
    Emphasis,
    Inline,
    PictureLink,
    PlainText,
    RoundedMarker,
    Slot,
    Unfilled,
    fill_blocks,
    fill_inlines,
    fill_text,
    slot_names,
)
from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError
from quizgen.core.positions import TEXT
from quizgen.kinds.contract import LabelledName, asked_form
from quizgen.maths.notation import format_tree, pretty
from quizgen.maths.numbers import format_exact, format_rounded
from quizgen.maths.tree import Expr
from quizgen.maths.units import format_unit
from quizgen.maths.values import Values
from quizgen.question.inlines import PlacedPicture, TypesetMaths, to_inlines

NBSP = "\u00a0"
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
        return fill_blocks(parts, self._fill_value, self._fill_program)

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
        if name in drawn.words:
            return self.sentence("words", drawn.words[name])
        if not self.hidden and ("words", name) in self.text.cases:
            return self.sentence("words", name)
        if name in drawn.template.chain.form_by_name and self._may_show_form(name):
            return (_inline_maths(drawn.form(name)),)
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

    def _may_show_form(self, name: str) -> bool:
        """Whether a formula of the solver may stand here: in a stem none that is asked for."""
        parts = self.drawn.template.rules.part
        return not self.hidden or all(asked_form(part.answer) != name for part in parts)

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
