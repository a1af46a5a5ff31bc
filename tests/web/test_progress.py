"""Progress in the browser: what a finished question changes, and what comes next."""

from __future__ import annotations

import html
import re
import time
import tomllib
from datetime import UTC, datetime, timedelta

import pytest

from quizgen.question.compose import compose_question
from quizgen.store import OutcomeRecord

QUESTION = "point-to-image-plane"

pytestmark = [pytest.mark.both_databases, pytest.mark.usefixtures("nothing_done")]


def text(page: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]*>", " ", page).split()))


def cards(app):
    store = app.state.site.store
    return store.cards.all(store.learner().id)


@pytest.fixture
def answers(bank):
    _, key = compose_question(bank.template(QUESTION), "3", "en")
    return key.solution.parts[0].answer.strip("()").split("; ")


@pytest.fixture
def topic(bank):
    """How many templates stand in the topic of the question."""
    return sum(bank.rules(name).topic == bank.rules(QUESTION).topic for name in bank.template_paths)


def test_nothing_yet(client, topic):
    page = client.get("/progress")
    assert page.status_code == 200
    assert "No mistake with a name has been made yet." in page.text
    assert f"0/{topic}" in text(page.text)
    assert "never" in text(page.text)
    assert "after five you see your points" in text(client.get("/").text)


def formulas(page: str) -> tuple[list[str], list[str]]:
    """Formulas in the table, and those that are folded away."""
    shown = page.partition('<h2 id="formulas">')[2]
    table, _, folded = shown.partition("<details>")
    return tuple(re.findall(r'href="/formulas#(F\d\d)"', one) for one in (table, folded))


def test_formulas_that_were_not_asked_are_folded_away(client, token, begin, answers):
    page = client.get("/progress").text
    seen, folded = formulas(page)
    assert (seen, len(folded)) == ([], 46)
    assert "Not seen yet: 46" in text(page)
    client.post(f"{begin(QUESTION)}/1", data={"token": token, "a": answers})
    after = client.get("/progress").text
    seen, rest = formulas(after)
    assert seen
    assert sorted(seen + rest) == sorted(folded)
    assert f"Not seen yet: {len(rest)}" in text(after)


def test_a_right_answer_at_once_is_good(client, token, begin, app, answers):
    client.post(f"{begin(QUESTION)}/1", data={"token": token, "a": answers})
    card = cards(app)["template", "A3"]
    assert card.stability == 2.3065
    assert card.due - card.last == pytest.approx(600, abs=1e-3)


def test_a_later_try_is_hard(client, token, begin, app, answers):
    at = begin(QUESTION)
    client.post(f"{at}/1", data={"token": token, "a": ["123", "456"]})
    assert cards(app) == {}, "not before the question is finished"
    client.post(f"{at}/1", data={"token": token, "a": answers})
    assert cards(app)["template", "A3"].stability == 1.2931


def test_a_mistake_is_remembered_and_named_in_both_languages(
    client, token, begin, app, answers, topic
):
    at = begin(QUESTION)
    client.post(f"{at}/1", data={"token": token, "a": answers[::-1]})
    client.post(f"{at}/1", data={"token": token, "do": "solution", "a": ["", ""]})
    found = cards(app)
    assert found["template", "A3"].stability == 0.212
    mistakes = [name for kind, name in found if kind == "mistake"]
    assert len(mistakes) <= 1
    page = client.get("/progress").text
    assert f"1/{topic}" in text(page)
    client.post("/settings", data={"token": token, "lang": "bn", "back": "/"})
    bangla = client.get("/progress").text
    assert "অগ্রগতি" in bangla
    assert "{" not in text(bangla)


def test_a_trap_gets_a_row_of_its_own_and_a_way_to_practise_it(client, token, begin, app, bank):
    _, key = compose_question(bank.template(QUESTION), "3", "en")
    trap = key.solution.parts[0].mistakes[0]
    at = begin(QUESTION)
    client.post(f"{at}/1", data={"token": token, "a": trap.value.strip("()").split("; ")})
    client.post(f"{at}/1", data={"token": token, "do": "solution", "a": ["", ""]})
    assert ("mistake", f"A3/trap:{trap.name}") in cards(app)
    page = client.get("/progress").text
    row = re.search(r'<h2 id="mistakes">.*?<tbody>(.*?)</tbody>', page, re.DOTALL)[1]
    assert f'name="template" value="{QUESTION}"' in row
    asked = client.post("/practice", data={"token": token, "template": QUESTION})
    assert asked.url.path.startswith("/q/")


