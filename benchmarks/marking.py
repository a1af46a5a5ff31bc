"""Answers per second on one core, by kind, with the input mix stated.

Run ``python benchmarks/marking.py``. Every spec is a plain table that is decoded anew for every
answer, as ``quizgen mark --batch`` does; each line is the best of three rounds of CPU time.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

from flint import fmpq

from quizgen.grading.options import QuestionContext
from quizgen.kinds.grade import grade_answer
from quizgen.maths.chain import Chain, ChainStep
from quizgen.maths.notation import parse_formula

Task = tuple[dict[str, Any], str]
BANGLA = str.maketrans("0123456789", "০১২৩৪৫৬৭৮৯")


def numbers(indices: range) -> Iterator[Task]:
    """40 % point, 20 % comma, 10 % each Bangla, fraction, scientific, wrong value."""
    for i in indices:
        spec = {"kind": "number", "value": f"{i}/7", "decimals": 3}
        text = f"{i / 7:.3f}"
        forms = [text, text, text, text, text.replace(".", ","), text.replace(".", ",")]
        forms += [text.translate(BANGLA), f"{i}/7", f"{i / 7:.5e}", f"{i / 7 + 1:.3f}"]
        yield spec, forms[i % 10]


def quantities(indices: range) -> Iterator[Task]:
    """50 % key's unit, 20 % another prefix, 10 % each comma, missing unit, prefix slip."""
    for i in indices:
        spec = {"kind": "quantity", "value": f"{i}/3", "unit": "mm", "rel": "0.005"}
        value = i / 3
        forms = [f"{value:.2f} mm"] * 5 + [f"{value / 10:.4f} cm", f"{value / 1000:.6f} m"]
        forms += [f"{value:.2f} mm".replace(".", ","), f"{value:.2f}", f"{value:.2f} m"]
        yield spec, forms[i % 10]


def points(indices: range) -> Iterator[Task]:
    """Half ``(a; b)``, a quarter ``a, b``, a quarter swapped."""
    for i in indices:
        a, b = i / 3, i / 4 + 1
        spec = {"kind": "point", "values": [f"{i}/3", f"{i + 4}/4"], "abs": "0.005"}
        forms = [
            f"({a:.2f}; {b:.2f})",
            f"({a:.2f}; {b:.2f})",
            f"{a:.2f}, {b:.2f}",
            f"({b:.2f}; {a:.2f})",
        ]
        yield spec, forms[i % 4]


def tables(indices: range) -> Iterator[Task]:
    """Two cells; half by name, half in order."""
    for i in indices:
        spec = {"kind": "table", "values": {"a": str(i), "b": f"{i}/2"}, "rel": "0.005"}
        yield spec, f"a = {i}; b = {i / 2}" if i % 2 else f"{i}; {i / 2}"


GAPS = [("demosaicing", ["mosaicing", "denoising"]), ("far-sighted", ["near-sighted"])]


def gaps(indices: range) -> Iterator[Task]:
    """Half right, a quarter misspelt, a quarter another term."""
    for i in indices:
        term, others = GAPS[i % 2]
        spec = {"kind": "gap", "accept": [[term]], "among": others}
        yield spec, [term, term.upper(), term[:4] + term[5:], others[0]][i // 2 % 4]


FORMULAS = [
    ("f*X/Z", dict.fromkeys("fXZ", "positive"), ["fX/Z", "f·X/Z", "X f / Z", "f*Z/X"]),
    ("sqrt(N)", {"N": "positive"}, ["√N", "N^0.5", "N/sqrt(N)", "N"]),
    ("x*(1+k1*r^2)", dict.fromkeys(["x", "k1", "r"], "real"), ["x(1+k1 r²)", "x + x k1 r²"] * 2),
]


def formulas(indices: range) -> Iterator[Task]:
    """Three formulas, three quarters right in different spellings, the rest wrong."""
    for i in indices:
        value, symbols, forms = FORMULAS[i % 3]
        yield {"kind": "expression", "value": value, "symbols": symbols}, forms[i // 3 % 4]


def _context() -> QuestionContext:
    steps = [("h", "f*X/Z", "mm"), ("n", "h/pitch", "px"), ("c", "n + o", "px")]
    given = {"f": "mm", "X": "m", "Z": "m", "pitch": "um", "o": "px"}
    chain = Chain(given, tuple(ChainStep(n, parse_formula(t), u) for n, t, u in steps))
    values = [fmpq(1, 20), fmpq(30), fmpq(600), fmpq(5, 10**6), fmpq(320)]
    return QuestionContext(chain, dict(zip(given, values, strict=True)))


def wrong(indices: range) -> Iterator[Task]:
    """Wrong values of a quantity three steps deep, none of them explained."""
    for i in indices:
        yield {"kind": "number", "value": "820", "rel": "0.005", "of": ["c"]}, f"{900 + i % 977}.7"


def rate(
    tasks: Callable[[range], Iterator[Task]], count: int, context: QuestionContext | None = None
) -> float:
    """Answers per CPU second, best of three.

    Every round has other numbers; the key formulas and terms repeat, as in a class of students.
    """
    for spec, typed in tasks(range(1, 20)):
        grade_answer(spec, typed, context=context)
    best = 0.0
    for turn in range(1, 4):
        work = list(tasks(range(turn * 10_000, turn * 10_000 + count)))
        start = time.process_time()
        for spec, typed in work:
            grade_answer(spec, typed, context=context)
        best = max(best, count / (time.process_time() - start))
    return best


LINES = [
    ("number", numbers, 5000, None, 40_000),
    ("quantity", quantities, 5000, None, 20_000),
    ("point", points, 3000, None, 10_000),
    ("table", tables, 3000, None, 10_000),
    ("gap", gaps, 3000, None, 10_000),
    ("expression", formulas, 1500, None, 4_500),
    ("full diagnosis", wrong, 500, _context, 6_000),
]


def main() -> None:
    """Print one line per kind."""
    print(f"{'kind':16}{'answers/s':>12}{'target':>10}  mix")
    for name, tasks, count, context, target in LINES:
        found = rate(tasks, count, context() if context else None)
        print(f"{name:16}{found:12,.0f}{target:10,}  {(tasks.__doc__ or '').strip()}")


if __name__ == "__main__":
    main()
