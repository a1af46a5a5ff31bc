"""Box plots of two samples."""

from quizgen.figures.kit import Parameter, format_given

PARAMETERS = {name: Parameter("", f"sample {name}", kind="list") for name in "xy"}
SIZE = (220, 140)


def draw(ax, values, *, quiz):
    ax.boxplot([values["x"], values["y"]], tick_labels=["$x$", "$y$"])
    ax.set_xlabel("sample")
    ax.set_ylabel("reading")


def alt(values, lang, *, quiz):
    x, y = (", ".join(map(format_given, values[name])) for name in "xy")
    return f"Box plots of two samples. x: {x}. y: {y}."
