"""The repair of the commanded rotation in Python: one function on plain numbers, with the reason of a refusal, and one
on arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from derive.emit.interface import rotation_entry
from derive.emit.python.arrays import CALLED, TYPES, array_body, named_in
from derive.emit.python.methods import ROTATION_ARGUMENT
from derive.emit.python.printer import ScalarPrinter, primitives_in
from derive.emit.python.program import Method, scalar_body
from derive.emit.python.refusal import explained
from derive.equations.rotation_repair import rotation_program, surely_exact
from derive.ir.passes import without_reasons
from derive.report.reasons import reasons_of_rotation


def rotation_functions() -> dict[str, object]:
    """The values that the templates read: the bodies of both functions, and the names that they call."""
    entry = rotation_entry()
    method = Method(
        "made_rotation", entry.summary, entry.program, (ROTATION_ARGUMENT,), "Rotation", ROTATION_ARGUMENT.shape
    )
    plain = _with_shortcut(scalar_body(method, explained(reasons_of_rotation())))
    arrays = array_body(replace(method, program=without_reasons(method.program)))
    return {
        "plain": plain,
        "primitives": primitives_in(plain),
        "arrays": arrays,
        "helpers": sorted(named_in(arrays, CALLED | TYPES), key=lambda n: (n[0].islower(), n)),
    }


def _with_shortcut(lines: Sequence[str]) -> list[str]:
    """The lines, with an early return for an exact rotation, as nearly every call has, in front of the first value."""
    first = rotation_program().lets()[0].name.name
    place = next(k for k, line in enumerate(lines) if line.startswith(f"{first} = "))
    conditions = " and ".join(map(ScalarPrinter().print, surely_exact()))
    shortcut = [f"if {conditions}:", f"    return {ROTATION_ARGUMENT.name}"]
    return [*lines[:place], *shortcut, *lines[place:]]
