"""Gain of the ISO setting: twice the ISO, twice the signal, noise and all."""

from __future__ import annotations

from quizgen.camera.amplifier import amplifier
from quizgen.camera.settings import Setting, between
from quizgen.camera.values import number
from quizgen.camera.view import View

BASE_ISO = 100.0
ISO = Setting("iso", number, BASE_ISO, (between(1.0, 1e7),))
"""At ISO 100 a full well is white."""


def gain(view: View) -> float:
    """Factor between electrons and codes, 1 at ISO 100."""
    return view.camera[ISO] / BASE_ISO


EFFECT = amplifier("gain", gain, settings=(ISO,), answers=("iso", "exposure", "noise", "snr"))
