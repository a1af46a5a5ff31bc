"""Sessions without a terminal: what is asked, tries, hints, outcomes, going on, the summary."""

from __future__ import annotations

import subprocess
import sys

import msgspec
import pytest

from quizgen.bank.folder import builtin
from quizgen.errors import ChoiceError
from quizgen.marking.mark import show
from quizgen.practice.choosing import fitting, nth
from quizgen.practice.session import Session
from quizgen.practice.state import Outcome, State, Wish, kept, new
from quizgen.practice.task import TRIES, Next
from quizgen.question.compose import compose

WISH = Wish(count=2, topic="projection", tier="A")


def key_of(turn, state):
    template = builtin().template(turn.question.template)
    number = str(turn.number)
    return compose(template, state.seed, state.wish.lang, slot=number, number=number)[1]


def session(wish=WISH, seed="s"):
    return Session(builtin(), new(wish, seed))


def kind_of(task):
    return task._keyed.spec["kind"]


def wrong(spec):
    """A readable answer that is neither right nor near."""
    table = msgspec.to_builtins(spec)
    return f"987654 {table.get('unit', '')}" if "value" in table else "(987654; 123457)"


def numeric_task():
    """The first task that a number or a point answers, and its spec."""
    held = session(Wish(count=50, topic="projection", tier="A"))
    while not held.finished:
        turn = held.turn()
        for task, spec in zip(turn.tasks, key_of(turn, held.state).specs, strict=True):
            if kind_of(task) in {"point", "quantity"} and task.solved.lines:
                return task, spec
        held.state.done = turn.number
    raise AssertionError("no such task")


def test_a_right_answer_ends_the_task_at_once():
    task, spec = numeric_task()
    feedback = task.answer(show(spec))
    assert (feedback.then, feedback.left) == (Next.RIGHT, TRIES - 1)
    assert task.outcome == Outcome("projection", right=True, first=True)


def test_what_cannot_be_read_costs_no_try():
    task, _ = numeric_task()
    feedback = task.answer("???")
    assert (feedback.then, feedback.left, task.outcome) == (Next.ASK_BACK, TRIES, None)
    assert feedback.verdict.message


def test_three_wrong_answers_end_the_task():
    task, spec = numeric_task()
    found = [task.answer(wrong(spec)) for _ in range(3)]
    assert [(f.then, f.left) for f in found] == [
        (Next.AGAIN, 2), (Next.AGAIN, 1), (Next.OUT_OF_TRIES, 0),
    ]  # fmt: skip
    assert task.outcome == Outcome("projection", right=False, first=False)


@pytest.mark.parametrize("help_with", ["another try", "a hint"])
def test_right_after_help_is_not_right_at_once(help_with):
    task, spec = numeric_task()
    if help_with == "a hint":
        assert task.hint() == task.solved.lines[0].why
    else:
        task.answer(wrong(spec))
    task.answer(show(spec))
    assert task.outcome == Outcome("projection", right=True, first=False)


def test_hints_are_the_steps_of_the_solution_in_turn_and_then_none():
    task, _ = numeric_task()
    reasons = [line.why for line in task.solved.lines]
    assert [task.hint() for _ in reasons] == reasons
    assert task.hint() is None


def test_giving_up_is_not_right():
    task, _ = numeric_task()
    task.give_up()
    assert task.outcome == Outcome("projection", right=False, first=False)


@pytest.mark.parametrize("right", [True, False])
def test_the_learner_judges_a_free_text(right):
    wish = Wish(count=200)
    held = session(wish)
    texts = (
        name for name in held.templates
        if any(part.answer["kind"] == "text" for part in builtin().rules(name).part)
    )  # fmt: skip
    held.templates = (next(texts),)
    tasks = held.turn().tasks
    task = next(t for t in tasks if kind_of(t) == "text")
    assert task.answer("something written").then is Next.SELF_MARK
    assert task.outcome is None
    task.mark_yourself(right=right)
    assert (task.outcome.right, task.outcome.first) == (right, right)


def test_an_unfinished_question_is_asked_again():
    held = session()
    turn = held.turn()
    turn.tasks[0].give_up()
    again = held.turn()
    assert again.question == turn.question
    assert not again.outcomes


def test_a_kept_state_goes_on_where_it_stopped(tmp_path):
    path, held = tmp_path / "deep" / "state.json", session()
    turn = held.turn()
    for task in turn.tasks:
        task.give_up()
    assert turn.finished
    held.finish(turn)
    held.state.save(path)
    state = kept(path, WISH)
    assert state == held.state
    assert [p.name for p in path.parent.iterdir()] == ["state.json"]
    later = Session(builtin(), state).turn()
    assert later.number == 2
    assert later.question == held.turn().question


def test_a_state_of_another_wish_or_a_broken_one_is_not_taken_up(tmp_path):
    path = tmp_path / "state.json"
    session().state.save(path)
    assert kept(path, Wish(count=3, topic="projection", tier="A")) is None
    assert kept(tmp_path / "none.json", WISH) is None
    for text in ("{not json", "[]", '{"wish": {}, "seed": 3}', "[" * 5000):
        path.write_text(text)
        assert kept(path, WISH) is None


def test_new_sessions_differ_and_a_seed_is_kept():
    assert new(WISH).seed != new(WISH).seed
    assert new(WISH, "abc").seed == "abc"


def test_the_summary_counts_by_topic():
    outcomes = [
        Outcome("optics", right=True, first=True),
        Outcome("colour", right=True, first=False),
        Outcome("optics", right=False, first=False),
    ]
    held = Session(builtin(), State(WISH, "s", 2, outcomes))
    assert held.finished
    found = [(row.topic, row.count, row.right, row.later) for row in held.summary()]
    assert found == [("colour", 1, 0, 1), ("optics", 2, 1, 0)]


def test_a_wish_that_nothing_fits_is_finished_at_once():
    held = session(Wish(topic="cooking"))
    assert held.finished
    assert held.summary() == ()


def test_an_unknown_language_is_named():
    with pytest.raises(ChoiceError, match=r"'fr'.*en, bn"):
        session(Wish(lang="fr"))


def test_all_templates_of_a_wish_come_before_one_returns():
    names = fitting(builtin(), Wish(topic="projection"))
    assert {builtin().rules(name).topic for name in names} == {"projection"}
    first, second = (
        [nth(builtin(), names, "x", turn * len(names) + n + 1) for n in range(len(names))]
        for turn in range(2)
    )
    assert sorted(first) == sorted(second) == sorted(names)
    assert first != second


def test_the_session_knows_no_terminal():
    code = "import sys, quizgen.practice.session\nprint('click' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
