"""The frames of a chain as CasADi expressions: multiplied out factor by factor, and moved by a small twist."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import reduce
from itertools import combinations
from operator import add, mul
from typing import Any

import casadi as ca
import numpy as np
import sympy as sp

from derive.description.joints import Joint, Loop
from derive.description.mechanism import ROTATION, DescriptionError, Mechanism, Turning
from derive.geometry.frames import Chain, Factor, Motion
from derive.ir.constants import DEGREE
from derive.ir.interpret import Array
from derive.ir.primitives import Select
from derive.ir.symbols import COORDINATE_NAMES, real
from derive.work import STEPS, spend


def frame_at(chain: Chain | None, known: Symbols) -> Term:
    """The frame at the end of the chain, multiplied out factor by factor."""
    position, rotation = ca.SX.zeros(3), ca.SX.eye(3)
    for factor in chain.factors if chain else ():
        amount = term(factor.amount, known)
        if factor.motion is Motion.SHIFT:
            position = position + rotation[:, factor.axis] * amount
        elif factor.motion is Motion.TURN:
            rotation = rotation @ turn(factor.axis, ca.cos(amount), ca.sin(amount))
        else:
            rotation = rotation @ turn(factor.axis, 1 - 2 * amount, 0)
    return ca.vertcat(position, ca.reshape(rotation.T, 9, 1))


def turn(axis: int, cosine: Term, sine: Term) -> Term:
    """Rodrigues' formula about a coordinate axis."""
    direction = ca.DM.zeros(3)
    direction[axis] = 1
    return cosine * ca.SX.eye(3) + sine * ca.skew(direction) + (1 - cosine) * (direction @ direction.T)


def joint_values(mechanism: Mechanism, motors: Term, known: Symbols) -> Term:
    """Joint = ratio * motor + coupling of the motors, in radians and lengths."""
    named = {**known, **{j.motor: motors[i] for i, j in enumerate(mechanism.joints)}}
    values = (
        _moved(j, motors[i], known) if j.loops else motors[i] * term(j.ratio, named) + term(j.coupling, named)
        for i, j in enumerate(mechanism.joints)
    )
    return ca.vertcat(ca.SX.zeros(0, 1), *values)


def _moved(joint: Joint, motor: Term, known: Symbols) -> Term:
    """The value of a joint that loops move; not a number where one does not close, or is beyond its dead point."""
    value, is_possible = motor, ca.SX(1)
    for loop in joint.loops:
        moved = _closed(loop, 0, value, known)
        is_possible = ca.logic_and(is_possible, _slope(loop, 1, moved, value, known) > 0)
        value = moved
    return ca.if_else(is_possible, value, float("nan"))


def motor_of(joint: Joint, value: Term, known: Symbols) -> tuple[Term, Term]:
    """The motor value of a joint that loops move, and what is positive where loops close on their sides."""
    is_possible = ca.SX(1)
    for loop in reversed(joint.loops):
        by = _closed(loop, 1, value, known)
        slope = _slope(loop, 0, value, by, known)
        is_possible, value = ca.logic_and(is_possible, slope > 0), by
    return value, 2 * is_possible - 1


def _closed(loop: Loop, sought: int, given: Term, known: Symbols) -> Term:
    """What closes a loop, on its side: 0 for what it moves, 1 for what moves it.

    The start is the textbook's, for a cosine or a square; two steps of Newton's method on the equation as it stands
    then give the value, and by automatic differentiation its derivative.
    """
    unknown, other = (loop.moved, loop.by) if sought == 0 else (loop.by, loop.moved)

    def open_by(value: Term) -> Term:
        return term(loop.equation, {**known, other: given, unknown: value})

    side = term(loop.sides[sought], known)
    if loop.turns[sought]:
        first, opposite, quarter = (open_by(a) for a in (0.0, np.pi, np.pi / 2))
        level, along = (first + opposite) / 2, (first - opposite) / 2
        across = quarter - level
        reach = ca.sqrt(along**2 + across**2)
        value = ca.atan2(across, along) - side * ca.acos(-level / reach)
    else:
        rest, after, before = (open_by(a) for a in (0.0, 1.0, -1.0))
        square, slope = (after + before) / 2 - rest, (after - before) / 2
        value = (-slope + side * ca.sqrt(slope**2 - 4 * square * rest)) / (2 * square)
    for _ in range(2):
        slope = term(sp.diff(loop.equation, unknown), {**known, other: given, unknown: value})
        value = value - open_by(value) / slope
    return value


