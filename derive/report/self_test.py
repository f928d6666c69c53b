"""Test vectors for the controller: calls of a block, and the answers of its programs by the reference interpreter.

All values are drawn with fixed seeds and rounded, so that every computer generates the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import chain, islice

import numpy as np

from derive.description.mechanism import DescriptionError, Joint, Role
from derive.ir.constants import LARGEST, SINGULAR
from derive.ir.interpret import Array
from derive.ir.program import Status
from derive.ir.symbols import MAX_MISS
from derive.kinematics.kinematics import Bytes, Called, Case, Kinematics, Reals, SelfTest
from derive.kinematics.sampling import sample_axes
from derive.report.call_cost import with_operations
from derive.report.reference_calls import Machine, branches, fitted, forward, inverse, machine_with, margins
from derive.work import stage

_CANDIDATES, _LOOP_CANDIDATES = 300, 3000
"""The number of axis values that are drawn: few of them close a loop."""
_TRIED, _SHOWN = 8, 3
"""Regular poses, among which the one with the most solutions is tested on every branch; and how many are tested."""
_NEAR = 0.1
"""The share of the ranges in which poses are sought where none was found in the whole ranges."""
_REGULAR = 0.05
"""Margins at a regular pose are at least this."""
_SINGULAR = 1e-5
"""Margins at a singular pose are at most this, a hundredth of the threshold of IsSingularity."""
_AWAY = 0.02
"""The largest distance of the legs of a platform from those at its home pose."""
_TOO_SHORT = 0.2
"""Legs whose lengths are multiplied by this do not reach the platform."""
_SIZE = 100.0
"""The range of linear axes in a machine without any length."""
_DECIMALS = 6
"""Those of the limits and offsets of a usual machine."""
_MISSED = 1.01
"""A surplus rod whose length is multiplied by this misses the pose of the others."""
_NO_ROTATION = 1.1
"""A rotation multiplied by this is no rotation."""


@stage("the self-test of the machine")
def self_test(kinematics: Kinematics) -> SelfTest:
    """The test vectors of a mechanism: a refused machine, the nominal one, and the nominal one with limits around a
    pose.
    """
    nominal = _nominal(kinematics)
    found = _Vectors(nominal)
    machines = [nominal]
    if (wrong := _refused(nominal)) is not None:
        machines.insert(0, wrong)
    if (limited := _limited(nominal, found.poses[0])) is not None:
        machines.append(limited)
    cases: list[Case] = []
    for index, machine in enumerate(machines):
        cases.append(Case(Called.INITIALIZE, index, machine.status))
        own = found.cases if machine is nominal else _once_more(machine, found)
        cases += [replace(case, machine=index) for case in own]
        cases = [case if case.operations else with_operations(case, machine) for case in cases]
    return SelfTest(tuple(m.given for m in machines), tuple(cases))


def _nominal(kinematics: Kinematics) -> Machine:
    """The nominal machine without limits, with an offset on every axis where it may have one."""
    given = kinematics.unlimited_values | ({MAX_MISS: 0.0} if kinematics.mechanism.surplus else {})
    plain = machine_with(kinematics, given)
    offsets = {j.offset.name: _scaled(plain, j, 10.5 * (i + 1)) for i, j in enumerate(kinematics.mechanism.joints)}
    shifted = machine_with(kinematics, given | offsets)
    return shifted if shifted.status is Status.OK else plain


def _scaled(machine: Machine, joint: Joint, value: float) -> float:
    """The value of an axis as it is, or a length as small as the machine is."""
    return value if joint.axis_is_angle else round(value * 10.0**-machine.smaller, _DECIMALS + machine.smaller)


def _refused(nominal: Machine) -> Machine | None:
    """A machine that Initialize refuses: without its first length, or with limits the wrong way round."""
    lengths = [p.name for p in nominal.kinematics.parameters if p.role is Role.LENGTH]
    keys = [j.key for j in nominal.kinematics.mechanism.joints]
    wrong = [{lengths[0]: 0.0}] if lengths else [{f"lower_{keys[0]}": 1.0, f"upper_{keys[0]}": -1.0}] if keys else []
    found = (machine_with(nominal.kinematics, {**nominal.given, **change}) for change in wrong)
    return next((machine for machine in found if machine.status is not Status.OK), None)


def _limited(nominal: Machine, axes: Reals) -> Machine | None:
    """The machine with limits one unit away from every axis value, in both directions; of a small one, less."""
    limits = {}
    for joint, value in zip(nominal.kinematics.mechanism.joints, axes, strict=True):
        for word, away in (("lower", -1.0), ("upper", 1.0)):
            end = value + _scaled(nominal, joint, away)
            limits[f"{word}_{joint.key}"] = round(end, _DECIMALS + nominal.smaller)
    machine = machine_with(nominal.kinematics, {**nominal.given, **limits})
    return machine if limits and machine.status is Status.OK else None


def _once_more(machine: Machine, found: _Vectors) -> Iterator[Case]:
    """The answers of another machine to the first calls.

    A refused machine refuses; one with limits finds a single solution, and none at another pose."""
    first = [c for c in found.cases if c.status is Status.OK and c.called in (Called.FORWARD, Called.INVERSE)]
    inverses = [c for c in first if c.called is Called.INVERSE and c.frame == found.frames[0]]
    others = [c for c in first if c.called is Called.INVERSE and c.frame != found.frames[0]]
    chosen = [next(c for c in first if c.called is Called.FORWARD), *inverses]
    if machine.status is not Status.OK:
        yield from (replace(case, status=machine.status) for case in chosen[:2])
        return
    for case in (*inverses, *others[:1]):
        status, axes = inverse(machine, case.frame, case.configuration, case.reference)
        yield replace(case, status=status, axes=axes or case.axes)


class _Vectors:
    """Poses of one machine, and the cases at them."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self._mechanism = machine.kinematics.mechanism
        self._candidates = candidates(machine)

    @cached_property
    def poses(self) -> tuple[Reals, ...]:
        """Axis values of up to three regular poses; the first has the most solutions. Raises `DescriptionError` where
        no sampled pose is one.
        """
        if not self._regular:
            raise DescriptionError("no sampled pose is regular: check the nominal values of parameters and joints")
        poses = self._regular[: 1 if self._mechanism.search else _TRIED]  # to compare poses, a root search takes long
        solutions = [sum(status is Status.OK for status in self._statuses(axes)) for axes in poses]
        best = poses[int(np.argmax(solutions))]
        return (best, *[axes for axes in self._regular if axes != best][: _SHOWN - 1])

    @cached_property
    def frames(self) -> tuple[Reals, ...]:
        """The frames of the regular poses."""
        return tuple(forward(self.machine, axes)[1] for axes in self.poses)

    @cached_property
    def cases(self) -> tuple[Case, ...]:
        """All cases of this machine."""
        return tuple(self._cases())

    def _cases(self) -> Iterator[Case]:
        """Forward kinematics at every pose, every branch at the first one, singular poses, refusals."""
        for axes in self.poses:
            yield self._forward(axes)
        yield from self._branches()
        for axes in self.poses[1:]:
            _, frame, own = forward(self.machine, axes)
            yield self._inverse(frame, own, axes)
            if self._mechanism.branches and not self._mechanism.search:
                yield self._inverse(frame, (0,) * len(own), self._aside(axes))
        yield self._singularity(self.poses[0])
        for axes in self._singular():
            yield self._singularity(axes)
            case = self._forward(axes)
            if case.status is not Status.OK or not self._mechanism.rods:  # near a type 2 singularity digits are lost
                yield case
        yield from self._refusals()

    @cached_property
    def _regular(self) -> list[Reals]:
        """Poses away from singular ones, to which the inverse leads back."""
        found: list[Reals] = []
        for axes in regular_poses(self.machine, self._candidates):
            _, frame, own = forward(self.machine, axes)
            status, back = inverse(self.machine, frame, own, axes)
            if status is Status.OK and np.allclose(back, axes, rtol=0, atol=1e-3):
                found.append(axes)
            if len(found) == (_SHOWN if self._mechanism.search else _TRIED):
                break
        return found

    def _statuses(self, axes: Reals) -> list[Status]:
        """The answers of every branch at a pose."""
        frame = forward(self.machine, axes)[1]
        every = self._open((0,) * len(self._mechanism.branches))
        return list(branches(self.machine, frame, every, self._aside(axes))[2])

    def _branches(self) -> Iterator[Case]:
        """The first pose with its own configuration, and on every branch without turns; a root search
        that fails is long.
        """
        axes, frame = self.poses[0], self.frames[0]
        reference, every = self._aside(axes), self._open((0,) * len(self._mechanism.branches))
        yield self._inverse(frame, forward(self.machine, axes)[2], reference)
        slots, solutions, statuses = branches(self.machine, frame, every, reference)
        for slot, found, status in zip(slots, solutions, statuses, strict=True) if slots[0] else ():
            if status is Status.OK or not self._mechanism.search:
                yield Case(Called.INVERSE, 0, status, found, reference, frame, self._open(slot))

    def _open(self, slot: Bytes) -> Bytes:
        """The bytes of a branch, with automatic turns."""
        return slot + (0,) * len(self._mechanism.period_joints)

    def _aside(self, axes: Reals) -> Reals:
        """A reference that differs from the answer."""
        if self._mechanism.search:
            return axes
        steps = (17.3 if j.axis_is_angle else 1.7 for j in self._mechanism.joints)
        return tuple(round(a + (k + 1) * step, 6) for k, (a, step) in enumerate(zip(axes, steps, strict=True)))

    def _forward(self, axes: Reals) -> Case:
        status, frame, configuration = forward(self.machine, axes)
        return Case(Called.FORWARD, 0, status, axes, frame=frame, configuration=configuration)

    def _inverse(self, frame: Reals, configuration: Bytes, reference: Reals) -> Case:
        status, axes = inverse(self.machine, frame, configuration, reference)
        return Case(Called.INVERSE, 0, status, axes, reference, frame, configuration)

    def _singularity(self, axes: Reals) -> Case:
        smallest = np.min(np.abs(margins(self.machine, [axes])), initial=np.inf)
        return Case(Called.SINGULARITY, 0, axes=axes, is_singular=not smallest >= float(SINGULAR))

    def _singular(self) -> Iterator[Reals]:
        """A pose at which a margin is nearly zero, and axis values at which there is no pose."""
        yield from islice(chain(self._crossing(), self._square()), 1)
        nowhere = np.flatnonzero(np.isnan(margins(self.machine, self._candidates)).any(axis=0))
        yield from (self._candidates[k] for k in nowhere[:1])

    def _crossing(self) -> Iterator[Reals]:
        """A singular pose between two poses on either side of it, by bisection."""
        found = margins(self.machine, self._candidates)
        for row in range(len(found)):
            above, below = np.flatnonzero(found[row] > _REGULAR)[:1], np.flatnonzero(found[row] < -_REGULAR)[:20]
            if len(above) and len(below):
                rows = np.array(self._candidates)
                halved = self._halved(row, np.repeat(rows[above], len(below), axis=0), rows[below])
                if (axes := next(halved, None)) is not None:
                    yield axes
                    return

    def _square(self) -> Iterator[Reals]:
        """A singular pose where the margin keeps its sign: the first pose, with one joint at zero
        or at a right angle.
        """
        for k, joint in enumerate(self._mechanism.joints):
            for value in (0.0, 90.0, -90.0, 180.0) if joint.axis_is_angle else (0.0,):
                zero = self.machine.given[joint.offset.name]
                axes = (*self.poses[0][:k], round(value + zero, 6), *self.poses[0][k + 1 :])
                found = np.abs(margins(self.machine, [axes]))
                if np.min(found) < _SINGULAR and not np.isnan(found).any():
                    yield axes

    def _halved(self, row: int, low: Array, high: Array) -> Iterator[Reals]:
        """The poses at which a margin vanishes, between pairs of poses with opposite signs of it."""
        for _ in range(60):
            middle = (low + high) / 2.0
            is_above = (margins(self.machine, [tuple(m) for m in middle.tolist()])[row] > 0.0)[:, None]
            low, high = np.where(is_above, middle, low), np.where(is_above, high, middle)
        found = [tuple(round(v, 6) for v in axes) for axes in low.tolist()]
        near = np.abs(margins(self.machine, found)[row]) < _SINGULAR
        yield from (axes for axes, is_near in zip(found, near, strict=True) if is_near)

    def _refusals(self) -> Iterator[Case]:
        """Refusals: a number too large, a pose too far away, no rotation, a tool pointing the opposite way, an invalid
        byte.
        """
        axes, frame = self.poses[0], self.frames[0]
        own = forward(self.machine, axes)[2]
        if axes:
            yield self._forward((2.0 * float(LARGEST), *axes[1:]))
        for k in (k for k, j in enumerate(self._mechanism.joints) if j in self._mechanism.surplus_joints):
            yield self._forward((*axes[:k], round(_MISSED * axes[k], _DECIMALS + self.machine.smaller), *axes[k + 1 :]))
        turned, far = (
            tuple(round(k * v, 6) for v in part) for k, part in ((_NO_ROTATION, frame[3:]), (1e3, frame[:3]))
        )
        opposite = tuple(v * (1.0 if k % 3 == 0 else -1.0) + 0.0 for k, v in enumerate(frame[3:]))
        frames = [
            (2.0 * float(LARGEST), *frame[1:]),
            (*far, *frame[3:]),
            (*frame[:3], *turned),
            (*frame[:3], *opposite),
        ]
        cases = [self._inverse(other, own, axes) for other in frames]
        if self._mechanism.branches:
            cases.append(self._inverse(frame, (4, *own[1:]), axes))
        yield from (case for case in cases if case.status is not Status.OK)


