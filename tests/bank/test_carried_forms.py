"""An own wrong formula, matrix or complex number is carried on, and so is a number into a formula."""

from __future__ import annotations

import pytest
from msgspec import structs
from symbolic_bank import write_questions

import quizgen
from quizgen.core.errors import KeyFileError
from quizgen.paper.answer_key import FORMAT, make_key_question
from quizgen.paper.grading import grade_paper
from quizgen.paper.paper import single_question_paper

SOLVERS = {
    "slope": ("""
a, c, x = symbols("a c x")
f, df = Function("f")(x), Function("df")(x)
MODEL = Model(
    given={a: "", c: ""},
    free=("x",),
    steps=(
        Step(f, a*x**3 + c*x), Step(df, diff(f, x)), Step("D", df.subs(x, c)),
        Step("t", df.subs(x, c)*(x - c) + f.subs(x, c)), Step("A", Integral(f, (x, 0, c))),
    ),
)
""", "a = { pick = [2] }\\nc = { pick = [3] }", [
        'kind = "expression", of = "f"', 'kind = "expression", of = "df"', 'kind = "number", of = "D", sigfigs = 4', 'kind = "expression", of = "t"', 'kind = "number", of = "A", sigfigs = 4',
    ]),
    "area": ("""
a, x = symbols("a x")
f = Function("f")(x)
MODEL = Model(
    given={a: ""},
    free=("x",),
    steps=(
        Step(f, sin(a*x)/x), Step("L", limit(f, x, 0)), Step("F", integrate(x*f, x)),
        Step("S", Sum(f, (x, 1, 3))),
    ),
)
""", "a = { pick = [2] }", [
        'kind = "expression", of = "f"', 'kind = "number", of = "L", sigfigs = 4', 'kind = "expression", of = "F", up_to = "constant"', 'kind = "number", of = "S", sigfigs = 4',
    ]),
    "line": ("""
a, b, m, x = symbols("a b m x")
MODEL = Model(
    given={a: "", b: ""},
    free=("x",),
    steps=(Step(m, b/a), Step("y", m*x + b), Step("s", Interval(a - m, a + m))),
)
""", "a = { pick = [2] }\\nb = { pick = [6] }", ['kind = "number", of = "m", sigfigs = 4', 'kind = "expression", of = "y"', 'kind = "interval", of = "s"']),
    "matrix": ("""
a, c, d = symbols("a c d")
A = MatrixSymbol("A", 2, 2)
MODEL = Model(
    given={a: "", c: ""},
    steps=(Step(A, Matrix([[a, 1], [c, 2]])), Step(d, det(A)), Step("B", A.inv())),
)
""", "a = { pick = [4] }\\nc = { pick = [3] }", ['kind = "matrix", of = "A"', 'kind = "number", of = "d", sigfigs = 4', 'kind = "matrix", of = "B"']),
    "impedance": ("""
R, X, s = symbols("R X s")
z = Symbol("z")
MODEL = Model(
    given={R: "", X: ""},
    steps=(Step(z, R + X*I), Step("y", 1/z), Step(s, Abs(z))),
)
""", "R = { pick = [3] }\\nX = { pick = [4] }", ['kind = "complex", of = "z"', 'kind = "complex", of = "y"', 'kind = "number", of = "s", sigfigs = 4']),
}  # fmt: skip


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    return quizgen.Bank(write_questions(tmp_path_factory.mktemp("carried"), SOLVERS), trusted=True)


