"""The secret of a class, and what follows from it: seeds, codes, and nothing back.

Every number of every paper follows from 128 bits that stay with the examiner. What is printed on a
paper is a message authentication code (HMAC-SHA-256, cut to 80 bits): it tells who has the secret
whose paper this is and that nothing in it has changed, and tells nobody else anything.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import secrets

from quizgen.paper.code import GRADED, GROUP, GROUPS, SIGNS

BYTES = 16


def new_secret() -> str:
    """Return a new random secret of 128 bits, as 32 hexadecimal digits."""
    return secrets.token_hex(BYTES)


def student_seed(secret: str, *whose: str) -> str:
    """Return a seed of 128 bits in hexadecimal: of a student by the id, of the class without."""
    return student_mac(secret, "seed", *whose)[:BYTES].hex()


def student_code(secret: str, student: str, digest: str) -> str:
    """Return the code printed on a student's paper, such as ``G-7K2M-X9QD-4TWR-HZP8``.

    Parameters
    ----------
    secret : str
    student : str
        The id.
    digest : str
        Of what the paper asks.
    """
    number = int.from_bytes(student_mac(secret, "code", student, digest), "big")
    signs = "".join(SIGNS[(number >> 5 * place) % len(SIGNS)] for place in range(GROUP * GROUPS))
    return "-".join([GRADED, *(signs[at : at + GROUP] for at in range(0, len(signs), GROUP))])


def form_seal(secret: str, student: str, digest: str) -> str:
    """Return 16 hexadecimal digits that forms bear instead of the paper's digest.

    The digest would confirm guesses at the numbers to a student who can compute it.
    """
    return student_mac(secret, "seal", student, digest)[:8].hex()


def sheet_seal(secret: str, code: str, version: int, page: int) -> str:
    """Return 8 hexadecimal digits in capitals that sign a page of an answer sheet."""
    return student_mac(secret, "sheet", code, str(version), str(page))[:4].hex().upper()


def student_mac(secret: str, *words: str) -> bytes:
    """Return the HMAC-SHA-256 of some words under the secret (32 bytes)."""
    return hmac.new(bytes.fromhex(secret), json.dumps(words).encode(), hashlib.sha256).digest()
