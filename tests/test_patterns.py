"""Patterns that wait to be asked are the ones of ``re``, and every one in the package compiles."""

import ast
import importlib
import re
from pathlib import Path

import pytest

import quizgen
from quizgen.patterns import lazy

PACKAGE = Path(quizgen.__file__).parent


def test_it_answers_as_a_compiled_pattern_does():
    asked, compiled = lazy(r"(?P<a>\d+)-", re.IGNORECASE), re.compile(r"(?P<a>\d+)-", re.IGNORECASE)
    assert asked.pattern == compiled.pattern
    assert asked.flags == compiled.flags
    assert asked.groupindex == compiled.groupindex
    assert asked.sub("x", "12-3-") == compiled.sub("x", "12-3-") == "xx"
    assert asked.match("12-")["a"] == "12"


def test_it_waits_to_be_asked():
    wrong = lazy("(")
    with pytest.raises(re.error, match="missing"):
        wrong.match("x")


def test_every_pattern_of_the_package_compiles():
    found = 0
    for path in PACKAGE.rglob("*.py"):
        calls = [
            node
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Assign)
            and isinstance(node.value, ast.Call)
            and getattr(node.value.func, "id", "") == "lazy"
        ]
        name = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
        for node in calls:
            module = importlib.import_module(name)
            assert getattr(module, node.targets[0].id).flags
            found += 1
    assert found > 100
