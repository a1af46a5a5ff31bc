"""The terminal session: feedback, hints, retries, Ctrl-C and going on."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from quizgen.bank.folder import builtin
from quizgen.cli import practice
from quizgen.locale import languages
from quizgen.marking.mark import show
from quizgen.marking.messages import practice_words
from quizgen.practice.choosing import fitting, nth
from quizgen.practice.state import Wish
from quizgen.question.compose import compose


@pytest.fixture(autouse=True)
def state(tmp_path, monkeypatch):
    path = tmp_path / "state" / "practice.json"
    monkeypatch.setattr(practice, "state_path", lambda: path)
    return path


def run(lines, *arguments):
    return CliRunner().invoke(
        practice.practice,
        ["--topic", "projection", "--tier", "A", *arguments],
        input="\n".join(lines) + "\n",
    )


def first_question(seed="s", lang="en", number=1):
    name = nth(builtin(), fitting(builtin(), Wish(lang, 1, "projection", "A")), seed, number)
    template = builtin().template(name)
    return compose(template, seed, lang, slot=str(number), number=str(number), figures=False)[1]


def test_right_answers_end_in_a_summary():
    typed = [show(spec) for spec in first_question().specs]
    done = run(typed, "--seed", "s", "--count", "1")
    assert done.exit_code == 0
    assert done.output.count("Correct.") == len(typed)
    assert f"projection: {len(typed)} of {len(typed)} parts right at once" in done.output


def test_unreadable_answers_cost_no_try_and_three_wrong_ones_show_the_solution():
    key = first_question()
    lines = ["???", "1;2;3;4;5;6;7", "?"]
    for spec in key.specs:
        unit = getattr(spec, "unit", "")
        wrong = f"987654 {unit}" if hasattr(spec, "value") else "(987654; 123457)"
        lines += [wrong] * 3
    done = run(lines, "--seed", "s", "--count", "1")
    assert "Hint:" in done.output
    assert "Try again (2 left)." in done.output
    assert f"Answer: {key.solution.parts[0].answer}" in done.output


def test_interruption_keeps_the_session_and_the_same_command_goes_on(state):
    typed = [show(spec) for spec in first_question().specs]
    stopped = run(typed, "--seed", "s", "--count", "2")  # input ends: as Ctrl-C
    assert stopped.exit_code == 0
    assert "Session kept" in stopped.output
    assert json.loads(state.read_text())["done"] == 1
    rest = [show(spec) for spec in first_question(number=2).specs]
    done = run(rest, "--count", "2")
    assert "Going on with the session of seed s." in done.output
    assert "Question 2 of 2" in done.output
    assert "Summary by topic" in done.output
    assert not state.exists()


def test_a_broken_session_file_is_ignored(state):
    state.parent.mkdir(parents=True)
    state.write_text("{not json")
    assert run(["!"] * 9, "--count", "1").exit_code == 0


def test_bangla_and_giving_up():
    done = run(["!"] * 9, "--lang", "bn", "--seed", "s", "--count", "1")
    assert "উত্তর:" in done.output
    assert "বিষয় ধরে ফলাফল" in done.output


def test_filters_that_fit_nothing():
    done = CliRunner().invoke(practice.practice, ["--topic", "cooking"])
    assert "No template fits" in done.output


def test_every_sentence_exists_in_every_language():
    first, *others = (practice_words(lang) for lang in languages())
    assert all(first.keys() == other.keys() for other in others)
