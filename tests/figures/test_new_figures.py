"""Figures of a textbook, measured in their own drawings against independent numbers."""

from __future__ import annotations

from math import degrees, hypot

import cv2
import numpy as np
import pytest
from figure_cases import REFERENCE, draw, module
from scipy.stats import multivariate_normal
from svg_reader import read_labels, read_parts
from sweep import together

from quizgen.bank.bank import builtin_bank
from quizgen.bank.formulas import read_formulas
from quizgen.core.errors import BankError


def parts(name, quiz=False, **values):
    return read_parts(draw(name, values or REFERENCE[name], quiz=quiz))


def labels(name, quiz=False, **values):
    return read_labels(draw(name, values or REFERENCE[name], quiz=quiz))


def size(line):
    """Width and height of what a line encloses."""
    return np.ptp(line, axis=0)


# Field of view -----------------------------------------------------------------------------


@pytest.mark.parametrize(("width", "f"), [(36, 50), (8.8, 4), (24, 135)])
def test_the_rays_enclose_the_field_of_view_that_opencv_computes(width, f):
    pixels = 1000
    focal = pixels * f / width
    matrix = np.array([[focal, 0, pixels / 2], [0, focal, pixels / 2], [0, 0, 1]])
    expected, *_ = cv2.calibrationMatrixValues(matrix, (pixels, pixels), width, width)
    edge, hole, other = parts("field_of_view", W=width, H=24, f=f, Z=10)["field"][0][:3]
    up, down = (np.arctan2(*(end - hole)[::-1]) for end in (edge, other))
    assert degrees(up - down) == pytest.approx(expected, abs=0.1)


def test_sensor_and_wall_are_seen_under_the_same_angle():
    drawn = parts("field_of_view")
    (sensor,), (wall,) = drawn["sensor"], drawn["wall"]
    hole = drawn["field"][0][1]
    ratio = size(sensor)[1] / (hole[0] - sensor[0][0])
    assert ratio == pytest.approx(size(wall)[1] / (wall[0][0] - hole[0]), rel=0.01)
    assert ratio == pytest.approx(36 / 50, rel=0.01)


def test_the_sensor_from_the_front_has_its_shape():
    width, height = size(parts("field_of_view")["front"][0])
    assert width / height == pytest.approx(36 / 24, rel=0.01)


# Rolling shutter ---------------------------------------------------------------------------


def test_each_row_of_the_pole_lies_farther_to_the_right_by_the_same_step():
    lefts = [piece[:, 0].min() for piece in parts("rolling_shutter_skew")["pole"]]
    steps = np.diff(lefts)
    assert np.ptp(np.delete(steps, 3)) < 0.03  # the rows that are left out stand for one
    assert steps[3] == pytest.approx(2 * steps[0], abs=0.03)


@pytest.mark.parametrize(
    ("v", "t_r", "n", "shift", "angle"),
    [(500, 20, 1000, "10", "0.5729"), (8000, 30, 300, "72", "13.5"), (400, 10, 500, "2", "0.2292")],
)
def test_shift_and_lean_are_those_of_plain_kinematics(v, t_r, n, shift, angle):
    shown = labels("rolling_shutter_skew", v=v, t_r=t_r, n=n)
    assert f"d = {shift} px" in shown
    assert any(text.startswith("α") and f" {angle}°" in text for text in shown)


# Pixels ------------------------------------------------------------------------------------


def place_in_frame(drawn, spot):
    frame = drawn["frame"][0]
    left, top = frame[:, 0].min(), frame[:, 1].max()
    scale = size(frame)[0] / 640
    return (spot[0] - left) / scale, (top - spot[1]) / scale


def centre(lines):
    return np.mean([lines[0].min(axis=0), lines[0].max(axis=0)], axis=0)


def test_point_and_principal_point_lie_at_their_pixels_with_rows_counted_down():
    drawn = parts("pixel_grid")
    assert place_in_frame(drawn, centre(drawn["point"])) == pytest.approx((430, 170), abs=1)
    cross = drawn["principal"]
    middle = (np.mean(cross[0], axis=0) + np.mean(cross[1], axis=0)) / 2
    assert place_in_frame(drawn, middle) == pytest.approx((310, 250), abs=1)


def test_a_point_beside_the_picture_is_drawn_beside_it():
    drawn = parts("pixel_grid", **{**REFERENCE["pixel_grid"], "u": -100, "v": 520})
    assert place_in_frame(drawn, centre(drawn["point"])) == pytest.approx((-100, 520), abs=2)


def test_a_hidden_point_decides_nothing_in_the_drawing():
    far, near = (
        draw("pixel_grid", {**REFERENCE["pixel_grid"], "u": u}, quiz=True) for u in (-300, 400)
    )
    assert far.inline_svg == near.inline_svg
    assert "point" not in parts("pixel_grid", quiz=True)


def test_a_given_point_is_shown_in_a_quiz_without_its_offsets():
    shown = labels("pixel_grid", quiz=True, **REFERENCE["pixel_grid"], given=1)
    assert "(430; 170)" in shown
    assert not [text for text in shown if "−" in text]


