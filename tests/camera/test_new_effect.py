"""An effect is one module and one line: here is the module, the fixture is the line."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from quizgen.camera import Camera, Scene, SceneError, effects
from quizgen.camera.costs import measured
from quizgen.camera.effect import Effect, Rung, on_picture
from quizgen.camera.facts import Error
from quizgen.camera.plan import Prepared, everything, plan
from quizgen.camera.settings import SHARE, Setting
from quizgen.camera.simulate import run
from quizgen.camera.values import quantity
from quizgen.cli.simulate import simulate

HAZE = Setting("haze", quantity("%"), 0.0, (SHARE,))


def hazy(image, view, rung=""):
    share = np.float32(view.camera[HAZE])
    light = np.float32(0.9 if rung == "dim" else 1.0)
    return image * (1 - share) + share * light


EFFECT = Effect(
    name="haze",
    stage="sensor",
    decides=("haze",),
    settings=(HAZE,),
    present=lambda view: view.camera[HAZE] > 0.0,
    run=on_picture(hazy),
    cost=measured((1.0, 40), dim=(0.5, 20)),
    skipped=lambda facts, view: Error(
        view.camera[HAZE] * max(abs(1 - facts.low), abs(1 - facts.high))
    ),
    carried=lambda error, _, view: error.times(1 - view.camera[HAZE]),
    rungs=(Rung("dim", lambda _, view: Error(0.1 * view.camera[HAZE])),),
)


@pytest.fixture(autouse=True)
def table(monkeypatch):
    place = next(i for i, effect in enumerate(effects.EFFECTS) if effect.name == "exposure")
    longer = (*effects.EFFECTS[:place], EFFECT, *effects.EFFECTS[place:])
    with monkeypatch.context() as patched:
        patched.setattr(effects, "EFFECTS", longer)
        effects.settings.cache_clear()
        yield
    effects.settings.cache_clear()


def scene_file(tmp_path, haze, question=""):
    path = tmp_path / "foggy.toml"
    path.write_text(
        f"[scene]\nwidth = 8\nheight = 6\nbackground = [0.25, 0.25, 0.25]\n{question}\n"
        f'[camera]\nhaze = "{haze}"\nexposure = "1 stop"\n',
        "utf-8",
    )
    return path


def report(path, *options):
    result = CliRunner().invoke(simulate, [str(path), "--json", *options], catch_exceptions=False)
    return json.loads(result.output)


def test_it_is_read_planned_run_and_reported(tmp_path):
    made = report(scene_file(tmp_path, "20 %"), "--all")
    assert made["ran"] == ["haze", "exposure"]
    assert made["difference_dn"] == 0.0
    assert "haze" in report(scene_file(tmp_path, "0 %"))["absent"]


def test_it_is_skipped_with_its_bound(tmp_path):
    """0.1 % of the way from 0.25 to 1, doubled by the exposure: 0.3825 grey levels."""
    made = report(scene_file(tmp_path, "0.1 %"), "--all")
    (left,) = made["skipped"]
    assert left["effect"] == "haze"
    assert left["bound_dn"] == pytest.approx(0.3825, abs=2e-3)
    assert made["difference_dn"] == pytest.approx(0.3825, abs=1e-3)
    assert made["difference_dn"] <= made["predicted_error_dn"]


def test_it_runs_on_its_rung_and_is_kept_when_asked_about(tmp_path):
    assert report(scene_file(tmp_path, "4 %"), "--budget", "visible", "--all")["rungs"] == {}
    made = report(scene_file(tmp_path, "1 %"), "--budget", "visible", "--all")
    assert made["rungs"] == {"haze": "dim"}
    assert made["difference_dn"] <= made["predicted_error_dn"] <= 2.0
    asked = report(scene_file(tmp_path, "0.1 %", 'question = ["haze"]'))
    assert "haze" in asked["ran"]
    assert asked["rungs"] == {}


def test_its_picture_is_its_own():
    prepared = Prepared(Scene(8, 6, background=(0.25, 0.5, 1.0)), Camera(haze=0.2))
    photo = run(prepared, everything(prepared))
    assert photo.values[0, 0] == pytest.approx([0.4, 0.6, 1.0])
    assert [step.effect for step in plan(prepared, budget=60.0).steps] == []


def test_its_values_are_checked(tmp_path):
    with pytest.raises(SceneError, match="haze must be 0 to 1"):
        Camera(haze=1.5)
    for haze, message in (
        ("2 m", "2: haze: expected a unit like '%'"),
        ("120 %", "haze must be 0 to 1"),
    ):
        path = scene_file(tmp_path, haze)
        result = CliRunner().invoke(simulate, [str(path)])
        assert isinstance(result.exception, SceneError)
        assert message.split(": ")[-1] in str(result.exception)
    with pytest.raises(SceneError, match="did you mean 'haze'"):
        Camera(hase=0.1)


@pytest.mark.parametrize("name", ["name", "stage", "present", "run", "cost"])
def test_what_an_effect_must_have(name):
    fields = {
        key: getattr(EFFECT, key)
        for key in ("name", "stage", "decides", "present", "run", "cost")
        if key != name
    }
    with pytest.raises(TypeError, match=name):
        Effect(**fields)
