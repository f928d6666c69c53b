"""Common parts: what several statements of a straight line compute alike is computed once, under a name that says what it is.

    c_down = p * c - q * s,  c_up = p * c + q * s                →  p_times_c = p * c,  q_times_s = q * s, …
    first = x * c + y * s - a * u,  second = x * c + y * s + b   →  the sum x * c + y * s, once
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import sympy as sp

from derive.ir.names import Names
from derive.ir.passes import assemble
from derive.ir.primitives import (
    Select,
)
from derive.ir.program import (
    Let,
    Program,
    Statement,
)
from derive.ir.symbols import (
    real,
    symbols_of,
)
from derive.optimize.constant_parts import without_sign, words
from derive.optimize.unroll import Sign, without_words

_READABLE = re.compile(r"(?=.{1,60}$)[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")


def common_parts(program: Program, signs: Sequence[Sign], constants: frozenset[str]) -> Program:
    """The program, unrolled by signs, with its common sums and products under names, but for those of constants alone."""
    taken = Names.of(program)
    while True:
        found = _most_common(program, constants)
        if not found:
            return program
        bound = {let.value: let.name for let in program.lets()}
        names = {p: bound.get(p) or _negative(bound.get(-p)) or _name(p, user, signs, taken) for p, user in found.items()}
        program = _with_names(program, names)


def _most_common(program: Program, constants: frozenset[str]) -> dict[sp.Expr, sp.Symbol]:
    """The parts that most statements share, none of which overlaps another, with who reads each first."""
    users: dict[sp.Expr, list[sp.Symbol]] = {}
    for let in program.lets():
        for part in dict.fromkeys(_parts(let.value)):
            users.setdefault(part, []).append(let.name)
    shared = {p: names for p, names in users.items() if len(names) > 1 and not {s.name for s in symbols_of(p)} <= constants}
    kept: dict[sp.Expr, sp.Symbol] = {}
    touched: set[sp.Symbol] = set()
    for part, names in sorted(shared.items(), key=lambda item: (not item[0].is_Add, -len(item[1]))):
        if not touched & set(names):
            kept[part] = names[0]
            touched |= set(names)
    return kept


def _parts(value: sp.Expr) -> Iterator[sp.Expr]:
    """What could be shared: two terms of a sum of more, and the products of names that are terms."""
    if isinstance(value, Select | sp.Mul):
        for inner in value.args[isinstance(value, Select) :]:
            yield from _parts(inner)
        return
    terms = sp.Add.make_args(value)
    if len(terms) > 2:
        for first, second in combinations(terms, 2):
            if not (first.is_number or second.is_number):
                yield without_sign(first + second)
    for term in terms:
        product = without_sign(term)
        if len(terms) > 1 and product.is_Mul and sum(not f.is_number for f in product.args) > 1:
            yield product


def _negative(name: sp.Symbol | None) -> sp.Expr | None:
    return None if name is None else -name


def _with_names(program: Program, names: Mapping[sp.Expr, sp.Expr]) -> Program:
    body: list[Statement] = []
    for statement in program.body:
        if isinstance(statement, Let):
            value = statement.value
            for part, name in names.items():
                value = _read(value, part, name)
            statement = replace(statement, value=value)
        body.append(statement)
    parts = [Let(name, part) for part, name in names.items() if name.is_Symbol and name not in program.bound()]
    return assemble(program.name, [*parts, *body], program.outputs)


def _read(value: sp.Expr, part: sp.Expr, name: sp.Expr) -> sp.Expr:
    """The value with the part by its name."""
    if isinstance(value, Select | sp.Mul):
        return value.func(*(_read(a, part, name) if isinstance(a, sp.Expr) else a for a in value.args))
    terms, wanted = list(sp.Add.make_args(value)), sp.Add.make_args(part)
    for sign in (1, -1):
        signed = [sign * term for term in wanted]
        if all(term in terms for term in signed) and len(terms) > len(signed):
            return sp.Add(sign * name, *[term for term in terms if term not in signed])
    return value


def _name(part: sp.Expr, user: sp.Symbol, signs: Sequence[Sign], taken: Names) -> sp.Symbol:
    """`a_times_b_front` of `a` and `b_front`; what is too long to say is a part of its first user."""
    stems = {s: real(without_words(s.name, signs)[0]) for s in part.free_symbols}
    said, behind = words(part.xreplace(stems)), {w for s in part.free_symbols for w in without_words(s.name, signs)[1]}
    if not _READABLE.match(said):
        said, behind = f"part_of_{without_words(user.name, signs)[0]}", set(without_words(user.name, signs)[1])
    return taken.fresh("_".join([said, *(word for sign in signs for word in sign.words if word in behind)]))
