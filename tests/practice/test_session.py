"""Sessions without a terminal: what is asked, tries, hints, outcomes, going on, the summary."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction

import msgspec
import pytest
from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.core.errors import AttemptFinishedError, InvalidChoiceError
from quizgen.kinds.grade import show_key
from quizgen.practice.part_attempt import TRIES, NextStep
from quizgen.practice.selection import matching_templates, question_seed, template_at
from quizgen.practice.session import Session
from quizgen.practice.session_state import PartOutcome, PracticeRequest, SessionState, new_session
from quizgen.practice.session_store import SessionStore
from quizgen.practice.topic_results import TopicResult, summarise_by_topic, weak_topics
from quizgen.question.compose import compose_question
from quizgen.question.formula_sheet import cite_formula
from quizgen.render.text import inlines_to_plain_text

WISH = PracticeRequest(count=2, topic="projection", tier="A")


def key_of(turn, state):
    template = builtin_bank().template(turn.question.template)
    return compose_question(template, question_seed(state.seed, turn.number), state.wish.lang)[1]


def session(wish=WISH, seed="s"):
    return Session(builtin_bank(), new_session(msgspec.structs.replace(wish, seed=seed)))


def kind_of(task):
    return task._keyed.spec["kind"]


def wrong(spec):
    """A readable answer that is neither right nor near."""
    table = msgspec.to_builtins(spec)
    return f"987654 {table.get('unit', '')}" if "value" in table else "(987654; 123457)"


def numeric_task():
    """The first task that a number or a point answers, and its spec."""
    held = session(PracticeRequest(count=50, topic="projection", tier="A"))
    while not held.is_finished:
        turn = held.current_question()
        for task, spec in zip(turn.tasks, key_of(turn, held.state).specs, strict=True):
            if kind_of(task) in {"point", "quantity"} and task.solved.lines:
                return task, spec
        held.state.done = turn.number
    raise AssertionError("no such task")


def test_a_right_answer_ends_the_task_at_once():
    task, spec = numeric_task()
    feedback = task.answer(show_key(spec))
    assert (feedback.then, feedback.left) == (NextStep.RIGHT, TRIES - 1)
    assert task.outcome == PartOutcome("projection", right=True, first=True)


def test_what_cannot_be_read_costs_no_try():
    task, _ = numeric_task()
    feedback = task.answer("???")
    assert (feedback.then, feedback.left, task.outcome) == (NextStep.ASK_BACK, TRIES, None)
    assert feedback.verdict.message == "", (
        "an answer is only judged; words are for whoever shows it"
    )
    assert task.explain_verdict(feedback.verdict).message


def test_three_wrong_answers_end_the_task():
    task, spec = numeric_task()
    found = [task.answer(wrong(spec)) for _ in range(3)]
    assert [(f.then, f.left) for f in found] == [
        (NextStep.AGAIN, 2), (NextStep.AGAIN, 1), (NextStep.OUT_OF_TRIES, 0),
    ]  # fmt: skip
    assert task.outcome == PartOutcome("projection", right=False, first=False)


@pytest.mark.parametrize("help_with", ["another try", "a hint"])
def test_right_after_help_is_not_right_at_once(help_with):
    task, spec = numeric_task()
    if help_with == "a hint":
        assert task.next_hint().why == task.solved.lines[0].why
    else:
        task.answer(wrong(spec))
    task.answer(show_key(spec))
    assert task.outcome == PartOutcome("projection", right=True, first=False)


def test_hints_climb_each_step_of_the_solution_in_turn_and_then_there_are_none():
    task, _ = numeric_task()
    steps = len(task.solved.lines)
    kinds = []
    while task.more_hints:
        kinds.append(task.next_hint().kind)
    assert kinds == ["quantity", "formula", "numbers", "result"] * steps
    assert task.next_hint() is None
    assert [hint.why for hint in task.hints[::4]] == [line.why for line in task.solved.lines]


def test_what_the_rungs_of_a_thin_lens_say():
    """By hand, for f = 60 mm and z = 150 mm: 1/60 - 1/150 = 0.01, of which the inverse is 100."""
    task = lens(new_session(PracticeRequest(topic="optics", seed="h"))).current_question().tasks[0]
    hints = [task.next_hint() for _ in range(8)]
    assert [inlines_to_plain_text(hint.shown).replace("\u00a0", " ") for hint in hints] == [
        "the reciprocal of the image distance (q)",
        "q = 1/f − 1/z",
        "q = 1/(60 mm) − 1/(150 mm)",
        "q = 0.01 mm⁻¹",
        "the image distance (z′)",
        "z′ = 1/q",
        "z′ = 1/(0.01 mm⁻¹)",
        "z′ = 100 mm",
    ]
    assert [hint.formula for hint in hints[:4]] == ["", "F42", "", ""]
    sheet = inlines_to_plain_text(cite_formula(builtin_bank(), "F42", "en"))
    assert sheet.startswith("F42, Thin lens")
    assert "1/f = 1/z + 1/z′" in sheet


def test_giving_up_is_not_right():
    task, _ = numeric_task()
    task.give_up()
    assert task.outcome == PartOutcome("projection", right=False, first=False)


ENDINGS = {
    "answered": lambda task, answer: task.answer(answer),
    "given up": lambda task, _: task.give_up(),
    "skipped": lambda task, _: task.skip(),
    "judged right": lambda task, _: task.self_mark(1.0),
}


@together("then", ENDINGS)
@together("ended", ENDINGS)
def test_a_part_that_has_ended_cannot_end_otherwise(ended, then):
    """Else a learner reads the solution, sends the answer again, and it counts as right."""
    task, spec = numeric_task()
    ENDINGS[ended](task, show_key(spec))
    before = msgspec.to_builtins(task.state)
    with pytest.raises(AttemptFinishedError):
        ENDINGS[then](task, show_key(spec))
    assert msgspec.to_builtins(task.state) == before


@pytest.mark.parametrize("share", [1.0, 0.5, 0.0])
def test_the_learner_judges_a_sentence(share):
    wish = PracticeRequest(count=200)
    held = session(wish)
    texts = (
        name for name in held.templates
        if any(part.answer["kind"] == "rubric" for part in builtin_bank().rules(name).part)
    )  # fmt: skip
    held.templates = (next(texts),)
    tasks = held.current_question().tasks
    task = next(t for t in tasks if kind_of(t) == "rubric")
    assert task.answer("something written").then is NextStep.SELF_MARK
    assert task.outcome is None
    task.self_mark(share)
    assert (task.outcome.right, task.outcome.first) == (share == 1, share == 1)
    assert task.state.credit == share


def test_a_question_goes_on_where_it_was_left():
    held = session()
    turn = held.current_question()
    assert len(turn.tasks) > 1
    turn.tasks[0].give_up()
    turn.tasks[1].next_hint()
    again = Session(
        builtin_bank(), msgspec.json.decode(msgspec.json.encode(held.state), type=SessionState)
    )
    later = again.current_question()
    assert later.question == turn.question
    assert [task.outcome for task in later.tasks] == [turn.tasks[0].outcome] + [None] * (
        len(turn.tasks) - 1
    )
    assert later.tasks[1].next_hint() == turn.tasks[1].next_hint()


def lens(state=None):
    """A question about a thin lens: image distance z', then the magnification that follows."""
    held = Session(builtin_bank(), state or new_session(PracticeRequest(topic="optics", seed="s")))
    held.templates = ("thin-lens-image-distance",)
    return held


