"""A class sits its exam in the browser: cards, papers, time, those who watch, what lands in the folder."""

from __future__ import annotations

import csv
import hashlib
import plistlib
import re
import time
from dataclasses import replace

import msgspec
import pytest
from class_server import (
    ADA,
    JOERG,
    OPEN,
    RAHIMA,
    STUDENTS,
    Exam,
    exam_settings,
    exams,
    make_class,
)
from click.testing import CliRunner
from people import ADDRESS
from starlette.testclient import TestClient

from quizgen.classes.admission import write_admission_files
from quizgen.classes.analysis_page import write_analysis_page
from quizgen.classes.class_folder import ClassFolder, format_settings
from quizgen.classes.exam_details import read_exam_details
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.grading_run import grade_class
from quizgen.classes.safe_exam_browser import read_config_key
from quizgen.classes.seats import DATABASE, RECORD, entry_code, normalise_entry_code
from quizgen.classes.statuses import read_statuses
from quizgen.classes.template_history import write_template_history
from quizgen.cli.main import root_group
from quizgen.core.errors import ClassError
from quizgen.core.executor import InlineExecutor
from quizgen.kinds.grade import show_key
from quizgen.web.app import create_app


@pytest.fixture
def opened(tmp_path, monkeypatch):
    """Opens a class's exam; ``about`` is its ``exam.toml``."""
    with exams(lambda about: make_class(tmp_path, about), monkeypatch) as one:
        yield one


WINDOW = "[browser]\nbegins = {}\nends = {}\nminutes = 60\n"


def window(before: float, after: float) -> str:
    """An exam that began and ends so many minutes from now."""
    now = time.time()
    at = (time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(now + 60 * m)) for m in (-before, after))
    return WINDOW.format(*at)


def right_answers(exam: Exam, who) -> dict[str, str]:
    key = exam.folder.find_by_code(exam.folder.heads()[who.id].code).key
    return {part.id: show_key(part.spec) for q in key.questions for part in q.parts}


def as_fields(text: str, count: int) -> list[str]:
    """What a person puts into the fields of a part whose answer is a text."""
    if ":" in text:  # pairs
        return [one.partition(":")[2] for one in text.split(",")]
    several = [one.strip(" ()") for one in text.split(";")]
    return several if len(several) == count else [text]


def test_from_the_card_to_the_marks(opened):
    exam = opened()
    teacher, ada = exam.watcher(), exam.student(ADA)
    page = ada.enter(ada.code.lower().replace("-", " "))
    assert page.url.path == "/seat"
    assert "has not been opened yet" in page.text
    assert "Ada Lovelace" in page.text
    assert ada.begin().url.path == "/seat", "nobody begins before"
    teacher.get("/live")
    teacher.post("/live", do="open")
    assert "Begin the exam" in ada.get("/seat").text
    paper = ada.begin()
    at = paper.url.path
    assert re.fullmatch("/exam/[^/]+", at)
    assert ada.get("/seat").url.path == at, "who comes back is led to the paper"
    code = exam.folder.heads()[ADA.id].code
    assert code not in paper.text
    assert not re.search('name="(clock|pauses|code|blueprint)"|value="rest"', paper.text)
    right = right_answers(exam, ADA)
    choice = [*right][-1]
    assert ada.save(at, p1=["1", "2"]) == 200
    teacher.get("/live")
    row = re.search(r"<tr[^>]*>(?:(?!</tr>).)*Ada Lovelace.*?</tr>", teacher.page, re.DOTALL)[0]
    assert "writing" in row
    assert ada.post(at, do="hand-in").url.path == "/seat"
    assert "You have handed in" in ada.page
    exam.store()
    form = exam.form(ADA)
    assert (form["code"], form["student"]["matriculation"]) == (code, ADA.id)
    assert [*form["answers"]] == ["1"]
    assert 0 <= form["minutes"] < 5
    assert "Your marks" not in ada.get("/seat").text
    assert grade_class(exam.folder, InlineExecutor(), 1).problems == ()
    assert ada.get("/seat/report").status_code == 404
    assert "Your marks" not in ada.get("/seat").text, "not before they are released"
    teacher.get("/live")
    teacher.post("/live", do="release")
    page = ada.get("/seat").text
    assert "Your marks" in page
    assert choice in page
    again = exam.student(ADA)
    assert "Your marks" in again.enter().text, "the card shows them, once they may be seen"
    teacher.get("/live")
    teacher.post("/live", do="withhold")
    assert "Your marks" not in ada.get("/seat").text


