"""Eager against planned photographs, and every effect beside the copy bandwidth of the same run.

``python benchmarks/camera.py [--quick] [--chains] [--calibrate] [--photos [N]] [--large [N]]
[--oracle [N]] [--scenes] [--files]``; best of several runs, ms. ``--photos`` plans and runs N (60)
ordinary photographs of 640 x 480 with ordinary cameras, best of five turns, ``--large`` N (8) of
4000 x 3000; ``--scenes`` the shipped scenes in the same way; ``--oracle`` tries what could be left
out of N (12) of the small ones, or of the large ones if both are given; ``--files`` photographs the
shipped scenes at 12 megapixels from file to file.
"""

# ruff: noqa: SLF001 - caches are emptied between runs

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from typing import Any

import numpy as np
from photographs import forget_maps, oracle, photos, shipped

from quizgen.camera import Camera, Scene, View, effects, filters, hsv
from quizgen.camera.decision import Plan
from quizgen.camera.draw import Layer
from quizgen.camera.effects import distortion, lateral_colour, mosaic, vignetting
from quizgen.camera.kernels import disc
from quizgen.camera.plan import Prepared, everything, plan
from quizgen.camera.reading import load
from quizgen.camera.simulate import run
from quizgen.cli.simulate import SCENES

SIZES = {"640x480": (640, 480), "12 MP": (4000, 3000)}

# Six effects (and the well's clip) are in this camera, all too weak to be seen.
WEAK = Camera(
    focal_length=0.05,
    pixel_pitch=2e-7,
    f_number=16.0,
    focus_distance=10.00001,
    k1=1e-9,
    natural_vignetting=True,
    full_well=1e12,
    read_noise=0.01,
    bit_depth=16,
)

# A long lens: the corner is 0.01 of the focal length away, so that only what is asked for shows.
STRONG = {
    "barrel": {"k1": -900.0},
    "defocus": {"f_number": 8.0, "focus_distance": 9.9999},
    "noise": {"full_well": 20000.0},
    "vignetting": {"mechanical_vignetting": 0.6},
    "none": {},
}


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


def view(width: int, height: int, **changes: Any) -> View:
    camera = Camera(0.01, 1e-5 * 640 / width, **changes)
    return View(Scene(width, height, image=picture(width, height), depth=10.0), camera)


def primitives(size: tuple[int, int], repeats: int) -> dict[str, float]:
    """Time of every building block of the cost table."""
    look = view(
        *size, k1=-0.05, lateral_colour=2.0, natural_vignetting=True, full_well=20000.0,
        exposure=1.0, dark_current=100.0, shutter=0.1, read_noise=5.0, smear=0.01, bit_depth=12,
        mosaic="RGGB", white_balance=(1.5, 1.0, 1.4), gamma="srgb", hue=1.0,
        gaussian_noise=0.05, impulse_noise=0.05, normalise=(0.1, 0.9, 0.0, 1.0), blooming=True,
        light=2856.0, fixed_pattern=1.0, dark_frames=4,
    )  # fmt: skip
    image = look.scene.image
    raw = mosaic.run(image, look)
    x, y = distortion.source(look)
    x, y = x + np.float32(0.25), y + np.float32(0.25)
    small, large = disc(2.5), disc(21.0)
    building_blocks = {
        "(rgb to hsv)": lambda: hsv.rgb_to_hsv(image),
        "(copy)": image.copy,
        "SAMPLE": lambda: filters.sample(image, x, y),
        "NEAREST": lambda: filters.sample_nearest(image, x, y),
        "LATERAL": lambda: lateral_colour.work(Layer(image), look),
        "SMALL": lambda: filters.convolve(image, small),
        "LARGE": lambda: filters.convolve(image, large),
    }
    point = dict(pointwise(image, raw, look))
    times = {name: best(work, repeats) for name, work in {**point, **building_blocks}.items()}
    times["MAP"] = best(lambda: fresh_map(look), repeats)
    return times


def pointwise(
    image: np.ndarray, raw: np.ndarray, look: View
) -> Iterator[tuple[str, Callable[[], Any]]]:
    """Every effect on one picture, and its cheaper ways."""
    for effect in effects.EFFECTS:
        if effect.stage in ("scene", "optics"):
            continue
        stack = (Layer(raw if effect.name == "demosaicing" else image),)
        for rung in ("", *(rung.name for rung in effect.rungs)):
            name = f"{effect.name}/{rung}" if rung else effect.name
            yield name, partial(from_nothing, effect.run, stack, look, rung)


def from_nothing(work: Callable[..., Any], *arguments: Any) -> None:
    """Run an effect without what an earlier run has left."""
    vignetting._fall_off_map.cache_clear()
    work(*arguments)


def fresh_map(look: View) -> None:
    forget_maps()
    distortion.source(look)


def calibrate() -> None:
    """Print the figures of `quizgen.camera.costs` and of every effect."""
    real = filters.opencv
    for name, stand_in in (("OpenCV", real), ("NumPy", lambda: None)):
        filters.opencv = hsv.opencv = stand_in
        filters._opencv_remap_is_exact.cache_clear()
        small, large = SIZES.values()
        columns = [primitives(small, 9), primitives(large, 2)]
        print(f"# {name}")
        for key in columns[0]:
            print(f'    "{key}": ({columns[0][key]:.3g}, {columns[1][key]:.4g}),')
    filters.opencv = hsv.opencv = real
    filters._opencv_remap_is_exact.cache_clear()


