"""Whether a formula is the general solution of y''' + c y' = 0: by insertion and independence."""

from fractions import Fraction

import sympy

from quizgen.grading.checking import read_as_sympy

X = sympy.Symbol("x")
CONSTANTS = "A B C D a b c d K L M C1 C2 C3 C4 C_1 C_2 C_3 C_4 c1 c2 c3 c4 c_1 c_2 c_3 c_4 k1 k2 k3"


def check(values, answer):
    """Judge a solution with constants of the student's own names."""
    y = read_as_sympy(answer, f"x i {CONSTANTS}").subs(sympy.Symbol("i"), sympy.I)
    if sympy.simplify(y.diff(X, 3) + values["c"] * y.diff(X)) != 0:
        return 0, "no-solution"
    constants = sorted(y.free_symbols - {X}, key=str)
    pieces = sympy.Matrix([[y.diff(one).subs(X, place) for one in constants] for place in range(5)])
    rank = pieces.rank() if constants else 0
    if rank == 3:
        return 1
    return Fraction(rank, 4), "dependent" if rank < len(constants) else "few"
