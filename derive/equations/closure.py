"""The closure equations of a mechanism, in the coordinates of its task.

A chain gives f(q) - x = 0; a mechanism that states equations gives these. A commanded rotation about z enters as the
known angle `heading`, by its sine and cosine.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache

import sympy as sp

from derive.algebra.normal_form import is_compound, polynomial, reduce_units, split_known
from derive.description.mechanism import (
    DescriptionError,
    Joint,
    Mechanism,
    Rod,
    Role,
    Turning,
)
from derive.equations.chain_splits import Commanded, Split, Target, Unknowns, is_spatial, split_positions
from derive.equations.problem import Equation
from derive.geometry.frames import Chain, Factor, Motion, Txyz
from derive.geometry.pose import pose_of
from derive.ir.constants import (
    DEGREE,
)
from derive.ir.program import (
    Let,
)
from derive.ir.symbols import (
    COORDINATE_NAMES,
    HEADING,
    OFFSET,
    ROTATION_ENTRIES,
    cosine,
    real,
    sine,
)

FLANGE = tuple(real(f"flange_{c}") for c in COORDINATE_NAMES)
"""The position of the flange for a commanded point off it, where the flange keeps its orientation."""


@dataclass(frozen=True)
class Closure:
    """Equations, the statements that bind their names, and the coordinate of the position that is given."""

    equations: tuple[Equation, ...]
    arguments: tuple[sp.Expr, ...]
    """Arguments of sines and cosines, where sums of parallel angles can be read."""
    lets: tuple[Let, ...] = ()
    planes: tuple[tuple[str, sp.Expr], ...] = ()
    """The coordinates that the task does not command, each with its constant value: z of a machine in a plane."""
    turns: tuple[Factor, ...] = ()
    """The rotations whose product is the commanded one, where the task is more than a rotation about z."""
    columns: tuple[int, ...] = (0, 1, 2)
    """The columns of the commanded rotation that are followed."""
    links: tuple[Factor, ...] = ()
    """The chain for which the position equations are written, which ends in `target`."""
    target: Target = Target(())
    back: tuple[tuple[Factor, ...], Target] | None = None
    """The same from the flange to the point in which the first joints intersect."""


def signs_of(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The parameters that are +1 or -1, and those that are 0 or 1."""
    return tuple(p.symbol for p in mechanism.parameters if p.role in (Role.SIGN, Role.FLAG))


