"""Questions as Moodle XML: a category for each slot, a question for each variant.

A part alone becomes a question of Moodle's own type for it. Several parts, or several values, make
one question with embedded fields (cloze), so that its figure and its story stand there once; each
part that a person grades becomes an essay of its own.

Sources: Moodle documentation, "Moodle XML format" and "Embedded Answers (Cloze) question type".
"""

from __future__ import annotations

import base64
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial, singledispatch
from itertools import groupby
from math import lcm

import jinja2
from markupsafe import Markup

from quizgen.figures import Figure
from quizgen.lms.interactions import (
    ChoiceInteraction,
    ExtendedTextInteraction,
    Interaction,
    MatchInteraction,
    NumericInteraction,
    OrderInteraction,
    TextEntryInteraction,
    TrueFalseInteraction,
    needs_manual_grading,
    order_as_match,
)
from quizgen.lms.items import CourseQuestion, ExportItem, part_suffix
from quizgen.lms.manifest import ManifestQuestion
from quizgen.lms.manifest_writer import manifest_question
from quizgen.lms.markup import (
    field_html,
    fill_marks,
    hint_html,
    image_name,
    list_marks,
    mark_fields,
    option_html,
    part_html,
    question_images,
    question_mark,
    solution_html,
    solution_images,
    stem_html,
    target_texts,
    to_course_html,
    with_language,
)
from quizgen.lms.weighted_answers import weighted_answers, with_letter
from quizgen.locale import translate
from quizgen.render.layouts import jinja_environment
from quizgen.typeset.prose import PlainText

# Stands in a text until a field takes its place; no text has this character.
_FIELD_MARK = Markup("\N{OBJECT REPLACEMENT CHARACTER}")

_QUESTION_TYPES = {
    "number": "numerical",
    "one": "multichoice",
    "many": "multichoice",
    "truth": "truefalse",
    "pairs": "matching",
    "order": "ordering",
    "words": "shortanswer",
}


@dataclass(frozen=True)
class MoodleQuestion(CourseQuestion):
    """A question as Moodle has it.

    ``type`` is Moodle's name of its type; ``interaction`` is what it asks if that is one thing.
    """

    type: str
    interaction: Interaction | None = None

    @property
    def category(self) -> str:
        """Its category: another one for each question of an item, or a quiz would draw any."""
        return f"{self.item.category}{self.suffix.replace('.', '-')}"

    @property
    def text(self) -> Markup:
        """Its text, with the token at the end that its responses are recognized by."""
        before, token = stem_html(self.item, _file_address), question_mark(self.item, self.suffix)
        if self.type == "cloze":
            return _escape_braces(before) + _cloze_html(self) + token
        lang, alone = self.item.lang, len(self.parts) == 1
        parts = [
            part_html(part, found, lang, _file_address, alone=alone) for part, found in self.parts
        ]
        return before + Markup("").join(parts) + token

    @property
    def labels(self) -> list[str]:
        """The labels of its parts."""
        return [part.label for part, _ in self.parts]


def write_moodle(items: Iterable[ExportItem]) -> bytes:
    """Return the questions as a file to import, equal for equal questions."""
    questions = [question for item in items for question in moodle_questions(item)]
    questions.sort(key=_get_category)
    page = _load_layouts().get_template("moodle.xml.j2")
    return page.render(slots=groupby(questions, key=_get_category)).encode()


def moodle_manifest(item: ExportItem) -> Iterator[ManifestQuestion]:
    """Yield how the responses to each question of an item are read back."""
    for question in moodle_questions(item):
        yield manifest_question(question, embedded=question.type == "cloze")


def _get_category(question: MoodleQuestion) -> str:
    """Return the category of a question: the key that questions are sorted and grouped by."""
    return question.category


@cache
def _load_layouts() -> jinja2.Environment:
    """Return the Jinja environment with the layout of Moodle XML."""
    layouts = jinja_environment("quizgen.lms")
    layouts.globals.update(
        answers=weighted_answers,
        asked=lambda question: question_images(question.item, question.labels),
        base64=lambda data: base64.b64encode(data).decode(),
        cdata=lambda text: Markup(str(text).replace("]]>", "]]]]><![CDATA[>")),  # noqa: S704
        hints=hint_html,
        in_order=lambda order: [(letter, dict(order.steps)[letter]) for letter in order.right],
        inline=to_course_html,
        marked=option_html,
        solution=lambda question: solution_html(question.item, _file_address, question.labels),
        solved=lambda question: solution_images(question.item, question.labels),
        spoken=with_language,
        targets=target_texts,
    )
    return layouts


