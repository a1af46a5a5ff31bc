"""Values of a stated type, made of tables and of JSON, by one thread or by many.

msgspec describes a type when it is first used. A second thread that uses it meanwhile meets half a
description, and the process ends: with msgspec 0.22, in six runs of six where eight threads began
with a new type. So a type is described under a lock, with all that it holds.
"""

from __future__ import annotations

from functools import cache
from threading import Lock
from typing import Any, TypeVar

import msgspec

T = TypeVar("T")

_LOCK = Lock()


def prepare_type(shape: Any) -> None:
    """Have a type described before anything else is done with it."""
    _prepare_decoder_type(shape)


def convert(table: object, shape: type[T]) -> T:
    """A table as a value of a type, checked.

    Raises
    ------
    msgspec.ValidationError
        If it is none.
    """
    prepare_type(shape)
    return msgspec.convert(table, shape)


def json_decoder(shape: type[T]) -> msgspec.json.Decoder[T]:
    """What reads values of a type from JSON."""
    asked: Any = shape
    found: msgspec.json.Decoder[T] = _build_json_decoder(asked)
    return found


def decode_json(data: bytes | str, shape: type[T]) -> T:
    """A value of a type that stands in JSON, checked.

    Raises
    ------
    msgspec.DecodeError
        If it is none.
    """
    return json_decoder(shape).decode(data)


@cache
def _prepare_decoder_type(shape: Any) -> None:
    with _LOCK:
        msgspec.msgpack.Decoder(shape)


@cache
def _build_json_decoder(shape: Any) -> msgspec.json.Decoder[Any]:
    prepare_type(shape)
    return msgspec.json.Decoder(shape)
