"""Which mistakes of a part can be told from its key and from one another, value by value."""

from __future__ import annotations

from pathlib import Path

import pytest
from flint import fmpq

from quizgen.bank.bank import Bank
from quizgen.bank.misconceptions import PartChecker
from quizgen.bank.sampler import sampler_for

RULES = """
topic = "projection"
tier = "A"
solver = "projection/perspective"
drop = ["depth-over-f", "forgot-depth", "range-for-depth", "swapped"]
may_vanish = [{vanish}]
[draw]
f = {{ range = [2, 6, 1] }}
p_x = {{ range = [-15, 15, 1] }}
p_y = {{ range = [-15, 15, 1] }}
p_z = {{ range = [2, 12, 1] }}
[[part]]
answer = {{ kind = "number", of = "p'_x"{answer} }}
"""
ENV = {"f": 8.0, "p_x": 20.0, "p_y": 100.0, "p_z": 4.0, "p'_x": 40.0, "p'_y": 200.0}
"""The key is 8*20/4 = 40; f left out gives 20/4 = 5, dividing by f 20/8 = 2.5, turned round -40."""
ALL = ("divided-by-f", "forgot-f", "physical-plane")


def part(folder: Path, answer: str = "", vanish: str = "") -> PartChecker:
    place = folder / "templates" / "projection" / "mine"
    place.mkdir(parents=True)
    (place / "template.toml").write_text(RULES.format(answer=answer, vanish=vanish), "utf-8")
    (place / "en.md").write_text("# T\nstem\n", "utf-8")
    return sampler_for(Bank(folder).template("mine")).parts[0]


def check(plan: PartChecker, *, lenient: bool = False, **env: float) -> tuple[str, ...] | str:
    values = {**ENV, **{name.replace("key", "p'_x"): value for name, value in env.items()}}
    return plan.check(values, {"f": fmpq(8)}, lenient=lenient)


def test_mistakes_far_apart_are_all_usable(tmp_path):
    assert sorted(check(part(tmp_path))) == list(ALL)


@pytest.mark.parametrize(
    ("answer", "key", "apart"),
    [
        (', abs = "1"', 7.01, True),
        (', abs = "1"', 6.99, False),
        (', abs = "1/10"', 5.21, True),
        (', abs = "1/10"', 5.19, False),
        (", decimals = 1", 5.21, True),
        (", decimals = 1", 5.19, False),
        (", sigfigs = 2", 5.21, True),
        (", sigfigs = 2", 5.19, False),
        (', rel = "1/10"', 6.26, True),
        (', rel = "1/10"', 6.24, False),
        ("", 5.06, True),
        ("", 5.04, False),
        (', abs = "1", percent = true', 5.021, True),
        (', abs = "1", percent = true', 5.019, False),
        (", exact = true", 5.011, True),
        (", exact = true", 5.009, False),
        (', decimals = 1, within = "2"', 5.21, True),
        (', decimals = 1, within = "2"', 5.19, False),
    ],
)
def test_a_mistake_lies_two_tolerances_from_the_key(tmp_path, answer, key, apart):
    """f left out gives 5; a rounding with a step of its own is as wide as it says."""
    found = check(part(tmp_path, answer), key=key)
    near = "trap 'forgot-f' cannot be told from 'the key'"
    assert (near != found) is apart
    lenient = check(part(tmp_path / "b", answer), key=key, lenient=True)
    assert ("forgot-f" in lenient) is apart


def test_two_mistakes_alike_are_one_reason_to_draw_again(tmp_path):
    """With f = 3.9 and the depth 4 both give about 5: 20/4 and 20/3.9."""
    plan = part(tmp_path, ', abs = "1/10"')
    assert check(plan, f=3.9) == "trap 'forgot-f' cannot be told from 'divided-by-f'"
    assert check(plan, f=3.9, lenient=True) == ("divided-by-f", "physical-plane")
    assert sorted(check(plan, f=3.8)) == list(ALL)


