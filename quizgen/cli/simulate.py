"""``quizgen simulate``: photograph a scene and say what was left out."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict, Unpack

import click

from quizgen.cli.terminal import print_table, tell
from quizgen.errors import ChoiceError
from quizgen.files import write_all

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from quizgen.camera.simulate import Photo

HEAD = ("effect", "", "DN", "ms", "took", "why")
"""What an effect can change, what it was to take (or saves, if skipped), what it took."""
SCENES = Path(__file__).parent.parent / "camera" / "scenes"


class Options(TypedDict):
    """What to run, and what to write."""

    budget: str
    question: tuple[str, ...]
    compare: bool
    out: Path | None
    as_json: bool


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
@click.option("--all", "compare", is_flag=True, help="Also run everything; show the difference.")
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
    from quizgen.camera.plan import Prepared, everything, plan
    from quizgen.camera.reading import load
    from quizgen.camera.simulate import run

    encode = _writer(options["out"])
    prepared = Prepared(*load(_find(scene)))
    question = options["question"] or None
    photo = run(prepared, plan(prepared, question=question, budget=options["budget"]))
    whole = run(prepared, everything(prepared)) if options["compare"] else None
    if options["out"] is not None:
        write_all(options["out"].parent, {options["out"].name: encode(photo.pixels())})
    report = summary(photo, whole)
    if options["as_json"]:
        click.echo(json.dumps(report, ensure_ascii=False, indent=1))
    else:
        _print(prepared.given.scene.title or scene, photo, whole, report)
    if not report.get("promise_kept", True):
        click.echo(
            f"quizgen: broken: {report['predicted_error_dn']:.3g} DN at most were promised, "
            f"{report['difference_dn']:.3g} DN are found; please report this scene",
            err=True,
        )
        sys.exit(1)


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


def summary(photo: Photo, whole: Photo | None = None) -> dict[str, Any]:
    """The plan as plain data; ``difference_dn`` only when everything was run for comparison."""
    from quizgen.camera.simulate import difference_dn, is_broken

    what = photo.plan
    report: dict[str, Any] = {
        "ran": [step.effect for step in what.steps],
        "rungs": {step.effect: step.rung for step in what.steps if step.rung},
        "skipped": [
            {
                "effect": item.effect,
                "reason": item.reason,
                "bound_dn": item.bound_dn,
                "saved_ms": item.saved_ms,
            }
            for item in what.skipped
        ],
        "absent": list(what.absent),
        "budget_dn": what.budget,
        "predicted_error_dn": what.predicted_error_dn,
        "predicted_ms": what.predicted_ms,
        "measured_ms": photo.measured_ms,
    }
    if whole is not None:
        report["difference_dn"] = difference_dn(photo, whole)
        report["everything_ms"] = whole.measured_ms
        report["promise_kept"] = not is_broken(photo, whole)
    return report


def _print(title: str, photo: Photo, whole: Photo | None, report: dict[str, Any]) -> None:
    click.echo(title)
    rows = [*_ran(photo), *_skipped(photo)]
    if rows:
        print_table(HEAD, rows)
    _print_totals(photo, whole, report)


def _ran(photo: Photo) -> Iterator[tuple[str, ...]]:
    for step in photo.plan.steps:
        times = f"{step.predicted_ms:.2f}", f"{photo.times[step.effect]:.2f}"
        why = f"as {step.rung}: {step.reason}" if step.rung else step.reason
        yield step.effect, "ran", f"{step.bound_dn:.3g}", *times, why


def _skipped(photo: Photo) -> Iterator[tuple[str, ...]]:
    for item in photo.plan.skipped:
        saved = f"{item.saved_ms:.2f}"
        yield item.effect, "skipped", f"{item.bound_dn:.3g}", saved, "", item.reason


def _print_totals(photo: Photo, whole: Photo | None, report: dict[str, Any]) -> None:
    if not photo.plan.steps and not photo.plan.skipped:
        tell("nothing is called for: the picture is the scene")
    tell(
        f"error at most {report['predicted_error_dn']:.3g} DN of {report['budget_dn']:g} allowed; "
        f"{report['predicted_ms']:.1f} ms predicted, {report['measured_ms']:.1f} ms measured"
    )
    if photo.plan.absent:
        tell(f"not in this camera: {', '.join(photo.plan.absent)}")
    if whole is not None:
        tell(
            f"everything: {report['everything_ms']:.1f} ms, "
            f"difference {report['difference_dn']:.3g} DN"
        )
