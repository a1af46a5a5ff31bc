"""Codes of diagnostics: the table for people is that of the code, and each code is used."""

from __future__ import annotations

import re
from pathlib import Path

from quizgen.core.diagnostics import CODES, Diagnostic, can_be_ignored, diagnose
from quizgen.core.positions import Span

ROOT = Path(__file__).parents[2]
ROW = re.compile(r"^\| (QG\d{3}) \| (.+?) \| (.*?) ?\|$", re.MULTILINE)


def test_the_table_of_the_documentation_is_that_of_the_code():
    listed = ROW.findall((ROOT / "docs" / "diagnostics.md").read_text("utf-8"))
    table = [(code, rule.what.replace("``", "`"), rule.hint) for code, rule in CODES.items()]
    assert listed == sorted(table)


def test_every_code_is_given_somewhere_and_every_one_given_is_listed():
    source = "\n".join(
        path.read_text("utf-8")
        for path in (ROOT / "quizgen").rglob("*.py")
        if path.name != "diagnostics.py"
    )
    given = set(re.findall(r'"(QG\d{3})"', source)) | {"QG100"}
    assert given == CODES.keys()


def test_what_stops_a_paper_cannot_be_ignored():
    assert [can_be_ignored(code) for code in ("QG121", "QG204", "QG303", "QG405", "QG503", "QG601")] == [
        False, True, True, True, False, False,
    ]  # fmt: skip
    assert not can_be_ignored("QG299"), "there is no such code"


def test_a_diagnostic_reads_as_editors_expect(tmp_path):
    file = tmp_path / "template.toml"
    file.write_text('topic = "x"\nkeep = { F = { min = 1 } }\n')
    found = diagnose("QG208", file, "the answer is 1 in all draws", ("keep", "F"))
    assert str(found) == (
        f"{file}:2:10: QG208 the answer is 1 in all draws; let it depend on what is drawn"
    )
    assert found.as_json() == {
        "code": "QG208",
        "file": str(file),
        "line": 2,
        "column": 10,
        "message": "the answer is 1 in all draws",
        "hint": "let it depend on what is drawn",
    }


def test_what_is_about_a_whole_file_has_no_line(tmp_path):
    found = diagnose("QG151", tmp_path / "en.md", "no title")
    assert found == Diagnostic("QG151", tmp_path / "en.md", None, "no title")
    assert str(found) == f"{tmp_path / 'en.md'}: QG151 no title"
    assert (found.as_json()["line"], found.as_json()["column"]) == (None, None)
    assert diagnose("QG151", tmp_path / "en.md", "no title", line=1).span == Span(1)
