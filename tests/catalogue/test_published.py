"""Numbers that others computed: with compiled LinuxCNC kinematics, in a manual's sample, or by hand."""

from math import cos, radians, sin, sqrt

import numpy as np
import pytest
import softkin

from tests.catalogue.robots import UR5, UR10
from tests.orthonormal import about

LINUXCNC = (
    # axes A1, A2, A4, then x, y and the turn c of LinuxCNC's scarakins with links 340 and 250
    ((30.0, 45.0, -15.0), (359.153398562339, 411.481456572267), 60.0),
    ((120.0, -75.0, 30.0), (6.776695296637, 471.225332583346), 75.0),
    ((10.0, -130.0, -400.0), (209.834636024151, -157.465970539353), -520.0),
)
TRUNNIONS = (
    # joints X, Y, Z, tilt, C, then x, y, z of xyzac-trt-kins with y-offset -20, z-offset -30, tool-offset 75
    ("A", (10.0, -20.0, 30.0, 35.0, 50.0), (-15.483788392, -26.046514022, 32.712719336)),
    ("A", (-45.0, 60.0, 5.0, -70.0, 200.0), (26.912596333, -57.629447284, 106.49460393)),
    # and of xyzbc-trt-kins with x-offset 25, z-offset -40, tool-offset 90
    ("B", (10.0, -20.0, 30.0, 35.0, 50.0), (0.224446142, -31.381961033, 25.013312569)),
    ("B", (-45.0, 60.0, 5.0, -70.0, 200.0), (18.22004219, -70.482219373, 100.387577005)),
)
SAMPLE = (-124.963889, -52.330798, 84.504469, -481.124887)
SAMPLE_POSITION = (-431.717444, -279.263625, 99.566963)
SIX_DIGITS = 1e-5
"""Half a unit of the sixth digit of three angles, in degrees, moves the end of a 550 mm arm by 8e-6 mm."""


@pytest.mark.parametrize("name", ["Kin_Scara4_ZCcoupled_Type1", "Kin_Scara4_CCZC_ZCcoupled"])
@pytest.mark.parametrize(("angles", "position", "turn"), LINUXCNC)
def test_scara_of_linuxcnc(name: str, angles: tuple[float, ...], position: tuple[float, ...], turn: float) -> None:
    robot = softkin.catalogue()[name](link_length_1=340.0, link_length_2=250.0)
    axes = (angles[0], angles[1], 37.0, angles[2])
    frame, configuration = robot.forward(axes)
    assert frame.position == pytest.approx((*position, 37.0), abs=1e-11)
    assert np.allclose(frame.rotation, about(2, turn), rtol=0, atol=1e-14)
    assert configuration[0] == (1 if angles[1] > 0 else 2)
    assert robot.inverse(((*position, 37.0), about(2, turn)), configuration) == pytest.approx(axes, abs=1e-10)


def test_three_axis_scara_of_linuxcnc() -> None:
    """The same arms without the fourth axis: the flange turns with them."""
    for angles, position, _ in LINUXCNC:
        for name, word in (("Kin_Scara3_CCZ", "link"), ("Kin_Scara2_Z", "arm")):
            robot = softkin.catalogue()[name](**{f"{word}_length_1": 340.0, f"{word}_length_2": 250.0})
            frame, _ = robot.forward((angles[0], angles[1], -3.0))
            assert frame.position == pytest.approx((*position, -3.0), abs=1e-11)
            assert np.allclose(frame.rotation, about(2, angles[0] + angles[1]), rtol=0, atol=1e-14)


@pytest.mark.parametrize(("tilt", "axes", "position"), TRUNNIONS)
def test_trunnions_of_linuxcnc(tilt: str, axes: tuple[float, ...], position: tuple[float, ...]) -> None:
    """Its offsets are pivots the other way round, and zeros of slides; its z is that of the tip with the tool added."""
    if tilt == "A":
        robot = softkin.TableTableAC(pivot_y=20.0, pivot_z=30.0, tool_length=75.0, offset_y=-20.0, offset_z=-30.0)
    else:
        robot = softkin.TableTableBC(pivot_x=-25.0, pivot_z=40.0, tool_length=90.0, offset_x=25.0, offset_z=-40.0)
    tip = (*position[:2], position[2] - robot.parameters["tool_length"])
    frame, configuration = robot.forward(axes)
    assert frame.position == pytest.approx(tip, abs=1e-8)
    assert robot.inverse((tip, frame.rotation), configuration, axes) == pytest.approx(axes, abs=1e-7)


