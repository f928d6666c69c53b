"""Passes over programs: fold aliases, order by need, hoist what depends on parameters alone.

fold    Let(cos_s, cos_heading); … cos_s …                   →  … cos_heading …
order   a Let stands just before its first use; one that nothing needs disappears
hoist   Let(scale_a2, 2*link_length_1*link_length_2)         →  computed once, by `setup`
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import sympy as sp

from derive.program import DEGREE, Let, Output, Program, Require, Root, Statement, real, symbols_of
from derive.verify import BrokenProgram, verify


def assemble(name: str, statements: Iterable[Statement], outputs: Sequence[Output]) -> Program:
    """A verified program from statements in any sensible order: bare names, folded, ordered, inputs found."""
    body, values = bare(statements), tuple(Output(o.name, _bare_expression(o.value)) for o in outputs)
    body, values = _fold(body, values)
    ordered = _order(body, values)
    program = Program(name, (), ordered, values)
    return with_inputs(program)


def with_inputs(program: Program) -> Program:
    """The program with its inputs recomputed, verified."""
    inputs = tuple(sorted(program.reads(), key=lambda s: s.name))
    return verify(replace(program, inputs=inputs))


def _bare_expression(value: sp.Basic) -> sp.Expr:
    """Symbols without assumptions of their own: in a program a name is a name. Pi is 180 degrees, a surd a root."""
    table = {s: real(s.name) for s in value.free_symbols if s != DEGREE}
    if any(_is_surd(power) for power in value.atoms(sp.Pow)):
        value = value.replace(_is_surd, lambda power: Root(power.base))
    return value.subs(sp.pi, 180 * DEGREE).xreplace(table) if value.has(sp.pi) else value.xreplace(table)


def _is_surd(value: sp.Basic) -> bool:
    return isinstance(value, sp.Pow) and value.is_number and value.exp == sp.Rational(1, 2)


def bare(statements: Iterable[Statement]) -> tuple[Statement, ...]:
    """The statements with plain names: in a program a name is a name, whatever the solver knew of its sign."""
    plain: list[Statement] = []
    for s in statements:
        if isinstance(s, Let):
            plain.append(replace(s, name=real(s.name.name), value=_bare_expression(s.value)))
        else:
            plain.append(replace(s, condition=_bare_expression(s.condition)))
    return tuple(plain)


def _fold(
    body: Sequence[Statement], outputs: Sequence[Output]
) -> tuple[tuple[Statement, ...], tuple[Output, ...]]:
    aliases: dict[sp.Symbol, sp.Expr] = {}
    bound: dict[sp.Symbol, sp.Expr] = {}
    kept: list[Statement] = []
    for s in body:
        if isinstance(s, Require):
            kept.append(replace(s, condition=s.condition.xreplace(aliases)))
            continue
        value = s.value.xreplace(aliases)
        if bound.setdefault(s.name, s.value) != s.value:
            raise BrokenProgram(f"{s.name} is bound twice, to {bound[s.name]} and to {s.value}")
        if s.name in aliases or s.name in {k.name for k in kept if isinstance(k, Let)}:
            continue  # the same Let again
        if value.is_Symbol or value.is_Number:
            aliases[s.name] = value
        else:
            kept.append(replace(s, value=value))
    return tuple(kept), tuple(replace(o, value=o.value.xreplace(aliases)) for o in outputs)


def _order(body: Sequence[Statement], outputs: Sequence[Output]) -> tuple[Statement, ...]:
    lets = {s.name: s for s in body if isinstance(s, Let)}
    done: dict[sp.Symbol, None] = {}
    ordered: list[Statement] = []

    def need(value: sp.Basic) -> None:
        wanted = [s for s in lets if s in symbols_of(value) and s not in done]  # in the order of the derivation
        for symbol in wanted:
            if symbol in done:
                continue
            done[symbol] = None
            need(lets[symbol].value)
            ordered.append(lets[symbol])

    for s in body:
        if isinstance(s, Require):
            need(s.condition)
            ordered.append(s)
    for o in outputs:
        need(o.value)
    return tuple(ordered)


def hoist(programs: Sequence[Program], constants: Iterable[str]) -> tuple[tuple[Program, ...], tuple[Let, ...]]:
    """The programs without the Lets that depend on constants alone, and these Lets, each value under one name."""
    known = set(constants)
    local = {let.name.name for p in programs for let in p.lets() if not _is_constant(let, p, known)}
    by_value: dict[sp.Expr, sp.Symbol] = {}
    hoisted: list[Let] = []
    lowered: list[Program] = []
    for program in programs:
        names: dict[sp.Symbol, sp.Symbol] = {}
        body: list[Statement] = []
        for s in program.body:
            if isinstance(s, Require):
                body.append(replace(s, condition=s.condition.xreplace(names)))
                continue
            value = s.value.xreplace(names)
            if not {v.name for v in symbols_of(value)} <= known:
                body.append(replace(s, value=value))
                continue
            if value not in by_value:
                name = _fresh(s.name, known | local)
                known.add(name.name)
                by_value[value] = name
                hoisted.append(Let(name, value, s.note))
            names[s.name] = by_value[value]
        outputs = tuple(replace(o, value=o.value.xreplace(names)) for o in program.outputs)
        lowered.append(replace(program, body=tuple(body), outputs=outputs))
    return tuple(with_inputs(p) for p in lowered), tuple(hoisted)


def _is_constant(let: Let, program: Program, constants: set[str]) -> bool:
    """Whether a Let depends on constants alone, through whatever Lets."""
    values = {s.name: s.value for s in program.lets()}
    pending = symbols_of(let.value)
    while pending:
        symbol = pending.pop()
        if symbol in values:
            pending |= symbols_of(values[symbol])
        elif symbol.name not in constants:
            return False
    return True


def _fresh(name: sp.Symbol, taken: set[str]) -> sp.Symbol:
    number, proposal = 1, name.name
    while proposal in taken:
        number += 1
        proposal = f"{name.name}_{number}"
    return real(proposal)
