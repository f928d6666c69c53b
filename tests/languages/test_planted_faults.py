"""A wrong text is found out: each fault is planted into what is written, and the comparison with Python notices it."""

import re
from pathlib import Path

import pytest

from tests.c import programs
from tests.corpus.recording import read
from tests.javascript import modules
from tests.javascript.comparison import differences
from tests.languages.language import JAVASCRIPT, C

ARM = "Kin_Scara4_ZCcoupled_Type1"
ELBOW = "Kin_ArticulatedRobot_6DOF"
SEARCHED = "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"
PLATE = "Softkin_Planar_3RRR"
IN_C: dict[str, tuple[str, str, str, str]] = {
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
IN_JAVASCRIPT: dict[str, tuple[str, str, str, str]] = {
    "sign of a sum": (ARM, "scara4", r"link_length_1\*cos_a1 \+ link", "link_length_1*cos_a1 - link"),
    "sign of a branch": (ARM, "scara4", r"\*sign_elbow;", "*-sign_elbow;"),
    "sine for cosine": (ARM, "scara4", r"const cos_a12 = Math\.cos", "const cos_a12 = Math.sin"),
    "entry of the Jacobian": (ARM, "scara4", r"\[1, 1, 0, 1\]\]", "[1, 1, 0, -1]]"),
    "turn that is open": (ARM, "scara4", r"single_a1 \? mid_a1 : ref_a1", "single_a1 ? ref_a1 : mid_a1"),
    "limit": (ARM, "scara4", r"axis_a1 <= highest_a1", "axis_a1 >= highest_a1"),
    "reason": (ARM, "scara4", r"A2: out of reach", "A1: out of reach"),
    "amount": (ARM, "scara4", r"axis_a3 - highest_a3\)", "highest_a3 - axis_a3)"),
    "status": (ARM, "scara4", r"refuse\(Status\.UNREACHABLE, \"A2: out", 'refuse(Status.IMPOSSIBLE, "A2: out'),
    "order of bytes": (ARM, "scara4", r"periodAxes: \[3, 0, 1\]", "periodAxes: [0, 3, 1]"),
    "edge of a period": (ARM, "softkin/numbers.js", r"180 \+ EDGE", "180 - EDGE"),
    "choice by distance": (ARM, "softkin/softkin.js", r"(Distance\(axes, near, counted\)) <", r"\1 >"),
    "byte that means nothing": (ARM, "softkin/softkin.js", r"byte < 0 \|\| byte > 3", "byte < 0 || byte > 4"),
    "turn that is inside": (ARM, "softkin/configuration.js", r"turn >= 0 \? turn \+ 1 : turn", "turn"),
    "tolerance of limits": (ARM, "softkin/limits.js", r"low - tolerance, isWide", "low - 1, isWide"),
    "repair of a rotation": (ELBOW, "softkin/rotation.js", r"<= 0\.0001", "<= 0.01"),
    "wide matrix": (PLATE, "softkin/numbers.js", r"factor \* rows\[k\]\[j\]", "factor * rows[k][i]"),
    "no exchange of rows": (PLATE, "softkin/numbers.js", r"determinant = -determinant;", ""),
    "fewer passes": (SEARCHED, "ac6_rzryryrxryrz_j6offset.js", r"pass < 4001", "pass < 41"),
    "one root of two": (SEARCHED, "softkin/roots.js", r"at \+= away;", "at += 2.0 * away;"),
    "farthest first": (SEARCHED, "softkin/roots.js", r"a\.away - b\.away", "b.away - a.away"),
    "one search alone": (SEARCHED, "softkin/softkin.js", r"others\.some\(\(other\)", "!others.some((other)"),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("fault", IN_C)
def test_a_fault_in_c_is_found(fault: str) -> None:
    """Some answer differs from that of Python, or the program is stopped."""
    name, file, found, wrong = IN_C[fault]
    options = programs.SANITIZED if fault in STOPPED else ("-O0",)
    program = programs.compiled_with_a_fault(programs.part_of(name), file, found, wrong, options)
    first, *others = read(name)
    few = [first | {"asked": first["asked"][:65:2]}] if name == SEARCHED else [first, *others[-4:]]
    try:
        assert differences(C.compared(program, few)), f"{fault} is not found"
    except AssertionError as stopped:
        if STOPPED.get(fault, "never") not in str(stopped):
            raise
    else:
        assert fault not in STOPPED, f"{fault} does not stop the program"


def planted(fault: str) -> Path:
    """The module with the fault in one place, which must be there."""
    name, file, found, wrong = IN_JAVASCRIPT[fault]

    def change(path: str, text: str) -> str:
        changed = re.sub(found, wrong, text) if path.startswith(file) else text
        assert changed != text or not path.startswith(file), f"{path} does not hold {found}"
        return changed

    return modules.written(modules.part_of(name), change)


@pytest.mark.slow("passes", "of two", "farthest", "one search")
@pytest.mark.parametrize("fault", IN_JAVASCRIPT)
def test_a_fault_in_javascript_is_found(fault: str) -> None:
    name = IN_JAVASCRIPT[fault][0]
    recording = read(name)
    few = [*recording[:2], *recording[-8:]]
    if name == SEARCHED:
        asked = recording[0]["asked"]  # a search takes long: regular poses, and some next to a fold
        few = [recording[0] | {"asked": [*asked[8:16], *asked[64:72]]}]
    assert differences(JAVASCRIPT.compared(planted(fault), few)), f"{fault} is not found"
