"""A platform that a loop turns: its home pose, and the checks of its inverse.

det A (see `legs`) is the margin: it is zero if the lines of the rods belong to one linear complex (type 2). The
inverse computes it from the spans of the legs, and divides by their lengths at the end.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import sympy as sp

from derive.algebra.normal_form import polynomial
from derive.description.loops import FREE_TWIST
from derive.description.mechanism import Branch, DescriptionError, Mechanism, Rod, Turning
from derive.equations.closures.fixed_names import all_angles, fixed_angles, signs_of, with_fixed_names
from derive.ir.constants import DEGREE, SHORTEST_LINK, SINGULAR
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output, Require, Solve, Statement, Status
from derive.ir.reason import Why, about, about_leg, about_parameters
from derive.ir.symbols import (
    ASSEMBLY_SIGN,
    COORDINATE_NAMES,
    DETERMINANT,
    HOME_ROTATION,
    MIN_TYPE2_MARGIN,
    ROTATION_ENTRIES,
    SCALE,
    START_ROTATION,
    cosine,
    real,
    sine,
)
from derive.plate.cones import cone_axes, cone_checks, cone_constants
from derive.plate.legs import (
    MARGIN,
    RADIUS,
    arm_names,
    by_angles,
    divisor,
    home_angles,
    is_driven,
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
    span_moment,
    turned,
    vector_word,
)
from derive.plate.passive import guides_determinant, mode_constants, modes_at_home, solve_passive

_APART = "legs that have a length at the home pose, and joints that are apart"
_GUIDED = "a home pose at which the guides hold what the task does not command"
_HELD = "a home pose at which the legs hold the platform"


def machine_statements(mechanism: Mechanism, at_home: Sequence[Statement] = ()) -> tuple[Statement, ...]:
    """The statements of parameters alone: home rotation and arms, scales, assembly mode at the home pose.

    at_home: the statements that bind the joints at the home pose, `home_cos_a1`, where joints move ends of rods.
    """
    later = [rod for rod in mechanism.holding_rods if is_driven(mechanism, rod.base)]
    return (
        *platform_size(mechanism),
        *at_home,
        *(let for rod in later for let in _span_at_home(mechanism, rod)),
        *(length(rod, vector_word(mechanism, rod)) for rod in later if is_driven(mechanism, [rod.length])),
        *_mode_at_home(mechanism),
        *modes_at_home(mechanism, pose_at_home(mechanism)),
    )


def pose_at_home(mechanism: Mechanism) -> dict[sp.Symbol, sp.Expr]:
    """The names of the platform's pose, with the home pose for each."""
    position = dict(zip(map(real, COORDINATE_NAMES), home_position(mechanism), strict=True))
    return position | dict(zip(ROTATION_ENTRIES, home_rotation(mechanism), strict=True))


