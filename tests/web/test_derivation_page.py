"""A derivation as it is practised: its lines with signs on the page and in the terminal."""

from __future__ import annotations

import re

import pytest
from click.testing import CliRunner
from starlette.testclient import TestClient

from quizgen.bank.bank import Bank
from quizgen.cli import practice
from quizgen.store import QuestionRef
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings

RULES = """topic = "force"
tier = "A"
[draw]
n = { range = [2, 6, 1] }
[[part]]
points = 2
[part.answer]
kind = "derivation"
symbols = { F = "positive", m = "positive", a = "positive" }
let = { a = "F/(n*m)" }
traps = { forgotten = "F = m*a" }
[part.answer.lines]
law = { is = "F = n*m*a", points = 1, needed = true }
goal = { is = "a = F/(n*m)", points = 1 }
"""
WORDS = """# A train
A force $F$ pulls {{ n }} carts of mass $m$.

**Derive the acceleration $a$.**

## steps
- law: The force moves all of them.
- goal: Divide by the mass of all.

## traps
- forgotten: Think of the other carts.
"""


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    root = tmp_path_factory.mktemp("bank")
    folder = root / "templates" / "force" / "train"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(RULES)
    (folder / "en.md").write_text(WORDS)
    return Bank(root)


@pytest.fixture(scope="module")
def client(bank, database):
    app = create_app(ServerSettings(database(), bank, workers=1))
    with TestClient(app, "http://127.0.0.1:8000") as client:
        client.get(f"/enter?key={app.state.site.settings.token}")
        yield client


def test_each_line_has_a_sign_and_the_first_wrong_one_its_reason(client):
    store = client.app.state.site.store
    question = f"/q/{store.start_attempt(store.learner().id, QuestionRef('train', '3'), {}).id}"
    assert "<textarea" in client.get(question).text
    token = csrf_token(client.cookies[COOKIE])
    data = {"token": token, "do": "answer", "a": "F = m a\na = F/m\nall carts move alike"}
    page = client.post(f"{question}/1", data=data).text
    verdict = re.search(r'<div class="verdict partial" id="verdict-1">.*?</div>', page, re.DOTALL)
    assert verdict is not None
    assert "Line 1: Think of the other carts." in verdict[0]
    lines = re.findall(r'<li class="(\w+)">.*?<span class="typed">([^<]*)</span>', verdict[0])
    assert lines == [
        ("wrong", "F = m·a"),
        ("partial", "a = F/m"),
        ("ambiguous", "all carts move alike"),
    ]


def test_a_terminal_reads_lines_until_an_empty_one(bank, tmp_path, monkeypatch):
    monkeypatch.setattr(practice, "state_folder", lambda: tmp_path / "state")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    typed = ["F = m a", "a = F/m", "", "?", "F = 3 m a", "F/m = 3 a", "", "!"]
    done = CliRunner().invoke(
        practice.practice,
        ["--bank", str(bank.root), "--count", "1", "--seed", "s"],
        input="\n".join(typed) + "\n",
    )
    assert done.exit_code == 0
    assert "1 ✗ F = m·a" in done.output
    assert "2 ~ a = F/m" in done.output
    assert "Line 1: Think of the other carts." in done.output
    assert "Hint: The force moves all of them." in done.output
    assert "Answer: F = " in done.output


def read_back(client, road, token, field, typed):
    """The lines as they are read back while they are written: class, text and what is said."""
    page = client.post(road, data={"token": token, field: typed}).text
    row = r'<li class="(\w*)">.*?<span class="typed">([^<]*)</span> <span class="quiet">([^<]*)</span>'
    return re.findall(row, page, re.DOTALL)


def test_each_finished_line_is_read_and_judged_as_one_writes(client):
    store = client.app.state.site.store
    question = f"/q/{store.start_attempt(store.learner().id, QuestionRef('train', '3'), {}).id}"
    client.get(question)
    token = csrf_token(client.cookies[COOKIE])

    def read(typed):
        return read_back(client, f"{question}/1/read", token, "a", typed)

    number = re.search(r"pulls (\d) carts", client.get(question).text)[1]
    early = "not told yet: first write what leads to it"
    # Right or wrong, the goal cannot be found by trying.
    for goal in (f"a = F/({number} m)", "a = F/m", "a = m/F"):
        ((sign, _, said),) = read(goal)
        assert (sign, said) == ("ambiguous", early)
    law = f"F = {number} m a"
    assert [(sign, said) for sign, _, said in read(f"{law}\na = F/({number} m)\na = F/m\n")] == [
        ("correct", "right"), ("correct", "right"), ("wrong", "not right"),
    ]  # fmt: skip
    assert [sign for sign, _, _ in read("F = m a\na = F/m")] == ["wrong", "partial"]
    signs = read(f"{law}\ncarts move\na = F/(\nF = {law[4:]}")
    assert [(sign, text) for sign, text, _ in signs[1:]] == [
        ("ambiguous", "carts move"), ("unreadable", "a = F/("), ("correct", f"F = {number}·m·a"),
    ]  # fmt: skip
    assert read("") == []
    page = client.get(question).text
    assert "Tries left" not in page, "reading is no try"
    assert "Think of the other carts" not in page


def test_in_an_exam_lines_are_read_back_and_not_judged(client):
    token = csrf_token(client.cookies[COOKIE])
    sent = {"token": token, "minutes": "30", "blueprint": "force"}
    exam = client.post("/exam", data=sent)
    found = re.search(r'hx-post="(/exam/[\w-]+/read/([\w.]+))" hx-trigger="quizgen:row"', exam.text)
    lines = read_back(client, found[1], token, f"a-{found[2]}", "F = 9 m a\na = F/(\n")
    assert [line[:2] for line in lines] == [("ambiguous", "F = 9·m·a"), ("unreadable", "a = F/(")]
    assert lines[0][2] == ""


def test_a_bank_without_formulas_has_no_page_of_them(client):
    found = [client.get(address).status_code for address in ("/formulas", "/formulas.pdf")]
    assert found == [404, 404]
