"""Sensor, raw development and edits against published values, OpenCV, colorsys and statistics."""

import colorsys
import math
import zlib

import cv2
import numpy as np
import pytest
from scipy import stats
from sweep import together

from quizgen.camera import Camera, PreparedScene, Scene, View, picture_sets, simulate_question
from quizgen.camera.effects import (
    blooming,
    dark_current,
    demosaicing,
    flat_field,
    gaussian_noise,
    impulse_noise,
    mosaic,
    quantisation,
    read_noise,
    shot_noise,
    smear,
    vignetting,
)
from quizgen.camera.effects.normalisation import stretch_range
from quizgen.camera.pixels.codes import to_8bit
from quizgen.camera.pixels.hsv import edit_hsv, rgb_to_hsv
from quizgen.camera.pixels.noise import effect_random, poisson_quantiles
from quizgen.camera.pixels.tiles import apply_tilewise
from quizgen.camera.pixels.tone_curve import encode_piecewise, encode_value
from quizgen.camera.raster.rasterizer import Layer
from quizgen.camera.simulation import run_plan
from quizgen.numerics.gamma import srgb_decode
from quizgen.numerics.hsv import hsv_to_rgb


def flat(level, size=300):
    return np.full((size, size, 3), level, np.float32)


def ran(effect, image, look):
    """What an effect makes of a picture, which it leaves alone."""
    before = image.copy()
    (layer,) = effect.EFFECT.run((Layer(image),), look)
    assert np.array_equal(image, before)
    return layer.colour


def encode(light, gamma):
    return apply_tilewise(light, [encode_piecewise(gamma)])[0]


def view(**camera):
    return View(Scene(seed=7), Camera(**camera))


def chi_square(counts, mean):
    """Probability of a fit at least this bad against Poisson(mean)."""
    low, high = int(stats.poisson.ppf(1e-4, mean)), int(stats.poisson.ppf(1 - 1e-4, mean))
    inner = [(counts == value).sum() for value in range(low, high + 1)]
    seen = np.array([(counts < low).sum(), *inner, (counts > high).sum()])
    chances = stats.poisson.pmf(np.arange(low, high + 1), mean)
    expected = np.array([stats.poisson.cdf(low - 1, mean), *chances, stats.poisson.sf(high, mean)])
    possible = expected > 0
    assert seen[~possible].sum() == 0
    expected = expected[possible] / expected.sum() * seen.sum()
    return stats.chisquare(seen[possible], expected).pvalue


@pytest.mark.parametrize("electrons", [3.0, 40.0, 1000.0])
def test_shot_noise_is_poisson(electrons):
    noisy = ran(shot_noise, flat(0.5), view(full_well=2 * electrons)) * 2 * electrons
    counts = np.rint(noisy)
    assert np.abs(noisy - counts).max() < 1e-3
    assert 1e-3 < chi_square(counts, electrons) < 1 - 1e-3


@pytest.mark.parametrize("electrons", [0.2, 6.0, 300.0])
def test_dark_charge_is_poisson(electrons):
    look = view(full_well=1e4, dark_current=electrons, shutter=1.0)
    counts = np.rint(ran(dark_current, flat(0.0), look) * 1e4)
    assert 1e-3 < chi_square(counts, electrons) < 1 - 1e-3


def test_dark_electrons_that_are_few_are_put_where_the_table_has_them():
    look = view(full_well=1e4, dark_current=0.02, shutter=1.0)
    lucky = effect_random(look, "dark current").draw_from_table(np.arange(65536.0), 0, 64 * 128 * 3)
    counts = stats.poisson.ppf((lucky + 0.5) / 65536, 0.02).reshape(64, 128, 3)
    charged = ran(dark_current, np.zeros((64, 128, 3), np.float32), look) * 1e4
    assert 300 < np.count_nonzero(counts) < 700
    assert np.allclose(charged, counts, atol=1e-4)


def test_normal_noises_are_normal():
    read = ran(read_noise, flat(0.5), view(full_well=1000.0, read_noise=8.0)) - 0.5
    finished = ran(gaussian_noise, flat(0.5), view(gaussian_noise=0.02)) - 0.5
    for values, sigma in ((read, 8e-3), (finished, 0.02)):
        assert stats.kstest(values.ravel() / sigma, "norm").pvalue > 1e-3


@pytest.fixture(scope="module")
def many_normals():
    source = effect_random(view(), "read noise")
    return np.concatenate([source.draw_normal(tile, 24_576, np.float64) for tile in range(400)])


