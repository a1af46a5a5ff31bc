"""How a figure is written, and what comes of it: contract, parameters, look, bytes, what is kept."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from inspect import signature
from pathlib import Path
from xml.etree import ElementTree as ET

import html5lib
import matplotlib as mpl
import numpy as np
import pytest
import typst
from matplotlib import _path, _text_helpers, font_manager
from matplotlib.axes import Axes
from matplotlib.axis import Axis, XAxis
from matplotlib.colors import is_color_like, to_hex
from matplotlib.figure import Figure as StockFigure
from matplotlib.patches import Circle
from matplotlib.transforms import Affine2D
from PIL import Image
from svg_reader import SVG, read_labels, read_parts, read_pictures
from sweep import together

from quizgen import figures
from quizgen.bank.solvers import import_module_file, unload_modules
from quizgen.core.errors import BankError
from quizgen.figures import describe_figure, draw_figure, engine, plot_figure
from quizgen.figures.contract import Figure
from quizgen.figures.kit import ABSENT, SQUARE, Parameter
from quizgen.figures.parameters import fill_defaults
from quizgen.figures.svg import write_svg

HERE = Path(__file__).parent
LINE = """
from quizgen.figures.kit import Parameter

PARAMETERS = {"x": Parameter("mm", "width", default=4, low=1, high=9)}
CALLS = []


def draw(ax, values, *, quiz):
    CALLS.append(quiz)
    ax.plot([0, values["x"]], [0, 1], gid="curve")
    ax.set_xlabel("width / mm")


def alt(values, lang, *, quiz):
    return f"A line. It is {values['x']:g} mm wide."
