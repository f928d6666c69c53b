"""All poses at given axes: as many as independent numerics find, of every kind of machine."""

import numpy as np
import pytest
import softkin
from softkin import Coupled, Frame

from tests.catalogue.platform_poses import (
    are_same,
    beside_home,
    every_pose,
    hexapod,
    missed,
    nominal_of,
    poses_in_a_plane,
)
from tests.mechanisms import named

PLANAR = "Softkin_Planar_3RRR"
ASSEMBLED, APART = (3.2, 137.0, -176.8), (0.0, 0.0, 0.0)


def planar() -> softkin.Planar3RRR:
    return softkin.Planar3RRR(**nominal_of(PLANAR))


def delta() -> softkin.DeltaP3CType3:
    return softkin.DeltaP3CType3(**nominal_of("Kin_Delta_P3C_Type3"))


@pytest.mark.parametrize(("seed", "count"), [(0, 12), (2, 8), (5, 12)])
def test_a_hexapod(seed: int, count: int) -> None:
    """The legs have their lengths, and random starts find no other pose; both assembly modes are among them."""
    machine = hexapod(seed)
    axes = beside_home(machine)
    found = machine.robot.forward_all(axes)
    rows = np.array([[*one.frame.position, *np.ravel(one.frame.rotation)] for one in found])
    assert missed(machine, axes, rows) < 1e-9
    assert len(found) == count and are_same(rows, every_pose(machine, axes), 1e-3)
    assert np.allclose(found[0].frame.matrix, machine.robot.forward(axes)[0].matrix, rtol=0.0, atol=1e-9)
    modes = [one.is_other for one in found]
    assert modes == sorted(modes) and set(modes) == {False, True}


@pytest.mark.parametrize("axes", [ASSEMBLED, (15.8, 150.7, -174.7), (30.5, 141.3, -199.5), APART])
def test_a_platform_in_a_plane(axes: tuple[float, ...]) -> None:
    """Its poses are the roots of one function of the heading: all of these, and none where there is none."""
    wanted = poses_in_a_plane(nominal_of(PLANAR), np.array(axes))
    frames = [one.frame for one in planar().forward_all(axes)]
    rows = np.array([[*f.position[:2], f.rotation[0][0], f.rotation[1][0]] for f in frames]).reshape(-1, 4)
    assert are_same(rows, wanted, 1e-6) and len(wanted) == (0 if axes == APART else 2)


@pytest.mark.parametrize("name", ["Kin_PCC", "Kin_Scara3_Z", "Softkin_Excavator"])
def test_where_there_is_one_pose(name: str) -> None:
    """Of a chain, of one with loops inside, and of a loop that closes in one way."""
    robot = softkin.catalogue()[name](**nominal_of(name))
    axes = [joint.shown for joint in named(name).joints]
    assert robot.forward_all(axes) == ((*robot.forward(axes), False),)


def test_the_other_pose_is_that_of_the_machine_in_the_other_mode() -> None:
    """As it is, on a base and with a tool, in radians, as measured, and with a wrist at its flange."""
    one, other, axes = delta(), delta().changed(tcp_above=True), (10.0, 20.0, 30.0)
    place, measured, wrist = Frame((10.0, 0.0, -50.0)), {"a1_gain": 0.01, "inner_arm_1": 0.5}, softkin.Wrist3()
    pairs = [
        (one, other, axes),
        (one.with_base(place).with_tool(place), other.with_base(place).with_tool(place), axes),
        (one.in_radians(), other.in_radians(), tuple(np.radians(axes))),
        (one.calibrated(measured), other.calibrated(measured), axes),
        (Coupled(one, wrist), Coupled(other, wrist), (*axes, 40.0, 50.0, 60.0)),
    ]
    for robot, reassembled, at in pairs:
        assert robot.forward_all(at) == ((*robot.forward(at), False), (*reassembled.forward(at), True))


def test_a_mounted_platform_is_searched_as_the_bare_one() -> None:
    base = Frame.from_euler(30.0, 0.0, 0.0, (100.0, 0.0, 0.0))
    for bare, carried in zip(
        planar().forward_all(ASSEMBLED), planar().with_base(base).forward_all(ASSEMBLED), strict=True
    ):
        assert np.allclose((base @ bare.frame).matrix, carried.frame.matrix, rtol=0.0, atol=1e-12)
        assert bare[1:] == carried[1:]


def test_what_cannot_be_assembled_has_no_pose() -> None:
    assert softkin.TripodLinear(**nominal_of("Kin_Tripod_Linear")).forward_all((0.0, 5000.0, 0.0)) == ()


def test_what_is_no_number_is_refused() -> None:
    with pytest.raises(softkin.KinematicsError, match="Kin_Delta_P3C_Type3.forward_all: numbers must be finite"):
        delta().forward_all((float("nan"), 0.0, 0.0))
