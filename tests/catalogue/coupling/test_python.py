"""A coupling in Python: what it says about itself, what it refuses, and what CODESYS documents of such machines."""

import math

import numpy as np
import pytest
import softkin
from softkin import Status

from tests.catalogue.refusals import refusal, status_of
from tests.text.samples import tilted

ARM = {"d1": 350.0, "a2": 310.0, "d4": 290.0}


def scara_with_c(**given: float) -> softkin.Coupled:
    return softkin.Coupled(softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0), softkin.CAxis(**given))


def test_what_it_says_about_itself() -> None:
    """A coupling has the axes and bytes of both parts."""
    robot = scara_with_c()
    assert [a.name for a in robot.AXES] == ["A1", "A2", "Z", "C"]
    assert [b.name for b in robot.CONFIGURATION] == ["elbow", "A1", "A2", "C"]
    assert [b.kind for b in robot.CONFIGURATION] == ["branch", "period", "period", "period"]
    assert robot.DEFAULT_CONFIGURATION == (1, 0, 0, 0)
    assert (robot.BRANCHES, robot.PERIOD_AXES, robot.DISTANCE_AXES) == (1, (0, 1, 3), (0, 1, 3))
    assert robot.MARGINS == ("elbow",) and robot.PARAMETERS == () and dict(robot.parameters) == {}
    assert robot.NAME == "Coupled(Kin_Scara2_Z, Kin_CAxis)"
    assert repr(robot) == "Coupled(Scara2Z(arm_length_1=300.0, arm_length_2=250.0), CAxis())"
    assert robot.position_part.ROLE == "position" and robot.orientation_part.ROLE == "orientation"


def test_the_same_names_in_both_parts() -> None:
    """Axes and bytes with equal names get different names in a coupling."""
    robot = softkin.Coupled(softkin.HGantry2(), softkin.Wrist2())
    assert [a.name for a in robot.AXES] == ["A", "B", "orientation A", "orientation B"]
    robot = softkin.Coupled(softkin.PosRRR(**ARM), softkin.Wrist3())
    assert [b.name for b in robot.CONFIGURATION] == ["arm", "elbow", "A1", "A2", "A3", "hand", "A", "B", "C"]
    assert len(set(robot.MARGINS)) == len(robot.MARGINS) == 3


def test_the_image() -> None:
    """The degrees of freedom of the tool follow from those of both parts."""
    assert scara_with_c().orientation_image().freedom == "one"
    gantry = softkin.Gantry3()
    freedoms = {
        "zero": softkin.Coupled(gantry, softkin.Tool(tool_x=3.0)),
        "one": softkin.Coupled(gantry, softkin.CAxisTool(tool_x=3.0)),
        "three": softkin.Coupled(gantry, softkin.Wrist2()),
    }
    for freedom, robot in freedoms.items():
        image = robot.orientation_image()
        assert image.freedom == freedom == robot.FREEDOM
        assert np.array(image.rotation) @ np.array(image.flange_axis) == pytest.approx(np.array(image.base_axis))
    assert softkin.Coupled(softkin.PosRRR(**ARM), softkin.CAxis()).FREEDOM == "three"
    assert softkin.Coupled(softkin.Polar(), softkin.Tool(tool_z=5.0)).FREEDOM == "one"


def test_parts_of_the_wrong_kind() -> None:
    scara, wrist = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0), softkin.Wrist3()
    whole = softkin.Kin5Axes()
    for first, second, place in (
        (scara, scara, "second"),
        (wrist, wrist, "first"),
        (whole, wrist, "first"),
        (scara, whole, "second"),
        (scara_with_c(), wrist, "first"),
        (scara, scara_with_c(), "second"),
        (scara, None, "second"),
        ("scara", wrist, "first"),
    ):
        says = f"^Coupled: the {place} part must be a"
        assert refusal(softkin.Coupled, first, second, says=says) is Status.INVALID_COUPLING
    following, says = softkin.SCCC(link_length_1=300.0, link_length_2=200.0), "follows the turn of the tool itself"
    assert refusal(softkin.Coupled, following, wrist, says=says) is Status.INVALID_COUPLING


