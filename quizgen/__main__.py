"""``python -m quizgen`` and the command ``quizgen``."""

import atexit
import gc
import os
import sys

ALGEBRA = "OPENBLAS_NUM_THREADS"
"""What OpenBLAS, which NumPy loads, reads when it is loaded: how many threads it begins."""
PAGES = "NUMPY_MADVISE_HUGEPAGE"
"""What NumPy reads when it is loaded: whether it asks for memory in pages of 2 MiB."""


def main() -> None:
    """Run the command line; an interrupt while it is still being loaded is one line, too."""
    # Threads for products of large matrices, of which there are none, took two thirds of the CPU
    # time in which NumPy is loaded.
    os.environ.setdefault(ALGEBRA, "1")
    # A layer of a scene takes memory where something is drawn: in large pages a fifth more.
    os.environ.setdefault(PAGES, "0")
    gc.set_threshold(100_000)  # what is loaded stays: to look through it took a tenth of a paper
    atexit.register(gc.freeze)  # and goes with the process: to look through it took half a second
    try:
        from quizgen.cli.main import main as run
    except KeyboardInterrupt:
        sys.stderr.write("quizgen: interrupted\n")
        sys.stderr.flush()
        os._exit(130)
    run()


if __name__ == "__main__":
    main()
