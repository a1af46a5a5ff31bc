"""What a question should take, counted by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from msgspec import structs

from quizgen.lint.item_quality import check_workload, estimate_minutes


@pytest.mark.parametrize(
    ("name", "minutes"),
    [
        # one stem, p'_x = f*p_x/p_z and p'_y = f*p_y/p_z: two operations each
        ("point-to-image-plane", 0.5 + 0.5 + 4 * 0.3),
        # three statements
        ("true-or-false-colour", 0.5 + 3 * 0.5),
        # a product and a quotient; the quotient by the pitch; a product and a quotient
        ("image-height-and-fill-distance", 0.5 + 3 * 0.5 + (2 + 1 + 2) * 0.3),
    ],
)
def test_operations_statements_and_parts_add_up(bank, name, minutes):
    assert math.isclose(estimate_minutes(bank.template(name)), minutes)


def test_points_far_from_the_work_are_noted(bank):
    template = bank.template("point-to-image-plane")
    assert list(check_workload(template)) == []
    few = replace(template, rules=structs.replace(template.rules, minutes=1))
    assert list(check_workload(few)) == ["1 minutes, where its operations take about 2.2 minutes"]
