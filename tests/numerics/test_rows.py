"""Every array function against 40-digit values on inputs chosen to break it.

Rows of formulas that have no array function are tried on the exact path (``test_exact_path``), and
on the plain lines of the accuracy page (``tests/tradeoff/test_printed_formulas.py``).
"""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from functions import FUNCTIONS, function
from sweep import together
from ulp import ulps

from quizgen.numerics.domain import DomainError, is_defined

ROWS = [
    line.split("\t")
    for path in sorted((Path(__file__).parent / "rows").glob("*.tsv"))
    for line in path.read_text().splitlines()
]
NAMES = sorted(FUNCTIONS)


def rows_of(name):
    return [read(row)[1:] for row in ROWS if row[0] == name]


def read(row):
    name, args, text, tolerance, _origin = row
    with mp.workdps(45):
        truth = mp.inf if text in {"+inf", "inf"} else mp.mpf(text)
    return name, tuple(map(float.fromhex, args.split())), truth, float(tolerance)


@together("name", NAMES)
def test_alone_and_in_an_array(name):
    """Arrays of ordinary values take shorter ways than scalars and mixed arrays do."""
    wrong = []
    for args, truth, tolerance in rows_of(name):
        pair = function(name)(*[np.array([arg, arg]) for arg in args])
        values = (function(name)(*args), float(pair[0]))
        wrong += [(args, one) for one in values if not ulps(one, truth) <= tolerance]
    assert wrong == []


def test_all_rows_of_a_function_in_one_array():
    for name in NAMES:
        rows = rows_of(name)
        columns = [np.array(column) for column in zip(*(args for args, _, _ in rows), strict=True)]
        values = function(name)(*columns)
        assert np.all(is_defined(values)), name
        for value, (args, truth, tolerance) in zip(values, rows, strict=True):
            assert ulps(float(value), truth) <= tolerance, (name, args)


def patterns(count):
    """Which arguments are one number and which are arrays; not all are numbers."""
    return list(itertools.product((False, True), repeat=count))[:-1]


def mixtures(args):
    """Arguments of which some are arrays and some one number for all."""
    for fixed in patterns(len(args)):
        yield [
            arg if one else np.array([arg, arg * 1.001])
            for arg, one in zip(args, fixed, strict=True)
        ]


@together("name", NAMES)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # the other element may overflow
def test_some_arguments_as_numbers(name):
    """Whatever is an array and whatever one number for all, the answer stays."""
    wrong = []
    for args, truth, tolerance in rows_of(name):
        for mixed in mixtures(args):
            values = function(name)(*mixed)
            if not (is_defined(values)[0] and ulps(float(values[0]), truth) <= tolerance):
                wrong.append((mixed, values))
    assert wrong == []


def test_rows_are_many_and_for_every_family():
    families = {row[0].split(".")[0] for row in ROWS}
    assert len(families) == 8
    assert len(ROWS) > 250


# Published and hand-checked values: the notes, the errata and textbooks.

PRINTED = [
    ("distortion.fold_radius", (-0.25, 0.0), "1.1547005383792515290182975610039149112952"),
    ("distortion.inverse_radius", (0.6928203230275509, -0.25, 0.0), "0.842122266240542597058376431111914615164825"),
    ("distortion.inverse_radius", (0.7698003589187312, -0.25, 0.0), "1.15469959557077248815649073423700620394087"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "args", "text"), PRINTED)
def test_printed_values(name, args, text):
    with mp.workdps(45):
        assert ulps(function(name)(*args), mp.mpf(text)) <= 4


# Where there is no answer.

REFUSED = [
    ("distortion.inverse_radius", (math.nan, -0.25, 0.0), "not-finite"),
    ("distortion.inverse_radius", (0.77, -0.25, 0.0), "beyond-fold"),
    ("distortion.inverse_radius", (0.76980035891950105, -0.25, 0.0), "beyond-fold"),
    ("gamma.srgb_decode", (-0.1,), "negative-intensity"),
    ("gaussian.inverse_upper_tail", (1.0,), "not-a-probability"),
]


@together(("name", "args", "reason"), REFUSED)
def test_no_answer(name, args, reason):
    with pytest.raises(DomainError) as caught:
        function(name)(*args)
    assert caught.value.reason == reason
    values = function(name)(*[np.array([arg, arg]) for arg in args])
    assert not np.any(is_defined(values))
    assert np.ma.isMaskedArray(values)


def test_mask_only_where_there_is_no_answer():
    values = function("distortion.inverse_radius")(np.array([[0.1, 0.9], [0.5, 0.2]]), -0.25)
    assert is_defined(values).tolist() == [[True, False], [True, True]]
    assert type(function("distortion.fold_radius")(np.array([-0.2]))) is np.ndarray


def test_no_fold_is_infinity():
    assert function("distortion.fold_radius")(0.2, 0.0) == math.inf
