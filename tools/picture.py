"""The pictures of the documents: home, a question, a paper, the marking page.

Needs Chromium and ``pdftoppm``.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Page, Playwright, sync_playwright

import quizgen
from quizgen.paper.blueprint import load_blueprint
from quizgen.store import OutcomeRecord, QuestionRef, Store

DOCS = Path(__file__).parent.parent / "docs"
QUESTION = QuestionRef("point-to-image-plane", "3")
TYPED = ("20", "16")
"""A known mistake, so that the picture shows it named."""
ITEM = "blur-and-light-factors/b"
BLUEPRINT = """
[title]
en = "Sentences"
[[slot]]
templates = ["blur-and-light-factors"]
"""
HAND = """The cone begins as wide as the aperture,
so with f/2 the disc on the sensor is larger.
More points get a disc that one can see."""
"""What stands on a student's sheet."""
PAPER = ("exam", "--blueprint", "trial", "--seed", "3", "--lang", "en", "--format", "pdf")


def main() -> None:
    """Take all pictures, from a new database and an empty folder."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        photograph_paper(folder)
        database = f"sqlite:///{folder / 'learning.sqlite3'}"
        store = Store(database)
        learner = store.learner().id
        attempt = store.start_attempt(learner, QUESTION, {})
        other = store.start_attempt(learner, QUESTION, {})
        store.save_attempt(other, list_outcomes())
        store.close()
        with serve("--database", database) as entrance:
            photograph_pages(entrance, f"/q/{attempt.id}")
        photograph_marking(folder)
    for picture in ("home.png", "serve.png", "paper.png", "marking.png"):
        print(f"{picture}: {(DOCS / picture).stat().st_size // 1000} kB")


def photograph_marking(folder: Path) -> None:
    """Save the marking page of a class of one, whose sentence stands on paper."""
    (folder / "one.toml").write_text(BLUEPRINT, "utf-8")
    (folder / "roster.csv").write_text("id,name\n4711001,Ada\n", "utf-8")
    room = folder / "midterm"
    wished = ("--blueprint", str(folder / "one.toml"), "--out", str(room))
    _type("class", "make", str(folder / "roster.csv"), *wished)
    about = json.loads((room / "keys.jsonl").read_text("utf-8"))
    (room / "answers").mkdir()
    answers = {"code": about["code"], "answers": {"1a": "2"}}
    (room / "answers" / "4711001.json").write_text(json.dumps(answers), "utf-8")
    (room / "scans" / about["code"]).mkdir(parents=True)
    draw_handwriting(room / "scans" / about["code"] / "1b.png")
    _type("class", "mark", str(room), allowed=(0, 1))
    more = ("--class", str(room), "--database", f"sqlite:///{folder / 'marking.sqlite3'}")
    with serve(*more) as entrance, sync_playwright() as driver:
        page = open_page(driver, 860)
        page.goto(entrance)
        home = page.url.rstrip("/")
        page.goto(f"{home}/marking")
        page.fill("[name=who]", "AM")
        page.press("[name=who]", "Enter")
        page.wait_for_load_state()
        page.goto(f"{home}/marking/answer?item={ITEM}")
        page.locator("#decide").wait_for()
        page.keyboard.press("1")
        page.screenshot(path=DOCS / "marking.png")


def draw_handwriting(file: Path) -> None:
    """Save a picture of unsteady lines and letters, as a scanner gives it."""
    import matplotlib.pyplot as plt

    with plt.xkcd(scale=1.2, length=60, randomness=3):
        plt.rcParams["font.family"] = "DejaVu Sans"
        figure = plt.figure(figsize=(8, 3), facecolor="#f7f5ef")
        figure.text(0.04, 0.34, HAND, fontsize=21, color="#34508a", linespacing=1.7, style="italic")
        lens = figure.add_axes((0.62, 0.04, 0.3, 0.26))
        lens.plot([0, 0, 3, 0], [-1, 1, 0, -1], color="#34508a")
        lens.plot([2.4, 2.4], [-0.5, 0.5], color="#34508a")
        lens.axis("off")
        figure.savefig(file, dpi=120)
        plt.close(figure)


def _type(*words: str, allowed: tuple[int, ...] = (0,)) -> None:
    """Type a command; it must end with one of the exit codes."""
    done = subprocess.run(
        [sys.executable, "-m", "quizgen", *words], check=False, capture_output=True, text=True
    )
    if done.returncode not in allowed:
        raise SystemExit(done.stdout + done.stderr)


@contextmanager
def serve(*options: str) -> Iterator[str]:
    """Start a server and yield the address that signs in."""
    with subprocess.Popen(
        [sys.executable, "-m", "quizgen", "serve", "--no-open", *options],
        stdout=subprocess.PIPE,
        text=True,
    ) as server:
        try:
            yield (server.stdout.readline() if server.stdout else "").split()[-1]
        finally:
            server.terminate()


def open_page(driver: Playwright, height: int) -> Page:
    """Return a page of Chromium that is 1200 wide."""
    browser = driver.chromium.launch(
        executable_path=shutil.which("chromium"), args=["--no-sandbox"]
    )
    return browser.new_page(viewport={"width": 1200, "height": height})


def list_outcomes() -> tuple[OutcomeRecord, ...]:
    """An evening so far: every third part of two rounds on the trial exam went wrong."""
    bank = quizgen.builtin_bank()
    names = [slot.templates[0] for slot in load_blueprint("trial").slot]
    now = time.time()
    return tuple(
        OutcomeRecord(name, bank.rules(name).topic, "a", "", right, right, now - 7200 + 300 * i,
                      float(right), False, f"evening-{i}")
        for i, name in enumerate(names * 2)
        for right in [i % 3 != 1]
    )  # fmt: skip


def photograph_paper(folder: Path) -> None:
    """Save the first page of a trial exam."""
    _type(*PAPER, "--out", str(folder / "paper"))
    draw = ["pdftoppm", "-png", "-r", "60", "-singlefile", str(folder / "paper" / "exam.pdf")]
    subprocess.run([*draw, str(DOCS / "paper")], check=True)


def photograph_pages(entrance: str, question: str) -> None:
    """Save screenshots of the first page, and of the question with a wrong answer.

    ``entrance`` is the address that signs in, ``question`` the path of the question.
    """
    with sync_playwright() as driver:
        page = open_page(driver, 640)
        page.goto(entrance)
        home = page.url.rstrip("/")
        page.screenshot(path=DOCS / "home.png")
        page.goto(home + question)
        for field, value in zip(page.locator("input[type=text]").all(), TYPED, strict=True):
            field.fill(value)
        page.get_by_role("button", name="Check").click()
        page.locator(".verdict").wait_for()
        page.wait_for_timeout(500)  # the verdict fades in
        page.screenshot(path=DOCS / "serve.png")


if __name__ == "__main__":
    main()