def test_marks_are_those_of_typed_answers(opened):
    exam = opened(OPEN)
    for who in STUDENTS[:2]:
        student, at = exam.begun(who)
        fields = student.parts()
        for part, text in right_answers(exam, who).items():
            assert student.save(at, **{f"p{part}": as_fields(text, len(fields[part]))}) == 200
        student.post(at, do="hand-in")
    exam.store()
    typed = {who.id: right_answers(exam, who) for who in STUDENTS[:2]}
    assert grade_class(exam.folder, InlineExecutor(), 1).problems == ()
    marks = {one.student: one for one in GradingHistory(exam.folder.path).current()}
    assert {who: one.marks for who, one in marks.items()} == {ADA.id: 6, RAHIMA.id: 6}
    assert {
        who: [*exam.form(one)["answers"]] for who, one in ((one.id, one) for one in STUDENTS[:2])
    } == {who: [*one] for who, one in typed.items()}
    assert marks[RAHIMA.id].minutes is not None


def test_times_of_questions_are_analysed(opened):
    exam = opened(OPEN)
    times = {ADA.id: 90, JOERG.id: 150}
    for who in (ADA, JOERG):
        student, at = exam.begun(who)
        exam.later += 170
        sent = {
            "token": student.token,
            "on-1": "",
            "a-1": ["1", "2"],
            "spent-1": str(times[who.id]),
        }
        student.browser.post(at, data=sent, headers={"accept": "application/json"})
        student.post(at, do="hand-in")
    exam.store()
    assert exam.form(ADA)["seconds"] == {"1": 90}
    assert grade_class(exam.folder, InlineExecutor(), 1).problems == ()
    _, page = write_analysis_page(exam.folder)
    assert "Minutes for the question (median)" in page.read_text("utf-8")
    write_template_history(exam.folder, [])
    for table in ("items.csv", "templates.csv"):
        with (page.parent / table).open(encoding="utf-8-sig") as stream:
            assert {row["minutes"] for row in csv.DictReader(stream)} == {"2", ""}


def test_each_has_the_own_paper_in_the_own_language(opened):
    exam = opened(OPEN)
    pages = {}
    for who in STUDENTS:
        student, at = exam.begun(who)
        pages[who.id] = re.sub(r"<[^>]*>", " ", student.page.partition('id="exam"')[2])
        assert ('action="/settings"' in student.get(at).text) == (who.lang == "both")
    assert len({*pages.values()}) == 3


def test_extra_time_is_added_and_stands_on_no_page_before_the_own_clock(opened):
    exam = opened(window(0, 40))
    for who, minutes in ((ADA, 40), (RAHIMA, 55), (JOERG, 70)):  # of 60: 25 % and 30
        student = exam.student(who)
        waiting = student.enter().text
        assert not re.search(r"\b(15|25|30|40|55|60|70)\b", re.sub(r"<[^>]*>|2011", "", waiting))
        page = student.begin().text
        left = float(re.search(r'data-left="([\d.]+)"', page)[1])
        assert left == pytest.approx(60 * minutes, abs=20)


def test_nobody_begins_before_or_after(opened):
    exam = opened(window(-5, 30))
    ada = exam.student(ADA)
    assert "has not been opened yet" in ada.enter().text
    assert ada.begin().url.path == "/seat"
    exam.later = 31 * 60
    assert "you did not begin it" in ada.get("/seat").text
    assert ada.begin().url.path == "/seat"
    rahima = exam.student(RAHIMA)  # who has a quarter of an hour more
    rahima.enter()
    assert rahima.begin().url.path.startswith("/exam/")


