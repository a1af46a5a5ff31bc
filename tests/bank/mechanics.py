"""A small bank of mechanics: units, a figure, a solver and one language of its own."""

from __future__ import annotations

from pathlib import Path

FILES = {
    "templates/bank.toml": """
name = "mechanics"
version = "1.2"
licence = "CC BY 4.0"
authors = ["A. Lecturer"]
requires = ">=1.0"
languages = ["en"]
units = ["crate = [goods] = cr = crates", "haul = kcr * m / s**2 = hu", "press = 100000 * hu / m**2 = press"]
title.en = "Mechanics"
topics.forces.en = "Forces"
""",
    "solvers/forces/newton.py": """
from sympy import evaluate, symbols

from quizgen.maths.model import Model, Step

m, a, F = symbols("m a F")
with evaluate(False):
    MODEL = Model(
        given={m: "kcr", a: "m/s^2"},
        steps=(Step(F, m * a, "hu"),),
        traps={"added": Step(F, m + a, "hu")},
    )
""",
    "templates/forces/push/template.toml": """
topic = "forces"
tier = "A"
solver = "forces/newton"

[draw]
m = { range = [2, 9, 1], unit = "kcr" }
a = { pick = [3, 5, 7], unit = "m/s^2" }

[figure]
name = "block"
values = { m = "m", F = "F" }

[[part]]
points = 2
answer = { kind = "quantity", of = "F", unit = "hu", rel = "0.01" }
""",
    "templates/forces/push/en.md": """# A push
A block of {{ m }} shall be accelerated by {{ a }}.

**How large is the force?**

## steps
- F: Force is mass times acceleration: {{ F }}.

## traps
- added: You added mass and acceleration.

## check
$F/m$ is $a$ again.
""",
    "templates/figures/block.py": """
from quizgen.figures.kit import Parameter, format_equation

SIZE = (250, 60)
PARAMETERS = {"m": Parameter("kcr", "mass", low=0.0), "F": Parameter("hu", "force", low=0.0)}


def draw(fig, values, *, quiz):
    sketch = fig.sketch()
    sketch.area([(90, 10), (150, 10), (150, 50), (90, 50)], "shade", "ink")
    sketch.arrow((150, 30), (220, 30), "red", 1.4)
    sketch.label((185, 42), format_equation("$F$", values["F"], "hu", hide=quiz))


def alt(values, lang, *, quiz):
    force = "of unknown size" if quiz else f"of {values['F']:g} hu"
    return f"A block of {values['m']:g} kcr, pushed by a force {force}."
""",
}


def write(root: Path, changes: dict[str, str] | None = None) -> Path:
    """Write the bank, some of its files with other contents."""
    for name, text in {**FILES, **(changes or {})}.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    return root
