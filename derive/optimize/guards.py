"""Guards: a condition that holds where a radicand is positive is tested only where the radicand is not positive.

if not square >= -tolerance:                          if square > 0:
    return                                                x = sqrt(square)*sigma
x = (sqrt(square) if square > 0 else 0)*sigma    →    else:
                                                          if not square >= -tolerance:
                                                              return
                                                          x = 0
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import sympy as sp

from derive.ir.primitives import Root
from derive.ir.program import Let, Require, Statement
from derive.ir.symbols import symbols_of
from derive.ir.tree import If, Item


class PositiveRoot(sp.Function):
    """The root of a radicand that is known to be positive."""

    nargs = 1
    is_nonnegative = True


def guarded(body: Sequence[Statement], constants: Iterable[Let] = ()) -> tuple[Item, ...]:
    """The statements with such conditions moved to where they can fail. constants: the bindings of constants that they
    read.
    """
    known = {let.name: let.value for let in constants}
    found: list[Item] = []
    done: set[Statement] = set()
    for place, statement in enumerate(body):
        root = _root_of(statement, body[place + 1 :], known) if isinstance(statement, Require) else None
        if isinstance(statement, Require) and root is not None:
            found.append(_choice(statement, root))
            done.add(root)
        elif statement not in done:
            found.append(statement)
    return tuple(found)


def _root_of(require: Require, later: Sequence[Statement], known: Mapping[sp.Basic, sp.Expr]) -> Let | None:
    """The statement that takes the root, if it can be computed where the condition is tested."""
    condition = require.condition
    if not isinstance(condition, sp.GreaterThan) or not condition.lhs.is_Symbol:
        return None
    bound = condition.rhs
    while symbols_of(bound) & known.keys():
        bound = bound.xreplace(known)
    if not _is_never_positive(bound):
        return None
    unknown = {name for statement in later for name in statement.bound()}
    takers = [s for s in later if isinstance(s, Let) and s.value.has(Root(condition.lhs))]
    if not takers or symbols_of(takers[0].value) & unknown:
        return None
    vanished = takers[0].value.xreplace({Root(condition.lhs): sp.Integer(0)})
    return None if vanished.has(sp.zoo, sp.nan) else takers[0]


def _choice(require: Require, root: Let) -> If:
    square = require.condition.args[0]
    positive, zero = (root.value.xreplace({Root(square): there}) for there in (PositiveRoot(square), sp.Integer(0)))
    return If(sp.Gt(square, 0), (replace(root, value=positive),), (require, replace(root, value=zero)), (root.name,))


def _is_never_positive(value: sp.Expr) -> bool:
    """Whether a value is a sum of squares with negative factors."""
    terms = [term.as_coeff_Mul() for term in sp.Add.make_args(value)]
    return all(
        factor <= 0 and all(part == 1 or (part.is_Pow and part.exp % 2 == 0) for part in sp.Mul.make_args(rest))
        for factor, rest in terms
    )
