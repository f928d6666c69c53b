"""The closure equations of a mechanism as CasADi functions, built from its description as it is written.

Nothing here knows a derived formula, or what the compiler makes of a description before it derives: a chain is
multiplied out factor by factor, closure equations are read as they stand, and every derivative is automatic
differentiation. Parameters are matched with those of the machine by the names that the user gave, axes by their places.
Functions work on rows of samples.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import reduce

import casadi as ca
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.amounts import with_exact_angles
from derive.description.mechanism import ROTATION, Mechanism, Turning, X, Y, Z
from derive.geometry.frames import Motion
from derive.ir.constants import DEGREE
from derive.ir.interpret import Array
from derive.ir.symbols import COORDINATE_NAMES, real
from derive.witness.frames import (
    Rows,
    Symbols,
    Term,
    as_in,
    drift_of,
    entries_at,
    followed_axes,
    followed_pose,
    frame_at,
    is_miss,
    joint_values,
    missed,
    motor_of,
    moved_by,
    passive_rows,
    pulled,
    task_rows,
    term,
    turn,
    with_twist,
)

LEAST_MARGIN = 1e-6
"""A solution of a closed loop nearer to a type 2 singularity than this is not counted."""
POSE = ("x", "y", "z", *(f"r{i}{j}" for i in "123" for j in "123"))
"""The columns of a pose: position, then rotation by rows."""


@dataclass(frozen=True)
class Closure:
    """Φ(q, pose; p) = 0 of one mechanism: q are joint values in radians and lengths, p its parameters."""

    described: Mechanism
    """The description, as it is written."""
    joints: Rows
    """axes (interface units), parameters → joint values"""
    gearing: Rows
    """axes, parameters → ∂ joints / ∂ axes, per radian"""
    residual: Rows
    """joints, pose, parameters → Φ; the first `equations` rows are lengths or the like, the others rotation entries"""
    by_pose: Rows
    """joints, pose, parameters → A = ∂Φ/∂pose along twists, one column for each of `moved`"""
    by_joints: Rows
    """joints, pose, parameters → B = ∂Φ/∂q"""
    drift: Rows
    """axes, pose, parameters, speeds of the axes, rates of `moved` → -A times the acceleration at constant speeds"""
    frame: Rows
    """joints, parameters → the pose of a chain; with stated equations the rotation that they tell, at position zero"""
    positive: Rows
    """joints, pose, parameters → the quantities that are positive in this machine"""
    indicators: Rows
    """joints, pose, parameters → branch indicators, positive = byte 1"""
    equations: int
    task: tuple[str, ...]
    """The rows of the task, as the Jacobian names them."""
    moved: tuple[str, ...]
    """The columns of `by_pose`: the task, then what the loop moves besides."""
    parameters: tuple[str, ...]
    """The columns of the parameters: those of the description, then the offsets."""
    angles: NDArray[np.bool_]
    """Which joints are angles: the closure turns by them."""
    rates: Rows
    """joints, parameters → the largest and the least turn of the closure per turn of each joint (columns); ones for a
    joint that is no angle"""
    places: Rows
    """joints, parameters → what tells solutions apart: cosines and sines of all angles of the closure, then lengths"""
    turned: int
    """How many of the places are cosines and sines."""
    motors: Rows
    """joints, parameters → the motor values of the joints that loops move; zeros for others"""
    solved: NDArray[np.bool_]
    """Which joints the inverse solves for: the others keep the value of the reference."""

    def row_scale(self, reach: Array) -> Array:
        """The unit of each row of the task, where lengths are measured in reaches."""
        return np.where([row in COORDINATE_NAMES or is_miss(row) for row in self.moved], reach[:, None], 1.0)

    def joint_scale(self, reach: Array, joints: Array, parameters: Array) -> Array:
        """The unit of each joint, in radians and lengths: a radian of the closure, however slow a gear makes it."""
        return np.where(self.angles, 1.0 / self.rates(joints, parameters)[:, :, 0], reach[:, None])

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The coordinates of the position that the loop moves, those of the task first."""
        return tuple(row for row in self.moved if row in COORDINATE_NAMES)

    def joint_size(self, reach: Array) -> Array:
        """The size of the values of each joint, in radians and lengths."""
        return np.where(self.angles, 1.0, reach[:, None])

    def described_values(self, values: Mapping[str, Array]) -> dict[str, Array]:
        """The values of the parameters, by the names that the description's expressions have for them."""
        own = zip(self.described.parameters, self.parameters, strict=False)
        return {parameter.symbol.name: values[column] for parameter, column in own}

    def axes_at(self, joints: Array, offsets: Array, parameters: Array, in_degrees: NDArray[np.bool_]) -> Array:
        """The axes with these joint values."""
        gears = self.gearing(offsets, parameters)
        motors = np.linalg.solve(gears, joints[:, :, None] - self.joints(offsets, parameters))[:, :, 0]
        return np.asarray(offsets + np.where(in_degrees, np.degrees(motors), motors))

    def axis_scale(self, reach: Array) -> Array:
        """The unit of each axis, in degrees and lengths."""
        turns = [j.in_degrees if j.loops else a for j, a in zip(self.described.joints, self.angles, strict=True)]
        return np.where(turns, np.degrees(1.0), reach[:, None])


