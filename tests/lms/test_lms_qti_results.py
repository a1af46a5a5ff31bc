"""A result report of QTI, typed by hand as the specification shows one."""

from __future__ import annotations

import msgspec
import pytest
from sweep import together

from quizgen.lms.manifest import ManifestQuestion, ResponseField
from quizgen.lms.qti.results import qti_field_values
from quizgen.lms.response_files import read_attempts
from quizgen.maths.notation import FormulaReadError

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
    (found,) = read_attempts([path], (), lost.append)
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


@together(
    ("ask", "given", "values"),
    [
        (ResponseField("number", "1", unit="mm"), ["3,5"], ["3,5 mm"]),
        (ResponseField("many", "1", options=ABC), ["C_1_C", "C_1_A"], ["C", "A"]),
        (ResponseField("one", "1", options=ABC), ["C_1_D"], "option-unknown"),
        (ResponseField("truth", "1"), ["C_1_true"], ["true"]),
        (ResponseField("pairs", "1", options=ABC, targets={"1": ["1"], "2": ["2"]}),
         ["C_1_C C_1_1", "C_1_A C_1_2"], ["2", "", "1"]),
        (ResponseField("order", "1", options=ABC), ["C_1_C", "C_1_A", "C_1_B"], ["C", "A", "B"]),
        (ResponseField("order", "1", options=ABC, targets={"1": ["1"], "2": ["2"], "-": ["-"]}),
         ["C_1_C C_1_1", "C_1_A C_1_2", "C_1_B C_1_-"], ["C", "A"]),
        (ResponseField("order", "1", options=ABC, targets={"1": ["1"], "2": ["2"], "-": ["-"]}),
         ["C_1_C C_1_1", "C_1_A C_1_1"], "place-twice"),
        (ResponseField("many", "1", options=ABC), ["", "C_1_A"], ["A"]),
        (ResponseField("truth", "1"), [" ", "C_1_true"], ["true"]),
        (ResponseField("pairs", "1", options=ABC, targets={"1": ["1"]}), ["C_1_A C_1_1", "C_1_B"],
         "option-unknown"),
        (ResponseField("pairs", "1", options=ABC, targets={"1": ["1"]}), ["C_1_A"], "option-unknown"),
        (ResponseField("words", "1"), [""], []),
        (ResponseField("words", "1"), [], []),
    ],
)  # fmt: skip
def test_variables(ask, given, values):
    entry = ManifestQuestion("", "", [msgspec.structs.replace(ask, name="RESPONSE_1")])
    (found,) = qti_field_values(entry, {"RESPONSE_1": given})
    assert (found.code if isinstance(found, FormulaReadError) else found) == values
