"""A key in a wrong unit: found in every step, and no command makes a paper of it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from click.testing import CliRunner

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.cli.main import root_group
from quizgen.core.errors import BankError

SOLVER = """
from sympy import acos, asin, atan, atan2, cos, evaluate, pi, sin, symbols, tan

from quizgen.maths.model import Model, Step

{names}, y = symbols("{names} y")
with evaluate(False):
    MODEL = Model(given={{{given}}}, steps=(Step(y, {formula}, "{unit}"),))
"""
TEMPLATE = """
topic = "steps"
tier = "A"
solver = "steps/one"
{ignore}
[draw]
{draw}

[[part]]
points = 1
answer = {{ kind = "{kind}", of = "y"{asked}, rel = "0.01" }}
"""
WORDS = """# One step
Given is {{{{ {first} }}}}.

**How large is y?**

## steps
- y: It is {{{{ y }}}}.

## check
No other number fits.
"""


def write_bank(root: Path, formula: str, unit: str, *, ignore: str = "", **given: str) -> Bank:
    """A bank of one step; ``given`` maps letters to a value and its unit: ``U="12 V"``."""
    names = list(given)
    units = {name: text.partition(" ")[2] for name, text in given.items()}
    draw = "\n".join(
        f'{name} = {{ pick = [{text.partition(" ")[0]}], unit = "{units[name]}" }}'
        for name, text in given.items()
    )
    kind, asked = ("quantity", f', unit = "{unit}"') if unit else ("number", "")
    files = {
        "templates/bank.toml": 'name = "steps"\nlanguages = ["en"]\ntopics.steps.en = "Steps"\n',
        "solvers/steps/one.py": SOLVER.format(
            names=", ".join(names),
            given=", ".join(f'{name}: "{text}"' for name, text in units.items()),
            formula=formula,
            unit=unit,
        ),
        "templates/steps/one/template.toml": TEMPLATE.format(
            ignore=ignore, draw=draw, kind=kind, asked=asked
        ),
        "templates/steps/one/en.md": WORDS.format(first=names[0]),
    }
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    return Bank(root, trusted=True)


def draw_answer(bank: Bank) -> float:
    (value,) = draw_variant(bank.template("one"), 1).answer_of_part(0)
    return float(value)


@pytest.mark.parametrize(
    ("formula", "unit", "given", "answer"),
    [
        ("U*I", "W", {"U": "12 V", "I": "40 mA"}, 0.48),
        ("U*I", "mW", {"U": "12 V", "I": "40 mA"}, 480),
        ("R*C", "us", {"R": "10 kohm", "C": "220 pF"}, 2.2),
        ("m*c*T", "kJ", {"m": "200 g", "c": "4182 J/(kg*K)", "T": "10 K"}, 8.364),
        ("p*V/(R*T)", "mol", {"p": "1 bar", "V": "24 l", "R": "8 J/(mol*K)", "T": "300 K"}, 1.0),
        ("s/t", "km/h", {"s": "100 m", "t": "10 s"}, 36),
        ("k/w", "eV", {"k": "1240 eV*nm", "w": "620 nm"}, 2),
        ("n*p", "€", {"n": "3 1", "p": "2.5 €"}, 7.5),
        ("180/pi*acos(a)", "°", {"a": "0.5 1"}, 60),
        ("2*(180/pi)*atan(a/b)", "°", {"a": "5 mm", "b": "5 mm"}, 90),
        ("180*atan2(a, b)/pi", "deg", {"a": "5 mm", "b": "5 mm"}, 45),
        ("asin(a)", "rad", {"a": "1 1"}, 1.5707963),
        ("b*sin(a*pi/180)", "mm", {"a": "30 °", "b": "4 mm"}, 2),
        ("360/n", "°", {"n": "8 1"}, 45),
    ],
)  # fmt: skip
def test_units_are_coherent(tmp_path, formula, unit, given, answer):
    assert draw_answer(write_bank(tmp_path, formula, unit, **given)) == pytest.approx(answer)


WRONG = [
    ("-atan(f/g)", "°", {"f": "3 kHz", "g": "500 Hz"}, "in radians.*180/pi"),
    ("acos(c)", "°", {"c": "0.77 1"}, "in radians"),
    ("s/r", "°", {"s": "2 m", "r": "4 m"}, "in radians"),
    ("2*pi/n", "°", {"n": "6 1"}, "in radians"),
    ("sin(a)", "", {"a": "30 °"}, "sin of degrees.*pi/180"),
    ("pi/180*acos(c)", "°", {"c": "0.77 1"}, "in radians"),
    ("a + 0", "rad", {"a": "30 °"}, "in degrees"),
    ("1.008*n", "g/mol", {"n": "2 1"}, "is a plain number.*1 would be 1000 g/mol"),
    ("U/I", "W", {"U": "3 V", "I": "90 mA"}, "and the step says 'W'"),
    ("Q/T", "J/K", {"Q": "5 J", "T": "20 °C"}, r"°C\^-1 \(draw it in K, too"),
    (f"sin({'+'.join(['a'] * 99)})", "", {"a": "30 °"}, r" \.\.\.: sin of degrees"),
    ("m*v", "J", {"m": "3 kg", "v": "2 m/s"}, "and the step says 'J'"),
    ("T + d", "K", {"T": "20 °C", "d": "3 K"}, "cannot be put together"),
    ("a + b", "€", {"a": "20 €", "b": "3 $"}, "cannot be put together"),
]


@pytest.mark.parametrize(("formula", "unit", "given", "said"), WRONG)
def test_a_formula_of_another_unit_gives_no_variant(tmp_path, formula, unit, given, said):
    bank = write_bank(tmp_path, formula, unit, **given)
    with pytest.raises(BankError, match=rf"one\.py:8: step 'y' .*{said}"):
        draw_answer(bank)


@pytest.mark.parametrize(
    "command",
    [
        ("exam", "--topic", "steps", "--format", "html", "--out", "paper"),
        ("preview", "one"),
        ("export", "moodle", "--topic", "steps", "--out", "export"),
        ("cards", "--topic", "steps", "--out", "deck"),
        ("lint",),
    ],
    ids=lambda command: command[0],
)
def test_no_command_gives_a_key_in_radians_for_degrees(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    write_bank(tmp_path / "bank", "-atan(f/g)", "°", f="3 kHz", g="500 Hz")
    done = CliRunner().invoke(root_group, [*command, "--bank", "bank", "--trust"])
    assert done.exit_code
    assert "in radians" in f"{done.output}{done.exception}"
    assert {path.name for path in tmp_path.iterdir()} <= {"bank"}


def test_an_author_who_means_it_says_so(tmp_path):
    bank = write_bank(tmp_path, "U*I", "A", U="3 V", I="2 A", ignore='ignore = ["QG203"]')
    assert draw_answer(bank) == 6
