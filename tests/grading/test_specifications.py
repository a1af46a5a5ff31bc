"""Specifications as structs and as the plain tables of a key."""

from __future__ import annotations

import json

import msgspec
import pytest
from sweep import together

from quizgen.core.errors import KeyFileError
from quizgen.kinds import KINDS, choice, number
from quizgen.kinds.grade import grade_answer, load_spec, show_key
from quizgen.maths.tolerance import Tolerance

NOTES = {"en": {"half": "You took half."}, "bn": {"half": "অর্ধেক নিয়েছ।"}}

FULL = [
    {"kind": "rubric", "full": "2",
     "criteria": {"why": {"points": "2", "accept": ["since it falls"], "half": ["it falls"],
                          "refuse": ["it rises"], "follows": "what"},
                  "what": {"points": "1", "accept": ["a stone"]}},
     "ideas": {"en": {"why": "It falls."}}, "model": {"en": "A stone falls."},
     "mistakes": {"up": ["it rises"]}, "synonyms": [["stone", "rock"]]},
    {"kind": "checked", "check": "abc", "example": "1 6", "function": "judge",
     "values": {"n": "6", "x": ["1", "2"]}},
    {"kind": "number", "bound": "most", "decimals": 3, "within": "1/2", "accept": ["1", "2"], "strict": True,
     "value": "20/3", "traps": {"half": "10/3", "two": ["1", "2"]}, "notes": NOTES, "of": ["x"],
     "form": "decimal", "percent": True, "notation": "f-number"},
    {"kind": "number", "sigfigs": 3, "value": "5", "unit": "px"},
    {"kind": "number", "value": "5", "base": 2},
    {"kind": "number", "value": "5", "counts": ["px", "level"]},
    {"kind": "number", "exact": True, "value": "57", "base": 16},
    {"kind": "quantity", "bound": "most", "rel": "0.005", "value": "50", "unit": "mm", "bare": True,
     "traps": {"half": "25"}, "notes": NOTES, "of": ["f"]},
    {"kind": "angle", "bound": "least", "abs": "0.5", "value": "140", "period": "180", "of": ["H"]},
    {"kind": "set", "values": ["1", "2"], "unit": "cr", "define": ["crate = [goods] = cr"]},
    {"kind": "point", "exact": True, "values": ["440", "160"], "names": ["u", "v"], "unit": "px",
     "counts": ["px"], "up_to_scale": True, "traps": {"half": ["1", "2"]}, "of": ["u", "v"],
     "called": {"u": ["column"]}},
    {"kind": "table", "exact": True, "values": {"V": "1", "H": "2"}, "units": {"V": "px"},
     "counts": {"V": ["px"]}, "cells": {"H": {"kind": "angle", "abs": "0.5"}}, "traps": {"half": {"V": "3"}},
     "of": {"V": "V", "H": "H"}, "called": {"V": ["value"]}},
    {"kind": "set", "values": ["1", "2"], "unit": "mm", "traps": {"half": ["3"]}},
    {"kind": "interval", "value": "]0; 1]", "abs": "0.01", "brackets": "any"},
    {"kind": "expression", "value": "f*X/Z", "symbols": {"f": "positive", "X": "real", "Z": [1, 2]},
     "traps": {"half": "f*X"}},
    {"kind": "expression", "value": "x^3", "symbols": {"x": "real"}, "form": "expanded",
     "up_to": "constant", "calls": {"x": "f(n)"}},
    {"kind": "set", "values": ["1"], "letters": ["a", "b"], "exact": True},
    {"kind": "equation", "value": "x = 2*y", "symbols": ["x", "y"], "traps": {"half": "x = y"}},
    {"kind": "complex", "parts": ["1", "-2"], "form": "polar", "rel": "0.01", "unit": "V", "traps": {"half": ["1", "2"]}},
    {"kind": "matrix", "entries": [["1", "2"], ["3", "1/4"]], "decimals": 2, "unit": "V", "traps": {"half": [["1", "2"]]}},
    {"kind": "vector", "components": ["1", "2"], "up_to": "scale", "rel": "0.01", "unit": "N", "traps": {"half": ["1", "1"]}},
    {"kind": "choice", "options": ["a", "b"], "said": [["c", "d"]], "correct": [2],
     "traps": {"half": 1}},
    {"kind": "multi", "options": ["a", "b", "c"], "correct": [2, 3], "negative": False,
     "traps": {"half": [1, 2]}},
    {"kind": "tf", "correct": [2]},
    {"kind": "match", "pairs": {"A": "1", "B": "1"}, "reuse": True,
     "words": {"A": "grain", "1": "noise"}, "said": [{"A": "Korn"}], "traps": {"half": {"A": "2"}}},
    {"kind": "order", "steps": ["a", "b"], "before": [["a", "b"]], "distractors": ["c"],
     "together": [["a", "b"]], "words": {"a": "first"}, "said": [{"a": "zuerst"}]},
    {"kind": "gap", "accept": [["colour", "রং"], "grey"], "among": ["hue"],
     "terms": ["great"], "names": [["V", "S"]]},
    {"kind": "witness", "predicate": "x^2 < y", "symbols": {"x": "real"}, "let": {"y": "x"},
     "where": ["x > 0"], "example": {"x": "1/2"}},
    {"kind": "witness", "demands": {"short": {"holds": "f < 50", "worth": 2}}, "symbols": ["f"],
     "units": {"f": "mm"}, "traps": {"half": "f > 90"}, "notes": NOTES, "why": NOTES},
    {"kind": "code", "output": "4", "also": ["4.0"], "traps": {"half": "2"}, "notes": NOTES},
    {"kind": "program", "function": "f", "parameters": "x", "solution": "def f(x):\n    return x\n",
     "cases": {"one": {"args": [{"uint8": [1]}, 2], "worth": 2}}, "keeps": 1,
     "traps": {"half": "def f(x):\n    return x / 2\n"}, "notes": NOTES},
    {"kind": "derivation", "symbols": {"x": "real", "a": "positive", "b": [1, 2]},
     "let": {"x": "a*b"}, "where": ["a > b/9"], "given": ["x/b = a"], "traps": {"half": ["x = a/b"]},
     "lines": {"start": {"forms": ["x/a = b"], "points": "1/2", "needed": True},
               "goal": {"forms": ["x = a*b"], "points": 2}},
     "reasons": {"cause": {"points": 1, "words": ["similar", "সদৃশ"]}}, "unit": "cm", "notes": NOTES},
    {"kind": "sketch", "view": [-1, 1, 0, "1"], "tall": "1/2", "cuts": [0], "lines": {"ray": "0,0 0.5,1"},
     "features": {"way": {"reads": "line", "of": ["ray"], "worth": 2, "bend": True, "on": True,
                          "circle": [0, 0, "0.7"]}},
     "traps": {"half": {"ray": "0,0 0.25,1"}}, "notes": NOTES},
]  # fmt: skip
"""Every field of every kind, none of them at its default."""


