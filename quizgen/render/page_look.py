"""The look of pages that stand alone: tokens and components, colours of figures, the font."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from quizgen.figures.inks import write_theme_css
from quizgen.render.fonts import text_uri

FOLDER = Path(__file__).parent / "look"


@cache
def write_page_look() -> str:
    """Return the style of a page that stands alone, its font in Latin letters included."""
    face = (
        f'@font-face {{ font-family: "QuizText"; src: url({text_uri()}); font-weight: 200 900; }}'
    )
    return face + write_theme_css() + "".join(read_look(name) for name in ("look.css", "page.css"))


def read_look(name: str) -> str:
    """Return a style sheet of the shared look."""
    return (FOLDER / name).read_text(encoding="utf-8")
