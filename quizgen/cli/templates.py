"""``quizgen templates``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, TypedDict, Unpack

import click

from quizgen.cli.author_language import explain_error
from quizgen.cli.options import BankOptions, bank_options, match_choice, open_bank, resolve_topic
from quizgen.cli.terminal import is_interactive, print_message, print_table, to_one_line
from quizgen.core.errors import BankError

if TYPE_CHECKING:
    from quizgen.bank.bank import Bank

HEAD = ("id", "tier", "topic", "pool", "languages", "title")


class TemplateFilters(TypedDict):
    """Conditions on templates; all must hold."""

    topic: str | None
    kind: str | None
    search: str | None
    covers: str | None


class TemplatesOptions(BankOptions, TemplateFilters):
    """Options of ``quizgen templates``."""

    coverage: bool


@click.command()
@click.option("--topic", help="Only of this topic.")
@click.option("--kind", help="Only with an answer of this kind, such as number or choice.")
@click.option("--search", metavar="TEXT", help="Only with this text in id or title.")
@click.option("--covers", metavar="ITEM", help="Only those that cover this item, such as Q4a.")
@click.option("--coverage", is_flag=True, help="What of the curriculum is covered, with holes.")
@bank_options
def templates(**options: Unpack[TemplatesOptions]) -> None:
    """List the templates of the bank: id, tier, topic, pool size, languages, title.

    Piped, each template is one line, its cells parted by tabs.
    """
    bank = open_bank(options)
    if options["coverage"]:
        _print_coverage(bank)
        return
    rows = list(_iter_matching_rows(bank, options))
    _print_templates(HEAD, rows)
    if not rows and options["covers"] is not None:
        click.echo(f"no template covers {options['covers']!r}", err=True)
    elif is_interactive() or not rows:
        click.echo(f"{len(rows)} templates", err=True)


def _iter_matching_rows(bank: Bank, filters: TemplateFilters) -> Iterator[tuple[str, ...]]:
    """Yield the rows of the templates that meet every condition.

    One that cannot be read is named on the error stream, and the others go on.

    Raises
    ------
    click.BadParameter
        If there is no such topic or kind; it names all.
    """
    from quizgen.kinds import KINDS
    from quizgen.lint.coverage import templates_covering

    topic, kind, search, covers = (filters[key] for key in ("topic", "kind", "search", "covers"))
    topic = None if topic is None else resolve_topic(bank, topic)
    kind = None if kind is None else match_choice("--kind", kind, sorted(KINDS))
    covered = {
        (part, own) for part in bank.members if covers for own in templates_covering(part, covers)
    }
    for name in bank.template_paths:
        try:
            rules = bank.rules(name)
            if (
                topic in {None, rules.topic}
                and (kind is None or kind in {part.answer["kind"] for part in rules.part})
                and (covers is None or bank.owner_of(name) in covered)
                and (search is None or _is_mentioned(bank, name, search))
            ):
                yield _build_template_row(bank, name)
        except BankError as error:
            print_message(explain_error(error))


def _is_mentioned(bank: Bank, name: str, search: str) -> bool:
    """Return whether a text occurs in a template's name or titles."""
    texts = [
        name,
        *(_read_template_title(bank, name, lang) for lang in bank.template_languages(name)),
    ]
    return any(search.casefold() in text.casefold() for text in texts)


def _build_template_row(bank: Bank, name: str) -> tuple[str, ...]:
    """Return the cells of a template, without running its solver."""
    rules, langs = bank.rules(name), _list_languages(bank, name)
    title = _read_template_title(bank, name, langs[0]) if langs else ""
    return (name, rules.tier, rules.topic, str(rules.pool or "-"), ",".join(langs), title)


def _list_languages(bank: Bank, name: str) -> list[str]:
    """Return the languages of a template, those of the bank first and in their order."""
    written = bank.template_languages(name)
    return sorted(written, key=[*bank.languages, *written].index)


def _read_template_title(bank: Bank, name: str, lang: str) -> str:
    """Return a template's title in a language."""
    from quizgen.bank.language_file import read_language_file

    return read_language_file(bank.template_paths[name] / f"{lang}.md").title


def _print_coverage(bank: Bank) -> None:
    """Print how much of the curriculum is covered, and what is not."""
    from quizgen.lint.coverage import curriculum_coverage, verb_coverage

    for head, list_rows in (("group", curriculum_coverage), ("verb", verb_coverage)):
        rows = [
            (row.group, str(len(row.covered)), str(row.total), " ".join(row.holes))
            for part in bank.members
            for row in list_rows(part)
        ]
        if rows:
            _print_templates((head, "covered", "of", "holes"), rows)


def _print_templates(head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table on a terminal, else tab-separated lines."""
    if is_interactive():
        print_table(head, rows)
        return
    for row in rows:
        click.echo("\t".join(map(to_one_line, row)))
