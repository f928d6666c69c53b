"""These tests would notice: a text with one statement slightly wrong answers differently from Python."""

import re
from dataclasses import replace
from itertools import cycle

import pytest

from derive.description.mechanism import Mechanism
from tests.harness.library import Library, compile_st
from tests.text.breakage import Break, texts
from tests.text.comparisons import COMPARISONS
from tests.text.controller import OK, Controller
from tests.text.pairs import LOOPS, pairs_of
from tests.text.units import compiled_text, file_of, text_of

pytestmark = pytest.mark.slow

PUBLIC = {"FindPose": "AxesToCartesian", "SolveBranch": "CartesianToAxes", "FindJacobian": "Jacobian"}
"""The methods that are spoiled, and those that must answer differently."""
BY_TURNS = list(zip(LOOPS, cycle(PUBLIC), strict=False))
SAMPLES = 6


OUTPUTS = {
    "FindPose": r"^(  |)(v\.dX := )(.+?);",
    "SolveBranch": r"^(  |)(\w+\.a0 := )(.+?);",
    "FindJacobian": r"^(  |)(J\[0, 0\] := )(.+?);",
}


def spoiled(text: str, method: str) -> str:
    """The text with the first output of a method made a little larger."""
    start = text.index(f"METHOD PROTECTED {method} ")
    end = text.index("END_METHOD", start)
    pattern = re.compile(OUTPUTS[method], re.MULTILINE | re.DOTALL)
    wrong, count = pattern.subn(r"\g<1>\g<2>1.0000001*(\g<3>);", text[start:end], count=1)
    assert count == 1, f"nothing to spoil in {method}"
    return text[:start] + wrong + text[end:]


@pytest.mark.parametrize(("mechanism", "method"), BY_TURNS, ids=[f"{m.name}-{method}" for m, method in BY_TURNS])
def test_a_wrong_statement_is_noticed(mechanism: Mechanism, method: str) -> None:
    """The comparison with Python notices a changed statement: of every loop in one method, by turns."""
    library = compiled_text(file_of(mechanism), spoiled(text_of(mechanism), method))
    with pytest.raises(AssertionError):
        compare(mechanism, library, PUBLIC[method], SAMPLES)


def compare(mechanism: Mechanism, library: Library, method: str, samples: int) -> None:
    """The comparisons of a method, with another text for the block."""
    loop = pairs_of(mechanism)[1]
    controller = Controller(library, mechanism)
    assert controller.initialise(loop.robot.parameters) == OK
    for sample in loop.regular[:samples]:
        COMPARISONS[method](replace(loop, controller=controller), sample)


_BRANCH, _FORWARD, _INPUTS = (
    "METHOD PROTECTED SolveBranch",
    "METHOD PROTECTED FindPose",
    "METHOD PROTECTED ReadInputs",
)
FIVE_BAR, TRIPOD, DELTA = "Kin_P2C_Type1", "Kin_Tripod_Rotary", "Kin_Delta_P3C_Type3"
TOWARDS_THE_MODE = "assemblySignByOuterArmSquared*(rod1X*rod2Y - rod1Y*rod2X)"
WRONG = {
    "CartesianToAxes: a knee on the other side": (
        FIVE_BAR,
        Break(_BRANCH, "2.0*Softkin_Root(sineSquareA1)*signKnee1", "-2.0*Softkin_Root(sineSquareA1)*signKnee1"),
    ),
    "CartesianToAxes: two legs exchanged": (
        DELTA, Break(_BRANCH, "a.a0 := axisA1;\na.a1 := axisA2;", "a.a0 := axisA2;\na.a1 := axisA1;"),
    ),
    "AxesToCartesian: the other assembly mode": (
        FIVE_BAR, Break(_INPUTS, "SEL(xTcpAbove, -1.0, 1.0)", "SEL(xTcpAbove, 1.0, -1.0)"),
    ),
    "CartesianToAxes: the other assembly mode not refused": (
        FIVE_BAR, Break(_BRANCH, TOWARDS_THE_MODE, f"ABS({TOWARDS_THE_MODE})"),
    ),
    "CartesianToAxes: another least margin": (
        FIVE_BAR, Break(_BRANCH, "type2ArmsAligned >= minType2Margin", "type2ArmsAligned >= 0.2"),
    ),
    "CartesianToAxes: a ball joint that swings less": (
        TRIPOD, Break(_BRANCH, "<= sinMaxAngleBallJoint", "<= 0.5*sinMaxAngleBallJoint"),
    ),
    "IsSingularity: another margin": (
        TRIPOD,
        Break("METHOD PROTECTED FindMargins", "aMargins[3] := marginRodsCoplanar;", "aMargins[3] := 0.0;"),
    ),
    "AxesToCartesian: another byte for a knee": (
        DELTA, Break(_FORWARD, "aBranches[1] := branchKnee2", "aBranches[1] := branchKnee1"),
    ),
    "Jacobian: a slope of the other leg": (FIVE_BAR, Break("METHOD PROTECTED FindJacobian", "*sinA2", "*sinA1")),
}  # fmt: skip
"""The method that then answers otherwise, what is wrong, and in which unit."""


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_formula_is_noticed(name: str) -> None:
    """The comparison with Python notices a changed formula, and accepts the correct text."""
    named, change = WRONG[name]
    (mechanism,) = (m for m in LOOPS if m.name == named)
    library = compile_st(texts(change, mechanism))  # a text that is not there is no fault that is noticed
    with pytest.raises(AssertionError):
        compare(mechanism, library, name.split(":")[0], 120)
    compare(mechanism, compile_st(texts(None, mechanism)), name.split(":")[0], 10)
