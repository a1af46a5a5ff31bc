"""A confidence interval for the mean of one of three samples."""

from sympy import Eq, Function, Piecewise, Rational, sqrt, symbols

from quizgen.maths.lists import mean, var
from quizgen.maths.model import Model, Step

x, y, z, k, m, v, h, low, high = symbols("x y z k m v h L U")


def of_sample(rule):
    """Return what a rule makes of the sample that is asked about."""
    return Piecewise((rule(x), Eq(k, 0)), (rule(y), Eq(k, 1)), (rule(z), True))


width = Function("t_quantile")(Rational(39, 40), 49) * sqrt(v / 50)
MODEL = Model(
    given={x: "", y: "", z: "", k: ""},
    steps=(
        Step(m, of_sample(mean)),
        Step(v, of_sample(var)),
        Step(h, width),
        Step(low, m - h),
        Step(high, m + h),
    ),
    traps={
        "of-a-value": Step(h, width * sqrt(50)),
        "root-left-out": Step(h, width**2),
        "next-sample": Step(
            m, Piecewise((mean(y), Eq(k, 0)), (mean(z), Eq(k, 1)), (mean(x), True))
        ),
    },
)
