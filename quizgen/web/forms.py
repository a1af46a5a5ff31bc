"""Forms as they are posted: only with the token of our own pages."""

from __future__ import annotations

import secrets
from fractions import Fraction

from starlette.datastructures import FormData, UploadFile
from starlette.exceptions import HTTPException
from starlette.requests import Request

from quizgen.web.auth import csrf_token

LONGEST = 10_000
"""Characters of one field."""
MOST = 400
"""Fields of a form."""
LONGEST_ANSWER = 20_000
"""Characters of all fields of a part together."""


async def read_form(request: Request) -> FormData:
    """Return the form of a request, after checking its token and size.

    Raises
    ------
    HTTPException
        403 without the token, 400 where it is no form, or longer than any of ours.
    """
    form = await request.form(max_files=0, max_fields=MOST, max_part_size=LONGEST * 4)
    _check_form_token(request, form)
    for name, value in form.multi_items():
        if not isinstance(value, str) or len(value) > LONGEST or "\0" in name + value:
            raise HTTPException(400)
    return form


async def read_upload(request: Request, name: str) -> bytes:
    """Return the uploaded file of a form; empty bytes if there is none.

    Raises
    ------
    HTTPException
        403 without the token.
    """
    async with request.form(max_files=1, max_fields=5) as form:
        _check_form_token(request, form)
        sent = form.get(name)
        return await sent.read() if isinstance(sent, UploadFile) else b""


def _check_form_token(request: Request, form: FormData) -> None:
    """Raise HTTP 403 unless the form holds the session's token."""
    expected = csrf_token(request.state.token)
    if not secrets.compare_digest(field_text(form, "token").encode(), expected.encode()):
        raise HTTPException(403)


def field_text(form: FormData, name: str) -> str:
    """Return the text of a field; empty if there is none."""
    value = form.get(name, "")
    return value if isinstance(value, str) else ""


def field_texts(form: FormData, name: str) -> list[str]:
    """Return all texts of fields with a name, in order."""
    return [value for value in form.getlist(name) if isinstance(value, str)]


def read_ticked_criteria(form: FormData, part: str) -> dict[str, Fraction]:
    """Return the criteria of a part that are ticked, each with its share.

    That is a half where only the half is ticked.
    """
    halves = {name: Fraction(1, 2) for name in field_texts(form, f"half-{part}")}
    return halves | {name: Fraction(1) for name in field_texts(form, f"mark-{part}")}


def read_answer(form: FormData, name: str) -> list[str]:
    """Return all texts of the fields of a part, in order.

    Raises
    ------
    HTTPException
        413 where they are longer than any answer is.
    """
    values = field_texts(form, name)
    if sum(map(len, values)) > LONGEST_ANSWER:
        raise HTTPException(413)
    return values
