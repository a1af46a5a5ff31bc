"""A bank of steps that are any SymPy: derivatives, matrices, sets, complex numbers, quantiles."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

BANK = """
name = "symbolic"
version = "1.0"
licence = "MIT"
languages = ["en"]
[title]
en = "Symbolic"
[topics]
any = { en = "Any" }
"""

PROSE = """# {title}
{stem}

## steps
{steps}

## traps
{traps}

## check
Type it into a computer algebra system.
"""

HEAD = "from sympy import *\n\nfrom quizgen.maths.model import Model, Step\n\n"

SOLVERS = {
    "derivative": """
a, b, c, D, x = symbols("a b c D x")
f, df = Function("f")(x), Function("df")(x)
MODEL = Model(
    given={a: "", b: "", c: ""},
    free=("x",),
    steps=(Step(f, a*x**3*exp(b*x)), Step(df, diff(f, x)), Step(D, df.subs(x, c))),
    traps={"first": Step(df, 3*a*x**2*exp(b*x)), "power": Step(df, a*b*x**3*exp(b*x))},
)
""",
    "antiderivative": """
a, b, x = symbols("a b x")
MODEL = Model(
    given={a: "", b: ""},
    free=("x",),
    steps=(Step("f", a*x**2 + b*cos(x)), Step("F", integrate(a*x**2 + b*cos(x), x))),
    traps={"sign": Step("F", a*x**3/3 - b*sin(x))},
)
""",
    "factors": """
p, q, x = symbols("p q x")
MODEL = Model(
    given={p: "", q: ""},
    free=("x",),
    steps=(Step("g", expand((x - p)*(x + q))), Step("h", (x - p)*(x + q))),
    traps={"signs": Step("h", (x + p)*(x - q))},
)
""",
    "matrix": """
a, b, c, d, m = symbols("a b c d m")
A, B = MatrixSymbol("A", 2, 2), MatrixSymbol("B", 2, 2)
MODEL = Model(
    given={a: "", b: "", c: ""},
    steps=(
        Step(A, Matrix([[a, b], [1, c]])),
        Step(B, Matrix([[2, 0], [a, 1]])),
        Step("P", A*B),
        Step(d, det(A)),
        Step("I", A.inv()),
        Step("v", Matrix([a, b, c])),
    ),
    traps={"turned": Step("P", B*A), "plus": Step(d, a*c + b)},
)
""",
    "solutions": """
p, q, x = symbols("p q x")
MODEL = Model(
    given={p: "", q: ""},
    steps=(
        Step("S", Union(Interval(-oo, -p), Interval.open(q, oo))),
        Step("R", Interval.Lopen(-p, q)),
        Step("T", FiniteSet(p, -q, 2*p + 1)),
        Step("eq", Eq((symbols("x") - p)**2 + symbols("y")**2, q**2)),
    ),
    free=("x", "y"),
    traps={
        "closed": Step("S", Union(Interval(-oo, -p), Interval(q, oo))),
        "radius": Step("eq", Eq((symbols("x") - p)**2 + symbols("y")**2, q)),
        "signs": Step("T", FiniteSet(-p, q, 2*p + 1)),
    },
)
""",
    "complex": """
a, b, r = symbols("a b r")
z = symbols("z")
MODEL = Model(
    given={a: "", b: ""},
    steps=(Step(z, a + b*I), Step("w", z**2), Step(r, Abs(z)), Step("u", 1/z)),
    traps={"squares": Step("w", a**2 + b**2*I)},
)
""",
    "statistics": """
n, p, k, t, w, s = symbols("n p k t w s")
quantile = Function("t_quantile")
MODEL = Model(
    given={n: "", p: ""},
    steps=(
        Step(t, quantile(Rational(39, 40), n - 1)),
        Step(w, Sum(binomial(n, k)*p**k*(1 - p)**(n - k), (k, 0, 2))),
        Step(s, Integral(exp(-p*k**2), (k, 0, 1))),
    ),
    traps={"freedom": Step(t, quantile(Rational(39, 40), n)),
           "point": Step(w, binomial(n, 2)*p**2*(1 - p)**(n - 2))},
)
""",
    "edge": """
