"""A program as the body of a Python method on arrays: a statement computes all rows at once, a refusal is a mask."""

from __future__ import annotations

from collections.abc import Collection, Iterable

import sympy as sp

from derive.emit.python import calls
from derive.emit.python.control_flow import array_arm_lines, fixed
from derive.emit.python.layout import note_lines
from derive.emit.python.loops import array_end, array_head
from derive.emit.python.printer import ArrayPrinter, words
from derive.emit.python.program import Method, binding_lines, constants_of, has_search, step_lines, unpacked, values_of
from derive.ir.primitives import FUNCTIONS, KEYS, NearestPeriod
from derive.ir.program import Call, FindRoot, Iterate, Let, Require, Solve
from derive.ir.symbols import START_POSITION, START_ROTATION
from derive.ir.tree import If, Item, Tree, grouped
from derive.kinematics.kinematics import Kinematics
from derive.lowering.passes import ARRAYS, NOTHING, UNCONVERTED, applied

OF_A_SEARCH = 120_000
"""The number of values for one row of a root scan, whose trials are computed together: measured."""
CALLED = frozenset(ArrayPrinter.function(KEYS[one]) for one in FUNCTIONS) | {
    "DEGREE", "advanced", "degrees", "elsewhere", "initial", "opposite", "passed", "reasonable", "require", "run_where",
    "settled", "solve", "sqrt",
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
            lines += [*array_head(item, printer), *step_lines(item, printer), *array_end(item, printer)]
        elif isinstance(item, Call):
            lines += calls.array_lines(item, printer)
        elif isinstance(item, FindRoot):
            lines += calls.array_search(item, printer)
        elif isinstance(item, Require):
            condition = sp.And(*(r.condition for r in same))
            notes = [line for note in dict.fromkeys(r.comment for r in same) for line in note_lines(note)]
            lines += [*notes, f"require(status, {printer.print(condition)}, Status.{item.otherwise.name})"]
        else:
            lines += bound(item)
    return lines


def values_of_a_row(kin: Kinematics) -> int:
    """The number of values of one row in the inverse: inputs, intermediate values, results. A program that every pose
    calls has its own values for every slot.
    """
    called = {s.program.name for s in kin.branch.body if isinstance(s, Call) and not s.is_rare}
    programs = [(kin.branch, 1), *((p, 2 ** len(kin.branches) if p.name in called else 1) for p in kin.shared)]
    own = sum(slots * (len(p.inputs) + len(p.bound())) for p, slots in programs)
    return own + OF_A_SEARCH * any(map(has_search, kin.shared))
