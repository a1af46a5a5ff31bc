"""Compare what users get with what another commit made: ``tools/compare_outputs.py COMMIT``.

Papers with keys and forms, decks, exports, formula sheets, a class folder and pictures are made by
both states of the code, and their bytes are compared. The digest of a template's code in a key may
differ: it says that the code of a figure was edited, and nothing that is printed or marked.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parent.parent
ROSTER = "id,name\n1001,Ada\n1002,Bela\n1003,Chandra\n"
BLUEPRINTS = ("mock", "trial")
COMMANDS = (
    *(
        ["exam", "--seed", "7", "--lang", "both", "--blueprint", name, "--out", f"exam-{name}"]
        for name in BLUEPRINTS
    ),
    *(
        ["exam", "--seed", "8", "--lang", "bn", "--level", level, "--out", f"exam-{level}"]
        for level in ("guided", "transfer")
    ),
    *(
        ["export", name, "--seed", "3", "--out", f"export-{name}"]
        for name in ("moodle", "qti21", "qti3", "canvas")
    ),
    ["cards", "--format", "tsv", "--out", "cards"],
    ["sheet", "--out", "sheet"],
    ["simulate", "portrait", "--out", "portrait.png"],
    ["class", "make", "roster.csv", "--out", "class"],
)
DIGEST = re.compile(rb'"digest": ?"[0-9a-f]+"')


def make_outputs(code: Path, folder: Path) -> dict[str, bytes]:
    """Run every command with the code in a folder; return the bytes of each file by name.

    Exit code and messages of each command are a file, too.
    """
    (folder / "roster.csv").write_text(ROSTER, "utf-8")
    environment = {**os.environ, "PYTHONPATH": str(code), "XDG_CACHE_HOME": str(folder / "cache")}
    for number, command in enumerate(COMMANDS):
        done = subprocess.run(
            [sys.executable, "-m", "quizgen", *command], cwd=folder, env=environment,
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        said = f"{' '.join(command)}\nexit {done.returncode}\n{done.stderr}"
        (folder / f"command-{number:02}.txt").write_text(said, "utf-8")
    return {
        str(path.relative_to(folder)): DIGEST.sub(b'"digest": ""', path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.is_file() and not path.is_relative_to(folder / "cache")
    }


def main(commit: str) -> int:
    """Print the files that differ or that only one of the two has; 1 if there are any."""
    with tempfile.TemporaryDirectory() as name:
        other, before, after = (Path(name) / part for part in ("code", "before", "after"))
        for folder in (other, before, after):
            folder.mkdir()
        archive = subprocess.run(
            ["git", "archive", commit], cwd=ROOT, capture_output=True, check=True
        )
        subprocess.run(["tar", "x", "-C", str(other)], input=archive.stdout, check=True)
        old = make_outputs(other, before)
        # A class has a secret that nobody can give it: the new code goes on with the old folder.
        shutil.copytree(before / "class", after / "class")
        new = make_outputs(ROOT, after)
        different = [path for path in sorted({*old, *new}) if old.get(path) != new.get(path)]
        for path in different:
            print(path)
            if path.startswith("command-"):
                print(new.get(path, b"").decode("utf-8", "replace"))
    print(f"{len(old)} files, {len(different)} of them different")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
