"""User transformations of PacDrive: every machine, in the text of that profile, as in Python, by its two methods."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np
import pytest
import softkin

from derive.emit.softmotion.inputs import inputs
from derive.emit.softmotion.library import StructuredTextFiles
from tests.corpus.dimensions import DIMENSIONS
from tests.harness import ast
from tests.harness.library import Library, compile_st
from tests.linuxcnc.machine import NAMES, about, differs, recorded
from tests.mechanisms import kinematics_of, named
from tests.text.test_portable import lint

pytestmark = pytest.mark.broad

SAME, SINGULAR, FREE = 1e-12, 1e-3, 1e-9
DOUBLE = 3e-8
"""Where two roots meet, rounding of a rotation costs half of its digits."""
OK, REFUSED = "Ok", "InputParameterInvalid"
LETTERS = "ABCDEF"
Axes = list[float]


@cache
def library_of(name: str) -> Library:
    """The block of a machine with all that it needs."""
    language = StructuredTextFiles("pacdrive")
    part = language.part(kinematics_of(named(name)))
    assert part is not None
    return compile_st({path: text for path, text in language.files([part]).items() if path.endswith(".st")})


class Robot:
    """A robot that has a machine as its transformation."""

    def __init__(self, name: str) -> None:
        self.mechanism, self.library = named(name), library_of(name)
        self.block = self.library.new(self.mechanism.block_name)
        declared = self.library.objects[self.mechanism.block_name]
        assert isinstance(declared, ast.Block)
        (interface,) = declared.implements
        self.is_small = interface == "ROB.IF_UserTransformation3Ax"
        self.letters = LETTERS[:3] if self.is_small else LETTERS
        self.names = inputs(kinematics_of(self.mechanism)).names

    def give(self, **parameters: float) -> None:
        """Write inputs."""
        for key, value in parameters.items():
            own = getattr(self.block, self.names.get(key, key))
            setattr(self.block, self.names.get(key, key), type(own)(value))

    def choose(self, configuration: tuple[int, ...]) -> None:
        """Write the bytes of a configuration."""
        self.block.Config.abyData[: len(configuration)] = [byte % 256 for byte in configuration]

    def direct(self, axes: Axes) -> tuple[str, str, Any]:
        """The diagnosis, its words, and the frame."""
        given = [*axes, *(0.0 for _ in self.letters)][: len(self.letters)]
        pairs = zip(self.letters, given, strict=True)
        _, found = self.block.call_with_outputs("Direct", **{f"i_lrPosition{one}": value for one, value in pairs})
        position, angles = found["q_stCoordinate"], found.get("q_stOrientation")
        rotation = np.eye(3) if angles is None else about(2, angles.lrZ) @ about(1, angles.lrY) @ about(0, angles.lrX)
        frame = softkin.Frame((position.lrX, position.lrY, position.lrZ), rotation.tolist())
        return found["q_etDiag"], found["q_sMsg"], (frame, angles)

    def inverse(self, position: Any, angles: Any) -> tuple[str, str, Axes]:
        """The diagnosis, its words, and the axis values."""
        given = self.library.new("PDL.ST_Vector3D")
        given.lrX, given.lrY, given.lrZ = position
        turned = {} if self.is_small else {"i_stRefOrientation": angles}
        _, found = self.block.call_with_outputs("Inverse", i_stRefCoordinate=given, **turned)
        axes = [found[f"q_lrRefPosition{one}"] for one in self.letters]
        return found["q_etDiag"], found["q_sMsg"], axes[: len(self.mechanism.joints)]


@pytest.mark.slow("Ac6_RZ", "ThreeParallel", "Planar")
@pytest.mark.parametrize("name", NAMES)
def test_a_robot_moves_as_in_python(name: str) -> None:
    """Frames, and axes near the last answer or on the branch of the configuration; what Python refuses is refused, with
    words, and changes nothing.
    """
    robot, twin = Robot(name), softkin.catalogue()[name](**DIMENSIONS[name])
    robot.give(**DIMENSIONS[name])
    scale = 1.0 + max((abs(value) for value in DIMENSIONS[name].values()), default=0.0)
    regular = singular = 0
    for axes in recorded(name):
        diagnosis, words, (frame, angles) = robot.direct(axes)
        try:
            expected, configuration = twin.forward(axes)
        except softkin.KinematicsError:
            assert diagnosis == REFUSED and words
            continue
        assert diagnosis == OK and words == ""
        assert np.allclose(frame.position, expected.position, rtol=0.0, atol=SAME * scale)
        assert robot.is_small or np.allclose(frame.rotation, expected.rotation, atol=SAME)
        for chosen in ((0,) * len(configuration), configuration):
            robot.choose(chosen)
            robot.direct(axes)  # its axes are the reference
            diagnosis, words, found = robot.inverse(frame.position, angles)
            try:
                wanted = twin.inverse(frame, chosen, axes)
            except softkin.KinematicsError as problem:
                assert diagnosis == REFUSED and words and str(problem)
                continue
            assert diagnosis == OK and words == ""
            least = min((abs(m) for m in twin.singularity(wanted).margins.values()), default=1.0)
            if least > SINGULAR:
                assert differs(found, list(wanted)) < SAME * 1e3 / least**2
                regular += 1
            else:
                _assert_reached(robot, found, frame, scale)
                singular += 1
    assert regular >= 3 and regular + singular >= 10


def _assert_reached(robot: Robot, axes: Axes, frame: softkin.Frame, scale: float) -> None:
    """Near a singularity axes have fewer digits than the pose, which they reach."""
    _, _, (again, _) = robot.direct(axes)
    assert np.allclose(again.position, frame.position, atol=FREE * scale)
    assert np.allclose(again.rotation, frame.rotation, atol=DOUBLE)


@pytest.mark.parametrize("name", ["Kin_Scara3_Z", "Kin_Pos_RRR"])
def test_its_text_is_portable(name: str) -> None:
    """By the rules of the blocks for SoftMotion, of which it names nothing."""
    language = StructuredTextFiles("pacdrive")
    files = language.files([language.part(kinematics_of(named(name)))])  # type: ignore[list-item]
    texts = {path: text for path, text in files.items() if path.endswith(".st")}
    assert {path: found for path, text in texts.items() if (found := lint(text))} == {}
    code = re.sub(r"'[^']*'|\(\*.*?\*\)|//[^\n]*", "", "\n".join(texts.values()), flags=re.DOTALL)
    assert re.findall(r"TRAFO|SM3\w*|SMC_\w*|\bISM\w*|MC_KIN\w*", code) == []
    assert "Teach" not in files["README.md"] and "CheckLine" not in files["README.md"]


def test_its_interface_is_that_of_its_axes() -> None:
    small = {"Kin_Pos_RRR", "Kin_Delta_P3C_Type3", "Kin_Gantry3", "Kin_P2X_Type1"}
    large = {"Kin_Scara3_Z", "Kin_ArticulatedRobot_6DOF", "Kin_CAxis"}
    assert {name: Robot(name).is_small for name in (*small, *large)} == {
        **dict.fromkeys(small, True), **dict.fromkeys(large, False)
    }  # fmt: skip


def test_a_robot_is_refused_in_words() -> None:
    """A forgotten length, a pose beyond reach, and angles that are no numbers; afterwards it answers again."""
    robot = Robot("Kin_Scara3_Z")
    assert robot.direct([0.0] * 4)[:2] == (
        REFUSED, "dArmLength1 is not allowed: it must be more than 1e-12 and at most 1e+09"
    )  # fmt: skip
    angles = robot.library.new("PDL.ST_Vector3D")
    assert robot.inverse((400.0, 0.0, 0.0), angles)[1].startswith("dArmLength1 is not allowed")
    robot.give(arm_length_1=300.0, arm_length_2=200.0, arm_length_3=50.0)
    assert robot.inverse((700.0, 0.0, 0.0), angles)[:2] == (REFUSED, "A2: out of reach [u]")
    for number in (float("nan"), float("inf"), 1e300):
        angles.lrZ = number
        assert robot.inverse((400.0, 0.0, 0.0), angles)[0] == REFUSED
    angles.lrZ = 30.0
    diagnosis, words, axes = robot.inverse((400.0, 0.0, 0.0), angles)
    assert (diagnosis, words) == (OK, "")
    assert robot.direct(axes)[2][0].position == pytest.approx((400.0, 0.0, 0.0))
