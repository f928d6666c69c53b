"""Forward kinematics of a platform that a loop turns: Newton's method on the lengths of its rods, from a start pose.

The state is the position, and the rotation from the start in roll, pitch and yaw: R = Rz(yaw) Ry(pitch) Rx(roll)
R_start; for a platform that turns about z alone it is yaw. A step solves A (v, w) = -e for the twist; w = E (roll',
pitch', yaw') gives the rates of the angles. A step is at most half the size of the machine and half a radian, so that
nothing overflows, and a far start does not lead into another assembly mode. The iteration ends when the rods fit for
the second time: the step between leaves rounding errors only, however small det A is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.loops import FREE_TWIST
from derive.description.mechanism import Mechanism, Plane, Turning
from derive.equations.axes import Forward, finite, joint_lets
from derive.equations.closures.fixed_names import fixed_lets, with_fixed_names
from derive.equations.trigonometry import named_trigonometry
from derive.ir.constants import CONVERGED, FREE_ANGLE, PLANE
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Solve, Statement, Status
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import (
    ASSEMBLY_SIGN,
    CHECK_FORWARD,
    DETERMINANT,
    HEADING,
    HOME_ROTATION,
    ROTATION_ENTRIES,
    SCALE,
    START_ROTATION,
    cosine,
    flag,
    real,
    sine,
)
from derive.plate.legs import (
    NORMAL,
    RADIUS,
    about_z,
    angles,
    arm_names,
    by_angles,
    home_angles,
    is_direction,
    leg_symbol,
    legs_of,
    length,
    names,
    plane_row,
    point_of,
    position_of,
    rotation_axes,
    rotation_of,
    row,
    rows,
    span,
    turned,
    vector_word,
    with_note,
)
from derive.plate.passive import completed
from derive.plate.surplus import miss_checks
from derive.plate.turns import least_turned, rates

SEARCH = "find_platform"
"""The name of the program."""
LIMIT = 20
"""The largest number of iterations; from a neighbouring pose four suffice."""
_TURN = sp.Matrix(3, 3, [real(f"turned_{r.name[1:]}") for r in ROTATION_ENTRIES])
"""The rotation from the start."""
_BEGIN_HEADING = (real("begin_cos_heading"), real("begin_sin_heading"))
_BEGIN_ROTATION = tuple(real(f"begin_{r.name}") for r in ROTATION_ENTRIES)


@dataclass(frozen=True)
class Start:
    """The pose at which Newton's method starts, and the conditions on it."""

    statements: tuple[Statement, ...]
    position: tuple[sp.Expr, ...]
    rotation: tuple[sp.Symbol, ...]
    name: str


def at_home(mechanism: Mechanism) -> Start:
    """Start at the machine's home pose."""
    rotation = HOME_ROTATION if _is_free(mechanism) else tuple(by_angles(home_angles(mechanism))[:2, 0])
    return Start((), mechanism.home[: len(mechanism.motion.position)], rotation, "the home pose")


def at_given(mechanism: Mechanism) -> Start:
    """Start at the pose that is a constant of the machine, and that a caller may replace. If the platform turns
    about z alone, the start is the nearest rotation about z.
    """
    position = _position(mechanism, "start_")
    lets, rotation = ((), START_ROTATION) if _is_free(mechanism) else _heading_of_start()
    further, position_there, rotation_there = completed(mechanism, position, rotation)
    return Start((*finite(position), *lets, *further), position_there, rotation_there, "the start")


def _heading_of_start() -> tuple[tuple[Statement, ...], tuple[sp.Symbol, ...]]:
    """The statements of the nearest rotation about z, and its cosine and sine."""
    along, across, size = (real(f"start_{word}") for word in ("along", "across", "length"))
    given = sp.Matrix(3, 3, START_ROTATION)
    determined = sp.Gt(size, FREE_ANGLE)
    heading = (real("start_cos_heading"), real("start_sin_heading"))
    divisor = real("start_divisor")
    lets = (
        Let(along, given[0, 0] + given[1, 1], "nearest rotation about Z"),
        Let(across, given[1, 0] - given[0, 1]),
        Let(size, Root(along**2 + across**2)),
        Require(determined, Status.BAD_INPUT, reason=about_machine(Why.OPPOSITE)),
        Let(divisor, Select(determined, size, sp.Integer(1))),
        Let(heading[0], along / divisor),
        Let(heading[1], across / divisor),
    )
    return lets, heading


