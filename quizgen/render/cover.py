"""What the cover of an exam says besides title, code and points: where, when, by which rules."""

from __future__ import annotations

from collections.abc import Iterable

from quizgen.paper.paper import Paper
from quizgen.render.typst_document import (
    join_languages,
    replace_unprintable,
    stack_languages,
    translate_all,
    typst_literal,
)


def list_cover_facts(paper: Paper) -> list[tuple[str, str]]:
    """Return pairs of a word of the section ``paper`` and its value as Typst code."""
    if paper.cover is None:
        return []
    rows = []
    for name in paper.cover.facts:
        said = dict.fromkeys(
            replace_unprintable(paper.cover.pick_fact(name, lang)) for lang in paper.langs
        )
        shown = [f"#{typst_literal(text)};" for text in said]
        value = join_languages(paper.langs, shown) if len(said) > 1 else shown[0]
        rows.append((name, f"[{value}]"))
    return rows


def typeset_house_rules(paper: Paper) -> list[str]:
    """Return Typst source of the rules of the room, and of the line to sign on."""
    if paper.cover is None:
        return []
    found = []
    rules = paper.cover.rules
    spoken = [lang for lang in paper.langs if rules.get(lang)]
    lists = {lang: _typeset_list(rules[lang]) for lang in spoken}
    if not lists and any(rules.values()):
        lists = {paper.langs[0]: _typeset_list(next(filter(None, rules.values())))}
    if lists:
        found.append(f"#block(above: 0.9em)[{stack_languages([*lists], lists.values())}]")
    if paper.cover.signature:
        label = translate_all(paper.langs, "paper.signature")
        found.append(
            "#v(1.4em)\n#grid(columns: (auto, 1fr), column-gutter: 0.6em, align: bottom, "
            f"[{label}], line(length: 100%, stroke: 0.5pt))"
        )
    return found


def _typeset_list(lines: Iterable[str]) -> str:
    """Return Typst source of lines as a list."""
    rows = "".join(f"[#{typst_literal(replace_unprintable(line))};]," for line in lines)
    return f"#list({rows})"
