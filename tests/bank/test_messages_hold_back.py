"""No message tells the answer while there are tries left: nonsense typed into every part."""

from __future__ import annotations

import re

from sweep import spread, together

from quizgen.bank.bank import builtin_bank
from quizgen.grading.judge import explain_verdict, judge_answer
from quizgen.grading.options import GradingOptions
from quizgen.grading.spec import NumericSpec
from quizgen.kinds.choice import ChoiceSpec
from quizgen.kinds.code import CodeSpec
from quizgen.kinds.gap import GapSpec
from quizgen.kinds.match import MatchSpec
from quizgen.kinds.order import OrderSpec
from quizgen.question.compose import compose_question

NONSENSE = ("zzzzzzz", "987654321", "জজজজজজজ", "qqqq; zzzz; wwww; vvvv")
NAMES = sorted(template.id for template in builtin_bank())
WITH_GAPS = [
    name
    for name in NAMES
    if any(part.answer["kind"] == "gap" for part in builtin_bank().rules(name).part)
]
OTHERS = [name for name in NAMES if name not in WITH_GAPS]
SHORTEST = 3


def wanted_words(spec) -> set[str]:
    """What a message must not hold: accepted words, or the key as it is printed."""
    if isinstance(spec, GapSpec):
        return {word.lower() for gap in spec.gaps() for word in gap if len(word) >= SHORTEST}
    shown = spec.show().lower() if isinstance(spec, (NumericSpec, CodeSpec)) else ""
    return {shown} if len(shown) >= SHORTEST else set()


@together("name", [*WITH_GAPS, *spread(OTHERS, 24)])
def test_nonsense_is_answered_without_the_answer(name):
    template = builtin_bank().template(name)
    for spec in compose_question(template, "1", "en")[1].specs:
        for typed in NONSENSE:
            verdict = judge_answer(spec, typed, GradingOptions())
            for lang in ("en", "bn", "de"):
                message = explain_verdict(spec, verdict, lang, reveal=False).message.lower()
                assert [word for word in wanted_words(spec) if word in message] == [], typed


def wrong_picks(spec):
    """Wrong answers that are one choice, pair or step away, with the words that were wanted."""
    if isinstance(spec, ChoiceSpec) and spec.kind == "choice":
        (right,) = spec.correct
        for place in range(1, len(spec.options) + 1):
            if place != right:
                yield str(place), [spec.options[right - 1]]
    elif isinstance(spec, MatchSpec):
        sides = {label for label in spec.words if label not in spec.pairs} | {*spec.pairs.values()}
        for left, right in spec.pairs.items():
            for other in sorted(sides - {right}):
                yield f"{left}{other}", [spec.words.get(right, "")]
    elif isinstance(spec, OrderSpec):
        right = spec.show().split()
        for place in range(len(right) - 1):
            swapped = [*right[:place], right[place + 1], right[place], *right[place + 2 :]]
            yield " ".join(swapped), [spec.words.get(step, "") for step in right]


def holds(message: str, words: str) -> bool:
    bare = " ".join(re.split(r"[^\w\u0980-\u09ff]+", words.lower())).strip()
    plain = " ".join(re.split(r"[^\w\u0980-\u09ff]+", message.lower()))
    return len(bare) >= SHORTEST and f" {bare} " in f" {plain} "


@together("name", spread(NAMES, 24))
def test_a_wrong_pick_is_answered_without_the_right_one(name):
    for spec in compose_question(builtin_bank().template(name), "1", "en")[1].specs:
        for typed, wanted in wrong_picks(spec):
            verdict = judge_answer(spec, typed, GradingOptions())
            message = explain_verdict(spec, verdict, "en", reveal=False).message
            assert [words for words in wanted if holds(message, words)] == [], typed


def test_the_reasons_are_said_in_the_end():
    template = builtin_bank().template("rods-cones-and-peaks")
    specs = [s for s in compose_question(template, "1", "en")[1].specs if isinstance(s, GapSpec)]
    assert specs
    for spec in specs:
        typed = "; ".join(["zzzzzzz"] * len(spec.gaps()))
        verdict = judge_answer(spec, typed, GradingOptions())
        early, late = (
            explain_verdict(spec, verdict, "en", reveal=reveal).message for reveal in (False, True)
        )
        assert early
        assert late.startswith(early)
