"""Which effects of a camera can be seen: displacements in px, noise in grey levels.

Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 22 (blur disc); the rest are
the bounds of docs/camera.md.
"""

from sympy import Abs, Symbol, evaluate, symbols

from quizgen.maths.model import Model, Step

f, N, s, z, p, R, H, v, t_r, F, G = symbols("f N s z p R H v t_r F G", positive=True)
k_1 = symbols("k_1", real=True)
sigma = Symbol("sigma", positive=True)
c, n_c, a, n_k, u, n_s, q, e_c, e_k, e_s, e_q = symbols(
    "c n_c a n_k u n_s q e_c e_k e_s e_q", real=True
)

with evaluate(False):
    MODEL = Model(
        given={
            f: "mm",
            N: "",
            s: "m",
            z: "m",
            p: "um",
            R: "",
            H: "",
            k_1: "",
            v: "m/s",
            t_r: "us",
            sigma: "",
            F: "",
            G: "",
        },
        steps=(
            Step(c, f**2 * Abs(z - s) / (N * z * (s - f)), "um"),
            Step(n_c, c / p),
            Step(a, R * p / f),
            Step(n_k, Abs(k_1) * a**2 * R),
            Step(u, f * v / (z * p), "px/s"),
            Step(n_s, u * t_r * H),
            Step(q, 255 * sigma / F),
            Step(e_c, G * n_c),
            Step(e_k, G * n_k),
            Step(e_s, G * n_s),
            Step(e_q, 4 * q),
        ),
        formulas={"c": "F33", "n_k": "F20", "a": "F08", "u": "F05"},
        traps={
            "radius": Step(n_c, c / (2 * p)),
            "number-multiplied": Step(c, f**2 * Abs(z - s) * N / (z * (s - f))),
            "share-of-radius": Step(n_k, Abs(k_1) * a**2),
            "not-squared": Step(n_k, Abs(k_1) * a * R),
            "one-row": Step(n_s, u * t_r),
            "no-depth": Step(u, f * v / p),
            "electrons-kept": Step(q, sigma),
            "variance": Step(q, 255 * sigma**2 / F),
        },
    )