def test_a_plane_is_met_or_refused() -> None:
    """Two slides and two turns: z is not free."""
    robot = softkin.Coupled(softkin.Gantry2(), softkin.Wrist2(tool_length=90.0))
    axes = (100.0, -50.0, 30.0, 40.0)
    (position, rotation), configuration = robot.forward(axes)
    assert robot.inverse((position, rotation), configuration, axes) == pytest.approx(axes, abs=1e-9)
    for shift in (-1.0, 0.1):
        lifted = (*position[:2], position[2] + shift)
        assert refusal(robot.inverse, (lifted, rotation), configuration, axes) is Status.UNREACHABLE
        assert all(s.status is Status.UNREACHABLE for s in robot.inverse_all((lifted, rotation)))
        statuses = robot.inverse_batch([lifted, position], [rotation] * 2)[1]
        assert list(statuses) == [Status.UNREACHABLE, Status.OK]


def test_a_tool_that_points_the_opposite_way() -> None:
    """No twist is nearest then; a wrist with three axes has it."""
    down = ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0))
    frame = (300.0, 100.0, 50.0), down
    assert refusal(scara_with_c().inverse, frame) is Status.UNREACHABLE
    assert list(scara_with_c().inverse_batch([frame[0]], [down])[1]) == [Status.UNREACHABLE]
    carrier = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0)
    robot = softkin.Coupled(carrier, softkin.Wrist3(tool_offset_z=75.0))
    found, _ = robot.forward(robot.inverse(frame))
    assert np.abs(np.subtract(found.rotation, down)).max() < 1e-12


def test_limits_are_those_of_the_parts() -> None:
    robot = scara_with_c(lower_c=-10.0, upper_c=10.0)
    for c, allowed in ((5.0, True), (15.0, False)):
        axes = (10.0, 20.0, 30.0, c)
        frame, configuration = robot.forward(axes)
        statuses = robot.inverse_batch([frame.position], [frame.rotation], [configuration], [axes])[1]
        assert list(statuses) == [Status.OK if allowed else Status.UNREACHABLE]
        if allowed:
            assert robot.inverse(frame, configuration, axes) == pytest.approx(axes, abs=1e-9)
        else:
            assert refusal(robot.inverse, frame, configuration, axes) is Status.UNREACHABLE
    unchecked = scara_with_c(lower_c=-10.0, upper_c=10.0, check_limits=False)
    assert unchecked.inverse(frame, configuration, axes) == pytest.approx(axes, abs=1e-9)


@pytest.mark.parametrize("garbage", (math.nan, math.inf, -math.inf, 1e300, 1.1e9))
@pytest.mark.parametrize("carrier", (softkin.Gantry3(), softkin.PosRRR(**ARM)), ids=("gantry", "arm"))
def test_garbage(carrier: softkin.Mechanism, garbage: float) -> None:
    """A refusal wherever the number stands, alone and in a batch; what is not needed is not looked at."""
    robot = softkin.Coupled(carrier, softkin.Wrist3(tool_offset_z=75.0))
    axes = [5.0, 10.0, 15.0, 20.0, 25.0, 30.0]
    frame, configuration = robot.forward(axes)
    for i in range(6):
        wrong = [*axes[:i], garbage, *axes[i + 1 :]]
        assert refusal(robot.forward, wrong) is Status.BAD_INPUT
        if carrier.BRANCHES or i >= 3:
            assert refusal(robot.orientation, wrong) is Status.BAD_INPUT
            assert refusal(robot.jacobian, wrong) is Status.BAD_INPUT
            assert robot.singularity(wrong).is_singular
            assert refusal(robot.inverse, frame, (0,) * len(configuration), wrong) is Status.BAD_INPUT
        assert list(robot.forward_batch([axes, wrong])[3]) == [Status.OK, Status.BAD_INPUT]
    for i in range(12):
        numbers = [*frame.position, *np.ravel(frame.rotation).tolist()]
        numbers[i] = garbage
        wrong_frame = tuple(numbers[:3]), (tuple(numbers[3:6]), tuple(numbers[6:9]), tuple(numbers[9:]))
        assert refusal(robot.inverse, wrong_frame) is Status.BAD_INPUT
        assert {s.status for s in robot.inverse_all(wrong_frame)} == {Status.BAD_INPUT}
        assert list(robot.inverse_batch([wrong_frame[0]], [wrong_frame[1]])[1]) == [Status.BAD_INPUT]


