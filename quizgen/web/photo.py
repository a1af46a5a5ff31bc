"""A photograph with its plan, and everything-on beside it; made in a worker."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from quizgen.bank.folder import Bank

if TYPE_CHECKING:
    from quizgen.camera.camera import Camera
    from quizgen.camera.decision import Plan
    from quizgen.camera.scene import Image

SCENES = ("portrait", "landscape", "night", "texture", "flat", "propeller", "fisheye", "pinhole")
BUDGETS = ("same", "visible", "sketch")

OFF = math.nan
"""A camera that has not got the thing at all."""
LENS = frozenset({"f_number", "focus_distance", "k1"})
"""Settings that need a lens."""
SENSOR = frozenset({"read_noise", "full_well"})
"""Settings of a sensor that counts electrons."""

STOPS: dict[str, tuple[float, ...]] = {
    "f_number": (1, 1.4, 1.8, 2, 2.8, 4, 5.6, 8, 11, 16, 22, 32),
    "focus_distance": (0.5, 1, 1.5, 2, 2.5, 3, 5, 8, 12, 30, 100, 1200, math.inf),
    "exposure": (-4, -3, -2, -1, 0, 1, 2, 3, 4),
    "k1": (-0.4, -0.25, -0.1, -0.05, 0, 0.05, 0.1, 0.25, 0.4),
    "full_well": (100, 500, 2000, 5000, 15000, 20000, 30000, 60000, 200000),
    "read_noise": (0, 1, 2, 3, 6, 12, 25, 50, 100),
    "gaussian_noise": (0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2),
    "bit_depth": (OFF, 1, 2, 3, 4, 5, 6, 8, 10, 12, 14),
}
"""Where each slider can stand, in base units; besides, wherever the scene itself has it."""


class Slider(msgspec.Struct, frozen=True):
    """A setting, where it can stand, and where the scene has it."""

    name: str
    stops: tuple[float, ...]
    own: int


class Shot(msgspec.Struct, frozen=True):
    """A photograph, its plan and what everything-on makes of the scene; pictures as PNG."""

    taken: bytes
    whole: bytes
    difference: bytes
    gain: float
    """What the difference was multiplied by; 0 where there is none."""
    apart: float
    """Largest difference, in grey levels."""
    ran: list[tuple[str, str, float]]
    """Effect, how it ran (``exact``, ``asked`` or ``cheaper``), and what it can change."""
    skipped: list[tuple[str, float]]
    absent: list[str]
    budget: float
    bound: float
    takes: float
    """Predicted, in ms."""
    whole_takes: float


@dataclass(frozen=True)
class Shoot:
    """What to photograph: a shipped scene with other settings of its camera."""

    scene: str
    changes: tuple[tuple[str, float], ...]
    budget: str

    def run(self, bank: Bank) -> bytes:
        """Take it twice: as planned, and with everything on.

        Raises
        ------
        SceneError
            If no camera can be set like that.
        """
        del bank
        from quizgen.camera.plan import Prepared, everything, plan
        from quizgen.camera.reading import load
        from quizgen.camera.simulate import difference_dn, run

        scene, camera = load(_file(self.scene))
        prepared = Prepared(scene, self._set(camera))
        photo = run(prepared, plan(prepared, budget=self.budget))
        whole = run(prepared, everything(prepared))
        gain, difference = _amplified(photo.values, whole.values)
        return msgspec.msgpack.encode(
            Shot(
                _png(photo.values), _png(whole.values), difference, gain,
                difference_dn(photo, whole),
                _ran(photo.plan),
                [(one.effect, one.bound_dn) for one in photo.plan.skipped],
                list(photo.plan.absent),
                photo.plan.budget,
                photo.plan.predicted_error_dn,
                photo.plan.predicted_ms,
                whole.plan.predicted_ms,
            )
        )  # fmt: skip

    def _set(self, camera: Camera) -> Camera:
        changes: dict[str, object] = dict(self.changes)
        if "bit_depth" in changes:
            bits = dict(self.changes)["bit_depth"]
            changes["bit_depth"] = None if math.isnan(bits) else int(bits)
        return camera.but(**changes)


def _file(scene: str) -> Path:
    return Path(str(files("quizgen.camera") / "scenes" / f"{scene}.toml"))


def _ran(plan: Plan) -> list[tuple[str, str, float]]:
    def how(rung: str, reason: str) -> str:
        return "cheaper" if rung else "asked" if reason == "asked about" else "exact"

    return [(step.effect, how(step.rung, step.reason), step.bound_dn) for step in plan.steps]


def _png(values: Image) -> bytes:
    import numpy as np

    from quizgen import png
    from quizgen.camera.codes import rounded

    return png.compact(rounded(values * np.float32(255)))


def _amplified(one: Image, other: Image) -> tuple[float, bytes]:
    """How far two pictures lie apart, so bright that the largest difference is white."""
    import numpy as np

    apart = np.abs(one - other)
    largest = float(apart.max())
    gain = 2.0 ** math.floor(-math.log2(largest)) if largest > 0 else 0.0
    return gain, _png(apart * np.float32(gain))


@cache
def sliders(scene: str) -> tuple[Slider, ...]:
    """What can be changed of a scene's camera."""
    from quizgen.camera import effects
    from quizgen.camera.reading import load

    camera = load(_file(scene))[1]
    lens = {"focal_length", "pixel_pitch"} <= camera.given.keys()
    known = effects.settings()
    found = []
    for name, stops in STOPS.items():
        if (name in LENS and not lens) or (name in SENSOR and "full_well" not in camera.given):
            continue
        value = camera.given.get(name, known[name].identity)
        own = OFF if value is None else float(str(value))
        places = tuple(sorted({*stops, own} - {OFF}, key=float))
        places = (OFF, *places) if OFF in stops or math.isnan(own) else places
        found.append(Slider(name, places, _place(places, own)))
    return tuple(found)


def _place(stops: tuple[float, ...], value: float) -> int:
    return 0 if math.isnan(value) else stops.index(value)