def fixed_angles(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The angles of the machine that never move: its angle parameters, in degrees."""
    return tuple(p.symbol for p in mechanism.parameters if p.role is Role.ANGLE)


def fixed_lets(mechanism: Mechanism) -> tuple[Let, ...]:
    """The cosines and sines of these angles, and the roots that are made of parameters alone."""
    functions = ((cosine, sp.cos), (sine, sp.sin))
    angles = tuple(Let(f(a), g(a * DEGREE)) for a in fixed_angles(mechanism) for f, g in functions)
    return (
        *angles,
        *(let for _, let in _fixed_roots(mechanism.equations, tuple(p.symbol for p in mechanism.parameters))),
    )


def fixed_names(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """Every name that is made of parameters alone."""
    return (*(p.symbol for p in mechanism.parameters), *(let.name for let in fixed_lets(mechanism)))


def fixed_squares(mechanism: Mechanism) -> dict[sp.Symbol, sp.Expr]:
    """The squares of these roots, by their names."""
    parameters = tuple(p.symbol for p in mechanism.parameters)
    own = {real(p.name): p for p in parameters}
    return {
        let.name: sp.expand((let.value**2).xreplace(own)) for _, let in _fixed_roots(mechanism.equations, parameters)
    }


@cache
def _fixed_roots(equations: tuple[sp.Expr, ...], parameters: tuple[sp.Symbol, ...]) -> tuple[tuple[sp.Expr, Let], ...]:
    """The square roots in the equations that are made of parameters alone, inner ones first, each with its name.

    A radicand under a name is not expanded: a difference of squares stays a product of lengths.
    """
    powers = {p for e in equations for p in sp.sympify(e).atoms(sp.Pow) if p.exp == sp.Rational(1, 2)}
    roots = [r for r in powers if r.free_symbols and r.free_symbols <= set(parameters)]
    found: list[tuple[sp.Expr, Let]] = []
    for number, root in enumerate(sorted(roots, key=lambda r: (sp.count_ops(r), str(r))), 1):
        radicand = sp.factor(root.base.xreplace({inner: let.name for inner, let in found}))
        radicand = radicand.xreplace({s: real(s.name) for s in radicand.free_symbols})  # else SymPy splits the root
        found.append((root, Let(real(f"fixed_length_{number}"), sp.sqrt(radicand), "a length made of parameters")))
    return tuple(found)


def all_angles(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """Every angle whose sine and cosine have names."""
    return (*angles_of(mechanism), *fixed_angles(mechanism))


def with_fixed_names(mechanism: Mechanism, expression: sp.Expr) -> sp.Expr:
    """The expression with the sines and cosines of fixed angles and of the heading of a loop, and the roots of
    parameters, by their names.
    """
    functions = ((cosine, sp.cos), (sine, sp.sin))
    table = {g(a * DEGREE): f(a) for a in fixed_angles(mechanism) for f, g in functions}
    if mechanism.is_turning_loop and mechanism.task.turning is Turning.ABOUT_Z:
        table |= _heading_entries()
    for root, let in _fixed_roots(mechanism.equations, tuple(p.symbol for p in mechanism.parameters)):
        table[root] = let.name
    return sp.sympify(expression).xreplace(table)


def _heading_entries() -> dict[sp.Expr, sp.Expr]:
    """The entries of a rotation about z, by the names of its cosine and sine."""
    cos_heading, sin_heading = cosine(HEADING), sine(HEADING)
    entries = (cos_heading, -sin_heading, 0, sin_heading, cos_heading, 0, 0, 0, 1)
    return dict(zip(ROTATION_ENTRIES, map(sp.sympify, entries), strict=True))


def angles_of(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The angles of the rotary joints."""
    return tuple(j.symbol for j in mechanism.joints if j.is_angle)


def flange_flips(chain: Chain) -> tuple[Chain, tuple[Factor, ...]]:
    """The chain without its last flips, and these flips: a fixed rotation behind the joints."""
    factors = list(chain.factors)
    flips: list[Factor] = []
    while factors and factors[-1].motion is Motion.FLIP:
        flips.insert(0, factors.pop())
    if any(f.motion is Motion.FLIP for f in factors):
        raise DescriptionError("a flip must stand at the end of the chain")
    return Chain(tuple(factors)), tuple(flips)


def flange_rotation(chain: Chain) -> sp.ImmutableMatrix:
    """The fixed rotation behind the last joint."""
    return pose_of(Chain(flange_flips(chain)[1])).rotation


def pose_closure(mechanism: Mechanism) -> Closure:
    """The closure of a commanded pose."""
    if mechanism.chain is None:
        return _with_heading(mechanism, _stated_closure(mechanism, {}), mechanism.heading)
    is_pitch = mechanism.followed_turns > 0
    if is_pitch or (is_spatial(mechanism.chain) and mechanism.task.turning is not Turning.ABOUT_Z):
        return _spatial_closure(mechanism, mechanism.chain, mechanism.solved_joints, mechanism.task.turning)
    pose = pose_of(mechanism.chain)
    closure = _position_closure(mechanism, pose.position)
    if mechanism.task.turning is Turning.NONE:
        return closure
    return _with_heading(mechanism, closure, heading_of(mechanism.chain))


def _with_heading(mechanism: Mechanism, closure: Closure, argument: sp.Expr | None) -> Closure:
    """The closure, with the equations that the flange is turned about z as it is commanded."""
    if argument is None:
        return closure
    parts = (("cos", sp.cos(argument)), ("sin", sp.sin(argument)))
    turns = tuple(_equation(mechanism, f"{word} heading", value - real(f"{word}_heading")) for word, value in parts)
    arguments = tuple(dict.fromkeys((*closure.arguments, argument)))
    return Closure(closure.equations + turns, arguments, closure.lets, closure.planes)


def closure_at(mechanism: Mechanism, known: Joint) -> Closure:
    """The closure of a commanded pose with one joint known."""
    assert mechanism.chain is not None
    moving = tuple(j for j in mechanism.solved_joints if j != known)
    return _spatial_closure(mechanism, mechanism.chain, moving, mechanism.task.turning)


def _spatial_closure(mechanism: Mechanism, chain: Chain, moving: tuple[Joint, ...], turning: Turning) -> Closure:
    """The closure of a spatial chain: its position equations are split here, its rotation is split by the solver.

    turning: the part of the commanded rotation that is known.
    """
    angles, lengths = (tuple(j.symbol for j in moving if j.is_angle is kind) for kind in (True, False))
    unknowns = Unknowns(angles, lengths, all_angles(mechanism), signs_of(mechanism))
    follows = turning is not Turning.NONE
    columns = (2,) if turning in (Turning.DIRECTION, Turning.PITCH) else (0, 1, 2)
    is_whole = follows and not mechanism.followed_turns  # a direction that is projected tells no wrist centre
    commanded = Commanded(sp.Matrix(3, 3, ROTATION_ENTRIES), columns if is_whole else ())
    pose = pose_of(chain)
    planes = _planes_of(mechanism, pose.position)
    table = dict(planes)
    point = tuple(table.get(c, real(c)) for c in COORDINATE_NAMES)  # those not commanded are what the machine has
    split = split_positions(chain, point, commanded, unknowns) if mechanism.task.position else Split(())
    arguments = dict.fromkeys((*_arguments(pose.position), *(t.amount for t in pose.turns)))
    turns = pose.turns if follows else ()
    return Closure(
        tuple(e for e in split.equations if e.expression != 0),
        tuple(arguments),
        planes=planes,
        turns=turns,
        columns=columns,
        links=split.links,
        target=split.target,
        back=split.back,
    )


def heading_of(chain: Chain) -> sp.Expr:
    """The angle by which a chain turns its flange about z. Raises `DescriptionError` where it turns otherwise."""
    joints, _ = flange_flips(chain)
    turns = pose_of(joints).turns
    if len(turns) != 1 or turns[0].axis != 2:
        about = f"it turns about {', '.join('xyz'[t.axis] for t in turns)}" if turns else "it does not turn at all"
        raise DescriptionError(
            f"the chain must turn the flange about z alone: its rotation is not one turn about z, {about}; command the "
            "whole rotation, or a direction, or turn the flange back"
        )
    return turns[0].amount


def offset_closure(mechanism: Mechanism, unknown: tuple[Joint, ...]) -> Closure:
    """The closure of the position of a point off the flange; the joints that are not unknown are held at their
    reference.
    """
    if mechanism.chain is None:
        return _stated_closure(mechanism, dict(zip(COORDINATE_NAMES, OFFSET, strict=True)))
    factors = (*mechanism.chain.factors, *Txyz(*OFFSET).factors)
    symbols = {j.symbol for j in unknown}
    last = max(
        (i for i, f in enumerate(factors) if f.motion is Motion.TURN and f.amount.free_symbols & symbols), default=-1
    )
    tool = pose_of(Chain(factors[last + 1 :])).position
    lets: list[Let] = []
    entries = [
        _named_tool(mechanism, entry, f"tool_{c}", symbols, lets)
        for entry, c in zip(tool, COORDINATE_NAMES, strict=True)
    ]
    seen = Chain(factors[: last + 1]) * Txyz(*entries)
    if is_spatial(mechanism.chain):
        return replace(_spatial_closure(mechanism, seen, unknown, Turning.NONE), lets=tuple(lets))
    pose = pose_of(seen)
    closure = _position_closure(mechanism, pose.position)
    return Closure(closure.equations, closure.arguments, tuple(lets), closure.planes)


def _named_tool(mechanism: Mechanism, entry: sp.Expr, name: str, unknown: set[sp.Symbol], lets: list[Let]) -> sp.Expr:
    """The entry with its known part under one name, which the solver treats as a symbol."""
    form = polynomial(entry, angles_of(mechanism), signs_of(mechanism))
    moving, known = split_known(form, unknown)
    if not is_compound(known):
        return moving + known
    lets.append(Let(real(name), known, "commanded point, in the frame of the last moving joint"))
    return moving + real(name)


def _position_closure(mechanism: Mechanism, position: sp.ImmutableMatrix) -> Closure:
    equations = tuple(
        _equation(mechanism, name, value - real(name))
        for value, name in zip(position, COORDINATE_NAMES, strict=True)
        if name in mechanism.task.position
    )
    return Closure(equations, _arguments(position), (), _planes_of(mechanism, position))


def _planes_of(mechanism: Mechanism, position: sp.ImmutableMatrix) -> tuple[tuple[str, sp.Expr], ...]:
    """The coordinates of a chain that the task does not command, by their values, which no joint moves."""
    joints = {j.symbol for j in mechanism.joints}
    moving = joints | {f(a) for a in angles_of(mechanism) for f in (sine, cosine)}
    planes: list[tuple[str, sp.Expr]] = []
    for value, name in zip(position, COORDINATE_NAMES, strict=True):
        if name in mechanism.task.position or not mechanism.task.position:
            continue
        plane = with_fixed_names(mechanism, sp.sympify(value))
        if plane.free_symbols & joints:
            plane = polynomial(plane, all_angles(mechanism), signs_of(mechanism))
        if plane.free_symbols & moving:
            raise DescriptionError(f"{name} is not commanded but the joints move it")
        planes.append((name, plane))
    return tuple(planes)


def _stated_closure(mechanism: Mechanism, offset: dict[str, sp.Symbol], known: str = "span") -> Closure:
    """The stated equations; with an offset they hold for the flange, whose orientation is known.

    known: the known part of a rod's vector: its "span" where the joints are unknown, its "pivot" where the position is.
    """
    flange = dict(zip(COORDINATE_NAMES, FLANGE, strict=True))
    rotation = sp.eye(3) if mechanism.heading is None else sp.Matrix(3, 3, [*_heading_entries().values()])
    shift = rotation * sp.Matrix([*offset.values()]) if offset else ()
    note = "position of the flange: the point less its offset"
    lets = tuple(Let(flange[c], real(c) - o, note) for c, o in zip(offset, shift, strict=True))
    table = {real(c): flange[c] for c in offset}
    wanted = {j.symbol for j in mechanism.joints} if known == "span" else set(map(real, COORDINATE_NAMES))
    equations = [
        _equation(mechanism, _label(e, number), sp.sympify(e).xreplace(table))
        for number, e in enumerate(mechanism.closure, 1)
    ]
    equations += [
        _equation(mechanism, f"guide {plane.name}", plane.equation)
        for plane in mechanism.guides
        if plane not in mechanism.fixed_guides
    ]
    equations += [_rod_equation(mechanism, rod, table, (known, wanted)) for rod in mechanism.rods]
    planes = tuple((c, offset.get(c, sp.Integer(0))) for c in COORDINATE_NAMES if c not in mechanism.motion.position)
    return Closure(tuple(equations), _arguments(mechanism.equations), lets, planes)


def position_closure(mechanism: Mechanism) -> Closure:
    """The stated equations with the joints known and the position unknown."""
    return _stated_closure(mechanism, {}, "pivot")


def _rod_equation(
    mechanism: Mechanism, rod: Rod, table: dict[sp.Symbol, sp.Symbol], sought: tuple[str, set[sp.Symbol]]
) -> Equation:
    """|plate - base|^2 = length^2, with the known part of every coordinate under one name."""
    word, wanted = sought
    unknown = {s for v in wanted for s in (v, sine(v), cosine(v))}
    lets: list[Let] = []
    total: sp.Expr = -(rod.length**2)
    for name, plate, base in zip(COORDINATE_NAMES, rod.plate, rod.base, strict=False):
        between = with_fixed_names(mechanism, (plate - base).xreplace(table))
        form = polynomial(between, all_angles(mechanism), signs_of(mechanism))
        moving, known = split_known(form, unknown)
        side = 1 if word == "span" else -1  # a span points from the base to the plate, a pivot is a point of the base
        known = side * known
        if is_compound(known):
            note = f"rod {rod.name}: {'known part of its vector' if word == 'span' else 'centre about which it swings'}"
            lets.append(Let(real(f"{word}_{rod.name}_{name}"), known, "" if lets else note))
            known = lets[-1].name
        total += (moving + side * known) ** 2
    expression = reduce_units(total, all_angles(mechanism), signs_of(mechanism))
    return Equation(f"rod {rod.name}", expression, tuple(lets), _rod_scales(mechanism, rod))


def _rod_scales(mechanism: Mechanism, rod: Rod) -> dict[sp.Symbol, sp.Expr]:
    """2 * length * |derivative of the rod's vector| by a joint or by the position, where that is a constant."""
    scales: dict[sp.Symbol, sp.Expr] = {}
    for symbol in (*(j.symbol for j in mechanism.joints), *(real(c) for c in COORDINATE_NAMES)):
        rates = [sp.diff(p - b, symbol) for p, b in zip(rod.plate, rod.base, strict=True)]
        square = polynomial(
            with_fixed_names(mechanism, sum(r**2 for r in rates)), all_angles(mechanism), signs_of(mechanism)
        )
        if square != 0 and not square.free_symbols & set(_moving_symbols(mechanism)):
            scales[symbol] = 2 * rod.length * sp.sqrt(sp.factor(square))
    return scales


def _moving_symbols(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    joints = [j.symbol for j in mechanism.joints]
    return (*joints, *(f(a) for a in joints for f in (sine, cosine)), *(real(c) for c in COORDINATE_NAMES))


def _label(equation: sp.Expr, number: int) -> str:
    held = [c for c in COORDINATE_NAMES if real(c) in sp.sympify(equation).free_symbols]
    return held[0] if len(held) == 1 else f"closure_{number}"


def _arguments(expressions: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
    found = sp.Matrix(list(expressions)).atoms(sp.sin, sp.cos)
    return tuple(sorted({f.args[0] for f in found}, key=sp.default_sort_key))


def _equation(mechanism: Mechanism, label: str, expression: sp.Expr) -> Equation:
    return Equation(
        label, polynomial(with_fixed_names(mechanism, expression), all_angles(mechanism), signs_of(mechanism))
    )
