"""What is wrong in an authored table, in words an author knows."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, get_args, get_origin, get_type_hints

import msgspec

from quizgen.core.decoding import convert
from quizgen.core.errors import BankError
from quizgen.core.positions import Place

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
_STEP = re.compile(r"\[(\d+)\]|\[(\.\.\.)\]|([^.\[\]]+)")


def complaint_of(
    error: Exception, kind: object, table: object = None, before: Place = ()
) -> BankError:
    """Return a ``BankError`` that says in an author's words why a table is not of a type.

    msgspec names a path and two types; the error names the key, what stands there, what is allowed
    and the name that was probably meant.

    Parameters
    ----------
    error : Exception
        What the conversion raised; one that is not msgspec's keeps its message.
    kind : type
        The type that the table was converted to.
    table : object
        The table itself, to find the faulty key: of a mapping msgspec says only ``[...]``.
    before : tuple of str or int
        Where the table stands in its file.
    """
    text = str(error)
    if not isinstance(error, msgspec.ValidationError):
        return BankError(text, rule="QG100", place=before)
    found = _PLACE.search(text)
    place = _parse_msgspec_path(found[1] if found else "", kind, table)
    rule, what, key = _explain_type_error(
        text[: found.start()] if found else text, _find_type_at_place(kind, place)
    )
    name = key or (place[-1] if place else "")
    if len((*before, *place)) > (not key) and name in getattr(kind, "__struct_encode_fields__", ()):
        what += f"; {name!r} of the whole file stands above its first [table]"
    said = written_place((*before, *place))
    whole = (*before, *place, *([key] if key else []))
    return BankError(f"{said}: {what}" if said else what, rule=rule, place=whole)


def written_place(place: Place) -> str:
    """Return a place as people count it: ``("part", 0, "points")`` is ``part 1: points``."""
    text = ""
    for step in place:
        text += f" {step + 1}" if isinstance(step, int) else f".{step}"
    return re.sub(r"^part (\d+)\.?", r"part \1: ", text.removeprefix(".")).rstrip(": ")


def _parse_msgspec_path(path: str, kind: object, table: object) -> Place:
    """Return the keys and indices of msgspec's path (``.part[0].points``).

    For ``[...]``, any key of a mapping, the first one is taken whose value does not convert.
    """
    place: list[str | int] = []
    for number, dots, name in _STEP.findall(path):
        step: str | int | None = int(number) if number else name or None
        if dots:
            inside = _find_type_at_step(_find_type_at_place(kind, tuple(place)), "...")
            step = next(
                (key for key, value in _iter_items(table) if not _is_convertible(value, inside)),
                None,
            )
        if step is None:
            break
        place.append(step)
        table = dict(_iter_items(table)).get(step)
    return tuple(place)


def _iter_items(table: object) -> Iterable[tuple[Any, object]]:
    """Return the (key, value) pairs of a table or the (index, value) pairs of a list; else none."""
    if isinstance(table, dict):
        return table.items()
    return enumerate(table) if isinstance(table, list | tuple) else ()


def _is_convertible(value: object, kind: Any) -> bool:
    """Return whether msgspec can convert a value to a type."""
    try:
        convert(value, kind)
    except msgspec.ValidationError:
        return False
    return True


def _explain_type_error(text: str, kind: object) -> tuple[str, str, str]:
    """Return code, message and the unknown key that one message of msgspec is about (or "")."""
    if match := _EXPECTED.match(text):
        wanted = (_TYPES.get(name, name) for name in match[1].split(" | "))
        got = _GOT.get(match[2], match[2])
        expected = " or ".join(filter(None, wanted))
        return "QG106", f"{got} stands there, {expected} is expected", ""
    if match := _UNKNOWN.match(text):
        known = _list_allowed_keys(_choose_container(kind))
        return "QG104", f"unknown key {match[1]!r}{_suggest_name(match[1], known)}", match[1]
    if match := _MISSING.match(text):
        return "QG105", f"the key {match[1]!r} is missing", ""
    if match := _NONE_OF.match(text):
        lists = ["[...]"] if get_origin(_choose_container(kind)) in {tuple, list} else []
        allowed = [*map(str, _list_allowed_values(kind)), *lists]
        return "QG107", f"{match[1]!r} is not allowed{_suggest_name(match[1], allowed)}", ""
    return "QG106", text, ""


def _suggest_name(name: str, known: Iterable[str]) -> str:
    """Return the end of a message: the closest known name, and all that are allowed."""
    allowed = sorted(known)
    from difflib import get_close_matches

    close = get_close_matches(name, allowed, 1)
    meant = f"; did you mean {close[0]!r}?" if close else ""
    return f"{meant} (allowed: {', '.join(allowed)})" if allowed else meant


def _list_allowed_keys(kind: object) -> list[str]:
    """Return the keys that a table of this type may have; none if it is no Struct."""
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        names = (field.encode_name for field in msgspec.structs.fields(kind))
        return [name for name in names if not name.startswith("/")]
    return []


def _list_allowed_values(kind: object) -> tuple[Any, ...]:
    """Return the texts that a ``Literal``, or a union of them, allows."""
    inside = [value for one in get_args(kind) for value in (get_args(one) or (one,))]
    return tuple(value for value in inside if isinstance(value, str))


def _find_type_at_place(kind: object, place: Place) -> object:
    """Return the type that a Struct has at a place, such as its first part's answer."""
    for step in place:
        kind = _find_type_at_step(kind, step)
    return kind


def _find_type_at_step(kind: object, step: str | int) -> object:
    """Return the type of one key or item of a type; None if the type has no such key."""
    kind = _choose_container(kind)
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        names = {f.encode_name: f.name for f in msgspec.structs.fields(kind)}
        return get_type_hints(kind).get(names.get(str(step), str(step)))
    args = [one for one in get_args(kind) if one is not Ellipsis]
    return args[-1] if args else None


def _choose_container(kind: object) -> object:
    """Return the Struct, dict, list or tuple among a union's members, else the type itself."""
    for one in get_args(kind) if get_origin(kind) not in {dict, tuple, list} else ():
        if isinstance(one, type) and issubclass(one, msgspec.Struct):
            return one
        if get_origin(one) in {dict, tuple, list}:
            return one
    return kind
