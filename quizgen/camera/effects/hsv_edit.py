"""HSV edit: hue turned, saturation and value scaled."""

from __future__ import annotations

import math

from msgspec.structs import replace

from quizgen.camera.blocks import Work
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, PointByPoint
from quizgen.camera.facts import Error, Facts
from quizgen.camera.hsv import hsv_work
from quizgen.camera.power import CURVE_ERROR
from quizgen.camera.settings import NOT_NEGATIVE, Setting
from quizgen.camera.values import number, quantity
from quizgen.camera.view import View

HUE = Setting("hue", quantity("deg"), 0.0)
"""rad added."""
SATURATION = Setting("saturation", number, 1.0, (NOT_NEGATIVE,))
VALUE = Setting("value", number, 1.0, (NOT_NEGATIVE,))


def _turn(view: View) -> float:
    return math.fmod(view.camera[HUE], 2 * math.pi)


def present(view: View) -> bool:
    """Whether anything is edited; whole turns of the hue change nothing."""
    return (_turn(view), view.camera[SATURATION], view.camera[VALUE]) != (0.0, 1.0, 1.0)


def work(view: View, rung: str = "") -> Work:
    """`edit_hsv` with the camera's parameters."""
    camera = view.camera
    turn = math.degrees(camera[HUE])
    return hsv_work(turn, camera[SATURATION], camera[VALUE], view.precision)


def skipped(facts: Facts, view: View) -> Error:
    """Hue stays between a pixel's channels, saturation and value scale them."""
    camera = view.camera
    top = min(max(facts.top, 0.0), 1.0)
    chroma = min(top, facts.span + 2 * facts.reach)
    turned = chroma if _turn(view) else 0.0
    edited = turned + abs(camera[SATURATION] - 1.0) * chroma + abs(camera[VALUE] - 1.0) * top
    clipped = facts.outside(0.0, 1.0)
    return replace(clipped, odd=3.0 * clipped.odd).plus(Error(edited + CURVE_ERROR))


def _gain(view: View) -> float:
    """Bound on how much an edit spreads differences: every factor of a piecewise smooth map."""
    camera = view.camera
    turned = 3.0 if _turn(view) else 1.0
    saturated = 1.0 if camera[SATURATION] <= 1.0 else 3.0 * camera[SATURATION]
    scaled = camera[VALUE] if camera[VALUE] <= 1.0 else 2.0 * camera[VALUE]
    return turned * saturated * scaled


def carried(error: Error, facts: Facts, view: View) -> Error:
    """Spread by at most `_gain`: any channel's luck may decide."""
    return Error(error.certain * _gain(view), odd=3.0 * error.odd)


def after(facts: Facts, view: View) -> Facts:
    """Anything from black to the brightest value."""
    gain = _gain(view)
    high = min(1.0, facts.top * max(1.0, view.camera[VALUE]))
    tail = min(facts.reach * gain, 1.0)
    changed = Facts(0.0, high, facts.layers, tail=tail, limits=(0.0, 1.0))
    return changed.with_jump((facts.jump[0] * gain, facts.jump[1] * gain))


EFFECT = Effect(
    name="hsv edit",
    stage="edit",
    decides=("hsv", "hue", "saturation edit"),
    settings=(HUE, SATURATION, VALUE),
    present=present,
    run=PointByPoint(work),
    cost=measured((38.4, 1490), opencv=(1.5, 75)),
    skipped=skipped,
    carried=carried,
    after=after,
)
