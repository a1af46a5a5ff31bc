"""A class of two questions that sits its exam on a server in this process."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from people import ADDRESS, Somebody
from starlette.testclient import TestClient

from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.roster import RosterStudent
from quizgen.classes.seats import DATABASE
from quizgen.web.settings import ServerSettings

sys.path.insert(0, str(Path(__file__).parents[1] / "classes"))
import small

ADA, RAHIMA, JOERG = STUDENTS = [
    RosterStudent("4711001", "Ada Lovelace"),
    RosterStudent("4711002", "রহিমা খাতুন", "both", "25%"),
    RosterStudent("4711003", "Jörg Müller", extra="30"),
]


def make_class(root: Path, about: str = "") -> ClassFolder:
    """A class with papers; ``about`` is its ``exam.toml``."""
    root.mkdir(parents=True, exist_ok=True)
    folder, plan = small.begun(root, STUDENTS)
    small.with_papers(folder, plan, STUDENTS)
    if about:
        (folder.path / "exam.toml").write_text(about, encoding="utf-8")
    return folder


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
