"""Bring what bank, layouts and a round of papers come to with the wheel: nobody waits for it."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Keep(BuildHookInterface):  # type: ignore[type-arg]
    """Loads all templates and layouts and chooses the first papers while their wheel is built."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add what is kept to the files of the wheel; a checkout keeps it when it is asked."""
        if version == "editable":
            return
        sys.path.insert(0, self.root)
        from quizgen.bank.bank import Bank
        from quizgen.core import cache
        from quizgen.paper.blueprint import load_blueprint
        from quizgen.paper.quota import ROUND
        from quizgen.paper.selection import select_templates
        from quizgen.render.layouts import precompile_layouts

        self._made = tempfile.TemporaryDirectory()
        cache.user_cache_folder = lambda: Path(self._made.name)
        bank = Bank(Path(self.root), trusted=True)
        list(bank)
        select_templates(bank, load_blueprint("mock"), ROUND - 1)
        precompile_layouts("quizgen.render")
        build_data["force_include"][self._made.name] = "quizgen/builtin/kept"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove what was made for the wheel."""
        del build_data, artifact_path
        if version != "editable":
            self._made.cleanup()
