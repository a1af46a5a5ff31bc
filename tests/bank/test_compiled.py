"""Rules and prose are read once; what is kept of them is what reading them gives."""

from __future__ import annotations

import pytest

from quizgen.bank import language_file, template
from quizgen.bank.bank import Bank, builtin_bank
from quizgen.bank.language_file import parse_language_file, read_language_file
from quizgen.bank.template import read_rules
from quizgen.core.errors import BankError

PROSE = """# Title
A lens of $f$ = {{ f }}, *thin*, with `code {{ n }}`.

1. one
2. two

| a | b |
|---|---|
| $1.50*x$ | {{ y }} |

```
print({{ n }})
```
## why
Because.
- a [x < 2]: said so
- a: else
## traps
- minus: **Not** $-x/3$.
"""
SAMPLE = 12
"""Every so many templates are looked at."""


def unread(*_arguments):
    raise AssertionError("read again")


def test_what_is_kept_of_prose_is_all_of_it(tmp_path, empty_cache, monkeypatch):
    (tmp_path / "en.md").write_text(PROSE)
    first = read_language_file(tmp_path / "en.md")
    monkeypatch.setattr(language_file, "parse_language_file", unread)
    again = read_language_file(tmp_path / "en.md")
    assert (again, repr(again)) == (first, repr(first)) == (parse_language_file(PROSE), repr(first))


def test_the_banks_own_files_are_all_read_once(empty_cache, monkeypatch):
    root = builtin_bank().root
    names = list(builtin_bank().template_paths)[::SAMPLE]
    first = [Bank(root, trusted=True).template(name) for name in names]
    monkeypatch.setattr(language_file, "parse_language_file", unread)
    monkeypatch.setattr(template, "parse_toml", unread)
    bank = Bank(root, trusted=True)
    assert [bank.template(name) for name in names] == first


@pytest.mark.parametrize("change", [("# Title", "# Other"), ("thin", "{{ open"), ("Because", "")])
def test_changed_prose_is_read_anew(tmp_path, empty_cache, change):
    file = tmp_path / "en.md"
    file.write_text(PROSE)
    before = read_language_file(file)
    file.write_text(PROSE.replace(*change))
    if "{{" in change[1]:
        for _ in range(2):
            with pytest.raises(BankError, match=r"en\.md:2: only"):
                read_language_file(file)
    else:
        assert read_language_file(file) != before


def test_rules_that_are_wrong_are_told_each_time(tmp_path, empty_cache):
    (tmp_path / "template.toml").write_text('topic = "eye"\ntier = "E"\n')
    for _ in range(2):
        with pytest.raises(BankError, match=r"template\.toml:2: .*tier"):
            read_rules(tmp_path / "template.toml")


@pytest.mark.parametrize("value", ["2024-01-01", "99999999999999999999999"])
def test_rules_that_would_come_back_otherwise_are_read_each_time(tmp_path, empty_cache, value):
    """A date is no text, and some numbers are too long for what they are kept in."""
    (tmp_path / "template.toml").write_text(
        'topic = "eye"\ntier = "A"\n[[part]]\nanswer = { kind = "sketch", view = [0, 1, 0, 1], '
        f"grid = [1, 1], lines = {{}}, features = {{ a = {{ on = {value} }} }} }}\n"
    )
    first, again = (read_rules(tmp_path / "template.toml") for _ in range(2))
    assert repr(first) == repr(again)
    assert not isinstance(again.part[0].answer["features"]["a"]["on"], str)
