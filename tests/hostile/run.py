"""Run mutants and say what each came to: a result, an error that names its file, or a failure.

``uv run python tests/hostile/run.py 100000 [processes]`` runs a long sweep and counts.
"""

from __future__ import annotations

import random
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from kinds import KINDS

from quizgen.core.errors import QuizgenError

LONGEST, LARGEST = 2.0, 500
"""CPU seconds and MB that one mutant may take."""
HANGS = 10
"""CPU seconds after which a mutant is stopped."""


class Hung(BaseException):
    """A mutant took too long; not an ``Exception``, so that nothing takes it for its own."""


class Outcome(NamedTuple):
    """What a mutant came to; ``located`` if its error names the file that is wrong."""

    kind: str
    number: int
    failure: str
    error: str
    seconds: float
    megabytes: int
    located: bool = True


@contextmanager
def limited() -> Iterator[None]:
    """Stop what takes too much CPU time."""

    def stop(*_: object) -> None:
        raise Hung

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, HANGS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def kind_of(number: int) -> str:
    """The kind of the mutant of a number."""
    names = [name for name, (share, _) in KINDS.items() for _ in range(share)]
    return names[number * 37 % len(names)]


def peak() -> int:
    """Largest memory that the process ever had, in MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024


def tried(number: int) -> Outcome:
    """Make a mutant and use it."""
    kind = kind_of(number)
    folder = Path(tempfile.mkdtemp(prefix="hostile-"))
    started, size = time.process_time(), peak()
    failure = error = ""
    try:
        with limited():
            KINDS[kind][1](folder, random.Random(number))
    except QuizgenError as found:
        error = str(found)
    except Hung:
        failure = f"hangs at {_place(sys.exc_info()[2])}"
    except Exception as found:  # noqa: BLE001 - whatever it is, it is what is looked for
        failure = f"{type(found).__name__} at {_place(found.__traceback__)}: {str(found)[:80]}"
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    located = not error or f"{folder}/" in error
    return Outcome(
        kind, number, failure, error, time.process_time() - started, peak() - size, located
    )


def _place(trace: object) -> str:
    inside = [f for f in traceback.extract_tb(trace) if "/quizgen/" in f.filename]
    last = inside[-1] if inside else traceback.extract_tb(trace)[-1]
    return f"{last.filename.rpartition('/quizgen/')[2]}:{last.lineno}"


def warm() -> None:
    """Load and cache what every mutant needs, so that no single one pays for it."""
    for number in range(100):
        tried(number)


def main() -> None:
    from multiprocessing import get_context

    count = int(sys.argv[1])
    processes = int(sys.argv[2]) if len(sys.argv) > 2 else 2
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    ways, kinds, slow, nameless = Counter(), Counter(), [], 0
    with get_context("spawn").Pool(processes, warm, maxtasksperchild=5000) as pool:
        for one in pool.imap_unordered(tried, range(first, first + count), chunksize=50):
            kinds[one.kind, "failure" if one.failure else "error" if one.error else "result"] += 1
            if one.failure:
                ways[one.kind, one.failure[:110]] += 1
                if ways[one.kind, one.failure[:110]] == 1:
                    print("FAIL", one.kind, one.number, one.failure, flush=True)
            if not one.located:
                nameless += 1
                print("NO FILE", one.kind, one.number, one.error[:300], flush=True)
            if one.error and "--errors" in sys.argv:
                print("ERR", one.kind, one.number, one.error[:300].replace("\n", " "), flush=True)
            if one.seconds > LONGEST or one.megabytes > LARGEST:
                slow.append(one)
                print(
                    "SLOW",
                    one.kind,
                    one.number,
                    f"{one.seconds:.1f} s {one.megabytes} MB",
                    one.error[:100],
                    flush=True,
                )
    for row in sorted(kinds.items()):
        print(*row)
    print(
        sum(ways.values()),
        "failures,",
        nameless,
        "errors without a file,",
        len(slow),
        "too slow or too large",
    )
    for (kind, way), times in ways.most_common():
        print(times, kind, way)


if __name__ == "__main__":
    main()
