"""A base and a tool around every machine: the truth is its equations, and the product of three matrices."""

import copy
import math
import pickle

import numpy as np
import pytest
import softkin
from hypothesis import given, settings
from hypothesis import strategies as st
from softkin import Frame, KinematicsError, Status

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.mounted.machines import BASE, EVERY, LATERAL, TOOL, Sample, matrices, sample_of, tools_of
from tests.catalogue.references import held_at
from tests.catalogue.refusals import refusal, status_of
from tests.catalogue.search.arms import frame as frame_of_arm
from tests.mechanisms import in_the_task
from tests.orthonormal import turned
from tests.text.samples import tilted

pytestmark = [pytest.mark.long("Hexapod"), pytest.mark.broad]

EVERY_MECHANISM = pytest.mark.parametrize("mechanism", EVERY, ids=lambda m: m.name)
ASIDE = Frame((25.0, 0.0, 0.0))


def size(sample: Sample) -> float:
    """The size of the machine with base and tool."""
    return sample.reach + float(np.abs(sample.flange[:, :3, 3]).max()) + 600.0


def moving(sample: Sample) -> bool:
    """Whether the inverse follows a position: not that of a machine which only turns."""
    return not {*"xyz"}.isdisjoint(sample.robot.JACOBIAN_ROWS)


@pytest.mark.slow("Hexaglide", "Kin_Hexapod")
@pytest.mark.long("Ac6")
@EVERY_MECHANISM
def test_its_frames_are_those_of_the_tool(mechanism: Mechanism) -> None:
    """Forward kinematics is base times flange times tool; the inverse leads back, alone and in a batch."""
    sample = sample_of(mechanism)
    for tool in tools_of(sample):
        robot = sample.robot.with_tool(tool).with_base(BASE)
        expected = BASE.matrix @ sample.flange @ tool.matrix
        positions, rotations, configurations, statuses = robot.forward_batch(sample.axes)
        assert (statuses == Status.OK).all()
        assert np.abs(matrices(positions, rotations) - expected).max() < 1e-12 * size(sample)
        near = held_at(robot, sample.axes, sample.axes)
        back, statuses = robot.inverse_batch(expected, None, configurations, near)
        assert (statuses == Status.OK).all() and np.abs(back - sample.axes).max(initial=0.0) < 1e-6
        every, outcomes = robot.inverse_all_batch(expected, None, near)
        for k, axes in enumerate(sample.axes.tolist()):
            frame, configuration = robot.forward(axes)
            assert np.abs(frame.matrix - matrices(positions, rotations)[k]).max() < 1e-12 * size(sample)
            assert configuration == tuple(configurations[k])
            assert robot.orientation(axes) == frame.rotation
            assert robot.inverse(frame, configuration, axes) == pytest.approx(tuple(axes), abs=1e-6)
            assert robot.inverse(expected[k], configuration, axes) == pytest.approx(tuple(back[k]), abs=1e-7)
            slots = robot.inverse_all(expected[k], axes)
            assert any(s.axes is not None and s.axes == pytest.approx(tuple(axes), abs=1e-5) for s in slots)
            for slot, found, status in zip(slots, every[k], outcomes[k], strict=True):
                assert slot.status == status
                assert slot.axes is None or slot.axes == pytest.approx(tuple(found), abs=1e-6)


@EVERY_MECHANISM
def test_every_slot_meets_the_position(mechanism: Mechanism) -> None:
    """Any rotation is commanded: whatever the machine makes of it, each answer has the tool where it was commanded."""
    sample = sample_of(mechanism)
    rng = np.random.default_rng(5)
    for tool in tools_of(sample):
        robot = sample.robot.with_base(BASE).with_tool(tool)
        for pose, axes in zip(BASE.matrix @ sample.flange @ tool.matrix, sample.axes.tolist(), strict=True):
            place = pose[:3, 3]
            start = {"start": pose} if mechanism.is_platform else {}  # a far pose is not found from home
            commanded = pose[:3, :3] if mechanism.is_platform else tilted(rng)
            for slot in robot.inverse_all((place, commanded), axes):
                if slot.axes is not None and moving(sample):
                    reached = robot.forward(slot.axes, **start)[0]
                    apart = in_the_task(mechanism.name, BASE.matrix[:3, :3].T @ (reached.position - place))
                    assert np.abs(apart).max() < 2e-9 * size(sample)


