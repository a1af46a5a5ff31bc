"""An engine for items of QTI 2.1, as its information model describes the rules that are used."""

from __future__ import annotations

from math import isclose, prod
from xml.etree import ElementTree as ET

from qti_cases import text_of

QTI = "{http://www.imsglobal.org/xsd/imsqti_v2p1}"


class Session:
    """An attempt at an item: its outcomes, and the sentences that are shown."""

    def __init__(self, item: ET.Element, given: dict[str, str | list[str]]) -> None:
        self.item = item
        self.declared = {d.get("identifier"): d for d in item.iter(f"{QTI}responseDeclaration")}
        self.given = {name: given.get(name) for name in self.declared}
        outcomes = {d.get("identifier"): d for d in item.iter(f"{QTI}outcomeDeclaration")}
        self.outcomes = {name: one.findtext(f".//{QTI}value") for name, one in outcomes.items()}
        for rule in item.find(f"{QTI}responseProcessing"):
            self.rule(rule)

    @property
    def said(self) -> dict[tuple[str, str], str]:
        shown = {}
        for one in self.item.iter(f"{QTI}modalFeedback"):
            name = one.get("outcomeIdentifier"), one.get("identifier")
            values = self.outcomes[name[0]]
            if name[1] in (values if isinstance(values, list) else [values]):
                shown[name] = text_of(one)
        return shown

    def rule(self, rule: ET.Element) -> None:
        match rule.tag.removeprefix(QTI):
            case "setOutcomeValue":
                self.outcomes[rule.get("identifier")] = self.value(rule[0])
            case "responseCondition":
                for branch in rule:
                    otherwise = branch.tag == f"{QTI}responseElse"
                    if otherwise or self.value(branch[0]):
                        for one in branch[0 if otherwise else 1 :]:
                            self.rule(one)
                        return
            case other:
                raise AssertionError(f"a rule that this engine does not know: {other}")

    def value(self, one: ET.Element):
        """What an expression gives, of what those inside it give."""
        inside = [self.value(child) for child in one]
        name = one.tag.removeprefix(QTI)
        return OPERATORS[name](*inside) if name in OPERATORS else READERS[name](self, one, *inside)

    def variable(self, one: ET.Element):
        name = one.get("identifier")
        return self.given[name] if name in self.given else self.outcomes[name]

    def key(self, one: ET.Element):
        declared = self.declared[one.get("identifier")]
        values = [value.text for value in declared.iterfind(f"{QTI}correctResponse/{QTI}value")]
        return values[0] if declared.get("cardinality") == "single" else values

    def mapped(self, one: ET.Element) -> float:
        name = one.get("identifier")
        mapping = self.declared[name].find(f"{QTI}mapping")
        entries = {entry.get("mapKey"): float(entry.get("mappedValue")) for entry in mapping}
        nothing = float(mapping.get("defaultValue"))
        total = sum(entries.get(key, nothing) for key in self.given[name])
        return max(total, float(mapping.get("lowerBound")))


OPERATORS = {
    "not": lambda holds: not holds,
    "isNull": lambda given: not given,
    "and": lambda *all_of: all(all_of),
    "or": lambda *any_of: any(any_of),
    "sum": lambda *numbers: sum(map(float, numbers)),
    "product": lambda *numbers: prod(map(float, numbers)),
    "member": lambda one, container: one in container,
    "gte": lambda a, b: float(a) >= float(b),
    "lte": lambda a, b: float(a) <= float(b),
    "match": lambda a, b: a == b,
}


def same(one: ET.Element, a: str, b: str) -> bool:
    return a == b if one.get("caseSensitive") == "true" else a.casefold() == b.casefold()


READERS = {
    "baseValue": lambda _, one: one.text,
    "variable": Session.variable,
    "correct": Session.key,
    "mapResponse": Session.mapped,
    "index": lambda _, one, container: container[int(one.get("n")) - 1],
    "stringMatch": lambda _, one, a, b: same(one, a, b),
}


def disagreements(name: str, item: ET.Element, cases):
    """Cases in which an item says something else than is declared."""
    for case in cases:
        played = Session(item, case.given)
        told = {text for (outcome, _), text in played.said.items() if outcome != "SOLUTION"}
        marks = float(played.outcomes["SCORE"])
        if not isclose(marks, case.marks, abs_tol=1e-9) or told != case.said:
            yield name, case, marks, told
