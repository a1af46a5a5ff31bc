"""Errors about what stands in a file name the file, once."""

from __future__ import annotations

from pathlib import Path

import pytest
from sweep import together

from quizgen.core.errors import BankError, FormulaError, PaperCodeError
from quizgen.core.untrusted import error_context


@together(
    ("file", "said", "shown"),
    [
        ("bank/a/template.toml", "no words", "bank/a/template.toml: no words"),
        ("bank/a/template.toml", "bank/a/template.toml: part 1", "bank/a/template.toml: part 1"),
        ("bank/a/template.toml", "bank/a/en.md: line 3", "bank/a/en.md: line 3"),
        ("bank/a/template.toml", "bank/b/en.md", "bank/a/template.toml: bank/b/en.md"),
        ("paper.toml", "no template. Sorry", "paper.toml: no template. Sorry"),
        (None, "no words", "no words"),
    ],
)
def test_an_error_names_its_file_once(file, said, shown):
    with pytest.raises(BankError) as caught, error_context(file and Path(file)):
        raise BankError(said)
    assert str(caught.value) == shown


def test_an_error_keeps_its_kind_and_its_column():
    with pytest.raises(FormulaError) as caught, error_context(Path("x.toml")):
        raise FormulaError("unknown unit", 4)
    assert (str(caught.value), caught.value.column) == ("x.toml: unknown unit", 4)


def test_only_errors_of_the_kind_that_is_about_the_file_name_it():
    with (
        pytest.raises(BankError, match=r"^elsewhere$"),
        error_context(Path("x.toml"), PaperCodeError),
    ):
        raise BankError("elsewhere")
