"""Note types for Anki: fields, card templates and style sheet."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from importlib.resources import files
from typing import Any

import msgspec

from quizgen.cards.content import load_card_words
from quizgen.cards.note import field_name, field_names
from quizgen.cards.versions import BASE, STEP
from quizgen.core.decoding import convert
from quizgen.locale import FIRST, get_language, language_css

NAMES = {"basic": "Quizgen", "term": "Quizgen term", "cloze": "Quizgen formula"}
FONT = "_qg_hind_siliguri.woff2"
"""Bangla font as a media file; the underscore tells Anki that note types use it."""


Columns = tuple[str, ...]
"""Languages that a note type has fields for."""

Sides = list[tuple[str, str, str]]
"""Name, front and back of each card."""


class NoteTypeVersions(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """``looks.toml``: the languages of the plain note types, version and digest of each."""

    languages: tuple[str, ...]
    looks: dict[str, tuple[int, str]]


@cache
def read_note_type_versions() -> NoteTypeVersions:
    """Return the versions of the note types that this package ships."""
    return convert(msgspec.toml.decode(_read_packaged_text("looks.toml")), NoteTypeVersions)


def _read_packaged_text(name: str) -> str:
    """Return the text of a file in this package."""
    return (files("quizgen.cards") / name).read_text(encoding="utf-8")


def stable_id(name: str) -> int:
    """Return a number for a note type or a deck that follows from its name alone."""
    digest = hashlib.sha256(f"quizgen/{name}".encode()).digest()
    return 1_500_000_000_000 + int.from_bytes(digest[:5], "big") % 2**36


def card_css() -> str:
    """Return the style sheet of every note type."""
    return _read_packaged_text("card.css") + language_css('.qg [lang="{}"]', ".qg")


def _render_field_by_language(name: str, columns: Columns) -> str:
    """Return Anki's template of a field in each language that is filled in."""
    fields = {lang: field_name(name, lang) for lang in columns}
    return "".join(
        _wrap_in_condition(field, f'<div lang="{lang}">{{{{{field}}}}}</div>') + "\n"
        for lang, field in fields.items()
    )


def _render_label_by_language(word: str, name: str, columns: Columns) -> str:
    """Return Anki's template of a word shown in each language in which the field is filled in."""
    asked = "".join(
        _wrap_in_condition(
            field_name(name, lang), f'<span lang="{lang}">{load_card_words(lang)[word]}</span>'
        )
        for lang in columns
    )
    return f'<div class="qg-label">{asked}</div>\n'


def _wrap_in_condition(name: str, text: str) -> str:
    """Return Anki's template of a text that is shown if a field is filled in."""
    return f"{{{{#{name}}}}}{text}{{{{/{name}}}}}"


def _wrap_card(body: str) -> str:
    """Return Anki's template of one side, in the frame that the style sheet expects."""
    return f'<div class="qg">\n{body}</div>'


_FOOT = _wrap_in_condition("Source", '<footer class="qg-source">{{Source}}</footer>') + "\n"
_RULE = '<hr id="answer">\n'


def _build_basic_templates(columns: Columns) -> Sides:
    """Return name, front and back of the cards with a front and a back field."""
    front = _render_field_by_language("Front", columns) + "{{Figure}}\n"
    work = _wrap_in_condition("Work", '<div class="qg-work">{{Work}}</div>') + "\n"
    back = f'<div class="qg-answer">{_render_field_by_language("Back", columns)}</div>\n'
    more = "{{Answer figure}}\n" + _render_field_by_language("More", columns)
    return [("Question", _wrap_card(front), _wrap_card(front + _RULE + back + work + more + _FOOT))]


