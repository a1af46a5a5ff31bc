"""HSV edit: hue turned, saturation and value scaled."""

from __future__ import annotations

import math

from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.pixels.hsv import hsv_operation
from quizgen.camera.pixels.tiles import TileOperation
from quizgen.camera.pixels.tone_curve import CURVE_ERROR
from quizgen.camera.setup.settings import NOT_NEGATIVE, Setting
from quizgen.camera.setup.value_parsers import parse_plain_number, quantity_parser
from quizgen.camera.setup.view import Signal, View

HUE = Setting("hue", quantity_parser("deg"), 0.0)
"""rad added."""
SATURATION = Setting("saturation", parse_plain_number, 1.0, (NOT_NEGATIVE,))
VALUE = Setting("value", parse_plain_number, 1.0, (NOT_NEGATIVE,))


def _normalised_hue(view: View) -> float:
    """Return the camera's hue turn in rad without whole turns, which change nothing."""
    return math.fmod(view.camera[HUE], 2 * math.pi)


def operation(view: View) -> TileOperation:
    """Return what edits hue, saturation and value of a tile by the camera's settings."""
    camera = view.camera
    turn = math.degrees(camera[HUE])
    return hsv_operation(turn, camera[SATURATION], camera[VALUE], view.precision)


def omission_bound(signal: Signal, view: View) -> float:
    """Return a bound: hue moves within a pixel's channels, saturation and value scale them."""
    camera = view.camera
    top = min(max(signal.high, 0.0), 1.0)
    chroma = min(top, signal.span)
    turned = chroma if _normalised_hue(view) else 0.0
    edited = turned + abs(camera[SATURATION] - 1.0) * chroma + abs(camera[VALUE] - 1.0) * top
    return signal.outside(0.0, 1.0) + edited + CURVE_ERROR


def carry_error(error: float, signal: Signal, view: View) -> float:
    """Return the error after the edit: a piecewise smooth map spreads it by its factors."""
    camera = view.camera
    turned = 3.0 if _normalised_hue(view) else 1.0
    saturated = 1.0 if camera[SATURATION] <= 1.0 else 3.0 * camera[SATURATION]
    scaled = camera[VALUE] if camera[VALUE] <= 1.0 else 2.0 * camera[VALUE]
    return error * turned * saturated * scaled + CURVE_ERROR


def range_after(signal: Signal, view: View) -> Signal:
    """Return the range from black to the brightest value that the edit can make."""
    return Signal(0.0, min(1.0, max(signal.high, 0.0) * max(1.0, view.camera[VALUE]) + CURVE_ERROR))


def is_present(view: View) -> bool:
    """Return whether anything is edited."""
    return (_normalised_hue(view), view.camera[SATURATION], view.camera[VALUE]) != (0.0, 1.0, 1.0)


EFFECT = Effect(
    name="hsv edit",
    answers=("hsv", "hue", "saturation edit"),
    settings=(HUE, SATURATION, VALUE),
    is_present=is_present,
    run=PointByPoint(operation),
    omission_bound=omission_bound,
    carry_error=carry_error,
    range_after=range_after,
)
