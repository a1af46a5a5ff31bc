"""Every public array function on every kind of array: right, whole, and as large as they come.

Expected values are mpmath's (`oracle`), on the doubles that the elements are.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import tracemalloc

import numpy as np
import pytest
from functions import FUNCTIONS, function
from oracle import reference
from sweep import sample, together
from ulp import ulps

from quizgen import numerics
from quizgen.numerics.domain import is_defined

COUNT = 60
MILLIONS = 10**7
MOST_ULPS = {"distortion.inverse_radius": 8}
"""Units in the last place where they are more than 4."""


def uniform(low, high):
    return lambda rng, count: rng.uniform(low, high, count)


def powers(low, high):
    return lambda rng, count: 10.0 ** rng.uniform(low, high, count)


DRAWN = {
    "gaussian.inverse_upper_tail": (powers(-300, -0.01),),
    "distortion.distort_x": (
        uniform(-0.6, 0.6), uniform(-0.6, 0.6), uniform(-0.3, 0.3), uniform(0, 0.1),
    ),
    "distortion.inverse_radius": (uniform(0, 0.5), uniform(-0.3, 0.3), uniform(-0.02, 0.02)),
    "distortion.fold_radius": (uniform(-0.5, -0.1), uniform(-0.1, 0.002)),
    "gamma.srgb_decode": (uniform(0, 1),),
    "hsv.red": (uniform(-720, 720), uniform(0, 1), uniform(0, 1)),
    "hsv.green": (uniform(-720, 720), uniform(0, 1), uniform(0, 1)),
    "hsv.blue": (uniform(-720, 720), uniform(0, 1), uniform(0, 1)),
    "luminosity.luminous_efficiency": (uniform(350, 840),),
}  # fmt: skip
WHOLE = {
    "distortion.inverse_radius": (1, 1, 0),
    "gamma.srgb_decode": (1,), "hsv.red": (100, 1, 1), "hsv.green": (100, 1, 1),
    "hsv.blue": (100, 1, 1), "luminosity.luminous_efficiency": (107,), "distortion.fold_radius": (1, 0),
    "distortion.distort_x": (1, 2, 1, 0),
}  # fmt: skip
"""Arguments that whole numbers of any type may be."""
LEAST = 5e-324
SUBNORMAL = {
    "gaussian.inverse_upper_tail": [(LEAST,), (1e-310,), (2.2e-308,)],
    "distortion.distort_x": [(3e-310, 4e-310, 0.1, 0.1), (0.5, 0.5, LEAST, -3e-310)],
    "distortion.inverse_radius": [(3e-310, -0.2, 0.0), (0.5, -3e-310, 0.0), (0.5, LEAST, LEAST)],
    "distortion.fold_radius": [(-3e-310, 0.0), (-LEAST, 0.0), (-0.2, LEAST)],
    "gamma.srgb_decode": [(LEAST,), (3e-310,)],
    "hsv.red": [(LEAST, 0.5, 0.5), (200.0, 3e-310, 0.5), (200.0, 0.5, 3e-310)],
    "hsv.green": [(LEAST, 0.5, 0.5), (20.0, 3e-310, 0.5), (20.0, 0.5, 3e-310)],
    "hsv.blue": [(LEAST, 0.5, 0.5), (20.0, 3e-310, 0.5), (20.0, 0.5, 3e-310)],
    "luminosity.luminous_efficiency": [(LEAST,), (3e-310,)],
}


def drawn(name, count=COUNT):
    rng = np.random.default_rng(31)
    return [draw(rng, count) for draw in DRAWN[name]]


def assert_right(name, value, args):
    """By mpmath."""
    assert ulps(float(value), reference(name, args)) <= MOST_ULPS.get(name, 4), (name, args)


def assert_all_right(name, values, columns, places):
    flat = [np.broadcast_to(column, values.shape).reshape(-1) for column in columns]
    there = np.broadcast_to(is_defined(values), values.shape).reshape(-1)
    for place in places:
        assert there[place], (name, place)
        assert_right(name, values.reshape(-1)[place], tuple(float(c[place]) for c in flat))


def test_no_public_function_is_left_out():
    public = set()
    for module in pkgutil.iter_modules(numerics.__path__):
        held = importlib.import_module(f"quizgen.numerics.{module.name}")
        for name, call in inspect.getmembers(held, inspect.isfunction):
            kinds = inspect.get_annotations(call).values()
            if call.__module__ == held.__name__ and name[0] != "_" and "Numbers" in kinds:
                public.add(f"{module.name}.{name}")
    told = {name.replace("distort_x", "distort") for name in FUNCTIONS}
    colours = {f"hsv.{channel}" for channel in ("red", "green", "blue")}
    helpers = {"ufunc.broadcast_flat"}
    assert public - helpers == told - colours | {"hsv.hsv_to_rgb"}
    assert FUNCTIONS.keys() == DRAWN.keys() == SUBNORMAL.keys()


@together("name", FUNCTIONS)
def test_subnormal_numbers(name):
    for args in SUBNORMAL[name]:
        values = function(name)(*[np.array([arg, arg]) for arg in args])
        assert_right(name, function(name)(*args), args)
        assert_right(name, values[1], args)


@together("kinds", [("f4", "f8"), ("f8", "f2"), ("f2", "f4"), ("g", "f4", "O")])
@together("name", FUNCTIONS)
def test_mixed_types_of_floats(name, kinds):
    """Each argument in another precision, long double and objects included."""
    columns = drawn(name)
    if name == "gaussian.inverse_upper_tail":
        columns = [np.maximum(column, 1e-3) for column in columns]  # half precision ends at 6e-8
    columns = [c.astype("f2").astype(kinds[i % len(kinds)]) for i, c in enumerate(columns)]
    values = function(name)(*columns)
    assert values.dtype == np.float64
    for place in range(0, COUNT, 5):
        args = tuple(float(column[place]) for column in columns)
        if is_defined(values)[place]:
            assert_right(name, values[place], args)
    assert is_defined(values).mean() > 0.8


@together("kind", ["i1", "u1", "i4", "u4", "i8", "u8", ">i4", ">f8"])
@together("name", WHOLE)
def test_whole_numbers_of_any_type(name, kind):
    args = WHOLE[name]
    if name == "distortion.fold_radius" and kind != "u1":
        args = (-1, 0) if "u" not in kind else args
    columns = [np.array([arg, arg], kind) for arg in args]
    assert_all_right(name, function(name)(*columns), columns, [0, 1])


@together("name", FUNCTIONS)
def test_masks_of_any_argument(name):
    columns, whole = drawn(name), function(name)(*drawn(name))
    for hidden in range(len(columns)):
        given = [
            np.ma.MaskedArray(c, np.arange(COUNT) % 7 == 3) if i == hidden else c
            for i, c in enumerate(columns)
        ]
        values = function(name)(*given)
        expected = is_defined(whole) & (np.arange(COUNT) % 7 != 3)
        assert is_defined(values).tolist() == expected.tolist()
        assert np.array_equal(np.ma.getdata(values)[expected], np.ma.getdata(whole)[expected])
        assert given[hidden].mask.sum() == len(range(3, COUNT, 7))


@together("name", FUNCTIONS)
def test_arrays_without_a_dimension(name):
    for place in range(0, COUNT, 7):
        args = [column[place] for column in drawn(name)]
        alone, zero = function(name)(*map(float, args)), function(name)(*map(np.array, args))
        assert isinstance(zero, float)
        assert zero == alone
        assert_right(name, zero, tuple(map(float, args)))
    masked = function(name)(np.ma.MaskedArray([0.5], mask=[True]), *([0.5] * (len(args) - 1)))
    assert not is_defined(masked).any()


STRIDES = {
    "every second": lambda c: np.repeat(c, 2)[::2],
    "backwards": lambda c: c[::-1].copy()[::-1],
    "by columns": lambda c: np.asfortranarray(c.reshape(4, -1)),
    "turned": lambda c: c.reshape(-1, 4).T.copy().T,
    "a field of a record": lambda c: np.rec.fromarrays([np.zeros(c.size, "i1"), c])["f1"],
    "not aligned": lambda c: np.frombuffer(b"x" + c.tobytes(), "u1")[1:].view("f8"),
}


@together("stride", STRIDES)
@together("name", FUNCTIONS)
def test_strides_of_what_may_not_be_written(name, stride):
    columns = [STRIDES[stride](column) for column in drawn(name)]
    before = [column.tobytes() for column in columns]
    for column in columns:
        column.flags.writeable = False
    values = function(name)(*columns)
    assert values.shape == columns[0].shape
    assert [column.tobytes() for column in columns] == before
    places = [p for p in range(0, COUNT, 11) if is_defined(values).reshape(-1)[p]]
    assert_all_right(name, values, columns, places)
    assert len(places) >= 4


@pytest.mark.slow
@together("name", sample(FUNCTIONS, 4))
def test_ten_million_elements(name):
    """A result of eight bytes an element, and no more than a few blocks besides."""
    columns = [np.resize(column, MILLIONS) for column in drawn(name, 100_003)]
    outputs = {"hsv": 3, "distortion.distort_x": 2}
    results = outputs.get(name, outputs.get(name.split(".")[0], 1))
    tracemalloc.start()
    values = function(name)(*columns)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    masks = 2 * MILLIONS * isinstance(values, np.ma.MaskedArray)
    assert peak < 8 * MILLIONS * results + masks + 64e6
    assert values.shape == (MILLIONS,)
    data, there = np.ma.getdata(values), is_defined(values)
    for start in (0, MILLIONS - 100_003 - MILLIONS % 100_003):
        part = slice(start, start + 100_003)
        assert np.array_equal(there[part], there[:100_003])
        seen = np.flatnonzero(there[:100_003])
        assert np.array_equal(data[part][seen], data[:100_003][seen])
    places = np.random.default_rng(2).choice(np.flatnonzero(there), 24)
    assert_all_right(name, values, columns, places)
