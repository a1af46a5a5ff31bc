"""A confidence interval for a mean, with the quantile of Student's distribution."""

from sympy import Function, evaluate, sqrt, symbols

from quizgen.maths.model import Model, Step

n, m, v, g, t, h, low, high = symbols("n m v g t h L U")
quantile, normal = Function("t_quantile"), Function("normal_quantile")
with evaluate(False):
    MODEL = Model(
        given={n: "", m: "", v: "", g: ""},
        steps=(
            Step(t, quantile((100 + g) / 200, n - 1)),
            Step(h, t * sqrt(v / n)),
            Step(low, m - h),
            Step(high, m + h),
        ),
        traps={
            "normal-quantile": Step(t, normal((100 + g) / 200)),
            "one-more-degree": Step(t, quantile((100 + g) / 200, n)),
            "one-sided": Step(t, quantile(g / 100, n - 1)),
            "root-left-out": Step(h, t * v / n),
        },
    )
