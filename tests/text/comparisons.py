"""The comparisons: by method of a block, its expected answer, from its twin in Python or from the description.

A test runs for every method that stands in the emitted text, and looks it up here: one that is missing fails.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache

import numpy as np

from derive.description.mechanism import Joint, Kind, Turning
from derive.equations.chain_splits import is_spatial
from tests.catalogue.machines import Machine
from tests.text.closeness import asked, assert_same, is_close
from tests.text.controller import NOT_INITIALIZED, OK, UNREACHABLE, Answer, Controller
from tests.text.reasons import compare_reason
from tests.text.samples import HALF_TURN, NO_TURN, Bytes, Command, Sample, commands
from tests.text.settings import Range, own_limits, together
from tests.text.twins import Twins

Comparison = Callable[[Twins, Sample], None]
ROUNDING = 1e-11
BYTES = 32
"""The bytes of CONFIGDATA in the stand-in for the library."""


def padded(found: Iterable[int]) -> Bytes:
    """Signed configuration bytes as all bytes of CONFIGDATA: those without a meaning are 0."""
    given = tuple(byte % 256 for byte in found)
    return given + (0,) * (BYTES - len(given))


def signed(byte: int) -> int:
    """A byte as a signed number."""
    return byte - 256 if byte > 127 else byte


def initialize(twins: Twins, sample: Sample) -> None:
    """Fresh, refused without parameters or with the last one, and again accepted."""
    one = Controller(twins.library, twins.mechanism)
    assert not one.block.call("IsInitialized")
    assert one.initialise(twins.robot.parameters) == OK
    assert one.block.call("IsInitialized")
    one.set_inputs({"offset_" + twins.mechanism.joints[0].key: float("nan")})
    assert one.block.call("Initialize") == NOT_INITIALIZED
    assert not one.block.call("IsInitialized")
    assert one.initialise(twins.robot.parameters) == OK
    assert_same(one.forward(sample.axes), twins.controller.forward(sample.axes), twins, sample)


def name(twins: Twins, sample: Sample) -> None:
    expected = twins.mechanism.title or twins.mechanism.block_name
    assert twins.controller.block.call("GetKinematicsName") == expected


def axis_properties(twins: Twins, sample: Sample) -> None:
    """Types as declared, and the limits that the block keeps; beyond the axes a free linear one."""
    for index in (*range(6), 255, 2**32 - 1):
        found = twins.controller.axis_properties(index)
        if index < len(twins.mechanism.joints):
            assert_same(found, _properties(twins, twins.mechanism.joints[index]), twins, index)
        else:
            assert found == ("Linear", True, 0.0, 0.0)


def _properties(twins: Twins, joint: Joint) -> tuple[str, bool, float, float]:
    kind = "Rotary" if joint.kind is Kind.ROTARY else "Linear"
    own = own_limits(twins.mechanism, twins.robot.parameters, joint)
    return (kind, True, 0.0, 0.0) if own is None else (kind, False, *own)


def axis_settings(twins: Twins, sample: Sample) -> None:
    """Limits of all drives around a pose narrow those of the machine: the machine with both answers
    the same in Python.
    """
    rng = np.random.default_rng(list(sample.data) or 5)
    controller = Controller(twins.library, twins.mechanism)
    drives = [drive_around(value, joint, rng) for value, joint in zip(sample.axes, twins.mechanism.joints, strict=True)]
    both = together(twins.mechanism, twins.robot.parameters, drives)
    statuses = [controller.axis_settings(index, drive) for index, drive in enumerate(drives)]
    assert set(statuses) == {OK}
    assert controller.initialise(twins.robot.parameters) == (NOT_INITIALIZED if both is None else OK)
    if both is None:
        return
    robot = type(twins.robot)(**both)
    for command, _ in solved(twins.machine, sample):
        frame = command.position, command.rotation
        status, answer = asked(robot.inverse, frame, command.configuration, command.reference)
        expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
        found = controller.inverse(*frame, command.configuration, command.reference)
        if status == OK and robot.singularity(answer).is_singular and not is_close(found, (status, expected)):
            assert_same_pose(twins, found, (status, expected), command)
            continue
        assert_same(found, (status, expected), twins, drives, command)


def drive_around(value: float, joint: Joint, rng: np.random.Generator) -> Range:
    """Limits of a drive, of less or more than a turn, about a value as far as the machine could have them; or none."""
    if rng.uniform() < 0.3:
        return None
    low, high = joint.limit_range or (-1e9, 1e9)
    below, above = rng.choice((5.0, 100.0, 170.0, 300.0), 2)
    inside = min(max(value, low + 5.0), high - 5.0)
    return max(low, inside - below), min(high, inside + above)


def forward(twins: Twins, sample: Sample) -> None:
    status, answer = asked(twins.robot.forward, sample.axes)
    expected = (*answer[0], padded(answer[1])) if status == OK else None
    assert_same(twins.controller.forward(sample.axes), (status, expected), twins, sample)


def _is_spatial(twins: Twins) -> bool:
    chain = twins.machine.mechanism.chain
    return chain is not None and is_spatial(chain)


def inverse(twins: Twins, sample: Sample) -> None:
    for command, (status, answer) in solved(twins.machine, sample):
        frame = command.position, command.rotation
        expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
        found = twins.controller.inverse(*frame, command.configuration, command.reference)
        if 3 in own_bytes(twins, sample) and _is_spatial(twins) and not is_close(found, (status, expected)):
            assert_same_pose(twins, found, (status, expected), command)
        else:
            assert_same(found, (status, expected), twins, command)


@lru_cache(maxsize=1000)
def solved(machine: Machine, sample: Sample) -> tuple[tuple[Command, Answer], ...]:
    """The commands of a sample, each with the answer in Python: it is the same for all methods that are held against
    it.
    """
    return tuple(
        (c, asked(machine.robot.inverse, (c.position, c.rotation), c.configuration, c.reference))
        for c in commands(machine, sample)
    )


def own_bytes(twins: Twins, sample: Sample) -> tuple[int, ...]:
    """The branch bytes of a sample; nothing where it has no pose."""
    status, answer = asked(twins.robot.forward, sample.axes)
    return tuple(answer[1][: twins.robot.BRANCHES]) if status == OK else ()


def assert_same_pose(twins: Twins, found: Answer, expected: Answer, command: object) -> None:
    """Where branches meet the last digit decides half of those of an angle, and perhaps whether another is free.

    Both answers must reach the same pose, which is known to all digits.
    """
    assert found[0] == expected[0] == OK, f"{found} is not {expected}: {twins} {command}"
    count = len(twins.mechanism.joints)
    first, second = (twins.robot.forward(answer[1][:count])[0] for answer in (found, expected))
    apart = [abs(a - b) for a, b in zip(first.position, second.position, strict=True)]
    assert max(apart) < ROUNDING * twins.machine.reach, f"{found} is not {expected}: {twins} {command}"
    turned = [
        abs(a - b) for p, q in zip(first.rotation, second.rotation, strict=True) for a, b in zip(p, q, strict=True)
    ]
    assert max(turned) < ROUNDING or not twins.machine.closure.follows_rotation, (
        f"{found} is not {expected}: {twins} {command}"
    )


def diagnose(twins: Twins, sample: Sample) -> None:
    for command, (status, _) in solved(twins.machine, sample):
        compare_reason(twins, command, status)


def orientation(twins: Twins, sample: Sample) -> None:
    expected = asked(twins.robot.orientation, sample.axes)
    assert_same(twins.controller.orientation(sample.axes), expected, twins, sample)


def singularity(twins: Twins, sample: Sample) -> None:
    expected = twins.robot.singularity(sample.axes).is_singular
    assert twins.controller.is_singular(sample.axes) == expected, f"{twins} {sample}"


def jacobian(twins: Twins, sample: Sample) -> None:
    status, rows = asked(twins.robot.jacobian, sample.axes)
    expected = None
    if status == OK:
        wide = [tuple(row) + (0.0,) * (6 - len(row)) for row in rows]
        expected = (*wide, *((0.0,) * 6,) * (6 - len(wide)))
    assert_same(twins.controller.jacobian(sample.axes), (status, expected), twins, sample)


def image(twins: Twins, sample: Sample) -> None:
    for method in ("GetOrientationImage", "GetFlangeOrientationImageTotal"):
        if method.lower() in twins.controller.block.routines:
            expected = twins.robot.orientation_image()
            assert_same(twins.controller.image(method), (OK, tuple(expected)), twins)


def image_with_orientation(twins: Twins, sample: Sample) -> None:
    """The projection, as a space of one orientation; refused where the tool points exactly the opposite way.

    A machine that follows the whole rotation, or the tool's direction, gives the rotation itself.
    """
    refusals = []
    whole = twins.mechanism.task.turning in (Turning.DIRECTION, Turning.FULL)
    for rows in (sample.rotation, NO_TURN, HALF_TURN):
        status, projected = (OK, rows) if whole else asked(twins.robot.project, rows)
        expected = None
        if status == OK:
            freedom = "one" if twins.mechanism.task.turning is Turning.DIRECTION else "zero"  # the twist is passive
            expected = (freedom, projected, tuple(row[2] for row in projected), (0.0, 0.0, 1.0))
        assert_same(twins.controller.image_with_orientation(rows), (status, expected), twins, rows)
        refusals += [status] if status != OK else []
    assert refusals == ([] if whole else [UNREACHABLE])


def configuration_offset(twins: Twins, sample: Sample) -> None:
    """All automatic where there is no pose: the method has no status."""
    for offset in ((0.0, 0.0, 0.0), sample.offset):
        _, found = asked(twins.robot.configuration_offset, sample.axes, offset)
        expected = padded(found or ())
        assert twins.controller.configuration_offset(sample.axes, offset) == expected, f"{twins} {sample}"


def inverse_offset(twins: Twins, sample: Sample) -> None:
    robot, far = twins.robot, sample.reference
    if asked(robot.forward, sample.axes)[0] != OK:
        return
    for offset in ((0.0, 0.0, 0.0), sample.offset):
        place = point_at(twins, sample, offset)
        own = robot.configuration_offset(sample.axes, offset)
        opened = (0,) * len(own)
        for point, configuration, reference in (
            (place, own, sample.axes),
            (place, own, far),
            (place, opened, sample.axes),
            (place, opened, far),
            (place, sample.data, far),
            (tuple(2.0 * v for v in place), robot.DEFAULT_CONFIGURATION, far),
        ):
            status, answer = asked(robot.inverse_offset, point, offset, configuration, reference)
            expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
            found = twins.controller.inverse_offset(point, offset, configuration, reference)
            assert_same(found, (status, expected), twins, point, offset, configuration, reference)


def point_at(twins: Twins, sample: Sample, offset: Iterable[float]) -> tuple[float, ...]:
    """Where a point of the flange is."""
    (position, rotation), _ = twins.robot.forward(sample.axes)
    arm = tuple(offset)
    return tuple(
        p + sum(r * o for r, o in zip(row, arm, strict=True)) for p, row in zip(position, rotation, strict=True)
    )


def configuration_size(twins: Twins, sample: Sample) -> None:
    assert twins.controller.block.call("GetConfigurationDataSize") == len(twins.robot.CONFIGURATION) == len(sample.data)


def default_configuration(twins: Twins, sample: Sample) -> None:
    found = twins.controller.configuration(sample.data)
    assert twins.controller.block.call("GetDefaultConfigurationData", cd=found) is True
    assert tuple(found.abyData) == padded(twins.robot.DEFAULT_CONFIGURATION)


def connectible(twins: Twins, sample: Sample) -> None:
    """By the branch bytes alone."""
    branches = twins.robot.BRANCHES
    others = sample.data[:branches] + tuple(255 - byte for byte in sample.data[branches:])
    changed = tuple(255 - byte for byte in sample.data[:branches]) + sample.data[branches:]
    for data, expected in ((sample.data, True), (others, True), (changed, branches == 0)):
        given = {"cd1": twins.controller.configuration(sample.data), "cd2": twins.controller.configuration(data)}
        assert twins.controller.block.call("CPConnectible", **given) is expected


def automatic_periods(twins: Twins, sample: Sample) -> None:
    """The period bytes are 0, and all others are copied."""
    source, found = twins.controller.configuration(sample.data), twins.controller.configuration(())
    expected = list(source.abyData)
    expected[twins.robot.BRANCHES : len(sample.data)] = [0] * len(twins.robot.PERIOD_AXES)
    twins.controller.block.call("ActivateAutomaticRotaryPeriods", cdDst=found, cdSrc=source)
    assert found.abyData == expected


def singular_configuration(twins: Twins, sample: Sample) -> None:
    branches = twins.robot.BRANCHES
    for byte in range(5):
        data = (byte,) * branches + (3,) * (len(sample.data) - branches)
        given = twins.controller.configuration(data)
        assert twins.controller.block.call("IsConfigSingular", cd=given) is (byte == 3 and branches > 0)


def periods(twins: Twins, sample: Sample) -> None:
    """By axis, signed; 0 for an axis without a period."""
    found = [99] * 6
    twins.controller.block.call("GetPeriods", cd=twins.controller.configuration(sample.data), aPeriods=found)
    expected = [0] * 6
    for axis, byte in zip(twins.robot.PERIOD_AXES, sample.data[twins.robot.BRANCHES :], strict=True):
        expected[axis] = signed(byte)
    assert found == expected


COMPARISONS: dict[str, Comparison] = {
    "Initialize": initialize,
    "IsInitialized": initialize,
    "GetKinematicsName": name,
    "GetAxisProperties": axis_properties,
    "AxisSettings": axis_settings,
    "AxesToCartesian": forward,
    "CartesianToAxes": inverse,
    "AxesToOrientation": orientation,
    "IsSingularity": singularity,
    "Jacobian": jacobian,
    "Diagnose": diagnose,
    "GetOrientationImage": image,
    "GetFlangeOrientationImageTotal": image,
    "GetFlangeOrientationImageWithOri": image_with_orientation,
    "AxesToConfiguration_Offset": configuration_offset,
    "CartesianToAxes_Offset": inverse_offset,
    "GetConfigurationDataSize": configuration_size,
    "GetDefaultConfigurationData": default_configuration,
    "CPConnectible": connectible,
    "ActivateAutomaticRotaryPeriods": automatic_periods,
    "IsConfigSingular": singular_configuration,
    "GetPeriods": periods,
}
"""By the name of the method."""

POSELESS = {
    "Initialize",
    "IsInitialized",
    "GetKinematicsName",
    "GetAxisProperties",
    "AxisSettings",
    "GetOrientationImage",
    "GetFlangeOrientationImageTotal",
    "GetConfigurationDataSize",
}
"""Methods that no pose goes into: a few samples of a machine are enough."""