def test_the_vanishing_point_is_where_far_points_of_the_line_are_imaged():
    values = REFERENCE["vanishing_point"]
    matrix = np.array([[500, 0, 320], [0, 500, 240], [0, 0, 1]], float)
    far = np.array(values["a"]) + 1e7 * np.array(values["d"], float)
    (pixel,), _ = cv2.projectPoints(far, np.zeros(3), np.zeros(3), matrix, None)
    drawn = parts("vanishing_point")
    spot = place_in_frame(drawn, centre(drawn["vanishing"]))
    assert spot == pytest.approx(tuple(pixel[0]), abs=1)
    assert "(445; 490)" in labels("vanishing_point")


def test_images_of_parallel_lines_meet_in_the_vanishing_point():
    drawn = parts("vanishing_point")
    goal = centre(drawn["vanishing"])
    ends = [line[-1] for line in (*drawn["parallels"], *drawn["line"][:1])]
    assert np.allclose(ends, goal, atol=0.05)


@pytest.mark.parametrize("name", ["pixel_grid", "vanishing_point"])
def test_a_pixel_of_a_learner_is_ringed_where_it_lies(name):
    drawn = read_parts(draw(name, REFERENCE[name], marks={"u": 200, "v": 100}))
    assert place_in_frame(drawn, centre(drawn["learned"])) == pytest.approx((200, 100), abs=1)


def test_a_pixel_far_outside_is_an_arrow_at_the_edge():
    drawn = read_parts(draw("pixel_grid", REFERENCE["pixel_grid"], marks={"u": 99999}))
    u, v = place_in_frame(drawn, drawn["learned"][0][0])
    assert (u, v) == pytest.approx((640, 170), abs=1)


# CCD ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "count", "streak"),
    [
        # 3·(200000 − 20000)/(20000 − 2000), 3·200000·5/10000
        ({"F": 20000, "Q": 200000, "b": 2000, "h": 3, "t": 10, "t_r": 5}, "30", "300"),
        # 2·(100000 − 10000)/(10000 − 1000), 2·100000·10/20000
        ({"F": 10000, "Q": 100000, "b": 1000, "h": 2, "t": 20, "t_r": 10}, "20", "100"),
    ],
)
def test_overflow_and_streak_are_those_of_the_balance_of_charge(values, count, streak):
    shown = labels("ccd_streak", **values)
    assert f"n = {count}" in shown
    assert [text for text in shown if text.startswith(f"e = {streak} ")]


def test_charges_are_as_long_as_their_share_of_the_full_well():
    drawn = parts("ccd_streak")
    (full,) = {round(float(size(site)[0]), 1) for site in drawn["photosites"]}
    lengths = [size(charge)[0] / full for charge in drawn["charge"]]
    assert sorted(lengths) == pytest.approx([0.1] * 8 + [1.0] * 3, abs=0.01)
    assert all(size(over)[0] / full == pytest.approx(0.9, abs=0.01) for over in drawn["overflow"])


def test_before_it_flows_over_neither_overflow_nor_streak_is_seen():
    assert not {"overflow", "streak"} & parts("ccd_streak", quiz=True).keys()


# Spectra -----------------------------------------------------------------------------------


def test_what_comes_back_is_the_product_in_each_band():
    drawn, values = parts("reflectance_spectra"), REFERENCE["reflectance_spectra"]
    one = size(drawn["b-0"][0])[1]  # the blue light has the strength 1
    for band in "rgb":
        heights = [size(drawn[f"{band}-{place}"][0])[1] / one for place in range(3)]
        expected = values[f"L_{band}"], values[f"R_{band}"]
        assert heights == pytest.approx([*expected, expected[0] * expected[1]], abs=0.01)


def test_a_quiz_has_no_bars_for_what_comes_back():
    assert not [name for name in parts("reflectance_spectra", quiz=True) if name.endswith("-2")]


# Gaussians in the plane --------------------------------------------------------------------


@pytest.mark.parametrize("row", [(4, 0, 9), (25, 0, 1), (2, 1, 2), (2, -1, 2)])
def test_contours_are_curves_of_equal_density(row):
    density = multivariate_normal([0, 0], [[row[0], row[1]], [row[1], row[2]]]).pdf
    points = module("gaussian_contours").contour(row, 1.5)
    assert density(points) == pytest.approx(density(points[0]), rel=1e-9)
    assert density(points[0]) / density((0, 0)) == pytest.approx(np.exp(-(1.5**2) / 2))


def test_the_density_at_the_point_is_that_of_scipy():
    g = multivariate_normal([0, 0], [[4, 0], [0, 9]]).pdf((1, 2))
    assert f"g ≈ {g:.4g}" in labels("gaussian_contours")
    assert f"q ≈ {1 / 4 + 4 / 9:.4g}" in labels("gaussian_contours")


def test_semi_axes_are_the_standard_deviations():
    width, height = size(parts("gaussian_contours")["contour-1"][0])
    assert width / height == pytest.approx(2 / 3, rel=0.01)


