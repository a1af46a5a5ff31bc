"""``quizgen simulate``: photograph a scene and say what was left out."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypedDict, Unpack

import click

from quizgen.cli import contrast
from quizgen.cli.terminal import Progress, print_table, tell
from quizgen.errors import ChoiceError
from quizgen.files import write_all

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.camera.decision import Decision, Skipped, Step
    from quizgen.camera.scene import Precision
    from quizgen.camera.simulate import Photo

HEAD = ("effect", "", "DN", "ms", "took", "")
"""What an effect can change, what it was to take (or saves, if skipped), what it took."""
REALLY = (*HEAD[:3], "really", *HEAD[3:])
"""With what it really changes."""
SCENES = Path(__file__).parent.parent / "camera" / "scenes"


class Options(TypedDict):
    """What to run, and what to write."""

    budget: str
    question: tuple[str, ...]
    precision: Precision | None
    everything: bool
    compare: Path | None
    out: Path | None
    as_json: bool


@dataclass
class Shot:
    """A scene photographed: the picture, what it is compared with, and where the time went."""

    title: str
    photo: Photo
    whole: Photo | None
    single: Photo | None
    """The same effects in float32, where the picture is in float64."""
    seed: int
    idle: dict[str, str]
    """Settings that do nothing, and what they need."""
    exif: dict[str, float]
    """Settings that the photograph's file said, in base units."""
    really: dict[str, float]
    """What each effect really changes, where that was asked."""
    times: dict[str, float]
    """ms of reading, planning, drawing, the effects and writing."""

    @contextmanager
    def timed(self, what: str) -> Iterator[None]:
        """Count the time of what is done within."""
        started = perf_counter()
        yield
        self.times[what] = self.times.get(what, 0.0) + (perf_counter() - started) * 1e3


