"""What the drawings show, measured in their own coordinates against independent numbers."""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

import cv2
import numpy as np
import pytest
from figure_cases import module, render
from scipy.stats import norm

shown_extent = module("distorted_grid").shown_extent


STEP = re.compile(r"([MLQCz])([^MLQCz]*)")


def parts(name, quiz=False, **values):
    """Part name to its polylines as arrays, y pointing up."""
    figure = render(name, values, quiz=quiz, lang="en")
    root = ET.fromstring(figure.svg.decode())
    found: dict[str, list[np.ndarray]] = {}
    for group in root.iter("{http://www.w3.org/2000/svg}g"):
        part = group.get("data-part")
        if part and part != "labels":
            for path in group:
                found.setdefault(part, []).extend(_polylines(path.get("d"), figure.height_pt))
    return found


def _polylines(d, height):
    lines = []
    for letter, numbers in STEP.findall(d):
        if letter == "M":
            lines.append([])
        if letter in "ML":
            x, y = map(float, numbers.split())
            lines[-1].append((x, height - y))
    return [np.array(line) for line in lines]


def crossing(a, b):
    """Where two lines, each given by two points, meet."""
    (p, q), (r, s) = (np.array(line[:2], float) for line in (a, b))
    t, _ = np.linalg.solve(np.column_stack([q - p, r - s]), r - p)
    return p + t * (q - p)


def length(line):
    return float(np.hypot(*(line[-1] - line[0])))


# Gaussian ----------------------------------------------------------------------------------


def _area(polygon):
    x, y = polygon.T
    return abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))) / 2


@pytest.mark.parametrize(
    ("k", "tails", "expected"),
    [
        (1, 2, 2 * norm.sf(1)),
        (2, 1, norm.sf(2)),
        (1.5, -1, norm.cdf(-1.5)),
        (1, 0, 1 - 2 * norm.sf(1)),
    ],
)
def test_shaded_area_is_the_probability(k, tails, expected):
    got = parts("gaussian", sigma=2.5, mu=4, k=k, tails=tails)
    whole = _area(got["curve-0"][0])
    assert sum(map(_area, got["shaded"])) / whole == pytest.approx(expected, abs=2e-3)
    label = render(
        "gaussian", {"sigma": 2.5, "mu": 4, "k": k, "tails": tails}, quiz=False, lang="en"
    ).alt
    assert f"≈ {100 * expected:.4g} %" in label


def test_curve_is_the_density():
    curve = parts("gaussian", sigma=0.5, sigma2=1, sigma3=2)
    tops = [curve[f"curve-{i}"][0][:, 1].max() - curve["axis"][0][0][1] for i in range(3)]
    assert np.array(tops) / tops[0] == pytest.approx([1, 0.5, 0.25], abs=1e-3)
    x, y = curve["curve-2"][0].T
    base, middle = curve["axis"][0][0][1], (x[0] + x[-1]) / 2
    u = (x - middle) / (x[-1] - middle) * 4.4
    expected = norm.pdf(u) / norm.pdf(0)
    assert (y - base) / (y.max() - base) == pytest.approx(expected, abs=2e-3)


def test_printed_peaks_are_those_of_the_notes():
    # W18: 0.798, 0.399, 0.199; C13: 0.1995
    alt = render("gaussian", {"sigma": 0.5, "sigma2": 1, "sigma3": 2}, quiz=False, lang="bn").alt
    assert [peak in alt for peak in ("0.7979", "0.3989", "0.1995")] == [True] * 3


# Distorted grid ----------------------------------------------------------------------------


@pytest.mark.parametrize(("k1", "k2"), [(-0.15, 0.0), (0.15, 0.0), (-0.3, 0.04), (0.05, 0.02)])
@pytest.mark.parametrize("centre", [(0.0, 0.0), (0.2, -0.1)])
def test_grid_is_opencvs_distortion(k1, k2, centre):
    c_x, c_y = centre
    got = parts("distorted_grid", k1=k1, k2=k2, c_x=c_x, c_y=c_y)
    before, after = (np.concatenate(got[part]) for part in ("undistorted", "distorted"))
    (a, b), (c, d) = got["principal-point"]
    point = crossing((a, b), (c, d))
    extent = shown_extent({"k1": k1, "k2": k2, "extent": 1.0, "c_x": c_x, "c_y": c_y})
    scale = np.ptp(before[:, 0]) / (2 * extent)
    rays = np.column_stack([(before - point) / scale, np.ones(len(before))])
    expected, _ = cv2.projectPoints(
        rays, np.zeros(3), np.zeros(3), np.eye(3), np.array([k1, k2, 0, 0.0])
    )
    assert (after - point) / scale == pytest.approx(expected[:, 0], abs=3e-4)


