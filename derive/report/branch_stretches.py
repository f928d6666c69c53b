"""Stretches of a branch: values that depend on some signs alone are equal in all branches that share these signs.

A language that solves one branch after the other keeps the values of a stretch for the next branch: a delta then solves
each leg twice, not eight times. Statements keep their order, except that one without a division moves up to the first
stretch with the same signs behind the values that it reads, which is allowed because a program is total.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.primitives import ToReal
from derive.ir.program import Call, Let, Program, Require, reason_expressions
from derive.ir.symbols import is_branch_sign, names_in
from derive.ir.tree import If, Item, bound_in, expressions_in, given_to, read_in
from derive.ir.types import Type, type_of
from derive.kept import kept_by_identity
from derive.lowering.passes import structured

MOST_SIDES, MOST_KEPT = 16, 80
"""The most that branches can share: stretches, one for every side of their signs, and values."""


@dataclass(frozen=True)
class Stretch:
    """Consecutive statements of a branch."""

    items: tuple[Item, ...]
    signs: tuple[sp.Symbol, ...]
    """The signs on which they depend, in the order of the inputs."""
    kept: tuple[sp.Symbol, ...]
    """Where branches share the stretch, the values that the rest reads; nothing if they do not."""
    is_shared: bool

    @property
    def sides(self) -> int:
        """How many times it is computed for all branches together."""
        return int(2 ** len(self.signs))


@kept_by_identity(50)
def stretches_of(program: Program) -> tuple[Stretch, ...]:
    """The stretches of a branch; one that is not shared if there is nothing to share."""
    items = structured(program)
    signs = tuple(s for s in program.inputs if is_branch_sign(s))
    if len(items) < 2 or not signs or not all(isinstance(i, Let | Require | If) or _is_rare(i) for i in items):
        return (Stretch(items, signs, (), is_shared=False),)
    groups = _groups(items, signs)
    wanted = {s for o in program.outputs for s in names_in(o.value)}
    found: list[Stretch] = []
    for supported, group in reversed(groups):
        is_shared = len(supported) < len(signs) and any(map(_computes, expressions_in(group)))
        kept = tuple(name for name in bound_in(group) if name in wanted) if is_shared else ()
        if not all(type_of(name) in (Type.REAL, Type.ANGLE, Type.BOOL) for name in kept):
            is_shared, kept = False, ()
        found.insert(0, Stretch(tuple(group), tuple(s for s in signs if s in supported), kept, is_shared))
        wanted |= read_in(group).union(*map(_read_by_reason, group))
    return tuple(_with_room(found))


def _is_rare(item: Item) -> bool:
    """Whether a statement calls a program in rare cases alone; it is no part of what branches share."""
    return isinstance(item, Call) and item.is_rare


def _with_room(stretches: Iterable[Stretch]) -> Iterator[Stretch]:
    """The stretches; a stretch is shared only while there is room for its values."""
    sides = kept = 0
    for stretch in stretches:
        more = sides + stretch.sides, kept + stretch.sides * len(stretch.kept)
        if stretch.is_shared and more[0] <= MOST_SIDES and more[1] <= MOST_KEPT:
            sides, kept = more
            yield stretch
        else:
            yield replace(stretch, kept=(), is_shared=False)


def _groups(items: Sequence[Item], signs: Sequence[sp.Symbol]) -> list[tuple[frozenset[sp.Symbol], list[Item]]]:
    """The statements by the signs on which they depend, one stretch after the other."""
    support: dict[sp.Symbol, frozenset[sp.Symbol]] = {s: frozenset({s}) for s in signs}
    place: dict[sp.Symbol, int] = {}
    groups: list[tuple[frozenset[sp.Symbol], list[Item]]] = []
    for item in items:
        needed = given_to((item,)) | _read_by_reason(item)
        own = frozenset[sp.Symbol]().union(*(support.get(name, frozenset()) for name in needed))
        first = max((place[name] for name in needed if name in place), default=0)
        earlier = [k for k in range(first, len(groups)) if groups[k][0] == own and _may_move(item, groups[k + 1 :])]
        if earlier:
            at = earlier[0]
        elif groups and groups[-1][0] == own:
            at = len(groups) - 1
        else:
            groups.append((own, []))
            at = len(groups) - 1
        groups[at][1].append(item)
        for name in bound_in((item,)):
            support[name], place[name] = own, at
    return groups


def _read_by_reason(item: Item) -> set[sp.Symbol]:
    """The names that the reason of a refusal reads."""
    return {s for value in reason_expressions(item) for s in names_in(value)} if isinstance(item, Require) else set()


def _may_move(item: Item, groups: Sequence[tuple[frozenset[sp.Symbol], list[Item]]]) -> bool:
    """Whether a statement may stand before these groups: it does not refuse, and divides by nothing that a refusal in
    them may keep from zero.
    """
    if not groups:
        return True
    powers = (power for e in expressions_in((item,)) for power in e.atoms(sp.Pow))
    divides = any(power.exp.is_negative and power.base != DEGREE for power in powers)
    return not _refuses(item) and not (divides and any(_refuses(i) for _, group in groups for i in group))


def _refuses(item: Item) -> bool:
    return isinstance(item, Require | Call)


def _computes(expression: sp.Basic) -> bool:
    """Whether an expression takes operations, and is not merely a choice, or a sign as a number."""
    return bool(expression.atoms(sp.Add, sp.Mul, sp.Pow, sp.Function) - expression.atoms(ToReal))
