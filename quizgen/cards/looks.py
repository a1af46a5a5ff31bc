"""Note types for Anki: fields, card templates and style sheet."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from importlib.resources import files
from typing import Any

from quizgen.cards.content import words
from quizgen.cards.note import FIELDS
from quizgen.cards.versions import BASE, STEP, registry

NAMES = {"basic": "Quizgen", "term": "Quizgen term", "cloze": "Quizgen formula"}
FONT = "_qg_hind_siliguri.woff2"
"""Bangla font as a media file; the underscore tells Anki that note types use it."""


def identity(name: str) -> int:
    """A fixed number for a note type or a deck, from its name."""
    digest = hashlib.sha256(f"quizgen/{name}".encode()).digest()
    return 1_500_000_000_000 + int.from_bytes(digest[:5], "big") % 2**36


def style() -> str:
    """The style sheet of every note type."""
    return (files("quizgen.cards") / "card.css").read_text(encoding="utf-8")


def _both(name: str) -> str:
    """A field in each language that is filled in."""
    return (
        f'{{{{#{name}}}}}<div lang="en">{{{{{name}}}}}</div>{{{{/{name}}}}}\n'
        f'{{{{#{name} bn}}}}<div lang="bn">{{{{{name} bn}}}}</div>{{{{/{name} bn}}}}\n'
    )


def _label(word: str, field: str) -> str:
    """What is asked, in each language of the note."""
    en, bn = (words(lang)[word] for lang in ("en", "bn"))
    return (
        f'<div class="qg-label">{{{{#{field}}}}}<span lang="en">{en}</span>{{{{/{field}}}}}'
        f'{{{{#{field} bn}}}}<span lang="bn">{bn}</span>{{{{/{field} bn}}}}</div>\n'
    )


def _if(name: str, text: str) -> str:
    return f"{{{{#{name}}}}}{text}{{{{/{name}}}}}"


def _card(body: str) -> str:
    return f'<div class="qg">\n{body}</div>'


_FOOT = _if("Source", '<footer class="qg-source">{{Source}}</footer>') + "\n"
_RULE = '<hr id="answer">\n'


def _basic() -> list[tuple[str, str, str]]:
    front = _both("Front") + "{{Figure}}\n"
    work = _if("Work", '<div class="qg-work">{{Work}}</div>') + "\n"
    back = f'<div class="qg-answer">{_both("Back")}</div>\n'
    more = "{{Answer figure}}\n" + _both("More")
    return [("Question", _card(front), _card(front + _RULE + back + work + more + _FOOT))]


def _term() -> list[tuple[str, str, str]]:
    term = '<div class="qg-term" lang="en">{{Term}}</div>\n'
    bangla = '<div class="qg-term" lang="bn">{{Term bn}}</div>\n'
    meaning, known = _both("Meaning"), _if("Term bn", bangla)
    asked = _label("term", "Meaning") + term
    named = _label("meaning", "Meaning") + meaning
    english = f'<div class="qg-label"><span lang="bn">{words("bn")["bangla"]}</span></div>\n'
    return [
        ("Term", _card(asked), _card(asked + _RULE + meaning + known + _FOOT)),
        ("Meaning", _card(named), _card(named + _RULE + term + known + _FOOT)),
        (
            "Bangla",
            _if("Term bn", _card(english + bangla)),
            _card(english + bangla + _RULE + term + meaning + _FOOT),
        ),
    ]


def _cloze() -> list[tuple[str, str, str]]:
    front = _label("formula", "Title") + _both("Title") + "{{cloze:Text}}\n"
    return [("Formula", _card(front), _card(front + _RULE + _both("Extra") + _FOOT))]


_TEMPLATES = {"basic": _basic, "term": _term, "cloze": _cloze}


@cache
def note_type(form: str) -> dict[str, Any]:
    """One note type in the form in which Anki stores it.

    Parameters
    ----------
    form : str
        A key of ``quizgen.cards.note.FIELDS``.
    """
    templates = _TEMPLATES[form]()
    return {
        "id": identity(NAMES[form]),
        "name": NAMES[form],
        "type": int(form == "cloze"),
        "mod": BASE + STEP * registry().get(f"looks/{form}", (1, ""))[0],
        "usn": -1,
        "sortf": 1,
        "did": 1,
        "tmpls": [_template(i, *parts) for i, parts in enumerate(templates)],
        "flds": [_field(i, name) for i, name in enumerate(FIELDS[form])],
        "css": style(),
        "latexPre": "",
        "latexPost": "",
        "latexsvg": False,
        "req": [[i, "any", list(range(1, len(FIELDS[form])))] for i in range(len(templates))],
        "tags": [],
        "vers": [],
    }


def digest_of(form: str) -> str:
    """Digest of everything that a note type consists of."""
    table = {key: value for key, value in note_type(form).items() if key != "mod"}
    return hashlib.sha256(json.dumps(table, sort_keys=True).encode()).hexdigest()[:12]


def _template(index: int, name: str, front: str, back: str) -> dict[str, Any]:
    return {"name": name, "ord": index, "qfmt": front, "afmt": back, "did": None,
            "bqfmt": "", "bafmt": ""}  # fmt: skip


def _field(index: int, name: str) -> dict[str, Any]:
    return {"name": name, "ord": index, "sticky": False, "rtl": False, "font": "Arial",
            "size": 20, "media": []}  # fmt: skip
