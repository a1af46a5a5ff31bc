"""What authors see, of a bank of their own."""

from __future__ import annotations

import re
import shutil

import html5lib
import pytest
from own_bank import NAME
from starlette.testclient import TestClient

from quizgen.bank.bank import Bank
from quizgen.bank.combined import open_banks
from quizgen.cli.lint import lint_while_writing
from quizgen.web.app import create_app
from quizgen.web.author import bank_stamp
from quizgen.web.settings import ServerSettings


@pytest.fixture(scope="module")
def author(root, database):
    settings = ServerSettings(
        database(), Bank(root, trusted=True), workers=1, examine=lint_while_writing
    )
    app = create_app(settings)
    with TestClient(app, "http://127.0.0.1:8000") as client:
        client.get(f"/enter?key={app.state.site.settings.token}")
        yield client


def test_learners_have_no_such_page(client):
    assert client.get("/author").status_code == 404
    assert client.get(f"/author/{NAME}").status_code == 404


def test_the_menu_has_the_camera_only_where_its_chapter_is(author, client):
    for chapter in ('href="/camera"', 'href="/tradeoff"'):
        assert chapter in client.get("/").text
        assert chapter not in author.get("/").text


def test_a_template_stands_with_its_solution_in_both_languages(author):
    assert f'href="/author/{NAME}"' in author.get("/author").text
    page = author.get(f"/author/{NAME}?seed=3").text
    assert re.findall('<section class="pair" lang="(..)"', page) == ["en", "bn"]
    assert page.count('class="steps"') == 2
    assert page.count("<details open><summary>Common mistakes") == 2
    other = author.get(f"/author/{NAME}?seed=4").text
    stems = [re.search(r'<div class="stem">.*?</div>', one, re.DOTALL)[0] for one in (page, other)]
    assert stems[0] != stems[1]


@pytest.mark.browser
def test_the_page_of_a_template_in_a_browser(browser, database, root, barriers):
    from playwright.sync_api import expect
    from served import Served

    server = Served(database(), "--bank", str(root), "--trust", "--author")
    context = browser.new_context(viewport={"width": 390, "height": 800})
    try:
        page = context.new_page()
        page.goto(server.entrance)
        page.goto(f"{server.address}/author/{NAME}")
        expect(page.locator("#found")).to_contain_text("Nothing to mend")
        assert barriers(page) == []
        prose = root / "templates" / "projection" / NAME / "en.md"
        told = prose.read_text("utf-8")
        prose.write_text(told.replace("# ", "# Anew: ", 1), "utf-8")
        expect(page.locator("#title-en")).to_contain_text("Anew: ")
        prose.write_text(told, "utf-8")
        expect(page.locator("#title-en")).not_to_contain_text("Anew: ")
        page.evaluate("window.same = true")
        stem = page.locator(".stem").first
        before = stem.inner_text()
        page.locator("#slide").focus()
        page.keyboard.press("ArrowRight")
        expect(page.locator("#seed")).to_have_value("1")
        expect(stem).not_to_have_text(before)
        expect(page.locator("#slide")).to_be_focused()
        page.locator("#seed").fill("7")
        page.locator("#seed").press("Tab")
        expect(page.locator("#slide")).to_have_value("7")
        page.set_viewport_size({"width": 1600, "height": 900})
        sides = [side.bounding_box() for side in page.locator(".side").all()[:2]]
        assert sides[0]["width"] == sides[1]["width"]
        assert (
            sum(side["width"] for side in sides)
            > 0.9 * page.locator(".pair").first.bounding_box()["width"]
        )
        assert page.evaluate("window.same"), "without another page"
    finally:
        context.close()
        server.kill()


@pytest.mark.parametrize("path", ["", f"/{NAME}", f"/{NAME}/lint"])
def test_its_pages_are_valid(author, path):
    html5lib.HTMLParser(strict=True).parse(author.get(f"/author{path}").text)


def test_a_template_that_is_not_there_has_no_page(author):
    assert author.get("/author/nowhere").status_code == 404
    assert author.get("/author/nowhere/lint").status_code == 404


def test_what_is_saved_is_shown_and_nothing_else_is_sent(author, root):
    page = author.get(f"/author/{NAME}").text
    stamp = re.search(r"stamp=(\w+)", page)[1]
    assert author.get(f"/author/{NAME}?stamp={stamp}").status_code == 204
    prose = root / "templates" / "projection" / NAME / "en.md"
    told = prose.read_text("utf-8")
    prose.write_text(told.replace("# ", "# Anew: ", 1), "utf-8")
    assert "Anew: " in author.get(f"/author/{NAME}?stamp={stamp}").text
    prose.write_text(told + "\n## nonsense\n", "utf-8")
    broken = author.get(f"/author/{NAME}")
    assert broken.status_code == 200
    assert "cannot be shown" in broken.text
    assert "en.md" in broken.text
    prose.write_text(told, "utf-8")
    assert "cannot be shown" not in author.get(f"/author/{NAME}").text