def _file_address(figure: Figure) -> str:
    """Return the address of a figure that is attached to its question."""
    return f"@@PLUGINFILE@@/{image_name(figure)}"


def moodle_questions(item: ExportItem) -> Iterator[MoodleQuestion]:
    """Yield the questions that an item becomes: one, and an essay for each manual part."""
    automatic = [(part, found) for part, found in item.parts if not needs_manual_grading(found)]
    if automatic:
        yield _single_question(item) or MoodleQuestion(item, "", automatic, "cloze")
    for part, found in item.parts:
        for one in found:
            if isinstance(one, ExtendedTextInteraction):
                yield MoodleQuestion(item, part_suffix(part), [(part, found)], "essay", one)


def _single_question(item: ExportItem) -> MoodleQuestion | None:
    """Return a question of Moodle's own type if one thing is asked, else None."""
    _, found = item.parts[0]
    if len(item.parts) > 1 or len(found) > 1:
        return None
    (interaction,) = found
    if isinstance(interaction, OrderInteraction) and not interaction.is_complete:
        interaction = order_as_match(interaction, item.lang)
    return MoodleQuestion(item, "", item.parts, _QUESTION_TYPES[interaction.kind], interaction)


def _cloze_html(question: MoodleQuestion) -> Markup:
    """Return the parts as cloze text, with a field for each value.

    A field of a sentence or a cell stands there if that leaves the fields in the order of the
    parts, in which responses come back; else it stands below.
    """
    lang = question.item.lang
    shares = [part.points / _count_fields(found, lang) for part, found in question.parts]
    # Weights of fields are whole numbers.
    scale = lcm(*(share.denominator for share in shares))
    weights = [int(share * scale) for share in shares]
    below = [
        Markup("").join(_embed_interaction(one, weight, lang) for one in found)
        for (_, found), weight in zip(question.parts, weights, strict=True)
    ]
    placed = {
        place: field
        for place, ((part, found), weight) in enumerate(zip(question.parts, weights, strict=True))
        if part.field.near is not None and (field := _embed_in_line(found, weight, lang))
    }
    mark = partial(mark_fields, question.parts, lang, _file_address, escape=_escape_braces)
    text = mark(frozenset(placed))
    if list_marks(text) != [*range(len(below))]:
        text, placed = mark(frozenset()), {}
    return fill_marks(text, [placed.get(place, field) for place, field in enumerate(below)])


def _embed_in_line(found: Sequence[Interaction], weight: int, lang: str) -> Markup:
    """Return the fields of a part that stand inside a sentence; empty where there are none."""
    fields = [_write_line_field(one, weight, lang) for one in found]
    return Markup("; ").join(fields) if all(fields) else Markup("")


def _write_line_field(interaction: Interaction, weight: int, lang: str) -> Markup:
    """Return a field for a number or words, or a drop-down list; empty for what is none."""
    match interaction:
        case NumericInteraction():
            kind = "NUMERICAL"
        case TextEntryInteraction():
            kind = "SHORTANSWER_C" if interaction.printed else "SHORTANSWER"
        case ChoiceInteraction(many=False):
            shown = [to_course_html(option.words, lang) for option in interaction.options]
            kind = "MULTICHOICE_V" if any("<" in one for one in shown) else "MULTICHOICE"
        case TrueFalseInteraction():
            return _cloze_field(weight, "MULTICHOICE", _list_truths(interaction, lang))
        case _:
            return Markup("")
    rows = list[tuple[str, float, Markup]]()
    for one in weighted_answers(interaction, lang):
        typed = f"{one.text}:{one.tolerance}" if kind == "NUMERICAL" else ""
        typed = typed or _escape_cloze(with_letter(one) if one.letter else one.text)
        rows.append((typed, one.percent, one.feedback))
    return _cloze_field(weight, kind, rows)


def _escape_braces(text: Markup) -> Markup:
    """Return a text in which no brace begins a field."""
    return Markup(text.replace("{", "&#123;"))  # noqa: S704 - the same page


def _count_fields(found: Sequence[Interaction], lang: str) -> int:
    """Return how many cloze fields the interactions of a part need."""
    return sum(
        len(order_as_match(one, lang).stems)
        if isinstance(one, MatchInteraction | OrderInteraction)
        else 1
        for one in found
    )


@singledispatch
def _embed_interaction(interaction: Interaction, _weight: int, _lang: str) -> Markup:
    """Return an interaction as cloze fields; ``_weight`` is a whole number of marks for each."""
    raise TypeError(type(interaction).__name__)


