"""The types of a whole program: every value has the type of its name, and a requirement is a condition."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from derive.ir.program import Call, FindRoot, Iterate, Let, Program, Require, Solve, Statement
from derive.ir.types import TURNING, IllTypedError, Known, Type, angles_of, fits, output_types, type_of


def check_types(program: Program) -> None:
    """Raise `IllTypedError` for a statement or an output that mixes types."""
    known: dict[sp.Symbol, Type] = {}
    for statement in program.body:
        known |= check_statement(statement, known)
    for output in program.outputs:
        type_of(output.value, known)


def check_statement(statement: Statement, known: Known) -> dict[sp.Symbol, Type]:
    """The names that a statement binds to angles, given the `known` ones; raises `IllTypedError` if it mixes types."""
    if isinstance(statement, Let):
        return _check_let(statement, known)
    bound = angles_of(statement, known)
    if isinstance(statement, Iterate):
        _check_loop(statement, known, {**known, **bound})
        return bound
    for value, wanted in _wanted(statement):
        _check(value, type_of(value, known), wanted)
    if isinstance(statement, Call):
        types = output_types(statement.program)
        for name in statement.names:
            _check(name, types[name.name], type_of(name, bound))
    if isinstance(statement, FindRoot):
        found = list(output_types(statement.finish).values())
        for name, kind in zip(statement.names, found, strict=True):
            _check(name, kind, type_of(name, bound))
        _check(statement.names[0], found[0], Type.BOOL)
    return bound


def _check_let(let: Let, known: Known) -> dict[sp.Symbol, Type]:
    found = type_of(let.value, known)
    bound = {let.name: found} if found in TURNING else {}
    wanted = type_of(let.name, bound)
    if found is not wanted:
        _check(let.value, found, wanted)
    return bound


def _wanted(statement: Statement) -> Iterator[tuple[sp.Basic, Type]]:
    """The values of a statement other than a `Let`, with the types that they must have."""
    if isinstance(statement, Require):
        yield statement.condition, Type.BOOL
    elif isinstance(statement, Solve):
        yield from ((value, Type.REAL) for value in (*statement.matrix, *statement.right))
    elif isinstance(statement, Call):
        yield from ((value, type_of(name)) for name, value in statement.given)
        yield statement.wanted, Type.BOOL
    elif isinstance(statement, FindRoot):
        yield from ((statement.start, Type.REAL), (statement.wanted, Type.BOOL))


def _check_loop(loop: Iterate, known: Known, inside: Known) -> None:
    """known, inside: the names that are angles in front of the loop, and in it."""
    for inner in loop.step:
        check_statement(inner, inside)
    for name, start, following in zip(loop.state, loop.start, loop.following, strict=True):
        _check(start, type_of(start, known), type_of(name, inside))
        _check(following, type_of(following, inside), type_of(name, inside))
    _check(loop.done, type_of(loop.done, inside), Type.BOOL)


def _check(value: sp.Basic, found: Type, wanted: Type) -> None:
    if not fits(found, wanted):
        raise IllTypedError(f"{value} is {found.value}, and {wanted.value} is wanted")
