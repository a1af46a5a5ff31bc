"""Who sits an exam of a class in the browser and means to see, write or gain more than is theirs."""

from __future__ import annotations

import hashlib
import logging
import re

import pytest
from class_server import ADA, JOERG, OPEN, RAHIMA, exams, make_class
from people import ADDRESS, Somebody
from starlette.testclient import TestClient

from quizgen.web.class_exam import CONFIG_KEY, EXAM_KEY
from quizgen.web.class_room import WRONG_CODES


@pytest.fixture
def opened(tmp_path, monkeypatch):
    with exams(lambda about: make_class(tmp_path, about), monkeypatch) as one:
        yield one


def test_a_neighbour_sees_and_writes_nothing_of_another(opened):
    exam = opened(OPEN)
    (ada, at), (rahima, _) = exam.begun(ADA), exam.begun(RAHIMA)
    assert ada.save(at, p1=["1", "2"]) == 200
    for address in (at, f"{at}/hand-in"):
        assert rahima.browser.get(address).status_code == 404
    assert rahima.save(at, p1=["7", "7"]) == 404
    assert rahima.browser.post(at, data={"token": rahima.token, "do": "hand-in"}).status_code == 404
    flag = f"{at}/flag/1"
    assert rahima.browser.post(flag, data={"token": rahima.token}).status_code == 404
    assert 'value="1"' in ada.get(at).text
    for who, page in ((ADA, rahima.get("/seat").text), (RAHIMA, ada.get("/seat").text)):
        assert who.name not in page
        assert who.id not in page


def test_a_student_does_not_watch_and_has_nothing_but_the_exam(opened):
    exam = opened(OPEN)
    ada, _ = exam.begun(ADA)
    here = f"/live/{exam.number(ADA)}"
    for address in ("/live", here, "/people"):
        assert ada.browser.get(address).status_code == 403
    for address, what in ((here, "extend"), (here, "reopen"), ("/live", "open"),
                          ("/live", "extend"), ("/live", "release")):  # fmt: skip
        sent = {"token": ada.token, "do": what, "minutes": "60", "sure": "1"}
        assert ada.browser.post(address, data=sent).status_code == 403
    for address in (
        "/exam",
        "/practice",
        "/formulas",
        "/progress",
        "/questions",
        "/class",
        "/author",
    ):
        assert ada.browser.get(address).status_code == 404
    stranger = TestClient(exam.app, ADDRESS)
    for address in ("/live", "/seat", "/seat/state", here):
        assert stranger.get(address, follow_redirects=False).status_code in {303, 403}


def test_a_code_lets_in_once_however_its_link_is_opened(opened):
    exam = opened(OPEN)
    ada, thief = exam.student(ADA), exam.student(ADA, "10.9.9.9")
    code = ada.code
    for _ in range(3):  # as a mail program looks at links before anybody does
        assert thief.get(f"/?code={code}").url.path == "/"
    assert ada.enter(code).url.path == "/seat"
    assert thief.enter(code).status_code == 403
    assert "This code has been used" in thief.page
    assert thief.get("/seat").url.path == "/"
    learner, issue, _ = exam.room.store.seats.list_issues()[ADA.id]
    assert not exam.room.store.seats.use_code(learner, issue)
    teacher = exam.watcher()
    assert "the code was tried again" in teacher.get("/live").text
    assert "10.9.9.9" in teacher.get(f"/live/{learner}").text


def test_a_new_code_ends_the_session_of_the_first_computer_and_keeps_the_answers(opened):
    exam = opened(OPEN)
    teacher, (ada, at) = exam.watcher(), exam.begun(ADA)
    old = ada.code
    assert ada.save(at, p1=["1", "2"]) == 200
    here = f"/live/{exam.number(ADA)}"
    teacher.get(here)
    assert "Tick the box" in teacher.post(here, do="code").text
    shown = teacher.post(here, do="code", sure="1").text
    fresh = re.search(r'class="entry">([^<]+)<', shown)[1]
    assert fresh != old
    assert ada.save(at, p1=["9", "9"]) == 403
    assert exam.student(ADA).enter(old).status_code == 403
    second = exam.student(ADA, "10.0.0.77")
    assert second.enter(fresh).url.path == at
    assert 'value="1"' in second.page


def test_wrong_codes_are_slowed_down_and_a_right_one_from_the_same_address_is_not(opened):
    exam = opened(OPEN)
    thief = exam.student(RAHIMA, "10.0.0.50")
    found = [thief.enter(f"AAAAA-{n:05}").status_code for n in range(WRONG_CODES[0] + 5)]
    assert found == [403] * WRONG_CODES[0] + [429] * 5
    assert thief.enter("' OR 1=1 --").status_code == 429
    ada = exam.student(ADA, "10.0.0.50")
    assert ada.enter().url.path == "/seat"


def test_a_paper_has_no_code_and_no_key_and_takes_no_parts_of_others(opened):
    exam = opened(OPEN)
    ada, at = exam.begun(ADA)
    heads = exam.folder.heads()
    assert not any(head.code in ada.page or head.code[2:] in ada.page for head in heads.values())
    assert ada.save(at, p9z="1") == 400


def test_no_code_and_no_name_stands_in_the_log(opened, caplog):
    caplog.set_level(logging.DEBUG)
    exam = opened(OPEN)
    ada, at = exam.begun(ADA)
    ada.save(at, p1=["123456789", "2"])
    ada.enter("AAAAA-BBBBB")
    said = caplog.text + "".join(str(one.__dict__) for one in caplog.records)
    for secret in (ada.code, ADA.name, "123456789", "BBBBB"):
        assert secret not in said.replace("/?code=", ""), secret


KEYS = {CONFIG_KEY: "a" * 64, EXAM_KEY: "b" * 64}
KIOSK = f'{OPEN}config_keys = ["{"c" * 64}", "{"A" * 64}"]\nexam_keys = ["{"b" * 64}"]\n'


def sign(path: str, keys=KEYS) -> dict[str, str]:
    """What Safe Exam Browser sends with a request."""
    made = {name: hashlib.sha256(f"{ADDRESS}{path}{key}".encode()) for name, key in keys.items()}
    return {name: one.hexdigest() for name, one in made.items()}


def test_only_the_prescribed_browser_is_let_in(opened):
    exam = opened(KIOSK)
    browser = TestClient(exam.app, ADDRESS)
    assert browser.get("/").status_code == 403
    assert "Safe Exam Browser" in browser.get("/").text
    assert browser.get("/?code=1", headers=sign("/?code=1")).status_code == 200
    for headers in (sign("/seat"), sign("/?code=2"), {}, {**sign("/"), EXAM_KEY: "0" * 64},
                    sign("/", {CONFIG_KEY: "a" * 64}), sign("/", {**KEYS, CONFIG_KEY: "d" * 64})):  # fmt: skip
        assert browser.get("/", headers=headers).status_code == 403
    page = browser.get("/", headers=sign("/")).text
    token = re.search(r'name="token" value="(\w+)"', page)[1]
    sent = {"token": token, "code": exam.student(JOERG).code}
    assert browser.post("/", data=sent).status_code == 403, "without its keys the code is not used"
    inside = browser.post("/", data=sent, headers=sign("/"), follow_redirects=False)
    assert inside.headers["location"] == "/seat"
    assert browser.get("/seat").status_code == 403
    assert browser.get("/seat", headers=sign("/seat")).status_code == 200
    assert Somebody(exam.app).get("/sign-in").status_code == 200, "who watches needs no kiosk"
    assert exam.watcher().get("/live").status_code == 200
