"""AxisSettings: limits that only the drives know narrow those of a block, whichever comes first, or are refused.

For every block with turns to choose from, positions, loops and orientation kinematics alike. What a block and its
drives allow together is a machine in Python with the common limits.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import product

import pytest
import softkin

from derive.description.mechanism import Joint, Mechanism
from tests.text.controller import BAD_INPUT, NOT_INITIALIZED, OK, UNREACHABLE, Answer, Controller, asked, assert_same
from tests.text.settings import TURNING, Range, poses, robot_of, together
from tests.text.units import compiled

EVERY = pytest.mark.parametrize("mechanism", TURNING, ids=lambda m: m.name)
DRIVE = (-170.0, 170.0)
NAN, INF = math.nan, math.inf
NO_RANGES = ((10.0, -10.0), (NAN, 10.0), (-10.0, NAN), (NAN, NAN), (INF, -INF), (1e300, -1e300))
NO_AXES = (6, 255, 2**32 - 1)


def at(mechanism: Mechanism, joint: Joint, value: float, **given: float) -> tuple[softkin.Mechanism, tuple[float, ...]]:
    """A machine whose axis has that value at a regular pose, and all axis values there."""
    index, motors = mechanism.joints.index(joint), poses(mechanism)[0]
    offset = value - motors[index]
    axes = tuple(value if i == index else motor for i, motor in enumerate(motors))
    return robot_of(mechanism, **{joint.offset.name: offset, **given}), axes


def block_of(mechanism: Mechanism) -> Controller:
    return Controller(compiled(mechanism), mechanism)


def started(robot: softkin.Mechanism, mechanism: Mechanism, drives: Sequence[Range] = ()) -> Controller:
    """A block with the parameters of a machine; then its drives are heard."""
    block = block_of(mechanism)
    assert block.initialise(robot.parameters) == OK
    assert [block.axis_settings(axis, drive) for axis, drive in enumerate(drives)] == [OK] * len(drives)
    return block


def moved(block: Controller, robot: softkin.Mechanism, axes: Sequence[float], reference: Sequence[float]) -> Answer:
    """Point to point: the branches of the pose, open turns."""
    frame, configuration = robot.forward(axes)
    status, found = block.inverse(*frame, opened(robot, configuration), reference)
    return status, found and found[: len(axes)]


def opened(robot: softkin.Mechanism, configuration: Sequence[int]) -> tuple[int, ...]:
    turns = len(configuration) - robot.BRANCHES
    return (*configuration[: robot.BRANCHES], *(0,) * turns)


def heard(block: Controller) -> dict[str, object]:
    """All that a block keeps, without what means nothing: the ends of no limits, the middle of several values."""
    state = block.state()
    for joint in block.mechanism.joints:
        if not state[f"driveLimited{joint.name}"]:
            del state[f"driveLower{joint.name}"], state[f"driveUpper{joint.name}"]
        if joint.multi_turn and not state[f"isSingle{joint.name}"]:
            del state[f"middle{joint.name}"]
    return state


def counted(state: dict[str, object]) -> dict[str, object]:
    """What limits come to: the ends that are tested, and what decides a turn."""
    return {
        name: value for name, value in state.items() if name.startswith(("lowest", "highest", "isSingle", "middle"))
    }


def of_axis(mechanism: Mechanism, joint: Joint, limits: Range) -> list[Range]:
    """Limits of one axis, and none of all others."""
    return [limits if other is joint else None for other in mechanism.joints]


def beside(axes: tuple[float, ...], index: int, value: float) -> tuple[float, ...]:
    """The axis values with another value in one place."""
    return (*axes[:index], value, *axes[index + 1 :])


def test_the_example_of_a_scara() -> None:
    """From 160 to -160 with +-170 in the drive alone: the way back, and not 40 degrees on, which SoftMotion refuses."""
    (mechanism,) = (m for m in TURNING if m.name == "Kin_Scara2_Z")
    robot = softkin.catalogue()[mechanism.name](arm_length_1=300.0, arm_length_2=250.0)
    block = started(robot, mechanism)
    axes, reference = (-160.0, 60.0, 10.0), (160.0, 60.0, 10.0)
    assert moved(block, robot, axes, reference) == (OK, pytest.approx((200.0, 60.0, 10.0)))
    assert block.axis_settings(0, DRIVE) == OK
    assert moved(block, robot, axes, reference) == (OK, pytest.approx(axes))
    assert block.axis_settings(0, None) == OK
    assert moved(block, robot, axes, reference) == (OK, pytest.approx((200.0, 60.0, 10.0)))


@pytest.mark.long("Ac6")
@EVERY
def test_the_drive_decides_the_turn(mechanism: Mechanism) -> None:
    """Of every axis with turns, both ways round; what the machine with these limits answers in
    Python, digit by digit.
    """
    for joint, value in product(mechanism.period_joints, (-160.0, 160.0)):
        index = mechanism.joints.index(joint)
        robot, axes = at(mechanism, joint, value)
        reference = beside(axes, index, -value)
        block = started(robot, mechanism)
        status, free = moved(block, robot, axes, reference)
        assert status == OK and free[index] == pytest.approx(value - math.copysign(360.0, value)), joint.name
        drives = of_axis(mechanism, joint, DRIVE)
        assert block.axis_settings(index, DRIVE) == OK
        found = moved(block, robot, axes, reference)
        assert found[0] == OK and found[1][index] == pytest.approx(value), joint.name
        if not any(other.coupling != 0 for other in mechanism.joints):  # through a gear one axis moves the next
            assert found[1] == pytest.approx(axes, abs=1e-6), joint.name
        both = together(mechanism, robot.parameters, drives)
        assert both is not None
        frame, configuration = robot.forward(axes)
        command = frame, opened(robot, configuration), reference
        assert_same(found, asked(type(robot)(**both).inverse, *command), mechanism.name, joint.name)


@EVERY
def test_the_order_of_the_calls_does_not_matter(mechanism: Mechanism) -> None:
    """Before Initialize, after it, repeated, through several: the last settings count, and all that is kept is the
    same.
    """
    last = [(-100.0 - k, 170.0 + k) if j.axis_is_angle else (-900.0, 900.0 + k) for k, j in enumerate(mechanism.joints)]
    first: list[Range] = [(-5.0, 5.0), None, (-1e6, 1e6)]
    robot = robot_of(mechanism)
    wanted = heard(started(robot, mechanism, last))
    for sequence in ("LI", "LLI", "FLI", "FILI", "IFL", "LII", "FIIL", "ILL"):
        block = block_of(mechanism)
        for step in sequence:
            if step == "I":
                assert block.initialise(robot.parameters) == OK, sequence
                continue
            for axis in range(len(mechanism.joints)):
                drive = last[axis] if step == "L" else first[(axis + sequence.index(step)) % 3]
                if block.axis_settings(axis, drive) != OK:  # a joint of the closure may not go there
                    assert step == "F" and mechanism.joints[axis].domain is not None
        assert heard(block) == wanted, sequence


@EVERY
def test_what_is_refused_changes_nothing(mechanism: Mechanism) -> None:
    """Before Initialize and after it, with limits in block and drive and without."""
    count = len(mechanism.joints)
    joint = mechanism.period_joints[0]
    index = mechanism.joints.index(joint)
    for own, drive in product(({}, {f"lower_{joint.key}": -90.0, f"upper_{joint.key}": 90.0}), (None, (-80.0, 100.0))):
        robot = robot_of(mechanism, **own)
        for block in (block_of(mechanism), started(robot, mechanism, of_axis(mechanism, joint, drive))):
            before = heard(block)
            for axis, limits in product(range(count), NO_RANGES):
                assert block.axis_settings(axis, limits) == BAD_INPUT
            for axis in (count, *NO_AXES):
                assert block.axis_settings(axis, drive) == BAD_INPUT
            if own and block.block.call("IsInitialized"):
                for limits in ((91.0, 200.0), (-200.0, -91.0), (1e300, 1e301)):
                    assert block.axis_settings(index, limits) == NOT_INITIALIZED
                assert block.block.call("IsInitialized")
            assert heard(block) == before
            if own:
                assert block.axis_settings(index, (90.0, 200.0)) == OK, "one value in common is no empty range"


@EVERY
def test_initialize_refuses_what_the_drives_exclude(mechanism: Mechanism) -> None:
    """Settings that came first are not the fault of the one who gave them; other settings or limits mend it."""
    for index, joint in enumerate(mechanism.joints):
        robot = robot_of(mechanism, **{f"lower_{joint.key}": -90.0, f"upper_{joint.key}": 90.0})
        block = block_of(mechanism)
        assert block.axis_settings(index, (100.0, 200.0)) == OK
        assert block.initialise(robot.parameters) == NOT_INITIALIZED and not block.block.call("IsInitialized")
        assert block.axis_properties(index)[1] is True
        assert block.axis_settings(index, (-INF, 50.0)) == OK and not block.block.call("IsInitialized")
        assert block.initialise(robot.parameters) == OK and block.block.call("IsInitialized")
        assert block.axis_settings(index, (100.0, 200.0)) == NOT_INITIALIZED and block.block.call("IsInitialized")
        assert heard(block)[f"highest{joint.name}"] == pytest.approx(50.0)


@EVERY
def test_wider_limits_are_none(mechanism: Mechanism) -> None:
    """Any wider ones: what is tested is as without. GetAxisProperties reports the limits of the block whatever the
    drives say.
    """
    limits: dict[str, float] = {}
    for joint in mechanism.joints:
        low, high = joint.limit_range or (-1e9, 1e9)
        limits |= {f"lower_{joint.key}": max(low, -300.0), f"upper_{joint.key}": min(high, 1500.0)}
    count = len(mechanism.joints)
    block = started(robot_of(mechanism, **limits), mechanism)
    alone, own = heard(block), [block.axis_properties(axis) for axis in range(6)]
    for wide in ((-INF, INF), (-1e300, 1e300), (-2000.0, 2000.0), (-300.0, 1500.0), None):
        assert [block.axis_settings(axis, wide) for axis in range(count)] == [OK] * count
        assert counted(heard(block)) == counted(alone), wide
        assert [block.axis_properties(axis) for axis in range(6)] == own
    assert [block.axis_settings(axis, (-50.0, 60.0)) for axis in range(count)] == [OK] * count
    assert counted(heard(block)) != counted(alone)
    assert [block.axis_properties(axis) for axis in range(6)] == own


@EVERY
def test_without_limits_in_the_block_those_of_the_drives_are_all(mechanism: Mechanism) -> None:
    """Larger than any axis value is no limit of a drive either; what the block itself is bound to stays."""
    block = started(robot_of(mechanism), mechanism)
    own = [block.axis_properties(axis) for axis in range(6)]
    for axis, joint in enumerate(mechanism.joints):
        low, high = (-INF, INF) if own[axis][1] else own[axis][2:]
        for limits in ((-INF, INF), (-1e9, 1e300), (20.0, 1e12), (-90.0, 90.0), (100.0, 449.0)):
            assert block.axis_settings(axis, limits) == OK
            state = heard(block)
            ends = (max(-1e9, low, limits[0]), min(1e9, high, limits[1]))
            assert (state[f"lowest{joint.name}"], state[f"highest{joint.name}"]) == pytest.approx(
                ends, rel=1e-8, abs=2.0
            )
            if joint.multi_turn:
                assert state[f"isSingle{joint.name}"] == (ends[1] - ends[0] <= 350.0)
    assert [block.axis_properties(axis) for axis in range(6)] == own


@pytest.mark.long("Ac6")
@EVERY
def test_every_axis_is_tested_against_both(mechanism: Mechanism) -> None:
    """The pose itself, just inside and just outside what the drive allows; xCheckLimits leaves the
    test to SoftMotion.
    """
    axes = poses(mechanism)[0]
    robot, unchecked = robot_of(mechanism), robot_of(mechanism, check_limits=False)
    for index, value in enumerate(axes):
        for limits, expected in (
            ((value - 1e-3, value + 50.0), OK),
            ((value - 50.0, value + 1e-3), OK),
            ((value + 1e-3, value + 50.0), UNREACHABLE),
            ((value - 50.0, value - 1e-3), UNREACHABLE),
        ):
            drives: list[Range] = [limits if i == index else None for i in range(len(axes))]
            assert moved(started(robot, mechanism, drives), robot, axes, axes)[0] == expected
            assert moved(started(unchecked, mechanism, drives), robot, axes, axes)[0] == OK


@EVERY
def test_the_turn_is_chosen_where_limits_are_not_tested(mechanism: Mechanism) -> None:
    for joint in mechanism.period_joints:
        index = mechanism.joints.index(joint)
        robot, axes = at(mechanism, joint, -160.0, check_limits=False)
        block = started(robot, mechanism, of_axis(mechanism, joint, DRIVE))
        status, found = moved(block, robot, axes, beside(axes, index, 160.0))
        assert status == OK and found[index] == pytest.approx(-160.0), joint.name
        assert block.axis_settings(index, (20.0, 330.0)) == OK
        status, found = moved(block, robot, axes, axes)
        assert status == OK and found[index] == pytest.approx(200.0), joint.name


@EVERY
def test_limits_of_block_and_drive_decide_together(mechanism: Mechanism) -> None:
    """Neither range has one value inside, what they have in common does."""
    for joint in mechanism.period_joints:
        index = mechanism.joints.index(joint)
        own = {f"lower_{joint.key}": -170.0, f"upper_{joint.key}": 340.0}
        robot, axes = at(mechanism, joint, -160.0, **own)
        reference = beside(axes, index, 160.0)
        block = started(robot, mechanism)
        assert moved(block, robot, axes, reference)[1][index] == pytest.approx(200.0)
        assert block.axis_settings(index, (-350.0, 170.0)) == OK
        assert moved(block, robot, axes, reference)[1][index] == pytest.approx(-160.0)
        assert block.axis_settings(index, (-150.0, 170.0)) == OK
        assert moved(block, robot, axes, reference)[0] == UNREACHABLE, "limits refuse, they never choose another turn"


CHANGES: tuple[Range, ...] = (
    None, DRIVE, (100.0, 440.0), (-720.0, 720.0), (-40.0, 20.0), (-250.0, -150.0), (-180.0, 180.0),
)  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("name", ["Kin_Scara2_Z", "Kin_Scara4_ZCcoupled_Type1", "Kin_Wrist3", "Kin_SCCC"])
def test_a_call_while_the_settings_change(name: str) -> None:
    """Behind every one of its assignments: the answer before, the answer from then on, or a refusal."""
    (mechanism,) = (m for m in TURNING if m.name == name)
    joint = mechanism.period_joints[0]
    index = mechanism.joints.index(joint)
    instants = 0
    for value in (-160.0, -30.0, 130.0):
        robot, axes = at(mechanism, joint, value)
        reference = beside(axes, index, value + 290.0)
        for old, new in product(CHANGES, CHANGES):
            block = started(robot, mechanism, of_axis(mechanism, joint, old))
            before = moved(block, robot, axes, reference)
            seen: list[Answer] = []
            with _between(block, partial(moved, block, robot, axes, reference), seen):
                assert block.axis_settings(index, new) == OK
            after = moved(block, robot, axes, reference)
            allowed = (before, after, (UNREACHABLE, None))
            assert all(one in allowed for one in seen), (value, old, new, before, seen, after)
            instants += len(seen)
    assert instants > 6 * 3 * len(CHANGES) ** 2


@contextmanager
def _between(block: Controller, look: Callable[[], Answer], seen: list[Answer]) -> Iterator[None]:
    """Look behind every assignment to what a block keeps of an axis, as a task that interrupts there does."""
    kept = block.block.axes
    plain = type(kept[0])

    def assign(self: object, name: str, value: object) -> None:
        object.__setattr__(self, name, value)
        seen.append(look())

    for one in kept:
        one.__class__ = type(plain.__name__, (plain,), {"__slots__": (), "__setattr__": assign})
    yield
    for one in kept:
        one.__class__ = plain


def every_statement_of_the_settings(mechanism: Mechanism) -> None:
    """For those who watch which statements run."""
    if mechanism in TURNING:
        test_the_order_of_the_calls_does_not_matter(mechanism)
        test_what_is_refused_changes_nothing(mechanism)
        test_initialize_refuses_what_the_drives_exclude(mechanism)
