"""Whether a sentence in a learner's own words says an idea, denies it, or neither.

A sentence is cut into clauses. An idea is stated by examples, each a few words as a learner would
write them; an example is found in a clause that has all its words in any order, each in any of its
forms, slips of the fingers allowed. Words on a scale (more and less, bright and dark) also meet
their opposites, which turn the statement, as words of denial do. Words for all of this stand in
``statements.toml`` of each language; a sentence may mix languages, so all of them hold at once.

Nothing is learnt and nothing is guessed: what is neither said nor denied stays open.
"""

from __future__ import annotations

import itertools
import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial
from typing import Literal, NamedTuple

from quizgen.grading.judging.spelling import (
    allowed_typos,
    fold_word,
    is_another_word,
    typo_distance,
)
from quizgen.locale import cache_words, list_languages, load_words
from quizgen.locale.word_patterns import list_words

Meaning = Literal["said", "half", "denied", "open"]
"""What a clause does with an idea; ``open`` where its words are there and its sign is not sure."""

WIDEST = 3
"""Clauses next to each other that one example may be spread over."""
LONGEST_NOUN = 3
"""Words of what is missing where a clause begins with *without*; more are what then holds."""
LOOSE = 3
"""Words for each that was recognised, from which on they may belong to several statements."""
SHORTEST = 4
"""Letters of a word that others may go on from; fewer in scripts that write fewer letters."""

APART = 4
"""Words after *between* in which its *and* stands."""
LAW = 2
"""Amounts of two things, one of which makes the other: it holds as well if both are turned."""
LONE = 3
"""Most things that an example says, its denial counted, which is about a single one."""

_SYMBOLS = {"²": "^2", "³": "^3", "√": "sqrt ", "∝": "~", "∼": "~", "×": "x", "·": "*", "−": "-",
            "σ": "sigma", "λ": "lambda", "µ": "u", "μ": "mu", "Σ": "sigma", "≈": "~", "⁄": "/",
            "’": "'", "→": ">", "∞": "infinity"}  # fmt: skip
_MARKS = "\u0300-\u036f\u0981-\u0983\u09bc-\u09cd\u09d7\u200c\u200d"
_TOKEN = re.compile(rf"\d+(?:[.,:]\d+)*|[^\W\d_](?:[^\W_]|[{_MARKS}'])*|[^\s\w]|_")
_STOP = frozenset(".!?।;\n")
_PAUSE = frozenset(',:()[]{}–—|>"“”„')
_TIED = frozenset("^/=~*+<%.-_'")
"""Signs that make what stands around them a formula, if no blank is between."""


class WordToken(NamedTuple):
    """A word, a number or a sign of a sentence.

    Parameters
    ----------
    text : str
        As it is compared.
    start, end : int
        Where it stands.
    tied : bool
        Whether no blank stands before it.
    """

    text: str
    start: int
    end: int
    tied: bool


def split_tokens(typed: str) -> list[WordToken]:
    """Return the words, numbers and signs of a text, each with its place."""
    letters, places = [], []
    for place, sign in enumerate(typed):
        for letter in _SYMBOLS.get(sign) or unicodedata.normalize("NFKC", sign).casefold():
            letters.append(letter)
            places.append(place)
    places.append(len(typed))
    text = "".join(letters)
    found: list[WordToken] = []
    last = -1
    for match in _TOKEN.finditer(text):
        for word in _split_prefix(unicodedata.normalize("NFC", match[0])):
            start, end = places[match.start()], places[match.end() - 1] + 1
            found.append(WordToken(word, start, end, match.start() == last))
            last = match.end()
    return _drop_brackets(found)


def _drop_brackets(tokens: list[WordToken]) -> list[WordToken]:
    """Return tokens without brackets around the one argument of a root: ``sqrt(N)`` is ``√N``."""
    texts, dropped = [token.text for token in tokens], set[int]()
    for place, text in enumerate(texts[:-3]):
        if text == "sqrt" and texts[place + 1] == "(" and texts[place + 3] == ")":
            dropped |= {place + 1, place + 3}
    return [token for place, token in enumerate(tokens) if place not in dropped]


def _split_prefix(word: str) -> tuple[str, ...]:
    """Return a word folded, a prefix or an ending that denies it apart: nonlinear, doesn't."""
    if word.endswith("n't") or word in _vocabulary().contracted:
        return ("not",)
    word = word.removesuffix("'s").strip("'")
    folded = fold_word(word) or word
    for prefix in list_words("spelling.denying-prefixes"):
        if folded.startswith(prefix) and len(folded) >= len(prefix) + SHORTEST + 1:
            return ("not", folded.removeprefix(prefix))
    return (folded,)


Words = tuple[str, ...]
"""A row of words, folded, that stands for one thing."""
Scale = tuple[str, int]
"""The name of a scale, and 1 or -1 for its end."""


@dataclass(frozen=True)
class _Vocabulary:
    """The words of all languages that turn, join or compare statements, folded."""

    contracted: frozenset[str]
    breaks: frozenset[str]
    denials: frozenset[str]
    ahead: frozenset[str]
    doubts: tuple[tuple[str, ...], ...]
    ended: frozenset[tuple[str, ...]]
    conditions: frozenset[str]
    harmless: frozenset[tuple[str, ...]]
    that: frozenset[str]
    pointers: frozenset[str]
    speech: frozenset[str]
    verdicts: frozenset[str]
    remarks: frozenset[str]
    corrections: frozenset[tuple[str, ...]]
    than: frozenset[str]
    than_behind: frozenset[str]
    helpers: frozenset[str]
    degrees: frozenset[str]
    halves: frozenset[tuple[str, ...]]
    between: frozenset[str]
    when: frozenset[str]
    causes: frozenset[tuple[str, ...]]
    correlatives: frozenset[str]
    excess: frozenset[str]
    fillers: frozenset[str]
    grammar: frozenset[str]
    scales: Mapping[str, tuple[Scale, ...]]
    stems: tuple[tuple[str, Scale], ...]
    phrases: tuple[tuple[tuple[str, ...], Scale], ...]
    equal: tuple[frozenset[str], ...]


_OF_REMARKS = ("that", "speech", "verdicts", "remarks", "denials", "fillers")
"""Lists of words of which a remark on another statement is made, and nothing else."""


@cache_words
def _vocabulary() -> _Vocabulary:
    """Return the words of all languages, read once."""
    tables = [table for lang in list_languages() if (table := load_words(lang, "statements"))]

    def rows(name: str) -> list[tuple[str, ...]]:
        """Return the rows of words of a list."""
        return [_fold_row(row) for table in tables for row in table["clauses"].get(name, ())]

    def words(name: str) -> frozenset[str]:
        """Return the words of a list, each a row of its own."""
        return frozenset(word for row in rows(name) for word in row)

    ends = [
        (word, (name, sign))
        for table in tables
        for name, listed in table["scales"].items()
        for sign, end in ((1, "one"), (-1, "other"))
        for word in listed[end]
    ]
    return _Vocabulary(
        words("contracted"),
        words("breaks"),
        words("denials"),
        words("ahead"),
        tuple(rows("doubts")),
        frozenset(rows("ended")),
        words("conditions"),
        frozenset(rows("harmless")),
        words("that"),
        words("pointers"),
        words("speech"),
        words("verdicts"),
        frozenset().union(*map(words, _OF_REMARKS)),
        frozenset(rows("corrections")),
        words("than"),
        words("than_behind"),
        words("helpers"),
        words("degrees"),
        frozenset(rows("halves")),
        words("between"),
        words("when"),
        frozenset(rows("causes")),
        words("correlatives"),
        words("excess"),
        words("fillers"),
        frozenset().union(*map(words, (*_OF_REMARKS, "helpers", "breaks"))),
        _group_scales(ends),
        tuple((fold_word(word[:-1]), end) for word, end in ends if word.endswith("-")),
        tuple((_fold_row(word), end) for word, end in ends if " " in word),
        _group_equal_words(table["words"] for table in tables),
    )


