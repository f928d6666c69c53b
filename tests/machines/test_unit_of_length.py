"""Loops of the catalogue in metres: the same programs, a drawing, and test vectors for the controller."""

from dataclasses import replace

import pytest

from derive.description.catalogue import MECHANISMS, load
from derive.description.mechanism import Mechanism, Role
from derive.ir.program import Status
from derive.kinematics.build import build
from derive.kinematics.kinematics import Called
from derive.pipeline import derive_one
from derive.report.self_test import self_test

pytestmark = pytest.mark.slow("p2c")

LOOPS = ("kin_p2x_type2", "kin_p2c_type1")
LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH, Role.DISTANCE)


def in_metres(mechanism: Mechanism) -> Mechanism:
    """The same machine with its lengths a thousandth."""
    parameters = (replace(p, nominal=p.nominal / 1e3) if p.role in LENGTHS else p for p in mechanism.parameters)
    joints = (j if j.is_angle else replace(j, nominal=j.nominal / 1e3) for j in mechanism.joints)
    return replace(mechanism, parameters=tuple(parameters), joints=tuple(joints))


@pytest.mark.parametrize("name", LOOPS)
def test_a_loop_in_metres(name: str) -> None:
    """It is derived whole, with the program that it has in millimetres."""
    usual = load(MECHANISMS / f"{name}.py")
    small = in_metres(usual)
    assert build(small).programs == build(usual).programs
    assert derive_one(small).evidence is not None


@pytest.mark.parametrize("name", LOOPS)
def test_its_test_vectors_are_fine_enough(name: str) -> None:
    """Frames are told in more digits than the controller compares, and several poses are tested."""
    kinematics = build(in_metres(load(MECHANISMS / f"{name}.py")))
    cases = [c for c in self_test(kinematics).cases if c.called is Called.FORWARD and c.status is Status.OK]
    assert len({c.axes for c in cases}) >= 3
    assert any(round(v, 6) != v for case in cases for v in case.frame[:3])
