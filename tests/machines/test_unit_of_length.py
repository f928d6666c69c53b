"""Loops of the catalogue in metres: the same programs, a drawing, and test vectors for the controller. What is out of
reach does not depend on the unit.
"""

from dataclasses import replace

import numpy as np
import pytest
import softkin

from derive.description.catalogue import MECHANISMS, load
from derive.description.mechanism import Mechanism, Role
from derive.ir.interpret import run
from derive.ir.program import Status
from derive.ir.symbols import SCALE
from derive.kinematics.build import build
from derive.kinematics.kinematics import Called
from derive.kinematics.sampling import machine_at
from derive.pipeline import derive_one
from derive.report.self_test import self_test
from tests.machines.parallel_machines import PARALLEL
from tests.mechanisms import catalogue, kinematics_of

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


BOUNDED = {m.name: m for _, m in catalogue() if m.chain is not None and not m.drives} | PARALLEL


@pytest.mark.parametrize("name", BOUNDED)
def test_bounds_of_cosines_have_no_unit(name: str) -> None:
    """Of no machine do they change where every length is a million times as large."""
    kinematics = kinematics_of(BOUNDED[name])
    usual = machine_at(kinematics.mechanism)
    lengths = {SCALE.name, *(p.name for p in kinematics.mechanism.parameters if p.role in LENGTHS)}
    large = {key: value * (1e6 if key in lengths else 1.0) for key, value in usual.items()}
    bounds = [
        {k: v for k, v in run(kinematics.setup, given)[0].items() if "bound_of_" in k} for given in (usual, large)
    ]
    assert bounds[0].keys() == bounds[1].keys() and (bounds[0] or name not in PARALLEL)
    assert all(np.allclose(v, bounds[1][k], rtol=1e-15, atol=0.0) for k, v in bounds[0].items())


@pytest.mark.parametrize("unit", [1.0, 1e3, 1e9])
def test_a_reach_is_the_same_share_in_every_unit(unit: float) -> None:
    robot, turned = softkin.SwivelArm(arm_length=0.4 * unit), ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    assert robot.inverse(((0.4 * unit * (1.0 + 1e-13), 0, 0), turned))
    with pytest.raises(softkin.KinematicsError, match="out of reach"):
        robot.inverse(((0.4 * unit * (1.0 + 1e-11), 0, 0), turned))