@EVERY_MECHANISM
def test_what_the_equations_do_not_determine_is_refused(mechanism: Mechanism) -> None:
    """A tool to the side of a flange that turns by itself; beside or inclined to a tool whose direction is followed."""
    sample = sample_of(mechanism)
    inclined = Frame.from_euler(0.0, 30.0, 0.0)
    refused = [ASIDE] if (sample.turns_by_itself or sample.follows_the_direction) and moving(sample) else []
    refused += [inclined] if sample.follows_the_direction else []
    for tool in refused:
        with pytest.raises(KinematicsError, match="does not determine the flange") as refusal:
            sample.robot.with_tool(tool)
        assert refusal.value.status is Status.INVALID_COUPLING and mechanism.name in str(refusal.value)
    for tool in (ASIDE, inclined):
        assert tool in refused or sample.robot.with_tool(tool).tool == tool


def test_the_documented_cases() -> None:
    """What is truly undetermined, by name, and what is not."""
    undetermined = {"Kin_Scara2_Z", "Kin_Scara3_CCZ", "Kin_Polar", "Kin_Polar_Z", "Kin_Pos_RRR", "Softkin_Transmit"}
    directions = {m.name for m in EVERY if m.task.turning is Turning.DIRECTION and m.task.position}
    found = set()
    for mechanism in EVERY:
        try:
            sample_of(mechanism).robot.with_tool(ASIDE)
        except KinematicsError:
            found.add(mechanism.name)
    assert found == undetermined | directions and len(directions) == 15


@EVERY_MECHANISM
def test_the_nearest_rotation_is_that_of_the_flange(mechanism: Mechanism) -> None:
    """A rotation out of reach: the flange takes the nearest of all its turns about its axis."""
    if mechanism.task.turning is not Turning.ABOUT_Z or not mechanism.task.position.startswith("xy"):
        return
    sample, rng = sample_of(mechanism), np.random.default_rng(3)
    robot = sample.robot.with_tool(TOOL).with_base(BASE)
    turns = turned(2, np.radians(np.linspace(0.0, 360.0, 721)))
    zero = np.array(sample.robot.orientation_image().rotation)
    answered = 0
    for axes in sample.axes.tolist():
        (place, own), configuration = robot.forward(axes)
        commanded = np.array(tilted(rng))
        if mechanism.is_platform:  # so that forward kinematics, from home, finds the pose
            commanded = np.array(own) @ Frame.from_euler(20.0, 15.0, -10.0).rotation
        flange = np.array(BASE.rotation).T @ commanded @ np.array(TOOL.rotation).T
        best = np.einsum("nij,ij->n", turns @ zero, flange).max()
        for slot in robot.inverse_all((place, commanded), axes):
            is_own = slot.configuration[: robot.BRANCHES] == configuration[: robot.BRANCHES]
            if slot.axes is not None and (is_own or not mechanism.is_platform):
                answered += 1
                own = np.array(sample.robot.orientation(slot.axes))
                assert np.sum(own * flange) >= best - 1e-12
                assert np.abs(np.subtract(robot.forward(slot.axes)[0].position, place)).max() < 2e-9 * size(sample)
    assert answered


ANGLES, LENGTHS = st.floats(-180.0, 180.0), st.floats(-500.0, 500.0)
FRAMES = st.builds(Frame.from_euler, ANGLES, ANGLES, ANGLES, st.tuples(LENGTHS, LENGTHS, LENGTHS))


@settings(max_examples=30)
@given(FRAMES, FRAMES, st.tuples(*[st.floats(-170.0, 170.0)] * 6))
def test_any_base_and_any_tool(base: Frame, tool: Frame, axes: tuple[float, ...]) -> None:
    """Of six axes and of four: base times flange times tool; and the answer has the frame, alone and in a batch."""
    arm = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
    quill = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, pitch_zc=20.0)
    for bare, given_axes in ((arm, axes), (quill, axes[:4])):
        robot = bare.with_base(base).with_tool(tool)
        frame, configuration = robot.forward(given_axes)
        assert np.abs(base.matrix @ bare.forward(given_axes)[0].matrix @ tool.matrix - frame.matrix).max() < 1e-11
        found = robot.inverse(frame, configuration, given_axes)
        assert np.abs(robot.forward(found)[0].matrix - frame.matrix).max() < 1e-8
        together, statuses = robot.inverse_batch([frame], None, configuration, given_axes)
        assert statuses.tolist() == [Status.OK]
        reached = robot.forward_batch(together)
        assert np.abs(matrices(reached[0], reached[1])[0] - frame.matrix).max() < 1e-8


