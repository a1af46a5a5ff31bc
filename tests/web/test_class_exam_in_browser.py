"""A class exam in Chromium: three students, one who watches, and a server that is killed meanwhile."""

from __future__ import annotations

import json

import pytest
from class_server import ADA, JOERG, RAHIMA, make_class
from people import PASSWORD
from playwright.sync_api import expect
from served import Served

from quizgen.classes.seats import DATABASE, entry_code

pytestmark = pytest.mark.browser


@pytest.fixture
def folder(tmp_path):
    return make_class(tmp_path)


@pytest.fixture
def served(folder):
    """The server of the class, which ``opened`` opens pages of."""
    server = Served(
        f"sqlite:///{folder.path / DATABASE}", "--host", "127.0.0.1",
        command=("class", "open", str(folder.path)),
    )  # fmt: skip
    yield server
    server.kill()


def test_a_class_sits_its_exam_and_nothing_is_lost(opened, served, folder, barriers):
    watching = opened()
    watching.get_by_label("Name").fill("Weber")
    watching.get_by_label("The new password once more").fill(PASSWORD)
    watching.get_by_label("Password", exact=True).or_(
        watching.get_by_label("New password", exact=True)
    ).first.fill(PASSWORD)
    watching.locator("button.main").click()
    expect(watching.get_by_role("heading", level=1)).to_contain_text("Exam")
    pages = {}
    for who in (ADA, RAHIMA, JOERG):
        page = pages[who.id] = opened()
        code = entry_code(folder.settings.secret, who.id, 0)
        page.goto(f"{served.address}/?code={code}")
        assert barriers(page) == []
        page.get_by_role("button", name="Go in").click()
        expect(page.get_by_text("has not been opened yet")).to_be_visible()
        assert barriers(page) == []
    expect(watching.get_by_text("Papers ready: 3 of 3")).to_be_visible()
    watching.get_by_role("button", name="Open the exam now").click()
    for page in pages.values():  # they change by themselves
        page.get_by_role("button", name="Begin the exam").click()
        expect(page.locator("#exam")).to_be_visible()
    ada, rahima, joerg = pages.values()
    ada.locator("#exam input[type=text]").first.fill("0.5")
    expect(ada.get_by_text("All answers are saved.")).to_be_visible()
    expect(watching.locator("tr", has_text=ADA.name)).to_contain_text("writing")
    assert barriers(watching) == []
    watching.get_by_role("link", name=JOERG.name).click()
    watching.get_by_role("button", name="Pause").click()
    expect(joerg.get_by_text("has stopped the exam")).to_be_visible()
    assert barriers(watching) == []
    watching.get_by_role("button", name="Go on").click()
    expect(joerg.locator("#exam")).to_be_visible()
    served.kill()
    rahima.locator("#exam input[type=text]").first.fill("0.25")
    expect(rahima.get_by_text("The server does not answer")).to_be_visible()
    served.start()
    expect(rahima.get_by_text("All answers are saved.")).to_be_visible(timeout=60_000)
    opened.wrong.clear()  # that it was away
    for page in (ada, rahima):
        page.goto(served.address + "/seat")
        page.locator("button[value=end]").click()
        page.get_by_role("button", name="Hand in").click()
        expect(page.get_by_text("You have handed in")).to_be_visible()
    watching.goto(served.address + "/live")
    watching.get_by_role("link", name=JOERG.name).click()
    watching.get_by_label("Take in this paper as it is").check()
    watching.get_by_role("button", name="Hand in").click()
    expect(watching.get_by_text("Done.")).to_be_visible()
    expect(joerg.get_by_text("You have handed in")).to_be_visible()
    watching.goto(served.address + "/live")
    expect(watching.get_by_text("not in the folder yet")).to_have_count(0)
    forms = {path.stem: json.loads(path.read_text("utf-8"))["answers"]
             for path in (folder.path / "answers" / "browser").iterdir()}  # fmt: skip
    assert {who: [*one.values()] for who, one in forms.items()} == {
        ADA.id: ["0.5; "], RAHIMA.id: ["0.25; "], JOERG.id: [],
    }  # fmt: skip
