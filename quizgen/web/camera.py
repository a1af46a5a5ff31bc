"""The camera: sliders, the photograph with and without what is asked, and what was left out."""

from __future__ import annotations

import math
from base64 import b64encode

import msgspec
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from quizgen.core.decoding import prepare_type
from quizgen.core.errors import QuizgenError
from quizgen.web.photo import SCENES, CameraJob, CameraSlider, CameraView, camera_sliders
from quizgen.web.state import ServerState
from quizgen.web.views import page_response, request_language, translate_page

SIGNED = ("exposure", "k1")
"""Settings whose sign matters."""


def slider_position(request: Request, slider: CameraSlider) -> int:
    """Where a slider stands; where the scene has it, if it was not touched or is nowhere."""
    sent = request.query_params.get(slider.name, "")
    place = int(sent) if sent.isascii() and sent.isdecimal() and len(sent) < 3 else slider.own
    return place if place < len(slider.stops) else slider.own


def format_setting(lang: str, name: str, value: float) -> str:
    """A value of a setting, for people."""
    if math.isnan(value):
        return translate_page(lang, "camera.off")
    if math.isinf(value):
        return "∞"
    number = f"{value:+g}" if name in SIGNED and value else f"{value:g}"
    return translate_page(lang, f"camera.{name}_is", value=number.replace("-", "−"))


async def show_camera(request: Request) -> Response:
    """The photograph that the sliders ask for."""
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
        time=lambda seconds: _told_time(lang, seconds),
    )


def _list_picture_urls(shot: CameraView) -> list[tuple[str, str]]:
    """Name of each picture and its address."""
    found = [("taken", shot.taken)]
    if shot.scale:
        found += [("plain", shot.plain), ("difference", shot.difference)]
    return [(name, f"data:image/png;base64,{b64encode(data).decode()}") for name, data in found]


def _told_time(lang: str, seconds: float) -> str:
    """An exposure time as photographers write it."""
    told = f"{seconds:.2g}" if seconds >= 0.5 else f"1/{1.0 / seconds:.3g}"
    return translate_page(lang, "camera.seconds", value=told)


ROUTES = [Route("/camera", show_camera)]
