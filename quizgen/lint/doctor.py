"""What must be there for papers to look right: packages, fonts, glyphs."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version

from quizgen.bank.bank import builtin_bank
from quizgen.core.errors import EXTRA_MODULES, QuizgenError, has_extra
from quizgen.locale import PLACES, languages_in_script
from quizgen.render import fonts

PACKAGES = ("numpy", "sympy", "jinja2", "matplotlib", "python-flint", "mpmath", "click",
            "msgspec", "markdown-it-py", "typst", "fonttools")  # fmt: skip

CheckOutcome = tuple[str, str, bool]


def run_checks() -> Iterator[CheckOutcome]:
    """Yield name, result in words and success of each check of the installation."""
    yield "python", sys.version.split()[0], sys.version_info >= (3, 11)
    for package in PACKAGES:
        try:
            yield package, version(package), True
        except PackageNotFoundError:
            yield package, "not installed", False
    yield "extras", ", ".join(filter(has_extra, EXTRA_MODULES)), True
    yield from _check_fonts()
    yield _check_bank()


def _check_fonts() -> Iterator[CheckOutcome]:
    """Yield the checks of fonts: files, and a glyph for every Bangla character in use."""
    try:
        yield "Bangla font", fonts.bangla_file().name, True
        missing = fonts.missing_characters(all_bangla_text())
        shown = " ".join(f"U+{ord(c):04X}" for c in sorted(missing))
        yield "Bangla glyphs", shown or "every character has one", not missing
        names = (fonts.MATHS, fonts.ALL_MATHS, *fonts.BANGLA.values())
        yield "page fonts", f"{sum(map(len, map(fonts.read_web_font, names))) // 1000} kB", True
    except (QuizgenError, StopIteration) as error:
        yield "fonts", str(error), False


def _check_bank() -> CheckOutcome:
    """Return the check that the built-in bank loads."""
    try:
        count = sum(1 for _ in builtin_bank())
    except QuizgenError as error:
        return "templates", str(error), False
    return "templates", f"{count} load", count > 0


def all_bangla_text() -> str:
    """Return all Bangla words of interface and templates as one text: what fonts must cover."""
    langs = languages_in_script("Beng")
    paths = [
        *(
            entry
            for lang in langs
            for place in PLACES
            if (place / lang).is_dir()
            for entry in (place / lang).iterdir()
        ),
        *(
            folder / f"{lang}.md"
            for folder in builtin_bank().template_paths.values()
            for lang in langs
        ),
    ]
    return "".join(path.read_text(encoding="utf-8") for path in paths if path.is_file())
