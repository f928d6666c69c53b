"""The repair of the commanded rotation in Python: one function on plain numbers, with the reason of a refusal, and one
on arrays."""

from __future__ import annotations

from dataclasses import replace

from derive.emit.python.arrays import CALLED, TYPES, array_body, named_in
from derive.emit.python.methods import ROTATION, ROTATION_ARGUMENT
from derive.emit.python.printer import primitives_in
from derive.emit.python.program import Method, scalar_body
from derive.emit.python.refusal import explained
from derive.equations.rotation_repair import rotation_program
from derive.ir.passes import untold
from derive.report.reasons import reasons_of_rotation


def rotation_functions() -> dict[str, object]:
    """The values that the templates read: the bodies of both functions, and the names that they call."""
    summary = "The rotation as it is used."
    method = Method("made_rotation", summary, rotation_program(), (ROTATION_ARGUMENT,), "Rotation", ROTATION)
    plain = scalar_body(method, explained(reasons_of_rotation()))
    arrays = array_body(replace(method, program=untold(method.program)))
    return {
        "plain": plain,
        "primitives": primitives_in(plain),
        "arrays": arrays,
        "helpers": sorted(named_in(arrays, CALLED | TYPES), key=lambda n: (n[0].islower(), n)),
    }
