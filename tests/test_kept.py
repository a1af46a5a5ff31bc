"""What is kept comes back as it was, or not at all."""

from __future__ import annotations

import os
import time

import pytest

from quizgen.core import cache as cache_module

KEY = "a" * 64


@pytest.fixture
def cache(empty_cache):
    """Begin as a new process does."""

    def begin():
        cache_module.user_cache_folder.cache_clear()
        cache_module.remove_stale.cache_clear()
        return empty_cache

    return begin


def test_what_is_kept_is_found_again(cache):
    cache()
    assert cache_module.read_cached("kind", KEY) is None
    cache_module.write_cached("kind", KEY, b"said\n")
    assert cache_module.read_cached("kind", KEY) == b"said\n"
    assert cache_module.read_cached("kind", "b" * 64) is None
    assert cache_module.read_cached("other", KEY) is None


def test_what_a_wheel_brings_is_found_before_anybody_asks_for_a_cache(cache, monkeypatch):
    cache_module.write_entry(cache_module.SHIPPED, "kind", KEY, b"said")
    monkeypatch.setattr(cache_module, "user_cache_folder", lambda: pytest.fail("asked"))
    assert cache_module.read_cached("kind", KEY) == b"said"


@pytest.mark.parametrize("change", [
    lambda data: data[:0], lambda data: data[:-1], lambda data: data + b" ",
    lambda data: data.replace(b"said", b"sold"), lambda data: bytes(len(data)),
])  # fmt: skip
def test_what_is_damaged_is_as_if_it_had_never_been_kept(cache, change):
    file = cache() / "kind" / KEY
    cache_module.write_cached("kind", KEY, b"said")
    file.write_bytes(change(file.read_bytes()))
    assert cache_module.read_cached("kind", KEY) is None
    cache_module.write_cached("kind", KEY, b"said")
    assert cache_module.read_cached("kind", KEY) == b"said"


def test_what_was_kept_for_another_place_is_not_believed(cache):
    home = cache()
    cache_module.write_cached("kind", KEY, b"said")
    (home / "kind" / ("b" * 64)).write_bytes((home / "kind" / KEY).read_bytes())
    assert cache_module.read_cached("kind", "b" * 64) is None


@pytest.mark.skipif(os.name == "nt", reason="files have no modes there")
def test_a_cache_is_its_owners_alone(cache):
    home = cache()
    cache_module.write_cached("kind", KEY, b"said")
    assert home.stat().st_mode & 0o077 == 0
    home.chmod(0o777)
    cache()
    assert cache_module.read_cached("kind", KEY) is None
    cache_module.write_cached("kind", "b" * 64, b"said")
    assert not (home / "kind" / ("b" * 64)).exists()


@pytest.mark.parametrize("home", ["/dev/null/nowhere", "/proc/nowhere"])
def test_without_a_cache_nothing_is_kept_and_nothing_is_said(cache, monkeypatch, home):
    monkeypatch.setenv("XDG_CACHE_HOME", home)
    cache()
    cache_module.write_cached("kind", KEY, b"said")
    assert cache_module.read_cached("kind", KEY) is None


def test_a_cache_is_never_begun_beside_the_user(cache, monkeypatch, tmp_path):
    monkeypatch.setattr("platformdirs.user_cache_path", lambda name: type(tmp_path)("~") / name)
    monkeypatch.chdir(tmp_path)
    cache()
    cache_module.write_cached("kind", KEY, b"said")
    assert list(tmp_path.iterdir()) == []


def test_what_a_wheel_brings_needs_no_cache(cache, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", "/dev/null/nowhere")
    cache()
    cache_module.write_entry(tmp_path / "shipped", "kind", KEY, b"said")
    assert cache_module.read_cached("kind", KEY) == b"said"


def test_what_is_old_is_swept_away_once_a_day(cache):
    home = cache()
    cache_module.write_cached("kind", KEY, b"said")
    old = time.time() - cache_module.OLD - 60
    os.utime(home / "kind" / KEY, (old, old))
    cache()
    cache_module.write_cached("kind", "b" * 64, b"said")
    assert cache_module.read_cached("kind", KEY) == b"said", "it was swept a moment ago"
    yesterday = time.time() - cache_module.PAUSE - 60
    os.utime(home / cache_module.SWEPT.format("kind"), (yesterday, yesterday))
    cache()
    cache_module.write_cached("kind", "c" * 64, b"said")
    left = {path.name for path in (home / "kind").iterdir()}
    assert left == {"b" * 64, "c" * 64}
