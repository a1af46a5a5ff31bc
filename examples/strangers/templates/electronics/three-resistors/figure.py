"""A source and three resistors, in series or parallel."""

from quizgen.figures.kit import Parameter, format_given

PARAMETERS = {
    "k": Parameter("", "1 parallel, 0 in series", 0, 0, 1, whole=True),
    "U": Parameter("V", "voltage"),
} | {f"R_{n}": Parameter("ohm", f"resistor {n}") for n in (1, 2, 3)}
SIZE = (250, 130)


def draw(fig, values, *, quiz):
    art, parallel = fig.sketch(), bool(values["k"])
    art.line([(30, 58), (30, 15), (230, 15)], "ink", 1)
    art.line([(30, 62), (30, 105), (230, 105)], "ink", 1)
    art.line([(20, 62), (40, 62)], "ink", 1)
    art.line([(25, 58), (35, 58)], "ink", 2)
    art.label((44, 60), f"{format_given(values['U'])} V", "lm")
    if not parallel:
        art.line([(230, 15), (230, 105)], "ink", 1)
    for n in (1, 2, 3):
        x = 50 + 55 * n
        name = f"{format_given(values[f'R_{n}'])} Ω"
        if parallel:
            art.line([(x + 15, 15), (x + 15, 105)], "ink", 1)
            art.area([(x + 10, 42), (x + 20, 42), (x + 20, 78), (x + 10, 78)], "paper", "ink")
            art.label((x + 6, 60), name, "rm")
        else:
            art.area([(x - 8, 100), (x + 28, 100), (x + 28, 110), (x - 8, 110)], "paper", "ink")
            art.label((x + 10, 116), name, "cb")
    if parallel:
        art.line([(230, 15), (230, 15)], "ink", 1)


def alt(values, lang, *, quiz):
    how = "in parallel" if values["k"] else "in series"
    parts = ", ".join(f"{format_given(values[f'R_{n}'])} Ω" for n in (1, 2, 3))
    return f"A source of {format_given(values['U'])} V and three resistors {how}: {parts}."
