"""The shipped scenes give stored pictures and messages, whatever is rebuilt below them.

``python tests/camera/test_digests.py`` writes the digests anew.
"""

from __future__ import annotations

import hashlib
import tempfile
from pathlib import Path

import pytest

from quizgen.camera import PreparedScene, SceneError, plan_budget
from quizgen.camera.effects import EFFECTS
from quizgen.camera.pixels.filters import numpy_only
from quizgen.camera.scene_file import load_scene
from quizgen.camera.simulation import run_plan

STORED = Path(__file__).with_name("digests.txt")
SCENES = Path(__file__).parents[2] / "quizgen" / "camera" / "scenes"
NAMES = sorted(path.stem for path in SCENES.glob("*.toml"))

BAD = (
    '[camera]\nfocal_lenght = "50 mm"',
    '[camera]\nfocal_length = "50 kg"',
    "[camera]\nfocal_length = 50",
    '[camera]\nfocal_length = "-50 mm"',
    '[camera]\nfocal_length = "50 mm"\nsensor_width = "36 mm"\nfocus_distance = "20 mm"',
    '[camera]\nfocal_length = "50 mm"\nsensor_width = "36 mm"\npixel_pitch = "5 um"',
    '[camera]\nf_number = "f/2"',
    '[camera]\nf_number = "wide"',
    "[camera]\nk1 = -0.1",
    '[camera]\nk2 = "much"',
    '[camera]\nlateral_colour = "1 mm"',
    "[camera]\nnatural_vignetting = true",
    "[camera]\nnatural_vignetting = 1",
    "[camera]\nmechanical_vignetting = 1.5",
    '[camera]\nshutter = "-1 s"',
    '[camera]\nvelocity = ["1 px/s"]',
    '[camera]\nrow_time = "-1 us"',
    '[camera]\nexposure = "1 s"',
    '[camera]\nfull_well = "0 e-"',
    '[camera]\nshot_noise = "yes"',
    '[camera]\nread_noise = "3 e-"',
    '[camera]\nfull_well = "10 e-"\nread_noise = "-3 e-"',
    '[camera]\ndark_current = "3 e-/s"',
    '[camera]\nhot_pixels = "3 %"',
    '[camera]\nfull_well = "10 e-"\nhot_pixels = "300 %"',
    "[camera]\nblooming = true",
    '[camera]\nsmear = "1 %"',
    '[camera]\nfull_well = "10 e-"\nsmear = "-1 %"',
    "[camera]\nbit_depth = 17",
    "[camera]\nbit_depth = true",
    '[camera]\nmosaic = "RGBG"',
    "[camera]\nwhite_balance = [1, -1, 1]",
    "[camera]\nwhite_balance = [1, 1]",
    "[camera]\ngamma = 0.5",
    '[camera]\ngamma = "film"',
    '[camera]\nhue = "1 m"',
    "[camera]\nsaturation = -1",
    "[camera]\nvalue = -1",
    "[camera]\ngaussian_noise = -1",
    '[camera]\nimpulse_noise = "101 %"',
    "[camera]\nnormalise = [1, 0, 0, 1]",
    "[camera]\nnormalise = [1, 0]",
    '[camera]\n"a b" = 1',
    "[camra]\nk1 = 0",
    "[scene]\nwidth = 0",
    '[scene]\nquestion = ["colour"]',
    '[question]\nasks = "colour"',
    "[question]\nreads = { corner = 3 }",
    '[question]\nasks = "gamma"\nreads = { corner = -3 }',
    '[question]\nasks = "gamma"\nreads = { edge = 3 }',
    '[[thing]]\nshape = "disc"',
)


def picture_digest(name: str) -> str:
    """One line per scene: its picture with every effect, computed without OpenCV."""
    with numpy_only():
        photo = run_plan(PreparedScene(*load_scene(SCENES / f"{name}.toml")))
    return f"{name} everything {hashlib.sha256(photo.pixels().tobytes()).hexdigest()}"


def bad_file_messages() -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "s.toml"
        found = []
        for text in BAD:
            path.write_text(text, "utf-8")
            with pytest.raises(SceneError) as caught:
                load_scene(path)
            found.append("bad " + str(caught.value).removeprefix(str(path)))
    return found


def stored(kind: str) -> list[str]:
    return [line for line in STORED.read_text("utf-8").splitlines() if line.split()[0] == kind]


@pytest.mark.parametrize("name", NAMES)
def test_pictures_are_the_stored_ones(name):
    assert [picture_digest(name)] == stored(name)


@pytest.mark.parametrize("name", NAMES)
def test_every_effect_runs_is_left_out_or_is_absent(name):
    made = plan_budget(PreparedScene(*load_scene(SCENES / f"{name}.toml")))
    told = [*(choice.effect for choice in (*made.steps, *made.left_out)), *made.absent]
    assert sorted(told) == sorted(effect.name for effect in EFFECTS)


def test_messages_are_the_stored_ones():
    assert bad_file_messages() == stored("bad")


if __name__ == "__main__":
    lines = [picture_digest(name) for name in NAMES] + bad_file_messages()
    STORED.write_text("".join(f"{line}\n" for line in lines), "utf-8")
