"""The documents as a whole: four doors, each page with whom it is for, how long, and the next one."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import consoles
import pytest
from needed import without
from sweep import together

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
DOORS = [
    body.split()
    for body in re.findall(
        r":caption: \w+\n\n(.*?)```", (DOCS / "index.md").read_text("utf-8"), re.DOTALL
    )
]
PAGES = [
    (name, after) for door in DOORS for name, after in zip(door, [*door[1:], "index"], strict=True)
]
INCLUDED = {"architecture": "ARCHITECTURE", "contributing": "CONTRIBUTING"}
WORDS_A_MINUTE = 180


def prose(text):
    """A page without its programs and tables."""
    text = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    return [word for line in text.split("\n") if not line.startswith("|") for word in line.split()]


def test_every_page_stands_behind_one_door():
    names = [name for name, _after in PAGES]
    assert len(DOORS) == 5
    assert sorted(names) == sorted({page.stem for page in DOCS.glob("*.md")} - {"index"})


@together(("name", "after"), PAGES)
def test_a_page_says_for_whom_and_how_long_and_leads_on(name, after):
    text = (DOCS / f"{name}.md").read_text("utf-8")
    assert re.search(rf"\n\nNext: \[[^]]+\]\({after}\.md\)\n$", text)
    if name in INCLUDED:
        return
    said = re.match(r"# .+\n\n\*For ([^.]+)\. ([^.]+)\.\*\n\n", text)
    assert said
    if minutes := re.fullmatch(r"About (\d+) minutes?", said[2]):
        assert abs(int(minutes[1]) - len(prose(text)) / WORDS_A_MINUTE) <= 2


def test_all_pages_are_read_in_less_than_three_hours():
    pages = [page for page in consoles.PAGES if page.stem not in INCLUDED]
    assert sum(len(prose(page.read_text("utf-8"))) for page in pages) <= 30_000
    assert len((ROOT / "CONTRIBUTING.md").read_text("utf-8").split()) <= 2_500


LINK = re.compile(r"(?<!!)\[[^\]\n]+\]\(([^)\s]+)\)")


def anchors(page):
    """The places of a page that a link can lead to."""
    titles = re.findall(r"^#+ (.+)$", page.read_text("utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).strip().replace(" ", "-") for title in titles}


@together("page", [*consoles.PAGES, ROOT / "ARCHITECTURE.md", ROOT / "CHANGELOG.md"])
def test_links_lead_to_a_page_and_a_heading_of_it(page):
    text = re.sub(r"```.*?```|`[^`\n]+`", "", page.read_text("utf-8"), flags=re.DOTALL)
    for target in LINK.findall(text):
        if "://" in target or target.startswith("mailto:"):
            continue
        path, _, anchor = target.partition("#")
        place = (page.parent / path).resolve() if path else page
        assert place.exists(), f"{page.name}: {target}"
        if anchor and place.suffix == ".md":
            assert anchor in anchors(place), f"{page.name}: {target}"


@pytest.mark.slow
def test_the_site_is_built_by_its_one_command(tmp_path):
    if importlib.util.find_spec("sphinx") is None:
        without("sphinx is not installed: uv sync --group docs")
    command = ["-W", "--keep-going", "-q", str(DOCS), str(tmp_path)]
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *command], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert {"index.html", "searchindex.js"} <= {path.name for path in tmp_path.iterdir()}
