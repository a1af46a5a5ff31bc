"""Kind ``gap``: words are to be filled in."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain

from quizgen.bank.pools import select_from_pool
from quizgen.bank.variant import Variant
from quizgen.grading.judging.spelling import confusable_terms, fold_word
from quizgen.grading.kinds.gap import Spec
from quizgen.grading.mark import show_key as printed
from quizgen.locale import translate
from quizgen.question.contract import Box, Built, Control
from quizgen.question.specs import (
    accepted_words,
    authored_answer,
    reasons,
    specification,
    with_reason,
)


def build(drawn: Variant, index: int) -> Built[Spec]:
    """The words of every gap, of all languages; of a pool also the sentences around them."""
    answer = authored_answer(drawn, index)
    gaps = select_from_pool(drawn, index).names
    words = [drawn.words.get(name, name) for name in gaps]
    known = _reasons(drawn)
    told = [gap if gap in known else term for gap, term in zip(gaps, words, strict=True)]
    wrong = list(_wrong_words(drawn, gaps, words))
    among = [*answer.get("among", ()), *(term for _, _, terms in wrong for term in terms)]
    named = [(str(place), name) for place, name in enumerate(told, 1)]
    slips = [(f"{mark}={fold_word(term)}", name) for mark, name, terms in wrong for term in terms]
    accept = [accepted_words(drawn, name) for name in words]
    return Built(
        specification(
            Spec,
            drawn,
            index,
            accept=accept,
            among=list(dict.fromkeys(among)),
            terms=confusable_terms(drawn.template.about.terms, chain(*accept)),
            why=reasons(drawn, [*named, *slips]),
        ),
        Control("gaps", boxes=tuple(Box("") for _ in gaps) if len(gaps) > 1 else ()),
        statements=tuple(("options", name) for name in gaps) if "take" in answer else (),
        right=tuple(("reasons", name) for _, name in with_reason(drawn, named)),
        reasons=tuple((f"({mark}) {terms[0]}", name) for mark, name, terms in wrong),
    )


def _wrong_words(
    drawn: Variant, gaps: Sequence[str], words: Sequence[str]
) -> Iterator[tuple[str, str, list[str]]]:
    """Number of a gap, ``gap = word`` as the reasons name it, and how the word may be typed."""
    for place, (gap, right) in enumerate(zip(gaps, words, strict=True), 1):
        for name in _reasons(drawn):
            first, equals, term = name.partition(" = ")
            if equals and first in {gap, right} and term != right:
                yield str(place), name, _typed(drawn, term)


def _reasons(drawn: Variant) -> list[str]:
    texts = drawn.template.texts.values()
    return list(dict.fromkeys(name for text in texts for name in text.named.get("reasons", ())))


def _typed(drawn: Variant, term: str) -> list[str]:
    """The synonyms of another gap's word, else the word itself."""
    known = any(text.sentence("gaps", term) for text in drawn.template.texts.values())
    return accepted_words(drawn, term) if known else [term]


def hints(_spec: Spec, lang: str) -> tuple[str, ...]:
    """How words are typed."""
    return (translate(lang, "ask.gap"),)


__all__ = ["build", "hints", "printed"]
