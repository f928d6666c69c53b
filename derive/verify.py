"""The verifier of the intermediate representation: run after every pass, it finds a broken program at once."""

from __future__ import annotations

import re

import sympy as sp

from derive.program import DEGREE, PRIMITIVES, Let, Program

_PORTABLE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")
_ARITHMETIC = (sp.Add, sp.Mul, sp.Pow, sp.Symbol, sp.Rational, sp.Float, sp.Integer)
_LOGIC = (sp.Le, sp.Lt, sp.Ge, sp.Gt, sp.And, sp.Or)


class BrokenProgram(Exception):
    """A program that no language may print; the message names the program and the place."""


def verify(program: Program) -> Program:
    """Return the program, or raise `BrokenProgram`: unbound or repeated name, unportable name, unknown primitive."""
    bound = {s.name for s in program.inputs} | {DEGREE.name}
    spelled: dict[str, str] = {}
    for name in [s.name for s in program.inputs] + [let.name.name for let in program.lets()]:
        _check_name(program, name, spelled)
    for statement in program.body:
        value = statement.value if isinstance(statement, Let) else statement.condition
        _check_expression(program, value, bound)
        if isinstance(statement, Let):
            bound.add(statement.name.name)
    for output in program.outputs:
        _check_expression(program, output.value, bound)
    return program


def _check_name(program: Program, name: str, spelled: dict[str, str]) -> None:
    if not _PORTABLE.match(name):
        raise BrokenProgram(f"{program.name}: {name!r} is not a portable snake_case name")
    key = name.replace("_", "")  # Structured Text joins the words and ignores case
    if key in spelled:
        raise BrokenProgram(f"{program.name}: {name!r} is bound twice (also as {spelled[key]!r})")
    spelled[key] = name


def _check_expression(program: Program, value: sp.Basic, bound: set[str]) -> None:
    for node in sp.preorder_traversal(value):
        if isinstance(node, sp.Symbol) and node.name not in bound:
            raise BrokenProgram(f"{program.name}: {node.name!r} is read before it is bound, in {value}")
        if isinstance(node, sp.Pow) and not _is_power_printable(node):
            raise BrokenProgram(f"{program.name}: power {node} is not an integer power")
        if not isinstance(node, _ARITHMETIC + _LOGIC + PRIMITIVES) and node not in (sp.true, sp.false):
            raise BrokenProgram(f"{program.name}: {type(node).__name__} is not a primitive, in {value}")


def _is_power_printable(node: sp.Pow) -> bool:
    return bool(node.exp.is_Integer)
