"""The second bank, `examples/filtering`: clean, in both languages, and right by NumPy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sweep import draws, together

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.kinds.grade import grade_answer
from quizgen.lint.template_checks import lint_template
from quizgen.maths.numbers import to_float
from quizgen.paper.blueprint import load_blueprint
from quizgen.paper.paper import build_paper, single_question_paper
from quizgen.question.levels import effective_level
from quizgen.render import render_paper

ROOT = Path(__file__).parent.parent.parent / "examples" / "filtering"
BANK = Bank(ROOT, trusted=True)
SEEDS = range(8)


@together("name", BANK.template_paths)
def test_every_template_is_clean(name):
    report = lint_template(BANK.template(name), 60, BANK.languages)
    assert not report.problems


@pytest.mark.slow
@together("name", BANK.template_paths)
def test_every_template_is_clean_in_many_draws(name):
    assert not lint_template(BANK.template(name), draws(80, full=1000), BANK.languages).problems


def values(name, seed):
    drawn = draw_variant(BANK.template(name), seed)
    return {key: to_float(value) for key, value in drawn.shown_values.items()}


def nine(v, letter):
    return np.array([v[f"{letter}_{k}"] for k in range(1, 10)]).reshape(3, 3)


@together("seed", SEEDS)
def test_convolution_turns_the_kernel(seed):
    v = values("convolve-by-hand", seed)
    assert v["g"] == np.sum(nine(v, "f") * np.rot90(nine(v, "w"), 2))


@together("seed", SEEDS)
def test_mean_and_median(seed):
    v = values("mean-and-median-with-outlier", seed)
    seen = [v[f"f_{k}"] for k in (1, 2, 3, 4, 6, 7, 8, 9)] + [v["c"]]
    assert (v["m"], v["r"]) == (pytest.approx(np.mean(seen)), np.median(seen))


@together("seed", SEEDS)
def test_the_corner_with_zeros_and_with_repeated_pixels(seed):
    v = values("mean-in-the-corner", seed)
    picture = np.array([[v["a"], v["b"]], [v["c"], v["d"]]])
    assert v["z"] == pytest.approx(np.pad(picture, ((1, 0), (1, 0))).mean())
    assert v["r"] == pytest.approx(np.pad(picture, ((1, 0), (1, 0)), mode="edge").mean())


@together("seed", SEEDS)
def test_derivatives(seed):
    v = values("sobel-gradient", seed)
    across = np.array([[-1, 0, 1], [-2, 0, 2], [-1, 0, 1]])
    g_x, g_y = np.sum(nine(v, "f") * across), np.sum(nine(v, "f") * across.T)
    assert (v["G_x"], v["G_y"]) == (g_x, g_y)
    assert v["theta"] == pytest.approx(np.degrees(np.angle(g_x + 1j * g_y)))
    v = values("sharpen-with-laplacian", seed)
    sharp = np.array([[0, -1, 0], [-1, 5, -1], [0, -1, 0]])
    assert v["h"] == np.sum(nine(v, "f") * sharp)


@together("seed", SEEDS)
def test_frequencies(seed):
    v = values("spectrum-of-a-mean", seed)
    assert v["f_0"] * v["n"] == pytest.approx(1)
    assert v["a"] == pytest.approx(np.sinc(v["n"] / v["p"]))
    v = values("alias-of-stripes", seed)
    wave, places = v["f"] * v["p"] / 1000, np.arange(12)
    alias = np.cos(2 * np.pi * v["u_a"] * places)
    assert np.allclose(np.cos(2 * np.pi * wave * places), alias)
    assert (v["u_a"] <= 0.5, v["f_N"] * v["p"]) == (True, pytest.approx(500))


@together("seed", SEEDS)
def test_histograms(seed):
    v = values("equalise-one-level", seed)
    pixels = np.repeat(np.arange(8), [int(v[f"h_{k}"]) for k in range(8)])
    assert v["s"] == np.floor(7 * np.mean(pixels <= 3) + 0.5)
    v = values("otsu-threshold", seed)
    pixels = np.repeat(np.arange(4), [int(v[f"h_{k}"]) for k in range(4)])
    for t in range(3):
        inside = sum(part.var() * part.size for part in (pixels[pixels <= t], pixels[pixels > t]))
        assert v[f"B_{t}"] == pytest.approx(pixels.var() - inside / pixels.size)


@together("seed", SEEDS)
def test_shapes(seed):
    v = values("erode-dilate-open", seed)
    m, n, k = (int(v[name]) for name in "mnk")
    picture = np.zeros((m + 10, n + 10 + 6 * k), bool)
    picture[4 : 4 + m, 4 : 4 + n] = True
    picture[4, n + 10 : n + 10 + 6 * k : 6] = True
    eroded = grown(picture, np.logical_and)
    assert v["E"] == eroded.sum()
    assert v["D"] == grown(picture, np.logical_or).sum()
    assert v["O"] == grown(eroded, np.logical_or).sum()


def grown(picture, together):
    around = [np.roll(picture, (y, x), (0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    return together.reduce(around)


@together("seed", SEEDS)
def test_components_by_flooding(seed):
    v = values("count-components", seed)
    cells = {(1, x) for x in range(0, 9, 2)}
    for gap in range(4):
        row = {1: 1, 2: 0, 3: 2}.get(int(v[f"l_{gap + 1}"]))
        cells |= set() if row is None else {(row, 2 * gap + 1)}
    assert (v["n_4"], v["n_8"]) == (flooded(cells, 1), flooded(cells, 2))


def flooded(cells, reach):
    """Components of cells; neighbours are at most 1 away each way and ``reach`` in all."""
    left, count = set(cells), 0
    while left:
        count, todo = count + 1, [left.pop()]
        while todo:
            y, x = todo.pop()
            near = {(b, a) for b, a in left
                    if max(abs(b - y), abs(a - x)) == 1 and abs(b - y) + abs(a - x) <= reach}  # fmt: skip
            left -= near
            todo += near
    return count


def test_cost_and_spread():
    v = values("cost-of-separable-filter", 1)
    assert v["d"] / v["s"] == v["v"] == v["n"] / 2
    assert v["D"] * 1e6 == pytest.approx(v["M"] * (v["n"] ** 2 - 2 * v["n"]))
    v = values("two-gaussians-in-a-row", 1)
    assert v["sigma"] == pytest.approx(np.hypot(v["sigma_1"], v["sigma_2"]))
    assert np.hypot(v["sigma"], v["rho"]) == pytest.approx(v["sigma_3"])


def test_a_paper_in_two_languages():
    paper = build_paper(BANK, load_blueprint("mock", BANK), 5, "both")
    page = render_paper(paper, "exam", "html").decode()
    assert 'lang="de"' in page
    assert "Mock exam: Filtering" in page
    assert "Probeklausur: Filterung" in page


READ = {
    "mean-and-median-with-outlier",
    "mean-in-the-corner",
    "sharpen-with-laplacian",
    "sobel-gradient",
    "equalise-one-level",
    "otsu-threshold",
}


@together("name", sorted(READ | {"erode-dilate-open"}))
def test_what_is_read_in_a_figure_is_asked_step_by_step_and_turned_round(name):
    """The figure stays on the page."""
    for seed in SEEDS:
        drawn = draw_variant(BANK.template(name), seed)
        for asked in ("guided", "transfer"):
            assert effective_level(drawn, asked) == asked
            (item,) = single_question_paper(BANK.template(name), seed, "de", level=asked).items
            assert (item.questions[0].figure is not None) is (name in READ)


@together("seed", SEEDS)
def test_the_first_step_of_the_mean_is_the_sum_of_what_is_drawn(seed):
    v = values("mean-and-median-with-outlier", seed)
    seen = [v[f"f_{k}"] for k in (1, 2, 3, 4, 6, 7, 8, 9)] + [v["c"]]
    template = BANK.template("mean-and-median-with-outlier")
    (item,) = single_question_paper(template, seed, "en", level="guided", figures=False).items
    assert grade_answer(item.keys[0].specs[0], str(int(sum(seen)))).verdict == "correct"
