"""Sitting an exam over its addresses."""

from __future__ import annotations

import html
import json
import re
import time
from types import SimpleNamespace

import pytest
from sqlalchemy import update
from typed import typed as typed_in

from quizgen.bank.bank import builtin_bank
from quizgen.locale import BOTH
from quizgen.paper.answer_key import make_answer_key
from quizgen.paper.blueprint import find_blueprint
from quizgen.paper.paper import build_paper, rebuild_paper
from quizgen.store import OutcomeRecord
from quizgen.store.schema import SITTING

pytestmark = pytest.mark.both_databases


def shown(page: str) -> str:
    return html.unescape(" ".join(re.sub(r"<[^>]*>", " ", page).split()))


@pytest.fixture(scope="module")
def paper_of():
    made = {}

    def of(page: str):
        code = re.search(r"<code>([\w.-]+-both-[0-9a-f]{6})</code>", page)[1]
        return made.setdefault(code, rebuild_paper(builtin_bank(), code, figures=False))

    return of


@pytest.fixture(scope="module")
def code(bank):
    """A paper that is the same on every day."""
    return build_paper(bank, find_blueprint("trial", bank), 7, BOTH, figures=False).code


@pytest.fixture
def exam(client, token, code, nothing_done):
    """A short exam that has begun: its address and page."""

    def begun(**how: str):
        sent = {"token": token, "code": code, "clock": "1", **how}
        page = client.post("/exam", data=sent)
        assert page.status_code == 200, page.text
        return page.url.path, page.text

    return begun


def typed(paper) -> dict[str, list[str]]:
    """The printed answers of all its questions."""
    found = {}
    for item in paper.items:
        found |= typed_in(item.questions[0], item.keys[0])
    return found


def body(token, answers, **more):
    sent = {"token": token, **more}
    for part, values in answers.items():
        sent[f"on-{part}"] = "1"
        sent[f"a-{part}"] = values
    return sent


def test_printed_answers_give_all_points_that_a_machine_gives(client, token, exam, paper_of):
    at, page = exam()
    paper = paper_of(page)
    done = client.post(at, data=body(token, typed(paper), do="hand-in"))
    key = make_answer_key(paper)
    sentences = {p.id for q in key.questions for p in q.parts if p.spec["kind"] == "rubric"}
    wrong = re.findall(
        r'id="part-(\w+)">(?:(?!id="part-).)*?<div class="verdict (?!correct)(\w+)"',
        done.text,
        re.DOTALL,
    )
    assert {part for part, _ in wrong} == sentences
    assert "of 10 points" in shown(done.text)


def test_what_was_saved_is_there_after_a_reload_and_in_another_language(
    client, token, exam, paper_of
):
    at, page = exam()
    answers = typed(paper_of(page))
    part = next(name for name, values in answers.items() if len(values) > 1)
    kept = client.post(
        at, data=body(token, {part: answers[part]}), headers={"accept": "application/json"}
    )
    assert kept.json()["kept"] is True
    read_before, read_after = (
        float(re.search(r'data-read="([\d.]+)"', text)[1]) for text in (page, client.get(at).text)
    )
    assert read_before < kept.json()["at"] < read_after
    for lang in ("bn", "en"):
        client.post("/settings", data={"token": token, "lang": lang, "back": at})
        again = client.get(at).text
        for value in answers[part]:
            assert f'value="{html.escape(value)}"' in again or f"selected>{value}<" in again


def test_parts_that_are_not_sent_keep_what_they_have(client, token, exam, paper_of):
    at, page = exam()
    (first, second) = list(typed(paper_of(page)).items())[:2]
    client.post(at, data=body(token, dict([first])))
    client.post(at, data=body(token, dict([second])))
    client.post(at, data=body(token, {second[0]: []}))
    done = shown(client.post(at, data={"token": token, "do": "hand-in"}).text)
    assert "Right." in done


