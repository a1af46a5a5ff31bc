"""Whether an answer worked out from a page is the one in ``key.json``, within what the page allows.

The rounding sentence is read off the page, in either language; formulas and conditions of the key
are evaluated here, by Python, so that nothing of the product takes part.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from printed_numbers import UNITS

Spec = Mapping[str, Any]
NUMERIC = {"number", "quantity", "angle", "point", "table", "set", "interval"}
OWED = NUMERIC | {"expression", "witness", "code", "program", "sketch", "derivation"}
"""Kinds of answers that every solver has to give; those of choices where numbers decide."""
COUNTED = {"DN": 1, "stop": 1, "e-": 1, "deg": 1}
"""Units of keys that say what is counted."""


def _last_place(value: Fraction, figures: int) -> Fraction:
    return Fraction(10) ** (math.floor(math.log10(abs(value))) + 1 - figures)


RULES = [
    (r"± ([\d.]+)", lambda n, _: Fraction(n)),
    (r"within ([\d.]+) %|([\d.]+) % পর্যন্ত", lambda n, key: abs(key) * Fraction(n) / 100),
    (r"Round to (\d) decimals?|দশমিকের পর (\d) ঘর", lambda n, _: Fraction(1, 2 * 10 ** int(n))),
    (r"(\d) significant|(\d)ট[িা] সার্থক", lambda n, key: _last_place(key, int(n)) / 2),
    (r"(Round to a whole number)|(পূর্ণসংখ্যায় round)", lambda *_: Fraction(1, 2)),
    (r"(exact value)|(হুবহু মান দিন[।;])", lambda _, key: abs(key) / 10**12),
]  # fmt: skip


def allowed(hint: str, key: Fraction) -> Fraction:
    """By how much an answer may differ from the key, as the hint on the page says."""
    for pattern, rule in RULES:
        if found := re.search(pattern, hint):
            return rule(next(filter(None, found.groups())), key)
    raise AssertionError(f"no tolerance is printed: {hint!r}")


def agrees(mine: Any, spec: Spec, hint: str) -> bool:
    """Whether an answer is the key's."""
    kind = spec["kind"]
    return NUMBERS(mine, spec, hint) if kind in NUMERIC else OTHERS[kind](mine, spec)


def NUMBERS(mine: Any, spec: Spec, hint: str) -> bool:  # noqa: N802
    """Compare values in the units of the key; a percentage is compared as one."""
    values = spec.get("values", spec.get("value"))
    keys = list(values.values()) if isinstance(values, dict) else values
    keys = keys if isinstance(keys, list) else [keys]
    units = spec.get("units", {})
    asked = (
        [units.get(name, "") for name in values] if units else [spec.get("unit", "")] * len(keys)
    )
    given = mine if isinstance(mine, Sequence) else [mine]
    scale = 100 if spec.get("percent") else 1
    return len(given) == len(keys) and all(
        _near(Fraction(one) / (UNITS | COUNTED)[unit] * scale, Fraction(key) * scale, hint, spec)
        for one, key, unit in zip(given, keys, asked, strict=True)
    )


def _near(mine: Fraction, key: Fraction, hint: str, spec: Spec) -> bool:
    if spec.get("accept") and not any(re.search(pattern, hint) for pattern, _ in RULES):
        low, high = map(Fraction, spec["accept"])
        return low <= mine <= high
    off = abs(mine - key)
    if spec.get("period"):
        off = min(off % spec["period"], -off % spec["period"])
    return off <= allowed(hint, key)


def _in_order(mine: Sequence[str], spec: Spec) -> bool:
    before = spec["before"] or list(zip(spec["steps"], spec["steps"][1:], strict=False))
    return sorted(mine) == sorted(spec["steps"]) and all(
        mine.index(a) < mine.index(b) for a, b in before
    )


def _gaps(mine: Sequence[str], spec: Spec) -> bool:
    return all(one in words for one, words in zip(mine, spec["accept"], strict=True))


MATHS = {name: getattr(math, name) for name in ("sqrt", "exp", "log", "log2", "floor", "pi", "erf")}
MATHS |= {"max": max, "min": min, "abs": abs}


def calculated(formula: str, values: Mapping[str, Any]) -> Any:
    """The value of a formula of the key, or whether a condition holds."""
    python = formula.replace("{", "(").replace("}", ")").replace("^", "**")
    python = re.sub(r"(?<![<>!=])=(?!=)", "==", python)
    python = re.sub(r"(?<![\w.*])(\d+(?:\.\d+)?)(?![\w.])", r"F('\1')", python)
    return eval(python, {"F": Fraction, **MATHS, **values})


def _formula(mine: Callable[..., float], spec: Spec) -> bool:
    names = sorted(spec["symbols"])
    places = [[0.3 + 0.17 * ((3 * i + 5 * j) % 11) for i in range(len(names))] for j in range(12)]
    found = [dict(zip(names, place, strict=True)) for place in places]
    return all(
        math.isclose(float(calculated(spec["value"], one)), mine(**one), rel_tol=1e-9)
        for one in found
    )


