"""A machine as it is: a serial chain whose lines stand beside those of the drawing, by deviations that are inputs.

    Rz(A2) →  Tx(a2_shift_x) Ty(a2_shift_y) Rx(a2_tilt_x) Ry(a2_tilt_y) Rz(A2) and these four back

x and y are those of a frame whose z is the axis. Base and tool are moved, too, and a motor is at (1 + gain) times its
value, plus an offset. Names and signs are those of `robot.calibrated`: docs/CALIBRATION.md.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.dimensions import Parameter, Role, angle, distance, radians
from derive.description.joints import Joint
from derive.description.mechanism import DescriptionError, Mechanism, Turning
from derive.geometry.frames import Chain, Factor, Motion
from derive.ir.symbols import real

_FOLLOWED = (Turning.NONE, Turning.ABOUT_Z, Turning.DIRECTION, Turning.FULL)
_ANGLE, _GAIN, _SHIFT = 0.05, 1e-4, 5e-4
"""Deviations of the machine that is tested: degrees, a share of the travel, a share of all lengths of the machine."""
_TURNS = ("c", "b", "a")
"""The turns of base and tool behind their shifts: Rz(c) Ry(b) Rx(a)."""


@dataclass(frozen=True)
class Line:
    """A factor of a chain that joints move, the name of its line, and the part of its amount that none moves."""

    factor: Factor
    name: str
    fixed: sp.Expr


def with_deviations(drawn: Mechanism) -> Mechanism:
    """The machine with its deviations as further inputs, which are zero unless they are given.

    Raises `DescriptionError` for what has no deviations of lines: a closed loop has dimensions.
    """
    if drawn.chain is None:
        raise DescriptionError("the deviations of a closed loop are those of its dimensions, which are inputs already")
    if drawn.drives:
        raise DescriptionError("deviations of a chain whose joints are moved by loops are not known yet")
    if not drawn.task.position or drawn.task.turning not in _FOLLOWED:
        raise DescriptionError("deviations need a chain that commands a position, and not a pitch")
    own = tuple(_parameters(drawn, lines_of(drawn.chain, drawn.joints)))
    taken = {p.name for p in drawn.parameters} & {p.name for p in own}
    if taken:
        raise DescriptionError(f"parameter {min(taken)!r} has the name of a deviation: choose another")
    off = {p.name: p.symbol for p in own}
    true = {j.motor: motor_of(j, off) for j in drawn.joints}
    joints = tuple(
        replace(j, coupling=j.coupling.xreplace(true) + j.ratio * (true[j.motor] - j.motor)) for j in drawn.joints
    )
    return replace(
        drawn, parameters=(*drawn.parameters, *own), joints=joints, chain=Chain(true_factors(drawn, off)), drawn=None,
        nominal=drawn, offset_interface=False,
    )  # fmt: skip


def motor_of(joint: Joint, off: Mapping[str, sp.Expr]) -> sp.Expr:
    """The motor value that a joint has, in the motor value that its axis tells."""
    return joint.motor * (1 + off[f"{joint.key}_gain"]) + off[f"{joint.key}_offset"] * joint.unit


def lines_of(chain: Chain, joints: Sequence[Joint]) -> list[Line | Factor]:
    """The factors of a chain; those that move have the name of the first axis that moves them and has no line yet, a
    further line of an axis has a number.
    """
    motors = {j.symbol: sp.expand(j.ratio * j.motor + j.coupling) for j in joints}
    at_zero = dict.fromkeys((j.symbol for j in joints), sp.Integer(0))
    found: list[Line | Factor] = []
    names: list[str] = []
    for factor in chain.factors:
        moved = sp.sympify(factor.amount).xreplace(motors)
        own = [j.key for j in joints if j.motor in moved.free_symbols]
        if not own:
            found.append(factor)
            continue
        free = next((key for key in own if key not in names), "")
        names.append(free or next(n for k in range(2, len(names) + 3) if (n := f"{own[0]}_{k}") not in names))
        found.append(Line(factor, names[-1], sp.sympify(factor.amount).xreplace(at_zero)))
    return found


def true_factors(drawn: Mechanism, off: Mapping[str, sp.Expr]) -> tuple[Factor, ...]:
    """The factors of the true chain of a mechanism, with its chain as it is described. off: the deviations by name."""
    chain = drawn.drawn or drawn.chain
    assert chain is not None
    found = list(_end("base", off))
    for one in lines_of(chain, drawn.joints):
        if isinstance(one, Factor):
            found.append(one)
            continue
        beside = _beside(one, off)
        moves = replace(one.factor, amount=sp.expand(one.factor.amount - one.fixed))
        found += [*beside, moves, *(f.inverse() for f in reversed(beside))]
        found += [replace(one.factor, amount=one.fixed)] if one.fixed != 0 else []
    return (*found, *_end("tool", off))


def _beside(line: Line, off: Mapping[str, sp.Expr]) -> list[Factor]:
    """From the line as it is drawn to where it is."""
    x, y = (line.factor.axis + 1) % 3, (line.factor.axis + 2) % 3
    shifts = ((x, "shift_x"), (y, "shift_y")) if line.factor.motion is Motion.TURN else ()
    return [
        *(Factor(Motion.SHIFT, axis, off[f"{line.name}_{word}"]) for axis, word in shifts),
        *(_turn(axis, off[f"{line.name}_{word}"]) for axis, word in ((x, "tilt_x"), (y, "tilt_y"))),
    ]


def _end(end: str, off: Mapping[str, sp.Expr]) -> tuple[Factor, ...]:
    shifts = (Factor(Motion.SHIFT, k, off[f"{end}_{c}"]) for k, c in enumerate("xyz"))
    return (*shifts, *(_turn(2 - k, off[f"{end}_{c}"]) for k, c in enumerate(_TURNS)))


def _turn(axis: int, degrees: sp.Expr) -> Factor:
    return Factor(Motion.TURN, axis, radians(degrees))


def _parameters(drawn: Mechanism, lines: Sequence[Line | Factor]) -> Iterator[Parameter]:
    """The deviations of a machine, in the order of `softkin._deviations.units_of`."""
    lengths = sum(abs(p.nominal) for p in drawn.parameters if p.unit == "u")
    shift = _SHIFT * (lengths or 1.0)
    for line in (one for one in lines if isinstance(one, Line)):
        for c in "xy":
            yield _angle(f"{line.name}_tilt_{c}", f"the line of {line.name} is turned about {c}")
        for c in "xy" if line.factor.motion is Motion.TURN else "":
            yield _length(f"{line.name}_shift_{c}", f"the line of {line.name} is shifted along {c}", shift)
    for end in ("tool", "base"):
        for c in "xyz":
            yield _length(f"{end}_{c}", f"shift of the {end} along {c}", shift)
        for c in "abc":
            yield _angle(f"{end}_{c}", f"turn of the {end}: Rz(c) Ry(b) Rx(a)")
    for j in drawn.joints:
        name, meaning = f"{j.key}_offset", f"{j.name}: what the joint adds to the axis value"
        yield _angle(name, meaning) if j.in_degrees else _length(name, meaning, shift)
    for j in drawn.joints:
        name, meaning = f"{j.key}_gain", f"{j.name}: share of its travel that the joint adds"
        yield Parameter(real(name), name, Role.RATIO, meaning, "1", -0.5, 0.5, False, 0.0, 0.0, deviation=_GAIN)


def _angle(name: str, meaning: str) -> Parameter:
    return replace(angle(name, meaning, nominal=0.0, default=0.0), deviation=_ANGLE)


def _length(name: str, meaning: str, tested: float) -> Parameter:
    return replace(distance(name, meaning, nominal=0.0), deviation=tested)