def test_a_configuration_selects() -> None:
    """Bytes of both parts, in the order of the axes; what is no configuration is refused."""
    robot = softkin.Coupled(softkin.PosRRR(**ARM), softkin.Wrist3(tool_offset_z=75.0))
    axes = (370.0, 40.0, -30.0, -500.0, 50.0, 60.0)
    frame, configuration = robot.forward(axes)
    assert configuration == (*configuration[:2], 2, 1, 1, configuration[5], -1, 1, 1)
    assert robot.inverse(frame, configuration) == pytest.approx(axes, abs=1e-9)
    other = (*configuration[:5], 3 - configuration[5], *configuration[6:])
    flipped = robot.inverse(frame, other)
    assert flipped[:3] == pytest.approx(axes[:3], abs=1e-9) and flipped[4] == pytest.approx(-50.0, abs=1e-9)
    assert refusal(robot.inverse, frame, (4, *configuration[1:])) is Status.BAD_INPUT
    assert refusal(robot.inverse, frame, (*configuration[:5], 4, *configuration[6:])) is Status.BAD_INPUT
    assert refusal(robot.inverse, frame, configuration[1:]) is Status.BAD_INPUT
    wrong = np.array([configuration, (*configuration[:5], 4, *configuration[6:])])
    assert list(robot.inverse_batch([frame.position] * 2, [frame.rotation] * 2, wrong)[1]) == [
        Status.OK,
        Status.BAD_INPUT,
    ]


def test_singular_poses_are_answers() -> None:
    """The wrist stretched and the elbow nearly so: the reference decides what is free."""
    robot = softkin.Coupled(softkin.PosRRR(**ARM), softkin.Wrist3(tool_offset_z=75.0))
    axes = (10.0, 40.0, -30.0, 25.0, 0.0, 60.0)
    frame, configuration = robot.forward(axes)
    assert configuration[5] == 3 and robot.singularity(axes).is_singular
    assert robot.inverse(frame, configuration, axes) == pytest.approx(axes, abs=1e-9)
    again, _ = robot.forward(robot.inverse(frame, configuration, (0.0,) * 6))
    assert np.abs(np.subtract(again.position, frame.position)).max() < 1e-9


def test_an_automatic_choice_where_only_slides_tell() -> None:
    """Branches of a position part without a rotary axis are told apart by its slides."""
    scissors = softkin.catalogue()["Kin_P2X_Type1"]
    needed = {p.name: 400.0 for p in scissors.PARAMETERS if p.default is None}
    robot = softkin.Coupled(scissors(**needed), softkin.CAxis())
    assert robot.DISTANCE_AXES == (0, 1, 2)
    assert softkin.Coupled(softkin.Gantry3(), softkin.Wrist2()).DISTANCE_AXES == (3, 4)
    assert softkin.Coupled(softkin.Gantry3(), softkin.Tool()).DISTANCE_AXES == (0, 1, 2)


def test_a_diagnosis_names_the_part_that_refuses() -> None:
    robot = softkin.Coupled(
        softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0, lower_z=-50.0, upper_z=80.0),
        softkin.CAxis(lower_c=-90.0, upper_c=90.0),
    )
    frame, configuration = robot.forward((10.0, 20.0, 30.0, 40.0))
    assert robot.diagnose(frame, configuration)[:4] == (Status.OK, "", 0.0, 0)
    far = softkin.Frame((600.0, 0.0, 0.0), frame.rotation)
    found = robot.diagnose(far, configuration)
    assert found.status is Status.UNREACHABLE and found.reason.startswith("Kin_Scara2_Z: ")
    assert found.missing == pytest.approx(50.0)
    high = softkin.Frame((frame.position[0], frame.position[1], 83.0), frame.rotation)
    found = robot.diagnose(high, configuration)
    assert found.status is Status.UNREACHABLE and found.reason.startswith("Kin_Scara2_Z: ") and "Z" in found.reason
    assert found.missing == pytest.approx(3.0)
    turned, configuration = robot.forward((10.0, 20.0, 30.0, 95.0))
    found = robot.diagnose(turned, configuration)
    assert found.status is Status.UNREACHABLE and found.reason.startswith("Kin_CAxis: ") and "C" in found.reason
    assert found.missing == pytest.approx(5.0)
    assert robot.diagnose(turned, (7, 0, 0, 0)).status is Status.BAD_INPUT
    assert robot.diagnose(frame, (1, -2, 1, 1)).status is status_of(robot.inverse, frame, (1, -2, 1, 1))


ROOT = math.sqrt(0.5)


def frame_of(robot: softkin.Mechanism, *axes: float) -> tuple[np.ndarray, np.ndarray]:
    """Position and rotation of the flange at axis values."""
    frame, _ = robot.forward(axes)
    return np.array(frame.position), np.array(frame.rotation)