def test_tries_survive_a_break():
    held = lens()
    for _ in range(TRIES - 1):
        assert held.current_question().tasks[0].answer("987654 mm").then is NextStep.AGAIN
    assert (
        lens(held.state).current_question().tasks[0].answer("987654 mm").then
        is NextStep.OUT_OF_TRIES
    )


def test_a_wrong_value_is_carried_forward_over_a_break():
    held = lens()
    turn = held.current_question()
    distance, size = (Fraction(spec.value) for spec in key_of(turn, held.state).specs[:2])
    turn.tasks[0].answer(f"{float(distance * 3 / 2):.6f} mm")
    turn.tasks[0].give_up()
    follows = f"{float(size * 3 / 2):.6f}"
    assert (
        lens(held.state).current_question().tasks[1].answer(follows).verdict.note
        == "carried-forward"
    )


def test_how_far_another_question_got_says_nothing_about_this_one():
    held = session()
    turn = held.current_question()
    turn.tasks[0].give_up()
    held.state.question = "another(x=1)"
    assert not held.current_question().outcomes


def test_a_skipped_part_is_neither_right_nor_wrong():
    held = session()
    task = held.current_question().tasks[0]
    task.skip()
    assert task.outcome == PartOutcome("projection", right=False, first=False, skipped=True)
    assert summarise_by_topic([task.outcome]) == (TopicResult("projection", 0, 0, 0, 1),)


def test_a_kept_session_goes_on_where_it_stopped(tmp_path):
    shelf, held = SessionStore(tmp_path / "deep"), session()
    turn = held.current_question()
    for task in turn.tasks:
        task.give_up()
    assert turn.is_finished
    held.finish(turn)
    shelf.save(held.state)
    state = shelf.load(held.state.wish)
    assert state == held.state
    assert [p.name for p in shelf.folder.iterdir()] == [shelf.path(state.wish).name]
    later = Session(builtin_bank(), state).current_question()
    assert later.number == 2
    assert later.question == held.current_question().question


