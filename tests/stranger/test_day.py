"""A stranger's day: a wheel in an empty environment, and the commands of the documents, in order."""

from __future__ import annotations

import http.cookiejar
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tomllib
import urllib.parse
import urllib.request
import zipfile
from pathlib import Path

import pytest
from consoles import PAGES
from lxml import html
from needed import without

ROOT = Path(__file__).parents[2]
DOCUMENTS = "\n".join(page.read_text("utf-8") for page in PAGES)
pytestmark = pytest.mark.slow


class Stranger:
    """Somebody with an empty folder and an installed quizgen, who types what the pages say."""

    def __init__(self, folder: Path, wheel: Path, uv: str) -> None:
        self.folder, venv = folder, folder / "venv"
        pins = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
        constraints = folder / "constraints.txt"
        constraints.write_text("\n".join(pins["tool"]["uv"]["constraint-dependencies"]), "utf-8")
        programs = venv / ("Scripts" if os.name == "nt" else "bin")
        python = str(programs / "python")
        for command in (
            ["venv", "--quiet", "--python", sys.executable, str(venv)],
            ["pip", "install", "--quiet", "--python", python, "--constraint", str(constraints),
             f"{wheel}[web,class]"],
        ):  # fmt: skip
            subprocess.run([uv, *command], check=True)
        self.program = str(programs / "quizgen")
        self.environment = {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("UV", "PYTHON", "VIRTUAL_ENV", "XDG"))
        } | {"XDG_DATA_HOME": str(folder / "data"), "XDG_CACHE_HOME": str(folder / "cache")}

    def types(self, command: str, *statuses: int) -> str:
        """Type a command of the documents; return what it prints."""
        assert f"quizgen {command}" in DOCUMENTS, command
        done = subprocess.run(
            [self.program, *command.split()], cwd=self.folder, env=self.environment,
            capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False,
        )  # fmt: skip
        assert done.returncode in (statuses or (0,)), f"{command}\n{done.stdout}{done.stderr}"
        assert "Traceback" not in done.stderr
        return done.stdout


@pytest.fixture(scope="module")
def stranger(tmp_path_factory):
    uv = shutil.which("uv") or without("uv is not installed")
    folder = tmp_path_factory.mktemp("stranger")
    subprocess.run([uv, "build", "--quiet", "--wheel", "--out-dir", str(folder / "dist")],
                   check=True, cwd=ROOT)  # fmt: skip
    wheel = next((folder / "dist").glob("*.whl"))
    assert wheel.stat().st_size <= 6_000_000
    return Stranger(folder, wheel, uv)


def test_a_paper_is_made_and_marked(stranger):
    stranger.types("exam --blueprint trial --out tonight")
    made = {path.name for path in (stranger.folder / "tonight").iterdir()}
    assert {"exam.pdf", "exam.html", "solutions.pdf", "answers.toml", "key.json"} <= made
    form = stranger.folder / "tonight" / "answers.toml"
    assert "Total: 0 / 10" in stranger.types("check tonight/key.json tonight/answers.toml")
    key = json.loads((stranger.folder / "tonight" / "key.json").read_text("utf-8"))
    assert key["code"].startswith("trial-")
    text = form.read_text("utf-8")
    form.write_text(re.sub(r'= ""', '= "(1; 2)"', text), "utf-8")
    said = stranger.types("check tonight/key.json tonight/answers.toml")
    assert "Total: 0 / 10" not in said or "blank" not in said


class Browser:
    """Follows links and sends forms, and runs no script."""

    def __init__(self) -> None:
        jar = urllib.request.HTTPCookieProcessor(http.cookiejar.CookieJar())
        self._open = urllib.request.build_opener(jar).open

    def get(self, address: str):
        """The page at an address."""
        with self._open(address, timeout=60) as answer:
            return html.fromstring(answer.read(), base_url=answer.url)

    def send(self, page, action: str, *fields: tuple[str, str]):
        """Send the first form of a page whose address ends so."""
        form = next(f for f in page.forms if re.search(action, f.action or ""))
        changed = {name for name, _value in fields}
        data = [(name, value) for name, value in form.form_values() if name not in changed]
        address = urllib.parse.urljoin(page.base_url, form.action)
        body = urllib.parse.urlencode([*data, *fields]).encode()
        with self._open(address, body, timeout=60) as answer:
            return html.fromstring(answer.read(), base_url=answer.url)


