"""What a draw takes of a pool: as many as asked, never twice, every one some time, evenly."""

from __future__ import annotations

from collections import Counter
from itertools import combinations

import pytest

from quizgen.bank.bank import Bank
from quizgen.bank.pools import count_pool_variants, select_from_pool, selected_claims
from quizgen.bank.variant import draw_variant
from quizgen.core.errors import BankError

SEEDS = 400
HEAD = 'topic = "light"\ntier = "A"\n'


def made(folder, rules):
    home = folder / "templates" / "light" / "pooled"
    home.mkdir(parents=True)
    (home / "template.toml").write_text(HEAD + rules, "utf-8")
    (home / "en.md").write_text("# T\nstem\n", "utf-8")
    return Bank(folder).template("pooled")


def part(answer):
    return f"[[part]]\nanswer = {answer}\n"


def claimed(count, true=4, false=4):
    listed = [f"t{i} = true" for i in range(true)] + [f"f{i} = false" for i in range(false)]
    pool = "\n".join(["[claims]", *listed])
    return f"{pool}\n" + part('{ kind = "tf", from = "claims" }') * count


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_claims_of_one_draw_differ_and_each_comes_up_about_as_often(tmp_path, count):
    template = made(tmp_path, claimed(count))
    found = [selected_claims(draw_variant(template, seed)) for seed in range(SEEDS)]
    assert all(len({*one.values()}) == len(one) == count for one in found)
    counts = Counter(name for one in found for name in one.values())
    share = SEEDS * count / 8
    assert len(counts) == 8
    assert all(abs(n - share) < 5 * share**0.5 for n in counts.values())


def test_three_claims_are_neither_all_true_nor_all_false(tmp_path):
    template = made(tmp_path, claimed(3, true=1, false=9))
    for seed in range(SEEDS):
        assert {name[0] for name in selected_claims(draw_variant(template, seed)).values()} == {
            "t",
            "f",
        }


def test_true_and_false_are_as_likely_however_many_there_are(tmp_path):
    template = made(tmp_path, claimed(1, true=2, false=10))
    true = sum(selected_claims(draw_variant(template, seed))[0][0] == "t" for seed in range(SEEDS))
    assert abs(true - SEEDS / 2) < 5 * (SEEDS / 4) ** 0.5


def test_a_condition_decides_whether_a_claim_is_true(tmp_path):
    rules = '[draw]\nk = { pick = [0, 1] }\n[claims]\none = "k = 1"\ntwo = { true = "k = 0" }\n'
    template = made(tmp_path, rules + part('{ kind = "tf", from = "claims" }') * 2)
    for seed in range(50):
        assert {*selected_claims(draw_variant(template, seed)).values()} == {"one", "two"}


def test_a_further_claim_leaves_the_others_in_their_order(tmp_path):
    before = made(tmp_path / "a", claimed(2, true=6, false=6))
    after = made(tmp_path / "b", claimed(2, true=7, false=6))
    same = 0
    for seed in range(SEEDS):
        old, new = (selected_claims(draw_variant(template, seed)) for template in (before, after))
        assert old == new or "t6" in new.values()
        same += old == new
    assert same > SEEDS * 0.7


CHOICE = '{ kind = "choice", take = 3, options = { a = true, b = true, c = false, d = false, e = false } }'
MULTI = '{ kind = "multi", take = 3, right = [1, 2], options = { a = true, b = true, c = true, d = false, e = false } }'
MATCH = '{ kind = "match", take = 2, extra = 1, pairs = { a = "A", b = "B", c = "C" }, distractors = ["X"] }'
SHARED = '{ kind = "match", take = 3, pairs = { a = "ccd", b = "ccd", c = "cmos", d = "cmos", e = "cmos" } }'
ORDER = '{ kind = "order", take = 3, steps = ["a", "b", "c", "d"], distractors = ["x", "y", "z"], extra = 2 }'
GAP = '{ kind = "gap", take = 2, gaps = ["a", "b", "c", "d"] }'


def sets_of(template):
    return {
        tuple(map(frozenset, (one.names, one.extra)))
        for one in (select_from_pool(draw_variant(template, seed), 0) for seed in range(SEEDS))
    }


