"""What several classes, of several years, taught about templates: a row for each part, as CSV.

Classical values are pooled over classes by their students: difficulty as a mean, discrimination by
Fisher's transformation of the correlations. From ``ENOUGH`` answers on the two-parameter logistic
model is fitted by mirt, if it is installed: an answer counts as right from half of its points on,
and years are held together by what they asked alike.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

import numpy as np

from quizgen.classes.analysis_page import iter_marks_with_outlines
from quizgen.classes.class_folder import ClassFolder
from quizgen.classes.gradebook import FOLDER
from quizgen.classes.grading import StudentMarks
from quizgen.classes.grading_history import GradingHistory
from quizgen.classes.item_analysis import ItemStatistics, analyse_class
from quizgen.classes.key_index import KeyIndex
from quizgen.classes.rulings import read_filled_rows
from quizgen.core.errors import ClassError, has_extra
from quizgen.core.files import PRIVATE, write_all
from quizgen.core.untrusted import format_csv

FILE = "templates.csv"
COLUMNS = ("template", "part", "classes", "students", "points", "difficulty", "discrimination",
           "blank", "minutes", "a", "b", "mistakes")  # fmt: skip
ENOUGH = 200
"""Answers to an item from which the two-parameter model is fitted."""
FEWEST_ITEMS = 4
"""Items of that model."""
SURE = 0.999
"""Largest correlation that Fisher's transformation takes."""


@dataclass
class PartHistory:
    """What is known of one part of a template over all classes that were asked it.

    Parameters
    ----------
    template, part : str
    classes : list of str
        Their names.
    found : list of ItemStatistics
        Of each of them.
    slope, place : float or None
        Of the two-parameter model: discrimination and difficulty on the scale of the abilities.
    """

    template: str
    part: str
    classes: list[str] = field(default_factory=list)
    found: list[ItemStatistics] = field(default_factory=list)
    slope: float | None = None
    place: float | None = None

    @property
    def students(self) -> int:
        """Return of how many students the points are known."""
        return sum(one.students for one in self.found)

    @property
    def difficulty(self) -> float | None:
        """Return the mean share of the points over all students; None if nobody has any."""
        rows = [(one.students, one.difficulty) for one in self.found if one.difficulty is not None]
        total = sum(count for count, _ in rows)
        return sum(count * value for count, value in rows) / total if total else None

    @property
    def discrimination(self) -> float | None:
        """Return the pooled correlation with the points of all other parts."""
        rows = [
            (one.students - 3, max(-SURE, min(SURE, one.discrimination)))
            for one in self.found
            if one.discrimination is not None and one.students > 3
        ]
        total = sum(count for count, _ in rows)
        return math.tanh(sum(n * math.atanh(r) for n, r in rows) / total) if total else None

    @property
    def minutes(self) -> float | None:
        """Return the median time of the whole question over all whose time is known."""
        known = [time for one in self.found for time in one.seconds]
        return median(known) / 60 if known else None

    @property
    def mistakes(self) -> Counter[str]:
        """Return how many students made each named mistake."""
        found = Counter[str]()
        for one in self.found:
            found.update({mistake.note: mistake.students for mistake in one.mistakes})
        return found

    def format_row(self) -> list[str]:
        """Return the cells of the row, in the order of ``COLUMNS``."""
        points = max((one.points for one in self.found), default=0.0)
        named = "; ".join(f"{count} {note}" for note, count in self.mistakes.most_common())
        values = (points, self.difficulty, self.discrimination)
        return [self.template, self.part, " ".join(self.classes), str(self.students),
                *map(_format_value, values), str(sum(one.blank for one in self.found)),
                *map(_format_value, (self.minutes, self.slope, self.place)), named]  # fmt: skip


def _format_value(value: float | None) -> str:
    """Return a value with four digits; empty if it is not known."""
    return "" if value is None else f"{value:.4g}"


