"""Fields inside sentences on pages: practised with one button, sat in an exam, without JavaScript."""

from __future__ import annotations

import re

import pytest
from starlette.testclient import TestClient

from quizgen.bank.bank import Bank
from quizgen.store import QuestionRef
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings

RULES = """topic = "sea"
tier = "A"
[draw]
h = { range = [3, 9, 1] }
[[part]]
answer = { kind = "gap", gaps = ["moon"] }
[[part]]
answer = { kind = "choice", in_order = true, options = { higher = true, lower = false } }
[[part]]
answer = { kind = "code", output = "{{ h }}" }
"""
WORDS = """# Tides
The tide is {{ h }}.

## a
The tides follow the {{ ?a }}; the flood is {{ ?b }} than usual.

The clock shows {{ ?c }}.

## gaps
- moon: Moon
## options
- higher: higher
- lower: lower
"""


@pytest.fixture(scope="module")
def client(tmp_path_factory, database):
    root = tmp_path_factory.mktemp("bank")
    folder = root / "templates" / "sea" / "tide"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(RULES)
    (folder / "en.md").write_text(WORDS)
    app = create_app(ServerSettings(database(), Bank(root), workers=1))
    with TestClient(app, "http://127.0.0.1:8000") as client:
        client.get(f"/enter?key={app.state.site.settings.token}")
        yield client


@pytest.fixture
def question(client):
    store = client.app.state.site.store
    return f"/q/{store.start_attempt(store.learner().id, QuestionRef('tide', '3'), {}).id}"


def send(client, question, do="answer", **fields):
    token = csrf_token(client.cookies[COOKIE])
    data = {"token": token, "do": do, **{f"a-1{part}": text for part, text in fields.items()}}
    return client.post(f"{question}/1a", data=data).text


def test_inputs_stand_in_the_sentence_and_have_the_names_of_its_words(client, question):
    page = client.get(question).text
    sentence = re.search(r"<p>The tides follow.*?</p>", page, re.DOTALL)[0]
    assert re.search(
        r'<input type="text" name="a-1a"[^>]*aria-label="[^"]*The tides follow the"', sentence
    )
    assert re.search(r'<select name="a-1b"[^>]*aria-label="[^"]*the flood is"', sentence)
    assert page.count('value="answer"') == 1


def test_one_button_checks_each_field_by_itself(client, question):
    page = send(client, question, a="Sun", b="A", c="")
    verdicts = re.findall(r'<div class="verdict (\w+)" id="verdict-(\w+)"', page)
    assert verdicts == [("wrong", "1a"), ("correct", "1b")]
    assert 'value="Sun"' in page
    assert re.search(r'<option value="A" selected>', page)


def test_a_wrong_field_costs_no_further_try_while_another_is_answered(client, question):
    first = send(client, question, a="Sun")
    tries = r'id="verdict-1a">.*?<p class="quiet">([^<]*)</p>\s*</div>'
    left = re.search(tries, first, re.DOTALL)[1]
    again = send(client, question, a="Sun", b="A")
    assert re.search(tries, again, re.DOTALL)[1] == left


def test_what_is_typed_stays_when_the_solution_of_another_field_is_shown(client, question):
    page = send(client, question, do="solution:1a", a="", c="half")
    assert "Moon" in page
    assert 'value="half"' in page
    assert 'id="verdict-1c"' not in page
    finished = send(client, question, b="B", c="7")
    assert 'id="verdict-1c"' in finished


def test_an_exam_has_the_same_fields_and_marks_them(client):
    token = csrf_token(client.cookies[COOKIE])
    page = client.post("/exam", data={"token": token, "blueprint": "sea", "minutes": "15"})
    assert re.search(
        r"follow the <span[^>]*><label[^>]*>\(a\)</label> <input[^>]*name=\"a-1a\"", page.text
    )
    address = page.url.path
    data = {"token": token, "do": "hand-in", "on-1a": "[]", "on-1b": "[]", "on-1c": "[]"}
    done = client.post(address, data={**data, "a-1a": "moon", "a-1b": "A", "a-1c": "x"}).text
    assert "2 of 3" in re.sub(r"<[^>]*>", "", done).replace("\u00a0", " ")
