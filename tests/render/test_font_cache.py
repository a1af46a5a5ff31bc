"""Fonts are kept between runs; what was damaged there is made again, never put into a page."""

from __future__ import annotations

import pytest

from quizgen.render import fonts

FEW = tuple(range(0x0995, 0x09A0))


@pytest.fixture
def made(monkeypatch, tmp_path):
    """How often a font was packed."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))
    packed, subset = [], fonts._subset

    def counted(source, characters):
        packed.append(characters)
        return subset(source, characters)

    monkeypatch.setattr(fonts, "_subset", counted)
    return packed


def kept():
    (file,) = fonts.cache_folder().iterdir()
    return file


def test_a_font_is_packed_once(made):
    first = fonts._subset_cached(fonts.bangla_file(), FEW)
    assert fonts._subset_cached(fonts.bangla_file(), FEW) == first
    assert first.startswith(b"wOF2")
    assert len(made) == 1


@pytest.mark.parametrize(
    "damage", [lambda d: d[:1000], lambda _: b"", lambda d: d[:-1] + b"x", lambda d: d[40:]]
)
def test_a_damaged_font_is_packed_again(made, damage):
    first = fonts._subset_cached(fonts.bangla_file(), FEW)
    kept().write_bytes(damage(kept().read_bytes()))
    assert fonts._subset_cached(fonts.bangla_file(), FEW) == first
    assert fonts._subset_cached(fonts.bangla_file(), FEW) == first
    assert len(made) == 2
