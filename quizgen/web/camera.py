"""The camera: sliders, the photograph with and without what is asked, and what was left out."""

from __future__ import annotations

import math
from base64 import b64encode
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.bank.bank import Bank
from quizgen.core.decoding import prepare_type
from quizgen.core.errors import QuizgenError
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, request_language, translate_page

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from quizgen.camera.camera import Camera
    from quizgen.camera.question_photo import QuestionPhoto
    from quizgen.camera.setup.scene import Image, Scene

SIGNED = ("exposure", "k1")
"""Settings whose sign matters."""


def slider_position(request: Request, slider: CameraSlider) -> int:
    """Return the index of a slider's stop: the one requested, else that of the scene."""
    sent = request.query_params.get(slider.name, "")
    place = int(sent) if sent.isascii() and sent.isdecimal() and len(sent) < 3 else slider.own
    return place if place < len(slider.stops) else slider.own


def format_setting(lang: str, name: str, value: float) -> str:
    """Return the value of a camera setting in the words of a language."""
    if math.isnan(value):
        return translate_page(lang, "camera.off")
    if math.isinf(value):
        return "∞"
    number = f"{value:+g}" if name in SIGNED and value else f"{value:g}"
    return translate_page(lang, f"camera.{name}_is", value=number.replace("-", "−"))


async def show_camera(request: Request) -> Response:
    """Return the page with the photograph for the slider positions requested."""
    site: ServerState = request.app.state.site
    lang, asked = request_language(request), request.query_params
    scene = asked.get("scene", "") if asked.get("scene") in SCENES else SCENES[0]
    there = await run_in_threadpool(camera_sliders, scene)
    same = asked.get("before") == scene  # another scene begins with settings of its own
    places = {one.name: slider_position(request, one) if same else one.own for one in there}
    changes = tuple(
        (one.name, one.stops[places[one.name]]) for one in there if places[one.name] != one.own
    )
    effect = asked.get("effect", "") if same else ""
    try:
        data = await site.workers.get_result(
            CameraJob(scene, changes, effect), request.state.learner.id
        )
    except QuizgenError:
        shot = None
    else:
        prepare_type(CameraView)
        shot = msgspec.msgpack.decode(data, type=CameraView)
    return page_response(
        request,
        "camera.html.j2",
        scenes=SCENES,
        scene=scene,
        sliders=there,
        places=places,
        told=lambda name, value: format_setting(lang, name, value),
        shot=shot,
        pictures=_list_picture_urls(shot) if shot else [],
        time=lambda seconds: _format_exposure_time(lang, seconds),
    )


def _list_picture_urls(shot: CameraView) -> list[tuple[str, str]]:
    """Return name and data address of each picture of a photograph."""
    found = [("taken", shot.taken)]
    if shot.scale:
        found += [("plain", shot.plain), ("difference", shot.difference)]
    return [(name, f"data:image/png;base64,{b64encode(data).decode()}") for name, data in found]


def _format_exposure_time(lang: str, seconds: float) -> str:
    """Return an exposure time as photographers write it: ``1/125 s``."""
    told = f"{seconds:.2g}" if seconds >= 0.5 else f"1/{1.0 / seconds:.3g}"
    return translate_page(lang, "camera.seconds", value=told)


ROUTES = [Route("/camera", show_camera)]


SCENES = ("portrait", "landscape", "night", "texture", "flat", "propeller", "fisheye", "pinhole")
EVERYTHING = "everything"
"""Stands among the effects for all of them."""

OFF = math.nan
"""A camera that has not got the thing at all."""
LENS = frozenset({"f_number", "focus_distance", "k1"})
"""Settings that need a lens."""
SENSOR = frozenset({"read_noise", "full_well"})
"""Settings of a sensor that counts electrons."""

