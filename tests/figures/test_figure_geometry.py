"""What the drawings show, measured in their own coordinates against independent numbers."""

from __future__ import annotations

import itertools
import re
from fractions import Fraction
from xml.etree import ElementTree as ET

import cv2
import numpy as np
import pytest
from figure_cases import module, render
from scipy.stats import norm

neighbours = module("bayer").neighbours
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


# pinhole -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("f", "p_z", "p_y"), [(2, 4, 9), (3, 6, -5), (6, 2, 7), (2, 5, 1)])
def test_pinhole_is_to_scale(f, p_z, p_y):
    got = parts("pinhole", f=f, p_z=p_z, p_y=p_y)
    origin, (ray_end) = got["ray"][0][0], got["ray"][0][1]
    point, image = got["leg-point"][0], got["leg-image"][0]
    assert (image[0] - origin)[0] / (point[0] - origin)[0] == pytest.approx(f / p_z, abs=2e-3)
    assert length(image) / length(point) == pytest.approx(f / p_z, abs=4e-3)
    assert np.sign(point[1] - point[0])[1] == np.sign(p_y)
    assert max(point[1], image[1], key=lambda p: p[0]) == pytest.approx(ray_end)
    assert "break" not in got


@pytest.mark.parametrize(
    "values",
    [
        {"f": 50, "p_z": 600, "p_y": 30, "metric": 1},
        {"f": 6, "p_z": 5, "p_y": -14},
    ],
)
def test_pinhole_stays_similar_when_not_to_scale(values):
    got = parts("pinhole", physical=1, **values)
    origin = got["ray"][0][0]
    slopes = [
        (tip - origin)[1] / (tip - origin)[0]
        for tip in (got["leg-point"][0][1], got["leg-image"][0][1], got["physical-ray"][0][1])
    ]
    assert slopes == pytest.approx([slopes[0]] * 3, rel=2e-3)
    assert "break" in got
    virtual = got["leg-image"][0][1] - origin
    assert got["physical-ray"][0][1] - origin == pytest.approx(-virtual, abs=0.02)


def test_shaded_triangles_have_the_legs_and_the_ray_as_sides():
    got = parts("pinhole", f=2, p_z=4, p_y=9)
    for part, leg in (("outer", "leg-point"), ("inner", "leg-image")):
        origin, foot, tip = got[part][0]
        assert origin == pytest.approx(got["ray"][0][0])
        assert np.array([foot, tip]) == pytest.approx(got[leg][0])


def test_y_down_turns_the_picture_over():
    up, down = (parts("pinhole", f=2, p_z=4, p_y=9, y_down=d) for d in (0, 1))
    assert up["leg-point"][0][1][1] > up["leg-point"][0][0][1]
    assert down["leg-point"][0][1][1] < down["leg-point"][0][0][1]
    assert down["axis-y"][0][1][1] < down["axis-y"][0][0][1]


# thin lens ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("f", "z"), [(50, 200), (20, 25), (30, 45), (85, 255), (24, 60), (50, 250)]
)
def test_rays_meet_at_the_real_image(f, z):
    got = parts("thin_lens", f=f, z=z, quiz=True)
    rays = [got[f"ray-{name}"][0] for name in ("parallel", "central", "focal")]
    lens_x = rays[1][1][0]
    meet = [crossing(a[1:], b[1:]) for a, b in itertools.combinations(rays, 2)]
    focus = crossing(rays[0][1:], got["axis"][0])
    image = 1 / (Fraction(1, f) - Fraction(1, z))  # the lens equation, exactly
    scale = (focus[0] - lens_x) / f
    for point in meet:
        assert (point[0] - lens_x) / scale == pytest.approx(float(image), rel=5e-3)
        assert point == pytest.approx(
            got["image"][0][0] + [0, rays[0][2][1] - got["image"][0][0][1]], abs=0.1
        )
    assert (lens_x - rays[0][0][0]) / scale == pytest.approx(z, rel=5e-3)
    height = rays[0][0][1] - got["axis"][0][0][1]
    assert (got["axis"][0][0][1] - meet[0][1]) / height == pytest.approx(float(image / z), rel=2e-2)