def test_bases_and_tools_compose() -> None:
    """Two tools are their product, two bases likewise, in every order of the calls; and it says so."""
    bare = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
    second = Frame.from_quaternion((0.1, 0.2, 0.3, math.sqrt(0.86)), (5.0, 6.0, 7.0))
    once = bare.with_tool(TOOL @ second).with_base(second @ BASE)
    axes = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)
    for robot in (
        bare.with_tool(TOOL).with_tool(second).with_base(BASE).with_base(second),
        bare.with_base(BASE).with_tool(TOOL).with_base(second).with_tool(second),
    ):
        assert robot.bare is bare
        assert np.abs(robot.tool.matrix - once.tool.matrix).max() < 1e-12
        assert np.abs(robot.base.matrix - once.base.matrix).max() < 1e-12
        assert np.abs(robot.forward(axes)[0].matrix - once.forward(axes)[0].matrix).max() < 1e-9
    assert once.NAME == "Kin_ArticulatedRobot_6DOF on a base with a tool" and once.ROLE == "complete"
    known = {"ArticulatedRobot6DOF": softkin.ArticulatedRobot6DOF, "Frame": Frame}
    assert repr(eval(repr(once), known)) == repr(once)
    for other in (copy.copy(once), copy.deepcopy(once), pickle.loads(pickle.dumps(once))):
        assert repr(other) == repr(once) and other.forward(axes) == once.forward(axes)
    assert once == bare.with_tool(once.tool).with_base(once.base) != bare.with_tool(once.tool)
    assert len({once, bare.with_tool(once.tool).with_base(once.base)}) == 1


def test_an_iterative_machine_starts_where_the_tool_is() -> None:
    """The start is a frame of the tool, alone and in a batch."""
    sample = sample_of(next(m for m in EVERY if m.name == "Kin_Hexapod"))
    robot = sample.robot.with_tool(TOOL).with_base(BASE)
    for axes in sample.axes.tolist():
        frame, _ = robot.forward(axes)
        again, _ = robot.forward(axes, start=frame)
        assert np.abs(again.matrix - frame.matrix).max() < 1e-8
        for start in (frame, frame.matrix, [frame], ([frame.position], [frame.rotation])):
            positions, rotations, _, statuses = robot.forward_batch([axes], start=start)
            assert statuses.tolist() == [Status.OK] and np.abs(positions[0] - frame.position).max() < 1e-8
            assert np.abs(rotations[0] - frame.rotation).max() < 1e-10
        for wrong in (frame.matrix[:3], frame.matrix + 1e-3, "no frame", [frame.position]):
            assert refusal(robot.forward_batch, [axes], start=wrong) is Status.BAD_INPUT
    upside_down = (frame.position, np.array(frame.rotation) @ np.diag([1.0, -1.0, -1.0]))
    outcome = robot.forward_batch([axes], start=upside_down)[3]
    try:
        robot.forward(axes, start=upside_down)
    except KinematicsError as refused:
        assert outcome.tolist() == [refused.status]
    else:
        assert outcome.tolist() == [Status.OK]


def test_a_searched_arm_keeps_its_further_solutions() -> None:
    """Every root of the search is a solution of the mounted arm, in the same slot and order."""
    sample = sample_of(next(m for m in EVERY if m.search is not None))
    robot = sample.robot.with_tool(TOOL).with_base(BASE)
    further = 0
    drawn = np.random.default_rng(1).uniform(-170.0, 170.0, (40, 6))
    for pose, axes in zip(frame_of_arm(drawn, LATERAL), drawn.tolist(), strict=True):
        bare = sample.robot.inverse_all(pose, axes)
        for slot, expected in zip(robot.inverse_all(BASE.matrix @ pose @ TOOL.matrix, axes), bare, strict=True):
            assert slot.status == expected.status and len(slot.others) == len(expected.others)
            for own, other in zip(slot.others, expected.others, strict=True):
                further += 1
                assert own == pytest.approx(other, abs=1e-5)
        skewed = robot.inverse_all((pose[:3, 3], 1.01 * pose[:3, :3]), axes)
        assert {s.status for s in skewed} == {Status.BAD_INPUT}
    assert further


