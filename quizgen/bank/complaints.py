"""What is wrong in an authored table, in words an author knows."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, get_args, get_origin, get_type_hints

import msgspec

_TYPES = {
    "int": "a whole number",
    "float": "a number",
    "str": 'a text in "quotes"',
    "bool": "true or false",
    "array": "a list [...]",
    "object": "a table",
    "null": "",
}
_GOT = _TYPES | {"str": "a text", "array": "a list", "bool": "true or false"}
_PLACE = re.compile(r" - at `(?:key in )?\$\.?(.*)`$")
_EXPECTED = re.compile(r"Expected `(.*)`, got `(.*)`$")
_UNKNOWN = re.compile(r"Object contains unknown field `(.*)`$")
_MISSING = re.compile(r"Object missing required field `(.*)`$")
_NONE_OF = re.compile(r"Invalid enum value '?(.*?)'?$")
_INDEX = re.compile(r"\[(\d+|\.\.\.)\]")


def explain_validation_error(error: Exception, kind: type[msgspec.Struct]) -> str:
    """What msgspec says of a table that should be of a kind: key, what is there, what may be.

    Parameters
    ----------
    error : Exception
        Any but msgspec's are handed on as they are.
    kind : type
        What the table was converted to.
    """
    text = str(error)
    if not isinstance(error, msgspec.ValidationError):
        return text
    found = _PLACE.search(text)
    path = found[1] if found else ""
    what = _explain_type_error(text[: found.start()] if found else text, _kind_at(kind, path))
    return f"{_format_path(path)}: {what}" if path else what


def _format_path(path: str) -> str:
    """``part[0].points`` as ``part 1: points``: as it is counted by people."""
    parts = re.sub(r"^part\[(\d+)\]\.?", lambda m: f"part {int(m[1]) + 1}: ", path)
    return _INDEX.sub(lambda m: "" if m[1] == "..." else f" {int(m[1]) + 1}", parts).rstrip(": ")


def _explain_type_error(text: str, kind: object) -> str:
    if match := _EXPECTED.match(text):
        wanted = (_TYPES.get(name, name) for name in match[1].split(" | "))
        got = _GOT.get(match[2], match[2])
        return f"{got} stands there, {' or '.join(filter(None, wanted))} is expected"
    if match := _UNKNOWN.match(text):
        known = _list_allowed_keys(kind)
        return f"unknown key {match[1]!r}{_suggest_name(match[1], known)}"
    if match := _MISSING.match(text):
        return f"the key {match[1]!r} is missing"
    if match := _NONE_OF.match(text):
        allowed = list(map(str, _list_allowed_values(kind)))
        return f"{match[1]!r} is not allowed{_suggest_name(match[1], allowed)}"
    return text


def _suggest_name(name: str, known: Iterable[str]) -> str:
    allowed = sorted(known)
    from difflib import get_close_matches

    close = get_close_matches(name, allowed, 1)
    meant = f"; did you mean {close[0]!r}?" if close else ""
    return f"{meant} (allowed: {', '.join(allowed)})" if allowed else meant


def _list_allowed_keys(kind: object) -> list[str]:
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        names = (field.encode_name for field in msgspec.structs.fields(kind))
        return [name for name in names if not name.startswith("/")]
    return []


def _list_allowed_values(kind: object) -> tuple[Any, ...]:
    inside = [value for one in get_args(kind) for value in (get_args(one) or (one,))]
    return tuple(value for value in inside if isinstance(value, str))


def _kind_at(kind: object, path: str) -> object:
    """The type that stands at a path."""
    for step in re.findall(r"\[\d*(?:\.\.\.)?\]|[^.\[\]]+", path):
        kind = _find_type_at_step(kind, step)
    return _struct_in(kind)


def _find_type_at_step(kind: object, step: str) -> object:
    kind = _struct_in(kind)
    if step.startswith("["):
        args = [one for one in get_args(kind) if one is not Ellipsis]
        return args[-1] if args else None
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        names = {f.encode_name: f.name for f in msgspec.structs.fields(kind)}
        return get_type_hints(kind).get(names.get(step, step))
    return None


def _struct_in(kind: object) -> object:
    """The table among several types, else the types."""
    for one in get_args(kind) if get_origin(kind) not in {dict, tuple, list} else ():
        if isinstance(one, type) and issubclass(one, msgspec.Struct):
            return one
        if get_origin(one) in {dict, tuple, list}:
            return one
    return kind
