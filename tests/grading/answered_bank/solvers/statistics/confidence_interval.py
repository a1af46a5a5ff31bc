"""A confidence interval for a mean, with the quantile of Student's distribution."""

from sympy import Function, Rational, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

n, m, v, t, h, low, high = symbols("n m v t h L U")
quantile = Function("t_quantile")
normal = Function("normal_quantile")
with evaluate(False):
    MODEL = Model(
        given={n: "", m: "", v: ""},
        steps=(
            Step(t, quantile(Rational(39, 40), n - 1)),
            Step(h, t * sqrt(v / n)),
            Step(low, m - h),
            Step(high, m + h),
        ),
        traps={
            "normal-quantile": Step(t, normal(Rational(39, 40))),
            "one-more-degree": Step(t, quantile(Rational(39, 40), n)),
            "root-left-out": Step(h, t * v / n),
        },
    )
