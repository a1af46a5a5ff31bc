"""``quizgen check`` of responses that a system for courses collected."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from quizgen.core.untrusted import escape_control_characters
from quizgen.locale import FIRST

if TYPE_CHECKING:
    from quizgen.lms.grading import GradedAttempt


def check(
    path: Path,
    files: Sequence[Path],
    lang: str | None,
    banks: tuple[Path, ...],
    flags: Mapping[str, object],
) -> int:
    """Mark the responses in files, print them, and give the code to leave with.

    Raises
    ------
    KeyFileError
        If the keys cannot be read.
    """
    from quizgen.lms.grading import grade_attempts
    from quizgen.lms.manifest import read_manifest
    from quizgen.lms.response_files import read_attempts

    manifest = read_manifest(path)
    if banks:
        from quizgen.cli.banks import compare_banks

        compare_banks(manifest.banks, banks)
    lost: list[str] = []
    given = read_attempts(files, manifest.found, lost.append)
    found = list(grade_attempts(manifest, given, lang, settle=not flags["no_settle"]))
    for line in (*lost, *_untold(found)):
        click.echo(f"quizgen: {escape_control_characters(' '.join(line.split()))}", err=True)
    there = [one for one in found if one.attempt.responses]
    if there:
        _print(there, lang or FIRST, flags)
    return (1 if there else 2) if lost else 0


def _untold(found: Sequence[GradedAttempt]) -> Iterator[str]:
    """What is no error, but not marked either."""
    for one in found:
        who = one.attempt.name or one.attempt.person_key[0]
        if not one.attempt.responses:
            yield f"{one.attempt.where}: {who}: no attempt"
        for number in one.foreign:
            yield f"{one.attempt.where}: {who}: question {number} is not in the keys; not marked"


def _print(found: Sequence[GradedAttempt], lang: str, flags: Mapping[str, object]) -> None:
    from quizgen.lms.attempt_report import attempt_to_json, attempts_to_csv, format_attempts

    if flags["as_json"]:
        click.echo(
            json.dumps([attempt_to_json(one) for one in found], ensure_ascii=False, indent=1)
        )
    elif flags["as_csv"]:
        click.echo(attempts_to_csv(found), nl=False)
    else:
        for line in format_attempts(found, lang):
            click.echo(line)