a, b, s, t, phi = symbols("a b s t phi")
length = sqrt(a**2 + 1)*sqrt(b**2 + 4)
MODEL = Model(
    given={a: "", b: ""},
    steps=(Step(s, a*b + 2), Step(t, length), Step(phi, acos(s/t), "rad")),
    traps={"lengths": Step(s, length), "first": Step(s, a*b)},
)
""",
}

DRAWS = {
    "derivative": "a = { range = [2, 9, 1] }\nb = { pick = [-2, -1, 1, 2] }\nc = { range = [4, 7, 1] }",
    "antiderivative": "a = { range = [2, 9, 1] }\nb = { range = [2, 9, 1] }",
    "factors": "p = { range = [1, 9, 1] }\nq = { range = [2, 9, 1] }",
    "matrix": "a = { range = [2, 9, 1] }\nb = { range = [3, 9, 1] }\nc = { range = [-7, -2, 1] }",
    "solutions": "p = { range = [1, 9, 1] }\nq = { range = [2, 9, 1] }",
    "complex": "a = { range = [1, 9, 1] }\nb = { range = [2, 9, 1] }",
    "statistics": 'n = { range = [5, 30, 1] }\np = { pick = ["0.1", "0.2", "0.3", "0.4"] }',
    "edge": "a = { range = [3, 9, 1] }\nb = { range = [2, 4, 1] }",
}

PARTS = {
    "derivative": ['{ kind = "expression", of = "df" }', '{ kind = "number", of = "D", sigfigs = 4 }'],
    "antiderivative": ['{ kind = "expression", of = "F", up_to = "constant" }'],
    "factors": ['{ kind = "expression", of = "h", form = "factored" }'],
    "matrix": [
        '{ kind = "matrix", of = "P" }', '{ kind = "number", of = "d", exact = true }',
        '{ kind = "matrix", of = "I", decimals = 3 }', '{ kind = "vector", of = "v", up_to = "scale" }',
    ],
    "solutions": [
        '{ kind = "interval", of = "S" }', '{ kind = "interval", of = "R" }',
        '{ kind = "set", of = "T" }', '{ kind = "equation", of = "eq", symbols = ["x", "y"] }',
    ],
    "complex": [
        '{ kind = "complex", of = "w", form = "cartesian" }', '{ kind = "number", of = "r", exact = true }',
        '{ kind = "complex", of = "u" }', '{ kind = "complex", of = "z", form = "polar" }',
    ],
    "statistics": [
        '{ kind = "number", of = "t", sigfigs = 4 }', '{ kind = "number", of = "w", sigfigs = 4 }',
        '{ kind = "number", of = "s", sigfigs = 4 }',
    ],
    "edge": ['{ kind = "quantity", of = "phi", unit = "rad", decimals = 3 }'],
}  # fmt: skip

STEMS = {"derivative": "Differentiate {{ f }}.", "factors": "Factor {{ g }}."}

STEPS = {
    "derivative": "df D", "antiderivative": "F", "factors": "h", "matrix": "P d I v",
    "solutions": "S R T eq", "complex": "w r u z", "statistics": "t w s", "edge": "s t phi",
}  # fmt: skip

TRAPS = {
    "derivative": "first power", "antiderivative": "sign", "factors": "signs",
    "matrix": "turned plus", "solutions": "closed radius signs", "complex": "squares",
    "statistics": "freedom point", "edge": "lengths first",
}  # fmt: skip


def write_bank(folder: Path, *names: str) -> Path:
    """The bank with some of its questions; all by default."""
    (folder / "templates" / "any").mkdir(parents=True)
    (folder / "solvers").mkdir()
    (folder / "templates" / "bank.toml").write_text(BANK)
    for name in names or SOLVERS:
        write_question(folder, name)
    return folder


def write_question(folder: Path, name: str) -> None:
    home = folder / "templates" / "any" / name
    home.mkdir()
    (folder / "solvers" / f"{name}.py").write_text(HEAD + SOLVERS[name])
    parts = "\n".join(f"[[part]]\nanswer = {answer}" for answer in PARTS[name])
    draws = DRAWS[name]
    drawn = [line.split(" ")[0] for line in draws.splitlines()]
    rules = f'topic = "any"\ntier = "B"\nsolver = "{name}"\nlevels = []\n[draw]\n{draws}\n{parts}\n'
    (home / "template.toml").write_text(rules)
    stem = STEMS.get(name, "") + " Here " + ", ".join(f"${n}$ = {{{{ {n} }}}}" for n in drawn) + "."
    if len(PARTS[name]) > 1:
        stem += "".join(f"\n\n## {label}\nFind it." for label in "abcdefg"[: len(PARTS[name])])
    listed = {
        "steps": "\n".join(f"- {step}: By the rules." for step in STEPS[name].split()),
        "traps": "\n".join(f"- {trap}: Look at {trap} again." for trap in TRAPS[name].split()),
    }
    (home / "en.md").write_text(PROSE.format(title=name, stem=stem.strip(), **listed))


def write_questions(folder: Path, solvers: Mapping[str, tuple[str, str, list[str]]]) -> Path:
    """Write a bank of questions: of each the model, its draws and what parts ask."""
    (folder / "templates").mkdir(parents=True)
    (folder / "solvers").mkdir()
    (folder / "templates" / "bank.toml").write_text(BANK)
    for name, written in solvers.items():
        write_parts(folder, name, *written)
    return folder


def write_parts(folder: Path, name: str, model: str, draws: str, asked: list[str]):
    """Write a question of which each part asks something of the model."""
    (folder / "solvers" / f"{name}.py").write_text(HEAD + model)
    home = folder / "templates" / "any" / name
    home.mkdir(parents=True)
    parts = [f"[[part]]\nanswer = {{ {answer} }}" for answer in asked]
    draws = draws.replace("\\n", "\n")
    (home / "template.toml").write_text(
        f'topic = "any"\ntier = "B"\nsolver = "{name}"\nlevels = []\n[draw]\n{draws}\n'
        + "\n".join(parts)
    )
    stem = (
        "Here "
        + ", ".join(f"{line[0]} is {{{{ {line[0]} }}}}" for line in draws.splitlines())
        + "."
    )
    stem += "".join(f"\n\n## {label}\nFind it." for label, _ in zip("abcdef", asked, strict=False))
    traps = "\n".join(f"- {trap}: Look again." for trap in re.findall(r'"(\w+)": Step', model))
    names = re.findall(r"Step\(\"?(\w+)", model.split("traps=", maxsplit=1)[0])
    steps = "\n".join(f"- {name}: By the rules." for name in dict.fromkeys(names))
    (home / "en.md").write_text(PROSE.format(title=name, stem=stem, steps=steps, traps=traps))
