"""The lines of a manifest; apart from its reader, which grading needs alone."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable

import msgspec

from quizgen.lms.interactions import (
    ChoiceInteraction,
    FeedbackText,
    Interaction,
    MatchInteraction,
    NumericInteraction,
    OrderInteraction,
    order_as_match,
)
from quizgen.lms.items import CourseQuestion, ExportItem
from quizgen.lms.manifest import ManifestItem, ManifestQuestion, ResponseField, ResponseShape
from quizgen.lms.markup import target_texts, to_course_html
from quizgen.question.compose import QuestionPart
from quizgen.render.text import inlines_to_plain_text

_HTML_TAG = re.compile(r"<[^>]*>")


def manifest_entry(item: ExportItem, questions: Iterable[ManifestQuestion]) -> ManifestItem:
    """Return the line of an item, with the questions that it became."""
    question = msgspec.Raw(msgspec.json.encode(item.key_question))
    kinds = {part.id: part.spec["kind"] for part in item.key_question.parts}
    shapes = {
        part.field.id: _response_shape(part, matrix=kinds[part.field.id] == "matrix")
        for part in item.question.parts
    }
    return ManifestItem(item.id, item.slot, item.lang, question, shapes, list(questions))


def _response_shape(part: QuestionPart, *, matrix: bool) -> ResponseShape:
    """Return how a part is answered in one line."""
    control = part.field.control
    rows = control.lines if matrix else 0
    names = [box.name for box in control.boxes]
    return ResponseShape(control.form, names, control.named, rows)


def manifest_question(question: CourseQuestion, *, embedded: bool = False) -> ManifestQuestion:
    """Return how the responses to a question of a system are read back."""
    lang = question.item.lang
    fields = [
        response_field(interaction, part, lang)
        for part, interactions in question.parts
        for interaction in interactions
    ]
    token = question.item.token(question.suffix)
    return ManifestQuestion(token, question.id, fields, embedded)


def response_field(
    interaction: Interaction, part: QuestionPart, lang: str, name: str = ""
) -> ResponseField:
    """Return how the response to an interaction is read back; ``name`` is the system's variable."""
    unit = ""
    rows: Iterable[tuple[str, FeedbackText]] = ()
    targets: dict[str, list[str]] = {}
    match interaction:
        case NumericInteraction():
            unit = "" if interaction.unit == "1" else interaction.unit
        case ChoiceInteraction():
            rows = ((option.letter, option.words) for option in interaction.options)
        case MatchInteraction() | OrderInteraction():
            pairs = order_as_match(interaction, lang)
            rows = pairs.stems
            targets = {letter: [text] for letter, text in target_texts(pairs).items()}
    options = {letter: _option_texts(words, lang) for letter, words in rows}
    return ResponseField(interaction.kind, part.field.id, unit, options, targets, name)


def _option_texts(words: FeedbackText, lang: str) -> list[str]:
    """Return an option as systems export it (HTML without tags), and in our own plain text."""
    page = html.unescape(_HTML_TAG.sub("", str(to_course_html(words, lang))))
    return list(dict.fromkeys((page, inlines_to_plain_text(words))))
