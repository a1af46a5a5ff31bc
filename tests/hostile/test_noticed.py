"""Whoever runs a server hears of what goes wrong, and of nobody's secrets; copies of it restore."""

from __future__ import annotations

import io
import json
import logging
import re
import sqlite3
import threading

import pytest
from click.testing import CliRunner
from sqlalchemy.exc import OperationalError
from starlette.testclient import TestClient

from quizgen.cli.serve import serve
from quizgen.core.errors import StoreError
from quizgen.store import Packed, Store
from quizgen.store.database import back_up
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.event_log import FORMS, log_event, set_up_log
from quizgen.web.settings import ServerSettings

ADDRESS = "http://127.0.0.1:8000"
ANSWER = "hunter2 is my answer"


@pytest.fixture(scope="module")
def app(tmp_path_factory):
    file = tmp_path_factory.mktemp("data") / "learning.sqlite3"
    app = create_app(ServerSettings(f"sqlite:///{file}", workers=1))
    with TestClient(app, ADDRESS):
        yield app


@pytest.fixture
def client(app):
    browser = TestClient(app, ADDRESS)
    browser.get(f"/enter?key={app.state.site.settings.token}")
    return browser


@pytest.fixture(params=FORMS)
def log(request, monkeypatch):
    """What is written to the standard error, in each form."""
    written, logs = io.StringIO(), [logging.getLogger(name) for name in ("quizgen", "uvicorn")]
    monkeypatch.setattr("sys.stderr", written)
    before = [(one.handlers, one.propagate, one.level) for one in logs]
    set_up_log(request.param)
    yield lambda: (request.param, written.getvalue())
    for one, kept in zip(logs, before, strict=True):
        one.handlers, one.propagate, one.level = kept


def read(log) -> dict[str, str]:
    """The one line of a log, as its fields."""
    form, (line,) = log()[0], log()[1].splitlines()
    if form == "json":
        return {name: str(value) for name, value in json.loads(line).items()}
    _, level, event, rest = line.split(" ", 3)
    return {"level": level, "event": event, **dict(re.findall(r'(\w+)=("[^"]*"|\S+)', rest))}


def test_a_line_has_every_word_once_and_signs_of_any_script(log):
    log_event("seen", who="শিক্ষার্থী", said="two words", empty="", many=["a", "b"])
    form, text = log()
    if form == "json":
        assert "শিক্ষার্থী" in text
        assert json.loads(text)["said"] == "two words"
    else:
        assert text.rstrip().endswith('who=শিক্ষার্থী said="two words" empty="" many=a,b')


class DiskFullError(Exception):
    sqlite_errorname = "SQLITE_FULL"


@pytest.mark.parametrize(
    ("raised", "told"),
    [
        (ValueError(f"could not read {ANSWER}"), {"status": "500", "error": "ValueError"}),
        (OperationalError(f"INSERT {ANSWER}", {}, DiskFullError(ANSWER)),
         {"status": "503", "error": "OperationalError", "database": "SQLITE_FULL"}),
    ],
)  # fmt: skip
def test_what_fails_is_found_in_the_log_by_the_id_on_the_page(
    client, app, log, monkeypatch, raised, told
):
    def fail(*_: object) -> None:
        raise raised

    monkeypatch.setattr(app.state.site.store, "start_attempt", fail)
    sent = {"token": csrf_token(client.cookies[COOKIE]), "template": "point-to-image-plane"}
    answer = client.post("/practice", data=sent)
    found = read(log)
    expected = {"level": "ERROR", "event": "failed", "page": "start_question", **told}
    assert found.items() >= expected.items()
    assert answer.status_code == int(found["status"])
    assert f"number: {found['id']}" in answer.text
    assert answer.headers["x-request-id"] == found["id"]
    assert "practice.py" in found["at"]
    assert "hunter2" not in log()[1] + answer.text


