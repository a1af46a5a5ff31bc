"""The terminal session: feedback, hints, retries, Ctrl-C and going on."""

from __future__ import annotations

import json
import re
import time
from functools import cache
from pathlib import Path

import pytest
from click.testing import CliRunner

from quizgen.bank.bank import builtin_bank
from quizgen.cli import practice
from quizgen.cli.options import own_database
from quizgen.core.text_width import text_width
from quizgen.grading.feedback import load_practice_words
from quizgen.kinds.grade import show_key
from quizgen.locale import list_languages
from quizgen.practice.selection import matching_templates, question_seed, template_at
from quizgen.practice.session_state import PracticeRequest
from quizgen.practice.session_store import SessionStore
from quizgen.question.compose import compose_question
from quizgen.store import OutcomeRecord, QuestionRef
from quizgen.store.archive import read_archive


@pytest.fixture(autouse=True)
def shelf(tmp_path, monkeypatch):
    folder = tmp_path / "state"
    monkeypatch.setattr(practice, "state_folder", lambda: folder)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    return SessionStore(folder)


def run(lines, *arguments):
    return CliRunner().invoke(
        practice.practice,
        ["--topic", "projection", "--tier", "A", *arguments],
        input="\n".join(lines) + "\n",
    )


def first_question(seed="s", lang="en", number=1):
    name = template_at(
        builtin_bank(),
        matching_templates(builtin_bank(), PracticeRequest(lang, 1, "projection", "A")),
        seed,
        number,
    )
    template = builtin_bank().template(name)
    return compose_question(template, question_seed(seed, number), lang, figures=False)[1]


def test_right_answers_end_in_a_summary():
    typed = [show_key(spec) for spec in first_question().specs]
    done = run(typed, "--seed", "s", "--count", "1")
    assert done.exit_code == 0
    assert done.output.count("Correct.") == len(typed)
    assert f"Projection: {len(typed)} of {len(typed)} parts right at once" in done.output
    assert "Everything right at once." in done.output


def test_unreadable_answers_cost_no_try_and_three_wrong_ones_show_the_solution():
    key = first_question()
    lines = ["???", "1;2;3;4;5;6;7", "?"]
    for spec in key.specs:
        unit = getattr(spec, "unit", "")
        wrong = f"987654 {unit}" if hasattr(spec, "value") else "(987654; 123457)"
        lines += [wrong] * 3
    lines += ["!"] * 9
    done = run(lines, "--seed", "s", "--count", "1")
    assert "Hint:" in done.output
    assert "Try again (2 left)." in done.output
    assert f"Answer: {key.solution.parts[0].answer}" in done.output
    assert "Practise next: Projection (--topic projection)" in done.output


@cache
def several():
    """A seed whose first question has several parts."""
    return next(seed for seed in "abcdefgh" if len(first_question(seed).specs) > 1)


@pytest.mark.parametrize("seeded", [True, False], ids=["a seed", "no seed"])
@pytest.mark.parametrize("stop", [[], ["quit"], ["QUIT"]], ids=["end of input", "quit", "QUIT"])
def test_the_same_command_goes_on_where_it_was_left(shelf, monkeypatch, stop, seeded):
    monkeypatch.setattr("secrets.token_hex", lambda _size: "0c097f")
    options = ["--seed", several()] if seeded else []
    done = run(["!", *stop], *options, "--count", "2")
    assert done.exit_code == 0
    assert "Session kept" in done.output
    (path,) = shelf.folder.glob("*.json")
    state = json.loads(path.read_text())
    template, numbers = state["due"]
    first = compose_question(builtin_bank().template(template), numbers, figures=False)[1]
    left = [part for part in state["parts"] if part["outcome"] is None]
    rest = [show_key(spec) for spec in first.specs[-len(left) :]]
    done = run([*rest, *["!"] * 9], *options, "--count", "2")
    assert f"Continuing the session with seed {state['seed']}." in done.output
    assert done.output.count("Correct.") == len(rest)
    assert ("Done before: (a)." in done.output) == (len(left) < len(first.specs))
    assert "Question 2 of 2" in done.output
    assert "Summary by topic" in done.output
    assert not list(shelf.folder.glob("*.json"))
    assert "Continuing the session" not in run(["quit"], *options, "--count", "2").output


def test_a_glance_at_another_topic_deletes_nothing(shelf):
    run(["!", "quit"], "--count", "2")
    for others in (["--topic", "noise"], ["--tier", "B"], ["--count", "3"], ["--lang", "bn"]):
        run(["quit"], "--count", "2", *others)
        run(["!"] * 40, "--count", "1", *others)
    assert "Continuing the session" in run(["quit"], "--count", "2").output
    assert "Continuing the session" not in run(["quit"], "--count", "2", "--fresh").output