@pytest.mark.long("Ac6")
@EVERY_MECHANISM
def test_garbage_is_refused_alike(mechanism: Mechanism) -> None:
    """Numbers that are none, wherever they stand: the same status alone and in a batch, and never an answer."""
    sample = sample_of(mechanism)
    robot = sample.robot.with_tool(tools_of(sample)[-1]).with_base(BASE)
    axes = sample.axes[0].tolist()
    frame, configuration = robot.forward(axes)
    for garbage in (math.nan, math.inf, -math.inf, 1e300, 1e9 + 10.0):
        for place in range(12):
            matrix = frame.matrix
            matrix[place // 4, place % 4] = garbage
            alone = status_of(robot.inverse, matrix, configuration, axes)
            together = robot.inverse_batch(matrix[None], None, configuration, axes)[1]
            assert together.tolist() == [alone]
            assert {s.status for s in robot.inverse_all(matrix, axes)} >= {alone} - {Status.OK}
            reads = place % 4 == 3 and moving(sample)
            assert alone is not Status.OK or not (reads or (sample.robot.READS_ROTATION and place % 4 < 3))
        for place in range(len(axes)):
            wrong = [*axes[:place], garbage, *axes[place + 1 :]]
            with pytest.raises(KinematicsError):
                robot.jacobian(wrong)
            assert robot.forward_batch([wrong])[3][0] != Status.OK
            assert robot.singularity(wrong).is_singular and robot.singularity_batch([wrong])[0].all()


@EVERY_MECHANISM
def test_metres_give_what_millimetres_give(mechanism: Mechanism) -> None:
    """The same machine, base and tool in metres: angles are the same, lengths a thousandth."""
    sample = sample_of(mechanism)
    given = {
        p.name: sample.robot.parameters[p.name] * (1e-3 if p.unit.startswith("u") else 1.0)
        for p in sample.robot.PARAMETERS
    }
    small = type(sample.robot)(**given)
    lengths = np.array([1e-3 if axis.unit == "u" else 1.0 for axis in small.AXES])
    for tool in tools_of(sample):
        large = sample.robot.with_tool(tool).with_base(BASE)
        robot = small.with_tool(_metres(tool)).with_base(_metres(BASE))
        assert robot.JACOBIAN_ROWS == large.JACOBIAN_ROWS
        for axes in sample.axes[:3]:
            frame, configuration = large.forward(axes)
            found, written = robot.forward(axes * lengths)
            assert np.abs(found.matrix - _metres(frame).matrix).max() < 1e-11 and written == configuration
            back = np.array(robot.inverse(_metres(frame), configuration, axes * lengths))
            assert np.abs(back / lengths - axes).max(initial=0.0) < 1e-6


def _metres(frame: Frame) -> Frame:
    x, y, z = frame.position
    return Frame((1e-3 * x, 1e-3 * y, 1e-3 * z), frame.rotation)


def test_limits_are_those_of_the_bare_machine() -> None:
    """Limits refuse, with the axis; where they are not tested they do not."""
    given = {"link_length_1": 325.0, "link_length_2": 225.0, "lower_a3": -50.0, "upper_a3": 80.0}
    for checks in (True, False):
        robot = softkin.Scara4ZCcoupledType1(**given, check_limits=checks).with_tool(ASIDE).with_base(BASE)
        frame, configuration = robot.forward((10.0, 20.0, 90.0, 30.0))
        statuses = robot.inverse_batch([frame], None, configuration)[1].tolist()
        if checks:
            assert statuses == [Status.UNREACHABLE]
            found = robot.diagnose(frame, configuration)
            assert "A3" in found.reason and found.missing == pytest.approx(10.0)
        else:
            assert statuses == [Status.OK] and robot.inverse(frame, configuration)[2] == pytest.approx(90.0)