"""


@pytest.fixture
def module(tmp_path):
    """Makes the module of a figure from its source."""

    def make(source=LINE, name="line"):
        (tmp_path / f"{name}.py").write_text(source, encoding="utf-8")
        unload_modules(tmp_path)
        return import_module_file(tmp_path, name)

    return make


def draw(figure, values=None, *, quiz=False, lang="en", **more):
    return draw_figure(figure, values or {}, quiz=quiz, lang=lang, **more)


def plot(function, size=None, lang="en"):
    """A plot on axes of the house."""
    return plot_figure(function, "A plot.", lang, size)


def on_sheet(function, size=SQUARE):
    """A drawing on a whole figure."""
    drawing = engine.draw_sheet(function, size, ".", axes=False)
    svg = write_svg(drawing, "A drawing.", "en")
    return Figure(svg, drawing.width, drawing.height, "A drawing.", "en", labels=drawing.labels)


# The contract


def test_a_figure_is_parameters_a_drawing_and_words(module):
    figure = draw(module(), {"x": 5})
    assert figure.alt == "A line. It is 5 mm wide."
    assert "width / mm" in read_labels(figure)
    assert len(read_parts(figure)["curve"]) == 1
    assert (figure.needs_colour, figure.outside, figure.lang) == (False, 0, "en")


@pytest.mark.parametrize("name", ["PARAMETERS", "draw", "alt"])
def test_what_a_module_lacks_is_told(module, name):
    source = re.sub(rf"\b{name}\b", f"{name}_", LINE)
    with pytest.raises(
        BankError, match=rf"line.py: figure 'line': the module has no {name} \(see docs/"
    ):
        draw(module(source))


def test_the_first_parameter_is_called_ax_or_fig(module):
    with pytest.raises(BankError, match=r"draw\(\) takes 'ax' or 'fig' first"):
        draw(module(LINE.replace("draw(ax,", "draw(axes,")))


def test_a_figure_that_draws_nothing_is_refused(module):
    source = re.sub(
        r"def draw.*?\n\n", "def draw(fig, values, *, quiz): pass\n\n", LINE, flags=re.DOTALL
    )
    with pytest.raises(BankError, match="the figure is empty"):
        draw(module(source))


def test_something_far_outside_is_refused(module):
    source = LINE.replace("CALLS.append(quiz)", "ax.text(99, 0, 'x')")
    with pytest.raises(BankError, match="drawn far outside: the picture would be 5872 by"):
        draw(module(source))


def test_markers_outside_their_axes_are_counted():
    def three_of_five(ax):
        ax.plot(range(5), range(5), "o")
        ax.set_xlim(-0.5, 2.5)

    assert plot(three_of_five).outside == 2


def test_a_figure_speaks_the_languages_there_are(module):
    with pytest.raises(BankError, match="figure 'line': no alt text in 'xx'"):
        draw(module(), lang="xx")


def test_a_figure_may_say_that_it_needs_colour(module):
    always = module(LINE + "\nCOLOUR = True\n")
    assert draw(always).needs_colour
    wide = module(LINE + "\ndef COLOUR(values): return values['x'] > 6\n")
    assert [draw(wide, {"x": x}).needs_colour for x in (2, 8)] == [False, True]


def test_the_size_of_the_axes_is_said_in_points(module):
    for width in (60, 240):
        figure = draw(module(LINE + f"\nSIZE = ({width}, 80)\n"))
        (frame,) = (line for line in read_parts(figure)["curve"])
        assert np.ptp(frame[:, 0]) == pytest.approx(width / 1.06, abs=0.5)  # 3 % at either side


def test_words_in_a_picture_are_drawn_in_its_language(module):
    source = LINE.replace("quiz):\n    CALLS", "quiz, lang):\n    CALLS")
    source = source.replace('"width / mm"', '{"en": "width", "bn": "প্রস্থ"}[lang]')
    figure = module(source)
    for lang, word in (("en", "width"), ("bn", "প্রস্থ")):
        assert word in read_labels(draw(figure, lang=lang))


def test_a_learners_value_is_marked_beside_the_right_one(module):
    mark = "\ndef mark(ax, values, marks): ax.axvline(marks['x'], color='gold', gid='mark')\n"
    figure = module(LINE + mark)
    plain, marked = draw(figure), draw(figure, marks={"x": 3})
    assert "mark" not in read_parts(plain)
    assert len(read_parts(marked)["mark"]) == 1
    assert b"--fig-gold" in marked.inline_svg


def test_a_figure_without_mark_shows_no_other_values(module):
    with pytest.raises(BankError, match=r"figure 'line' has no mark\(\)"):
        draw(module(), marks={"x": 3})


def test_a_figure_is_described_without_being_drawn(module):
    figure = module()
    assert describe_figure(figure, {"x": 2}, quiz=True, lang="en") == "A line. It is 2 mm wide."
    assert figure.CALLS == []


# Parameters


def fill(rule, **values):
    return fill_defaults("line", {"x": rule}, values)["x"]


@together(
    ("rule", "value", "message"),
    [
        (Parameter("mm", "width"), "3", "x = '3' is not a number"),
        (Parameter("mm", "width"), True, "x = True is not a number"),
        (Parameter("mm", "width"), [3], "x = [3] is not a number"),
        (Parameter("mm", "width"), float("nan"), "x = nan is not between -inf and inf"),
        (Parameter("mm", "width"), float("inf"), "x = inf is not between"),
        (Parameter("mm", "width", low=1, high=9), 10, "x = 10 is not between 1 and 9"),
        (Parameter("", "count", whole=True), 2.5, "x = 2.5 is not whole"),
        (Parameter("g", "sample", kind="list"), 3.0, "x = 3.0 is no list"),
        (Parameter("g", "sample", kind="list"), "abc", "x = 'abc' is no list"),
        (Parameter("g", "sample", kind="list"), [1, "a"], "x = 'a' is not a number"),
        (Parameter("g", "sample", kind="list", low=0), [1, -1], "x = -1 is not between 0 and"),
        (Parameter("", "levels", kind="table"), [1, 2], "x = 1 is no list"),
        (Parameter("", "levels", kind="table"), [[1, 2], [3]], "x: rows of different lengths"),
        (Parameter("", "name", kind="text"), 3, "x = 3 is no text"),
        (Parameter("", "gates", kind="texts"), "or", "x = 'or' is no list"),
        (Parameter("", "gates", kind="texts"), ["or", 3], "x: not all are texts"),
        (Parameter("", "gates", kind="words"), ["or"], "x: there is no kind 'words'"),
    ],
)
def test_a_value_that_cannot_be_drawn_gets_one_line(rule, value, message):
    with pytest.raises(BankError, match=re.escape(f"figure 'line': {message}")) as caught:
        fill(rule, x=value)
    assert "\n" not in str(caught.value)


def test_unknown_and_missing_parameters_are_named():
    table = {"x": Parameter("mm", "width")}
    with pytest.raises(BankError, match=r"figure 'line': missing parameter 'x' \(width\)"):
        fill_defaults("line", table, {})
    with pytest.raises(BankError, match="figure 'line': unknown parameter 'y'"):
        fill_defaults("line", table, {"x": 1, "y": 2})


def test_values_are_numbers_lists_tables_arrays_and_text():
    assert fill(Parameter("mm", "width"), x=3) == 3.0
    assert fill(Parameter("g", "sample", kind="list"), x=np.arange(3)) == (0.0, 1.0, 2.0)
    assert fill(Parameter("", "levels", kind="table"), x=[[1, 2], (3, 4)]) == ((1, 2), (3, 4))
    assert fill(Parameter("", "levels", kind="table"), x=np.eye(2)) == ((1, 0), (0, 1))
    assert fill(Parameter("", "name", kind="text"), x="convex") == "convex"
    assert fill(Parameter("", "gates", kind="texts"), x=["or", "and"]) == ("or", "and")


def test_what_is_left_out_has_its_default_or_is_absent():
    table = {"x": Parameter("mm", "width", 7.0), "y": Parameter("mm", "height", ABSENT)}
    assert fill_defaults("line", table, {}) == {"x": 7.0}


def test_minus_zero_is_zero(module):
    source = LINE.replace("low=1", "low=-1")
    assert draw(module(source), {"x": -0.0}).alt == draw(module(source), {"x": 0.0}).alt


# Nothing of the house stays outside, nothing from outside comes in


def settings():
    return {name: dict.__getitem__(mpl.rcParams, name) for name in dict.keys(mpl.rcParams)}


@pytest.mark.parametrize("fails", [False, True])
def test_an_authors_settings_and_colours_are_as_before(module, fails):
    before, red = settings(), to_hex("red")
    figure = module(LINE.replace("CALLS.append(quiz)", "1 / 0") if fails else LINE)
    if fails:
        with pytest.raises(ZeroDivisionError):
            draw(figure)
    else:
        draw(figure)
    assert settings() == before
    assert to_hex("red") == red == "#ff0000"
    assert not is_color_like("pale-blue")
    assert not is_color_like("ink")


DIGESTS = """
import hashlib, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from documented import VALUES, load_examples
from quizgen.figures import draw_figure
found = load_examples(Path(sys.argv[2]))
assert "matplotlib" not in sys.modules
for name, module in found.items():
    figure = draw_figure(module, VALUES.get(name, {}), quiz=False, lang="en")
    print(name, hashlib.sha256(figure.inline_svg).hexdigest())
