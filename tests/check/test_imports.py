"""What checking loads, and how long a paper takes from the start of the process."""

from __future__ import annotations

import json
import resource
import subprocess
import sys

import pytest

HEAVY = ("sympy", "numpy", "matplotlib")

SPECS = {
    "1a": {"kind": "number", "value": "20/3", "decimals": 3},
    "1b": {"kind": "quantity", "value": "50", "unit": "mm"},
    "1c": {"kind": "expression", "value": "f*X/Z", "symbols": dict.fromkeys("fXZ", "positive")},
    "1d": {"kind": "gap", "accept": [["demosaicing"]]},
    "1e": {"kind": "witness", "predicate": "x^2 < x", "symbols": ["x"]},
}
TYPED = {"1a": "6,667", "1b": "5 cm", "1c": "fX/Z", "1d": "demosaicng", "1e": "0,5"}


def key(count: int = 1) -> dict[str, object]:
    """A paper of so many questions with five parts each and a chain."""
    chain = {
        "given": {
            "f": {"value": "1/20", "unit": "mm"},
            "X": {"value": "4", "unit": "m"},
            "Z": {"value": "30", "unit": "m"},
        },
        "steps": [["u", "f*X/Z", "mm"], ["n", "u/0.000005", "px"]],
    }
    questions = [
        {
            "number": str(number),
            "template": "T",
            "title": {"en": "t"},
            "points": "5",
            "chain": chain,
            "parts": [
                {"id": f"{number}{part[1]}", "points": "1", "spec": spec}
                for part, spec in SPECS.items()
            ],
        }
        for number in range(1, count + 1)
    ]
    return {
        "format": "quizgen-key/1",
        "code": "c",
        "title": {"en": "t"},
        "langs": ["en"],
        "questions": questions,
    }


def run(code: str) -> str:
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    ).stdout


def test_marking_every_kind_loads_no_heavy_package():
    code = (
        "import sys, json\n"
        "from quizgen.marking.mark import mark\n"
        f"specs, typed = json.loads({json.dumps(json.dumps([SPECS, TYPED]))})\n"
        "assert all(mark(specs[p], typed[p]).verdict == 'correct' for p in specs)\n"
        f"print([m for m in {HEAVY!r} if m in sys.modules])"
    )
    assert run(code).strip() == "[]"


def test_checking_a_paper_loads_no_heavy_package(tmp_path):
    paper, form = tmp_path / "key.json", tmp_path / "a.json"
    paper.write_text(json.dumps(key()))
    form.write_text(json.dumps({"answers": {"1a": "7", "1b": "3 cm", "1c": "f*X"}}))
    code = (
        "import sys\nfrom quizgen.cli.main import main\n"
        f"main(['check', {str(paper)!r}, {str(form)!r}])\n"
        f"print([m for m in {HEAVY!r} if m in sys.modules])"
    )
    assert run(code).strip().endswith("[]")


@pytest.mark.parametrize("answers", [TYPED, dict.fromkeys(TYPED, "9")], ids=["right", "wrong"])
def test_twenty_questions_from_start_to_verdict(tmp_path, answers):
    """At most 0.4 s CPU; the best of three, because the machine is shared."""
    paper, form = tmp_path / "key.json", tmp_path / "a.json"
    paper.write_text(json.dumps(key(20)))
    typed = {f"{n}{part[1]}": text for n in range(1, 21) for part, text in answers.items()}
    form.write_text(json.dumps({"answers": typed}))
    best = 9.0
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(
            [sys.executable, "-m", "quizgen", "check", str(paper), str(form)],
            capture_output=True,
            text=True,
            check=True,
            timeout=60,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        best = min(best, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    assert done.returncode == 0
    assert best <= 0.4
