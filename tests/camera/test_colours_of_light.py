"""Axial colour and colour filters: against exact fractions, SciPy and colour-science."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy import constants, ndimage
from sweep import together

from quizgen.camera import Camera, PreparedScene, Scene, SceneError, View
from quizgen.camera.effects import axial_colour, colour_filters
from quizgen.camera.pixels.kernels import disc_kernel, moved_share
from quizgen.camera.raster.rasterizer import Layer
from quizgen.camera.scene_file import load_scene
from quizgen.camera.simulation import run_plan

LENS = {"focal_length": 0.05, "pixel_pitch": 5e-6, "f_number": 2.0, "focus_distance": 2.0}


def scene(depth, size=(60, 70), seed=1):
    image = np.random.default_rng(seed).random((*size, 3), np.float32)
    return Scene(size[1], size[0], image=image, depth=depth)


def photo(what, **settings):
    prepared = PreparedScene(what, Camera(**settings))
    return run_plan(prepared).values


# Axial colour


def diameters(f, number, s, z, between, pitch):
    """Signed circles of red, green and blue, px: A (v - v')/v' with v' = f' z/(z - f')."""
    f, s, z, between = (Fraction(x) for x in (f, s, z, between))
    sensor, hole = f * s / (s - f), f / Fraction(number)
    images = [own * z / (z - own) for own in (f + between / 2, f, f - between / 2)]
    return [float(hole * (sensor - image) / image / Fraction(pitch)) for image in images]


@pytest.mark.parametrize(
    ("f", "number", "s", "z", "between"),
    [(50, 2, 2000, 5000, "0.2"), (35, 4, 900, 700, "-0.1"), (85, 8, 10000, 10000, "0.5")],
)
def test_circles_of_each_colour_from_image_distances(f, number, s, z, between):
    view = View(
        Scene(), Camera(f / 1000, 5e-6, number, s / 1000, axial_colour=float(between) / 1000)
    )
    red, green, blue = diameters(f, number, s, z, between, "0.005")
    middle, shift = view.blur_diameter(z / 1000), axial_colour.blur_shifts(view)
    assert middle == pytest.approx(green, rel=1e-9, abs=1e-9)
    assert middle + shift[0] == pytest.approx(red, rel=1e-9)
    assert middle + shift[2] == pytest.approx(blue, rel=1e-9)


def test_each_colour_is_blurred_by_its_own_disc_as_by_scipy():
    what = scene(5.0)
    made = photo(what, **LENS, axial_colour=1e-4)
    sizes = diameters(50, 2, 2000, 5000, "0.1", "0.005")
    assert max(sizes) - min(sizes) > 5
    for channel, size in enumerate(sizes):
        expected = ndimage.convolve(
            what.image[..., channel].astype(float), disc_kernel(size), mode="nearest"
        )
        assert made[..., channel] == pytest.approx(expected, abs=3e-5), channel


def test_in_focus_green_alone_is_sharp():
    what = scene(2.0)
    made = photo(what, **LENS, axial_colour=1e-4)
    assert made[..., 1] == pytest.approx(what.image[..., 1], abs=1e-6)
    assert np.abs(made[..., 0] - what.image[..., 0]).max() > 0.1


def test_without_it_or_left_out_all_colours_are_blurred_as_green_is():
    what = scene(5.0)
    plain = photo(what, **LENS)
    prepared = PreparedScene(what, Camera(**LENS, axial_colour=1e-4))
    assert np.array_equal(run_plan(prepared, ["defocus"]).values, plain)


def test_a_map_of_one_depth_is_as_that_depth():
    near = scene(3.0)
    mapped = replace(near, depth=np.full((60, 70), 3.0, np.float32))
    alone, sliced = (photo(one, **LENS, axial_colour=4e-5) for one in (near, mapped))
    step = 0.5  # slices are half a pixel of blur apart at most
    assert np.abs(alone - sliced).max() < step / 2 * 0.2


def test_covers_part_with_the_colours():
    """A white square on black: what each colour covers is what it shows."""
    cover = np.zeros((40, 40, 1), np.float32)
    cover[15:25, 15:25] = 1.0
    view = View(Scene(40, 40), Camera(**LENS, axial_colour=1e-4))
    layer = Layer(cover.repeat(3, axis=2), cover, depth=5.0)
    made = axial_colour.operation(layer, view)
    assert made.cover is not None
    assert made.cover == pytest.approx(made.colour, abs=2e-6)
    assert made.sharp == (1,)
    assert not np.array_equal(made.cover[..., 0], made.cover[..., 2])


def test_an_edge_is_moved_by_no_more_than_the_light_is():
    assert moved_share(disc_kernel(7.3), disc_kernel(7.3)) == 0.0
    edge = np.where(np.arange(80)[None, :] < 40, 0.0, 1.0) * np.ones((40, 1))
    for sizes in ((9.0, 12.0), (0.0, 3.0)):
        one, other = (ndimage.convolve(edge, disc_kernel(size), mode="nearest") for size in sizes)
        bound = moved_share(*map(disc_kernel, sizes))
        assert 0.1 * bound < np.abs(one - other).max() <= bound <= 1.0


def test_a_point_has_no_focus(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('[camera]\nfocal_length = "50 mm"\npixel_pitch = "5 um"\naxial_colour = "1 mm"')
    with pytest.raises(SceneError, match=r"s\.toml:4: axial_colour needs f_number"):
        load_scene(path)
    with pytest.raises(SceneError, match="must not exceed focal_length"):
        Camera(**LENS, axial_colour=0.06)


# Colour filters


def straight(x, *points):
    at, values = zip(*points, strict=True)
    return np.interp(x, at, values)


def reference(temperature, *, filtered):
    """The table of docs/camera.md with colour-science's Planck and V(lambda), in steps of 0.1 nm."""
    import colour  # two seconds of each process that only looks which tests there are

    nm = np.arange(380.0, 1100.05, 0.1)
    curve = colour.colorimetry.SDS_LEFS_PHOTOPIC["CIE 1924 Photopic Standard Observer"]
    eye = straight(nm, *zip(curve.wavelengths, curve.values, strict=True))
    eye[nm > 830] = 0.0

    def lamp(kelvin):
        x = constants.h * constants.c / (constants.k * nm * 1e-9 * kelvin)
        power = nm**-5 / (np.exp(x) - 1)
        return power / (power * eye).sum()

    def dye(centre, width, opens):
        bell = np.exp(-((nm - centre) ** 2) / (2 * width**2))
        return np.maximum(bell, straight(nm, (opens, 0), (opens + 120, 1)))

    sites = [straight(nm, (570, 0), (610, 1)), dye(535, 40, 690), dye(455, 35, 720)]
    closed = straight(nm, (630, 1), (680, 0))
    photons = nm * straight(nm, (650, 1), (1100, 0))
    bands = [
        straight(nm, (535, 0), (610, 1)),
        straight(nm, (455, 0), (535, 1), (610, 0)),
        straight(nm, (455, 1), (535, 0)),
    ]
    rows = []
    for site in sites:
        white = (lamp(5500) * site * closed * photons).sum()
        through = lamp(temperature) * site * photons * (closed if filtered else 1)
        rows.append([(through * band).sum() / white for band in bands])
    return np.array(rows)


@together("temperature", [2000.0, 2856.0, 5500.0, 12000.0])
@together("filtered", [True, False])
def test_sites_see_what_the_integral_says(temperature, filtered):
    made = colour_filters.mixing_matrix(temperature, infrared_filter=filtered)
    assert made == pytest.approx(reference(temperature, filtered=filtered), rel=3e-3, abs=1e-4)


def test_plancks_law_is_that_of_colour_science():
    import colour

    nm = np.array([450.0, 560.0, 900.0])
    theirs = colour.colorimetry.planck_law(nm * 1e-9, 2856.0)
    ours = colour_filters.lamp_spectrum(2856.0)[(nm - 380).astype(int)]
    assert ours / ours[1] == pytest.approx(theirs / theirs[1], rel=1e-4)


def test_white_is_white_in_daylight_and_orange_by_a_lamp():
    white = scene(math.inf)
    white.image[...] = 1.0
    assert photo(white, light=5500.0) == pytest.approx(np.ones((60, 70, 3)), abs=1e-6)
    red, green, blue = photo(white, light=2856.0)[0, 0].tolist()
    assert red > green > blue
    bare = photo(white, light=2856.0, infrared_filter=False)[0, 0]
    assert bare[0] > 5 * red
    assert bare[2] > bare[1]  # what blue sites see is mostly infrared


def test_every_pixel_is_mixed_by_the_table():
    what = scene(math.inf)
    made = photo(what, light=3200.0, infrared_filter=False)
    assert made == pytest.approx(what.image @ reference(3200.0, filtered=False).T, rel=4e-3)


def test_a_filter_without_a_light_is_told():
    from quizgen.camera.effects import ineffective_settings

    view = View(Scene(), Camera(infrared_filter=False))
    assert ineffective_settings(view) == {"infrared_filter": "light"}


def test_a_colour_temperature_has_its_unit(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('[camera]\nlight = "2856 nm"')
    with pytest.raises(SceneError, match=r"s\.toml:2: light: expected a colour temperature"):
        load_scene(path)
    path.write_text('[camera]\nlight = "2856 K"')
    assert load_scene(path)[1].given == {"light": 2856.0}
