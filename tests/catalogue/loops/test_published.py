"""Closed loops against numbers that others computed: LinuxCNC, Klipper, Newton's method on the closure."""

import numpy as np
import pytest
import softkin

IDENTITY = np.eye(3)


def delta(azimuths: tuple[float, ...], **sizes: float) -> softkin.Mechanism:
    """A delta with three equal legs in these directions."""
    given = {f"{name}_{i}": value for name, value in sizes.items() for i in (1, 2, 3)}
    return softkin.DeltaP3CType3(**given, **{f"azimuth_{i}": a for i, a in enumerate(azimuths, 1)})


@pytest.mark.parametrize(
    "axes, position",
    [
        ((30, 30, 30), (0, 0, -10.976451095529)),
        ((10, 25, 40), (1.252020219789, -1.949378239769, -9.006516203479)),
        ((45, 60, 30), (-3.738102003353, -0.197756004784, -15.058413037815)),
    ],
)
def test_linuxcnc_rotary_delta(axes: tuple[float, ...], position: tuple[float, ...]) -> None:
    robot = delta((-90.0, 30.0, 150.0), base_radius=10.0, inner_arm=10.0, outer_arm=14.0, tcp_radius=6.0)
    np.testing.assert_allclose(robot.forward(axes)[0].position, position, atol=1e-11)
    np.testing.assert_allclose(robot.inverse((position, IDENTITY)), axes, atol=1e-9)


@pytest.mark.parametrize(
    "axes, position",
    [
        ((20, 20, 20), (0, 0, -418.326579449955)),
        ((10, 30, 45), (150.668457743427, 43.719611721084, -459.729467840755)),
        ((-10, 15, 40), (181.884236450374, 63.902195073290, -396.894615840285)),
    ],
)
def test_klipper_rotary_delta_in_t_layout(axes: tuple[float, ...], position: tuple[float, ...]) -> None:
    robot = delta((0.0, 90.0, -90.0), base_radius=140.0, inner_arm=200.0, outer_arm=450.0, tcp_radius=45.0)
    np.testing.assert_allclose(robot.forward(axes)[0].position, position, atol=1e-9)
    np.testing.assert_allclose(robot.inverse((position, IDENTITY)), axes, atol=1e-9)


@pytest.mark.parametrize(
    "position, axes",
    [
        ((50, 0, 10), (239.991168308698, 213.999893665922, 263.329663451188)),
        ((20, -80, 100), (266.601132949329, 333.460800020652, 352.047475396436)),
    ],
)
def test_linuxcnc_linear_delta(position: tuple[float, ...], axes: tuple[float, ...]) -> None:
    turns = np.radians([90, 210, 330])
    rails = {
        f"rail_{c}_{i + 1}": float(130.25 * f(t))
        for i, t in enumerate(turns)
        for c, f in (("x", np.cos), ("y", np.sin))
    }
    robot = softkin.TripodP3Z(arm_length=269.0, **rails)
    np.testing.assert_allclose(robot.inverse((position, IDENTITY)), axes, atol=1e-9)
    np.testing.assert_allclose(robot.forward(axes)[0].position, position, atol=1e-9)


@pytest.mark.parametrize(
    "links, axes, position",
    [
        ((300, 350, 100, 300, 100), (20, 0), (247.393957, -281.90778624)),
        ((300, 350, 100, 300, 100), (0, 20), (328.89241728, -419.70705016)),
        ((300, 350, 100, 300, 100), (15, -10), (267.03700002, -229.0008857)),
        ((300, 350, 110, 280, 90), (0, 0), (343.81817978, -365.4909097)),
        ((300, 350, 110, 280, 90), (15, -10), (270.26776336, -327.93810163)),
    ],
)
def test_type_12(links: tuple[float, ...], axes: tuple[float, ...], position: tuple[float, ...]) -> None:
    given = {f"link_length_{i}": v for i, v in enumerate(links, 1)}
    robot = softkin.KinType12XY(**given)
    np.testing.assert_allclose(robot.forward(axes)[0].position[:2], position, atol=2e-8)
    np.testing.assert_allclose(robot.inverse(((*position, 0.0), IDENTITY)), axes, atol=1e-7)
    mirrored = softkin.KinType12XY(**given, swap_xy=True)
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