def test_a_form_changes_only_what_differs_from_its_page(client, token, exam, paper_of):
    at, page = exam()
    part, values = next(
        (name, values) for name, values in typed(paper_of(page)).items() if len(values) > 1
    )
    client.post(at, data=body(token, {part: values}))
    stale = {"token": token, f"on-{part}": "[]", f"a-{part}": ["" for _ in values]}
    client.post(at, data=stale)
    shown_now = html.unescape(
        re.search(f'name="on-{part}" value="([^"]*)"', client.get(at).text)[1]
    )
    assert json.loads(shown_now) == values
    client.post(at, data={**stale, f"on-{part}": shown_now})
    assert f'name="on-{part}" value="[&#34;&#34;' in client.get(at).text, "emptied on purpose"


def test_no_solution_before_it_is_handed_in_and_no_change_after(client, token, exam, paper_of, app):
    at, page = exam()
    assert 'class="result"' not in page
    assert "verdict" not in page
    answers = typed(paper_of(page))
    client.post(at, data={"token": token, "do": "hand-in"})
    late = client.post(at, data=body(token, answers), headers={"accept": "application/json"})
    assert (late.status_code, late.json()["kept"]) == (409, False)
    assert "0 of 10 points" in shown(client.get(at).text)


def test_the_clock_is_the_servers(client, token, exam, app):
    at, _ = exam()
    name = at.rsplit("/", 1)[1]
    with app.state.site.store.database.writing() as connection:
        connection.execute(
            update(SITTING).where(SITTING.c.id == name).values(begun=time.time() - 86400)
        )
    late = client.post(at, data=body(token, {"1": ["1"]}), headers={"accept": "application/json"})
    assert late.status_code == 409
    assert "Results" in client.get(at).text


@pytest.mark.parametrize(("seconds", "kept"), [(0.1, True), (4.9, True), (5.1, False)])
def test_what_was_on_its_way_when_the_time_ended_arrives_for_five_seconds(
    client, exam, app, monkeypatch, seconds, kept
):
    at, _ = exam()
    part = re.findall(r'data-part="(\w+)"', client.get(at).text)[0]
    store, name = app.state.site.store, at.rsplit("/", 1)[1]
    learner = store.learner().id
    sitting = store.sittings.find(learner, name)
    clock = SimpleNamespace(now=lambda: sitting.ends + seconds)
    monkeypatch.setattr(store.sittings, "clock", clock)
    assert store.sittings.save(learner, name, {part: ["12"]}) == (sitting, kept)
    assert store.sittings.answers(sitting) == ({part: ["12"]} if kept else {})


def test_a_pause_stops_the_clock_where_it_is_allowed(client, token, exam, app):
    at, _ = exam(pauses="1")
    store, learner = app.state.site.store.sittings, app.state.site.store.learner().id
    name = at.rsplit("/", 1)[1]
    assert "The exam rests" in client.post(at, data={"token": token, "do": "rest"}).text
    assert store.find(learner, name).ends is None
    refused = client.post(
        at, data=body(token, {"1": ["1"]}), headers={"accept": "application/json"}
    )
    assert refused.status_code == 409
    assert "The exam rests" not in client.post(at, data={"token": token, "do": "go-on"}).text
    assert store.find(learner, name).rested > 0
    client.post(at, data={"token": token, "do": "hand-in"})
    strict, _ = exam(practice="1")
    assert "The exam rests" not in client.post(strict, data={"token": token, "do": "rest"}).text


def test_a_flag_comes_and_goes(client, token, exam):
    at, _ = exam()
    assert 'class="flagged"' in client.post(f"{at}/flag/2", data={"token": token}).text
    assert 'class="flagged"' not in client.post(f"{at}/flag/2", data={"token": token}).text
    assert client.post(f"{at}/flag/77", data={"token": token}).status_code == 404


@pytest.mark.parametrize(
    ("sent", "said"),
    [
        ({"code": "mock-1-both-ffffff"}, "not the code of a paper"),
        ({"code": "../../etc/passwd"}, "not the code of a paper"),
        ({"blueprint": "pyproject.toml"}, "cannot be made"),
        ({"blueprint": "optics", "minutes": "1"}, "cannot be made"),
    ],
)
def test_a_paper_that_cannot_be_made_is_said(client, token, sent, said):
    assert said in client.post("/exam", data={"token": token, **sent}).text


