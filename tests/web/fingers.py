"""Fingers and pens, as Chromium gets them from a screen: it makes pointer events and scrolls."""

from __future__ import annotations

from collections.abc import Iterable

Point = tuple[float, float]


class Screen:
    """A touch screen."""

    def __init__(self, page) -> None:
        self._session = page.context.new_cdp_session(page)

    def _touched(self, kind: str, *fingers: Point) -> None:
        points = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(fingers)]
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def finger(self, way: Iterable[Point], beside: Point | None = None) -> None:
        """Draw a finger along a way; another one touches the screen meanwhile and is lifted."""
        begin, *rest = way
        self._touched("touchStart", begin)
        for number, point in enumerate(rest):
            self._touched("touchMove", point)
            if beside and not number:  # and is gone before it moves on
                self._touched("touchStart", point, beside)
                self._touched("touchMove", point, (beside[0] + 9, beside[1] + 9))
                self._touched("touchMove", point)
        self._touched("touchEnd")

    def pen(self, way: Iterable[Point]) -> None:
        """Draw a pen along a way."""
        begin, *rest = way
        pressed = {"button": "left", "buttons": 1, "pointerType": "pen", "force": 0.5}
        for kind, (x, y) in (
            ("mousePressed", begin),
            *(("mouseMoved", point) for point in rest),
            ("mouseReleased", rest[-1]),
        ):
            more = {"clickCount": 1} if kind != "mouseMoved" else {}
            at = {"type": kind, "x": x, "y": y, **pressed, **more}
            self._session.send("Input.dispatchMouseEvent", at)


def between(one: Point, other: Point, steps: int = 8) -> list[Point]:
    """Places on the way from one to another, both among them."""
    (x, y), (u, v) = one, other
    return [(x + (u - x) * t / steps, y + (v - y) * t / steps) for t in range(steps + 1)]
