"""The language files of a template: sections of prose and lists of named sentences.

A language file has a title, a stem, one section per part and lists of named sentences::

    # Perspective projection
    A pinhole camera has focal length {{ f }} ...
    ## a
    **Where does $p$ appear?**
    ## steps          why each step is taken, by quantity
    - x: Similar triangles ...
    ## why            what makes the answer right, where nothing is computed
    ## check          how to see that the result makes sense
    ## traps          what went wrong, by mistake
    ## options        wording of choices, pairs, ordered steps
    ## claims         statements that are true or false, by name
    ## reasons        why an option or a claim is wrong (or right), a pair does not fit, a step
                      comes later, a gap takes its word
    ## words          wording of drawn phrases
    ## points         the ideas that sentences are marked by, by criterion
    ## accept         examples of what counts for one, with | between; then half, refuse, about
    ## model          the model answer, by part
    ## note           a remark shown with the solution (where the notes differ, and why)

Sentences are written in the subset of ``prose``. A named sentence may be told by a condition,
``- name [h < 60]: ...``; the first that holds is said, else the one without. In ``why``, sentences
named by a part's label belong to that part.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import accumulate
from pathlib import Path

from quizgen.bank.compile_cache import CompileCache
from quizgen.bank.markdown import (
    ConditionalSentence,
    LanguageFile,
    leaves,
    parse_blocks,
    parse_inlines,
)
from quizgen.core import untrusted
from quizgen.core.errors import BankError
from quizgen.typeset.prose import Block, PictureLink

NAMED_SECTIONS = frozenset(
    {
        "steps",
        "traps",
        "options",
        "words",
        "gaps",
        "points",
        "accept",
        "half",
        "refuse",
        "about",
        "model",
        "reasons",
        "claims",
    }
)
PROSE_SECTIONS = frozenset({"why", "check", "note"})
_TEXTS = CompileCache("prose", LanguageFile, "markdown_it", "math_core")


def read_language_file(path: Path) -> LanguageFile:
    """Return the parsed content of a language file.

    Raises
    ------
    BankError
        Naming the file and what is wrong in it.
    """
    source = untrusted.read_text(path, BankError)
    if control := untrusted.CONTROLS.search(source):
        line = source.count("\n", 0, control.start()) + 1
        what = f"{untrusted.escape_control_characters(control[0])} in a text"
        raise BankError(what, rule="QG102", file=path, line=line)
    with untrusted.error_context(path, BankError):
        found = _TEXTS.get(source.encode())
        return found or _TEXTS.store_compiled(parse_language_file(source), source.encode())


def parse_language_file(source: str) -> LanguageFile:
    """Return the parsed content of the text of a language file."""
    title, body = _split_title(source)
    pieces = re.split(r"^## +(\S.*)$", body, flags=re.MULTILINE)
    # The body begins where the source ends with it; each piece where those before it end.
    begins = accumulate(
        map(_count_breaks, pieces), initial=_count_breaks(source) - _count_breaks(body)
    )
    lines = [begin + 1 for begin in begins]
    sections: dict[str, tuple[Block, ...]] = {}
    listed: dict[str, list[tuple[str, ConditionalSentence]]] = {}
    for heading, whole, line in zip(pieces[1::2], pieces[2::2], lines[2::2], strict=False):
        name = heading.strip()
        content, labelled = _split_off_labelled(whole) if name == "why" else (whole, "")
        if labelled:
            listed[name] = list(
                _iter_named_sentences(name, labelled, line + _count_breaks(content))
            )
        if name in NAMED_SECTIONS:
            listed[name] = list(_iter_named_sentences(name, content, line))
        elif name in PROSE_SECTIONS or re.fullmatch(r"[a-j]", name):
            sections[name] = parse_blocks(content, line)
        else:
            allowed = ", ".join(sorted(NAMED_SECTIONS | PROSE_SECTIONS))
            what = f"section {name!r} is unknown (allowed: a, b, ..., {allowed})"
            raise BankError(what, rule="QG150", line=line)
    named = {section: {n: said for n, (_, said) in found} for section, found in listed.items()}
    stem = parse_blocks(pieces[0], lines[0])
    told = [stem, *sections.values(), *(said for of in listed.values() for _, (_, said) in of)]
    pictures = [leaf for parts in told for leaf in leaves(parts) if isinstance(leaf, PictureLink)]
    return LanguageFile(
        title, stem, sections, named, _index_conditional_sentences(listed), tuple(pictures)
    )


def _count_breaks(text: str) -> int:
    """Return the number of line breaks in a text."""
    return text.count("\n")


def _split_off_labelled(content: str) -> tuple[str, str]:
    """Return the paragraphs of an explanation, and its closing list of sentences by part."""
    found = re.search(r"^- [a-j](?: \[[^\]\n]*\])?:", content, flags=re.MULTILINE)
    return (content[: found.start()], content[found.start() :]) if found else (content, "")


def _index_conditional_sentences(
    listed: Mapping[str, list[tuple[str, ConditionalSentence]]],
) -> dict[tuple[str, str], tuple[ConditionalSentence, ...]]:
    """Return section and name of the sentences that a condition chooses from."""
    found: dict[tuple[str, str], list[ConditionalSentence]] = {}
    for section, entries in listed.items():
        for name, case in entries:
            found.setdefault((section, name), []).append(case)
    return {place: tuple(cases) for place, cases in found.items() if any(c for c, _ in cases)}


def _split_title(source: str) -> tuple[str, str]:
    """Return the title and what comes after its line.

    Raises ``BankError`` if the first line is no title; a byte order mark in front is allowed.
    """
    head, _, body = source.lstrip("\ufeff\n").partition("\n")
    if not head.startswith("# "):
        raise BankError("the first line must be the title: '# ...'", rule="QG151", line=1)
    return head[2:].strip(), body


_CASE = re.compile(r"(?P<name>[^\[]*?)(?:\s*\[(?P<condition>[^\]]*)\])?\s*")


def _iter_named_sentences(
    section: str, content: str, line: int
) -> Iterator[tuple[str, ConditionalSentence]]:
    """Yield names and sentences of a list that begins in a line."""
    for entry in re.split(r"^- ", content, flags=re.MULTILINE):
        begin, line = line, line + _count_breaks(entry)
        if not entry.strip():
            continue
        name, colon, sentence = entry.partition(":")
        if not colon:
            what = f"section {section!r}: {entry.strip()!r} lacks 'name: sentence'"
            raise BankError(what, rule="QG152", line=begin)
        found = _CASE.fullmatch(name)
        if found is None:
            what = f"section {section!r}: {name.strip()!r} is not 'name [condition]'"
            raise BankError(what, rule="QG152", line=begin)
        yield found["name"].strip(), (found["condition"] or "", parse_inlines(sentence, begin))
