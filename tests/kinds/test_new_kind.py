"""An answer kind is one module, its place in one list and its words: docs/extending.md, walked.

The page's files are put into a copy of quizgen. From there on everything is what an author, a
student and a grader do: nothing else of the copy is touched.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "docs" / "extending.md").read_text("utf-8")

TEMPLATE = """
topic = "colour"
tier = "A"

[draw]
R = { pick = [255] }
G = { pick = [128] }
B = { pick = [0] }

[[part]]
answer = { kind = "hex_colour", channels = ["R", "G", "B"] }
"""
PROSE = """# A colour in hexadecimal digits
A page asks for red {{ R }}, green {{ G }} and blue {{ B }}.

**How is the colour written?**

## why
Two digits hold a number from 0 to 255.
"""
STEPS = """
import json, sys
from pathlib import Path
from click.testing import CliRunner
from quizgen.bank.bank import Bank
from quizgen.cli.main import root_group
from quizgen.kinds.grade import grade_answer
from quizgen.locale import translate
from quizgen.practice.part_attempt import PartAttempt
from quizgen.web.question_view import QuestionRequest, run_request

bank, out = sys.argv[1:]
said = {}

def run(name, *arguments):
    result = CliRunner().invoke(root_group, [*arguments, "--bank", bank], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    said[name] = result.output

run("lint", "lint")
run("preview", "preview", "hex")
run("exam", "exam", "--topic", "colour", "--seed", "1", "--out", f"{out}/exam")
run("cards", "cards", "--out", f"{out}/cards", "--format", "tsv")
for name in ("moodle", "qti3", "canvas"):
    run(name, "export", name, "--topic", "colour", "--variants", "1", "--out", f"{out}/{name}")
made = json.loads(run_request(Bank(Path(bank)), QuestionRequest("hex", "1", "en")))
said["web"] = json.dumps(made["parts"][0])
(form,) = Path(out, "exam").glob("answers*.toml")
for typed in ("#FF8000", "ff8001", "orange"):
    filled = Path(out, f"{typed.strip('#')}.toml")
    filled.write_text(form.read_text("utf-8").replace('"1" = ""', f'"1" = "{typed}"'))
    result = CliRunner().invoke(root_group, ["check", f"{out}/exam/key.json", str(filled), "--json"])
    said[typed] = result.stdout
said["schema"] = CliRunner().invoke(root_group, ["schema", "template"]).output
said["bangla"] = translate("bn", "ask.hex_colour")
print(json.dumps(said))
"""


def blocks(language: str) -> list[str]:
    """The files of the page's section on kinds that are in a language."""
    section = GUIDE.partition("## An answer kind\n")[2].partition("### A drawing\n")[0]
    return re.findall(rf"```{language}\n(.*?)```", section, re.DOTALL)


def insert(path: Path, *edits: tuple[str, str]) -> None:
    """Put lines after others, each of which stands there once."""
    text = path.read_text("utf-8")
    for after, line in edits:
        assert text.count(after) == 1, after
        text = text.replace(after, f"{after}{line}")
    path.write_text(text, "utf-8")


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """What each command says in a copy of quizgen that has the kind, and where the files are."""
    folder = tmp_path_factory.mktemp("copy")
    shutil.copytree(ROOT / "quizgen", folder / "quizgen")
    kinds, words = folder / "quizgen" / "kinds", folder / "quizgen" / "locale" / "en"
    (code,) = blocks("python")
    hint, notes = blocks("toml")
    (kinds / "hex_colour.py").write_text(code, "utf-8")
    insert(
        kinds / "__init__.py",
        ("    gap,\n", "    hex_colour,\n"),
        ("rubric, sketch,", " hex_colour,"),
    )
    insert(words / "interface.toml", ("[ask]\n", hint))
    insert(words / "messages.toml", ("[notes]\n", notes))
    template = folder / "bank" / "templates" / "colour" / "hex"
    template.mkdir(parents=True)
    (template / "template.toml").write_text(TEMPLATE)
    (template / "en.md").write_text(PROSE)
    run = subprocess.run(
        [sys.executable, "-c", STEPS, str(folder / "bank"), str(folder / "out")],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(folder), "XDG_CACHE_HOME": str(folder / "cache")},
    )
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout), folder / "out"


def test_lint_finds_nothing_to_say(walked):
    (row,) = re.findall(r"^hex +\d.* (\d+)(?: +\w+)? *$", walked[0]["lint"], re.MULTILINE)
    assert row == "0"


def test_editors_are_told_its_keys(walked):
    shape = json.loads(walked[0]["schema"])["$defs"]["HexColour"]
    assert shape["properties"]["channels"]["description"] == "Quantities from 0 to 255."
    assert shape["properties"]["kind"]["enum"] == ["hex_colour"]


def test_a_student_is_told_how_to_type_it_and_a_solution_what_is_right(walked):
    said, out = walked
    assert "Write # and six hexadecimal digits." in said["preview"]
    assert "#ff8000" in said["preview"]
    page = (out / "exam" / "exam.html").read_text("utf-8")
    assert "Write # and six hexadecimal digits." in page
    assert re.search(r'<input type="text"[^>]* id="a-1"', page)
    assert "#ff8000" not in page
    assert "#ff8000" in (out / "exam" / "solutions.html").read_text("utf-8")
    assert (out / "exam" / "solutions.pdf").read_bytes().startswith(b"%PDF")


def test_a_language_without_its_words_says_them_in_english(walked):
    assert walked[0]["bangla"] == "Write # and six hexadecimal digits."


EXPECTED = "# and six hexadecimal digits are expected, such as #ff8000."


@pytest.mark.parametrize(
    ("typed", "credit", "message"),
    [
        ("#FF8000", 1.0, ""),
        ("ff8001", pytest.approx(2 / 3), "2 of 3 channels are right."),
        ("orange", 0.0, f"“orange” is no colour: {EXPECTED}"),
    ],
)
def test_what_is_typed_on_the_form_gets_its_marks(walked, typed, credit, message):
    (part,) = json.loads(walked[0][typed])["parts"]
    assert (part["credit"], part["message"]) == (credit, message)


def test_it_is_practised_in_the_browser_and_asked_on_cards(walked):
    said, out = walked
    assert "Write # and six hexadecimal digits." in said["web"]
    (cards,) = (out / "cards").glob("*.tsv")
    assert re.search("#[0-9a-f]{6}", cards.read_text("utf-8"))


@pytest.mark.parametrize("system", ["moodle", "qti3", "canvas"])
def test_a_system_for_courses_lets_a_person_grade_it(walked, system):
    assert "exported as essay: 1 (1 hex_colour)" in walked[0][system].replace("parts ", "")
