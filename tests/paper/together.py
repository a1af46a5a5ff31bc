"""Papers and marks of threads that all begin at once: ``together.py THREADS PAPERS INTERVAL FORMAT...``.

Prints a digest of all that was made, which is the same whatever the threads.
"""

from __future__ import annotations

import hashlib
import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

THREADS, PAPERS, INTERVAL = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
TOGETHER = Barrier(min(THREADS, PAPERS), timeout=30)
FORMATS = sys.argv[4:]


def begun() -> None:
    """Let no thread load anything before all are there."""
    TOGETHER.wait()


def made(seed: int) -> str:
    """Digest of a paper, its pages, its key and the marks of its own printed answers."""
    import quizgen
    from quizgen.kinds.grade import grade_answer, show_key
    from quizgen.paper.answer_key import write_answer_key

    bank = quizgen.builtin_bank()
    paper = quizgen.build_paper(bank, quizgen.load_blueprint("trial", bank), seed)
    pages = [
        quizgen.render_paper(paper, kind, to) for to in FORMATS for kind in ("exam", "solutions")
    ]
    specs = [spec for item in paper.items for spec in item.keys[0].specs]
    marks = [
        repr(grade_answer(spec, typed)) for spec in specs for typed in (show_key(spec, "en"), "1/3")
    ]
    return hashlib.sha256(
        b"".join([write_answer_key(paper), *pages, *map(str.encode, marks)])
    ).hexdigest()


sys.setswitchinterval(INTERVAL)
with ThreadPoolExecutor(THREADS, initializer=begun) as executor:
    found = list(executor.map(made, range(PAPERS)))
from flint import ctx  # noqa: E402 - what it is afterwards

print(hashlib.sha256("".join(found).encode()).hexdigest(), ctx.prec)
