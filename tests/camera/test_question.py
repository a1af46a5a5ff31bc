"""A photograph for a question shows what is asked, and nothing else decides what is read off it."""

import numpy as np
import pytest

from quizgen.camera import (
    Camera,
    Length,
    PreparedScene,
    Scene,
    SceneObject,
    question_photo,
    run_plan,
)
from quizgen.camera.effects import EFFECTS
from quizgen.camera.planner import EffectSelection
from quizgen.camera.question_photo import (
    InvisibleEffectError,
    MovedReadingError,
    check_visible,
    measure_visibility,
    photograph_question,
    take_question_photo,
)
from quizgen.camera.setup.scene import PictureQuestion, Reading

LENS = {"focal_length": 18e-3, "pixel_pitch": 250e-6}
DARK_CORNERS = Camera(**LENS, natural_vignetting=True, gamma="srgb")
WALL = Scene(144, 96, background=(0.55, 0.55, 0.55))


def grid(cell=12.0, colour=(0.0, 0.0, 0.0)):
    lines = SceneObject("grid", cell=Length(cell), stroke=Length(2.0), colour=colour)
    return Scene(144, 96, (lines,), (0.9, 0.9, 0.9))


def test_what_is_asked_runs_with_what_a_picture_needs():
    camera = DARK_CORNERS.replace(full_well=2e4, read_noise=20.0, k1=-0.1)
    taken = photograph_question(WALL, camera, "vignetting")
    assert taken.plan.names == ("vignetting", "gamma")
    assert taken.plan.asked == ("vignetting",)
    assert {one.effect: one.why for one in taken.plan.left_out}["distortion"] == "not asked"
    assert taken.without.values[0, 0] == pytest.approx(taken.without.values[48, 72])
    assert taken.photo.values[0, 0, 0] < taken.without.values[0, 0, 0] - 0.1


def test_without_what_is_asked_the_picture_is_as_if_the_camera_had_not_got_it():
    taken = photograph_question(grid(), Camera(**LENS, k1=-0.05, gamma="srgb"), "distortion")
    ideal = run_plan(PreparedScene(grid(), Camera(gamma="srgb")))
    assert np.array_equal(taken.without.values, ideal.values)


def test_a_flat_field_runs_with_the_vignetting_that_it_divides_out():
    taken = take_question_photo(WALL, DARK_CORNERS.replace(flat_field=True), "flat field")
    assert taken.plan.names == ("vignetting", "flat field", "gamma")
    assert np.ptp(taken.photo.values) < 1e-3 < np.ptp(taken.without.values)


@pytest.mark.parametrize(
    ("scene", "camera", "asks", "why"),
    [
        (grid(), Camera(**LENS, k1=-1e-4), "distortion", "moves points by up to 0.0"),
        (WALL, Camera(**LENS, k1=-0.05), "distortion", "changes no pixel by more than 0"),
        (WALL, Camera(full_well=1e6), "shot noise", "spreads grey levels by 0.19"),
        (WALL, Camera(full_well=1e4, blooming=True), "blooming", "changes no pixel by more than 0"),
        (grid(), Camera(lateral_colour=0.2), "lateral colour", "1 would be seen"),
    ],
)
def test_what_cannot_be_seen_is_an_error_that_says_by_how_much(scene, camera, asks, why):
    with pytest.raises(InvisibleEffectError, match=f"^{asks} cannot be seen: .*{why}"):
        photograph_question(scene, camera, asks)


def test_hot_pixels_are_seen_without_a_dark_current():
    """A share of 0.4 % of the photosites: about 55 of them."""
    camera = Camera(full_well=1e4, hot_pixels=0.004, shot_noise=False, gamma="srgb")
    (seen,) = photograph_question(WALL, camera, "hot pixels").seen
    assert 30 < seen.specks < 85
    assert seen.says == ()


def test_every_kind_that_is_asked_must_be_seen():
    camera = Camera(full_well=300.0, read_noise=1e-3)
    photograph_question(WALL, camera, "shot noise")
    with pytest.raises(InvisibleEffectError, match="read noise"):
        photograph_question(WALL, camera, ("shot noise", "read noise"))


def test_red_on_a_green_as_bright_is_lost_in_a_greyscale_print():
    """0.3 R + 0.59 G + 0.11 B of codes, by hand: 59 for (197, 0, 0), as for (0, 100, 0)."""
    plain, shown = np.zeros((96, 144, 3), np.uint8), np.zeros((96, 144, 3), np.uint8)
    plain[..., 1], shown[..., 1] = 100, 100
    shown[20:40, 20:40] = (197, 0, 0)
    seen = measure_visibility(shown, plain, "hue")
    assert seen.is_visible
    assert seen.needs_colour
    assert seen.grey.levels == pytest.approx(0.1, abs=1e-4)
    check_visible(seen)
    with pytest.raises(InvisibleEffectError, match="hue cannot be seen in grey"):
        check_visible(seen, grey=True)


