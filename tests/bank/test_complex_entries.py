"""Complex entries of matrices and vectors, and units of complex numbers: circuits, eigenvectors."""

from __future__ import annotations

import pytest
from symbolic_bank import write_questions

import quizgen
from quizgen.bank.dimensions import find_unit_errors

SOLVERS = {
    "entries": ("""
a, b = symbols("a b")
MODEL = Model(
    given={a: "", b: ""},
    steps=(
        Step("M", Matrix([[a, I*b], [1 - I, a + b*I]])), Step("v", Matrix([1, a*I])),
        Step("w", Matrix([1, I/3])),
    ),
    traps={"real": Step("M", Matrix([[a, b], [1, a]]))},
)
""", "a = { pick = [2] }\\nb = { pick = [3] }",
        ['kind = "matrix", of = "M"', 'kind = "vector", of = "v", up_to = "scale"',
         'kind = "vector", of = "w", decimals = 2']),
    "impedance": ("""
R, X, U, i = symbols("R X U i")
MODEL = Model(
    given={R: "kohm", X: "kohm", U: "V"},
    steps=(Step("Z", R + X*I), Step("i", U/(R + X*I))),
    traps={"capacitor": Step("Z", R - X*I)},
)
""", 'R = { pick = [3], unit = "kohm" }\\nX = { pick = [4], unit = "kohm" }\\nU = { pick = [50], unit = "V" }',
        ['kind = "complex", of = "Z", unit = "kohm", form = "cartesian"',
         'kind = "complex", of = "i", unit = "mA", rel = "0.01"']),
    "torque": ("""
x, y, F, G = symbols("x y F G")
MODEL = Model(
    given={x: "m", y: "m", F: "kN", G: "kN"},
    steps=(Step("M", Matrix([x, y, 0]).cross(Matrix([F, G, 0]))), Step("K", Matrix([[F, G]]))),
)
""", 'x = { pick = [2], unit = "m" }\\ny = { pick = [3], unit = "m" }\\nF = { pick = [5], unit = "kN" }\\nG = { pick = [7], unit = "kN" }',
        ['kind = "vector", of = "M", unit = "N*m"', 'kind = "matrix", of = "K", unit = "kN"']),
    "wrong": ("""
R, X = symbols("R X")
MODEL = Model(given={R: "ohm", X: "ohm"}, steps=(Step("Z", R + X*I),))
""", 'R = { pick = [3], unit = "ohm" }\\nX = { pick = [4], unit = "ohm" }',
        ['kind = "complex", of = "Z", unit = "V"', 'kind = "complex", of = "Z"']),
}  # fmt: skip


@pytest.fixture(scope="module")
def bank(tmp_path_factory):
    return quizgen.Bank(write_questions(tmp_path_factory.mktemp("complex"), SOLVERS), trusted=True)


@pytest.mark.parametrize(("name", "part", "typed", "right"), [
    ("entries", "a", "[2, 3i; 1 - i, 2 + 3i]", ("correct", "")),
    ("entries", "a", "2 & 3j \\\\ 1-j & 2+3j", ("correct", "")),
    ("entries", "a", "[2, 3; 1, 2]", ("wrong", "trap:real")),
    ("entries", "a", "[2, 1 - i; 3i, 2 + 3i]", ("wrong", "transposed")),
    ("entries", "a", "[2, -3i; 1 - i, 2 + 3i]", ("partial", "matrix-row")),
    ("entries", "b", "(1; 2i)", ("correct", "")),
    ("entries", "b", "(-i; 2)", ("correct", "")),  # times -i
    ("entries", "b", "(1; -2i)", ("wrong", "")),
    ("entries", "c", "(1; 0.33i)", ("correct", "")),
    ("impedance", "a", "3 + 4i kΩ", ("correct", "")),
    ("impedance", "a", "(3+4j) kOhm", ("correct", "")),
    ("impedance", "a", "3000 Ω + 4000j Ω", ("correct", "")),
    ("impedance", "a", "3kΩ + j4kΩ", ("correct", "")),
    ("impedance", "a", "3 + 4i", ("partial", "unit-missing")),
    ("impedance", "a", "3 + 4i V", ("wrong", "unit-clash")),
    ("impedance", "a", "3 + 4i Ω", ("wrong", "")),
    ("impedance", "a", "3 - 4i kΩ", ("wrong", "trap:capacitor")),
    ("impedance", "a", "5∠53.13° kΩ", ("partial", "form-cartesian")),
    ("impedance", "b", "6 - 8i mA", ("correct", "")),
    ("impedance", "b", "10∠-53.13° mA", ("correct", "")),
    ("impedance", "b", "0.006 - 0.008i A", ("correct", "")),
    ("torque", "a", "(0; 0; -1000) Nm", ("correct", "")),
    ("torque", "a", "(0; 0; -1) kN m", ("correct", "")),
    ("torque", "a", "(0; 0; 1000) N·m", ("wrong", "sign")),
    ("torque", "a", "(0; 0; -1000)", ("partial", "unit-missing")),
    ("torque", "a", "(0; 0; -1000) J/s", ("wrong", "unit-clash")),
    ("torque", "a", "-1000k N m", ("correct", "")),
    ("torque", "a", "0i + 0j - 1000 k Nm", ("correct", "")),
    ("torque", "b", "[5, 7] kN", ("correct", "")),
    ("entries", "a", "2, j3; 1 - j, 2 + j3", ("correct", "")),
    ("torque", "b", "[5000 N, 7000 N]", ("correct", "")),
])  # fmt: skip
def test_complex_answers(bank, name, part, typed, right):
    found = quizgen.mark_part(bank.template(name), typed, part=part)
    assert (found.verdict, found.note) == right


def test_a_unit_that_does_not_fit_is_an_error(bank):
    said = [(error.rule, str(error)) for error in find_unit_errors(bank.template("wrong"))]
    assert [rule for rule, _ in said] == ["QG202", "QG202"]
    assert "part 1: Z is in" in said[0][1]
    assert list(find_unit_errors(bank.template("impedance"))) == []
