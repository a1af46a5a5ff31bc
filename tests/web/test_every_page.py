"""Every template in the browser: its printed answer, put into the fields of its page, is right.

Over the addresses of the application; only the worker processes are left out, and the pictures.
The slow sweep has each level in turn in either language: the key is the same in both.
"""

from __future__ import annotations

import re
from functools import cache

import pytest
from sweep import draws, spread
from typed import Fields, typed

from quizgen.bank.bank import builtin_bank
from quizgen.bank.levels import EXAM, GUIDED
from quizgen.question.compose import compose_variant, draw_instance
from quizgen.question.levels import effective_level
from quizgen.store import QuestionRef
from quizgen.web.question_view import question_view

NAMES = sorted(builtin_bank().template_paths)


@cache
def numbers(template: str, seed: str):
    return draw_instance(builtin_bank().template(template), seed)


@pytest.fixture(scope="module")
def at_once(app):
    """Questions made here, without pictures; what was made, by what was wanted."""
    kept, workers = {}, app.state.site.workers

    async def question(wanted, _asker=None):
        if wanted not in kept:
            drawn = numbers(wanted.template, wanted.seed)
            pair = compose_variant(drawn, wanted.lang, level=wanted.level, figures=False)
            kept.clear()
            kept[wanted] = (*pair, question_view(wanted, *pair))
        return kept[wanted][2]

    before, workers.get_question = workers.get_question, question
    yield kept
    workers.get_question = before


def every_part(client, at: str, names) -> str:
    """The pages of all parts, one after the other."""
    return "".join(client.get(at, params={"part": name}).text for name in names)


def takes(forms, name: str, values: list[str]) -> bool:
    """Whether the form of a part takes an answer; parts in one text share a form, each by its name."""
    if name in forms and Fields(forms[name]).take("a", values):
        return True
    return any(Fields(form).take(f"a-{name}", values) for form in forms.values())


def wrong_parts(page: str, answered: str, answers, sentences) -> list[str]:
    """Parts that take their printed answers amiss, and how."""
    part = r'<section class="part[^"]*" id="part-(\w+)"'
    forms = dict(re.findall(part + "(.*?)</section>", page, re.DOTALL))
    verdicts = re.findall(r'<div class="verdict (\w+)" id="verdict-(\w+)"', answered)
    said = {name: verdict for verdict, name in verdicts}
    found = [
        f"{name}: the fields do not take {values}"
        for name, values in answers.items()
        if not takes(forms, name, values)
    ]
    right = {name for name, verdict in said.items() if verdict == "correct"}
    return found + [f"{name}: {said.get(name)}" for name in answers.keys() - right - sentences]


@pytest.fixture
def wrong(client, token, app, at_once):
    """What goes wrong in a question: parts that take their printed answers amiss."""
    store = app.state.site.store
    learner = store.learner().id

    def asked(template: str, seed: str, lang: str, level: str) -> list[str]:
        store.update_settings(learner, {"lang": lang})
        at = f"/q/{store.start_attempt(learner, QuestionRef(template, seed, level), {}).id}"
        client.get(at)
        ((question, key, _),) = at_once.values()
        answers = typed(question, key)
        page = every_part(client, at, answers)
        shared = {f"a-{part}": values for part, values in answers.items()}
        for part, values in answers.items():
            sent = {**shared, "token": token, "do": "answer", "a": values}
            client.post(f"{at}/{part}", data=sent, follow_redirects=False)
        parts = zip(question.parts, key.specs, strict=True)
        sentences = {part.field.id for part, spec in parts if spec.kind == "rubric"}
        found = wrong_parts(page, every_part(client, at, answers), answers, sentences)
        code = "def " in page  # in which None may be said
        found += ["None is shown"] if ">None<" in page and not code else []
        store.update_settings(learner, {"lang": "en"})
        return [f"{template} {seed} {lang} {level} {one}" for one in found]

    return asked


def levels(template: str, seed: str) -> list[str]:
    drawn = numbers(template, seed)
    return [level for level in (EXAM, GUIDED) if effective_level(drawn, level) == level]


@pytest.mark.parametrize("template", spread(NAMES[::8], 11))
def test_the_printed_answer_is_right(wrong, template):
    place = NAMES.index(template)
    asked = levels(template, str(place))
    lang, level = ("en", "bn")[place % 2], asked[place // 2 % len(asked)]
    assert wrong(template, str(place), lang, level) == []


@pytest.mark.parametrize("template", spread(NAMES, 0, slow=40))
def test_printed_answers_of_more_draws_are_right(wrong, template):
    for place in range(draws(1, full=20)):
        seed = str(place)
        for turn, level in enumerate(levels(template, seed), place):
            assert wrong(template, seed, ("en", "bn")[turn % 2], level) == []
