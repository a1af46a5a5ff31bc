"""Every template, read as a person does: no programmer's numbers, names or hyphens are left."""

from __future__ import annotations

import html
import re

import pytest
from sweep import spread, together

from quizgen.bank.bank import builtin_bank
from quizgen.kinds.grade import grade_answer
from quizgen.question.compose import compose_question
from quizgen.question.html import blocks_to_html, inlines_to_html
from quizgen.render.text import inlines_to_plain_text
from quizgen.typeset.prose import InlineCode

LANGS = ("en", "bn")
SEEDS = (1, 2)

POWER = re.compile(r"\d[eE][-+]?\d")
HYPHEN = re.compile(r"(?<![\w)\]}-])-\s?\d")
RUN = re.compile(r"(?<![\d.])\d{5,}")
NAME = re.compile(r"[^\W\d_]+['′]*_\w+")
STAR = re.compile(r"[\w)]\*[\w(]|\^\d+(?![.\d])")
FRACTION = re.compile(r"(?<![\d./·])(\d+)/(\d+)(?![\d./])(?:[^\S\n]*[^\d\s≈=;,]*)([^\S\n]*≈)?")
TAGS = re.compile(r"<[^>]+>")
UNTYPESET = (POWER, HYPHEN, RUN, STAR, NAME)
WITHOUT_LETTER = re.compile(r"_[^₀-₉]*[b-dfgqwyzA-Z\u0370-\u03ff]")
"""A subscript for which Unicode has no letter may keep its underscore, in plain text only."""


def words_of(page: str) -> str:
    """Text of a piece of HTML outside formulas and programs."""
    bare = re.sub(r"<(math|code|pre)\b.*?</\1>", " ", page, flags=re.DOTALL)
    return html.unescape(TAGS.sub(" ", bare))


def sentences(question, key):
    """Runs of inlines that a question and its solution consist of."""
    for part in question.parts:
        yield part.field.hint
        yield from (text for _, text in (*part.field.options, *part.field.targets))
    for part in key.solution.parts:
        yield part.shown
        yield from (line.why for line in part.lines)
        yield from part.options
        for mistake in part.mistakes:
            yield from (mistake.shown, mistake.sentence)


def sections(question, key):
    """Blocks that a question and its solution consist of."""
    solution = key.solution
    yield from (question.stem, *(part.body for part in question.parts))
    yield from (solution.why, solution.check, solution.note, solution.precision)


def strange(text: str, patterns=UNTYPESET) -> list[str]:
    """What nobody writes by hand, with its surroundings."""
    return [
        text[max(0, found.start() - 20) : found.end() + 10]
        for pattern in patterns
        for found in pattern.finditer(text)
        if pattern is not NAME or not WITHOUT_LETTER.search(found[0])
    ]


def unreadable(text: str) -> list[str]:
    """Fractions of long numbers without their decimal value."""
    return [
        found[0]
        for found in FRACTION.finditer(text)
        if max(len(found[1]), len(found[2])) >= 3 and found[1] != "1" and not found[3]
    ]


@together("lang", LANGS)
@together("name", spread(builtin_bank().template_paths, 12, slow=60))
def test_a_page_is_written_for_people(name, lang):
    for seed in SEEDS:
        question, key = compose_question(builtin_bank().template(name), seed, lang, figures=False)
        shown = [str(inlines_to_html(run, lang)) for run in sentences(question, key)]
        shown += [str(blocks_to_html(part, lang)) for part in sections(question, key)]
        for text in map(words_of, shown):
            assert strange(text) + unreadable(text) == []
            assert NAME.findall(text) == []


@together("lang", LANGS)
@together("name", spread(builtin_bank().template_paths, 12, slow=60))
def test_a_terminal_is_written_for_people(name, lang):
    template = builtin_bank().template(name)
    for seed in SEEDS:
        question, key = compose_question(template, seed, lang, figures=False)
        runs = [without_code(run) for run in sentences(question, key)]
        worked = [
            inlines_to_plain_text(line.maths) for part in key.solution.parts for line in part.lines
        ]
        for text in (*map(inlines_to_plain_text, runs), *worked):
            assert strange(text) == []


def without_code(run):
    return tuple(part for part in run if not isinstance(part, InlineCode))


@together("lang", LANGS)
@together("name", spread(builtin_bank().template_paths, 12, slow=60))
def test_what_is_said_of_mistakes_is_written_for_people(name, lang):
    """Each mistake of a question typed back: what was read, and what is said."""
    _, key = compose_question(builtin_bank().template(name), 1, lang, figures=False)
    for spec, part in zip(key.specs, key.solution.parts, strict=True):
        if spec.kind != "code":
            for mistake in part.mistakes:
                verdict = grade_answer(spec, mistake.value, lang=lang)
                assert strange(verdict.read_as) + strange(verdict.message) == []


@pytest.mark.parametrize("lang", LANGS)
def test_the_example_of_how_to_type_a_formula_answers_no_question(lang):
    for name in builtin_bank().template_paths:
        if any(part.answer["kind"] == "expression" for part in builtin_bank().rules(name).part):
            question, key = compose_question(builtin_bank().template(name), 1, lang, figures=False)
            for spec, part in zip(key.specs, question.parts, strict=True):
                typed = [one.text for one in part.field.hint if isinstance(one, InlineCode)]
                assert not any(grade_answer(spec, text).credit for text in typed)
                if spec.kind == "expression":  # nor is it one with its letters changed
                    assert typed == ["(a+b)^2/2"]