def listed(page: str, heading: str) -> str:
    """What stands in the list below a heading."""
    return shown(re.search(f"<h2>{heading}</h2>(.*?)</ul>", page, re.DOTALL)[1])


def test_before_it_is_handed_in_what_is_missing_is_named(client, token, exam, paper_of, app):
    at, page = exam()
    printed = typed(paper_of(page)).items()
    answers = {name: values if any(values) else ["a sentence"] for name, values in printed}
    half = next(name for name, values in answers.items() if len(values) > 1)
    whole = [name for name in answers if name != half]
    client.post(at, data=body(token, {name: answers[name] for name in whole}))
    client.post(at, data=body(token, {half: [answers[half][0], *("" for _ in answers[half][1:])]}))
    client.post(f"{at}/flag/2", data={"token": token})
    asked = client.post(at, data={"token": token, "do": "end"})
    assert asked.url.path == f"{at}/hand-in"
    assert listed(asked.text, "Not answered, or not all of it").startswith(half[0])
    assert f'href="{at}#part-{half}"' in asked.text
    assert re.findall(f'href="{at}#part-([^"]*)"', asked.text) == [half]
    assert listed(asked.text, "To come back to").startswith("2.")
    store = app.state.site.store
    name = at.rsplit("/", 1)[1]
    assert store.sittings.find(store.learner().id, name).handed is None
    client.post(at, data=body(token, {half: answers[half]}))
    client.post(f"{at}/flag/2", data={"token": token})
    assert "Every question is answered." in client.get(f"{at}/hand-in").text
    done = client.post(at, data={"token": token, "do": "hand-in"})
    assert "Results" in done.text
    assert client.get(f"{at}/hand-in").url.path == at, "nothing is asked any more"


def test_half_filled_fields_are_shown_as_fields(client, token, exam, paper_of):
    at, page = exam()
    answers = typed(paper_of(page))
    half = next(name for name, values in answers.items() if len(values) == 2)
    client.post(at, data=body(token, {half: ["9.75", ""]}))
    done = client.post(at, data={"token": token, "do": "hand-in"}).text
    part = shown(re.search(f'id="part-{half}">(.*?)<ol class="steps">', done, re.DOTALL)[1])
    assert "Your answer: p ′ x = 9.75 ; p ′ y = –" in part
    assert "Fill in every field." in part
    assert "9.75; " not in part


def test_results_say_when_the_time_was_over(client, token, exam, app):
    at, _ = exam()
    name = at.rsplit("/", 1)[1]
    with app.state.site.store.database.writing() as connection:
        connection.execute(
            update(SITTING).where(SITTING.c.id == name).values(begun=time.time() - 86400)
        )
    assert "The time was over" in client.get(f"{at}/hand-in").text
    early, _ = exam(practice="1")
    done = client.post(early, data={"token": token, "do": "hand-in"})
    assert "The time was over" not in done.text


def test_two_hands_hand_in_once(client, token, exam, app):
    at, _ = exam()
    site = app.state.site
    before = len(site.store.list_outcomes(site.store.learner().id))
    sitting = site.store.sittings.find(site.store.learner().id, at.rsplit("/", 1)[1])
    assert site.store.sittings.hand_in(sitting)
    assert not site.store.sittings.hand_in(sitting)
    assert len(site.store.list_outcomes(site.store.learner().id)) == before


@pytest.mark.parametrize("code", ["gone-1-en-0a1b2c", "mock-1-xx-0a1b2c", "no code"])
def test_an_exam_that_cannot_be_made_any_more_is_listed(client, app, code):
    store = app.state.site.store
    begun = store.sittings.begin(store.learner().id, code, None, pauses=True)
    listed = client.get("/exam")
    assert listed.status_code == 200
    assert f'<a href="/exam/{begun.id}">' in listed.text