@_embed_interaction.register
def _embed_number(interaction: NumericInteraction, weight: int, lang: str) -> Markup:
    """Return a numeric field between its name and its unit."""
    around = _escape_braces(field_html(interaction, _FIELD_MARK, lang))
    field = _write_line_field(interaction, weight, lang)
    return Markup(around.replace(_FIELD_MARK, field))  # noqa: S704 - escaped


@_embed_interaction.register
def _embed_text(interaction: TextEntryInteraction, weight: int, lang: str) -> Markup:
    """Return a field for words; a program's output is compared with its capitals."""
    return Markup("<p>{}</p>").format(_write_line_field(interaction, weight, lang))


@_embed_interaction.register
def _embed_choice(interaction: ChoiceInteraction, weight: int, lang: str) -> Markup:
    """Return a list of options to choose from."""
    kind = "MULTIRESPONSE" if interaction.many else "MULTICHOICE_V"
    answers = weighted_answers(interaction, lang)
    rows = [(_escape_cloze(with_letter(one)), one.percent, one.feedback) for one in answers]
    return Markup("<div>{}</div>").format(_cloze_field(weight, kind, rows))


@_embed_interaction.register
def _embed_true_false(interaction: TrueFalseInteraction, weight: int, lang: str) -> Markup:
    """Return the two options of a statement."""
    rows = _list_truths(interaction, lang)
    return Markup("<div>{}</div>").format(_cloze_field(weight, "MULTICHOICE_H", rows))


def _list_truths(interaction: TrueFalseInteraction, lang: str) -> list[tuple[str, float, Markup]]:
    """Return true and false with the percentage of each, and the feedback to the wrong one."""
    feedback = to_course_html(interaction.feedback, lang)
    return [
        (
            _escape_cloze(translate(lang, f"ask.{name}")),
            100 * right,
            Markup("") if right else feedback,
        )
        for name, right in (("true", interaction.true), ("false", not interaction.true))
    ]


@_embed_interaction.register(MatchInteraction)
@_embed_interaction.register(OrderInteraction)
def _embed_match(
    interaction: MatchInteraction | OrderInteraction, weight: int, lang: str
) -> Markup:
    """Return a drop-down of the targets' letters for each stem, since it can hold no formulas."""
    pairs = order_as_match(interaction, lang)
    targets = [
        _escape_braces(option_html(letter, words, lang))
        for letter, words in pairs.targets
        if words != (PlainText(letter),)
    ]
    stems = [
        _escape_braces(option_html(letter, words, lang))
        + " "
        + _match_field(pairs, letter, weight, lang)
        for letter, words in pairs.stems
    ]
    paragraphs = [Markup("<br>").join(lines) for lines in (targets, stems) if lines]
    return Markup("").join(Markup("<p>{}</p>").format(lines) for lines in paragraphs)


def _match_field(pairs: MatchInteraction, stem: str, weight: int, lang: str) -> Markup:
    """Return the drop-down of one stem, with feedback by target.

    If the feedback is the same for all targets, it stands in the worked solution instead.
    """
    feedback = {letter: pairs.feedback.get((stem, letter), ()) for letter, _ in pairs.targets}
    right = pairs.right[stem]
    is_same = len({words for letter, words in feedback.items() if letter != right}) == 1
    rows = [
        (letter, 100 * (letter == right), to_course_html(() if is_same else words, lang))
        for letter, words in feedback.items()
    ]
    return _cloze_field(weight, "MULTICHOICE", rows)


def _cloze_field(weight: int, kind: str, rows: Iterable[tuple[str, float, Markup]]) -> Markup:
    """Return a cloze field such as ``{2:NUMERICAL:=3.5:0.1~%0%7:0.2#Halved twice.}``.

    ``rows`` are answer, percentage of the marks and feedback.
    """
    texts = [
        f"%{percent:.9g}%{typed}" + (f"#{_escape_cloze(str(feedback))}" if feedback else "")
        for typed, percent, feedback in rows
    ]
    return Markup(f"{{{weight}:{kind}:{'~'.join(texts)}}}")  # noqa: S704 - rows are escaped


_SIGNS = {ord("&"): "&amp;"} | {ord(sign): f"&#{ord(sign)};" for sign in "~#{}=%"}


def _escape_cloze(text: str) -> str:
    """Return a text with the signs of the cloze grammar as entities, which are read once."""
    return text.translate(_SIGNS)
