"""Four states of a made-up map, one of them marked."""

from quizgen.figures.kit import Parameter

SIZE = (240, 130)
PARAMETERS = {"k": Parameter("", "place of the marked state")}
PLACES = ((10, 70), (120, 70), (10, 10), (120, 10))


def draw(fig, values, *, quiz):
    """Draw the states as fields, the wanted one shaded."""
    del quiz
    sketch = fig.sketch()
    for place, (x, y) in enumerate(PLACES, 1):
        corners = [(x, y), (x + 100, y), (x + 100, y + 50), (x, y + 50)]
        sketch.area(corners, "shade" if place == round(values["k"]) else "paper", "ink")
        sketch.label((x + 14, y + 38), str(place))


def alt(values, lang, *, quiz):
    """Say which field is shaded."""
    del lang, quiz
    return f"Four fields, numbered from 1 at the upper left to 4; number {values['k']:g} is shaded."
