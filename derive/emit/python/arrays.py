"""A program as the body of a Python method on arrays: a statement computes all rows at once, a refusal is a mask."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence

import sympy as sp

from derive.emit.python import calls
from derive.emit.python.layout import note_lines, taken_apart, tuple_of
from derive.emit.python.printer import ArrayPrinter, ScalarPrinter, spelled, words
from derive.emit.python.program import (
    Method,
    array_end,
    array_head,
    binding_lines,
    constants_of,
    step_lines,
    unpacked,
    values_of,
)
from derive.ir.primitives import FUNCTIONS, KEYS, NearestPeriod
from derive.ir.program import Call, Iterate, Let, Program, Require, Solve, Statement
from derive.ir.symbols import START_POSITION, START_ROTATION, Flag, is_count, symbols_of
from derive.ir.tree import If, Item, Tree, given_to, grouped, read_in
from derive.kinematics.kinematics import Kinematics
from derive.lowering.passes import ARRAYS, NOTHING, UNCONVERTED, applied

CALLED = frozenset(ArrayPrinter.function(KEYS[one]) for one in FUNCTIONS) | {
    "DEGREE", "FEW_SEARCHES", "advanced", "degrees", "elsewhere", "initial", "opposite", "passed", "reasonable",
    "require", "settled", "solve", "sqrt",
}  # fmt: skip
"""The functions that programs on arrays call."""
TYPES = frozenset((
    "Codes", "Matrix", "Real", "Reals", "Rotation", "Signs", "Truth", "Turns", "Values", "Vector", "Whole",
))  # fmt: skip
"""The types that programs on arrays name."""


def named_in(lines: Iterable[str], names: Collection[str]) -> set[str]:
    """The given names that occur in the statements."""
    return words(lines) & set(names)


def array_body(method: Method) -> list[str]:
    """The body on arrays. The status of a row is that of its first condition that does not hold."""
    constants = constants_of(method)
    lines = _statements(method, constants)
    values = values_of(method, ArrayPrinter(constants))
    if method.is_shared:
        return [*lines, f"return {values}"]
    return [*lines, f"return {values}, status" if values else "return status"]


def _statements(method: Method, constants: Collection[str]) -> list[str]:
    printer, turns = ArrayPrinter(constants), ArrayPrinter(constants, modulo_turns=True)
    lines = [*unpacked(method), *(["k = self.constants"] if constants else [])]
    if not method.is_shared:
        lines.append(f"status = passed({', '.join(a.name for a in method.arguments)})")
    program = applied(UNCONVERTED, method.program, NOTHING)
    read = {s for statement in program.body for s in statement.reads() if s.name in constants}
    alike = fixed(program.body, read - {*START_POSITION, *START_ROTATION})

    def bound(item: Item) -> list[str]:
        if isinstance(item, If):
            return array_arm_lines(item, alike, bound, printer)
        assert isinstance(item, Let | Solve)
        return binding_lines(
            item, turns if isinstance(item, Let) and isinstance(item.value, NearestPeriod) else printer
        )

    for item, same in grouped(applied(ARRAYS, Tree.of(program), NOTHING).items):
        if isinstance(item, Iterate):
            step = step_lines(item, printer, lambda call: calls.array_lines(call, printer))
            lines += [*array_head(item, printer), *step, *array_end(item, printer)]
        elif isinstance(item, Call):
            lines += calls.array_lines(item, printer)
        elif isinstance(item, Require):
            condition = sp.And(*(r.condition for r in same))
            notes = [line for note in dict.fromkeys(r.comment for r in same) for line in note_lines(note)]
            lines += [*notes, f"require(status, {printer.print(condition)}, Status.{item.otherwise.name})"]
        else:
            lines += bound(item)
    return lines


def values_of_a_row(kin: Kinematics) -> int:
    """The number of values of one row in the inverse: inputs, intermediate values, results, tables of linear equations.
    A program that every pose calls has its own values for every slot.
    """
    called = {c.program.name for c in kin.branch.calls() if not (c.is_rare and c in kin.branch.body)}
    programs = [(kin.branch, 1), *((p, 2 ** len(kin.branches) if p.name in called else 1) for p in kin.shared)]
    return sum(slots * (len(p.inputs) + len(p.bound()) + _in_tables(p)) for p, slots in programs)


def _in_tables(program: Program) -> int:
    """The number of values in the tables of its linear equations, those in loops as well."""
    steps = (s.step if isinstance(s, Iterate) else (s,) for s in program.body)
    return sum(len(s.children()) for step in steps for s in step if isinstance(s, Solve))


def array_arm_lines(
    arms: If, constants: Collection[sp.Symbol], lines: Callable[[Item], list[str]], printer: ScalarPrinter
) -> list[str]:
    """The choice: its first side for all rows, its second side for the rows that are on it, which usually are few.

        def elsewhere_cos_q1(ref_a1: Real) -> Reals: …
        cos_q1, sin_q1 = along_q1/length_q1, across_q1/length_q1
        cos_q1, sin_q1 = elsewhere(length_q1 > 1e-11, (cos_q1, sin_q1), elsewhere_cos_q1, (ref_a1,))

    Programs are total: the first side does no harm in other rows. Where nothing has to be computed on the second
    side, it is a value: `select(absolute(rate_q1) > 1e-12, excess_q1/rate_q1, 0.0)`.
    constants: the names with one value for all rows; a choice that only they decide is made once.
    """
    condition, results = printer.print(arms.condition), [spelled(name.name) for name in arms.names]
    if symbols_of(arms.condition) <= set(constants):
        holds, fails = ([line for item in side for line in lines(item)] for side in (arms.holds, arms.fails))
        declared = [f"{spelled(name.name)}: {_kind(name)}" for name in arms.names]
        return [*declared, f"if {condition}:", *_indented(holds), "else:", *_indented(fails)]
    comments = [line for comment in arms.comments for line in note_lines(comment)]
    (first, held), (second, other) = (_side(side, arms.names, printer) for side in arms.sides)
    if not second:
        first, held = _side(arms.sides[0], arms.names, printer, is_written_out=len(results) == 1)
        name, named = (condition, []) if len(results) == 1 else ("holds", [f"holds = {condition}"])
        chosen = [f"{r} = select({name}, {a}, {b})" for r, a, b in zip(results, held, other, strict=True)]
        return [*(line for item in first for line in lines(item)), *named, *comments, *chosen]
    holds = [line for item in first for line in lines(item)]
    fails = [line for item in second for line in lines(item)]
    kinds = {
        spelled(s.name): _kind(s) for s in sorted(given_to(arms.fails) - set(constants), key=lambda s: spelled(s.name))
    }
    function = _unused(f"elsewhere_{results[0]}", holds)
    return [
        "",
        f"def {function}({', '.join(f'{name}: {kind}' for name, kind in kinds.items())}) -> Reals:",
        *_indented([*fails, f"return {tuple_of(other)}"]),
        "",
        *holds,
        *comments,
        *taken_apart(results, f"elsewhere({condition}, {tuple_of(held)}, {function}, {tuple_of(list(kinds))})"),
    ]


def _side(
    items: list[Item], names: Sequence[sp.Symbol], printer: ScalarPrinter, *, is_written_out: bool = False
) -> tuple[list[Item], list[str]]:
    """The statements of a side, and its results: a value that has a name needs no other.

    is_written_out: whether a result that nothing else on the side reads stands where it is chosen.
    """
    results: list[str] = []
    for name in names:
        let = next((i for i in items if isinstance(i, Let) and i.name == name), None)
        others = [i for i in items if i is not let]
        is_short = let is not None and (let.value.is_Symbol or let.value.is_number)
        is_short |= is_written_out and let is not None and not isinstance(let.value, NearestPeriod)
        if let is not None and is_short and name not in read_in(others):
            items = others
            results.append(printer.value(name, let.value))
        else:
            results.append(spelled(name.name))
    return items, results


def _kind(name: sp.Symbol) -> str:
    """The type of a name on arrays."""
    return "Truth" if isinstance(name, Flag) else "Whole" if is_count(name) else "Real"


def _unused(function: str, holds: Sequence[str]) -> str:
    """A function name that no choice on the first side has: that would replace this function before its call."""
    number, found = 1, function
    while any(line.startswith(f"def {found}(") for line in holds):
        number += 1
        found = f"{function}_{number}"
    return found


def fixed(body: Iterable[Statement], constants: Iterable[sp.Symbol]) -> set[sp.Symbol]:
    """The names with one value for all rows: constants, and values computed from constants alone."""
    found = set(constants)
    for statement in body:
        if isinstance(statement, Let) and symbols_of(statement.value) <= found:
            found.add(statement.name)
    return found


def _indented(lines: list[str]) -> list[str]:
    return [f"    {line}" for line in lines]
