"""What happens to a server, as lines to read or as JSON: never what was asked, typed or answered.

In: the name of an event and its fields. Out: a line on the standard error. Must never know: pages.
"""

from __future__ import annotations

import json
import logging
import traceback
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

FORMS = ("plain", "json")
_LOG = logging.getLogger("quizgen.events")
_FIELDS = "event_fields"


def log_event(name: str, level: int = logging.INFO, **fields: object) -> None:
    """Log an event with its fields.

    Parameters
    ----------
    name : str
    level : int
        As ``logging`` has them.
    **fields
        Numbers of learners and addresses at most: no names, no text of anybody.
    """
    _LOG.log(level, name, extra={_FIELDS: fields})


def find_cause(error: BaseException) -> dict[str, object]:
    """Return type and place of an error, without its message: that may hold answers."""
    found: dict[str, object] = {"error": type(error).__name__}
    database = getattr(error, "orig", None)  # SQLAlchemy's: what the database said, by its code
    code = getattr(database, "sqlite_errorname", None) or getattr(database, "sqlstate", None)
    if database is not None:
        found["database"] = code or type(database).__name__
    frames = traceback.extract_tb(error.__traceback__)
    found["at"] = [f"{Path(one.filename).name}:{one.lineno}" for one in frames[-8:]]
    return found


def set_up_log(form: str) -> None:
    """Log events of quizgen and uvicorn to standard error.

    Parameters
    ----------
    form : str
        One of ``FORMS``.
    """
    handler = logging.StreamHandler()
    handler.setFormatter(_Json() if form == "json" else _Plain())
    for name, level in (("quizgen", logging.INFO), ("uvicorn", logging.WARNING)):
        log = logging.getLogger(name)
        log.handlers, log.propagate = [handler], False
        log.setLevel(level)


class _Plain(logging.Formatter):
    """Formats a record as a line of names and values."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        fields = _get_event_fields(record)
        told = [f"{name}={_quote_value(value)}" for name, value in fields.items()]
        return " ".join([_format_time(record), record.levelname, record.getMessage(), *told])


class _Json(logging.Formatter):
    """Formats a record as a line of JSON."""

    def format(self, record: logging.LogRecord) -> str:
        """Return the line."""
        head = {
            "time": _format_time(record),
            "level": record.levelname,
            "event": record.getMessage(),
        }
        return json.dumps({**head, **_get_event_fields(record)}, ensure_ascii=False, default=str)


def _get_event_fields(record: logging.LogRecord) -> dict[str, Any]:
    """Return the fields of an event, with the cause of its error if it has one."""
    fields: dict[str, Any] = dict(getattr(record, _FIELDS, {}))
    if record.exc_info and record.exc_info[1] is not None:
        fields |= find_cause(record.exc_info[1])
    return fields


def _format_time(record: logging.LogRecord) -> str:
    """Return the time of a record in UTC, as ISO 8601 with milliseconds."""
    return datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds")


def _quote_value(value: object) -> str:
    """Return a value as text without blanks; quoted if it has any."""
    if isinstance(value, list):
        return ",".join(map(str, value))
    text = str(value)
    return json.dumps(text) if not text or set(text) & set(' "=\n') else text