@pytest.mark.parametrize(("f", "z"), [(50, 30), (50, 25), (100, 70)])
def test_backward_rays_meet_at_the_virtual_image(f, z):
    got = parts("thin_lens", f=f, z=z)
    rays = [got[f"ray-{name}"][0] for name in ("parallel", "central", "focal")]
    lens_x = rays[1][1][0]
    scale = (crossing(rays[0][1:], got["axis"][0])[0] - lens_x) / f
    image = 1 / (Fraction(1, f) - Fraction(1, z))
    for a, b in itertools.combinations(rays, 2):
        assert (crossing(a[1:], b[1:])[0] - lens_x) / scale == pytest.approx(float(image), rel=5e-3)


def test_object_in_the_focal_plane_has_no_image():
    got = parts("thin_lens", f=50, z=50)
    slopes = [np.diff(got[f"ray-{name}"][0][1:], axis=0)[0] for name in ("parallel", "central")]
    assert slopes[0][1] / slopes[0][0] == pytest.approx(slopes[1][1] / slopes[1][0], rel=2e-3)
    assert "image" not in got
    assert "no image" in render("thin_lens", {"f": 50, "z": 50}, quiz=False, lang="en").alt


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


# Blur disc ---------------------------------------------------------------------------------


@pytest.mark.parametrize(("z_p", "z_s"), [(50, 65), (50, 35), (60, 78)])
def test_blur_disc_is_cut_from_the_cone(z_p, z_s):
    got = parts("blur_disc", D=25, z_p=z_p, z_s=z_s)
    upper, lower = got["rays"]
    aperture = upper[0][1] - lower[0][1]
    sensor = got["sensor"][0]
    hits = [crossing(ray[:2], sensor)[1] for ray in (upper, lower)]
    assert abs(hits[0] - hits[1]) == pytest.approx(length(got["disc"][0]), abs=0.05)
    assert length(got["disc"][0]) / aperture == pytest.approx(abs(z_s - z_p) / z_p, abs=1e-3)


def test_blur_disc_of_the_curriculum():
    # S11: D 25, z'_p 50, z'_s 50.2 -> 0.1 mm
    alt = render("blur_disc", {"D": 25, "z_p": 50, "z_s": 50.2}, quiz=False, lang="en").alt
    assert alt.endswith("D is 25 mm; the diameter of the disc is c = 0.1 mm.")


# Bayer -------------------------------------------------------------------------------------

OPENCV = [
    cv2.COLOR_BayerBG2RGB,
    cv2.COLOR_BayerRG2RGB,
    cv2.COLOR_BayerGB2RGB,
    cv2.COLOR_BayerGR2RGB,
]


@pytest.mark.parametrize("phase", range(4))
def test_neighbours_are_those_of_opencv(phase):
    raw = np.random.default_rng(phase).integers(5, 58, (6, 6), dtype=np.uint8) * 4
    colours = cv2.cvtColor(raw, OPENCV[phase])
    for y, x in itertools.product((2, 3), (2, 3)):
        values = {"phase": phase, "size": 6, "x": x, "y": y}
        for index, channel in enumerate("RGB"):
            used = neighbours(values, channel)
            if (x, y) not in used and colours[y, x, index] != raw[y, x]:
                mean = np.mean([raw[b, a] for a, b in used])
                assert colours[y, x, index] == pytest.approx(mean, abs=0.5)


def test_arrows_come_from_the_sites_that_are_used():
    got = parts("bayer", v01=100, v10=120, v12=110, v21=130)
    assert (len(got["use-G"]), len(got["use-R"])) == (4, 4)
    middle = (
        got["marked"][0].mean(axis=0)
        if len(got["marked"][0]) == 4
        else got["marked"][0][:4].mean(axis=0)
    )
    for start, end in got["use-G"] + got["use-R"]:
        assert np.hypot(*(end - middle)) < np.hypot(*(start - middle))
    assert "use-G" not in parts("bayer", quiz=True, v01=100, v10=120, v12=110, v21=130)


def test_reference_site_of_the_notes():
    # W15 / S14: 115 and 65
    values = {
        "v00": 60,
        "v01": 100,
        "v02": 64,
        "v10": 120,
        "v12": 110,
        "v20": 70,
        "v21": 130,
        "v22": 66,
    }
    alt = render("bayer", values, quiz=False, lang="en").alt
    assert "G = (100 + 120 + 110 + 130) / 4 = 115." in alt
    assert "R = (60 + 64 + 70 + 66) / 4 = 65." in alt


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