assert "matplotlib.pyplot" not in sys.modules
"""
HOSTILE = """
figure.constrained_layout.use: True
figure.dpi: 300
lines.linewidth: 7
lines.scale_dashes: True
path.simplify: False
path.sketch: 3, 100, 2
font.family: monospace
mathtext.fontset: cm
patch.linewidth: 5
axes.facecolor: red
axes.prop_cycle: cycler(color=['k'])
axes.formatter.use_locale: True
axes.grid: True
image.cmap: jet
image.interpolation: bicubic
xtick.direction: in
xtick.minor.visible: True
text.usetex: True
savefig.bbox: tight
boxplot.notch: True
"""


def digests(folder, **environment):
    """Digests of the documented figures, by a process that has heard of none of them."""
    folder.mkdir()
    done = subprocess.run(
        [sys.executable, "-c", DIGESTS, str(HERE), str(folder / "figures")],
        env={"PATH": "", "HOME": str(folder), "XDG_CACHE_HOME": str(folder), **environment},
        cwd=HERE.parents[1], check=True, capture_output=True, text=True,
    )  # fmt: skip
    return done.stdout.splitlines()


@pytest.mark.slow
def test_a_hostile_matplotlibrc_changes_nothing_and_pyplot_is_never_loaded(tmp_path):
    rc = tmp_path / "matplotlibrc"
    rc.write_text(HOSTILE)
    usual = digests(tmp_path / "usual", PYTHONHASHSEED="0")
    hostile = digests(tmp_path / "hostile", PYTHONHASHSEED="4711", LC_ALL="C",
                      MATPLOTLIBRC=str(rc))  # fmt: skip
    assert usual == hostile
    assert len({line.split()[1] for line in usual}) == len(usual) >= 7


def test_all_code_that_decides_what_is_drawn_is_known():
    for name in engine._CODE:
        assert engine._list_python_files(engine._PACKAGE / name), name


# Anything that matplotlib draws


X, Y = np.meshgrid(np.linspace(-3, 3, 25), np.linspace(-2, 2, 20))
HILL = np.exp(-(X**2) - Y**2)
EXTENT = (-3, 3, -2, 2)


def image_with_overlay(ax):
    ax.imshow(HILL, extent=EXTENT)
    ax.imshow(X, cmap="viridis", alpha=0.5, extent=EXTENT)
    ax.plot([-2, 2], [-1, 1], "o-", color="gold")


def smoothed_image(ax):
    ax.imshow(HILL, extent=EXTENT, interpolation="bilinear", alpha=0.5)


def turned_image(ax):
    turned = Affine2D().rotate_deg(30) + ax.transData
    ax.imshow(HILL, extent=EXTENT, transform=turned)


def contours(ax):
    ax.clabel(ax.contour(X, Y, HILL, colors="blue"), fontsize=8)


def filled_contours_with_a_bar(ax):
    ax.figure.colorbar(ax.contourf(X, Y, HILL, cmap="Greys"), ax=ax, label="height / m")


def logarithmic_axes(ax):
    ax.loglog([1, 10, 1e5], [1, 100, 1e4])
    ax.grid(which="both")


def hatched_bars(ax):
    ax.bar(["A", "B"], [3, 5], hatch=["//", "xx"], color="paper", edgecolor="ink")


def boxes(ax):
    ax.boxplot([[1, 2, 3, 9], [2, 3, 4]])


def an_annotation(ax):
    ax.plot([1, 2, 3])
    ax.annotate("peak", (2, 3), xytext=(0.5, 2.5), arrowprops={"arrowstyle": "->"})


def turned_text(ax):
    ax.text(0.2, 0.5, "uphill", rotation=45, bbox={"facecolor": "pale-gold", "boxstyle": "round"})


def formulas(ax):
    ax.text(0.2, 0.4, r"$\frac{\alpha}{\sqrt{2}}\sum_{i=0}^{n} x_i$")
    ax.set_title("A title")


def colour_mesh(ax):
    ax.figure.colorbar(ax.pcolormesh(X, Y, HILL, cmap="viridis"), ax=ax)


def smooth_triangles(ax):
    ax.pcolormesh(X[:4, :4], Y[:4, :4], HILL[:4, :4], shading="gouraud")


def coloured_markers(ax):
    ax.scatter(X[::5, ::5], Y[::5, ::5], c=HILL[::5, ::5], s=30, cmap="viridis", alpha=0.7)


def twin_axes(ax):
    ax.plot([1, 2])
    ax.twinx().plot([20, 10], color="red")


def a_clip_path(ax):
    circle = Circle((0, 0), 1, transform=ax.transData)
    ax.imshow(HILL, extent=EXTENT).set_clip_path(circle)
    for height in (-0.5, 0, 0.5):
        ax.plot([-3, 3], [height, height])[0].set_clip_path(circle)


def a_legend(ax):
    ax.plot([1, 2], label="one $a$")
    ax.plot([2, 1], label="two")
    ax.legend(title="Key")


def areas(ax):
    ax.fill_between([1, 2, 3], [1, 3, 2], alpha=0.3)
    ax.stackplot([1, 2, 3], [1, 1, 1], [2, 1, 1])


def gaps(ax):
    ax.plot([1, 2, np.nan, 4, 5], [1, 2, np.nan, 2, 1])
    ax.plot([np.nan] * 3, [np.nan] * 3)
    ax.plot([np.nan], [np.nan], "o")


def a_field_of_arrows(ax):
    ax.quiver([0, 1], [0, 1], [1, 0], [0, 1])
    ax.streamplot(X, Y, X, Y, density=0.3)


def errors_stems_and_steps(ax):
    ax.errorbar([1, 2, 3], [1, 2, 1], yerr=0.2, capsize=3)
    ax.stem([4, 5], [1, 2])
    ax.step([6, 7], [1, 2])
    ax.stairs([1, 2, 3])


def styled_ticks(ax):
    ax.plot([1, 2])
    ax.tick_params(axis="x", rotation=45, colors="red")
    ax.spines["left"].set_position(("data", 0.5))


def an_inset(ax):
    ax.plot([1, 2])
    ax.inset_axes([0.6, 0.1, 0.3, 0.3]).plot([2, 1])


def a_cake(ax):
    ax.pie([1, 2, 3], labels=["a", "b", "c"])


def polar_axes(fig):
    ax = fig.add_subplot(projection="polar")
    ax.plot(np.linspace(0, 6), np.linspace(0, 1))


def a_surface(fig):
    ax = fig.add_subplot(projection="3d")
    ax.plot_surface(X, Y, HILL, cmap="viridis")


def subplots(fig):
    for ax in fig.subplots(2, 2, sharex=True).flat:
        ax.plot([1, 2])
    fig.suptitle("All")
    fig.tight_layout()


ON_AXES = (
    image_with_overlay, smoothed_image, turned_image, contours, filled_contours_with_a_bar,
    logarithmic_axes, hatched_bars, boxes, an_annotation, turned_text, formulas, colour_mesh,
    smooth_triangles, coloured_markers, twin_axes, a_clip_path, a_legend, areas, gaps,
    a_field_of_arrows, errors_stems_and_steps, styled_ticks, an_inset, a_cake,
)  # fmt: skip
ON_SHEETS = (polar_axes, a_surface, subplots)


def as_pdf(svg, folder):
    """A page with a picture, and what Typst warns of."""
    (folder / "figure.svg").write_bytes(svg)
    (folder / "page.typ").write_text('#image("figure.svg", alt: "x")')
    page, warnings = typst.compile_with_warnings(str(folder / "page.typ"))
    return page, [str(warning) for warning in warnings]


@pytest.mark.parametrize("function", [*ON_AXES, *ON_SHEETS], ids=lambda one: one.__name__)
def test_what_matplotlib_draws_stands_in_pages_and_pdf(function, tmp_path):
    figure = plot(function) if function in ON_AXES else on_sheet(function)
    svg = figure.inline_svg.decode()
    html5lib.HTMLParser(strict=True).parse(f"<!DOCTYPE html><title>x</title>{svg}{svg}")
    ids = re.findall(r'\bid="([^"]*)"', svg)
    assert len(ids) == len(set(ids))
    assert set(re.findall(r"url\(#([^)]*)\)", svg)) == set(ids)
    page, warnings = as_pdf(figure.standalone_svg, tmp_path)
    assert page.startswith(b"%PDF")
    assert warnings == []
    assert b"var(" not in figure.standalone_svg
    assert "nan" not in re.sub(r"base64,[^\"]*", "", svg)


@together("function", [*ON_AXES, *ON_SHEETS])
def test_numbers_have_two_digits_behind_the_point(function):
    figure = plot(function) if function in ON_AXES else on_sheet(function)
    geometry = re.findall(
        r' (?:d|x|y|width|height|transform)="([^"]*)"', figure.inline_svg.decode()
    )
    assert max(map(len, re.findall(r"\.(\d+)", " ".join(geometry)))) == 2


def test_the_name_of_a_hatch_or_a_clip_follows_from_what_it_is():
    """So two figures on a page may share it, and never mean different things by one."""
    hatched = [plot(lambda ax, way=way: ax.bar([1], [1], hatch=way)) for way in ("//", "//", "xx")]
    ids = [re.findall(rb'id="(\w+)"', one.inline_svg) for one in hatched]
    assert ids[0] == ids[1] != ids[2]


def seen(figure, folder, at):
    """Colour of the printed figure at a place, as shares of its width and height."""
    (folder / "figure.svg").write_bytes(figure.standalone_svg)
    (folder / "page.typ").write_text(
        '#set page(width: auto, height: auto, margin: 0pt)\n#image("figure.svg", alt: "x")'
    )
    page = Image.open(io.BytesIO(typst.compile(str(folder / "page.typ"), format="png", ppi=72)))
    return page.convert("RGB").getpixel(
        tuple(int(s * n) for s, n in zip(at, page.size, strict=True))
    )


def test_half_a_white_over_black_is_grey(tmp_path):
    def overlay(ax):
        ax.imshow(np.zeros((2, 2)), vmin=0, vmax=1)
        ax.imshow(np.ones((2, 2)), vmin=0, vmax=1, alpha=0.5)

    assert seen(plot(overlay, SQUARE), tmp_path, (0.5, 0.5)) == (128, 128, 128)


def test_pixels_keep_their_opacity(tmp_path):
    pixels = np.zeros((2, 2, 4))  # nothing but paper to be seen
    assert seen(plot(lambda ax: ax.imshow(pixels), SQUARE), tmp_path, (0.5, 0.5)) == (255,) * 3


def test_a_picture_is_not_seen_outside_its_axes(tmp_path):
    def zoomed(ax):
        ax.imshow(np.zeros((4, 4)))
        ax.set(xlim=(0.9, 2.1), ylim=(0.9, 2.1), xticks=[], yticks=[])
        ax.text(1.3, 2.3, "above")

    figure = plot(zoomed, SQUARE)
    assert seen(figure, tmp_path, (0.9, 0.04)) == (255, 255, 255)
    assert seen(figure, tmp_path, (0.5, 0.5)) == (0, 0, 0)


def test_pictures_are_never_resampled():
    codes = np.arange(12, dtype=np.uint8).reshape(3, 4) * 17
    (image,) = read_pictures(plot(lambda ax: ax.imshow(codes, vmin=0, vmax=255)))
    assert np.array_equal(image[..., 0], codes)


# The look


def test_axes_have_names_at_their_ends_and_no_box():
    def named(ax):
        ax.plot([0, 1], [0, 1])
        ax.set(xlabel="$f$ / Hz", ylabel="gain / dB")

    figure = plot(named, (200, 100))
    across, upright = (label for label in figure.labels if "/" in label.text)
    ticks = [label for label in figure.labels if "/" not in label.text]
    assert across.right == pytest.approx(200, abs=0.5)
    assert across.top >= max(label.bottom for label in ticks) - 0.5
    assert upright.bottom <= min(label.top for label in ticks) + 0.5
    assert all(label.size >= 9 for label in figure.labels)


def test_lines_differ_without_colours():
    def four(ax):
        for slope in range(4):
            ax.plot([0, 1], [0, slope])

    svg = plot(four).inline_svg.decode()
    for ink in ("blue", "red", "teal", "gold"):
        assert f"var(--fig-{ink}," in svg
    assert len(set(re.findall('stroke-dasharray="([^"]*)"', svg))) == 3


def test_inks_are_variables_in_a_page_and_fixed_in_a_file():
    figure = plot(lambda ax: ax.plot([0, 1], color="red"))
    assert b'stroke="var(--fig-red,#b8371f)"' in figure.inline_svg
    assert b'stroke="#b8371f"' in figure.standalone_svg
    assert b"currentColor" in figure.inline_svg
    assert b"currentColor" not in figure.standalone_svg


def test_other_colours_stay_what_they_are():
    assert b'stroke="#123456"' in plot(lambda ax: ax.plot([0, 1], color="#123456")).inline_svg


def test_an_author_may_name_parts_as_he_likes():
    figure = plot(lambda ax: ax.plot([0, 1], gid='"<&>"'))
    names = {element.get("data-part") for element in ET.fromstring(figure.inline_svg).iter()}
    assert '"<&>"' in names


def test_the_first_sentence_is_the_title(module):
    root = ET.fromstring(draw(module(), {"x": 5}, lang="bn").inline_svg)
    assert (root.get("role"), root.get("lang")) == ("img", "bn")
    assert [(one.tag, one.text) for one in root[:2]] == [
        (f"{SVG}title", "A line."), (f"{SVG}desc", "It is 5 mm wide."),
    ]  # fmt: skip


def test_bangla_letters_join():
    """Consonants with a hasanta between them are one letter: three signs, one outline."""

    def conjunct(fig):
        fig.sketch().label((50, 50), "ক্ষ", part="word")

    (word,) = (
        element for element in ET.fromstring(on_sheet(conjunct).inline_svg)
        if element.get("data-part") == "word"
    )  # fmt: skip
    assert len("ক্ষ") == 3
    assert word.get("d").count("M") == 1


def test_numbers_have_the_decimal_sign_of_the_language():
    def told(text):
        return lambda ax: (ax.text(0, 0.5, text), ax.set_axis_off())

    german, english = plot(told("1.5 mm, 2."), lang="de"), plot(told("1,5 mm, 2."), lang="en")
    assert german.inline_svg.replace(b'lang="de"', b'lang="en"') == english.inline_svg


# What is kept


def test_the_same_figure_is_drawn_once(module):
    figure = module()
    assert draw(figure, {"x": 4}) is draw(figure, {"x": 4.0}) is draw(figure)
    assert figure.CALLS == [False]


def test_finished_drawings_are_kept_for_the_next_process(module, empty_cache):
    figure = module()
    first = draw(figure)
    figures._draw_items.cache_clear()
    assert draw(figure) == first
    assert figure.CALLS == [False]
    assert len([*(empty_cache / "figures").iterdir()]) == 1


def test_another_question_or_language_shares_no_drawing_it_would_change(module, empty_cache):
    figure = module()
    for quiz, lang in ((True, "en"), (False, "en"), (False, "bn"), (False, "de")):
        draw(figure, quiz=quiz, lang=lang)
    assert figure.CALLS == [True, False, False]  # Bangla writes the numbers that English writes


@pytest.mark.parametrize("changed", ["line", "beside"])
def test_a_changed_module_is_drawn_again(module, tmp_path, empty_cache, changed):
    (tmp_path / "beside.py").write_text("HEIGHT = 1\n")
    source = LINE.replace("CALLS = []", "CALLS = []\nfrom .beside import HEIGHT")
    source = source.replace("[0, 1],", "[0, HEIGHT],")
    before = draw(module(source))
    if changed == "beside":
        (tmp_path / "beside.py").write_text("HEIGHT = 200\n")
    else:
        source = source.replace("[0, HEIGHT]", "[HEIGHT, 0]")
    assert draw(module(source)) != before


def test_a_damaged_drawing_is_drawn_again(module, empty_cache):
    figure = module()
    first = draw(figure)
    (file,) = (empty_cache / "figures").iterdir()
    file.write_bytes(b"damaged")
    figures._draw_items.cache_clear()
    assert draw(figure) == first
    assert figure.CALLS == [False, False]


# matplotlib's inner side, which the lean axes and the renderer lean on: a new version may move it


def changed(what, file):
    return f"matplotlib {mpl.__version__} has changed {what}; see quizgen/figures/{file}"


@pytest.fixture
def stock():
    """Axes of matplotlib's own."""
    return StockFigure().add_subplot()


