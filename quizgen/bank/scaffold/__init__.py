"""A first bank and first templates, to be changed: each sound as it is.

In: names. Out: files. Must never know: what is asked of whom.
"""

from __future__ import annotations

import re
import tomllib
from importlib.metadata import version
from importlib.resources import files
from importlib.resources.abc import Traversable

from quizgen.bank.json_schema import SCHEMAS, build_json_schema
from quizgen.locale import FIRST as ENGLISH
from quizgen.locale import list_languages, translatable_files

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
"""Topic and name of a new bank's first template, an example from life."""


def scaffold_bank(name: str, langs: tuple[str, ...]) -> dict[str, bytes]:
    """Return the files of a bank with one question, by their path in it.

    Parameters
    ----------
    name : str
        What it is called.
    langs : tuple of str
        Languages that it is to be written in; one that no example is in begins with English words.
    """
    blanks = {"BANK": name, "VERSION": version("quizgen")}
    blanks["LANGUAGES"] = ", ".join(f'"{lang}"' for lang in langs)
    blanks["TITLES"] = "\n".join(f'{lang} = "{_make_title_from_name(name)}"' for lang in langs)
    example = tomllib.loads((_HERE / "example.toml").read_text("utf-8"))
    blanks["EXAMPLES"] = ", ".join(
        f'{lang} = "{example.get(lang, example[ENGLISH])}"' for lang in langs
    )
    found = {
        "templates/bank.toml": _fill_scaffold_file(_HERE / "bank.toml", blanks, langs[0]),
        **{f"schemas/{kind}.json": build_json_schema(kind) for kind in SCHEMAS},
        **scaffold_template(*FIRST, FIRST[1], langs),
    }
    for lang in langs:
        if lang not in list_languages():
            found |= scaffold_language(lang)
    return found


def scaffold_package(name: str, langs: tuple[str, ...]) -> tuple[str, dict[str, bytes]]:
    """Return where the bank of a package stands in it, and the files of both by path.

    Parameters
    ----------
    name : str
        What the bank is called.
    langs : tuple of str
        As for ``scaffold_bank``.
    """
    word = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
    module = f"bank_of_{word}"
    blanks = {"BANK": name, "VERSION": version("quizgen"), "MODULE": module, "ENTRY": word}
    blanks["PROJECT"] = module.replace("_", "-")
    source = _HERE / "package"
    return module, {
        "pyproject.toml": _fill_scaffold_file(source / "pyproject.toml.txt", blanks, langs[0]),
        ".github/workflows/lint.yml": _fill_scaffold_file(
            source / "lint.yml.txt", blanks, langs[0]
        ),
        f"{module}/__init__.py": f'"""Questions for quizgen: {name}."""\n'.encode(),
        **{f"{module}/{path}": data for path, data in scaffold_bank(name, langs).items()},
    }


def scaffold_language(lang: str) -> dict[str, bytes]:
    """Return what a bank says of a language that quizgen has no words for, by path."""
    said = _fill_scaffold_file(_HERE / "language.toml", {"LANG": lang})
    return {f"{_locate_locale_folder(lang)}/language.toml": said}


def english_translation_files(lang: str) -> dict[str, bytes]:
    """Return the sentences of quizgen to be translated, by path; what is left out stays English."""
    return {
        f"{_locate_locale_folder(lang)}/{file.name}": file.read_bytes()
        for file in translatable_files()
    }


def _locate_locale_folder(lang: str) -> str:
    """Return where a bank keeps its own words of a language, relative to its root."""
    return f"templates/locale/{lang}"


def scaffold_template(topic: str, name: str, kind: str, langs: tuple[str, ...]) -> dict[str, bytes]:
    """Return the files of a question, by their path in the bank.

    Parameters
    ----------
    topic, name : str
        Where it stands: ``templates/TOPIC/NAME``.
    kind : str
        One of ``KINDS``, or the first template of a bank.
    langs : tuple of str
        Languages of the bank; one that there is no example in gets English words, to be translated.
    """
    solver, folder = f"{topic}/{name.replace('-', '_')}", _HERE / kind
    blanks = {"TOPIC": topic, "SOLVER": solver, "TITLE": _make_title_from_name(name)}
    found = {
        f"templates/{topic}/{name}/template.toml": _fill_scaffold_file(
            folder / "template.toml", blanks, langs[0]
        )
    }
    for lang in langs:
        own = folder / f"{lang}.md"
        words = own if own.is_file() else folder / "en.md"
        found[f"templates/{topic}/{name}/{lang}.md"] = _fill_scaffold_file(words, blanks)
    if (folder / "solver.py.txt").is_file():
        found[f"solvers/{solver}.py"] = _fill_scaffold_file(
            folder / "solver.py.txt", blanks, langs[0]
        )
    return found


def _fill_scaffold_file(file: Traversable, blanks: dict[str, str], lang: str = ENGLISH) -> bytes:
    """Return a file of the scaffold with each ``@name@`` replaced, its comments in a language."""
    text = file.read_text("utf-8")
    comments = tomllib.loads((_HERE / "comments.toml").read_text("utf-8"))
    for english, said in comments.get(lang, {}).items():
        text = text.replace(english, said)
    for name, value in blanks.items():
        text = text.replace(f"@{name}@", value)
    return text.encode()


def _make_title_from_name(name: str) -> str:
    """Return a title made of a name: words instead of hyphens, a capital in front."""
    return name.replace("-", " ").replace("_", " ").capitalize()
