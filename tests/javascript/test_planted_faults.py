"""A wrong text is found out: each fault is planted into what is written, and the comparison with Python notices it."""

import re
from collections.abc import Callable

import pytest

from tests.corpus.recording import read
from tests.javascript.comparison import differences
from tests.javascript.modules import part_of, written
from tests.languages.language import JAVASCRIPT

ARM = "Kin_Scara4_ZCcoupled_Type1"
ELBOW = "Kin_ArticulatedRobot_6DOF"
SEARCHED = "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"
PLATE = "Softkin_Planar_3RRR"
FAULTS: dict[str, tuple[str, str, str, str]] = {
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
"""The mechanism, the beginning of the file, what stands there, and what is planted."""


def planted(file: str, found: str, wrong: str) -> Callable[[str, str], str]:
    """The change of one place of one file, which must be there."""

    def change(path: str, text: str) -> str:
        if not path.startswith(file):
            return text
        changed = re.sub(found, wrong, text)
        assert changed != text, f"{path} does not hold {found}"
        return changed

    return change


@pytest.mark.slow("passes", "of two", "farthest", "one search")
@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_found(fault: str) -> None:
    """Some answer differs from that of Python."""
    name, file, found, wrong = FAULTS[fault]
    module = written(part_of(name), planted(file, found, wrong))
    recording = read(name)
    few = [*recording[:2], *recording[-8:]]
    if name == SEARCHED:
        asked = recording[0]["asked"]  # a search takes long: regular poses, and some next to a fold
        few = [recording[0] | {"asked": [*asked[8:16], *asked[64:72]]}]
    assert differences(JAVASCRIPT.compared(module, few)), f"{fault} is not found"