@pytest.mark.parametrize(("side", "height"), [(1, 90.0), (-1, -90.0)])
def test_the_inclination_moves_the_tool_to_x(side: int, height: float) -> None:
    """Library 4.16 and later: the tool points along +Z; 4.12: along -Z. A positive angle moves both to +X."""
    for robot, zeros in (
        (softkin.Kin5Axes(tool_length=90.0, tool_side=side), (0.0, 0.0, 0.0)),
        (softkin.Coupled(softkin.Gantry3(), softkin.Wrist2(tool_length=90.0, tool_side=side)), (0.0, 0.0, 0.0)),
        (softkin.Wrist2(tool_length=90.0, tool_side=side), ()),
    ):
        position, rotation = frame_of(robot, *zeros, 0.0, 0.0)
        assert position == pytest.approx((0.0, 0.0, height), abs=1e-12)
        assert rotation == pytest.approx(np.eye(3), abs=1e-12)
        assert frame_of(robot, *zeros, 0.0, 90.0)[0] == pytest.approx((90.0, 0.0, 0.0), abs=1e-12)
        assert frame_of(robot, *zeros, 90.0, 90.0)[0] == pytest.approx((0.0, 90.0, 0.0), abs=1e-12)
        assert frame_of(robot, *zeros, 0.0, 45.0)[0] == pytest.approx((90.0 * ROOT, 0.0, height * ROOT), abs=1e-12)


def test_the_roll_axis_offset_is_seen_behind_the_yaw() -> None:
    robot = softkin.Wrist2(tool_length=90.0, roll_axis_offset_x=12.0, roll_axis_offset_y=-7.0, roll_axis_offset_z=-40.0)
    assert frame_of(robot, 90.0, 0.0)[0] == pytest.approx((7.0, 12.0, 50.0), abs=1e-12)


def test_a_wrist_with_three_axes() -> None:
    """Its middle axis turns about the negative Y: hand down is positive, and the angles have closed forms."""
    robot = softkin.Wrist3(tool_offset_z=75.0)
    assert frame_of(robot, 0.0, 90.0, 0.0)[0] == pytest.approx((-75.0, 0.0, 0.0), abs=1e-12)
    assert frame_of(robot, 0.0, 0.0, 0.0)[0] == pytest.approx((0.0, 0.0, 75.0), abs=1e-12)
    rng = np.random.default_rng(53)
    for _ in range(20):
        r = np.array(tilted(rng))
        for byte, s in ((1, 1.0), (2, -1.0)):
            expected = (
                math.atan2(-s * r[1, 2], -s * r[0, 2]),
                math.atan2(s * math.hypot(r[0, 2], r[1, 2]), r[2, 2]),
                math.atan2(-s * r[2, 1], s * r[2, 0]),
            )
            found = robot.inverse(((0.0, 0.0, 0.0), r.tolist()), (byte, 0, 0, 0))
            assert found == pytest.approx([math.degrees(v) for v in expected], abs=1e-9)


def test_a_c_axis_reaches_all_but_the_half_turns() -> None:
    """ "All orientations except those rotated about X or Y by 180 degrees", by phi = atan2(r21 - r12, r11 + r22)."""
    robot, rng = softkin.CAxis(), np.random.default_rng(59)
    for _ in range(20):
        r = np.array(tilted(rng))
        expected = math.degrees(math.atan2(r[1, 0] - r[0, 1], r[0, 0] + r[1, 1]))
        assert robot.inverse(((0.0, 0.0, 0.0), r.tolist())) == pytest.approx((expected,), abs=1e-9)
    for half_turn in (np.diag((1.0, -1.0, -1.0)), np.diag((-1.0, 1.0, -1.0))):
        with pytest.raises(softkin.KinematicsError):
            robot.inverse(((0.0, 0.0, 0.0), half_turn.tolist()))


def test_a_tool_on_a_c_axis_is_parallel_to_the_flange_at_zero() -> None:
    """The shifts of a tool turn with the C axis, and stay fixed on a flange without an axis."""
    robot = softkin.CAxisTool(tool_x=15.0, tool_y=-8.0, tool_z=-60.0)
    assert frame_of(robot, 0.0)[0] == pytest.approx((15.0, -8.0, -60.0), abs=1e-12)
    assert frame_of(robot, 90.0)[0] == pytest.approx((8.0, 15.0, -60.0), abs=1e-12)
    still = softkin.Tool(tool_x=15.0, tool_y=-8.0, tool_z=-60.0)
    assert frame_of(still)[0] == pytest.approx((15.0, -8.0, -60.0)) and frame_of(still)[1] == pytest.approx(np.eye(3))
