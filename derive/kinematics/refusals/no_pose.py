"""The reason why a machine has no pose at its nominal dimensions: rods that cannot meet, or a quantity that is never
positive.

It is found numerically, and only where sampling has found no pose. From many starts a loop is brought as near to
closing as possible; the message states the remaining error of each rod.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import DescriptionError, Mechanism
from derive.ir.interpret import Array, evaluate
from derive.ir.program import Statement
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES
from derive.kinematics.sampling import Samples, machine_at, size_of
from derive.plate.legs import angles, by_angles
from derive.plate.turning import NoPoseAtHome, samples_near_home

_STARTS, _STEPS, _SEED = 200, 60, 41
_DRAWS = 4000
_CLOSED = 1e-6
"""The largest error of a closed loop, in lengths of the machine."""
_DIFFERENCE = 1e-6
_CHECK = "check the nominal values of parameters"
_AWAY = 3.0
"""The largest start of a length or a position, in lengths of the machine."""


def why_no_pose(mechanism: Mechanism, *, at_home: bool = False) -> str:
    """The message for a machine without a pose. at_home: for a loop without a pose near its home pose."""
    machine = machine_at(mechanism)
    if mechanism.chain is None:
        search = _Search(mechanism, machine, at_home)
        found = search.nearest()
        missed = search.missed(found)
        if np.abs(missed).max() > _CLOSED:
            return _open_loop(mechanism, machine, missed * search.size, at_home)
        closed = search.most_regular_first(found[np.abs(search.residual(found)).max(axis=1) <= _CLOSED])
        return _not_positive(mechanism, search.values(closed)) or _elsewhere(mechanism, search.values(closed[:1]))
    return _not_positive(mechanism, _anywhere(mechanism, machine)) or f"no sampled pose is possible: {_CHECK}"


def _elsewhere(mechanism: Mechanism, values: Mapping[str, Array]) -> str:
    """The message that a loop closes at a pose that was not sampled."""
    units = [np.pi / 180.0 if j.is_angle else 1.0 for j in mechanism.joints]
    joints = zip(mechanism.joints, units, strict=True)
    place = ", ".join(f"{j.name} = {float(values[j.symbol.name][0]) / unit:.4g}" for j, unit in joints)
    return f"no sampled pose is possible, but the loop closes at {place}: state nominal values of the joints near these"


def _open_loop(mechanism: Mechanism, machine: Samples, missed: NDArray[np.float64], at_home: bool) -> str:
    place = "its home pose is not where the legs reach it" if at_home else "the loop never closes"
    parts = []
    for number, wrong in enumerate(missed):
        if abs(wrong) <= _CLOSED * size_of(mechanism, machine):
            continue
        if number < len(mechanism.closure):
            parts.append(f"equation {number + 1} of the closure misses zero by {abs(wrong):.4g}")
            continue
        if number < len(mechanism.closure) + len(mechanism.guides):
            held = mechanism.guides[number - len(mechanism.closure)]
            parts.append(f"guide {held.name!r} is missed by {abs(wrong):.4g}")
            continue
        rod = mechanism.rods[number - len(mechanism.closure) - len(mechanism.guides)]
        if {name.name for name in rod.length.free_symbols} <= machine.keys():
            length = float(evaluate(rod.length, machine))
            parts.append(f"rod {rod.name!r} is {length:.4g} long, and should be {length + wrong:.4g}")
        else:
            parts.append(f"rod {rod.name!r}, which changes its length, misses {abs(wrong):.4g}")
    return f"with nominal dimensions {place}: at best {', '.join(parts)}; {_CHECK}"


def _not_positive(mechanism: Mechanism, values: Mapping[str, Array]) -> str | None:
    """The message about quantities that must be positive and never are; None if that is not the reason."""
    quantities = [f"{q}" for q in mechanism.positive]
    found = [evaluate(sp.sympify(q), values) for q in mechanism.positive]
    for text, value in zip(quantities, found, strict=True):
        if not np.any(value > 0):
            return f"{text} must be positive, and is at most {np.max(value):.4g}: {_CHECK}"
    if len(found) > 1 and not np.any(np.all(np.stack(np.broadcast_arrays(*found)) > 0, axis=0)):
        return f"{' and '.join(quantities)} must be positive, and never are together: {_CHECK}"
    for bound in mechanism.bounds:
        least, largest = (float(np.min(np.abs(evaluate(v, values)))) for v in (bound.value, bound.largest))
        if least > largest:
            return f"{bound.meaning} is at least {least:.4g} where it was tried, and may be {largest:.4g}: {_CHECK}"
    if any(j.domain is not None for j in mechanism.joints):
        domains = [
            f"{j.name} from {j.domain[0]:g} to {j.domain[1]:g}" for j in mechanism.joints if j.domain is not None
        ]
        return f"no pose is possible where the joints may be ({', '.join(domains)}): {_CHECK}"
    return None


def _anywhere(mechanism: Mechanism, machine: Samples) -> dict[str, Array]:
    """Joint values of a chain, over the whole ranges of the joints."""
    rng, size = np.random.default_rng(_SEED), size_of(mechanism, machine)
    drawn = {}
    for joint in mechanism.joints:
        low, high = joint.domain or ((-180.0, 180.0) if joint.is_angle else (-_AWAY * size, _AWAY * size))
        high = min(high, low + 360.0 if joint.is_angle else _AWAY * max(size, abs(low)))
        drawn[joint.symbol.name] = rng.uniform(low, high, _DRAWS) * (np.pi / 180.0 if joint.is_angle else 1.0)
    return {**machine, **drawn}


def near_home(
    mechanism: Mechanism, derivation: Sequence[Statement], signs: Sequence[sp.Symbol], machine: Samples, seed: int
) -> Samples:
    """`samples_near_home`; if there are none, raises `DescriptionError` with the errors of the legs."""
    try:
        return samples_near_home(mechanism, derivation, signs, machine, seed)
    except NoPoseAtHome:
        raise DescriptionError(why_no_pose(mechanism, at_home=True)) from None


class _Search:
    """The equations of a loop in its joints and its pose: lengths in lengths of the machine, angles in radians."""

    def __init__(self, mechanism: Mechanism, machine: Samples, at_home: bool) -> None:
        self._mechanism, self._machine = mechanism, machine
        self.size = size_of(mechanism, machine)
        self._coordinates = tuple(mechanism.motion.position)
        self._turns = angles(mechanism) if mechanism.is_platform else ()
        self._pose = [float(evaluate(v, machine)) for v in mechanism.home] if at_home else None
        moved = [1.0 if j.is_angle else self.size for j in mechanism.joints]
        posed = [] if at_home else [self.size] * len(self._coordinates) + [1.0] * len(self._turns)
        self._units = np.array([*moved, *posed])

    def values(self, unknowns: NDArray[np.float64]) -> dict[str, Array]:
        """The values of all names, a row for each row of unknowns."""
        columns = (unknowns * self._units).T
        joints = self._mechanism.joints
        known: dict[str, Array] = {**self._machine, **dict.fromkeys(COORDINATE_NAMES, np.asarray(0.0))}
        known |= {j.symbol.name: column for j, column in zip(joints, columns, strict=False)}
        pose = columns[len(joints) :] if self._pose is None else np.array(self._pose)[:, None] * np.ones(len(unknowns))
        known |= dict(zip(self._coordinates, pose, strict=False))
        if self._turns:
            turned = dict(zip(self._turns, pose[len(self._coordinates) :], strict=True))
            named = {f"{w}_{a}": f(v) for a, v in turned.items() for w, f in (("cos", np.cos), ("sin", np.sin))}
            for name, entry in zip(ROTATION_ENTRIES, by_angles(self._turns), strict=True):
                known[name.name] = evaluate(entry, named)
        return known

    def residual(self, unknowns: NDArray[np.float64]) -> NDArray[np.float64]:
        """The error of every equation, a column each; for a rod, the error of its length."""
        known = self.values(unknowns)
        stated = (*self._mechanism.closure, *(g.equation for g in self._mechanism.guides))
        missed = [evaluate(sp.sympify(e), known) / self.size for e in stated]
        for rod in self._mechanism.rods:
            square = sum(evaluate(p - b, known) ** 2 for p, b in zip(rod.end, rod.base, strict=True))
            missed.append((np.sqrt(square) - evaluate(rod.length, known)) / self.size)
        return np.stack([np.broadcast_to(m, (len(unknowns),)) for m in missed], axis=1)

    def nearest(self) -> NDArray[np.float64]:
        """The unknowns that come nearest to closing the loop, from every start."""
        rng = np.random.default_rng(_SEED)
        here = rng.uniform(-1.0, 1.0, (_STARTS, len(self._units))) * np.where(self._units == self.size, _AWAY, np.pi)
        damping, eye = np.full(_STARTS, 1e-2), np.eye(len(self._units))
        missed = self.residual(here)
        for _ in range(_STEPS):
            slopes = np.stack([self._slope(here, k) for k in range(here.shape[1])], axis=2)
            normal = np.swapaxes(slopes, 1, 2) @ slopes + damping[:, None, None] * eye
            step = np.linalg.solve(normal, np.swapaxes(slopes, 1, 2) @ missed[:, :, None])[:, :, 0]
            tried = self.residual(here - step)
            better = (tried**2).sum(axis=1) < (missed**2).sum(axis=1)
            here = np.where(better[:, None], here - step, here)
            missed = np.where(better[:, None], tried, missed)
            damping = np.clip(np.where(better, damping * 0.2, damping * 5.0), 1e-12, 1e6)
        return here

    def most_regular_first(self, closed: NDArray[np.float64]) -> NDArray[np.float64]:
        """The closed poses with positive quantities where they must be, the most regular pose first."""
        columns = range(len(self._mechanism.joints), closed.shape[1])
        if not columns:
            return closed
        held = np.linalg.svd(np.stack([self._slope(closed, k) for k in columns], axis=2), compute_uv=False)[:, -1]
        values = self.values(closed)
        is_own = [np.broadcast_to(evaluate(q, values) > 0, (len(closed),)) for q in self._mechanism.positive]
        return np.asarray(closed[np.argsort(-np.where(np.all(is_own, axis=0), held, -1.0), kind="stable")])

    def missed(self, found: NDArray[np.float64]) -> NDArray[np.float64]:
        """The errors of the equations at the best of the found unknowns."""
        missed = self.residual(found)
        return np.asarray(missed[int(np.argmin((missed**2).sum(axis=1)))])

    def _slope(self, here: NDArray[np.float64], column: int) -> NDArray[np.float64]:
        away = np.zeros(here.shape[1])
        away[column] = _DIFFERENCE
        return np.asarray((self.residual(here + away) - self.residual(here - away)) / (2 * _DIFFERENCE))