def collect_template_history(folders: Iterable[ClassFolder]) -> list[PartHistory]:
    """Return what classes taught about templates, by template and part.

    Raises
    ------
    ClassError
        If one of them has not been marked.
    """
    found: dict[str, PartHistory] = {}
    shares: list[dict[str, float]] = []
    for folder in folders:
        pairs = [*iter_marks_with_outlines(GradingHistory(folder.path), KeyIndex(folder))]
        if not pairs:
            raise ClassError(f"{folder.path}: nothing has been marked yet (quizgen class mark)")
        for item in analyse_class(pairs).items:
            template, _, part = item.item.partition("/")
            row = found.setdefault(item.item, PartHistory(template.partition(":")[0], part))
            row.classes.append(folder.settings.name)
            row.found.append(item)
        shares += [_index_shares(marks) for marks, _ in pairs]
    for name, (slope, place) in fit_two_parameters(shares).items():
        found[name].slope, found[name].place = slope, place
    return sorted(found.values(), key=lambda one: (one.template, one.part))


def _index_shares(marks: StudentMarks) -> dict[str, float]:
    """Return the share of its points for each item of a student that is decided and counts."""
    return {part.item: part.share for part in marks.parts if part.share is not None}


def fit_two_parameters(
    shares: Sequence[Mapping[str, float]],
) -> dict[str, tuple[float, float]]:
    """Return discrimination and difficulty of the items that were answered often enough.

    None are returned where the package is missing, there are too few items, or it finds no end.

    Parameters
    ----------
    shares : sequence of mapping of str to float
        For each student, the share of the points of each item.
    """
    ones: dict[str, set[bool]] = defaultdict(set)
    counts = Counter[str]()
    for row in shares:
        counts.update(row.keys())
        for item, share in row.items():
            ones[item].add(share >= 0.5)
    # An item that all got right, or all wrong, has no place on the scale.
    items = sorted(
        item for item, count in counts.items() if count >= ENOUGH and len(ones[item]) > 1
    )
    if len(items) < FEWEST_ITEMS or not has_extra("irt"):
        return {}
    import mirt

    table = np.array([[_code_answer(row.get(item)) for item in items] for row in shares])
    fitted = mirt.fit_mirt(table[(table >= 0).any(axis=1)], model="2PL")
    if not fitted.converged:
        return {}
    slopes, places = (
        np.ravel(fitted.model.parameters[name]) for name in ("discrimination", "difficulty")
    )
    return {item: (float(a), float(b)) for item, a, b in zip(items, slopes, places, strict=True)}


def _code_answer(share: float | None) -> int:
    """Return 1 for an answer that counts as right, 0 for another one, -1 for none."""
    return -1 if share is None else int(share >= 0.5)


def write_template_history(folder: ClassFolder, earlier: Sequence[ClassFolder]) -> Path:
    """Write what a class and earlier ones taught about templates; return the path of the table.

    Raises
    ------
    ClassError
        If one of them has not been marked.
    """
    rows = collect_template_history([folder, *earlier])
    data = format_csv([COLUMNS, *(one.format_row() for one in rows)]).encode("utf-8-sig")
    return write_all(folder.path / FOLDER, {FILE: data}, PRIVATE)[0]


def read_difficulties(path: Path) -> dict[str, float]:
    """Return how difficult each template was over all its parts, from a table of the kind above.

    Raises
    ------
    ClassError
        Naming file and line.
    """
    if not path.exists():
        raise ClassError(f"{path}: there is no such file", rule="QG651")
    sums: dict[str, list[float]] = defaultdict(lambda: [0.0, 0.0])
    for at, cells in read_filled_rows(path, {"template", "points", "difficulty"}):
        if not cells["difficulty"]:
            continue
        try:
            points, difficulty = float(cells["points"]), float(cells["difficulty"])
        except ValueError:
            raise ClassError(
                f"{path}: line {at}: points and difficulty are numbers", rule="QG651"
            ) from None
        sums[cells["template"]][0] += points * difficulty
        sums[cells["template"]][1] += points
    return {name: got / of for name, (got, of) in sums.items() if of > 0}