@click.command()
@click.argument("scene", required=False)
@click.option(
    "--budget",
    default="0.5",
    show_default=True,
    metavar="LEVELS",
    help="Largest tolerated change in 8-bit grey levels, or same (0.5), visible (2), sketch (8).",
)
@click.option("--question", multiple=True, metavar="KIND", help="Keep what decides this question.")
@click.option(
    "--precision",
    type=click.Choice(["float32", "float64"]),
    help="What to compute in; float64 also says what float32, the default, is off by.",
)
@click.option("--all", "everything", is_flag=True, help="Also run everything; show the difference.")
@click.option(
    "--compare",
    type=click.Path(path_type=Path, dir_okay=False),
    help="As --all, and write planned, everything and their difference here: .html, .png or .jpg.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    help="Write the picture here: .png or .jpg.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the plan as JSON.")
def simulate(scene: str | None, **options: Unpack[Options]) -> None:
    """Photograph SCENE (a TOML file, or the name of a shipped scene).

    Only effects that can be seen or are asked about are run. Without SCENE, the shipped scenes are
    listed.
    """
    if scene is None:
        _list_scenes()
        return
    contrast.check(options["compare"])
    encode = _writer(options["out"])
    with Progress("simulate:") as told:
        shot = _shoot(scene, options, told)
        _write(shot, options, encode)
    report = summary(shot)
    if options["as_json"]:
        click.echo(json.dumps(report, ensure_ascii=False, indent=1))
    else:
        _print(shot, report)
    if not report.get("promise_kept", True):
        click.echo(
            f"quizgen: broken: {report['predicted_error_dn']:.3g} DN at most were promised, "
            f"{report['difference_dn']:.3g} DN are found; please report this scene",
            err=True,
        )
        sys.exit(1)


def _shoot(scene: str, options: Options, told: Progress) -> Shot:
    from quizgen.camera import effects
    from quizgen.camera.compare import really
    from quizgen.camera.plan import Prepared, decided, everything
    from quizgen.camera.reading import load
    from quizgen.camera.simulate import run

    started = perf_counter()
    told("reading")
    prepared = Prepared(*load(_find(scene), options["precision"]))
    read = (perf_counter() - started) * 1e3
    told("planning")
    what = decided(prepared, options["question"] or None, options["budget"])
    planned = (perf_counter() - started) * 1e3 - read - prepared.drawn_ms
    again = options["everything"] or options["compare"] is not None
    photo = run(prepared, what, told, last=not again)
    times = {"read": read, "planned": planned, "drawn": photo.drawn_ms}
    seen, idle = prepared.given.scene, effects.idle(prepared.given)
    times["effects"] = photo.measured_ms
    single = _in_float32(scene, what, told) if seen.precision == "float64" else None
    shot = Shot(
        seen.title or scene, photo, None, single, seen.seed, idle, dict(seen.exif), {}, times
    )
    if again:
        shot.whole = run(prepared, everything(prepared), told)
    if options["compare"] is not None:
        shot.really = really(prepared, photo, told)
    return shot


def _in_float32(scene: str, what: Decision, told: Callable[[str], None]) -> Photo:
    from quizgen.camera.plan import Prepared
    from quizgen.camera.reading import load
    from quizgen.camera.simulate import run

    return run(Prepared(*load(_find(scene), "float32")), what, told, last=True)


def _write(shot: Shot, options: Options, encode: Callable[[NDArray[np.uint8]], bytes]) -> None:
    out, beside = options["out"], options["compare"]
    if out is not None:
        with shot.timed("written"):
            write_all(out.parent, {out.name: encode(shot.photo.pixels())})
    if beside is not None and shot.whole is not None:
        photos, told = (shot.photo, shot.whole), (REALLY, *_rows(shot))
        page = contrast.contents(beside, shot.title, photos, told, _in_parts(shot))
        write_all(beside.parent, {beside.name: page})


def _find(scene: str) -> Path:
    path, shipped = Path(scene), SCENES / f"{scene}.toml"
    plain = path.name == scene
    if path.exists() or not plain or path.suffix:
        return path
    if not shipped.exists():
        names = ", ".join(sorted(known.stem for known in SCENES.glob("*.toml")))
        raise ChoiceError(f"no scene {scene!r} (there are {names}; or the path of a TOML file)")
    return shipped


def _list_scenes() -> None:
    from quizgen.camera.reading import load

    for path in sorted(SCENES.glob("*.toml")):
        click.echo(f"{path.stem:14} {load(path)[0].title}")


def _writer(target: Path | None) -> Callable[[NDArray[np.uint8]], bytes]:
    """What encodes a picture for a file, by its ending; asked before anything is computed."""
    from quizgen.camera.codecs import WRITERS

    ending = ".png" if target is None else target.suffix.lower()
    if ending not in WRITERS:
        raise ChoiceError(f"cannot write {target} (endings: {', '.join(WRITERS)})")
    return WRITERS[ending]


def summary(shot: Shot) -> dict[str, Any]:
    """The plan as plain data; what everything gives only where it was run for comparison."""
    from quizgen.camera.simulate import difference_dn, farthest_dn, is_broken

    photo, whole, what = shot.photo, shot.whole, shot.photo.plan
    report: dict[str, Any] = {
        "ran": [step.effect for step in what.steps],
        "rungs": {step.effect: step.rung for step in what.steps if step.rung},
        "steps": [_step(step, shot) for step in what.steps],
        "skipped": [_skip(item, shot) for item in what.skipped],
        "levels": [
            {"above": level.above, "share": share, "ways": level.ways, "bound_dn": level.bound_dn}
            for share, level in zip(photo.shares[1:], what.levels.each, strict=True)
        ],
        "absent": list(what.absent),
        "idle": shot.idle,
        "exif": shot.exif,
        "seed": shot.seed,
        "precision": str(photo.values.dtype),
        "budget_dn": what.budget,
        "predicted_error_dn": what.predicted_error_dn,
        "predicted_ms": what.predicted_ms,
        "measured_ms": photo.measured_ms,
        "times_ms": shot.times,
    }
    if shot.single is not None:
        report["float32_difference_dn"] = farthest_dn(shot.single, photo)
        report["float32_ms"] = shot.single.measured_ms
    if whole is not None:
        report["difference_dn"] = difference_dn(photo, whole)
        report["everything_ms"] = whole.measured_ms
        report["promise_kept"] = not is_broken(photo, whole)
    return report


def _step(step: Step, shot: Shot) -> dict[str, Any]:
    return {
        "effect": step.effect,
        "rung": step.rung,
        "share": shot.photo.share(step.effect),
        "reason": step.reason,
        "bound_dn": step.bound_dn,
        "predicted_ms": step.predicted_ms,
        "measured_ms": shot.photo.times[step.effect],
        **_real(step.effect, shot),
    }


def _skip(item: Skipped, shot: Shot) -> dict[str, Any]:
    return {
        "effect": item.effect,
        "reason": item.reason,
        "bound_dn": item.bound_dn,
        "saved_ms": item.saved_ms,
        **_real(item.effect, shot),
    }


def _real(effect: str, shot: Shot) -> dict[str, float]:
    return {"really_dn": shot.really[effect]} if effect in shot.really else {}


def _print(shot: Shot, report: dict[str, Any]) -> None:
    click.echo(shot.title)
    if rows := list(_rows(shot)):
        print_table(REALLY if shot.really else HEAD, rows)
    _print_totals(shot, report)


def _rows(shot: Shot) -> Iterator[tuple[str, ...]]:
    """Rows of the table; what the column of grey levels says is not said again as a reason."""

    def cells(effect: str, state: str, bound: float) -> tuple[str, ...]:
        real = f"{shot.really[effect]:.3g}" if effect in shot.really else ""
        return effect, state, f"{bound:.3g}", *((real,) if shot.really else ())

    for step in shot.photo.plan.steps:
        times = f"{step.predicted_ms:.2f}", f"{shot.photo.times[step.effect]:.2f}"
        off = step.reason.partition("this rung is ")[2].removesuffix(" at most")
        rung = f"{step.rung}, {off}"
        why = rung if step.rung else "" if step.reason.startswith("may change") else step.reason
        share = shot.photo.share(step.effect)
        ran = "ran" if share == 1.0 else f"ran in {share:.0%}"
        yield *cells(step.effect, ran, step.bound_dn), *times, why
    for item in shot.photo.plan.skipped:
        yield *cells(item.effect, "skipped", item.bound_dn), f"{item.saved_ms:.2f}", "", ""


def _in_parts(shot: Shot) -> Iterator[str]:
    """What bright tiles of the picture do without."""
    photo = shot.photo
    for share, level in zip(photo.shares[1:], photo.what.levels.each, strict=True):
        without = [f"no {name}" for name, way in level.ways.items() if way == "skip"]
        cheaper = [f"{name} {way}" for name, way in level.ways.items() if way != "skip"]
        if share:
            yield (
                f"tiles with no value below {level.above:.3g} ({share:.0%} of the picture): "
                f"{', '.join(without + cheaper)}; {level.bound_dn:.3g} DN at most"
            )


def _print_totals(shot: Shot, report: dict[str, Any]) -> None:
    what, whole = shot.photo.plan, shot.whole
    if not what.steps and not what.skipped:
        tell("nothing is called for: the picture is the scene")
    for line in _in_parts(shot):
        tell(line)
    tell(
        f"error at most {report['predicted_error_dn']:.3g} DN of {report['budget_dn']:g} allowed; "
        f"effects {report['predicted_ms']:.1f} ms predicted, {report['measured_ms']:.1f} ms taken"
    )
    tell("; ".join(f"{name} {spent:.0f} ms" for name, spent in shot.times.items()))
    if shot.single is not None:
        tell(
            f"float64; the same effects in float32: {report['float32_ms']:.1f} ms, "
            f"difference {report['float32_difference_dn']:.3g} DN"
        )
    if what.absent:
        tell(f"not in this camera: {', '.join(what.absent)}")
    if shot.exif:
        said = ", ".join(f"{name} {value:g}" for name, value in shot.exif.items())
        tell(f"from the photograph's file: {said}")
    for name, need in shot.idle.items():
        tell(f"{name} does nothing without {need}")
    if whole is not None:
        tell(
            f"everything: {report['everything_ms']:.1f} ms, "
            f"difference {report['difference_dn']:.3g} DN"
        )
