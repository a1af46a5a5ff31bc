"""A language made of accents: every word of English, with its vowels marked.

What stands in braces, between dollar signs or backticks is not prose and stays.
"""

from __future__ import annotations

import json
import re
import shutil
import tomllib
from itertools import pairwise
from pathlib import Path

from quizgen import locale
from quizgen.bank.bank import builtin_bank

LANG = "xx"
KEPT = re.compile(r"\{\{.*?\}\}|\{[^{}]*\}|\$[^$]*\$|`[^`]*`|<[^<>]*>")
MARKS = str.maketrans("aeiouAEIOU", "áéíóúÁÉÍÓÚ")


def quoted(value) -> str:
    """TOML of a text or a list; TOML knows no pairs of surrogates, which JSON would write."""
    return json.dumps(value, ensure_ascii=False)


def accented(text):
    """The text with marked vowels, but for what is filled in or typed."""
    ends = [0, *(end for found in KEPT.finditer(text) for end in found.span()), len(text)]
    pieces = [text[start:end] for start, end in pairwise(ends)]
    return "".join(p if i % 2 else p.translate(MARKS) for i, p in enumerate(pieces))


def toml(table, path=()):
    """A table as TOML; JSON strings are TOML strings."""
    plain = {k: v for k, v in table.items() if not isinstance(v, dict)}
    lines = [f"[{'.'.join(map(quoted, path))}]"] if path else []
    for key, value in plain.items():
        said = [accented(v) for v in value] if isinstance(value, list) else accented(value)
        lines.append(f"{quoted(key)} = {quoted(said)}")
    for key, value in table.items():
        if isinstance(value, dict):
            lines += toml(value, (*path, key))
    return lines


def write_language(folder):
    """Write ``folder/xx`` from English."""
    made = folder / LANG
    made.mkdir(parents=True)
    for path in (Path(locale.__file__).parent / "en").glob("*.toml"):
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        if path.stem != "language":
            (made / path.name).write_text("\n".join(toml(table)) + "\n", encoding="utf-8")
    (made / "language.toml").write_text(
        'name = "Áccénts"\nenglish = "Accents"\norder = 9\nscript = "Latn"\n', encoding="utf-8"
    )


def prose(line):
    """A line of a template; names of sections and entries are no prose."""
    head = re.match(r"## .*|- [^:\[]+( \[.*?\])?: ", line)
    cut = head.end() if head else 0
    return line[:cut] + accented(line[cut:])


def write_bank(root, names):
    """Write a bank of some templates in English and in accents, with their figures and one card."""
    for name in names:
        source = builtin_bank().template_paths[name]
        folder = root / "templates" / source.parent.name / name
        folder.mkdir(parents=True)
        shutil.copy(source / "template.toml", folder)
        text = (source / "en.md").read_text(encoding="utf-8")
        (folder / "en.md").write_text(text, encoding="utf-8")
        lines = "\n".join(map(prose, text.split("\n")))
        (folder / f"{LANG}.md").write_text(lines, encoding="utf-8")
    figures = root / "templates" / "figures"
    shutil.copytree(builtin_bank().folder / "figures", figures)
    words = tomllib.loads((figures / "en.toml").read_text(encoding="utf-8"))
    (figures / f"{LANG}.toml").write_text("\n".join(toml(words)) + "\n", encoding="utf-8")
    cards = root / "templates" / "cards"
    cards.mkdir()
    (cards / "vocabulary.toml").write_text(
        '[[entry]]\nid = "lens"\nnumber = 1\ngroup = "g"\ntopic = "optics"\ntier = "A"\n'
        'section = "1"\nterm = { en = "Lens", xx = "Léns" }\n'
        'meaning = { en = "Bends light.", xx = "Bénds líght." }\n', encoding="utf-8",
    )  # fmt: skip
