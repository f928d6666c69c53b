"""Rods beyond those that hold the point or the platform of a loop: their lengths are axes that follow from its pose.

The inverse solves every rod for its length. Forward kinematics takes the rods that hold the pose, and refuses axes at
which a surplus rod misses: |plate - base| = length + miss. A pose commands the misses to be zero: they are rows of the
Jacobian behind those of the task, which is square again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations, product

import numpy as np
import sympy as sp

from derive.description.mechanism import COORDINATE_NAMES, Joint, Mechanism, Rod
from derive.description.reach import is_own_length
from derive.equations.closures.fixed_names import with_fixed_names
from derive.ir.constants import LARGEST_MISS
from derive.ir.interpret import Array, evaluate
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.reason import Unit, Why, about
from derive.ir.symbols import MAX_MISS, ROTATION_ENTRIES, real
from derive.plate.legs import divisor, leg_symbol, names, rotation_axes

MISS = "miss"
"""The first word of the rows of the Jacobian for surplus rods: their rates are lengths."""
_ITERATIONS, _DAMPING = 60, 1e-9
_SAME = 1e-6
"""Poses are equally good where their errors differ by less than this share of the machine."""
_DIGITS = 9
"""Subsets whose determinants agree to so many digits are equally good: the first is taken."""


def miss_row(joint: Joint) -> str:
    """The name of the row of the Jacobian for a surplus rod, whose length is the joint."""
    return f"{MISS} {joint.key}"


def miss_checks(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The conditions at a pose, in its names, that every surplus rod has its length."""
    return tuple(s for joint, rod in _surplus(mechanism) for s in _fits(mechanism, joint, rod))


def _fits(mechanism: Mechanism, joint: Joint, rod: Rod) -> tuple[Statement, ...]:
    miss, most, length = real(f"{MISS}_{joint.key}"), real(f"most_{joint.key}"), with_fixed_names(mechanism, rod.length)
    between = [with_fixed_names(mechanism, p - b) for p, b in zip(rod.plate, rod.base, strict=True)]
    value = Root(sp.Add(*[v**2 for v in between])) - length
    allowed = Select(sp.Gt(real(MAX_MISS), 0), real(MAX_MISS), LARGEST_MISS * length)
    reason = about(joint.name, Why.MISSES, sp.Abs(miss) - most, Unit.LENGTH)
    return (
        Let(miss, value, f"what surplus rod {rod.name} is too short for this pose"),
        Let(most, allowed),
        Require(sp.Le(sp.Abs(miss), most), Status.IMPOSSIBLE, reason=reason),
    )


def misses_of(
    mechanism: Mechanism, moved: sp.Matrix, joints: sp.Matrix | None = None
) -> tuple[sp.Matrix, tuple[Let, ...]]:
    """The rates of the misses, and the statements for the lines of surplus rods: that of |plate - base| less that of
    the length.

    moved: the rates of the pose: position, then turns about the axes of a platform. joints: those of the joints, if
    they are not the columns themselves.
    """
    symbols = [j.symbol for j in mechanism.joints]
    own = sp.eye(len(symbols)) if joints is None else joints
    axes = rotation_axes(mechanism) if mechanism.is_platform else ()
    rates, lets = sp.zeros(0, own.cols), list[Let]()
    for rod in mechanism.surplus_rods:
        line, length = names("along", rod), with_fixed_names(mechanism, rod.length)
        between = [with_fixed_names(mechanism, p - b) for p, b in zip(rod.plate, rod.base, strict=True)]
        away = Let(leg_symbol("distance", rod), Root(sp.Add(*[v**2 for v in between])), f"surplus rod {rod.name}")
        one = divisor(rod, away.name)
        lets += [away, one, *(Let(n, v / one.name) for n, v in zip(line, between, strict=True))]
        by = [[sp.diff(p, real(c)) for p in rod.plate] for c in mechanism.motion.position]
        by += [[with_fixed_names(mechanism, turned_rate(p, axis)) for p in rod.plate] for axis in axes]
        slopes = sp.Matrix([[sp.Add(*[n * v for n, v in zip(line, column, strict=True)]) for column in by]])
        rates = rates.col_join(slopes * moved - sp.Matrix([length]).jacobian(symbols) * own)
    return rates, tuple(lets)


def _surplus(mechanism: Mechanism) -> tuple[tuple[Joint, Rod], ...]:
    return tuple(zip(mechanism.surplus_joints, mechanism.surplus_rods, strict=True))


def with_surplus(mechanism: Mechanism, count: int) -> Mechanism:
    """The mechanism with its surplus rods named: those without which the others hold its nominal pose best.

    count: how many more joints than quantities of the task there are. Unchanged where they are stated, or where other
    joints than lengths of rods are too many.
    """
    if mechanism.surplus or count <= 0 or mechanism.chain is not None or mechanism.closure:
        return mechanism
    lengths = [j for j in mechanism.joints if is_own_length(mechanism, j)]
    if len(lengths) < count:
        return mechanism
    lines = _lines(mechanism, _nominal_poses(mechanism)[0])
    best, chosen = 0.0, lengths[len(lengths) - count :]
    for left in combinations(reversed(lengths), count):
        kept = [row for row, read in lines if not read & {j.symbol for j in left}]
        held = abs(float(np.linalg.det(np.stack(kept)))) if len(kept) == len(kept[0]) else 0.0
        if round(held, _DIGITS) > round(best, _DIGITS):
            best, chosen = held, list(left)
    return replace(mechanism, surplus=tuple(j for j in mechanism.joints if j in chosen))


