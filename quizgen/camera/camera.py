"""A camera with checked settings."""

from __future__ import annotations

import math

from quizgen.camera import effects
from quizgen.camera.setup.scene import SceneError, SettingError
from quizgen.camera.setup.settings import CameraSettings, suggest_setting


class Camera(CameraSettings):
    """A camera, by the settings that were given; a setting that was not given has no effect at all.

    Parameters
    ----------
    focal_length, pixel_pitch : float or None
        m.
    f_number : float or None
        None is a pinhole.
    focus_distance : float
        Distance in perfect focus, m, may be infinite.
    **more : object
        Any other setting of `quizgen.camera.setup.settings` or of an effect, in base units, such as
        ``k1=-0.2``, ``full_well=2e4`` or ``gamma="srgb"``.

    Raises
    ------
    SceneError
        If a setting is unknown or impossible.
    """

    def __init__(
        self,
        focal_length: float | None = None,
        pixel_pitch: float | None = None,
        f_number: float | None = None,
        focus_distance: float = math.inf,
        **more: object,
    ) -> None:
        lens = {
            "focal_length": focal_length,
            "pixel_pitch": pixel_pitch,
            "f_number": f_number,
            "focus_distance": focus_distance,
        }
        known, given = effects.all_settings(), lens | more
        for name in more.keys() - known.keys():
            raise SceneError(f"unknown key {name!r} in camera{suggest_setting(name, known)}")
        super().__init__({name: x for name, x in given.items() if x != known[name].identity})
        for setting in (setting for name, setting in known.items() if name in self.given):
            for fault in setting.find_faults(self):
                raise SettingError(setting.name, fault)

    def replace(self, **changes: object) -> Camera:
        """Return the same camera with other values of some settings."""
        return Camera(**{**self.given, **changes})  # type: ignore[arg-type]
