"""Finding a question: by a word of it, a topic, a formula or an item of the notes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.bank import Bank
from quizgen.bank.formulas import read_formulas
from quizgen.question.entry_prose import entry_inlines
from quizgen.question.solution import inlines_to_plain
from quizgen.web.state import ServerState
from quizgen.web.tonight import readable_templates, template_title
from quizgen.web.views import page_response, request_language

LONGEST = 200
"""Letters of a search that are read."""


_SECTION = re.compile(r"§?\s*([0-9]{1,2}(?:\.[0-9]{1,2})?)")


@dataclass(frozen=True)
class FoundQuestion:
    """A question that may be practised.

    Parameters
    ----------
    template, title, topic : str
    place : str
        ``exam``, ``notes`` or ``beyond``: where it stands.
    section : str
        Of the notes; empty if it is in none.
    minutes : int
    head, text : str
        Title, topic, formulas and items, and all that its file says; both folded for the search.
    """

    template: str
    title: str
    topic: str
    place: str
    section: str
    minutes: int
    head: str
    text: str


async def find_questions(request: Request) -> Response:
    """Return the page of questions that a search finds; all of them by topic without one."""
    site: ServerState = request.app.state.site
    lang, asked = request_language(request), request.query_params.get("q", "")[:LONGEST]
    names = readable_templates(request)
    every = await run_in_threadpool(list_questions, site.bank, names, lang)
    found = search_questions(every, asked)
    inside = [one for one in found if one.place != "beyond"]
    sections = [
        (f"§{row.section} {site.bank.section_title(row.section, lang)}",
         [one for one in inside if one.section == row.section])
        for row in site.bank.curriculum.notes
    ]  # fmt: skip
    topics = [
        (site.bank.topic_title(topic, lang),
         [one for one in inside if one.topic == topic and not one.section])
        for topic in site.bank.topics
    ]  # fmt: skip
    return page_response(
        request,
        "questions.html.j2",
        asked=asked,
        count=len(found),
        topics=[row for row in sections + topics if row[1]],
        beyond=[one for one in found if one.place == "beyond"],
        kept={"q": asked} if asked else {},
    )


@lru_cache(maxsize=2)
def list_places(bank: Bank) -> dict[str, str]:
    """Return where each template stands: ``exam``, ``notes`` or ``beyond``."""
    from quizgen.practice.ability import read_practice_items  # NumPy, only where it is asked
    from quizgen.practice.exam_plan import read_exam_goal

    exam = read_exam_goal(bank).templates
    return {
        item.name: "exam" if item.name in exam else "beyond" if item.beyond else "notes"
        for item in read_practice_items(bank)
    }


@lru_cache(maxsize=8)
def list_questions(bank: Bank, names: tuple[str, ...], lang: str) -> tuple[FoundQuestion, ...]:
    """Return the questions of some templates, with what a search looks at."""
    from quizgen.practice.ability import read_practice_items  # NumPy, only where it is asked

    places = list_places(bank)
    titles = {
        entry.id: inlines_to_plain(entry_inlines(entry, "title", lang))
        for entry in read_formulas(bank)
    }
    return tuple(
        _list_question(
            bank, item.name, lang,
            place=places[item.name],
            minutes=round(item.minutes),
            formulas=[titles.get(formula, "") for formula in item.formulas],
        )
        for item in read_practice_items(bank)
        if item.name in names
    )  # fmt: skip


def _list_question(
    bank: Bank, name: str, lang: str, *, place: str, minutes: int, formulas: list[str]
) -> FoundQuestion:
    """Return one question with what a search looks at."""
    rules, title = bank.rules(name), template_title(bank, name, lang)
    section = bank.notes_section(name)
    words = (title, bank.topic_title(rules.topic, lang), name, *rules.covers, *formulas)
    words += (f"§{section}", bank.section_title(section, lang)) if section else ()
    written = bank.template_paths[name] / f"{lang}.md"
    text = written.read_text("utf-8") if written.is_file() else ""
    head = " ".join(words).casefold()
    return FoundQuestion(
        name, title, rules.topic, place, section, minutes, head, f"{head} {text}".casefold()
    )


def search_questions(questions: tuple[FoundQuestion, ...], asked: str) -> list[FoundQuestion]:
    """Return the questions that hold every word of a search.

    Those that have all words in title, topic or formulas come alone, if there are any: a word like
    ``lens`` stands in half of all texts. The number of a section of the notes finds what is in it.
    """
    number = _SECTION.fullmatch(asked.strip())
    if number and (of := [one for one in questions if _is_in(one.section, number[1])]):
        return of
    words = asked.casefold().split()
    inside = [one for one in questions if all(word in one.head for word in words)]
    return inside or [one for one in questions if all(word in one.text for word in words)]


def _is_in(section: str, number: str) -> bool:
    """Return whether a section is the one of a number, or in it: 4.5 is in 4."""
    return section == number or section.startswith(f"{number}.")


ROUTES = [Route("/questions", find_questions)]