def sign_at_nominal(mechanism: Mechanism, determinant: sp.Expr) -> int:
    """The sign of a determinant at the nominal pose, if surplus rods tell that from its mirror image; else 0."""
    if not mechanism.surplus or mechanism.is_platform:
        return 0
    signs = {int(np.sign(float(evaluate(determinant, pose)))) for pose in _nominal_poses(mechanism)}
    return signs.pop() if len(signs) == 1 else 0


def _nominal_poses(mechanism: Mechanism) -> list[dict[str, Array]]:
    """The nominal poses: all values of parameters, joints and coordinates by their names. There is one at home, or
    those points at which the nominal lengths fit best.
    """
    known = {p.symbol.name: np.asarray(p.nominal) for p in mechanism.parameters}
    known |= {j.symbol.name: np.asarray(j.nominal * float(evaluate(j.unit, {}))) for j in mechanism.joints}
    known |= {c: np.asarray(0.0) for c in COORDINATE_NAMES}
    known |= {r.name: np.asarray(float(k % 4 == 0)) for k, r in enumerate(ROTATION_ENTRIES)}
    if mechanism.is_platform:
        return [known | _home(mechanism, known)]
    return [known | place for place in _nearest(mechanism, known)]


def _home(mechanism: Mechanism, known: Mapping[str, Array]) -> dict[str, Array]:
    values = [float(evaluate(v, known)) for v in mechanism.home]
    width = len(mechanism.motion.position)
    rotation = np.eye(3)
    for axis, angle in zip((2,) if len(values) - width == 1 else (0, 1, 2), values[width:], strict=True):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[first, first] = turn[second, second] = np.cos(angle)
        turn[second, first], turn[first, second] = np.sin(angle), -np.sin(angle)
        rotation = turn @ rotation
    entries = zip((r.name for r in ROTATION_ENTRIES), map(np.asarray, rotation.ravel()), strict=True)
    return dict(zip(mechanism.motion.position, map(np.asarray, values), strict=False)) | dict(entries)


def _nearest(mechanism: Mechanism, known: Mapping[str, Array]) -> list[dict[str, Array]]:
    """The positions at which the rods have their nominal lengths best, by Newton's method from several starts."""
    own, found = mechanism.task.position, list[tuple[float, dict[str, Array]]]()
    ends = [[float(evaluate(v, known)) for v in rod.base] for rod in mechanism.rods]
    middle, size = np.mean(ends, axis=0)[: len(own)], float(np.max(np.ptp(ends, axis=0))) or 1.0
    for way in product((0.3, -0.7), repeat=len(own)):
        place = middle + size * np.array(way)
        for _ in range(_ITERATIONS):
            errors, slopes = _errors(mechanism, {**known, **_placed(own, place)})
            normal = slopes.T @ slopes + _DAMPING * np.eye(len(own))
            place = place - np.linalg.solve(normal, slopes.T @ errors)
        errors, _ = _errors(mechanism, {**known, **_placed(own, place)})
        found.append((float(np.linalg.norm(errors)), _placed(own, place)))
    least = min(error for error, _ in found) + _SAME * size
    return [place for error, place in found if error <= least]


def _placed(coordinates: str, place: Array) -> dict[str, Array]:
    return dict(zip(coordinates, map(np.asarray, place), strict=True))


def _errors(mechanism: Mechanism, at: Mapping[str, Array]) -> tuple[Array, Array]:
    """How much longer the rods are than their lengths, and the derivatives by the position."""
    errors, slopes = [], []
    for rod in mechanism.rods:
        span = np.array([float(evaluate(p - b, at)) for p, b in zip(rod.plate, rod.base, strict=True)])
        away = float(np.linalg.norm(span)) or 1.0
        by = [[float(evaluate(sp.diff(p, real(c)), at)) for c in mechanism.task.position] for p in rod.plate]
        errors.append(away - float(evaluate(rod.length, at)))
        slopes.append(span / away @ np.array(by))
    return np.array(errors), np.stack(slopes)


def _lines(mechanism: Mechanism, at: Mapping[str, Array]) -> list[tuple[Array, set[sp.Basic]]]:
    """Of every leg its line at a pose, by what the platform moves, and the symbols that its length reads. Turns count
    by the largest distance of a joint of the platform.
    """
    axes = rotation_axes(mechanism) if mechanism.is_platform else ()
    spans = (tuple(p - b for p, b in zip(rod.plate, rod.base, strict=True)) for rod in mechanism.rods)
    legs = [(rod.plate, span, rod.length) for rod, span in zip(mechanism.rods, spans, strict=True)]
    legs += [(plane.plate, plane.normal, plane.offset) for plane in mechanism.guides]
    found, width, size = [], len(mechanism.motion.position), 0.0
    for plate, along, length in legs:
        span = np.array([float(evaluate(v, at)) for v in along])
        by = [[sp.diff(p, real(c)) for p in plate] for c in mechanism.motion.position]
        by += [[turned_rate(p, axis) for p in plate] for axis in axes]
        slopes = np.array([[float(evaluate(v, at)) for v in column] for column in by])
        size = max(size, float(np.max(np.abs(slopes[width:]), initial=0.0)))
        found.append((slopes @ span / (float(np.linalg.norm(span)) or 1.0), length.free_symbols))
    scale = np.array([1.0] * width + [size or 1.0] * len(axes))
    return [(row / scale, read) for row, read in found]


def turned_rate(value: sp.Expr, axis: str) -> sp.Expr:
    """The rate of a coordinate of the plate where it turns about an axis of the base."""
    rotation, about = sp.Matrix(3, 3, ROTATION_ENTRIES), sp.Matrix([int(axis == c) for c in COORDINATE_NAMES])
    rates = sp.Matrix.hstack(*[about.cross(rotation.col(k)) for k in range(3)])
    return sp.Add(*[sp.diff(value, r) * rate for r, rate in zip(ROTATION_ENTRIES, rates, strict=True)])
