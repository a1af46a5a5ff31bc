"""The scene whose colours are edited, beside the edits of scikit-image."""

from __future__ import annotations

import base64
import io
import itertools
import re

import numpy as np
import pytest
from figure_cases import module, render
from PIL import Image
from skimage.color import hsv2rgb, rgb2hsv

edit_order = module("hsv_edits").edit_order
_scene = module("_scene")


def pictures(**values):
    text = render("hsv_edits", values, quiz=True, lang="en").svg.decode()
    files = [base64.b64decode(data) for data in re.findall(r"base64,([^\"]+)", text)]
    return dict(
        zip(
            edit_order(values.get("order", 0)),
            [np.asarray(Image.open(io.BytesIO(file)).convert("RGB")) for file in files],
            strict=True,
        )
    )


@pytest.mark.parametrize("order", [0, 13, 23])
def test_edits_are_those_of_scikit_image(order):
    got = pictures(a=0.4, b=0.2, delta=120, order=order, scene=order % 8)
    hsv = rgb2hsv(got["original"])
    for edit, change in (
        ("V", hsv * [1, 1, 0.4]),
        ("S", hsv * [1, 0.2, 1]),
        ("H", np.dstack([(hsv[..., 0] + 1 / 3) % 1, hsv[..., 1:]])),
    ):
        assert got[edit] == pytest.approx(hsv2rgb(change) * 255, abs=0.6)


@pytest.mark.parametrize("scene", range(8))
@pytest.mark.parametrize("delta", [60, 90, 120, 180, 240])
def test_edits_can_be_told_apart(scene, delta):
    """Curriculum Q1a: V kept within 1 % by S and H edits, 12 grey levels RMS between any two."""
    for a, b in itertools.product((0.35, 0.55), (0.1, 0.3)):
        got = pictures(a=a, b=b, delta=delta, scene=scene)
        value = {edit: picture.max(axis=2).mean() for edit, picture in got.items()}
        assert value["S"] == pytest.approx(value["original"], rel=0.01)
        assert value["H"] == pytest.approx(value["original"], rel=0.01)
        for one, other in itertools.combinations(got.values(), 2):
            assert np.sqrt(np.mean((one.astype(float) - other) ** 2)) > 12


def test_scene_has_hues_greys_and_whites():
    used = np.array(_scene.PALETTE)[np.unique(_scene.indices(0))] / 255
    hue, saturation, value = rgb2hsv(used[None])[0].T
    vivid = hue[saturation > 0.5] * 360
    assert len(np.unique(vivid // 60)) >= 4
    assert ((saturation == 0) & (value > 0.3) & (value < 0.7)).any()
    assert ((saturation < 0.05) & (value > 0.95)).any()


def test_scenes_differ():
    assert len({_scene.indices(scene).tobytes() for scene in range(8)}) == 8