def _slope(loop: Loop, place: int, moved: Term, by: Term, known: Symbols) -> Term:
    """The derivative of a loop by what it moves (0) or by what moves it (1), with the sign of its side: positive."""
    named = {**known, loop.moved: moved, loop.by: by}
    slope = sp.diff(loop.equation, (loop.moved, loop.by)[place])
    return term(loop.sides[place], known) * term(slope, named)


def moved_by(pose: Term, task: tuple[str, ...], twist: Term, axes: Sequence[Term] = ()) -> Term:
    """The pose moved by a small twist: p + v, (I + [ω]) R. axes: of the pitch and the roll."""
    shift, spin, tilt = ([ca.SX(0)] * 3 for _ in range(3))
    parts = {"turn": spin, "tilt": tilt}
    for i, row in enumerate(task):
        if is_miss(row):
            continue
        if row in ("pitch", "roll"):
            about = axes[("pitch", "roll").index(row)]
            spin = [spin[k] + about[k] * twist[i] for k in range(3)]
            continue
        parts.get(row[:4], shift)["xyz".index(row[-1])] = twist[i]
    rotation = ca.reshape(pose[3:], 3, 3).T
    turned = rotation + ca.skew(ca.vertcat(*spin)) @ rotation + rotation @ ca.skew(ca.vertcat(*tilt))
    return ca.vertcat(pose[:3] + ca.vertcat(*shift), ca.reshape(turned.T, 9, 1))


def task_rows(mechanism: Mechanism) -> tuple[str, ...]:
    """The commanded directions, which the rows of the Jacobian must be."""
    turns = {Turning.NONE: "", Turning.ABOUT_Z: "z", Turning.FULL: "xyz"}
    if mechanism.task.turning is Turning.DIRECTION:
        return (*mechanism.task.position, "tilt x", "tilt y", *(f"miss {j.key}" for j in mechanism.surplus_joints))
    if mechanism.followed_turns:
        return (*mechanism.task.position, *("pitch", "roll")[: mechanism.followed_turns])
    misses = (f"miss {j.key}" for j in mechanism.surplus_joints)
    return (*mechanism.task.position, *(f"turn {axis}" for axis in turns[mechanism.task.turning]), *misses)


def passive_rows(described: Mechanism) -> tuple[str, ...]:
    """The rows of a twist for what the equations of a turning platform move and the task does not command."""
    if not described.is_platform:
        return ()
    read = {s for e in described.equations for s in sp.sympify(e).free_symbols}
    own = tuple(c for c in COORDINATE_NAMES if real(c) in read and c not in described.task.position)
    is_held = described.task.turning is Turning.DIRECTION
    is_held = is_held and len(described.equations) > len(task_rows(described)) + len(own)  # else no leg feels the twist
    return (*own, *((_TWIST,) if is_held else ()))


def with_twist(described: Mechanism) -> Mechanism:
    """The description; one more equation says that its twist is the least turn from home, where it leaves it free."""
    follows = described.is_platform and described.task.turning is Turning.DIRECTION
    if not follows or _TWIST in passive_rows(described):
        return described
    roll, pitch, yaw = described.home[-3:]
    home = sp.rot_ccw_axis3(yaw) * sp.rot_ccw_axis2(pitch) * sp.rot_ccw_axis1(roll)
    twist = home.col(1).dot(ROTATION.col(0)) - home.col(0).dot(ROTATION.col(1))
    return replace(described, closure=(*described.closure, twist))


def entries_at(column: Term, places: list[int]) -> Term:
    """The entries of a column at some places, which may be none."""
    return column[places] if places else ca.SX.zeros(0, 1)


def is_miss(row: str) -> bool:
    """Whether a row of the Jacobian is the miss of a surplus rod."""
    return row.startswith("miss ")