@pytest.mark.parametrize("k1", [-0.3, -0.25, -0.2, -0.15, -0.1, -0.05, 0.1, 0.3])
def test_grid_never_folds(k1):
    lines = parts("distorted_grid", k1=k1, quiz=True)["distorted"]
    for line in lines:
        main = 0 if np.ptp(line[:, 0]) > np.ptp(line[:, 1]) else 1
        assert (np.diff(line[:, main]) > 0).all()


def test_limit_of_the_whole_square_is_that_of_the_notes():
    # errata E03 and curriculum FIG2: |k1| <= 0.15 on [-1, 1]²
    square = {"k2": 0.0, "extent": 1.0, "c_x": 0.0, "c_y": 0.0}
    assert shown_extent({"k1": -0.15, **square}) == 1.0
    assert shown_extent({"k1": -0.2, **square}) < 1.0


def test_only_lines_through_the_principal_point_stay_straight():
    got = parts("distorted_grid", k1=-0.1, extent=1, step=0.5)
    sags = []
    for after in got["distorted"]:
        way = after[-1] - after[0]
        off = (after - after[0]) @ np.array([-way[1], way[0]]) / np.hypot(*way)
        sags.append(round(float(np.abs(off).max()), 1))
    assert [sag < 0.1 for sag in sags] == [False, False, True, False, False] * 2
    # the line x = a sags by a k1 b² between its middle and y = b (E02): here 0.5 and 1
    scale = np.ptp(np.concatenate(got["undistorted"])[:, 0]) / 2
    assert sags[1] / scale == pytest.approx(0.5 * 0.1, abs=2e-3)


# blur curve --------------------------------------------------------------------------------


def test_blur_curves_have_the_heights_of_the_curriculum():
    # X-C03: f = 50, N = 2, s = 2.05 m, z = 4.1 m gives 0.3125 mm; f/8 a quarter of it
    got = parts("blur_curve", f=50, s=2.05, N_1=2, N_2=8, high=400)
    (_, origin, _) = got["axes"][0]
    right, top = np.array(got["grid"]).reshape(-1, 2).max(axis=0)
    for curve, diameter in zip(got["curves"], (312.5, 78.125), strict=True):
        z = (curve[:, 0] - origin[0]) / (right - origin[0]) * 10
        height = (curve[:, 1] - origin[1]) / (top - origin[1]) * 400
        assert np.interp(4.1, z, height) == pytest.approx(diameter, rel=5e-3)
        assert z[height.argmin()] == pytest.approx(2.05, abs=0.01)
        assert height.min() == pytest.approx(0, abs=0.1)


def test_limits_of_the_sharp_zone_are_those_of_the_curriculum():
    # X-C01: f = 50, N = 8, c = 0.03, s = 3 m is sharp from 2.338 m to 4.185 m
    got = parts("blur_curve", f=50, s=3, N_1=8, c=30, high=300)
    (_, origin, _) = got["axes"][0]
    right, _ = np.array(got["grid"]).reshape(-1, 2).max(axis=0)
    at = [(line[0, 0] - origin[0]) / (right - origin[0]) * 10 for line in got["limits"][:2]]
    assert at == pytest.approx([2.338, 4.185], abs=2e-3)
    assert "limits" not in parts("blur_curve", quiz=True, f=50, s=3, N_1=8, c=30, high=300)


# fall_off ----------------------------------------------------------------------------------


# X-C15: cos^4 for tan = 3/4, 5/12, 8/15, 1
@pytest.mark.parametrize(
    ("f", "r", "light"), [(20, 15, 0.4096), (24, 10, 0.7260), (15, 8, 0.6061), (20, 20, 0.25)]
)
def test_light_falls_with_the_fourth_power_of_the_cosine(f, r, light):
    got = parts("fall_off", f=f, r=0, extent=r)
    floor = got["axes"][0][1][1]
    start, end = got["curve"][0][0][1] - floor, got["curve"][0][-1][1] - floor
    assert end / start == pytest.approx(light, abs=0.003)