@together("deviations", [3.0, 3.5, 4.0, 4.3, 4.5])
@together("side", [-1, 1])
def test_noise_has_its_true_tail(many_normals, deviations, side):
    """As many of 9.8 million values lie beyond as the normal law says."""
    beyond = int((side * many_normals > deviations).sum())
    assert stats.binomtest(beyond, many_normals.size, stats.norm.sf(deviations)).pvalue > 1e-3


def test_single_counts_of_many_electrons_are_as_frequent_as_they_should():
    """45 000 electrons: every count that is expected 20 times, in 4.9 million."""
    source = effect_random(view(), "shot noise")
    mean = np.full(24_576, 45_000.0)
    drawn = [
        poisson_quantiles(mean, source.draw_normal(tile, 24_576, float, fine=True))
        for tile in range(200)
    ]
    counts = np.concatenate(drawn).astype(int)
    seen = np.bincount(counts - 43_000, minlength=4000)
    expected = counts.size * stats.poisson.pmf(np.arange(43_000, 43_000 + seen.size), 45_000)
    inner = expected >= 20
    apart = (seen - expected)[inner] / np.sqrt(expected[inner])
    assert stats.chi2.sf((apart**2).sum(), inner.sum()) > 1e-3
    assert np.abs(apart).max() < 5


def test_the_same_seed_gives_the_same_noise_everywhere():
    """Pinned: pieces of a Philox stream do not depend on the machine nor on other effects."""
    noise = effect_random(view(), "read noise").draw_normal(3, 1000)
    assert zlib.crc32(noise.tobytes()) == PINNED_NOISE
    scene = Scene(64, 48, background=(0.2, 0.3, 0.4), seed=11)
    noisy = Camera(full_well=5000.0, read_noise=5.0, bit_depth=12, gamma="srgb", exposure=0.5)
    assert (
        zlib.crc32(simulate_question(scene, noisy, budget=0.0).pixels().tobytes()) == PINNED_PHOTO
    )


PINNED_NOISE = 1250975989
PINNED_PHOTO = 340385804


def test_one_pass_over_the_picture_is_every_effect_alone():
    """2.2 million values: 90 pieces."""
    image = np.random.default_rng(1).random((700, 1050, 3), np.float32)
    camera = Camera(
        0.02, 5e-6, natural_vignetting=True, exposure=0.5, full_well=3000.0, dark_current=40.0,
        shutter=0.5, hot_pixels=0.01, read_noise=4.0, bit_depth=10, flat_field=True,
        white_balance=(1.2, 1.0, 1.5), gamma="srgb", hue=0.2, gaussian_noise=0.01,
        impulse_noise=0.02, normalise=(0.1, 0.9, 0.0, 1.0),
    )  # fmt: skip
    prepared = PreparedScene(Scene(1050, 700, image=image, seed=3), camera)
    stack = (Layer(image.copy()),)
    for effect in prepared.present:
        stack = effect.run(stack, prepared.view)
    assert np.array_equal(run_plan(prepared).values, stack[0].colour)
    assert np.array_equal(image, np.random.default_rng(1).random((700, 1050, 3), np.float32))


def test_streams_differ_between_effects_and_seeds():
    one = effect_random(view(), "read noise").draw_uniform(0, 4)
    assert not np.array_equal(one, effect_random(view(), "shot noise").draw_uniform(0, 4))
    assert not np.array_equal(one, effect_random(view(), "read noise").draw_uniform(1, 4))
    other = View(Scene(seed=8), Camera())
    assert not np.array_equal(one, effect_random(other, "read noise").draw_uniform(0, 4))


def test_hot_pixels_are_a_share():
    look = view(full_well=1e4, hot_pixels=0.01)
    hot = (ran(dark_current, flat(0.1), look) == 1).all(axis=2).sum()
    assert stats.binomtest(int(hot), 90_000, 0.01).pvalue > 1e-3


def test_a_picture_that_overflows_everywhere_is_even_after_blooming():
    image = np.linspace(1.75, 3.0, 5 * 4 * 3).astype(np.float32).reshape(5, 4, 3)
    assert (blooming.run(image, view()) == 1.0).all()


def test_a_coloured_lamp_blooms_white():
    """One sensor: what a red lamp spills fills the green and blue sites of its column, too."""
    image = np.zeros((61, 5, 3), np.float32)
    image[30, 2] = (31.0, 0.0, 0.0)
    spilt = blooming.run(image, view())
    assert spilt.sum() == pytest.approx(31.0, rel=1e-6)
    assert spilt[26:35, 2].min() == 1.0, "nine pixels of three sites, and the ends"


