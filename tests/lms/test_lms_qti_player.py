"""Packages of QTI 3.0 in a player that others wrote, in Chromium."""

from __future__ import annotations

from math import isclose
from pathlib import Path

import pytest
from needed import absent
from qti_cases import cases
from sweep import sample

from quizgen.lms.qti.dialect import QTI3
from quizgen.lms.qti.item import item_identifier
from quizgen.lms.qti.package import package_files

HERE = Path(__file__).parent / "player"
BUNDLE = HERE / "node_modules" / "@citolab" / "qti-components" / "cdn" / "index.global.js"

EXACT, ROUNDED = 1e-9, 2e-3
"""How near marks are: the player writes each outcome with three decimals."""


@pytest.fixture(scope="module")
def player(browser):
    """A page that plays items, and what it complained of."""
    if not BUNDLE.is_file():
        absent("qti-components", f"nodejs npm; npm --prefix {HERE} install")
    page, complaints = browser.new_page(), []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.add_script_tag(path=BUNDLE)
    page.add_script_tag(path=HERE / "play.js")
    yield page, complaints
    page.close()


def disagreements(page, item, xml: bytes):
    """Answers that the player marks otherwise than declared, or of which it says something else."""
    page.evaluate("xml => shown(xml)", xml.decode())
    nothing, key, *others = cases(item)
    for case, how in ((nothing, "tried"), (key, "answered"), *((one, "tried") for one in others)):
        marks, shown = page.evaluate(f"given => {how}(given)", case.given)
        told = {text for outcome, text in shown if outcome != "SOLUTION"}
        solved = "SOLUTION" in {outcome for outcome, _ in shown}
        exact = EXACT if case is key else ROUNDED
        if not isclose(marks, case.marks, abs_tol=exact) or told != case.said or not solved:
            yield item_identifier(item), case, marks, told


@pytest.mark.slow
@pytest.mark.browser
def test_the_player_marks_and_says_what_is_declared(items, player):
    """Half of the items, spread evenly, unless all are asked for."""
    page, complaints = player
    items = sample(items, (len(items) + 1) // 2)
    files, found = package_files(items, QTI3), []
    for item in items:
        found += disagreements(page, item, files[f"items/{item_identifier(item)}.xml"])
    assert found == []
    assert complaints == []
