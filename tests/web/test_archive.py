"""Everything of a learner as a file, taken in by another server: added, never doubled."""

from __future__ import annotations

import json

import pytest
from sweep import together

from quizgen.core.errors import StoreError
from quizgen.practice.scheduler import ReviewEvent, ReviewRating
from quizgen.store import OutcomeRecord, QuestionRef, Store
from quizgen.store.archive import read_archive

NOW = 1_795_000_000.0

pytestmark = pytest.mark.both_databases


@pytest.fixture
def store(database):
    made = []

    def opened() -> Store:
        made.append(Store(database()))
        return made[-1]

    yield opened
    for one in made:
        one.close()


@pytest.fixture
def full(store):
    """A learner with a question, an exam, a card and a date."""
    mine = store()
    learner = mine.learner().id
    attempt = mine.start_attempt(
        learner, QuestionRef("rgb-to-hsv", "7"), {"topic": "colour", "tier": ""}
    )
    done = {"typed": "1", "tries": 1, "hints": 0, "wrong": "2", "note": "sign",
            "credit": 0.5, "helped": False, "decimal": "", "mistakes": {"trap:sign": "2"},
            "outcome": {"topic": "colour", "right": True, "first": False, "skipped": False}}  # fmt: skip
    attempt.state = {"parts": {"1a": {"state": done, "values": ["1"], "asked_back": ""}},
                     "ended": ["1a"]}  # fmt: skip
    attempt.ended = NOW
    mine.save_attempt(
        attempt, (OutcomeRecord("rgb-to-hsv", "colour", "a", "", right=True, first=True, at=NOW),)
    )
    sitting = mine.sittings.begin(learner, "mock-1-en-0a1b2c", 60.0, pauses=True)
    mine.sittings.save(sitting.learner, sitting.id, {"2a": ["x", "৩"]})
    mine.sittings.flag(sitting, "2")
    mine.cards.review(learner, [ReviewEvent("A3", ReviewRating.AGAIN, ("trap:swapped",))], NOW)
    mine.update_settings(learner, {"exam": "2027-02-12", "unknown": 1})
    return mine


def content(store):
    return json.loads(store.archives.write(store.learner().id))


def test_what_comes_out_goes_in_elsewhere_and_is_the_same(full, store):
    data = full.archives.write(full.learner().id)
    other = store()
    learner = other.learner().id
    assert other.archives.import_archive(learner, read_archive(data)) == 2
    assert content(other) == content(full)
    assert other.list_outcomes(learner)[0].template == "rgb-to-hsv"
    assert other.archives.import_archive(learner, read_archive(data)) == 0, (
        "a second time adds nothing"
    )
    assert content(other) == content(full)


def test_a_file_does_not_hand_in_the_paper_that_is_open_here(full):
    learner = full.learner().id
    open_here = json.loads(full.archives.write(learner))
    (sitting,) = open_here["sittings"]
    sitting |= {"id": "another-name", "code": "mock-1-both-0a1b2c", "handed": NOW}
    full.archives.import_archive(learner, read_archive(json.dumps(open_here).encode()))
    assert [one.handed for one in full.sittings.latest(learner)] == [None]


def test_somebody_else_on_the_same_server_gets_names_of_their_own(full):
    data = full.archives.write(full.learner().id)
    other = full.learner("other").id
    before = content(full)
    assert full.archives.import_archive(other, read_archive(data)) == 2
    assert full.archives.import_archive(other, read_archive(data)) == 0
    assert content(full) == before
    assert full.latest(other)[0].id != full.latest(full.learner().id)[0].id


def test_the_later_card_stays(full):
    learner = full.learner().id
    data = full.archives.write(learner)
    full.cards.review(learner, [ReviewEvent("A3", ReviewRating.GOOD)], NOW + 90)
    after = full.cards.all(learner)
    full.archives.import_archive(learner, read_archive(data))
    assert full.cards.all(learner) == after


def changed(**new):
    whole = {"format": "quizgen learning", "version": 1, "settings": {}, "attempts": [], "seen": [],
             "cards": [], "sittings": []}  # fmt: skip
    return json.dumps({**whole, **new}).encode()


SEEN = {
    "template": "x",
    "topic": "c",
    "part": "a",
    "note": "",
    "right": True,
    "first": True,
    "at": 1.0,
}


def test_a_file_of_the_form_of_the_next_test_can_be():
    assert read_archive(changed(seen=[SEEN])).seen[0].topic == "c"


@together(
    "data",
    [
        b"", b"[]", b"\xff\xfe", b"{" * 100_000, changed(version=2), changed(format="other"),
        changed(seen=[{**SEEN, "note": "a\0b"}]), changed(seen=[{**SEEN, "part": "x" * 21}]),
        changed(more=1), changed(settings={"lang": "x" * 50}), changed(seen=[{"template": "x"}]),
        changed(cards=[{"kind": "template", "name": "x\0", "state": 1, "step": 0, "stability": 1.0,
                        "difficulty": 5.0, "last": 0.0, "due": 0.0}]),
        changed(cards=[{"kind": "boss", "name": "x", "state": 1, "step": 0, "stability": 1.0,
                        "difficulty": 5.0, "last": 0.0, "due": 0.0}]),
        changed(cards=[{"kind": "template", "name": "x", "state": 1, "step": 0, "stability": 1e9,
                        "difficulty": 5.0, "last": 0.0, "due": 0.0}]),
    ],
)  # fmt: skip
def test_a_file_that_cannot_be_is_refused(data):
    with pytest.raises(StoreError):
        read_archive(data)


def test_in_the_browser(client, token):
    data = client.get("/progress/export")
    assert "attachment" in data.headers["content-disposition"]
    sent = client.post("/progress/import", data={"token": token}, files={"file": data.content})
    assert sent.status_code == 200
    assert "Questions and exams added: 0." in sent.text
    wrong = client.post("/progress/import", data={"token": token}, files={"file": b"<script>"})
    assert wrong.status_code == 400
    assert "nothing has changed" in wrong.text
    assert "<script>" not in wrong.text.split("<main", 1)[1]
    assert client.post("/progress/import", files={"file": data.content}).status_code == 403
    assert client.post("/progress/import", data={"token": token}).status_code == 400
    large = client.post(
        "/progress/import", data={"token": token}, files={"file": b"x" * 18_000_000}
    )
    assert large.status_code == 413