def test_a_solver_that_is_saved_is_read_again(author, root):
    before = author.get(f"/author/{NAME}").text
    solver = root / "solvers" / "projection" / "perspective.py"
    source = solver.read_text("utf-8")
    solver.write_text(source + "\nraise ValueError('half written')\n", "utf-8")
    assert "half written" in author.get(f"/author/{NAME}").text
    solver.write_text(source + "\n", "utf-8")
    after = author.get(f"/author/{NAME}").text
    assert re.findall('class="result".*', before) == re.findall('class="result".*', after)


def test_lint_says_what_is_wrong(author, root):
    assert "Nothing to mend" in author.get(f"/author/{NAME}/lint").text
    (bangla := root / "templates" / "projection" / NAME / "bn.md").write_text(
        re.sub(r"## check\n.*?(?=\n## )", "", bangla.read_text("utf-8"), flags=re.DOTALL), "utf-8"
    )
    assert "bn.md" in author.get(f"/author/{NAME}/lint").text


def test_a_template_that_cannot_be_read_hides_no_other(author, root):
    there = root / "templates" / "projection"
    other = there / "new"
    other.mkdir()
    (other / "template.toml").write_text('teir = "A"\n', "utf-8")
    try:
        page = author.get("/author")
        assert page.status_code == 200
        assert re.search(r"templates/projection/new/template\.toml:\d+: .*teir", page.text)
        assert f'href="/author/{NAME}"' in page.text
    finally:
        (other / "template.toml").unlink()
        other.rmdir()


def test_authors_are_told_what_is_wrong_with_their_bank(author, root):
    about = root / "templates" / "bank.toml"
    about.write_text('nmae = "x"\n', "utf-8")
    try:
        page = author.get("/author")
        assert page.status_code == 500
        assert re.search(r"<pre>.*bank\.toml:\d+: unknown key .*nmae", page.text)
    finally:
        about.unlink()


FIGURE = """
from quizgen.figures.kit import Parameter, load_alt_words

PARAMETERS = {"f": Parameter("", "focal length")}


def draw(fig, values, *, quiz):
    fig.sketch().line([(20, 20), (60, 30)])


def alt(values, lang, *, quiz):
    return load_alt_words(__file__, lang)["said"]
"""


def test_a_figure_that_is_saved_is_drawn_anew_and_told_in_its_new_words(author, root):
    rules, folder = root / "templates" / "projection" / NAME / "template.toml", root / "templates"
    before, told = rules.read_text("utf-8"), bank_stamp(Bank(root))
    figure, words = (folder / "figures" / name for name in ("own.py", "en.toml"))
    figure.parent.mkdir()
    try:
        figure.write_text(FIGURE, "utf-8")
        assert bank_stamp(Bank(root)) != told
        words.write_text('[own]\nsaid = "A small seven."\n', "utf-8")
        rules.write_text(
            re.sub(
                r"\[figure\]\n.*\n.*\n", '[figure]\nname = "own"\nvalues = { f = "f" }\n', before
            )
        )
        first = author.get(f"/author/{NAME}").text
        assert "A small seven." in first
        figure.write_text(FIGURE.replace("(20, 20)", "(20, 40)"), "utf-8")
        words.write_text('[own]\nsaid = "A seven."\n', "utf-8")
        again = author.get(f"/author/{NAME}").text
        assert "A seven." in again
        assert "A small seven." not in again
        drawings = [set(re.findall(r'<path d="M[^"]*"', page)) for page in (first, again)]
        assert drawings[0]
        assert not drawings[0] & drawings[1]
    finally:
        shutil.rmtree(figure.parent)
        rules.write_text(before, "utf-8")


def test_authors_of_one_bank_among_others(root, database, jobs_in_this_process):
    mixed = open_banks([("", True), (str(root), True)])
    app = create_app(ServerSettings(database(), mixed, workers=1, examine=lint_while_writing))
    with TestClient(app, "http://127.0.0.1:8000") as client:
        client.get(f"/enter?key={app.state.site.settings.token}")
        name = f"{root.name}:{NAME}"
        assert f'href="/author/{name}"' in client.get("/author").text
        assert 'class="steps"' in client.get(f"/author/{name}").text
        assert 'id="found"' in client.get(f"/author/{name}/lint").text
        token = re.search(r'name="token" value="([^"]+)"', client.get("/").text)[1]
        asked = client.post("/practice", data={"token": token, "template": name})
        assert f"Question bank: {root.name} (" in asked.text
