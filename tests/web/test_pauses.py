"""Whether the clock of an exam may be stopped: as its blueprint says, else as one chooses."""

from __future__ import annotations

import re

import pytest
from own_bank import NAME

from quizgen.bank.bank import Bank
from quizgen.core.errors import BlueprintError
from quizgen.paper.blueprint import load_blueprint
from quizgen.web.settings import ServerSettings

BLUEPRINT = """{rule}
[title]
en = "{name}"
[[slot]]
templates = ["{template}"]
"""
RULES = {"strict": "pauses = false", "easy": "pauses = true", "silent": ""}
PAUSE = 'value="rest"'


@pytest.fixture(scope="module")
def settings(database, root):
    """A bank with a paper of each sort."""
    folder = root / "templates" / "blueprints"
    folder.mkdir()
    for name, rule in RULES.items():
        text = BLUEPRINT.format(rule=rule, name=name.title(), template=NAME)
        (folder / f"{name}.toml").write_text(text)
    return ServerSettings(database(), Bank(root, trusted=True), workers=1)


@pytest.mark.parametrize(
    ("blueprint", "ticked", "may"),
    [
        ("strict", True, False),
        ("strict", False, False),
        ("easy", True, True),
        ("easy", False, True),
        ("silent", True, True),
        ("silent", False, False),
    ],
)
def test_the_blueprint_goes_before_the_choice(client, token, blueprint, ticked, may):
    sent = {"token": token, "blueprint": blueprint, **({"pauses": "1"} if ticked else {})}
    begun = client.post("/exam", data=sent)
    assert (PAUSE in begun.text) == may
    code = re.search(r"<code>([^<]*)</code>", begun.text)[1]
    again = client.post("/exam", data={**sent, "code": code})
    assert (PAUSE in again.text) == may
    rests = client.post(again.url.path, data={"token": token, "do": "rest"})
    assert ("The exam rests" in rests.text) == may


def test_where_it_is_chosen_stands_what_each_paper_says(client):
    told = dict(re.findall(r'<option value="(\w+)">([^<]*)</option>', client.get("/exam").text))
    assert told["strict"] == "Strict (without pauses)"
    assert told["easy"] == "Easy (pauses allowed)"
    assert told["silent"] == "Silent"


def test_it_is_yes_or_no(root, tmp_path):
    file = tmp_path / "odd.toml"
    file.write_text(BLUEPRINT.format(rule='pauses = "some"', name="Odd", template=NAME))
    with pytest.raises(BlueprintError, match=r"pauses"):
        load_blueprint(str(file), Bank(root, trusted=True))
