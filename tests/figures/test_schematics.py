"""Pinhole, thin lens, blur disc and Bayer mosaic, measured against optics from elsewhere."""

from __future__ import annotations

import itertools
from fractions import Fraction

import cv2
import numpy as np
import pytest
from figure_cases import MOSAIC, draw, module
from svg_reader import read_labels, read_parts
from sweep import together

from quizgen.camera import Camera, Scene, View
from quizgen.camera.effects import demosaicing

letter, neighbours = module("bayer").letter, module("bayer").neighbours


def parts(name, *, quiz=False, **values):
    return read_parts(draw(name, values, quiz=quiz))


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
    far, origin = got["ray"][0]
    point, image = got["leg-point"][0], got["leg-image"][0]
    assert (image[0] - origin)[0] / (point[0] - origin)[0] == pytest.approx(f / p_z, abs=2e-3)
    assert length(image) / length(point) == pytest.approx(f / p_z, abs=4e-3)
    assert np.sign(point[1] - point[0])[1] == np.sign(p_y)
    assert max(point[1], image[1], key=lambda p: p[0]) == pytest.approx(far)
    assert "break" not in got


@pytest.mark.parametrize(
    "values", [{"f": 50, "p_z": 600, "p_y": 30, "metric": 1}, {"f": 6, "p_z": 5, "p_y": -14}]
)
def test_pinhole_stays_similar_when_not_to_scale(values):
    got = parts("pinhole", physical=1, **values)
    origin, behind = got["physical-ray"][0]
    tips = [got["leg-point"][0][1], got["leg-image"][0][1], behind]
    slopes = [(tip - origin)[1] / (tip - origin)[0] for tip in tips]
    assert slopes == pytest.approx([slopes[0]] * 3, rel=2e-3)
    assert "break" in got
    assert behind - origin == pytest.approx(origin - got["leg-image"][0][1], abs=0.02)


def test_shaded_triangles_have_the_legs_and_the_ray_as_sides():
    got = parts("pinhole", f=2, p_z=4, p_y=9)
    for part, leg in (("outer", "leg-point"), ("inner", "leg-image")):
        origin, foot, tip = got[part][0][:3]
        assert origin == pytest.approx(got["ray"][0][1])
        assert np.array([foot, tip]) == pytest.approx(got[leg][0])


def test_y_down_turns_the_picture_over():
    up, down = (parts("pinhole", f=2, p_z=4, p_y=9, y_down=d) for d in (0, 1))
    assert up["leg-point"][0][1][1] > up["leg-point"][0][0][1]
    assert down["leg-point"][0][1][1] < down["leg-point"][0][0][1]
    assert down["axis-y"][0][1][1] < down["axis-y"][0][0][1]


def test_the_tree_is_upside_down_on_the_physical_plane():
    *upright, turned = parts("pinhole", f=2, p_z=5, p_y=3, physical=1)["tree"]
    for tree, up in (*((tree, True) for tree in upright), (turned, False)):
        widest = np.ptp(tree[:, 0])
        low = tree[tree[:, 1] < tree[:, 1].min() + 0.3 * np.ptp(tree[:, 1])]
        assert (np.ptp(low[:, 0]) > 0.9 * widest) == up


def test_questions_that_name_a_thing_show_no_tree():
    assert "tree" not in parts("pinhole", f=50, p_z=600, p_y=30, metric=1)


# thin lens ---------------------------------------------------------------------------------


@together(("f", "z"), [(50, 200), (20, 25), (30, 45), (85, 255), (24, 60), (50, 250), (50, 300)])
def test_rays_meet_at_the_real_image(f, z):
    got = parts("thin_lens", f=f, z=z, quiz=True)
    rays = [got[f"ray-{name}"][0] for name in ("parallel", "central", "focal")]
    lens_x, axis_y = rays[1][1]
    meet = [crossing(a[1:], b[1:]) for a, b in itertools.combinations(rays, 2)]
    focus = crossing(rays[0][1:], got["axis"][0])
    image = 1 / (Fraction(1, f) - Fraction(1, z))  # the lens equation, exactly
    scale = (focus[0] - lens_x) / f
    for point in meet:
        assert (point[0] - lens_x) / scale == pytest.approx(float(image), rel=5e-3)
        assert point == pytest.approx([got["image"][0][0][0], rays[0][2][1]], abs=0.1)
    assert (lens_x - rays[0][0][0]) / scale == pytest.approx(z, rel=5e-3)
    height = rays[0][0][1] - axis_y
    assert (axis_y - meet[0][1]) / height == pytest.approx(float(image / z), rel=2e-2)
    assert "break" not in got


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
    assert "no image" in draw("thin_lens", {"f": 50, "z": 50}).alt


def test_far_objects_are_broken_off_and_still_look_different():
    near, far = (parts("thin_lens", f=50, z=z) for z in (400, 1050))
    assert "break" in near
    assert "break" in far
    tips = [got["image"][0][-1] for got in (near, far)]
    assert np.abs(tips[0] - tips[1]).max() > 3


def test_a_learners_image_stands_at_its_distance():
    # the reciprocals added: 1/(1/50 + 1/200) = 40, where the image is at 66.67
    figure = draw("thin_lens", {"f": 50, "z": 200}, marks={"z'": 40})
    got = read_parts(figure)
    lens_x, right = got["ray-central"][0][1][0], got["image"][0][0][0]
    learned = got["learned"][0][0][0]
    assert (learned - lens_x) / (right - lens_x) == pytest.approx(40 / (200 / 3), rel=5e-3)
    assert read_labels(figure)[-1] == "40 mm"


# blur disc ---------------------------------------------------------------------------------