def sample() -> softkin.Mechanism:
    """The SCARA of the published example."""
    offsets = dict(zip(("offset_a1", "offset_a2", "offset_a3", "offset_a4"), (5.0, -10.0, 12.5, 15.0), strict=True))
    return softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, pitch_zc=20.0, **offsets)


def test_sample_of_the_manual() -> None:
    frame, configuration = sample().forward(SAMPLE)
    assert frame.position == pytest.approx(SAMPLE_POSITION, abs=SIX_DIGITS)
    assert np.allclose(frame.rotation, about(2, -129.963889 - 42.330798 - 496.124887), rtol=0, atol=1e-14)
    assert configuration == (2, -1, 1, 1)  # left elbow; A4 one turn below, A1 and A2 on the first turn


def test_way_back_of_the_sample() -> None:
    rotation = about(2, -129.963889 - 42.330798 - 496.124887)
    axes = sample().inverse((SAMPLE_POSITION, rotation), (2, -1, 1, 1))
    assert axes == pytest.approx(SAMPLE, abs=1e-6)
    near = sample().inverse((SAMPLE_POSITION, rotation), (0, 0, 0, 0), reference=(-120, -50, 0, -500))
    assert near == pytest.approx(SAMPLE, abs=1e-6)


def test_the_period_of_a4_moves_a3() -> None:
    """One turn more of A4 lowers the quill by its pitch less: the period is chosen before A3 is computed."""
    frame = SAMPLE_POSITION, about(2, -129.963889 - 42.330798 - 496.124887)
    below = sample().inverse(frame, (2, -1, 1, 1))
    above = sample().inverse(frame, (2, 1, 1, 1))
    assert np.subtract(above, below) == pytest.approx((0.0, 0.0, 20.0, 360.0), abs=1e-9)


