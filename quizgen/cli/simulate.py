"""``quizgen simulate``: photograph a scene for what is asked, and say what was left out."""

from __future__ import annotations

import json
import sys
from base64 import b64encode
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypedDict, Unpack

import click

from quizgen.cli.terminal import ProgressLine, print_sentence, print_table
from quizgen.core.errors import InvalidChoiceError
from quizgen.core.files import write_all

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from quizgen.camera.comparison import Codes, Race
    from quizgen.camera.planner import EffectChoice, EffectSelection, Plan, PreparedScene
    from quizgen.camera.question_photo import QuestionPhoto, Visibility
    from quizgen.camera.setup.scene import Precision
    from quizgen.camera.simulation import Photo


HEAD = ("effect", "", "at most", "took", "")
"""What leaving an effect out can change, in grey levels, and the ms it took."""
REALLY = (*HEAD[:3], "really", *HEAD[3:])
"""With what it really changes."""
SCENES = Path(__file__).parent.parent / "camera" / "scenes"


class SimulateOptions(TypedDict):
    """Options of ``quizgen simulate``."""

    asks: tuple[str, ...]
    only: tuple[str, ...]
    plus: tuple[str, ...]
    minus: tuple[str, ...]
    budget: str | None
    precision: Precision | None
    everything: bool
    compare: Path | None
    out: Path | None
    as_json: bool


@dataclass
class SimulatedShot:
    """A rendered scene: its pictures, what they are compared with, and times in ms."""

    title: str
    prepared: PreparedScene
    plan: Plan
    photo: Photo
    taken: QuestionPhoto | None = None
    """The photograph with and without what is asked, where something is."""
    whole: Photo | None = None
    single: Photo | None = None
    """The same effects in float32, where the picture is in float64."""
    race: Race | None = None
    really: dict[str, float] = field(default_factory=dict)
    """Grey levels that each effect really changes, where that was wanted."""
    times: dict[str, float] = field(default_factory=dict)
    """ms of reading, planning, drawing, the effects and writing."""

    @contextmanager
    def measure_time(self, what: str) -> Iterator[None]:
        """Add the milliseconds of the body of ``with`` to ``times[what]``."""
        started = perf_counter()
        yield
        self.times[what] = self.times.get(what, 0.0) + (perf_counter() - started) * 1e3


def _make_effect_option(*flags: str, name: str, text: str) -> Callable[[Any], Any]:
    """Return a decorator that adds an option naming effects, which may be repeated."""
    return click.option(*flags, name, multiple=True, metavar="EFFECT", help=text)


