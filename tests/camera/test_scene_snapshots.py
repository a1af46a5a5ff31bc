"""The shipped scenes give the kept pictures, wrong files the kept messages."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sweep import together

from quizgen.camera import PreparedScene, SceneError, plan_budget
from quizgen.camera.effects import EFFECTS
from quizgen.camera.pixels.filters import numpy_only
from quizgen.camera.scene_file import load_scene
from quizgen.camera.simulation import run_plan

SCENES = Path(__file__).parents[2] / "quizgen" / "camera" / "scenes"
NAMES = sorted(path.stem for path in SCENES.glob("*.toml"))
ROWS, COLUMNS = 6, 8
"""Fields of a picture whose mean colours are kept."""

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


def describe_picture(pixels: np.ndarray) -> str:
    """Return size, statistics of each channel, and mean colours of fields, as people compare them.

    The last column of a channel is the root mean square of neighbours' differences: it tells blur
    and noise, which leave means as they are.
    """
    values = pixels.astype(np.float64)
    lines = [f"{pixels.shape[1]} x {pixels.shape[0]} {pixels.dtype}", "", "     mean       deviation  least  most  step"]  # fmt: skip
    for name, channel in zip("RGB", np.moveaxis(values, 2, 0), strict=True):
        step = np.sqrt(np.mean(np.diff(channel, axis=1) ** 2))
        least, most = int(channel.min()), int(channel.max())
        lines.append(
            f"{name}    {channel.mean():9.5f}  {channel.std():9.5f}  {least:5}  {most:4}  {step:8.5f}"
        )
    lines.append("")
    for band in np.array_split(values, ROWS):
        fields = [field.mean(axis=(0, 1)) for field in np.array_split(band, COLUMNS, axis=1)]
        lines.append("  ".join(" ".join(f"{c:5.1f}" for c in field) for field in fields))
    return "\n".join([*lines, ""])


@pytest.mark.parametrize("name", NAMES)
def test_a_picture_with_every_effect_is_the_kept_one(snapshots, name):
    """Without OpenCV, whose results differ in the last digit from one version to the next."""
    with numpy_only():
        photo = run_plan(PreparedScene(*load_scene(SCENES / f"{name}.toml")))
    snapshots.check(f"camera/{name}.txt", describe_picture(photo.pixels()))


def test_every_shipped_scene_has_its_picture(snapshots):
    snapshots.check_names("camera", [*(f"{name}.txt" for name in NAMES), "wrong-files.txt"])


@together("name", NAMES)
def test_every_effect_runs_is_left_out_or_is_absent(name):
    made = plan_budget(PreparedScene(*load_scene(SCENES / f"{name}.toml")))
    told = [*(choice.effect for choice in (*made.steps, *made.left_out)), *made.absent]
    assert sorted(told) == sorted(effect.name for effect in EFFECTS)


def test_what_is_said_of_wrong_files(snapshots, tmp_path):
    path, found = tmp_path / "scene.toml", []
    for text in BAD:
        path.write_text(text, "utf-8")
        with pytest.raises(SceneError) as caught:
            load_scene(path)
        found.append(f"{text}\n    {str(caught.value).replace(str(path), path.name)}\n")
    snapshots.check("camera/wrong-files.txt", "\n".join(found))
