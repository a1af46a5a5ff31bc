"""What answer kinds may ask of a part of a variant: its values, its sentences, their order."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from functools import lru_cache
from typing import Any

from quizgen.bank.markdown import leaves
from quizgen.bank.pools import condition_holds, matching_pairs, select_from_pool, selected_claims
from quizgen.bank.rules import get_claim
from quizgen.bank.sampler import shuffle
from quizgen.bank.variant import Variant
from quizgen.core.errors import BankError, FormulaError
from quizgen.grading.judging.statements import used_synonyms
from quizgen.grading.reading.factor_words import find_bound
from quizgen.grading.reading.units import read_unit
from quizgen.kinds import KINDS
from quizgen.kinds.contract import (
    AskedPart,
    Condition,
    LabelledName,
    PartContext,
    asked_quantities,
)
from quizgen.locale import localise_numbers
from quizgen.locale.word_patterns import WordPattern, set_of_words
from quizgen.maths.numbers import (
    format_exact,
    format_rounded,
    is_readable_exactly,
    parse_written_number,
)
from quizgen.maths.tree import Expr, Sym
from quizgen.maths.values import Value
from quizgen.question.interpolation import (
    Interpolator,
    fill_program,
    inlines_as_typed,
    inlines_to_text,
    join_unit,
)
from quizgen.typeset.prose import InlineFormula, PlainText, Slot

_WORD = r"(?:[a-zäöüß-]{3,}|[\u0980-\u09ff]{3,})"
_LAST_WORDS = re.compile(
    rf"((?:{_WORD} ){{0,2}}(?:[a-zäöüß-]{{4,}}|[\u0980-\u09ff]{{3,}})) \(?$", re.IGNORECASE
)
_LETTER = r"(?:[^\W\d_]|[\u0980-\u09ff])"
"""A letter, or a sign of Bangla that belongs to one."""
_WORDS_BEHIND = WordPattern(
    r" «behind-name» (?P<words>(?:[^\W\d_]+ ){0,2}[^\W\d_]{3,})(?=[,.:;?]|$| «and»)", re.IGNORECASE
)
"""Of what a value is: ``$r$ in the dark part``."""
_ASKED_NOUN = WordPattern(
    r"(?<![^\W\d_])«how-many» (?!«percent»|«factors.signs»)(?:«of» (?:«articles» )?)?"
    rf"(?P<both>(?P<noun>{_LETTER}{{3,}})(?: {_LETTER}{{3,}})?)",
    re.IGNORECASE,
)
"""What is counted: ``how many photons of the scene``."""
_ASKED_IN = WordPattern(
    rf"(?<![^\W\d_])«in» (?!«articles» )(?P<words>%|(?:{_LETTER}+ ){{0,2}}{_LETTER}+)(?=[,.:?])",
    re.IGNORECASE,
)
"""What a number is asked in: ``in Swiss francs?``, ``in percent.``."""
_NUMBERED = re.compile(r"\((\d)\) ?([^,;.?()]+)")
"""A number in a question with the words behind it."""
_UNFILLED = re.compile(r"\{\{[^{}]*\}\}")
"""What stays of a blank with a slip in it."""
SHORTEST_NOUN = 3
"""Letters of a word for what is counted."""
OPTION_FIGURES = 4
"""Significant figures of a value to choose that has no short exact form."""


def _write_plainly(piece: object) -> str:
    """Return the text of a piece of a question, or the name that its formula is; else a blank."""
    if isinstance(piece, InlineFormula) and isinstance(piece.expr, Sym):
        return piece.expr.name
    return piece.text if isinstance(piece, PlainText) else " "


class VariantPart(PartContext):
    """The part of one variant that an answer kind reads (``PartContext``).

    Parameters
    ----------
    drawn : Variant
    index : int
        Of the part, from 0.
    """

    def __init__(self, drawn: Variant, index: int) -> None:
        """Take the part's answer, values, units and words from the variant."""
        template = drawn.template
        self.drawn, self.index = drawn, index
        self.answer = template.rules.part[index].answer
        self.shown, self.shown_values, self.words = drawn.shown, drawn.shown_values, drawn.words
        self.units, self.defined_units = template.units, template.about.units
        self.terms, self.points = template.about.terms, str(template.rules.part[index].points)
        self.lists, self.check_digest = drawn.lists, template.check_digest

    def error(self, what: str, rule: str = "QG112") -> BankError:
        """Return an error that stands at the part's ``answer`` table; the caller raises it.

        ``rule`` is its diagnostic code.
        """
        said, place = f"part {self.index + 1}: {what}", ("part", self.index, "answer")
        return BankError(said, rule=rule, file=self.drawn.template.file, place=place)

    def evaluate(self, formula: str) -> Value:
        """Return the value of a formula over the quantities in shown units."""
        return self.drawn.evaluate(formula)

    def answer_values(self) -> tuple[Value, ...]:
        """Return the components of the answer, each in the unit it is asked in."""
        return self.drawn.answer_of_part(self.index)

    def misconception_answers(self) -> dict[str, tuple[Value, ...]]:
        """Return the answer that each usable misconception gives, as ``answer_values``."""
        return self.drawn.misconception_answers(self.index)

    def exact_texts(self) -> tuple[str, ...]:
        """Return each irrational component of the key as a formula; empty where it is none."""
        return self.drawn.exact_texts(self.index)

    def answer_form(self) -> Expr:
        """Return the form that is asked for, with the drawn numbers in place."""
        return self.drawn.form_of_part(self.index)

    def misconception_forms(self) -> dict[str, Expr]:
        """Return the form that each usable misconception leads to."""
        return self.drawn.misconception_forms(self.index)

    def count_nouns(self) -> dict[str, Any]:
        """Return the field ``counts`` of a specification, or an empty dict if there is none.

        An author may list the words, for the answer or for each of its components. Otherwise they
        follow from the unit, if all that is asked for is shown in one; a table or an answer with a
        unit of its own has no such word. Of a plain number they are what the question counts.
        """
        stated = self.answer.get("counts")
        if isinstance(stated, Mapping):
            return {"counts": {name: self._nouns(things) for name, things in stated.items()}}
        names = asked_quantities(self.answer)
        units = {self.units.get(name, "") for name in names} - {"", "1"}
        several = self.answer["kind"] == "table" or "unit" in self.answer or len(units) != 1
        if stated is None and several:
            asked = self.answer["kind"] == "number" and not units and self._asked_nouns()
            return {"counts": asked} if asked else {}
        return {"counts": self._nouns(stated or [*units])}

    def _asked_nouns(self) -> list[str]:
        """Return what the question itself counts, *photons* in "how many photons", by language."""
        label, found = self.drawn.template.labels[self.index], list[str]()
        for lang, text in self.drawn.template.texts.items():
            pieces = leaves(text.sections.get(label, ()) if label else text.stem)
            asks = "".join(self._write_piece(piece, lang) for piece in pieces)
            for asked in _ASKED_NOUN.finditer(asks):
                found += [asked["both"], asked["noun"]]
            for asked in _ASKED_IN.finditer(asks):
                found += self._list_measures(asked["words"])
        return list(dict.fromkeys(found))

    def _write_piece(self, piece: object, lang: str) -> str:
        """Return a piece of the question as text, with a drawn phrase in its place."""
        phrase = isinstance(piece, Slot) and self.words.get(piece.name)
        if phrase:
            with suppress(BankError):  # text of a data file is no phrase
                return inlines_to_text(Interpolator(self.drawn, lang).sentence("words", phrase))
        return _write_plainly(piece)

    def _list_measures(self, words: str) -> list[str]:
        """Return what may stand behind a number that is asked in ``Swiss francs``."""
        if words == "%" or words.casefold() in set_of_words("percent"):
            return ["%"]
        last = words.rpartition(" ")[2]
        nouns = [one for one in (words, last) if len(one) >= SHORTEST_NOUN]
        with self.drawn.template.about.system.activate():
            for unit in (words, last):
                with suppress(FormulaError):
                    return [read_unit(unit).text, *nouns]
        return nouns

    def _nouns(self, things: str | list[str]) -> list[str]:
        """Return listed units as they are, and the bank's words for whatever else is counted.

        Raises
        ------
        BankError
            If one is neither a unit nor counted in ``bank.toml``.
        """
        about, found = self.drawn.template.about, list[str]()
        for thing in [things] if isinstance(things, str) else things:
            if thing not in about.system.simple and thing not in about.counted:
                raise self.error(f"counts: {thing!r} is neither a unit nor in bank.toml")
            found += about.counted.get(thing, (thing,))
        return found

    def misconception_notes(self, mistakes: Iterable[str]) -> dict[str, dict[str, str]]:
        """Return what to tell somebody who made a mistake, by language and mistake."""
        return self.sentences("traps", [(name, name) for name in mistakes])

    def with_reason(self, names: Iterable[LabelledName]) -> tuple[LabelledName, ...]:
        """Return those of the marks and names for which some language has a reason."""
        known = {*self.reason_names()}
        return tuple((mark, name) for mark, name in names if name in known)

    def reasons(self, names: Iterable[LabelledName]) -> dict[str, dict[str, str]]:
        """Return the reasons as plain text, by language and mark; empty if none is written."""
        found = self.with_reason(names)
        return self.sentences("reasons", found) if found else {}

    def sentences(self, section: str, names: Iterable[LabelledName]) -> dict[str, dict[str, str]]:
        """Return filled sentences of a section as plain text, by language and mark.

        Their numbers have the decimal sign of the language: a key may quote them as they are.
        """
        named = tuple(names)
        fillers = {lang: Interpolator(self.drawn, lang) for lang in self.drawn.template.texts}
        return {
            lang: {
                mark: localise_numbers(lang, inlines_to_text(filler.sentence(section, name)))
                for mark, name in named
            }
            for lang, filler in fillers.items()
        }

    def reason_names(self) -> list[str]:
        """Return the names of all sentences in section ``reasons``, each once, of all languages."""
        texts = self.drawn.template.texts.values()
        return list(dict.fromkeys(n for text in texts for n in text.named.get("reasons", ())))

    def shuffle_names(self, names: Iterable[str], side: str = "") -> list[str]:
        """Return the names in the order in which they are shown.

        A drawn one, unless the author set ``in_order``; ``side`` tells lists of one part apart.
        """
        return [*names] if self.answer.get("in_order") else self.shuffle([*names], side)

    def shuffle(self, names: Sequence[str], side: str) -> list[str]:
        """Return the names in a drawn order, whatever ``in_order`` says.

        The order follows from origin, version, seed and slot, so that a code rebuilds it.
        """
        drawn, template = self.drawn, self.drawn.template
        place = f"{drawn.seed}/{drawn.slot}/order/{self.index}{side}"
        return shuffle(f"{template.origin}/{template.rules.version}/{place}", names)

    def accepted_words(self, name: str, section: str = "gaps") -> list[str]:
        """Return the words of a gap, or the examples of a criterion, of all languages, each once.

        A learner may answer in any language of the bank, whichever the paper is printed in. Only
        words of a gap must be there in every language.
        """
        found: list[str] = []
        for lang, text in self.drawn.template.texts.items():
            if section == "gaps" or text.sentence(section, name) is not None:
                words = inlines_as_typed(Interpolator(self.drawn, lang).sentence(section, name))
                found += [word.strip() for word in words.split("|") if word.strip()]
        return list(dict.fromkeys(found))

    def model_answers(self) -> dict[str, str]:
        """Return the model answer by language, where section ``model`` has one for the part."""
        label = self.drawn.template.labels[self.index] or "a"
        fillers = {lang: Interpolator(self.drawn, lang) for lang in self.drawn.template.texts}
        return {
            lang: localise_numbers(lang, inlines_to_text(filler.sentence("model", label)))
            for lang, filler in fillers.items()
            if filler.text.sentence("model", label) is not None
        }

    def synonyms(self, texts: Iterable[str]) -> list[list[str]]:
        """Return the groups of ``[synonyms]`` in ``bank.toml`` of which texts have a word."""
        known = self.drawn.template.about.synonyms
        return [[*known[name]] for name in used_synonyms(known, texts)]

    def has_gap(self, name: str) -> bool:
        """Return whether a language file has words for a gap of this name."""
        return any(text.sentence("gaps", name) for text in self.drawn.template.texts.values())

    def format_option(self, value: Value, unit: str) -> str:
        """Return a choice with its unit: exactly if that is easy to read, else rounded."""
        exactly = format_exact(value) if is_readable_exactly(value) else None
        return join_unit(exactly or format_rounded(value, figures=OPTION_FIGURES), unit)

    def asked_bound(self) -> str:
        """Return ``most`` or ``least`` where the part asks for such a number."""
        template = self.drawn.template
        label, text = template.labels[self.index], template.texts[template.languages[0]]
        pieces = leaves(text.sections.get(label, ()) if label else text.stem)
        said = " ".join(piece.text for piece in pieces if isinstance(piece, PlainText))
        return find_bound(said)

    def value_words(self, names: Mapping[str, str]) -> dict[str, list[str]]:
        """Return what the question calls each value, in every language.

        That are the words before its name (*largest value* in "what is the largest value $M$"), of
        what it is behind it ("$r$ in the dark part"), or the phrase that is drawn there ("$n_1$: a
        raw image"). Words that two values share bind
        neither.
        """
        found: dict[str, list[str]] = {name: [] for name in names}
        for lang in self.drawn.template.texts:
            for name, words in self._iter_value_words(lang, names):
                found[name].append(words)
        return {name: list(dict.fromkeys(words)) for name, words in found.items() if words}

    def _iter_value_words(self, lang: str, names: Mapping[str, str]) -> Iterator[tuple[str, str]]:
        """Yield each name that stands in the question of a language, with the words beside it."""
        text, label = self.drawn.template.texts[lang], self.drawn.template.labels[self.index]
        sections = (*text.stem, *text.sections.get(label, ()))
        pieces = [PlainText(""), *leaves(sections), PlainText(""), PlainText("")]
        by_quantity = {quantity: name for name, quantity in names.items()}
        for before, formula, after, slot in zip(
            pieces, pieces[1:], pieces[2:], pieces[3:], strict=False
        ):
            if not (isinstance(formula, InlineFormula) and isinstance(formula.expr, Sym)):
                continue
            name = by_quantity.get(formula.expr.name, formula.expr.name)
            drawn = isinstance(slot, Slot) and self.words.get(slot.name)
            if name not in names or _is_listed(after, slot):
                continue
            if isinstance(before, PlainText) and (word := _LAST_WORDS.search(before.text)):
                yield name, word[1].lower()
            if isinstance(after, PlainText) and (word := _WORDS_BEHIND.match(after.text)):
                yield name, word["words"].lower()
            elif drawn and isinstance(after, PlainText) and after.text == ": ":
                yield name, inlines_to_text(Interpolator(self.drawn, lang).sentence("words", drawn))

    def numbered_words(self, count: int) -> list[list[str]]:
        """Return what the question numbers, ``(1) rounded, (2) raised``, in each language."""
        label, found = self.drawn.template.labels[self.index], []
        for text in self.drawn.template.texts.values():
            pieces = leaves(text.sections.get(label, ()) if label else text.stem)
            listed = dict(_NUMBERED.findall("".join(map(_write_plainly, pieces))))
            if {*listed} == {*map(str, range(1, count + 1))}:
                found.append([listed[str(place)].strip() for place in range(1, count + 1)])
        return found

    def option_texts(self, names: Iterable[str]) -> list[list[str]]:
        """Return the wordings of options as they would be typed, in each language once."""
        asked = list(names)
        fillers = (Interpolator(self.drawn, lang) for lang in self.drawn.template.languages)
        found = [
            [inlines_as_typed(filler.sentence("options", name)) for name in asked]
            for filler in fillers
        ]
        return [texts for place, texts in enumerate(found) if texts not in found[:place]]

    def condition_holds(self, condition: Condition) -> bool:
        """Return whether an authored condition holds in this variant."""
        return condition_holds(self.drawn, condition)

    def selection(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return what the part shows of its pool, and what of it fits nowhere."""
        shown = select_from_pool(self.drawn, self.index)
        return shown.names, shown.extra

    def matching_pairs(self) -> dict[str, str]:
        """Return the right side of each left side of a matching, whatever is shown of it."""
        return matching_pairs(self.drawn, self.index)

    def claim(self) -> tuple[str, Condition, str]:
        """Return the claim that the part takes: its name, when it is true, its source."""
        name = selected_claims(self.drawn)[self.index]
        claim = get_claim(self.drawn.template.rules, name)
        return name, claim.true, claim.source

    def fill_program(self, text: str) -> str:
        """Return program text, or its output, with the drawn values in place."""
        filled = fill_program(text, self.drawn, self.drawn.shown_values)
        if found := _UNFILLED.search(filled):
            raise self.error(f"{found[0]} is no blank that can be filled", "QG154")
        return filled

    def examples(self) -> tuple[tuple[str, Fraction], ...]:
        """Return the answers of ``[[part.example]]`` filled, and the share that each earns."""
        rule = self.drawn.template.rules.part[self.index]
        worth = parse_written_number(rule.points)
        return tuple(
            (self.fill_program(one.answer), parse_written_number(one.points) / worth)
            for one in rule.example
        )


def _is_listed(after: object, following: object) -> bool:
    """Return whether another name follows at once: what stands before is then said of both."""
    between = after.text.strip(" ,;") if isinstance(after, PlainText) else "?"
    return isinstance(following, InlineFormula) and between in {"", *set_of_words("and")}


@lru_cache(maxsize=128)
def ask_part(drawn: Variant, index: int) -> AskedPart[Any]:
    """Return one part of a variant as its kind asks it, the same for every language.

    Raises
    ------
    BankError
        If its kind is unknown or its answer is not complete. What a kind raises on a wrong
        answer becomes one, too: an author sees where it stands and never a traceback.
    """
    part = VariantPart(drawn, index)
    name = str(part.answer.get("kind", ""))
    if name not in KINDS:
        raise part.error(f"unknown kind {name!r} (allowed: {', '.join(sorted(KINDS))})")
    try:
        return KINDS[name].ask(part)
    except KeyError as error:
        raise part.error(f"answer: {error} is missing") from error
    except (TypeError, ValueError, AttributeError, ArithmeticError, IndexError) as error:
        raise part.error(f"answer: not of kind {name!r}: {error}") from error


def authored_answer(drawn: Variant, index: int) -> Mapping[str, Any]:
    """Return the ``answer`` table of a part as authored."""
    return drawn.template.rules.part[index].answer
