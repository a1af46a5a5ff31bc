"""A first bank and first templates, to be changed: each sound as it is.

In: names. Out: files. Must never know: what is asked of whom.
"""

from __future__ import annotations

from importlib.metadata import version
from importlib.resources import files
from importlib.resources.abc import Traversable

from quizgen.bank.schemas import SCHEMAS, schema
from quizgen.locale import languages, sentences

KINDS = {
    "solver": "Something is computed (the usual kind).",
    "choice": "One of several options is right.",
    "claims": "Statements are true or false.",
    "match": "Pairs are found.",
    "order": "Steps are put in order.",
    "gap": "Words are missing in sentences.",
}
"""What a new template asks, as ``quizgen new template --help`` tells it."""

_HERE = files(__name__)
FIRST = ("example", "travel-time")
"""Topic and name of a new bank's first template."""


def new_bank(name: str, langs: tuple[str, ...]) -> dict[str, bytes]:
    """The files of a bank with one question, by their path in it.

    Parameters
    ----------
    name : str
        What it is called.
    langs : tuple of str
        Languages that it is to be written in; each begins with the English words.
    """
    blanks = {"BANK": name, "VERSION": version("quizgen")}
    blanks["LANGUAGES"] = ", ".join(f'"{lang}"' for lang in langs)
    blanks["TITLES"] = "\n".join(f'{lang} = "{_titled(name)}"' for lang in langs)
    blanks["EXAMPLES"] = ", ".join(f'{lang} = "Example"' for lang in langs)
    found = {
        "templates/bank.toml": _filled(_HERE / "bank.toml", blanks),
        **{f"schemas/{kind}.json": schema(kind) for kind in SCHEMAS},
        **new_template(*FIRST, "solver", langs),
    }
    for lang in langs:
        if lang not in languages():
            found |= new_language(lang)
    return found


def new_language(lang: str) -> dict[str, bytes]:
    """What a bank says of a language that quizgen has no words for, by path in the bank."""
    said = _filled(_HERE / "language.toml", {"LANG": lang})
    return {f"{_locale(lang)}/language.toml": said}


def english_words(lang: str) -> dict[str, bytes]:
    """All that quizgen says, to be translated, by path in the bank; what is left out stays."""
    return {f"{_locale(lang)}/{file.name}": file.read_bytes() for file in sentences()}


def _locale(lang: str) -> str:
    return f"templates/locale/{lang}"


def new_template(topic: str, name: str, kind: str, langs: tuple[str, ...]) -> dict[str, bytes]:
    """The files of a question, by their path in the bank.

    Parameters
    ----------
    topic, name : str
        Where it stands: ``templates/TOPIC/NAME``.
    kind : str
        One of ``KINDS``.
    langs : tuple of str
        Languages of the bank; each gets the English words, to be translated.
    """
    solver, folder = f"{topic}/{name.replace('-', '_')}", _HERE / kind
    blanks = {"TOPIC": topic, "SOLVER": solver, "TITLE": _titled(name)}
    found = {f"templates/{topic}/{name}/template.toml": _filled(folder / "template.toml", blanks)}
    for lang in langs:
        found[f"templates/{topic}/{name}/{lang}.md"] = _filled(folder / "en.md", blanks)
    if kind == "solver":
        found[f"solvers/{solver}.py"] = _filled(folder / "solver.py.txt", blanks)
    return found


def _filled(file: Traversable, blanks: dict[str, str]) -> bytes:
    text = file.read_text("utf-8")
    for name, value in blanks.items():
        text = text.replace(f"@{name}@", value)
    return text.encode()


def _titled(name: str) -> str:
    return name.replace("-", " ").replace("_", " ").capitalize()
