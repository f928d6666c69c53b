"""The closure equations of a mechanism, in the coordinates of its task.

A chain gives f(q) - x = 0; a mechanism that states equations gives these. The commanded turn enters as a
known angle `heading`, through its sine and cosine.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import sympy as sp

from derive.algebra import is_compound, polynomial, split_known
from derive.frames import Chain, Factor, Motion, Txyz
from derive.mechanism import DescriptionError, Joint, Mechanism, Role, Turning
from derive.pose import pose_of
from derive.problem import Equation
from derive.program import Let, real

COORDINATES = ("x", "y", "z")
HEADING = real("heading")
OFFSET = tuple(real(f"point_{c}") for c in COORDINATES)
"""The point off the flange, in flange coordinates."""


@dataclass(frozen=True)
class Closure:
    """Equations, what they name, and what of the position is met and not solved for."""

    equations: tuple[Equation, ...]
    arguments: tuple[sp.Expr, ...]
    """Arguments of sines and cosines, where sums of parallel angles can be read."""
    lets: tuple[Let, ...] = ()
    plane: sp.Expr | None = None
    """The z that a planar machine has."""


def signs_of(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The parameters that are +1 or -1."""
    return tuple(p.symbol for p in mechanism.parameters if p.role is Role.SIGN)


def angles_of(mechanism: Mechanism) -> tuple[sp.Symbol, ...]:
    """The joints that turn."""
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
        return _stated_closure(mechanism, {})
    pose = pose_of(mechanism.chain)
    closure = _position_closure(mechanism, pose.position)
    if mechanism.task.turning is Turning.NONE:
        return closure
    argument = heading_of(mechanism.chain)
    turns = (
        _equation(mechanism, "cosine of the heading", sp.cos(argument) - real("cos_heading")),
        _equation(mechanism, "sine of the heading", sp.sin(argument) - real("sin_heading")),
    )
    arguments = tuple(dict.fromkeys((*closure.arguments, argument)))
    return Closure(closure.equations + turns, arguments, closure.lets, closure.plane)


def heading_of(chain: Chain) -> sp.Expr:
    """The one turn about z that a chain makes in front of its flange."""
    bare, _ = flange_flips(chain)
    turns = pose_of(bare).turns
    if len(turns) != 1 or turns[0].axis != 2:
        raise DescriptionError("the chain must turn the flange about z alone: its rotation is not one turn about z")
    return turns[0].amount


def offset_closure(mechanism: Mechanism, unknown: tuple[Joint, ...]) -> Closure:
    """The closure of the position of a point off the flange; joints that are not unknown are frozen."""
    if mechanism.chain is None:
        return _stated_closure(mechanism, dict(zip(COORDINATES, OFFSET, strict=True)))
    factors = (*mechanism.chain.factors, *Txyz(*OFFSET).factors)
    symbols = {j.symbol for j in unknown}
    last = max((i for i, f in enumerate(factors) if f.motion is Motion.TURN and f.amount.free_symbols & symbols), default=-1)
    tool = pose_of(Chain(factors[last + 1 :])).position
    lets: list[Let] = []
    entries = [_named_tool(mechanism, entry, f"tool_{c}", symbols, lets) for entry, c in zip(tool, COORDINATES, strict=True)]
    pose = pose_of(Chain(factors[: last + 1]) * Txyz(*entries))
    closure = _position_closure(mechanism, pose.position)
    return Closure(closure.equations, closure.arguments, tuple(lets), closure.plane)


def _named_tool(
    mechanism: Mechanism, entry: sp.Expr, name: str, unknown: set[sp.Symbol], lets: list[Let]
) -> sp.Expr:
    """The entry with its known part under one name: the solver need not look into it."""
    form = polynomial(entry, angles_of(mechanism), signs_of(mechanism))
    moving, known = split_known(form, unknown)
    if not is_compound(known):
        return moving + known
    lets.append(Let(real(name), known, "the point seen from the last moving joint"))
    return moving + real(name)


def _position_closure(mechanism: Mechanism, position: sp.ImmutableMatrix) -> Closure:
    equations: list[Equation] = []
    plane: sp.Expr | None = None
    for value, name in zip(position, COORDINATES, strict=True):
        if name in mechanism.task.position:
            equations.append(_equation(mechanism, name, value - real(name)))
        else:
            plane = sp.sympify(value)
            if plane.free_symbols & {j.symbol for j in mechanism.joints}:
                raise DescriptionError(f"{name} is not commanded but the joints move it")
    return Closure(tuple(equations), _arguments(position), (), plane)


def _stated_closure(mechanism: Mechanism, offset: dict[str, sp.Symbol]) -> Closure:
    """The stated equations; with an offset they hold for the flange, which keeps its orientation."""
    lets = tuple(Let(real(f"flange_{c}"), real(c) - o, "the flange behind the point") for c, o in offset.items())
    table = {real(c): real(f"flange_{c}") for c in offset}
    equations = tuple(
        _equation(mechanism, _label(e, number), sp.sympify(e).xreplace(table))
        for number, e in enumerate(mechanism.closure, 1)
    )
    plane = None if "z" in mechanism.task.position else offset.get("z", sp.Integer(0))
    return Closure(equations, _arguments(mechanism.closure), lets, plane)


def _label(equation: sp.Expr, number: int) -> str:
    held = [c for c in COORDINATES if real(c) in sp.sympify(equation).free_symbols]
    return held[0] if len(held) == 1 else f"closure_{number}"


def _arguments(expressions: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
    found = sp.Matrix(list(expressions)).atoms(sp.sin, sp.cos)
    return tuple(sorted({f.args[0] for f in found}, key=sp.default_sort_key))


def _equation(mechanism: Mechanism, label: str, expression: sp.Expr) -> Equation:
    return Equation(label, polynomial(expression, angles_of(mechanism), signs_of(mechanism)))

