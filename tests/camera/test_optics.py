"""Lens and motion against analytic profiles, exact fractions and OpenCV."""

import math
from fractions import Fraction

import cv2
import numpy as np
import pytest
from scipy import ndimage
from scipy.integrate import quad
from sweep import together

from quizgen.camera import (
    Camera,
    Length,
    PreparedScene,
    Scene,
    SceneError,
    SceneObject,
    View,
    simulate_question,
)
from quizgen.camera.effects import defocus, distortion, lateral_colour, rolling_shutter, vignetting
from quizgen.camera.pixels.filters import convolve, sample_nearest
from quizgen.camera.pixels.kernels import disc_kernel, motion_kernel
from quizgen.camera.raster import depth_blur
from quizgen.camera.raster.rasterizer import Layer, Motion, composite_layers
from quizgen.camera.simulation import run_plan


def edge(width=80, height=8):
    image = np.zeros((height, width, 3), np.float32)
    image[:, width // 2 :] = 1
    return image


def edge_behind_a_disc(position, radius):
    """Light behind a uniform disc on an ideal edge, closed form."""
    x = min(max(position / radius, -1.0), 1.0)
    return 0.5 + (math.asin(x) + x * math.sqrt(1 - x * x)) / math.pi


@together("diameter", [0.02, 0.3, 0.7, 1.0, 1.9, 3.3, 7.0, 15.0, 31.0])
def test_disc_blur_has_the_analytic_edge_profile(diameter):
    blurred = convolve(edge(), disc_kernel(diameter))[4, :, 0]
    for pixel in range(40 - 18, 40 + 18):
        left = pixel - 40
        kinks = [k for k in (-diameter / 2, diameter / 2) if left < k < left + 1]
        mean, _ = quad(edge_behind_a_disc, left, left + 1, (diameter / 2,), points=kinks or None)
        assert blurred[pixel] == pytest.approx(mean, abs=3e-4), pixel


def test_a_small_blur_moves_an_edge_by_the_published_amount():
    """255 c/(3 pi) grey levels: 13.5 for half a pixel."""
    moved = 255 * convolve(edge(), disc_kernel(0.5))[4, 39, 0]
    assert moved == pytest.approx(255 * 0.5 / (3 * math.pi), rel=1e-3)
    assert round(float(moved), 1) == 13.5


@pytest.mark.parametrize(
    ("f", "number", "s", "z"), [(50, 2, 2000, 5000), (35, 8, 3000, 900), (85, 4, 10000, 8000)]
)
def test_circle_of_confusion_from_two_image_distances(f, number, s, z):
    """c = D |z'_s - z'_z| / z'_z by exact fractions, pitch 5 um."""
    f, s, z = Fraction(f), Fraction(s), Fraction(z)
    in_focus, other = f * s / (s - f), f * z / (z - f)
    expected = f / number * (in_focus - other) / other / Fraction(5, 1000)
    camera = Camera(float(f) / 1000, 5e-6, float(number), float(s) / 1000)
    assert View(Scene(), camera).blur_diameter(float(z) / 1000) == pytest.approx(
        float(expected), rel=1e-12
    )


def test_focus_at_infinity_and_subject_at_infinity():
    near = View(Scene(), Camera(0.05, 5e-6, 2.0)).blur_diameter(10.0)
    assert near == pytest.approx(-(0.05**2) / (2 * 10) / 5e-6)
    far = View(Scene(), Camera(0.05, 5e-6, 2.0, 10.0)).blur_diameter(math.inf)
    assert far == pytest.approx(0.05**2 / (2 * 9.95) / 5e-6)


def test_ray_traced_spot():
    """Rays through random points of the aperture land inside, and spread like, the disc."""
    source, camera = np.random.default_rng(1), Camera(0.05, 5e-6, 2.0, 2.0)
    f, s, z = 0.05, 2.0, 3.0
    sensor_at, focus_at = f * s / (s - f), f * z / (z - f)
    turn, distance = source.uniform(0, 2 * np.pi, 200_000), np.sqrt(source.random(200_000)) * 0.0125
    x = distance * np.cos(turn) * (1 - sensor_at / focus_at) / 5e-6
    kernel = disc_kernel(float(View(Scene(), camera).blur_diameter(z)))
    offsets = np.arange(kernel.shape[0]) - kernel.shape[0] // 2
    variance = (kernel.sum(axis=0) * offsets**2).sum() - 1 / 6
    assert variance == pytest.approx(x.var(), rel=0.01)


def test_a_sharp_front_keeps_its_edge_before_a_blurred_background():
    front = Layer(edge() * 0.5, edge()[..., :1], 2.0)
    back = Layer(np.random.default_rng(0).random((8, 80, 3)).astype(np.float32), None, 50.0)
    view = View(Scene(80, 8), Camera(0.05, 5e-6, 2.0, 2.0))
    picture = composite_layers(defocus.EFFECT.run((back, front), view))
    assert (picture[:, 40:] == 0.5).all()


def test_a_blurred_front_lets_the_background_through():
    front = Layer(np.zeros((8, 80, 3), np.float32), edge()[..., :1], 1.0)
    back = Layer(np.ones((8, 80, 3), np.float32), None, 2.0)
    view = View(Scene(80, 8), Camera(0.05, 5e-6, 8.0, 2.0))
    picture = composite_layers(defocus.EFFECT.run((back, front), view))[4, :, 0]
    radius = abs(view.blur_diameter(1.0)) / 2
    expected = [1 - edge_behind_a_disc(pixel + 0.5 - 40, radius) for pixel in range(20, 60)]
    assert np.abs(picture[20:60] - expected).max() < 2e-3


def test_the_front_does_not_leak_into_a_blurred_background():
    """Depth map: black in front, white behind; beside the black edge the background stays white."""
    image = 1 - edge()
    depth = np.where(edge()[..., 0] > 0, 2.0, 40.0).astype(np.float32)
    scene = Scene(80, 8, image=image, depth=depth)
    prepared = PreparedScene(scene, Camera(0.05, 2e-5, 4.0, 2.0))
    picture = run_plan(prepared).values
    assert picture[:, :40].min() > 0.999
    assert picture[:, 40:].max() < 1e-6


def test_slices_of_a_depth_map_leave_no_seams():
    """In bands of rows, as SciPy blurs each slice of the whole picture (far in front of near)."""
    source = np.random.default_rng(5)
    image = source.random((500, 60, 3))
    depth = 1.0 / np.linspace(1.0 / 1.5, 1.0 / 6.0, 500)[:, None] * np.ones(60)
    depth[200:320, 20:35] = 1.2
    camera = Camera(0.05, 1e-5, 4.0, 2.0)
    view = View(Scene(60, 500, image=image, depth=depth, precision="float64"), camera)
    blur = view.blur_diameter(depth)
    middles = depth_blur.slice_diameters((float(blur.min()), float(blur.max())))
    slices = np.rint((view.blur_diameter(depth) - middles[0]) / (middles[1] - middles[0]))
    expected = image.copy()
    for number in range(len(middles) - 1, -1, -1):
        kernel, mask = disc_kernel(float(middles[number])), (slices == number)[..., None] * 1.0
        cover = ndimage.convolve(mask, kernel[..., None], mode="nearest")
        colour = ndimage.convolve(image * mask, kernel[..., None], mode="nearest")
        if number == len(middles) - 1:
            seen = cover > 1e-3
            expected = np.where(seen, colour / np.where(seen, cover, 1.0), image)
        else:
            expected = expected * (1.0 - cover) + colour
    found = defocus.operation(Layer(image, depth=depth), view).colour
    assert 8 < len(middles) < 30
    assert np.abs(found - expected).max() < 1e-12


def test_a_depth_map_is_bent_with_its_picture():
    depth = np.random.default_rng(2).random((150, 201)).astype(np.float32) + 1.0
    image = np.repeat(depth[..., None], 3, axis=2)
    view = View(Scene(201, 150, image=image, depth=depth), Camera(0.05, 0.05 / 220, k1=-0.2))
    bent = distortion.operation(Layer(image, depth=depth), view)
    assert np.abs(bent.depth - depth).max() > 0.5
    assert np.array_equal(bent.depth, sample_nearest(depth, *distortion.source_positions(view)))


@pytest.mark.parametrize(("k1", "k2"), [(-0.2, 0.0), (0.3, 0.0), (-0.25, 0.1), (0.1, 0.4)])
def test_distortion_is_that_of_project_points(k1, k2):
    """A point drawn undistorted is found where OpenCV projects it."""
    view = View(Scene(201, 151), Camera(0.05, 0.05 / 220, k1=k1, k2=k2))
    x, y = distortion.source_positions(view)
    rows, columns = np.mgrid[0:151:10, 0:201:10]
    normal = np.stack([(x - 100) / 220, (y - 75) / 220, np.ones_like(x)], axis=-1)
    matrix = np.array([[220.0, 0, 100], [0, 220, 75], [0, 0, 1]])
    points = normal[rows, columns].reshape(-1, 1, 3).astype(np.float64)
    found, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), matrix, np.array([k1, k2, 0, 0]))
    assert np.abs(found[:, 0, 0] - columns.ravel()).max() < 1e-4
    assert np.abs(found[:, 0, 1] - rows.ravel()).max() < 1e-4


