"""A note: one fact to learn, in the languages asked for, and the cards that ask for it.

A note has a *form*. ``basic`` asks a question and gives the answer; ``term`` asks term to meaning,
meaning to term and every other language to English; ``cloze`` hides sides of formulas. What stands
in which field is decided here, once, for Anki and for tables alike.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape
from typing import Any

from quizgen.cards.markup import ClozeHole, InLanguage, media, to_card_html, to_card_text
from quizgen.locale import FIRST, get_language

CardBlocks = tuple[Any, ...]
CardWords = Mapping[str, CardBlocks]
"""Language to blocks."""

_NO_TAG = re.compile(r"[^\w:.§+-]")

SAID = {"basic": ("Front", "Back", "More"), "term": ("Term", "Meaning"),
        "cloze": ("Title", "Extra")}  # fmt: skip
"""Form to the fields that every language has for itself."""

FIELDS = {
    "basic": ("Key", "Front", "Figure", "Back", "Work", "Answer figure", "More", "Source"),
    "term": ("Key", "Term", "Meaning", "Source"),
    "cloze": ("Key", "Title", "Text", "Extra", "Source"),
}
"""Form to the fields of its note type; those in ``SAID`` come once per language."""


def field_name(name: str, lang: str) -> str:
    """Return the name of a field in one language: ``Front``, ``Front bn``."""
    return name if lang == FIRST else f"{name} {lang}"


def field_names(form: str, columns: tuple[str, ...]) -> tuple[str, ...]:
    """Return the fields of a note type with fields for these languages, in order."""
    said = SAID[form]
    each = [[field_name(name, lang) for lang in columns] if name in said else [name]
            for name in FIELDS[form]]  # fmt: skip
    return tuple(field for names in each for field in names)


@dataclass(frozen=True)
class Note:
    """One note of a deck, which gives one or several cards.

    Parameters
    ----------
    key : str
        Stable name, for example ``vocab/pixel``: what makes it the same note on re-import.
    kind : str
        ``vocab``, ``formula``, ``cheat``, ``trap``, ``figure``, ``question``, ...
    form : str
        A key of ``FIELDS``.
    topic, tier, section : str
        Sub-deck and tags.
    refs : tuple of str
        Curriculum ids, as tags.
    words : mapping
        Field to language to blocks, for the fields in ``SAID``.
    shared : mapping
        Field to blocks that need no translation (formulas, figures).
    version : int
        Rises when the content changes.
    langs : tuple of str
        Languages asked for, the leading one first.
    columns : tuple of str
        Languages that the note type has fields for.
    """

    key: str
    kind: str
    form: str
    topic: str
    tier: str
    words: Mapping[str, CardWords]
    section: str = ""
    refs: tuple[str, ...] = ()
    shared: Mapping[str, CardBlocks] = field(default_factory=dict)
    version: int = 1
    langs: tuple[str, ...] = (FIRST,)
    columns: tuple[str, ...] = (FIRST,)

    @property
    def guid(self) -> str:
        """The note's identity in Anki, from its key, never from its text or language."""
        return hashlib.sha256(f"quizgen/{self.key}".encode()).hexdigest()[:20]

    @property
    def source(self) -> str:
        """The small line at the foot of a card: where the note comes from."""
        place = f"§{self.section}" if self.section else ""
        return " · ".join(part for part in (*self.refs[:1], place, self.tier) if part)

    @property
    def tags(self) -> tuple[str, ...]:
        """The note's tags: kind, tier, section, languages and curriculum ids."""
        named = [f"kind::{self.kind}", f"tier::{self.tier}"]
        named += [f"section::{self.section}"] if self.section else []
        named += [f"lang::{lang}" for lang in self.langs]
        named += [f"ref::{ref}" for ref in self.refs]
        return tuple(sorted(_format_tag(f"quizgen::{name}") for name in named))

    def fields(self) -> tuple[str, ...]:
        """Return the HTML of every field of the note type, in order.

        Unrequested languages are empty.
        """
        filled = {"Key": escape(self.key), "Source": escape(self.source)}
        main = self.langs[0]
        filled |= {name: to_card_html(blocks, main) for name, blocks in self.shared.items()}
        for name, words in self.words.items():
            filled |= {
                field_name(name, lang): to_card_html(blocks, lang) for lang, blocks in words.items()
            }
        return tuple(filled.get(name, "") for name in field_names(self.form, self.columns))

    def media(self) -> dict[str, bytes]:
        """Return the files of the pictures on the note, by name."""
        said = [blocks for words in self.words.values() for blocks in words.values()]
        return dict(found for blocks in (*self.shared.values(), *said) for found in media(blocks))

    def cards(self) -> tuple[int, ...]:
        """Return the numbers of the cards that the note gives, as Anki counts them (from 0)."""
        if self.form == "cloze":
            holes = {part.number for part in self.shared["Text"] if isinstance(part, ClozeHole)}
            return tuple(sorted(number - 1 for number in holes))
        if self.form == "term":
            asked = [
                n
                for n, lang in enumerate(self._list_other_languages(), 2)
                if lang in self.words["Term"]
            ]
            return (0, 1, *asked)
        return (0,)

    def sides(self) -> Iterator[tuple[str, CardBlocks, CardBlocks]]:
        """Yield each card as (name, front, back), for programs that know two sides only."""
        if self.form == "term":
            yield from self._term_sides()
        elif self.form == "cloze":
            text = self.shared["Text"]
            yield (
                "Formula",
                (*self.in_all_languages("Title"), *text),
                (*text, *self.in_all_languages("Extra")),
            )
        else:
            front = (*self.in_all_languages("Front"), *self.shared.get("Figure", ()))
            shared = (*self.shared.get("Work", ()), *self.shared.get("Answer figure", ()))
            yield (
                "Question",
                front,
                (*self.in_all_languages("Back"), *shared, *self.in_all_languages("More")),
            )

    def _term_sides(self) -> Iterator[tuple[str, CardBlocks, CardBlocks]]:
        """Yield the sides of a vocabulary note: term to meaning, back, and translations."""
        terms, meaning = self.words["Term"], self.in_all_languages("Meaning")
        term, named = (
            terms[FIRST],
            {lang: terms[lang] for lang in self._list_other_languages() if lang in terms},
        )
        known = tuple(block for blocks in named.values() for block in blocks)
        yield "Term", term, (*meaning, *known)
        yield "Meaning", meaning, (*term, *known)
        for lang, asked in named.items():
            yield get_language(lang).english, asked, (*term, *meaning)

    def _list_other_languages(self) -> tuple[str, ...]:
        """Return the languages of the note without English, the language of terms."""
        return tuple(lang for lang in self.columns if lang != FIRST)

    def in_all_languages(self, name: str) -> CardBlocks:
        """Return a field in every language of the note, one after the other."""
        words = self.words.get(name, {})
        return tuple(InLanguage(lang, words[lang]) for lang in self.langs if lang in words)


def _format_tag(name: str) -> str:
    """Return a name as a tag of Anki: without blanks, control characters and quotes."""
    return _NO_TAG.sub("_", name)


def side_to_text(blocks: CardBlocks, *, ask: bool) -> str:
    """Return one side of a card as plain text; ``ask`` leaves hidden sides out."""
    return to_card_text(blocks, ask=ask).strip()
