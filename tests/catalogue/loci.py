"""The singular loci of a mechanism, from its description: zeros of branch indicators and of positive quantities."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import combinations, product

import numpy as np
import sympy as sp

from tests.catalogue.closure import Array, derivative
from tests.catalogue.machines import Machine

OFTEN = 0.9
"""A quantity c + h cos(u - centre) has zeros where |c| is less than this fraction of h."""


SHIFTS = (0.0, 1e-12, -1e-9, 1e-6, -1e-4, 1e-3)
"""How far (radians) singular joints are from their places, where several singularities coincide."""
POSES = 6
PASSES, LONGEST, MET = 40, 0.4, 1e-14
"""Of Newton's method: steps, the longest (radians), and the size of a quantity (of its largest) that is zero."""


@dataclass(frozen=True, eq=False)
class Locus:
    """One of the two places (`second` or not) at which a joint makes a quantity vanish, whatever the others are."""

    machine: Machine
    quantity: sp.Expr
    joint: int
    second: bool
    branch: int | None
    """The branch whose two solutions meet here; None where a positive quantity ends."""

    @property
    def is_length(self) -> bool:
        """Whether the joint is a length that ends, and no angle."""
        return not self.machine.mechanism.joints[self.joint].is_angle

    @property
    def inward(self) -> float:
        """The direction of a shift from the locus that the machine can make: both, for a branch."""
        return -1.0 if self.branch is None and self.second else 1.0

    def moved(self, axes: Array, shift: float | Array, together: int | None = None) -> Array:
        """The axis values at a shift (radians, per reach) from the locus; rows without a place have another's."""
        rows, exists = np.arange(len(axes)), self.exists(axes)
        stays = np.zeros(len(axes), dtype=bool)
        for start in range(0, len(axes), together or len(axes)):
            group = slice(start, start + (together or len(axes)))
            others = start + np.flatnonzero(exists[group])
            if len(others):
                rows[group][~exists[group]] = np.resize(others, int((~exists[group]).sum()))
            else:
                stays[group] = True
        joints = self.machine.closure.joints(axes[rows])
        joints[:, self.joint] = self._root(joints) + shift * (self.machine.reach if self.is_length else 1.0)
        return np.where(stays[:, None], axes, self.machine.closure.axes(joints))

    def within(self, axes: Array, share: float | Array, turns: int = 0) -> Array:
        """The axis values with the joint inside the arc on which the quantity is positive: -1 and 1 are its ends."""
        joints = self.machine.closure.joints(axes)
        centre, half = self._arc(joints)
        joints[:, self.joint] = np.unwrap(centre) + share * half + 2 * np.pi * turns
        return self.machine.closure.axes(joints)

    def exists(self, axes: Array) -> Array:
        """Which rows have the place."""
        if self.is_length:
            return np.ones(len(axes), dtype=bool)
        level, along, across = self._harmonic(self.machine.closure.joints(axes))
        return np.abs(level) < OFTEN * np.hypot(along, across)

    @cached_property
    def joints(self) -> int:
        """How many joints the quantity depends on."""
        return len(_joints(self.machine, self.quantity))

    def _root(self, joints: Array) -> Array:
        if self.is_length:
            return np.zeros(len(joints))
        centre, half = self._arc(joints)
        there = joints.copy()
        there[:, self.joint] = centre + (half if self.second else -half)
        _, along, across = self._harmonic(joints)
        angle = there[:, self.joint]
        return angle - self._value(there) / (across * np.cos(angle) - along * np.sin(angle))

    def _arc(self, joints: Array) -> tuple[Array, Array]:
        """The middle and half the width of the arc on which the quantity is positive, within reason."""
        level, along, across = self._harmonic(joints)
        return np.arctan2(across, along), np.arccos(np.clip(-level / np.hypot(along, across), -OFTEN, OFTEN))

    def _harmonic(self, joints: Array) -> tuple[Array, Array, Array]:
        """The quantity as level + along cos u + across sin u of the joint."""
        there = np.repeat(joints[None], 4, axis=0)
        there[:, :, self.joint] = np.array((0.0, np.pi, np.pi / 2, 0.7))[:, None]
        values = self._value(there.reshape(-1, joints.shape[1])).reshape(4, -1)
        level, along = (values[0] + values[1]) / 2, (values[0] - values[1]) / 2
        across = values[2] - level
        missed = np.abs(level + along * np.cos(0.7) + across * np.sin(0.7) - values[3])
        assert (missed <= 1e-8 + 1e-5 * np.abs(values[3])).all(), f"teach the tests where {self.quantity} vanishes"
        return level, along, across

    def _value(self, joints: Array) -> Array:
        return self.machine.closure.at_joints([self.quantity], joints)[:, 0]