def test_the_zero_pose_is_stretched_along_x() -> None:
    robot = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, pitch_zc=20.0)
    frame, configuration = robot.forward((0,) * 4)
    assert frame == ((550.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    assert configuration == (3, 1, 1, 1)


@pytest.mark.parametrize(("motors", "linuxcnc"), [((10.0, 4.0), (7.0, 3.0)), ((-250.5, 100.25), (-75.125, -175.375))])
def test_h_bot_is_corexy(motors: tuple[float, float], linuxcnc: tuple[float, float]) -> None:
    """LinuxCNC's corexykins has x = (j0 + j1) / 2 and y = (j0 - j1) / 2: x and y are named the other way round."""
    y, x = linuxcnc
    robot = softkin.P2Y()
    frame, configuration = robot.forward(motors)
    assert frame.position == (x, y, 0.0)
    assert configuration == ()
    assert robot.inverse(frame) == motors


def test_directions_of_the_belt_gantries() -> None:
    """CODESYS: the H-gantry's first drive pulls to +X and -Y, the T-gantry's to +X and -Y with the
    second to +X and +Y.
    """
    assert softkin.HGantry2().forward((10.0, 4.0))[0].position == (3.0, -7.0, 0.0)
    assert softkin.HGantry3().forward((10.0, 4.0, 5.0))[0].position == (3.0, -7.0, 5.0)
    assert softkin.TGantry2().forward((10.0, 4.0))[0].position == (7.0, -3.0, 0.0)
    assert softkin.TGantry3().forward((10.0, 4.0, 5.0))[0].position == (7.0, -3.0, 5.0)


def test_spherical_crane_by_hand() -> None:
    robot = softkin.Crane()
    frame, configuration = robot.forward((2.0, 30.0, 60.0))
    assert frame.position == pytest.approx((1.5, sqrt(3) / 2, 1.0), abs=1e-15)
    assert configuration == (1,)
    assert robot.inverse((frame.position, np.eye(3))) == pytest.approx((2.0, 30.0, 60.0), abs=1e-12)
    assert robot.inverse(((0.0, 0.0, -7.0), np.eye(3)), None, (0.0, 77.0, 0.0)) == pytest.approx((7.0, 77.0, 180.0))


def test_belt_arm_with_motors_in_the_base() -> None:
    """With coupling -1 the motors turn the links absolutely: motor 2 alone bends link 2, motor 1
    shifts it in parallel.
    """
    robot = softkin.SCCC(link_length_1=300.0, link_length_2=250.0, coupling_12=-1.0, coupling_23=-1.0)
    frame, configuration = robot.forward((90.0, 30.0, -50.0))
    assert frame.position == pytest.approx((250 * cos(radians(30)), 300 + 250 * sin(radians(30)), 0.0), abs=1e-12)
    assert np.allclose(frame.rotation, about(2, 30.0 - 50.0 - 30.0), rtol=0, atol=1e-14)
    assert configuration == (2, 1, 1, 1)


def test_parallel_arm_by_hand() -> None:
    frame, configuration = softkin.PCC(link_length_1=300.0, link_length_2=250.0).forward((90.0, 180.0))
    assert frame.position == pytest.approx((-250.0, 300.0, 0.0), abs=1e-12)
    assert configuration == (1, 1, 2)


@pytest.mark.parametrize(
    ("dimensions", "position"), [(UR5, (-817.25, -191.45, -5.491)), (UR10, (-1184.3, -256.141, 11.6))]
)
def test_zero_pose_of_arms_with_three_parallel_axes(dimensions: dict[str, float], position: tuple[float, ...]) -> None:
    """As their controllers show it: stretched to the back, the flange turned to the side."""
    robot = softkin.Ac6ThreeParallel(**dimensions)
    frame, configuration = robot.forward((0.0,) * 6)
    assert frame.position == pytest.approx(position, abs=1e-10)
    assert np.allclose(frame.rotation, ((1, 0, 0), (0, 0, -1), (0, 1, 0)), rtol=0, atol=1e-15)
    assert configuration[1:3] == (3, 3)
    axes = robot.inverse(frame, configuration, (0.0,) * 6)
    assert robot.forward(axes)[0].position == pytest.approx(position, abs=1e-8)


ARM = {"d1": 350.0, "a1": 80.0, "a2": 310.0, "d3": 50.0, "a3": 30.0, "d4": 290.0}


def test_zero_pose_of_the_articulated_robot() -> None:
    """CODESYS: the origin at (a1 + d4 + d6, -d3, d1 + a2 + a3), x of the flange up, its y along -y, its z along x."""
    frame, configuration = softkin.ArticulatedRobot6DOF(**ARM, d6=75.0).forward((0.0,) * 6)
    assert frame.position == pytest.approx((80 + 290 + 75, -50.0, 350 + 310 + 30), abs=1e-12)
    assert np.allclose(frame.rotation, ((0, 0, 1), (0, -1, 0), (1, 0, 0)), rtol=0, atol=1e-15)
    assert configuration[0] == 1
    assert configuration[2] == 3  # A4 and A6 are in line
    arm = softkin.PosRRR(**ARM)
    assert arm.forward((0.0, 0.0, 0.0))[0].position == pytest.approx((80 + 290, -50.0, 350 + 310 + 30), abs=1e-12)


def test_the_articulated_robot_leans_back_with_a_positive_angle() -> None:
    """The second axis looks along -y: 90 degrees lay the upper arm down to the back, and the forearm then points up."""
    frame, _ = softkin.PosRRR(**ARM).forward((0.0, 90.0, 0.0))
    assert frame.position == pytest.approx((80 - 310 - 30, -50.0, 350 + 290), abs=1e-12)
    frame, _ = softkin.PosRRR(**ARM).forward((90.0, 0.0, 0.0))
    assert frame.position == pytest.approx((50.0, 80 + 290, 350 + 310 + 30), abs=1e-12)


def test_the_limits_that_codesys_states_leave_a_solution() -> None:
    """A1 and A2 within a turn, A3 from -90 to 180 degrees: given as limits, the zero pose is inside."""
    limits = {"lower_a1": -180.0, "upper_a1": 180.0, "lower_a2": -180.0, "upper_a2": 180.0}
    robot = softkin.PosRRR(**ARM, **limits, lower_a3=-90.0, upper_a3=180.0)
    frame, configuration = robot.forward((10.0, -20.0, 30.0))
    assert robot.inverse(frame, configuration) == pytest.approx((10.0, -20.0, 30.0), abs=1e-9)


def test_head_of_the_gantry_by_hand() -> None:
    """Turned by 90 degrees about y, the flange's x looks down and its z along x."""
    robot = softkin.Ac6TXTYTZRYRXRZ(flange_x=1.0, flange_y=2.0, flange_z=3.0)
    frame, configuration = robot.forward((100.0, 200.0, 300.0, 90.0, 0.0, 0.0))
    assert frame.position == pytest.approx((103.0, 202.0, 299.0), abs=1e-12)
    assert np.allclose(frame.rotation, ((0, 0, 1), (0, 1, 0), (-1, 0, 0)), rtol=0, atol=1e-15)
    assert configuration[0] == 1
    flipped = robot.inverse(frame, (2, 0, 0, 0))
    assert flipped[:3] == pytest.approx((100.0, 200.0, 300.0), abs=1e-9)
    assert abs(flipped[4]) == pytest.approx(180.0, abs=1e-9)
