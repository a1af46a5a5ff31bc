"""Interactions as an item has them: declaration, body, response processing and feedback.

Engines treat ``null`` in comparisons in different ways, so all rules are guarded by a test whether
there is a response (``item``); and not all know ``equal`` with a tolerance, so an interval is two
comparisons.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import singledispatch

from markupsafe import Markup

from quizgen.lms.answer_ranges import AnswerRange
from quizgen.lms.interactions import (
    ChoiceInteraction,
    ExtendedTextInteraction,
    FeedbackText,
    Interaction,
    MatchInteraction,
    NumericInteraction,
    OrderInteraction,
    TextEntryInteraction,
    TrueFalseInteraction,
    order_as_match,
)
from quizgen.lms.markup import field_html, option_html, to_course_html
from quizgen.lms.qti.dialect import Attributes, format_number_plain
from quizgen.lms.qti.response_rules import ResponseRules
from quizgen.locale import translate
from quizgen.typeset.prose import PlainText

# Characters that a field for a number or a word has room for.
FIELD_LENGTH = 20
# Pairs as a table to tick, in the vocabulary of QTI 3.0: no dragging is needed.
TABULAR = "qti-match-tabular"

_EMPTY = Markup("")


@dataclass(frozen=True, slots=True)
class FeedbackElement:
    """Feedback that is shown when an outcome has this value."""

    outcome: str
    value: str
    words: FeedbackText


@dataclass(frozen=True, slots=True)
class RenderedInteraction:
    """The pieces of an item that an interaction becomes.

    ``processing`` are the rules of a response that was given, ``outcomes`` the declarations that
    ``feedback`` depends on. ``inline`` is the field alone, if it can stand in a sentence.
    """

    declaration: Markup
    body: Markup
    processing: Markup = _EMPTY
    outcomes: Markup = _EMPTY
    feedback: Sequence[FeedbackElement] = ()
    inline: Markup = _EMPTY


@singledispatch
def render_interaction(interaction: Interaction, _rules: ResponseRules) -> RenderedInteraction:
    """Return the pieces of an item that an interaction becomes."""
    raise TypeError(type(interaction).__name__)


@render_interaction.register
def _render_number(interaction: NumericInteraction, rules: ResponseRules) -> RenderedInteraction:
    """Return a numeric interaction: two comparisons for each interval."""
    right = [_is_within(one, rules) for one in interaction.ranges if one.right]
    wrong = [
        (_is_within(one, rules), one.feedback, one.share)
        for one in interaction.ranges
        if not one.right and (one.feedback or one.share)
    ]
    declaration = rules.declare_response(
        "single float", [format_number_plain(interaction.key.value)]
    )
    body = field_html(interaction, _text_entry(rules), rules.lang, rules.label)
    return _render_typed(rules, declaration, body, right, wrong)


def _is_within(one: AnswerRange, rules: ResponseRules) -> Markup:
    """Return the condition that the response lies in an interval."""
    response = rules.response_variable()
    low = rules.tag("gte", {}, response, rules.constant("float", one.low))
    return rules.tag(
        "and", {}, low, rules.tag("lte", {}, response, rules.constant("float", one.high))
    )


@render_interaction.register
def _render_text(interaction: TextEntryInteraction, rules: ResponseRules) -> RenderedInteraction:
    """Return a text entry: one comparison for each accepted or wrong text."""

    def is_same(typed: str) -> Markup:
        """Return the condition that the response is this text."""
        how = {"caseSensitive": str(interaction.printed).lower()}
        text = rules.constant("string", typed)
        return rules.tag("stringMatch", how, rules.response_variable(), text)

    right = [is_same(typed) for typed in interaction.right]
    wrong = [(is_same(typed), words, 0.0) for typed, words in interaction.wrong if words]
    declaration = rules.declare_response("single string", interaction.right[:1])
    body = Markup("<p>{}{}</p>").format(rules.label, _text_entry(rules))
    return _render_typed(rules, declaration, body, right, wrong)


def _text_entry(rules: ResponseRules) -> Markup:
    """Return the field of a number or a word."""
    return rules.interaction("textEntryInteraction", {"expectedLength": FIELD_LENGTH})


def _render_typed(
    rules: ResponseRules,
    declaration: Markup,
    body: Markup,
    right: list[Markup],
    wrong: Sequence[tuple[Markup, FeedbackText, float]],
) -> RenderedInteraction:
    """Return a typed interaction: all marks for the key, feedback for a misconception.

    ``right`` are conditions, ``wrong`` conditions with feedback and the share of the marks that the
    mistake still earns; the first that holds counts.
    """
    name = rules.feedback_name
    feedback = [FeedbackElement(name, f"M{i}", words) for i, (_, words, _) in enumerate(wrong, 1)]
    cases = [(rules.any_of(right), rules.set_score(rules.points))]
    for one, (condition, _, share) in zip(feedback, wrong, strict=True):
        earned = rules.set_score(rules.points * share) if share else _EMPTY
        cases.append((condition, earned + rules.set_feedback(name, one.value)))
    outcomes = rules.declare_feedback(name) if feedback else _EMPTY
    processing = rules.first_case(cases)
    return RenderedInteraction(
        declaration, body, processing, outcomes, feedback, _text_entry(rules)
    )


@render_interaction.register
def _render_true_false(
    interaction: TrueFalseInteraction, rules: ResponseRules
) -> RenderedInteraction:
    """Return a statement as a choice of true and false."""
    options = {
        name: Markup.escape(translate(rules.lang, f"ask.{name}")) for name in ("true", "false")
    }
    right = "true" if interaction.true else "false"
    feedback = {name: interaction.feedback for name in options if name != right}
    return _render_options(rules, options, [right], feedback, many=False)


@render_interaction.register
def _render_choice(interaction: ChoiceInteraction, rules: ResponseRules) -> RenderedInteraction:
    """Return a choice with feedback on each option."""
    options = {
        one.letter: option_html(one.letter, one.words, rules.lang) for one in interaction.options
    }
    right = [one.letter for one in interaction.right]
    feedback = {one.letter: one.feedback for one in interaction.options}
    return _render_options(rules, options, right, feedback, many=interaction.many)


def _render_options(
    rules: ResponseRules,
    options: Mapping[str, Markup],
    right: Sequence[str],
    feedback: Mapping[str, FeedbackText],
    *,
    many: bool,
) -> RenderedInteraction:
    """Return a choice; the response itself is the outcome that selects feedback.

    With ``many``, a wrong option takes away what a right one gives.
    """
    identify, name = rules.choice_identifier, rules.feedback_name
    cardinality = "multiple" if many else "single"
    share = rules.points / max(len(right), 1)
    shares = {identify(letter): share if letter in right else -share for letter in options}
    mapping = [rules.score_mapping(shares)] if many else []
    declaration = rules.declare_response(
        f"{cardinality} identifier", map(identify, right), *mapping
    )
    elements = [
        FeedbackElement(name, identify(letter), words)
        for letter, words in feedback.items()
        if words
    ]
    outcomes, processing = _EMPTY, rules.match_correct(partly=many)
    if elements:
        outcomes = rules.declare_feedback(name, cardinality)
        processing += rules.set_outcome(name, rules.response_variable())
    body, inline = (
        rules.interaction(
            f"{name}Interaction",
            {"shuffle": "false", **how},
            *(rules.tag(choice, {"identifier": identify(mark)}, options[mark]) for mark in options),
        )
        for name, choice, how in (
            ("choice", "simpleChoice", {"maxChoices": 0 if many else 1}),
            ("inlineChoice", "inlineChoice", dict[str, float]()),
        )
    )
    if many or any(
        "<" in shown for shown in options.values()
    ):  # a list drops down with words alone
        inline = _EMPTY
    return RenderedInteraction(declaration, body, processing, outcomes, elements, inline)


@render_interaction.register
def _render_match(interaction: MatchInteraction, rules: ResponseRules) -> RenderedInteraction:
    """Return a table to tick; each wrong pair has its own feedback."""
    stems, targets = interaction.stems, interaction.targets
    shares = {
        rules.pair_identifier(*pair): rules.points / len(stems)
        for pair in interaction.right.items()
    }
    declaration = rules.declare_response(
        "multiple directedPair", shares, rules.score_mapping(shares)
    )
    outcomes, processing = _EMPTY, rules.match_correct(partly=True)
    feedback: list[FeedbackElement] = []
    for stem, _ in stems:
        outcome = f"{rules.feedback_name}_{stem}"
        wrong = [(letter, interaction.feedback.get((stem, letter), ())) for letter, _ in targets]
        found = [
            FeedbackElement(outcome, rules.choice_identifier(letter), words)
            for letter, words in wrong
            if words
        ]
        if found:
            outcomes += rules.declare_feedback(outcome)
            processing += rules.first_case(
                (_is_paired(stem, one, rules), rules.set_feedback(outcome, one.value))
                for one in found
            )
        feedback += found
    how: Attributes = {"class": TABULAR, "shuffle": "false", "maxAssociations": len(stems)}
    # A target may be used any number of times, which is 0.
    sides = (_match_side(stems, 1, rules), _match_side(targets, 0, rules))
    body = rules.interaction("matchInteraction", how, *sides)
    return RenderedInteraction(declaration, body, processing, outcomes, feedback)


def _is_paired(stem: str, one: FeedbackElement, rules: ResponseRules) -> Markup:
    """Return the condition that a stem was given the target of this feedback."""
    pair = rules.constant("directedPair", f"{rules.choice_identifier(stem)} {one.value}")
    return rules.tag("member", {}, pair, rules.response_variable())


def _match_side(
    rows: Sequence[tuple[str, FeedbackText]], most: int, rules: ResponseRules
) -> Markup:
    """Return one side of a match; each row may be used ``most`` times, 0 for any number."""
    choices = [
        rules.tag(
            "simpleAssociableChoice",
            {"identifier": rules.choice_identifier(letter), "matchMax": most},
            letter if words == (PlainText(letter),) else option_html(letter, words, rules.lang),
        )
        for letter, words in rows
    ]
    return rules.tag("simpleMatchSet", {}, *choices)


@render_interaction.register
def _render_order(interaction: OrderInteraction, rules: ResponseRules) -> RenderedInteraction:
    """Return steps to sort, with a share of the marks for each step in its place."""
    if not interaction.is_complete:
        return _render_match(order_as_match(interaction, rules.lang), rules)
    right = [rules.choice_identifier(letter) for letter in interaction.right]
    share = rules.add_score(rules.points / len(right))
    partly = Markup("").join(
        rules.first_case([(_is_in_place(step, place, rules), share)])
        for place, step in enumerate(right, 1)
    )
    steps = [
        rules.tag(
            "simpleChoice",
            {"identifier": rules.choice_identifier(letter)},
            option_html(letter, words, rules.lang),
        )
        for letter, words in interaction.steps
    ]
    declaration = rules.declare_response("ordered identifier", right)
    body = rules.interaction("orderInteraction", {"shuffle": "false"}, *steps)
    processing = rules.first_case([(rules.is_correct(), rules.set_score(rules.points))], partly)
    return RenderedInteraction(declaration, body, processing)


def _is_in_place(step: str, place: int, rules: ResponseRules) -> Markup:
    """Return the condition that a step stands at a place, counted from 1."""
    there = rules.tag("index", {"n": place}, rules.response_variable())
    return rules.tag("match", {}, there, rules.constant("identifier", step))


@render_interaction.register
def _render_extended_text(
    interaction: ExtendedTextInteraction, rules: ResponseRules
) -> RenderedInteraction:
    """Return a field that a person grades by a key that learners do not see."""
    key = Markup("<p>{}</p>").format(to_course_html(interaction.key, rules.lang))
    rubric = rules.dialect.flow("rubricBlock", {"view": "scorer", "use": "scoring"}, key)
    body = rules.interaction("extendedTextInteraction", {"expectedLines": interaction.lines})
    return RenderedInteraction(rules.declare_response("single string", ()), body + rubric)
