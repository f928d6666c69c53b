"""A platform on six rods that moves with its whole pose: its home pose, the checks of its inverse, and its singularity.

det A (see `legs`) is the margin: it is zero where the lines of the rods belong to one linear complex (type 2). The
inverse computes it from the spans of the legs, and divides by their lengths at the end.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.description.mechanism import (
    DescriptionError,
    Mechanism,
    Rod,
)
from derive.ir.constants import (
    FREE_ANGLE,
    SHORTEST_LINK,
    SINGULAR,
)
from derive.ir.passes import normalise
from derive.ir.primitives import (
    Root,
    Select,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
    Require,
    Solve,
    Statement,
    Status,
)
from derive.ir.reason import Why, about, about_leg, about_machine, about_parameters
from derive.ir.symbols import (
    ASSEMBLY_SIGN,
    COORDINATE_NAMES,
    DETERMINANT,
    HOME_ROTATION,
    MIN_TYPE2_MARGIN,
    POSITION,
    ROTATION_ENTRIES,
    SCALE,
    real,
)
from derive.plate.cones import cone_axes, cone_checks, cone_constants
from derive.plate.legs import (
    ANGLES,
    MARGIN,
    RADIUS,
    by_angles,
    divisor,
    length,
    names,
    of,
    point_of,
    row,
    rows,
    span,
    span_moment,
    turned,
)

_APART = "legs that have a length at the home pose, and joints that are apart"
_HELD = "a home pose at which the legs hold the platform"


def machine_statements(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The statements that depend on parameters alone: home rotation and arms, scales, assembly mode
    at the home pose.
    """
    if len(mechanism.rods) != 6 or len(mechanism.home) != 6:
        raise DescriptionError("a platform that moves freely needs six rods and a home pose of six coordinates")
    turns = tuple(zip(ANGLES, mechanism.home[3:], strict=True))
    trigonometric = (Let(real(f"{w}_home_{n}"), f(v)) for n, v in turns for w, f in (("cos", sp.cos), ("sin", sp.sin)))
    rotation = by_angles([f"home_{n}" for n in ANGLES])
    return (
        *trigonometric,
        *(Let(n, v) for n, v in zip(HOME_ROTATION, rotation, strict=True)),
        *(let for rod in mechanism.rods for let in turned(HOME_ROTATION, point_of(rod), names("home_arm", rod))),
        *_platform_radius(mechanism),
        *_at_home(mechanism),
    )


def _platform_radius(mechanism: Mechanism) -> tuple[Let, ...]:
    points = [point_of(rod) for rod in mechanism.rods]
    centre = tuple(real(f"centre_{c}") for c in COORDINATE_NAMES)
    means = (sp.Add(*column) / len(points) for column in zip(*points, strict=True))
    squares = [(c - m) ** 2 for point in points for c, m in zip(point, centre, strict=True)]
    spread = real("spread")
    return (
        *(Let(n, v, "centre of the joints on the platform") for n, v in zip(centre, means, strict=True)),
        Let(spread, Root(sp.Add(*squares) / len(points)), "root mean square of their distances from it"),
        Let(RADIUS, Select(sp.Gt(spread, 0), spread, sp.Integer(1))),
    )