def platform_size(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The home pose, the arms there, and the scales of the machine. Lengths that are joints are those at home."""
    turns = tuple(zip(home_angles(mechanism), mechanism.home[len(mechanism.motion.position) :], strict=True))
    trigonometric = (Let(real(f"{w}_{n}"), f(v)) for n, v in turns for w, f in (("cos", sp.cos), ("sin", sp.sin)))
    rotation = by_angles([n for n, _ in turns])
    entries = zip(HOME_ROTATION, rotation, strict=True) if len(turns) > 1 else ()
    home = home_rotation(mechanism)
    return (
        *trigonometric,
        *(Let(n, v) for n, v in entries),
        *(let for leg in legs_of(mechanism) for let in turned(home, point_of(leg), arm_names("home_arm", leg))),
        *_platform_radius(mechanism),
        *_lengths_at_home(mechanism),
    )


def home_branches(mechanism: Mechanism) -> tuple[Branch, ...]:
    """The branches on which the lines of the legs at the home pose depend."""
    is_needed = is_driven(mechanism, [v for rod in mechanism.holding_rods for v in rod.base])
    return mechanism.branches if is_needed else ()


def check_home(mechanism: Mechanism) -> None:
    """Refuse a loop that is not stated as these programs need it."""
    if mechanism.motion.turning is Turning.DIRECTION:
        raise DescriptionError(
            "a loop may turn its platform about z, or about every axis: it commands a direction only where guides hold "
            "what is not commanded, or no rod feels a turn about it"
        )
    if mechanism.offset_interface:
        raise DescriptionError(
            "a loop that turns its platform needs offset_interface=False: a position alone leaves its joints open"
        )
    if mechanism.assembly is not None:
        raise DescriptionError("a loop that turns its platform needs no assembly: its home pose tells the mode")
    count = len(mechanism.motion.position) + len(rotation_axes(mechanism))
    legs = legs_of(mechanism)
    for one in mechanism.rods:
        if one.ring is not None and (is_driven(mechanism, one.base) or FREE_TWIST not in mechanism.guides):
            raise DescriptionError(
                f"rod {one.name!r}: a rod that ends on a ring begins at a fixed point, and its platform is commanded a "
                "direction, about which no rod feels a turn"
            )
    if len(mechanism.fixed_guides) != len(mechanism.passive):
        raise DescriptionError(
            f"the platform moves {count} quantities, and the task commands all{_but(mechanism.passive)}: as many "
            f"guides without joints must hold the others, and there are {len(mechanism.fixed_guides)}"
        )
    if len(legs) != count or mechanism.closure:
        held = f" and {len(mechanism.guides)} guides" if mechanism.guides else ""
        of_what = "that it moves" if mechanism.passive else "of the task"
        raise DescriptionError(
            f"a platform that a loop turns needs a rod for each of the {count} quantities {of_what}: "
            f"it has {len(mechanism.holding_rods)} rods{held}{_no_rods(mechanism)}"
        )
    for leg in legs:
        if is_driven(mechanism, point_of(leg)):
            what, end = ("rod", "its end") if isinstance(leg, Rod) else ("guide", "its point")
            raise DescriptionError(
                f"{what} {leg.name!r}: {end} must be a point of the plate, which no joint moves on it"
            )
    for plane in (g for g in mechanism.guides if not g.turns_along):
        if strange := {s for v in plane.normal for s in v.free_symbols} - {p.symbol for p in mechanism.parameters}:
            raise DescriptionError(
                f"guide {plane.name!r}: its normal reads {min(map(str, strange))!r}, and is made of parameters alone"
            )
    if mechanism.passive:
        solve_passive(mechanism)
    if len(mechanism.home) != count:
        raise DescriptionError(
            f"a platform that a loop turns needs a home pose of {count} coordinates, and has {len(mechanism.home)}"
        )


def _but(words: Sequence[str]) -> str:
    return f" but {', '.join(words)}" if words else ""


def _no_rods(mechanism: Mechanism) -> str:
    """The advice on equations that are no rods."""
    if not mechanism.closure:
        return ""
    if not mechanism.task.position:
        return (
            f" and {len(mechanism.closure)} other equations: closure= of a platform that only turns must say that a "
            "direction of the platform encloses a fixed angle with one that joints turn, or its distance to a point"
        )
    joints = {j.symbol for j in mechanism.joints}
    turns = [e for e in mechanism.closure if not e.free_symbols & {real(c) for c in COORDINATE_NAMES}]
    if turns and all(e.free_symbols & joints for e in turns):
        turning = ", ".join(j.name for j in mechanism.joints if j.symbol in turns[0].free_symbols)
        return f" and an equation that only turns it: where a joint on the plate ({turning}) does, say so by heading="
    return (
        f" and {len(mechanism.closure)} other equations: closure= of a loop that turns its platform must say that a "
        "point of the platform keeps its distance from one that joints move, which a rod says"
    )


def home_rotation(mechanism: Mechanism) -> sp.Matrix:
    """The rotation of the home pose, by names that the setup binds."""
    words = home_angles(mechanism)
    return by_angles(words) if len(words) == 1 else sp.Matrix(3, 3, HOME_ROTATION)


def home_position(mechanism: Mechanism) -> tuple[sp.Expr, ...]:
    """The position of the home pose: zero if the task commands none."""
    given = dict(zip(mechanism.motion.position, mechanism.home, strict=False))
    return tuple(given.get(c, sp.Integer(0)) for c in COORDINATE_NAMES)


def _platform_radius(mechanism: Mechanism) -> tuple[Let, ...]:
    points = [point_of(rod) for rod in mechanism.holding_rods]
    centre = tuple(real(f"centre_{c}") for c, _ in zip(COORDINATE_NAMES, points[0], strict=False))
    means = (sp.Add(*column) / len(points) for column in zip(*points, strict=True))
    squares = [(c - m) ** 2 for point in points for c, m in zip(point, centre, strict=True)]
    spread = real("spread")
    return (
        *(Let(n, v, "centre of the joints on the platform") for n, v in zip(centre, means, strict=True)),
        Let(spread, Root(sp.Add(*squares) / len(points)), "root mean square of their distances from it"),
        Let(RADIUS, Select(sp.Gt(spread, 0), spread, sp.Integer(1))),
    )


def _lengths_at_home(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The lengths of the legs at the home pose: where one is a joint, it follows from the pose. If joints move its base
    as well, they are zero for this.
    """
    rods = mechanism.holding_rods
    fixed = [rod for rod in rods if not is_driven(mechanism, rod.base)]
    measured = [rod for rod in rods if is_driven(mechanism, [rod.length])]
    lengths = tuple(leg_symbol("length" if r in fixed or r not in measured else "rest_length", r) for r in rods)
    shortest = SHORTEST_LINK * SCALE
    apart = sp.And(sp.Gt(real("spread"), shortest), *[sp.Gt(v, shortest) for v in lengths])
    return (
        *(let for rod in fixed for let in _span_at_home(mechanism, rod)),
        *(_at_rest(mechanism, r, n) if r in measured else Let(n, r.length) for r, n in zip(rods, lengths, strict=True)),
        Let(SCALE, sp.Add(*lengths) / len(lengths) + RADIUS, "characteristic length: mean leg, radius of the platform"),
        Require(apart, Status.NOT_INITIALIZED, reason=about_parameters(_APART)),
    )


def _at_rest(mechanism: Mechanism, rod: Rod, name: sp.Symbol) -> Let:
    """The length of a leg at the home pose, with the joints that move its base at zero."""
    if not is_driven(mechanism, rod.base):
        return length(rod)
    base = (v.xreplace({j.symbol: sp.Integer(0) for j in mechanism.joints}) for v in rod.base)
    ends = zip(home_position(mechanism), names("home_arm", rod), base, strict=False)
    return Let(name, Root(sp.Add(*[(p + a - b) ** 2 for p, a, b in ends])))


def _span_at_home(mechanism: Mechanism, rod: Rod) -> tuple[Let, ...]:
    base = [at_home_joints(mechanism, v) for v in rod.base]
    return span(mechanism, rod, (home_position(mechanism), home_rotation(mechanism)), base, "home_arm")


def at_home_joints(mechanism: Mechanism, value: sp.Expr) -> sp.Expr:
    """A value with the joints at the home pose: `home_cos_a1`, `home_a1`."""
    form = polynomial(with_fixed_names(mechanism, value), all_angles(mechanism), signs_of(mechanism))
    own = [s for j in mechanism.joints for s in (j.symbol, cosine(j.symbol), sine(j.symbol))]
    unfixed = {f(a): g(a * DEGREE) for a in fixed_angles(mechanism) for f, g in ((cosine, sp.cos), (sine, sp.sin))}
    return form.xreplace({s: real(f"home_{s.name}") for s in own} | unfixed) if is_driven(mechanism, [value]) else value


def _mode_at_home(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The lines of the legs at the home pose, and the sign of their determinant."""
    lines = (
        row(mechanism, rod, names("home_arm", rod), leg_symbol("length", rod), vector_word(mechanism, rod))
        for rod in mechanism.holding_rods
    )
    home = home_rotation(mechanism)
    planes = (plane_row(mechanism, p, names("home_arm", p), home, named=False) for p in mechanism.guides)
    return (
        *(let for lets in (*lines, *planes) for let in lets),
        *cone_axes(mechanism, home_rotation(mechanism)),
        Solve(
            (),
            rows(mechanism),
            (),
            DETERMINANT,
            "determinant at the home pose: zero where the legs do not hold the platform",
        ),
        Require(sp.Gt(sp.Abs(DETERMINANT), SINGULAR), Status.NOT_INITIALIZED, reason=about_parameters(_HELD)),
        *_guided_at_home(mechanism),
        Let(
            ASSEMBLY_SIGN, Select(sp.Gt(DETERMINANT, 0), sp.Integer(1), sp.Integer(-1)), "assembly mode of this machine"
        ),
    )


def _guided_at_home(mechanism: Mechanism) -> tuple[Require, ...]:
    """The condition that the planes determine the passive coordinates at the home pose."""
    if not mechanism.passive:
        return ()
    pose = pose_at_home(mechanism)
    held = sp.Abs(guides_determinant(mechanism).xreplace(pose))
    return (Require(sp.Gt(held, SINGULAR), Status.NOT_INITIALIZED, reason=about_parameters(_GUIDED)),)


def machine_constants(mechanism: Mechanism) -> tuple[Output, ...]:
    """The outputs that other programs may read."""
    words = home_angles(mechanism)
    rotation = HOME_ROTATION if len(words) > 1 else tuple(real(f"{w}_{words[0]}") for w in ("cos", "sin"))
    own = (Output(n.name, n) for n in (*rotation, RADIUS, SCALE, ASSEMBLY_SIGN))
    return (*own, *_start(mechanism), *mode_constants(mechanism), *cone_constants(mechanism))


def _start(mechanism: Mechanism) -> Iterator[Output]:
    """The pose at which forward kinematics starts: home. It is data of the machine, so that a caller can give another
    start.
    """
    yield from (Output(f"start_{c}", v) for c, v in zip(mechanism.motion.position, mechanism.home, strict=False))
    yield from (Output(s.name, v) for s, v in zip(START_ROTATION, home_rotation(mechanism), strict=True))


def platform_checks(mechanism: Mechanism, solved: Sequence[Statement]) -> tuple[Statement, ...]:
    """The checks of a solved inverse: legs with a length, the machine's assembly mode, no singularity."""
    bound = {s.name for s in solved if isinstance(s, Let)}
    lets: list[Let] = []
    for rod in mechanism.holding_rods:
        arm, word = names("arm", rod), vector_word(mechanism, rod)
        base = [
            polynomial(with_fixed_names(mechanism, v), all_angles(mechanism), signs_of(mechanism))
            if is_driven(mechanism, rod.base)
            else v
            for v in rod.base
        ]
        vectors = (
            *turned(rotation_of(mechanism), point_of(rod), arm_names("arm", rod)),
            *span(mechanism, rod, (position_of(mechanism), rotation_of(mechanism)), base),
            *span_moment(mechanism, rod, arm, word),
        )
        lets += [let for let in vectors if let.name not in bound]
        lets += [divisor(rod, rod.length)] if is_driven(mechanism, [rod.length]) else []
    for plane in mechanism.guides:
        arm, rotation = names("arm", plane), rotation_of(mechanism)
        vectors = (*turned(rotation, point_of(plane), arm), *plane_row(mechanism, plane, arm, rotation))
        lets += [let for let in vectors if let.name not in bound]
    margin, least = ASSEMBLY_SIGN * DETERMINANT, real(MIN_TYPE2_MARGIN)
    lengths = sp.Mul(
        *[leg_symbol("divisor", r) if is_driven(mechanism, [r.length]) else r.length for r in mechanism.holding_rods]
    )
    of_spans = real("determinant_of_spans")
    words = [vector_word(mechanism, rod) for rod in mechanism.holding_rods]
    return (
        *lets,
        *(_beyond(rod, rod.length) for rod in mechanism.holding_rods if is_driven(mechanism, [rod.length])),
        *(_beyond(rod, real(f"off_axis_{rod.name}")) for rod in mechanism.holding_rods if rod.ring is not None),
        *cone_checks(mechanism),
        Solve((), rows(mechanism, words), (), of_spans, "determinant of the spans of the legs and their moments"),
        Let(
            DETERMINANT,
            of_spans / lengths,
            "the same of unit vectors: margin of the platform, zero in a type 2 singularity",
        ),
        Require(sp.Ge(margin, least), Status.UNREACHABLE, reason=about(MARGIN, Why.NEAR_TYPE_2, least - margin)),
    )


def _beyond(rod: Rod, length: sp.Expr) -> Require:
    """The condition that a rod has a length, or that its base is off the axis of its ring."""
    return Require(
        sp.Gt(length, SHORTEST_LINK * SCALE), Status.UNREACHABLE, reason=about_leg(rod.name, Why.WITHOUT_LENGTH)
    )
