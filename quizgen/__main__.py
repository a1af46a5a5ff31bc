"""``python -m quizgen`` and the command ``quizgen``."""

import gc
import os
import sys


def main() -> None:
    """Run the command line; an interrupt while it is still being loaded is one line, too."""
    gc.set_threshold(100_000)  # what is loaded stays: to look through it took a tenth of a paper
    try:
        from quizgen.cli.main import main as run
    except KeyboardInterrupt:
        sys.stderr.write("quizgen: interrupted\n")
        sys.stderr.flush()
        os._exit(130)
    run()


if __name__ == "__main__":
    main()