def test_set_ticks_takes_places_labels_and_minor():
    names = list(signature(Axis.set_ticks).parameters)
    assert names == ["self", "ticks", "labels", "minor", "kwargs"], changed("set_ticks", "axes.py")


def test_set_tick_params_goes_through_ticks_that_were_made(stock):
    names = list(signature(Axis.set_tick_params).parameters)
    said = changed("set_tick_params", "axes.py")
    assert names == ["self", "which", "reset", "kwargs"], said
    stock.xaxis.majorTicks, stock.xaxis.minorTicks = [], []
    stock.xaxis.set_tick_params(pad=7)
    assert stock.xaxis.majorTicks == [], said


def test_set_clip_path_takes_a_path_and_a_transform():
    names = list(signature(Axis.set_clip_path).parameters)
    assert names == ["self", "path", "transform"], changed("set_clip_path", "axes.py")


def test_reset_ticks_forgets_made_ticks(stock):
    (first, *_) = stock.xaxis.get_major_ticks()
    stock.xaxis.reset_ticks()
    assert first not in stock.xaxis.get_major_ticks(), changed("reset_ticks", "axes.py")


def test_axes_make_their_axis_in_init_axis():
    made = []

    class Watched(Axes):
        def _init_axis(self):
            made.append(self)
            super()._init_axis()

    StockFigure().add_axes((0, 0, 1, 1), axes_class=Watched)
    assert len(made) == 1, changed("_init_axis", "axes.py")


