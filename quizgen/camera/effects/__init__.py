"""The table of effects in physical order: light, lens, motion, sensor, raw development, edits.

In: layers and a view of them. Out: layers, and bounds on what each effect can change. Must never
know: the budget, the plan.

Adding an effect is one module with an ``EFFECT``, and its import and its line here.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType

from quizgen.camera.effect import Effect
from quizgen.camera.effects import (
    axial_colour,
    binning,
    blooming,
    colour_filters,
    dark_current,
    dark_frame,
    defocus,
    demosaicing,
    diffraction,
    distortion,
    exposure,
    fixed_pattern,
    flare,
    flat_field,
    full_well,
    gain,
    gamma,
    gaussian_noise,
    hsv_edit,
    impulse_noise,
    lateral_colour,
    mosaic,
    motion_blur,
    normalisation,
    projection,
    quantisation,
    read_noise,
    rolling_shutter,
    shot_noise,
    smear,
    vignetting,
    white_balance,
)
from quizgen.camera.setup.settings import BODY, VELOCITY, AnySetting
from quizgen.camera.setup.view import View

EFFECTS: tuple[Effect, ...] = (
    projection.EFFECT,
    distortion.EFFECT,
    lateral_colour.EFFECT,
    axial_colour.EFFECT,
    defocus.EFFECT,
    diffraction.EFFECT,
    motion_blur.EFFECT,
    rolling_shutter.EFFECT,
    vignetting.EFFECT,
    flare.EFFECT,
    colour_filters.EFFECT,
    exposure.EFFECT,
    shot_noise.EFFECT,
    dark_current.EFFECT,
    blooming.EFFECT,
    smear.EFFECT,
    full_well.EFFECT,
    fixed_pattern.EFFECT,
    read_noise.EFFECT,
    gain.EFFECT,
    mosaic.EFFECT,
    quantisation.EFFECT,
    dark_frame.EFFECT,
    demosaicing.EFFECT,
    flat_field.EFFECT,
    white_balance.EFFECT,
    binning.EFFECT,
    gamma.EFFECT,
    hsv_edit.EFFECT,
    gaussian_noise.EFFECT,
    impulse_noise.EFFECT,
    normalisation.EFFECT,
)
"""Every effect in the order of the light's way."""


def present_effects(view: View) -> tuple[Effect, ...]:
    """Return the effects that a camera has, in physical order: from lens to file."""
    return tuple(effect for effect in EFFECTS if effect.is_present(view))


def ineffective_settings(view: View) -> dict[str, str]:
    """Return the settings that are given and do nothing, each with what it needs."""
    absent = [effect for effect in EFFECTS if effect.needs and not effect.is_present(view)]
    found = {setting.name: effect.needs for effect in absent for setting in effect.settings}
    if not (motion_blur.EFFECT.is_present(view) or rolling_shutter.EFFECT.is_present(view)):
        found[VELOCITY.name] = "shutter or row_time"
    return {name: found[name] for name in view.camera.given if name in found}


def get_effect(name: str) -> Effect:
    """Return the effect of a name, which must exist."""
    return next(effect for effect in EFFECTS if effect.name == name)


def question_kinds() -> tuple[str, ...]:
    """Return the kinds of question that some effect answers."""
    return tuple(sorted({kind for effect in EFFECTS for kind in effect.answers}))


@cache
def all_settings() -> Mapping[str, AnySetting]:
    """Return every setting of ``[camera]`` by its key: the body's and the effects'."""
    found = (*BODY, *(setting for effect in EFFECTS for setting in effect.settings))
    return MappingProxyType({setting.name: setting for setting in found})