def test_an_answer_after_the_end_is_refused_and_what_was_saved_is_handed_in(opened, monkeypatch):
    exam = opened(window(0, 30))
    ada, at = exam.begun(ADA)
    [sitting] = [one.sitting for one in exam.room.store.seats.list_seats() if one.sitting]
    ends = sitting.ends
    monkeypatch.setattr(exam.room.store.clock, "now", lambda: ends + 2)
    exam.store()  # takes nothing in yet: an answer may be on its way
    assert ada.save(at, p1=["1", "2"]) == 200
    monkeypatch.setattr(exam.room.store.clock, "now", lambda: ends + 20)
    assert ada.save(at, p1=["3", "4"]) == 409
    exam.store()
    assert exam.form(ADA)["answers"] == {"1": "1; 2"} or "1" in exam.form(ADA)["answers"]["1"]
    assert exam.form(ADA)["minutes"] == pytest.approx((ends - sitting.begun) / 60, abs=0.051)
    assert "The time was over" in ada.get(at).text
    with (exam.folder.path / RECORD).open(encoding="utf-8", newline="") as stream:
        assert ["clock", ADA.id, "handed in"] in [row[1:4] for row in csv.reader(stream)]


def test_who_watches_gives_time_pauses_and_takes_in(opened):
    exam = opened(window(0, 30))
    teacher, (ada, at) = exam.watcher(), exam.begun(ADA)
    here = f"/live/{exam.number(ADA)}"
    tag = re.search(r"/seat/state\?tag=(\w+)", ada.page)[1]
    assert ada.get(f"/seat/state?tag={tag}").status_code == 204
    teacher.get(here)
    assert teacher.post(here, do="withhold").status_code == 400, "that is for the whole class"
    teacher.get(here)
    teacher.post(here, do="extend", minutes="7")
    assert ada.browser.get(f"/seat/state?tag={tag}").headers["hx-refresh"] == "true"
    left = float(re.search(r'data-left="([\d.]+)"', ada.get(at).text)[1])
    assert left == pytest.approx(37 * 60, abs=20)
    ada_token = ada.token
    teacher.post(here, do="pause")
    assert "stopped the exam" in ada.get(at).text
    assert "go-on" not in ada.page
    ada.browser.post(at, data={"token": ada_token, "do": "go-on"})
    assert "stopped the exam" in ada.get(at).text, "only who watches lets it go on"
    ada.page = f'name="token" value="{ada_token}"'
    assert ada.save(at, p1=["1", "2"]) == 409
    exam.later = 20 * 60
    teacher.post(here, do="go-on")
    left = float(re.search(r'data-left="([\d.]+)"', ada.get(at).text)[1])
    assert left == pytest.approx(37 * 60, abs=20), "the clock stood still"
    assert ada.save(at, p1=["1", "2"]) == 200
    assert "Tick the box" in teacher.post(here, do="hand-in").text
    teacher.post(here, do="hand-in", sure="1")
    assert "You have handed in" in ada.get(at).text
    exam.store()
    first = exam.form(ADA)
    teacher.get(here)
    teacher.post(here, do="reopen", sure="1", minutes="10")
    assert ada.get("/seat").url.path == at
    assert ada.save(at, p1=["5", "6"]) == 200
    ada.post(at, do="hand-in")
    exam.store()
    assert exam.form(ADA)["answers"] != first["answers"]


def test_a_pause_for_everybody_lets_nobody_begin(opened):
    exam = opened(OPEN)
    teacher, _, joerg = exam.watcher(), exam.begun(ADA), exam.student(JOERG)
    joerg.enter()
    teacher.get("/live")
    teacher.post("/live", do="pause")
    assert joerg.begin().url.path == "/seat"
    teacher.get("/live")
    assert "everything is paused" in teacher.page
    teacher.post("/live", do="go-on")
    assert joerg.begin().url.path.startswith("/exam/")