def candidates(machine: Machine) -> list[Reals]:
    """Axis values over the whole ranges; where few poses close, near the nominal values."""
    drawn = _candidates(machine)
    return _candidates(machine, _NEAR) if np.isnan(np.min(margins(machine, drawn), axis=0)).all() else drawn


def regular_poses(machine: Machine, drawn: Sequence[Reals]) -> Iterator[Reals]:
    """Those of some axis values that are away from singular ones."""
    least = np.min(np.abs(margins(machine, drawn)), axis=0)
    regular = min(_REGULAR, float(np.nanmax(np.append(least, 0.0))) / 2)  # margins of some machines are never large
    yield from (axes for axes, smallest in zip(drawn, least, strict=True) if smallest > regular)


def _candidates(machine: Machine, share: float = 1.0) -> list[Reals]:
    """Axis values with one decimal, over the whole ranges, or a share of them around nominal values; for a platform,
    near its home pose. Lengths of a small machine have more decimals.
    """
    mechanism = machine.kinematics.mechanism
    count = _LOOP_CANDIDATES if mechanism.rods else _CANDIDATES
    if mechanism.is_platform:
        home = np.array(machine.home)
        near = home * (1.0 + _AWAY * np.random.default_rng(3).uniform(-1.0, 1.0, (_TRIED, len(home))))
        drawn = np.vstack([near, _TOO_SHORT * home])
    elif mechanism.joints:
        samples = sample_axes(mechanism, dict(machine.values), count, 3, share, _SIZE)
        drawn = np.stack([samples[j.axis.name] * _turns(j) for j in mechanism.joints], axis=1)
    else:
        return [()]
    angles = [j.axis_is_angle for j in mechanism.joints]
    rounded = [
        tuple(
            round(float(v), 1 if is_angle else 1 + machine.iterations) for v, is_angle in zip(row, angles, strict=True)
        )
        for row in drawn
    ]
    return fitted(machine, rounded)


def _turns(joint: Joint) -> float:
    """By how much the range of an axis is wider: several turns where it has them."""
    return 2.0 if joint.axis_is_angle and joint.multi_turn else 1.0
