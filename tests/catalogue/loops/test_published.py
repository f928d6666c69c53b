"""Closed loops against numbers that others computed: LinuxCNC, Klipper, Newton's method on the closure."""

import numpy as np
import pytest
import softkin

from tests.catalogue.loops import edges

IDENTITY = np.eye(3)


def delta(azimuths: tuple[float, ...], **sizes: float) -> softkin.Mechanism:
    """A delta with three equal legs in these directions."""
    return softkin.DeltaP3CType3(**edges.arms(**sizes), **edges.azimuths(*azimuths))


LINUXCNC = delta((-90.0, 30.0, 150.0), base_radius=10.0, inner_arm=10.0, outer_arm=14.0, tcp_radius=6.0)
T_LAYOUT = delta((0.0, 90.0, -90.0), base_radius=140.0, inner_arm=200.0, outer_arm=450.0, tcp_radius=45.0)
RAILS = softkin.TripodP3Z(**edges.rails(269.0, *edges.around(130.25)))
FIRST, SECOND = (300, 350, 100, 300, 100), (300, 350, 110, 280, 90)
PUBLISHED = [
    (LINUXCNC, (30, 30, 30), (0, 0, -10.976451095529), 1e-11),
    (LINUXCNC, (10, 25, 40), (1.252020219789, -1.949378239769, -9.006516203479), 1e-11),
    (LINUXCNC, (45, 60, 30), (-3.738102003353, -0.197756004784, -15.058413037815), 1e-11),
    (T_LAYOUT, (20, 20, 20), (0, 0, -418.326579449955), 1e-9),
    (T_LAYOUT, (10, 30, 45), (150.668457743427, 43.719611721084, -459.729467840755), 1e-9),
    (T_LAYOUT, (-10, 15, 40), (181.884236450374, 63.902195073290, -396.894615840285), 1e-9),
    (RAILS, (239.991168308698, 213.999893665922, 263.329663451188), (50, 0, 10), 1e-9),
    (RAILS, (266.601132949329, 333.460800020652, 352.047475396436), (20, -80, 100), 1e-9),
]
"""The machine, axes, position, and the tolerance of the position; axes are held against 1e-9."""
FIVE_BARS = [
    (FIRST, (20, 0), (247.393957, -281.90778624)),
    (FIRST, (0, 20), (328.89241728, -419.70705016)),
    (FIRST, (15, -10), (267.03700002, -229.0008857)),
    (SECOND, (0, 0), (343.81817978, -365.4909097)),
    (SECOND, (15, -10), (270.26776336, -327.93810163)),
]


@pytest.mark.parametrize(("robot", "axes", "position", "tolerance"), PUBLISHED)
def test_deltas_of_linuxcnc_and_klipper(
    robot: softkin.Mechanism, axes: tuple[float, ...], position: tuple[float, ...], tolerance: float
) -> None:
    np.testing.assert_allclose(robot.forward(axes)[0].position, position, atol=tolerance)
    np.testing.assert_allclose(robot.inverse((position, IDENTITY)), axes, atol=1e-9)


@pytest.mark.parametrize(("links", "axes", "position"), FIVE_BARS)
def test_type_12(links: tuple[float, ...], axes: tuple[float, ...], position: tuple[float, ...]) -> None:
    robot = softkin.KinType12XY(**edges.links(*links))
    np.testing.assert_allclose(robot.forward(axes)[0].position[:2], position, atol=2e-8)
    np.testing.assert_allclose(robot.inverse(((*position, 0.0), IDENTITY)), axes, atol=1e-7)
    mirrored = robot.changed(swap_xy=True)
    np.testing.assert_allclose(mirrored.forward(axes)[0].position[:2], position[::-1], atol=2e-8)


def test_planar_delta_stretched_and_knees_together() -> None:
    robot = softkin.P2CType1(inner_arm=250.0, outer_arm=500.0, displacement=80.0)
    stretched = robot.inverse(((0.0, -745.721127500086, 0.0), IDENTITY))
    np.testing.assert_allclose(stretched, (96.12319886627, 96.12319886627), atol=1e-5)
    assert robot.singularity(stretched).is_singular
    assert robot.singularity((108.662924884942, 108.662924884942)).is_singular


def test_symmetric_delta_stretched_and_rods_parallel() -> None:
    robot = delta((0.0, 120.0, 240.0), base_radius=95.0, inner_arm=200.0, outer_arm=450.0)
    lowest = robot.inverse(((0.0, 0.0, -643.020217411552), IDENTITY))
    np.testing.assert_allclose(lowest, [98.404101570840] * 3, atol=1e-4)
    assert robot.singularity(lowest).is_singular
    assert robot.singularity((118.359350028158,) * 3).is_singular