def points(repeats: int) -> None:
    """Point operations in units of one copy of the same picture."""
    for name, size in SIZES.items():
        times = primitives(size, repeats)
        print(f"\n{name}: copy {times['(copy)']:.2f} ms")
        for effect, time in times.items():
            print(f"  {effect:22}{time:10.2f} ms{time / times['(copy)']:8.1f} copies")


def chains(repeats: int) -> None:
    """Eager against planned for scenes that call for one effect."""
    for name, (width, height) in SIZES.items():
        print(f"\n{name}: six effects, eager against planned")
        scene = Scene(width, height, image=picture(width, height), depth=10.0)
        scene.range  # noqa: B018 - known before, as for drawn scenes
        for wish, changes in STRONG.items():
            camera = WEAK.but(pixel_pitch=2e-7 * 4000 / width, **changes)
            if wish == "defocus":
                camera = camera.but(focus_distance=focus_for(15.0, camera))
            prepared = Prepared(scene, camera)
            whole = everything(prepared)
            eager = best(lambda: run(prepared, whole), repeats)  # noqa: B023
            planned = best(lambda: plan_and_run(scene, camera), repeats)  # noqa: B023
            chosen = plan(prepared)
            runs = [timed(prepared, chosen) for _ in range(repeats)]
            wall, busy = (min(column) for column in zip(*runs, strict=True))
            ran = ", ".join(f"{step.effect} {step.rung}".strip() for step in chosen.steps)
            print(
                f"  {wish:11} eager {eager:8.1f}  planned {planned:8.2f}  x{eager / planned:7.1f}"
                f"  predicted {chosen.predicted_ms:6.1f} measured {wall:6.1f}"
                f" (cpu {busy:6.1f})  ran: {ran}"
            )


def timed(prepared: Prepared, chosen: Plan) -> tuple[float, float]:
    """Wall and processor time of all effects with nothing left over from an earlier run, ms.

    On a busy machine the wall time counts the others' work too; the processor time does not.
    """
    forget_maps()
    prepared.stack  # noqa: B018 - drawn before the clock starts
    started = process_time()
    wall = run(prepared, chosen).measured_ms
    return wall, (process_time() - started) * 1e3


def focus_for(diameter: float, camera: Camera) -> float:
    """Focus distance at which a subject at 10 m is blurred to a diameter, px (bisection)."""
    low, high = 5.0, 10.0
    for _ in range(80):
        middle = (low + high) / 2
        blur = View(Scene(), camera.but(focus_distance=middle)).blur_diameter(10.0)
        low, high = (middle, high) if blur > diameter else (low, middle)
    return low


def plan_and_run(scene: Scene, camera: Camera) -> None:
    prepared = Prepared(scene, camera)
    run(prepared, plan(prepared))


def ideal(repeats: int) -> None:
    """A question that needs no effect: planning only."""
    scene = Scene(image=picture(640, 480))
    time = best(lambda: plan_and_run(scene, Camera()), repeats)
    print(f"\nideal camera, 640x480: {time:.4f} ms for planning and running")


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


def files() -> None:
    """Processor time and memory of whole processes."""
    with TemporaryDirectory() as folder:
        for path in sorted(SCENES.glob("*.toml")):
            file = Path(folder, path.name)
            file.write_text(enlarged(path.read_text("utf-8"), 6.25), "utf-8")
            target = file.with_suffix(".png")
            words = [sys.executable, "-m", "quizgen", "simulate", str(file), "--out", str(target)]
            process = subprocess.Popen([*words, "--json"], stdout=subprocess.PIPE, text=True)
            report = json.load(process.stdout)
            _, _, used = os.wait4(process.pid, 0)
            busy_s = used.ru_utime + used.ru_stime
            spent = "  ".join(f"{name} {ms:.0f}" for name, ms in report["times_ms"].items())
            print(f"{path.stem:10} {busy_s:5.1f} s CPU {used.ru_maxrss / 1e3:6.0f} MB  ms: {spent}")


def main() -> None:
    filters.warm_up()
    if "--calibrate" in sys.argv:
        calibrate()
        return
    if "--scenes" in sys.argv:
        paths = sorted(SCENES.glob("*.toml"))
        shipped((path.stem, *load(path)) for path in paths)
        return
    if "--files" in sys.argv:
        files()
        return
    if "--oracle" in sys.argv:
        number = sys.argv[-1]
        oracle(int(number) if number.isdecimal() else 12, 3000 if "--large" in sys.argv else 480)
        return
    if "--large" in sys.argv:
        number = sys.argv[-1]
        photos(int(number) if number.isdecimal() else 8, 3000)
        return
    if "--photos" in sys.argv:
        number = sys.argv[-1]
        photos(int(number) if number.isdecimal() else 60)
        return
    repeats = 1 if "--quick" in sys.argv else 3
    ideal(20)
    if "--chains" not in sys.argv:
        points(repeats)
    chains(repeats)


if __name__ == "__main__":
    main()
