"""A class of two questions that sits its exam on a server in this process."""

from __future__ import annotations

import contextlib
import json
import re
import shutil
import sys
import tempfile
from concurrent.futures import Future
from functools import cache
from pathlib import Path

import argon2
from people import ADDRESS, Somebody
from starlette.testclient import TestClient

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.roster import RosterStudent
from quizgen.classes.seats import DATABASE
from quizgen.web import job_cache, passwords
from quizgen.web.app import create_app
from quizgen.web.settings import ServerSettings

sys.path.insert(0, str(Path(__file__).parents[1] / "classes"))
import small

ADA, RAHIMA, JOERG = STUDENTS = [
    RosterStudent("4711001", "Ada Lovelace"),
    RosterStudent("4711002", "রহিমা খাতুন", "both", "25%"),
    RosterStudent("4711003", "Jörg Müller", extra="30"),
]


@cache
def _made_once() -> tempfile.TemporaryDirectory:
    """The folder of a class that others are copies of: papers take seconds."""
    place = tempfile.TemporaryDirectory()
    folder, plan = small.begun(Path(place.name), STUDENTS)
    small.with_papers(folder, plan, STUDENTS)
    return place


def make_class(root: Path, about: str = "") -> ClassFolder:
    """A class with papers; ``about`` is its ``exam.toml``."""
    shutil.copytree(Path(_made_once().name) / "class", root / "class")
    if about:
        (root / "class" / "exam.toml").write_text(about, encoding="utf-8")
    return ClassFolder(root / "class")


def exam_settings(folder: ClassFolder) -> ServerSettings:
    """Of a server on which the class sits its exam."""
    return ServerSettings(
        f"sqlite:///{folder.path / DATABASE}", host="0.0.0.0", workers=1, class_exam=folder.path
    )


class Student(Somebody):
    """A browser of a student, from an address of its own."""

    def __init__(self, app, who: RosterStudent, client: str = "") -> None:
        super().__init__(app)
        self.app, self.who = app, who
        self.browser = TestClient(app, ADDRESS, client=(client or f"10.0.0.{who.id[-1]}", 1))

    @property
    def code(self) -> str:
        room = self.app.state.site.room
        _, issue, _ = room.store.seats.list_issues()[self.who.id]
        return room.code_of(self.who.id, issue)

    def enter(self, code: str = ""):
        self.get("/")
        return self.post("/", code=code or self.code)

    def begin(self):
        return self.post("/seat/begin")

    def parts(self) -> dict[str, list[str]]:
        """The names of the fields of each part on the page of the paper."""
        names = re.findall(r'name="on-(\w+)"', self.page)
        return {name: re.findall(rf'name="a-{name}"', self.page) for name in names}

    def save(self, exam: str, **answers: str | list[str]):
        sent: dict[str, object] = {}
        for part, value in answers.items():
            name = part.removeprefix("p")
            sent |= {f"on-{name}": "", f"a-{name}": value}
        answer = self.browser.post(
            exam, data={"token": self.token, **sent}, headers={"accept": "application/json"}
        )
        return answer.status_code


class InlinePool:
    """In place of worker processes: what is asked for is made at once, in this one."""

    def __init__(self, _count: int, prepare, given, **_more) -> None:
        self.processes: list = []
        prepare(*given)

    def submit(self, work, *given) -> Future:
        done: Future = Future()
        try:
            done.set_result(work(*given))
        except Exception as error:  # noqa: BLE001 - raised again by who asked
            done.set_exception(error)
        return done

    def start_all(self) -> None: ...

    def stop(self) -> None: ...


class Exam:
    """A server on which a class sits its exam, and its clock, which a test sets on."""

    def __init__(self, folder, monkeypatch) -> None:
        monkeypatch.setattr(job_cache, "ProcessExecutor", InlinePool)
        self.folder, self.later = folder, 0.0
        self.app = create_app(exam_settings(folder))
        self.room = self.app.state.site.room
        steady = self.room.store.clock.now
        monkeypatch.setattr(self.room.store.clock, "now", lambda: steady() + self.later)
        self.loop = TestClient(self.app, ADDRESS)

    def __enter__(self):
        self.loop.__enter__()
        self.loop.portal.call(self.room.make_all_papers)
        return self

    def __exit__(self, *how) -> None:
        self.loop.__exit__(*how)

    def store(self) -> None:
        """What the server does every few seconds."""
        self.loop.portal.call(self.room.close_and_store)

    def watcher(self, name: str = "Weber") -> Somebody:
        found = Somebody(self.app)
        key = self.room.store.accounts.invite(manages=True)
        found.join(f"/invited?key={key}", name)
        return found

    def student(self, who, client: str = "") -> Student:
        return Student(self.app, who, client)

    def begun(self, who) -> tuple[Student, str]:
        """A student who has begun, and where the paper is."""
        student = self.student(who)
        student.enter()
        return student, student.begin().url.path

    def number(self, who) -> int:
        return self.room.store.seats.list_issues()[who.id][0]

    def form(self, who) -> dict:
        return json.loads((self.folder.path / f"answers/browser/{who.id}.json").read_text("utf-8"))


@contextlib.contextmanager
def exams(folder_of, monkeypatch):
    """Gives what opens exams of classes, which end with the block; passwords take no time."""
    cheap = argon2.PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    monkeypatch.setattr(passwords, "_make_hasher", lambda: cheap)
    with contextlib.ExitStack() as running:
        yield lambda about="", folder=None: running.enter_context(
            Exam(folder or folder_of(about), monkeypatch)
        )


OPEN = "[browser]\nbegins = 2020-01-01T10:00:00\n"