def test_blank_paper_was_handed_in_by_somebody_who_was_there(opened):
    exam = opened(OPEN)
    ada, at = exam.begun(ADA)
    ada.post(at, do="hand-in")
    exam.store()
    assert read_statuses(exam.folder.path)[ADA.id].status == "present"
    assert grade_class(exam.folder, InlineExecutor(), 1).problems == ()


def test_a_server_that_was_killed_goes_on_where_it_was(opened, tmp_path, monkeypatch):
    exam = opened(window(0, 30))
    ada, at = exam.begun(ADA)
    assert ada.save(at, p1=["1", "2"]) == 200
    joerg, there = exam.begun(JOERG)
    joerg.post(there, do="hand-in")
    assert not (exam.folder.path / "answers").exists(), "killed before it was written"
    after = opened(folder=exam.folder)
    for student in (ada, joerg):
        cookies = student.browser.cookies
        student.browser = TestClient(after.app, ADDRESS, cookies=cookies)
    page = ada.get(at).text
    assert 'value="1"' in page
    assert float(re.search(r'data-left="([\d.]+)"', page)[1]) < 30 * 60
    after.store()
    assert after.form(JOERG)["student"]["matriculation"] == JOERG.id
    assert "You have handed in" in joerg.get("/seat").text


def test_what_to_look_at_outlives_the_server(opened):
    exam = opened(OPEN)
    exam.begun(ADA)
    elsewhere = exam.student(ADA, client="10.0.0.99")
    assert elsewhere.enter().status_code == 403
    after = opened(folder=exam.folder)
    watcher = after.watcher("Weber 2")
    page = watcher.get(f"/live/{after.number(ADA)}").text
    assert "10.0.0.99" in page
    assert page.count("10.0.0.99") == 1
    with (exam.folder.path / RECORD).open(encoding="utf-8") as stream:
        said = [(row["student"], row["more"]) for row in csv.DictReader(stream)
                if row["what"] == "code tried again"]  # fmt: skip
    assert said == [(ADA.id, "10.0.0.99")]


def test_papers_that_were_made_outlive_a_changed_bank(opened, monkeypatch):
    exam = opened(OPEN)
    _, at = exam.begun(ADA)
    settings = msgspec.structs.replace(exam.folder.settings, digest="of other templates")
    exam.folder.path.joinpath("class.toml").write_bytes(format_settings(settings))
    after = opened(folder=ClassFolder(exam.folder.path))
    joerg = after.student(JOERG)
    assert joerg.enter().url.path == "/seat"
    assert joerg.begin().url.path not in {"/seat", at}
    (exam.folder.path / DATABASE).unlink()
    with pytest.raises(ClassError, match="with other templates"):
        create_app(exam_settings(ClassFolder(exam.folder.path)))


def test_a_database_of_another_class_is_refused(opened, tmp_path):
    exam = opened()
    other = make_class(tmp_path / "other")
    other.path.joinpath("class.toml").write_bytes(
        format_settings(msgspec.structs.replace(other.settings, secret="5" * 32))
    )
    settings = replace(exam_settings(exam.folder), class_exam=other.path, workers=1)
    with pytest.raises(ClassError, match="of another class"):
        create_app(settings)


@pytest.mark.parametrize(
    ("about", "wrong"),
    [("[browser]\nbegins = 2027-02-12T10:00:00\nends = 2027-02-12T09:00:00", "before it begins"),
     ("[browser]\nminutes = 0", "browser.minutes"),
     ('[browser]\nconfig_keys = ["abc"]', "64 hexadecimal digits"),
     ('[browser]\nquit_password = "x"', "quit_password: is for safe_exam_browser"),
     ("[browser]\nstarts = 2027-02-12T10:00:00", "starts")],
)  # fmt: skip
def test_what_cannot_be_meant_is_named_with_its_file(tmp_path, about, wrong):
    (tmp_path / "exam.toml").write_text(about, encoding="utf-8")
    with pytest.raises(ClassError, match=rf"exam\.toml: .*{wrong}"):
        read_exam_details(tmp_path / "exam.toml")


