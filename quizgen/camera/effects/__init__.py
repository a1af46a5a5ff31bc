"""The table of effects in physical order: light, lens, motion, sensor, raw development, edits.

Adding an effect is one function and one row. Vignetting stands after motion because the lens
stands still: a fixed factor per pixel can be taken out of the integral over the exposure.
"""

from __future__ import annotations

import math

from quizgen.camera.effects import (
    isp,
    isp_bounds,
    optics,
    optics_bounds,
    sensor,
    sensor_bounds,
)
from quizgen.camera.effects.base import Effect, Rung, no_bound
from quizgen.camera.scene import View


def _moves(view: View) -> bool:
    things = view.scene.things
    return any(view.camera.velocity) or any(
        thing.spin or any(part.value for part in thing.velocity) for thing in things
    )


def _vignettes(view: View) -> bool:
    return view.camera.natural_vignetting or view.camera.mechanical_vignetting > 0.0


def _edits_hsv(view: View) -> bool:
    camera = view.camera
    return (math.fmod(camera.hue, 2 * math.pi), camera.saturation, camera.value) != (0.0, 1.0, 1.0)


_GEOMETRY = ("geometry", "artefacts")
_NOISE = ("noise", "snr", "histogram")

EFFECTS: tuple[Effect, ...] = (
    Effect(
        "projection",
        "scene",
        ("projection", *_GEOMETRY),
        lambda view: view.scene.metric,
        optics.projection,
    ),
    Effect(
        "distortion",
        "optics",
        ("distortion", *_GEOMETRY),
        lambda view: view.camera.k1 != 0.0 or view.camera.k2 != 0.0,
        optics.distortion,
        optics_bounds.distortion_skipped,
        after=optics_bounds.distortion_after,
        cheaper=(Rung("nearest", optics_bounds.distortion_nearest),),
    ),
    Effect(
        "lateral colour",
        "optics",
        ("lateral colour", "artefacts"),
        lambda view: view.camera.lateral_colour != 0.0,
        optics.lateral_colour,
        optics_bounds.lateral_skipped,
        after=optics_bounds.lateral_after,
    ),
    Effect(
        "defocus",
        "optics",
        ("defocus", "depth of field", "aperture", "artefacts"),
        lambda view: view.camera.f_number is not None,
        optics.defocus,
        optics_bounds.defocus_skipped,
        after=optics_bounds.defocus_after,
        cheaper=(
            Rung("half", optics_bounds.defocus_half),
            Rung("quarter", optics_bounds.defocus_quarter),
        ),
    ),
    Effect(
        "motion blur",
        "optics",
        ("motion blur", "motion", "artefacts"),
        lambda view: view.camera.shutter > 0.0 and _moves(view),
        optics.motion_blur,
        optics_bounds.motion_skipped,
        after=optics_bounds.motion_after,
        cheaper=(Rung("half", optics_bounds.motion_half),),
    ),
    Effect(
        "rolling shutter",
        "optics",
        ("rolling shutter", "motion", "artefacts"),
        lambda view: view.camera.row_time > 0.0 and _moves(view),
        optics.rolling_shutter,
        optics_bounds.rolling_skipped,
        after=optics_bounds.rolling_after,
    ),
    Effect(
        "vignetting",
        "sensor",
        ("vignetting", "artefacts"),
        _vignettes,
        sensor.vignetting,
        sensor_bounds.vignetting_skipped,
        after=sensor_bounds.vignetting_after,
    ),
    Effect(
        "exposure",
        "sensor",
        ("exposure",),
        lambda view: view.camera.exposure != 0.0,
        sensor.exposure,
        sensor_bounds.exposure_skipped,
        sensor_bounds.exposure_carried,
        sensor_bounds.exposure_after,
    ),
    Effect(
        "shot noise",
        "sensor",
        ("shot noise", *_NOISE),
        lambda view: view.camera.full_well is not None and view.camera.shot_noise,
        sensor.shot_noise,
        sensor_bounds.shot_skipped,
        sensor_bounds.shot_carried,
        sensor_bounds.shot_after,
        (Rung("gaussian", sensor_bounds.shot_gaussian),),
    ),
    Effect(
        "dark current",
        "sensor",
        ("dark current", "hot pixels", *_NOISE),
        lambda view: sensor.dark_electrons(view) > 0.0 or view.camera.hot_pixels > 0.0,
        sensor.dark_current,
        sensor_bounds.dark_skipped,
        after=sensor_bounds.dark_after,
    ),
    Effect(
        "blooming",
        "sensor",
        ("blooming", "saturation", "artefacts"),
        lambda view: view.camera.blooming,
        sensor.blooming,
        sensor_bounds.blooming_skipped,
        sensor_bounds.blooming_carried,
        sensor_bounds.blooming_after,
    ),
    Effect(
        "streak",
        "sensor",
        ("streak", "saturation", "artefacts"),
        lambda view: view.camera.smear > 0.0,
        sensor.smear,
        sensor_bounds.smear_skipped,
        sensor_bounds.smear_carried,
        sensor_bounds.smear_after,
    ),
    Effect(
        "full well",
        "sensor",
        ("clipping", "saturation", "dynamic range"),
        lambda view: view.camera.full_well is not None,
        sensor.full_well,
        sensor_bounds.full_well_skipped,
        after=sensor_bounds.full_well_after,
    ),
    Effect(
        "read noise",
        "sensor",
        ("read noise", "dynamic range", *_NOISE),
        lambda view: view.camera.read_noise > 0.0,
        sensor.read_noise,
        sensor_bounds.read_skipped,
        after=sensor_bounds.read_after,
    ),
    Effect(
        "mosaic",
        "sensor",
        ("bayer", "demosaicing", "moire"),
        lambda view: view.camera.mosaic != "",
        sensor.mosaic,
        no_bound,
        pair="bayer",
    ),
    Effect(
        "quantisation",
        "sensor",
        ("quantisation", "bit depth"),
        lambda view: view.camera.bit_depth is not None,
        sensor.quantise,
        sensor_bounds.quantise_skipped,
        sensor_bounds.quantise_carried,
        sensor_bounds.quantise_after,
    ),
    Effect(
        "demosaicing",
        "processing",
        ("bayer", "demosaicing", "moire"),
        lambda view: view.camera.mosaic != "",
        isp.demosaic,
        sensor_bounds.demosaic_skipped,
        after=sensor_bounds.demosaic_after,
        pair="bayer",
    ),
    Effect(
        "flat field",
        "processing",
        ("flat field", "vignetting"),
        lambda view: view.camera.flat_field and _vignettes(view),
        isp.flat_field,
        isp_bounds.flat_skipped,
        isp_bounds.flat_carried,
        isp_bounds.flat_after,
    ),
    Effect(
        "white balance",
        "processing",
        ("white balance",),
        lambda view: view.camera.white_balance != (1.0, 1.0, 1.0),
        isp.white_balance,
        isp_bounds.balance_skipped,
        isp_bounds.balance_carried,
        isp_bounds.balance_after,
    ),
    Effect(
        "gamma",
        "processing",
        ("gamma",),
        lambda view: view.camera.gamma not in ("linear", 1.0),
        isp.gamma,
        isp_bounds.gamma_skipped,
        isp_bounds.gamma_carried,
        isp_bounds.gamma_after,
        (Rung("table", isp_bounds.gamma_table),),
    ),
    Effect(
        "hsv edit",
        "edit",
        ("hsv", "hue", "saturation edit"),
        _edits_hsv,
        isp.hsv_edit,
        isp_bounds.hsv_skipped,
        isp_bounds.hsv_carried,
        isp_bounds.hsv_after,
    ),
    Effect(
        "gaussian noise",
        "edit",
        ("gaussian noise", *_NOISE),
        lambda view: view.camera.gaussian_noise > 0.0,
        isp.gaussian_noise,
        isp_bounds.gaussian_skipped,
        after=isp_bounds.gaussian_after,
    ),
    Effect(
        "impulse noise",
        "edit",
        ("impulse noise", *_NOISE),
        lambda view: view.camera.impulse_noise > 0.0,
        isp.impulse_noise,
        isp_bounds.impulse_skipped,
        after=isp_bounds.impulse_after,
    ),
    Effect(
        "normalisation",
        "edit",
        ("normalisation", "contrast"),
        lambda view: view.camera.normalise is not None,
        isp.normalise,
        isp_bounds.normalise_skipped,
        isp_bounds.normalise_carried,
        isp_bounds.normalise_after,
    ),
)
"""Every effect in the order of the light's way."""

QUESTIONS = tuple(sorted({kind for effect in EFFECTS for kind in effect.decides}))
"""Kinds of question that effects decide."""