def test_what_an_exam_cost_is_repaired_question_by_question(client, token, exam, app):
    at, _ = exam()
    page = client.post(at, data={"token": token, "do": "hand-in"}).text
    told = re.search(r"Repair these: (\d+) min, (\d+) questions", page)
    assert int(told[2]) == 5
    assert int(told[1]) <= 45
    name = at.rsplit("/", 1)[1]
    store = app.state.site.store
    me = store.learner().id
    cost = {one.template for one in store.list_outcomes(me)}
    asked = client.post("/practice", data={"token": token, "repair": name})
    found = []
    for _ in range(int(told[2])):
        attempt = store.latest(me, 1)[0]
        found.append(attempt.template)
        row = OutcomeRecord(attempt.template, "any", "", "", right=True, first=True,
                            at=time.time(), credit=1.0, helped=False, attempt=attempt.id)  # fmt: skip
        store.save_attempt(attempt, (row,))
        asked = client.post(f"/q/{attempt.id}/next", data={"token": token})
        assert asked.url.path.startswith("/q/"), "in the end what the plan says"
    assert sorted(found) == sorted(cost), "each once"
    assert "Repair" not in client.get(at).text


def test_results_say_what_each_question_cost_in_points_and_time(client, token, exam, code, app):
    at, page = exam()
    store, numbers = app.state.site.store, re.findall(r'data-question="(\d)"', page)
    begun = store.sittings.find(store.learner().id, at.rpartition("/")[2]).begun
    with store.database.writing() as connection:  # it began ten minutes ago
        connection.execute(update(SITTING).values(begun=begun - 600))
    json_only = {"accept": "application/json"}
    for seconds in ("65.5", "60"):
        sent = {
            "token": token,
            "spent-1": seconds,
            "spent-2": "9.0",
            "spent-x": "3",
            "spent-3": "-4",
        }
        assert client.post(at, data=sent, headers=json_only).json()["kept"] is True
    client.post(at, data={"token": token, "spent-4": "86400"}, headers=json_only)
    done = client.post(at, data={"token": token, "do": "hand-in"}).text
    rows = [shown(row) for row in re.findall(r"<tr>(?:(?!</tr>).)*?</tr>", done, re.DOTALL)]
    clocks = [
        re.search(r"(\d+:\d\d) planned (\d+):(\d\d)", row) for row in rows if "planned" in row
    ]
    assert len(clocks) == len(numbers)
    assert [one[1] for one in clocks[:3]] == ["2:06", "0:18", "0:00"]
    assert clocks[3][1] in {"7:36", "7:37"}, "no more than has passed"
    planned = sum(60 * int(one[2]) + int(one[3]) for one in clocks)
    minutes = re.search(r"10:0\d of (\d+) min", shown(done))[1]
    assert planned == pytest.approx(60 * int(minutes), abs=len(clocks))
    lost = [float(one) for one in re.findall(r'<span class="lost">−([\d.]+)</span>', done)]
    assert lost == sorted(lost, reverse=True)
    assert sum(lost) == 10
    assert done.count('class="lost"') == len(numbers), "what was left empty stands in one line"


def test_a_decimal_sign_is_declared_in_an_exam_and_kept(client, token, exam, app):
    store = app.state.site.store
    at, page = exam()
    assert 'value="comma" formnovalidate aria-pressed="false"' in page
    told = client.post(at, data={"token": token, "do": "comma"})
    assert told.url.path == at
    assert 'value="comma" formnovalidate aria-pressed="true"' in told.text
    sitting = store.sittings.find(store.learner().id, at.rpartition("/")[2])
    assert sitting.decimal == "comma"
    assert store.learner().settings["decimal"] == "comma", "remembered for what comes next"
    client.post(at, data={"token": token, "do": "hand-in"})
    store.sittings.declare_decimal(sitting, "point")
    kept = store.sittings.find(store.learner().id, sitting.id)
    assert kept.decimal == "comma", "what was handed in is marked as it was read"