def named(spec) -> str:
    return spec["kind"]


def test_every_field_of_every_kind_is_looked_at():
    for shape in {kind.spec for kind in KINDS.values()}:
        looked_at = {name for spec in FULL if KINDS[spec["kind"]].spec is shape for name in spec}
        common = {*Tolerance.__struct_fields__, "traps", "notes", "why", "of", "define", "worth"}
        assert {*shape.__struct_fields__} - common - {"accept"} <= looked_at, shape


@together("table", FULL)
def test_a_specification_as_a_table_and_back_is_the_same(table):
    spec = load_spec(table)
    assert json.loads(json.dumps(msgspec.to_builtins(spec))) == table
    assert load_spec(json.loads(json.dumps(msgspec.to_builtins(spec)))) == spec


@together("table", FULL)
def test_a_struct_is_marked_and_shown_as_its_table(table):
    spec = load_spec(table)
    typed = show_key(table)
    assert show_key(spec) == typed
    assert grade_answer(spec, typed) == grade_answer(table, typed)
    assert show_key(spec, "bn") == show_key(table, "bn")


def test_defaults_are_left_out():
    spec = number.NumberSpec(kind="number", value="20/3", decimals=3)
    assert msgspec.to_builtins(spec) == {"kind": "number", "decimals": 3, "value": "20/3"}


def test_true_or_false_needs_no_options_and_keeps_none():
    spec = choice.ChoiceSpec(kind="tf", correct=[1])
    assert (show_key(spec), show_key(spec, "bn")) == ("true", "সত্য")
    assert msgspec.to_builtins(spec) == {"kind": "tf", "correct": [1]}


def test_a_specification_cannot_be_changed():
    spec = number.NumberSpec(kind="number", value="1")
    with pytest.raises(AttributeError):
        spec.value = "2"  # type: ignore[misc]


@together(
    ("table", "said"),
    [
        ({"kind": "number", "value": "1", "traps": {"half": {"a": 1}}}, "traps"),
        ({"kind": "code", "output": "1", "traps": {"half": 1}}, "traps"),
        ({"kind": "table", "values": {"a": "1"}, "traps": {"half": "2"}}, "traps"),
        ({"kind": "match", "pairs": {"A": "1"}, "traps": {"half": "A2"}}, "traps"),
        ({"kind": "order", "steps": ["A", "B", "A"], "before": [["A", "B"]]}, "stands twice"),
        ({"kind": "gap", "accept": [["hue"], []]}, "one word per gap"),
        ({"kind": "number", "value": "1", "colour": "red"}, "colour"),
        ({"kind": "number", "value": "1", "decimals": 1, "exact": True}, "only one of"),
    ],
)
def test_what_has_the_wrong_shape_is_named(table, said):
    with pytest.raises(KeyFileError, match=said):
        load_spec(table)


def test_what_is_typed_is_text():
    with pytest.raises(TypeError, match="text is expected, not int"):
        grade_answer({"kind": "number", "value": "1"}, 1)  # type: ignore[arg-type]


def test_steps_are_named_by_their_letters_and_words_together():
    table = {"kind": "order", "steps": ["A", "B"], "before": [["A", "B"]],
             "words": {"A": "light falls in", "B": "charge is read"}}  # fmt: skip
    right = grade_answer(table, "A light falls in, B charge is read")
    other = grade_answer(table, "B: charge is read, A: light falls in")
    assert (right.verdict, other.verdict) == ("correct", "wrong")
    assert other.read_as == "B A"


def test_every_kind_is_a_frozen_struct_that_leaves_out_defaults():
    for shape in {kind.spec for kind in KINDS.values()}:
        config = shape.__struct_config__
        assert issubclass(shape, msgspec.Struct)
        assert (config.frozen, config.omit_defaults, config.forbid_unknown_fields) == (True,) * 3
