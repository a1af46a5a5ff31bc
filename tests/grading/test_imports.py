"""What checking loads."""

from __future__ import annotations

import json
import subprocess
import sys

HEAVY = ("sympy", "numpy", "matplotlib")

SPECS = {
    "1a": {"kind": "number", "value": "20/3", "decimals": 3},
    "1b": {"kind": "quantity", "value": "50", "unit": "mm"},
    "1c": {"kind": "expression", "value": "f*X/Z", "symbols": dict.fromkeys("fXZ", "positive")},
    "1d": {"kind": "gap", "accept": [["demosaicing"]]},
    "1e": {"kind": "witness", "predicate": "x^2 < x", "symbols": ["x"]},
}
TYPED = {"1a": "6,667", "1b": "5 cm", "1c": "fX/Z", "1d": "demosaicng", "1e": "0,5"}


def key() -> dict[str, object]:
    """A paper of one question with five parts and a chain."""
    chain = {
        "given": {
            "f": {"value": "1/20", "unit": "mm"},
            "X": {"value": "4", "unit": "m"},
            "Z": {"value": "30", "unit": "m"},
        },
        "steps": [["u", "f*X/Z", "mm"], ["n", "u/0.000005", "px"]],
    }
    parts = [{"id": name, "points": "1", "spec": spec} for name, spec in SPECS.items()]
    question = {"number": "1", "template": "T", "chain": chain, "parts": parts}
    return {"format": "quizgen-key/2", "code": "c", "questions": [question]}


def run(code: str) -> str:
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    ).stdout


def test_marking_every_kind_loads_no_heavy_package():
    code = (
        "import sys, json\n"
        "from quizgen.kinds.grade import grade_answer\n"
        f"specs, typed = json.loads({json.dumps(json.dumps([SPECS, TYPED]))})\n"
        "assert all(grade_answer(specs[p], typed[p]).verdict == 'correct' for p in specs)\n"
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
