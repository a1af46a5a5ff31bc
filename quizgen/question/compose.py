"""From a draw to a question and its key, two separate values.

``Question`` holds what a learner sees before answering; ``Key`` holds the rest. Whatever is handed
only a ``Question`` cannot leak an answer.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from quizgen.bank.draw import Draw, draw, reference
from quizgen.bank.prose import Block, Inline
from quizgen.bank.template import Template
from quizgen.bank.traps import factor
from quizgen.errors import BankError
from quizgen.figures import Figure
from quizgen.figures import render as render_figure
from quizgen.maths.numbers import key_text, to_float
from quizgen.question import hints, solution, specs
from quizgen.question.solution import Solution

NBSP = "\u00a0"


@dataclass(frozen=True)
class Field:
    """One answer field.

    Parameters
    ----------
    id : str
        Name in the answer form, for example ``3b``.
    kind : str
        Answer kind.
    hints : tuple of str
        What to type, in the question's language.
    options : tuple of (str, inlines)
        Lettered choices, or the left side of a matching.
    targets : tuple of (str, inlines)
        The right side of a matching.
    """

    id: str
    kind: str
    hints: tuple[str, ...]
    options: tuple[tuple[str, tuple[Inline, ...]], ...] = ()
    targets: tuple[tuple[str, tuple[Inline, ...]], ...] = ()


@dataclass(frozen=True)
class Part:
    """One sub-question as the learner sees it."""

    label: str
    points: Fraction
    body: tuple[Block, ...]
    field: Field


@dataclass(frozen=True)
class Question:
    """A question in one language, without anything that gives its answer away."""

    template: str
    number: str
    lang: str
    tier: str
    topic: str
    title: str
    minutes: int
    stem: tuple[Block, ...]
    parts: tuple[Part, ...]
    figure: Figure | None = None

    @property
    def points(self) -> Fraction:
        """Marks of all parts."""
        return sum((part.points for part in self.parts), Fraction(0))


@dataclass(frozen=True)
class Key:
    """Answers, worked solution and everything needed to mark one question."""

    template: str
    number: str
    identity: str
    specs: tuple[dict[str, Any], ...]
    solution: Solution
    chain: dict[str, Any] | None
    draw: Draw
    figure: Figure | None = None


def instance(template: Template, seed: str | int, slot: str | int = "0") -> Draw:
    """Draw a template, or take its reference instance for ``seed="reference"``."""
    return reference(template) if seed == "reference" else draw(template, seed, slot)


def compose(
    template: Template,
    seed: str | int = 0,
    lang: str = "en",
    *,
    slot: str | int = "0",
    number: str = "1",
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
    number : str
        Its printed number.
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
    return put_into_words(instance(template, seed, slot), lang, number=number, figures=figures)


def put_into_words(
    drawn: Draw, lang: str, *, number: str = "1", figures: bool = True
) -> tuple[Question, Key]:
    """Compose an instance that has already been drawn."""
    template = drawn.template
    if lang not in template.texts:
        raise BankError(f"template {template.id!r} is not written in {lang!r}")
    built = tuple(specs.build(drawn, i) for i in range(len(template.rules.part)))
    question = Question(
        template=template.id,
        number=number,
        lang=lang,
        tier=template.rules.tier,
        topic=template.rules.topic,
        title=template.texts[lang].title,
        minutes=template.minutes,
        stem=solution.filled(template.texts[lang].stem, drawn, lang, hidden=True),
        parts=tuple(_part(drawn, lang, i, number, spec) for i, spec in enumerate(built)),
        figure=_figure(drawn, lang, quiz=True) if figures else None,
    )
    key = Key(
        template=template.id,
        number=number,
        identity=identity(drawn),
        specs=built,
        solution=solution.solve(drawn, lang, built),
        chain=chain_table(drawn),
        draw=drawn,
        figure=_figure(drawn, lang, quiz=False) if figures else None,
    )
    return question, key


def identity(drawn: Draw) -> str:
    """Name of the variant: two questions are the same if and only if this is the same."""
    numbers = [f"{name}={key_text(value)}" for name, value in sorted(drawn.shown.items())]
    words = [f"{name}={value}" for name, value in sorted(drawn.words.items())]
    return f"{drawn.template.id}({', '.join(numbers + words)})"


def _part(drawn: Draw, lang: str, index: int, number: str, spec: Mapping[str, Any]) -> Part:
    template = drawn.template
    label = template.labels[index]
    body = template.texts[lang].sections.get(label, ()) if label else ()
    if label and not body:
        raise BankError(f"template {template.id!r}: section {label!r} is missing in {lang}.md")
    return Part(
        label=label,
        points=Fraction(str(template.rules.part[index].points)),
        body=solution.filled(body, drawn, lang, hidden=True),
        field=_field(drawn, lang, index, f"{number}{label}", spec),
    )


def _field(drawn: Draw, lang: str, index: int, name: str, spec: Mapping[str, Any]) -> Field:
    answer = drawn.template.rules.part[index].answer
    options, targets = specs.display(drawn, index)
    return Field(
        id=name,
        kind=str(spec["kind"]),
        hints=hints.hints(answer, spec, lang),
        options=_lettered(drawn, lang, options),
        targets=_lettered(drawn, lang, targets),
    )


def _lettered(
    drawn: Draw, lang: str, names: tuple[tuple[str, str], ...]
) -> tuple[tuple[str, tuple[Inline, ...]], ...]:
    return tuple(
        (mark, solution.sentence(drawn, lang, "options", name, hidden=True)) for mark, name in names
    )


def figure_values(drawn: Draw) -> dict[str, Any]:
    """Parameters of the template's figure, as floats in shown units (words stay words)."""
    from quizgen.bank.draw import plan_of
    from quizgen.maths.systems import compile_expr, exact

    rule = drawn.template.rules.figure
    if rule is None:
        return {}
    env = plan_of(drawn.template).shown_env(drawn.shown, drawn.values)
    result: dict[str, Any] = {}
    for name, source in rule.values.items():
        if isinstance(source, str) and source in drawn.words:
            result[name] = drawn.words[source]
        elif isinstance(source, str):
            value = compile_expr(drawn.template.formula(source), exact())(env)
            result[name] = to_float(value)
        else:
            result[name] = source
    return result


def _figure(drawn: Draw, lang: str, *, quiz: bool) -> Figure | None:
    rule = drawn.template.rules.figure
    if rule is None or (quiz and not rule.quiz):
        return None
    return render_figure(rule.name, figure_values(drawn), quiz=quiz, lang=lang)


def chain_table(drawn: Draw) -> dict[str, Any] | None:
    """The chain with its numbers as plain JSON, for marking without SymPy."""
    chain = drawn.template.chain
    if not chain.steps:
        return None
    from quizgen.maths.notation import to_text

    units = drawn.template.units
    return {
        "given": {
            name: {
                "value": key_text(drawn.shown[name] * factor(units.get(name, ""))),
                "unit": units.get(name, ""),
            }
            for name in chain.given
        },
        "steps": [[step.name, to_text(step.expr), step.unit] for step in chain.steps],
    }