def closure_of(described: Mechanism, machine: Mechanism) -> Closure:
    """The closure of a description in CasADi.

    machine: what was derived of it. It gives the names of its inputs in programs, and says what the signs of branches
    and of an assembly mode mean that the description does not name.
    """
    described, count = with_twist(with_exact_angles(as_in(machine, described))), len(described.joints)
    q, axes, pose = ca.SX.sym("q", count), ca.SX.sym("axes", count), ca.SX.sym("pose", len(POSE))
    columns = _columns(described, machine)
    p = ca.SX.sym("p", len(columns))
    known = {own.symbol: p[i] for i, own in enumerate(described.parameters)}
    offsets = p[len(known) : len(known) + count]
    motors = (axes - offsets) * ca.vertcat(*(term(j.unit, {}) for j in described.joints))
    joints = joint_values(described, motors, known)
    known |= {joint.symbol: q[i] for i, joint in enumerate(described.joints)}
    drives = [motor_of(j, q[i], known) if j.loops else (ca.SX(0), ca.SX(1)) for i, j in enumerate(described.joints)]
    task = task_rows(described)
    rows = (*task, *passive_rows(described))
    twist = ca.SX.sym("twist", len(rows))
    moved = moved_by(pose, rows, twist, followed_axes(described, known))
    missing, misses = ca.SX.sym("misses", len(described.surplus)), [k for k, row in enumerate(rows) if is_miss(row)]
    residual, equations = _residual(described, known, moved, missing + entries_at(twist, misses))
    units = ca.vertcat(*(float(j.unit.subs(DEGREE, sp.pi / 180)) for j in described.joints))
    at_rest = ca.substitute([residual, ca.jacobian(residual, twist)], [twist], [ca.SX.zeros(len(rows))])
    frame, speeds, rates = _frame_of(described, known), ca.SX.sym("speeds", count), ca.SX.sym("rates", len(rows))
    by_joints, moving = ca.jacobian(at_rest[0], q), ca.SX.sym("moving", count)
    posed = ca.jtimes(moved, twist, rates) if described.chain is None else ca.jtimes(frame, q, moving)
    velocity, moved_axes = at_rest[1] @ rates + by_joints @ moving, (axes, joints, speeds / units)
    moving_pose = (ca.vertcat(pose, missing), ca.vertcat(posed, entries_at(rates, misses)))
    drift = drift_of(velocity, (q, moving), moving_pose, moved_axes)
    fitting = [missing], [ca.SX.zeros(len(misses))]
    *at_rest, by_joints, drift = ca.substitute([*at_rest, by_joints, drift], *fitting)
    possible = [least for j, (_, least) in zip(described.joints, drives, strict=True) if j.loops]
    named = known | _position_symbols(pose)
    labels = _machine_symbols(described, machine, q, p) | _position_symbols(pose)
    possible += pulled(described, known, at_rest[1][:, [k for k in range(len(rows)) if k not in misses]])
    state = (q, pose, p)
    angles, lengths = _places(described)
    turned = _column([term(a, known) for a in angles])
    is_angle = np.array([any(a.has(j.symbol) for a in angles) for j in described.joints], dtype=bool)
    return Closure(
        described=described,
        joints=Rows("joints", (axes, p), joints),
        gearing=Rows("gearing", (axes, p), ca.jacobian(joints, axes) @ ca.diag(1 / units)),
        residual=Rows("residual", state, at_rest[0]),
        by_pose=Rows("by_pose", state, at_rest[1]),
        by_joints=Rows("by_joints", state, by_joints),
        drift=Rows("drift", (axes, pose, p, speeds, rates), drift),
        frame=Rows("frame", (q, p), frame),
        positive=Rows("positive", state, _column([*_positive(described, named, machine, labels), *possible])),
        indicators=Rows("indicators", state, _column(_indicators(described, named, machine, labels))),
        equations=equations,
        task=task,
        moved=rows,
        parameters=columns,
        angles=is_angle,
        rates=Rows("rates", (q, p), _rates(turned, q, is_angle)),
        places=Rows("places", (q, p), ca.vertcat(ca.cos(turned), ca.sin(turned), *(term(v, known) for v in lengths))),
        turned=2 * len(angles),
        motors=Rows("motors", (q, p), _column([m for m, _ in drives])),
        solved=np.array([j not in described.held_joints for j in described.joints]),
    )


