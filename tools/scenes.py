"""Take the pictures of the shipped scenes anew: ``docs/scenes.jpg``, by the order of names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from quizgen.camera.codecs import WRITERS
from quizgen.camera.reading import load
from quizgen.camera.simulate import simulate_everything
from quizgen.cli.simulate import SCENES

TARGET = Path(__file__).parent.parent / "docs" / "scenes.jpg"
SIZE = 320, 240
COLUMNS = 4


def main() -> None:
    """Photograph each scene with every effect, small, four in a row."""
    taken = [
        Image.fromarray(simulate_everything(*load(path)).pixels()).resize(
            SIZE, Image.Resampling.BOX
        )
        for path in sorted(SCENES.glob("*.toml"))
    ]
    rows = [taken[start : start + COLUMNS] for start in range(0, len(taken), COLUMNS)]
    sheet = np.concatenate([np.concatenate(list(map(np.asarray, row)), axis=1) for row in rows])
    TARGET.write_bytes(WRITERS[".jpg"](sheet))


if __name__ == "__main__":
    main()