def _holds(mine: Mapping[str, Any], spec: Spec) -> bool:
    symbols = spec["symbols"]
    known = dict(mine)
    for name, formula in spec.get("let", {}).items():
        known[name] = calculated(formula, known)
    inside = isinstance(symbols, list) or all(
        mine[name] > 0 if domain == "positive" else _between(mine[name], domain)
        for name, domain in symbols.items()
    )
    demands = [one["holds"] for one in spec.get("demands", {}).values()]
    conditions = [*spec.get("where", []), *(demands or [spec["predicate"]])]
    return set(mine) == set(symbols) and inside and all(calculated(c, known) for c in conditions)


def _between(value: float, bounds: Sequence[Any]) -> bool:
    low, high = map(Fraction, bounds)
    return low <= value <= high


def _lines(mine: Sequence[Sequence[tuple[float, float]]], spec: Spec) -> bool:
    """Whether the lines of a drawing are those of the key, point by point."""
    wanted = [
        [tuple(map(float, point.split(","))) for point in line.split()]
        for line in spec["lines"].values()
    ]
    return len(mine) == len(wanted) and all(
        any(len(a) == len(b) and all(math.dist(p, q) < 1e-3 for p, q in zip(a, b, strict=True))
            for b in wanted)
        for a in mine
    )  # fmt: skip


def _does_the_same(mine: Callable[..., Any], spec: Spec) -> bool:
    """Whether a function gives on every hidden input what the solution of the key gives."""
    space: dict[str, Any] = {"np": np}
    exec(spec["solution"], space)
    with np.errstate(all="ignore"):
        return all(
            _alike(mine(*_inputs(case)), space[spec["function"]](*_inputs(case)))
            for case in spec["cases"].values()
        )


def _inputs(case: Mapping[str, Any]) -> list[Any]:
    return [
        np.array(*one.values(), dtype=next(iter(one))) if isinstance(one, dict) else one
        for one in case["args"]
    ]


def _alike(mine: Any, theirs: Any) -> bool:
    one, other = np.asarray(mine), np.asarray(theirs)
    return (one.shape, one.dtype.kind) == (other.shape, other.dtype.kind) and bool(
        np.allclose(one.astype(float), other.astype(float), 1e-9, 1e-9, equal_nan=True)
    )


PLACES = 40
"""Places at which the lines of a derivation are tried."""


def _derived(mine: Callable[[Mapping[str, float]], Mapping[str, float]], spec: Spec) -> bool:
    """Whether every line holds for the derived quantities as they were worked out, and no mistake."""
    names = sorted(spec["symbols"])
    places = (_place(spec, names, j) for j in range(PLACES))
    found = [env for env in places
             if _fits(mine, spec, env)]  # fmt: skip
    lines = [form for line in spec["lines"].values() for form in line["forms"]]
    right = all(_true(line, env) for line in (*lines, *spec.get("given", ())) for env in found)
    wrong = [form for forms in spec.get("traps", {}).values() for form in forms]
    return len(found) > 3 and right and not any(all(_true(w, e) for e in found) for w in wrong)


def _place(spec: Spec, names: Sequence[str], j: int) -> dict[str, float]:
    """Numbers for all names, each within its bounds."""
    shares = {name: (0.13 + 0.37 * ((3 * i + 5 * j) % 11)) / 4 for i, name in enumerate(names)}
    bounds = {
        name: of if isinstance(of, list) else (0.05, 4) for name, of in spec["symbols"].items()
    }
    return {name: float(low) + share * (float(high) - float(low))
            for name, share in shares.items() for low, high in [bounds[name]]}  # fmt: skip


def _fits(mine: Callable[..., Mapping[str, float]], spec: Spec, env: dict[str, float]) -> bool:
    """Put the derived quantities in, and say whether the place meets the conditions."""
    env.update(mine(env))
    return all(_python(one, env) for one in spec.get("where", ()))


def _true(line: str, env: Mapping[str, float]) -> bool:
    """Whether a line of a key holds at a place."""
    if re.search("[<>!]", line):
        return bool(_python(line, env))
    left, right = (_python(side, env) for side in line.split("="))
    return math.isclose(left, right, rel_tol=1e-9, abs_tol=1e-9)


def _python(formula: str, env: Mapping[str, float]) -> Any:
    """The value of a formula whose names may have primes."""
    values = {name.replace("'", "_prime"): value for name, value in env.items()}
    return calculated(formula.replace("'", "_prime"), {"log2": math.log2, "ln": math.log, **values})


OTHERS: dict[str, Callable[[Any, Spec], bool]] = {
    "choice": lambda mine, spec: mine == set(spec["correct"]),
    "multi": lambda mine, spec: mine == set(spec["correct"]),
    "tf": lambda mine, spec: spec["correct"] == [1 if mine else 2],
    "match": lambda mine, spec: {a: str(b) for a, b in mine.items()} == spec["pairs"],
    "code": lambda mine, spec: mine.split() == spec["output"].split(),
    "order": _in_order,
    "gap": _gaps,
    "expression": _formula,
    "witness": _holds,
    "sketch": _lines,
    "program": _does_the_same,
    "derivation": _derived,
}