@click.command()
@click.argument("scene", required=False)
@click.option("--asks", multiple=True, metavar="KIND", help="Ask this instead of the scene's own.")
@_make_effect_option(
    "--only", name="only", text="Run this effect, what it needs, and nothing else."
)
@_make_effect_option("--with", name="plus", text="Run this effect, too.")
@_make_effect_option("--without", name="minus", text="Leave this effect out.")
@click.option(
    "--budget",
    metavar="LEVELS",
    help="Ask nothing; leave out what changes no value by more than so many 8-bit grey levels, or "
    "same (0.5, where nothing is asked), visible (2), sketch (8).",
)
@click.option(
    "--precision",
    type=click.Choice(["float32", "float64"]),
    help="What to compute in; float64 also says what float32, the default, is off by.",
)
@click.option(
    "--everything",
    is_flag=True,
    help="Run every effect of the camera, and say how it differs and how long both take.",
)
@click.option(
    "--compare",
    type=click.Path(path_type=Path, dir_okay=False),
    help="Write the picture with and without what is asked, and their difference: .html, .png, "
    ".jpg.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    help="Write the picture here: .png or .jpg.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
def simulate(scene: str | None, **options: Unpack[SimulateOptions]) -> None:
    """Photograph SCENE (a TOML file, or the name of a shipped scene).

    Runs what the scene's question asks about and what its picture would be wrong without, measures
    that it can be seen, and says what was left out. Without SCENE, the shipped scenes are listed.
    """
    if scene is None:
        _list_scenes()
        return
    check_target(options["compare"], ".html")
    check_target(options["out"])
    with ProgressLine("simulate:") as told:
        shot = _simulate_scene(scene, options, told)
        _write_pictures(shot, options)
    report = summarise(shot)
    if options["as_json"]:
        click.echo(json.dumps(report, ensure_ascii=False, indent=1))
    else:
        _print_report(shot, report)
    if not report.get("everything", {}).get("bound_kept", True):
        click.echo(
            f"quizgen: broken: {shot.plan.bound_dn:.3g} grey levels at most were promised, "
            f"{report['everything']['difference_dn']:.3g} are found; please report this scene",
            err=True,
        )
        sys.exit(1)


def _simulate_scene(scene: str, options: SimulateOptions, told: ProgressLine) -> SimulatedShot:
    """Return a scene rendered and compared as the options ask; ``told`` shows progress."""
    from quizgen.camera.comparison import measure_effects, time_in_turns
    from quizgen.camera.planner import PreparedScene
    from quizgen.camera.scene_file import load_scene
    from quizgen.camera.simulation import run_plan

    started = perf_counter()
    told("reading")
    prepared = PreparedScene(*load_scene(_find_scene(scene), options["precision"]))
    read = (perf_counter() - started) * 1e3
    shot = _take_photo(scene, prepared, options, told)
    shot.times = {"read": read, "drawn": shot.photo.drawn_ms, "effects": shot.photo.measured_ms}
    if prepared.given.scene.precision == "float64":
        single = PreparedScene(*load_scene(_find_scene(scene), "float32"), shot.plan.names)
        shot.single = run_plan(single, on_effect=told, last=True)
    if options["everything"] or (options["compare"] is not None and shot.taken is None):
        shot.whole = run_plan(prepared, on_effect=told)
    if options["everything"]:
        told("timing")
        shot.race = time_in_turns(prepared, shot.plan.names, [one.name for one in prepared.present])
    if options["compare"] is not None:
        shot.really = measure_effects(
            prepared, run_plan(prepared, shot.plan.names), shot.plan.names, told
        )
    return shot


def _take_photo(
    scene: str, prepared: PreparedScene, options: SimulateOptions, told: ProgressLine
) -> SimulatedShot:
    """Return a scene rendered for its question, or within a budget if nothing is asked."""
    from quizgen.camera.planner import plan_budget
    from quizgen.camera.question_photo import photograph_question, take_question_photo
    from quizgen.camera.simulation import run_plan

    seen, chosen = prepared.given.scene, _parse_selection(options)
    asks = options["asks"] or (seen.question.asks if seen.question else ())
    title = seen.title or scene
    if options["budget"] is not None and (options["asks"] or options["only"]):
        raise InvalidChoiceError(
            "--budget is for pictures without a question; leave out --asks or --only"
        )
    if options["budget"] is None and (asks or chosen.only):
        # who chooses effects by name may look at what cannot be seen
        take = take_question_photo if chosen.only or chosen.minus else photograph_question
        taken = take(seen, prepared.camera, options["asks"], chosen=chosen, on_effect=told)
        return SimulatedShot(title, prepared, taken.plan, taken.photo, taken)
    plan = plan_budget(prepared, options["budget"] or "same", chosen)
    again = options["everything"] or options["compare"] is not None
    return SimulatedShot(
        title, prepared, plan, run_plan(prepared, plan.names, told, last=not again)
    )


def _parse_selection(options: SimulateOptions) -> EffectSelection:
    """Return the effects that the options run alone, add or leave out."""
    from quizgen.camera.planner import EffectSelection, parse_effect

    only, plus, minus = (
        tuple(map(parse_effect, options[way])) for way in ("only", "plus", "minus")
    )
    return EffectSelection(only, plus, minus)


def _write_pictures(shot: SimulatedShot, options: SimulateOptions) -> None:
    """Write the picture and the comparison, if files are named for them."""
    from quizgen.camera.pixels.codecs import WRITERS

    out, beside = options["out"], options["compare"]
    if out is not None:
        photo = shot.whole if options["everything"] and shot.whole else shot.photo
        with shot.measure_time("written"):
            write_all(out.parent, {out.name: WRITERS[out.suffix.lower()](photo.pixels())})
    if beside is not None:
        told = (REALLY, *_iter_table_rows(shot))
        page = comparison_file(
            beside, shot.title, _choose_pictures(shot), told, _iter_plan_sentences(shot)
        )
        write_all(beside.parent, {beside.name: page})


def _choose_pictures(shot: SimulatedShot) -> dict[str, Photo]:
    """Return two pictures to compare, by what they show."""
    if shot.taken is not None:
        asked = ", ".join(shot.plan.asked)
        return {f"with {asked}": shot.photo, f"without {asked}": shot.taken.without}
    return {"what is run": shot.photo, "everything": shot.whole or shot.photo}


def _find_scene(scene: str) -> Path:
    """Return the file of a scene, given as a path or as the name of a shipped one."""
    path, shipped = Path(scene), SCENES / f"{scene}.toml"
    plain = path.name == scene
    if path.exists() or not plain or path.suffix:
        return path
    if not shipped.exists():
        names = ", ".join(sorted(known.stem for known in SCENES.glob("*.toml")))
        raise InvalidChoiceError(
            f"no scene {scene!r} (there are {names}; or the path of a TOML file)"
        )
    return shipped


def _list_scenes() -> None:
    """Print name and title of each shipped scene."""
    from quizgen.camera.scene_file import load_scene

    for path in sorted(SCENES.glob("*.toml")):
        click.echo(f"{path.stem:14} {load_scene(path)[0].title}")


def summarise(shot: SimulatedShot) -> dict[str, Any]:
    """Return the report as plain data; the full rendering only if it was made."""
    from quizgen.camera import effects
    from quizgen.camera.simulation import measure_difference

    plan, seen = shot.plan, shot.prepared.given.scene
    report: dict[str, Any] = {
        "ran": list(plan.names),
        "steps": [_format_choice_json(step, shot) for step in plan.steps],
        "left_out": [_format_choice_json(item, shot) for item in plan.left_out],
        "absent": list(plan.absent),
        "asked": list(plan.asked),
        "idle": effects.ineffective_settings(shot.prepared.given),
        "exif": dict(seen.exif),
        "seed": seen.seed,
        "precision": str(shot.photo.values.dtype),
        "budget_dn": plan.budget,
        "bound_dn": plan.bound_dn,
        "measured_ms": shot.photo.measured_ms,
        "times_ms": shot.times,
    }
    if shot.taken is not None:
        report["seen"] = [_format_visibility_json(one) for one in shot.taken.seen]
        report["readings"] = shot.taken.readings
    if shot.single is not None:
        report["float32_difference_dn"] = measure_difference(shot.single, shot.photo)
        report["float32_ms"] = shot.single.measured_ms
    if shot.race is not None and shot.whole is not None:
        report["everything"] = _format_full_run_json(shot, shot.race, shot.whole)
    return report


def _format_choice_json(choice: EffectChoice, shot: SimulatedShot) -> dict[str, Any]:
    """Return why an effect was chosen and what it did, as plain data."""
    told: dict[str, Any] = {
        "effect": choice.effect,
        "why": choice.why,
        "does": choice.says,
        "bound_dn": choice.bound_dn,
    }
    if choice.effect in shot.photo.times:
        told["measured_ms"] = shot.photo.times[choice.effect]
    if choice.effect in shot.really:
        told["really_dn"] = shot.really[choice.effect]
    return told


def _format_visibility_json(seen: Visibility) -> dict[str, Any]:
    """Return how visible an effect is, as plain data."""
    return {
        "kind": seen.kind,
        "is_visible": seen.is_visible,
        "needs_colour": seen.needs_colour,
        "explanation": seen.explain(),
        "share": seen.share,
        "mean_dn": seen.mean,
        "spread_dn": seen.spread,
    }


def _format_full_run_json(shot: SimulatedShot, race: Race, whole: Photo) -> dict[str, Any]:
    """Return how the picture differs from one with every effect, as plain data."""
    from quizgen.camera.simulation import is_within, measure_difference

    return {
        "difference_dn": measure_difference(shot.photo, whole),
        "bound_kept": is_within(shot.plan.bound_dn, shot.photo, whole),
        "ms": race.second_ms,
        "chosen_ms": race.first_ms,
        "saves_time": race.saves,
    }


def _print_report(shot: SimulatedShot, report: dict[str, Any]) -> None:
    """Print the table of effects and the sentences below it."""
    click.echo(shot.title)
    if rows := list(_iter_table_rows(shot)):
        print_table(REALLY if shot.really else HEAD, rows)
    for line in (*_iter_plan_sentences(shot), *_iter_total_lines(shot, report)):
        print_sentence(line)


def _iter_table_rows(shot: SimulatedShot) -> Iterator[tuple[str, ...]]:
    """Yield effect, state, bound (grey levels), time (ms) and reason of each effect."""
    plan = shot.plan
    for state, choice in [*(("ran", x) for x in plan.steps), *(("", x) for x in plan.left_out)]:
        bound = "any" if choice.bound_dn >= 255.0 else f"{choice.bound_dn:.3g}"
        really = (f"{shot.really[choice.effect]:.3g}",) if choice.effect in shot.really else ("",)
        took = f"{shot.photo.times.get(choice.effect, 0.0):.2f}" if state else ""
        why = choice.why if state else "left out"
        yield choice.effect, state, bound, *(really if shot.really else ()), took, why


def _iter_plan_sentences(shot: SimulatedShot) -> Iterator[str]:
    """Yield sentences on what was left out and why, and on what is visible."""
    plan = shot.plan
    for item in plan.left_out:
        yield f"{item.effect}: {item.why}; would {item.says}"
    if not plan.steps and not plan.left_out:
        yield "nothing is called for: the picture is the scene"
    for seen in shot.taken.seen if shot.taken else ():
        state = "is seen" if seen.is_visible else "is not seen"
        grey = " (only in colour)" if seen.needs_colour else ""
        yield f"{seen.kind} {state}{grey}: {seen.explain()}"
    for name, value in shot.taken.readings.items() if shot.taken else ():
        yield f"{name} is read as {value:.4g}"


def _iter_total_lines(shot: SimulatedShot, report: dict[str, Any]) -> Iterator[str]:
    """Yield sentences on the whole: bound, times, float32, the full rendering."""
    plan = shot.plan
    if plan.budget is not None:
        yield (
            f"at most {plan.bound_dn:.3g} grey levels from everything, of {plan.budget:g} allowed"
        )
    yield "; ".join(f"{name} {spent:.0f} ms" for name, spent in shot.times.items())
    if shot.single is not None:
        yield (
            f"float64; the same effects in float32: {report['float32_ms']:.1f} ms, "
            f"difference {report['float32_difference_dn']:.3g} grey levels"
        )
    if plan.absent:
        yield f"not in this camera: {', '.join(plan.absent)}"
    if report["exif"]:
        said = ", ".join(f"{name} {value:g}" for name, value in report["exif"].items())
        yield f"from the photograph's file: {said}"
    for name, need in report["idle"].items():
        yield f"{name} does nothing without {need}"
    if shot.race is not None:
        yield from _iter_race_sentences(shot.race, report["everything"]["difference_dn"])


def _iter_race_sentences(race: Race, difference: float) -> Iterator[str]:
    """Yield sentences on difference (grey levels) and time of the full rendering."""
    yield f"everything: really {difference:.3g} grey levels apart"
    chosen, whole = race.medians
    yield (
        f"what was run {_format_milliseconds(chosen, race.first_ms)}, everything "
        f"{_format_milliseconds(whole, race.second_ms)}: "
        f"medians of {len(race.first_ms)} turns, both warm"
    )
    if not race.saves:
        yield "leaving out saves no time here"


def _format_milliseconds(middle: float, times: tuple[float, ...]) -> str:
    """Return a median and the range of times (sorted, ms) in words."""
    return f"{middle:.1f} ms ({times[0]:.1f} to {times[-1]:.1f})"


_STYLE = """
body { font: 16px/1.4 system-ui, sans-serif; margin: 1.5em; color: #1b1f24; background: #fff }
.pictures { display: flex; flex-wrap: wrap; gap: 1em }
figure { margin: 0; flex: 1 1 20em; max-width: 48em }
img { width: 100%; image-rendering: pixelated }
.table { overflow-x: auto }
table { border-collapse: collapse; margin: 1em 0 }
th, td { text-align: left; padding: .2em .8em .2em 0; border-bottom: 1px solid #d0d7de }
@media (max-width: 34em) {
  body { margin: 1em }
  table { font-size: .75em }
  th, td { padding-right: .4em }
}
"""


def check_target(target: Path | None, *more: str) -> None:
    """Raise ``InvalidChoiceError`` for a file that no picture can be written to.

    Called before anything is computed: an unknown suffix must not cost a rendering.

    Parameters
    ----------
    target : Path or None
    *more : str
        Endings besides those of pictures.

    Raises
    ------
    InvalidChoiceError
        Naming the endings there are.
    """
    from quizgen.camera.pixels.codecs import WRITERS

    endings = (*WRITERS, *more)
    if target is not None and target.suffix.lower() not in endings:
        raise InvalidChoiceError(f"cannot write {target} (endings: {', '.join(endings)})")


def comparison_file(
    target: Path,
    title: str,
    photos: Mapping[str, Photo],
    told: tuple[Sequence[str], ...],
    notes: Iterable[str] = (),
) -> bytes:
    """Return the bytes of a file with two pictures and their difference.

    Parameters
    ----------
    target : Path
        ``.html`` for a page with the table, else three pictures beside each other.
    title : str
        The scene's.
    photos : mapping of str to Photo
        Two pictures, by what they show.
    told : tuple of sequence of str
        Head and rows of the table.
    notes : iterable of str
        Sentences below it.
    """
    from quizgen.camera.comparison import amplify_difference, concatenate_pictures
    from quizgen.camera.pixels.codecs import WRITERS

    one, other = photos.values()
    scale, apart = amplify_difference(one.values, other.values)
    pictures = one.pixels(), other.pixels(), _write_on(apart, f"difference x {scale}")
    if target.suffix.lower() != ".html":
        return WRITERS[target.suffix.lower()](concatenate_pictures(*pictures))
    names = *photos, f"difference × {scale}"
    return _render_page(title, zip(names, pictures, strict=True), told, notes).encode()


def _write_on(codes: Codes, text: str) -> Codes:
    """Return a picture with a text in its corner."""
    import numpy as np
    from PIL import Image, ImageDraw, ImageFont

    picture = Image.fromarray(codes)
    size = max(8, codes.shape[0] // 24)
    font = ImageFont.load_default(size)
    ImageDraw.Draw(picture).text(
        (size // 2, size // 2), text, (255, 255, 255), font, stroke_width=1, stroke_fill=(0, 0, 0)
    )
    return np.asarray(picture)


def _render_page(
    title: str,
    pictures: Iterable[tuple[str, Codes]],
    told: tuple[Sequence[str], ...],
    notes: Iterable[str],
) -> str:
    """Return the HTML page of a comparison."""
    head, *rows = told
    figures = "".join(_render_figure(name, codes) for name, codes in pictures)
    body = "".join(_render_table_row("td", row) for row in rows)
    below = "".join(f"<p>{escape(note)}</p>\n" for note in notes)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width">\n'
        f"<title>{escape(title)}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n"
        f'<h1>{escape(title)}</h1>\n<div class="pictures">\n{figures}</div>\n'
        f'<div class="table">\n<table>\n<thead>{_render_table_row("th", head)}</thead>\n'
        f"<tbody>\n{body}</tbody>\n</table>\n</div>\n{below}</body>\n</html>\n"
    )


def _render_figure(name: str, codes: Codes) -> str:
    """Return a picture as an HTML figure with its name."""
    from quizgen.camera.pixels.codecs import encode_photo

    data = b64encode(encode_photo(codes)).decode()
    source = f"data:image/png;base64,{data}"
    label = escape(name)
    return f'<figure><img src="{source}" alt="{label}"><figcaption>{label}</figcaption></figure>\n'


def _render_table_row(cell: str, texts: Sequence[str]) -> str:
    """Return texts as an HTML table row of ``td`` or ``th``."""
    return "<tr>" + "".join(f"<{cell}>{escape(text)}</{cell}>" for text in texts) + "</tr>\n"
