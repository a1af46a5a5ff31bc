"""A truth table of three statements, and two expressions for it."""

from itertools import product

ROWS = list(product((1, 0), repeat=3))


def draw(rng):
    """Return the columns of a table with two to six ones, and its normal forms."""
    value = [int(one) for one in rng.integers(0, 2, 8)]
    if not 2 <= sum(value) <= 6:
        return None
    columns = [["1" if one else "0" for one in column] for column in zip(*ROWS, strict=True)]
    table = dict(zip("pqr", columns, strict=True)) | {"value": value}
    return {"t": table, "key": normal_form(value, 1), "other": normal_form(value, 0)}


def normal_form(value, wanted):
    """Return the disjunctive form for 1, the conjunctive one for 0."""
    inner, outer = (" and ", " or ") if wanted else (" or ", " and ")
    terms = []
    for row, one in zip(ROWS, value, strict=True):
        if one == wanted:
            signs = ["" if cell == wanted else "not " for cell in row]
            pieces = [sign + name for sign, name in zip(signs, "pqr", strict=True)]
            terms.append(f"({inner.join(pieces)})")
    return outer.join(terms)
