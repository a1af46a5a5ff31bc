"""Strings that nobody means, typed to every part of the bank: refused, never a crash, never slow."""

from __future__ import annotations

import random
import re
import time
import unicodedata
from functools import cache

import pytest
from msgspec import to_builtins
from sweep import draws

from quizgen.bank.bank import builtin_bank
from quizgen.kinds.derivation import DerivationSpec
from quizgen.kinds.grade import grade_answer, load_spec, show_key
from quizgen.question.compose import draw_instance
from quizgen.question.part_context import ask_part

pytestmark = pytest.mark.slow

SEED = 20261128
LIMIT = 0.5
"""CPU seconds that an answer may take at most."""
NOT_TYPED = {"program", "checked", "rubric", "witness"}
"""Kinds that are judged by a process, or have no single right answer."""
SIGNS = (
    "0123456789.,;:+-*/^()[]{}|=<>≤≥≠%°√π∞ xXeEfkrZmpsuµ_'\"\\#@!&~\t\n"
    "০১৯৫২³½×·−–—\u200b\u202e\u00a0abcABCসত্য।"
)
WORDS = [
    "1",
    "2",
    "0",
    "0.5",
    "10",
    "true",
    "false",
    "mm",
    "px",
    "s",
    "and",
    "or",
    "not",
    "A",
    "B",
    "C",
    "x",
    "y",
    "=",
    ";",
    ",",
    "no",
    "yes",
    "left",
    "right",
    "red",
    "the",
    "কম",
    "বেশি",
    "->",
    "(",
    ")",
    "%",
    "*",
    "/",
    "^",
    "-",
    "+",
]
WORD = re.compile(r"\d+(?:[.,]\d+)*|[^\W\d]+")
TRUE = {
    "true",
    "tru",
    "t",
    "yes",
    "y",
    "right",
    "correct",
    "r",
    "w",
    "j",
    "1",
    "a",
    "ঠিক",
    "সত্য",
    "স",
}
FALSE = {"false", "f", "no", "n", "wrong", "0", "2", "b"}


@cache
def parts():
    """Each part of the bank that is typed: its name and what it asks."""
    bank, found = builtin_bank(), []
    for name in bank.template_paths:
        template = bank.template(name)
        drawn = draw_instance(template, 3)
        for index in range(len(template.rules.part)):
            spec = ask_part(drawn, index).spec
            if to_builtins(spec)["kind"] not in NOT_TYPED:
                found.append((f"{name}.{index}", load_spec(to_builtins(spec))))
    return found


def random_text(source, number):
    if number % 2:
        return "".join(source.choices(SIGNS, k=source.randint(1, 14)))
    words = source.choices(WORDS, k=source.randint(1, 5))
    return "".join(word + source.choice(["", "", " "]) for word in words)


def mutated(source, text):
    signs = list(text)
    for _ in range(source.randint(1, 4)):
        place, action = source.randint(0, len(signs)), source.random()
        if action < 0.4:
            signs.insert(place, source.choice(SIGNS))
        elif signs and action < 0.7:
            del signs[min(place, len(signs) - 1)]
        elif signs:
            signs[min(place, len(signs) - 1)] = source.choice(SIGNS)
    return "".join(signs)


def names_the_option(table, typed):
    """Whether a letter, a place, a truth value or a word of a right option stands in a text."""
    options, right = table.get("options", ()), set()
    for place in table.get("correct", ()):
        right |= {str(place), "abcdefgh"[place - 1]}
        right |= set(WORD.findall(options[place - 1].casefold()))
        if table["kind"] == "tf":
            right |= TRUE if place == 1 else FALSE
    text = unicodedata.normalize("NFKC", typed).casefold()
    digits = "".join(str(int(sign)) if sign.isdigit() else sign for sign in text)
    return bool(right & set(WORD.findall(digits)))


def test_random_strings_are_right_only_where_an_option_is_named():
    source = random.Random(SEED)
    accepted = []
    for number in range(draws(2_000, full=5_000)):
        name, spec = source.choice(parts())
        typed = random_text(source, number)
        verdict = grade_answer(spec, typed)
        if verdict.verdict == "correct":
            table = to_builtins(spec)
            concluded = typed.removeprefix("-> ") == verdict.read_as  # as a person writes it
            accepted += [] if concluded or names_the_option(table, typed) else [(name, typed)]
    assert accepted == []


def test_what_is_true_of_a_letter_alone_earns_nothing_in_a_derivation():
    earned = [
        (name, line)
        for name, spec in parts()
        if isinstance(spec, DerivationSpec)
        for letter in spec.symbols
        for line in (f"{letter} = {letter}", f"{letter} != -24", f"{letter} > -1000")
        if grade_answer(spec, line).credit
    ]
    assert earned == []


def test_mutations_of_right_answers_neither_crash_nor_hang():
    source = random.Random(SEED)
    for _ in range(draws(3_000, full=8_000)):
        name, spec = source.choice(parts())
        typed = mutated(source, show_key(spec))
        decimal, lang = source.choice(["auto", "point", "comma"]), source.choice(["en", "bn", "de"])
        begun = time.process_time()
        verdict = grade_answer(spec, typed, decimal=decimal, lang=lang)
        seconds = time.process_time() - begun
        assert 0 <= verdict.credit <= 1
        assert verdict.credit == 1 or verdict.is_graded or verdict.message, (name, typed)
        if seconds >= LIMIT:  # the first may load what is needed
            begun = time.process_time()
            grade_answer(spec, typed, decimal=decimal, lang=lang)
            assert time.process_time() - begun < LIMIT, (name, typed)
