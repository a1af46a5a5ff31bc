"""Take the pictures of the shipped scenes again: ``docs/scenes.jpg``, by the order of names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from quizgen.camera import PreparedScene, run_plan
from quizgen.camera.pixels.codecs import WRITERS
from quizgen.camera.scene_file import load_scene
from quizgen.cli.simulate import SCENES

TARGET = Path(__file__).parent.parent / "docs" / "scenes.jpg"
SIZE = 320, 240
COLUMNS = 4


def main() -> None:
    """Render each scene with every effect, small, four in a row, into ``docs/scenes.jpg``."""
    taken = [
        Image.fromarray(run_plan(PreparedScene(*load_scene(path))).pixels()).resize(
            SIZE, Image.Resampling.BOX
        )
        for path in sorted(SCENES.glob("*.toml"))
    ]
    rows = [taken[start : start + COLUMNS] for start in range(0, len(taken), COLUMNS)]
    sheet = np.concatenate([np.concatenate(list(map(np.asarray, row)), axis=1) for row in rows])
    TARGET.write_bytes(WRITERS[".jpg"](sheet))


if __name__ == "__main__":
    main()