@cache_words
def list_clause_words(name: str) -> frozenset[str]:
    """Return the single words of a list of clauses in all languages, folded: ``denials``."""
    return frozenset(
        fold_word(word)
        for lang in list_languages()
        for word in load_words(lang, "statements")["clauses"].get(name, ())
        if " " not in word
    )


@cache_words
def list_equal_words(name: str) -> frozenset[str]:
    """Return the single words that mean the same as one of them in all languages, folded."""
    tables = [table for lang in list_languages() if (table := load_words(lang, "statements"))]
    words = (word for table in tables for word in table["words"].get(name, ()))
    return frozenset(fold_word(word) for word in words if " " not in word)


def _group_scales(ends: Iterable[tuple[str, Scale]]) -> dict[str, tuple[Scale, ...]]:
    """Return each single word with the ends of scales that it stands for."""
    found: dict[str, tuple[Scale, ...]] = {}
    for word, end in ends:
        if " " not in word and not word.endswith("-"):
            key = fold_word(word)
            found[key] = (*found.get(key, ()), end)
    return found


def _group_equal_words(
    tables: Iterable[Mapping[str, Sequence[str]]],
) -> tuple[frozenset[str], ...]:
    """Return the groups of words that mean the same, those of all languages under one name."""
    found: dict[str, set[str]] = {}
    for table in tables:
        for name, listed in table.items():
            found.setdefault(name, set()).update(map(fold_word, listed))
    return tuple(map(frozenset, found.values()))


def _fold_row(text: str) -> tuple[str, ...]:
    """Return the folded words of a row such as ``not only``."""
    return tuple(fold_word(word) for word in text.split())


@lru_cache(maxsize=8192)
def find_scales(word: str, *, slips: bool = True) -> tuple[Scale, ...]:
    """Return the ends of scales that a word stands for, with ``slips`` those of the fingers too."""
    known = _vocabulary()
    if word in known.scales:
        return known.scales[word]
    found = tuple(scale for stem, scale in known.stems if word.startswith(stem))
    if found or not slips or len(word) <= SHORTEST:
        return found
    if word in known.fillers or word in known.grammar:  # *right* is no slip of *bright*
        return ()
    near = [
        scale for stem, scale in known.stems if len(stem) > SHORTEST and _is_near_stem(word, stem)
    ]
    near += [
        scale
        for other, scales in known.scales.items()
        if len(other) > SHORTEST + 1 and _is_slip(word, other)
        for scale in scales
    ]
    return tuple(dict.fromkeys(near))


def _is_slip(word: str, wanted: str) -> bool:
    """Return whether a word is another one with a slip of the fingers, and no word of its own."""
    allowed = allowed_typos(wanted)
    if not allowed or typo_distance(word, wanted, allowed) > allowed:
        return False
    return not is_another_word(word, wanted, ())


def _is_near_stem(word: str, stem: str) -> bool:
    """Return whether a word begins with a stem that has a slip of the fingers in it."""
    return any(_is_slip(word[:size], stem) for size in (len(stem) - 1, len(stem), len(stem) + 1))


@partial(cache_words, most=8192)
def _stems(word: str) -> frozenset[str]:
    """Return a folded word, and what is left of it without each ending that leaves a stem."""
    least = SHORTEST if word.isascii() else 2
    found = {word}
    for end in list_words("spelling.endings"):
        if word.endswith(end):
            stem = word[: -len(end)]
            found |= {stem, stem[:-1]} if stem[-1:] == stem[-2:-1] else {stem}
    plain = list_words("spelling.plain-endings")
    return frozenset(stem for stem in found if len(stem) >= least or stem == word or (
        len(stem) == least - 1 and any(word == stem + end for end in plain)
    ))  # fmt: skip


@lru_cache(maxsize=8192)
def _order_stems(word: str) -> tuple[str, ...]:
    """Return the stems of a word, the longest first: the order of a set differs between runs."""
    return tuple(sorted(_stems(word), key=lambda stem: (-len(stem), stem)))


@lru_cache(maxsize=65536)
def is_form_of(word: str, wanted: str, *, slips: bool = True) -> bool:
    """Return whether a word is a form of the wanted one, or with ``slips`` one of the fingers."""
    if word == wanted:
        return True
    if wanted[:1].isdigit() or not word[:1].isalpha():
        return False
    short = SHORTEST if wanted.isascii() else 3
    if len(wanted) >= short and word.startswith(wanted):
        return True
    if _stems(word) & _stems(wanted):
        return True
    if not slips or word in _vocabulary().grammar:
        return False
    return _is_slip(word, wanted) or any(
        len(stem) > SHORTEST + 1 and _is_slip(typed, stem)
        for typed in _stems(word)
        for stem in _stems(wanted)
    )


@dataclass(frozen=True)
class _Item:
    """One thing that an example says: any of some rows of words, or an end of a scale."""

    rows: tuple[tuple[str, ...], ...] = ()
    scales: tuple[Scale, ...] = ()
    formula: bool = False

    @cached_property
    def begins(self) -> frozenset[str]:
        """Return the words that its rows begin with."""
        return frozenset(row[0] for row in self.rows)

    @property
    def is_general(self) -> bool:
        """Whether it says nothing of a subject."""
        return bool(self.scales)

    @property
    def is_opposed(self) -> bool:
        """Whether the other end of its scale denies it: *some* need not deny *all* of another."""
        return all(name not in {"totality", "sameness"} for name, _ in self.scales)


@dataclass(frozen=True)
class Example:
    """An example of how an idea is put, ready to be looked for.

    Parameters
    ----------
    text : str
        As its author wrote it.
    meaning : Meaning
        What it means for the idea.
    steps : tuple of tuple of _Item
        What must be said; several where one follows the other.
    denied : bool
        Whether it holds a word of denial itself.
    compared : int
        Number of things that it says before it compares them with others; 0 if it does not.
    """

    text: str
    meaning: Meaning
    steps: tuple[tuple[_Item, ...], ...]
    denied: bool
    compared: int

    @property
    def size(self) -> int:
        """Number of things that it says; the more, the better it fits what it is found in."""
        return sum(map(len, self.steps)) + self.denied

    @property
    def scales(self) -> frozenset[str]:
        """Names of the scales that it has a word of."""
        items = itertools.chain.from_iterable(self.steps)
        return frozenset(name for item in items for name, _ in item.scales)

    @cached_property
    def is_law(self) -> bool:
        """Whether it says how the amounts of two things go together, and no more.

        *A smaller hole makes a smaller disc*: turned once it is wrong, turned twice it is right.
        """
        items = self.steps[0] if len(self.steps) == 1 and self.meaning == "said" else ()
        scales = [item.scales for item in items if item.scales]
        joined = any(token.text in _vocabulary().breaks for token in split_tokens(self.text))
        return not joined and len(scales) == len(items) - len(scales) == LAW and all(
            any(name == "amount" for name, _ in one) for one in scales
        )  # fmt: skip

    @cached_property
    def has_excess(self) -> bool:
        """Whether it finds fault: *too few bits* are no contradiction of the cure, *more bits*."""
        return any(token.text in _vocabulary().excess for token in split_tokens(self.text))

    @property
    def is_bare(self) -> bool:
        """Whether it says how much, or how bright, and nothing else."""
        return self.size == 1 and bool(self.scales)


