"""The command line within this process: all that a cold one says, without its seconds of loading."""

from __future__ import annotations

import contextlib
import io
import signal
from pathlib import Path
from subprocess import CompletedProcess

from quizgen.cli.main import main


def run(*arguments: str, cwd: Path) -> CompletedProcess:
    """Run a command in a folder."""
    out, err, handler = io.StringIO(), io.StringIO(), signal.getsignal(signal.SIGINT)
    status = 0
    try:
        with (
            contextlib.chdir(cwd),
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
        ):
            main(list(arguments))
    except SystemExit as end:
        status = end.code
    finally:
        signal.signal(signal.SIGINT, handler)
    return CompletedProcess(arguments, status, out.getvalue(), err.getvalue())
