"""The comparisons: by method of a block, its expected answer, from the same method in Python or from the description.

A test runs for every method that stands in the emitted text, and looks it up here: one that is missing fails.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache
from math import isnan, pi, prod

import numpy as np

from derive.description.mechanism import Joint, Kind, Turning
from derive.equations.chain_splits import is_spatial
from tests.catalogue.machines import Machine
from tests.text import values
from tests.text.closeness import asked, assert_same, is_close
from tests.text.controller import NOT_INITIALIZED, OK, UNREACHABLE, Answer, Controller
from tests.text.reasons import compare_reason
from tests.text.samples import HALF_TURN, NO_TURN, Bytes, Command, Sample, commands
from tests.text.serial_pairs import SerialPair
from tests.text.settings import Range, own_limits, together

Comparison = Callable[[SerialPair, Sample], None]
ROUNDING = 1e-11
ANSWERED = 3
"""The commands of a sample that have an answer, and are diagnosed."""
BYTES = 32
"""The bytes of CONFIGDATA in the stand-in for the library."""


def padded(found: Iterable[int]) -> Bytes:
    """Signed configuration bytes as all bytes of CONFIGDATA: those without a meaning are 0."""
    given = tuple(byte % 256 for byte in found)
    return given + (0,) * (BYTES - len(given))


def signed(byte: int) -> int:
    """A byte as a signed number."""
    return byte - 256 if byte > 127 else byte


def initialize(pair: SerialPair, sample: Sample) -> None:
    """Fresh, refused without parameters or with the last one, and again accepted."""
    one = Controller(pair.library, pair.mechanism)
    assert not one.block.call("IsInitialized")
    assert one.initialise(pair.robot.parameters) == OK
    assert one.block.call("IsInitialized")
    one.set_inputs({"offset_" + pair.mechanism.joints[0].key: float("nan")})
    assert one.block.call("Initialize") == NOT_INITIALIZED
    assert not one.block.call("IsInitialized")
    assert one.initialise(pair.robot.parameters) == OK
    assert_same(one.forward(sample.axes), pair.controller.forward(sample.axes), pair, sample)


def name(pair: SerialPair, sample: Sample) -> None:
    """GetKinematicsName returns the title of the mechanism."""
    expected = pair.mechanism.title or pair.mechanism.block_name
    assert pair.controller.block.call("GetKinematicsName") == expected


def axis_properties(pair: SerialPair, sample: Sample) -> None:
    """Types as declared, and the limits that the block keeps; beyond the axes a free linear one."""
    for index in (*range(6), 255, 2**32 - 1):
        found = pair.controller.axis_properties(index)
        if index < len(pair.mechanism.joints):
            assert_same(found, _properties(pair, pair.mechanism.joints[index]), pair, index)
        else:
            assert found == ("Linear", True, 0.0, 0.0)


def _properties(pair: SerialPair, joint: Joint) -> tuple[str, bool, float, float]:
    kind = "Rotary" if joint.kind is Kind.ROTARY else "Linear"
    own = own_limits(pair.mechanism, pair.robot.parameters, joint)
    return (kind, True, 0.0, 0.0) if own is None else (kind, False, *own)


def axis_settings(pair: SerialPair, sample: Sample) -> None:
    """Limits of all drives around a pose narrow those of the machine: the machine with both answers
    the same in Python.
    """
    rng = np.random.default_rng(list(sample.data) or 5)
    controller = Controller(pair.library, pair.mechanism)
    drives = [drive_around(value, joint, rng) for value, joint in zip(sample.axes, pair.mechanism.joints, strict=True)]
    both = together(pair.mechanism, pair.robot.parameters, drives)
    statuses = [controller.axis_settings(index, drive) for index, drive in enumerate(drives)]
    assert set(statuses) == {OK}
    assert controller.initialise(pair.robot.parameters) == (NOT_INITIALIZED if both is None else OK)
    if both is None:
        return
    robot = type(pair.robot)(**both)
    for command, _ in solved(pair.machine, sample):
        frame = command.position, command.rotation
        status, answer = asked(robot.inverse, frame, command.configuration, command.reference)
        expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
        found = controller.inverse(*frame, command.configuration, command.reference)
        if status == OK and robot.singularity(answer).is_singular and not is_close(found, (status, expected)):
            assert_same_pose(pair, found, (status, expected), command)
            continue
        assert_same(found, (status, expected), pair, drives, command)


def drive_around(value: float, joint: Joint, rng: np.random.Generator) -> Range:
    """Limits of a drive, of less or more than a turn, about a value as far as the machine could have them; or none."""
    if rng.uniform() < 0.3:
        return None
    low, high = joint.limit_range or (-1e9, 1e9)
    below, above = rng.choice((5.0, 100.0, 170.0, 300.0), 2)
    inside = min(max(value, low + 5.0), high - 5.0)
    return max(low, inside - below), min(high, inside + above)


def forward(pair: SerialPair, sample: Sample) -> None:
    """AxesToCartesian writes the pose and the configuration that Python gives, or refuses with the same status."""
    status, answer = asked(pair.robot.forward, sample.axes)
    expected = (*answer[0], padded(answer[1])) if status == OK else None
    assert_same(pair.controller.forward(sample.axes), (status, expected), pair, sample)


def _is_spatial(pair: SerialPair) -> bool:
    chain = pair.machine.mechanism.chain
    return chain is not None and is_spatial(chain)


def inverse(pair: SerialPair, sample: Sample) -> None:
    """CartesianToAxes gives the axis values of Python; where branches coincide, axis values of the same pose."""
    coincide = _is_spatial(pair) and 3 in own_bytes(pair, sample)
    for command, (status, answer) in solved(pair.machine, sample):
        frame = command.position, command.rotation
        expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
        found = pair.controller.inverse(*frame, command.configuration, command.reference)
        if coincide and not is_close(found, (status, expected)):
            assert_same_pose(pair, found, (status, expected), command)
        else:
            assert_same(found, (status, expected), pair, command)


@lru_cache(maxsize=1000)
def solved(machine: Machine, sample: Sample) -> tuple[tuple[Command, Answer], ...]:
    """The commands of a sample, each with the answer in Python: it is the same for all methods that are held against
    it.
    """
    return tuple(
        (c, asked(machine.robot.inverse, (c.position, c.rotation), c.configuration, c.reference))
        for c in commands(machine, sample)
    )


def own_bytes(pair: SerialPair, sample: Sample) -> tuple[int, ...]:
    """The branch bytes of a sample; nothing where it has no pose."""
    status, answer = asked(pair.robot.forward, sample.axes)
    return tuple(answer[1][: pair.robot.BRANCHES]) if status == OK else ()


def assert_same_pose(pair: SerialPair, found: Answer, expected: Answer, command: object) -> None:
    """Where branches meet the last digit decides half of those of an angle, and perhaps whether another is free.

    Both answers must reach the same pose, which is known to all digits.
    """
    assert found[0] == expected[0] == OK, f"{found} is not {expected}: {pair} {command}"
    count = len(pair.mechanism.joints)
    first, second = (pair.robot.forward(answer[1][:count])[0] for answer in (found, expected))
    apart = [abs(a - b) for a, b in zip(first.position, second.position, strict=True)]
    assert max(apart) < ROUNDING * pair.machine.reach, f"{found} is not {expected}: {pair} {command}"
    turned = [
        abs(a - b) for p, q in zip(first.rotation, second.rotation, strict=True) for a, b in zip(p, q, strict=True)
    ]
    assert max(turned) < ROUNDING or not pair.machine.closure.follows_rotation, (
        f"{found} is not {expected}: {pair} {command}"
    )


def diagnose(pair: SerialPair, sample: Sample) -> None:
    """Diagnose gives the reason of Python for every command of the sample that is refused, and no reason for the first
    that is not: what it finds then is what `inverse` compares for all of them.
    """
    answered = 0
    for command, (status, _) in solved(pair.machine, sample):
        answered += status == OK
        if status != OK or answered <= ANSWERED:
            compare_reason(pair, command, status)


def orientation(pair: SerialPair, sample: Sample) -> None:
    """AxesToOrientation writes the rotation that Python gives."""
    expected = asked(pair.robot.orientation, sample.axes)
    assert_same(pair.controller.orientation(sample.axes), expected, pair, sample)


def singularity(pair: SerialPair, sample: Sample) -> None:
    """IsSingularity answers as Python."""
    expected = pair.robot.singularity(sample.axes).is_singular
    assert pair.controller.is_singular(sample.axes) == expected, f"{pair} {sample}"


def jacobian(pair: SerialPair, sample: Sample) -> None:
    """Jacobian writes the matrix of Python, and zeros in all other places."""
    status, rows = asked(pair.robot.jacobian, sample.axes)
    expected = None
    if status == OK:
        wide = [tuple(row) + (0.0,) * (6 - len(row)) for row in rows]
        expected = (*wide, *((0.0,) * 6,) * (6 - len(wide)))
    assert_same(pair.controller.jacobian(sample.axes), (status, expected), pair, sample)


def margins(pair: SerialPair, sample: Sample) -> None:
    """Margins writes those of Python, and zeros in all other places."""
    found = [values.MEANINGLESS] * 8
    block = pair.controller.block
    given = {"aMargins": found, "a": values.axes(pair.library, sample.axes)}
    status, outputs = block.call_with_outputs("Margins", **given)
    expected = tuple(pair.robot.singularity(sample.axes).margins.values())
    if status == OK:
        assert outputs["iCount"] == len(expected)
        assert_same((status, tuple(found)), (OK, (*expected, *(0.0,) * (8 - len(expected)))), pair, sample)
    else:
        assert found == [values.MEANINGLESS] * 8 and all(map(isnan, expected))


def axis_velocities(pair: SerialPair, sample: Sample) -> None:
    """AxisVelocities gives what the Jacobian of Python turns into the twist; where that is singular, a status and
    zeros.
    """
    twist = [40.0, -30.0, 20.0, 10.0, -15.0, 25.0]
    found = [values.MEANINGLESS] * 6
    given = {"aVelocities": found, "aTwist": twist, "a": values.axes(pair.library, sample.axes)}
    status = pair.controller.block.call("AxisVelocities", **given)
    wanted, rows = asked(pair.robot.jacobian, sample.axes)
    if status != OK:
        assert found == [0.0] * 6
        margins = pair.robot.singularity(sample.axes).margins.values()
        assert wanted == status or prod(map(abs, margins)) < 1e-9
        return
    assert wanted == OK
    speeds = [v * pi / 180 if j.in_degrees else v for v, j in zip(found, pair.mechanism.joints, strict=False)]
    # An entry of the Jacobian is rounded as the largest one of its column, whatever its own size.
    largest = [max(map(abs, column)) for column in zip(*rows, strict=True)]
    size = max(1.0, sum(entry * abs(v) for entry, v in zip(largest, speeds, strict=True)))
    for row, name, value in zip(rows, pair.robot.JACOBIAN_ROWS, twist, strict=False):
        expected = value * pi / 180 if name.startswith("turn") else value
        assert abs(sum(a * b for a, b in zip(row, speeds, strict=True)) - expected) < 1e-9 * size, f"{pair} {sample}"
    assert not any(found[len(speeds) :])


def why_initialize(pair: SerialPair, sample: Sample) -> None:
    """InitializeReason is empty after success."""
    assert pair.controller.block.call("InitializeReason") == ""


def image(pair: SerialPair, sample: Sample) -> None:
    """The methods without a commanded rotation write the orientations that Python gives."""
    for method in ("GetOrientationImage", "GetFlangeOrientationImageTotal"):
        if method.lower() in pair.controller.methods:
            expected = pair.robot.orientation_image()
            assert_same(pair.controller.image(method), (OK, tuple(expected)), pair)


def image_with_orientation(pair: SerialPair, sample: Sample) -> None:
    """The projection, as a space of one orientation; refused where the tool points exactly the opposite way.

    A machine that follows the whole rotation, or the tool's direction, gives the rotation itself.
    """
    refusals = []
    whole = pair.mechanism.task.turning in (Turning.DIRECTION, Turning.FULL)
    for rows in (sample.rotation, NO_TURN, HALF_TURN):
        status, projected = (OK, rows) if whole else asked(pair.robot.project, rows)
        expected = None
        if status == OK:
            freedom = "one" if pair.mechanism.task.turning is Turning.DIRECTION else "zero"  # the twist is passive
            expected = (freedom, projected, tuple(row[2] for row in projected), (0.0, 0.0, 1.0))
        assert_same(pair.controller.image_with_orientation(rows), (status, expected), pair, rows)
        refusals += [status] if status != OK else []
    assert refusals == ([] if whole else [UNREACHABLE])


def configuration_offset(pair: SerialPair, sample: Sample) -> None:
    """All automatic where there is no pose: the method has no status."""
    for offset in ((0.0, 0.0, 0.0), sample.offset):
        _, found = asked(pair.robot.configuration_offset, sample.axes, offset)
        expected = padded(found or ())
        assert pair.controller.configuration_offset(sample.axes, offset) == expected, f"{pair} {sample}"


def inverse_offset(pair: SerialPair, sample: Sample) -> None:
    """CartesianToAxes_Offset answers as Python: branches named and open, references near and far, and out of reach."""
    robot, far = pair.robot, sample.reference
    if asked(robot.forward, sample.axes)[0] != OK:
        return
    for offset in ((0.0, 0.0, 0.0), sample.offset):
        place = point_at(pair, sample, offset)
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
            found = pair.controller.inverse_offset(point, offset, configuration, reference)
            assert_same(found, (status, expected), pair, point, offset, configuration, reference)


def point_at(pair: SerialPair, sample: Sample, offset: Iterable[float]) -> tuple[float, ...]:
    """Where a point of the flange is."""
    (position, rotation), _ = pair.robot.forward(sample.axes)
    arm = tuple(offset)
    return tuple(
        p + sum(r * o for r, o in zip(row, arm, strict=True)) for p, row in zip(position, rotation, strict=True)
    )


def configuration_size(pair: SerialPair, sample: Sample) -> None:
    """GetConfigurationDataSize returns the number of bytes of the configuration."""
    assert pair.controller.block.call("GetConfigurationDataSize") == len(pair.robot.CONFIGURATION) == len(sample.data)


def default_configuration(pair: SerialPair, sample: Sample) -> None:
    """GetDefaultConfigurationData writes the default of Python."""
    found = pair.controller.configuration(sample.data)
    assert pair.controller.block.call("GetDefaultConfigurationData", cd=found) is True
    assert tuple(found.abyData) == padded(pair.robot.DEFAULT_CONFIGURATION)


def connectible(pair: SerialPair, sample: Sample) -> None:
    """By the branch bytes alone."""
    branches = pair.robot.BRANCHES
    others = sample.data[:branches] + tuple(255 - byte for byte in sample.data[branches:])
    changed = tuple(255 - byte for byte in sample.data[:branches]) + sample.data[branches:]
    for data, expected in ((sample.data, True), (others, True), (changed, branches == 0)):
        given = {"cd1": pair.controller.configuration(sample.data), "cd2": pair.controller.configuration(data)}
        assert pair.controller.block.call("CPConnectible", **given) is expected


def automatic_periods(pair: SerialPair, sample: Sample) -> None:
    """The period bytes are 0, and all others are copied."""
    source, found = pair.controller.configuration(sample.data), pair.controller.configuration(())
    expected = list(source.abyData)
    expected[pair.robot.BRANCHES : len(sample.data)] = [0] * len(pair.robot.PERIOD_AXES)
    pair.controller.block.call("ActivateAutomaticRotaryPeriods", cdDst=found, cdSrc=source)
    assert found.abyData == expected


def singular_configuration(pair: SerialPair, sample: Sample) -> None:
    """IsConfigSingular tells where a branch byte says that branches coincide."""
    branches = pair.robot.BRANCHES
    for byte in range(5):
        data = (byte,) * branches + (3,) * (len(sample.data) - branches)
        given = pair.controller.configuration(data)
        assert pair.controller.block.call("IsConfigSingular", cd=given) is (byte == 3 and branches > 0)


def periods(pair: SerialPair, sample: Sample) -> None:
    """By axis, signed; 0 for an axis without a period."""
    found = [99] * 6
    pair.controller.block.call("GetPeriods", cd=pair.controller.configuration(sample.data), aPeriods=found)
    expected = [0] * 6
    for axis, byte in zip(pair.robot.PERIOD_AXES, sample.data[pair.robot.BRANCHES :], strict=True):
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
    "Margins": margins,
    "AxisVelocities": axis_velocities,
    "InitializeReason": why_initialize,
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
    "InitializeReason",
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
