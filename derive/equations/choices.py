"""Flags and signs of a machine: equations calculate with 0 and 1, and with -1 and 1; programs choose, and convert to
numbers.

x (1 - swap) + y swap     →  select(swap, y, x)
z + h (1 - 2 down)        →  z + h select(down, -1, 1)
a x (1 - swap) + a y swap →  a select(swap, y, x)
direction a               →  to_real(direction) a          where the machine is set up; elsewhere it is a number by then
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import sympy as sp
from sympy.core.relational import Relational

from derive.description.mechanism import Parameter, Role
from derive.ir.passes import with_inputs
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Output, Program, Statement, rewritten, shared
from derive.ir.symbols import count, flag, real

_NAMED = {Role.FLAG: flag, Role.SIGN: count}


def input_of(parameter: Parameter) -> sp.Symbol:
    """The name of a parameter as the setup reads it: a flag is a Boolean there, a sign an integer."""
    return _NAMED.get(parameter.role, real)(parameter.name)


def with_choices(program: Program, parameters: Sequence[Parameter]) -> Program:
    """The program with a choice in place of every calculation with a flag of the machine; so in those it calls."""
    called = {p.name: with_choices(p, parameters) for p in shared([program])}
    program = replace(program, body=tuple(s.calling(called) for s in program.body))
    for name in (p.name for p in parameters if p.role is Role.FLAG):
        if real(name) in program.inputs:
            body = tuple(rewritten(s, partial(_chosen, name=name)) for s in program.body)
            outputs = tuple(Output(o.name, _chosen(o.value, name)) for o in program.outputs)
            program = with_inputs(replace(program, body=body, outputs=outputs))
    return program


def converted(statement: Statement, parameters: Sequence[Parameter]) -> Statement:
    """A statement of the setup, with its flags as conditions and its signs as numbers."""
    signs = {real(p.name): ToReal(count(p.name)) for p in parameters if p.role is Role.SIGN}
    return rewritten(statement, lambda e: _with_signs(e, signs, parameters))


def _with_signs(value: sp.Basic, signs: Mapping[sp.Symbol, sp.Expr], parameters: Sequence[Parameter]) -> sp.Basic:
    for name in (p.name for p in parameters if p.role is Role.FLAG):
        value = _chosen(value, name)
    return value.xreplace(dict(signs))


def _chosen(value: sp.Basic, name: str) -> sp.Basic:
    """The value with a choice in place of the terms, or of the factor, that calculate with a flag."""
    number = real(name)
    if number not in value.free_symbols:
        return value
    if value == number or (value.is_Mul and number in value.args):
        return _choice(value, name)
    if isinstance(value, Relational):
        return _asked(value, name)
    if value.is_Add:
        own = [term for term in value.args if number in term.free_symbols]
        parts = sp.Add(*(term for term in value.args if term not in own), _choice(sp.Add(*own), name))
        whole = _choice(value, name)
        return whole if sp.count_ops(whole) <= sp.count_ops(parts) else parts
    return value.func(*(_chosen(argument, name) for argument in value.args))


def _asked(value: Relational, name: str) -> sp.Basic:
    """A comparison; if the flag alone decides it, the flag itself or its negation."""
    holds, fails = (value.xreplace({real(name): sp.Integer(number)}) for number in (1, 0))
    if holds == fails or {holds, fails} == {sp.true, sp.false}:
        return holds if holds == fails else flag(name) if holds == sp.true else sp.Not(flag(name))
    return value.func(*(_chosen(side, name) for side in value.args))


def _choice(value: sp.Expr, name: str) -> sp.Expr:
    """A choice between the value with the flag set and without; common factors stand before the choice."""
    holds, fails = (value.xreplace({real(name): sp.Integer(number)}) for number in (1, 0))
    if holds == 0 or fails == 0:
        return Select(flag(name), holds, fails)
    factors = sp.Mul(*(f for f in sp.Mul.make_args(holds) if f in sp.Mul.make_args(fails)))
    return factors * Select(flag(name), holds / factors, fails / factors)