def test_ctrl_c_keeps_the_session_and_says_so(shelf, monkeypatch):
    typed = iter(["!"])

    def answer(prompt):
        for line in typed:
            return line
        raise KeyboardInterrupt

    monkeypatch.setattr("builtins.input", answer)
    done = CliRunner().invoke(
        practice.practice, ["--topic", "projection", "--tier", "A", "--seed", several()]
    )
    assert done.exit_code == 130
    assert done.output.endswith("Session kept. The same command continues it.\n")
    (path,) = shelf.folder.glob("*.json")
    assert json.loads(path.read_text())["parts"][0]["outcome"]


@pytest.mark.parametrize(("lang", "word", "said"), [
    ("en", "skip", "Skipped."), ("en", "Skip", "Skipped."),
    ("bn", "বাদ", "বাদ দেওয়া হলো।"), ("bn", "skip", "বাদ দেওয়া হলো।"),
])  # fmt: skip
def test_a_part_can_be_skipped(lang, word, said):
    parts = len(first_question(lang=lang).specs)
    done = run([word] * parts, "--seed", "s", "--count", "1", "--lang", lang)
    assert done.output.count(said) == parts
    if lang == "en":
        assert f"Projection: {parts} skipped" in done.output
        assert "parts right at once" not in done.output


def test_the_bangla_word_for_quit():
    assert "অনুশীলন জমা রইল।" in run(["থামুন"], "--lang", "bn").output


def test_no_word_that_steers_is_an_answer():
    """A gap or a piece of code might ask for the word itself."""
    words = {
        word.casefold() for lang in list_languages() for name in ("skip-words", "quit-words")
        for word in load_practice_words(lang)[name].split(", ")
    }  # fmt: skip
    for name in builtin_bank().template_paths:
        for text in builtin_bank().template(name).texts.values():
            for accepted in text.named.get("gaps", {}).values():
                answers = str(accepted).casefold()
                assert not [w for w in words if f"'{w}'" in answers], name


def test_a_broken_session_file_is_ignored(shelf):
    wish = PracticeRequest("en", 1, "projection", "A")
    shelf.folder.mkdir(parents=True)
    shelf.path(wish).write_text("{not json")
    assert run(["!"] * 9, "--count", "1").exit_code == 0


POINT = "point-to-image-plane"


@pytest.fixture
def browser_side():
    """What a server of the same database has of the learner."""
    from quizgen.store import Store
    from quizgen.store.learner import LearnerProgress

    store = Store(own_database())
    yield LearnerProgress(store, builtin_bank(), store.learner())
    store.close()


def test_what_is_practised_here_shows_in_the_browser(browser_side):
    key = first_question("s")
    lines = [show_key(spec) for spec in key.specs]
    assert run(lines, "--seed", "s", "--count", "1").exit_code == 0
    card = browser_side.agenda().card(key.template)
    assert card.stability == 2.3065, "FSRS: right at once"
    (attempt,) = browser_side.store.latest(browser_side.learner.id)
    assert attempt.ended is not None
    question, _ = compose_question(
        builtin_bank().template(attempt.template), attempt.seed, figures=False
    )
    names = {part.field.id for part in question.parts}
    assert set(attempt.state["parts"]) == names, "as the pages of the browser call them"
    seen = browser_side.store.list_outcomes(browser_side.learner.id)
    assert [(one.topic, one.right, one.first) for one in seen] == [
        ("projection", True, True)
    ] * len(names)
    run(lines, "--seed", "s", "--count", "1")
    assert browser_side.agenda().card(key.template) == card, "the same numbers say nothing new"


def test_a_skipped_part_says_nothing(browser_side):
    done = run(["skip"] * 9, "--seed", several(), "--count", "1")
    assert "Practise next: Projection" in done.output
    assert browser_side.store.list_outcomes(browser_side.learner.id) == []
    assert browser_side.agenda().cards == {}
    browser_side.store.archives.import_archive(
        browser_side.learner.id,
        read_archive(browser_side.store.archives.write(browser_side.learner.id)),
    )


def test_what_was_done_in_the_browser_is_known_here(browser_side):
    asked = browser_side.plan(builtin_bank().template_paths).choose_next()
    title = compose_question(builtin_bank().template(asked), figures=False)[0].title
    assert f"Question 1 of 1: {title}" in run(["quit"], "--count", "1").output
    done = OutcomeRecord(asked, "any", "a", "", right=True, first=True, at=time.time(), credit=1.0)
    attempt = browser_side.store.start_attempt(browser_side.learner.id, QuestionRef(asked, "1"), {})
    browser_side.store.save_attempt(attempt, (done,))
    assert f"Question 1 of 1: {title}" not in run(["quit"], "--count", "1", "--fresh").output
    seen = OutcomeRecord("rgb-to-hsv", "colour", "a", "", right=False, first=False, at=time.time())
    attempt = browser_side.store.start_attempt(
        browser_side.learner.id, QuestionRef("rgb-to-hsv", "1"), {}
    )
    browser_side.store.save_attempt(attempt, (seen,))
    done = run(["!"] * 9, "--count", "1", "--seed", "s")
    assert "So far, here and in the browser" in done.output
    assert "Colour: 0 of 1 parts right at once" in done.output


