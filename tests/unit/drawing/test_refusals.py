"""A description whose drawing would be wrong is refused, with a sentence that names the fault."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism, X, Y, rod
from derive.description.validate import validate
from derive.drawing.drawing import drawing_of
from derive.drawing.pose import drawn_pose, nominal_machine
from derive.ir.program import Require, Status
from derive.kinematics.build import build
from derive.report.reference_calls import margins
from tests.unit.drawing.machines import CATALOGUE

SCISSOR = CATALOGUE["Kin_P2X_Type2"]
CRANE = CATALOGUE["Kin_Crane"]
LENGTH, _ = SCISSOR.parameters
A1, A2 = SCISSOR.joints
R, THETA, _ = CRANE.joints


def _scissor(*bars: object) -> Mechanism:
    return replace(SCISSOR, bars=tuple(bars))


WRONG = {
    "a bar that is not as long as stated": (
        _scissor(rod("1", (A1, 0), (X, Y), LENGTH), rod("2", (A2, 0), (X, Y), LENGTH)),
        r"bar '1' is 400 long, but its ends are \d+(\.\d+)? apart in the drawn pose",
    ),
    "a joint that moves nothing": (
        _scissor(rod("1", *(SCISSOR.bars[0].base, SCISSOR.bars[0].plate), LENGTH)),
        "nothing that is drawn moves with joint 'A2': name its bars",
    ),
    "an end that goes on no circle": (
        replace(
            CRANE, bars=(rod("reach", (0, 0, 0), (0, 0, R), R), rod("boom", (0, 0, THETA), (X, Y, THETA + 100), 200))
        ),
        "joint 'Theta' does not move the end of its bar on a circle",
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("case", WRONG)
def test_refused(case: str) -> None:
    """A mechanism that cannot be drawn is refused with a message that names the fault."""
    mechanism, message = WRONG[case]
    kinematics = build(validate(mechanism))
    with pytest.raises(DescriptionError, match=message):
        drawing_of(kinematics)


FAR = replace(SCISSOR, joints=tuple(replace(j, nominal=2.0 * j.nominal) for j in SCISSOR.joints))


@pytest.mark.long
def test_nominal_joints_that_fit_no_pose() -> None:
    """Another pose is drawn, away from singular ones."""
    machine = nominal_machine(build(validate(FAR)))
    pose = drawn_pose(machine)
    assert pose.axes != tuple(j.nominal for j in FAR.joints)
    assert np.min(np.abs(margins(machine, [pose.axes]))) > 0.05


@pytest.mark.long
def test_no_pose_can_be_drawn() -> None:
    """Where no sampled pose is possible either, the nominal values are named."""
    kinematics = build(validate(FAR))
    nowhere = replace(kinematics.singularity, body=(Require(sp.false, Status.IMPOSSIBLE), *kinematics.singularity.body))
    refused = replace(kinematics.forward, body=(Require(sp.false, Status.IMPOSSIBLE), *kinematics.forward.body))
    machine = nominal_machine(replace(kinematics, singularity=nowhere, forward=refused))
    with pytest.raises(DescriptionError, match="no pose can be drawn: the nominal values of its joints fit no pose"):
        drawn_pose(machine)


def test_a_bar_of_something_unknown_is_refused_before() -> None:
    """A bar that reads an unknown parameter is refused when the description is checked."""
    strange = CATALOGUE["Kin_PCC"].parameters[0]
    with pytest.raises(DescriptionError, match="bar '1' reads 'link_length_1', which is not a joint or a parameter"):
        validate(_scissor(rod("1", (A1, 0), (X, Y), strange)))
