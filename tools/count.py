"""Count anew how many keys go wrong in each arithmetic: ``quizgen/tradeoff/counted.json``.

Run: ``uv run python tools/do.py counts`` after a change of number systems, marking or many
templates; ``tests/tradeoff/test_solving.py`` says when.
"""

from __future__ import annotations

import sys
from pathlib import Path

from quizgen.bank.folder import builtin
from quizgen.tradeoff.page import counts_json
from quizgen.tradeoff.product import ROUND, count_faults

COUNTED = Path(__file__).parents[1] / "quizgen" / "tradeoff" / "counted.json"


def main() -> int:
    """Count and write."""
    found = count_faults(builtin(), ROUND, lambda _name: None)
    COUNTED.write_text(counts_json(found), "utf-8")
    print(COUNTED)
    return 0


if __name__ == "__main__":
    sys.exit(main())
