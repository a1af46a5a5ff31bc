"""Quantities that are drawn and that nothing uses."""

from __future__ import annotations

import re
from collections.abc import Iterator

import msgspec

from quizgen.bank.markdown import LanguageFile, slot_names
from quizgen.bank.template import Template
from quizgen.maths.tree import names_in

_NAME = re.compile(r"[^\W\d]\w*'*")


def find_unused_draws(template: Template) -> list[str]:
    """Return names of what is drawn and then neither shown, asked, computed with nor tested.

    Whatever has the name in it counts as a use, so that none is reported wrongly.
    """
    rules = template.rules
    unused = {*rules.draw, *rules.data} - set(_iter_used_names(template))
    derived = [(name, set(_iter_names(rule))) for name, rule in rules.draw.items()]
    changed = True
    while changed:  # what only unused quantities are made of is used as little
        used = {n for name, names in derived if name not in unused for n in names if n != name}
        changed = bool(unused & used)
        unused -= used
    return sorted(name for name in unused if not _is_derived(template, name))


def _is_derived(template: Template, name: str) -> bool:
    """Whether a quantity follows from others: it makes no question a different one."""
    rule = template.rules.draw.get(name)
    return rule is not None and bool(rule.formula or rule.by or rule.of or rule.values)


def _iter_used_names(template: Template) -> Iterator[str]:
    """Yield the names in everything but ``[draw]`` itself."""
    rules, chain = template.rules, template.chain
    for names in chain.operands.values():
        yield from names
    wrong = (*chain.traps.values(), *chain.form_traps.values(), chain.forms)
    for step in (step for steps in wrong for step in steps):
        yield from names_in(step.expr)
    for value in (rules.part, rules.where, rules.claims, rules.figure, rules.files):
        yield from _iter_names(value)
    yield from rules.keep
    for text in template.texts.values():
        yield from _iter_prose_names(text)


def _iter_names(value: object) -> Iterator[str]:
    """Yield every word in the texts of a value; keys count, too."""
    todo = [msgspec.to_builtins(value)]
    while todo:
        one = todo.pop()
        if isinstance(one, str):
            yield from _NAME.findall(one)
            yield one
        elif isinstance(one, dict):
            todo += [*one, *one.values()]
        elif isinstance(one, list | tuple):
            todo += one


def _iter_prose_names(text: LanguageFile) -> Iterator[str]:
    """Yield every name in the slots, sentences and conditions of a language file."""
    for section in (text.stem, *text.sections.values()):
        for slot in slot_names(section):
            yield from _NAME.findall(slot)
    for sentences in text.named.values():
        for sentence in sentences.values():
            for slot in slot_names(sentence):
                yield from _NAME.findall(slot)
    for (_, name), cases in text.cases.items():
        yield name
        for condition, sentence in cases:
            yield from _NAME.findall(condition)
            for slot in slot_names(sentence):
                yield from _NAME.findall(slot)