CARRIED = [
    ("slope", {"a": "x^3 + 3x"}, "b", "3x^2 + 3"),  # from an own f
    ("slope", {"a": "x^3 + 3x"}, "c", "30"),
    ("slope", {"b": "x^2"}, "c", "9"),
    ("slope", {"a": "x^3 + 3x", "b": "x^2"}, "c", "9"),  # the nearest own work counts
    ("slope", {"a": "x^3 + 3x"}, "d", "30(x-3) + 36"),
    ("slope", {"a": "4x^3"}, "e", "81"),
    ("slope", {"a": "sin(x)"}, "b", "cos x"),
    ("area", {"a": "x^2 + 1"}, "b", "1"),  # a limit is the value where there is one
    ("area", {"a": "sin(3x)/x"}, "c", "-cos(3x)/3"),  # and an antiderivative has that derivative
    ("area", {"a": "x^2 + 1"}, "c", "x^4/4 + x^2/2 + C"),
    ("area", {"a": "1/(x-1)"}, "c", "x + ln(x-1) - 5"),
    ("area", {"a": "sin(3x)/x"}, "d", "0.1388"),
    ("line", {"a": "5"}, "b", "5x + 6"),  # a number into a formula
    ("line", {"a": "1/3"}, "b", "x/3 + 6"),
    ("line", {"a": "1"}, "c", "[1; 3]"),  # into an interval
    ("matrix", {"a": "[4, 1; 3, 1]"}, "b", "1"),
    ("matrix", {"a": "[4, 1; 3, 1]"}, "c", "[1, -1; -3, 4]"),
    ("impedance", {"a": "3 - 4i"}, "b", "3/25 + 4/25 i"),
    ("impedance", {"a": "6 + 8i"}, "c", "10"),
]
WRONG = [
    ("slope", {"a": "x^3 + 3x"}, "b", "3x^2"),
    ("slope", {"a": "7"}, "b", "0"),  # nothing was left to do
    ("slope", {"a": "6x^3 + 9"}, "b", "12"),
    ("area", {"a": "sin(3x)/x"}, "b", "3"),  # no value there: nothing follows
    ("area", {"a": "sin(3x)/x"}, "c", "sin(3x)/x"),
    ("area", {"a": "sin(3x)/x"}, "c", "cos(3x)/3"),
    ("area", {"a": "x^2 + 1"}, "c", "x^4/4 + x^2/2 + x"),
    ("line", {"a": "5"}, "b", "4x + 6"),
    ("line", {"a": "0"}, "b", "6"),
    ("matrix", {"a": "[4, 1, 2; 3, 1, 2]"}, "b", "1"),  # another size
    ("matrix", {"a": "[4, 1; 3, 1]"}, "b", "4"),
    ("impedance", {"a": "3 - 4i"}, "b", "3 + 4i"),
]


@pytest.mark.parametrize(("name", "own", "part", "typed"), CARRIED)
def test_what_follows_from_own_work_has_full_marks(bank, name, own, part, typed):
    found = quizgen.mark_part(bank.template(name), typed, part=part, earlier=own)
    assert (found.note, found.credit) == ("carried-forward", 1)
    assert quizgen.mark_part(bank.template(name), typed, part=part).credit < 1


@pytest.mark.parametrize(("name", "own", "part", "typed"), WRONG)
def test_what_does_not_follow_is_wrong(bank, name, own, part, typed):
    found = quizgen.mark_part(bank.template(name), typed, part=part, earlier=own)
    assert found.note != "carried-forward"
    assert found.credit < 1


def test_a_right_answer_stays_right_after_wrong_work(bank):
    found = quizgen.mark_part(bank.template("slope"), "6x^2 + 3", part="b", earlier={"a": "x"})
    assert found.verdict == "correct"


@pytest.mark.parametrize("odd", [
    5, "x", [], ["x", 5], ["x", [["a"]]], ["x", [["a", "nowhere", [], [], {}]]], [["exec", "x"], []],
    ["x", [["a", "f", [-1], [], {}]]], ["x", [["a", "f", [], [], {"x": 5}]]], ["x +", []],
])  # fmt: skip
def test_a_key_with_an_odd_recipe_is_refused(bank, odd):
    keyed = make_key_question(single_question_paper(bank.template("slope"), 1, "en").items[0])
    chain = structs.asdict(keyed.chain)
    table = {"format": FORMAT, "questions": [{
        "number": "1", "parts": [structs.asdict(part) for part in keyed.parts],
        "chain": {**chain, "given": {n: structs.asdict(g) for n, g in chain["given"].items()},
                  "recipes": {**chain["recipes"], "df": odd}},
    }]}  # fmt: skip
    with pytest.raises(KeyFileError):
        grade_paper(table, {})