def test_several_gaussians_are_numbered_in_a_quiz_and_named_in_the_solution():
    assert {"1", "5"} <= set(labels("gaussian_contours", quiz=True, x=0))
    assert {"(2; −1)", "(−1; 2)"} <= set(labels("gaussian_contours", x=0))
    turned = [parts("gaussian_contours", x=0)[f"contour-{n}"][0] for n in (3, 4)]
    slopes = [np.cov(line.T)[0, 1] for line in turned]
    assert slopes[0] > 0 > slopes[1]


def test_what_is_no_covariance_matrix_is_refused():
    with pytest.raises(BankError, match="is no variance, covariance, variance"):
        draw("gaussian_contours", {"covariances": ((1, 2, 1),)})


# Pipeline ----------------------------------------------------------------------------------


def test_the_blocks_stand_in_the_order_of_the_template():
    steps = builtin_bank().template("imaging-pipeline-order").rules.part[0].answer["steps"]
    assert list(module("imaging_pipeline").STEPS) == steps


def test_the_step_that_is_left_out_is_crossed():
    drawn = parts("imaging_pipeline", left_out=8)
    block = drawn["block-demosaic"][0]
    assert np.allclose(centre(drawn["left-out"]), centre([block]), atol=0.05)
    assert "left-out" not in parts("imaging_pipeline", left_out=0)


def test_the_pipeline_speaks_the_language_of_the_question():
    bangla = read_labels(draw("imaging_pipeline", {}, lang="bn"))
    assert "রঙের filter" in bangla
    assert "colour filters" not in bangla


# Bayer -------------------------------------------------------------------------------------


@together("phase", range(4))
@together(("columns", "rows"), [(5, 5), (4, 7), (12, 3)])
def test_the_counts_are_those_of_the_sites_that_are_drawn(phase, columns, rows):
    pattern = ("RGGB", "BGGR", "GRBG", "GBRG")[phase]
    sites = [pattern[2 * (y % 2) + x % 2] for y in range(rows) for x in range(columns)]
    drawn = parts("bayer_counts", phase=phase, W=columns, H=rows)
    shown = labels("bayer_counts", phase=phase, W=columns, H=rows)
    for letter in "RGB":
        assert len(drawn[f"site-{letter}"]) == sites.count(letter)
        (line,) = [text for text in shown if text.startswith(f"{letter} =")]
        assert line.endswith(f" = {sites.count(letter)}")


def test_a_tile_from_the_middle_of_a_sensor_counts_as_the_sensor_does():
    values = {"size": 6, "left": 14, "top": 6, "x": 3, "y": 2, "channel": 1}
    figure = draw("bayer", values)  # column 17 and row 8 of RGGB: green, in a row with red
    assert "column 17, row 8 (G)" in figure.alt
    assert "(16, 8), (18, 8)" in figure.alt
    assert {"14", "19", "6", "11"} <= set(read_labels(figure))
    with pytest.raises(BankError, match="left and top are not even"):
        draw("bayer", {**values, "left": 13})


# Formula sketches --------------------------------------------------------------------------


def test_every_formula_with_a_sketch_names_one_that_can_be_drawn_and_none_is_unused():
    named = {e.figure.values["formula"] for e in read_formulas(builtin_bank()) if e.figure}
    drawn = {n for numbers, _ in module("formula_sketch").SKETCHES.values() for n in numbers}
    assert named == drawn


def test_a_formula_names_its_own_sketch():
    for entry in read_formulas(builtin_bank()):
        if entry.figure:
            assert entry.id == f"F{entry.figure.values['formula']:02.0f}"


def test_sketches_are_small_and_hold_symbols():
    for numbers, _ in module("formula_sketch").SKETCHES.values():
        figure = draw("formula_sketch", {"formula": numbers[0]})
        assert figure.width_pt <= 115
        assert figure.height_pt <= 90


def test_a_formula_without_a_sketch_is_refused():
    with pytest.raises(BankError, match="formula 19 has no sketch"):
        draw("formula_sketch", {"formula": 19})


def test_the_blur_disc_of_its_sketch_is_where_the_cone_meets_the_sensor():
    drawn = read_parts(draw("formula_sketch", {"formula": 33}))
    (upper, lower), disc = drawn["rays"][:2], drawn["disc"][0]
    assert {round(float(line[-1][1]), 1) for line in (upper, lower)} == {
        round(float(y), 1) for y in disc[:, 1]
    }


def test_the_image_of_the_lens_sketch_lies_where_its_rays_cross():
    drawn = read_parts(draw("formula_sketch", {"formula": 42}))
    parallel, central = drawn["rays"][0], drawn["rays"][-1]
    tip = drawn["image"][-1]
    (p, q), (r, s) = parallel[-2:], central[[0, -1]]
    share, _ = np.linalg.solve(np.column_stack([q - p, r - s]), r - p)
    assert hypot(*(p + share * (q - p) - tip[0])) < 0.3