def test_tick_settings_are_kept_by_name(stock):
    axis = XAxis(stock)
    axis.set_tick_params(pad=7, labelbottom=False)
    kept = {name: axis._major_tick_kw.get(name) for name in ("pad", "label1On", "gridOn")}
    expected = {"pad": 7, "label1On": False, "gridOn": False}
    assert kept == expected, changed("_major_tick_kw", "axes.py")


def test_a_spine_knows_whether_it_was_moved(stock):
    spine, said = stock.spines["left"], changed("spine._position", "axes.py")
    spine.get_position()
    assert spine._position == ("outward", 0.0), said
    spine.set_position(("data", 2))
    assert spine._position == ("data", 2), said


def test_paths_are_written_by_convert_to_string():
    path, commands = mpl.path.Path([(0, 0), (1.5, 2.125), (3, 0)]), [b"M", b"L", b"Q", b"C", b"z"]
    text = _path.convert_to_string(path, Affine2D(), None, False, None, 2, commands, False)
    assert text == b"M 0 0 \nL 1.5 2.12 \nL 3 0 \n", changed("_path.convert_to_string", "svg.py")


def test_text_helpers_lay_out_letters():
    font = font_manager.get_font(font_manager.findfont("STIXGeneral"))
    font.set_size(100, 72)
    (first, second), said = _text_helpers.layout("AB", font), changed("layout", "svg.py")
    assert first.glyph_index != second.glyph_index, said
    assert (first.x, first.y) == (0, 0), said
    assert 50 < second.x < 90, said
    assert Path(first.ft_object.fname).name == "STIXGeneral.ttf", said


