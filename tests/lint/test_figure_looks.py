"""What lint says of figures that are hard to read, and that a clean one passes."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from quizgen.bank.bank import Bank
from quizgen.bank.variant import draw_variant
from quizgen.figures import plot_figure
from quizgen.lint.figures import check_figures, look_problems

sys.path.insert(0, str(Path(__file__).parents[1] / "bank"))

from mechanics import FILES, write


def look(drawing, size=None):
    return [what for _, what in look_problems([plot_figure(drawing, "A plot.", "en", size)])]


def name_axes(ax):
    ax.set_xlabel("time / s")
    ax.set_ylabel("$U$ / V")


def test_a_plot_in_the_style_of_the_house_passes():
    def drawing(ax):
        for height in (1, 2, 3, 4):  # four inks, four kinds of dashes
            ax.plot([0, 10], [0, height], gid=f"line{height}")
        ax.text(5, 3.6, "$U_0$ = 4 V")
        name_axes(ax)

    assert look(drawing) == []


def test_labels_that_cover_each_other_are_named():
    def drawing(ax):
        ax.plot([0, 10], [0, 1])
        ax.text(5, 0.5, "first")
        ax.text(5.2, 0.5, "second")
        name_axes(ax)

    (said,) = look(drawing)
    assert said.startswith("figure: labels 'first' and 'second' overlap by ")


def test_labels_side_by_side_do_not_overlap():
    def drawing(ax):
        ax.plot([0, 10], [0, 1])
        ax.text(5, 0.5, "first", ha="right")
        ax.text(5, 0.5, " second", ha="left")
        name_axes(ax)

    assert look(drawing) == []


def test_small_letters_are_named_with_their_size():
    def drawing(ax):
        ax.text(0.5, 0.5, "tiny", fontsize=6)

    assert look(lambda ax: [drawing(ax), name_axes(ax)]) == [
        "figure: letters of 'tiny' are 6.0 pt, less than 7 pt"
    ]


def test_an_index_may_be_a_little_smaller_than_other_letters():
    def drawing(ax, size):
        ax.text(0.5, 0.5, "$U_0$", fontsize=size)  # an index is set at 0.7 of that
        name_axes(ax)

    assert look(lambda ax: drawing(ax, 9)) == []
    assert look(lambda ax: drawing(ax, 8)) == [
        "figure: letters of '$U_0$' are 5.6 pt, less than 6 pt"
    ]


def test_a_figure_wider_than_a_page_is_named():
    (said,) = look(lambda ax: [ax.plot([0, 1], [0, 1]), name_axes(ax)], (500, 100))
    assert said.endswith(" pt wide, more than the 480 pt of a page")


def test_markers_outside_the_axes_are_counted():
    def drawing(ax):
        ax.plot([1, 5, 9], [1, 5, 9], "o")
        ax.set_xlim(0, 6)
        ax.set_ylim(0, 10)
        name_axes(ax)

    assert look(drawing) == ["figure: markers that lie outside the axes are clipped: 1"]


def test_numbers_at_an_axis_need_a_name():
    def drawing(ax):
        ax.plot([0, 1], [0, 1])
        ax.set_xlabel("time / s")

    assert look(drawing) == ["figure: an axis has numbers and no name"]


def test_numbers_need_a_name_also_where_ticks_are_styled():
    def drawing(ax):
        ax.plot([0, 1], [0, 1])
        ax.set_ylabel("$U$ / V")
        ax.tick_params(axis="x", rotation=90)

    assert look(drawing) == ["figure: an axis has numbers and no name"]


def test_powers_of_ten_are_numbers():
    def drawing(ax):
        ax.loglog([1, 1000], [1, 1000])
        ax.set_xlabel("$f$ / Hz")

    assert look(drawing) == ["figure: an axis has numbers and no name"]


def test_names_of_categories_need_none():
    def drawing(ax):
        ax.bar(["Dhaka", "Bonn"], [3, 4], color="pale-blue", edgecolor="ink")
        ax.set_ylabel("people / 1000")

    assert look(drawing) == []


def test_an_axis_without_numbers_needs_no_name():
    def drawing(ax):
        ax.plot([0, 1], [0, 1])
        ax.set_xticks([])
        ax.set_yticks([])

    assert look(drawing) == []


@pytest.mark.parametrize(
    ("drawing", "said"),
    [
        (lambda ax: ax.plot([0, 1], [0, 1], "#f0e442"), "a line in #f0e442 can hardly be seen"),
        (lambda ax: ax.text(0.5, 0.5, "pale", color="#bbbbbb"), "letters in #bbbbbb can hardly be"),
        (lambda ax: ax.fill([0, 1, 1], [0, 0, 1], color="#eeeeaa", lw=0), "an area in #eeeeaa can"),
    ],
)
def test_colours_that_white_paper_swallows_are_named(drawing, said):
    # Contrast by WCAG 2: #f0e442 has 1.3, #bbbbbb 1.9, #eeeeaa 1.2.
    (found,) = look(lambda ax: [drawing(ax), name_axes(ax)])
    assert found.startswith(f"figure: {said}")


def test_coloured_lines_of_one_lightness_need_different_dashes():
    # L* of #d62728 is 47, of #1a7f37 is 47.
    def drawing(ax, dashes):
        ax.plot([0, 1], [0, 1], "#d62728", linestyle="-")
        ax.plot([0, 1], [1, 0], "#1a7f37", linestyle=dashes)
        name_axes(ax)

    assert look(lambda ax: drawing(ax, "-")) == [
        "figure: lines in #1a7f37 and #d62728 look alike on grey paper"
    ]
    assert look(lambda ax: drawing(ax, "--")) == []


def test_lint_looks_at_the_figures_of_a_template(tmp_path):
    block = FILES["templates/figures/block.py"].replace(
        "    sketch.label(", '    sketch.label((184, 42), "push")\n    sketch.label('
    )
    bank = Bank(write(tmp_path, {"templates/figures/block.py": block}), trusted=True)
    draws = [draw_variant(bank.template("push"), seed) for seed in range(6)]
    (said,) = check_figures(draws)
    assert (said.code, said.file.name, said.span.line) == ("QG403", "template.toml", 10)
    assert said.message.startswith("figure: labels 'push' and '$F$")


def test_the_figure_of_a_sound_bank_passes(tmp_path):
    bank = Bank(write(tmp_path), trusted=True)
    draws = [draw_variant(bank.template("push"), seed) for seed in range(6)]
    assert list(check_figures(draws)) == []