def test_differences_are_counted_where_they_are_seen():
    """400 of 13 824 pixels differ by 20 levels, 10 others by 7, which nobody sees."""
    plain = np.full((96, 144), 100, np.uint8)
    shown = plain.copy()
    shown[:20, :20] = 120
    shown[50, :10] = 107
    seen = measure_visibility(shown, plain)
    assert seen.share == pytest.approx(400 / 13_824)
    assert seen.mean == 20.0
    assert seen.levels == 20.0
    assert seen.spread == pytest.approx(np.sqrt((400 * 20**2 + 10 * 7**2) / 13_824))
    assert not seen.needs_colour


def test_a_few_hot_pixels_are_seen_though_they_spread_nothing():
    plain = np.zeros((96, 144, 3), np.uint8)
    shown = plain.copy()
    shown[[5, 20, 50, 80], [3, 100, 70, 20]] = 255
    assert measure_visibility(shown, plain, speckles=True).is_visible
    shown[5, 3] = 0
    assert not measure_visibility(shown, plain, speckles=False).is_visible


# What is read off


def corner(tolerance, value=None):
    return {"corner": Reading("corner", tolerance, value)}


def test_what_is_read_off_is_told():
    taken = photograph_question(WALL, DARK_CORNERS, "vignetting", corner(2.0))
    light = 0.55 / (1 + (np.hypot(67.5, 45) / 72) ** 2) ** 2  # in the middle of the corner patch
    told = 255 * (1.055 * light ** (1 / 2.4) - 0.055)
    assert taken.readings["corner"] == pytest.approx(told, abs=1.0)


def test_the_key_must_be_what_is_read_off():
    with pytest.raises(MovedReadingError, match=r"corner is read as \d+\.?\d*, not as 30 ± 2"):
        photograph_question(WALL, DARK_CORNERS, "vignetting", corner(2.0, 30.0))


def test_an_effect_without_which_the_key_is_wrong_runs():
    """Stray light of 20 % makes the corner brighter: a key that counts with it calls for it."""
    camera = DARK_CORNERS.replace(flare=0.2, k1=-0.05)
    alone = photograph_question(WALL, camera, "vignetting", corner(1.0)).readings["corner"]
    both = run_plan(PreparedScene(WALL, camera.replace(k1=0.0)))
    key = question_photo.read_value(both.values, Reading("corner", 1.0))
    assert key > alone + 5
    taken = photograph_question(WALL, camera, "vignetting", corner(1.0, key))
    assert taken.plan.names == ("vignetting", "flare", "gamma")


def test_what_runs_besides_may_not_move_what_is_read():
    camera = DARK_CORNERS.replace(flare=0.2)
    besides = EffectSelection(plus=("flare",))
    photograph_question(WALL, camera, "vignetting", corner(60.0), chosen=besides)
    with pytest.raises(MovedReadingError, match=r"flare moves corner by .*, more than 2"):
        photograph_question(WALL, camera, "vignetting", corner(2.0), chosen=besides)


def test_a_function_reads_what_has_no_name():
    row = {"line": Reading(lambda levels: float(levels[48, :, 0].argmin()), 0.5)}
    taken = photograph_question(
        grid(cell=60.0), Camera(**LENS, k1=-0.05, gamma="srgb"), "distortion", row
    )
    assert taken.readings["line"] == pytest.approx(11, abs=8)


# Costs


def test_the_scene_brings_its_own_question():
    scene = Scene(144, 96, background=(0.5, 0.5, 0.5), question=PictureQuestion(("vignetting",)))
    assert photograph_question(scene, DARK_CORNERS).plan.asked == ("vignetting",)


def test_pictures_of_drawn_scenes_are_kept():
    """By what is in the scene, not by which object it is."""
    first, again = (photograph_question(grid(), Camera(**LENS, k1=-0.06), "geometry") for _ in "ab")
    assert first is again
    other = photograph_question(grid(11.0), Camera(**LENS, k1=-0.06), "geometry")
    assert other is not first


def test_no_more_pictures_are_kept_than_said():
    for step in range(question_photo._MOST_KEPT + 3):
        photograph_question(grid(8.0 + step), Camera(lateral_colour=3.0), "lateral colour")
    assert len(question_photo._KEPT) == question_photo._MOST_KEPT


def test_every_effect_that_has_a_least_size_says_what_it_is():
    for effect in EFFECTS:
        if effect.size is not None and effect.size.least:
            assert effect.size.says, effect.name