class Subject:
    """What a subject has words for: groups of words, or rows of words, that mean the same.

    Parameters
    ----------
    synonyms : tuple of tuple of str
    """

    def __init__(self, synonyms: tuple[tuple[str, ...], ...]) -> None:
        self.groups = tuple(
            tuple(row for one in group if (row := tuple(t.text for t in split_tokens(one))))
            for group in synonyms
        )
        self._begins: dict[str, list[tuple[int, tuple[str, ...]]]] = {}
        for index, rows in enumerate(self.groups):
            for row in rows:
                for stem in _stems(row[0]):
                    self._begins.setdefault(stem, []).append((index, row))
        self._read: dict[tuple[str, Meaning], Example] = {}
        self._items: dict[_Item, _Item] = {}
        self._words: dict[tuple[tuple[str, Meaning], ...], ExampleWords] = {}

    def find(
        self, tokens: Sequence[WordToken], place: int
    ) -> tuple[tuple[tuple[str, ...], ...], int]:
        """Return the group of which a row stands at a token, the longest; and its length.

        Of rows of one length, that counts which shares the longest stem with the token.
        """
        best: tuple[tuple[tuple[str, ...], ...], int] = ((), 0)
        for stem in _order_stems(tokens[place].text):
            for index, row in self._begins.get(stem, ()):
                if len(row) > best[1] and _has_stems(tokens, place, row):
                    best = (self.groups[index], len(row))
        return best

    def read(self, text: str, meaning: Meaning) -> Example:
        """Return an example of an idea, ready to be looked for.

        Parameters
        ----------
        text : str
            A few words; ``->`` between what is said first and what follows.
        meaning : Meaning
        """
        known = self._read.get((text, meaning))
        if known is None:
            known = self._read[text, meaning] = _read_example(text, meaning, self)
        return known

    def share_item(self, item: _Item) -> _Item:
        """Return the one item that stands for all that are equal to it."""
        return self._items.setdefault(item, item)

    def collect_words(
        self, examples: Sequence[Example], mistakes: Sequence[Example]
    ) -> ExampleWords:
        """Return the words of examples of a part and of its mistakes, the same for the same ones.

        Parameters
        ----------
        examples, mistakes : sequence of Example
        """
        asked = tuple((one.text, one.meaning) for one in (*examples, *mistakes))
        if asked not in self._words:
            self._words[asked] = ExampleWords(examples, mistakes)
        return self._words[asked]


class ExampleWords:
    """The words of all examples of a part, and which of them each typed word may be.

    All answers to a part are searched for the same words, and most are none of them.

    Parameters
    ----------
    examples : sequence of Example
        No word of them is taken for another one misspelt.
    mistakes : sequence of Example
    """

    def __init__(self, examples: Sequence[Example] = (), mistakes: Sequence[Example] = ()) -> None:
        rows = _iter_rows(examples)
        self.own = frozenset(stem for row in rows for word in row for stem in _stems(word))
        self._begins = sorted({row[0] for row in _iter_rows((*examples, *mistakes))})
        self._found: dict[str, tuple[str, ...]] = {}

    def has_own(self, typed: str) -> bool:
        """Return whether a typed word is a form of one of the examples: no slip of another."""
        return not self.own.isdisjoint(_stems(typed))

    def find_begun(self, typed: str) -> tuple[str, ...]:
        """Return the words that rows begin with and of which a typed word is a form."""
        found = self._found.get(typed)
        if found is None:
            if len(self._found) >= MOST_TYPED:
                self._found.clear()
            slips = not self.has_own(typed)
            found = tuple(word for word in self._begins if is_form_of(typed, word, slips=slips))
            self._found[typed] = found
        return found


MOST_TYPED = 4096
"""Typed words that are remembered for a part."""


def _iter_rows(examples: Iterable[Example]) -> Iterator[tuple[str, ...]]:
    """Yield the rows of words of all items of examples."""
    for one in examples:
        for step in one.steps:
            for item in step:
                yield from item.rows


@lru_cache(maxsize=512)
def read_subject(synonyms: tuple[tuple[str, ...], ...]) -> Subject:
    """Return a subject, the same for the same synonyms."""
    return Subject(synonyms)


def read_words(texts: Iterable[str], subject: Subject) -> frozenset[Words]:
    """Return names of a thing as rows of words, with all that mean the same in the subject."""
    found = set[Words]()
    for text in texts:
        tokens = split_tokens(text)
        rows, length = subject.find(tokens, 0)
        found |= set(rows) if length == len(tokens) else {tuple(token.text for token in tokens)}
    return frozenset(found)


def _is_condition(words: Sequence[str], index: int) -> bool:
    """Return whether a word says under what condition a clause holds: *without a lens, ...*."""
    return index == 0 and len(words) > LONGEST_NOUN + 1 and words[0] in _vocabulary().conditions


def _read_example(text: str, meaning: Meaning, subject: Subject) -> Example:
    """Return an example of an idea, ready to be looked for."""
    known = _vocabulary()
    steps: list[list[_Item]] = []
    denied, compared = False, 0
    for piece in text.replace("→", "->").split("->"):
        tokens = split_tokens(piece)
        steps.append([])
        place = 0
        while place < len(tokens):
            item, length = _read_item(tokens, place, subject)
            words = [token.text for token in tokens[place : place + length]]
            denies = item is None and words[0] in known.denials | known.ahead
            if denies and not _is_condition([token.text for token in tokens], place):
                denied = not denied
            if item is None and words[0] in known.than | known.than_behind:
                compared = max(len(steps[-1]), 1)
            steps[-1] += [subject.share_item(item)] if item else []
            place += length
    return Example(text, meaning, tuple(map(tuple, filter(None, steps))), denied, compared)


def _read_item(
    tokens: Sequence[WordToken], place: int, subject: Subject
) -> tuple[_Item | None, int]:
    """Return what an example says from a token on, and how many tokens that takes."""
    rows, length = subject.find(tokens, place)
    if rows:
        return _Item(rows), length
    end = place + 1
    while end < len(tokens) and _is_in_formula(tokens, end):
        end += 1
    if end > place + 1:
        return _Item((tuple(token.text for token in tokens[place:end]),), formula=True), end - place
    for row, scale in _vocabulary().phrases:
        if _has_row(tokens, place, row):
            return _Item(scales=(scale,)), len(row)
    item = _read_word(tokens[place].text)
    before = tuple(token.text for token in tokens[max(place - 2, 0) : place])
    if item and item.scales and before in _vocabulary().halves:
        item = _Item(scales=_scale_down(item.scales))
    return item, 1


def _scale_down(scales: Iterable[Scale]) -> tuple[Scale, ...]:
    """Return what is said of an amount that is only a part of another: less."""
    return tuple((name, -1) for name, _ in scales if name == "amount")


def _read_word(word: str) -> _Item | None:
    """Return what a single word of an example says; None if it only joins, denies or compares."""
    known = _vocabulary()
    if word in known.denials | known.ahead | known.than | known.than_behind:
        return None
    scales = find_scales(word, slips=False)
    if scales:
        return _Item(scales=scales)
    if word in known.fillers or word in known.breaks or not word[0].isalnum():
        return None
    same = {other for group in known.equal if word in group for other in group}
    return _Item(tuple((other,) for other in sorted({word, *same})))


def _is_in_formula(tokens: Sequence[WordToken], place: int) -> bool:
    """Return whether a token is tied to the one before it by a sign, as in ``D^2``."""
    one, before = tokens[place], tokens[place - 1]
    signs = _TIED - {"-", "'", "."}
    if before.text == "sqrt":
        return True
    return one.tied and (
        one.text in signs or before.text in signs or one.text in "()" or before.text == "("
    )