def test_the_browser_leads_to_a_verdict_in_two_taps(stranger):
    assert "uv run quizgen serve" in DOCUMENTS
    with subprocess.Popen(
        [stranger.program, "serve", "--no-open", "--port", "0"], cwd=stranger.folder,
        env=stranger.environment, text=True, stdout=subprocess.PIPE, start_new_session=True,
    ) as server:  # fmt: skip
        try:
            browser = Browser()
            page = browser.get(server.stdout.readline().split()[-1])
            page = browser.send(page, "/start$", ("days", "1"), ("minutes", "25"))
            field = page.xpath("//form//*[@name='a' or starts-with(@name, 'a')]/@name")[0]
            page = browser.send(page, r"/q/[\w-]+/\d+$", (field, "1"), ("do", "answer"))
            said = page.xpath("//*[starts-with(@id, 'verdict-')]")
            assert said
            assert said[0].text_content().strip()
        finally:
            os.killpg(server.pid, signal.SIGINT)


def test_a_class_of_three_goes_from_roster_to_grades(stranger):
    (stranger.folder / "roster.csv").write_text("id,name\n1,Ada\n2,Emmy\n3,Rumana\n", "utf-8")
    stranger.types("class make roster.csv --out midterm")
    midterm = stranger.folder / "midterm"
    assert {path.stem for path in (midterm / "papers").glob("*.pdf")} == {"1", "2", "3"}
    (midterm / "answers").mkdir()
    for form in (midterm / "forms").glob("*.toml"):
        head, answers = form.read_text("utf-8").split("[answers]")
        filled = answers.replace('= ""', '= "1"', 5)
        (midterm / "answers" / form.name).write_text(f"{head}[answers]{filled}", "utf-8")
    assert "3 students marked" in stranger.types("class mark midterm", 0, 1)
    stranger.types("class grade midterm", 0, 1)  # 1: what a person has to decide waits
    assert list((midterm / "results").glob("grades*"))


def test_a_question_of_ones_own_is_written_proved_and_printed(stranger):
    stranger.types("new bank physics")
    stranger.types("preview travel-time --bank physics --trust")
    stranger.types("new template example/base-units --choice --bank physics")
    stranger.types("lint --bank physics --trust")
    command = "exam --bank physics --trust --topic example --seed 1 --out physics-paper"
    stranger.types(command)
    assert (stranger.folder / "physics-paper" / "exam.pdf").read_bytes()[:4] == b"%PDF"


def test_cards_and_an_lms_package_are_exported(stranger):
    stranger.types("cards --lang both")
    deck = stranger.folder / "cards" / "quizgen.apkg"
    assert "collection.anki2" in " ".join(zipfile.ZipFile(deck).namelist())
    stranger.types("export moodle --topic optics --variants 5 --out week3/optics.xml")
    assert (stranger.folder / "week3" / "optics.xml").read_text("utf-8").startswith("<?xml")


def test_what_is_missing_says_what_to_type(stranger):
    done = subprocess.run(
        [stranger.program, "serve", "--database", "postgresql+psycopg://nowhere/x", "--no-open"],
        cwd=stranger.folder, env=stranger.environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert 'pip install "quizgen[postgres]"' in done.stderr


def test_one_answer_is_marked_as_the_page_says(stranger):
    spec, typed = '{kind="number", value="20/3", decimals=3}', "6,67"
    assert f"quizgen mark '{spec}' '{typed}'" in DOCUMENTS
    done = subprocess.run(
        [stranger.program, "mark", spec, typed], cwd=stranger.folder, env=stranger.environment,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["read_as"] == "6.67"
