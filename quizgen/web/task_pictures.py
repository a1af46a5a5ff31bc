"""The picture on the card of a task: its figure, or a sketch of its formula."""

from __future__ import annotations

from dataclasses import dataclass

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.routing import Route

from quizgen.bank.bank import Bank
from quizgen.bank.formulas import read_formulas
from quizgen.figures import Figure
from quizgen.locale import fallback_language
from quizgen.question.compose import compose_variant, draw_instance
from quizgen.question.formula_sheet import draw_sketch
from quizgen.web.state import ServerState

SEED = "card"
"""The numbers of the figure on a card: always the same, so that one knows the task by it."""
DAY = 86_400


@dataclass(frozen=True)
class TaskPictureJob:
    """Draws the picture of a template as SVG; empty if there is none."""

    template: str

    def run(self, bank: Bank) -> bytes:
        """Return the SVG."""
        figure = find_task_figure(bank, self.template)
        return figure.standalone_svg if figure else b""


def find_task_figure(bank: Bank, template: str) -> Figure | None:
    """Return the figure of a template, else the sketch of a formula it is about, else None."""
    lang = fallback_language(next(iter(bank.template_languages(template))))
    question, _ = compose_variant(draw_instance(bank.template(template), SEED), lang)
    if question.figure is not None:
        return question.figure
    rules = bank.rules(template)
    entries = read_formulas(bank)
    about = [entry for entry in entries if entry.id in rules.covers]
    of_topic = [entry for entry in entries if entry.topic == rules.topic]
    sketches = (draw_sketch(bank, entry, (lang,)) for entry in (*about, *of_topic))
    return next((found[0] for found in sketches if found), None)


async def show_task_picture(request: Request) -> Response:
    """Return the picture of a template (SVG), or the address of a sign where there is none."""
    site: ServerState = request.app.state.site
    template = request.path_params["template"]
    if template not in site.bank.template_paths:
        raise HTTPException(404)
    data = await site.workers.get_result(TaskPictureJob(template), request.state.learner.id)
    if not data:  # the sign of the pages
        return RedirectResponse("/static/icon.svg")
    return Response(
        data, media_type="image/svg+xml", headers={"cache-control": f"private, max-age={DAY}"}
    )


ROUTES = [Route("/picture/{template:path}", show_task_picture)]
