"""Decks in the real Anki library: counts, media, cards, re-import, corrections, schedule."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from anki.collection import ImportAnkiPackageOptions, ImportAnkiPackageRequest
from sweep import spread

from quizgen.cards import apkg, build_deck, note_types
from quizgen.cards.apkg import write_apkg
from quizgen.typeset.prose import Paragraph, PlainText

GOOD = 3


def bring_in(collection, data, tmp_path, **options):
    path = tmp_path / "deck.apkg"
    path.write_bytes(data)
    request = ImportAnkiPackageRequest(
        package_path=str(path), options=ImportAnkiPackageOptions(**options)
    )
    return collection.import_anki_package(request).log


def corrected(deck, key, name, text):
    """The same deck with one text changed and its version raised."""

    def changed(note):
        if note.key != key:
            return note
        words = {**note.words, name: {**note.words[name], "en": (Paragraph((PlainText(text),)),)}}
        return replace(note, words=words, version=note.version + 1)

    return replace(deck, notes=tuple(map(changed, deck.notes)))


def note_of(collection, key):
    (number,) = collection.find_notes(f'Key:"{key}"')
    return collection.get_note(number)


@pytest.mark.slow
def test_every_note_and_card_arrives(deck, packed, collection, tmp_path):
    log = bring_in(collection, packed, tmp_path)
    assert log.found_notes == len(log.new) == len(deck.notes)
    assert collection.card_count() == deck.card_count
    assert not [*log.updated, *log.duplicate, *log.conflicting, *log.missing_notetype]


def test_media_are_complete_and_none_is_unused(deck, packed, collection, tmp_path):
    bring_in(collection, packed, tmp_path)
    report = collection.media.check()
    assert not report.missing
    assert not report.unused
    assert {name for name in deck.media if collection.media.have(name)} == set(deck.media)
    assert deck.media


def test_no_card_is_broken(packed, collection, tmp_path):
    """Every card has a front, a back that says more, and no field or cloze left unfilled."""
    bring_in(collection, packed, tmp_path)
    for number in collection.find_cards(""):
        card = collection.get_card(number)
        front, back = card.question(), card.answer()
        seen = re.sub(r"<style>.*?</style>|<[^>]+>|\s", "", front, flags=re.DOTALL)
        assert seen or "<img" in front
        assert len(back) > len(front) or "cloze" in front
        for text in (front, back):
            assert "{{" not in text
            assert "}}" not in text
            assert "unknown field" not in text.lower()
            assert "No cloze" not in text
            assert text.count("\\(") == text.count("\\)")


def test_no_card_is_reported_empty(packed, collection, tmp_path):
    bring_in(collection, packed, tmp_path)
    assert not collection.get_empty_cards().notes


def test_decks_and_tags(deck, packed, collection, tmp_path):
    bring_in(collection, packed, tmp_path)
    names = {entry.name for entry in collection.decks.all_names_and_ids(skip_empty_default=True)}
    assert "Quizgen" in names
    assert "Quizgen::Colour" in names
    assert len(collection.find_cards("deck:Quizgen::*")) == deck.card_count
    assert len(collection.find_notes("tag:quizgen::kind::vocab")) == 41
    assert len(collection.find_notes("tag:quizgen::lang::bn")) == len(deck.notes)
    assert collection.find_notes("tag:quizgen::tier::A tag:quizgen::section::2.4")


def test_importing_again_adds_and_changes_nothing(deck, packed, collection, tmp_path):
    bring_in(collection, packed, tmp_path)
    log = bring_in(collection, packed, tmp_path)
    assert not log.new
    assert not log.updated
    assert len(log.duplicate) == len(deck.notes)
    assert collection.card_count() == deck.card_count


def studied(collection, key):
    """Answer one card of a note as after a good review, and return its id."""
    card = note_of(collection, key).cards()[0]
    collection.sched.set_due_date([card.id], "12")
    card = collection.get_card(card.id)
    card.start_timer()
    states = collection._backend.get_scheduling_states(card.id)
    answer = collection.sched.build_answer(card=card, states=states, rating=GOOD - 1)
    collection.sched.answer_card(answer)
    return card.id


def schedule(collection, number):
    card = collection.get_card(number)
    return card.type, card.queue, card.due, card.ivl, card.factor, card.reps, card.lapses


def test_a_corrected_text_updates_the_note_and_keeps_its_schedule(
    deck, packed, collection, tmp_path
):
    bring_in(collection, packed, tmp_path)
    number = studied(collection, "vocab/pixel")
    before = schedule(collection, number)
    assert before[5] == 1
    assert before[3] > 0
    better = corrected(deck, "vocab/pixel", "Meaning", "A corrected meaning.")
    log = bring_in(collection, write_apkg(better), tmp_path)
    assert not log.new
    assert [entry.id.nid for entry in log.updated] == [note_of(collection, "vocab/pixel").id]
    assert "A corrected meaning." in note_of(collection, "vocab/pixel")["Meaning"]
    assert schedule(collection, number) == before
    assert collection.card_count() == deck.card_count


def test_a_changed_text_without_a_new_version_would_not_arrive(deck, packed, collection, tmp_path):
    """What the list of versions is for."""
    bring_in(collection, packed, tmp_path)
    better = corrected(deck, "vocab/pixel", "Meaning", "A corrected meaning.")
    same = replace(better, notes=tuple(
        replace(note, version=old.version)
        for note, old in zip(better.notes, deck.notes, strict=True)
    ))  # fmt: skip
    assert not bring_in(collection, write_apkg(same), tmp_path).updated


@pytest.mark.slow
def test_another_seed_gives_the_questions_new_numbers_and_no_new_notes(
    deck, packed, collection, tmp_path
):
    bring_in(collection, packed, tmp_path)
    number = studied(collection, "question/A3")
    before, text = schedule(collection, number), note_of(collection, "question/A3")["Front"]
    log = bring_in(collection, write_apkg(build_deck("both", seed=2)), tmp_path)
    assert not log.new
    questions = sum(note.kind == "question" for note in deck.notes)
    assert len(log.updated) == questions
    assert note_of(collection, "question/A3")["Front"] != text
    assert schedule(collection, number) == before


@pytest.mark.parametrize("lang", spread(["bn", "en"], 1))
def test_a_second_language_joins_the_same_notes(lang, deck, packed, collection, tmp_path):
    single = build_deck(lang, seed=1)
    bring_in(collection, write_apkg(single), tmp_path)
    alone = note_of(collection, "vocab/pixel")
    assert bool(alone["Meaning"]) == (lang == "en")
    log = bring_in(collection, packed, tmp_path)
    assert not log.new
    assert len(log.updated) == len(single.notes) == len(deck.notes)
    together = note_of(collection, "vocab/pixel")
    assert together["Meaning"]
    assert together["Meaning bn"]
    assert collection.card_count() == deck.card_count
    report = collection.media.check()
    assert not report.missing
    # A picture with words in it is another file in each language: the first one's stays behind.
    assert all("imaging-pipeline" in name for name in report.unused)


def test_a_new_look_arrives_with_a_re_import(deck, packed, collection, tmp_path, monkeypatch):
    bring_in(collection, packed, tmp_path)
    better = {**note_types.note_type("term", deck.wish.columns), "css": ".card { color: red; }"}
    better["mod"] += 100_000
    monkeypatch.setattr(
        apkg,
        "note_type",
        lambda form, of: better if form == "term" else note_types.note_type(form, of),
    )
    bring_in(collection, write_apkg(deck), tmp_path)
    assert collection.models.by_name("Quizgen term")["css"] == better["css"]
    assert "qg-term" in collection.models.by_name("Quizgen")["css"]
    assert collection.card_count() == deck.card_count


def test_a_learners_own_change_is_kept(packed, deck, collection, tmp_path):
    """Notes edited in Anki are newer than any content version."""
    bring_in(collection, packed, tmp_path)
    note = note_of(collection, "vocab/pixel")
    note["Meaning"] = "My own words."
    collection.update_note(note)
    newer = write_apkg(corrected(deck, "vocab/pixel", "Meaning", "A corrected meaning."))
    assert not bring_in(collection, newer, tmp_path).updated
    assert note_of(collection, "vocab/pixel")["Meaning"] == "My own words."
