"""The pictures of the README: home, a question, a paper; needs Chromium and ``pdftoppm``."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

import quizgen
from quizgen.paper.blueprint import load_blueprint
from quizgen.store import OutcomeRecord, QuestionRef, Store

DOCS = Path(__file__).parent.parent / "docs"
QUESTION = QuestionRef("point-to-image-plane", "3")
TYPED = ("20", "16")
"""A known mistake, so that the picture shows it named."""
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
        server = subprocess.Popen(
            [sys.executable, "-m", "quizgen", "serve", "--no-open", "--database", database],
            stdout=subprocess.PIPE,
            text=True,
        )
        try:
            entrance = (server.stdout.readline() if server.stdout else "").split()[-1]
            photograph_pages(entrance, f"/q/{attempt.id}")
        finally:
            server.terminate()
            server.wait()
    for picture in ("home.png", "serve.png", "paper.png"):
        print(f"{picture}: {(DOCS / picture).stat().st_size // 1000} kB")


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
    command = [sys.executable, "-m", "quizgen", *PAPER, "--out", str(folder / "paper")]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    draw = ["pdftoppm", "-png", "-r", "60", "-singlefile", str(folder / "paper" / "exam.pdf")]
    subprocess.run([*draw, str(DOCS / "paper")], check=True)


def photograph_pages(entrance: str, question: str) -> None:
    """Save screenshots of the first page, and of the question with a wrong answer.

    ``entrance`` is the address that signs in, ``question`` the path of the question.
    """
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        page = browser.new_page(viewport={"width": 1200, "height": 640})
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
        browser.close()


if __name__ == "__main__":
    main()
