"""One answer from the fields that a page has for it, as it would have been typed in one line."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from quizgen.kinds.contract import InputControl

_BETWEEN = "; "


def join_fields(control: InputControl, values: Sequence[str], marks: Sequence[str] = ()) -> str:
    """Return the values of a part's fields as one typed answer; empty if all are blank.

    Pages have several fields for a part, and grading reads one line, the same as in a terminal.

    Parameters
    ----------
    control : InputControl
        How the part is answered.
    values : sequence of str
        What stands in its fields in their order: the ticked marks, for pairs the mark of a target
        per option, for an order the mark at each place.
    marks : sequence of str
        Marks of the options that pairs begin with.
    """
    filled = [value.strip() for value in values]
    if not any(filled):
        return ""
    join = _JOINED.get(control.form)
    if join is not None:
        return join(filled, marks)
    if len(filled) == 1:
        return filled[0]
    return _BETWEEN.join(before + value for _, before, value in _locate_values(control, filled))


def _locate_values(control: InputControl, filled: Sequence[str]) -> list[tuple[int, str, str]]:
    """Return index, prefix (such as ``x = ``) and value of each field that is joined."""
    if not control.named:
        return [(place, "", value) for place, value in enumerate(filled)]
    named = enumerate(zip(control.boxes, filled, strict=False))
    return [(place, f"{box.name} = ", value) for place, (box, value) in named if value]


def locate_in_fields(control: InputControl, values: Sequence[str], column: int) -> tuple[int, int]:
    """Return the index of a field and the column in it for a column of the joined line.

    An error is located in the joined line, and a page marks the field that it is in.

    Parameters
    ----------
    control : InputControl
        Of a part with several boxes.
    values : sequence of str
        What stands in them; not all of it blank.
    column : int
        From 1.
    """
    begin, found = 0, (0, 1)
    for place, before, value in _locate_values(control, [value.strip() for value in values]):
        begin += len(before)
        blanks = len(values[place]) - len(values[place].lstrip())
        found = place, max(1, column - begin) + blanks
        begin += len(value)
        if column <= begin + 1:
            break
        begin += len(_BETWEEN)
    return found


def is_complete(control: InputControl, values: Sequence[str], marks: Sequence[str] = ()) -> bool:
    """Return whether all fields of a part are filled, of one with a single field that one.

    Parameters
    ----------
    control : InputControl
    values : sequence of str
        What stands in its fields.
    marks : sequence of str
        Marks of the options that pairs begin with.
    """
    there = [bool(value.strip()) for value in values]
    if control.has_several_fields:
        return all(there) and len(there) >= max(len(control.boxes), len(marks), 1)
    return any(there)


def _join_as_list(filled: list[str], _marks: Sequence[str]) -> str:
    """Return marks as they are typed for a choice: ``A, C``."""
    return ", ".join(filter(None, filled))


def _join_as_pairs(filled: list[str], marks: Sequence[str]) -> str:
    """Return pairs as they are typed: ``1:B, 2:A``; options without a target are left out."""
    pairs = zip(marks, filled, strict=False)
    return ", ".join(f"{mark}:{chosen}" for mark, chosen in pairs if chosen)


def _join_as_order(filled: list[str], _marks: Sequence[str]) -> str:
    """Return marks as they are typed for an order: ``B A C``."""
    return " ".join(filter(None, filled))


_JOINED: dict[str, Callable[[list[str], Sequence[str]], str]] = {
    "one": _join_as_list,
    "many": _join_as_list,
    "truth": _join_as_list,
    "pairs": _join_as_pairs,
    "order": _join_as_order,
}
"""Forms whose fields hold marks, and how these are typed."""
