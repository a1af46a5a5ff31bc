"""Builders of the response processing of one interaction in an item."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, repeat

from markupsafe import Markup

from quizgen.lms.qti.dialect import Attributes, Dialect, format_number_plain


@dataclass(frozen=True)
class ResponseRules:
    """The variables of an interaction, and elements that refer to them.

    Parameters
    ----------
    dialect : Dialect
    suffix : str
        At the end of its variables' names: ``_b_2`` for the second value of part b, empty if the
        item has one interaction.
    points : float
        Its marks.
    lang : str
    label : str
        Of a field whose value has no name, as ``2. ``.
    """

    dialect: Dialect
    suffix: str
    points: float
    lang: str
    label: str = ""

    @property
    def response_name(self) -> str:
        """The name of the response variable."""
        return f"RESPONSE{self.suffix}"

    @property
    def score_name(self) -> str:
        """The name of the outcome with its marks."""
        return f"SCORE{self.suffix}"

    @property
    def feedback_name(self) -> str:
        """The name of the outcome that selects feedback."""
        return f"FEEDBACK{self.suffix}"

    def choice_identifier(self, letter: str) -> str:
        """Return the identifier of an option, a stem or a step."""
        return f"C{self.suffix}_{letter}"

    def pair_identifier(self, stem: str, target: str) -> str:
        """Return the value of a stem and its target."""
        return f"{self.choice_identifier(stem)} {self.choice_identifier(target)}"

    def tag(self, name: str, attributes: Attributes, *inside: str) -> Markup:
        """Return an element by its name in QTI 2.1."""
        return self.dialect.tag(name, attributes, *inside)

    def interaction(self, name: str, attributes: Attributes, *inside: Markup) -> Markup:
        """Return an element that sets the response."""
        return self.tag(name, {"responseIdentifier": self.response_name, **attributes}, *inside)

    def declare_response(self, kind: str, right: Iterable[str], *mapping: Markup) -> Markup:
        """Return the declaration of the response with its key, of a kind as ``single float``."""
        cardinality, base = kind.split()
        named = {"identifier": self.response_name, "cardinality": cardinality, "baseType": base}
        values = [self.tag("value", {}, value) for value in right]
        correct = [self.tag("correctResponse", {}, *values)] if values else []
        return self.tag("responseDeclaration", named, *correct, *mapping)

    def declare_feedback(self, name: str, cardinality: str = "single") -> Markup:
        """Return the declaration of an outcome that selects feedback."""
        return self.dialect.outcome(name, f"{cardinality} identifier", {})

    def score_mapping(self, shares: Mapping[str, float]) -> Markup:
        """Return the marks of each value; their sum counts as no less than 0."""
        entries = [
            self.tag("mapEntry", {"mapKey": key, "mappedValue": share})
            for key, share in shares.items()
        ]
        return self.tag("mapping", {"lowerBound": 0, "defaultValue": 0}, *entries)

    def response_variable(self) -> Markup:
        """Return the expression of the response."""
        return self.tag("variable", {"identifier": self.response_name})

    def constant(self, base: str, value: str | float) -> Markup:
        """Return the expression of a constant."""
        return self.tag("baseValue", {"baseType": base}, format_number_plain(value))

    def is_correct(self) -> Markup:
        """Return the condition that exactly the key was given."""
        key = self.tag("correct", {"identifier": self.response_name})
        return self.tag("match", {}, self.response_variable(), key)

    def any_of(self, conditions: Sequence[Markup]) -> Markup:
        """Return the condition that one of these holds."""
        return conditions[0] if len(conditions) == 1 else self.tag("or", {}, *conditions)

    def set_outcome(self, outcome: str, expression: Markup) -> Markup:
        """Return a rule that sets an outcome."""
        return self.tag("setOutcomeValue", {"identifier": outcome}, expression)

    def set_feedback(self, outcome: str, value: str) -> Markup:
        """Return a rule that shows feedback."""
        return self.set_outcome(outcome, self.constant("identifier", value))

    def set_score(self, marks: float) -> Markup:
        """Return a rule that gives these marks."""
        return self.set_outcome(self.score_name, self.constant("float", marks))

    def add_score(self, marks: float) -> Markup:
        """Return a rule that gives these marks in addition."""
        score = self.tag("variable", {"identifier": self.score_name})
        total = self.tag("sum", {}, score, self.constant("float", marks))
        return self.set_outcome(self.score_name, total)

    def match_correct(self, *, partly: bool) -> Markup:
        """Return a rule that gives all marks for the key, else those of the mapping, or none."""
        mapped = self.tag("mapResponse", {"identifier": self.response_name})
        otherwise = self.set_outcome(self.score_name, mapped) if partly else ""
        return self.first_case([(self.is_correct(), self.set_score(self.points))], otherwise)

    def if_answered(self, rules: Markup) -> Markup:
        """Return these rules under the condition that there is a response."""
        is_null = self.tag("isNull", {}, self.response_variable())
        return self.first_case([(self.tag("not", {}, is_null), rules)])

    def first_case(self, cases: Iterable[tuple[Markup, Markup]], otherwise: str = "") -> Markup:
        """Return the rule of the first condition that holds."""
        names = chain(["responseIf"], repeat("responseElseIf"))
        tags = [self.tag(name, {}, *case) for name, case in zip(names, cases, strict=False)]
        last = [self.tag("responseElse", {}, otherwise)] if otherwise else []
        return self.tag("responseCondition", {}, *tags, *last)
