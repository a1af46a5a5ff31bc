"""What several classes taught about templates, and what is asked instead because of it."""

from __future__ import annotations

import csv
import math
import shutil

import numpy as np
import pytest
from made import made, run

from quizgen.bank.bank import builtin_bank
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.generation import create_settings, replace_by_comparable, replace_template
from quizgen.classes.item_analysis import ClassMistake, ItemStatistics, MistakeExample
from quizgen.classes.template_history import (
    PartHistory,
    fit_two_parameters,
    read_difficulties,
    write_template_history,
)
from quizgen.core.errors import ClassError
from quizgen.paper.blueprint import load_blueprint


def statistics(students, difficulty, discrimination, *mistakes):
    found = tuple(
        ClassMistake(name, count, MistakeExample("s", "1a", "x")) for name, count in mistakes
    )
    return ItemStatistics("t/a", students, 2.0, difficulty, discrimination, 3, 0, found, ())


def test_years_are_pooled_by_their_students():
    one = PartHistory("t", "a", ["y1", "y2"], [
        statistics(103, 0.6, 0.5, ("trap:f", 10), ("trap:g", 2)), statistics(53, 0.3, 0.2, ("trap:f", 5)),
    ])  # fmt: skip
    assert one.students == 156
    assert one.difficulty == pytest.approx((103 * 0.6 + 53 * 0.3) / 156)
    # Fisher: atanh 0.5 = ln(3)/2, atanh 0.2 = ln(1.5)/2, weighted by 100 and 50
    assert math.atanh(one.discrimination) == pytest.approx(
        (100 * math.log(3) / 2 + 50 * math.log(1.5) / 2) / 150
    )
    assert one.format_row()[:4] == ["t", "a", "y1 y2", "156"]
    assert one.format_row()[-1] == "15 trap:f; 2 trap:g"


def test_what_nobody_answered_has_no_values():
    assert PartHistory("t", "a", ["y"], [statistics(0, None, None)]).format_row()[5:7] == ["", ""]


def test_the_table_of_two_classes_has_a_row_for_each_part(tmp_path):
    there = made(tmp_path, [("1", "A", "en"), ("2", "B", "en")])
    (tmp_path / "in.csv").write_text("id,2a\n1,1\n2,4\n", "utf-8")
    assert run("class", "mark", there, tmp_path / "in.csv") == 0
    earlier = shutil.copytree(there, tmp_path / "earlier")
    path = write_template_history(ClassFolder(there), [ClassFolder(earlier)])
    with path.open(encoding="utf-8-sig", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len({(row["template"], row["part"]) for row in rows}) == len(rows)
    assert {row["students"] for row in rows if row["template"] == "exposure-equivalence"} == {"4"}
    assert all(row["a"] == "" for row in rows)  # far too few for a model
    assert read_difficulties(path).keys() == {row["template"] for row in rows if row["difficulty"]}


PLAN = """
[title]
en = "One"
[[slot]]
templates = ["rods-cones-and-peaks", "point-to-image-plane", "normalise-from-8-bit-range", "exposure-equivalence"]
points = 3
"""
KNOWN = {
    "rods-cones-and-peaks": 0.65, "point-to-image-plane": 0.62, "normalise-from-8-bit-range": 0.2,
    "exposure-equivalence": 0.9, "no-such-template": 0.65,
}  # fmt: skip


@pytest.mark.parametrize(("now", "then"), [
    ("rods-cones-and-peaks", "point-to-image-plane"), ("exposure-equivalence", "rods-cones-and-peaks"),
    ("normalise-from-8-bit-range", "point-to-image-plane"),
])  # fmt: skip
def test_what_was_about_as_difficult_is_asked_instead(tmp_path, now, then):
    (tmp_path / "plan.toml").write_text(PLAN, "utf-8")
    bank, plan = builtin_bank(), load_blueprint(str(tmp_path / "plan.toml"), builtin_bank())
    begun = create_settings("c", bank, plan, "en")
    if begun.templates != ((now,),):
        begun = replace_template(begun, bank, plan, 1, now)
    assert replace_by_comparable(begun, bank, plan, 1, KNOWN).templates == ((then,),)
    with pytest.raises(ClassError, match=f"no earlier class was asked {now}"):
        replace_by_comparable(begun, bank, plan, 1, {then: 0.5})
    with pytest.raises(ClassError, match="nothing that earlier classes were asked"):
        replace_by_comparable(begun, bank, plan, 1, {now: 0.5, "uint8-sum-repair": 0.5})
    with pytest.raises(ClassError, match="no question 2"):
        replace_by_comparable(begun, bank, plan, 2, KNOWN)


def test_what_is_not_known_or_cannot_be_read_is_said(tmp_path):
    path = tmp_path / "known.csv"
    path.write_text("template,points,difficulty\na,1,0.5\na,3,\nb,x,0.5\n", "utf-8")
    with pytest.raises(ClassError, match="line 4: points and difficulty are numbers"):
        read_difficulties(path)
    with pytest.raises(ClassError, match="there is no such file"):
        read_difficulties(tmp_path / "other.csv")


@pytest.mark.slow
def test_the_two_parameter_model_finds_what_answers_were_drawn_with():
    """Answers of 600 students by the logistic model itself; one item is one that few were asked."""
    chance = np.random.default_rng(5)
    slopes, places = np.linspace(0.8, 2.0, 10), np.tile(np.linspace(-1.5, 1.5, 5), 2)
    right = chance.random((600, 10)) < 1 / (
        1 + np.exp(-slopes * (chance.normal(size=(600, 1)) - places))
    )
    rows = [{f"i{k}": float(one[k]) for k in range(10)} for one in right]
    rows[0]["rare"] = 1.0
    del rows[1]["i0"]  # who was not asked is neither right nor wrong
    found = fit_two_parameters(rows)
    assert found.keys() == {f"i{k}" for k in range(10)}
    assert max(abs(found[f"i{k}"][1] - places[k]) for k in range(10)) < 0.4
    assert np.corrcoef(slopes, [found[f"i{k}"][0] for k in range(10)])[0, 1] > 0.7
    assert fit_two_parameters(rows[:199]) == {}
