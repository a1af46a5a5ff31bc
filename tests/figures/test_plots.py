"""Plots: what they show, measured in print against numbers from elsewhere; and questions on them."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from figure_cases import draw, module
from scipy.stats import norm
from svg_reader import read_labels, read_parts, read_pictures
from sweep import spread, together

from quizgen.bank.variant import draw_variant
from quizgen.camera import picture_sets
from quizgen.core.errors import BankError
from quizgen.numerics import luminosity
from quizgen.question.part_context import ask_part

find_extent = module("distorted_grid").find_extent
read_efficiency = module("luminosity").read_efficiency
normalisation = module("normalisation")
staircase = module("staircase")

SEEDS = spread(range(60), 6)


def parts(name, *, quiz=False, marks=None, **values):
    return read_parts(draw(name, values, quiz=quiz, marks=marks))


def area(polygon):
    x, y = polygon.T
    return abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))) / 2


def corners(lines):
    """The lowest and the highest coordinates of lines."""
    points = np.concatenate(lines)
    return points.min(axis=0), points.max(axis=0)


def distances(points, line):
    """Of points from a line through many points."""
    line = line[np.append(np.diff(line, axis=0).any(axis=1), True)]  # none twice
    start, way = line[:-1], np.diff(line, axis=0)
    share = np.einsum("pld,ld->pl", points[:, None] - start, way) / (way**2).sum(axis=1)
    foot = start + np.clip(share, 0, 1)[..., None] * way
    return np.hypot(*np.moveaxis(points[:, None] - foot, -1, 0)).min(axis=1)


def centre(ring):
    return (ring.min(axis=0) + ring.max(axis=0)) / 2


# gaussian ----------------------------------------------------------------------------------


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
    values = {"sigma": 2.5, "mu": 4, "k": k, "tails": tails}
    got = parts("gaussian", **values)
    whole = area(got["curve-0"][0])
    assert sum(map(area, got["shaded"])) / whole == pytest.approx(expected, abs=2e-3)
    assert f"≈ {100 * expected:.4g} %" in draw("gaussian", values).alt


def test_curve_is_the_density():
    got = parts("gaussian", sigma=0.5, sigma2=1, sigma3=2)
    base = got["axis"][0][0][1]
    tops = [got[f"curve-{i}"][0][:, 1].max() - base for i in range(3)]
    assert np.array(tops) / tops[0] == pytest.approx([1, 0.5, 0.25], abs=1e-3)
    x, y = got["curve-2"][0].T
    middle = (x[0] + x[-1]) / 2
    u = (x - middle) / (x[-1] - middle) * 4.4
    expected = norm.pdf(u) / norm.pdf(0)
    assert (y - base) / (y.max() - base) == pytest.approx(expected, abs=2e-3)


def test_printed_peaks_are_those_of_the_notes():
    # W18: 0.798, 0.399, 0.199; C13: 0.1995
    alt = draw("gaussian", {"sigma": 0.5, "sigma2": 1, "sigma3": 2}, lang="bn").alt
    assert [peak in alt for peak in ("0.7979", "0.3989", "0.1995")] == [True] * 3


def test_marks_of_several_curves_are_refused():
    with pytest.raises(BankError, match="marks need a single curve"):
        draw("gaussian", {"sigma": 1, "sigma2": 2, "k": 1})


def test_a_learners_peak_is_ringed_at_its_height():
    values = {"sigma": 2, "k": 2}
    figure = draw("gaussian", values, marks={"g_0": 0.1})
    got = read_parts(figure)
    base, top = got["axis"][0][0][1], got["curve-0"][0][:, 1].max()
    height = (centre(got["learned"][0])[1] - base) / (top - base)
    assert height == pytest.approx(0.1 / 0.1995, abs=5e-3)
    assert "g(μ) = 0.1" in read_labels(figure)


def test_a_learners_share_stands_where_such_tails_begin():
    # 31.73 % of a normal distribution lie beyond one standard deviation
    got = parts("gaussian", sigma=2, k=2, marks={"P_1": 31.731})
    mean, edge = got["mean"][0][0][0], max(line[0][0] for line in got["marks"])
    line = next(line for line in got["learned"] if len(line) == 2)
    assert (line[0][0] - mean) / (edge - mean) == pytest.approx(0.5, abs=2e-3)


def test_a_learners_value_far_outside_is_an_arrow_at_the_edge():
    far, farther = (draw("gaussian", {"sigma": 2}, marks={"g_0": peak}) for peak in (79, 7e9))
    assert far.height_pt == farther.height_pt
    assert "g(μ) = 7 · 10^9" in read_labels(farther)


# luminosity --------------------------------------------------------------------------------


@together(
    ("wavelength", "night", "value"),
    # CIE 1924 and 1951 tables
    [(530, False, 0.862), (655, False, 0.0816), (650, False, 0.107), (700, False, 0.004102),
     (507, True, 1.0), (650, True, 0.000677), (555, False, 1.0)],
)  # fmt: skip
def test_curves_are_read_at_the_tables_values(wavelength, night, value):
    assert read_efficiency(wavelength, night=night) == pytest.approx(value)


@pytest.mark.parametrize(("at", "value"), [(480, 0.139), (530, 0.862), (600, 0.631), (650, 0.107)])
def test_the_drawn_curve_has_the_heights_of_the_table(at, value):
    x, y = parts("luminosity", quiz=True)["day"][0].T
    wavelength = 380 + 400 * (x - x[0]) / (x[-1] - x[0])
    height = (y - y.min()) / np.ptp(y)
    assert np.interp(at, wavelength, height) == pytest.approx(value, abs=4e-3)


def test_each_decade_of_the_logarithmic_axis_is_equally_high():
    got = parts("luminosity", m_1=600, log=1)
    (foot, _), day = got["marks"][0], got["day"][0]
    height = np.interp(foot[0], *day.T) - foot[1]  # the foot is 0.0001, the peak 1
    assert 10 ** (4 * height / (day[:, 1].max() - foot[1]) - 4) == pytest.approx(0.631, rel=0.02)


def test_the_curves_differ_without_colours():
    svg = draw("luminosity", {}, quiz=True).inline_svg.decode()
    dashed = [name for name in ("day", "night") if "dasharray" in svg.split(f'"{name}"')[1][:9000]
              .split("/>")[0]]  # fmt: skip
    assert dashed == ["night"]


def test_marks_too_close_to_tell_apart_are_refused():
    with pytest.raises(BankError, match="5 nm apart"):
        draw("luminosity", {"m_1": 500, "m_2": 504})


def test_a_learners_height_is_ringed_at_its_mark():
    got = parts("luminosity", m_1=530, m_2=650, marks={"V_2": 0.5})
    day, ring = got["day"][0], centre(got["learned"][0])
    assert (ring[1] - day[:, 1].min()) / np.ptp(day[:, 1]) == pytest.approx(0.5, abs=4e-3)
    assert (ring[0] - day[0, 0]) / np.ptp(day[:, 0]) == pytest.approx(270 / 400, abs=2e-3)


# distorted grid ----------------------------------------------------------------------------


@together(("k1", "k2"), [(-0.15, 0.0), (0.15, 0.0), (-0.3, 0.04), (0.05, 0.02)])
@together("c", [(0.0, 0.0), (0.2, -0.1)])
def test_grid_is_opencvs_distortion(k1, k2, c):
    values = {"k1": k1, "k2": k2, "c_x": c[0], "c_y": c[1]}
    got = parts("distorted_grid", **values)
    cross = corners(got["principal-point"])
    point = (cross[0] + cross[1]) / 2
    low, high = corners(got["undistorted"])
    scale = (high - low)[0] / (2 * find_extent({**values, "extent": 1.0}))
    for before, after in zip(got["undistorted"], got["distorted"], strict=True):
        start, end = (before[[0, -1]] - point) / scale
        along = start + np.linspace(0, 1, 400)[:, None] * (end - start)
        rays = np.column_stack([along, np.ones(400)])
        moved, _ = cv2.projectPoints(
            rays, np.zeros(3), np.zeros(3), np.eye(3), np.array([k1, k2, 0, 0.0])
        )
        expected = point + scale * moved[:, 0]
        assert distances(after, expected).max() < 0.05
        assert distances(expected, after).max() < 0.15


@together("k1", [-0.3, -0.25, -0.2, -0.15, -0.1, -0.05, 0.1, 0.3])
def test_grid_never_folds(k1):
    for line in parts("distorted_grid", quiz=True, k1=k1)["distorted"]:
        way = np.diff(line[:, int(np.ptp(line[:, 1]) > np.ptp(line[:, 0]))])
        assert (way >= 0).all() or (way <= 0).all()


def test_limit_of_the_whole_square_is_that_of_the_notes():
    # errata E03 and curriculum FIG2: |k1| <= 0.15 on [-1, 1]²
    square = {"k2": 0.0, "extent": 1.0, "c_x": 0.0, "c_y": 0.0}
    assert find_extent({"k1": -0.15, **square}) == 1.0
    assert find_extent({"k1": -0.2, **square}) < 1.0


def test_only_lines_through_the_principal_point_stay_straight():
    got = parts("distorted_grid", k1=-0.1, extent=1, step=0.5)
    sags = []
    for after in got["distorted"]:
        way = after[-1] - after[0]
        off = (after - after[0]) @ np.array([-way[1], way[0]]) / np.hypot(*way)
        sags.append(round(float(np.abs(off).max()), 1))
    assert [sag < 0.1 for sag in sags] == [False, False, True, False, False] * 2
    # the line x = a sags by a k1 b² between its middle and y = b (E02): here 0.5 and 1
    low, high = corners(got["undistorted"])
    assert sags[1] / (high - low)[0] * 2 == pytest.approx(0.5 * 0.1, abs=2e-3)


def test_the_grid_has_coordinates():
    labels = read_labels(draw("distorted_grid", {"k1": -0.05, "c_x": 0.25}, quiz=True))
    assert [labels.count(text) for text in ("−1", "−0.5", "0", "0.5", "1", "x", "y")] == (
        [2] * 5 + [1] * 2
    )


def test_arrows_lead_from_the_corners_of_one_grid_to_those_of_the_other():
    got = parts("distorted_grid", k1=0.1)
    (low, high), (outer_low, outer_high) = corners(got["undistorted"]), corners(got["distorted"])
    shafts = [line for line in got["moved"] if len(line) == 2]
    for shaft in shafts:
        assert np.isclose(shaft[0], low, atol=0.02).any() or np.isclose(shaft[0], high).any()
    tips = [line[0] for line in got["moved"] if len(line) > 2]
    assert np.min(tips, axis=0) == pytest.approx(outer_low, abs=0.05)
    assert np.max(tips, axis=0) == pytest.approx(outer_high, abs=0.05)
    assert "moved" not in parts("distorted_grid", quiz=True, k1=0.1)


# blur curve --------------------------------------------------------------------------------


def test_blur_curves_have_the_heights_of_the_curriculum():
    # X-C03: f = 50, N = 2, s = 2.05 m, z = 4.1 m gives 0.3125 mm; f/8 a quarter of it
    got = parts("blur_curve", f=50, s=2.05, N_1=2, N_2=8, high=400)
    low, high = corners(got["grid"])
    for curve, diameter in zip(got["curves"], (312.5, 78.125), strict=True):
        z, height = ((curve - low) / (high - low) * [10, 400]).T
        assert np.interp(4.1, z, height) == pytest.approx(diameter, rel=5e-3)
        assert z[height.argmin()] == pytest.approx(2.05, abs=0.01)
        assert height.min() == pytest.approx(0, abs=0.1)


def test_limits_of_the_sharp_zone_are_those_of_the_curriculum():
    # X-C01: f = 50, N = 8, c = 0.03, s = 3 m is sharp from 2.338 m to 4.185 m
    values = {"f": 50, "s": 3, "N_1": 8, "c": 30, "high": 300}
    got = parts("blur_curve", **values)
    low, high = corners(got["grid"])
    feet = [line[0, 0] for line in got["limits"] if len(line) == 2]
    assert (np.array(feet) - low[0]) / (high - low)[0] * 10 == pytest.approx(
        [2.338, 4.185], abs=2e-3
    )
    assert not {"limits", "zone"} & set(parts("blur_curve", quiz=True, **values))


def test_a_learners_distance_and_f_number_are_drawn_beside_the_right_ones():
    values = {"f": 50, "s": 2.05, "N_1": 2, "N_2": 8, "high": 400}
    figure = draw("blur_curve", values, marks={"s": 4.0, "N_2": 4})
    got = read_parts(figure)
    low, high = corners(got["grid"])
    line, *_, curve = sorted(got["learned"], key=len)
    assert (line[0, 0] - low[0]) / (high - low)[0] * 10 == pytest.approx(4, abs=1e-2)
    z, height = ((curve - low) / (high - low) * [10, 400]).T
    assert np.interp(4.1, z, height) == pytest.approx(312.5 / 2, rel=5e-3)
    assert {"s = 4 m", "f/4"} <= set(read_labels(figure))


# fall-off ----------------------------------------------------------------------------------

# X-C15: cos^4 for tan = 3/4, 5/12, 8/15, 1
FALL_OFF = pytest.mark.parametrize(
    ("f", "r", "light"), [(20, 15, 0.4096), (24, 10, 0.7260), (15, 8, 0.6061), (20, 20, 0.25)]
)


@FALL_OFF
def test_light_falls_with_the_fourth_power_of_the_cosine(f, r, light):
    got = parts("fall_off", f=f, r=0, extent=r)
    low, high = corners(got["grid"])  # tenths, from the first to the tenth
    floor = low[1] - (high - low)[1] / 9
    start, end = got["curve"][0][[0, -1], 1] - floor
    assert end / start == pytest.approx(light, abs=0.003)


@FALL_OFF
def test_the_wall_falls_with_the_fourth_power_of_the_cosine(f, r, light):
    (photo,) = read_pictures(draw("fall_off", {"f": f, "r": 0, "extent": r}, quiz=True))
    linear = ((photo[36, :, 0] / 255 + 0.055) / 1.055) ** 2.4
    assert linear[-1] / linear[48] == pytest.approx(light, abs=0.02)


def test_a_learners_share_is_ringed_at_the_mark():
    got = parts("fall_off", f=20, r=15, marks={"share": 0.64})  # the square of the cosine
    low, high = corners(got["grid"])
    floor = low[1] - (high - low)[1] / 9
    ring = centre(got["learned"][0])
    assert (ring[1] - floor) / (high[1] - floor) == pytest.approx(0.64, abs=3e-3)
    assert (ring[0] - low[0]) / (high - low)[0] == pytest.approx(15 / 22, abs=3e-3)


# normalisation -----------------------------------------------------------------------------


def test_clamping_gathers_what_lies_above():
    image = normalisation.draw_sample(60.0, 180.0, 0.0, 1)
    levels = image * 255
    assert levels.min() == pytest.approx(60)
    assert levels.max() == pytest.approx(180)
    _, before, after = picture_sets.make_normalised(image, 60 / 255, 140 / 255, normalisation.BINS)
    assert before.sum() == after.sum() == image.size
    # the last bin holds what is clamped, and what fell into it anyway
    last = 60 + (140 - 60) * (normalisation.BINS - 1) / normalisation.BINS
    assert after[-1] == (levels >= last).sum()
    assert after[-1] > 5 * after[:-1].max()


def test_outliers_have_their_share():
    levels = normalisation.draw_sample(100.0, 140.0, 0.1, 5) * 255
    outside = ((levels < 100) | (levels > 140)).mean()
    assert outside == pytest.approx(0.1 * (1 - 40 / 255), abs=4 * np.sqrt(0.1 / levels.size))


def test_bars_and_limits_stand_at_their_grey_levels():
    got = parts("normalisation", low=60, high=140, a=60, b=180)
    before, after = got["histogram"]
    (x0, _), (x1, _) = corners([before])
    assert x1 - x0 == pytest.approx(126)
    bars = before[before[:, 1] > before[:, 1].min() + 0.01][:, 0]  # 64 bins of 4 levels
    assert (np.array([bars.min(), bars.max()]) - x0) / 126 * 255 == pytest.approx(
        [60, 180], abs=255 / 64
    )
    limits = sorted(line[0, 0] for line in got["limits"])
    assert (np.array(limits) - x0) / 126 * 255 == pytest.approx([60, 140], abs=0.1)
    tall = after[after[:, 1] > after[:, 1].max() - 0.01][:, 0]  # all above the limit is in one bar
    assert after[:, 0].max() - tall.min() == pytest.approx(126 / 64, abs=0.02)
    quiz = parts("normalisation", quiz=True, low=60, high=140, a=60, b=180)
    assert not {"limits", "clamped"} & set(quiz)


def test_a_learners_limit_is_drawn_at_its_grey_level():
    got = parts("normalisation", low=60, high=140, marks={"I_max": 180})
    (x0, _), _ = corners([got["histogram"][0]])
    line = next(line for line in got["learned"] if len(line) == 2)
    assert (line[0, 0] - x0) / 126 * 255 == pytest.approx(180, abs=0.1)


# staircase ---------------------------------------------------------------------------------

ROUNDINGS = (
    lambda intensity, n: np.floor(intensity * (n - 1) + 0.5),
    lambda intensity, n: np.floor(intensity * (n - 1)),
    lambda intensity, n: np.minimum(np.floor(intensity * n), n - 1),
    lambda intensity, n: np.ceil(intensity * (n - 1)),
)


@together("rule", range(4))
@together("n", [2, 4, 8, 16])
def test_the_treads_are_those_of_the_rounding(rule, n):
    got = parts("staircase", quiz=True, n=n, rule=rule)
    treads = [line for line in got["staircase"] if len(line) == 2]
    low, high = corners([*treads, *got["rises"]])
    ends = (np.array(treads) - low) / (high - low) * [1, n - 1]
    for intensity in np.linspace(0.013, 0.987, 60):
        (code,) = {round(y) for (a, y), (b, _) in ends if a < intensity < b}
        assert code == ROUNDINGS[rule](intensity, n)


@pytest.mark.parametrize("n", [2, 4, 8, 16])
def test_the_upright_axis_has_a_tick_a_level_and_tells_no_number(n):
    figure = draw("staircase", {"n": n}, quiz=True)
    ticks = [line for line in read_parts(figure)["axis"]
             if len(line) == 2 and abs(np.ptp(line[:, 0]) - 3) < 0.1]  # fmt: skip
    assert len(ticks) == n
    assert read_labels(figure).count("0") == 2
    assert str(n) not in read_labels(figure)


@pytest.mark.parametrize("marks", [{"n": 5}, {"Delta": 0.25}])
def test_a_learners_staircase_has_treads_of_its_own_length(marks):
    got = parts("staircase", n=8, rule=1, marks=marks)
    x, _ = got["learned"][0].T
    lengths = np.diff(x)[::2] / np.ptp(x)
    assert lengths[:4] == pytest.approx([0.25] * 4, abs=1e-3)


# Questions on plots: the key is what the figure of the same draw shows ---------------------


def _draw_question(bank, name, seed, part=0):
    """Drawn numbers and the name of the right option of a part."""
    drawn = draw_variant(bank.template(name), seed)
    ((_, right),) = ask_part(drawn, part).right
    return {key: float(value) for key, value in drawn.shown.items()}, right


@together("seed", SEEDS)
def test_the_brighter_laser_is_the_higher_on_the_curve(bank, seed):
    given, key = _draw_question(bank, "two-lasers-from-curves", seed)
    curve = luminosity.NIGHT if given["dark"] else luminosity.DAY
    heights = [float(luminosity.luminous_efficiency(given[name], curve)) for name in ("l_1", "l_2")]
    assert [given["h_1"], given["h_2"]] == pytest.approx(heights, rel=0.01)
    assert heights[("first", "second").index(key)] == max(heights)


@together("seed", SEEDS)
def test_spikes_stand_where_the_limits_cut(bank, seed):
    given, key = _draw_question(bank, "normalisation-from-histograms", seed)
    cuts = given["low"] > given["a"], given["b"] > given["high"]
    touches = given["low"] == given["a"] and given["high"] == given["b"]
    seen = {(True, True): "both", (True, False): "bottom", (False, True): "top"}
    assert key == seen.get(cuts, "fits" if touches else "wide")


@together("seed", SEEDS)
def test_the_order_of_five_lights_is_that_of_the_curves(bank, seed):
    given, key = _draw_question(bank, "order-wavelengths-by-brightness", seed, part=1)
    by_day = [float(luminosity.luminous_efficiency(given[f"n_{k}"])) for k in range(1, 6)]
    assert by_day == sorted(by_day, reverse=True)
    assert [given[f"V_{k}"] for k in range(1, 6)] == pytest.approx(by_day, rel=0.01)
    by_night = [
        float(luminosity.luminous_efficiency(given[name], luminosity.NIGHT))
        for name in ("m_1", "m_2")
    ]
    assert [given["W_1"], given["W_2"]] == pytest.approx(by_night, rel=0.01)
    assert by_night[("short", "long").index(key)] == max(by_night)


@together("seed", SEEDS)
def test_the_lamps_have_the_heights_of_both_curves(bank, seed):
    drawn = draw_variant(bank.template("two-lamps-by-day-and-by-night"), seed)
    given = {k: float(v) for k, v in drawn.shown.items()}
    for k in "12":
        assert given[f"V_{k}"] == pytest.approx(
            luminosity.luminous_efficiency(given[f"l_{k}"]), abs=0.001
        )
        by_night = luminosity.luminous_efficiency(given[f"l_{k}"], luminosity.NIGHT)
        assert given[f"V'_{k}"] == pytest.approx(by_night, abs=0.001)


@together("seed", SEEDS)
def test_the_curve_is_as_high_at_the_wavelength_beyond_the_peak(bank, seed):
    drawn = draw_variant(bank.template("power-for-equal-brightness"), seed)
    given = {k: float(v) for k, v in drawn.shown.items()}
    curve = luminosity.NIGHT if given["dark"] else luminosity.DAY
    beyond = given["lambda_3"]
    for at, height, off in (
        (given["l_1"], given["h_1"], 0.002),
        (given["l_2"], given["h_2"], 0.002),
        (beyond, given["h_s"], 0.002),
        (beyond + given["w"], given["h_s"], 0.008),
    ):
        assert float(luminosity.luminous_efficiency(at, curve)) == pytest.approx(height, abs=off)


@together("seed", SEEDS)
def test_the_staircase_rises_where_the_key_says(bank, seed):
    given, key = _draw_question(bank, "quantiser-from-staircase", seed, part=1)
    drawn = draw_variant(bank.template("quantiser-from-staircase"), seed)
    rises = staircase.list_jumps(given)
    ends = {
        "nearest": (0.5, 0.5), "down": (1, 0), "parts": (1, 1), "up": (0, 1)
    }[key]  # fmt: skip
    tread = rises[1] - rises[0]
    assert (rises[0] / tread, (1 - rises[-1]) / tread) == pytest.approx(ends, abs=1e-9)
    k, q = (float(v) for v in ask_part(drawn, 2).spec.show().replace("k = ", "").split("; q = "))
    rounding = ROUNDINGS[int(given["rule"])]
    assert k == sum(rise < given["I"] for rise in rises) == rounding(given["I"], int(given["n"]))
    assert q == pytest.approx(k / len(rises), abs=0.0005)  # three figures are shown
