"""Why an option, a pair, an order or a formula is wrong: authored, said on marking, printed."""

from __future__ import annotations

import json

import msgspec
import pytest

from quizgen.bank.bank import Bank
from quizgen.core.errors import BankError
from quizgen.kinds.grade import grade_answer
from quizgen.question.compose import compose_question

RULES = """
topic = "light"
tier = "A"
[[part]]
answer = { kind = "multi", options = { cone = true, rod = false, iris = false } }
[[part]]
answer = { kind = "match", pairs = { red = "long", blue = "short" } }
[[part]]
answer = { kind = "order", steps = ["lens", "sensor", "file"], traps = { backwards = ["file", "sensor", "lens"] } }
[[part]]
answer = { kind = "expression", value = "f*X/Z", symbols = { f = "real", X = "real", Z = "real" }, traps = { inverted = "f*Z/X" } }
[[part]]
answer = { kind = "choice", options = { cone = true, rod = false } }
[[part]]
answer = { kind = "tf", true = "n = 0", claim = "claim" }
[draw]
n = { pick = [1] }
claim = { words = ["few", "many"], by = "n" }
"""

PROSE = """# Eyes
A stem.
## a
Which?
## b
Match.
## c
Order.
## d
Formula?
## e
Which one?
## f
{{ claim }}
## words
- few: Rods have one pigment.
- many: Rods have three.
## options
- cone: cones.
- rod: rods
- iris: the iris
- red: red
- blue: blue
- long: long waves
- short: short waves
- lens: lens
- sensor: sensor
- file: file
## traps
- backwards: [{0}] You followed the light backwards.
- inverted: [{0}] Depth stands below.
## reasons
- cone: [{0}] Three pigments.
- rod: [{0}] Rods have one pigment.
- red = short: [{0}] Red light has long waves.
- file: [{0}] A file needs a sensor first.
- many: [{0}] Rods have {{ n }}, no: one.
"""


@pytest.fixture
def parts(tmp_path):
    folder = tmp_path / "templates" / "light" / "eyes"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(RULES, "utf-8")
    for lang in ("en", "bn"):
        (folder / f"{lang}.md").write_text(PROSE.replace("{0}", lang), "utf-8")
    question, key = compose_question(
        Bank(tmp_path, trusted=True).template("eyes"), 1, "en", figures=False
    )
    specs = [json.loads(json.dumps(msgspec.to_builtins(spec))) for spec in key.specs]
    marks = [{n: m for m, n in names_of(part.field)} for part in question.parts]
    return specs, marks, key.solution.parts


def names_of(field):
    """Each option's or target's mark, and its last word."""
    return [
        (mark, text[0].text.split()[-1].rstrip("."))
        for mark, text in (*field.options, *field.targets)
    ]


def test_a_wrong_tick_gets_its_reason_in_the_learners_language(parts):
    specs, marks, _ = parts
    both = f"{marks[0]['cones']}, {marks[0]['rods']}"
    assert "[en] Rods have one pigment." in grade_answer(specs[0], both).message
    assert "[bn] Rods" in grade_answer(specs[0], both, lang="bn").message
    assert "pigment" not in grade_answer(specs[0], marks[0]["iris"]).message
    assert grade_answer(specs[4], marks[4]["rods"]).message == "[en] Rods have one pigment."


def test_a_wrong_pair_gets_its_reason(parts):
    (_, spec, *_), marks, _ = parts
    left = {name: m for name, m in marks[1].items() if name in {"red", "blue"}}
    places = spec["pairs"]
    swapped = f"{left['red']}{places[left['blue']]} {left['blue']}{places[left['red']]}"
    assert "[en] Red light has long waves." in grade_answer(spec, swapped).message
    assert "Red light" not in grade_answer(spec, f"{left['blue']}{places[left['red']]}").message


def test_a_wrong_order_gets_its_reason_or_its_mistake(parts):
    specs, marks, _ = parts
    lens, sensor, file = (marks[2][name] for name in ("lens", "sensor", "file"))
    early = grade_answer(specs[2], f"{lens} {file} {sensor}")
    assert "[en] A file needs a sensor first." in early.message
    backwards = grade_answer(specs[2], f"{file} {sensor} {lens}")
    assert backwards.note == "trap:backwards"
    assert backwards.message == "[en] You followed the light backwards."


def test_a_wrong_formula_gets_its_mistake(parts):
    verdict = grade_answer(parts[0][3], "f*Z/X")
    assert (verdict.note, verdict.message) == ("trap:inverted", "[en] Depth stands below.")


def test_a_wrong_truth_gets_the_reason_of_the_claim(parts):
    spec = parts[0][5]
    assert grade_answer(spec, "true").message == "[en] Rods have 1, no: one."
    assert grade_answer(spec, "মিথ্যা", lang="bn").verdict == "correct"
    assert grade_answer(spec, "সত্য", lang="bn").message == "[bn] Rods have 1, no: one."


def test_the_solution_prints_them(parts):
    _, marks, solved = parts
    printed = [{m.name: m.value for m in part.reasons} for part in solved]
    assert printed[0] == {"rod": marks[0]["rods"]}, "not the right option's"
    assert set(printed[1]) == {"red = short"}
    assert set(printed[2]) == {"file"}
    named = [[mistake.name for mistake in part.mistakes] for part in solved]
    assert named == [[], [], ["backwards"], ["inverted"], [], []]
    said = "".join(getattr(part, "text", "") for part in solved[4].options[0])
    assert said == "cones: [en] Three pigments.", "no full stop before a colon"
    assert [part.text for part in solved[5].options[0]] == ["[en] Rods have ", "1", ", no: one."]


@pytest.mark.parametrize(
    ("order", "said"),
    [
        ('["file", "sensor", "sensor"]', "'sensor' is twice"),
        ('["film", "lens"]', "'film' is unknown"),
    ],
)
def test_a_wrong_order_is_one_of_the_steps(tmp_path, order, said):
    rules = RULES.replace('["file", "sensor", "lens"]', order)
    folder = tmp_path / "templates" / "light" / "eyes"
    folder.mkdir(parents=True)
    (folder / "template.toml").write_text(rules, "utf-8")
    (folder / "en.md").write_text(PROSE, "utf-8")
    with pytest.raises(BankError, match=f"part 3: answer: traps.backwards: step {said}"):
        compose_question(Bank(tmp_path).template("eyes"), 1, figures=False)
