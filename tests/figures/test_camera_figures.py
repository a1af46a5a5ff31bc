"""Figures that are photographs of the camera simulator: what their pixels and curves must show."""

from __future__ import annotations

import base64
import re

import cv2
import numpy as np
import pytest
from figure_cases import module, render

from quizgen.camera import pictures

luminosity = module("luminosity")
normalisation = module("normalisation")


def _decoded(data: bytes):
    """A PNG as RGB, read by OpenCV."""
    return cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)[..., ::-1].astype(float)


def _pictures(name, values, *, quiz):
    svg = render(name, values, quiz=quiz, lang="en").svg.decode()
    found = re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", svg)
    return [_decoded(base64.b64decode(text)) for text in found]


@pytest.mark.parametrize(
    ("wavelength", "night", "value"),
    # CIE 1924 and 1951 tables
    [(530, False, 0.862), (655, False, 0.0816), (650, False, 0.107), (700, False, 0.004102), (507, True, 1.0),
     (650, True, 0.000677), (555, False, 1.0)],
)  # fmt: skip
def test_curves_are_read_at_the_tables_values(wavelength, night, value):
    assert luminosity.read(wavelength, night=night) == pytest.approx(value)


def test_clamping_gathers_what_lies_above():
    image = normalisation.sample(60.0, 180.0, 0.0, 1)
    levels = image * 255
    assert levels.min() == pytest.approx(60)
    assert levels.max() == pytest.approx(180)
    _, before, after = pictures.normalised(image, 60 / 255, 140 / 255, normalisation.BINS)
    assert before.sum() == after.sum() == image.size
    # the last bin holds what is clamped, and what fell into it anyway
    last = 60 + (140 - 60) * (normalisation.BINS - 1) / normalisation.BINS
    assert after[-1] == (levels >= last).sum()
    assert after[-1] > 5 * after[:-1].max()


def test_outliers_have_their_share():
    levels = normalisation.sample(100.0, 140.0, 0.1, 5) * 255
    outside = ((levels < 100) | (levels > 140)).mean()
    assert outside == pytest.approx(0.1 * (1 - 40 / 255), abs=4 * np.sqrt(0.1 / levels.size))


# X-C15: cos^4 for tan = 3/4, 5/12, 8/15, 1
@pytest.mark.parametrize(
    ("f", "r", "light"), [(20, 15, 0.4096), (24, 10, 0.7260), (15, 8, 0.6061), (20, 20, 0.25)]
)
def test_the_wall_falls_with_the_fourth_power_of_the_cosine(f, r, light):
    (photo,) = _pictures("fall_off", {"f": f, "r": 0, "extent": r}, quiz=True)
    linear = ((photo[36, :, 0] / 255 + 0.055) / 1.055) ** 2.4
    assert linear[-1] / linear[48] == pytest.approx(light, abs=0.02)