def test_the_same_numbers_again_and_steps_do_not_count_as_known(client, token, begin, app, answers):
    at = begin(QUESTION)
    client.post(f"{at}/1", data={"token": token, "do": "solution", "a": ["", ""]})
    before = cards(app)
    client.post(f"{begin(QUESTION)}/1", data={"token": token, "a": answers})
    assert cards(app) == before


def test_the_next_questions_are_those_of_the_trial_exam(client, token, app, bank):
    store = app.state.site.store
    learner = store.learner().id
    client.post("/practice", data={"token": token})
    slots = tomllib.loads(bank.blueprints["trial"].read_text("utf-8"))["slot"]
    asked = set()
    for _ in slots:
        latest = store.latest(learner, 1)[0]
        asked.add(next(slot["points"] for slot in slots if latest.template in slot["templates"]))
        row = OutcomeRecord(latest.template, "any", "a", "", right=False, first=False,
                            at=time.time(), credit=0.0, helped=False, attempt=latest.id)  # fmt: skip
        latest.ended = time.time()
        store.save_attempt(latest, (row,))
        client.post(f"/q/{latest.id}/next", data={"token": token})
    assert asked == {slot["points"] for slot in slots}, "each question of it once"
    home = text(client.get("/").text)
    assert re.search(r"\d(\.5)?–\d(\.5)? of 10 points", home), "a range from five on"
    assert "5 questions to a first estimate" in home, "but no number before ten"


def test_the_minutes_of_tonight(client, token):
    counts = {}
    for minutes in ("15", "90"):
        page = client.post("/tonight", data={"token": token, "minutes": minutes}).text
        told = re.search(r"Go on: (\d+) min, (\d+) questions", text(page))
        assert int(told[1]) <= int(minutes)
        counts[minutes] = int(told[2])
        assert re.search(rf'value="{minutes}" aria-pressed="true"', page)
    assert counts["15"] < counts["90"]
    client.post("/tonight", data={"token": token, "minutes": "7"})
    assert 'value="90" aria-pressed="true"' in client.get("/").text, "only what is offered"


def test_a_question_of_the_exam_is_begun_from_its_card(client, token, app, bank):
    page = client.post("/tonight", data={"token": token, "minutes": "25"}).text
    names = re.findall(r'<button name="template" value="([^"]+)"', page)
    slots = tomllib.loads(bank.blueprints["trial"].read_text("utf-8"))["slot"]
    assert len(names) == len(slots)
    assert all(name in slot["templates"] for name, slot in zip(names, slots, strict=True))
    asked = client.post("/practice", data={"token": token, "template": names[2]})
    assert asked.url.path.startswith("/q/")


def test_the_day_of_the_exam(client, token, app, begin, answers):
    day = (datetime.now(UTC).astimezone() + timedelta(days=12)).date()
    page = client.post("/progress/exam", data={"token": token, "exam": day.isoformat()})
    assert f'value="{day.isoformat()}"' in client.get("/progress").text
    assert "12 days until the exam" in text(page.text)
    wrong = client.post("/progress/exam", data={"token": token, "exam": "soon"})
    assert wrong.status_code == 400
    assert "This is not a date." in wrong.text
    client.post("/progress/exam", data={"token": token, "exam": ""})
    assert "until the exam" not in client.get("/").text


def test_a_forged_form_changes_nothing(client):
    assert client.post("/progress/exam", data={"exam": "2027-02-12"}).status_code == 403
    assert "2027" not in client.get("/progress").text


def test_an_exam_counts_too(client, token, app):
    at = client.post(
        "/exam", data={"token": token, "blueprint": "projection", "minutes": "15"}
    ).url.path
    page = client.get(at).text
    on = dict.fromkeys(re.findall(r'name="(on-[^"]+)"', page), "1")
    client.post(at, data={"token": token, "do": "hand-in", **on})
    found = cards(app)
    assert found
    assert {card.stability for card in found.values()} == {0.212}