def _columns(described: Mechanism, machine: Mechanism) -> tuple[str, ...]:
    """The columns of the parameters: the names that the machine's programs give to those of the description, to the
    offsets of the axes, and to the assembly mode.
    """
    names = {p.given_name: p.name for p in machine.parameters}
    own = (names[p.given_name] for p in described.parameters)
    mode = (machine.assembly.parameter,) if machine.assembly is not None else ()
    return (*own, *(j.offset.name for j in machine.joints), *mode)


def _machine_symbols(described: Mechanism, machine: Mechanism, q: Term, p: Term) -> Symbols:
    """What the machine's own expressions read: they give signs a meaning where the description gives none.

    Its joints may have other gears than those of the description: both follow from the motors.
    """
    columns = dict(zip(_columns(described, machine), (p[i] for i in range(p.numel())), strict=True))
    named = {m.symbol: columns[m.name] if m.fixed is None else float(m.nominal) for m in machine.parameters}
    given = {own.symbol: p[i] for i, own in enumerate(described.parameters)}
    motors = ca.SX.sym("motors", len(machine.joints))
    geared = (_without_loops(m) for m in (described, machine))  # a joint that loops move has no gear
    own, others = (joint_values(m, motors, known) for m, known in zip(geared, (given, named), strict=True))
    if ca.is_equal(own, others, 8):
        values = q
    else:
        values = ca.substitute(others, motors, ca.solve(ca.jacobian(own, motors), q))
    named |= {joint.symbol: values[i] for i, joint in enumerate(machine.joints)}
    return named | ({real(machine.assembly.parameter): p[-1]} if machine.assembly is not None else {})


def _without_loops(mechanism: Mechanism) -> Mechanism:
    return replace(mechanism, drives=(), joints=tuple(replace(j, loops=()) for j in mechanism.joints))


def _places(described: Mechanism) -> tuple[tuple[sp.Expr, ...], tuple[sp.Expr, ...]]:
    """The angles by which the closure turns, and the lengths by which joints shift, as far as joints are in them."""
    joints = {j.symbol for j in described.joints}
    if described.chain is not None:
        moving = [f for f in described.chain.factors if f.amount.free_symbols & joints]
        kinds = (Motion.TURN, Motion.SHIFT)
        angles, lengths = (tuple(dict.fromkeys(f.amount for f in moving if f.motion is kind)) for kind in kinds)
        return angles, lengths
    functions = {f for e in described.equations for f in sp.sympify(e).atoms(sp.sin, sp.cos)}
    turned = [f.args[0] for f in sorted(functions, key=sp.default_sort_key)]
    turned += [] if described.heading is None else [described.heading]
    angles = tuple(dict.fromkeys(a for a in turned if a.free_symbols & joints))
    turning = {s for a in angles for s in a.free_symbols & joints}
    return angles, _lengths(described, turning)


def _lengths(described: Mechanism, turning: set[sp.Basic]) -> tuple[sp.Expr, ...]:
    """The joints that are lengths, each with the angles that equations add to it: a quill that climbs with a turn is
    elsewhere after a whole one, and the solution is the same.
    """
    joints = {j.symbol for j in described.joints}
    own = joints | {p.symbol for p in described.parameters}
    climbing: dict[sp.Basic, sp.Expr] = {}
    for total in (t for e in described.equations for t in sp.preorder_traversal(sp.sympify(e)) if t.is_Add):
        shifts = (t for t in total.args if t.free_symbols <= own and not t.has(sp.sin, sp.cos))
        shift = sp.Add(*[t for t in shifts if t.free_symbols & joints])
        if shift.free_symbols & turning:
            climbing |= dict.fromkeys(shift.free_symbols & (joints - turning), shift)
    return tuple(climbing.get(j.symbol, j.symbol) for j in described.joints if j.symbol not in turning)


