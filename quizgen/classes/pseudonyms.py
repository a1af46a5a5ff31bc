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
    """128 bits, as 32 hexadecimal digits."""
    return secrets.token_hex(BYTES)


def student_seed(secret: str, *whose: str) -> str:
    """A seed of 128 bits: that of a student by the id, that of the class without."""
    return _compute_mac(secret, "seed", *whose)[:BYTES].hex()


def student_code(secret: str, student: str, digest: str) -> str:
    """What is printed on a paper: ``G-7K2M-X9QD-4TWR-HZP8``.

    Parameters
    ----------
    secret : str
    student : str
        The id.
    digest : str
        Of what the paper asks.
    """
    number = int.from_bytes(_compute_mac(secret, "code", student, digest), "big")
    signs = "".join(SIGNS[(number >> 5 * place) % len(SIGNS)] for place in range(GROUP * GROUPS))
    return "-".join([GRADED, *(signs[at : at + GROUP] for at in range(0, len(signs), GROUP))])


def form_seal(secret: str, student: str, digest: str) -> str:
    """What forms bear in place of a paper's digest, which would confirm guesses at its numbers."""
    return _compute_mac(secret, "seal", student, digest)[:8].hex()


def _compute_mac(secret: str, *words: str) -> bytes:
    return hmac.new(bytes.fromhex(secret), json.dumps(words).encode(), hashlib.sha256).digest()
