"""Forward kinematics of a platform that moves freely: Newton's method on the lengths of its rods, from a start pose.

The state is the position, and the rotation from the start in roll, pitch and yaw: R = Rz(yaw) Ry(pitch) Rx(roll)
R_start. A step solves A (v, w) = -e for the twist; w = E (roll', pitch', yaw') gives the rates of the angles. A step is
at most half the size of the machine and half a radian, so that nothing overflows, and a far start does not lead into
another assembly mode. The iteration ends when the rods fit for the second time: the step between leaves rounding errors
only, however small det A is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import (
    Mechanism,
)
from derive.equations.axes import finite, joint_lets
from derive.equations.pose_at_axes import (
    Forward,
)
from derive.equations.trigonometry import named_trigonometry
from derive.ir.constants import (
    CONVERGED,
    FREE_ANGLE,
)
from derive.ir.passes import normalise
from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Call,
    Iterate,
    Let,
    Output,
    Program,
    Require,
    Solve,
    Statement,
    Status,
)
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import (
    ASSEMBLY_SIGN,
    COORDINATE_NAMES,
    DETERMINANT,
    HOME_ROTATION,
    POSITION,
    ROTATION_ENTRIES,
    SCALE,
    START_POSITION,
    START_ROTATION,
    flag,
    real,
)
from derive.plate.legs import (
    ANGLES,
    RADIUS,
    by_angles,
    length,
    names,
    of,
    point_of,
    row,
    rows,
    span,
    turned,
    with_note,
)

SEARCH = "find_platform"
"""The name of the program."""
LIMIT = 20
"""Iterations, at most: from a neighbouring pose it takes four."""
_TURN = tuple(real(f"turned_{r.name[1:]}") for r in ROTATION_ENTRIES)
"""The rotation from the start."""


@dataclass(frozen=True)
class Start:
    """The pose at which Newton's method starts, and the conditions on it."""

    statements: tuple[Statement, ...]
    position: tuple[sp.Expr, ...]
    rotation: tuple[sp.Symbol, ...]
    name: str


def at_home(mechanism: Mechanism) -> Start:
    """Start at the machine's home pose."""
    return Start((), mechanism.home[:3], HOME_ROTATION, "the home pose")


def at_given() -> Start:
    """Start at a given pose, which is an input of the program."""
    return Start(finite(START_POSITION), START_POSITION, START_ROTATION, "the given start")


def found_from(mechanism: Mechanism, start: Start, search: Program) -> Forward:
    """The pose of the platform at its axis values, and the rows of A there, from the iteration that
    all programs share.
    """
    axes = tuple((j.axis, j.axis) for j in mechanism.joints)
    begin = zip((*START_POSITION, *START_ROTATION), (*start.position, *start.rotation), strict=True)
    outputs = tuple(real(o.name) for o in search.outputs)
    call = Call(search, (*axes, *begin), outputs, f"pose of the platform, by Newton's method from {start.name}")
    lets = (*joint_lets(mechanism), *_bases(mechanism)[0])
    return Forward((*start.statements, *lets, call), POSITION, ROTATION_ENTRIES)


def search_program(mechanism: Mechanism) -> Program:
    """The program that finds the pose of the platform at its axis values from a start, the rows of
    A there, and det A.
    """
    outputs = [Output(n.name, n) for n in (*POSITION, *ROTATION_ENTRIES, DETERMINANT, *rows(mechanism))]
    positive = sp.And(*[sp.Gt(v, 0) for v in mechanism.positive])
    checks: tuple[Statement, ...] = (
        *finite([j.axis for j in mechanism.joints]),
        *joint_lets(mechanism),
        Require(positive, Status.IMPOSSIBLE, reason=about_machine(Why.OTHER_MIRROR)),
    )
    search = normalise(SEARCH, (*checks, *_newton(mechanism)), outputs)
    return replace(
        search, summary="The pose of the platform at its axis values, the rows of A there, and their determinant"
    )


