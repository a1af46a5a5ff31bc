"""When a plan looks at the steps of a picture."""

from __future__ import annotations

import importlib

import numpy as np
import pytest

from quizgen.camera import Camera, Length, Scene, Thing, plan

planning = importlib.import_module("quizgen.camera.plan")
LENS = Camera(0.05, 5e-6, f_number=2.0, focus_distance=2.1)


def smooth(width, height):
    ramp = np.linspace(0.2, 0.8, width, dtype=np.float32)[None, :, None]
    return Scene(width, height, image=np.broadcast_to(ramp, (height, width, 3)).copy(), depth=2.0)


@pytest.fixture
def looks(monkeypatch):
    found = []
    real = planning.glimpsed

    def counted(*arguments, **options):
        found.append(arguments)
        return real(*arguments, **options)

    monkeypatch.setattr(planning, "glimpsed", counted)
    return found


def test_a_small_photograph_is_not_looked_at(looks):
    made = plan(smooth(64, 48), LENS, budget=2.0)
    assert not looks
    assert [step.effect for step in made.steps] == ["defocus"]


def test_a_photograph_whose_lens_takes_long_is_looked_at(looks):
    made = plan(smooth(2000, 1500), LENS, budget=2.0)
    assert looks
    assert [one.effect for one in made.skipped] == ["defocus"]


def test_a_drawn_scene_of_any_size_is_looked_at(looks):
    wall = Thing("full", colour=(0.8,) * 3, other=(0.2,) * 3, texture="ramp", width=Length(400.0))
    plan(Scene(160, 120, (wall,), background_depth=2.0), LENS, budget=2.0)
    assert looks
