"""When a template is asked again: the same as ``fsrs`` itself says, at moments written down."""

from __future__ import annotations

from datetime import UTC, date, datetime, timedelta

import fsrs
import pytest
from sweep import together

from quizgen.practice.agenda import Agenda
from quizgen.practice.scheduler import (
    DAY,
    ReviewEvent,
    ReviewRating,
    days_left,
    due_time,
    iter_reviewed_cards,
    rate_outcomes,
    review_card,
)
from quizgen.practice.session_state import PartOutcome

NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)
NOW = NOON.timestamp()
NAME = ("template", "A3")
RIGHT = PartOutcome("projection", right=True, first=True)
LATER = PartOutcome("projection", right=True, first=False)
WRONG = PartOutcome("projection", right=False, first=False)
SKIPPED = PartOutcome("projection", right=False, first=False, skipped=True)


def theirs(reviews, most=36500):
    """What fsrs makes of (days, rating) from a new card on."""
    scheduler = fsrs.Scheduler(enable_fuzzing=False, maximum_interval=most)
    card = fsrs.Card(card_id=1, due=NOON)
    for days, rating in reviews:
        card, _ = scheduler.review_card(card, rating, NOON + timedelta(days=days))
    return card


@together("grades", ["3", "1", "33", "3331", "2323", "1133", "333333"])
def test_a_card_goes_the_way_of_fsrs(grades):
    reviews = [(3 * place, int(grade)) for place, grade in enumerate(grades)]
    card = None
    for days, grade in reviews:
        card = review_card(card, NAME, ReviewRating(grade), NOW + days * DAY)
    expected = theirs([(days, fsrs.Rating(grade)) for days, grade in reviews])
    assert (card.stability, card.difficulty) == (expected.stability, expected.difficulty)
    assert card.due == expected.due.timestamp()
    assert (card.state, card.step) == (int(expected.state), expected.step)


def test_the_first_times_by_hand():
    """The weights of FSRS-6: 2.3065 days after a first right answer, 0.212 after a wrong one."""
    good = review_card(None, NAME, ReviewRating.GOOD, NOW)
    wrong = review_card(None, NAME, ReviewRating.AGAIN, NOW)
    assert (good.stability, good.due - NOW) == (2.3065, 600)
    assert (wrong.stability, wrong.due - NOW) == (0.212, 60)
    second = review_card(good, NAME, ReviewRating.GOOD, NOW + 600)
    assert second.due - second.last == 2 * DAY


def test_an_exam_caps_the_intervals():
    card = None
    for day in (0, 1, 4, 12):
        card = review_card(card, NAME, ReviewRating.GOOD, NOW + day * DAY)
    now = NOW + 40 * DAY
    assert review_card(card, NAME, ReviewRating.GOOD, now).due > now + 30 * DAY
    assert review_card(card, NAME, ReviewRating.GOOD, now, 9).due == now + 9 * DAY


def test_a_date_that_is_set_later_brings_cards_forward():
    card = None
    for day in (0, 1, 4, 12):
        card = review_card(card, NAME, ReviewRating.GOOD, NOW + day * DAY)
    assert due_time(card, NOW + 13 * DAY, None) == card.due > NOW + 20 * DAY
    assert due_time(card, NOW + 13 * DAY, 3) == NOW + 15 * DAY
    assert due_time(card, NOW + 12.5 * DAY, 1) == card.last + DAY


def test_days_left():
    today = date(2027, 2, 2)
    assert days_left(date(2027, 2, 12), today) == 10
    assert days_left(today, today) is None
    assert days_left(date(2027, 1, 1), today) is None
    assert days_left(None, today) is None


@together(
    ("outcomes", "grade"),
    [
        ([RIGHT, RIGHT], ReviewRating.GOOD), ([RIGHT, LATER], ReviewRating.HARD), ([RIGHT, WRONG], ReviewRating.AGAIN),
        ([RIGHT, SKIPPED], ReviewRating.GOOD), ([SKIPPED], None), ([], None),
    ],
)  # fmt: skip
def test_the_grade_of_a_question(outcomes, grade):
    assert rate_outcomes(outcomes) is grade


def told(cards, asked, now):
    for card in list(iter_reviewed_cards(cards, asked, now)):
        cards[card.kind, card.name] = card


def test_a_mistake_has_a_card_of_its_own():
    cards = {}
    told(cards, ReviewEvent("A3", ReviewRating.AGAIN, ("trap:swapped", "brackets", "")), NOW)
    assert set(cards) == {("template", "A3"), ("mistake", "A3/trap:swapped")}
    mistake = cards["mistake", "A3/trap:swapped"]
    assert (mistake.template, mistake.note) == ("A3", "trap:swapped")
    assert mistake.due == NOW + 60
    told(cards, ReviewEvent("B1", ReviewRating.GOOD), NOW + DAY)
    assert cards["mistake", "A3/trap:swapped"] is mistake
    told(cards, ReviewEvent("A3", ReviewRating.AGAIN), NOW + DAY)
    assert cards["mistake", "A3/trap:swapped"] is mistake, (
        "a question that went wrong proves nothing"
    )
    told(cards, ReviewEvent("A3", ReviewRating.GOOD), NOW + 2 * DAY)
    assert cards["mistake", "A3/trap:swapped"].last == NOW + 2 * DAY


@pytest.fixture
def names(bank):
    return [
        name for name in bank.template_paths if bank.rules(name).topic in {"projection", "noise"}
    ]


def agenda(bank, cards, now=NOW, exam=None):
    return Agenda(bank, cards, now, exam)


def card(bank, name, grade, now):
    return {("template", bank.origin(name)): review_card(
        None, ("template", bank.origin(name)), grade, now)}  # fmt: skip


def test_how_far_a_topic_is_known(bank, names):
    cards = card(bank, names[0], ReviewRating.GOOD, NOW - 5) | card(
        bank, names[1], ReviewRating.AGAIN, NOW - 90
    )
    standing = agenda(bank, cards).mastery_of(names)
    assert (standing.count, standing.seen) == (len(names), 2)
    assert (standing.last, standing.stability) == (NOW - 5, 0.212)
    assert standing.due == NOW - 30
    nothing = agenda(bank, {}).mastery_of(names)
    assert (nothing.seen, nothing.last, nothing.due) == (0, None, None)
