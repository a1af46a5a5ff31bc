"""Questions of other subjects: clean, and right by NumPy, SciPy, SymPy's other methods and hand."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy
from click.testing import CliRunner
from scipy import stats
from sweep import draws, together

from quizgen.bank.bank import Bank
from quizgen.bank.variant import Variant, draw_variant
from quizgen.cli.main import root_group
from quizgen.kinds.contract import AskedPart
from quizgen.kinds.grade import grade_answer, show_key
from quizgen.lint.template_checks import lint_template
from quizgen.maths.numbers import to_float
from quizgen.question.part_context import ask_part

ROOT = Path(__file__).parent.parent.parent / "examples" / "strangers"
BANK = Bank(ROOT, trusted=True)
X = sympy.Symbol("x")


@together("name", BANK.template_paths)
def test_every_template_is_clean(name):
    assert not lint_template(BANK.template(name), 3, BANK.languages).problems


@pytest.mark.slow
@together("name", BANK.template_paths)
def test_every_template_is_clean_in_many_draws(name):
    assert not lint_template(BANK.template(name), draws(8, full=300), BANK.languages).problems


class Drawn:
    """What a question shows, as floats, lists and words: all that an answer is worked out from."""

    def __init__(self, variant: Variant) -> None:
        self.__dict__ |= {name: to_float(v) for name, v in variant.shown.items()}
        self.__dict__ |= {n: np.array([*map(to_float, v)]) for n, v in variant.lists.items()}
        self.__dict__ |= variant.words

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name)


def rows(matrix: Any) -> str:
    """Write a matrix as a person types it."""
    return "; ".join(", ".join(f"{round(float(entry), 9):.10g}" for entry in row) for row in matrix)


def number_with_i(z: complex) -> str:
    return f"{z.real:.12g} + {z.imag:.12g}i".replace("+ -", "- ")


def formula(expr: Any) -> str:
    return str(expr).replace("**", "^")


def joined(values: Iterable[object]) -> str:
    return "; ".join(map(str, values))


def rounded(value: float, decimals: int) -> str:
    return f"{math.floor(abs(value) * 10**decimals + 0.5) / 10**decimals * np.sign(value):.{decimals}f}"


def three_distances(v):
    a, b = abs(v.p - v.a), abs(v.q - v.b)
    return [a + b, rounded(np.hypot(a, b), 3), max(a, b)]


def fourfold(v):
    joint = (
        np.outer([v.b, 100 - v.b], [1, 1]) * np.array([[v.s, 100 - v.s], [v.t, 100 - v.t]]) / 100
    )
    (bs, bt), (s, t) = joint
    cells = [bs, bt, v.b, s, t, 100 - v.b, bs + s, bt + t]
    return [joined(rounded(cell, 2) for cell in cells)]


def prediction(v):
    slope = v.r * np.sqrt(v.v_y / v.v_x)
    return [rounded(v.m_y + slope * (v.x - v.m_x), 2)]


def misprints(v):
    page = stats.poisson(v.m / v.n)
    return [rounded(p, 4) for p in (page.pmf(0), page.pmf(v.c), page.cdf(2), page.sf(1))]


def between_vectors(v):
    turn = np.arctan2(v.b, v.a) - np.arctan2(v.q, v.p)
    return [rounded(np.degrees(abs((turn + np.pi) % (2 * np.pi) - np.pi)), 1)]


def interval(v):
    low, high = stats.t.interval(v.g / 100, v.n - 1, v.m, np.sqrt(v.v / v.n))
    return [f"{low:.2f}; {high:.2f}"]


def interval_of_sample(v):
    sample = (v.x, v.y, v.z)[int(v.k)]
    low, high = stats.t.interval(0.95, 49, sample.mean(), stats.sem(sample))
    return [f"{low:.2f}; {high:.2f}"]


def quartiles(v):
    low, middle, high = np.quantile(v.x, (0.25, 0.5, 0.75))
    return [f"{value:g} g" for value in (middle, low, high, high - low)]


def pearson(v):
    r, free = stats.pearsonr(v.x, v.y)[0], v.x.size - 2
    t, critical = r * np.sqrt(free / (1 - r * r)), stats.t(free).ppf(0.975)
    return [rounded(r, 3), rounded(t, 2), rounded(critical, 2),
            {"rejected": t > critical, "kept": t <= critical, "proved": False}]  # fmt: skip


def polynomial(v):
    p = np.polynomial.Polynomial([0, *v.c])
    slopes = p.deriv()
    return [formula(sum(int(c) * X**k for k, c in enumerate(slopes.coef))), f"{slopes(v.s):g}"]


def antiderivative(v):
    return [formula(sympy.integrate(sympy.expand((X - int(v.a)) ** int(v.n)), X)) + " + 7"]


def complex_numbers(v):
    z, w = complex(v.a, v.b), complex(v.c, v.d)
    quotient = sympy.nsimplify(
        sympy.simplify((v.a + v.b * sympy.I) / (v.c + v.d * sympy.I)), rational=True
    )
    exact = formula(quotient).replace("I", "i")
    return [number_with_i(2 * z + w), number_with_i(z * w), exact, number_with_i(z**2),
            f"sqrt({v.a**2 + v.b**2:g})"]  # fmt: skip


def any_product(v):
    n, m, p = ((2, 3, 2), (3, 2, 3), (2, 2, 3), (1, 3, 2))[int(v.k)]
    return [rows(v.a[: n * m].reshape(n, m) @ v.b[: m * p].reshape(m, p))]


def cholesky(v):
    n = 4
    factor = np.zeros((n, n))
    factor[np.triu_indices(n)] = v.x
    a = (factor.T @ factor)[: int(v.n), : int(v.n)]
    entry = np.linalg.cholesky(a).round(9)
    return [{"first": entry[0, 0] == v.b[0], "below": entry[1, 0] == v.b[1],
             "inner": entry[2, 1] < v.b[2], "corner": entry[2, 2] >= v.b[3],
             "equal": entry[1, 0] == entry[2, 0], "negative": entry[2, 0] < 0,
             "wider": entry[1, 1] > entry[0, 0], "upper": False}]  # fmt: skip


def eigenvectors(v):
    turn = np.array([[1, 0, v.p], [v.q, 1, v.p * v.q], [0, 0, 1]])
    a = turn @ np.diag([v.r, v.s, v.t]) @ np.linalg.inv(turn)
    values, vectors = np.linalg.eig(a)
    order = np.argsort(values)
    whole = []
    for vector in vectors[:, order].T:
        least = min(abs(c) for c in vector if abs(c) > 1e-9)
        whole.append(joined(f"{c / least:.6f}" for c in vector))
    return [joined(f"{value:.0f}" for value in values.round(6)[::-1]), *whole]


def cube_roots(v):
    cube = v.r**3 * np.exp(1j * np.pi * v.k / 4)
    found = np.angle(np.roots([1, 0, 0, -cube])) / np.pi * 12
    return [f"{abs(cube) ** (1 / 3):g}", joined(f"{k:.0f}pi/12" for k in found)]


def special_values(v):
    u = sympy.pi * sympy.Rational(int(v.n), int(v.d))
    z = sympy.expand_complex(int(v.r) * sympy.exp(sympy.I * u))
    c, s = formula(sympy.re(z)), formula(sympy.im(z))
    return [c, s, f"{c} + ({s})*i", f"pi/{6 if v.m == 2 else 3}"]


def rotation(v):
    u = sympy.pi * sympy.Rational(int(v.k), 12)
    point = sympy.expand_complex(sympy.exp(sympy.I * u))
    c, s = (formula(sympy.simplify(part)) for part in point.as_real_imag())
    return [f"{c}, -({s}); {s}, {c}"]


def half_plane(v):
    normal = np.array([v.d - v.b, v.a - v.c])  # (x - a, y - b) times it is positive below
    shift = normal @ [v.a, v.b]
    return [f"{shift:g} < {normal[0]:g}*x + ({normal[1]:g})*y".replace("+ -", "- ")]


def trapezium(v):
    f = (lambda x: np.sqrt(1 + x**3), lambda x: np.exp(-(x**2)), lambda x: x * np.log(x),
         lambda x: np.cos(x**2 / 4))[int(v.k) - 1]  # fmt: skip
    x = np.linspace(v.p, v.q, 5)
    return [f"{np.trapezoid(f(x), x):#.4g}"]


def resistors(v):
    parts = np.array([v.R_1, v.R_2, v.R_3])
    total = 1 / (1 / parts).sum() if v.k else parts.sum()
    return [f"{total:#.4g} ohm", f"{v.U / total * 1000:#.4g} mA"]


def throw(v):
    vertical = v.v * np.sin(np.radians(v.alpha))
    return [max(np.roots([-v.g / 2, vertical, v.h])), vertical]


def automaton(v):
    goal = (int(v.goal) // 2, int(v.goal) % 2)
    return [{n: (w.count("a") % 2, w.count("b") % 2) == goal
             for n in "uvwyz" if (w := getattr(v, n))}]  # fmt: skip


def analysis(v):
    groups = [v.x_1, v.x_2, v.x_3, v.x_4]
    f, p = stats.f_oneway(*groups)
    every = np.concatenate(groups)
    within = sum(((g - g.mean()) ** 2).sum() for g in groups)
    share = 1 - within / ((every - every.mean()) ** 2).sum()
    return [{"large": f > v.f, "share": share > v.r, "significant": p < 0.05,
             "not-significant": p >= 0.05, "most": share > 0.9, "one-sided": False,
             "each-pair": False, "equal-means": p >= 0.05, "spread": share < 0.5}]  # fmt: skip


def box_plots(v):
    def describe(sample):
        low, middle, high = np.quantile(sample, (0.25, 0.5, 0.75))
        far = 1.5 * (high - low)
        out = (sample > high + far).any() or (sample < low - far).any()
        return middle, high - low, (high + low - 2 * middle) / (high - low), out

    (a, s, skew, out), (b, t, other, beyond) = describe(v.x), describe(v.y)
    return [{"place": a > b, "spread": s > t, "narrow": s < t, "outliers": out or beyond,
             "right-x": skew >= 0.3, "left-x": skew <= -0.3, "right-y": other >= 0.3,
             "symmetric-y": abs(other) <= 0.12, "count": False}]  # fmt: skip


def frequencies(v):
    (bus, cycle, foot), (others_bus, _, others_foot) = v.n.reshape(2, 3)
    rows_, columns = v.p.reshape(2, 3).sum(1), v.p.reshape(2, 3).sum(0)
    whole = np.allclose(rows_, 100, atol=0.3), np.allclose(columns, 100, atol=0.3)
    return [{"rows": whole[0], "columns": whole[1], "total": not any(whole),
             "bus-share": bus / 100 > others_bus / 150, "most-foot": foot > others_foot,
             "half": bus > 50, "cycle-least": cycle < min(bus, foot), "sum-of-row": whole[0],
             "equal-groups": False}]  # fmt: skip


def vowel(v):
    chart = {"close": "iy uɯ", "near-close": "ɪʏ ʊ", "close-mid": "eø oɤ", "open-mid": "ɛœ ɔʌ",
             "open": "a ɑɒ"}  # fmt: skip
    height, place, lips, _ = v.vowel.split()
    found = [sign for sign in chart[height].split()[place == "back"]
             if (sign in "yʏøœuʊoɔɒ") == (lips == "rounded")]  # fmt: skip
    return [{n: getattr(v, n) in found for n in "rstuv"}]


def curves(v):
    names = ("exp", "sine", "bowl", "cubic", "hill", "corner")
    return [{n: names[int(k)] for n, k in zip(("one", "two", "three", "four"), v.o, strict=True)}]


def arrow(v):
    turn = np.exp(1j * np.radians(v.t * v.s))
    tip = complex(v.a, v.b) + 4 * turn
    return [f"{v.a:g},{v.b:g} {tip.real:.2f},{tip.imag:.2f}"]


ANSWERS: dict[str, Callable[[Any], list[Any]]] = {
    "absolute-inequality": lambda v: [f"x <= {v.a - v.b:g} or x >= {v.a + v.b:g}"],
    "adjacency": lambda v: [rows(v.e.reshape(4, 4))],
    "analysis-of-variance": analysis,
    "angle-between-vectors": between_vectors,
    "antiderivative": antiderivative,
    "arrow-at-an-angle": arrow,
    "binary-sum": lambda v: [f"{int(v.a) + int(v.b):b}"],
    "centroid": lambda v: [f"{v.a / 3:g},{v.b / 3:g} {v.a / 3 + 0.1:g},{v.b / 3 + 0.1:g}"],
    "cholesky": cholesky,
    "common-factor": lambda v: [
        formula(sympy.factor(int(v.a) * X**2 + int(v.a * (v.b + v.c)) * X + int(v.a * v.b * v.c)))
    ],
    "common-interval": lambda v: [f"{max(v.a, v.c):g} <= x <= {min(v.b, v.d):g}"],
    "complex-product": complex_numbers,
    "confidence-interval": interval,
    "cube-roots": cube_roots,
    "derivative-of-a-polynomial": polynomial,
    "distances": three_distances,
    "eigenvectors": eigenvectors,
    "fourfold-table": fourfold,
    "graphs-and-formulas": curves,
    "half-plane": half_plane,
    "interval-from-a-file": interval_of_sample,
    "kitchen-units": lambda v: [f"{v.n * 0.2366:.4g} l", f"{v.v * 1.609:.4g} km/h"],
    "limit-of-sines": lambda v: [f"{v.a:g}/{v.b:g}"],
    "matrix-product": lambda v: [
        rows(np.array([[v.a, v.b], [v.c, v.d]]) @ np.array([[v.p, 1], [0, v.q]])),
        f"{np.linalg.det([[v.a, v.b], [v.c, v.d]]):.0f}",
    ],
    "median-and-quartiles": quartiles,
    "misprints": misprints,
    "parity-automaton": automaton,
    "pearson": pearson,
    "phase-of-a-low-pass": lambda v: [-np.degrees(np.arctan(v.f * 1000 / v.f_c))],
    "power-of-a-resistor": lambda v: [f"{v.U * v.I} mW", f"{v.U / v.I:.6g} kohm"],
    "prediction": prediction,
    "price-abroad": lambda v: [f"{v.n * v.p * {'USD': 1.09, 'GBP': 0.86, 'CHF': 0.95}[v.c]:.4f}"],
    "product-of-sizes": any_product,
    "relative-frequencies": frequencies,
    "rotation-matrix": rotation,
    "special-values": special_values,
    "three-resistors": resistors,
    "throw-from-a-roof": throw,
    "trapezium-rule": trapezium,
    "two-box-plots": box_plots,
    "value-of-a-line": lambda v: [f"{np.interp(v.x, [-5, 5], [v.b - 5 * v.m, v.b + 5 * v.m]):g}"],
    "vowels": vowel,
}
WORDS = {"facts-on-iceland", "name-of-a-function", "odd-squares", "products-of-a-reaction",
         "reading-a-regression"}  # fmt: skip
"""Questions whose answer is not computed from what is drawn."""
ELSEWHERE = {"capital-of-a-region", "expression-of-a-table", "general-solution",
             "shape-of-a-sample", "three-properties"}  # fmt: skip
"""Questions that ``test_strangers_cells`` compares."""


def type_choice(part: AskedPart[Any], answer: Any) -> str:
    """Return what a learner types who knows which options are right, which pairs, or a value."""
    if not part.options:
        return f"{answer:g}"
    if part.targets:
        numbers = {name: number for number, name in part.targets}
        return " ".join(f"{mark}{numbers[answer[name]]}" for mark, name in part.options)
    if isinstance(answer, dict):
        return " ".join(mark for mark, name in part.options if answer.get(name))
    values = [float(name.strip("=").split()[0].rstrip("°").replace("−", "-"))
              for _, name in part.options]  # fmt: skip
    return part.options[int(np.argmin([abs(value - answer) for value in values]))][0]


def check_answers(name: str, seed: int) -> None:
    variant = draw_variant(BANK.template(name), seed)
    answers = ANSWERS[name](Drawn(variant))
    assert len(answers) == len(BANK.template(name).rules.part)
    for index, answer in enumerate(answers):
        part = ask_part(variant, index)
        typed = answer if isinstance(answer, str) else type_choice(part, answer)
        verdict = grade_answer(part.spec, typed)
        assert verdict.verdict == "correct", (
            name,
            seed,
            index,
            typed,
            show_key(part.spec),
            verdict,
        )


@pytest.mark.parametrize("name", sorted(ANSWERS))
def test_answers_from_elsewhere_are_right(name):
    for seed in range(3):
        check_answers(name, seed)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(ANSWERS))
def test_answers_from_elsewhere_are_right_in_many_draws(name):
    for seed in range(3, draws(13, full=53)):
        check_answers(name, seed)


def test_every_template_is_compared_or_is_of_words():
    assert {*BANK.template_paths} == {*ANSWERS} | WORDS | ELSEWHERE


def count_lines(name: str) -> int:
    """Count the lines of an exercise that are not blank: its files, its figure and its solver."""
    template = BANK.template(name)
    files = [file for file in template.path.iterdir() if file.suffix in {".toml", ".md", ".py"}]
    if template.rules.solver:
        files.append(ROOT / "solvers" / f"{template.rules.solver}.py")
    return sum(
        bool(line.strip()) for file in files for line in file.read_text("utf-8").splitlines()
    )


def test_the_table_counts_lines_and_mistakes():
    rows_ = [line.split(" | ") for line in (ROOT / "README.md").read_text("utf-8").splitlines()
             if line.startswith("| `")]  # fmt: skip
    found = {row[0].strip("| `"): (int(row[3]), int(row[5].split(" ")[0])) for row in rows_}
    assert found.keys() == {*BANK.template_paths}
    ratios = [int(row[3]) / int(row[4]) for row in rows_ if row[4] != "-"]
    text = (ROOT / "README.md").read_text("utf-8")
    assert f"**{np.median(ratios):.2f}**" in text
    for name, (lines, mistakes) in found.items():
        assert lines == count_lines(name), name
        template = BANK.template(name)
        authored = {trap for part in template.rules.part for trap in part.answer.get("traps", ())}
        solved = (
            {*template.chain.traps, *template.chain.form_traps} if template.rules.solver else set()
        )
        assert mistakes == len(authored | solved), name


def test_all_of_them_make_a_paper(tmp_path):
    run, bank = CliRunner().invoke, ("--bank", str(ROOT), "--trust")
    slots = "".join(f'[[slot]]\ntemplates = ["{name}"]\n' for name in BANK.template_paths)
    blueprint = tmp_path / "every.toml"
    blueprint.write_text(f'minutes = [1, 999]\n[title]\nen = "Every question"\n{slots}', "utf-8")
    asked = (*bank, "--blueprint", str(blueprint), "--seed", "3", "--out")
    made = run(root_group, ["exam", *asked, str(tmp_path / "paper"), "--format", "html"])
    assert made.exit_code == 0, made.output
    found = {path.name for path in (tmp_path / "paper").iterdir()}
    assert {"exam.html", "key.json"} <= found
    assert sum(name.endswith(".csv") for name in found) == len(("lengths", "sample", "shape"))


@pytest.mark.slow
@pytest.mark.parametrize("form", ["moodle", "qti3"])
def test_all_of_them_are_exported(form, tmp_path):
    done = CliRunner().invoke(root_group, ["export", form, "--bank", str(ROOT), "--trust",
                              "--seed", "3", "--out", str(tmp_path / form)])  # fmt: skip
    assert done.exit_code == 0, done.output


@pytest.mark.slow
def test_each_student_has_numbers_of_their_own(tmp_path):
    roster, folder = tmp_path / "roster.csv", tmp_path / "class"
    roster.write_text("id,name\n1815,Ada\n42,Ben\n", "utf-8")
    blueprint = tmp_path / "one.toml"
    blueprint.write_text(
        '[title]\nen = "x"\n[[slot]]\ntemplates = ["median-and-quartiles"]\n', "utf-8"
    )
    made = CliRunner().invoke(root_group, [
        "class", "make", str(roster), "--bank", str(ROOT), "--trust", "--blueprint",
        str(blueprint), "--out", str(folder), "--jobs", "1"])  # fmt: skip
    assert made.exit_code == 0, made.output
    first, second = sorted(path.read_text("utf-8") for path in folder.glob("data/*/*-sample.csv"))
    assert first.splitlines()[0] == second.splitlines()[0] == "x / g"
    assert first != second, "each student has numbers of their own"
