"""Where things stand in files: what is found is the key itself, whatever is said around it."""

from __future__ import annotations

import tomllib

import pytest
from sweep import together

from quizgen.core.positions import TEXT, Span, TomlPositions, find_span

TOML = '''\
# the key 'answer' is told here: part.answer = 1
title = "keep.T = 1 # no comment" # title = 2
"quoted key" = 'it''s'
[keep]
T = { min = 1, skip = [2, 3] }
F.max = """
[part]
F.min = 2
"""
[[part]]
points = 1
[part.answer]
kind = "number"
[[part]]
answer = { kind = "choice", options = { a = true, "b c" = "x > 1" } }
where = [
  "x > 1", # "x > 2"
  'x > 3',
]
'''.replace("'it''s'", "'it'")


def find(place, text=TOML):
    return TomlPositions(text).find(place)


@together(
    ("place", "line", "column"),
    [
        (("title",), 2, 1),
        (("quoted key",), 3, 1),
        (("keep", "T"), 5, 1),
        (("keep", "T", "skip"), 5, 16),
        (("keep", "T", "skip", 1), 5, 27),
        (("keep", "F", "max"), 6, 1),
        (("part", 0, "points"), 11, 1),
        (("part", 0, "answer", "kind"), 13, 1),
        (("part", 1, "answer", "options", "b c"), 15, 51),
        (("part", 1, "where", 1), 18, 3),
    ],
)
def test_a_key_is_found_where_it_is_written(place, line, column):
    assert tomllib.loads(TOML), "the example is TOML"
    assert find(place) == Span(line, column)


@pytest.mark.parametrize(
    ("place", "line"),
    [
        (("part", 1, "answer", "of"), 15),
        (("part", 1, "points"), 14),
        (("keep", "F", "min"), 6),
        (("part", 0, "show"), 10),
    ],
)
def test_of_a_key_that_is_missing_the_table_is_found(place, line):
    assert find(place).line == line


def test_what_is_nowhere_has_no_place():
    assert find(("draw", "m")) is None
    assert find((TEXT, "x > 2")) is None, "it stands in a comment"


def test_a_text_is_found_by_what_it_says():
    assert find((TEXT, "x > 1")) == Span(15, 59), "the first of two"
    assert find((TEXT, "x > 3")) == Span(18, 3)
    assert find((TEXT, 'a "b" \\ c'), r'f = "a \"b\" \\ c"') == Span(1, 5)


@pytest.mark.parametrize(
    "broken", ["a = 1\nb = [1, 2\nc = 3", "a = 1\n[b\n", "a = 1\n= 2", "a = '''"]
)
def test_what_stands_before_a_fault_is_found(broken):
    assert find(("a",), broken) == Span(1, 1)


def write(folder, name, text):
    (folder / name).write_text(text, "utf-8")
    return folder / name


WORDS = """# Title
A stem with {{ a }} and $F = m*a$ that
goes on in another line.

## steps
- F: Force.
- G [a > 1]: Weight, by
  another sentence.

## traps
- F: You forgot it.
"""


@pytest.mark.parametrize(
    ("place", "line"),
    [
        (("steps", "G"), 7),
        (("traps", "F"), 11),
        (("steps", "H"), 5),
        (("reasons",), None),
        ((TEXT, "{{a}}"), 2),
        ((TEXT, "that goes on"), 2),
        ((TEXT, "$F = m*a$"), 2),
    ],
)
def test_words_are_found_by_section_and_name_or_by_what_they_say(tmp_path, place, line):
    found = find_span(write(tmp_path, "en.md", WORDS), place)
    assert (found and found.line) == line


SOLVER = """
from sympy import Symbol, symbols
# Step(F, ...) comes below
image, m = symbols("z' m", real=True)
F = Symbol("F")
MODEL = Model(
    given={m: "kg"},
    traps={"twice": Step(image, 2 * m), "F": Step(F, m)},
    steps=(
        Step(image, m),
        Step(F, m),
    ),
    formulas={"F": "F1"},
)
"""


@pytest.mark.parametrize(
    ("place", "line"),
    [
        (("Step", "z'"), 10),
        (("Step", "F"), 11),
        (("traps", "twice"), 8),
        (("formulas", "F1"), 13),
        (("Step", "G"), None),
    ],
)
def test_a_step_is_found_by_its_symbol_whatever_the_variable_is_called(tmp_path, place, line):
    found = find_span(write(tmp_path, "lens.py", SOLVER), place)
    assert (found and found.line) == line


def test_a_file_that_is_gone_or_no_python_has_no_place(tmp_path):
    assert find_span(tmp_path / "gone.toml", ("a",)) is None
    assert find_span(write(tmp_path, "lens.py", "Step(F"), ("Step", "F")) is None
    assert find_span(write(tmp_path, "a.txt", "a = 1"), ("a",)) is None