def _has_row(
    tokens: Sequence[WordToken],
    place: int,
    row: Sequence[str],
    *,
    exactly: bool = False,
    known: frozenset[str] = frozenset(),
) -> bool:
    """Return whether a row of words begins at a token; hyphens between them do not count.

    A ``known`` word is never another one misspelt.
    """
    for word in row:
        while place < len(tokens) and tokens[place].text == "-" and word != "-":
            place += 1
        if place >= len(tokens):
            return False
        typed = tokens[place].text
        if typed != word and (
            exactly or not is_form_of(typed, word, slips=known.isdisjoint(_stems(typed)))
        ):
            return False
        place += 1
    return True


def _has_stems(tokens: Sequence[WordToken], place: int, row: Sequence[str]) -> bool:
    """Return whether a row of words begins at a token, but for their endings."""
    found = [token.text for token in tokens[place : place + len(row)]]
    return len(found) == len(row) and all(
        typed == word or bool(_stems(typed) & _stems(word))
        for typed, word in zip(found, row, strict=True)
    )


@dataclass
class _Clause:
    """A clause: the indices of its tokens, what denies it, and what is only compared with."""

    sentence: int
    places: list[int] = field(default_factory=list)
    denials: list[int] = field(default_factory=list)
    whole: int = 0
    ahead: list[int] = field(default_factory=list)
    compared: set[int] = field(default_factory=set)
    corrects: bool = False
    doubted: bool = False


@dataclass(frozen=True)
class Evidence:
    """What a clause, or a few of them, does with an idea.

    Parameters
    ----------
    meaning : Meaning
    example : str
        By which it was recognised.
    first, last : int
        The clauses.
    size : int
        How much of it was recognised.
    places : tuple of int
        The tokens that were.
    turned : bool
        Whether an opposite word alone made it a denial.
    law : bool
        Whether its clauses say each one end of how two amounts go together.
    """

    meaning: Meaning
    example: str
    first: int
    last: int
    size: int
    places: tuple[int, ...]
    turned: bool = False
    law: bool = False

    @property
    def is_loose(self) -> bool:
        """Return whether it is spread over clauses, and most of their words are others."""
        apart = self.last > self.first
        return apart and self.places[-1] - self.places[0] >= LOOSE * len(self.places)


