"""Count how many keys go wrong in each arithmetic: ``quizgen/tradeoff/counted.json``.

Run: ``uv run python tools/do.py counts`` after a change of number systems, marking or many
templates; ``tests/tradeoff/test_questions.py`` says when.
"""

from __future__ import annotations

import sys
from pathlib import Path

import msgspec

from quizgen.bank.folder import builtin
from quizgen.tradeoff.questions import count_wrong

COUNTED = Path(__file__).parents[1] / "quizgen" / "tradeoff" / "counted.json"


def main() -> int:
    """Count and write."""
    found = msgspec.json.format(msgspec.json.encode(count_wrong(builtin())))
    COUNTED.write_bytes(found + b"\n")
    print(COUNTED)
    return 0


if __name__ == "__main__":
    sys.exit(main())