def _at_home(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The legs at the home pose, which must hold the platform."""
    rods, arms = mechanism.rods, [names("home_arm", rod) for rod in mechanism.rods]
    lengths = tuple(of("length", rod) for rod in rods)
    shortest = SHORTEST_LINK * SCALE
    apart = sp.And(sp.Gt(real("spread"), shortest), *[sp.Gt(v, shortest) for v in lengths])
    spans = (span(rod, mechanism.home[:3], arm, rod.base) for rod, arm in zip(rods, arms, strict=True))
    return (
        *(let for lets in spans for let in lets),
        *(length(rod) for rod in rods),
        Let(SCALE, sp.Add(*lengths) / len(lengths) + RADIUS, "characteristic length: mean leg, radius of the platform"),
        Require(apart, Status.NOT_INITIALIZED, reason=about_parameters(_APART)),
        *(let for rod, arm in zip(rods, arms, strict=True) for let in row(rod, arm, of("length", rod))),
        *cone_axes(mechanism, HOME_ROTATION),
        Solve(
            (),
            rows(mechanism),
            (),
            DETERMINANT,
            "determinant at the home pose: zero where the legs do not hold the platform",
        ),
        Require(sp.Gt(sp.Abs(DETERMINANT), SINGULAR), Status.NOT_INITIALIZED, reason=about_parameters(_HELD)),
        Let(
            ASSEMBLY_SIGN, Select(sp.Gt(DETERMINANT, 0), sp.Integer(1), sp.Integer(-1)), "assembly mode of this machine"
        ),
    )


def machine_constants(mechanism: Mechanism) -> tuple[Output, ...]:
    """The outputs that other programs may read."""
    own = (Output(n.name, n) for n in (*HOME_ROTATION, RADIUS, SCALE, ASSEMBLY_SIGN))
    return (*own, *cone_constants(mechanism))


def platform_checks(mechanism: Mechanism, solved: Sequence[Statement]) -> tuple[Statement, ...]:
    """The checks of a solved inverse: legs with a length, the assembly mode of the machine, a distance from the
    singularity.
    """
    bound = {s.name for s in solved if isinstance(s, Let)}
    lets: list[Let] = []
    for rod in mechanism.rods:
        arm = names("arm", rod)
        vectors = (
            *turned(ROTATION_ENTRIES, point_of(rod), arm),
            *span(rod, POSITION, arm, rod.base),
            *span_moment(rod, arm),
        )
        lets += [let for let in (*vectors, divisor(rod, rod.length)) if let.name not in bound]
    margin, least = ASSEMBLY_SIGN * DETERMINANT, real(MIN_TYPE2_MARGIN)
    of_spans, lengths = real("determinant_of_spans"), sp.Mul(*[of("divisor", rod) for rod in mechanism.rods])
    return (
        *lets,
        *(_long_enough(rod) for rod in mechanism.rods),
        *cone_checks(mechanism),
        Solve((), rows(mechanism, "span"), (), of_spans, "determinant of the spans of the legs and their moments"),
        Let(
            DETERMINANT,
            of_spans / lengths,
            "the same of unit vectors: margin of the platform, zero in a type 2 singularity",
        ),
        Require(sp.Ge(margin, least), Status.UNREACHABLE, reason=about(MARGIN, Why.NEAR_TYPE_2, least - margin)),
    )


def _long_enough(rod: Rod) -> Require:
    return Require(
        sp.Gt(rod.length, SHORTEST_LINK * SCALE), Status.UNREACHABLE, reason=about_leg(rod.name, Why.WITHOUT_LENGTH)
    )


def platform_jacobian(mechanism: Mechanism, motors: sp.Matrix) -> tuple[tuple[Statement, ...], list[sp.Expr]]:
    """The Jacobian A^-1 (-B) at a pose that forward kinematics has found."""
    joints = [j.symbol for j in mechanism.joints]
    driven = sp.Matrix([_driven(rod).jacobian(joints) for rod in mechanism.rods]) * motors
    width = len(joints)
    words = (*(f"v{c}" for c in COORDINATE_NAMES), *(f"w{c}" for c in COORDINATE_NAMES))
    entries = [real(f"column_{column}_{word}") for word in words for column in range(1, width + 1)]
    held = Require(sp.Gt(sp.Abs(DETERMINANT), FREE_ANGLE), Status.IMPOSSIBLE, reason=about_machine(Why.UNCONTROLLED))
    system = Solve(
        tuple(entries), rows(mechanism), tuple(driven), None, "twist of the platform per velocity of each leg"
    )
    return (held, system), [e if k // width < 3 else e / RADIUS for k, e in enumerate(entries)]


def _driven(rod: Rod) -> sp.Matrix:
    """The negative of a rod's residual as a function of the joints, at a constant direction: along . base + length."""
    return sp.Matrix([sum((a * b for a, b in zip(names("along", rod), rod.base, strict=True)), rod.length)])


def platform_singularity(statements: Sequence[Statement]) -> Program:
    """The margin at a pose that forward kinematics has found."""
    return normalise("singularity", statements, [Output(MARGIN, DETERMINANT)])
