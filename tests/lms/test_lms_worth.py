"""What a known mistake still earns is what an LMS gives for it."""

from __future__ import annotations

import io
import re
import zipfile

import pytest
from click.testing import CliRunner

from quizgen.bank.bank import Bank
from quizgen.cli.main import root_group
from quizgen.lms.items import items_from_templates
from quizgen.lms.moodle import write_moodle
from quizgen.lms.qti.package import write_qti3, write_qti21


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Travel times, in which the product in place of the quotient earns three tenths."""
    root = tmp_path_factory.mktemp("worth") / "own"
    CliRunner().invoke(root_group, ["new", "bank", str(root)], catch_exceptions=False)
    rules = root / "templates/example/travel-time/template.toml"
    said = rules.read_text("utf-8").replace('rel = "', 'worth = { multiplied = "0.3" }, rel = "')
    rules.write_text(said, "utf-8")
    return [*items_from_templates(Bank(root, trusted=True), ["travel-time"], 1, 1, ["en"])]


def test_moodle_gives_the_share(exported):
    fractions = re.findall(r'<answer fraction="([\d.]+)"', write_moodle(exported).decode())
    assert sorted(map(float, fractions)) == [0, 30, 100]


@pytest.mark.parametrize("write", [write_qti21, write_qti3], ids=["2.1", "3.0"])
def test_qti_gives_the_share(exported, write):
    package = zipfile.ZipFile(io.BytesIO(write(exported)))
    (item,) = [name for name in package.namelist() if "travel-time" in name]
    text = package.read(item).decode()
    scores = re.findall(r'identifier="SCORE[^"]*">\s*<[\w-]+ base-?[tT]ype="float">([\d.]+)<', text)
    assert sorted({float(score) for score in scores}) == [0.6, 2.0], "of two points"
