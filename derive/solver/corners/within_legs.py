"""Within the legs of a later step: a root near zero is no longer than what the later step can hold.

A later step turns an arm (leg, d) to the commanded distance H: see `subproblems/other_leg`. It has a solution for
|d| <= H. Where the machine is nearly stretched, H is small, and d is a multiple of the root of an earlier step, which
has half of its digits there: d may be beyond H by far more than rounding. Then the root takes the value at which
|d| = H, if neither is more than rounding for the equation of its own step, in which its square stands.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.equations.problem import StepDeterminant
from derive.ir.constants import ROUNDING
from derive.ir.passes import needed_lets
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Statement, binds
from derive.ir.symbols import real, sine


def within_legs(statements: Sequence[Statement], determinants: Sequence[StepDeterminant]) -> tuple[Statement, ...]:
    """The derivation with the sine of every two-root step, near zero, no larger than a later step can hold."""
    found = list(statements)
    for later in determinants:
        for step in determinants:
            if later.beside is not None and step is not later:
                found = _limited(found, step, later.step, later.beside)
    return tuple(found)


def _limited(
    statements: list[Statement], step: StepDeterminant, later: sp.Symbol, beside: tuple[sp.Expr, sp.Expr]
) -> list[Statement]:
    """The statements with the sine of a step limited; as they are where d is no multiple of it."""
    root = sine(step.step)
    lets = {s.name: s for s in statements if isinstance(s, Let)}
    own = lets.get(root)
    if own is None or not own.value.has(Root) or step.sigma not in own.value.free_symbols:
        return statements
    size, value = beside
    place = statements.index(own)
    earlier = {name for s in statements[:place] for name in binds(s)}
    rate = sp.diff(_written_out(value, lets, {*earlier, root}), root)
    needed = needed_lets((let for let in lets.values() if let.name not in earlier), [size])
    read = set().union(*(let.value.free_symbols for let in needed), rate.free_symbols)
    if rate == 0 or read & (lets.keys() - earlier - {let.name for let in needed}):
        return statements
    before, rest = statements[:place], [s for s in statements[place + 1 :] if s not in needed]
    return [*before, *needed, *_limit(own, later, size, rate), *rest]


def _written_out(value: sp.Expr, lets: dict[sp.Symbol, Let], kept: set[sp.Symbol]) -> sp.Expr:
    """The value by names that are known where the sine is bound, and by the sine."""
    while names := (value.free_symbols & lets.keys()) - kept:
        value = value.xreplace({name: lets[name].value for name in names})
    return value


def _limit(own: Let, later: sp.Symbol, size: sp.Expr, rate: sp.Expr) -> tuple[Let, ...]:
    """The sine as its step gives it, and no larger than the later step can hold."""
    word = f"{own.name.name}_for_{later.name}"
    before, share, divisor = (
        real(f"{own.name.name}_before_{later.name}"),
        real(f"share_of_{word}"),
        real(f"size_{word}"),
    )
    taken = real(f"taken_by_{word}")
    is_beyond = sp.And(sp.Gt(taken, size), sp.Le((taken - size) * (taken + size), ROUNDING * rate**2))
    return (
        replace(own, name=before),
        Let(taken, sp.Abs(rate * before)),
        Let(divisor, Select(is_beyond, taken, sp.Integer(1))),
        Let(share, Select(is_beyond, size / divisor, sp.Integer(1)), f"near zero {later.name} holds no more of it"),
        Let(own.name, share * before),
    )
