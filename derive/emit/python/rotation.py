"""The commanded rotation in Python: one function on plain numbers, with the reason of a refusal, and one on arrays."""

from __future__ import annotations

from derive.emit.python.diagnosis import Explained
from derive.emit.python.methods import ROTATION, ROTATION_ARGUMENT
from derive.emit.python.printer import ARRAY_NAMES, array_helpers_in, primitives_in
from derive.emit.python.program import Method, array_body, scalar_body
from derive.equations.rotation_repair import rotation_program
from derive.report.reasons import reasons_of_rotation

_HELPERS = ("Real", "Reals", "elsewhere", "passed", "require", "root", "select", "sqrt", *ARRAY_NAMES.values())
"""What the function on arrays calls or names."""


def rotation_functions() -> dict[str, object]:
    """What the templates read: the bodies, and what they call."""
    summary = "The rotation as it is used."
    method = Method("made_rotation", summary, rotation_program(), (ROTATION_ARGUMENT,), "Rotation", ROTATION)
    plain = scalar_body(method, refusals=Explained(lambda status: f"Status.{status.name}", reasons_of_rotation()))
    arrays = array_body(method)
    return {
        "plain": plain,
        "primitives": primitives_in(line for line in plain if '"' not in line),
        "arrays": arrays,
        "helpers": sorted(array_helpers_in(arrays, _HELPERS), key=lambda n: (n[0].islower(), n)),
    }