WISHES = [
    PracticeRequest(), PracticeRequest(lang="bn"), PracticeRequest(count=3), PracticeRequest(topic="noise"), PracticeRequest(tier="B"), PracticeRequest(bank="x"),
    PracticeRequest(seed="a"), PracticeRequest(topic="noise", tier="B"),
]  # fmt: skip


def test_every_wish_has_a_session_of_its_own(tmp_path):
    shelf = SessionStore(tmp_path)
    states = [new_session(wish) for wish in WISHES]
    for number, state in enumerate(states):
        state.done = number
        shelf.save(state)
    assert [shelf.load(wish) for wish in WISHES] == states
    shelf.delete(WISHES[0])
    assert [shelf.load(wish) for wish in WISHES] == [None, *states[1:]]


def test_a_session_of_another_wish_or_a_broken_one_is_not_taken_up(tmp_path):
    shelf = SessionStore(tmp_path)
    assert shelf.load(WISH) is None
    shelf.save(new_session(PracticeRequest(count=3)))
    shelf.path(PracticeRequest(count=3)).rename(shelf.path(WISH))
    assert shelf.load(WISH) is None
    for text in ("{not json", "[]", '{"wish": {}, "seed": 3}', "[" * 5000):
        shelf.path(WISH).write_text(text)
        assert shelf.load(WISH) is None


def outcomes(topic, *, right, wrong):
    return [PartOutcome(topic, right=True, first=True)] * right + [
        PartOutcome(topic, right=False, first=False)
    ] * wrong


def test_what_to_practise_is_what_goes_worst():
    results = summarise_by_topic(
        outcomes("a", right=3, wrong=1) + outcomes("b", right=5, wrong=0)
        + outcomes("c", right=0, wrong=2) + outcomes("d", right=1, wrong=2)
        + outcomes("e", right=8, wrong=1)
    )  # fmt: skip
    assert weak_topics(results) == ("c", "d", "a")
    assert weak_topics(summarise_by_topic(outcomes("b", right=5, wrong=0))) == ()


def test_only_the_latest_parts_of_a_topic_say_how_well_it_is_known():
    past = outcomes("a", right=0, wrong=30) + outcomes("a", right=30, wrong=0)
    assert summarise_by_topic(past, 30) == (TopicResult("a", 30, 30, 0),)


def test_new_sessions_differ_and_a_seed_is_kept():
    assert new_session(WISH).seed != new_session(WISH).seed
    assert new_session(PracticeRequest(seed="abc")).seed == "abc"


def test_somebody_else_may_choose_and_what_is_due_stays_due(tmp_path):
    asked = []

    def choose(names):
        asked.append(len(names))
        return "thin-lens-image-distance", "0a1b2c3d"

    wish = PracticeRequest(topic="optics")
    held = Session(builtin_bank(), new_session(wish), choose)
    turn = held.current_question()
    assert (turn.question.template, turn.seed) == ("thin-lens-image-distance", "0a1b2c3d")
    SessionStore(tmp_path).save(held.state)
    again = Session(builtin_bank(), SessionStore(tmp_path).load(wish), choose)
    assert again.current_question().question == turn.question
    assert len(asked) == 1
    for task in turn.tasks:
        task.give_up()
    held.finish(turn)
    held.current_question()
    assert len(asked) == 2


def test_the_summary_counts_by_topic():
    outcomes = [
        PartOutcome("optics", right=True, first=True),
        PartOutcome("colour", right=True, first=False),
        PartOutcome("optics", right=False, first=False),
    ]
    held = Session(builtin_bank(), SessionState(WISH, "s", 2, outcomes))
    assert held.is_finished
    found = [(row.topic, row.count, row.right, row.later) for row in held.summary()]
    assert found == [("colour", 1, 0, 1), ("optics", 2, 1, 0)]


def test_a_wish_that_nothing_fits_is_finished_at_once():
    held = session(PracticeRequest(topic="cooking"))
    assert held.is_finished
    assert held.summary() == ()


def test_an_unknown_language_is_named():
    with pytest.raises(InvalidChoiceError, match=r"'fr'.*en, bn"):
        session(PracticeRequest(lang="fr"))


def test_all_templates_of_a_wish_come_before_one_returns():
    names = matching_templates(builtin_bank(), PracticeRequest(topic="projection"))
    assert {builtin_bank().rules(name).topic for name in names} == {"projection"}
    first, second = (
        [
            template_at(builtin_bank(), names, "x", turn * len(names) + n + 1)
            for n in range(len(names))
        ]
        for turn in range(2)
    )
    assert sorted(first) == sorted(second) == sorted(names)
    assert first != second


def test_the_session_knows_no_terminal():
    code = "import sys, quizgen.practice.session\nprint('click' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
