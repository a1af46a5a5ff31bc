"""Convolution of nine pixels with a kernel of nine numbers: the value in the middle.

Source: Gonzalez & Woods, Digital Image Processing, 4th ed. (2018), section 3.4.
"""

from sympy import Add, Mul, evaluate, symbols

from quizgen.maths.model import Model, Step

F = symbols("f_1:10", integer=True)
W = symbols("w_1:10", integer=True)
g = symbols("g", real=True)
FLIPPED = W[::-1]
COLUMNS_FLIPPED = [W[k] for k in (2, 1, 0, 5, 4, 3, 8, 7, 6)]
ROWS_FLIPPED = [W[k] for k in (6, 7, 8, 3, 4, 5, 0, 1, 2)]
TRANSPOSED = [W[k] for k in (8, 5, 2, 7, 4, 1, 6, 3, 0)]


def summed(weights: list) -> Add:
    """The sum of the pixels, each times its weight."""
    return Add(*[Mul(f, w) for f, w in zip(F, weights, strict=True)])


with evaluate(False):
    MODEL = Model(
        given=dict.fromkeys((*F, *W), ""),
        steps=(Step(g, summed(FLIPPED)),),
        traps={
            "not-flipped": Step(g, summed(W)),
            "columns-flipped": Step(g, summed(COLUMNS_FLIPPED)),
            "rows-flipped": Step(g, summed(ROWS_FLIPPED)),
            "transposed": Step(g, summed(TRANSPOSED)),
            "divided": Step(g, summed(FLIPPED) / 9),
        },
    )