def as_in(machine: Mechanism, described: Mechanism) -> Mechanism:
    """A description with the surplus joints of the machine that was derived of it."""
    names = {joint.name for joint in machine.surplus}
    return replace(described, surplus=tuple(joint for joint in described.joints if joint.name in names))


def missed(mechanism: Mechanism, misses: Term) -> tuple[list[sp.Expr], Symbols]:
    """The stated equations with surplus rods that are longer by their misses, and the symbols of these."""
    names = [sp.Symbol(f"miss {rod.name}") for rod in mechanism.surplus_rods]
    rods = zip(mechanism.surplus_rods, names, strict=True)
    longer = {rod.equation: replace(rod, length=rod.length + name).equation for rod, name in rods}
    return [longer.get(e, e) for e in mechanism.equations], {name: misses[i] for i, name in enumerate(names)}


def pulled(mechanism: Mechanism, known: Symbols, slopes: Term) -> list[Term]:
    """The least tension of cables that hold a load, of those sets of legs that could hold it alone the largest, and a
    positive number without a load. slopes: the derivatives of the stated equations by the pose.
    """
    if not mechanism.load:
        return []
    load = ca.vertcat(*(term(v, known) for v in mechanism.load))
    count, first = slopes.shape[1], len(mechanism.equations) - len(mechanism.rods)
    whole = ca.vertcat(load, ca.SX.zeros(count - load.numel()))
    lines = [slopes[first + k, :].T for k in range(len(mechanism.rods))]
    found: Term = -1.0
    for legs in combinations(range(len(lines)), count):
        tensions = ca.solve(ca.horzcat(*(lines[k] / ca.norm_2(lines[k]) for k in legs)), whole)
        least: Term = 1.0
        for pull in (tensions[i] for i, k in enumerate(legs) if mechanism.rods[k].only_pulls):
            least = ca.fmin(least, pull)
        found = ca.fmax(found, least)
    return [ca.if_else(ca.norm_2(load) > 0, found, 1.0)]


def drift_of(velocity: Term, joints: tuple[Term, Term], pose: tuple[Term, Term], axes: tuple[Term, Term, Term]) -> Term:
    """The rate of the velocity of Φ at constant rates of the pose, and constant speeds of the axes.

    joints, pose: their values and rates; axes: their values, the joints at these, and their speeds.
    """
    (q, moving), (values, at_axes, speeds) = joints, axes
    at_speeds = ca.jtimes(at_axes, values, speeds)
    changed = ca.jtimes(velocity, q, moving) + ca.jtimes(velocity, *pose)
    changed += ca.jacobian(velocity, moving) @ ca.jtimes(at_speeds, values, speeds)
    return ca.substitute([changed], [q, moving], [at_axes, at_speeds])[0]


def followed_axes(mechanism: Mechanism, known: Symbols) -> list[Term]:
    """The axes of the turns that follow the commanded rotation, in the frame of the base."""
    if mechanism.chain is None or not mechanism.followed_turns:
        return []
    factors = mechanism.chain.factors
    frames = ((factors[k], frame_at(Chain(factors[:k]), known)) for k in _followed(mechanism, factors))
    return [frame[[3 + factor.axis, 6 + factor.axis, 9 + factor.axis]] for factor, frame in frames]


def _followed(mechanism: Mechanism, factors: Sequence[Factor]) -> list[int]:
    """Where in the chain the last turns by joints are: one factor of each, neighbours about one axis as one turn."""
    joints = {j.symbol for j in mechanism.solved_joints}
    turns: list[tuple[int, sp.Expr, int]] = []
    for k, factor in enumerate(factors):
        if factor.motion is Motion.SHIFT:
            continue
        amount = factor.amount
        if turns and factor.motion is Motion.TURN and turns[-1][0] == factor.axis:
            amount = sp.expand(turns.pop()[1] + amount)
        turns += [(factor.axis, amount, k)] if amount != 0 else []
    return [k for _, amount, k in turns if amount.free_symbols & joints][-mechanism.followed_turns :]


