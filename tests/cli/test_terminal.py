"""What commands share of a terminal."""

from __future__ import annotations

import ctypes
import locale
import sys

import pytest

from quizgen.cli import terminal
from quizgen.cli.terminal import ProgressLine, format_count
from quizgen.core.text_width import lay_out_table, text_width, wrap_lines
from quizgen.core.untrusted import escape_control_characters

ENGLISH = "The pupil lets in less light, and shorter wavelengths are refracted with more power."
BANGLA = "একটি পিনহোল ক্যামেরায় ফোকাস দূরত্ব দেওয়া আছে; বিন্দুটি ছবিতে কোথায় দেখা যাবে তা বের করো।"
JAPANESE = "焦点距離が与えられたとき、点はどこに写りますか。カメラの前の点を答えなさい。"


def width_by_libc(text):
    """Columns by ``wcwidth``, that terminals go by; libc names none for control characters."""
    libc = ctypes.CDLL(None)
    return sum(max(0, libc.wcwidth(ctypes.c_wchar(character))) for character in text)


@pytest.fixture(autouse=True)
def _locale_that_knows_unicode():
    before = locale.setlocale(locale.LC_CTYPE)
    locale.setlocale(locale.LC_CTYPE, "C.UTF-8")
    yield
    locale.setlocale(locale.LC_CTYPE, before)


@pytest.mark.parametrize(
    "text", [ENGLISH, BANGLA, JAPANESE, "উদ্\u200cযাপন র‍্য ক্ষেত্র", "e\u0301 f\u00a0=\u00a01"]
)
def test_a_text_takes_the_columns_that_a_terminal_gives_it(text):
    assert text_width(text) == width_by_libc(text)


@pytest.mark.parametrize("room", [20, 33, 40, 80])
@pytest.mark.parametrize("text", [ENGLISH, BANGLA, JAPANESE], ids=["en", "bn", "ja"])
def test_no_line_is_wider_than_there_is_room(text, room):
    lines = list(wrap_lines(text, room, "(a) ", "    "))
    assert max(map(width_by_libc, lines)) <= room
    glue = "" if text is JAPANESE else " "
    assert glue.join(line[4:] for line in lines) == text


def test_one_thing_is_no_plural():
    assert [format_count(count, "mark") for count in (0, 1, 2)] == ["0 marks", "1 mark", "2 marks"]


def test_words_stay_whole():
    assert list(wrap_lines("shorter wavelengths", 12)) == ["shorter", "wavelengths"]
    assert list(wrap_lines("a wavelengths b", 5)) == ["a", "wavelengths", "b"]
    assert list(wrap_lines("f =\u00a0660 nm", 8)) == ["f =\u00a0660", "nm"]
    assert list(wrap_lines("", 8)) == [""]


def test_lines_are_as_full_as_they_can_be():
    assert list(wrap_lines("aa bb cc dd", 5)) == ["aa bb", "cc dd"]


def test_control_characters_are_named_and_bangla_joiners_kept():
    assert escape_control_characters("a\x1b[31m") == "a[U+001B control character][31m"
    assert escape_control_characters("\u202e") == "[U+202E RIGHT-TO-LEFT OVERRIDE]"
    assert escape_control_characters("উদ্\u200cযাপন\n") == "উদ্\u200cযাপন\n"


def progress(monkeypatch, times, *, terminal_there):
    ticks = iter(times)
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal_there, raising=False)
    with ProgressLine("lint", 3, clock=lambda: next(ticks)) as tell:
        for name in ("a", "b", "c"):
            tell(name)


ERASE_LINE = "\x1b[2K"


@pytest.mark.parametrize(
    ("times", "there", "shown"),
    [([0, 0.1, 0.2, 0.9], True, False), ([0, 1, 2, 3], False, False), ([0, 0.5, 2, 3], True, True)],
    ids=["quick", "no terminal", "slow"],
)
def test_progress_is_shown_only_when_slow_and_on_a_terminal(
    monkeypatch, capsys, times, there, shown
):
    progress(monkeypatch, times, terminal_there=there)
    written = capsys.readouterr()
    assert written.out == ""
    assert ("2/3 b" in written.err) == shown
    assert "1/3" not in written.err
    assert written.err == "" or written.err.endswith(ERASE_LINE)


def test_no_color_takes_every_code_out_of_tables(monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.delenv("TERM", raising=False)
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert terminal.colour_choice() is None
    monkeypatch.setenv("NO_COLOR", "1")
    assert terminal.colour_choice() is False
    monkeypatch.setenv("NO_COLOR", "")
    assert terminal.colour_choice() is None


EFFECTS = [
    ("chromatic aberration", "skipped", "0.0616", "22.00", "107.68", "changes at most 0.0616 DN"),
    ("gamma", "ran", "74.1", "1.50", "24.99", "as table: this rung is off by 0.0072 DN at most"),
]


@pytest.mark.parametrize("room", [30, 40, 60, 80, 120])
def test_a_table_is_no_wider_than_the_terminal(monkeypatch, capsys, room):
    monkeypatch.setattr(terminal, "is_interactive", lambda: True)
    monkeypatch.setattr(terminal, "terminal_width", lambda: room)
    terminal.print_table(("effect", "", "DN", "ms", "took", "why"), EFFECTS)
    lines = capsys.readouterr().out.splitlines()
    assert max(map(width_by_libc, lines)) <= room
    words = [word for row in EFFECTS for cell in row for word in cell.split()]
    assert " ".join(lines).split()[5:] == words


def test_a_table_that_is_piped_has_a_line_for_each_row(capsys):
    terminal.print_table(("effect", "", "DN", "ms", "took", "why"), EFFECTS)
    assert len(capsys.readouterr().out.splitlines()) == 3


def test_columns_stand_below_each_other_in_any_script():
    rows = [("ভুল", "1", "a"), ("wrong", "20", "b")]
    assert [line for (line,) in lay_out_table(rows)] == ["ভুল     1   a", "wrong  20  b"]