def test_the_inverse_is_the_published_one_and_stops_at_the_fold():
    assert distortion.undistorted_radius(0.6928203230275509, -0.25, 0.0) == pytest.approx(
        0.842122266240542597, abs=1e-15
    )
    with pytest.raises(SceneError, match="folds"):
        distortion.undistorted_radius(0.77, -0.25, 0.0)


def test_lateral_colour_moves_red_out_and_blue_in():
    image = np.zeros((101, 101, 3), np.float32)
    image[90, 90] = 1
    view = View(Scene(101, 101), Camera(lateral_colour=1.0))
    split = lateral_colour.EFFECT.run((Layer(image),), view)[0].colour
    places = np.arange(101)
    centres = [(split[..., c].sum(axis=0) * places).sum() / split[..., c].sum() for c in range(3)]
    share = 40 / 50 / math.sqrt(2)
    assert centres[0] - 90 == pytest.approx(share, abs=0.02)
    assert centres[1] == 90
    assert centres[2] - 90 == pytest.approx(-share, abs=0.02)


def test_lateral_colour_is_opencvs_remapping_of_each_channel():
    """Several bands of rows, reading beyond every edge."""
    image = np.random.default_rng(3).random((130, 170, 3), np.float32)
    view = View(Scene(170, 130, image=image), Camera(lateral_colour=-7.5))
    split = lateral_colour.operation(Layer(image), view).colour
    corner = math.hypot(84.5, 64.5)
    for channel, scale in enumerate((1 - 7.5 / corner, 1.0, 1 + 7.5 / corner)):
        x = np.tile((np.arange(170) - 84.5) / scale + 84.5, (130, 1)).astype(np.float32)
        y = np.tile((np.arange(130) - 64.5) / scale + 64.5, (170, 1)).T.astype(np.float32)
        plane, mode = np.ascontiguousarray(image[..., channel]), cv2.BORDER_REPLICATE
        expected = cv2.remap(plane, x, y, cv2.INTER_LINEAR, borderMode=mode)
        assert np.abs(split[..., channel] - expected).max() < 1e-6


