"""Box plots of the four groups."""

from quizgen.figures.kit import Parameter, format_given

GROUPS = ("1", "2", "3", "4")
PARAMETERS = {f"x_{n}": Parameter("", f"scores of group {n}", kind="list") for n in GROUPS}
SIZE = (250, 130)


def draw(ax, values, *, quiz):
    ax.boxplot([values[f"x_{n}"] for n in GROUPS], tick_labels=GROUPS)
    ax.set_xlabel("group")
    ax.set_ylabel("score")


def alt(values, lang, *, quiz):
    listed = "; ".join(f"{n}: {', '.join(map(format_given, values[f'x_{n}']))}" for n in GROUPS)
    return f"Box plots of the scores of four groups. {listed}."
