"""Words of each language: ``locale/<lang>/*.toml``, and nothing about a language in Python.

In: a language and the name of a sentence. Out: the sentence with its blanks filled in. Must never
know: what it is said about, which languages there are.

A language is a folder. ``language.toml`` holds its name, its place in lists and its script; the
other files hold its sentences:

============== ==================================================================
interface      papers and their pages
messages       what the checker and ``quizgen practice`` say
figures        drawings of answers in words
speech         mathematics in words, printed and read aloud
cards          short words on flashcards
classes        the report of a marked exam
tradeoff       the page of what accuracy costs
web            the pages of ``quizgen serve``
moving         their figures that move
answers        words by which typed answers are read: `word_patterns` makes patterns of them
statements     words that turn, join or compare what sentences say
============== ==================================================================

A template has one ``<lang>.md``, too.

A bank may be written in any other language: its own files are read by `custom`, and English
stands for the rest.
"""

from __future__ import annotations

import re
import tomllib
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache, lru_cache
from pathlib import Path
from typing import Annotated, Any, ParamSpec, TypeVar, cast

import msgspec

from quizgen.core.decoding import convert
from quizgen.core.diagnostics import Diagnostic, diagnose
from quizgen.core.errors import QuizgenError, require_one_of
from quizgen.locale import custom

FIRST = "en"
"""The language that every other one falls back to, and the first in every list."""

BOTH = "both"
"""The choice of every language of a bank at once."""

_POINT = re.compile(
    r"(?<![0-9.])(?P<whole>[0-9]+)\.(?P<rest>[0-9]+)(?!\.?[0-9])(?!(?<=\.[0-9]{3}),[0-9])"
)
"""A decimal point; there is one in every number until it is written in a language.

What has several (12.5.2024) is no number, and 1.000,50 is one as it is written already.
"""

SHIPPED = Path(__file__).parent
PLACES = [SHIPPED]
"""Folders that hold languages; ``register_languages`` adds one."""

_HEARD: list[str] = []
"""Languages that something is written in and no folder is about."""

_FORGETTING: list[Callable[[], None]] = []
"""What has functions forget the words that they have read."""

P = ParamSpec("P")
R = TypeVar("R")

LAST = 1000
"""Place in lists of a language that does not say its own."""