def _newton(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The iteration: position and rotation at given joint values, and the rows of A there."""
    pose = (*POSITION, *map(real, ANGLES))
    within = real("within")
    bases = _bases(mechanism)
    fits = sp.And(*[sp.Le(sp.Abs(of("error", rod)), within) for rod in mechanism.rods])
    fit, fitted = flag("fit"), flag("fitted")
    rotation = sp.Matrix(3, 3, _TURN) * sp.Matrix(3, 3, START_ROTATION)
    loop = Iterate(
        state=(*pose, fitted),
        start=(*START_POSITION, *[sp.Integer(0)] * 3, sp.false),
        step=(
            *_pass(mechanism, bases),
            Let(fit, fits, "whether every leg has its length"),
            *_step(mechanism),
        ),
        following=(*(s + real(f"{s.name}_rate") / real("stretch") for s in pose), fit),
        done=sp.And(fit, fitted),
        limit=LIMIT,
        otherwise=Status.IMPOSSIBLE,
        note="Newton's method: every pass improves the pose until all legs fit",
        reason=about_machine(Why.NOT_CONVERGED),
    )
    arms = (let for rod in mechanism.rods for let in turned(START_ROTATION, point_of(rod), names("start_arm", rod)))
    return (
        *with_note(arms, "joints of the platform, seen from its origin, in the orientation of the start"),
        *bases[0],
        Let(within, CONVERGED * SCALE, "tolerance of the leg lengths"),
        loop,
        Require(sp.Gt(ASSEMBLY_SIGN * DETERMINANT, 0), Status.IMPOSSIBLE, reason=about_machine(Why.OTHER_ASSEMBLY)),
        *with_note((Let(n, v) for n, v in zip(ROTATION_ENTRIES, rotation, strict=True)), "orientation of the platform"),
    )


def _bases(mechanism: Mechanism) -> tuple[tuple[Let, ...], list[sp.Expr]]:
    """The base joints of the rods and their lengths, every sine and cosine by its name."""
    return named_trigonometry(mechanism, [v for rod in mechanism.rods for v in (*rod.base, rod.length)])


def _pass(mechanism: Mechanism, bases: tuple[tuple[Let, ...], list[sp.Expr]]) -> tuple[Let, ...]:
    """The rods at the pose of the state: their lines, and their length errors."""
    lets = [Let(real(f"{w}_{a}"), f(real(a))) for a in ANGLES for w, f in (("cos", sp.cos), ("sin", sp.sin))]
    turn = (Let(n, v) for n, v in zip(_TURN, by_angles(), strict=True))
    lets += with_note(turn, "rotation from the start: Rz(yaw) Ry(pitch) Rx(roll)")
    for i, rod in enumerate(mechanism.rods):
        *base, wanted = bases[1][4 * i : 4 * i + 4]
        arm = names("arm", rod)
        lets += turned(_TURN, names("start_arm", rod), arm)
        lets += [*span(rod, POSITION, arm, base), length(rod), *row(rod, arm, of("length", rod))]
        lets.append(Let(of("error", rod), of("length", rod) - wanted, f"length error of leg {rod.name}"))
    return tuple(lets)


def _step(mechanism: Mechanism) -> tuple[Let | Solve, ...]:
    """The step of the state that cancels every error to first order, and the divisor that keeps it within bounds."""
    twist = tuple(real(f"{c}_rate") for c in COORDINATE_NAMES), tuple(real(f"swing_{c}") for c in COORDINATE_NAMES)
    spin = tuple(real(f"spin_{c}") for c in COORDINATE_NAMES)
    size = real("size")
    too_large = sp.Gt(size, sp.Rational(1, 2))
    shares = [*(v / SCALE for v in twist[0]), *(real(f"{a}_rate") for a in ANGLES)]
    errors = tuple(-of("error", rod) for rod in mechanism.rods)
    return (
        Solve(
            (*twist[0], *twist[1]),
            rows(mechanism),
            errors,
            DETERMINANT,
            "Newton step: twist that cancels the length errors",
        ),
        *(Let(n, v / RADIUS) for n, v in zip(spin, twist[1], strict=True)),
        *_rates(spin),
        Let(size, Root(sp.Add(*[s**2 for s in shares])), "size of the step, in characteristic lengths and radians"),
        Let(real("stretch"), Select(too_large, 2 * size, sp.Integer(1))),
    )


def _rates(spin: Sequence[sp.Expr]) -> tuple[Let, ...]:
    """w = E (roll', pitch', yaw') with E = [[cp cy, -sy, 0], [cp sy, cy, 0], [-sp, 0, 1]], solved for the rates."""
    roll, pitch, yaw = (real(f"{a}_rate") for a in ANGLES)
    cos_pitch, sin_pitch, cos_yaw, sin_yaw = map(real, ("cos_pitch", "sin_pitch", "cos_yaw", "sin_yaw"))
    divisor = real("cos_pitch_divisor")
    return (
        Let(divisor, Select(sp.Gt(sp.Abs(cos_pitch), FREE_ANGLE), cos_pitch, sp.Integer(1))),
        Let(roll, (cos_yaw * spin[0] + sin_yaw * spin[1]) / divisor),
        Let(pitch, cos_yaw * spin[1] - sin_yaw * spin[0]),
        Let(yaw, spin[2] + sin_pitch * roll),
    )
