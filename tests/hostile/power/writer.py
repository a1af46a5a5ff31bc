"""Saves and hands in, in threads, and says what was acknowledged: ``writer.py DATABASE THREADS``.

With ``ARCHIVE``, the file of a learner, one more thread takes it in meanwhile.
"""

from __future__ import annotations

import os
import sys
import threading
from pathlib import Path

from quizgen.store import Store
from quizgen.store.archive import read_archive


def main(file: str, threads: int, archive: str = "") -> None:
    store = Store(f"sqlite:///{file}")
    mine = [store.learner(f"learner {n}").id for n in range(threads)]
    go = threading.Barrier(threads)

    def write(place: int) -> None:
        go.wait()
        for number in range(10_000):
            code = f"mock-{number}-both-0a1b2c"
            sitting = store.sittings.begin(mine[place], code, None, pauses=False)
            for answer in range(5):
                store.sittings.save(mine[place], sitting.id, {"1": [str(answer)]})
                say(f"saved {sitting.id} {answer}")
            store.sittings.hand_in(sitting)
            say(f"handed {sitting.id}")

    def take_in() -> None:
        store.archives.import_archive(
            store.learner("reader").id, read_archive(Path(archive).read_bytes())
        )
        say("imported")

    def say(line: str) -> None:  # one write: lines of several threads do not mix
        os.write(1, f"{line}\n".encode())

    for place in range(threads):
        threading.Thread(target=write, args=(place,)).start()
    if archive:
        threading.Thread(target=take_in).start()


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), *sys.argv[3:])