class Statement:
    """A text of a learner, cut into clauses.

    Parameters
    ----------
    typed : str
    subject : Subject, optional
        Rows of words that are one thing in it neither end nor deny a clause.
    """

    def __init__(self, typed: str, subject: Subject | None = None) -> None:
        self.typed, self._words = typed, ExampleWords()
        self.tokens = split_tokens(typed)
        self._held = self._find_held(subject) if subject else set()
        self.clauses = self._cut()
        self._rows: dict[int, tuple[_Item, list[tuple[int, ...]]]] = {}
        self._scales: dict[int, tuple[Scale, ...]] = {}
        self._doubts: dict[int, set[int]] = {}

    def _find_held(self, subject: Subject) -> set[int]:
        """Return the tokens in a row of words of the subject, such as ``salt and pepper``."""
        held: set[int] = set()
        for place in range(len(self.tokens)):
            _, length = subject.find(self.tokens, place)
            held |= set(range(place, place + length)) if length > 1 else set()
        return held

    def _cut(self) -> list[_Clause]:
        """Return the clauses, each with what denies it."""
        known, found, sentence = _vocabulary(), [_Clause(0)], 0
        for place, token in enumerate(self.tokens):
            if place in self._held:
                found[-1].places.append(place)
                continue
            if token.text in _STOP and self._ends_sentence(place):
                sentence += 1
                found.append(_Clause(sentence))
            elif self._pauses(place):
                found.append(_Clause(sentence))
            elif token.text in known.breaks and not self._is_between(place):
                found.append(_Clause(sentence, [place]))
            else:
                found[-1].places.append(place)
        found = [
            clause
            for clause in found
            if any(at in self._held or self.tokens[at].text not in known.breaks
                   for at in clause.places)
        ]  # fmt: skip
        for clause in found:
            self._read_denials(clause)
        self._spread_remarks(found)
        return found

    def _is_between(self, place: int) -> bool:
        """Return whether a word joins two things between which something is."""
        known, before = _vocabulary(), self.tokens[max(place - APART, 0) : place]
        near = [at for at, token in enumerate(before) if token.text in known.between]
        return bool(near) and not any(
            token.text in known.breaks or token.text in _PAUSE | _STOP
            for token in before[near[-1] :]
        )

    def _stands_between(self, place: int) -> bool:
        """Return whether a word is one of two between which something is: nothing is said of it."""
        known = _vocabulary()
        texts = [token.text for token in self.tokens[max(place - APART, 0) : place + APART]]
        if known.between.isdisjoint(texts):
            return False
        joins = [place - 1, *range(place + 1, min(place + APART, len(self.tokens)))]
        return any(
            at > 0
            and self.tokens[at].text in known.breaks
            and self._is_between(at)
            and (at < place or any(token.text in known.between
                                   for token in self.tokens[max(at - APART, 0) : place]))
            for at in joins
        )  # fmt: skip

    def _ends_sentence(self, place: int) -> bool:
        """Return whether a stop ends a sentence and no abbreviation or number."""
        token = self.tokens[place]
        if token.text != ".":
            return True
        before = self.tokens[place - 1].text if place else ""
        after = self.tokens[place + 1] if place + 1 < len(self.tokens) else None
        if after and after.tied:
            return False
        if len(before) == 1 and before.isalnum():
            return place > 1 and after is not None and self._is_capitalised(place - 1, place + 1)
        return bool(before) and before not in {"vs", "etc", "ca"}

    def _is_capitalised(self, last: int, place: int) -> bool:
        """Return whether a word begins a sentence after a number, or a name of one letter.

        After other letters it may be part of an abbreviation: ``z. B.``.
        """
        word, before = self.tokens[place], self.typed[self.tokens[last].start]
        begins = len(word.text) > 1 and self.typed[word.start].isupper()
        return begins and (before.isdigit() or before.isupper())

    def _pauses(self, place: int) -> bool:
        """Return whether a sign parts two clauses."""
        token = self.tokens[place]
        if token.text == "-":
            after = self.tokens[place + 1] if place + 1 < len(self.tokens) else None
            return not token.tied and after is not None and not after.tied
        if token.text in "()":
            return not self._is_call(place)
        return token.text in _PAUSE and not self._is_correlative(place)

    def _is_correlative(self, place: int) -> bool:
        """Return whether a comma joins two amounts: *the smaller this, the smaller that*."""
        known, begin = _vocabulary().correlatives, place - 1
        if place + 2 >= len(self.tokens) or self.tokens[place + 1].text not in known:
            return False
        while begin > 0 and self.tokens[begin - 1].text not in _PAUSE | _STOP:
            begin -= 1
        return all(
            any(
                self.tokens[at].text in known and self._begins_amount(at)
                for at in range(first, last)
            )
            for first, last in ((begin, place - 1), (place + 1, place + 2))
        )

    def _begins_amount(self, place: int) -> bool:
        """Return whether an amount stands behind a word: next to it if that says little."""
        reach = 1 if self.tokens[place].text in _vocabulary().fillers else APART
        after = self.tokens[place + 1 : place + 1 + reach]
        return any(name == "amount" for token in after for name, _ in find_scales(token.text))

    def _is_call(self, place: int) -> bool:
        """Return whether a bracket stands around the argument of a function, as in ``V(λ)``."""
        opened = place
        while opened >= 0 and self.tokens[opened].text != "(":
            opened -= 1
        return opened > 0 and self.tokens[opened].tied

    def _read_denials(self, clause: _Clause) -> None:
        """Find the words of a clause that deny it, or what follows them, and what is compared."""
        known, words = _vocabulary(), [self.tokens[at].text for at in clause.places]
        clause.corrects = tuple(words) in known.corrections or any(
            tuple(words[: len(row)]) == row for row in known.corrections if len(row) > 1
        )
        if clause.corrects:
            return
        turning = known.denials | known.ahead | known.than | known.than_behind
        for index, (place, word) in enumerate(zip(clause.places, words, strict=True)):
            if place in self._held or word not in turning:
                continue
            if any(tuple(words[index : index + len(row)]) == row for row in known.harmless):
                continue
            if word in known.denials:
                clause.denials.append(place)
                clause.whole += self._is_whole(words, index)
            elif word in known.ahead and not _is_condition(words, index):
                clause.ahead.append(place)
            if word in known.than and any(
                name == "amount" for one in words[:index] for name, _ in find_scales(one)
            ):
                clause.compared |= set(clause.places[index + 1 :])
            elif word in known.than_behind and index:
                clause.compared |= set(clause.places[max(index - 1, 0) : index])

    def _is_whole(self, words: Sequence[str], index: int) -> bool:
        """Return whether a denial covers its clause, not just what follows: ``thin, not thick``."""
        if index == 0 or index == len(words) - 1:
            return True
        if words[index] == "no":
            return words[index - 1] != "with"
        nearby = words[max(0, index - 3) : index]
        return words[index] != "not" or any(word in _vocabulary().helpers for word in nearby)

    def _spread_remarks(self, clauses: list[_Clause]) -> None:
        """Doubt what a remark denies: *nobody would say that ...*, *..., which is wrong*.

        A remark speaks of what is said and of nothing else. What it denies stands behind it, or
        before it in its sentence; one that is a sentence by itself denies the sentence before.
        """
        remarks = [self._is_remark(clause) for clause in clauses]
        for index, clause in enumerate(clauses):
            begins = not index or clauses[index - 1].sentence != clause.sentence
            behind = self._count_remark(clauses, index) if begins else 0
            clause.doubted |= index > 0 and clause.corrects
            behind = behind or 2 * (begins and self._is_bare_denial(clause))
            if behind:
                for other in clauses[index + behind - 1 :]:
                    other.doubted |= other.sentence == clause.sentence
            elif remarks[index]:
                content = [
                    (at, other.sentence)
                    for at, other in enumerate(clauses)
                    if not remarks[at] and at != index
                ]
                mine = [at for at, sentence in content if sentence == clause.sentence]
                of = clause.sentence
                if not mine or (index < mine[0] and self._points_back(clause)):
                    of -= 1
                clause.doubted = index > 0
                for other in clauses[:index]:
                    other.doubted |= other.sentence == of

    def _count_remark(self, clauses: Sequence[_Clause], first: int) -> int:
        """Return how many clauses a remark at the head of a sentence reaches into; 0 without one.

        It denies once, up to its last word such as *that* or *think*. *The mistake is that ...*
        denies nothing.
        """
        known, head, size, reach = _vocabulary(), [], 0, 0
        for count, clause in enumerate(clauses[first:], 1):
            words = [self.tokens[at].text for at in clause.places]
            if clause.sentence != clauses[first].sentence or (
                count > 1 and words[0] not in known.that
            ):
                break
            inside = list(itertools.takewhile(known.remarks.__contains__, words))
            for word in inside:
                head.append(word)
                if word in known.that | known.speech:
                    size, reach = len(head), count
            if len(inside) < len(words):
                break
        head = head[:size]
        if not head or not self._denies(head):
            return 0
        states = len(head) > 1 and head[-1] in known.that and head[-2] in known.helpers
        return 0 if states and head[0] not in known.verdicts else reach

    def _is_bare_denial(self, clause: _Clause) -> bool:
        """Return whether a clause is a denial before a colon, and no correction."""
        texts = [self.tokens[at].text for at in clause.places]
        known, after = _vocabulary(), clause.places[-1] + 1
        return (
            not clause.corrects
            and len(self.tokens) > after
            and self.tokens[after].text == ":"
            and bool(clause.denials)
            and all(one in known.denials | known.fillers | known.remarks for one in texts)
        )

    def _is_remark(self, clause: _Clause) -> bool:
        """Return whether a clause only says that what was said is not so."""
        words = [self.tokens[at].text for at in clause.places]
        return clause.corrects or (
            all(word in _vocabulary().remarks for word in words) and self._denies(words)
        )

    def _points_back(self, clause: _Clause) -> bool:
        """Return whether a remark says *this* or *that* of the sentence before."""
        return self.tokens[clause.places[0]].text in _vocabulary().that | _vocabulary().pointers

    def _denies(self, words: Sequence[str]) -> bool:
        """Return whether words deny an odd number of times: *no doubt* denies nothing."""
        known = _vocabulary()
        return sum(word in known.denials | known.verdicts for word in words) % 2 == 1

    def know(self, words: ExampleWords) -> None:
        """Take the words of what will be looked for, before anything is."""
        self._words = words

    def find(
        self,
        examples: Iterable[Example],
        mine: Collection[Words] = (),
        others: Collection[Words] = (),
    ) -> list[Evidence]:
        """Return what the clauses do with an idea, by its examples; the best fit for each clause.

        After a word of correction (*no: brighter*), what was said of the idea before is dropped.

        Parameters
        ----------
        examples : iterable of Example
        mine, others : collection of tuple of str, optional
            What the idea is said of, and what other ideas are said of instead, each a row of words.
        """
        found = [
            self._open_if_unsure(one, example, mine, others)
            for example in examples
            if self._may_hold(example)
            for one in self._iter_evidence(example)
        ]
        kept: list[Evidence] = []
        for one in sorted(found, key=_rank):
            if not any(other.first <= one.last and one.first <= other.last for other in kept):
                kept.append(one)
        for index, clause in enumerate(self.clauses):
            if clause.corrects and any(one.first > index for one in kept):
                kept = [one for one in kept if one.first > index]
        return sorted(kept, key=lambda one: one.first)

    def _open_if_unsure(
        self,
        evidence: Evidence,
        example: Example,
        mine: Collection[Words],
        others: Collection[Words],
    ) -> Evidence:
        """Return evidence, left open where its clauses doubt it, or say it of something else."""
        if evidence.meaning not in {"said", "half"}:
            elsewhere = evidence.turned and self._is_said_of_another(evidence, mine, others)
            return replace(evidence, meaning="open") if elsewhere else evidence
        clauses = range(evidence.first, evidence.last + 1)
        unsure = (
            any(self.clauses[at].doubted for at in clauses)
            or self._is_said_of_another(evidence, mine, others)
            or any(not self._list_doubts(at) <= {*evidence.places} for at in clauses)
            or self._has_other_end(evidence, example)
        )
        return replace(evidence, meaning="open") if unsure else evidence

    def _list_doubts(self, index: int) -> set[int]:
        """Return the tokens of a clause where words such as *fails to* begin."""
        if index not in self._doubts:
            places = self.clauses[index].places
            words = [self.tokens[at].text for at in places]
            self._doubts[index] = {
                places[at]
                for row in _vocabulary().doubts
                for at in range(len(words))
                if words[at] == row[0] and tuple(words[at : at + len(row)]) == row
            }
        return self._doubts[index]

    def _has_other_end(self, evidence: Evidence, example: Example) -> bool:
        """Return whether clauses also say the other end of a scale of an example.

        Of sameness and totality in any clause (*equal distances look unequal*, *all of some*), of
        amounts in one of several, where an idea without amounts is not to have one, either (*S gets
        less, only H stays*).
        """
        apart = evidence.first < evidence.last
        names = {"sameness", "totality", *(["amount"] if apart else [])}
        wanted = {
            scale
            for step in example.steps
            for item in step
            for scale in item.scales
            if scale[0] in names
        }
        wanted -= {(name, -sign) for name, sign in wanted}
        if apart and not any(item.scales for step in example.steps for item in step):
            wanted |= {("amount", 1), ("amount", -1)}
        return bool(wanted) and any(
            (name, -sign) in wanted
            for clause in self.clauses[evidence.first : evidence.last + 1]
            for at in clause.places
            if at not in evidence.places
            for name, sign in self._scales_at(at)
            if name != "sameness" or not self._is_called_equal(at)
        )

    def _is_called_equal(self, place: int) -> bool:
        """Return whether differences are what is equal: *equally visible differences*."""
        return any(("sameness", 1) in self._scales_at(at) for at in range(max(place - 2, 0), place))

    def _is_said_of_another(
        self, evidence: Evidence, mine: Collection[Words], others: Collection[Words]
    ) -> bool:
        """Return whether a word of an idea stands in a clause that speaks of another thing.

        A clause that names nothing speaks of what was named last in its sentence.
        """
        if not others:
            return False
        for index in {self._clause_of(at) for at in evidence.places}:
            if self._is_framed_by_another(index, mine, others):
                return True
            for clause in reversed(self.clauses[: index + 1]):
                if clause.sentence != self.clauses[index].sentence:
                    break
                if self._names(clause, mine):
                    if self._gives_other_cause(clause, mine, others):
                        return True
                    break
                if self._names(clause, others):
                    return True
        return False

    def _is_framed_by_another(
        self, index: int, mine: Collection[Words], others: Collection[Words]
    ) -> bool:
        """Return whether a clause stands under the name of another thing, or its condition.

        *Printer: additive RGB*, and *it is infinite if the thing is far away*.
        """
        heading = self._find_heading(index, (*mine, *others))
        if heading is not None:
            return self._names(heading, others) and not self._names(heading, mine)
        if index + 1 == len(self.clauses) or self._names(self.clauses[index], mine):
            return False
        clause = self.clauses[index + 1]
        begins = self.tokens[clause.places[0]].text in _vocabulary().when
        together = clause.sentence == self.clauses[index].sentence
        named = begins and together and self._names(clause, others)
        return named and not self._names(clause, mine)

    def _find_heading(self, index: int, things: Collection[Words]) -> _Clause | None:
        """Return what stands before the last colon ahead that names one of some things.

        It holds to the end of its line or up to a full stop, over semicolons: *CCD: streaks; high
        power*.
        """
        for clause in reversed(self.clauses[:index]):
            after = clause.places[-1] + 1
            sign = self.tokens[after].text if after < len(self.tokens) else ""
            if sign in _STOP - {";"}:
                return None
            if sign == ":" and self._names(clause, things):
                return clause
        return None

    def _gives_other_cause(
        self, clause: _Clause, mine: Collection[Words], others: Collection[Words]
    ) -> bool:
        """Return whether a clause says that one thing comes from another: *fringes by vignetting*.

        What stands before a word such as *because of* and what behind it are not of one idea.
        """
        for row in _vocabulary().causes:
            for at in clause.places:
                if not _has_row(self.tokens, at, row, exactly=True):
                    continue
                sides = (
                    replace(clause, places=[one for one in clause.places if one < at]),
                    replace(clause, places=[one for one in clause.places if one >= at + len(row)]),
                )
                told = [(self._names(one, mine), self._names(one, others)) for one in sides]
                if sorted(told) == [(False, True), (True, False)]:
                    return True
        return False

    def _names(self, clause: _Clause, rows: Iterable[Words]) -> bool:
        """Return whether a clause names one of some things, and does not compare with it."""
        return any(
            at not in clause.compared and _has_row(self.tokens, at, row, known=self._words.own)
            for row in rows
            for at in clause.places
        )

    def _may_hold(self, example: Example) -> bool:
        """Return whether every word of an example is there; most have one that is nowhere."""
        items = example.steps[0] if len(example.steps) == 1 else ()
        return all(item.scales or self._list_rows(item) for item in items)

    def touches(self, examples: Iterable[Example]) -> bool:
        """Return whether any word of the examples is there."""
        everywhere = range(len(self.tokens))
        items = {item for example in examples for step in example.steps for item in step}
        return any(
            self._find_end(item, everywhere, ())[1] is not None
            if item.scales
            else bool(self._find_rows(item, everywhere))
            for item in items
        )

    def _iter_evidence(self, example: Example) -> Iterator[Evidence]:
        """Yield where an example is found, in one clause and, if nothing turns it, in several."""
        if len(example.steps) > 1:
            yield from self._find_order(example)
            return
        (items,) = example.steps or ((),)
        single: set[int] = set()
        for index in range(len(self.clauses)):
            fit = self._fit(items, self._clause_tokens[index], example)
            clause = self.clauses[index]
            if fit and (clause.corrects or not set(fit[1]).isdisjoint(clause.places)):
                single.add(index)
                yield from self._weigh(example, index, fit)
        for width in range(2, WIDEST + 1):
            for first in range(len(self.clauses) - width + 1):
                last = first + width - 1
                window = self.clauses[first : last + 1]
                if single & set(range(first, last + 1)) or len({c.sentence for c in window}) > 1:
                    continue
                if any(c.corrects for c in window) or all(item.is_general for item in items):
                    continue
                if example.meaning == "denied" and not self._are_joined(window, example):
                    continue
                fit = self._fit(items, [at for c in window for at in c.places], example)
                for one in self._join(window, first, fit, example) if fit else ():
                    single |= set(range(first, last + 1))
                    yield one

    def _are_joined(self, window: Sequence[_Clause], example: Example) -> bool:
        """Return whether words such as *and* join clauses, and no sign; so in the example, too."""
        breaks = _vocabulary().breaks
        return not breaks.isdisjoint(example.text.casefold().split()) and all(
            self.tokens[clause.places[0]].text in breaks for clause in window[1:]
        )

    @cached_property
    def _clause_tokens(self) -> list[list[int]]:
        """Return the tokens of each clause; one that only compares takes those before it, too.

        *brighter, so darker*: what gets darker was said before.
        """
        fillers, breaks = _vocabulary().fillers, _vocabulary().breaks
        found: list[list[int]] = []
        for index, clause in enumerate(self.clauses):
            words = [at for at in clause.places if self.tokens[at].text not in fillers | breaks]
            words = [at for at in words if at not in clause.denials]
            follows = index and self.clauses[index - 1].sentence == clause.sentence
            alone = bool(words) and all(self._scales_at(at) for at in words)
            before = [at for at in found[-1] if not self._scales_at(at)] if found else []
            completed = [*before, *clause.places] if follows and alone else clause.places
            found.append(found[-1] if clause.corrects and found else completed)
        return found

    def _join(
        self,
        window: Sequence[_Clause],
        first: int,
        fit: tuple[int, tuple[int, ...]],
        example: Example,
    ) -> Iterator[Evidence]:
        """Yield what several clauses say together, if nothing but one end of a law turns it."""
        sign, places = fit
        if self._spread_denial(window, places, example) or self._leaves_only(window, places):
            return
        law = bool(sign) and example.is_law and self._has_amount_each(window)
        if sign > 0 or law:
            meaning: Meaning = example.meaning if sign > 0 else "denied"
            last = first + len(window) - 1
            yield Evidence(meaning, example.text, first, last, example.size, places, law=law)

    def _has_amount_each(self, window: Sequence[_Clause]) -> bool:
        """Return whether two clauses have one amount each, as *if this grows, that shrinks*."""
        return len(window) == LAW and all(
            sum(any(name == "amount" for name, _ in self._scales_at(at)) for at in clause.places)
            == 1
            for clause in window
        )

    def _leaves_only(self, window: Sequence[_Clause], places: tuple[int, ...]) -> bool:
        """Return whether a word such as *only* or *every* is all that is needed of a clause.

        *Only the cones work and the rods switch off* does not say *only the rods*.
        """
        alone = list_equal_words("only")
        return any(
            bool(mine)
            and all(
                self.tokens[at].text in alone
                or any(name == "totality" for name, _ in self._scales_at(at))
                for at in mine
            )
            for clause in window
            for mine in [[at for at in places if at in clause.places]]
        )

    def _spread_denial(
        self, window: Sequence[_Clause], places: tuple[int, ...], example: Example
    ) -> bool:
        """Return whether a clause that is needed of several is denied, or has nothing of them."""
        used = [clause for clause in window if set(clause.places) & set(places)]
        if window[0] not in used or window[-1] not in used:
            return True
        return any(c.denials or c.ahead for c in used) or example.denied

    def _fit(
        self, items: Sequence[_Item], places: Sequence[int], example: Example
    ) -> tuple[int, tuple[int, ...]] | None:
        """Return 1 (as stated), -1 (by an opposite), 0 (both), and the tokens; None if absent."""
        if not items:
            return None
        taken: list[int] = []
        blocked = set[int]() if example.compared else self._compared_tokens
        than = [at for at in places if self.tokens[at].text in _vocabulary().than]
        exchanged = False
        for index, item in enumerate(items):
            if item.scales:
                continue
            rows = self._find_rows(item, places)
            rows = [row for row in rows if not set(row) & (blocked | set(taken))]
            if not rows:
                return None
            if example.compared and than:  # *more of this than of that*: each on its side
                ahead = index < example.compared
                sided = [row for row in rows if (row[0] < than[0]) == ahead]
                exchanged |= not sided
                rows = sided or rows
            taken += _nearest_row(rows, taken)
        sign, flips = 1, 0
        law = example.is_law
        for item in items:
            if not item.scales:
                continue
            end, place = self._find_end(item, places, taken)
            if place is None or (end < 0 and not item.is_opposed):
                return None
            flips += end < 0
            sign *= end
            taken += [place]
        unsure = exchanged or (flips > 1 and not (law and flips == LAW))
        return (0 if unsure else sign), tuple(sorted(taken))

    @cached_property
    def _compared_tokens(self) -> set[int]:
        """Return the tokens of all clauses with which something is compared."""
        return {at for clause in self.clauses for at in clause.compared}

    def _find_end(
        self, item: _Item, places: Iterable[int], taken: Sequence[int]
    ) -> tuple[int, int | None]:
        """Return which end of a scale is said nearest to other words, and where.

        That is 1 for the end of the item, -1 for the other one if only that is said, else 0.
        """
        found: dict[int, set[int]] = {}
        for at in places:
            if at not in taken:
                ends = {
                    sign * end
                    for name, sign in item.scales
                    for other, end in self._scales_at(at)
                    if name == other
                }
                found |= {at: ends} if ends else {}
        if not found:
            return 0, None
        away = {at: min((abs(at - other) for other in taken), default=0) for at in found}
        nearest = [at for at in found if away[at] == min(away.values())]
        right = [at for at in nearest if found[at] == {1}]
        if right and (taken or len(right) == len(found)):
            both = any(-1 in found[at] for at in nearest)
            return (0 if both and len(taken) < 2 else 1), right[0]
        alone = all(1 not in ends for ends in found.values())
        return (-1 if alone else 0), nearest[0]

    def _scales_at(self, place: int) -> tuple[Scale, ...]:
        """Return the ends of scales at a token, rows of words such as ``nimmt ab`` included."""
        if place not in self._scales:
            word = self.tokens[place].text
            if place and (self.tokens[place - 1].text, word) in _vocabulary().ended:
                self._scales[place] = ()
                return ()
            rows = tuple(
                scale for row, scale in _vocabulary().phrases if self._has_loose_row(place, row)
            )
            found = rows or find_scales(word, slips=not self._words.has_own(word))
            before = tuple(token.text for token in self.tokens[max(place - 2, 0) : place])
            if self._stands_between(place):
                found = ()
            elif before in _vocabulary().halves:  # *half as wide* is narrower
                found = _scale_down(found)
            self._scales[place] = found
        return self._scales[place]

    def _has_loose_row(self, place: int, row: Sequence[str]) -> bool:
        """Return whether a row begins here, with up to three words between: ``nimmt stark ab``."""
        if not is_form_of(self.tokens[place].text, row[0]) or len(self.tokens[place].text) < 2:
            return False
        after = [token.text for token in self.tokens[place + 1 : place + 5]]
        return all(word in after for word in row[1:])

    def _find_rows(self, item: _Item, places: Iterable[int]) -> list[tuple[int, ...]]:
        """Return the tokens of each of some places where a row of an item stands."""
        inside = set(places)
        return [row for row in self._list_rows(item) if row[0] in inside and row[-1] in inside]

    def _list_rows(self, item: _Item) -> list[tuple[int, ...]]:
        """Return the tokens of each place of the text where a row of an item stands."""
        if id(item) not in self._rows:
            found = () if item.begins.isdisjoint(self._begun) else sorted(
                (at, number)
                for number, row in enumerate(item.rows)
                for at in self._begun.get(row[0], ())
                if self._stands(item, row, at)
            )  # fmt: skip
            rows = [tuple(range(at, at + len(item.rows[number]))) for at, number in found]
            self._rows[id(item)] = (item, rows)
        return self._rows[id(item)][1]

    @cached_property
    def _firsts(self) -> list[tuple[int, str]]:
        """Return each token with the word that a row begins with there: after hyphens, if any."""
        found: list[tuple[int, str]] = []
        after = ""
        for at in reversed(range(len(self.tokens))):
            text = self.tokens[at].text
            if text == "-":
                found.append((at, text))
            after = after if text == "-" else text
            if after:
                found.append((at, after))
        return found[::-1]

    @cached_property
    def _begun(self) -> dict[str, list[int]]:
        """Return the tokens at which a row may begin, by its first word."""
        found: dict[str, list[int]] = {}
        for at, typed in self._firsts:
            for word in self._words.find_begun(typed):
                found.setdefault(word, []).append(at)
        return found

    def _stands(self, item: _Item, row: Sequence[str], place: int) -> bool:
        """Return whether a row stands at a token; a formula only if it goes on neither way.

        A word in the middle of another row of the subject is no word of its own.
        """
        if len(row) == 1 and place in self._held:
            return False
        if not _has_row(self.tokens, place, row, exactly=item.formula, known=self._words.own):
            return False
        if not item.formula and len(row[0]) > 1:
            return True
        before = self.tokens[place - 1] if place else None
        end = place + len(row)
        after = self.tokens[end] if end < len(self.tokens) else None
        if after is not None and after.text in {"^", "/"}:
            return False
        return before is None or before.text not in {"^", "/", "sqrt"}

    def _weigh(
        self, example: Example, index: int, fit: tuple[int, tuple[int, ...]]
    ) -> Iterator[Evidence]:
        """Yield what a clause that has all words of an example says of its idea.

        The contrary of what is refused says nothing of it.
        """
        sign, places = fit
        if sign == 0 and example.meaning == "denied":
            return
        clause = self.clauses[index]
        denied = self._is_denied(clause, places)
        turned = sign < 0
        opens_with = self.tokens[clause.places[0]].text
        contrast = example.denied and index and opens_with in list_words("spelling.not")
        unsure = (
            sign == 0
            or self._denies_elsewhere(
                clause, places, example
            )  # or *it is this, not that*: that there is no *that* is not said
            or denied is None
            or (contrast and clause.sentence == self.clauses[index - 1].sentence)
            or self._has_degree(clause, places, example)
            or (turned and self._is_excess(places) != example.has_excess)
        )
        if unsure or (sign < 0 and (denied or example.denied)):  # *not narrower* is not *wider*
            meaning: Meaning = "open"
        else:
            if sign < 0 and self._belongs_elsewhere(clause, places):
                return
            flips = (sign < 0) ^ bool(denied) ^ example.denied
            lone = (
                example.denied and example.size <= LONE
            )  # *not linear* does not deny every *linear*
            if flips and (example.meaning == "denied" or (lone and not denied)):
                return
            meaning = "denied" if flips else example.meaning
        yield Evidence(
            meaning, example.text, index, index, example.size, places,
            turned=turned and meaning == "denied",
        )  # fmt: skip

    def _belongs_elsewhere(self, clause: _Clause, places: tuple[int, ...]) -> bool:
        """Return whether a word on a scale stands before another word than one that is meant.

        In *the discs of more distances*, no disc is larger.
        """
        fillers = _vocabulary().fillers
        return any(
            name == "amount"
            and at + 1 in clause.places
            and at + 1 not in places
            and self.tokens[at + 1].text not in fillers
            and self.tokens[at + 1].text[0].isalpha()
            for at in places
            for name, _ in self._scales_at(at)
        )

    def _is_denied(self, clause: _Clause, places: tuple[int, ...]) -> bool | None:
        """Return whether a clause denies what it says at some tokens; None if twice."""
        heads = [at for at in clause.denials if at not in places]
        count = clause.whole if heads else 0
        if not count:
            count = sum(any(place > at for place in places) for at in heads)
        count += sum(any(place > at for place in places) for at in clause.ahead)
        return None if count > 1 else bool(count)

    def _denies_elsewhere(self, clause: _Clause, places: tuple[int, ...], example: Example) -> bool:
        """Return whether a clause denies, and not the one thing that an example denies.

        *A probability cannot be above 1* does not say that something is no probability.
        """
        heads = clause.denials + clause.ahead
        if not example.denied or example.size > LONE or not heads:
            return False
        fillers = _vocabulary().fillers
        return not any(
            at <= places[-1] + 1  # where verbs come last, so does what denies them
            or (at == clause.places[-1]
                and all(self.tokens[one].text in fillers for one in range(places[-1] + 1, at)))
            for at in heads
        )  # fmt: skip

    def _is_excess(self, places: tuple[int, ...]) -> bool:
        """Return whether one of some words is an amount that is *too* large or small."""
        return any(
            at > 0
            and self.tokens[at - 1].text in _vocabulary().excess
            and any(name == "amount" for name, _ in self._scales_at(at))
            for at in places
        )

    def _has_degree(self, clause: _Clause, places: tuple[int, ...], example: Example) -> bool:
        """Return whether a word of low degree, such as ``less``, stands before one that is meant.

        An example without a scale would not see that it is turned.
        """
        if any(item.scales for step in example.steps for item in step):
            return False
        known = _vocabulary().degrees
        return any(
            self.tokens[at].text in known
            and at not in places
            and (at + 1 in places or (at - 1 in places and not self.tokens[at].text.isascii()))
            for at in clause.places
        )

    def _find_order(self, example: Example) -> Iterator[Evidence]:
        """Yield what the text says of steps that follow each other."""
        everywhere = [at for clause in self.clauses for at in clause.places]
        denied = {at for c in self.clauses if c.denials or c.ahead for at in c.places}
        ends: list[list[int]] = []
        for step in example.steps:
            rows = [self._fit(step, clause.places, example) for clause in self.clauses]
            ends.append([fit[1][0] for fit in rows if fit and fit[0] > 0])
        if not all(ends) or not everywhere:
            return
        chosen, last = [], -1
        for places in ends:
            after = [at for at in places if at > last]
            if not after:
                break
            last = after[0]
            chosen.append(last)
        ordered = len(chosen) == len(ends)
        used = tuple(chosen) if ordered else tuple(places[0] for places in ends)
        clauses = [self._clause_of(place) for place in used]
        wrong = bool(set(used) & denied)
        if not ordered and example.meaning == "denied":
            return
        meaning: Meaning = "open" if wrong else example.meaning if ordered else "denied"
        first, last = min(clauses), max(clauses)
        yield Evidence(meaning, example.text, first, last, example.size, tuple(sorted(used)))

    def _clause_of(self, place: int) -> int:
        """Return the index of the clause of a token."""
        return next(i for i, clause in enumerate(self.clauses) if place in clause.places)

    def quote(self, evidence: Evidence) -> str:
        """Return the clauses that evidence stands in, as they were typed."""
        places = [at for c in self.clauses[evidence.first : evidence.last + 1] for at in c.places]
        known = _vocabulary().breaks
        while len(places) > 1 and self.tokens[places[0]].text in known:
            places = places[1:]
        return self.typed[self.tokens[places[0]].start : self.tokens[places[-1]].end]

    def spans(self, evidence: Evidence) -> list[tuple[int, int]]:
        """Return where the words of evidence stand: first character, and the one behind."""
        return [(self.tokens[at].start, self.tokens[at].end) for at in evidence.places]