@pytest.mark.parametrize(("across", "down"), [(6.0, 0.0), (0.0, 9.5), (4.0, 3.0)])
def test_motion_is_a_box_along_the_path(across, down):
    """Variance L^2/12 along the path, plus 1/6 of the bilinear grid where it moves off the grid."""
    kernel = motion_kernel(across, down)
    rows, columns = (np.arange(n) - n // 2 for n in kernel.shape)
    for length, weights, places in ((across, kernel.sum(0), columns), (down, kernel.sum(1), rows)):
        if length:
            grid = (weights * places**2).sum() - length**2 / 12
            assert 0.1 < grid < 0.2


def test_rolling_shutter_tilts_an_upright_edge():
    """Speed 500 px/s, 1 ms per row: half a pixel per row."""
    thing = SceneObject(
        "box", width=Length(10.0), height=Length(80.0), velocity=(Length(500.0), Length(0.0))
    )
    prepared = PreparedScene(Scene(120, 60, (thing,)), Camera(row_time=1e-3))
    picture = run_plan(prepared).values[..., 0]
    centres = (picture * np.arange(120)).sum(axis=1) / picture.sum(axis=1)
    assert np.diff(centres) == pytest.approx(0.5, abs=1e-3)


def test_a_propeller_turns_by_spin_times_row_time():
    view = View(Scene(101, 101), Camera(row_time=1e-3))
    image = np.zeros((101, 101, 3), np.float32)
    image[:, 49:52] = 1
    layer = Layer(image, image[..., :1], 1.0, Motion((0.0, 0.0), 20.0, (50.0, 50.0), 50.0))
    bent = rolling_shutter.EFFECT.run((layer,), view)[0].colour[..., 0]
    for row in (20, 35, 65, 80):
        place = (bent[row] * np.arange(101)).sum() / bent[row].sum()
        angle = 20.0 * (row - 50) * 1e-3
        assert place - 50 == pytest.approx(-math.tan(angle) * (row - 50), abs=0.1)


def test_natural_vignetting_is_cos_to_the_fourth():
    view = View(Scene(640, 480), Camera(0.05, 5e-5, natural_vignetting=True))
    kept = vignetting.falloff_map(view)[..., 0]
    for row, column in ((0, 0), (100, 333), (479, 639)):
        radius = math.hypot(column - 319.5, row - 239.5) * 5e-5
        assert kept[row, column] == pytest.approx(math.cos(math.atan2(radius, 0.05)) ** 4, rel=1e-6)


def test_mechanical_vignetting_is_the_overlap_of_two_discs():
    source = np.random.default_rng(2)
    turn, distance = source.uniform(0, 2 * np.pi, 400_000), np.sqrt(source.random(400_000)) / 2
    x, y = distance * np.cos(turn), distance * np.sin(turn)
    for shift in (0.2, 0.5, 0.8):
        inside = np.hypot(x - shift, y) < 0.5
        assert vignetting.rim_overlap(shift) == pytest.approx(inside.mean(), abs=3e-3)


def test_projection_of_metres():
    """x = f X/Z: 50 mm, 30 m wide at 600 m, 5 um pixels: 500 px (notes, C14)."""
    thing = SceneObject("box", width=Length(30.0, metric=True), height=Length(20.0), depth=600.0)
    scene = Scene(640, 20, (thing,))
    picture = simulate_question(scene, Camera(0.05, 5e-6)).values[10, :, 0]
    assert picture.sum() == pytest.approx(500.0, abs=1e-3)
    with pytest.raises(SceneError, match="focal_length"):
        simulate_question(scene, Camera())
