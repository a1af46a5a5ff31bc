"""An exam keeps what it showed and what marks it; its time goes on evenly."""

from __future__ import annotations

import re
import time

import pytest
from own_bank import NAME, own_bank
from sqlalchemy import func, select, update
from starlette.testclient import TestClient

from quizgen.bank.bank import Bank
from quizgen.store.schema import PAPER, SITTING
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings

pytestmark = [pytest.mark.both_databases, pytest.mark.usefixtures("jobs_in_this_process")]

BLUEPRINT = f"""[title]
en = "Short"
[[slot]]
templates = ["{NAME}"]
"""


class Browser:
    """A browser at a server of a bank, that was let in."""

    def __init__(self, address, root) -> None:
        app = create_app(ServerSettings(address, bank=Bank(root, trusted=True), workers=1))
        self.site = app.state.site
        self.client = TestClient(app, "http://127.0.0.1:8000")
        self.client.__enter__()
        self.client.get(f"/enter?key={self.site.settings.token}")
        self.token = csrf_token(self.client.cookies[COOKIE])

    def post(self, at, **sent):
        return self.client.post(at, data={"token": self.token, **sent})

    def end(self):
        self.client.__exit__(None, None, None)


@pytest.fixture
def root(tmp_path):
    own_bank(tmp_path)
    (tmp_path / "templates" / "blueprints").mkdir()
    (tmp_path / "templates" / "blueprints" / "short.toml").write_text(BLUEPRINT)
    return tmp_path


@pytest.fixture
def address(database):
    return database()


@pytest.fixture
def server(address, root):
    """Starts a server of the database and the bank, in place of the one before."""
    began = []

    def start() -> Browser:
        while began:
            began.pop().end()
        began.append(Browser(address, root))
        return began[0]

    yield start
    while began:
        began.pop().end()


def change_bank(root):
    """As an upgrade does: another digest, so that no code of before leads anywhere."""
    file = root / "templates" / "projection" / NAME / "template.toml"
    file.write_text(f"{file.read_text()}\n# changed\n")


def stem(page: str) -> list[str]:
    return re.findall(r'<div class="stem">.*?</div>', page, re.DOTALL)


def test_an_exam_goes_on_and_is_marked_after_the_bank_has_changed(server, root):
    before = server()
    begun = before.post("/exam", blueprint="short")
    at = begun.url.path
    before.post(at, **{"on-1": "1", "a-1": "7"})
    change_bank(root)
    after = server()
    code = re.search(r"<code>([^<]+)</code>", begun.text)[1]
    assert "not the code of a paper" in after.post("/exam", code=code).text
    assert stem(after.client.get(at).text) == stem(begun.text)
    done = after.post(at, do="hand-in")
    assert "Results" in done.text
    assert stem(done.text) == stem(begun.text)
    assert "Results" in server().client.get(at).text


def test_whoever_sits_the_same_paper_shares_what_is_kept(server):
    browser = server()
    code = re.search(r"<code>([^<]+)</code>", browser.post("/exam", blueprint="short").text)[1]
    store = browser.site.store
    packed = store.sittings.latest(store.learner().id)[0]
    browser.post(f"/exam/{packed.id}", do="hand-in")
    browser.post("/exam", code=code, practice="1")
    with store.database.reading() as connection:
        assert connection.execute(select(func.count()).select_from(PAPER)).scalar_one() == 1


@pytest.mark.parametrize("changed", [False, True])
def test_an_exam_of_before_keeps_its_paper_if_it_can_still_be_made(server, root, changed):
    browser = server()
    begun = browser.post("/exam", blueprint="short")
    with browser.site.store.database.writing() as connection:
        connection.execute(update(SITTING).values(paper=None))
    if changed:
        change_bank(root)
    shown = server().client.get(begun.url.path)
    assert shown.status_code == (410 if changed else 200)
    assert ("kept only the code" in shown.text) == changed
    assert (stem(shown.text) == stem(begun.text)) != changed


def test_the_next_server_goes_on_with_the_time_of_the_one_before(server, monkeypatch):
    first = server().site.store.clock
    monkeypatch.setattr(time, "time", lambda real=time.time: real() + 3600)
    second = server().site.store.clock
    assert second.anchor == first.anchor
