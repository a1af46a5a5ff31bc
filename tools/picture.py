"""The picture of ``quizgen serve`` in the README; needs Chromium."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from quizgen.store import QuestionRef, Store

PICTURE = Path(__file__).parent.parent / "docs" / "serve.png"
QUESTION = QuestionRef("point-to-image-plane", "3")
TYPED = ("20", "16")
"""A known mistake, so that the picture shows it named."""


def main() -> None:
    """Serve a question from a new database, answer it and take its picture."""
    with tempfile.TemporaryDirectory() as folder:
        database = f"sqlite:///{Path(folder) / 'learning.sqlite3'}"
        store = Store(database)
        attempt = store.start_attempt(store.learner().id, QUESTION, {})
        store.close()
        server = subprocess.Popen(
            [sys.executable, "-m", "quizgen", "serve", "--no-open", "--database", database],
            stdout=subprocess.PIPE,
            text=True,
        )
        try:
            entrance = (server.stdout.readline() if server.stdout else "").split()[-1]
            photograph(entrance, f"/q/{attempt.id}")
        finally:
            server.terminate()
            server.wait()


def photograph(entrance: str, question: str) -> None:
    """Answer the question as its page asks it, and save a screenshot.

    ``entrance`` is the address that signs in, ``question`` the path of the question.
    """
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        page = browser.new_page(viewport={"width": 1200, "height": 640})
        page.goto(entrance)
        page.goto(page.url.rstrip("/") + question)
        for field, value in zip(page.locator("input[type=text]").all(), TYPED, strict=True):
            field.fill(value)
        page.get_by_role("button", name="Check").click()
        page.locator(".verdict").wait_for()
        page.wait_for_timeout(500)  # the verdict fades in
        page.screenshot(path=PICTURE)
        browser.close()
    print(f"{PICTURE.name}: {PICTURE.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
