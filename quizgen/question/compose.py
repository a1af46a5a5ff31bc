"""From a variant to a question and its key, two separate values.

``Question`` holds what a learner sees before answering; ``Key`` holds the rest. Whatever is handed
only a ``Question`` cannot leak an answer.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import msgspec
from markupsafe import Markup

from quizgen.bank.levels import EXAM
from quizgen.bank.template import Template
from quizgen.bank.variant import Variant, draw_variant, reference_variant
from quizgen.core.errors import BankError
from quizgen.core.untrusted import error_context
from quizgen.figures import FieldPicture, Figure
from quizgen.grading.spec import AnySpec, NumericSpec
from quizgen.kinds import KINDS
from quizgen.kinds.contract import InputBox, InputControl, asked_form
from quizgen.maths.chain import Chain
from quizgen.maths.notation import format_tree
from quizgen.maths.numbers import format_for_key
from quizgen.maths.recipes import encode_form, encode_recipe
from quizgen.maths.units import format_unit
from quizgen.question.data_files import build_file_paragraphs
from quizgen.question.figure import draw_question_figure
from quizgen.question.html import blocks_to_html, inlines_to_html
from quizgen.question.interpolation import inlines_to_text
from quizgen.question.levels import effective_level, load_level
from quizgen.question.levels.contract import Choice, LevelPart
from quizgen.question.localise import localise
from quizgen.question.solution import Solution
from quizgen.typeset.prose import Block, Inline, TypesetMaths, join_inlines, to_inlines


class AnswerField(msgspec.Struct, frozen=True):
    """One answer field.

    Parameters
    ----------
    id : str
        Name in the answer form, for example ``3b``.
    control : InputControl
        How it is answered.
    asks : tuple of inlines
        Sentences that say what to type, in the question's language.
    options : tuple of (str, inlines)
        Lettered choices, or the left side of a matching.
    targets : tuple of (str, inlines)
        The right side of a matching.
    drawing : FieldPicture, optional
        The empty field, if the answer is drawn.
    near : str, optional
        The words around the field, if it stands inside a sentence or a cell (``PlacedField``).
    on_paper : tuple of inlines
        What is said beside the field on paper, where nothing is typed.
    box : InputBox
        Of an answer with one value: its letter if the question has it, and its unit.
    is_number : bool
        Whether the answer is made of numbers, which take less room than formulas and words.
    has_power : bool
        Whether one of them is so small or large that a power of ten shortens it.
    """

    id: str
    control: InputControl
    asks: tuple[tuple[Inline, ...], ...]
    options: tuple[Choice, ...] = ()
    targets: tuple[Choice, ...] = ()
    drawing: FieldPicture | None = None
    near: str | None = None
    on_paper: tuple[tuple[Inline, ...], ...] = ()
    box: InputBox = InputBox("")
    is_number: bool = False
    has_power: bool = False

    @property
    def hints(self) -> tuple[str, ...]:
        """Return what to type, one text for each line."""
        return tuple(map(inlines_to_text, self.asks))

    @property
    def hint(self) -> tuple[Inline, ...]:
        """Return what to type, as one run of sentences."""
        return join_inlines(self.asks, " ")

    @property
    def boxes(self) -> tuple[InputBox, ...]:
        """Return the boxes of an answer on paper, each with its unit as it is printed."""
        boxes = self.control.boxes or (self.box,)
        return tuple(InputBox(b.name, format_unit(b.unit) if b.unit else "") for b in boxes)

    @property
    def has_unit(self) -> bool:
        """Return whether the answer has a unit that earns something: a percentage has none."""
        return any(box.unit not in {"", "%", "1"} for box in self.boxes)

    @property
    def hint_on_paper(self) -> tuple[Inline, ...]:
        """Return what is said beside the field on paper, as one run of sentences."""
        return join_inlines(self.on_paper, ", " if self.is_number else " ")

    @property
    def hint_in_fields(self) -> tuple[Inline, ...]:
        """Return what to type where every value has a field of its own."""
        return join_inlines(self.asks[1:] if self.control.has_several_fields else self.asks, " ")


class QuestionPart(msgspec.Struct, frozen=True):
    """One sub-question as the learner sees it.

    ``shared`` is the text of a part before it that its field stands in, for what shows it alone.
    """

    label: str
    points: Fraction
    body: tuple[Block, ...]
    field: AnswerField
    shared: tuple[Block, ...] = ()

    def to_html(self, lang: str) -> Markup:
        """Return the part with its options and hints as HTML."""
        label = Markup("<h4>({})</h4>").format(self.label) if self.label else Markup("")
        choices = Markup("").join(
            Markup("<li>{} {}</li>").format(mark, inlines_to_html(text, lang))
            for mark, text in (*self.field.options, *self.field.targets)
        )
        listed = Markup("<ul>{}</ul>").format(choices) if choices else Markup("")
        hints = Markup("<p><small>{}</small></p>").format(inlines_to_html(self.field.hint, lang))
        return Markup("").join((label, blocks_to_html(self.body, lang), listed, hints))


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
    parts: tuple[QuestionPart, ...]
    figure: Figure | None = None

    @property
    def points(self) -> Fraction:
        """Return the marks of all parts."""
        return sum((part.points for part in self.parts), Fraction(0))

    def __repr__(self) -> str:
        """Return number, template, language and title."""
        return f"<Question {self.number} of {self.template} ({self.lang}): {self.title}>"

    def _repr_html_(self) -> str:
        """Return the question as a notebook shows it."""
        head = Markup("<h3>{}. {}</h3>").format(self.number, self.title)
        picture = Markup(self.figure.inline_svg.decode()) if self.figure else Markup("")  # noqa: S704
        parts = (part.to_html(self.lang) for part in self.parts)
        return str(Markup("").join((head, blocks_to_html(self.stem, self.lang), picture, *parts)))


class QuestionKey(msgspec.Struct, frozen=True):
    """Answers, worked solution and everything needed to mark one question."""

    template: str
    number: str
    identity: str
    specs: tuple[AnySpec, ...]
    solution: Solution
    chain: dict[str, Any] | None
    draw: Variant
    figure: Figure | None = None
    level: str = EXAM

    def __repr__(self) -> str:
        """Return number and identity, and none of the answers: a notebook shows it to anyone."""
        return f"<Key {self.number} of {self.identity}>"


def draw_instance(template: Template, seed: str | int, slot: str | int = "0") -> Variant:
    """Return a variant of a template, or its reference instance for ``seed="reference"``."""
    return (
        reference_variant(template) if seed == "reference" else draw_variant(template, seed, slot)
    )


def compose_question(
    template: Template,
    seed: str | int = 0,
    lang: str = "en",
    *,
    slot: str | int = "0",
    level: str = EXAM,
    figures: bool = True,
) -> tuple[Question, QuestionKey]:
    """Return a question and its key, drawn from a template and put into words.

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
    (Question, QuestionKey)

    Raises
    ------
    BankError
        If the template is not written in this language or a sentence is missing.
    SamplingError
        If no admissible numbers exist.
    """
    drawn = draw_instance(template, seed, slot)
    return compose_variant(drawn, lang, level=level, figures=figures)


def compose_variant(
    drawn: Variant, lang: str, *, number: str = "1", level: str = EXAM, figures: bool = True
) -> tuple[Question, QuestionKey]:
    """Return a variant in words: the question, and apart from it its key.

    Raises
    ------
    BankError
        If the template is not written in this language or a sentence is missing.
    InvalidChoiceError
        If there is no such level.
    """
    template = drawn.template
    if lang not in template.languages:
        known = ", ".join(template.languages)
        raise BankError(f"template {template.id!r} is not written in {lang!r} (only in {known})")
    with error_context(template.file):
        return _build_question_and_key(
            drawn, lang, number, effective_level(drawn, level), figures=figures
        )


def _build_question_and_key(
    drawn: Variant, lang: str, number: str, level: str, *, figures: bool
) -> tuple[Question, QuestionKey]:
    """Return a question and, apart from it, what answers it."""
    template = drawn.template
    asking = load_level(level).ask(drawn, lang)
    question = Question(
        template=template.id,
        number=number,
        lang=lang,
        tier=template.rules.tier,
        topic=template.rules.topic,
        title=template.texts[lang].title,
        minutes=template.minutes if asking.minutes is None else asking.minutes,
        stem=localise(lang, (*asking.stem, *build_file_paragraphs(drawn, lang, number))),
        parts=localise(lang, tuple(_build_part(part, lang, number) for part in asking.parts)),
        figure=draw_question_figure(drawn, lang, quiz=True) if figures else None,
    )
    key = QuestionKey(
        template=template.id,
        number=number,
        identity=drawn.identity if level == EXAM else f"{drawn.identity}/{level}",
        specs=tuple(part.spec for part in asking.parts),
        solution=localise(lang, asking.solution),
        chain=chain_as_json(drawn),
        draw=drawn,
        figure=draw_question_figure(drawn, lang, quiz=False) if figures else None,
        level=level,
    )
    return question, key


def _build_part(asked: LevelPart, lang: str, number: str) -> QuestionPart:
    """Return one part as the learner sees it; its field is named by number and label."""
    kind = KINDS[asked.spec.kind]
    hints = kind.input_hints(asked.spec, lang)
    is_plain = asked.near is not None and asked.control.form == "gaps"  # a word in its sentence
    field = AnswerField(
        id=f"{number}{asked.label}",
        control=asked.control,
        asks=() if is_plain else tuple(map(to_inlines, hints)),
        options=asked.options,
        targets=asked.targets,
        drawing=FieldPicture(asked.control.board, lang) if asked.control.board else None,
        near=asked.near,
        on_paper=() if is_plain else tuple(map(to_inlines, kind.paper_hints(asked.spec, lang))),
        box=_build_box(asked),
        is_number=isinstance(asked.spec, NumericSpec),
        has_power=_needs_power(asked.spec),
    )
    return QuestionPart(asked.label, asked.points, asked.body, field, asked.shared)


_LONG = re.compile(r"·10[⁻⁰¹²³⁴-⁹]|(?<!\d)0\.000|\d{7}")
"""In a printed key: what takes more cells than a box has, or a power of ten."""


def _needs_power(spec: AnySpec) -> bool:
    """Return whether a power of ten shortens a number of an answer."""
    return isinstance(spec, NumericSpec) and _LONG.search(spec.show()) is not None


def _build_box(asked: LevelPart) -> InputBox:
    """Return what is printed before and after the field of one value, as its spec has it.

    Its letter stands there only if the part has it: another name would tell what to look for.
    """
    names = set(asked.spec.quantities()) & set(_iter_formulas(asked.body))
    return InputBox(names.pop() if len(names) == 1 else "", asked.spec.printed_unit)


def _iter_formulas(said: object) -> Iterator[str]:
    """Yield the formulas of prose, as they are typed."""
    if isinstance(said, TypesetMaths):
        yield said.typed_text
    elif isinstance(said, tuple | msgspec.Struct):
        for one in said if isinstance(said, tuple) else msgspec.structs.astuple(said):
            yield from _iter_formulas(one)


def _format_given_for_key(drawn: Variant, name: str) -> str | list[str]:
    """Return a given quantity in base units, of a list each value."""
    factor = drawn.template.unit_factor(drawn.template.units.get(name, ""))
    if name in drawn.lists:
        return [format_for_key(value * factor) for value in drawn.lists[name]]
    return format_for_key(drawn.shown[name] * factor)


def _write_forms(chain: Chain) -> dict[str, Any]:
    """Return the forms of a chain, and how steps follow from them, as plain JSON."""
    recipes = {
        step.name: encode_recipe(step.recipe)
        for step in (*chain.steps, *chain.forms)
        if step.recipe is not None
    }
    return {
        "forms": {step.name: encode_form(step.expr) for step in chain.forms},
        **({"recipes": recipes} if recipes else {}),
        **({"free": list(chain.free)} if chain.free else {}),
    }


def chain_as_json(drawn: Variant) -> dict[str, Any] | None:
    """Return the chain with its numbers as plain JSON, for grading without SymPy."""
    chain = drawn.template.chain
    carries = len(drawn.template.rules.part) > 1 and any(
        asked_form(part.answer) for part in drawn.template.rules.part
    )
    if not chain.steps and not carries:
        return None
    units, own = drawn.template.units, drawn.template.about.units
    others = [[other.name, format_tree(other.expr)] for other in chain.alternatives]
    checked = [name for name, grade in chain.certainties.items() if grade == "checked"]
    return {
        **({"define": list(own)} if own else {}),
        **({"checked": checked} if checked else {}),
        "given": {
            name: {
                "value": _format_given_for_key(drawn, name),
                "unit": units.get(name, ""),
            }
            for name in chain.given
        },
        "steps": [[step.name, format_tree(step.expr), step.unit] for step in chain.steps],
        **({"alternatives": others} if others else {}),
        **(_write_forms(chain) if carries else {}),
    }
