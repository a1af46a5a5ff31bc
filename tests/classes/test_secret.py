"""What is printed on a graded paper leads to no question, and to nothing but its student."""

from __future__ import annotations

import hashlib
import hmac

import pytest

from quizgen.classes.pseudonyms import form_seal, new_secret, student_code, student_seed
from quizgen.core.errors import PaperCodeError
from quizgen.paper.code import is_class_code, parse_code

SECRET = "000102030405060708090a0b0c0d0e0f"


def mac(text):
    return hmac.new(bytes(range(16)), text.encode(), hashlib.sha256)


def test_seeds_and_seals_are_message_authentication_codes():
    assert student_seed(SECRET, "104") == mac('["seed", "104"]').hexdigest()[:32]
    assert form_seal(SECRET, "104", "ab") == mac('["seal", "104", "ab"]').hexdigest()[:16]
    number = int(mac('["code", "104", "ab"]').hexdigest(), 16)
    last = "0123456789ABCDEFGHJKMNPQRSTVWXYZ"[number % 32]
    assert student_code(SECRET, "104", "ab").replace("-", "")[1] == last


def test_secrets_have_128_bits_and_none_comes_twice():
    assert len({new_secret() for _ in range(100)}) == 100
    assert {len(bytes.fromhex(new_secret())) for _ in range(9)} == {16}


def test_another_student_paper_or_secret_has_another_code():
    codes = {student_code(s, i, d) for s in (SECRET, new_secret()) for i in "12" for d in "ab"}
    assert len(codes) == 8
    assert all(map(is_class_code, codes))


@pytest.mark.parametrize("typed", ["G-7K2M-X9QD-4TWR-HZP8", " g-7k2m-x9qd-4twr-hzp8 "])
def test_a_graded_code_is_refused_with_a_sentence_where_an_open_one_is_wanted(typed):
    with pytest.raises(PaperCodeError, match="graded paper: it says whose paper it is"):
        parse_code(typed)
    assert not is_class_code("mock-1234-en-0a1b2c")
