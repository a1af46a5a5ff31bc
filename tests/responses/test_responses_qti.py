"""A result report of QTI, typed by hand as the specification shows one."""

from __future__ import annotations

import msgspec
import pytest

from quizgen.maths.notation import FormulaReadError
from quizgen.responses.files import attempts
from quizgen.responses.keys import Asked, Entry
from quizgen.responses.qti import variables

REPORT = """<?xml version="1.0" encoding="UTF-8"?>
<assessmentResult xmlns="http://www.imsglobal.org/xsd/imsqti_result_v2p1">
  <context sourcedId="s1815">
    <sessionIdentifier sourceID="http://example.org/run" identifier="42"/>
  </context>
  <testResult identifier="test" datestamp="2026-11-22T09:41:45">
    <outcomeVariable identifier="SCORE" cardinality="single" baseType="float">
      <value>3</value>
    </outcomeVariable>
  </testResult>
  <itemResult identifier="lens_1_en" sequenceIndex="2" datestamp="2026-11-22T09:41:45"
              sessionStatus="final">
    <responseVariable identifier="RESPONSE_a" cardinality="single" baseType="float">
      <correctResponse><value>7.5</value></correctResponse>
      <candidateResponse><value>3.5</value></candidateResponse>
    </responseVariable>
    <responseVariable identifier="RESPONSE_b" cardinality="multiple" baseType="identifier">
      <candidateResponse><value>C_b_C</value><value>C_b_A</value></candidateResponse>
    </responseVariable>
    <responseVariable identifier="numAttempts" cardinality="single" baseType="integer">
      <candidateResponse><value>1</value></candidateResponse>
    </responseVariable>
    <outcomeVariable identifier="SCORE" cardinality="single" baseType="float">
      <value>1</value>
    </outcomeVariable>
  </itemResult>
  <itemResult identifier="other" datestamp="2026-11-22T09:41:45" sessionStatus="final">
    <responseVariable identifier="RESPONSE" cardinality="single" baseType="string">
      <candidateResponse/>
    </responseVariable>
  </itemResult>
</assessmentResult>
"""


@pytest.fixture
def attempt(tmp_path):
    path, lost = tmp_path / "r.xml", []
    path.write_text(REPORT, encoding="utf-8")
    (found,) = attempts([path], (), lost.append)
    assert lost == []
    return found


def test_what_was_given_and_by_whom(attempt):
    assert attempt.id == "s1815"
    assert [(one.number, one.question, one.given) for one in attempt.responses] == [
        ("", "lens_1_en", {"RESPONSE_a": ["3.5"], "RESPONSE_b": ["C_b_C", "C_b_A"],
                            "numAttempts": ["1"]}),
        ("", "other", {"RESPONSE": []}),
    ]  # fmt: skip


ABC = {"A": ["a"], "B": ["b"], "C": ["c"]}


@pytest.mark.parametrize(
    ("ask", "given", "values"),
    [
        (Asked("number", "1", unit="mm"), ["3,5"], ["3,5 mm"]),
        (Asked("many", "1", options=ABC), ["C_1_C", "C_1_A"], ["C", "A"]),
        (Asked("one", "1", options=ABC), ["C_1_D"], "option-unknown"),
        (Asked("truth", "1"), ["C_1_true"], ["true"]),
        (Asked("pairs", "1", options=ABC, targets={"1": ["1"], "2": ["2"]}),
         ["C_1_C C_1_1", "C_1_A C_1_2"], ["2", "", "1"]),
        (Asked("order", "1", options=ABC), ["C_1_C", "C_1_A", "C_1_B"], ["C", "A", "B"]),
        (Asked("order", "1", options=ABC, targets={"1": ["1"], "2": ["2"], "-": ["-"]}),
         ["C_1_C C_1_1", "C_1_A C_1_2", "C_1_B C_1_-"], ["C", "A"]),
        (Asked("order", "1", options=ABC, targets={"1": ["1"], "2": ["2"], "-": ["-"]}),
         ["C_1_C C_1_1", "C_1_A C_1_1"], "place-twice"),
        (Asked("many", "1", options=ABC), ["", "C_1_A"], ["A"]),
        (Asked("truth", "1"), [" ", "C_1_true"], ["true"]),
        (Asked("pairs", "1", options=ABC, targets={"1": ["1"]}), ["C_1_A C_1_1", "C_1_B"],
         "option-unknown"),
        (Asked("pairs", "1", options=ABC, targets={"1": ["1"]}), ["C_1_A"], "option-unknown"),
        (Asked("words", "1"), [""], []),
        (Asked("words", "1"), [], []),
    ],
)  # fmt: skip
def test_variables(ask, given, values):
    entry = Entry("", "", [msgspec.structs.replace(ask, name="RESPONSE_1")])
    (found,) = variables(entry, {"RESPONSE_1": given})
    assert (found.code if isinstance(found, FormulaReadError) else found) == values