def followed_pose(mechanism: Mechanism, known: Symbols, pose: Term) -> Term:
    """The pose with its rotation swung, by the smallest turn, until the tool is in the plane in which the pitch moves
    it.
    """
    square, *others = followed_axes(mechanism, known)
    own = ca.reshape(frame_at(mechanism.chain, known)[3:], 3, 3)  # by rows: this is its transpose
    tool = own @ others[0] if others else ca.DM([0, 0, 1])
    rotation = ca.reshape(pose[3:], 3, 3).T
    commanded = rotation @ tool
    seen = commanded - square * ca.dot(square, commanded)
    seen = seen / ca.sqrt(ca.dot(seen, seen))
    axis = ca.skew(ca.cross(commanded, seen))
    swung = rotation + axis @ rotation + axis @ axis @ rotation / (1 + ca.dot(commanded, seen))
    return ca.vertcat(pose[:3], ca.reshape(swung.T, 9, 1))


_TWIST = "tilt z"
"""The row of a twist for the turn about the tool, where the task does not command it."""
_TOGETHER = 64
"""Rows that a CasADi function takes at a time."""
_AS_LONG = 20
"""So many instructions of it, for these rows, take about as long as one step of a program."""


class Rows:
    """A CasADi function over rows of samples: (samples, size) arrays in, (samples, rows, columns) out."""

    def __init__(self, name: str, arguments: tuple[Term, ...], result: Term) -> None:
        self._shape = result.shape
        self._function = ca.Function(name, arguments, [ca.densify(result)])
        self._steps = 1 + self._function.n_instructions() // _AS_LONG
        self._buffer: Any = None

    def __call__(self, *columns: Array) -> Array:
        rows, width = self._shape
        result = np.empty((len(columns[0]), width, rows))  # CasADi stores by columns
        if result.size:
            given = [np.ascontiguousarray(c, dtype=float) for c in columns]
            spend(-(-len(result) // _TOGETHER) * self._steps, STEPS)
            whole = len(result) - len(result) % _TOGETHER
            for first in range(0, whole, _TOGETHER):
                self._run([c[first : first + _TOGETHER] for c in given], result[first : first + _TOGETHER])
            if whole < len(result):
                last = np.empty((_TOGETHER, width, rows))
                self._run([_filled(c[whole:]) for c in given], last)
                result[whole:] = last[: len(result) - whole]
        return np.swapaxes(result, 1, 2)

    def _run(self, given: Sequence[Array], result: Array) -> None:
        if self._buffer is None:
            self._buffer = self._function.map(_TOGETHER).buffer()
        buffer, run = self._buffer
        for place, rows_of_samples in enumerate(given):
            if rows_of_samples.size:
                buffer.set_arg(place, rows_of_samples.data)
        buffer.set_res(0, result.data)
        run()


def _filled(rows: Array) -> Array:
    """So many rows as CasADi takes at a time: the first once more where there are fewer."""
    return np.concatenate([rows, np.repeat(rows[:1], _TOGETHER - len(rows), axis=0)])


Term = Any
"""A CasADi expression (`casadi.SX`) or a number; CasADi carries no types."""
Symbols = dict[sp.Symbol, Term]
"""The symbols of a description, with their CasADi expressions."""

_FUNCTIONS: dict[type[sp.Basic], Callable[..., Term]] = {
    sp.Add: lambda *terms: reduce(add, terms),
    sp.Mul: lambda *factors: reduce(mul, factors),
    sp.Pow: lambda base, exponent: base**exponent,
    sp.sin: ca.sin,
    sp.cos: ca.cos,
    sp.Abs: ca.fabs,
    sp.sign: ca.sign,
    sp.Gt: operator.gt,
    Select: ca.if_else,
}


def term(expression: sp.Basic, symbols: Mapping[sp.Symbol, Term]) -> Term:
    """The expression over CasADi symbols; angles are in radians on both sides."""
    if expression == DEGREE:
        return float(sp.pi) / 180.0
    if isinstance(expression, sp.Symbol):
        if expression not in symbols:
            raise DescriptionError(f"{expression} is neither a joint nor a parameter")
        return symbols[expression]
    if isinstance(expression, sp.Number | sp.NumberSymbol):
        return float(expression)
    if type(expression) not in _FUNCTIONS:
        raise DescriptionError(f"{expression.func} has no place in a description: {expression}")
    return _FUNCTIONS[type(expression)](*(term(a, symbols) for a in expression.args))
