"""Every effect beside the copy bandwidth of the same run, and photographs with what is asked.

``python benchmarks/camera.py [--quick] [--scenes] [--files [OPTION ...]]``: ``--scenes`` takes the
shipped scenes with what they ask about and with everything, in turns; ``--files`` photographs them
at 12 megapixels from file to file, with further options of ``quizgen simulate``.
"""

# ruff: noqa: SLF001 - caches are emptied between runs

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np

from quizgen.camera import Camera, PreparedScene, Scene, View, effects, plan_question
from quizgen.camera.comparison import time_in_turns
from quizgen.camera.effect import Effect
from quizgen.camera.effects import distortion, mosaic, vignetting
from quizgen.camera.pixels import filters
from quizgen.camera.raster.rasterizer import Layer
from quizgen.camera.scene_file import load_scene
from quizgen.cli.simulate import SCENES

SIZES = {"640x480": (640, 480), "12 MP": (4000, 3000)}


def best(work: Callable[[], Any], repeats: int) -> float:
    """Shortest time of several runs, ms."""
    times = []
    for _ in range(repeats):
        started = perf_counter()
        work()
        times.append(perf_counter() - started)
    return min(times) * 1e3


def picture(width: int, height: int) -> np.ndarray:
    """Full contrast: a checker board on a gradient."""
    rows, columns = np.mgrid[0:height, 0:width]
    board = ((rows // 16 + columns // 16) % 2).astype(np.float32)
    image = np.empty((height, width, 3), np.float32)
    image[...] = (0.05 + 0.9 * board * columns / width)[..., None]
    return image


def view(width: int, height: int) -> View:
    """A camera that has nearly every effect."""
    camera = Camera(
        0.01, 1e-5 * 640 / width, 8.0, 9.99, k1=-0.05, lateral_colour=2.0, natural_vignetting=True,
        full_well=20000.0, exposure=1.0, dark_current=100.0, shutter=0.1, read_noise=5.0,
        smear=0.01, bit_depth=12, mosaic="RGGB", white_balance=(1.5, 1.0, 1.4), gamma="srgb",
        hue=1.0, gaussian_noise=0.05, impulse_noise=0.05, normalise=(0.1, 0.9, 0.0, 1.0),
        blooming=True, light=2856.0, fixed_pattern=1.0, dark_frames=4, iso=200.0, binning=2,
        flat_field=True, velocity=(50.0, 0.0), row_time=1e-5, flare=0.02, wavelength=550e-9,
    )  # fmt: skip
    return View(Scene(width, height, image=picture(width, height), depth=10.0), camera)


def points(repeats: int) -> None:
    """Every effect on one picture, in units of one copy of it."""
    for name, size in SIZES.items():
        look = view(*size)
        image = look.scene.image
        copy = best(image.copy, 5)
        print(f"\n{name}: copy {copy:.2f} ms")
        for effect in effects.present_effects(look):
            stack = (Layer(mosaic.run(image, look) if effect.name == "demosaicing" else image),)
            time = best(lambda: fresh(effect, stack, look), repeats)  # noqa: B023
            print(f"  {effect.name:16}{time:10.2f} ms{time / copy:8.1f} copies")


def fresh(effect: Effect, stack: tuple[Layer, ...], look: View) -> None:
    """Run an effect without what an earlier run has left."""
    vignetting._fall_off_map.cache_clear()
    distortion._build_inverse_table.cache_clear()
    effect.run(stack, look)


def scenes() -> None:
    """What a question costs, and what everything would."""
    for path in sorted(SCENES.glob("*.toml")):
        prepared = PreparedScene(*load_scene(path))
        question = prepared.given.scene.question
        if question is not None:
            asked = plan_question(prepared, question.asks).names
            race = time_in_turns(prepared, asked, [one.name for one in prepared.present])
            few, whole = race.medians
            print(
                f"{path.stem:10} asked {few:7.1f} ms  everything {whole:7.1f}  x{whole / few:.2f}"
            )


def enlarged(text: str, times: float) -> str:
    """A shipped scene, 640 pixels wide, with all lengths on the sensor so much larger."""

    def more(match: re.Match[str]) -> str:
        return f"{float(match[0]) * times:g}"

    text = re.sub(r"(?<=^width = )640$|(?<=^height = )480$", more, text, flags=re.MULTILINE)
    text = re.sub(r'(?<=")[-.\d]+(?= px)', more, text)
    rows = re.compile(r"(?<=^points = ).*", re.MULTILINE)
    text = rows.sub(lambda row: re.sub(r"[-.\d]+", more, row[0]), text)
    times = 1.0 / times
    return re.sub(r'(?<=pixel_pitch = ")[.\d]+|(?<=row_time = ")[.\d]+', more, text)


def files(*options: str) -> None:
    """Processor time and memory of whole processes."""
    with TemporaryDirectory() as folder:
        for path in sorted(SCENES.glob("*.toml")):
            file = Path(folder, path.name)
            file.write_text(enlarged(path.read_text("utf-8"), 6.25), "utf-8")
            target = file.with_suffix(".png")
            words = [
                sys.executable,
                "-m",
                "quizgen",
                "simulate",
                str(file),
                "--out",
                str(target),
                *options,
            ]
            process = subprocess.Popen([*words, "--json"], stdout=subprocess.PIPE, text=True)
            report = json.load(process.stdout)
            _, _, used = os.wait4(process.pid, 0)
            busy_s = used.ru_utime + used.ru_stime
            spent = "  ".join(f"{name} {ms:.0f}" for name, ms in report["times_ms"].items())
            print(f"{path.stem:10} {busy_s:5.1f} s CPU {used.ru_maxrss / 1e3:6.0f} MB  ms: {spent}")


def main() -> None:
    filters.warm_up()
    if "--scenes" in sys.argv:
        scenes()
    elif "--files" in sys.argv:
        files(*sys.argv[sys.argv.index("--files") + 1 :])
    else:
        points(1 if "--quick" in sys.argv else 3)


if __name__ == "__main__":
    main()