STOPS: dict[str, tuple[float, ...]] = {
    "f_number": (1, 1.4, 1.8, 2, 2.8, 4, 5.6, 8, 11, 16, 22, 32),
    "focus_distance": (0.5, 1, 1.5, 2, 2.5, 3, 5, 8, 12, 30, 100, 1200, math.inf),
    "exposure": (-4, -3, -2, -1, 0, 1, 2, 3, 4),
    "k1": (-0.4, -0.25, -0.1, -0.05, 0, 0.05, 0.1, 0.25, 0.4),
    "full_well": (100, 500, 2000, 5000, 15000, 20000, 30000, 60000, 200000),
    "read_noise": (0, 1, 2, 3, 6, 12, 25, 50, 100),
    "gaussian_noise": (0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2),
    "bit_depth": (OFF, 1, 2, 3, 4, 5, 6, 8, 10, 12, 14),
}
"""Where each slider can stand, in base units, and wherever the scene itself has it."""


class CameraSlider(msgspec.Struct, frozen=True):
    """A camera setting with its stops; ``own`` is the index of the scene's own value."""

    name: str
    stops: tuple[float, ...]
    own: int


class CameraView(msgspec.Struct, frozen=True):
    """A photograph with and without the chosen effect, as PNG, and what was measured."""

    taken: bytes
    plain: bytes
    """Without what is asked."""
    difference: bytes
    scale: int
    """What the difference was multiplied by; 0 where there is none."""
    asked: list[str]
    chosen: str
    """The effect that was chosen, or `EVERYTHING`; empty where the scene's question is asked."""
    effects: list[str]
    """What can be chosen."""
    ran: list[tuple[str, str]]
    """Effect, and why: ``asked``, ``set`` or ``needed``."""
    left_out: list[tuple[str, float]]
    """Effect, and grey levels that it can change at most."""
    absent: list[str]
    is_seen: bool
    needs_colour: bool
    share: float
    """Of the pixels, where it is seen."""
    mean: float
    """Mean difference there, in grey levels."""
    exposed: tuple[float, float] | None
    """Exposure time that keeps the brightness at another f-number, and the scene's own, s."""


@dataclass(frozen=True)
class CameraJob:
    """Renders a shipped scene with changed camera settings."""

    scene: str
    changes: tuple[tuple[str, float], ...]
    effect: str = ""

    def run(self, bank: Bank) -> bytes:
        """Return the photograph with and without the chosen effect, as JSON.

        Raises
        ------
        SceneError
            If no camera can be set like that.
        """
        del bank
        from quizgen.camera.comparison import amplify_difference
        from quizgen.camera.planner import PreparedScene
        from quizgen.camera.scene_file import load_scene

        scene, own = load_scene(_find_scene_file(self.scene))
        camera = self._apply_changes(own)
        prepared = PreparedScene(scene, camera)
        found = [one.name for one in prepared.present if not one.always]
        chosen = self.effect if self.effect in (*found, EVERYTHING) else ""
        taken = self._take_photo(scene, camera, found, chosen)
        scale, apart = amplify_difference(taken.photo.values, taken.without.values)
        return msgspec.msgpack.encode(
            CameraView(
                taken=_encode_picture(taken.photo.values),
                plain=_encode_picture(taken.without.values),
                difference=_encode_png(apart),
                scale=scale if apart.any() else 0,
                asked=list(taken.plan.asked),
                chosen=chosen,
                effects=[*found, EVERYTHING] if found else [],
                ran=list(_iter_run_effects(taken)),
                left_out=[(one.effect, one.bound_dn) for one in taken.plan.left_out],
                absent=list(prepared.absent),
                is_seen=any(one.is_visible for one in taken.seen),
                needs_colour=taken.needs_colour,
                share=max([one.share for one in taken.seen], default=0.0),
                mean=max([one.mean for one in taken.seen], default=0.0),
                exposed=_find_exposure_time(own, camera),
            )
        )

    def _take_photo(
        self, scene: Scene, camera: Camera, found: list[str], chosen: str
    ) -> QuestionPhoto:
        """Return the photograph with the chosen effect and those whose settings were changed."""
        from quizgen.camera.planner import EffectSelection
        from quizgen.camera.question_photo import take_question_photo

        if chosen == EVERYTHING:
            only = tuple(found)
        else:
            only = (chosen,) if chosen else () if scene.question else tuple(found[:1])
        plus = tuple(name for name in self._set_effects() if name in found)
        return take_question_photo(scene, camera, chosen=EffectSelection(only, plus))

    def _set_effects(self) -> Iterator[str]:
        """Yield the effects whose settings were changed."""
        from quizgen.camera import effects

        changed = dict(self.changes)
        for name, effect in _EFFECTS.items():
            if name in changed:
                yield effect
        for one in effects.EFFECTS:
            if any(setting.name in changed for setting in one.settings):
                yield one.name

    def _apply_changes(self, camera: Camera) -> Camera:
        """Return the camera with the changed settings."""
        changes: dict[str, object] = dict(self.changes)
        if "bit_depth" in changes:
            bits = dict(self.changes)["bit_depth"]
            changes["bit_depth"] = None if math.isnan(bits) else int(bits)
        return camera.replace(**changes)


