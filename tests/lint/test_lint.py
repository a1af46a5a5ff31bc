"""Templates that are wrong in one way each, and what is said about them."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from quizgen.bank.bank import Bank
from quizgen.cli.lint import lint
from quizgen.lint.template_checks import lint_template

RULES = """
topic = "colour"
tier = "A"
[draw]
a = { pick = [1, 2, 3] }
b = { pick = [4, 5, 6] }
[[part]]
answer = { kind = "choice", options = { yes = "a < b", no = "a > b" } }
"""
OPTIONS = "\n\n## options\n- yes: Yes.\n- no: No.\n## reasons\n- yes: So.\n- no: Not so.\n"
ENGLISH = f"# T\nWe have {{{{ a }}}} and {{{{ b }}}}.{OPTIONS}"


def problems(folder, english, bangla):
    template = folder / "templates" / "colour" / "one"
    template.mkdir(parents=True)
    (template / "template.toml").write_text(RULES)
    (template / "en.md").write_text(english, "utf-8")
    (template / "bn.md").write_text(bangla, "utf-8")
    found = lint_template(Bank(folder).template("one"), 5).problems
    return [(one.code, one.file.name, one.span.line, one.message) for one in found]


def test_a_sound_template_has_no_problem(tmp_path):
    assert problems(tmp_path, ENGLISH, ENGLISH) == []


@pytest.mark.parametrize(
    ("english", "bangla", "odd", "more"),
    [
        ("Only {{ a }}.", "Only {{ b }}.", ["a", "b"], "en.md"),
        ("{{ a }} and {{ a }}.", "{{ a }} and {{ b }}.", ["b"], "bn.md"),
        ("{{ a }} and {{ b }}.", "{{ a }}.", ["b"], "en.md"),
    ],
    ids=["as many but others", "one twice", "one less"],
)
def test_languages_that_show_other_values_are_told_apart(tmp_path, english, bangla, odd, more):
    found = problems(tmp_path, f"# T\n{english}{OPTIONS}", f"# T\n{bangla}{OPTIONS}")
    said = f"en.md and bn.md do not show the same values: {odd}"
    assert found == [("QG214", more, 2, said)], "where the value is that the other lacks"


def test_options_that_show_other_values_are_told_apart(tmp_path):
    bangla = ENGLISH.replace("- yes: Yes.", "- yes: Yes, {{ c }}.")
    assert problems(tmp_path, ENGLISH, bangla) == [
        ("QG214", "bn.md", 5, "en.md and bn.md do not show the same values: ['c']")
    ]


def test_languages_with_other_options_are_told_apart(tmp_path):
    found = problems(tmp_path, ENGLISH, ENGLISH.replace("- no: No.", "- not: No."))
    said = "section 'options' differs from en.md by ['no', 'not']"
    assert found == [("QG215", "bn.md", 6, said)]


@pytest.mark.parametrize(
    ("about", "missing"),
    [
        ("", []),
        ('languages = ["en"]', []),
        ('languages = ["en", "bn"]', ["QG210 no bn.md"]),
    ],
    ids=["the templates' own", "one", "two"],
)
def test_the_bank_says_in_which_languages_a_template_must_be(tmp_path, about, missing):
    template = tmp_path / "templates" / "colour" / "one"
    template.mkdir(parents=True)
    (tmp_path / "templates" / "bank.toml").write_text(about)
    (template / "template.toml").write_text(RULES)
    (template / "en.md").write_text(ENGLISH, "utf-8")
    done = CliRunner().invoke(lint, [str(tmp_path), "--seeds", "5"])
    found = [line.split("; ")[0] for line in done.stderr.splitlines()]
    assert found == [f"{template / 'bn.md'}: {problem}" for problem in missing]
    assert done.exit_code == bool(missing)


def test_what_a_report_counts(bank):
    """No mistake may vanish here, so each is met in every draw; 6*15/2 = 45 is the largest image."""
    report = lint_template(bank.template("point-to-image-plane"), 20)
    assert report.problems == []
    assert (report.seeds, len(report.traps), set(report.traps.values())) == (20, 7, {20})
    assert report.ranges.keys() == {"p'_x", "p'_y"}
    for low, high in report.ranges.values():
        assert -45 <= low < 0 < high <= 45
