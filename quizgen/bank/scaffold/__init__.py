"""A first bank and first templates, to be changed: each sound as it is.

In: names. Out: files. Must never know: what is asked of whom.
"""

from __future__ import annotations

from importlib.metadata import version
from importlib.resources import files
from importlib.resources.abc import Traversable

from quizgen.bank.schemas import SCHEMAS, schema

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


def new_bank(name: str) -> dict[str, bytes]:
    """The files of a bank with one question, by their path in it."""
    blanks = {"BANK": name, "TITLE": _titled(name), "VERSION": version("quizgen")}
    return {
        "templates/bank.toml": _filled(_HERE / "bank.toml", blanks),
        **{f"schemas/{kind}.json": schema(kind) for kind in SCHEMAS},
        **new_template(*FIRST, "solver", ("en",)),
    }


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
