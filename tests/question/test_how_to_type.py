"""Whoever answers is told how, whatever is asked, in every language."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from sweep import together

sys.path.insert(0, str(Path(__file__).parents[1] / "grading"))

from test_specifications import FULL

from quizgen.kinds import KINDS
from quizgen.kinds.grade import load_spec
from quizgen.render.text import inlines_to_plain_text
from quizgen.typeset.prose import to_inlines

TOLD = {
    ("set", "en"): "Give all values in any order, separated by semicolons.",
    ("set", "de"): "Geben Sie alle Werte in beliebiger Reihenfolge an, durch Semikolon getrennt.",
    (
        "interval",
        "en",
    ): "Write an interval, for example [0; 1) or (0; inf); join several with ∪ or “or”.",
    (
        "interval",
        "de",
    ): "Schreiben Sie ein Intervall, zum Beispiel [0; 1) oder (0; inf); mehrere mit ∪ oder „oder“ verbunden.",
}


@together("lang", ["en", "bn", "de"])
@together("table", FULL)
def test_every_kind_says_how_it_is_answered(table, lang):
    kind = table["kind"]
    told = [
        inlines_to_plain_text(to_inlines(one))
        for one in KINDS[kind].input_hints(load_spec(table), lang)
    ]
    assert told or kind == "number"  # a number alone is typed as one
    assert all(map(str.strip, told))
    assert TOLD.get((kind, lang), told[:1]) in (told[:1], *told[:1])


@pytest.mark.parametrize("lang", ["en", "bn", "de"])
def test_a_set_says_in_which_unit(lang):
    spec = load_spec({"kind": "set", "values": ["1", "2"], "unit": "mm"})
    assert any("mm" in one for one in KINDS["set"].input_hints(spec, lang))


@pytest.mark.parametrize("example", ["[0; 1)", "(0; inf)"])
def test_an_interval_may_be_typed_as_it_is_shown(example):
    assert load_spec({"kind": "interval", "value": example}).show()
