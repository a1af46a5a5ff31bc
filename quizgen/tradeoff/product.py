"""What a whole paper costs in several arithmetics, and how many keys of questions go wrong."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib.resources import files

from quizgen.bank.draw import Draw, draw
from quizgen.bank.folder import Bank, builtin
from quizgen.bank.plan import Plan
from quizgen.marking.mark import mark, show
from quizgen.marking.specs import AnySpec
from quizgen.maths.numbers import to_float
from quizgen.maths.precision import working_precision
from quizgen.maths.values import Values
from quizgen.shapes import decoded
from quizgen.tradeoff.basis import Basis, basis
from quizgen.tradeoff.measure import Timing, spread
from quizgen.tradeoff.solving import ARITHMETICS, FAILURES, Arithmetic, faults, solved, specs

BLUEPRINT = "mock"
PHASES = ("drawing", "solving", "collisions", "marking")
ROUND = 10_000
"""Questions that counts are said of."""


@dataclass(frozen=True)
class Row:
    """One arithmetic: seconds per paper in each phase and in all."""

    system: str
    phases: dict[str, Timing]
    whole: Timing


@dataclass(frozen=True)
class Counted:
    """Faults of each arithmetic among drawn questions.

    Parameters
    ----------
    date : str
    templates : int
        Over how many templates the questions are spread.
    drawn : int
        How many questions; fewer than ``ROUND`` are extrapolated.
    basis : Basis
        What they were counted from.
    faults : dict of str to dict of str to int
        Arithmetic to fault to the number of questions that have it.
    """

    date: str
    templates: int
    drawn: int
    basis: Basis
    faults: dict[str, dict[str, int]]

    def of_round(self, system: str, fault: str) -> int:
        """How many of ``ROUND`` questions have a fault."""
        return round(self.faults.get(system, {}).get(fault, 0) * ROUND / self.drawn)


@dataclass(frozen=True)
class Product:
    """Every arithmetic, over one paper of so many questions and over drawn ones."""

    questions: int
    rows: tuple[Row, ...]
    counted: Counted


def recorded() -> Counted:
    """What was counted when it was last counted in full."""
    return decoded((files("quizgen.tradeoff") / "counted.json").read_bytes(), Counted)


def measure_product(drawn: int, repeats: int, told: Callable[[str], None]) -> Product:
    """Time a paper, and count faults anew if asked to.

    Parameters
    ----------
    drawn : int
        Questions to draw, spread over all templates of the built-in bank; 0 for what is recorded.
    repeats : int
        Papers that are timed.
    told : callable
        Told the name of each arithmetic and template before it is tried.
    """
    bank = builtin()
    paper = [one for one in _paper(bank) if one.template.chain.steps]
    spent: dict[str, list[dict[str, float]]] = {system: [] for system in ARITHMETICS}
    marked = {system: [_to_mark(drawn, system) for drawn in paper] for system in ARITHMETICS}
    for _ in range(repeats + 1):
        for system, runs in spent.items():
            told(system)
            runs.append(_paper_seconds(paper, system) | {"marking": _marking(marked[system])})
    rows = tuple(_row(system, runs[1:]) for system, runs in spent.items())
    counted = count_faults(bank, drawn, told) if drawn else recorded()
    return Product(len(paper), rows, counted)


def _row(system: str, runs: Sequence[dict[str, float]]) -> Row:
    phases = {phase: spread([run[phase] for run in runs]) for phase in PHASES}
    return Row(system, phases, spread([sum(run.values()) for run in runs]))


def _paper(bank: Bank) -> list[Draw]:
    """A paper of the built-in blueprint."""
    from quizgen.paper.blueprint import load_blueprint
    from quizgen.paper.choose import choose
    from quizgen.paper.draws import draws

    return list(draws(bank, choose(bank, load_blueprint(BLUEPRINT, bank), 1), "1"))


def _paper_seconds(paper: Iterable[Draw], system: str) -> dict[str, float]:
    """Seconds of each phase but marking, all questions of a paper together."""
    total = dict.fromkeys(PHASES, 0.0)
    for drawn in paper:
        for phase, seconds in _drawing(drawn, ARITHMETICS[system]).items():
            total[phase] += seconds
    return total


class _Clock:
    """Seconds by phase."""

    def __init__(self) -> None:
        self.spent = dict.fromkeys(PHASES, 0.0)
        self._since = time.perf_counter()

    def to(self, phase: str) -> None:
        """What was done until now belongs to a phase."""
        now = time.perf_counter()
        self.spent[phase] += now - self._since
        self._since = now

    def skip(self) -> None:
        """What was done until now is no part of any phase."""
        self._since = time.perf_counter()


def _drawing(drawn: Draw, way: Arithmetic) -> dict[str, float]:
    """Make the same tries as the draw did, solved in an arithmetic."""
    plan, template, clock = drawn.plan, drawn.template, _Clock()
    stem = f"{template.origin}/{template.rules.version}/{drawn.seed}/{drawn.slot}"
    for attempt in range(drawn.tries):
        with working_precision():
            shown, _ = plan.candidate(stem, attempt)
            fits = all(condition.test(shown) for condition in plan.early)
        clock.to("drawing")
        if not fits:
            continue
        given = way.given({name: shown[name] * size for name, size in plan.base_factors.items()})
        clock.skip()
        with suppress(*FAILURES):
            found = way.run(template.chain, given)
            clock.to("solving")
            values = way.values(found)
            clock.skip()
            _kept(plan, shown, values, clock)
    return clock.spent


def _kept(plan: Plan, shown: Values, values: Values, clock: _Clock) -> None:
    """Test the conditions on what was solved, and that no mistake scores."""
    with working_precision():
        try:
            env = plan.shown_env(shown, values) if plan.late else {}
            fits = all(condition.test(env) for condition in plan.late)
        except FAILURES:
            fits = False
        clock.to("drawing")
        if fits:
            near = {name: to_float(value) for name, value in values.items()}
            for part in plan.parts:
                part.check(near, shown, lenient=False)
        clock.to("collisions")


def _to_mark(drawn: Draw, system: str) -> list[tuple[AnySpec, str]]:
    """What an arithmetic marks by, and the exact answers; nothing if it has no key."""
    try:
        others = specs(solved(drawn, system))
    except FAILURES:
        return []
    return [(spec, show(right)) for spec, right in zip(others, specs(drawn), strict=True)]


def _marking(answers: Iterable[list[tuple[AnySpec, str]]]) -> float:
    """Seconds to mark all answers of a paper."""
    since = time.perf_counter()
    for question in answers:
        for spec, text in question:
            mark(spec, text, decimal="point")
    return time.perf_counter() - since


def count_faults(bank: Bank, drawn: int, told: Callable[[str], None]) -> Counted:
    """Count the faults of each arithmetic among so many drawn questions.

    Parameters
    ----------
    bank : Bank
    drawn : int
        Questions to draw; templates without a computation count and have none.
    told : callable
        Told the name of each template.
    """
    wrong: dict[str, Counter[str]] = {system: Counter() for system in ARITHMETICS}
    for name, seed in questions(list(bank.paths), drawn):
        template = bank.template(name)
        if not template.chain.steps:
            continue
        told(name)
        one = draw(template, seed)
        for system, counts in wrong.items():
            counts.update(fault for fault, true in asdict(faults(one, system)).items() if true)
    found = {system: dict(counts) for system, counts in wrong.items()}
    return Counted(today(), len(bank.paths), drawn, basis(bank), found)


def today() -> str:
    """The date of a measurement."""
    return datetime.now(UTC).date().isoformat()


def questions(names: Sequence[str], drawn: int) -> Iterator[tuple[str, int]]:
    """So many pairs of a template and a seed, spread evenly over the templates."""
    if drawn < len(names):
        for i in range(drawn):
            yield names[i * len(names) // drawn], 0
        return
    for i in range(drawn):
        yield names[i % len(names)], i // len(names)