def test_the_summary_says_which_points_to_expect(browser_side):
    assert "In the exam" not in run(["!"] * 30, "--count", "3").output
    done = run(["!"] * 60, "--count", "7").output
    said = re.search(
        r"In the exam about ([\d.]+) of 10 points; in 8 of 10 cases ([\d.]+) to ([\d.]+)\.", done
    )
    low, high = float(said[2]), float(said[3])
    assert low <= float(said[1]) <= high < 8, "nothing was known"


def test_a_database_of_ones_own(tmp_path):
    from quizgen.store import Store

    file = tmp_path / "mine.sqlite3"
    run(["!"] * 9, "--count", "1", "--seed", "s", "--database", f"sqlite:///{file}")
    store = Store(f"sqlite:///{file}")
    assert len(store.latest(store.learner().id)) == 1
    store.close()


def test_sessions_before_are_remembered():
    run(["!"] * 9, "--seed", "s", "--count", "1")
    done = run(["!"] * 9, "--seed", "t", "--count", "1")
    assert "So far, here and in the browser" in done.output


@pytest.mark.parametrize("lang", ["en", "bn"])
@pytest.mark.parametrize("columns", [40, 80])
@pytest.mark.parametrize("topic", ["optics", "eye"])
def test_text_wraps_at_the_width_of_the_terminal(monkeypatch, lang, columns, topic):
    monkeypatch.setenv("COLUMNS", str(columns))
    done = CliRunner().invoke(
        practice.practice, ["--topic", topic, "--lang", lang, "--count", "6", "--seed", "w"],
        input="?\n!\n" * 60,
    )  # fmt: skip
    prompt = load_practice_words(lang)["prompt"]
    lines = [line.removeprefix(f"{prompt}: ") for line in done.output.splitlines()]
    breakable = [line for line in lines if len(line.split()) > 1 and ".svg" not in line]
    assert max(map(text_width, breakable)) <= columns
    assert done.exit_code == 0


def test_bangla_and_giving_up():
    done = run(["!"] * 9, "--lang", "bn", "--seed", "s", "--count", "1")
    assert "উত্তর:" in done.output
    assert "বিষয় ধরে ফলাফল" in done.output


def nothing():
    """A topic that has no question of a tier."""
    return next(
        ["--topic", topic, "--tier", tier]
        for topic in builtin_bank().topics for tier in "ABCD"
        if not matching_templates(builtin_bank(), PracticeRequest(topic=topic, tier=tier))
    )  # fmt: skip


def test_a_language_that_the_bank_has_not_names_those_it_has():
    done = CliRunner().invoke(practice.practice, ["--lang", "fr"])
    assert "'fr' (allowed: en, bn, both)" in str(done.exception)


@pytest.mark.parametrize(("options", "names"), [
    (["--topic", "cooking"], "projection, normalisation, aperture"),
    (["--tier", "E"], "allowed: A, B, C, D"),
    ([], "tiers there: "),
])  # fmt: skip
def test_filters_that_fit_nothing_name_what_there_is(options, names):
    options = options or nothing()
    done = CliRunner().invoke(practice.practice, options)
    assert done.exit_code == 2
    assert names in done.output


@pytest.mark.parametrize("topic", ["NOISE", "Noise", " noise", "রঙ"])
def test_topics_are_found_in_capitals_and_by_their_title(topic):
    done = CliRunner().invoke(practice.practice, ["--topic", topic, "--tier", "b"], input="quit\n")
    assert done.exit_code == 0


def test_every_sentence_exists_in_every_language():
    first, *others = (load_practice_words(lang) for lang in list_languages())
    assert all(first.keys() == other.keys() for other in others)


def test_a_german_answer_is_read_back_with_a_comma(shelf):
    bank = Path(__file__).parents[2] / "examples" / "filtering"
    done = CliRunner().invoke(
        practice.practice,
        ["--bank", str(bank), "--trust", "--lang", "de", "--count", "3", "--seed", "s"],
        input="0.5\n" * 60,
    )
    word = load_practice_words("de")["read"].split("{")[0]
    read = [line.partition(word)[2] for line in done.output.splitlines() if word in line]
    assert [text for text in read if text.startswith("0,5")]
    assert not [text for text in read if "0.5" in text]
