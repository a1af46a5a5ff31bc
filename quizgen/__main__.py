"""``python -m quizgen`` and the command ``quizgen``."""

import atexit
import gc
import os
import sys


def main() -> None:
    """Run the command line; an interrupt while it is still being loaded is one line, too."""
    # Each of these saves what is said of CPU time, in pairs of whole commands on two cores.
    # Threads for products of large matrices, of which there are none: 5 % of simulate, more where
    # OpenBLAS finds more cores to start them on. NumPy reads it when it is loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # What is loaded stays, so it is seldom looked through for garbage: 7 % of exam and simulate.
    gc.set_threshold(100_000)
    # Nor at the end, when it goes with the process: 13 % to 18 % of --help, check, simulate, exam.
    atexit.register(gc.freeze)
    try:
        from quizgen.cli.main import main as run
    except KeyboardInterrupt:
        sys.stderr.write("quizgen: interrupted\n")
        sys.stderr.flush()
        os._exit(130)
    run()


if __name__ == "__main__":
    main()
