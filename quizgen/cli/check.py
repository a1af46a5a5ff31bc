"""``quizgen check``."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Unpack

import click

from quizgen.cli.options import BankOptions, LanguageParam, bank_options, open_bank
from quizgen.cli.terminal import print_message
from quizgen.core.errors import KeyFileError
from quizgen.core.untrusted import error_context
from quizgen.grading.echo import safe_echo
from quizgen.lms import MANIFEST_SUFFIX
from quizgen.locale import FIRST, list_languages

if TYPE_CHECKING:
    from quizgen.lms.grading import GradedAttempt
    from quizgen.paper.answer_form import FilledForm
    from quizgen.paper.answer_key import AnswerKey
    from quizgen.paper.grading import PaperResult


PAGE = "exam.html"
HEAD = 4096
"""Bytes at the start of a page in which it says what paper it is of."""


class GradedForm(NamedTuple):
    """A graded form: file, name, matriculation, result and language."""

    file: str
    name: str
    matriculation: str
    lang: str
    result: PaperResult


class CheckOptions(BankOptions):
    """Options of ``quizgen check``."""

    key: Path
    answers: tuple[Path, ...]
    lang: str | None
    as_json: bool
    as_csv: bool
    no_settle: bool


@click.command(short_help="Mark typed answers with a paper's key.")
@click.argument("key", type=click.Path(path_type=Path))
@click.argument("answers", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--lang",
    type=LanguageParam(),
    help="Language of the remarks [the form's own].",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")
@click.option("--csv", "as_csv", is_flag=True, help="Print CSV (the default for several forms).")
@click.option("--no-settle", is_flag=True, help="Never start SymPy for undecided formulas.")
@bank_options
def check(**options: Unpack[CheckOptions]) -> None:
    """Mark ANSWERS (answers.toml, .csv or .json, one or many) with KEY (key.json).

    With the keys of an export (moodle.xml.keys.jsonl) as KEY, ANSWERS are responses that a system
    for courses collected: Moodle's report "Responses" as CSV or JSON, result reports of QTI (.xml),
    or archives of them (.zip).

    One form prints a table with the mistake found in each part; several forms print CSV: marks and
    notes per part, one line per student. A form that cannot be read is named and the others are
    marked. Exit codes: 0 every form was marked, 1 some were, 2 none.

    A key holds all that marking needs. With --bank it is also said whether the bank is still
    the one that the paper or the export was made from, and with --trust its check.py may run.
    """
    from quizgen.paper.answer_key import read_answer_key

    if options["trust"] or options["trust_bank"]:
        open_bank(options)  # so that answers are judged by its check.py

    key, answers, lang = options["key"], options["answers"], options["lang"]
    if key.name.endswith(MANIFEST_SUFFIX):
        sys.exit(check_responses(key, answers, lang, options["bank"], options))
    paper = read_answer_key(key)
    _check_key_belongs(key.parent / PAGE, paper)
    if options["bank"]:
        from quizgen.cli.banks import compare_banks

        compare_banks(paper.banks, options["bank"])
    marked = list(_iter_graded_forms(paper, answers, lang, settle=not options["no_settle"]))
    if marked:
        _print_results(marked, paper, options, many=len(answers) > 1)
    missing = len(answers) - len(marked)
    if missing:
        sys.exit(1 if marked else 2)


def _check_key_belongs(page: Path, key: AnswerKey) -> None:
    """Raise ``KeyFileError`` if the page in the key's folder is of another paper.

    Raises
    ------
    KeyFileError
        Naming the page.
    """
    try:
        with page.open("rb") as stream:
            head = stream.read(HEAD)
    except OSError:
        return
    found = re.search(rb'data-paper="([0-9a-f]*)"', head)
    if key.paper and found and found[1].decode() != key.paper:
        raise KeyFileError(
            f"{page} is of another paper than the key beside it ({safe_echo(key.code)})"
        )


def _iter_graded_forms(
    key: AnswerKey, answers: tuple[Path, ...], lang: str | None, *, settle: bool
) -> Iterator[GradedForm]:
    """Yield each form graded; print why a form could not be read."""
    for path in answers:
        try:
            yield _grade_form(key, path, lang, settle=settle)
        except KeyFileError as error:
            print_message(str(error))


def _print_results(
    marked: list[GradedForm], key: AnswerKey, flags: CheckOptions, *, many: bool
) -> None:
    """Print the results as JSON, CSV or a table."""
    if flags["as_json"]:
        _print_json(marked, key)
    elif flags["as_csv"] or many:
        from quizgen.paper.grade_report import write_class_csv

        click.echo(write_class_csv([(*one[:3], one.result) for one in marked]), nl=False)
    else:
        _print_table(marked[0])


def _grade_form(key: AnswerKey, path: Path, lang: str | None, *, settle: bool) -> GradedForm:
    """Return a graded form; ``KeyFileError`` if it is of another paper."""
    from quizgen.paper.answer_form import read_filled_form
    from quizgen.paper.grading import grade_paper

    form = read_filled_form(path)
    if form.code and key.code and form.code != key.code:
        raise KeyFileError(
            f"{path}: code {safe_echo(form.code)} belongs "
            f"to another paper; the key is for {key.code}"
        )
    if form.paper and key.paper and form.paper != key.paper:
        raise KeyFileError(
            f"{path}: is for other questions than the key, though both are called {key.code}"
        )
    chosen = lang or _choose_form_language(form, key)
    student = form.student
    result = grade_paper(
        key, form.list_typed_texts(), chosen, decimal=student.decimal, settle=settle
    )
    return GradedForm(str(path), str(student.name), str(student.matriculation), chosen, result)


def _choose_form_language(form: FilledForm, key: AnswerKey) -> str:
    """Return the language of the form, else of the paper, that quizgen has."""
    wished = (form.student.lang, *key.langs[:1])
    return next((lang for lang in wished if lang in list_languages()), FIRST)


def _print_json(marked: list[GradedForm], key: AnswerKey) -> None:
    """Print the results as JSON, a table for each form."""
    import json

    import msgspec

    tables = [
        {
            "file": one.file,
            "name": one.name,
            "matriculation": one.matriculation,
            **one.result.as_json(),
            "banks": msgspec.to_builtins(key.banks),
        }
        for one in marked
    ]
    shown = tables[0] if len(tables) == 1 else tables
    click.echo(json.dumps(shown, ensure_ascii=False, indent=1))


def _print_table(one: GradedForm) -> None:
    """Print the table of one form, as wide as the terminal."""
    import shutil

    from quizgen.paper.grade_report import format_table

    columns = shutil.get_terminal_size((80, 24)).columns
    for line in format_table(one.result, one.lang, columns, paint=sys.stdout.isatty()):
        click.echo(line)


def check_responses(
    path: Path,
    files: Sequence[Path],
    lang: str | None,
    banks: tuple[Path, ...],
    flags: Mapping[str, object],
) -> int:
    """Grade the responses in files and print them; return the exit code.

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
    with error_context(path, KeyFileError):
        found = list(grade_attempts(manifest, given, lang, settle=not flags["no_settle"]))
    for line in (*lost, *_iter_ungraded_messages(found)):
        print_message(line)
    there = [one for one in found if one.attempt.responses]
    if there:
        _print_attempts(there, lang or FIRST, flags)
    return (1 if there else 2) if lost else 0


def _iter_ungraded_messages(found: Sequence[GradedAttempt]) -> Iterator[str]:
    """Yield what is no error, but was not graded either."""
    for one in found:
        who = one.attempt.name or one.attempt.person_key[0]
        if not one.attempt.responses:
            yield f"{one.attempt.where}: {who}: no attempt"
        for number in one.foreign:
            yield f"{one.attempt.where}: {who}: question {number} is not in the keys; not marked"


def _print_attempts(found: Sequence[GradedAttempt], lang: str, flags: Mapping[str, object]) -> None:
    """Print graded attempts as JSON, CSV or a table."""
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
