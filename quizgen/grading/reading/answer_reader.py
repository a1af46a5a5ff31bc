"""Answers as people write them: what cannot matter is dropped, and what is left is found.

A kind reads the answer itself. What it would ask back for a word or a mark around the answer is
tried again here, plainer: without invisible characters, marks of Markdown, quotation marks,
bullets, ``I get``, ``(rounded)``, ``because ...``; at last the one number with its unit among
other words. Negation, ranges and alternatives never become a number: they stay asked back.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from fractions import Fraction
from typing import Literal, NamedTuple, TypeAlias

from quizgen.core.errors import FormulaError
from quizgen.grading.reading.factor_words import is_shrinking, read_factor
from quizgen.grading.reading.joined_values import bind_values, rejoin_values, repeat_value
from quizgen.grading.reading.labels import NAME, AskedNames, find_name
from quizgen.grading.reading.literals import LITERAL
from quizgen.grading.reading.normalise import LONGEST_PROSE, REWRITES
from quizgen.grading.reading.number_words import (
    add_large_words,
    add_mixed_units,
    list_number_words,
    replace_mixed_words,
    replace_number_word,
    replace_only_number_word,
)
from quizgen.grading.reading.source_map import SourceText
from quizgen.grading.reading.spoken_values import (
    drop_display,
    find_converted,
    find_given_value,
    list_given_lists,
    list_meant_values,
    write_spoken_formula,
    write_spoken_value,
)
from quizgen.grading.reading.units import read_unit
from quizgen.locale import cache_words, list_languages, load_words
from quizgen.locale.word_patterns import WordPattern, set_of_words

AnswerForm: TypeAlias = Literal[
    "number", "quantity", "values", "formula", "word", "option", "verbatim"
]
"""What an answer is made of: one number, one with a unit, several, a formula, words, marks of
options, or text in which every character counts."""

_INVISIBLE = re.compile("[\u00ad\u061c\u200b-\u200f\u202a-\u202e\u2060-\u2069\ufe0e\ufe0f\ufeff]")
_EMOJI = re.compile("[\u2600-\u2712\u2719-\u2753\u2757-\u27bf\u2b00-\u2bff\U0001f000-\U0001faff]")
_MARKDOWN = re.compile(
    r"(?<![\w*])(\*\*|__)(?=\S)(.+?)(?<=\S)\1(?![\w*])|(?<![\w*)])\*(?=\S)([^*]+)(?<=\S)\*(?!\S)"
)
_STRUCK = re.compile(r"~~(?=\S)[^~]+~~ *")
"""What its writer has struck out in Markdown."""
_CODE = re.compile(r"\s*`{1,3}([^`]+)`{1,3}\s*")
_QUOTES = '“”„‟«»"‹›'
_PAIRED = re.compile(r"^(['‘’‚`´]+)(.+?)['‘’`´]+$")
_UNDERSCORED = re.compile(r"(?<=\d)_(?=\d{3}(?!\d))")
_CLASSIFIED = WordPattern(r"(?<=\d) ?-?«classifiers-in-latin»(?=[ ;,.]|$)")
"""What Bangla puts behind a counted number, in Latin letters: ``9 ta pixel``."""
_TYPED_NUMBER = re.compile(r"(?:(?:np|numpy)\.)?(?:u?int|float)(?:8|16|32|64)?\(([^()]+)\)")
"""A number as Python prints one with its type: ``np.uint8(50)``."""
_TICK = re.compile(r"(?<=\S) ?[✓✔]+$")
_BULLET = re.compile(r"^(?:[•◦▪‣∙∴⇒→*+–—-] +(?=\S)|#{1,6} +)", re.MULTILINE)
_DASH = re.compile(r"^[–—−-] +(?=[.,]?\d)")
_LIST_MARK = re.compile(r"^\(?[a-h]\) *(?=\S)")
_ARROW = re.compile(r"^(?:∴|⇒|=>|→|->|>>>|≈|=) *(?=\S)")
_SIGNED = WordPattern(r"^«minus» +(?=\S)", re.IGNORECASE)
_PER_CENT = WordPattern(r"(?<=\d) *«percent»(?!\w)", re.IGNORECASE)
_SPOKEN_SHARE = WordPattern(r" *«point» [^\W\d_]+", re.IGNORECASE)
"""A number that begins with its decimal sign in words; ``point`` is what some questions ask for."""
_MODULUS = re.compile(r"(?<=[\d)]) ?% ?(?=\d+ ?(?:=|$))")
_THOUSANDS = re.compile(r"(?<=\d)k(?!\w)")
"""A thousand as in ``13.5k``; the unit of temperatures is a capital letter."""
_SPOKEN_POINT = WordPattern(r"(?<=\d) «point» (?=\d)", re.IGNORECASE)
_ORDINAL = WordPattern(r"(?<=\d)«ordinal-endings»(?![^\W\d_])")
_OF_A = WordPattern(r"(?<=\d) «of» (?:«of-what»)? ?(?=[^\W\d_])")
_LETTERS = r"(?:[^\W\d_]|[\u0981-\u0983\u09bc\u09be-\u09cd\u09d7])"
_WORD = re.compile(rf"{_LETTERS}+(?:['’-]{_LETTERS}+)*")
_DIGITS = LITERAL.pattern.removesuffix(r"\.?")
_FOUND = re.compile(
    rf"(?<![\w.,^/*])[-+]?(?:{_DIGITS})(?:[eE][-+]?\d+)?"
    r"(?: ?[*·×] ?10)?(?: ?\^ ?\(?[-+]?\d+\)?)?(?: ?/ ?\d+)?(?![\w^(]|[.,]\d)|"
    rf"(?<![\w.,^/*])[-+]?(?:{_DIGITS})(?=[^\W\d_])"
)
_GROUPED = re.compile(r"(?<![\d.,])\d{1,3}([.,])\d{3}(?:\1\d{3})+(?![\d.,]?\d)")
_LABEL = WordPattern(
    rf"(?<![^\W\d_])((?:{_LETTERS})+'*(?:_[^\W_]+'*)?)"
    r"(?: ?[:=] ?| «is» | ?)"
    r"(?=[-+−]?[.,]?\d)"
)
_BEHIND = re.compile(rf"([-+−]?\d+(?:[.,]\d+)?) ?((?:{_LETTERS})+'*(?:_[^\W_]+'*)?)(?:[ ,;]+|$)")
_LONG_LABEL = re.compile(rf"(?:{_LETTERS}+ ){{1,2}}({_LETTERS}+)(?: ?[:=] ?| )(?=[-+−]?[.,]?\d)")
_LABELLED = WordPattern(rf"(.*\d.*?)[ (]+(?:«for» )?((?:{_LETTERS})+'*(?:_[^\W_]+'*)?)\)?")
_PARTED = WordPattern(r"[;\n]|,(?!\d)| «and» ")
_JOINED = WordPattern(r"[ ,;]*(?:(?<![\w\u0980-\u09ff])«and»)?[ ,;]*$")
_FEWEST = 2
"""Labelled values that are no slip."""
_MOST_WORDS = 14
_MOST_READINGS = 3
_LONGEST_UNIT = 4
_END = r"(?![\w\u0980-\u09ff'’])"


class _AroundWords(NamedTuple):
    """What may stand around an answer, in every language."""

    before: re.Pattern[str]
    behind: re.Pattern[str]
    reason: re.Pattern[str]
    leading_on: frozenset[str]
    """Words behind a number that are not what it counts."""
    altering: frozenset[str]
    """Words that deny a number, offer another one or change it."""
    denying: re.Pattern[str]
    doubting: re.Pattern[str]
    """What takes back or leaves open what stands beside it."""
    correcting: re.Pattern[str]
    """A value that its writer has put in place of another, ``0.566 no, 0.569``."""
    becoming: re.Pattern[str]
    """What tells where a value goes, ``it drops to 208``: ``to`` is no range then."""
    rounded: re.Pattern[str]
    """What stands between a value and the same one rounded."""
    rounding: re.Pattern[str]
    """How far a value is said to be rounded, behind it."""


@cache_words
def _load_around_words() -> _AroundWords:
    """Return the words that may stand around an answer, of all languages, as patterns.

    Longer words come first, or a shorter one would match the start of a longer one.
    """
    found: dict[str, list[str]] = {}
    for lang in list_languages():
        for name, words in load_words(lang, "answers")["around"].items():
            found.setdefault(name, []).extend(words)
    listed = {
        name: "|".join(re.escape(word) for word in sorted(set(words), key=len, reverse=True))
        for name, words in found.items()
    }
    return _AroundWords(
        re.compile(rf"^(?:{listed['before']}){_END} *[:,=]? *(?=\S)", re.IGNORECASE),
        re.compile(
            rf"(?:[,;]? *\((?:{listed['behind']})\)|[,;]? +(?:{listed['behind']})"
            r"|[!,…?]+|\.{2,})$",
            re.IGNORECASE,
        ),
        re.compile(
            rf"(?<=\S)[,;.:]? *(?<![\w\u0980-\u09ff])(?:{listed['reasons']}){_END}.*$",
            re.IGNORECASE | re.DOTALL,
        ),
        frozenset(found["leading-on"]),
        frozenset(found["altering"]),
        re.compile(rf"(?<![\w\u0980-\u09ff])(?:{listed['denying']}){_END}", re.IGNORECASE),
        re.compile(rf"(?<![\w\u0980-\u09ff])(?:{listed['doubting']}){_END}", re.IGNORECASE),
        re.compile(
            rf".*\d.*?[,;.:]? (?:(?:{listed['correcting']})[,:;.]? )+"
            r"(?P<rest>[-+−]?[.,]?\d(?:[^,;(]|(?<=\d),(?=\d))*|[(\[][^()\[\]]*\d[^()\[\]]*[)\]])"
            r"(?: ?\([^()\d]+\))?",
            re.IGNORECASE | re.DOTALL,
        ),
        re.compile(
            rf"^([^\d]*(?:{listed['becoming']})(?: (?:{listed['where']}))?) (?:{listed['onto']})"
            r" (?=[-+−≈~]?[.,]?\d)",
            re.IGNORECASE,
        ),
        re.compile(
            rf",? (?:(?:->|→|=>|⇒) )?(?:{listed['rounded']})(?: (?:{listed['onto']}))?:?"
            r" (?=[-+−]?[.,]?\d)",
            re.IGNORECASE,
        ),
        re.compile(
            rf"[ ,(]+(?:{listed['rounded']}) (?:{listed['onto']}) \w+ (?:{listed['places']})\)?$",
            re.IGNORECASE,
        ),
    )


_IN_UNIT = WordPattern(r"(?<=\d) ?\(? ?«in» ([^\W\d_°]+|°)\)?$", re.IGNORECASE)
_CLOCK = re.compile(r"(\d{1,2})(?::([0-5]\d) ?h| ?h ?([0-5]\d))")
_CALLED = re.compile(r"[\w-]\(?$|-\s*$")
"""A call of a function, or a dash, right before a number."""
_BETWEEN = re.compile(r"[\s\w.,:;\u0980-\u09ff-]*")
_NAMED = WordPattern(
    rf"^(?:«so» )?(?:\|{NAME}\||{NAME}[\u0300-\u036f]?)"
    rf"(?: ?[=≈:] ?| «is» )(?:«about» )?(?=[-+]?[.,]?\d|√|sqrt)"
)
_NEARLY = WordPattern(rf"«nearly»{_END}", re.IGNORECASE)
"""What changes a word, and only rounds a number."""
_LOOKS_SAFE = re.compile(r"[\s\w.,:!?'’\"“”„()=≈\u0980-\u09ff-]*")


def list_plainer_texts(
    typed: str, form: AnswerForm, names: AskedNames = (), *, ranges: bool = False
) -> Iterator[str]:
    """Yield what may have been meant by an answer that was not read, plainest change first.

    Parameters
    ----------
    typed : str
        The answer as it was typed.
    form : str
        What an answer of this kind is made of.
    names : sequence or mapping
        Names that its values may carry.
    ranges : bool
        Whether two values may be given as from one to the other.

    Yields
    ------
    str
        Texts to try in turn; none where every character counts.
    """
    if form == "verbatim" or len(typed) > LONGEST_PROSE:
        return
    if form == "values":  # before a label such as "value" is taken for a word that leads on
        yield from separate_labelled_values(typed, names)
        yield from repeat_value(typed, len(names))
    plain = drop_decoration(typed, form)
    if plain != typed:
        yield plain
    if form == "formula":
        yield from _list_barer_formulas(plain)
    elif form in {"number", "quantity", "values"}:
        spelt = _write_words_as_numbers(typed if _SPOKEN_SHARE.match(typed) else plain)
        if form == "values":
            spelt = _write_items_as_numbers(spelt)
        if spelt != plain:
            yield spelt
        if form == "values":
            yield from _list_plainer_values(spelt, names, ranges=ranges)
        else:
            in_signs = write_in_signs(spelt)
            if in_signs != spelt:
                yield in_signs
            yield from list_meant_values(spelt)
            yield from _single_answer(spelt, form)
            yield from _find_conclusion(spelt)


def _list_plainer_values(text: str, names: AskedNames, *, ranges: bool) -> Iterator[str]:
    """Yield several values with their labels, joints or the words around them read."""
    joined = _JOINED_IN_LATIN.sub("; ", text)
    if joined != text:
        yield joined
    bare = _NOUN_BEHIND.sub(lambda m: m[0] if says_otherwise(m[2]) else m[1], text)
    if bare != text:
        yield bare
    yield from separate_labelled_values(text, names)
    yield from rejoin_values(text, len(names), ranges=ranges)
    yield from bind_values(text, names, scan_numbers)
    for given in list_given_lists(text):
        yield given
        yield from separate_labelled_values(given, names)
    yield from _drop_working(text, names)
    last = _LAST_LIST.fullmatch(text)
    corrected = _load_around_words().correcting.fullmatch(text)
    yield from ([last[1]] if last else [corrected["rest"]] if corrected else [])


_JOINED_IN_LATIN = WordPattern(
    r"(?<=[\d)%]) «and-in-latin» (?=[^\W\d_]\w*'?(?: ?[=:]| «is» )|[-+−]?\d)"
)


def _drop_working(text: str, names: AskedNames) -> Iterator[str]:
    """Yield the values that are asked without others before them: ``f/s = 375, u = 726, v = 9``."""
    pieces = [piece.strip() for piece in _PARTED.split(text) if piece.strip()]
    asked = [piece for piece in pieces if find_name(piece.partition("=")[0].strip(), names)]
    others = [piece for piece in pieces if piece not in asked]
    named = all("=" in piece for piece in pieces)
    if len(asked) == len(names) and others and named and not casts_doubt(text):
        yield "; ".join(asked)


_NOUN_BEHIND = re.compile(r"([=:] ?[-+−]?\d[\d.,/]*) ([^\W\d_]{4,})(?= *(?:[,;\n]|$))")
"""What a labelled value counts, ``r = 30 Elektronen``."""


def name_by_index(typed: str, names: AskedNames) -> str:
    """Return ``Y_601 = 0.4, Y_709 = 0.3`` for ``601: 0.4, 709: 0.3``, if these are its indices."""
    found = [(mark, find_name(mark[2], names)) for mark in _INDEXED.finditer(typed)]
    if len(found) != len(names) or {name for _, name in found} != {*names}:
        return typed
    return _INDEXED.sub(lambda m: f"{m[1]}{find_name(m[2], names)} = ", typed)


_INDEXED = re.compile(r"(^|[,;/\n] *)(\d{1,4}) ?[:=] ?(?=[-+−.]?\d)")


def _list_barer_formulas(text: str) -> Iterator[str]:
    """Yield a formula without words behind it, and the last side of several."""
    text = _WORDS_BEHIND.sub(lambda m: m[0] if says_otherwise(m[0]) else "", text)
    text = write_spoken_formula(text)
    yield text
    if "=" in text:
        yield text.rpartition("=")[2]


_ROOT_OF = WordPattern(r"«root-of» ([^\s+*/=-]+)", re.IGNORECASE)
_ROOT_BEHIND = WordPattern(r"([^\s+*/=-]+?)(?:-| )?«root-behind»")
_CUBE_ROOT = re.compile(r"∛ ?\(?(\d+(?:[.,]\d+)?)\)?")
_WORDS_BEHIND = re.compile(
    r" \((?:[^\W\d_]{3,}[ -]?)+\)$|, (?:(?:[^\W\d_]|[\u0981-\u09d7]){2,}[ '’-]?)+$"
)
_FRACTION_FACTOR = re.compile(r"(?<![\w.,^/*)])(\d+ ?/ ?\d+) (?=[(√]|[^\W\d_])")


def write_in_signs(typed: str) -> str:
    """Return a formula with ``root of N`` as a function, ``1/4 (x - 4)`` as a product.

    The blank parts the fraction from what it multiplies.
    """
    typed = _ROOT_BEHIND.sub(r"sqrt(\1)", _ROOT_OF.sub(r"sqrt(\1)", typed))
    typed = _CUBE_ROOT.sub(r"(\1)^(1/3)", typed)
    return _FRACTION_FACTOR.sub(r"(\1)*", typed)


def _single_answer(text: str, form: AnswerForm) -> Iterator[str]:
    """Yield the one number among words; a quantity needs its unit if words follow."""
    around = _load_around_words()
    named_by, text = text, _NAMED.sub("", _ASSUMED.sub("", text))
    text = around.becoming.sub(r"\1 ", around.rounding.sub("", text))
    text = _IN_UNIT.sub(r" \1", text)
    if text != named_by:
        yield text
    yield from _list_remarked(text)
    clock = _CLOCK.fullmatch(text)
    if clock:
        yield add_mixed_units(f"{int(clock[1])} h {int(clock[2] or clock[3])} min")
    found, words = scan_numbers(_NUMBERED_WORD.sub(r"\1", text))
    words = [*words[:-1], _DISTANCE.sub(" ", words[-1])]
    if len(found) != 1 or found[0] == text or not _can_be_dropped(words):
        return
    if casts_doubt(" ".join(words)):
        return
    behind = _WORD.search(words[1])
    named = behind is not None and behind[0].lower() not in around.leading_on
    remarked_on = words[1].startswith((",", ";")) and form == "number"
    named = named and not remarked_on
    if not found[0][-1].isdigit() or not (named or (behind and form == "quantity")):
        yield found[0]


def _list_remarked(text: str) -> Iterator[str]:
    """Yield the value without a remark that is before, behind or in brackets behind it."""
    parameter = _PARAMETER_BEHIND.fullmatch(text)
    tail, said = _SO_WHAT.search(text), _THAT_IS.fullmatch(text)
    if said and not casts_doubt(said["words"]):
        yield said["rest"]
    if parameter:
        yield parameter[1]
    if tail and not (casts_doubt(tail[0]) or says_otherwise(tail[0])):
        yield text[: tail.start()]
    same = _SAME_VALUE.fullmatch(text)
    if same:
        yield f"{same[1]} = {same[2]}"
    remarked = _REMARKED.fullmatch(text)
    if remarked and _is_idle_remark(remarked[2]) and not _is_shrunk(*remarked.groups()):
        yield remarked[1]


def _find_conclusion(text: str) -> Iterator[str]:
    """Yield the number that is concluded at the end: ``2^3 = 8, so 3 bits``."""
    for shape in (
        _CONCLUDED,
        _DERIVED,
        _ARROWED,
        _STEPS,
        _STEPS_NAMED,
        _load_around_words().correcting,
    ):
        concluded = shape.fullmatch(text)
        if concluded is None:
            continue
        words = concluded.groupdict().get("words") or ""
        around = " ".join([*scan_numbers(concluded["rest"])[1], words])
        if shape is _STEPS_NAMED:
            yield concluded["rest"]
        elif not (
            says_otherwise(around)
            or casts_doubt(words)
            or set_of_words("choices.no-option") & {*words.split()}
        ):
            yield add_mixed_units(concluded["rest"].rpartition("=")[2].strip() or text)
    converted = find_converted(text)
    if converted:
        yield converted
    said, given = find_given_value(text)
    if given and not is_denied(said):
        yield given


_CONCLUDED = WordPattern(
    r".*\w.*?[,;:.]? (?:«exactly»|«so»)"
    r",? (?P<rest>(?:[^,;]|(?<=\d),(?=\d))*\d(?:[^,;]|(?<=\d),(?=\d))*)",
    re.IGNORECASE | re.DOTALL,
)
_STEPS = re.compile(r"(?=[^,;]*\d[^,;]*=).*\d.*[,;] (?P<rest>[^,;]*\d[^,;]*)", re.DOTALL)
"""A value that ends steps with commas between them, ``56*100 = 5600, 5600^2 = 31 MP``."""
_STEPS_NAMED = re.compile(
    r"[^\W\d_]\w* ?= ?[-\d.,/ ]+[,;] (?P<rest>[-+(]*\d[^,;=]*[*/+^(][^;=]*= ?[-+]?\d[^,;=]*)"
)
"""A formula worked out behind a value that it needs, ``h = 0.4, 0.4*(1 + 2) = 1.2``."""
_DERIVED = re.compile(r"(?=.*[=√+*/]).*\d.*(?:->|→|=>|⇒) *(?P<rest>[^<>→⇒]*\d[^<>→⇒]*)", re.DOTALL)
"""A value behind the arrow at the end of a derivation."""
_ARROWED = re.compile(
    r"[-+\d][-+\d\s.,]*(?:(?:->|→|=>|⇒)[-+\d\s.,]+)*(?:->|→|=>|⇒) *"
    r"(?P<words>(?:[^\W\d_]{2,} ){0,4})(?P<rest>[-+]?\d[^<>→⇒]*)"
)
"""A value behind an arrow from numbers, ``320 -> 64 -> 32``."""


def find_conclusion(typed: str) -> str:
    """Return what is concluded from sides that are not equal, ``-30 → 330°``; empty if nothing."""
    text = _write_words_as_numbers(drop_decoration(typed, "number"))
    remarked = _PARAMETER_BEHIND.fullmatch(text)
    return remarked[1] if remarked else next(_find_conclusion(text), "")


_PARAMETER_BEHIND = re.compile(
    r"([-+−]?\d[\d.,]*(?: ?[^\W\d]\S*)?)"
    r" ?\((?:[^\W\d_]{2,3}|[A-Z])(?:_?\w)? ?[=≈] ?\d[\d.,]*(?: ?[^\W\d_]{1,4})?\)"
)
"""A value with what it depends on, ``2.45 (df = 6)``, ``1.6 (H = 24 m)``."""


def _is_idle_remark(words: str) -> bool:
    """Return whether words in brackets behind a number neither change it nor offer another."""
    found = [word[0].lower() for word in _WORD.finditer(words)]
    if _SAYS_NO.fullmatch(words) or _load_around_words().doubting.search(words):
        return False
    return len(found) <= _MOST_WORDS and not {*found} & (
        _load_around_words().altering - set_of_words("harmless-in-brackets")
    )


_NUMBERED_WORD = re.compile(r"(?<![^\W_])([a-z]{3,})\d+(?![\w.,])", re.IGNORECASE)
"""A word that ends in a number, ``uint8``, which is none of the values."""
_THAT_IS = WordPattern(r"(?P<words>[^\d]+),? «that-is»,? (?P<rest>[-+−]?\d.*)", re.IGNORECASE)
"""A value in words and, after that, as a number: ``half, i.e. 157.5 µm``."""
_SO_WHAT = WordPattern(r"[,;] «so» [^\d=,;]*$", re.IGNORECASE)
"""What follows from a value in words: ``q = 16, so longer``."""
_ASSUMED = WordPattern(r"^.{1,60}?\d.{0,30}? «assumed-behind»,? (?=.*\d)", re.IGNORECASE)
"""What a value was worked out with, in languages that say so behind it: ``1.7 m ধরে 425 px``."""
_SAYS_NO = WordPattern(
    r"(?:«choices.false»|«choices.not»)(?:[,;:. ]+[-+]?\d[\d.,]*)?", re.IGNORECASE
)
"""A remark that denies what stands before it, ``(no)``, ``(no, 296)``."""
_SAME_VALUE = WordPattern(
    r"([^()]*\d(?: ?[^\W\d]{1,12}(?:/[^\W\d]{1,12})?)?) \((?:«that-is» |[=≈] ?)?([^()]*\d[^()]*)\)"
)
"""A value, and what may be the same one in brackets."""


def _is_shrunk(number: str, remark: str) -> bool:
    """Return whether a remark makes a number smaller: ``5 (smaller)``, not ``1/5 (smaller)``."""
    if not is_shrinking(remark):
        return False
    share = read_factor(remark).replace("(", "").replace(")", "")
    plain = number.strip().replace(",", ".").replace(":", "/").replace(" ", "")
    if not _PLAIN_SHARE.fullmatch(plain):
        return True
    return Fraction(share) != _read_share(plain) if share else _read_share(plain) >= 1


def _read_share(text: str) -> Fraction:
    """Return the value of ``1/8`` or ``0.2``."""
    above, _, below = text.partition("/")
    return Fraction(above) / Fraction(below or 1)


_PLAIN_SHARE = re.compile(r"\d+(?:\.\d+)?(?:/[1-9]\d*)?")
_DISTANCE = WordPattern(
    r"^ (?:«away» )?«from» (?=«articles» )|^ «away» «from» (?=[^\W\d])",
    re.IGNORECASE,
)
"""From what a length is measured: no range, where no other number stands."""


def drop_decoration(typed: str, form: AnswerForm) -> str:
    """Return the answer without characters, marks and words around it that cannot matter."""
    text = _write_currency(drop_markup(_INVISIBLE.sub("", typed)).strip())
    text = drop_bullets(text) if not _DASH.match(text) or "\n" in text else text
    if form == "values":
        text = text.translate(dict.fromkeys(map(ord, _QUOTES)))
    before = ""
    while text and text != before:
        before = text
        text = _drop_once(text, form)
    return text or typed


def _write_currency(text: str) -> str:
    """Return ``$5.20`` with its unit behind it; ``$x$`` is LaTeX."""
    money = _MONEY.fullmatch(text)
    return f"{money[2]} {money[1]}" if money else text


_CALL_NAMED = re.compile(
    r"^\s*(?:[^\W\d_]{1,2}\([^()]{1,20}\) ?[=≈] ?|\([^()]*\d[^()]*\): )(?=[-+−.\d(√])"
)
"""What a value is called: ``P(X = 4) =``, or the point that it is of: ``(1; 2): ``."""
_MONEY = re.compile(r"([$£€]) ?([-+−]?\d[\d.,]*)")


def drop_equal_reason(typed: str) -> str:
    """Return an answer without a reason that is an equation, which is no side of it: ``2, da ...``.

    What it is called as a function or behind a point, ``P(X = 4) =``, is dropped, too. Any other
    reason is dropped where the answer cannot be read as it stands.
    """
    typed = _CALL_NAMED.sub(lambda m: m[0] if casts_doubt(m[0]) else "", typed)
    reason = _load_around_words().reason.search(typed) if "=" in typed else None
    head = typed[: reason.start()] if reason else ""
    return head if any(map(str.isdigit, head)) and "=" in typed[len(head) :] else typed


def drop_reason(typed: str) -> str:
    """Return a formula without the reason behind it; what was typed if nothing else is there."""
    head = _load_around_words().reason.sub("", typed).strip()
    return head or typed


def drop_transposed(typed: str) -> str:
    """Return a list without the sign that it is a column, ``(10; -5)^T``, or hats on its names."""
    return _TRANSPOSED.sub("", _HATS.sub("", typed))


_TRANSPOSED = re.compile(r"(?<=[)\]}])\s*(?:\^ ?\{?(?:T|\\top|t)\}?|ᵀ)\s*$")
_HATS = re.compile("(?<=[^\\W\\d_])[\u0302-\u0305\u0308\u20d7]")


def drop_bullets(typed: str) -> str:
    """Return the answer without bullets at the beginning of its lines."""
    return _BULLET.sub("", typed)


def drop_counting(typed: str) -> str:
    """Return several values without the numbers that count them off: ``1: 141, 2: 56``."""
    counted = list(_COUNTED.finditer(typed))
    if len(counted) < _FEWEST or counted[0].start():
        return typed
    if [int(mark[1]) for mark in counted] != list(range(1, len(counted) + 1)):
        return typed
    ends = [*(mark.start() for mark in counted[1:]), len(typed)]
    values = (typed[mark.end() : end] for mark, end in zip(counted, ends, strict=True))
    return "; ".join(value.strip(" ,;\n") for value in values)


_COUNTED = re.compile(r"(?:^|[,;\n] *| )\(?(\d)(?:[.)]|:(?=\s)) *(?=[-+−~≈]?[.,]?\d)(?<=[\s):])")


def drop_markup(typed: str) -> str:
    """Return the answer without marks of Markdown and emoji."""
    struck = _STRUCK.sub("", _EMOJI.sub("", typed))
    text = _MARKDOWN.sub(lambda m: m[2] or m[3], struck if struck.strip() else typed) or typed
    code = _CODE.fullmatch(text) if "`" in text else None
    return code[1] if code else text


def _drop_once(text: str, form: AnswerForm) -> str:
    """Return an answer without one layer of quotes, list marks, and words around it.

    The caller repeats it until nothing changes. An exclamation mark at the end of a formula is a
    factorial and remains.
    """
    text = text.strip(_QUOTES + " ")
    text = _PAIRED.sub(r"\2", text)
    if form != "option":
        text = _LIST_MARK.sub("", text)
    if form in {"option", "word"} and _NEARLY.match(text):
        return text
    around = _load_around_words()
    text = _TICK.sub("", text)
    text = around.before.sub("", _ARROW.sub("", text))
    if form == "formula" and text.endswith("!"):
        return text
    return around.behind.sub("", around.reason.sub("", text)).strip()


def _write_words_as_numbers(text: str) -> str:
    """Return ``minus sixteen`` as ``-16``, ``27 min 26 s`` as ``1646 s``."""
    for name in ("digits", "blanks"):
        text = SourceText.of(text).substitute(*REWRITES[name]).text
    text = _CLASSIFIED.sub("", _UNDERSCORED.sub("", text))
    text = _load_around_words().rounded.sub(" ≈ ", text)
    typed_array = _TYPED_NUMBER.fullmatch(text)
    text = typed_array[1] if typed_array else text
    text = write_spoken_value(_write_share_of_unit(text))
    text = _MINUS.sub("-", text)
    signed = _SIGNED.sub("", text)
    sign = "-" if signed != text and not signed.startswith(("-", "−", "–")) else ""
    spelt = _SPOKEN_POINT.sub(".", _THOUSANDS.sub(" thousand", signed if sign else text))
    if not any(map(str.isdigit, spelt)):
        spelt = replace_number_word(spelt)
    if not any(map(str.isdigit, spelt)):
        spelt = replace_only_number_word(spelt)
    spelt = _OF_A.sub(" ", _ORDINAL.sub("", _PER_CENT.sub(" %", spelt)))
    return sign + add_mixed_units(
        add_large_words(replace_mixed_words(_MODULUS.sub(" mod ", spelt)))
    )


def _write_share_of_unit(text: str) -> str:
    """Return ``one thirtieth of a second`` as ``1/30 second``; the text itself if it is none."""
    match = _SHARE_OF_UNIT.fullmatch(text)
    share = read_factor(match[1]) if match else ""
    return f"{share} {match[2]}" if match and "/" in share else text


_SHARE_OF_UNIT = WordPattern(rf"([^\d,;.]+?) (?:«share-of» )+({_LETTERS}+)", re.IGNORECASE)


def _write_items_as_numbers(text: str) -> str:
    """Return several values with those in words as digits, and without remarks in brackets."""
    text = drop_display(text)
    text = _REMARK.sub(lambda m: m[0] if says_otherwise(m[0]) else "", text)
    pieces = _ITEMS.split(_MINUS.sub("-", text))
    return "".join(map(_write_item_as_number, pieces))


def _write_item_as_number(piece: str) -> str:
    """Return one of several values with its number in digits, ``minus four`` as ``-4``."""
    if any(map(str.isdigit, piece)):
        return piece
    labelled = _LABEL_BEFORE_WORD.match(piece)
    if labelled:
        return f"{labelled[1]} = {_write_item_as_number(piece[labelled.end() :])}"
    plain = _SIGNED.sub("", piece)
    spelt = replace_number_word(plain)
    return piece if spelt == plain else f"{'-' if plain != piece else ''}{spelt}"


_LABEL_BEFORE_WORD = re.compile(r"([A-Z]'?(?:_?\d)?)(?: ?[=:] ?| )(?=[^\W\d])")
"""A letter before a number in words, ``G পঁচিশ``."""
_REMARKED = WordPattern(
    r"([-+−]?\d[^()]*?) ?\(([^\W\d][^()]*|\d+ ?%? «of» [^()]*"
    r"|\d+(?:\.|[.,]\d+)? ?[^\W\d]{3}[^()\d]*)\)"
)
_REMARK = re.compile(r"(?<=\d) ?\([^\W\d][^()\d;,]*\)|(?<=[^\W\d]) ?\(\d+ [^\W\d_]{3,}\)$")
_MINUS = WordPattern(r"(?<![^\W\d_])«minus» (?=[.,]?\d)", re.IGNORECASE)
_LAST_LIST = WordPattern(
    r"(?:.*\d.*|[^(,;]+)(?:=>?|:|→|⇒|->|,? «so») ?"
    r"(\([^()=]+\)|\[[^\[\]=]+\]|(?<=[>→⇒] )[-+−]?\d[\d.,]*(?: ?; ?[-+−]?\d[\d.,]*)+)",
    re.DOTALL,
)
"""The list at the end of equal ones: ``2·(1; 3) = (2; 6)``."""
_ITEMS = WordPattern(r"([;,\n] *| «and» )")


def separate_labelled_values(text: str, names: AskedNames) -> Iterator[str]:
    """Yield ``G = 111; R = 171`` for ``G111 R171``, if its labels are those of the values.

    Every label must mean a name of its own, and every value must be one number.
    """
    written = _write_each_letter(_write_each_equal(text), names)
    if written != text:
        yield written
    text = written
    ahead = [(m[1], m.start(), m.end()) for m in _LABEL.finditer(text)]
    if ahead and not ahead[0][1]:
        ends = [*(start for _, start, _ in ahead[1:]), len(text)]
        yield from _write_assigned(
            [(name, text[e:end]) for (name, _, e), end in zip(ahead, ends, strict=True)], names
        )
    if behind := _BEHIND.findall(text) if not _BEHIND.sub("", text) else []:
        yield from _write_assigned([(label, value) for value, label in behind], names)
    pieces = [piece.strip() for piece in _PARTED.split(text)]
    pairs = [pair for piece in pieces for pair in _read_labelled_piece(piece)]
    yield from _write_assigned(pairs, names, len(pieces))


def _write_each_equal(text: str) -> str:
    """Return ``a = b = 5`` as ``a = 5; b = 5``."""
    return _ALL_EQUAL.sub(lambda m: f"{m[1]} = {m[3]}; {m[2]} = {m[3]}", text)


def _write_each_letter(text: str, names: AskedNames) -> str:
    """Return ``RGB = 12, 24, 6`` with a letter before each value, if each means a name."""
    match = _RUN_TOGETHER.fullmatch(text.strip())
    if match is None or len(match[1]) != len(names):
        return text
    meant = [find_name(letter.lower(), names) for letter in match[1]]
    values = [
        value
        for value in re.split(r"[;/|]|,(?!\d)| +(?=[-\d.])", match[2].strip(" ()[]"))
        if value.strip()
    ]
    if not all(meant) or len({*meant}) < len(meant) or len(values) != len(meant):
        return text
    return "; ".join(f"{name} = {value.strip()}" for name, value in zip(meant, values, strict=True))


_ALL_EQUAL = re.compile(rf"({NAME}) ?= ?({NAME}) ?= ?([-+−]?\d[\d .,/]*\d|[-+−]?\d)")
_RUN_TOGETHER = re.compile(r"([A-Za-z]{2,4}) ?[=:]? ?([-(\[]?[\d.].*)")


def _read_labelled_piece(piece: str) -> Iterator[tuple[str, str]]:
    """Yield the label and the value of ``step 1/15``, or of ``16 levels``."""
    ahead = _LABEL.match(piece)
    several = None if ahead else _LONG_LABEL.match(piece)
    if ahead:
        yield ahead[1], piece[ahead.end() :]
    elif several:
        yield several[1], piece[several.end() :]
    elif behind := _LABELLED.fullmatch(piece):
        yield behind[2], behind[1]


def _write_assigned(
    pairs: list[tuple[str, str]], names: AskedNames, count: int = 0
) -> Iterator[str]:
    """Yield the pairs as ``name = value; ...`` if each name occurs once with one value.

    ``count`` is how many pieces the answer has, so that none of them is passed over.
    """
    meant = [find_name(label, names) for label, _ in pairs]
    values = [_JOINED.sub("", value).strip(" ,;") for _, value in pairs]
    once = all(meant) and len(set(meant)) == len(pairs) >= max(count, _FEWEST)
    if once and all(len(_FOUND.findall(value)) == 1 or _CHAIN.fullmatch(value) for value in values):
        yield "; ".join(f"{name} = {value}" for name, value in zip(meant, values, strict=True))


_CHAIN = re.compile(r"[\d\s.,/+*()−-]+(?:[=≈][\d\s.,/+*()−-]+)+")
"""One value that is worked out: ``1/31 = 0.032``."""


def prove_groups(typed: str) -> str:
    """Return it without marks of groups, where one number proves them: ``64,000; 1,152,000``.

    The other sign as a decimal one proves them, too: ``7,500; 12.87``; so does what is worked
    out, ``2^16 = 65.536``.
    """
    mark = re.escape(_find_thousands_mark(typed))
    if not mark:
        return typed
    group = re.compile(rf"(?<![\d.,])\d{{1,3}}(?:{mark}\d{{3}})+(?![\d.,]?\d)")
    return group.sub(lambda m: re.sub(mark, "", m[0]), typed)


def _find_thousands_mark(typed: str) -> str:
    """Return the sign between groups of three digits that a number proves; empty without proof."""
    grouped = _GROUPED.search(typed)
    if grouped:
        return grouped[1]
    beside = _DECIMAL_BESIDE.search(typed) if _HARD.search(typed) else None
    return {".": ",", ",": "."}[beside[1]] if beside else _find_mark_worked_out(typed)


def _find_mark_worked_out(typed: str) -> str:
    """Return the sign in a product or power that is worked out, ``2^16 = 65.536``."""
    for match in _WORKED_OUT.finditer(typed):
        value = 1
        for factor in re.split(r"[*·×x]", match["work"]):
            base, _, power = (piece.strip() for piece in factor.partition("^"))
            value *= int(base) ** min(int(power or 1), _LARGEST_POWER)
        if value == int(re.sub(r"[.,]", "", match["value"])):
            return match["sign"]
    return ""


_LARGEST_POWER = 64
_FACTOR = r"\d{1,6}(?: ?\^ ?\d{1,2})?"
_WORKED_OUT = re.compile(
    rf"(?P<work>{_FACTOR}(?: ?[*·×x] ?{_FACTOR}){{0,6}}) ?= ?"
    r"(?P<value>\d{1,3}(?P<sign>[.,])\d{3}(?:(?P=sign)\d{3})*)(?![\d.,]?\d)"
)
_DECIMAL_BESIDE = re.compile(r"(?<![\d.,])\d+([.,])(?:\d{1,2}|\d{4,})(?![\d.,])")
_HARD = WordPattern(r"[;|\n]| / | «and» ")


def scan_numbers(text: str) -> tuple[list[str], list[str]]:
    """Return the numbers in a text, each with its unit, and the pieces of text around them."""
    found: list[str] = []
    around, last = [], 0
    for match in _FOUND.finditer(text):
        unit, end = _find_unit(text, match.end())
        if not unit and text[end : end + 1].isalpha():
            continue
        found.append(f"{match[0]} {unit}".strip())
        around.append(text[last : match.start()])
        last = end
    return found, [*around, text[last:]]


def list_readings(typed: str) -> list[str]:
    """Return the numbers that an answer names, if there are several to choose from; else none."""
    found, around = scan_numbers(_write_words_as_numbers(drop_decoration(typed, "number")))
    named = list(dict.fromkeys(found))
    if not 1 < len(named) <= _MOST_READINGS or any(map(str.isdigit, " ".join(around))):
        return []
    between = " ".join(around[1:-1])
    return named if _WORD.search(between) and _BETWEEN.fullmatch(between) else []


def _find_unit(text: str, start: int) -> tuple[str, int]:
    """Return the unit after a number and where it ends; an empty one if there is none."""
    tokens = list(re.finditer(r" ?[^\s,;:!?()]+", text[start:]))[:_LONGEST_UNIT]
    for count in range(len(tokens), 0, -1):
        end = start + tokens[count - 1].end()
        unit = text[start:end].strip().rstrip(".")
        more = len(tokens) > count
        if unit.lower().rpartition(" ")[2] in set_of_words("no-units") and more:
            continue
        if any(map(str.isdigit, unit.replace("^2", "").replace("^3", ""))):
            continue
        try:
            read_unit(f"{unit[:-1]}-" if unit.endswith("⁻") else unit)
        except FormulaError:
            continue
        return unit, end
    return "", start


def _can_be_dropped(pieces: list[str]) -> bool:
    """Whether what stands around numbers is only words that say nothing more about them."""
    around = " ".join(pieces)
    balanced = around.count("(") == around.count(")")
    if not (balanced and _LOOKS_SAFE.fullmatch(around)) or any(map(str.isdigit, around)):
        return False
    if any(_CALLED.search(piece) for piece in pieces[:-1]):
        return False
    words = [word[0] for word in _WORD.finditer(around)]
    return len(words) <= _MOST_WORDS and all(map(_is_idle_word, words))


def _is_idle_word(word: str) -> bool:
    """Whether a word beside a number neither denies, doubles nor multiplies it."""
    small = word.lower().replace("’", "'")
    if len(small) == 1:
        return small in set_of_words("letters-as-words")
    return small not in _load_around_words().altering and (
        small not in list_number_words() or small in set_of_words("numbers.articles")
    )


_CUT_SHORT = re.compile(r"\d *(?:\.{2,}|…)")
_RANGE = re.compile(r"[-+−]?\d+(?:[.,]\d+)? *[-–—] *\d+(?:[.,]\d+)?(?: *[^\W\d][^\d]*)?")
_NUMBERED = re.compile(r"\d{1,2}[.)] +[-+−–]?[.,]?\d.*")
_SHUTTER_RANGE = re.compile(r"1 ?/ ?\d+ ?s? ?[-–—] ?1 ?/ ?\d+ ?s?")
_RAISED_DOT = re.compile(r"[-+−]?\d+·\d+(?: *[^\W\d][^\d]*)?")


def says_otherwise(text: str) -> bool:
    """Whether words deny, double or change what stands beside them."""
    words = (word[0].lower().replace("’", "'") for word in _WORD.finditer(text))
    return any(word in _load_around_words().altering for word in words)


def is_denied(text: str) -> bool:
    """Whether a word says that something is not the answer."""
    composed = unicodedata.normalize("NFC", text)
    struck = _STRUCK.fullmatch(composed.strip()) is not None
    return struck or _load_around_words().denying.search(composed) is not None


def casts_doubt(text: str) -> bool:
    """Whether words that are left out of an answer deny it, take it back or leave it open.

    What a rule drops must never be ``wrong``, ``or``, ``maybe`` or a question.
    """
    return is_doubted(text) or is_denied(text)


def is_doubted(text: str) -> bool:
    """Whether words take back what stands beside them, or leave it open: wrong, or, ``?``."""
    composed = unicodedata.normalize("NFC", text)
    return "?" in composed or _load_around_words().doubting.search(composed) is not None


def is_range_of_shares(typed: str) -> bool:
    """Whether two shares are joined by a dash, ``1/30 - 1/60 s``: hardly their difference."""
    return _SHUTTER_RANGE.fullmatch(typed.strip()) is not None


def is_cut_short(typed: str) -> bool:
    """Whether dots behind a number may stand for more of its digits: ``6.6...``."""
    return _CUT_SHORT.search(typed) is not None


def has_second_meaning(typed: str) -> bool:
    """Whether a wrong number may be a list item, a range or a decimal instead.

    ``- 16`` (a bullet), ``1. 16`` (the first item), ``15-17`` (a range) and ``102·5``: what they
    are read as is a guess, which must cost nobody marks.
    """
    text = typed.strip()
    return bool(
        _DASH.match(text)
        or any(shape.fullmatch(text) for shape in (_RANGE, _NUMBERED, _RAISED_DOT))
    )