def _nearest_row(rows: Sequence[tuple[int, ...]], taken: Sequence[int]) -> tuple[int, ...]:
    """Return the one of some rows of tokens that stands nearest to the middle of others."""
    middle = sum(taken) / len(taken) if taken else rows[0][0]
    return min(rows, key=lambda row: abs(row[0] - middle))


_ORDER = {"denied": 0, "half": 1, "said": 2, "open": 3}


def _rank(evidence: Evidence) -> tuple[bool, bool, int, bool, int]:
    """Return what the best fit comes first by.

    That is one clause before several, what is sure, then how much was recognised, then what is said
    in its own words, then the careful meaning.
    """
    spread = evidence.last > evidence.first and not evidence.law
    unsure = evidence.meaning == "open"
    return (spread, unsure, -evidence.size, evidence.turned, _ORDER[evidence.meaning])


def used_synonyms(groups: Mapping[str, Sequence[str]], texts: Iterable[str]) -> list[str]:
    """Return the names of the groups of synonyms that share a word with a text.

    A row of words such as *light cone* is needed where *light* is: it is another thing.

    Parameters
    ----------
    groups : mapping of str to sequence of str
    texts : iterable of str
    """
    used = frozenset[str]().union(*(_list_stems(text) for text in texts))
    return [
        name
        for name, group in groups.items()
        if not used.isdisjoint(
            frozenset().union(*(_list_stems(row, with_fillers=False) for row in group))
        )
    ]


@lru_cache(1 << 13)
def _list_stems(text: str, *, with_fillers: bool = True) -> frozenset[str]:
    """Return the stems of the words of a text, cached: every paper asks for the same ones."""
    fillers = frozenset[str]() if with_fillers else _vocabulary().fillers
    words = (token.text for token in split_tokens(text))
    return frozenset[str]().union(*(_stems(word) for word in words if word not in fillers))