def test_codes_are_read_as_people_type_them():
    code = entry_code("5" * 32, "4711001", 0)
    assert re.fullmatch("[0-9A-HJKMNP-TV-Z]{5}-[0-9A-HJKMNP-TV-Z]{5}", code)
    assert normalise_entry_code(f" {code.lower().replace('-', '')} ") == code
    assert normalise_entry_code("OIL00-11111") == "01100-11111"
    assert normalise_entry_code("short") == ""
    codes = {entry_code("5" * 32, str(n), issue) for n in range(300) for issue in range(3)}
    assert len(codes) == 900


def test_cards_have_every_code_and_the_address(tmp_path):
    pikepdf = pytest.importorskip("pikepdf")
    folder = make_class(tmp_path)
    (path,) = write_admission_files(folder, "https://exam.school.example", "en")
    with pikepdf.open(path) as found:
        assert len(found.pages) == 1
    assert path.stat().st_mode & 0o077 == 0
    wrong = ["class", "admit", str(folder.path), "--address", "exam.school.example"]
    done = CliRunner().invoke(root_group, wrong)
    assert done.exit_code == 2
    assert "begins with http" in done.output


SEB = OPEN + 'safe_exam_browser = true\nquit_password = "let me out"\n'


def seb_settings() -> str:
    """The settings as the page on Config Keys of the makers of the browser writes them: JSON, by hand."""
    password = hashlib.sha256(b"let me out").hexdigest()
    return (
        '{"allowBrowsingBackForward":false,"allowQuit":true,"allowSpellCheck":false,'
        '"browserWindowAllowReload":true,"examSessionClearCookiesOnEnd":true,'
        f'"examSessionClearCookiesOnStart":true,"hashedQuitPassword":"{password}",'
        f'"quitURL":"{ADDRESS}/seat/end","quitURLConfirm":false,"sebConfigPurpose":0,'
        '"sendBrowserExamKey":true,"showReloadButton":true,"showTime":true,'
        f'"startURL":"{ADDRESS}/"}}'
    )


def test_the_settings_file_lets_in_whom_it_locks_in(opened, tmp_path):
    folder = make_class(tmp_path, SEB)
    with pytest.raises(ClassError, match=r"exam\.seb: is not there yet"):
        create_app(exam_settings(folder))
    _, path = write_admission_files(folder, ADDRESS, "en")
    assert path.stat().st_mode & 0o077 == 0
    exam = opened(folder=folder)
    ada = exam.student(ADA)
    page = ada.browser.get("/")
    assert page.status_code == 403
    assert 'href="seb://' in page.text
    assert plistlib.loads(ada.browser.get("/exam.seb").content)["startURL"] == f"{ADDRESS}/"
    key = hashlib.sha256(seb_settings().encode()).hexdigest()

    def proof(place: str) -> dict[str, str]:
        hashed = hashlib.sha256(f"{ADDRESS}{place}{key}".encode()).hexdigest()
        return {"x-safeexambrowser-configkeyhash": hashed}

    assert "The code on your card" in ada.browser.get("/", headers=proof("/")).text
    assert ada.browser.get("/seat", headers=proof("/")).status_code == 403, "of another address"
    assert ada.browser.post("/", headers=proof("/live")).status_code == 403
    exam.watcher().get("/live")  # in any browser


def test_an_unlocked_settings_file_has_another_key(tmp_path):
    folder = make_class(tmp_path, SEB)
    _, path = write_admission_files(folder, ADDRESS, "en")
    before = read_config_key(path)
    path.write_bytes(path.read_bytes().replace(b"<false/>", b"<true/>", 1))
    assert read_config_key(path) != before
    path.write_bytes(b"pswd" + path.read_bytes())
    with pytest.raises(ClassError, match="changed by another program"):
        read_config_key(path)


def test_without_the_browser_there_is_no_settings_file(opened):
    assert opened(OPEN).student(ADA).browser.get("/exam.seb").status_code == 404
