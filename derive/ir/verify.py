"""The verifier of the intermediate representation: it runs after every pass, and finds a broken program at once."""

from __future__ import annotations

import re
from functools import cache

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.primitives import PRIMITIVES
from derive.ir.program import Call, FindRoot, Iterate, Program, Solve, Statement, reason_expressions, shared
from derive.ir.symbols import is_decided, names_in, symbols_of
from derive.ir.types import IllTypedError, check_types

_PORTABLE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")
_ARITHMETIC = (sp.Add, sp.Mul, sp.Pow, sp.Symbol, sp.Rational, sp.Float, sp.Integer)
_LOGIC = (sp.Le, sp.Lt, sp.Ge, sp.Gt, sp.Eq, sp.Ne, sp.And, sp.Or, sp.Not)


class BrokenProgram(Exception):
    """A program that no language may print; the message names the program and the place."""


class RepeatedName(BrokenProgram):
    """Two values of a program have the same name, or names that become the same in a language that joins words."""

    def __init__(self, message: str, *names: str) -> None:
        """names: the names of both values."""
        super().__init__(message)
        self.names = names


def verify(program: Program) -> Program:
    """Return the program, or raise `BrokenProgram`: unbound or repeated name, unportable name, unknown primitive, mixed
    types.
    """
    bound = {s.name: s for s in (*program.inputs, DEGREE)}
    spelled: dict[str, str] = {}
    for name in [s.name for s in program.inputs] + [name.name for name in program.bound()]:
        _check_name(program, name, spelled)
    for statement in program.body:
        _check_statement(program, statement, bound)
    for output in program.outputs:
        _check_expression(program, output.value, bound)
    try:
        check_types(program)
    except IllTypedError as problem:
        raise BrokenProgram(f"{program.name}: {problem}") from None
    return program


def _check_statement(program: Program, statement: Statement, bound: dict[str, sp.Symbol]) -> None:
    """Check what a statement reads, and add what it binds."""
    if isinstance(statement, Iterate):
        _check_loop(program, statement, bound)
        return
    if isinstance(statement, Solve):
        sizes = statement.size**2, statement.size * statement.columns, len(statement.right)
        if sizes != (len(statement.matrix), len(statement.right), len(statement.names)):
            raise BrokenProgram(f"{program.name}: the matrix, the right-hand sides and the names do not fit together")
    if isinstance(statement, Call):
        _check_call(program, statement)
    for value in (*statement.children(), *reason_expressions(statement)):
        _check_expression(program, value, bound)
    bound |= {name.name: name for name in statement.bound()}


def _check_call(program: Program, call: Call) -> None:
    """Check a call: its names are outputs of the shared program, and the caller binds none of its constants."""
    outputs, arguments = {o.name for o in call.program.outputs}, [name for name, _ in call.given]
    if strangers := [n.name for n in call.names if n.name not in outputs]:
        raise BrokenProgram(f"{program.name}: {call.program.name} has no output {strangers[0]!r}")
    if strangers := [n.name for n in arguments if n not in call.program.inputs]:
        raise BrokenProgram(f"{program.name}: {call.program.name} does not read {strangers[0]!r}")
    if call.passes is not None and any(isinstance(s, FindRoot) for p in _run_by(call) for s in p.body):
        raise BrokenProgram(f"{program.name}: {call.program.name} scans for roots, so `passes` does not bound its work")
    if unbound := [s.name for s in call.constants if s not in program.inputs]:
        message = f"{program.name}: {call.program.name} reads {unbound[0]!r}, which is neither given nor an input"
        raise RepeatedName(message, *(name.name for name in program.bound()))


def _run_by(call: Call) -> tuple[Program, ...]:
    return (call.program, *shared([call.program]))


def _check_loop(program: Program, loop: Iterate, bound: dict[str, sp.Symbol]) -> None:
    if not len(loop.state) == len(loop.start) == len(loop.following) or loop.limit < 1:
        raise BrokenProgram(
            f"{program.name}: state, start and following of a loop must be as many, its limit at least 1"
        )
    for value in loop.start:
        _check_expression(program, value, bound)
    bound |= {name.name: name for name in loop.state}
    for inner in loop.step:
        _check_statement(program, inner, bound)
    for value in (loop.done, *loop.following):
        _check_expression(program, value, bound)
    for own, value in zip(loop.state, loop.following, strict=True):
        if others := sorted(s.name for s in symbols_of(value) if s in loop.state and s != own):
            raise BrokenProgram(
                f"{program.name}: what follows {own} reads {others[0]!r}, which may have been assigned before"
            )


def _check_name(program: Program, name: str, spelled: dict[str, str]) -> None:
    key = _joined(name)
    if not key:
        raise BrokenProgram(f"{program.name}: {name!r} is not a portable snake_case name")
    if key in spelled:
        message = f"{program.name}: {name!r} is bound twice (also as {spelled[key]!r})"
        raise RepeatedName(message, name, spelled[key])
    spelled[key] = name


@cache
def _joined(name: str) -> str:
    """A name as Structured Text compares it, with its words joined and without case; empty if it is not portable."""
    return name.replace("_", "") if _PORTABLE.match(name) else ""


def _check_expression(program: Program, value: sp.Basic, bound: dict[str, sp.Symbol]) -> None:
    for name in names_in(value):
        found = bound.get(name.name)
        if found is not name and found != name:  # the same symbol, nearly always: SymPy compares slowly
            _refuse_name(program, value, bound)
    if strange := _strange_part(value):
        raise BrokenProgram(f"{program.name}: {strange}")


def _refuse_name(program: Program, value: sp.Basic, bound: dict[str, sp.Symbol]) -> None:
    """Raise an error for the first name that is not bound, or is bound with another type."""
    for node in sp.preorder_traversal(value):
        if isinstance(node, sp.Symbol) and node.name not in bound:
            message = f"{program.name}: {node.name!r} is read before it is bound, in {value}"
            raise RepeatedName(message, *(name.name for name in program.bound()))  # one of them may be an input, too
        if isinstance(node, sp.Symbol) and bound[node.name] != node:
            message = f"{program.name}: {node.name!r} is read as another type than it is bound, in {value}"
            raise RepeatedName(message, node.name)


@cache
def _strange_part(value: sp.Basic) -> str:
    """A description of the part of an expression that no language can print; empty if every part can be printed."""
    for node in sp.preorder_traversal(value):
        if isinstance(node, sp.Pow) and not bool(node.exp.is_Integer):
            return f"power {node} is not an integer power"
        if not isinstance(node, _ARITHMETIC + _LOGIC + PRIMITIVES) and not is_decided(node):
            return f"{type(node).__name__} is not a primitive, in {value}"
    return ""
