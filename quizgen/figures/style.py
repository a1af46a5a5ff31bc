"""The look of every figure: inks that a page can change, letters of the papers, thin axes."""

from __future__ import annotations

from typing import Any, ClassVar

import quizgen.figures.font_list  # noqa: F401 - before all that sets text

# isort: split
import matplotlib as mpl
from cycler import cycler
from matplotlib.colors import get_named_colors_mapping

from quizgen.figures.inks import INKS

_LIGHT = {name: light for name, (light, _) in INKS.items()}
_DASHES = ("-", (0, (5, 2)), (0, (1.2, 1.6)), (0, (6, 2, 1.2, 2)))
_SETTINGS: dict[str, Any] = {
    "figure.dpi": 72, "figure.facecolor": "none", "figure.edgecolor": "none",
    "font.family": ["STIXGeneral"], "font.size": 10, "mathtext.fontset": "stix",
    "axes.facecolor": "none", "axes.edgecolor": "ink", "axes.linewidth": 0.7,
    "axes.labelcolor": "ink", "text.color": "ink", "xtick.color": "ink", "ytick.color": "ink",
    "axes.spines.top": False, "axes.spines.right": False, "axes.titley": 1.0,
    "axes.labelsize": 10, "axes.labelpad": 3, "axes.titlesize": 10.5, "axes.axisbelow": True,
    "axes.xmargin": 0.03, "axes.ymargin": 0.06, "axes.unicode_minus": True,
    "figure.subplot.hspace": 0.55, "figure.subplot.wspace": 0.3,
    "axes.formatter.use_mathtext": True, "axes.formatter.limits": (-4, 5),
    # Colours and dashes change together: lines differ on grey paper, too.
    "axes.prop_cycle": cycler(color=["blue", "red", "teal", "gold"]) + cycler(linestyle=_DASHES),
    "grid.color": "rule", "grid.linewidth": 0.4, "grid.linestyle": "-",
    "xtick.direction": "out", "ytick.direction": "out",
    "xtick.major.size": 3, "ytick.major.size": 3, "xtick.minor.size": 1.8, "ytick.minor.size": 1.8,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4, "ytick.minor.width": 0.4,
    "xtick.labelsize": 9, "ytick.labelsize": 9, "xtick.major.pad": 2.5, "ytick.major.pad": 3,
    "lines.linewidth": 1.3, "lines.markersize": 4, "lines.scale_dashes": False,
    "patch.linewidth": 0.8, "patch.facecolor": "shade", "patch.edgecolor": "ink",
    "patch.force_edgecolor": False, "hatch.linewidth": 0.5,
    "legend.frameon": False, "legend.fontsize": 9, "legend.handlelength": 1.8,
    "image.interpolation": "none", "image.cmap": "gray",
    "boxplot.medianprops.color": "red", "boxplot.medianprops.linewidth": 1.6,
    "boxplot.boxprops.linewidth": 0.9, "boxplot.whiskerprops.linewidth": 0.8,
    "boxplot.capprops.linewidth": 0.8, "boxplot.flierprops.markersize": 3.5,
    "path.simplify": True, "path.simplify_threshold": 0.06, "path.sketch": None,
    "backend": "agg",  # boxplot() asks for it, and pyplot would be loaded to decide on one
    "svg.fonttype": "path", "svg.hashsalt": "quizgen", "text.hinting": "none",
}  # fmt: skip
# None of these decides what is drawn; asking the process for its backend would load pyplot.
_NOT_DRAWN = ("backend", "webagg", "savefig", "animation", "keymap", "tk.", "interactive",
              "toolbar", "timezone", "macosx", "date")  # fmt: skip


def _complete_settings() -> dict[str, Any]:
    """All settings a drawing depends on, whatever the machine's matplotlibrc says."""
    usual = {k: v for k, v in mpl.rcParamsDefault.items() if not k.startswith(_NOT_DRAWN)}
    with HouseColours():
        return dict(mpl.RcParams({**usual, **_SETTINGS}).items())


class HouseColours:
    """Names of the house's inks inside, those of before afterwards: ``red`` is ours only here."""

    _cache: ClassVar[dict[Any, Any]] = {}

    def __enter__(self) -> None:
        names: Any = get_named_colors_mapping()
        self._before = {name: dict.get(names, name) for name in _LIGHT}
        self._cache_before, names.cache = names.cache, self._cache
        dict.update(names, _LIGHT)

    def __exit__(self, *_: object) -> None:
        names: Any = get_named_colors_mapping()
        names.cache = self._cache_before
        for name, before in self._before.items():
            if before is None:
                dict.pop(names, name)
            else:
                dict.__setitem__(names, name, before)


class HouseStyle(HouseColours):
    """The house's settings inside, those of before afterwards.

    ``matplotlib.rc_context`` does the same in 0.44 ms, as it validates each value; these were
    validated once. Whoever enters holds the lock of the engine: settings belong to the process.
    """

    def __enter__(self) -> None:
        super().__enter__()
        now: Any = mpl.rcParams
        self._settings = {key: dict.__getitem__(now, key) for key in _COMPLETE}
        dict.update(now, _COMPLETE)

    def __exit__(self, *_: object) -> None:
        now: Any = mpl.rcParams
        dict.update(now, self._settings)
        super().__exit__()


_COMPLETE = _complete_settings()
