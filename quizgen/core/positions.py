"""Where in a file something stands: keys and texts of TOML, lists of Markdown, calls of Python.

A place is said in the words of the file: in TOML the path of a key (``("part", 0, "answer")``), in
Markdown a heading and the name of an item of its list (``("steps", "F")``), in Python a function
and its first argument (``("Step", "F")``) or a keyword and a text in it (``("traps", "added")``).
``(TEXT, "m*a")`` is the first text that is this one, in TOML and Markdown; in Markdown a number
behind it is the column in the text, from 1.

``tomllib`` gives no positions and ``tomlkit`` keeps none, hence the scan below. It is asked only
for what was read without error, or up to the line that could not be read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

if TYPE_CHECKING:
    import ast

Place = tuple[str | int, ...]

TEXT = "\0text"
"""Begins a place that is a text. No key and no heading can be called so."""


class Span(msgspec.Struct, frozen=True):
    """Line and column, both from 1, at which something begins."""

    line: int
    column: int = 1


def find_span(file: Path, place: Place) -> Span | None:
    """Return line and column of a place in a file, or None.

    For a missing place they are those of the nearest table, list or heading that holds it.

    Parameters
    ----------
    file : pathlib.Path
        Of TOML, Markdown or Python, by its suffix; in others nothing is found.
    place : tuple of str or int
        In the words of the file, as the top of this module explains.
    """
    if not place or file.suffix not in _FINDERS:
        return None
    try:
        text = file.read_bytes().decode("utf-8-sig")
        return _FINDERS[file.suffix](text.replace("\r\n", "\n").replace("\r", "\n"), place)
    except (OSError, ValueError, SyntaxError):
        return None


# TOML ---------------------------------------------------------------------------------------------

_BLANK = re.compile(r"(?:[ \t\n]|#[^\n]*)*")
_STRING = re.compile(
    r'"""(?P<a>(?:[^\\]|\\.)*?"{0,2})"""(?!")'
    r"|'''(?P<b>.*?'{0,2})'''(?!')"
    r'|"(?P<c>(?:[^"\\\n]|\\.)*)"'
    r"|'(?P<d>[^'\n]*)'",
    re.DOTALL,
)
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_ATOM = re.compile(r"[^,\]}#\n]*")
_ESCAPE = re.compile(r'\\(["\\])')


class TomlPositions:
    """The offsets of the keys, list items and texts of a TOML document, as far as it can be read.

    Parameters
    ----------
    text : str
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.keys: dict[Place, int] = {}
        self.texts: dict[str, int] = {}
        self._at = 0
        # ``[[part]]`` counts its tables, and ``[part.answer]`` speaks of the last one.
        self._counts: dict[Place, int] = {}
        with suppress(_ScanError, RecursionError):  # what stands before it is known
            self._scan()

    def find(self, place: Place) -> Span | None:
        """Return the span of a key or a text, or None.

        For a missing key it is the span of the table that would hold it.
        """
        if place[0] == TEXT:
            offset = self.texts.get(str(place[1]))
            return None if offset is None else _compute_span(self.text, offset)
        for end in range(len(place), 0, -1):
            if place[:end] in self.keys:
                return _compute_span(self.text, self.keys[place[:end]])
        return None

    def _scan(self) -> None:
        """Read the whole text and fill ``keys`` and ``texts``."""
        table: Place = ()
        while self._skip_blank() < len(self.text):
            if self._is_next("[["):
                table = self._read_table_header("]]")
            elif self._is_next("["):
                table = self._read_table_header("]")
            else:
                self._read_pair(table)

    def _skip_blank(self) -> int:
        """Pass over blanks and comments, and return the offset of what follows."""
        found = _BLANK.match(self.text, self._at)
        self._at = found.end() if found else self._at
        return self._at

    def _is_next(self, mark: str) -> bool:
        """Return whether ``mark`` follows, and pass over it if so."""
        if not self.text.startswith(mark, self._at):
            return False
        self._at += len(mark)
        return True

    def _expect(self, mark: str) -> None:
        """Pass over blanks and ``mark``; raise ``_ScanError`` if something else follows."""
        self._skip_blank()
        if not self._is_next(mark):
            raise _ScanError

    def _read_table_header(self, closing: str) -> Place:
        """Return the path of ``[table]`` or ``[[table]]``, counted if it is one of an array."""
        begin = self._at - len(closing)
        path: Place = ()
        names = self._read_dotted_key()
        for depth, name in enumerate(names):
            path = (*path, name)
            last = depth == len(names) - 1
            self.keys.setdefault(path, begin)
            if last and closing == "]]":
                self._counts[path] = self._counts.get(path, -1) + 1
            if path in self._counts:
                path = (*path, self._counts[path])
                self.keys.setdefault(path, begin)
        self._expect(closing)
        return path

    def _read_dotted_key(self) -> list[str]:
        """Return the names of a key such as ``answer.unit``."""
        names = [self._read_key_name()]
        while self._skip_blank() < len(self.text) and self._is_next("."):
            names.append(self._read_key_name())
        return names

    def _read_key_name(self) -> str:
        """Return one bare or quoted name of a key."""
        self._skip_blank()
        found = _STRING.match(self.text, self._at) or _BARE.match(self.text, self._at)
        if found is None:
            raise _ScanError
        self._at = found.end()
        return _decode_string(found) if found.re is _STRING else found[0]

    def _read_pair(self, table: Place) -> None:
        """Read ``key = value`` of the table whose path is given."""
        begin, path = self._at, table
        for name in self._read_dotted_key():
            path = (*path, name)
            self.keys.setdefault(path, begin)
        self._expect("=")
        self._read_value(path)

    def _read_value(self, path: Place) -> None:
        """Read a value and note its offset under its path, with all that is inside it."""
        begin = self._skip_blank()
        self.keys.setdefault(path, begin)
        if self._is_next("["):
            for count in self._iter_entry_indices("]"):
                self._read_value((*path, count))
        elif self._is_next("{"):
            for _ in self._iter_entry_indices("}"):
                self._read_pair(path)
        elif found := _STRING.match(self.text, begin):
            self._at = found.end()
            self.texts.setdefault(_decode_string(found), begin)
        elif found := _ATOM.match(self.text, begin):
            self._at = found.end()

    def _iter_entry_indices(self, closing: str) -> Iterator[int]:
        """Yield 0, 1 and so on, once for each entry before a closing bracket.

        The caller reads the entry each time.
        """
        count = 0
        while self._skip_blank() < len(self.text) and not self._is_next(closing):
            yield count
            count += 1
            self._skip_blank()
            if not self._is_next(",") and not self.text.startswith(closing, self._at):
                raise _ScanError


class _ScanError(Exception):
    """Raised where the text is not TOML; what was scanned before it stays usable."""


def _decode_string(found: re.Match[str]) -> str:
    """Return the text of a TOML string; of the escapes only quote and backslash are undone."""
    kind = str(found.lastgroup)
    text = found[kind]
    if kind in "ab":
        text = text.removeprefix("\n")
    return _ESCAPE.sub(r"\1", text) if kind in "ac" else text


def _compute_span(text: str, offset: int) -> Span:
    """Return line and column, both from 1, of an offset in a text."""
    return Span(text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset))


@lru_cache(maxsize=64)
def _scan_toml(text: str) -> TomlPositions:
    """Return the positions of a TOML text, kept for the next question about the same file."""
    return TomlPositions(text)


def _find_in_toml(text: str, place: Place) -> Span | None:
    """Return where a TOML text has a key or a text."""
    return _scan_toml(text).find(place)


# Markdown -----------------------------------------------------------------------------------------

_HEADING = re.compile(r"^## +(\S.*?)\s*$")
_ITEM = re.compile(r"^- ([^:\[]*?)\s*(?:\[[^\]]*\])?\s*:")


def _find_in_markdown(text: str, place: Place) -> Span | None:
    """Return the line of a list item, else of the heading above it, or of a quoted sentence."""
    if place[0] == TEXT:
        return _find_quoted_text(text, str(place[1]), int(place[2]) if len(place) > 2 else 1)
    heading, found = "", None
    for number, line in enumerate(text.split("\n"), 1):
        if head := _HEADING.match(line):
            heading = head[1]
            found = Span(number) if (heading,) == place[:1] and found is None else found
        elif (item := _ITEM.match(line)) and (heading, item[1]) == place[:2]:
            return Span(number)
    return found


def _find_quoted_text(text: str, quoted: str, column: int) -> Span | None:
    """Return where a sentence, or a column in it, is in a text that breaks lines elsewhere."""
    found = re.search(_match_any_blanks(quoted), text) if quoted.strip() else None
    if found is None:
        return None
    before = re.match(_match_any_blanks(quoted[: column - 1]) + r"\s*", text[found.start() :])
    return _compute_span(text, found.start() + (before.end() if before and column > 1 else 0))


def _match_any_blanks(quoted: str) -> str:
    """Return a pattern for a text, whatever blanks stand in it."""
    return r"\s*".join([re.escape(part) for part in re.findall(r"\w+|[^\w\s]", quoted)])


# Python -------------------------------------------------------------------------------------------


def _find_in_python(text: str, place: Place) -> Span | None:
    """Return where a call has this first argument, or a keyword holds this text."""
    import ast

    tree = ast.parse(text)
    inside, name = str(place[0]), str(place[-1])
    variables = {name, *_iter_symbol_variables(tree, name)}
    keywords = [node for node in ast.walk(tree) if isinstance(node, ast.keyword)]
    # What replaces a step is another one of the same name.
    others = [word for word in keywords if word.arg in {"traps", "alternatives"}]
    replaced = {id(n) for word in others for n in ast.walk(word)}
    here = [n for word in others if word.arg == inside for n in ast.walk(word)]
    right = [n for n in ast.walk(tree) if id(n) not in replaced]
    calls = [n for n in (here or right) if isinstance(n, ast.Call)]
    found: list[ast.AST] = [
        call for call in calls if _get_callee_name(call) == ("Step" if here else inside)
        and call.args and isinstance(call.args[0], ast.Name) and call.args[0].id in variables
    ]  # fmt: skip
    found += [
        n for word in keywords if word.arg == inside for n in _iter_matching_constants(word, name)
    ]
    return next((Span(n.lineno, n.col_offset + 1) for n in found), None)  # type: ignore[attr-defined]


def _get_callee_name(call: ast.Call) -> str:
    """Return the last name of what is called: ``Step`` in ``Step(...)`` and ``model.Step(...)``."""
    return str(getattr(call.func, "id", "") or getattr(call.func, "attr", ""))


def _iter_matching_constants(node: ast.AST, text: str) -> Iterator[ast.AST]:
    """Yield the constants inside a syntax node that equal a text."""
    import ast

    for inner in ast.walk(node):
        if isinstance(inner, ast.Constant) and inner.value == text:
            yield inner


def _iter_symbol_variables(tree: ast.AST, symbol: str) -> Iterator[str]:
    """Yield the Python names of a symbol.

    In ``f, image = symbols("f z'")`` that of ``z'`` is ``image``.
    """
    import ast

    for node in ast.walk(tree):
        if not (isinstance(node, ast.Assign) and isinstance(node.value, ast.Call)):
            continue
        first = node.value.args[0] if node.value.args else None
        if isinstance(first, ast.Constant) and isinstance(first.value, str):
            target = node.targets[0]
            names = target.elts if isinstance(target, ast.Tuple) else [target]
            for variable, name in zip(names, re.split(r"[,\s]+", first.value), strict=False):
                if name == symbol and isinstance(variable, ast.Name):
                    yield variable.id


_FINDERS = {".toml": _find_in_toml, ".md": _find_in_markdown, ".py": _find_in_python}
