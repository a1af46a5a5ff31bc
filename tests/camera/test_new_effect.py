"""An effect is one module and one line: here is the module, the fixture is the line."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from quizgen.camera import Camera, PreparedScene, Scene, SceneError, effects
from quizgen.camera.effect import Effect, EffectSize, on_composite
from quizgen.camera.question_photo import InvisibleEffectError
from quizgen.camera.setup.settings import SHARE, Setting
from quizgen.camera.setup.value_parsers import quantity_parser
from quizgen.camera.setup.view import Signal
from quizgen.camera.simulation import run_plan
from quizgen.cli.simulate import simulate

HAZE = Setting("haze", quantity_parser("%"), 0.0, (SHARE,))


def hazy(image, view):
    share = np.float32(view.camera[HAZE])
    return image * (1 - share) + share


EFFECT = Effect(
    name="haze",
    answers=("haze",),
    settings=(HAZE,),
    is_present=lambda view: view.camera[HAZE] > 0.0,
    run=on_composite(hazy),
    omission_bound=lambda signal, view: view.camera[HAZE] * signal.outside(1.0, 1.0),
    carry_error=lambda error, _, view: error * (1 - view.camera[HAZE]),
    range_after=lambda signal, _: Signal(min(signal.low, 1.0), max(signal.high, 1.0)),
    size=EffectSize(
        lambda view: 100.0 * view.camera[HAZE], "lay {:.3g} % of white over everything", 1.0
    ),
)


@pytest.fixture(autouse=True)
def table(monkeypatch):
    place = next(i for i, effect in enumerate(effects.EFFECTS) if effect.name == "exposure")
    longer = (*effects.EFFECTS[:place], EFFECT, *effects.EFFECTS[place:])
    with monkeypatch.context() as patched:
        patched.setattr(effects, "EFFECTS", longer)
        effects.all_settings.cache_clear()
        yield
    effects.all_settings.cache_clear()


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
    made = report(scene_file(tmp_path, "20 %"), "--everything")
    assert made["ran"] == ["haze", "exposure"]
    assert made["everything"]["difference_dn"] == 0.0
    assert "haze" in report(scene_file(tmp_path, "0 %"))["absent"]


def test_it_is_left_out_with_its_bound(tmp_path):
    """0.1 % of the way from 0.25 to 1, doubled by the exposure: 0.3825 grey levels."""
    made = report(scene_file(tmp_path, "0.1 %"), "--everything")
    (left,) = made["left_out"]
    assert left["effect"] == "haze"
    assert left["does"] == "lay 0.1 % of white over everything"
    assert left["bound_dn"] == pytest.approx(0.3825, abs=2e-3)
    assert made["everything"]["difference_dn"] == pytest.approx(0.3825, abs=1e-3)
    assert made["everything"]["difference_dn"] <= made["bound_dn"]


def test_it_runs_when_it_is_asked_and_is_measured_to_be_seen(tmp_path):
    asked = scene_file(tmp_path, "10 %", '[question]\nasks = "haze"')
    made = report(asked)
    assert made["asked"] == ["haze"]
    assert made["seen"][0]["explanation"].startswith("lays 10 % of white over everything; changes")
    with pytest.raises(InvisibleEffectError, match=r"haze cannot be seen: lays 0\.1 % of white"):
        report(scene_file(tmp_path, "0.1 %", '[question]\nasks = "haze"'))


def test_its_picture_is_its_own():
    prepared = PreparedScene(Scene(8, 6, background=(0.25, 0.5, 1.0)), Camera(haze=0.2))
    assert run_plan(prepared).values[0, 0] == pytest.approx([0.4, 0.6, 1.0])


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


@pytest.mark.parametrize("name", ["name", "answers", "is_present", "run"])
def test_what_an_effect_must_have(name):
    fields = {
        key: getattr(EFFECT, key) for key in ("name", "answers", "is_present", "run") if key != name
    }
    with pytest.raises(TypeError, match=name):
        Effect(**fields)