def subsets(names, count):
    return [frozenset(chosen) for chosen in combinations(names, count)]


@pytest.mark.parametrize(
    ("answer", "expected"),
    [
        (CHOICE, {(s, frozenset()) for s in subsets("abcde", 3) if len(s & {"a", "b"}) == 1}),
        (MULTI, {(s, frozenset()) for s in subsets("abcde", 3) if 1 <= len(s & set("abc")) <= 2}),
        (
            MATCH,
            {
                (s, frozenset(x))
                for s in subsets("abc", 2)
                for x in {*"ABCX"} - {name.upper() for name in s}
            },
        ),
        (
            SHARED,
            {(s, frozenset()) for s in subsets("abcde", 3) if s & set("ab") and s & set("cde")},
        ),
        (ORDER, {(s, x) for s in subsets("abcd", 3) for x in subsets("xyz", 2)}),
        (GAP, {(s, frozenset()) for s in subsets("abcd", 2)}),
    ],
    ids=["choice", "multi", "match", "shared targets", "order", "gap"],
)
def test_every_set_that_may_come_comes_and_no_other(tmp_path, answer, expected):
    template = made(tmp_path, part(answer))
    assert sets_of(template) == expected
    assert count_pool_variants(draw_variant(template, 0)) == len(expected)
    assert len({draw_variant(template, seed).identity for seed in range(SEEDS)}) == len(expected)


def test_how_many_may_be_right_is_no_count_of_steps(tmp_path):
    """A range as long as one likes takes no longer."""
    template = made(tmp_path, part(MULTI.replace("[1, 2]", f"[1, {10**15}]")))
    assert {len(s & set("abc")) for s, _ in sets_of(template)} == {1, 2, 3}


def test_steps_keep_their_order(tmp_path):
    template = made(tmp_path, part(ORDER))
    for seed in range(50):
        names = select_from_pool(draw_variant(template, seed), 0).names
        assert names == tuple(sorted(names))


@pytest.mark.parametrize(("count", "expected"), [(1, 8), (2, 28), (3, 48), (4, 68)])
def test_sets_of_claims_are_counted(tmp_path, count, expected):
    """28 = 8 over 2; 48 = 56 - 4 - 4 and 68 = 70 - 1 - 1 without those of one kind only."""
    template = made(tmp_path, claimed(count))
    assert count_pool_variants(draw_variant(template, 0)) == expected
    if count <= 3:
        assert len({draw_variant(template, seed).identity for seed in range(SEEDS)}) == expected


@pytest.mark.parametrize(
    ("rules", "said"),
    [
        (claimed(2, true=1, false=0), "claims: 1 are too few for 2 parts"),
        ("[claims]\na = true\n" + part('{ kind = "tf", true = true }'), "no part has from"),
        (part('{ kind = "tf", from = "pool" }'), "from: 'pool' is not allowed"),
        (part('{ kind = "gap", take = 3, gaps = ["a", "b"] }'), "answer.take: must be 1 to 12"),
        (part('{ kind = "tf", take = 1, true = true }'), "unknown key 'take'"),
        (
            part('{ kind = "order", take = 2, steps = ["a", "b", "c"], before = [["a", "b"]] }'),
            "without before",
        ),
        (
            part('{ kind = "multi", right = [1, 2], options = { a = true, b = false } }'),
            "answer.right",
        ),
        (
            part('{ kind = "order", extra = 2, steps = ["a"], distractors = ["x"] }'),
            "answer.extra: must be 0 to 1",
        ),
    ],
)
def test_a_pool_that_cannot_be_is_refused_where_it_stands(tmp_path, rules, said):
    with pytest.raises(BankError, match=said):
        made(tmp_path, rules)


def test_too_few_right_options_are_said(tmp_path):
    template = made(
        tmp_path,
        part(
            '{ kind = "choice", take = 3, options = { a = true, b = true, c = true, d = false } }'
        ),
    )
    with pytest.raises(BankError, match="3 right and 1 wrong options are too few"):
        select_from_pool(draw_variant(template, 0), 0)
