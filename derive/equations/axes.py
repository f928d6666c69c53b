"""Axes: axis values to joint values and back, the choice of a period, and the checks of inputs."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.description.mechanism import Joint, Mechanism
from derive.ir.constants import (
    DEGREE,
    LARGEST,
)
from derive.ir.primitives import (
    Atan2,
    NearestPeriod,
    Select,
    ToReal,
    Wrap,
)
from derive.ir.program import (
    Let,
    Require,
    Statement,
    Status,
)
from derive.ir.reason import Why, about_input
from derive.ir.symbols import (
    cosine,
    flag,
    real,
    sine,
)

_REASONABLE = "numbers of reasonable size"
_CHECK = "inputs must be numbers, and of reasonable size"


def finite(symbols: Sequence[sp.Symbol]) -> tuple[Require, ...]:
    """The condition that every input that is read is a number of reasonable size."""
    conditions = [sp.Le(sp.Abs(s), LARGEST) for s in symbols]
    reason = about_input(Why.NOT_GIVEN, _REASONABLE)
    return (Require(sp.And(*conditions), Status.BAD_INPUT, _CHECK, reason),) if conditions else ()


def joint_lets(mechanism: Mechanism) -> tuple[Let, ...]:
    """Joint values from axis values, in radians and lengths."""
    lets: list[Let] = []
    for joint in mechanism.joints:
        motor = (joint.axis - joint.offset) * joint.unit
        lets += _motor_and_joint(motor, joint.motor, joint.symbol, joint.coupling)
    return tuple(lets)


def _motor_and_joint(value: sp.Expr, motor: sp.Symbol, joint: sp.Symbol, coupling: sp.Expr) -> list[Let]:
    if coupling == 0:
        return [Let(joint, value), Let(motor, joint)]
    return [Let(motor, value), Let(joint, motor + coupling)]


def reference_lets(mechanism: Mechanism) -> tuple[Let, ...]:
    """Joint values at the reference: `reference_a1`, taken where nothing else determines the joint."""
    table = {j.motor: _reference_motor(j) for j in mechanism.joints}
    lets: list[Let] = []
    for joint in mechanism.joints:
        motor = (joint.reference - joint.offset) * joint.unit
        lets += _motor_and_joint(motor, _reference_motor(joint), reference_value(joint), joint.coupling.xreplace(table))
    return tuple(lets)


def _reference_motor(joint: Joint) -> sp.Symbol:
    return real(f"ref_motor_{joint.key}")


def reference_value(joint: Joint) -> sp.Symbol:
    """The joint value at the reference."""
    return real(f"reference_{joint.key}")


def axis_lets(joint: Joint) -> tuple[Let, ...]:
    """The axis value of a solved joint: its period chosen, its offset added, its gear coupling subtracted."""
    shift = joint.offset - joint.coupling / joint.unit
    motor = Let(joint.motor, (joint.axis - joint.offset) * joint.unit)
    if not joint.is_angle:
        return (Let(joint.axis, joint.symbol + shift), motor)
    direction = Atan2(sine(joint.symbol), cosine(joint.symbol))
    if not joint.multi_turn:
        return (Let(joint.axis, Wrap(direction) / DEGREE + shift), motor)
    near = real(f"near_{joint.key}")
    return (
        *_near(joint, near),
        Let(joint.axis, NearestPeriod(direction / DEGREE + shift, near), turn_of=joint.name),
        motor,
    )


def _near(joint: Joint, near: sp.Symbol) -> tuple[Let, ...]:
    """The axis value to which the nearest period is chosen: of the commanded turn, the middle of the limits, or the
    reference.

    The middle is taken where one value at most lies inside the limits. In wider limits another value inside may be a
    whole turn away, so limits never choose there: they only refuse. The reference is compared joint by joint, because
    with gear coupling an axis moves with its neighbours.
    """
    shift = -joint.coupling / joint.unit
    reference = joint.reference if joint.coupling == 0 else reference_value(joint) / joint.unit + joint.offset + shift
    note = f"{joint.name}: without a commanded turn, the value nearest to this"
    open_value, is_single = real(f"open_{joint.key}"), flag(f"single_{joint.key}")
    commanded = Select(sp.Gt(joint.turn, 0), joint.turn - 1, joint.turn)
    return (
        Let(open_value, Select(is_single, real(f"mid_{joint.key}"), reference), note),
        Let(near, Select(sp.Ne(joint.turn, 0), 360 * ToReal(commanded), open_value)),
    )


def plain_angle(joint: Joint) -> Let:
    """The joint value with its whole turns, for equations in which the angle stands outside sines and cosines."""
    shift = joint.offset - joint.coupling / joint.unit
    return Let(joint.symbol, (joint.axis - shift) * joint.unit, f"{joint.name}: joint value with its whole turns")


def frozen_lets(joint: Joint) -> tuple[Statement, ...]:
    """A joint kept at its reference: its value, sine and cosine, and its axis value."""
    shift = joint.offset - joint.coupling / joint.unit
    axis = joint.reference if joint.coupling == 0 else reference_value(joint) / joint.unit + shift
    lets: list[Statement] = [
        Let(joint.symbol, reference_value(joint), f"{joint.name}: held at the reference"),
        Let(joint.axis, axis),
        Let(joint.motor, (joint.axis - joint.offset) * joint.unit),
    ]
    if joint.is_angle:
        lets += [Let(cosine(joint.symbol), sp.cos(joint.symbol)), Let(sine(joint.symbol), sp.sin(joint.symbol))]
    return tuple(lets)
