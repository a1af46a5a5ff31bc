"""No draw lets a known mistake score, however a part states its rounding."""

from __future__ import annotations

from pathlib import Path

import pytest

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError
from quizgen.kinds.grade import grade_answer
from quizgen.maths.numbers import to_float
from quizgen.question.part_context import ask_part

TEMPLATE = """
topic = "projection"
tier = "A"
solver = "projection/perspective"
may_vanish = ["forgot-f"]
[draw]
f = {{ range = {f} }}
p_x = {{ range = [-15, 15, 1], skip = [0] }}
p_y = {{ range = [-15, 15, 1], skip = [0] }}
p_z = {{ range = [40, 160, 1] }}
[[part]]
answer = {{ {answer} }}
"""

PROSE = """# T
stem
## traps
- divided-by-f: a
- depth-over-f: b
- forgot-f: c
- forgot-depth: d
- range-for-depth: e
- swapped: f
- physical-plane: g
"""


def template(folder: Path, answer: str, f: str = "[20, 60, 1]"):
    """A template of its own, read from files."""
    place = folder / "templates" / "projection" / "mine"
    place.mkdir(parents=True)
    (place / "template.toml").write_text(TEMPLATE.format(answer=answer, f=f), "utf-8")
    (place / "en.md").write_text(PROSE, "utf-8")
    return Bank(folder).template("mine")


ROUNDINGS = {
    "none stated": "",
    "a share": ', rel = "0.02"',
    "a distance": ', abs = "0.05"',
    "decimals": ", decimals = 1",
    "figures": ", sigfigs = 2",
    "two units of the last place": ', decimals = 1, within = "2"',
}


@pytest.mark.parametrize("rounding", ROUNDINGS.values(), ids=ROUNDINGS)
def test_no_known_mistake_is_marked_right(tmp_path, rounding):
    mine = template(tmp_path, f'kind = "number", of = "p\'_x"{rounding}')
    for seed in range(200):
        drawn = draw_variant(mine, seed)
        spec = ask_part(drawn, 0).spec
        for trap in mine.chain.traps:
            wrong = to_float(mine.chain.solve_with_misconception(trap, drawn.values)["p'_x"])
            assert grade_answer(spec, f"{wrong:.9f}").credit == 0, (seed, trap)


def test_no_known_mistake_lies_in_the_interval_accepted_besides(tmp_path):
    between = '["min(1, 5/2)*f*p_x/p_z", "max(1, 5/2)*f*p_x/p_z"]'
    mine = template(tmp_path, f'kind = "number", of = "p\'_x", rel = "0.001", accept = {between}')
    for seed in range(200):
        drawn = draw_variant(mine, seed)
        key = to_float(drawn.values["p'_x"])
        swapped = to_float(mine.chain.solve_with_misconception("swapped", drawn.values)["p'_x"])
        assert not 1 <= swapped / key <= 2.5 or key < 0


def test_an_angle_without_rounding_keeps_half_a_degree_apart(tmp_path):
    mine = template(tmp_path, 'kind = "angle", of = "p\'_x"', f="[200, 600, 10]")
    for seed in range(200):
        drawn = draw_variant(mine, seed)
        spec = ask_part(drawn, 0).spec
        for trap in mine.chain.traps:
            wrong = to_float(mine.chain.solve_with_misconception(trap, drawn.values)["p'_x"])
            assert grade_answer(spec, f"{wrong:.9f}").credit == 0, (seed, trap)


def test_a_cell_with_a_tolerance_of_its_own_keeps_to_it(tmp_path):
    cells = 'cells = { u = { abs = "1/20" } }'
    mine = template(
        tmp_path, f'kind = "table", of = {{ u = "p\'_x", f = "f" }}, exact = true, {cells}'
    )
    for seed in range(100):
        drawn = draw_variant(mine, seed)
        key = to_float(drawn.values["p'_x"])
        for trap in mine.chain.traps:
            wrong = to_float(mine.chain.solve_with_misconception(trap, drawn.values)["p'_x"])
            assert abs(wrong - key) > 0.05, (seed, trap)


def test_two_roundings_at_once_are_refused_with_the_place(tmp_path):
    mine = template(tmp_path, 'kind = "number", of = "p\'_x", decimals = 1, rel = "0.01"')
    with pytest.raises(BankError, match=r"template\.toml:\d+: part 1: only one of decimals"):
        draw_variant(mine, 0)