def test_an_address_is_no_part_of_the_log(client, app, log, monkeypatch):
    monkeypatch.setattr(app.state.site.store, "attempt", lambda *_: 1 / 0)
    assert client.get(f"/q/{ANSWER}?a={ANSWER}").status_code == 500
    assert read(log)["error"] == "ZeroDivisionError"
    assert "hunter2" not in log()[1]


def test_health_asks_the_database(app, monkeypatch):
    stranger = TestClient(app, ADDRESS)
    answer = stranger.get("/health")
    assert (answer.status_code, answer.json()) == (
        200, {"status": "ok", "database": True, "workers": 1})  # fmt: skip
    assert "set-cookie" not in answer.headers

    def fail() -> None:
        raise OperationalError("SELECT", {}, DiskFullError())

    monkeypatch.setattr(app.state.site.store, "check", fail)
    answer = stranger.get("/health")
    assert (answer.status_code, answer.json()["status"]) == (503, "failing")


def paper(name: str, parts: int) -> Packed:
    return Packed(name * 64, "trial-1-both-000000", b"x" * 50_000, 10, None,
                  tuple(map(str, range(parts))))  # fmt: skip


def test_a_copy_made_while_answers_are_saved_restores_them(tmp_path):
    address = f"sqlite:///{tmp_path / 'learning.sqlite3'}"
    store = Store(address)
    me = store.learner().id
    sitting = store.sittings.begin(
        me, "trial-1-both-000000", None, pauses=False, paper=paper("a", 2000))  # fmt: skip
    acknowledged, copied = [], threading.Event()

    def save() -> None:
        for number in range(2000):
            assert store.sittings.save(me, sitting.id, {str(number): [str(number)]})[1]
            acknowledged.append(number)
            if copied.is_set():
                return

    writer = threading.Thread(target=save)
    writer.start()
    while len(acknowledged) < 20:
        assert writer.is_alive()
    before = len(acknowledged)
    copy = tmp_path / "copy.sqlite3"
    done = CliRunner().invoke(serve, ["--database", address, "--backup", str(copy)])
    copied.set()
    writer.join()
    store.close()
    assert done.exit_code == 0, done.output
    assert copy.stat().st_mode & 0o777 == 0o600
    assert sorted(tmp_path.glob("*copy*")) == [copy], "one file, whole"
    restored = tmp_path / "restored" / "learning.sqlite3"
    restored.parent.mkdir()
    restored.write_bytes(copy.read_bytes())
    with sqlite3.connect(restored) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    database.close()
    again = Store(f"sqlite:///{restored}")
    answers = again.sittings.answers(again.sittings.latest(me)[0])
    assert {str(number): [str(number)] for number in range(before)}.items() <= answers.items()
    assert again.sittings.paper("a" * 64) == b"x" * 50_000
    again.close()


def test_what_cannot_be_copied_is_said(tmp_path):
    with pytest.raises(StoreError, match="no such database"):
        back_up(f"sqlite:///{tmp_path / 'none.sqlite3'}", tmp_path / "copy")
    with pytest.raises(StoreError, match="pg_dump"):
        back_up("postgresql+psycopg://me@localhost/quiz", tmp_path / "copy")
    assert list(tmp_path.iterdir()) == []


def test_papers_that_only_somebody_removed_sat_go_with_them(tmp_path):
    store = Store(f"sqlite:///{tmp_path / 'learning.sqlite3'}")
    ann, ben = store.learner("Ann").id, store.learner("Ben").id
    for who, name in ((ann, "a"), (ann, "b"), (ben, "b")):
        code = f"trial-{ord(name)}-both-000000"
        store.sittings.begin(who, code, None, pauses=False, paper=paper(name, 1))
    store.accounts.remove(ann)
    assert store.sittings.paper("b" * 64)
    with store.database.reading() as connection:
        assert connection.exec_driver_sql("SELECT count(*) FROM paper").scalar() == 1
    store.close()
