"""The closure for what is commanded: a pose, a pose with one joint known, a point off the flange.

A chain gives f(q) - x = 0; a mechanism that states equations gives those. A commanded rotation about z enters as the
known angle `heading`, by its sine and cosine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.algebra.normal_form import is_compound, polynomial, split_known
from derive.description.mechanism import DescriptionError, Joint, Mechanism, Turning
from derive.equations.chain_splits import Commanded, Split, Unknowns, is_spatial, split_positions
from derive.equations.closures.closure import Closure, arguments_of, named_equation
from derive.equations.closures.fixed_names import all_angles, angles_of, signs_of, with_fixed_names
from derive.equations.closures.stated import stated_closure
from derive.equations.problem import Equation
from derive.geometry.frames import Chain, Factor, Motion, Txyz
from derive.geometry.pose import pose_of
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, OFFSET, ROTATION_ENTRIES, cosine, real, sine
from derive.work import counted


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
        return _with_heading(mechanism, stated_closure(mechanism, {}), mechanism.heading)
    chain, turning = mechanism.chain, mechanism.task.turning
    is_spaced = is_spatial(chain) and not mechanism.task.passive  # a split of the chain reads all coordinates
    is_upright = turning is Turning.ABOUT_Z
    if mechanism.followed_turns or (is_spaced and not is_upright):
        return _spatial_closure(mechanism, chain, mechanism.solved_joints, turning)
    closure = _position_closure(mechanism, pose_of(chain).position)
    if not is_upright:
        return closure
    seen = _spatial_closure(mechanism, chain, mechanism.solved_joints, Turning.NONE) if is_spaced else closure
    beside = any(_is_beside(e, mechanism.solved_joints) for e in seen.equations)
    return _with_heading(mechanism, seen if beside else closure, heading_of(chain))


def _is_beside(equation: Equation, joints: Sequence[Joint]) -> bool:
    """Whether an equation has one joint alone, a turn whose axis the point stays beside."""
    found = [j for j in joints if equation.expression.free_symbols & {j.symbol, cosine(j.symbol), sine(j.symbol)}]
    at_zero = {f(j.symbol): sp.Integer(0) for j in found for f in (cosine, sine)}
    return len(found) == 1 and found[0].is_angle and equation.expression.xreplace(at_zero) != 0


def _with_heading(mechanism: Mechanism, closure: Closure, argument: sp.Expr | None) -> Closure:
    """The closure, with the equations that the flange is turned about z as it is commanded."""
    if argument is None:
        return closure
    parts = (("cos", sp.cos(argument)), ("sin", sp.sin(argument)))
    turns = tuple(
        named_equation(mechanism, f"{word} heading", value - real(f"{word}_heading")) for word, value in parts
    )
    arguments = tuple(dict.fromkeys((*closure.arguments, argument)))
    return replace(closure, equations=closure.equations + turns, arguments=arguments)


@counted
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
    is_whole = follows and not mechanism.followed_turns  # a projected direction does not determine the wrist centre
    commanded = Commanded(sp.Matrix(3, 3, ROTATION_ENTRIES), columns if is_whole else ())
    pose = pose_of(chain)
    planes = _planes_of(mechanism, pose.position)
    table = dict(planes)
    point = tuple(table.get(c, real(c)) for c in COORDINATE_NAMES)  # the machine determines the others
    split = split_positions(chain, point, commanded, unknowns) if mechanism.task.position else Split(())
    arguments = dict.fromkeys((*arguments_of(pose.position), *(t.amount for t in pose.turns)))
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
    """The angle by which a chain turns its flange about z. Raises `DescriptionError` if it turns otherwise."""
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
        return stated_closure(mechanism, dict(zip(COORDINATE_NAMES, OFFSET, strict=True)))
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
    """The entry with one name for its known part, which the solver treats as a symbol."""
    form = polynomial(entry, angles_of(mechanism), signs_of(mechanism))
    moving, known = split_known(form, unknown)
    if not is_compound(known):
        return moving + known
    lets.append(Let(real(name), known, "commanded point, in the frame of the last moving joint"))
    return moving + real(name)


def _position_closure(mechanism: Mechanism, position: sp.ImmutableMatrix) -> Closure:
    equations = tuple(
        named_equation(mechanism, name, value - real(name))
        for value, name in zip(position, COORDINATE_NAMES, strict=True)
        if name in mechanism.task.position
    )
    return Closure(equations, arguments_of(position), (), _planes_of(mechanism, position))


def _planes_of(mechanism: Mechanism, position: sp.ImmutableMatrix) -> tuple[tuple[str, sp.Expr], ...]:
    """The coordinates of a chain that the task does not command, with their values, which no joint changes; not those
    that are passive.
    """
    joints = {j.symbol for j in mechanism.joints}
    moving = joints | {f(a) for a in angles_of(mechanism) for f in (sine, cosine)}
    planes: list[tuple[str, sp.Expr]] = []
    for value, name in zip(position, COORDINATE_NAMES, strict=True):
        if name in (*mechanism.task.position, *mechanism.task.passive) or not mechanism.task.position:
            continue
        plane = with_fixed_names(mechanism, sp.sympify(value))
        if plane.free_symbols & joints:
            plane = polynomial(plane, all_angles(mechanism), signs_of(mechanism))
        if plane.free_symbols & moving:
            raise DescriptionError(f"{name} is not commanded but the joints move it")
        planes.append((name, plane))
    return tuple(planes)