class Language(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What ``language.toml`` says of a language, each field with what stands for it if left out.

    ``name`` is the language in itself, ``english`` in English, ``order`` its place in lists,
    ``script`` the ISO 15924 code of its letters, ``line_height`` the lines that its letters need on
    pages where they need other lines than the page has, ``decimal`` the sign in its numbers,
    ``quotes`` the two quotation marks around what a learner typed, ``common`` words that every page
    in it has and pages in other languages have not, by which lint knows it.
    """

    name: str
    english: str = ""
    order: int = LAST
    script: str = "Latn"
    line_height: float | None = None
    decimal: str = "."
    quotes: Annotated[str, msgspec.Meta(min_length=2, max_length=2)] = "“”"
    common: tuple[str, ...] = ()


def list_languages() -> tuple[str, ...]:
    """Return the tags of all languages (``en``, ``bn``, ...), English first, then by ``order``."""
    return _find_languages(tuple(PLACES), tuple(_HEARD))


def register_languages(langs: Iterable[str] = (), place: Path | None = None) -> None:
    """Add languages to those that can be chosen: by their tags, or by a folder of their words.

    Parameters
    ----------
    langs : iterable of str
        BCP 47 tags, such as those of a bank's templates; anything else is passed over.
    place : pathlib.Path, optional
        Folder of a bank that holds one folder for each of its languages.
    """
    new = [lang for lang in langs if lang not in list_languages() and custom.is_language_tag(lang)]
    _HEARD.extend(dict.fromkeys(new))
    if place and place not in PLACES and place.is_dir():
        PLACES.append(place)
        forget_words()


def cache_words(make: Callable[P, R], most: int | None = None) -> Callable[P, R]:
    """Return a function whose results are kept until the words of another language are added.

    Parameters
    ----------
    make : callable
        Of words or texts.
    most : int, optional
        Results that are kept at once; all of them if it is left out.
    """
    kept = lru_cache(maxsize=most)(make)
    _FORGETTING.append(kept.cache_clear)
    return cast("Callable[P, R]", kept)


def forget_words() -> None:
    """Have all words read again, as after a language has been added."""
    for forget in (load_words.cache_clear, get_language.cache_clear, *_FORGETTING):
        forget()


def list_language_choices() -> tuple[str, ...]:
    """Return what a paper's language may be: any language, or ``both`` for all of a bank."""
    return (*list_languages(), BOTH)


def resolve_language_choice(choice: str, held: tuple[str, ...]) -> tuple[str, ...]:
    """Return the languages that a choice stands for, the leading one first.

    Parameters
    ----------
    choice : str
        A language, or ``both``.
    held : tuple of str
        The languages of the bank: what ``both`` stands for.

    Raises
    ------
    InvalidChoiceError
        If there is no such language; names those of the bank.
    """
    if choice not in list_language_choices():
        require_one_of("language", choice, (*held, BOTH))
    return held if choice == BOTH else (choice,)


def default_language(held: tuple[str, ...]) -> str:
    """Return the language where none is chosen: English if the bank has it, else its first."""
    return FIRST if FIRST in held or not held else held[0]


@cache
def _find_languages(places: tuple[Path, ...], heard: tuple[str, ...]) -> tuple[str, ...]:
    """Return the tags of all languages in folders, and of those registered by tag, sorted."""
    found = {
        entry.name
        for place in places
        for entry in place.iterdir()
        if (entry / "language.toml").is_file() and custom.is_language_tag(entry.name)
    }
    found.update(heard)
    return tuple(sorted(found, key=lambda lang: (lang != FIRST, get_language(lang).order, lang)))


@cache
def get_language(lang: str) -> Language:
    """Return name, order and script of a language; one without a file is called by its tag.

    Raises
    ------
    QuizgenError
        If there is no such language, or its file says something else.
    """
    file = _find_words_file(lang, "language")
    if file is None and lang not in _HEARD:
        raise QuizgenError(f"no language {lang!r} (there are {', '.join(list_languages())})")
    try:
        usual = {"name": lang, "english": lang, "script": custom.script_of(lang)}
        return convert(usual | _read_words(file), Language)
    except msgspec.ValidationError as error:
        what, _, key = str(error).partition(" - at `$.")
        key = key.rstrip("`")
        said, place = f"{key}: {what}" if key else what, (key,) if key else ()
        raise QuizgenError(said, rule="QG106", file=file, place=place) from error


def localise_numbers(lang: str, text: str) -> str:
    """Return a text for people with the decimal sign of a language in its numbers.

    Examples
    --------
    >>> localise_numbers("de", "3 Punkte: 27.25 mm"), localise_numbers("en", "27.25 mm")
    ('3 Punkte: 27,25 mm', '27.25 mm')
    >>> localise_numbers("de", "am 12.5.2024 für 1.000,50 Euro")
    'am 12.5.2024 für 1.000,50 Euro'
    """
    sign = get_language(lang).decimal
    return text if sign == "." else _POINT.sub(rf"\g<whole>{sign}\g<rest>", text)


def is_right_to_left(lang: str) -> bool:
    """Return whether a language is written from right to left."""
    return get_language(lang).script in custom.RIGHT_TO_LEFT


def languages_in_script(script: str) -> tuple[str, ...]:
    """Return the languages written in a script (ISO 15924, ``Beng``), which need its fonts."""
    return tuple(lang for lang in list_languages() if get_language(lang).script == script)


def language_css(rule: str, within: str = "") -> str:
    """Return CSS for the languages that need a line height or a direction of their own.

    Parameters
    ----------
    rule : str
        A selector with ``{}`` for the language, whose lines have a height of their own.
    within : str
        A selector of what alone is styled.
    """
    return _build_line_height_css(rule) + _build_direction_css(within)


def _build_direction_css(within: str) -> str:
    """Return CSS for languages from right to left and for what is not in them; "" without any."""
    found = [
        f'{within} [lang="{lang}"]'.strip() for lang in list_languages() if is_right_to_left(lang)
    ]
    if not found:
        return ""
    return (
        f"{within} [lang] {{ direction: ltr; unicode-bidi: isolate; }}\n".lstrip()
        + "".join(
            f"{one} {{ direction: rtl; }}\n{one} dd {{ margin: 0 .35rem; }}\n" for one in found
        )
        + f"{within} :is(math, code, pre, svg) ".lstrip()
        + "{ direction: ltr; unicode-bidi: isolate; }\n"
    )


def _build_line_height_css(rule: str) -> str:
    """Return one CSS rule for each language with a line height of its own; see `language_css`."""
    heights = {lang: get_language(lang).line_height for lang in list_languages()}
    return "".join(
        f"{rule.format(lang)} {{ line-height: {height:g}; }}\n"
        for lang, height in heights.items()
        if height
    )


def is_written_in(lang: str, text: str) -> bool:
    """Return whether a text is written in a language's letters, judged by those of its own name.

    Latin words, digits and symbols stand in texts of every script; a text that holds nothing else
    belongs to a language with Latin letters.
    """
    own = _find_own_scripts(lang)
    if own:
        return bool(own & _find_scripts(text))
    return not any(_find_own_scripts(other) & _find_scripts(text) for other in list_languages())


@cache
def _find_own_scripts(lang: str) -> frozenset[str]:
    """Return the scripts, Latin left out, in which a language writes its own name."""
    return _find_scripts(get_language(lang).name) - {"LATIN"}


def _find_scripts(text: str) -> frozenset[str]:
    """Return the scripts of a text's letters by their Unicode names: ``LATIN``, ``BENGALI``."""
    return frozenset(unicodedata.name(c, "").partition(" ")[0] for c in text if c.isalpha())


def fallback_language(lang: str) -> str:
    """Return the language itself if it exists, else English."""
    return lang if lang in list_languages() else FIRST


@cache
def load_words(lang: str, name: str = "interface") -> dict[str, Any]:
    """Return all words of one file of a language, with English where a translation is missing.

    Parameters
    ----------
    lang : str
        One of ``list_languages()``.
    name : str
        One of its files without the suffix, such as ``interface``.

    Raises
    ------
    QuizgenError
        If there is no such language or file, or it cannot be read.
    """
    file, english = _find_words_file(lang, name), SHIPPED / FIRST / f"{name}.toml"
    if lang not in list_languages() or not english.is_file():
        raise QuizgenError(
            f"no {name} words for language {lang!r} (there are {', '.join(list_languages())})"
        )
    if file == english:
        return _read_words(file)
    if file and file.is_relative_to(SHIPPED):
        return _with_english(_read_words(file), load_words(FIRST, name))
    return custom.merge_translation(load_words(FIRST, name), _read_words(file))


def _with_english(own: Mapping[str, Any], english: Mapping[str, Any]) -> dict[str, Any]:
    """Return a language's words with English ones where it has none, in nested tables, too."""
    merged = {**english, **own}
    for key, value in own.items():
        if isinstance(value, dict) and isinstance(english.get(key), dict):
            merged[key] = _with_english(value, english[key])
    return merged


def untranslated_languages(langs: Iterable[str]) -> list[str]:
    """Return those of the languages that have no words of the interface, from quizgen or a bank."""
    return [lang for lang in langs if _find_words_file(lang, "interface") is None]


def translatable_files() -> list[Path]:
    """Return the English files that a translation may have, ``language.toml`` left out."""
    return sorted(path for path in (SHIPPED / FIRST).glob("*.toml") if path.stem != "language")


OPEN = frozenset({"letters", "greek", "names", "said", "same", "alike", "functions", "unit-words"})
"""Tables in which a language has its own words as keys, as many as it likes."""


def check_translations(place: Path) -> Iterator[Diagnostic]:
    """Yield a diagnostic for everything wrong with the words that a bank brings.

    Parameters
    ----------
    place : pathlib.Path
        Its folder of languages; it may be missing.
    """
    known = {path.name: path for path in translatable_files()}
    for file in sorted(place.glob("*/*")):
        lang = file.parent.name
        try:
            if not custom.is_language_tag(lang):
                what = f"{lang!r} is no language (call the folder fr, or pt-BR)"
                yield diagnose("QG508", file, what)
            elif file.name == "language.toml":
                get_language(lang)
            elif file.name in known:
                english = _read_words(known[file.name])
                for key, what in custom.check_translation(
                    english, custom.read_translation(file), OPEN
                ):
                    yield diagnose("QG507", file, f"{key}: {what}", tuple(key.split(".")))
            else:
                yield diagnose("QG508", file, f"is none of language.toml, {', '.join(known)}")
        except QuizgenError as error:
            yield error.diagnostic(file)


def _find_words_file(lang: str, name: str) -> Path | None:
    """Return the file of a language's words in the first folder that has one, else None."""
    files = (place / lang / f"{name}.toml" for place in PLACES)
    return next(filter(Path.is_file, files), None)


def _read_words(file: Path | None) -> dict[str, Any]:
    """Return the table of a file of words; {} for None. Only files from outside are checked."""
    if file is None:
        return {}
    if file.is_relative_to(SHIPPED):
        return tomllib.loads(file.read_text(encoding="utf-8"))
    return custom.read_translation(file)


def translate(lang: str, key: str, **values: object) -> str:
    """Return one text of the interface by its key ``section.name``, with its blanks filled in."""
    section, _, name = key.partition(".")
    text: str = load_words(lang)[section][name]
    return text.format(**values) if values else text


def format_amount(value: Fraction | float, lang: str) -> str:
    """Return marks as a number with the decimal sign of a language: ``2.5``, ``2,5``."""
    return localise_numbers(lang, f"{float(value):g}")


def format_marks(points: Fraction, lang: str) -> str:
    """Return marks with their word in a language: ``1 point``, ``2.5 points``."""
    return (
        f"{format_amount(points, lang)} "
        f"{translate(lang, 'paper.point' if points == 1 else 'paper.points')}"
    )
