"""Axes: axis values to joint values and back, the choice of a period, and the checks of inputs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import sympy as sp

from derive.description.mechanism import Joint, Mechanism
from derive.equations.drives import joint_of_motor, motor_of_joint, renamed
from derive.equations.problem import StepDeterminant
from derive.ir.constants import DEGREE, LARGEST
from derive.ir.primitives import Atan2, NearestPeriod, Select, ToReal, Wrap
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.reason import Why, about_input
from derive.ir.symbols import compared, cosine, flag, real, sine

_REASONABLE = "numbers of reasonable size"
_ZERO = sp.Integer(0)
_CHECK = "inputs must be numbers, and of reasonable size"


def finite(symbols: Sequence[sp.Symbol]) -> tuple[Require, ...]:
    """The condition that every given input is finite and of reasonable size."""
    conditions = list(map(_is_reasonable, symbols))
    reason = about_input(Why.NOT_GIVEN, _REASONABLE)
    return (Require(sp.And(*conditions), Status.BAD_INPUT, _CHECK, reason),) if conditions else ()


@cache
def _is_reasonable(symbol: sp.Symbol) -> sp.Basic:
    """The condition for one input. Cached: machines share the names of their inputs."""
    return compared(sp.Le, sp.Abs(symbol), LARGEST)


def joint_lets(mechanism: Mechanism) -> tuple[Statement, ...]:
    """Joint values from axis values, in radians and lengths; refused where a loop that moves a joint does not close."""
    lets: list[Statement] = []
    for joint in mechanism.joints:
        motor = _ZERO if joint.free else (joint.axis - joint.offset) * joint.unit
        if joint.loops:
            lets += [Let(joint.motor, motor), *joint_of_motor(mechanism, joint)]
            continue
        lets += _motor_and_joint(motor, joint.motor, joint.symbol, (joint.ratio, joint.coupling))
    return tuple(lets)


def _motor_and_joint(value: sp.Expr, motor: sp.Symbol, joint: sp.Symbol, gear: tuple[sp.Expr, sp.Expr]) -> list[Let]:
    ratio, coupling = gear
    if coupling == 0 and ratio == 1:
        return [Let(joint, value), Let(motor, joint)]
    return [Let(motor, value), Let(joint, ratio * motor + coupling)]


def _axis_of(joint: Joint, value: sp.Expr) -> sp.Expr:
    """The axis value of a joint value that is given in units of the axis: its coupling is subtracted, its gear undone,
    its offset added.
    """
    if not joint.is_geared:
        return value + joint.offset - joint.coupling / joint.unit
    return (value - joint.coupling / joint.unit) / joint.ratio + joint.offset


def reference_lets(mechanism: Mechanism) -> tuple[Let, ...]:
    """Joint values at the reference, such as `reference_a1`: the value of a joint that nothing else determines."""
    table = {j.motor: _reference_motor(j) for j in mechanism.joints}
    lets: list[Let] = []
    for joint in mechanism.joints:
        motor = _ZERO if joint.free else (joint.reference - joint.offset) * joint.unit
        if joint.loops:
            names = {joint.motor: _reference_motor(joint), joint.symbol: reference_value(joint)}
            lets += [Let(_reference_motor(joint), motor), *renamed(joint_of_motor(mechanism, joint), names)]
            continue
        gear = (joint.ratio, joint.coupling.xreplace(table))
        lets += _motor_and_joint(motor, _reference_motor(joint), reference_value(joint), gear)
    return tuple(lets)


def _reference_motor(joint: Joint) -> sp.Symbol:
    return real(f"ref_motor_{joint.key}")


def reference_value(joint: Joint) -> sp.Symbol:
    """The joint value at the reference."""
    return real(f"reference_{joint.key}")


def axis_lets(joint: Joint) -> tuple[Let, ...]:
    """The axis value of a solved joint: its period chosen, its offset added, its gear coupling subtracted."""
    motor = Let(joint.motor, (joint.axis - joint.offset) * joint.unit)
    if joint.loops:  # statements of their own bind the axis: see `axes_of_drives`
        return ()
    if not joint.is_angle:
        return (Let(joint.axis, _axis_of(joint, joint.symbol / joint.unit)), motor)
    direction = Atan2(sine(joint.symbol), cosine(joint.symbol))
    if not joint.multi_turn:
        return (Let(joint.axis, _axis_of(joint, Wrap(direction) / DEGREE)), motor)
    near = real(f"near_{joint.key}")
    if joint.is_geared:
        return (*_near(joint, near), *_turned(joint, near), motor)
    shift = joint.offset - joint.coupling / joint.unit
    return (
        *_near(joint, near),
        Let(joint.axis, NearestPeriod(direction / DEGREE + shift, near), turn_of=joint.name),
        motor,
    )


def axes_of_drives(mechanism: Mechanism, resolved: set[sp.Symbol]) -> tuple[Statement, ...]:
    """The axis values of the solved joints that loops move. resolved: the names that have a value."""
    statements: list[Statement] = []
    for joint in mechanism.joints:
        if not joint.loops or joint.axis in resolved:
            continue
        functions = ((cosine, sp.cos), (sine, sp.sin)) if joint.is_angle else ()
        statements += [Let(f(joint.symbol), g(joint.symbol)) for f, g in functions if f(joint.symbol) not in resolved]
        statements += motor_of_joint(mechanism, joint)
        statements.append(Let(joint.axis, joint.motor / joint.unit + joint.offset))
    return tuple(statements)


def _turned(joint: Joint, near: sp.Symbol) -> tuple[Let, ...]:
    """The axis value of a joint with a gear: its period is chosen in degrees of the joint, in the sense of the axis."""
    turned = real(f"turned_{joint.key}")
    direction = Atan2(joint.sense * sine(joint.symbol), cosine(joint.symbol))
    shift = joint.turns * joint.offset - joint.sense * joint.coupling / joint.unit
    note = f"{joint.name} before its gear, in degrees of the joint"
    return (
        Let(turned, NearestPeriod(direction / DEGREE + shift, near), note, turn_of=joint.name),
        Let(joint.axis, turned / joint.turns),
    )


def _near(joint: Joint, near: sp.Symbol) -> tuple[Let, ...]:
    """The axis value next to which the period is chosen: that of the commanded turn, the middle of the limits, or the
    reference. With a gear it is in degrees of the joint.

    The middle is taken where at most one value lies inside the limits. In wider limits another value inside may be a
    whole turn away, so limits never choose there: they only refuse. The reference is compared joint by joint, because
    with gear coupling an axis moves with its neighbours.
    """
    reference = joint.reference
    if joint.coupling != 0:
        reference = _axis_of(joint, reference_value(joint) / joint.unit)
    note = f"{joint.name}: without a commanded turn, the value nearest to this"
    open_value, is_single = real(f"open_{joint.key}"), flag(f"single_{joint.key}")
    commanded = Select(sp.Gt(joint.turn, 0), joint.turn - 1, joint.turn)
    return (
        Let(open_value, joint.turns * Select(is_single, real(f"mid_{joint.key}"), reference), note),
        Let(near, Select(sp.Ne(joint.turn, 0), 360 * ToReal(commanded), open_value)),
    )


def plain_angle(joint: Joint) -> Let:
    """The joint value with its whole turns, for equations in which the angle stands outside sines and cosines."""
    shift = joint.offset - joint.coupling / joint.unit
    value = (joint.axis - shift) * joint.unit
    if joint.loops:
        value = Wrap(Atan2(sine(joint.symbol), cosine(joint.symbol)))
    if joint.is_geared:
        value = (joint.axis - joint.offset) * joint.unit * joint.ratio + joint.coupling
    return Let(joint.symbol, value, f"{joint.name}: joint value with its whole turns")


def frozen_lets(joint: Joint) -> tuple[Let, ...]:
    """A joint kept at its reference: its value, sine and cosine, and its axis value."""
    axis = joint.reference if joint.coupling == 0 else _axis_of(joint, reference_value(joint) / joint.unit)
    value, *functions = held_lets(joint)
    motor = Let(joint.motor, (joint.axis - joint.offset) * joint.unit)
    return (value, Let(joint.axis, axis), motor, *functions)


def held_lets(joint: Joint) -> tuple[Let, ...]:
    """The value of a joint that is kept at its reference, and its sine and cosine."""
    value = Let(joint.symbol, reference_value(joint), f"{joint.name}: held at the reference")
    if not joint.is_angle:
        return (value,)
    return (value, Let(cosine(joint.symbol), sp.cos(joint.symbol)), Let(sine(joint.symbol), sp.sin(joint.symbol)))


@dataclass(frozen=True)
class Forward:
    """The pose as statements: joint values, cosines and sines, position; and the entries of the rotation."""

    statements: tuple[Statement, ...]
    position: tuple[sp.Expr, ...]
    rotation: tuple[sp.Expr, ...]
    determinant: StepDeterminant | None = None
    """The determinant of the step with two solutions: its sign is the assembly mode."""
