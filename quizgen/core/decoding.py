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
    """Have msgspec describe a type, under a lock, before several threads use it."""
    _prepare_decoder_type(shape)


def convert(table: object, shape: type[T]) -> T:
    """Return a table as a checked value of a type.

    Raises
    ------
    msgspec.ValidationError
        If it is none.
    """
    prepare_type(shape)
    return msgspec.convert(table, shape)


def json_decoder(shape: type[T]) -> msgspec.json.Decoder[T]:
    """Return the decoder of JSON to values of a type, one for each type and process."""
    asked: Any = shape
    found: msgspec.json.Decoder[T] = _build_json_decoder(asked)
    return found


def decode_json(data: bytes | str, shape: type[T]) -> T:
    """Return the checked value of a type that JSON describes.

    Raises
    ------
    msgspec.DecodeError
        If it is none.
    """
    return json_decoder(shape).decode(data)


@cache
def _prepare_decoder_type(shape: Any) -> None:
    """Describe a type once: any decoder does it, and this one is thrown away."""
    with _LOCK:
        msgspec.msgpack.Decoder(shape)


@cache
def _build_json_decoder(shape: Any) -> msgspec.json.Decoder[Any]:
    """Return a new decoder of a type that was described under the lock."""
    prepare_type(shape)
    return msgspec.json.Decoder(shape)