def _build_term_templates(columns: Columns) -> Sides:
    """Return name, front and back of the cards of a term, one more for each translation."""
    term = f'<div class="qg-term" lang="{FIRST}">{{{{Term}}}}</div>\n'
    named = {lang: _render_translated_term(lang) for lang in columns if lang != FIRST}
    meaning = _render_field_by_language("Meaning", columns)
    known = "".join(
        _wrap_in_condition(field_name("Term", lang), text) for lang, text in named.items()
    )
    asked = _render_label_by_language("term", "Meaning", columns) + term
    told = _render_label_by_language("meaning", "Meaning", columns) + meaning
    return [
        ("Term", _wrap_card(asked), _wrap_card(asked + _RULE + meaning + known + _FOOT)),
        ("Meaning", _wrap_card(told), _wrap_card(told + _RULE + term + known + _FOOT)),
        *(_build_translation_template(lang, text, term + meaning) for lang, text in named.items()),
    ]


def _render_translated_term(lang: str) -> str:
    """Return Anki's template of the term in another language."""
    return f'<div class="qg-term" lang="{lang}">{{{{{field_name("Term", lang)}}}}}</div>\n'


def _build_translation_template(lang: str, named: str, back: str) -> tuple[str, str, str]:
    """Return the card that asks for the English term; Anki makes none if the field is empty."""
    asked = (
        f'<div class="qg-label"><span lang="{lang}'
        f'">{load_card_words(lang)["in_english"]}</span></div>\n'
    )
    front = _wrap_in_condition(field_name("Term", lang), _wrap_card(asked + named))
    return get_language(lang).english, front, _wrap_card(asked + named + _RULE + back + _FOOT)


def _build_cloze_templates(columns: Columns) -> Sides:
    """Return name, front and back of the cloze card."""
    front = (
        _render_label_by_language("formula", "Title", columns)
        + _render_field_by_language("Title", columns)
        + "{{cloze:Text}}\n"
    )
    return [
        (
            "Formula",
            _wrap_card(front),
            _wrap_card(front + _RULE + _render_field_by_language("Extra", columns) + _FOOT),
        )
    ]


_TEMPLATES = {
    "basic": _build_basic_templates,
    "term": _build_term_templates,
    "cloze": _build_cloze_templates,
}


def note_type_name(form: str, columns: Columns) -> str:
    """Return the name of a note type, with its languages unless they are the usual ones."""
    known = read_note_type_versions().languages
    return NAMES[form] if columns == known else f"{NAMES[form]} ({', '.join(columns)})"


@cache
def note_type(form: str, columns: Columns) -> dict[str, Any]:
    """Return one note type in the form in which Anki stores it.

    Parameters
    ----------
    form : str
        A key of ``quizgen.cards.note.FIELDS``.
    columns : tuple of str
        Languages that it has fields for.
    """
    templates, fields = _TEMPLATES[form](columns), field_names(form, columns)
    return {
        "id": stable_id(note_type_name(form, columns)),
        "name": note_type_name(form, columns),
        "type": int(form == "cloze"),
        "mod": BASE + STEP * read_note_type_versions().looks[form][0],
        "usn": -1,
        "sortf": 1,
        "did": 1,
        "tmpls": [_make_card_template(i, *parts) for i, parts in enumerate(templates)],
        "flds": [_make_note_field(i, name) for i, name in enumerate(fields)],
        "css": card_css(),
        "latexPre": "",
        "latexPost": "",
        "latexsvg": False,
        "req": [[i, "any", list(range(1, len(fields)))] for i in range(len(templates))],
        "tags": [],
        "vers": [],
    }


def note_type_digest(form: str) -> str:
    """Return a digest of everything that a note type consists of."""
    kind = note_type(form, read_note_type_versions().languages)
    table = {key: value for key, value in kind.items() if key != "mod"}
    return hashlib.sha256(json.dumps(table, sort_keys=True).encode()).hexdigest()[:12]


def _make_card_template(index: int, name: str, front: str, back: str) -> dict[str, Any]:
    """Return one card template in the form in which Anki stores it."""
    return {"name": name, "ord": index, "qfmt": front, "afmt": back, "did": None,
            "bqfmt": "", "bafmt": ""}  # fmt: skip


def _make_note_field(index: int, name: str) -> dict[str, Any]:
    """Return one field in the form in which Anki stores it."""
    return {"name": name, "ord": index, "sticky": False, "rtl": False, "font": "Arial",
            "size": 20, "media": []}  # fmt: skip
