"""The page has the decimal sign of its language in what is read, and nowhere else."""

from __future__ import annotations

import re

import pytest

from quizgen.locale import languages
from quizgen.tradeoff.data import words
from quizgen.tradeoff.numbers import in_places, in_prose

PAGE = (
    '<style>a{width:1.5px}</style><p title="1.5">1.5 and 2.25, <code>0.5</code>'
    '<span translate="no">NumPy 2.3.1</span></p><svg><path d="M1.5 2"/><text>10.5</text></svg>'
    "<script>x = 1.5</script><pre>1.5</pre> 2.5"
)
GERMAN = (
    '<style>a{width:1.5px}</style><p title="1.5">1,5 and 2,25, <code>0.5</code>'
    '<span translate="no">NumPy 2.3.1</span></p><svg><path d="M1.5 2"/><text>10,5</text></svg>'
    "<script>x = 1.5</script><pre>1.5</pre> 2,5"
)


@pytest.mark.parametrize(("lang", "said"), [("en", PAGE), ("bn", PAGE), ("de", GERMAN)])
def test_prose_has_the_sign_of_its_language(lang, said):
    assert in_prose(PAGE, lang) == said


def test_positions_of_a_slider_have_it():
    place = [12.5, "k = 2.65", "k = 2.65: 3 digits", ("8.04", "91", "·10⁻³"), ("8", ".1", "")]
    assert in_places([place], "de") == [
        [12.5, "k = 2,65", "k = 2,65: 3 digits", ("8,04", "91", "·10⁻³"), ("8", ",1", "")]
    ]
    assert in_places([place], "en") == [place]


def told(value):
    """All words below a table of words."""
    return (
        [one for part in value.values() for one in told(part)]
        if isinstance(value, dict)
        else [value]
    )


@pytest.mark.parametrize("lang", languages())
def test_no_word_has_a_mark_between_thousands(lang):
    """A comma or a point there is the decimal sign of the one language or the other."""
    assert [one for one in told(words(lang)) if re.search(r"\d[.,]\d{3}\b", one)] == []
