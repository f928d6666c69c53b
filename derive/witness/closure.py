"""The closure equations of a mechanism as CasADi functions, built from its description alone.

Nothing here knows a derived formula: a chain is multiplied out factor by factor, closure equations are
read as they stand, and every derivative is automatic differentiation. Functions work on rows of samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import ROTATION, Branch, Mechanism, Turning, X, Y, Z
from derive.equations.pitch.chain import followed_factors
from derive.geometry.frames import Chain, Motion
from derive.ir.constants import DEGREE
from derive.ir.interpret import Array
from derive.ir.symbols import COORDINATE_NAMES, real
from derive.witness.terms import Term, term

LEAST_MARGIN = 1e-6
"""A solution of a closed loop nearer to a type 2 singularity than this is not counted."""
POSE = ("x", "y", "z", *(f"r{i}{j}" for i in "123" for j in "123"))
"""The columns of a pose: position, then rotation by rows."""
_PASSIVE = {"twist": "tilt z"}
"""The rows of a twist for what the task does not command: the turn about the tool."""
_TOGETHER = 64
"""Rows that a CasADi function takes at a time."""


class Rows:
    """A CasADi function over rows of samples: (samples, size) arrays in, (samples, rows, columns) out."""

    def __init__(self, name: str, arguments: tuple[Term, ...], result: Term) -> None:
        self._shape = result.shape
        self._function = ca.Function(name, arguments, [ca.densify(result)])
        self._buffer: Any = None

    def __call__(self, *columns: Array) -> Array:
        rows, width = self._shape
        result = np.empty((len(columns[0]), width, rows))  # CasADi stores by columns
        if result.size:
            given = [np.ascontiguousarray(c, dtype=float) for c in columns]
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


@dataclass(frozen=True)
class Closure:
    """Φ(q, pose; p) = 0 of one mechanism: q are joint values in radians and lengths, p its parameters."""

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
    """Which joints are angles."""
    solved: NDArray[np.bool_]
    """Which joints the inverse solves for: the others keep the value of the reference."""

    def row_scale(self, reach: Array) -> Array:
        """The unit of each row of the task, where lengths are measured in reaches."""
        return np.where([row not in COORDINATE_NAMES for row in self.moved], 1.0, reach[:, None])

    def joint_scale(self, reach: Array) -> Array:
        """The unit of each joint, in radians and lengths."""
        return np.where(self.angles, 1.0, reach[:, None])

    def axis_scale(self, reach: Array) -> Array:
        """The unit of each axis, in degrees and lengths."""
        return np.where(self.angles, np.degrees(1.0), reach[:, None])


def closure_of(mechanism: Mechanism) -> Closure:
    """The closure of a description in CasADi."""
    count = len(mechanism.joints)
    q, axes, pose = ca.SX.sym("q", count), ca.SX.sym("axes", count), ca.SX.sym("pose", len(POSE))
    constants = [p.symbol for p in mechanism.parameters] + [j.offset for j in mechanism.joints]
    constants += [real(mechanism.assembly.parameter)] if mechanism.assembly else []
    p = ca.SX.sym("p", len(constants))
    known = {symbol: p[i] for i, symbol in enumerate(constants)}
    known |= {joint.symbol: q[i] for i, joint in enumerate(mechanism.joints)}
    task = task_rows(mechanism)
    rows = (*task, *(_PASSIVE.get(row, row) for row in mechanism.passive))
    twist = ca.SX.sym("twist", len(rows))
    moved = _moved(pose, rows, twist, _followed_axes(mechanism, known))
    joints = _joint_values(mechanism, axes, known)
    residual, equations = _residual(mechanism, known, moved)
    units = ca.vertcat(*(float(j.unit.subs(DEGREE, sp.pi / 180)) for j in mechanism.joints))
    at_rest = ca.substitute([residual, ca.jacobian(residual, twist)], [twist], [ca.SX.zeros(len(rows))])
    named = known | _position_symbols(pose)
    state = (q, pose, p)
    return Closure(
        joints=Rows("joints", (axes, p), joints),
        gearing=Rows("gearing", (axes, p), ca.jacobian(joints, axes) @ ca.diag(1 / units)),
        residual=Rows("residual", state, at_rest[0]),
        by_pose=Rows("by_pose", state, at_rest[1]),
        by_joints=Rows("by_joints", state, ca.jacobian(at_rest[0], q)),
        frame=Rows("frame", (q, p), _frame_of(mechanism, known)),
        positive=Rows("positive", state, _column([term(sp.sympify(e), named) for e in _positive(mechanism)])),
        indicators=Rows("indicators", state, _column([_indicator(b, named) for b in mechanism.branches])),
        equations=equations,
        task=task,
        moved=rows,
        parameters=tuple(s.name for s in constants),
        angles=np.array([j.is_angle for j in mechanism.joints]),
        solved=np.array([j not in mechanism.held_joints for j in mechanism.joints]),
    )


def task_rows(mechanism: Mechanism) -> tuple[str, ...]:
    """The commanded directions, which the rows of the Jacobian must be."""
    turns = {Turning.NONE: "", Turning.ABOUT_Z: "z", Turning.FULL: "xyz"}
    if mechanism.task.turning is Turning.DIRECTION:
        return (*mechanism.task.position, "tilt x", "tilt y")
    if mechanism.followed_turns:
        return (*mechanism.task.position, *("pitch", "roll")[: mechanism.followed_turns])
    return (*mechanism.task.position, *(f"turn {axis}" for axis in turns[mechanism.task.turning]))


def _positive(mechanism: Mechanism) -> list[sp.Expr]:
    """The positive quantities of this machine: stated ones, distances from bounds, the indicator of
    the assembly mode.
    """
    left = [*mechanism.positive, *(b.largest - sp.Abs(b.value) for b in mechanism.bounds)]
    if mechanism.assembly is None:
        return left
    way = mechanism.assembly
    mode = way.signs[0] * (1 - 2 * real(way.parameter)) * way.indicator * sp.sign(way.handedness)
    return [*left, mode / sp.Mul(*[sp.Abs(rod.length) for rod in mechanism.rods]) - LEAST_MARGIN]


def _indicator(branch: Branch, named: dict[sp.Symbol, Term]) -> Term:
    """The branch indicators: positive is byte 1. NaN, which no check compares, where only a scan tells the solutions
    apart.
    """
    return ca.SX(float("nan")) if branch.is_crossing else branch.signs[0] * term(branch.indicator, named)


def _column(terms: list[Term]) -> Term:
    return ca.vertcat(*terms) if terms else ca.SX.zeros(0, 1)


def _position_symbols(pose: Term) -> dict[sp.Symbol, Term]:
    return {symbol: pose[i] for i, symbol in enumerate((X.symbol, Y.symbol, Z.symbol, *ROTATION))}


def _joint_values(mechanism: Mechanism, axes: Term, known: dict[sp.Symbol, Term]) -> Term:
    """Joint = ratio * motor + coupling of the motors, motor = axis - offset, in radians and lengths."""
    motors = [(axes[i] - known[j.offset]) * term(j.unit, {}) for i, j in enumerate(mechanism.joints)]
    named = known | {j.motor: motors[i] for i, j in enumerate(mechanism.joints)}
    return ca.vertcat(
        *(motors[i] * term(j.ratio, named) + term(j.coupling, named) for i, j in enumerate(mechanism.joints))
    )


def _followed_axes(mechanism: Mechanism, known: dict[sp.Symbol, Term]) -> list[Term]:
    """The axes of the turns that follow the commanded rotation, in the frame of the base."""
    if mechanism.chain is None or not mechanism.followed_turns:
        return []
    factors = mechanism.chain.factors
    frames = ((factors[k], _frame(Chain(factors[:k]), known)) for k in followed_factors(mechanism))
    return [frame[[3 + factor.axis, 6 + factor.axis, 9 + factor.axis]] for factor, frame in frames]


def _moved(pose: Term, task: tuple[str, ...], twist: Term, axes: Sequence[Term] = ()) -> Term:
    """The pose moved by a small twist: p + v, (I + [ω]) R. axes: of the pitch and the roll."""
    shift, spin, tilt = ([ca.SX(0)] * 3 for _ in range(3))
    parts = {"turn": spin, "tilt": tilt}
    for i, row in enumerate(task):
        if row in ("pitch", "roll"):
            about = axes[("pitch", "roll").index(row)]
            spin = [spin[k] + about[k] * twist[i] for k in range(3)]
            continue
        parts.get(row[:4], shift)["xyz".index(row[-1])] = twist[i]
    rotation = ca.reshape(pose[3:], 3, 3).T
    turned = rotation + ca.skew(ca.vertcat(*spin)) @ rotation + rotation @ ca.skew(ca.vertcat(*tilt))
    return ca.vertcat(pose[:3] + ca.vertcat(*shift), ca.reshape(turned.T, 9, 1))


def _residual(mechanism: Mechanism, known: dict[sp.Symbol, Term], pose: Term) -> tuple[Term, int]:
    """Φ, and the number of its rows before those of the rotation."""
    if mechanism.chain is None:
        named = known | _position_symbols(pose)
        stated = [*mechanism.equations, *_turned(mechanism)]
        return _column([term(sp.sympify(e), named) for e in stated]), len(mechanism.equations)
    if mechanism.followed_turns:
        pose = _followed_pose(mechanism, known, pose)
    difference = _frame(mechanism.chain, known) - pose
    own = ["xyz".index(c) for c in mechanism.task.position]
    column = [5, 8, 11]
    followed = {Turning.NONE: [], Turning.DIRECTION: column, Turning.PITCH: column}
    rotation = followed.get(mechanism.task.turning, list(range(3, 12)))
    return difference[[*own, *rotation]], len(own)


def _followed_pose(mechanism: Mechanism, known: dict[sp.Symbol, Term], pose: Term) -> Term:
    """The pose with its rotation swung, by the smallest turn, until the tool is in the plane in which the pitch moves
    it.
    """
    square, *others = _followed_axes(mechanism, known)
    own = ca.reshape(_frame(mechanism.chain, known)[3:], 3, 3)  # by rows: this is its transpose
    tool = own @ others[0] if others else ca.DM([0, 0, 1])
    rotation = ca.reshape(pose[3:], 3, 3).T
    commanded = rotation @ tool
    seen = commanded - square * ca.dot(square, commanded)
    seen = seen / ca.sqrt(ca.dot(seen, seen))
    axis = ca.skew(ca.cross(commanded, seen))
    swung = rotation + axis @ rotation + axis @ axis @ rotation / (1 + ca.dot(commanded, seen))
    return ca.vertcat(pose[:3], ca.reshape(swung.T, 9, 1))


def _turned(mechanism: Mechanism) -> tuple[sp.Expr, ...]:
    """The equations of a heading that joints tell: the x axis of the flange."""
    if mechanism.heading is None:
        return ()
    return sp.cos(mechanism.heading) - ROTATION[0, 0], sp.sin(mechanism.heading) - ROTATION[1, 0]


def _frame_of(mechanism: Mechanism, known: dict[sp.Symbol, Term]) -> Term:
    """The frame of a chain; of a loop its rotation, at position zero."""
    if mechanism.heading is None:
        return _frame(mechanism.chain, known)
    angle = term(mechanism.heading, known)
    return ca.vertcat(ca.SX.zeros(3), ca.reshape(_turn(2, ca.cos(angle), ca.sin(angle)).T, 9, 1))


def _frame(chain: Chain | None, known: dict[sp.Symbol, Term]) -> Term:
    """The frame at the end of the chain, multiplied out factor by factor."""
    position, rotation = ca.SX.zeros(3), ca.SX.eye(3)
    for factor in chain.factors if chain else ():
        amount = term(factor.amount, known)
        if factor.motion is Motion.SHIFT:
            position = position + rotation[:, factor.axis] * amount
        elif factor.motion is Motion.TURN:
            rotation = rotation @ _turn(factor.axis, ca.cos(amount), ca.sin(amount))
        else:
            rotation = rotation @ _turn(factor.axis, 1 - 2 * amount, 0)
    return ca.vertcat(position, ca.reshape(rotation.T, 9, 1))


def _turn(axis: int, cosine: Term, sine: Term) -> Term:
    """Rodrigues' formula about a coordinate axis."""
    direction = ca.DM.zeros(3)
    direction[axis] = 1
    return cosine * ca.SX.eye(3) + sine * ca.skew(direction) + (1 - cosine) * (direction @ direction.T)