def _rates(turned: Term, q: Term, is_angle: NDArray[np.bool_]) -> Term:
    """The largest and the least turn of the closure per turn of each joint; ones for a joint that is no angle."""
    slopes = ca.jacobian(turned, q)
    rows: list[Term] = []
    for k, turns in enumerate(is_angle):
        own: list[Term] = [
            ca.fabs(slopes[i, k]) for i in range(slopes.shape[0]) if turns and not slopes[i, k].is_zero()
        ] or [1.0]
        rows.append(ca.horzcat(reduce(ca.fmax, own), reduce(ca.fmin, own)))
    return ca.vertcat(*rows) if rows else ca.SX.zeros(0, 2)


def _positive(described: Mechanism, named: Symbols, machine: Mechanism, labels: Symbols) -> list[Term]:
    """The positive quantities of this machine: stated ones, distances from bounds, the indicator of
    the assembly mode.
    """
    stated = [*described.positive, *(b.largest - sp.Abs(b.value) for b in described.bounds)]
    left = [term(sp.sympify(e), named) for e in stated]
    rods = {rod.length for rod in machine.rods}  # those that joints change are positive as such; nothing else is added
    left += [term(sp.sympify(e), labels) for e in machine.positive if e in rods]
    if machine.assembly is None:
        return left
    owner, symbols = (machine, labels) if described.assembly is None else (described, named)
    way = owner.assembly
    assert way is not None
    lengths = sp.Mul(*[sp.Abs(rod.length) for rod in owner.holding_rods])
    mode = way.signs[0] * way.indicator * sp.sign(way.handedness) / lengths
    return [*left, (1 - 2 * labels[real(machine.assembly.parameter)]) * term(mode, symbols) - LEAST_MARGIN]


def _indicators(described: Mechanism, named: Symbols, machine: Mechanism, labels: Symbols) -> list[Term]:
    """The branch indicators: positive is byte 1. NaN, which no check compares, where only a search tells the solutions
    apart.
    """
    own = {branch.name: branch for branch in described.branches}
    found = ((own.get(b.name, b), named if b.name in own else labels) for b in machine.branches)
    return [ca.SX(float("nan")) if b.is_crossing else b.signs[0] * term(b.indicator, symbols) for b, symbols in found]


def _column(terms: list[Term]) -> Term:
    return ca.vertcat(*terms) if terms else ca.SX.zeros(0, 1)


def _position_symbols(pose: Term) -> Symbols:
    return {symbol: pose[i] for i, symbol in enumerate((X.symbol, Y.symbol, Z.symbol, *ROTATION))}


def _residual(mechanism: Mechanism, known: Symbols, pose: Term, misses: Term) -> tuple[Term, int]:
    """Φ, and the number of its rows before those of the rotation. misses: what surplus rods are too short."""
    if mechanism.chain is None:
        equations, missing = missed(mechanism, misses)
        named = known | _position_symbols(pose) | missing
        stated = [*equations, *_turned(mechanism)]
        return _column([term(sp.sympify(e), named) for e in stated]), len(mechanism.equations)
    if mechanism.followed_turns:
        pose = followed_pose(mechanism, known, pose)
    difference = frame_at(mechanism.chain, known) - pose
    own = ["xyz".index(c) for c in mechanism.task.position]
    if mechanism.nominal and mechanism.task.turning is Turning.ABOUT_Z:  # its axes are tilted: it meets the turn alone
        here, goal = (ca.reshape(r[3:], 3, 3).T for r in (difference + pose, pose))
        left = here @ goal.T
        return ca.vertcat(difference[own], ca.atan2(left[1, 0] - left[0, 1], left[0, 0] + left[1, 1])), len(own)
    column = [5, 8, 11]
    followed = {Turning.NONE: [], Turning.DIRECTION: column, Turning.PITCH: column}
    rotation = followed.get(mechanism.task.turning, list(range(3, 12)))
    return difference[[*own, *rotation]], len(own)


def _turned(mechanism: Mechanism) -> tuple[sp.Expr, ...]:
    """The equations of a heading that joints tell: the x axis of the flange."""
    if mechanism.heading is None:
        return ()
    return sp.cos(mechanism.heading) - ROTATION[0, 0], sp.sin(mechanism.heading) - ROTATION[1, 0]


def _frame_of(mechanism: Mechanism, known: Symbols) -> Term:
    """The frame of a chain; of a loop its rotation, at position zero."""
    if mechanism.heading is None:
        return frame_at(mechanism.chain, known)
    angle = term(mechanism.heading, known)
    return ca.vertcat(ca.SX.zeros(3), ca.reshape(turn(2, ca.cos(angle), ca.sin(angle)).T, 9, 1))
