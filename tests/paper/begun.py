"""A paper made here, then in a process that is begun as METHOD says: ``python begun.py METHOD``.

Prints ``same`` if the pages are, else what the other process says.
"""

from __future__ import annotations

import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor

import quizgen
from quizgen.paper.blueprint import topic_blueprint


def made(output: str) -> bytes:
    """A page of a short paper."""
    bank = quizgen.builtin_bank()
    return quizgen.render_paper(
        quizgen.build_paper(bank, topic_blueprint(bank, "eye", 5), 3), "exam", output
    )


if __name__ == "__main__":
    method, *outputs = sys.argv[1:]
    made("pdf")  # from here on there are threads
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context(method)) as executor:
        try:
            there = list(executor.map(made, outputs, timeout=60))
        except quizgen.QuizgenError as error:
            print(error)
        else:
            print("same" if there == [made(output) for output in outputs] else "other")
