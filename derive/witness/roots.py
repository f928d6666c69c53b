"""All solutions of the closure for a pose, found by a damped Newton iteration from many starts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from derive.ir.interpret import Array
from derive.witness.closure import Closure
from derive.witness.samples import SEED, Samples

Rows = NDArray[np.int64]

STARTS = 160
_ITERATIONS = 40
_POLISH = 4
_LEAST_DAMPING = 1e-15
_CONVERGED = 1e-9
_SAME = 1e-6
_FAR = 4.0
"""The largest length from which a search starts, in reaches."""
_LAST_STEP = 1e-7
"""A solution is found where the next step of Newton's method is at most this. A small residual alone is not enough: a
joint that hardly moves the pose leaves a small one far away from the solution."""
_ROUNDING = 1e-13
"""An equation of order one is met but for rounding."""
_EXACT = 4e-15
"""It is met to the last digits: no step can bring a row nearer."""


@dataclass(frozen=True)
class Problem:
    """The closure at fixed poses, scaled: angles in radians, lengths in reaches, equations of order one."""

    closure: Closure
    pose: Array
    parameters: Array
    weights: Array
    units: Array
    """The unit of each scaled unknown, in radians or lengths."""
    angles: NDArray[np.bool_]
    whole: Array
    """Half of a turn of every angle of the closure, in each scaled unknown; half of a range for lengths."""
    reach: Array
    held: Array
    """The values of the joints that are not solved for; no number for the others."""

    def take(self, rows: Rows) -> Problem:
        """The problem at the chosen rows."""
        return Problem(
            self.closure,
            self.pose[rows],
            self.parameters[rows],
            self.weights[rows],
            self.units[rows],
            self.angles,
            self.whole[rows],
            self.reach[rows],
            self.held[rows],
        )

    def residual(self, unknowns: Array) -> Array:
        """Φ, and the distances of the joints that are not solved for from their values."""
        phi = self.weights * self.closure.residual(unknowns * self.units, self.pose, self.parameters)[:, :, 0]
        return np.concatenate([phi, self._off(unknowns)], axis=1)

    def _off(self, unknowns: Array) -> Array:
        kept = ~self.closure.solved  # most machines solve for all of them
        off = (unknowns - self.held)[:, kept]
        return np.where(self.angles[kept], (off + np.pi) % (2 * np.pi) - np.pi, off)

    def slopes(self, unknowns: Array) -> Array:
        """∂Φ by the unknowns."""
        b = self.closure.by_joints(unknowns * self.units, self.pose, self.parameters)
        phi = self.weights[:, :, None] * b * self.units[:, None, :]
        kept = np.eye(len(self.angles))[~self.closure.solved]
        return np.concatenate([phi, np.broadcast_to(kept, (len(phi), *kept.shape))], axis=1)

    def places(self, unknowns: Array) -> Array:
        """What tells solutions apart, in lengths of the reach: an angle of the closure that is a turn more is the same,
        whatever gear a joint has.
        """
        places = self.closure.places(unknowns * self.units, self.parameters)[:, :, 0]
        places[:, self.closure.turned :] /= self.reach[:, None]
        return places

    def places_at(self, row: int, unknowns: Array) -> Array:
        """The same for solutions of one row."""
        return self.take(np.full(len(unknowns), row)).places(unknowns)

    def is_positive(self, unknowns: Array) -> NDArray[np.bool_]:
        """Whether the description admits the solution, or excludes it as a mirror image."""
        quantities = self.closure.positive(unknowns * self.units, self.pose, self.parameters)[:, :, 0]
        return np.asarray(np.all(quantities > 0, axis=1), dtype=bool)


def problem_at(closure: Closure, samples: Samples) -> Problem:
    """The root-finding problem at each sample."""
    units = closure.joint_scale(samples.reach, samples.joints, samples.parameters)
    state = (samples.joints, samples.pose, samples.parameters)
    by_pose = closure.by_pose(*state) * closure.row_scale(samples.reach)[:, None, :]
    by_joints = closure.by_joints(*state) * units[:, None, :]
    sizes = np.linalg.norm(np.concatenate([by_pose, by_joints], axis=2), axis=2)
    sizes[:, closure.equations :] = 1.0  # entries of a rotation are of order one already
    held = np.where(closure.solved, np.nan, samples.joints / units)
    rates = closure.rates(samples.joints, samples.parameters)
    whole = np.where(closure.angles, np.pi * rates[:, :, 0] / rates[:, :, 1], _FAR)
    return Problem(
        closure, samples.pose, samples.parameters, 1.0 / sizes, units, closure.angles, whole, samples.reach, held
    )


def all_solutions(problem: Problem, starts_of_each: int = STARTS) -> list[Array]:
    """The distinct solutions at every pose, without those that the description excludes."""
    count = len(problem.pose)
    rows = np.repeat(np.arange(count), starts_of_each)
    many = problem.take(rows)
    starts = np.random.default_rng(SEED).uniform(-1.0, 1.0, many.whole.shape) * many.whole
    starts[1::2] = np.where(problem.angles, starts, np.abs(starts))[
        1::2
    ]  # six lengths have 64 mirror images, one is wanted
    ends = _newton(many, starts, _ITERATIONS)
    good = is_solution(many, ends)
    return [distinct(problem, i, ends[(rows == i) & good]) for i in range(count)]


def polished(problem: Problem, unknowns: Array) -> Array:
    """The solutions nearest to these unknowns."""
    return _newton(problem, unknowns, _POLISH)


def is_solution(problem: Problem, unknowns: Array) -> NDArray[np.bool_]:
    """Whether each row is a solution that the description admits."""
    residual = problem.residual(unknowns)
    good = np.linalg.norm(residual, axis=1) < _CONVERGED
    near = np.flatnonzero(good)
    step = np.linalg.pinv(problem.take(near).slopes(unknowns[near])) @ residual[near][:, :, None]
    good[near] = np.abs(step[:, :, 0]).max(axis=1) <= _LAST_STEP
    return np.asarray(good & problem.is_positive(unknowns), dtype=bool)


def distinct(problem: Problem, row: int, unknowns: Array) -> Array:
    """Each solution of a row once: the first of those that are the same."""
    left, places, kept = np.arange(len(unknowns)), problem.places_at(row, unknowns), []
    while len(left):
        kept.append(left[0])
        left = left[~same(places[left[0]], places[left])]
    return np.asarray(unknowns[np.array(kept, dtype=int)])


def same(one: Array, others: Array) -> NDArray[np.bool_]:
    """Whether a solution and others have the same places, for each of the others."""
    return np.asarray(np.all(np.abs(one - others) < _SAME, axis=-1), dtype=bool)


def _newton(problem: Problem, start: Array, iterations: int) -> Array:
    """Levenberg-Marquardt, every row with its own damping, which falls with the error: the last steps then are those of
    Newton's method, also along a joint that hardly moves the pose.

    A row is at its end where it meets the equations exactly, or but for rounding and a step does not bring it nearer.
    """
    unknowns, residual, identity = start.copy(), problem.residual(start), np.eye(start.shape[1])
    rows, damping = np.arange(len(start)), np.full(len(start), 1e-2)
    part, here, before = problem, unknowns, np.linalg.norm(residual, axis=1)
    for _ in range(iterations):
        slopes = part.slopes(here)
        damped = np.maximum(damping * np.minimum(1.0, before), _LEAST_DAMPING)
        normal = np.swapaxes(slopes, 1, 2) @ slopes + damped[:, None, None] * identity
        step = np.linalg.solve(normal, np.swapaxes(slopes, 1, 2) @ residual[:, :, None])[:, :, 0]
        trial = here - step
        missed = part.residual(trial)
        after = np.linalg.norm(missed, axis=1)
        better = after < before
        unknowns[rows[better]] = trial[better]
        now = np.where(better, after, before)
        going = np.flatnonzero(now > np.where(better, _EXACT, _ROUNDING))
        if not len(going):
            break
        residual = np.where(better[:, None], missed, residual)[going]
        before = now[going]
        damping = np.clip(np.where(better, damping * 0.1, damping * 10.0), _LEAST_DAMPING, 1e6)[going]
        rows, part = rows[going], part if len(going) == len(rows) else part.take(going)
        here = unknowns[rows]
    return unknowns
