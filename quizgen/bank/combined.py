"""Several banks as one: a paper, a deck or a session takes its questions from all of them.

Each bank keeps what is its own: units, figures, solvers, words and the formulas of its sheet. What
two of them call by the same name - a template, a blueprint, a formula - is told apart by the bank's
name before it, ``filtering:otsu-threshold``; whatever stands in one of them alone keeps its name. A
topic is the same one wherever it is called the same, and its title is that of the first bank.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from pathlib import Path

import msgspec

from quizgen.bank.bank import Bank, builtin_bank, builtin_root
from quizgen.bank.formulas import read_formulas
from quizgen.bank.metadata import BankMetadata
from quizgen.bank.qualified_names import qualify_names
from quizgen.bank.rules import Rules
from quizgen.bank.template import Template
from quizgen.core.errors import BankError
from quizgen.core.untrusted import require_identifier
from quizgen.locale import resolve_language_choice

BankSource = tuple[str, bool]
"""Folder of a bank, empty for the built-in one, and whether its Python may run."""


def bank_sources(bank: Bank) -> tuple[BankSource, ...]:
    """Return what ``open_banks`` opens the parts of a bank by."""
    return tuple(
        ("" if part is builtin_bank() else str(part.root.resolve()), part.trusted)
        for part in bank.members
    )


def open_banks(places: Iterable[BankSource]) -> Bank:
    """Return the bank of a folder, several as one, or the built-in one if there is none."""
    parts = tuple(_open_bank(root, trusted) for root, trusted in places)
    if len(parts) > 1:
        return CombinedBank(parts)
    return parts[0] if parts else builtin_bank()


def _open_bank(root: str, trusted: bool) -> Bank:
    """Return the built-in bank for its own folder or an empty one, else a new bank."""
    is_ours = not root or Path(root).resolve() == builtin_root().resolve()
    return builtin_bank() if is_ours else Bank(Path(root), trusted=trusted)


def _iter_template_origins(part: Bank) -> Iterator[str]:
    """Yield the origins of the templates of a bank.

    One that cannot be read is passed over here: it is reported when it is used, and stops none
    of the others.
    """
    for name in part.template_paths:
        with suppress(BankError):
            yield part.origin(name)


class CombinedBank(Bank):
    """Several banks as one.

    Parameters
    ----------
    parts : tuple of Bank
        Two or more; the first one's titles stand before those of the others.

    Raises
    ------
    BankError
        If two have the same name.
    """

    def __init__(self, parts: tuple[Bank, ...]) -> None:
        """Put the banks together.

        Their names must be identifiers: they stand in front of template names that two banks share.
        """
        super().__init__(
            parts[0].root,
            trusted=all(part.trusted for part in parts),
            left_out={name: error for part in parts for name, error in part.left_out.items()},
        )
        self._parts = parts
        for part in parts:
            require_identifier(part.name, f"{part.folder / 'bank.toml'}: name", BankError)
        for name, count in Counter(part.name for part in parts).items():
            if count > 1:
                roots = " and ".join(str(part.root) for part in parts if part.name == name)
                raise BankError(
                    f"{roots}: both are called {name!r}; write another name into bank.toml of one"
                )

    def __reduce__(self) -> tuple[object, ...]:
        """Return how another process opens the folders for itself."""
        return CombinedBank, (self._parts,)

    def __repr__(self) -> str:
        """Return the names of the banks and the number of templates."""
        return f"<Banks {self.name}: {len(self)} templates>"

    @property
    def members(self) -> tuple[Bank, ...]:
        """Return the banks that it consists of."""
        return self._parts

    def reload(self) -> Bank:
        """Return the same banks, their files and solvers to be read again."""
        return CombinedBank(tuple(part.reload() for part in self._parts))

    @cached_property
    def metadata(self) -> BankMetadata:
        """Return the names and titles of all joined by ``+``, and the topics of each in turn.

        The first bank that has a topic names it.
        """
        topics: dict[str, dict[str, str]] = {}
        for part in self._parts:
            for topic in part.topics:
                said = {lang: part.topic_title(topic, lang) for lang in part.languages}
                topics[topic] = {**said, **topics.get(topic, {})}
        spoken = dict.fromkeys(lang for part in self._parts for lang in part.languages)
        title = {lang: " + ".join(part.title(lang) for part in self._parts) for lang in spoken}
        return BankMetadata("+".join(part.name for part in self._parts), title=title, topics=topics)

    @cached_property
    def languages(self) -> tuple[str, ...]:
        """Return the languages that all of them are written in.

        Raises
        ------
        BankError
            If there is none.
        """
        first, *others = (part.languages for part in self._parts)
        found = tuple(lang for lang in first if all(lang in held for held in others))
        if not found:
            raise BankError(f"no language is common to the banks: {self._describe_languages}")
        return found

    @property
    def _describe_languages(self) -> str:
        """Return which languages each bank is written in, for an error."""
        return "; ".join(
            f"{one.name} is written in {', '.join(one.languages)}" for one in self._parts
        )

    def resolve_languages(self, choice: str) -> tuple[str, ...]:
        """Return the languages of a choice, the leading one first.

        ``both`` stands for those of all banks.

        Raises
        ------
        BankError
            If one of the banks is not written in it.
        InvalidChoiceError
            If there is no such language.
        """
        langs = resolve_language_choice(choice, self.languages)
        for lang in langs:
            if lang not in self.languages:
                common = " or ".join(self.languages)
                raise BankError(
                    f"not all of it is written in {lang!r}: {self._describe_languages} "
                    f"(--lang {common}, or fewer banks)"
                )
        return langs

    @cached_property
    def _template_names_by_bank(self) -> dict[Bank, dict[str, str]]:
        """Return, for each bank, the name in the combined bank of each of its template names.

        A name that two banks have gets the bank's name in front.
        """
        return qualify_names({part: part.template_paths for part in self._parts})

    @cached_property
    def _origin_names_by_bank(self) -> dict[Bank, dict[str, str]]:
        """Return, for each bank, the name in the combined bank of each of its origins."""
        return qualify_names({part: [*_iter_template_origins(part)] for part in self._parts})

    @cached_property
    def _homes_by_template(self) -> dict[str, tuple[Bank, str]]:
        """Return the bank of each template and its name there, by its name in the combined bank."""
        return {
            here: (part, own)
            for part, names in self._template_names_by_bank.items()
            for own, here in names.items()
        }

    @cached_property
    def template_paths(self) -> dict[str, Path]:
        """Return the folder of each template by its name here, in alphabetical order."""
        return {
            name: self._homes_by_template[name][0].template_paths[self._homes_by_template[name][1]]
            for name in sorted(self._homes_by_template)
        }

    def owner_of(self, name: str) -> tuple[Bank, str]:
        """Return the bank that a template stands in, and its name there."""
        self.folder_of(name)
        return self._homes_by_template[name]

    def _suggest_template(self, name: str) -> str:
        """Return the full names of a template that several banks have, else similar names."""
        clashing = [names[name] for names in self._template_names_by_bank.values() if name in names]
        return (
            f"; did you mean {' or '.join(clashing)}?"
            if clashing
            else super()._suggest_template(name)
        )

    @cached_property
    def blueprints(self) -> dict[str, Path]:
        """Return the file of each blueprint by its name here."""
        return {
            here: part.blueprints[own] for here, (part, own) in self._homes_by_blueprint.items()
        }

    @cached_property
    def _homes_by_blueprint(self) -> dict[str, tuple[Bank, str]]:
        """Return the bank of each blueprint and its name there, as ``_homes_by_template``."""
        called = qualify_names({part: part.blueprints for part in self._parts})
        return {here: (part, own) for part, names in called.items() for own, here in names.items()}

    def template_names_for(self, plan: str) -> Mapping[str, str]:
        """Return the names in the combined bank of the templates of a blueprint's own bank.

        A blueprint was written for one bank and knows no names of the others.
        """
        return self._template_names_by_bank[self._homes_by_blueprint[plan][0]]

    @cached_property
    def cards(self) -> dict[str, Path]:
        """Return the files of card content by name; of one name that of the first bank."""
        return {name: path for part in reversed(self._parts) for name, path in part.cards.items()}

    def rules(self, name: str) -> Rules:
        """Return the checked ``template.toml`` of a template, with the names that hold here."""
        if name not in self._rules:
            part, own = self.owner_of(name)
            found, called = part.rules(own), self._template_names_by_bank[part]
            first = self._origin_names_by_bank[part][part.origin(own)]
            self._rules[name] = msgspec.structs.replace(
                found,
                formerly="" if first == name else first,
                apart=tuple(called.get(other, other) for other in found.apart),
                covers=tuple(self._translate_formula_id(part, item) for item in found.covers),
            )
        return self._rules[name]

    def _translate_formula_id(self, part: Bank, name: str) -> str:
        """Return the id in the combined bank of a bank's formula; an unknown one stays as it is."""
        return self._formula_ids_by_bank.get(part, {}).get(name, name)

    @cached_property
    def _formula_ids_by_bank(self) -> dict[Bank, dict[str, str]]:
        """Return, for each bank, the id in the combined bank of each of its formula ids."""
        return qualify_names(
            {part: [entry.id for entry in read_formulas(part)] for part in self._parts}
        )

    def _load_template(self, name: str) -> Template:
        """Return a template of one of the banks, with the names that hold here."""
        part, own = self.owner_of(name)
        found = part.template(own)
        cites = {
            step: self._translate_formula_id(part, one)
            for step, one in found.chain.formulas.items()
        }
        chain = msgspec.structs.replace(found.chain, formulas=cites) if cites else found.chain
        return replace(found, id=name, rules=self.rules(name), chain=chain)