@pytest.mark.parametrize(("z_p", "z_s"), [(50, 65), (50, 35), (60, 78), (50, 60), (50, 75)])
def test_blur_disc_is_cut_from_the_cone(z_p, z_s):
    got = parts("blur_disc", D=25, z_p=z_p, z_s=z_s)
    upper, lower = got["rays"][0], next(line for line in got["rays"][1:] if len(line) == 3)
    aperture = upper[0][1] - lower[0][1]
    sensor = got["sensor"][0]
    hits = [crossing(ray[:2], sensor)[1] for ray in (upper, lower)]
    assert abs(hits[0] - hits[1]) == pytest.approx(length(got["disc"][0]), abs=0.05)
    assert length(got["disc"][0]) / aperture == pytest.approx(abs(z_s - z_p) / z_p, abs=1e-3)
    assert "break" not in got


def test_blur_disc_of_the_curriculum():
    # S11: D 25, z'_p 50, z'_s 50.2 -> 0.1 mm
    alt = draw("blur_disc", {"D": 25, "z_p": 50, "z_s": 50.2}).alt
    assert alt.endswith("D is 25 mm; the diameter of the disc is c = 0.1 mm.")


@pytest.mark.parametrize("z_s", [48, 52])
@pytest.mark.parametrize("quiz", [True, False])
def test_diameters_are_named_beside_their_arrows(z_s, quiz):
    figure = draw("blur_disc", {"D": 25, "z_p": 50, "z_s": z_s}, quiz=quiz)
    arrows = [line for line in read_parts(figure)["diameters"] if len(line) == 2]
    for name, pick in (("$D$", min), ("$c$", max)):
        arrow = pick(arrows, key=lambda line: line[0, 0])
        label = next(label for label in figure.labels if label.text.startswith(name))
        assert label.left - 12 <= arrow[0, 0] <= label.right + 12
        assert -label.bottom - arrow[:, 1].max() < 12


def test_small_apertures_and_far_sensors_look_so():
    wide, narrow = (parts("blur_disc", D=d, z_p=50, z_s=51) for d in (25, 3.125))
    assert length(wide["disc"][0]) > 1.3 * length(narrow["disc"][0])
    near, far = (parts("blur_disc", D=25, z_p=50, z_s=z) for z in (50.2, 52))
    assert length(far["disc"][0]) > 1.15 * length(near["disc"][0])


def test_a_learners_disc_is_as_much_larger_as_its_number():
    # twice the diameter; far too large a one ends at the edge
    got = read_parts(draw("blur_disc", {"D": 25, "z_p": 50, "z_s": 50.2}, marks={"c": 0.2}))
    assert length(got["learned"][0]) == pytest.approx(2 * length(got["disc"][0]), abs=0.05)
    far = draw("blur_disc", {"D": 25, "z_p": 50, "z_s": 50.2}, marks={"c": 200})
    assert len(read_parts(far)["learned"]) == 3
    assert far.height_pt < 200


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


@together("phase", range(4))
@together("site", [(2, 2), (3, 2), (2, 3), (3, 3)])
def test_the_bayer_diagram_averages_the_sites_that_the_camera_does(phase, site):
    """The figure's neighbours give what the simulator's demosaicing gives at the same site."""
    raw = np.random.Generator(np.random.SFC64(7)).integers(20, 236, (6, 6)).astype(np.float32)
    look = View(Scene(6, 6), Camera(mosaic=module("bayer").PATTERNS[phase]))
    full = demosaicing.run(raw[..., None], look)
    x, y = site
    values = {"phase": phase, "size": 6, "x": x, "y": y}
    for index, channel in enumerate("RGB"):
        if channel == letter(values, x, y):
            continue
        mean = np.mean([raw[v, u] for u, v in neighbours(values, channel)])
        assert full[y, x, index] == pytest.approx(mean, abs=1e-4)


def test_arrows_come_from_the_sites_that_are_used():
    values = {"v01": 100, "v10": 120, "v12": 110, "v21": 130}
    got = parts("bayer", **values)
    shafts = {c: [line for line in got[f"use-{c}"] if len(line) == 2] for c in "GR"}
    assert (len(shafts["G"]), len(shafts["R"])) == (4, 4)
    middle = got["marked"][0][:4].mean(axis=0)
    for start, end in shafts["G"] + shafts["R"]:
        assert np.hypot(*(end - middle)) < np.hypot(*(start - middle))
    assert "use-G" not in parts("bayer", quiz=True, **values)


@pytest.mark.parametrize(("phase", "pattern"), [(0, "RGGB"), (1, "BGGR"), (2, "GRBG"), (3, "GBRG")])
def test_strokes_tell_red_from_blue_without_colour(phase, pattern):
    """Red sites have rising strokes, blue ones falling; both where the pattern has them."""
    got = parts("bayer", phase=phase)
    assert len(got["hatch-R"]) == len(got["hatch-B"]) == 4 * 4
    for colour, sign in (("R", 1), ("B", -1)):
        ways = np.array([line[1] - line[0] for line in got[f"hatch-{colour}"]])
        assert (np.sign(ways[:, 0] * ways[:, 1]) == sign).all()
    assert read_labels(draw("bayer", {"phase": phase}))[:2] == list(pattern[:2])


def test_reference_site_of_the_notes():
    # W15 / S14: 115 and 65
    alt = draw("bayer", MOSAIC).alt
    assert "G = (100 + 120 + 110 + 130) / 4 = 115." in alt
    assert "R = (60 + 64 + 70 + 66) / 4 = 65." in alt


def test_a_single_neighbour_needs_no_mean():
    alt = draw("bayer", {"size": 3, "x": 0, "y": 0, "channel": 3, "v11": 31}).alt
    assert alt.endswith("arrows come from (column, row) (1, 1). B = 31.")
