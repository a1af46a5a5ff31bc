"""Whether a typed expression of p, q, r has the values of a truth table."""

import re
from itertools import product

SPELT = {"and": "&∧*·^", "or": "|∨+v", "not": "¬!~-", "(": "([", ")": ")]"}
TOKEN = re.compile(
    r"\s*(and|or|not|und|oder|nicht|[pqrPQR]|\\[a-z]+|&&|\|\||[&∧*·^|∨+v¬!~()\[\]-])"
)
WORDS = {"und": "and", "oder": "or", "nicht": "not", "&&": "and", "||": "or",
         "\\land": "and", "\\lor": "or", "\\lnot": "not", "\\neg": "not"}  # fmt: skip
SIGNS = {sign: word for word, signs in SPELT.items() for sign in signs}


def check(values, answer):
    """Compare all eight rows."""
    tokens = split(answer)
    tree = parse(tokens) if tokens else None
    if tree is None or tokens:
        return None
    rows = product((True, False), repeat=3)
    typed = [tree(dict(zip("pqr", row, strict=True))) for row in rows]
    wrong = sum(one != bool(wanted) for one, wanted in zip(typed, values["value"], strict=True))
    if wrong == 8:
        return 0, "negated"
    return wrong == 0, "" if not wrong else "one-row" if wrong == 1 else "rows"


def split(answer):
    """Return the tokens of an expression; none if a piece of it is no token."""
    tokens, place = [], 0
    while place < len(answer.rstrip()):
        found = TOKEN.match(answer, place)
        if found is None or len(tokens) > 200:
            return []
        tokens.append(WORDS.get(found[1], SIGNS.get(found[1], found[1].lower())))
        place = found.end()
    return tokens


def parse(tokens, level=0):
    """Take what stands first off and return it as a function; None if it cannot be read."""
    if level == 2:
        first = tokens.pop(0) if tokens else ""
        if first in {"p", "q", "r"}:
            return lambda row: row[first]
        inner = parse(tokens, 2) if first == "not" else parse(tokens) if first == "(" else None
        if first == "not":
            return inner and (lambda row: not inner(row))
        return inner if tokens and tokens.pop(0) == ")" else None
    left = parse(tokens, level + 1)
    while left and tokens and tokens[0] == ("or", "and")[level]:
        del tokens[0]
        left = join(left, parse(tokens, level + 1), level)
    return left


def join(left, right, level):
    """Return the disjunction or conjunction of two functions; None if one is missing."""
    if right is None:
        return None
    return (
        (lambda row: left(row) and right(row)) if level else (lambda row: left(row) or right(row))
    )
