"""Note types for Anki: fields, card templates and style sheet."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from importlib.resources import files
from typing import Any

import msgspec

from quizgen.cards.content import words
from quizgen.cards.note import field_name, field_names
from quizgen.cards.versions import BASE, STEP
from quizgen.locale import FIRST, language, styles
from quizgen.shapes import converted

NAMES = {"basic": "Quizgen", "term": "Quizgen term", "cloze": "Quizgen formula"}
FONT = "_qg_hind_siliguri.woff2"
"""Bangla font as a media file; the underscore tells Anki that note types use it."""


Columns = tuple[str, ...]
"""Languages that a note type has fields for."""

Sides = list[tuple[str, str, str]]
"""Name, front and back of each card."""


class Listed(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """``looks.toml``: the languages of the plain note types, and version and digest of each."""

    languages: tuple[str, ...]
    looks: dict[str, tuple[int, str]]


@cache
def listed() -> Listed:
    """Versions of the note types; ``python -m quizgen.cards.renew`` keeps them."""
    return converted(msgspec.toml.decode(_file("looks.toml")), Listed)


def _file(name: str) -> str:
    return (files("quizgen.cards") / name).read_text(encoding="utf-8")


def identity(name: str) -> int:
    """A fixed number for a note type or a deck, from its name."""
    digest = hashlib.sha256(f"quizgen/{name}".encode()).digest()
    return 1_500_000_000_000 + int.from_bytes(digest[:5], "big") % 2**36


def style() -> str:
    """The style sheet of every note type."""
    return _file("card.css") + styles('.qg [lang="{}"]', ".qg")


def _each(name: str, columns: Columns) -> str:
    """A field in each language that is filled in."""
    fields = {lang: field_name(name, lang) for lang in columns}
    return "".join(
        _if(field, f'<div lang="{lang}">{{{{{field}}}}}</div>') + "\n"
        for lang, field in fields.items()
    )


def _label(word: str, name: str, columns: Columns) -> str:
    """What is asked, in each language of the note."""
    asked = "".join(
        _if(field_name(name, lang), f'<span lang="{lang}">{words(lang)[word]}</span>')
        for lang in columns
    )
    return f'<div class="qg-label">{asked}</div>\n'


def _if(name: str, text: str) -> str:
    return f"{{{{#{name}}}}}{text}{{{{/{name}}}}}"


def _card(body: str) -> str:
    return f'<div class="qg">\n{body}</div>'


_FOOT = _if("Source", '<footer class="qg-source">{{Source}}</footer>') + "\n"
_RULE = '<hr id="answer">\n'


def _basic(columns: Columns) -> Sides:
    front = _each("Front", columns) + "{{Figure}}\n"
    work = _if("Work", '<div class="qg-work">{{Work}}</div>') + "\n"
    back = f'<div class="qg-answer">{_each("Back", columns)}</div>\n'
    more = "{{Answer figure}}\n" + _each("More", columns)
    return [("Question", _card(front), _card(front + _RULE + back + work + more + _FOOT))]


def _term(columns: Columns) -> Sides:
    term = f'<div class="qg-term" lang="{FIRST}">{{{{Term}}}}</div>\n'
    named = {lang: _named(lang) for lang in columns if lang != FIRST}
    meaning = _each("Meaning", columns)
    known = "".join(_if(field_name("Term", lang), text) for lang, text in named.items())
    asked = _label("term", "Meaning", columns) + term
    told = _label("meaning", "Meaning", columns) + meaning
    return [
        ("Term", _card(asked), _card(asked + _RULE + meaning + known + _FOOT)),
        ("Meaning", _card(told), _card(told + _RULE + term + known + _FOOT)),
        *(_translated(lang, text, term + meaning) for lang, text in named.items()),
    ]


def _named(lang: str) -> str:
    """The term in another language."""
    return f'<div class="qg-term" lang="{lang}">{{{{{field_name("Term", lang)}}}}}</div>\n'


def _translated(lang: str, named: str, back: str) -> tuple[str, str, str]:
    """The card that asks for the English term; there is none if the field is empty."""
    asked = f'<div class="qg-label"><span lang="{lang}">{words(lang)["in_english"]}</span></div>\n'
    front = _if(field_name("Term", lang), _card(asked + named))
    return language(lang).english, front, _card(asked + named + _RULE + back + _FOOT)


def _cloze(columns: Columns) -> Sides:
    front = _label("formula", "Title", columns) + _each("Title", columns) + "{{cloze:Text}}\n"
    return [("Formula", _card(front), _card(front + _RULE + _each("Extra", columns) + _FOOT))]


_TEMPLATES = {"basic": _basic, "term": _term, "cloze": _cloze}


def name_of(form: str, columns: Columns) -> str:
    """Name of a note type: short for the languages it was first made for, else with them."""
    known = listed().languages
    return NAMES[form] if columns == known else f"{NAMES[form]} ({', '.join(columns)})"


@cache
def note_type(form: str, columns: Columns) -> dict[str, Any]:
    """One note type in the form in which Anki stores it.

    Parameters
    ----------
    form : str
        A key of ``quizgen.cards.note.FIELDS``.
    columns : tuple of str
        Languages that it has fields for.
    """
    templates, fields = _TEMPLATES[form](columns), field_names(form, columns)
    return {
        "id": identity(name_of(form, columns)),
        "name": name_of(form, columns),
        "type": int(form == "cloze"),
        "mod": BASE + STEP * listed().looks[form][0],
        "usn": -1,
        "sortf": 1,
        "did": 1,
        "tmpls": [_template(i, *parts) for i, parts in enumerate(templates)],
        "flds": [_field(i, name) for i, name in enumerate(fields)],
        "css": style(),
        "latexPre": "",
        "latexPost": "",
        "latexsvg": False,
        "req": [[i, "any", list(range(1, len(fields)))] for i in range(len(templates))],
        "tags": [],
        "vers": [],
    }


def digest_of(form: str) -> str:
    """Digest of everything that a note type consists of."""
    kind = note_type(form, listed().languages)
    table = {key: value for key, value in kind.items() if key != "mod"}
    return hashlib.sha256(json.dumps(table, sort_keys=True).encode()).hexdigest()[:12]


def _template(index: int, name: str, front: str, back: str) -> dict[str, Any]:
    return {"name": name, "ord": index, "qfmt": front, "afmt": back, "did": None,
            "bqfmt": "", "bafmt": ""}  # fmt: skip


def _field(index: int, name: str) -> dict[str, Any]:
    return {"name": name, "ord": index, "sticky": False, "rtl": False, "font": "Arial",
            "size": 20, "media": []}  # fmt: skip
