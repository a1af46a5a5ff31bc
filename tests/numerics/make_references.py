"""Write the reference rows: hard inputs and stored worst cases with 40-digit results.

Run: ``python tests/numerics/make_references.py``. Results come from ``oracle`` (mpmath) only.
Each row: function, arguments as hexadecimal doubles, result, tolerance in ulp, origin.
"""

from __future__ import annotations

from pathlib import Path

import mpmath as mp
from hard_inputs import hard_rows
from oracle import reference

HERE = Path(__file__).parent
WIDER = {"poisson.lower": 8}


def worst_rows():
    """Inputs found by ``find_worst.py``."""
    for line in (HERE / "worst_inputs.tsv").read_text().splitlines():
        name, args, origin = line.split("\t")
        yield name, tuple(float.fromhex(arg) for arg in args.split()), origin


def tolerance(name, args):
    """Units in the last place allowed, from the project's stated limits."""
    if name == "distortion.inverse_radius" and args[2] != 0:
        return 8
    return WIDER.get(name, 4)


def row(name, args, origin):
    """One line of the file."""
    text = mp.nstr(reference(name, args), 40, strip_zeros=False)
    return "\t".join(
        (name, " ".join(arg.hex() for arg in args), text, str(tolerance(name, args)), origin)
    )


def write():
    """Write one file per family."""
    rows = {}
    for name, args, origin in (*hard_rows(), *worst_rows()):
        rows.setdefault(name.split(".")[0], []).append(row(name, args, origin))
    for family, lines in rows.items():
        (HERE / "rows" / f"{family}.tsv").write_text("\n".join(dict.fromkeys(lines)) + "\n")


if __name__ == "__main__":
    (HERE / "rows").mkdir(exist_ok=True)
    write()