@pytest.mark.parametrize(
    ("changed", "found"),
    [
        ({"f": 3.9}, ("divided-by-f", "physical-plane")),
        ({"key": 5.0}, ("divided-by-f", "physical-plane")),
        ({"key": 5.0 + 1e-10}, ("divided-by-f", "physical-plane")),
        ({"key": 5.1}, "trap 'forgot-f' cannot be told from 'the key'"),
        ({"key": 2.5}, "trap 'divided-by-f' cannot be told from 'the key'"),
    ],
    ids=["another mistake", "the key", "as good as the key", "near the key", "not allowed to"],
)
def test_a_mistake_that_may_vanish_is_left_out(tmp_path, changed, found):
    """Beside another mistake one name is enough; beside the key it must be the key itself."""
    assert check(part(tmp_path, ', abs = "1/10"', '"forgot-f"'), **changed) == found


@pytest.mark.parametrize(
    ("key", "tie"),
    [(7.05, True), (-7.05, True), (7.0481, True), (7.0479, False), (7.0519, True), (7.0521, False),
     (7.0, False)],
)  # fmt: skip
def test_a_key_within_a_fiftieth_of_a_rounding_tie_is_drawn_again(tmp_path, key, tie):
    """In units of the place asked: 7.05 is the tie, 0.02 of a tenth on either side is near."""
    found = check(part(tmp_path, ", decimals = 1"), key=key)
    assert (found == "rounding tie") is tie
    assert check(part(tmp_path / "b", ", decimals = 1"), key=key, lenient=True) != "rounding tie"
    assert check(part(tmp_path / "c", ', abs = "1/100"'), key=key) != "rounding tie"


@pytest.mark.parametrize(
    ("low", "high", "usable"),
    [("f - 3", "f + 1", False), ("f - 2", "f + 1", True), ("f - 9", "f - 3", False),
     ("f - 9", "f - 4", True), ("p'_x/8", "p'_x", False), ("p'_x/7", "p'_x", True)],
)  # fmt: skip
def test_a_mistake_in_the_interval_accepted_besides_is_none(tmp_path, low, high, usable):
    """f = 8 and the key 40; leaving out f gives 5, which counts on the bounds as well."""
    plan = part(tmp_path, f', rel = "1/1000", accept = ["{low}", "{high}"]')
    assert ("forgot-f" in check(plan, lenient=True)) is usable


@pytest.mark.parametrize(("low", "high"), [("1.1*f - 3.8", "p'_x"), ("0", "0.6*f + 0.2")])
def test_a_mistake_on_a_bound_counts_whatever_floats_make_of_it(tmp_path, low, high):
    """For f = 8 both bounds are exactly 5; in floats 5.000000000000001 and 4.999999999999999."""
    plan = part(tmp_path, f', rel = "1/1000", accept = ["{low}", "{high}"]')
    assert "forgot-f" not in check(plan, lenient=True)


def test_what_has_no_value_is_no_mistake(tmp_path):
    found = check(part(tmp_path), f=0.0)
    assert found == ("forgot-f", "physical-plane")


@pytest.mark.parametrize(
    ("within", "apart"), [("1", 2.0), ('"1"', 2.0), ('"2"', 1.0), ('"1/2"', 1.0)]
)
def test_a_step_of_its_own_is_as_wide_as_it_says(tmp_path, within, apart):
    plan = part(tmp_path, f", decimals = 1, within = {within}")
    assert (plan.apart, plan.one_step) == (apart, apart == 1.0)


def test_a_mistake_that_is_the_key_itself_is_none_where_nothing_is_allowed_for(tmp_path):
    """With p_x = 0 every way gives 0, and a hundredth of 0 is no room."""
    found = check(part(tmp_path, ", exact = true"), key=0.0, p_x=0.0)
    assert found == "trap 'divided-by-f' cannot be told from 'the key'"


def test_mistakes_are_as_far_apart_as_they_are_written_down(tmp_path):
    """5.4 and 7.45 are 2.05 apart, but 5 and 7 where whole numbers count within 2."""
    twins = {"p_x": 21.6, "f": 21.6 / 7.45}
    found = check(part(tmp_path / "a", ", decimals = 0, within = 2"), **twins)
    assert found == "trap 'forgot-f' cannot be told from 'divided-by-f'"
    assert sorted(check(part(tmp_path / "b", ", abs = 1"), **twins)) == list(ALL)


def test_small_numbers_are_the_same_only_if_they_are(tmp_path):
    """In 10^-12: 2/8 is 0.25 and the key 0.51; both vanish beside a room of a tenth."""
    plan = part(tmp_path, ', abs = "1/10"', '"divided-by-f"')
    found = check(plan, p_x=2e-12, key=0.51e-12)
    assert found == "trap 'divided-by-f' cannot be told from 'the key'"
