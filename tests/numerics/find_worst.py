"""Search for inputs with large errors: random starts near a singularity, then local moves.

Run: ``python tests/numerics/find_worst.py [seed]``. Writes ``worst_inputs.tsv``; the functions
under test only choose the inputs, the expected values come from ``oracle``.
"""

# ruff: noqa: PLW2901 - what is found replaces what it was found from

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from functions import function
from oracle import reference
from ulp import ulps

STARTS, MOVES, KEPT = 100, 100, 4


def near(x, rng, nearest=-15, farthest=0):
    """A double at a log-uniform relative distance from x."""
    return x * (1 + rng.choice((-1, 1)) * 10 ** rng.uniform(nearest, farthest) * 0.9)


def positive(rng):
    return 10 ** rng.uniform(-3, 3)


def barrel(rng):
    k1 = -positive(rng)
    return 2 / 3 / np.sqrt(-3 * k1) * (1 - 10 ** rng.uniform(-14, -0.1)), k1, 0.0


SPACES = {
    "gaussian.inverse_upper_tail": lambda rng: (10 ** rng.uniform(-300, -0.001),),
    "distortion.inverse_radius": barrel,
    "distortion.distort_x": lambda rng: (
        *rng.uniform(0, 1, 2).tolist(),
        rng.uniform(-0.5, 0.5),
        rng.uniform(-0.1, 0.1),
    ),
    "hsv.red": lambda rng: (
        rng.uniform(-720, 720),
        1 - 10 ** rng.uniform(-9, 0),
        rng.uniform(0, 1),
    ),
    "gamma.srgb_decode": lambda rng: (10 ** rng.uniform(-2, 0),),
    "luminosity.luminous_efficiency": lambda rng: (rng.uniform(355, 835),),
}


def error(name, args):
    """Error in ulp, or -1 where there is no answer."""
    try:
        truth = reference(name, args)
        alone = ulps(function(name)(*args), truth)
        array = function(name)(*[np.array([arg, arg]) for arg in args])
        return max(alone, ulps(array[0], truth))
    except (ValueError, ArithmeticError):
        return -1.0


def search(name, rng):
    """Best inputs of random starts followed by moves of a few ulp to per mille."""
    best = sorted(
        ((error(name, a), a) for a in (SPACES[name](rng) for _ in range(STARTS))), reverse=True
    )[:KEPT]
    found = []
    for value, args in best:
        for _ in range(MOVES):
            moved = [a * (1 + rng.normal() * 10 ** rng.uniform(-15, -3)) for a in args]
            trial = tuple(map(float, moved))
            score = error(name, trial)
            if score > value:
                value, args = score, trial
        found.append((value, args))
    return found


def main(seed):
    """Search, and keep what was found for functions that are no more: formulas must hold there too."""
    rng, file = np.random.default_rng(seed), Path(__file__).parent / "worst_inputs.tsv"
    lines = [line for line in file.read_text().splitlines() if line.split("\t")[0] not in SPACES]
    for name in SPACES:
        for value, args in search(name, rng):
            print(name, round(value, 2), args)
            found = " ".join(float(a).hex() for a in args)
            lines.append(f"{name}\t{found}\tlocal search, seed {seed}")
    file.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1)