def test_blooming_keeps_the_charge_and_stays_in_the_column():
    image = np.zeros((61, 5, 3), np.float32)
    image[30, 2] = 21.0
    spilt = blooming.run(image, view())
    assert spilt.max() == 1.0
    assert spilt.sum() == pytest.approx(63.0, rel=1e-6)
    assert spilt[20:41, 2].min() == 1.0
    assert (np.delete(spilt, 2, axis=1) == 0).all()
    assert np.array_equal(spilt, spilt[::-1])


def test_smear_lifts_the_whole_column():
    image = np.zeros((100, 3, 3), np.float32)
    image[10, 1] = 50.0
    lifted = smear.run(image, view(full_well=1.0, smear=0.02))
    assert lifted[60, 1] == pytest.approx(0.02 * 50 / 100)
    assert (lifted[:, 0] == 0).all()


def test_converter_codes():
    ramp = (np.arange(9, dtype=np.float32) / 8).reshape(1, 9, 1)
    codes = ran(quantisation, ramp, view(bit_depth=2)) * 3
    assert codes.ravel().tolist() == [0, 0, 1, 1, 2, 2, 2, 3, 3]
    fine = ran(
        quantisation, np.random.default_rng(0).random((400, 400, 3), np.float32), view(bit_depth=8)
    )
    original = np.random.default_rng(0).random((400, 400, 3), np.float32)
    error = (fine - original) * 255
    assert np.abs(error).max() <= 0.5001
    assert error.std() == pytest.approx(1 / math.sqrt(12), rel=5e-3)


OPENCV_NAMES = {
    "RGGB": cv2.COLOR_BayerBG2RGB,
    "BGGR": cv2.COLOR_BayerRG2RGB,
    "GRBG": cv2.COLOR_BayerGB2RGB,
    "GBRG": cv2.COLOR_BayerGR2RGB,
}
"""OpenCV names a mosaic after its second row and column (errata E06)."""


@pytest.mark.parametrize("phase", OPENCV_NAMES)
def test_demosaicing_is_that_of_opencv(phase):
    codes = np.random.default_rng(3).integers(0, 256, (40, 52), np.uint8)
    theirs = cv2.cvtColor(codes, OPENCV_NAMES[phase])
    ours = to_8bit(demosaicing.run(codes[..., None].astype(np.float32), view(mosaic=phase)))
    assert np.array_equal(ours[1:-1, 1:-1], theirs[1:-1, 1:-1])


def test_a_red_scene_stays_red_to_the_border():
    red = np.zeros((7, 9, 3), np.float32)
    red[..., 0] = 0.8
    for phase in OPENCV_NAMES:
        look = view(mosaic=phase)
        assert np.array_equal(demosaicing.run(mosaic.run(red, look), look), red)


def test_the_notes_bayer_means():
    """Four greens 100, 120, 110, 130 make 115, and nothing wraps (W15, EC7)."""
    raw = np.zeros((5, 5, 1), np.float32)
    raw[1, 2], raw[2, 1], raw[2, 3], raw[3, 2] = 100, 120, 110, 130
    assert demosaicing.run(raw, view(mosaic="RGGB"))[2, 2, 1] == 115


def test_flat_field_of_the_notes():
    """K28 with rounding instead of truncation: 191.25 becomes 191 either way, the rest is exact."""
    image, even = np.float32([[50, 100], [255, 60]]), np.float32([[100, 200], [200, 100]])
    corrected = image * flat_field.flat_field_gains(even)
    assert corrected.tolist() == [[75.0, 75.0], [191.25, 90.0]]


def test_flat_field_undoes_vignetting():
    camera = Camera(0.02, 5e-5, natural_vignetting=True, mechanical_vignetting=0.5, flat_field=True)
    picture = simulate_question(
        Scene(64, 48, background=(0.3, 0.6, 0.9)), camera, budget=0.0
    ).values
    kept = vignetting.falloff_map(View(Scene(64, 48), camera))
    assert picture == pytest.approx(
        np.float32([0.3, 0.6, 0.9]) * kept.mean() * np.ones_like(picture), rel=1e-5
    )


@together(
    ("gamma", "linear", "encoded"),
    [
        ("srgb", 0.5, 0.7353569830524495),
        ("srgb", 0.18, 0.4613561295004417),
        ("srgb", 0.0031308, 0.040449936),
        ("srgb", 0.002, 0.02584),
        (2.2, 0.5, 0.7297400528407231),
        (2.2, 0.2, 0.4811565050522864),
        (2.2, 0.8, 0.9035454309190944),
        (1.0, 0.25, 0.25),
    ],
)
def test_tone_curves_have_their_published_values(gamma, linear, encoded):
    values = np.full((2, 2, 3), linear, np.float32)
    assert encode(values, gamma) == pytest.approx(encoded, abs=2e-6)