def _is_free(mechanism: Mechanism) -> bool:
    """Whether the platform turns about every axis."""
    return mechanism.motion.turning is Turning.FULL


def _arguments(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The pose at which the shared program begins: position, then the rotation or cosine and sine of the heading."""
    rotation = _BEGIN_ROTATION if _is_free(mechanism) else _BEGIN_HEADING
    return (*_position(mechanism, "begin_"), *rotation)


def _begin_rotation(mechanism: Mechanism) -> sp.Matrix:
    return sp.Matrix(3, 3, _BEGIN_ROTATION) if _is_free(mechanism) else about_z(*_BEGIN_HEADING)


def _position(mechanism: Mechanism, before: str = "") -> tuple[sp.Symbol, ...]:
    """The part of the position that the iteration finds. before: what stands before each name."""
    return tuple(real(f"{before}{c}") for c in mechanism.motion.position)


def _rotation_names(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The names of the rotation that the iteration finds: all entries, or cosine and sine of the heading."""
    return ROTATION_ENTRIES if _is_free(mechanism) else (cosine(HEADING), sine(HEADING))


def found_from(mechanism: Mechanism, start: Start) -> Forward:
    """The pose of the platform at its axis values, and the rows of A there, from the iteration that
    all programs share.
    """
    lets = (*joint_lets(mechanism), *_bases(mechanism)[0])
    pose = (Let(name, _found(name)) for name in (*_position(mechanism), *_rotation_names(mechanism)))
    axes = finite([j.axis for j in mechanism.joints])
    statements = (*axes, *start.statements, *lets, _call(mechanism, start), *pose, *miss_checks(mechanism))
    return Forward(statements, position_of(mechanism), tuple(rotation_of(mechanism)))


def _call(mechanism: Mechanism, start: Start) -> Call:
    """The call of the iteration that all programs share."""
    search = search_program(mechanism)
    axes = tuple((j.axis, j.axis) for j in mechanism.joints)
    start_values = zip(_arguments(mechanism), (*start.position, *start.rotation), strict=True)
    begin = (pair for pair in start_values if pair[0] in search.inputs)  # all of it, but for a twist that no leg feels
    outputs = tuple(real(o.name) for o in search.outputs)
    return Call(search, (*axes, *begin), outputs, f"pose of the platform, by Newton's method from {start.name}")


def found_again(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The check of a solved inverse that forward kinematics finds the pose again, as a controller does that asks for
    the pose at power-up: from the home pose, given the axis values alone.
    """
    reason, asked = about_machine(Why.NOT_FOUND_AGAIN), flag(CHECK_FORWARD)
    pose = (*_position(mechanism), *_rotation_names(mechanism))
    call = replace(_call(mechanism, at_home(mechanism)), names=tuple(map(_found, pose)))
    turned = ROTATION_ENTRIES[2::3] if FREE_TWIST in mechanism.guides else _rotation_names(mechanism)
    most = dict.fromkeys(_position(mechanism), PLANE * SCALE) | dict.fromkeys(turned, PLANE)
    is_same = sp.And(*[sp.Le(sp.Abs(_found(n) - n), size) for n, size in most.items()])
    call = replace(call, wanted=asked, refusal=(Status.UNREACHABLE, reason))
    return (call, Require(sp.Or(sp.Not(asked), is_same), Status.UNREACHABLE, reason=reason))


def _found(name: sp.Symbol) -> sp.Symbol:
    """The name of a part of the pose as the iteration finds it."""
    return real(f"found_{name.name}")


def search_program(mechanism: Mechanism) -> Program:
    """The program that finds the pose of the platform at its axis values from a start, the rows of
    A there, and det A.
    """
    found = (*_position(mechanism), *_rotation_names(mechanism))
    entries = [e for e in rows(mechanism) if isinstance(e, sp.Symbol)]
    outputs = [*(Output(_found(n).name, n) for n in found), *(Output(n.name, n) for n in (DETERMINANT, *entries))]
    joints = {j.symbol for j in mechanism.joints}
    positive = [sp.Gt(v, 0) for v in mechanism.positive if v.free_symbols <= joints]
    mirror = Require(sp.And(*positive), Status.IMPOSSIBLE, reason=about_machine(Why.OTHER_MIRROR))
    checks: tuple[Statement, ...] = (*joint_lets(mechanism), *([mirror] if positive else []))
    search = normalise(SEARCH, (*checks, *_newton(mechanism)), outputs)
    return replace(
        search, summary="The pose of the platform at its axis values, the rows of A there, and their determinant"
    )


def _newton(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The iteration: position and rotation at given joint values, and the rows of A there."""
    pose = (*_position(mechanism), *map(real, angles(mechanism)))
    within, bases = real("within"), _bases(mechanism)
    fits = sp.And(*[sp.Le(sp.Abs(leg_symbol("error", leg)), within) for leg in legs_of(mechanism)])
    fit, fitted = flag("fit"), flag("fitted")
    loop = Iterate(
        state=(*pose, fitted),
        start=(*_position(mechanism, "begin_"), *[sp.Integer(0)] * len(angles(mechanism)), sp.false),
        step=(*_pass(mechanism, bases), Let(fit, fits, "whether every leg has its length"), *_step(mechanism)),
        following=(*(s + real(f"{s.name}_rate") / real("stretch") for s in pose), fit),
        done=sp.And(fit, fitted),
        limit=LIMIT,
        otherwise=Status.IMPOSSIBLE,
        note="Newton's method: every pass improves the pose until all legs fit",
        reason=about_machine(Why.NOT_CONVERGED),
    )
    start = _begin_rotation(mechanism)
    arms = (let for leg in legs_of(mechanism) for let in turned(start, point_of(leg), names("start_arm", leg)))
    return (
        *with_note(arms, "joints of the platform, seen from its origin, in the orientation of the start"),
        *bases[0],
        Let(within, CONVERGED * SCALE, "tolerance of the leg lengths"),
        loop,
        Require(sp.Gt(ASSEMBLY_SIGN * DETERMINANT, 0), Status.IMPOSSIBLE, reason=about_machine(Why.OTHER_ASSEMBLY)),
        *_orientation(mechanism),
        *_mirrors(mechanism),
    )


def _orientation(mechanism: Mechanism) -> Iterator[Statement]:
    """The rotation that was found: the rotation from the start, times the rotation of the start. A twist that no leg
    feels is that of the least turn from home.
    """
    rotation = _turn(mechanism) * _begin_rotation(mechanism)
    if FREE_TWIST in mechanism.guides:
        statements, rotation = least_turned(rotation[:, 2])
        yield from statements
    entries = zip(_rotation_names(mechanism), rotation if _is_free(mechanism) else rotation[:2, 0], strict=True)
    found = (let for name, entry in entries for let in (Let(_found(name), entry), Let(name, _found(name))))
    yield from with_note(found, "orientation of the platform")


def _mirrors(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The conditions that quantities of joints and pose are positive, at the pose that was found."""
    joints = {j.symbol for j in mechanism.joints}
    values = [with_fixed_names(mechanism, v) for v in mechanism.positive if not v.free_symbols <= joints]
    lets, named = named_trigonometry(mechanism, values) if values else ((), [])
    reason = about_machine(Why.OTHER_MIRROR)
    lengths = {*_position(mechanism), *(j.symbol for j in mechanism.joints if not j.is_angle)}
    least = (-PLANE * (SCALE if v.free_symbols & lengths else 1) for v in values)  # both meet where it is zero
    checks = (sp.Ge(v, low) for v, low in zip(named, least, strict=True))
    return (*fixed_lets(mechanism), *lets, *(Require(c, Status.IMPOSSIBLE, reason=reason) for c in checks))


def _turn(mechanism: Mechanism) -> sp.Matrix:
    """The rotation from the start, in names."""
    return _TURN if _is_free(mechanism) else by_angles(angles(mechanism))


def _bases(mechanism: Mechanism) -> tuple[tuple[Let, ...], list[sp.Expr]]:
    """The base joints of the rods and their lengths, with names for every sine and cosine."""
    ends = (v for rod in mechanism.holding_rods for v in (*rod.base, rod.length))
    values = [with_fixed_names(mechanism, v) for v in (*ends, *(plane.offset for plane in mechanism.guides))]
    lets, named = named_trigonometry(mechanism, values)
    return (*fixed_lets(mechanism), *lets), named


def _pass(mechanism: Mechanism, bases: tuple[tuple[Let, ...], list[sp.Expr]]) -> tuple[Let, ...]:
    """The rods at the pose of the state: their lines, and their length errors."""
    words = angles(mechanism)
    lets = [Let(real(f"{w}_{a}"), f(real(a))) for a in words for w, f in (("cos", sp.cos), ("sin", sp.sin))]
    if _is_free(mechanism):
        turn = (Let(n, v) for n, v in zip(_TURN, by_angles(), strict=True))
        lets += with_note(turn, "rotation from the start: Rz(yaw) Ry(pitch) Rx(roll)")
    values, rotation = iter(bases[1]), _turn(mechanism) * _begin_rotation(mechanism)
    for rod in mechanism.holding_rods:
        base, wanted = [next(values) for _ in rod.base], next(values)
        arm, word = names("arm", rod), vector_word(mechanism, rod)
        lets += turned(_turn(mechanism), names("start_arm", rod), arm_names("arm", rod))
        lets += [*span(mechanism, rod, (position_of(mechanism), rotation), base), length(rod, word)]
        lets += row(mechanism, rod, arm, leg_symbol("length", rod), word)
        error = leg_symbol("length", rod) - wanted
        lets.append(Let(leg_symbol("error", rod), error, f"length error of leg {rod.name}"))
    for plane in mechanism.guides:
        arm, normal = names("arm", plane), names(NORMAL, plane)
        lets += turned(_turn(mechanism), names("start_arm", plane), arm)
        lets += plane_row(mechanism, plane, arm, rotation)
        point = arm if is_direction(plane) else (p + a for p, a in zip(position_of(mechanism), arm, strict=False))
        ahead = 0 if plane.turns_along else sp.Add(*[n * p for n, p in zip(normal, point, strict=True)])
        note = f"distance of guide {plane.name} from its plane"
        lets.append(Let(leg_symbol("error", plane), ahead - next(values), note))
    return tuple(lets)


def legs_at_pose(mechanism: Mechanism) -> tuple[Let, ...]:
    """The legs as lines, the rows of A, at a pose at which every leg has its length."""
    lets, ends = _bases(mechanism)
    values, found = iter(ends), [*lets]
    for leg in legs_of(mechanism):
        arm, rotation = names("arm", leg), rotation_of(mechanism)
        found += turned(rotation, point_of(leg), arm_names("arm", leg))
        if isinstance(leg, Plane):
            found += plane_row(mechanism, leg, arm, rotation)
            continue
        base, measured = [next(values) for _ in leg.base], next(values)
        found += span(mechanism, leg, (position_of(mechanism), rotation), base)
        found += row(mechanism, leg, arm, measured, vector_word(mechanism, leg))
    return tuple(found)


def _step(mechanism: Mechanism) -> tuple[Let | Solve, ...]:
    """The step of the state that cancels every error to first order, and the divisor that keeps it within bounds."""
    about = rotation_axes(mechanism)
    twist = tuple(real(f"{c}_rate") for c in mechanism.motion.position), tuple(real(f"swing_{c}") for c in about)
    spin = tuple(real(f"spin_{c}") for c in about)
    size, too_large = real("size"), sp.Gt(real("size"), sp.Rational(1, 2))
    shares = [*(v / SCALE for v in twist[0]), *(real(f"{a}_rate") for a in angles(mechanism))]
    errors = tuple(-leg_symbol("error", leg) for leg in legs_of(mechanism))
    return (
        Solve(
            (*twist[0], *twist[1]),
            rows(mechanism),
            errors,
            DETERMINANT,
            "Newton step: twist that cancels the length errors",
        ),
        *(Let(n, v / RADIUS) for n, v in zip(spin, twist[1], strict=True)),
        *rates(spin),
        Let(size, Root(sp.Add(*[s**2 for s in shares])), "size of the step, in characteristic lengths and radians"),
        Let(real("stretch"), Select(too_large, 2 * size, sp.Integer(1))),
    )