def test_the_list_of_fonts_is_the_one_that_matplotlib_reads():
    """Else it scans the machine, and a STIX of the system may decide the bytes of a figure."""
    name = f"fontlist-v{font_manager.FontManager.__version__}.json"
    kept = Path(figures.__file__).parent / "fonts" / name
    assert kept.is_file(), changed("the form of its font list", "fonts, style.py")
    assert mpl.__version__.startswith("3.11."), changed("its version", "style.py")
    own = Path(mpl.get_data_path()).resolve()
    assert Path(font_manager.findfont("STIXGeneral")).resolve().is_relative_to(own)


FONTS = """
import sys
if "plots" in sys.argv:  # the author has a STIX of the system
    from matplotlib import font_manager as fonts
    fonts.fontManager.ttflist.insert(0, fonts.FontEntry("/usr/share/fonts/other.ttf", "STIXGeneral"))
from quizgen.figures import engine
from matplotlib import font_manager
print(font_manager.findfont("STIXGeneral"))
"""


@pytest.mark.slow
@pytest.mark.parametrize("way", ["alone", "plots"])
def test_letters_are_those_that_matplotlib_brings(tmp_path, way):
    done = subprocess.run([sys.executable, "-c", FONTS, way], cwd=HERE.parents[1], check=True,
                          env=os.environ | {"XDG_CACHE_HOME": str(tmp_path)},
                          capture_output=True, text=True)  # fmt: skip
    own = Path(mpl.get_data_path()).resolve()
    assert Path(done.stdout.strip()).resolve().is_relative_to(own)
    scanned = [*tmp_path.rglob("fontlist-*.json")]
    assert bool(scanned) == (way == "plots")  # else a first process waits for the machine's fonts


def test_pixels_stay_sharp_on_paper(tmp_path):
    two = np.array([[0.0, 1.0]])
    figure = plot(lambda ax: ax.imshow(two, aspect="auto", vmin=0, vmax=1), SQUARE)
    left, right = (seen(figure, tmp_path, (at, 0.3)) for at in (0.4, 0.7))
    assert (left, right) == ((0, 0, 0), (255, 255, 255))
