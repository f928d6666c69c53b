"""Passes over programs: fold aliases, order statements by use, hoist values that depend on parameters alone.

fold    Let(cos_s, cos_heading); … cos_s …                   →  … cos_heading …
order   a Let stands just before its first use; a Let that nothing reads disappears, and so does an unread result of a
        call; a value that only the amount of a reason reads is written out in it
hoist   Let(scale_a2, 2*link_length_1*link_length_2)         →  computed once, by `setup`
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.primitives import Root
from derive.ir.program import (
    Call,
    Iterate,
    Let,
    Output,
    Program,
    Require,
    Solve,
    Statement,
    reason_expressions,
    rewritten,
)
from derive.ir.reason import Unit
from derive.ir.symbols import POSITION, ROTATION_ENTRIES, Names, called, is_decided, names_in, replaced, symbols_of
from derive.ir.verify import RepeatedName, verify
from derive.kept import kept_by_identity


def normalise(name: str, statements: Iterable[Statement], outputs: Sequence[Output]) -> Program:
    """A verified program from statements in any order: symbols without assumptions, aliases folded, ordered, inputs
    found.
    """
    body, values = without_assumptions(statements), tuple(Output(o.name, plain(o.value)) for o in outputs)
    body, values = _fold(body, values)
    program = Program(name, (), written_out(_order(body, values), body), values)
    return with_inputs(program)


def with_inputs(program: Program) -> Program:
    """The program with its inputs recomputed, and verified."""
    inputs = tuple(sorted(program.reads(), key=lambda s: s.name))
    return verify(replace(program, inputs=inputs))


@cache
def plain(value: sp.Basic) -> sp.Expr:
    """The expression with symbols that have a type and no other assumptions, pi as 180 degrees, and square roots as
    `Root`.
    """
    names = {s: called(s.name, s) for s in value.free_symbols if s != DEGREE}
    named = value.xreplace(names) if any(s != name for s, name in names.items()) else value
    rooted = named
    if any(map(_is_square_root, named.atoms(sp.Pow))):
        rooted = named.replace(_is_square_root, lambda power: Root(power.base) ** sp.sign(power.exp))
    return rooted.subs(sp.pi, 180 * DEGREE) if rooted.has(sp.pi) else rooted


def _is_square_root(node: sp.Basic) -> bool:
    return isinstance(node, sp.Pow) and abs(node.exp) == sp.Rational(1, 2)


def without_assumptions(statements: Iterable[Statement]) -> tuple[Statement, ...]:
    """The statements with symbols that have a type and no other assumptions: what the solver knew
    of signs is dropped.
    """
    return tuple(renamed(rewritten(s, plain), lambda name: called(name.name, name)) for s in statements)


def renamed(statement: Statement, name: Callable[[sp.Symbol], sp.Symbol]) -> Statement:
    """The statement with the names that it binds changed."""
    return statement.with_names(name)


def _fold(body: Sequence[Statement], outputs: Sequence[Output]) -> tuple[tuple[Statement, ...], tuple[Output, ...]]:
    aliases: dict[sp.Symbol, sp.Expr] = {}
    kept = _without_aliases(body, aliases, {}, set())
    return tuple(kept), tuple(replace(o, value=replaced(o.value, aliases)) for o in outputs)


def _without_aliases(
    body: Sequence[Statement], aliases: dict[sp.Symbol, sp.Expr], bound: dict[sp.Symbol, sp.Expr], names: set[sp.Symbol]
) -> list[Statement]:
    kept: list[Statement] = []
    for s in body:
        if isinstance(s, Let):
            value = replaced(s.value, aliases)
            if bound.setdefault(s.name, s.value) != s.value:
                message = f"{s.name} is bound twice, to {bound[s.name]} and to {s.value}"
                raise RepeatedName(message, s.name.name)
            if s.name in aliases or s.name in names:
                continue  # the same Let again
            if value.is_Symbol or value.is_Number or is_decided(value):
                aliases[s.name] = value
                continue
        if isinstance(s, Iterate):
            inner = _without_aliases(s.step, aliases, bound, names)
            s = replace(s, step=tuple(i for i in inner if isinstance(i, Let | Solve | Call)))
        kept.append(_with_names(s, aliases))
        names |= set(s.bound())
    return kept


def _order(body: Sequence[Statement], outputs: Sequence[Output]) -> tuple[Statement, ...]:
    ordered = [_with_ordered_step(s) if isinstance(s, Iterate) else s for s in body]
    needed = needed_for(ordered, [o.value for o in outputs])
    read = {s for o in outputs for s in symbols_of(o.value)}.union(*(s.reads() for s in needed))
    return tuple(_with_read_names(s, read) for s in needed)


def _with_read_names(statement: Statement, read: set[sp.Symbol]) -> Statement:
    """A call, or a loop with calls, without the results that nothing reads."""
    if isinstance(statement, Call):
        return replace(statement, names=tuple(n for n in statement.names if n in read))
    if not isinstance(statement, Iterate) or not statement.calls():
        return statement
    inside = read.union(*map(names_in, (statement.done, *statement.following)), *(s.reads() for s in statement.step))
    step = (_with_read_names(s, inside) for s in statement.step)
    return replace(statement, step=tuple(s for s in step if isinstance(s, Let | Solve | Call)))


def _with_ordered_step(loop: Iterate) -> Iterate:
    step = needed_for(loop.step, [loop.done, *loop.following])
    return replace(loop, step=tuple(s for s in step if isinstance(s, Let | Solve | Call)))


def needed_for(body: Sequence[Statement], wanted: Sequence[sp.Basic]) -> tuple[Statement, ...]:
    """The statements that the wanted expressions need, each just before its first use; a statement that may refuse is
    kept.
    """
    sources = {name: s for s in body for name in s.bound()}
    order = {name: place for place, name in enumerate(sources)}
    done: list[Statement] = []
    begun: set[int] = set()

    def provide(statement: Statement) -> None:
        if id(statement) in begun:  # also in a cycle, which the verifier then refuses
            return
        begun.add(id(statement))
        need(statement.reads())
        done.append(statement)

    def need(symbols: set[sp.Symbol]) -> None:
        for name in sorted(symbols & order.keys(), key=order.__getitem__):  # in the order of the derivation
            provide(sources[name])

    for s in body:
        if not (s.is_straight and s.bound()):
            provide(s)
    for value in wanted:
        need(symbols_of(value))
    return tuple(done)


def depending_on(statements: Iterable[Statement], names: Collection[sp.Symbol]) -> dict[sp.Symbol, Let]:
    """The bindings whose values depend on names, by what they bind; bindings of these names are not among them."""
    found: dict[sp.Symbol, Let] = {}
    depending = set(names)
    for s in statements:
        if isinstance(s, Let) and s.name not in names and not depending.isdisjoint(names_in(s.value)):
            found[s.name] = s
            depending.add(s.name)
    return found


def needed_lets(lets: Iterable[Let], values: Iterable[sp.Expr]) -> tuple[Let, ...]:
    """The bindings that values need, in their given order."""
    wanted = {name for value in values for name in value.free_symbols}
    found: list[Let] = []
    for let in reversed(tuple(lets)):
        if let.name in wanted:
            wanted |= let.value.free_symbols
            found.append(let)
    return tuple(reversed(found))


def written_out(body: Sequence[Statement], known: Iterable[Statement]) -> tuple[Statement, ...]:
    """The statements; if a reason reads a name that is bound only later, its value stands in place of the name."""
    values = {s.name: s.value for s in known if isinstance(s, Let)}
    found: list[Statement] = []
    bound: set[sp.Symbol] = set()
    for s in body:
        found.append(with_bound_reason(s, bound, values))
        bound |= set(s.bound())
    return tuple(found)


def with_bound_reason(
    statement: Statement, bound: Container[sp.Symbol], values: Mapping[sp.Symbol, sp.Expr]
) -> Statement:
    """The statement with a reason that reads bound names alone; `values` holds the values of all other names."""
    if not isinstance(statement, Require) or statement.reason is None:
        return statement
    reason = statement.reason.rewritten(partial(_in_full, bound=bound, values=values))
    return statement if reason is statement.reason else replace(statement, reason=reason)


def _in_full(value: sp.Basic, bound: Container[sp.Symbol], values: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    for _ in values:  # no value depends on itself: as many replacements as values suffice
        unbound = {s: values[s] for s in symbols_of(value) if s in values and s not in bound}
        if not unbound:
            break
        value = value.xreplace(unbound)
    return value


@kept_by_identity(200)
def without_reasons(program: Program) -> Program:
    """The program for callers that get a status but no reason: nothing is computed for reasons."""
    if not any(next(reason_expressions(s), None) is not None for s in program.body):
        return program
    body = tuple(
        replace(s, reason=replace(s.reason, amount=None, unit=Unit.NONE, turns=()))
        if isinstance(s, Require) and s.reason
        else s
        for s in program.body
    )
    return with_inputs(replace(program, body=body))


def is_read_once(program: Program, name: sp.Symbol) -> bool:
    """Whether exactly one statement or output reads a name, and no reason does."""
    readers = sum(name in s.reads() for s in program.body) + sum(name in symbols_of(o.value) for o in program.outputs)
    return readers == 1 and not any(name in symbols_of(e) for s in program.body for e in reason_expressions(s))


def hoist(programs: Sequence[Program], constants: Iterable[str]) -> tuple[tuple[Program, ...], tuple[Let, ...]]:
    """The programs without the Lets that depend on constants alone, and these Lets, each value bound once.

    A program that others call comes before them.
    """
    known = set(constants)
    programs = [_with_constants_before_loops(program, known) for program in programs]
    commanded = {s.name for s in (*POSITION, *ROTATION_ENTRIES)}  # languages spell these as parts of a pose
    names_taken = Names(known | commanded | {name.name for p in programs for name in _varying(p, known)})
    by_value: dict[sp.Expr, sp.Symbol] = {}
    hoisted: list[Let] = []
    lowered: dict[str, Program] = {}
    for program in programs:
        names: dict[sp.Symbol, sp.Symbol] = {}
        body: list[Statement] = []
        for s in program.body:
            if not isinstance(s, Let):
                body.append(_with_names(s.calling(lowered), names))
                continue
            value = replaced(s.value, names)
            if not {v.name for v in symbols_of(value)} <= known:
                body.append(replace(s, value=value))
                continue
            if value not in by_value:
                proposal = f"fixed_{s.name.name}" if s.name.name in commanded else s.name.name
                name = names_taken.fresh(proposal, s.name)
                known.add(name.name)
                by_value[value] = name
                hoisted.append(replace(s, name=name, value=value))
            names[s.name] = by_value[value]
        outputs = tuple(replace(o, value=replaced(o.value, names)) for o in program.outputs)
        lowered[program.name] = with_inputs(replace(program, body=tuple(body), outputs=outputs))
    return tuple(lowered.values()), tuple(hoisted)


def _with_constants_before_loops(program: Program, constants: set[str]) -> Program:
    """The program with the steps of its loops that depend on constants alone in front of these loops."""
    known, body = set(constants), list[Statement]()
    for s in program.body:
        step = s.step if isinstance(s, Iterate) else (s,)
        fixed = list[Let]()
        for let in (one for one in step if isinstance(one, Let)):
            if {v.name for v in symbols_of(let.value)} <= known:
                known.add(let.name.name)
                fixed.append(let)
        if isinstance(s, Iterate):
            body += fixed
            s = replace(s, step=tuple(one for one in s.step if one not in fixed))
        body.append(s)
    return replace(program, body=tuple(body))


def _with_names(statement: Statement, names: Mapping[sp.Symbol, sp.Expr]) -> Statement:
    return rewritten(statement, lambda e: replaced(e, names))


def _varying(program: Program, constants: set[str]) -> list[sp.Symbol]:
    """The names that depend on inputs other than constants."""
    own, constant = set(program.bound()), set[sp.Symbol]()
    for let in program.lets():
        if all(s in constant if s in own else s.name in constants for s in names_in(let.value)):
            constant.add(let.name)
    return [name for name in program.bound() if name not in constant]
