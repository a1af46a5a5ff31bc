"""Diffraction, pinhole, the exposure triangle, flare, dark frames, binning: against the books."""

import math

import numpy as np
import pytest
from scipy import special
from skimage.measure import block_reduce
from sweep import together

from quizgen.camera import Camera, Length, PreparedScene, Scene, SceneError, SceneObject, View
from quizgen.camera.effects import binning, diffraction, exposure
from quizgen.camera.pixels.kernels import airy_kernel
from quizgen.camera.simulation import run_plan

LENS = {"focal_length": 0.05, "pixel_pitch": 5e-6}


def photo(image, **camera):
    """Everything of a camera before a picture of linear values, in linear values."""
    height, width = image.shape[:2]
    scene = Scene(width, height, image=image.astype(np.float32), seed=3)
    prepared = PreparedScene(scene, Camera(**camera))
    return run_plan(prepared).values


def even(level, side=64):
    return np.full((side, side, 3), level)


def edge(side=32):
    return np.where(np.arange(side)[None, :, None] < side // 2, 0.0, 1.0) * np.ones((side, 1, 3))


# Diffraction


def enclosed(ring):
    """Share of the light within x = ring of an Airy pattern (Rayleigh 1881)."""
    return 1 - special.j0(ring) ** 2 - special.j1(ring) ** 2


def test_the_airy_disc_holds_the_light_that_rayleigh_says():
    """83.8 % within the first dark ring of all the light; the kernel ends at the fifth."""
    scale = 12.0
    kernel = airy_kernel(scale)
    rows, columns = np.indices(kernel.shape) - kernel.shape[0] // 2
    inside = np.hypot(rows, columns) <= 1.2197 * scale
    assert enclosed(3.8317) == pytest.approx(0.838, abs=5e-4)
    expected = enclosed(special.jn_zeros(1, 1)[0]) / enclosed(special.jn_zeros(1, 5)[4])
    assert kernel[inside].sum() == pytest.approx(expected, abs=3e-3)


def test_the_airy_disc_has_the_shape_of_scipys_bessel_function():
    scale = 9.0
    kernel, middle = airy_kernel(scale), airy_kernel(scale).shape[0] // 2
    fine = np.linspace(-1, 1, 81)
    tent = np.maximum(0, 1 - np.abs(fine))
    for away in (0, 4, 11, 15, 25):
        x = math.pi * np.hypot(fine[:, None] + away, fine[None, :]) / scale
        light = np.where(
            x < 1e-9, 1.0, (2 * special.j1(np.maximum(x, 1e-9)) / np.maximum(x, 1e-9)) ** 2
        )
        expected = (tent[:, None] * tent[None, :] * light).sum() / (tent.sum() ** 2)
        share = kernel[middle, middle + away] / kernel[middle, middle]
        peak = 1.0 if away == 0 else None
        assert share == pytest.approx(peak or expected, rel=0.02, abs=1e-4)


def test_f22_softens_and_f4_does_not():
    """At 550 nm and 5 um the Airy disc is 5.4 um across at f/4 and 29.5 um at f/22.

    An edge rises by at most 8/(3 pi)/(wavelength times f-number): twice the area under the MTF.
    """

    def look(number):
        return View(Scene(), Camera(**LENS, f_number=number, wavelength=550e-9))

    assert 2 * 1.22 * diffraction.airy_scale(look(4.0)) * 5 == pytest.approx(5.37, abs=0.01)
    assert 2 * 1.22 * diffraction.airy_scale(look(22.0)) * 5 == pytest.approx(29.5, abs=0.05)
    sharp, soft = (photo(edge(), **LENS, f_number=n, wavelength=550e-9) for n in (4.0, 22.0))
    steepest = [np.abs(np.diff(picture, axis=1)).max() for picture in (sharp, soft)]
    assert steepest[0] > 0.7
    assert steepest[1] == pytest.approx(8 / (3 * math.pi) / 2.42, rel=0.05)


def test_a_point_has_no_diffraction():
    with pytest.raises(SceneError, match="needs f_number or pinhole"):
        Camera(**LENS, wavelength=550e-9)


# Pinhole and projection


def test_a_hole_blurs_by_its_own_shadow():
    """0.5 mm, 100 mm before the sensor, a point 1 m away: 0.55 mm by similar triangles."""
    look = View(Scene(), Camera(0.1, 5e-6, pinhole=5e-4))
    assert look.blur_diameter(1.0) * 5e-6 == pytest.approx(5.5e-4)
    assert look.blur_diameter(math.inf) * 5e-6 == pytest.approx(5e-4)


def test_a_hole_has_no_lens():
    with pytest.raises(SceneError, match="instead of f_number"):
        Camera(0.1, 5e-6, 8.0, pinhole=5e-4)


def test_a_near_thing_is_projected_by_its_image_distance():
    """f = 100 mm focused at 0.5 m magnifies f/(s - f) = 1/4: 10 mm become 2.5 mm, 500 px."""
    box = SceneObject(
        "box", width=Length(0.01, metric=True), height=Length(0.01, metric=True), depth=0.5
    )
    view = PreparedScene(Scene(640, 640, (box,)), Camera(0.1, 5e-6, focus_distance=0.5)).view
    assert view.scene.things[0].width.value == pytest.approx(500.0)


# Exposure


def test_the_sunny_sixteen_rule():
    """Full sun is light value 15: f/16 and 1/125 s at ISO 100 expose it within 0.04 stops."""
    look = View(Scene(), Camera(**LENS, f_number=16.0, shutter=1 / 125, light_value=15.0))
    assert math.log2(exposure.exposure_factor(look)) == pytest.approx(0.0, abs=0.04)


@together(
    ("change", "stops"),
    [
        ({"f_number": 4.0}, 2), ({"f_number": 16.0}, -2), ({"shutter": 1 / 32}, 2),
        ({"iso": 400.0}, 2), ({"f_number": 4.0, "iso": 25.0}, 0), ({"exposure": -1.0}, -1),
        ({"f_number": 16.0, "shutter": 1 / 64, "iso": 200.0}, 0),
    ],
)  # fmt: skip
def test_aperture_shutter_and_iso_are_counted_in_stops(change, stops):
    """f/8, 1/128 s and ISO 100 are EV 13."""
    settings = {**LENS, "f_number": 8.0, "shutter": 1 / 128, "light_value": 13.0, **change}
    assert photo(even(0.05), **settings).mean() == pytest.approx(0.05 * 2.0**stops, rel=1e-5)


def test_more_iso_instead_of_light_is_noisier():
    """A quarter of the light is a quarter of the electrons: half the signal-to-noise ratio."""
    settings = {**LENS, "shutter": 1 / 128, "light_value": 13.0, "full_well": 10000.0}
    low = photo(even(0.2, 256), f_number=8.0, **settings)
    high = photo(even(0.2, 256), f_number=16.0, iso=400.0, **settings)
    assert low.mean() == pytest.approx(high.mean(), rel=2e-3)
    assert high.std() / low.std() == pytest.approx(2.0, rel=0.01)
    assert low.mean() / low.std() == pytest.approx(math.sqrt(2000), rel=0.01)


def test_light_needs_an_opening_and_a_time():
    with pytest.raises(SceneError, match="needs shutter, and f_number or pinhole"):
        Camera(**LENS, f_number=8.0, light_value=13.0)


def test_veiling_glare_lifts_black_by_half_its_share_where_half_is_white():
    glared = photo(edge(), flare=0.05)
    assert glared[0, 0] == pytest.approx([0.025] * 3, abs=1e-6)
    assert glared[0, -1] == pytest.approx([0.975] * 3, abs=1e-6)


# Fixed pattern and dark frames

SENSOR = {"full_well": 1000.0, "shot_noise": False, "shutter": 1.0}


def test_the_pattern_is_the_same_in_every_picture_and_has_its_spread():
    first, second = (photo(even(0.2, 128), **SENSOR, fixed_pattern=20.0) for _ in range(2))
    assert np.array_equal(first, second)
    assert first.std() == pytest.approx(0.02, rel=0.02)


def test_many_dark_frames_take_pattern_pedestal_and_dark_charge_away():
    """What remains is the read noise of the picture and a tenth of it from a hundred frames."""
    settings = {**SENSOR, "fixed_pattern": 20.0, "bias": 100.0, "read_noise": 4.0}
    raw = photo(even(0.2, 128), **settings)
    clean = photo(even(0.2, 128), **settings, dark_frames=100)
    assert raw.mean() == pytest.approx(0.3, abs=1e-3)
    assert clean.mean() == pytest.approx(0.2, abs=1e-4)
    assert clean.std() == pytest.approx(0.004 * math.sqrt(1.01), rel=0.02)


def test_a_pedestal_keeps_black_from_brightening():
    """Clipped at zero, normal noise has the mean sigma/sqrt(2 pi)."""
    settings = {**SENSOR, "read_noise": 10.0, "bit_depth": 14}
    clipped = photo(even(0.0, 256), **settings)
    kept = photo(even(0.0, 256), **settings, bias=100.0, dark_frames=10000)
    assert clipped.mean() == pytest.approx(0.01 / math.sqrt(2 * math.pi), rel=0.02)
    assert kept.mean() == pytest.approx(0.0, abs=1e-4)


def test_dark_frames_of_a_mosaic_are_mosaics():
    settings = {**SENSOR, "fixed_pattern": 20.0, "bias": 100.0, "mosaic": "RGGB"}
    clean = photo(even(0.2, 32), **settings, dark_frames=1)
    assert clean == pytest.approx(np.full((32, 32, 3), 0.2), abs=2e-6)


# Binning


@pytest.mark.parametrize("side", [2, 3, 5])
def test_blocks_hold_scikit_images_means(side):
    source = np.random.default_rng(5)
    image = source.random((side * 4, side * 7, 3)).astype(np.float32)
    made = binning.run(image, View(Scene(), Camera(binning=side)))
    expected = block_reduce(image.astype(float), (side, side, 1), np.mean)
    assert made[::side, ::side] == pytest.approx(expected, abs=1e-6)
    assert np.array_equal(made, made[::side, ::side].repeat(side, 0).repeat(side, 1))


def test_a_cut_block_is_the_mean_of_what_it_has():
    image = np.arange(15.0, dtype=np.float32).reshape(3, 5, 1)
    made = binning.run(image, View(Scene(), Camera(binning=2)))[..., 0]
    assert made.tolist() == [[3, 3, 5, 5, 6.5], [3, 3, 5, 5, 6.5], [10.5, 10.5, 12.5, 12.5, 14]]
