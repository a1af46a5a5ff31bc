"""From a draw to a question and its key, two separate values.

``Question`` holds what a learner sees before answering; ``Key`` holds the rest. Whatever is handed
only a ``Question`` cannot leak an answer.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import Any

import msgspec
from markupsafe import Markup

from quizgen.bank.draw import Draw, draw, reference
from quizgen.bank.levels import EXAM
from quizgen.bank.pools import named
from quizgen.bank.prose import Block, Inline
from quizgen.bank.template import Template
from quizgen.errors import BankError
from quizgen.figures import FieldPicture, Figure
from quizgen.marking.specs import AnySpec
from quizgen.maths.notation import to_text
from quizgen.maths.numbers import key_text
from quizgen.outside import located
from quizgen.question.contract import Control
from quizgen.question.filling import plain
from quizgen.question.kinds import KINDS
from quizgen.question.levels import level as at_level
from quizgen.question.levels import level_of
from quizgen.question.levels.asking import Asked, Choice
from quizgen.question.markup import blocks, inline
from quizgen.question.notation import in_notation
from quizgen.question.picture import pictured
from quizgen.question.shown import listed, pieces
from quizgen.question.solution import Solution


class Field(msgspec.Struct, frozen=True):
    """One answer field.

    Parameters
    ----------
    id : str
        Name in the answer form, for example ``3b``.
    control : Control
        How it is answered.
    asks : tuple of inlines
        Sentences that say what to type, in the question's language.
    options : tuple of (str, inlines)
        Lettered choices, or the left side of a matching.
    targets : tuple of (str, inlines)
        The right side of a matching.
    drawing : FieldPicture, optional
        The empty field, if the answer is drawn.
    """

    id: str
    control: Control
    asks: tuple[tuple[Inline, ...], ...]
    options: tuple[Choice, ...] = ()
    targets: tuple[Choice, ...] = ()
    drawing: FieldPicture | None = None

    @property
    def hints(self) -> tuple[str, ...]:
        """What to type, as text."""
        return tuple(map(plain, self.asks))

    @property
    def hint(self) -> tuple[Inline, ...]:
        """What to type, as one run of sentences."""
        return listed(self.asks, " ")

    @property
    def hint_in_fields(self) -> tuple[Inline, ...]:
        """What to type where every value has a field of its own."""
        return listed(self.asks[1:] if self.control.several else self.asks, " ")


class Part(msgspec.Struct, frozen=True):
    """One sub-question as the learner sees it."""

    label: str
    points: Fraction
    body: tuple[Block, ...]
    field: Field

    def html(self, lang: str) -> Markup:
        """The part with its options and hints."""
        label = Markup("<h4>({})</h4>").format(self.label) if self.label else Markup("")
        choices = Markup("").join(
            Markup("<li>{} {}</li>").format(mark, inline(text, lang))
            for mark, text in (*self.field.options, *self.field.targets)
        )
        listed = Markup("<ul>{}</ul>").format(choices) if choices else Markup("")
        hints = Markup("<p><small>{}</small></p>").format(inline(self.field.hint, lang))
        return Markup("").join((label, blocks(self.body, lang), listed, hints))


class Question(msgspec.Struct, frozen=True):
    """A question in one language, without anything that gives its answer away."""

    template: str
    number: str
    lang: str
    tier: str
    topic: str
    title: str
    minutes: Fraction
    stem: tuple[Block, ...]
    parts: tuple[Part, ...]
    figure: Figure | None = None

    @property
    def points(self) -> Fraction:
        """Marks of all parts."""
        return sum((part.points for part in self.parts), Fraction(0))

    def __repr__(self) -> str:
        return f"<Question {self.number} of {self.template} ({self.lang}): {self.title}>"

    def _repr_html_(self) -> str:
        """The question as a notebook shows it."""
        head = Markup("<h3>{}. {}</h3>").format(self.number, self.title)
        picture = Markup(self.figure.inline_svg.decode()) if self.figure else Markup("")  # noqa: S704
        parts = (part.html(self.lang) for part in self.parts)
        return str(Markup("").join((head, blocks(self.stem, self.lang), picture, *parts)))


class Key(msgspec.Struct, frozen=True):
    """Answers, worked solution and everything needed to mark one question."""

    template: str
    number: str
    identity: str
    specs: tuple[AnySpec, ...]
    solution: Solution
    chain: dict[str, Any] | None
    draw: Draw
    figure: Figure | None = None
    level: str = EXAM

    def __repr__(self) -> str:
        return f"<Key {self.number} of {self.identity}>"


def instance(template: Template, seed: str | int, slot: str | int = "0") -> Draw:
    """Draw a template, or take its reference instance for ``seed="reference"``."""
    return reference(template) if seed == "reference" else draw(template, seed, slot)


def compose(
    template: Template,
    seed: str | int = 0,
    lang: str = "en",
    *,
    slot: str | int = "0",
    level: str = EXAM,
    figures: bool = True,
) -> tuple[Question, Key]:
    """Draw a template and put it into words.

    Parameters
    ----------
    template : Template
    seed : str or int
        The paper's seed; ``"reference"`` gives the numbers printed in the notes.
    lang : str
        Language of the question.
    slot : str or int
        The question's place in the paper: part of what determines its numbers.
    level : str
        ``exam``, ``guided``, ``transfer``, or ``mixed`` for one of them by the seed.
    figures : bool
        Whether to draw the figures.

    Returns
    -------
    (Question, Key)

    Raises
    ------
    BankError
        If the template is not written in this language or a sentence is missing.
    DrawError
        If no admissible numbers exist.
    """
    drawn = instance(template, seed, slot)
    return put_into_words(drawn, lang, level=level, figures=figures)


def put_into_words(
    drawn: Draw, lang: str, *, number: str = "1", level: str = EXAM, figures: bool = True
) -> tuple[Question, Key]:
    """Compose an instance that has already been drawn.

    Raises
    ------
    BankError
        If the template is not written in this language or a sentence is missing.
    ChoiceError
        If there is no such level.
    """
    template = drawn.template
    if lang not in template.languages:
        known = ", ".join(template.languages)
        raise BankError(f"template {template.id!r} is not written in {lang!r} (only in {known})")
    with located(template.file):
        return _worded(drawn, lang, number, level_of(drawn, level), figures=figures)


def _worded(
    drawn: Draw, lang: str, number: str, level: str, *, figures: bool
) -> tuple[Question, Key]:
    template = drawn.template
    asking = at_level(level).asking(drawn, lang)
    question = Question(
        template=template.id,
        number=number,
        lang=lang,
        tier=template.rules.tier,
        topic=template.rules.topic,
        title=template.texts[lang].title,
        minutes=Fraction(template.minutes),
        stem=in_notation(lang, asking.stem),
        parts=in_notation(lang, tuple(_part(part, lang, number) for part in asking.parts)),
        figure=pictured(drawn, lang, quiz=True) if figures else None,
    )
    key = Key(
        template=template.id,
        number=number,
        identity=identity(drawn, level),
        specs=tuple(part.spec for part in asking.parts),
        solution=in_notation(lang, asking.solution),
        chain=chain_table(drawn),
        draw=drawn,
        figure=pictured(drawn, lang, quiz=False) if figures else None,
        level=level,
    )
    return question, key


@lru_cache(maxsize=512)
def identity(drawn: Draw, level: str = EXAM) -> str:
    """Name of the variant: two questions are the same if and only if this is the same."""
    numbers = [f"{name}={key_text(value)}" for name, value in sorted(drawn.shown.items())]
    words = [f"{name}={value}" for name, value in sorted(drawn.words.items())]
    whole = f"{drawn.template.id}({', '.join(numbers + words + named(drawn))})"
    return whole if level == EXAM else f"{whole}/{level}"


def _part(asked: Asked, lang: str, number: str) -> Part:
    field = Field(
        id=f"{number}{asked.label}",
        control=asked.control,
        asks=tuple(map(pieces, KINDS[asked.spec.kind].hints(asked.spec, lang))),
        options=asked.options,
        targets=asked.targets,
        drawing=FieldPicture(asked.control.board, lang) if asked.control.board else None,
    )
    return Part(asked.label, asked.points, asked.body, field)


def chain_table(drawn: Draw) -> dict[str, Any] | None:
    """The chain with its numbers as plain JSON, for marking without SymPy."""
    chain = drawn.template.chain
    if not chain.steps:
        return None
    units = drawn.template.units
    return {
        "given": {
            name: {
                "value": key_text(drawn.shown[name] * drawn.template.factor(units.get(name, ""))),
                "unit": units.get(name, ""),
            }
            for name in chain.given
        },
        "steps": [[step.name, to_text(step.expr), step.unit] for step in chain.steps],
    }
