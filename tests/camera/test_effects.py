"""The table of effects: one name everywhere, and bounds and limits that no other test pins."""

import math
from importlib import import_module
from pathlib import Path

import numpy as np
from sweep import together

from quizgen.camera import Camera, Scene, View, effects
from quizgen.camera.effects import EFFECTS, distortion, motion_blur
from quizgen.camera.raster.rasterizer import Layer, Motion
from quizgen.camera.setup.settings import BODY

NAMES = [effect.name for effect in EFFECTS]


@together("effect", EFFECTS)
def test_an_effect_is_called_as_its_module(effect):
    module = import_module(f"quizgen.camera.effects.{effect.name.replace(' ', '_')}")
    assert module.EFFECT is effect


def test_every_module_stands_in_the_table_once():
    modules = {path.stem for path in Path(effects.__file__).parent.glob("*.py")} - {
        "__init__",
        "effect",
    }
    assert sorted(modules) == sorted(name.replace(" ", "_") for name in NAMES)


def test_every_setting_belongs_to_one_effect_or_the_body():
    named = [setting.name for setting in BODY]
    named += [setting.name for effect in EFFECTS for setting in effect.settings]
    assert len(named) == len(set(named)) == len(effects.all_settings())


@together("setting", effects.all_settings().values())
def test_the_identity_calls_for_nothing_and_breaks_no_rule(setting):
    look = View(Scene(), Camera(**{setting.name: setting.identity}))
    assert effects.present_effects(look) == ()
    assert list(setting.find_faults(look.camera)) == []


def test_a_camera_is_its_values():
    plain, bent = Camera(0.05, 5e-6), Camera(0.05, 5e-6, k1=-0.2)
    assert plain == Camera(focal_length=0.05, pixel_pitch=5e-6, k1=0.0, gamma="linear")
    assert hash(plain) == hash(Camera(0.05, 5e-6, saturation=1.0))
    assert plain.replace(k1=-0.2) == bent != plain
    assert bent.replace(k1=0.0) == plain
    assert repr(bent) == "Camera(focal_length=0.05, pixel_pitch=5e-06, k1=-0.2)"
    assert bent[distortion.K1] == -0.2
    assert plain[distortion.K1] == 0.0


def test_a_turning_layer_is_sampled_once_per_pixel_at_its_rim():
    """2 rad in the exposure at a rim of 30 px: 60 px, 60 positions; longer paths stop at 64."""
    shutter = 0.1
    assert motion_blur.rotation_samples(Motion(spin=20.0, reach=30.0), shutter) == 60
    assert motion_blur.rotation_samples(Motion(spin=-200.0, reach=30.0), shutter) == 64
    assert motion_blur.rotation_samples(Motion(spin=1e-6, reach=30.0), shutter) == 1


def test_a_turning_spot_becomes_an_arc_without_gaps():
    """A spot 25 px from the pivot sweeps 60 px: the arc is lit evenly, as its mean says."""
    size, radius, angle = 81, 25.0, 2.4
    image = np.zeros((size, size, 3), np.float32)
    image[40, 65] = 1.0
    layer = Layer(
        image, image[..., :1], motion=Motion(spin=angle / 0.1, pivot=(40.0, 40.0), reach=27.0)
    )
    view = View(Scene(size, size), Camera(shutter=0.1))
    (blurred,) = motion_blur.EFFECT.run((layer,), view)
    along = np.linspace(-angle / 2 + 0.1, angle / 2 - 0.1, 200)
    near = [
        blurred.colour[
            round(40 + radius * math.sin(turn)) - 1 : round(40 + radius * math.sin(turn)) + 2,
            round(40 + radius * math.cos(turn)) - 1 : round(40 + radius * math.cos(turn)) + 2,
            0,
        ].sum()
        for turn in along
    ]
    assert min(near) > 0.4 * float(np.mean(near))


@together("effect", EFFECTS)
def test_an_effect_says_what_it_does_with_the_verb_first(effect):
    if effect.size is not None:
        assert effect.size.says.split()[0] in VERBS
        assert "{" in effect.size.says


VERBS = {
    "add",
    "amplify",
    "blur",
    "brighten",
    "darken",
    "leave",
    "make",
    "move",
    "smear",
    "spread",
    "turn",
}


def test_what_an_effect_needs_is_an_effect():
    for effect in EFFECTS:
        assert set(effect.needs_effects) <= set(NAMES)
