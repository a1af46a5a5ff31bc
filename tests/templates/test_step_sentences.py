"""The sentences of steps: each stands by itself as the reason of a step or of an option."""

from __future__ import annotations

import re

import pytest

from quizgen.bank.bank import builtin_bank

SECTION = re.compile(r"^## steps\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)
SENTENCE = re.compile(r"^- [^:]+: (.+)$", re.MULTILINE)


@pytest.mark.parametrize("lang", ["en", "bn"])
def test_every_sentence_of_a_step_is_whole(lang):
    pages = {page.parent.name: page for page in builtin_bank().folder.glob(f"*/*/{lang}.md")}
    found = [
        (name, sentence)
        for name, page in pages.items()
        for section in SECTION.findall(page.read_text("utf-8"))
        for sentence in SENTENCE.findall(section)
    ]
    assert len(found) > 200
    assert not [one for one in found if not re.search(r"[.।)]$|\}\}$", one[1])]
    assert not [one for one in found if re.match(r"[a-z]+ ", one[1]) and lang == "en"]
