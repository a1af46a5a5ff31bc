"""``quizgen cards``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import click

from quizgen.cli.options import (
    LANGUAGE_HELP,
    SEED,
    BankOptions,
    LanguageParam,
    bank_options,
    jobs_option,
    match_choice,
    open_sound_bank,
    split_names,
    worthwhile_processes,
)
from quizgen.locale import default_language

if TYPE_CHECKING:
    from quizgen.cards import Deck

FORMATS = ("apkg", "tsv", "csv")
NAME = "quizgen"
A_TEMPLATE = 0.006
"""Seconds that the worked questions of a template take, about."""


class CardsOptions(BankOptions):
    """Options of ``quizgen cards``."""

    lang: str | None
    topics: str | None
    kinds: str | None
    seed: int
    formats: str
    marks: Path | None
    blueprint: str | None
    out: Path
    jobs: int | None


@click.command()
@click.option("--lang", type=LanguageParam(both=True), help=LANGUAGE_HELP)
@click.option("--topic", "topics", help="Only these topics, by comma.")
@click.option("--kind", "kinds", help="Only these kinds, by comma: vocab, formula, cheat, trap, "
              "figure, truth, choice, question.")  # fmt: skip
@click.option("--seed", type=SEED, default=0, show_default=True,
              help="Number that fixes the worked questions.")  # fmt: skip
@click.option("--format", "formats", default="apkg", show_default=True,
              help="apkg (Anki), tsv, csv; by comma.")  # fmt: skip
@click.option("--from-marks", "marks", type=click.Path(path_type=Path),
              help="Cards of what went wrong: a result of `quizgen check --json`.")  # fmt: skip
@click.option("--blueprint", help="The paper's blueprint, if it is a file (with --from-marks).")
@click.option("--out", type=click.Path(path_type=Path), default=Path("cards"), show_default=True,
              help="Folder to write to.")  # fmt: skip
@jobs_option
@bank_options
def cards(**options: Unpack[CardsOptions]) -> None:
    """Make flashcards for Anki and other programs."""
    from quizgen.core.files import write_all

    formats = [match_choice("--format", name, FORMATS) for name in split_names(options["formats"])]
    deck = _build_requested_deck(options)
    if not deck.notes:
        click.echo("Nothing to learn: no card fits.")
        return
    folder = options["out"]
    made = _encode_deck_files(deck, formats)
    media = deck.media if "tsv" in formats else {}
    write_all(folder, {**{f"media/{name}": data for name, data in media.items()}, **made})
    _report_deck(deck, [folder / name for name in made])


def _build_requested_deck(options: CardsOptions) -> Deck:
    """Return the deck that the options ask for: of graded mistakes, or of the bank."""
    from quizgen.cards import build_deck

    bank = open_sound_bank(options)
    lang = options["lang"] or default_language(bank.languages)
    if options["marks"] is not None:
        from quizgen.cards.error_deck import deck_from_grades

        return deck_from_grades(options["marks"], lang, bank=bank, blueprint=options["blueprint"])
    return build_deck(
        lang,
        topics=split_names(options["topics"]),
        kinds=split_names(options["kinds"]),
        seed=options["seed"],
        bank=bank,
        jobs=worthwhile_processes(options["jobs"], len(bank.template_paths) * A_TEMPLATE),
    )


def _encode_deck_files(deck: Deck, formats: list[str]) -> Mapping[str, bytes]:
    """Return the bytes of each file of a deck by its name."""
    from quizgen.cards.apkg import write_apkg
    from quizgen.cards.delimited import write_csv, write_tsv

    writers = {"apkg": write_apkg, "tsv": write_tsv, "csv": write_csv}
    return {f"{NAME}.{name}": writers[name](deck) for name in formats}


def _report_deck(deck: Deck, written: list[Path]) -> None:
    """Print the files written, and how many cards of each kind there are."""
    counts: dict[str, int] = {}
    for note in deck.notes:
        counts[note.kind] = counts.get(note.kind, 0) + len(note.cards())
    for path in written:
        click.echo(f"  {path}")
    total = ", ".join(f"{count} {kind}" for kind, count in counts.items())
    click.echo(f"{deck.card_count} cards ({total})")
    click.echo("Next: in Anki choose File > Import; import again later, nothing is doubled.")
