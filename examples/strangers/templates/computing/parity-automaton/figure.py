"""A diagram of four states: parities of the letters read so far."""

from quizgen.figures.kit import Parameter

PARAMETERS = {"goal": Parameter("", "accepting state, 0 to 3", 0, 0, 3, whole=True)}
SIZE = (230, 190)
PLACES = [(60, 140), (170, 140), (60, 40), (170, 40)]


def draw(fig, values, *, quiz):
    art, goal = fig.sketch(), int(values["goal"])
    for state, (x, y) in enumerate(PLACES):
        art.arc((x, y), 20, 0, 360)
        if state == goal:
            art.arc((x, y), 16.5, 0, 360)
        art.label((x, y), f"$q_{state}$", "cm")
    art.arrow((12, 140), (40, 140))
    for shift, sign in ((-5, 1), (5, -1)):
        for row in (140, 40):
            start, stop = (81, 149) if sign > 0 else (149, 81)
            art.arrow((start, row + shift), (stop, row + shift))
        for column in (60, 170):
            start, stop = (61, 119) if sign > 0 else (119, 61)
            art.arrow((column + shift, start), (column + shift, stop))
    for x, y, letter in ((115, 152, "b"), (115, 28, "b"), (46, 90, "a"), (184, 90, "a")):
        art.label((x, y), f"${letter}$", "cm")


def alt(values, lang, *, quiz):
    return (
        "State diagram. It starts in q0. Reading a leads from q0 to q2 and back, from q1 to q3 and "
        "back; b from q0 to q1 and back, from q2 to q3 and back. "
        f"The accepting state is q{int(values['goal'])}."
    )
