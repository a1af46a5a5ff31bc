"""Where an ask stands in an item: the names of its variables, and the rules that mark it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, repeat

from markupsafe import Markup

from quizgen.export.qti.dialect import Attributes, Dialect, written


@dataclass(frozen=True)
class Place:
    """The place of an ask.

    Parameters
    ----------
    dialect : Dialect
    suffix : str
        Behind the names of its variables: ``_b_2`` for the second value of part b, nothing where
        an item asks one thing.
    worth : float
        Its marks.
    lang : str
    number : str
        What a field without a name is told from its neighbours by, as ``2. ``.
    """

    dialect: Dialect
    suffix: str
    worth: float
    lang: str
    number: str = ""

    @property
    def response(self) -> str:
        """The variable of what is given."""
        return f"RESPONSE{self.suffix}"

    @property
    def score(self) -> str:
        """The outcome of its marks."""
        return f"SCORE{self.suffix}"

    @property
    def said(self) -> str:
        """The outcome of what is said."""
        return f"FEEDBACK{self.suffix}"

    def choice(self, mark: str) -> str:
        """What an option, a stem or a step is called by its mark."""
        return f"C{self.suffix}_{mark}"

    def pair(self, stem: str, target: str) -> str:
        """A stem and its target."""
        return f"{self.choice(stem)} {self.choice(target)}"

    def asked(self, name: str, attributes: Attributes, *inside: Markup) -> Markup:
        """An interaction."""
        return self.tag(name, {"responseIdentifier": self.response, **attributes}, *inside)

    def mapping(self, shares: Mapping[str, float]) -> Markup:
        """The marks of each thing that can be chosen; together they are not less than none."""
        entries = [
            self.tag("mapEntry", {"mapKey": key, "mappedValue": share})
            for key, share in shares.items()
        ]
        return self.tag("mapping", {"lowerBound": 0, "defaultValue": 0}, *entries)

    def tag(self, name: str, attributes: Attributes, *inside: str) -> Markup:
        """An element."""
        return self.dialect.tag(name, attributes, *inside)

    def declared(self, kind: str, right: Iterable[str], *mapping: Markup) -> Markup:
        """The declaration of the response, of a kind as ``single float``, with its key."""
        cardinality, base = kind.split()
        named = {"identifier": self.response, "cardinality": cardinality, "baseType": base}
        values = [self.tag("value", {}, value) for value in right]
        correct = [self.tag("correctResponse", {}, *values)] if values else []
        return self.tag("responseDeclaration", named, *correct, *mapping)

    def outcome(self, name: str, cardinality: str = "single") -> Markup:
        """The declaration of an outcome that says which feedback is shown."""
        return self.dialect.outcome(name, f"{cardinality} identifier", {})

    def given(self) -> Markup:
        """What was given."""
        return self.tag("variable", {"identifier": self.response})

    def correct(self) -> Markup:
        """Whether exactly the key was given."""
        key = self.tag("correct", {"identifier": self.response})
        return self.tag("match", {}, self.given(), key)

    def value(self, base: str, value: str | float) -> Markup:
        """A constant."""
        return self.tag("baseValue", {"baseType": base}, written(value))

    def sets(self, outcome: str, expression: Markup) -> Markup:
        """A rule that sets an outcome."""
        return self.tag("setOutcomeValue", {"identifier": outcome}, expression)

    def says(self, outcome: str, value: str) -> Markup:
        """A rule that has something said."""
        return self.sets(outcome, self.value("identifier", value))

    def earns(self, marks: float) -> Markup:
        """A rule that gives marks."""
        return self.sets(self.score, self.value("float", marks))

    def earns_more(self, marks: float) -> Markup:
        """A rule that gives further marks."""
        so_far = self.tag("variable", {"identifier": self.score})
        return self.sets(self.score, self.tag("sum", {}, so_far, self.value("float", marks)))

    def exactly(self, *, partly: bool) -> Markup:
        """A rule that gives all marks for the key, and else what the mapping gives, or nothing."""
        mapped = self.tag("mapResponse", {"identifier": self.response})
        otherwise = self.sets(self.score, mapped) if partly else ""
        return self.cases([(self.correct(), self.earns(self.worth))], otherwise)

    def if_given(self, rules: Markup) -> Markup:
        """These rules, if anything was given."""
        nothing = self.tag("isNull", {}, self.given())
        return self.cases([(self.tag("not", {}, nothing), rules)])

    def cases(self, rows: Iterable[tuple[Markup, Markup]], otherwise: str = "") -> Markup:
        """The rule of the first condition that holds."""
        names = chain(["responseIf"], repeat("responseElseIf"))
        tags = [self.tag(name, {}, *row) for name, row in zip(names, rows, strict=False)]
        last = [self.tag("responseElse", {}, otherwise)] if otherwise else []
        return self.tag("responseCondition", {}, *tags, *last)

    def any_of(self, conditions: Sequence[Markup]) -> Markup:
        """Whether one of these holds."""
        return conditions[0] if len(conditions) == 1 else self.tag("or", {}, *conditions)