def test_tone_curves_everywhere():
    values = np.random.default_rng(1).random((50, 50, 3)) ** 6
    expected = np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)
    assert encode(values.astype(np.float32), "srgb") == pytest.approx(expected, abs=2e-6)
    power = encode(values.astype(np.float32), 2.2)
    assert power == pytest.approx(values ** (1 / 2.2), abs=3e-6)


def colours():
    corners = np.array(np.meshgrid(*[np.linspace(0, 1, 9)] * 3)).reshape(3, -1).T
    return np.concatenate([corners, np.random.default_rng(4).random((800, 3))])[None].astype(
        np.float32
    )


def test_hsv_against_colorsys():
    ours = rgb_to_hsv(colours())[0]
    for colour, (hue, saturation, value) in zip(colours()[0].astype(float), ours, strict=True):
        expected = colorsys.rgb_to_hsv(*colour)
        turn = abs(hue / 360 - expected[0])
        assert min(turn, 1 - turn) < 1e-5
        assert saturation == pytest.approx(expected[1], abs=2e-6)
        assert value == pytest.approx(expected[2], abs=1e-7)
    assert edit_hsv(colours()) == pytest.approx(colours(), abs=2e-6)


def test_hsv_is_that_of_the_array_functions():
    """There in single precision and back in double."""
    hue, saturation, value = rgb_to_hsv(colours())[0].astype(float).T
    assert np.stack(hsv_to_rgb(hue, saturation, value), axis=1) == pytest.approx(
        colours()[0], abs=2e-6
    )


def srgb_encode(x):
    """IEC 61966-2-1 as printed."""
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


@pytest.mark.parametrize(
    ("gamma", "reference"), [("srgb", srgb_encode), (2.2, lambda x: x ** (1 / 2.2))]
)
def test_tone_curves_are_those_of_the_standard(gamma, reference):
    values = np.random.default_rng(1).random(5000).astype(np.float32) ** 3
    exact = np.asarray(reference(values.astype(float)))
    assert np.abs(encode(values, gamma) - exact).max() < 3e-7
    assert [encode_value(float(x), gamma) for x in values[:50]] == pytest.approx(
        exact[:50], abs=1e-15
    )


def test_srgb_is_decoded_as_it_is_encoded():
    codes = np.arange(256) / 255
    light = np.asarray(srgb_decode(codes))
    assert [encode_value(float(x), "srgb") for x in light] == pytest.approx(codes, abs=1e-7)


def test_hsv_edits_of_the_notes():
    """(0.2, 0.8, 0.4) is 140 deg; +120 deg swaps to (0.4, 0.2, 0.8); S x 0.2 is (0.68, 0.8, 0.72)."""
    colour = np.float32([[[0.2, 0.8, 0.4]]])
    assert rgb_to_hsv(colour)[0, 0] == pytest.approx([140, 0.75, 0.8], abs=1e-4)
    _, darker, paler, turned = (
        edit[0, 0] for edit in picture_sets.make_hsv_edits(colour, 0.5, 0.2, 120.0)
    )
    assert darker == pytest.approx([0.1, 0.4, 0.2], abs=1e-6)
    assert paler == pytest.approx([0.68, 0.8, 0.72], abs=1e-6)
    assert turned == pytest.approx([0.4, 0.2, 0.8], abs=1e-6)


def test_clipped_noise_lifts_black():
    """0.399 sigma (errata E39): 5.09 grey levels at sigma = 0.05."""
    lifted = ran(gaussian_noise, flat(0.0, 600), view(gaussian_noise=0.05)).mean() * 255
    assert lifted == pytest.approx(5.09, abs=0.02)


def test_salt_and_pepper_come_in_halves():
    _, _, spotted = picture_sets.make_noisy(flat(0.5), 0.08, 0.08, seed=6)
    black, white = (spotted == 0).all(axis=2).sum(), (spotted == 1).all(axis=2).sum()
    for count in (black, white):
        assert stats.binomtest(int(count), 90_000, 0.04).pvalue > 1e-3
    with pytest.raises(ValueError, match="share"):
        impulse_noise.add_impulses(1.5, effect_random(view(), "impulse noise"))


def test_normalisation_of_the_notes():
    values = np.float32([128, 125, 0.51, 160]) / 255
    look = stretch_range(values, 50 / 255, 200 / 255)
    assert look == pytest.approx([0.52, 0.5, 0.0, 110 / 150], abs=1e-6)
    after, before_counts, after_counts = picture_sets.make_normalised(flat(0.5), 0.25, 0.45)
    assert (after == 1).all()
    assert before_counts.sum() == after_counts.sum() == after_counts[-1]
