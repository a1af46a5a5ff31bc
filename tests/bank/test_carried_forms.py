"""An own wrong formula, matrix or complex number is carried on, and so is a number into a formula."""

from __future__ import annotations

from pathlib import Path

import pytest
from symbolic_bank import BANK, PROSE

import quizgen

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
        ("expression", "f"), ("expression", "df"), ("number", "D"), ("expression", "t"), ("number", "A"),
    ]),
    "line": ("""
a, b, m, x = symbols("a b m x")
MODEL = Model(
    given={a: "", b: ""},
    free=("x",),
    steps=(Step(m, b/a), Step("y", m*x + b), Step("s", Interval(a - m, a + m))),
)
""", "a = { pick = [2] }\\nb = { pick = [6] }", [("number", "m"), ("expression", "y"), ("interval", "s")]),
    "matrix": ("""
a, c, d = symbols("a c d")
A = MatrixSymbol("A", 2, 2)
MODEL = Model(
    given={a: "", c: ""},
    steps=(Step(A, Matrix([[a, 1], [c, 2]])), Step(d, det(A)), Step("B", A.inv())),
)
""", "a = { pick = [4] }\\nc = { pick = [3] }", [("matrix", "A"), ("number", "d"), ("matrix", "B")]),
    "impedance": ("""
R, X, s = symbols("R X s")
z = Symbol("z")
MODEL = Model(
    given={R: "", X: ""},
    steps=(Step(z, R + X*I), Step("y", 1/z), Step(s, Abs(z))),
)
""", "R = { pick = [3] }\\nX = { pick = [4] }", [("complex", "z"), ("complex", "y"), ("number", "s")]),
}  # fmt: skip


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    folder = tmp_path_factory.mktemp("carried")
    (folder / "templates").mkdir()
    (folder / "solvers").mkdir()
    (folder / "templates" / "bank.toml").write_text(BANK)
    for name, written in SOLVERS.items():
        write_question(folder, name, *written)
    return quizgen.Bank(folder, trusted=True)


def write_question(folder: Path, name: str, model: str, draws: str, asked: list[tuple[str, str]]):
    head = "from sympy import *\n\nfrom quizgen.maths.model import Model, Step\n\n"
    (folder / "solvers" / f"{name}.py").write_text(head + model)
    home = folder / "templates" / "any" / name
    home.mkdir(parents=True)
    rule = {"number": ", sigfigs = 4"}
    parts = [f'[[part]]\nanswer = {{ kind = "{kind}", of = "{of}"{rule.get(kind, "")} }}' for kind, of in asked]
    draws = draws.replace("\\n", "\n")
    (home / "template.toml").write_text(
        f'topic = "any"\ntier = "B"\nsolver = "{name}"\nlevels = []\n[draw]\n{draws}\n' + "\n".join(parts)
    )
    stem = "Here " + ", ".join(f"{line[0]} is {{{{ {line[0]} }}}}" for line in draws.splitlines()) + "."
    stem += "".join(f"\n\n## {label}\nFind it." for label, _ in zip("abcdef", asked, strict=False))
    steps = "\n".join(f"- {of}: By the rules." for _, of in asked)
    (home / "en.md").write_text(PROSE.format(title=name, stem=stem, steps=steps, traps=""))


CARRIED = [
    ("slope", {"a": "x^3 + 3x"}, "b", "3x^2 + 3"),  # from an own f
    ("slope", {"a": "x^3 + 3x"}, "c", "30"),
    ("slope", {"b": "x^2"}, "c", "9"),
    ("slope", {"a": "x^3 + 3x", "b": "x^2"}, "c", "9"),  # the nearest own work counts
    ("slope", {"a": "x^3 + 3x"}, "d", "30(x-3) + 36"),
    ("slope", {"a": "4x^3"}, "e", "81"),
    ("slope", {"a": "sin(x)"}, "b", "cos x"),
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
