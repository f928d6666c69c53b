"""A choice in a program on arrays: its first side for all rows, its second side for the rows that are on it.

    def elsewhere_cos_q1(ref_a1: Real) -> Reals:
        free_a1 = (ref_a1 - offset_a1)*DEGREE
        cos_q1 = cos(free_a1)
        sin_q1 = sin(free_a1)
        return cos_q1, sin_q1

    cos_q1 = along_q1/length_q1
    sin_q1 = across_q1/length_q1
    cos_q1, sin_q1 = elsewhere(length_q1 > 1e-11, (cos_q1, sin_q1), elsewhere_cos_q1, (ref_a1,))

Programs are total, so that the first side does no harm in rows that are on the second, which are few as a rule.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence

import sympy as sp

from derive.emit.python.layout import fold, taken_apart, tuple_of
from derive.emit.python.printer import ScalarPrinter, spelled
from derive.ir.program import (
    Let,
    Statement,
    binds,
    reads,
)
from derive.ir.symbols import (
    Flag,
    is_count,
    symbols_of,
)
from derive.optimize.control_flow import Arms, Item


def array_arm_lines(
    arms: Arms, constants: Collection[sp.Symbol], lines: Callable[[Item], list[str]], printer: ScalarPrinter
) -> list[str]:
    """The choice. constants: what is the same in all rows, so that a choice that only they decide is made once."""
    holds, fails = ([line for item in side for line in lines(item)] for side in (arms.holds, arms.fails))
    condition, results = printer.print(arms.condition), [spelled(name.name) for name in arms.names]
    if symbols_of(arms.condition) <= set(constants):
        declared = [f"{spelled(name.name)}: {_kind(name)}" for name in arms.names]
        return [*declared, *fold(f"if {condition}:"), *_indented(holds), "else:", *_indented(fails)]
    kinds = {spelled(s.name): _kind(s) for s in sorted(_read(arms.fails) - set(constants), key=lambda s: spelled(s.name))}
    function, answer = _unused(f"elsewhere_{results[0]}", holds), tuple_of(results)
    return [
        "",
        *fold(f"def {function}({', '.join(f'{name}: {kind}' for name, kind in kinds.items())}) -> Reals:"),
        *_indented([*fails, *fold(f"return {answer}")]),
        "",
        *holds,
        *taken_apart(results, f"elsewhere({condition}, {answer}, {function}, {tuple_of(list(kinds))})"),
    ]


def _kind(name: sp.Symbol) -> str:
    """What a name is in rows."""
    return "Truth" if isinstance(name, Flag) else "Whole" if is_count(name) else "Real"


def _unused(function: str, holds: Sequence[str]) -> str:
    """A name that no choice on the first side has: it would take the place of this one before it is called."""
    number, found = 1, function
    while any(line.startswith(f"def {found}(") for line in holds):
        number += 1
        found = f"{function}_{number}"
    return found


def fixed(body: Iterable[Statement], constants: Iterable[sp.Symbol]) -> set[sp.Symbol]:
    """What is the same in all rows: constants, and what is computed from nothing else."""
    found = set(constants)
    for statement in body:
        if isinstance(statement, Let) and symbols_of(statement.value) <= found:
            found.add(statement.name)
    return found


def _read(items: Sequence[Item]) -> set[sp.Symbol]:
    """What statements read that they do not bind."""
    found, bound = set[sp.Symbol](), set[sp.Symbol]()
    for item in items:
        read = symbols_of(item.condition) | _read(item.holds) | _read(item.fails) if isinstance(item, Arms) else reads(item)
        found |= read - bound
        bound |= set(item.names if isinstance(item, Arms) else binds(item))
    return found


def _indented(lines: list[str]) -> list[str]:
    return [f"    {line}" for line in lines]
