"""Every array function against 40-digit values on inputs chosen to break it."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from functions import function
from ulp import ulps

from quizgen.arrays.domain import DomainError, answered

ROWS = [
    line.split("\t")
    for path in sorted((Path(__file__).parent / "rows").glob("*.tsv"))
    for line in path.read_text().splitlines()
]
NAMES = sorted({row[0] for row in ROWS})


def rows_of(name):
    return [read(row)[1:] for row in ROWS if row[0] == name]


def read(row):
    name, args, text, tolerance, _origin = row
    with mp.workdps(45):
        truth = mp.inf if text in {"+inf", "inf"} else mp.mpf(text)
    return name, tuple(map(float.fromhex, args.split())), truth, float(tolerance)


def error(name, value, truth):
    if name == "hsv.hue":  # degrees on the circle, in units of the last place of 360
        turn = abs((mp.mpf(value) - truth + 180) % 360 - 180)
        return float(turn / math.ulp(360.0))
    return ulps(value, truth)


@pytest.mark.parametrize("name", NAMES)
def test_alone_and_in_an_array(name):
    """Arrays of ordinary values take shorter ways than scalars and mixed arrays do."""
    wrong = []
    for args, truth, tolerance in rows_of(name):
        pair = function(name)(*[np.array([arg, arg]) for arg in args])
        values = (function(name)(*args), float(pair[0]))
        wrong += [(args, one) for one in values if not error(name, one, truth) <= tolerance]
    assert wrong == []


def test_all_rows_of_a_function_in_one_array():
    by_name = {}
    for row in ROWS:
        name, args, truth, tolerance = read(row)
        by_name.setdefault(name, []).append((args, truth, tolerance))
    for name, rows in by_name.items():
        columns = [np.array(column) for column in zip(*(args for args, _, _ in rows), strict=True)]
        values = function(name)(*columns)
        assert np.all(answered(values)), name
        for value, (args, truth, tolerance) in zip(values, rows, strict=True):
            assert error(name, float(value), truth) <= tolerance, (name, args)


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


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # the other element may overflow
def test_some_arguments_as_numbers(name):
    """Whatever is an array and whatever one number for all, the answer stays."""
    wrong = []
    for args, truth, tolerance in rows_of(name):
        for mixed in mixtures(args):
            values = function(name)(*mixed)
            if not (answered(values)[0] and error(name, float(values[0]), truth) <= tolerance):
                wrong.append((mixed, values))
    assert wrong == []


def test_rows_are_many_and_for_every_family():
    families = {row[0].split(".")[0] for row in ROWS}
    assert len(families) == 15
    assert len(ROWS) > 600


# Published and hand-checked values: the notes, the errata and textbooks.

PRINTED = [
    ("gaussian.upper_tail", (1.0,), "0.158655253931457051414767454367962077522087"),
    ("gaussian.upper_tail", (8.0,), "6.22096057427178412351599517258818842248872e-16"),
    ("gaussian.upper_tail", (38.0,), "2.88542836006878430835097048156690409466182e-316"),
    ("gaussian.log_tail", (100.0,), "-5005.52420869420508862630245733002553133991"),
    ("gaussian.interval", (10.0, 10.0001), "7.69075259667299484435937687949755930016522e-27"),
    ("gaussian.interval", (20.0, 20 + 1e-12), "5.51163200324611242686350235952145211437656e-100"),
    ("gaussian.expected_beyond", (1e6, 3.0), "2699.79606326018905330362953518995475565874"),
    ("thin_lens.image_distance", (50.0, math.nextafter(50, 60)), "351843720888320050"),
    ("thin_lens.image_distance", (0.05, 0.05 * (1 + 1e-12)), "49998330584.2353621981681931751320813227376"),
    ("blur.blur_disc", (50.0, 2.8, 3000.0, math.nextafter(3000, 4000)), "4.58784655858014607420875773386217838741561e-17"),
    ("depth_of_field.far_limit", (50.0, 8.0, 0.03, 10466.666666666564), "1060011992019431206.8352449020866763953084"),
    ("distortion.fold_radius", (-0.25, 0.0), "1.1547005383792515290182975610039149112952"),
    ("distortion.inverse_radius", (0.6928203230275509, -0.25, 0.0), "0.842122266240542597058376431111914615164825"),
    ("distortion.inverse_radius", (0.7698003589187312, -0.25, 0.0), "1.15469959557077248815649073423700620394087"),
    ("stops.stops", (4.0, 4 * (1 + 1e-10)), "2.88539032037190313016812244454029824764421e-10"),
    ("snr.snr_loss", (1e12, 2.0), "1.99999999999400000000001999999999999993e-12"),
    ("poisson.pmf", (1e9, 1e9), "1.26156626090494950237711519758221174849564e-5"),
    ("gamma.gap", (0.25, 0.25 + 1e-8), "2.64059765801486935913635304408037512369901e-17"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "args", "text"), PRINTED)
def test_printed_values(name, args, text):
    with mp.workdps(45):
        assert ulps(function(name)(*args), mp.mpf(text)) <= 4


# Where there is no answer.

REFUSED = [
    ("distortion.inverse_radius", (0.77, -0.25, 0.0), "beyond-fold"),
    ("distortion.inverse_radius", (0.76980035891950105, -0.25, 0.0), "beyond-fold"),
    ("hsv.hue", (0.5, 0.5, 0.5), "grey-hue"),
    ("projection.project_x", (2.0, 1.0, -0.0), "on-camera-plane"),
    ("projection.pixel", (2.0, 1.0, 1.0, 0.0, 0.0), "on-camera-plane"),
    ("normalise.normalise", (1.0, 3.0, 3.0, 0.0, 1.0), "empty-range"),
    ("normalise.normalise", (1.0, 3.0, 2.0, 0.0, 1.0), "empty-range"),
    ("gamma.encode", (-1e-300,), "negative-intensity"),
    ("gamma.srgb_decode", (-0.1,), "negative-intensity"),
    ("thin_lens.image_distance", (0.0, 1.0), "not-positive"),
    ("thin_lens.image_distance", (math.nan, 1.0), "not-finite"),
    ("blur.blur_disc", (50.0, 2.0, 49.0, 100.0), "no-real-image"),
    ("gaussian.interval", (2.0, 1.0), "reversed"),
    ("gaussian.inverse_tail", (1.0,), "not-a-probability"),
    ("poisson.pmf", (1.5, 2.0), "not-a-count"),
]


@pytest.mark.parametrize(("name", "args", "reason"), REFUSED)
def test_no_answer(name, args, reason):
    with pytest.raises(DomainError) as caught:
        function(name)(*args)
    assert caught.value.reason == reason
    values = function(name)(*[np.array([arg, arg]) for arg in args])
    assert not np.any(answered(values))
    assert np.ma.isMaskedArray(values)


def test_mask_only_where_there_is_no_answer():
    values = function("distortion.inverse_radius")(np.array([[0.1, 0.9], [0.5, 0.2]]), -0.25)
    assert answered(values).tolist() == [[True, False], [True, True]]
    assert type(function("thin_lens.image_distance")(50.0, np.array([60.0]))) is np.ndarray


POLES = [
    ("thin_lens.image_distance", (50.0, 50.0)),
    ("thin_lens.magnification", (50.0, 50.0)),
    ("blur.blur_disc", (50.0, 2.0, 50.0, 100.0)),
    ("depth_of_field.far_limit", (50.0, 8.0, 0.03, 10466.67)),
    ("depth_of_field.far_limit", (1.0, 1.0, 0.5, 3.0)),
    ("depth_of_field.total_depth", (1.0, 1.0, 0.5, 3.0)),
    ("gaussian.peak_2d", (1.0, 1.0, 1.0)),
    ("distortion.fold_radius", (0.2, 0.0)),
]


@pytest.mark.parametrize(("name", "args"), POLES)
def test_pole_is_infinity(name, args):
    assert function(name)(*args) == math.inf
