"""A wrong text is found out: each fault is planted into what is written, and the comparison with Python notices it."""

import pytest

from tests.c.programs import SANITIZED, compiled_with_a_fault, part_of
from tests.corpus.recording import read
from tests.javascript.comparison import differences
from tests.languages.language import C

pytestmark = pytest.mark.slow

ARM = "Kin_Scara4_ZCcoupled_Type1"
ELBOW = "Kin_ArticulatedRobot_6DOF"
SEARCHED = "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"
PLATE = "Softkin_Planar_3RRR"
FAULTS: dict[str, tuple[str, str, str, str]] = {
    "sign of a sum": (ARM, "scara4", r"link_length_1\*cos_a1 \+ k", "link_length_1*cos_a1 - k"),
    "sign of a branch": (ARM, "scara4", r"\*sign_elbow;", "*-sign_elbow;"),
    "sine for cosine": (ARM, "scara4", r"const double cos_a12 = cos", "const double cos_a12 = sin"),
    "entry of the Jacobian": (ARM, "scara4", r"rows\[15\] = 1", "rows[15] = -1"),
    "turn that is open": (ARM, "scara4", r"single_a1 \? k->mid_a1 : ref_a1", "single_a1 ? ref_a1 : k->mid_a1"),
    "limit": (ARM, "scara4", r"axis_a1 <= k->highest_a1", "axis_a1 >= k->highest_a1"),
    "reason": (ARM, "scara4", r"A2: out of reach", "A1: out of reach"),
    "unit": (ARM, "scara4", r"\"A2: out of reach\", \"u\"", '"A2: out of reach", "deg"'),
    "amount": (ARM, "scara4", r"axis_a3 - k->highest_a3", "k->highest_a3 - axis_a3"),
    "status": (ARM, "scara4", r"SOFTKIN_UNREACHABLE, \"A2: out", 'SOFTKIN_IMPOSSIBLE, "A2: out'),
    "order of bytes": (ARM, "scara4", r"PERIOD_AXES\[\] = \{3, 0, 1\}", "PERIOD_AXES[] = {0, 3, 1}"),
    "edge of a period": (ARM, "softkin", r"180\.0 \+ SOFTKIN_EDGE\)\)/360", "180.0 - SOFTKIN_EDGE))/360"),
    "choice by distance": (ARM, "softkin", r"distance < nearest -", "distance > nearest +"),
    "byte that means nothing": (ARM, "softkin", r"bytes\[i\] < 0 \|\| bytes\[i\] > 3", "bytes[i] < 0 || bytes[i] > 4"),
    "turn that is inside": (ARM, "softkin", r"turn >= 0\.0 \? turn \+ 1\.0 : turn", "turn"),
    "tolerance of limits": (ARM, "softkin", r"low - tolerance;\n  window->highest = is_w",
                            "low - 1.0;\n  window->highest = is_w"),
    "size of an array": (ARM, "softkin", r"axes\[slot\*kind->axis_count \+ i\]", "axes[slot*kind->axis_count + i + 4]"),
    "result of a refusal": (ARM, "softkin", r"status == SOFTKIN_OK && i < kind->axis_count; i",
                            "i < kind->axis_count; i"),
    "division by zero": (ARM, "scara4", r"fabs\(heading_across\) > 2e-12", "fabs(1.0/heading_across) > 1e-11"),
    "repair of a rotation": (ELBOW, "softkin_rotation.h", r"<= 0\.0001", "<= 0.01"),
    "wide matrix": (PLATE, "softkin", r"factor\*system\[k\*width \+ j\]", "factor*system[k*width + i]"),
    "no exchange of rows": (PLATE, "softkin", r"determinant = -determinant;", "determinant *= 1.0;"),
    "one root of two": (SEARCHED, "softkin", r"of->start\] \+= results\[1\];", "of->start] += 2.0*results[1];"),
    "farthest first": (SEARCHED, "softkin", r"away > one\.away", "away < one.away"),
    "one search alone": (SEARCHED, "softkin", r"return false;\n    \}\n  \}\n  return true;",
                         "return true;\n    }\n  }\n  return true;"),
}  # fmt: skip
"""The mechanism, the beginning of the file, what stands there, and what is planted."""
STOPPED = {
    "size of an array": "AddressSanitizer",
    "result of a refusal": "driver: a call that refuses has written a result",
    "division by zero": "division by zero",
}
"""What stops the program, which has no answer then."""


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_found(fault: str) -> None:
    """Some answer differs from that of Python, or the program is stopped."""
    name, file, found, wrong = FAULTS[fault]
    program = compiled_with_a_fault(part_of(name), file, found, wrong, SANITIZED if fault in STOPPED else ("-O0",))
    first, *others = read(name)
    few = [first | {"asked": first["asked"][:65:2]}] if name == SEARCHED else [first, *others[-4:]]
    try:
        assert differences(C.compared(program, few)), f"{fault} is not found"
    except AssertionError as stopped:
        if STOPPED.get(fault, "never") not in str(stopped):
            raise
    else:
        assert fault not in STOPPED, f"{fault} does not stop the program"