@cache
def loci(machine: Machine) -> tuple[Locus, ...]:
    """Every place where some quantity vanishes; no two branches' by the same joint, where that can be."""
    quantities: list[tuple[int | None, sp.Expr]] = [(i, b.indicator) for i, b in enumerate(machine.mechanism.branches)]
    quantities += [(None, sp.sympify(p)) for p in machine.mechanism.positive]
    chosen: dict[int, Locus] = {}
    for number in sorted(range(len(quantities)), key=lambda n: len(_joints(machine, quantities[n][1]))):
        taken = {locus.joint for locus in chosen.values()}
        chosen[number] = _first(machine, *quantities[number], taken)
    pairs = [(chosen[n], replace(chosen[n], second=True)) for n in sorted(chosen)]
    return tuple(locus for pair in pairs for locus in (pair[:1] if pair[0].is_length else pair))


def coinciding(one: Machine) -> Iterator[Array]:
    """Poses at every combination of places where branches meet, one place a branch, each by some shift."""
    axes = one.draw(POSES, np.random.default_rng(3), farthest=150.0)
    groups: dict[int, list[Locus]] = {}
    for locus in loci(one):
        groups.setdefault(locus.branch or 0, []).append(locus)
    for count in range(1, len(groups) + 1):
        for chosen in combinations(groups.values(), count):
            for places in product(*chosen):
                shifts = list(product(SHIFTS, repeat=count)) if count < 3 else [(s,) * count for s in SHIFTS]
                there = np.tile(axes, (len(shifts), 1))
                columns = np.repeat(np.array(shifts), POSES, axis=0).T
                ordered = sorted(zip(places, columns, strict=True), key=lambda pair: pair[0].joints)
                for locus, column in ordered:
                    there = locus.moved(there, column, together=POSES)
                if _disturb([locus for locus, _ in ordered]):
                    there = _meeting([locus for locus, _ in ordered], there, [column for _, column in ordered])
                yield there


def _disturb(places: Sequence[Locus]) -> bool:
    """Whether a later place is reached by a joint that an earlier quantity depends on."""
    return any(
        later.joint in _joints(first.machine, first.quantity)
        for k, first in enumerate(places)
        for later in places[k + 1 :]
    )


def _meeting(places: Sequence[Locus], axes: Array, shifts: Sequence[Array]) -> Array:
    """Axis values where all quantities vanish, by Newton's method; a row without one has that of another."""
    machine = places[0].machine
    joints, quantities = machine.closure.joints(axes), [p.quantity for p in places]
    for _ in range(PASSES):
        values = machine.closure.at_joints(quantities, joints)
        slopes = derivative(lambda q: machine.closure.at_joints(quantities, q), joints)
        step = (np.linalg.pinv(slopes, rcond=1e-6) @ values[:, :, None])[:, :, 0]
        joints -= step / np.maximum(1.0, np.abs(step).max(axis=1, keepdims=True) / LONGEST)
    values = np.abs(machine.closure.at_joints(quantities, joints))
    found = np.flatnonzero((values < MET * machine.largest[[p.branch for p in places]]).all(axis=1))
    if not len(found):
        return axes
    joints = joints[np.resize(found, len(joints))]
    for place, shift in zip(places, shifts, strict=True):
        joints[:, place.joint] += shift
    return machine.closure.axes(joints)


def _first(machine: Machine, branch: int | None, quantity: sp.Expr, taken: set[int]) -> Locus:
    """The first place of a quantity, by the joint that brings it there from the most poses, the last of equals."""
    joints = _joints(machine, quantity)
    candidates = [Locus(machine, quantity, i, False, branch) for i in joints if i not in taken or taken >= set(joints)]
    shares = {c.joint: c.exists(machine.sample(200)).mean() for c in candidates}
    best = max(reversed(candidates), key=lambda c: shares[c.joint])
    assert shares[best.joint] > 0.2, f"{quantity} hardly vanishes"
    return best


def _joints(machine: Machine, quantity: sp.Expr) -> list[int]:
    symbols = [j.symbol for j in machine.mechanism.joints]
    return [i for i, s in enumerate(symbols) if s in sp.sympify(quantity).free_symbols]
