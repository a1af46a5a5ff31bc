"""The effects of a view in a row: what is known before each, and what becomes of an error."""

from __future__ import annotations

import math
from functools import cached_property

from msgspec.structs import replace

from quizgen.camera.effect import Effect, same_error, same_stack
from quizgen.camera.facts import LARGEST, NO_ERROR, Error, Facts, LayerFacts
from quizgen.camera.margins import views
from quizgen.camera.scene import SceneError
from quizgen.camera.view import View

GREY_LEVELS = 255.0

EXACT, SKIP = "", "skip"

_FAR = 4.0
"""How much smaller than a loss the error may still become, at two stops less light."""

_LAYERED = "scene", "optics"
"""Stages in which layers are still apart."""

_EVEN = LayerFacts((0.0, 0.0), (0.0, 0.0))

_ROUNDING = 5e-7
"""What single precision adds to a difference in one step, relative to the largest value."""


class Chain:
    """The present effects of one view with their facts; predicts the error of any choice.

    Parameters
    ----------
    present : tuple of Effect
    view : View
        The frame.
    facts : Facts
        Of the drawn layers, with their margin.
    seen : tuple of View, optional
        What each effect works on, if that is known.
    arrived : Error
        By how much two pictures differ before the first effect.
    like : Chain, optional
        The same effects for a picture of the same range with other steps. What looks at no
        neighbour is taken from there: none of its bounds depends on steps.
    """

    def __init__(
        self,
        present: tuple[Effect, ...],
        view: View,
        facts: Facts,
        seen: tuple[View, ...] | None = None,
        arrived: Error = NO_ERROR,
        like: Chain | None = None,
    ) -> None:
        self.present, self.view, self.facts, self.arrived = present, view, facts, arrived
        self.views = views(present, view) if seen is None else seen
        self._made: dict[tuple[int, str], Error] = {}
        self._passed: list[dict[Error, Error]] = [{} for _ in present]
        self._known: dict[frozenset[tuple[int, str]], float] = {}
        self._inert = [_is_inert(effect) for effect in present]
        if like is None:
            self.before = _facts_along(present, self.views, facts)
            self._rounding = [_rounding(before) for before in self.before]
        else:
            self._borrow(like)

    @cached_property
    def beside(self) -> list[int]:
        """Which effects look at neighbours, so that their bounds depend on steps."""
        return [index for index, effect in enumerate(self.present) if effect.around != 0]

    def _borrow(self, like: Chain) -> None:
        """Follow the facts as far as an effect looks at neighbours, and take all else."""
        self.beside = beside = like.beside
        count = beside[-1] + 1 if beside else 0
        facts = _facts_along(self.present[:count], self.views[:count], self.facts)
        self.before, self._passed = like.before.copy(), like._passed.copy()
        self._rounding = like._rounding
        for index in beside:
            self.before[index], self._passed[index] = facts[index], {}
        self._made.update({key: off for key, off in like._made.items() if key[0] not in beside})

    def off(self, index: int, made: str) -> Error:
        """Error of a choice other than exact, worked out when first asked for."""
        found = self._made.get((index, made))
        if found is None:
            found = self._made[index, made] = self._off(index, made)
        return found

    def _off(self, index: int, made: str) -> Error:
        effect, facts, view = self.present[index], self.before[index], self.views[index]
        if made == SKIP:
            return self._lost(index, facts)
        rung = next(rung for rung in effect.rungs if rung.name == made)
        return rung.error(facts, view).more(self._rounding[index])

    def error(self, choice: dict[int, str], before: int | None = None) -> Error:
        """Difference to running everything exactly, in the end or before an effect.

        Choices not given are exact.
        """
        first = min(choice, default=0) if self.arrived is NO_ERROR else 0
        return self._followed(self.arrived, first, choice, before)

    def _followed(
        self, error: Error, first: int, choice: dict[int, str], before: int | None = None
    ) -> Error:
        made_of = choice.get
        for index in range(first, len(self.present) if before is None else before):
            made = made_of(index, EXACT)
            if error is NO_ERROR:
                error = error if made == EXACT else self.off(index, made)
            elif made == SKIP:
                lost = self.off(index, SKIP)
                error = error.plus(lost) if self.present[index].random else error.along(lost)
            else:
                if self._inert[index]:
                    error = error.rounded(self._rounding[index])
                else:  # choices differ in one effect: many meet the same error
                    error = self._passed[index].get(error) or self._carried(index, error)
                if made != EXACT:
                    error = error.plus(self.off(index, made))
        return error

    @cached_property
    def _raw(self) -> int:
        """Place of the last effect of the sensor, which is the converter if there is one."""
        return max((i for i, one in enumerate(self.present) if one.stage == "sensor"), default=0)

    def floor(self, choice: dict[int, str]) -> float:
        """Grey levels of the least that can arrive there: rounding, of which it makes a code."""
        least = Error(self._rounding[self._raw - 1]) if self._raw else NO_ERROR
        return GREY_LEVELS * self._followed(least, self._raw, choice).total

    def arrives(self, index: int, made: str) -> bool:
        """Whether what a choice loses differs everywhere where it comes to the converter."""
        if index >= self._raw or made != SKIP or self.present[index].stage != "sensor":
            return index < self._raw
        lost = self.off(index, SKIP)
        return lost.sure > 0.0 or lost.sigma > 0.0

    def least(self, index: int, choice: dict[int, str], enough: float = math.inf) -> float:
        """Grey levels that an effect not run exactly takes, however small the steps before it.

        Not followed any farther once that is more than enough.
        """
        if any(choice.get(later) for later in self.beside if later > index):
            return 0.0  # these may be off by less, too
        effect, error = self.present[index], Error(self._rounding[index])
        if effect.stage in _LAYERED and (floor := self.floor(choice)) > enough:
            return floor
        if effect.stage not in _LAYERED and not effect.rungs:
            error = self._lost(index, replace(self.before[index], layers=(_EVEN,)))
        elif effect.stage == "sensor":
            return 0.0
        return GREY_LEVELS * self._followed(error, index + 1, choice).total

    def _lost(self, index: int, facts: Facts) -> Error:
        """Loss of skipping, with rounding; where a limit of the sensor is not met, none."""
        effect, rounding = self.present[index], self._rounding[index]
        lost = effect.skipped(facts, self.views[index])
        return lost.rounded(rounding) if effect.stage == "sensor" else lost.more(rounding)

    def _carried(self, index: int, error: Error) -> Error:
        carried, effect = error, self.present[index]
        if error != NO_ERROR and error.total != math.inf:
            if not effect.knows_where:
                carried = carried.everywhere()
            if effect.carried is not same_error:
                carried = effect.carried(carried, self.before[index], self.views[index])
            carried = carried.rounded(self._rounding[index])
        self._passed[index][error] = carried
        return carried

    def enlarges(self, index: int) -> bool:
        """Whether an effect makes any error larger that has been followed through it so far."""
        least = 2.0 * self._rounding[index]
        return any(
            after.clipped().total > error.clipped().total + least
            for error, after in self._passed[index].items()
        )

    def dn(self, choice: dict[int, str]) -> float:
        """The same in grey levels."""
        key = frozenset(choice.items())
        found = self._known.get(key)
        if found is None:
            found = self._known[key] = GREY_LEVELS * self.error(choice).total
        return found

    def hopeless(self, indices: tuple[int, ...], made: str, budget: float) -> bool:
        """Whether a choice alone loses so much that following it to the end is a waste of time."""
        far = _FAR * budget / GREY_LEVELS
        return max([self.off(index, made).clipped().total for index in indices]) > far


def _is_inert(effect: Effect) -> bool:
    """Whether an effect hands on errors as they are: in the lens none is beyond 0 and 1 alone."""
    return effect.carried is same_error and (effect.knows_where or effect.stage in _LAYERED)


def _rounding(facts: Facts) -> float:
    return _ROUNDING * max(facts.size, facts.top)


def _facts_along(present: tuple[Effect, ...], seen: tuple[View, ...], facts: Facts) -> list[Facts]:
    before = []
    for effect, view in zip(present, seen, strict=True):
        if effect.stage not in _LAYERED:
            facts = facts.flat()
        before.append(facts)
        rounded = facts.rounded + _ROUNDING * (effect.run is not same_stack)
        facts = replace(effect.after(facts, view), rounded=rounded)
        if not facts.size + facts.reach < LARGEST:
            raise SceneError(f"{effect.name} makes signals of more than {LARGEST:g}")
    return before