def _find_scene_file(scene: str) -> Path:
    """Return the file of a shipped scene."""
    return Path(str(files("quizgen.camera") / "scenes" / f"{scene}.toml"))


_EFFECTS = {"f_number": "defocus", "focus_distance": "defocus", "full_well": "shot noise"}
"""What shows settings that belong to the camera's body."""


def _iter_run_effects(taken: QuestionPhoto) -> Iterator[tuple[str, str]]:
    """Yield each effect that ran and why: ``asked``, ``set`` or ``needed``."""
    why = {"asked": "asked", "wanted": "set"}
    for step in taken.plan.steps:
        yield step.effect, why.get(step.why, "needed")


def _find_exposure_time(own: Camera, camera: Camera) -> tuple[float, float] | None:
    """Return the time (s) that keeps the exposure at a changed f-number, and the present one.

    None if the aperture is unchanged or a setting is missing.
    """
    from quizgen.camera.setup.settings import F_NUMBER, SHUTTER

    before, after, time = own[F_NUMBER], camera[F_NUMBER], own[SHUTTER]
    if before is None or after is None or before == after or not time:
        return None
    return time * (after / before) ** 2, time


def _encode_picture(values: Image) -> bytes:
    """Return a linear picture (0 to 1) as PNG bytes."""
    import numpy as np

    from quizgen.camera.pixels.codes import to_8bit

    return _encode_png(to_8bit(values * np.float32(255)))


def _encode_png(codes: NDArray[np.uint8]) -> bytes:
    """Return 8-bit codes as PNG bytes."""
    from quizgen.camera.pixels.codecs import encode_photo

    return encode_photo(codes)


@cache
def camera_sliders(scene: str) -> tuple[CameraSlider, ...]:
    """Return the sliders that make sense for a scene's camera."""
    from quizgen.camera import effects
    from quizgen.camera.scene_file import load_scene

    camera = load_scene(_find_scene_file(scene))[1]
    lens = {"focal_length", "pixel_pitch"} <= camera.given.keys()
    known = effects.all_settings()
    found = []
    for name, stops in STOPS.items():
        if (name in LENS and not lens) or (name in SENSOR and "full_well" not in camera.given):
            continue
        value = camera.given.get(name, known[name].identity)
        own = OFF if value is None else float(str(value))
        places = tuple(sorted({*stops, own} - {OFF}, key=float))
        places = (OFF, *places) if OFF in stops or math.isnan(own) else places
        found.append(CameraSlider(name, places, _find_stop_index(places, own)))
    return tuple(found)


def _find_stop_index(stops: tuple[float, ...], value: float) -> int:
    """Return the index of a value among the stops; NaN (off) is the first."""
    return 0 if math.isnan(value) else stops.index(value)
