"""Mechanisms whose inverse is a root search: a branch of a pose may have several solutions."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterable, Sequence
from functools import partial

from softkin._configuration import AUTOMATIC, Slot, slots
from softkin._constants import COINCIDENT
from softkin._core import Mechanism
from softkin._types import (
    Diagnosis,
    FrameLike,
    Numbers,
    Reals,
    Rotation,
    Signs,
    Solution,
    Status,
    Turns,
    Values,
    Vector,
)

_SAME = 2e-3
"""Axes that differ by less than this (degrees, lengths) are one solution of a branch: where the residual only touches
zero, the search finds the same root twice, and between two solutions of a branch there is one of another branch."""


class SearchedInverse(Mechanism):
    """A mechanism whose inverse searches one joint: for one branch, the solution nearest to the reference."""

    __slots__ = ()

    SIDES = 2
    """One scan is made for each choice of this many first branches; it finds the solutions of all other branches."""

    def inverse_all(self, frame: FrameLike, reference: Numbers | None = None) -> Sequence[Solution]:
        """Every branch of the inverse, in fixed slots: branch 1 before branch 2, the first byte varies fastest.

        A branch may have several solutions: `axes` is the one nearest to the reference along the scanned joint, and
        `others` has the rest in this order. Solutions beyond limits are left out; periods are open, as in `inverse`.
        A slot without axes has a status. Raises BAD_INPUT only for input that does not have the form of a frame.
        """
        position, rows = self._pose(frame)
        near, rotation, every = self._near(reference), self._made(rows), slots((AUTOMATIC,) * self.BRANCHES)
        if isinstance(rotation, Diagnosis):
            return tuple(self._solution(slot, rotation) for slot in every)
        turns = (0,) * len(self.PERIOD_AXES)
        given = self._search_given(position, rotation, every[0][1], turns, near)
        explained = partial(self._explained, position, rotation, near)
        if isinstance(given, Status):
            return tuple(explained(slot, int(given)) for slot in every)
        if not self._is_searched():
            answers = (self._branch(position, rotation, slot[1], turns, near) for slot in every)
            return tuple(map(self._solution, every, (self._refused_or(axes) for axes in answers)))
        found: dict[Signs, list[Reals]] = {}
        for signs in dict.fromkeys(slot[1][: self.SIDES] for slot in every):
            given = self._search_given(position, rotation, (*signs, *(0,) * (self.BRANCHES - self.SIDES)), turns, near)
            for joints in self._all_joints(given) if not isinstance(given, Status) else ():
                self._sort_in(found, self._from_joints(joints, turns, near))
        return tuple(self._solutions(explained, slot, found.get(slot[1], [])) for slot in every)

    def _every_solution(
        self, position: Vector, rotation: Rotation, reference: Reals
    ) -> Iterable[tuple[Signs, Reals | Diagnosis]]:
        """Every root of every scan, then that of the branch of the reference next to it; else why there is none."""
        if not self._is_searched():
            yield from super()._every_solution(position, rotation, reference)
            return
        turns, every = (0,) * len(self.PERIOD_AXES), slots((AUTOMATIC,) * self.BRANCHES)
        found: dict[Signs, list[Reals]] = {signs: [] for _, signs in every}
        for signs in dict.fromkeys(slot[1][: self.SIDES] for slot in every):
            given = self._search_given(
                position, rotation, (*signs, *(0,) * (self.BRANCHES - self.SIDES)), turns, reference
            )
            for joints in self._all_joints(given) if not isinstance(given, Status) else ():
                self._sort_in(found, self._from_joints(joints, turns, reference))
        pose = self._forward(reference)
        near = every[0][1] if isinstance(pose, Status) else tuple(1 if margin > 0.0 else -1 for margin in pose[2])
        own = self._branch(position, rotation, near, turns, reference)
        answers = [(signs, axes) for _, signs in every for axes in found[signs]]
        if not isinstance(own, Diagnosis):
            answers.append((near, own))
        yield from answers
        if not answers:
            yield from super()._every_solution(position, rotation, reference)

    def _has_one_solution_a_branch(self) -> bool:
        return not self._is_searched()

    def _sort_in(self, found: dict[Signs, list[Reals]], axes: Reals | Status) -> None:
        """Add a solution under the signs of its branch; where branches coincide, under the signs of both."""
        pose = self._forward(axes) if not isinstance(axes, Status) else axes
        if isinstance(pose, Status) or isinstance(axes, Status):
            return
        signs: list[Signs] = [()]
        for margin in pose[2]:
            sides = (1, -1) if abs(margin) < COINCIDENT else (1 if margin > 0.0 else -1,)
            signs = [(*s, side) for s in signs for side in sides]
        for key in signs:
            others = found.setdefault(key, [])
            if not any(self._are_same(axes, other) for other in others):
                others.append(axes)

    def _refused_or(self, axes: Reals | Diagnosis) -> Reals | Diagnosis:
        """The axes if they are inside their limits, else the reason why not."""
        return axes if isinstance(axes, Diagnosis) else self._beyond_limits(axes) or axes

    def _solutions(
        self, explained: Callable[[Slot, Reals | int], Solution], slot: Slot, found: Sequence[Reals]
    ) -> Solution:
        """The slot with its solutions inside the limits, the nearest one first."""
        allowed = [axes for axes in found if self._beyond_limits(axes) is None]
        first = explained(slot, allowed[0] if allowed else int(Status.UNREACHABLE))
        return first._replace(others=tuple(allowed[1:]))

    def _are_same(self, axes: Reals, other: Reals) -> bool:
        """Whether the axes differ by full turns alone."""
        apart = [abs(a - b) for a, b in zip(axes, other, strict=True)]
        for index, turns in zip(self.PERIOD_AXES, self._turn_sizes(), strict=True):
            apart[index] = abs((turns * apart[index] + 180.0) % 360.0 - 180.0) / turns
        return max(apart) < _SAME

    @abstractmethod
    def _is_searched(self) -> bool:
        """Whether there is no closed form for this machine."""

    @abstractmethod
    def _search_given(
        self, position: Vector, rotation: Rotation, signs: Signs, turns: Turns, reference: Reals
    ) -> Values | Status:
        """The arguments of the search."""

    @abstractmethod
    def _all_joints(self, given: Values) -> list[Reals]:
        """The joints at every root, nearest to the reference first."""

    @abstractmethod
    def _from_joints(self, joints: Reals, turns: Turns, reference: Reals) -> Reals | Status:
        """The axis values of joint values, on the commanded turns."""
