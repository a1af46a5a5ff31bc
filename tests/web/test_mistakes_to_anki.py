"""Mistakes to Anki from the browser: what went wrong in practice and in exams, imported by Anki."""

from __future__ import annotations

import pytest

from quizgen.question.compose import compose_question
from quizgen.store import QuestionRef

QUESTION = "point-to-image-plane"
GIVEN_UP = {"topic": "colour", "right": False, "first": False}


pytestmark = [pytest.mark.both_databases, pytest.mark.usefixtures("nothing_done")]


@pytest.fixture
def notes(collection, tmp_path):
    """What Anki makes of a file: the fields of its notes, the tags, the missing media."""
    from anki.collection import ImportAnkiPackageOptions, ImportAnkiPackageRequest

    def imported(data: bytes) -> list[str]:
        path = tmp_path / "mistakes.apkg"
        path.write_bytes(data)
        request = ImportAnkiPackageRequest(
            package_path=str(path), options=ImportAnkiPackageOptions()
        )
        collection.import_anki_package(request)
        assert not collection.media.check().missing
        found = collection.find_notes("tag:quizgen::kind::mistake")
        return [" ".join(collection.get_note(one).fields) for one in found]

    return imported


@pytest.fixture
def swapped(bank):
    """Both coordinates exchanged, as they are typed into two boxes."""
    _, key = compose_question(bank.template(QUESTION), "3", "en", figures=False)
    return key.solution.parts[0].answer.strip("()").split("; ")[::-1]


def test_nothing_went_wrong_yet(client):
    assert "mistakes.apkg" not in client.get("/progress").text
    answer = client.get("/progress/mistakes.apkg")
    assert answer.status_code == 404
    assert "No cards yet" in answer.text


def test_a_mistake_of_practice_is_a_card_also_when_it_was_mended(
    client, token, begin, swapped, notes
):
    at = begin(QUESTION)
    client.post(f"{at}/1", data={"token": token, "a": swapped})
    client.post(f"{at}/1", data={"token": token, "a": swapped[::-1]})
    assert 'href="/progress/mistakes.apkg"' in client.get("/progress").text
    answer = client.get("/progress/mistakes.apkg")
    assert answer.headers["content-disposition"].endswith('"quizgen-mistakes.apkg"')
    (card,) = notes(answer.content)
    assert "; ".join(swapped).replace("-", "−") in card.replace("-", "−")
    assert "coordinates are exchanged" in card


def test_each_mistake_with_a_name_once_and_nothing_else(client, token, begin, swapped, notes, bank):
    for seed in ("3", "4"):
        _, key = compose_question(bank.template(QUESTION), seed, "en", figures=False)
        other = key.solution.parts[0].answer.strip("()").split("; ")[::-1]
        at = begin(QUESTION, seed)
        for wrong in (other, ["987", "654"]):
            client.post(f"{at}/1", data={"token": token, "a": wrong})
    client.post(f"{begin('rgb-to-hsv')}/1a", data={"token": token, "do": "solution", "a": ["", ""]})
    (card,) = notes(client.get("/progress/mistakes.apkg").content)
    assert "coordinates are exchanged" in card, "made first, and not forgotten for the second"
    assert "987" not in card


def test_an_exam_in_bangla(client, token, notes):
    client.post("/settings", data={"token": token, "lang": "bn", "back": "/"})
    at = client.post("/exam", data={"token": token, "blueprint": "projection", "minutes": "15"})
    at = at.url.path
    assert client.get(f"{at}/mistakes.apkg").status_code == 404, "not before it is handed in"
    done = client.post(at, data={"token": token, "do": "hand-in"})
    assert f'href="{at}/mistakes.apkg"' in done.text
    cards = notes(client.get(f"{at}/mistakes.apkg").content)
    assert cards
    assert "ফাঁকা" in cards[0]
    assert client.get("/progress/mistakes.apkg").status_code == 404, "what is blank is no mistake"


def test_what_is_no_longer_in_the_bank_is_left_out(client, app, swapped, notes):
    store = app.state.site.store
    learner = store.learner().id
    state = {"outcome": GIVEN_UP, "mistakes": {"trap:swapped": "; ".join(swapped)}}
    for which in (QuestionRef(QUESTION, "3"), QuestionRef("taken-out", "3")):
        attempt = store.start_attempt(learner, which, {})
        attempt.state = {"parts": {"1": {"state": state}}}
        store.save_attempt(attempt)
    page = client.get("/progress/mistakes.apkg")
    assert len(notes(page.content)) == 1


def test_nobody_gets_those_of_another(client, app):
    other = app.state.site.store.learner("other").id
    sitting = app.state.site.store.sittings.begin(other, "trial-1-en-0a1b2c", None, pauses=False)
    app.state.site.store.sittings.hand_in(sitting)
    assert client.get(f"/exam/{sitting.id}/mistakes.apkg").status_code == 404
