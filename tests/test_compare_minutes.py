"""Times that people took beside the minutes of the model: made-up exams, sums by hand."""

from __future__ import annotations

import sys
from pathlib import Path

import msgspec
import pytest

from quizgen.bank.bank import builtin_bank
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper
from quizgen.store.archive import ArchivedAnswer, ArchivedExam, LearnerArchive

sys.path.insert(0, str(Path(__file__).parent.parent / "tools"))

import compare_minutes


@pytest.fixture(scope="module")
def paper():
    return build_paper(builtin_bank(), load_blueprint("trial"), 4, figures=False)


def sat(paper, seconds, **more):
    """An exam in which each question with a time was answered."""
    answers = [ArchivedAnswer(f"{number}a", ["1"], 2.0) for number in seconds]
    return ArchivedExam(
        id="S1234567890abcde", code=paper.code, begun=1.0, limit=None, pauses=False, rested=0.0,
        resting=None, handed=2.0, marks={}, answers=answers, flags=[], spent=seconds, **more,
    )  # fmt: skip


def test_the_median_of_each_template_stands_beside_the_minutes_of_the_model(paper):
    first, second = paper.items[0], paper.items[1]
    exams = [
        sat(paper, {"1": 60.0, "2": 30.0}), sat(paper, {"1": 120.0}), sat(paper, {"1": 240.0}),
        sat(paper, {"2": 3.0}),  # nobody has read it
    ]  # fmt: skip
    exams[1] = msgspec.structs.replace(
        exams[1], answers=[*exams[1].answers, ArchivedAnswer("2", [], 2.0)]
    )
    found = {one.template: one for one in compare_minutes.compare_times(
        compare_minutes.iter_times(exams, builtin_bank()))}  # fmt: skip
    own = found[first.keys[0].template]
    assert (own.count, own.median) == (3, 2.0)
    assert own.model == float(builtin_bank().template(own.template).minutes)
    assert found[second.keys[0].template].median == 0.5
    assert len(found) == 2


def test_papers_of_other_templates_and_files_of_others_are_told(paper, tmp_path, capsys):
    other = sat(paper, {"1": 60.0})
    other = msgspec.structs.replace(other, code=f"{paper.code[:-6]}000000")
    file = tmp_path / "mine.json"
    archive = LearnerArchive("quizgen learning", 1, {}, [], [], [], [other])
    file.write_bytes(msgspec.json.encode(archive))
    assert compare_minutes.main([str(file)]) == 1
    assert "no answered question" in capsys.readouterr().err
    file.write_text("{}")
    assert compare_minutes.main([str(file)]) == 1
    assert "mine.json" in capsys.readouterr().err
    file.write_bytes(msgspec.json.encode(msgspec.structs.replace(archive, sittings=[
        sat(paper, {"1": 90.0})])))  # fmt: skip
    assert compare_minutes.main([str(file)]) == 0
    assert " 1.5 " in capsys.readouterr().out
