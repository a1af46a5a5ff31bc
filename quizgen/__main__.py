"""``python -m quizgen`` and the command ``quizgen``."""

import os
import sys


def main() -> None:
    """Run the command line; an interrupt while it is still being loaded is one line, too."""
    try:
        from quizgen.cli.main import main as run
    except KeyboardInterrupt:
        sys.stderr.write("quizgen: interrupted\n")
        sys.stderr.flush()
        os._exit(130)
    run()


if __name__ == "__main__":
    main()
