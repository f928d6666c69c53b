"""Invalid values in every input of every method: refused with outputs unchanged, or not read; frames from REAL."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
import softkin
from softkin import KinematicsError

from derive.description.mechanism import Turning
from tests.catalogue.extreme import extreme_dimensions
from tests.orthonormal import mirrored, repaired, rows, slightly_off, too_far_off
from tests.text import values
from tests.text.any_method import Call, call_of, methods_of
from tests.text.comparisons import COMPARISONS
from tests.text.comparisons.configurations import padded
from tests.text.controller import BAD_INPUT, IMPOSSIBLE, NOT_INITIALIZED, OK, Controller, asked, assert_same
from tests.text.limits import has_limits
from tests.text.pairs import Pair
from tests.text.reasons import compare_reason
from tests.text.samples import NO_TURN, Command, Rows, Sample, tilted

GARBAGE = (math.nan, math.inf, -math.inf, 1e300, -1e300, 1.1e9)
NO_ROTATIONS: tuple[Rows, ...] = (
    ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0)),
    ((1.0001, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ((1.0, 0.0002, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ((1e9, 1e9, 1e9), (1e9, 1e9, 1e9), (1e9, 1e9, 1e9)),
)
"""Nothing, mirrored, stretched by a little, sheared by a little, swapped, huge."""

MOTIONS = {"AxisVelocities": "aVelocities", "AxisAccelerations": "aAccelerations"}
"""The methods that write zeros where they refuse, with the argument to which they do."""
FORWARD_METHODS = (
    "AxesToCartesian", "AxesToOrientation", "Jacobian", "IsSingularity", "AxesToConfiguration_Offset",
    "AxisAccelerations",
)  # fmt: skip


def real_inputs(call: Call) -> Iterator[tuple[str, values.Path]]:
    """Where the reals lie that a method reads."""
    for name in call.inputs:
        for path in values.scalars(call.arguments[name]):
            if path and isinstance(values.element(call.arguments[name], path), float):
                yield name, path


def check(call: Call, clean: tuple[Any, dict[str, Any]], what: object) -> None:
    """A refusal that wrote nothing, or the answer to clean inputs; a method without a status writes neutral values."""
    before = call.state()
    result, after = call.run()
    if call.is_refused(result) and (found := MOTIONS.get(call.method.removesuffix("From"))):
        assert set(after[found].values()) == {0.0}, f"{what}"
    elif call.is_refused(result):
        assert after == before, f"{call.method} refused, and wrote: {what}"
    elif call.method == "Diagnose":
        assert result or (result, after) == clean, f"{what}"
    elif call.method in ("IsSingularity", "IsCompatibleWithPosKin"):
        assert result is (call.method == "IsSingularity") or (result, after) == clean, f"{what}"
    elif call.method == "AxesToConfiguration_Offset":
        assert set(after["cd"].values()) == {0} or (result, after) == clean, f"{what}"
    elif call.method != "GetOrientationImageTotal":  # it passes on axes of a flange that has none
        assert (result, after) == clean, f"{call.method} answers {what}: {result} {after}"


@pytest.mark.long("Hexapod", "P2C", "Pos_RRR")
def test_garbage_in_one_number(pairs: tuple[Pair, ...]) -> None:
    """NaN, an infinite or a huge number in one argument is refused without a fault, and outputs stay as they are.

    Each is asked of one of two machines.
    """
    for one, numbers in ((pairs[1], GARBAGE[::2]), (pairs[-3], GARBAGE[1::2])):
        sample = one.regular[-1]
        for method in methods_of(one.controller):
            fitting = call_of(one, one.controller, method, sample)
            clean = fitting.again().run()
            for name, path in real_inputs(fitting):
                for garbage in numbers:
                    call = fitting.again()
                    values.put(call.arguments[name], path, garbage)
                    check(call, clean, (name, path, garbage))


def test_garbage_in_every_number(pairs: tuple[Pair, ...]) -> None:
    for one in (pairs[1], pairs[-3]):
        sample = one.regular[-1]
        for method in methods_of(one.controller):
            fitting = call_of(one, one.controller, method, sample)
            clean = fitting.again().run()
            for garbage in GARBAGE:
                call = fitting.again()
                for name, path in real_inputs(call):
                    values.put(call.arguments[name], path, garbage)
                check(call, clean, garbage)


def test_garbage_in_what_is_written(pairs: tuple[Pair, ...]) -> None:
    for one in pairs[1:2]:
        sample = one.regular[-1]
        for method in methods_of(one.controller):
            fitting = call_of(one, one.controller, method, sample)
            clean = fitting.again().run()
            for garbage in GARBAGE:
                call = fitting.again()
                for name in call.written:
                    spoil(call.arguments[name], garbage)
                assert call.run() == clean, method


def spoil(value: Any, garbage: float) -> None:
    """Write garbage into every real number of a value."""
    for path in values.scalars(value):
        if isinstance(values.element(value, path), float):
            values.put(value, path, garbage)


def test_garbage_in_axes_as_in_python(pairs: tuple[Pair, ...]) -> None:
    """Garbage in axis values has the status that Python gives."""
    one = pairs[1]
    sample = one.regular[0]
    for index, garbage in product(range(len(sample.axes)), GARBAGE):
        axes = (*sample.axes[:index], garbage, *sample.axes[index + 1 :])
        assert one.controller.forward(axes)[0] == BAD_INPUT
        for method in FORWARD_METHODS:
            if method.lower() in one.controller.methods:
                COMPARISONS[method](one, replace(sample, axes=axes))


def test_garbage_in_a_command_as_in_python(pairs: tuple[Pair, ...]) -> None:
    """Position, and reference; configurations open and explicit."""
    one = pairs[1]
    sample = one.regular[0]
    (position, rotation), own = one.robot.forward(sample.axes)
    clean = (*position, *sample.reference)
    for index, garbage in product(range(len(clean)), GARBAGE):
        numbers = (*clean[:index], garbage, *clean[index + 1 :])
        for data in (own, (0,) * len(own)):
            command = numbers[:3], rotation, data, numbers[3:]
            status, axes = asked(one.robot.inverse, command[:2], *command[2:])
            assert_same(
                one.controller.inverse(*command), (status, axes and axes + (0.0,) * (6 - len(axes))), one, command
            )
            if index < 3 and "xyz"[index] in one.mechanism.task.position:
                assert status == BAD_INPUT, f"{one} {command}"


def test_what_is_no_rotation(pairs: tuple[Pair, ...]) -> None:
    """Refused where the rotation is read, and never looked at elsewhere, as in Python."""
    unlimited = [one for one in pairs if not has_limits(one.machine)]
    for one in (unlimited[1], unlimited[-1]):
        for sample in one.regular[:5]:
            (position, rotation), own = one.robot.forward(sample.axes)
            scaled = tuple(tuple(2.0 * v for v in row) for row in rotation)
            for wrong in (*NO_ROTATIONS, scaled):
                found = one.controller.inverse(position, wrong, own, sample.axes)
                assert found[0] == (BAD_INPUT if one.robot.READS_ROTATION else OK), f"{one} {wrong}"
                status, axes = asked(one.robot.inverse, (position, wrong), own, sample.axes)
                assert_same(found, (status, axes and axes + (0.0,) * (6 - len(axes))), one, wrong)
                if "getflangeorientationimagewithori" in one.controller.methods:
                    assert one.controller.image_with_orientation(wrong)[0] == BAD_INPUT


def test_a_pose_that_cannot_be_assembled(serial_pairs: tuple[Pair, ...]) -> None:
    """A joint beyond what the closure allows: a negative radius, an angle past the vertical."""
    for one in serial_pairs[:5]:
        for index, joint in enumerate(one.mechanism.joints):
            if joint.domain is None:
                continue
            sample = one.regular[0]
            beyond = joint.domain[0] + one.robot.parameters[joint.offset.name] - 1.0
            axes = (*sample.axes[:index], beyond, *sample.axes[index + 1 :])
            assert one.controller.forward(axes)[0] == IMPOSSIBLE
            assert one.controller.is_singular(axes)
            for method in FORWARD_METHODS:
                if method.lower() in one.controller.methods:
                    COMPARISONS[method](one, replace(sample, axes=axes))


@pytest.mark.long("Pos_RRR")
def test_the_largest_numbers(pairs: tuple[Pair, ...]) -> None:
    """1e9 in size is a number; nothing overflows, and the pairs agree on what it means."""
    for one in (pairs[0], pairs[1], pairs[-1]):
        count = len(one.mechanism.joints)
        rng = np.random.default_rng(9)
        for row in rng.choice((-1e9, -1e5, 0.0, 1.0, 1e9), (20, 2 * count + 3)).tolist():
            axes, reference, position = tuple(row[:count]), tuple(row[count : 2 * count]), tuple(row[2 * count :])
            status, answer = asked(one.robot.forward, axes)
            found = one.controller.forward(axes)
            assert found[0] == status
            if status == OK:
                assert_same(found[1][:2], tuple(answer[0]), one, axes)
                assert found[1][2] == padded(answer[1])
            for data in (one.robot.DEFAULT_CONFIGURATION, (0,) * len(one.robot.CONFIGURATION)):
                status, answer = asked(one.robot.inverse, (position, NO_TURN), data, reference)
                found = one.controller.inverse(position, NO_TURN, data, reference)
                assert_same(found, (status, answer and answer + (0.0,) * (6 - count)), one, position, data, reference)


MACHINES = 8


def test_every_call_ends(pairs: tuple[Pair, ...]) -> None:
    """Initialize refuses what Python refuses, and every call after it answers a status."""
    mechanism = pairs[0].mechanism
    made = softkin.catalogue()[mechanism.name]
    names = {p.name for p in made.PARAMETERS}
    for given in extreme_dimensions(mechanism, MACHINES):
        controller = Controller(pairs[0].library, mechanism)
        try:
            made(**{name: value for name, value in given.items() if name in names})
            expected = OK
        except KinematicsError:
            expected = NOT_INITIALIZED
        assert controller.initialise(given) == expected
        axes = [10.0 * (k + 1) for k in range(len(made.AXES))]
        status, pose = controller.forward(axes)
        position, rows = pose[:2] if status == OK else ((30.0, -20.0, 10.0), NO_TURN)
        controller.inverse(position, rows, made.DEFAULT_CONFIGURATION, axes)


ROUNDING = 1e-9
INSIDE = 0.02


def offered(one: Pair) -> bool:
    """Whether the block has the method that reads a commanded rotation."""
    return "getflangeorientationimagewithori" in one.controller.methods


def test_a_frame_from_real_is_answered_as_in_python(pairs: tuple[Pair, ...]) -> None:
    for one in (pairs[0], pairs[-1]):
        for sample in [s for s in one.regular if _is_inside(one.robot, s.axes)][:3]:
            (position, rotation), own = one.robot.forward(sample.axes)
            for matrix in slightly_off(np.array(rotation)):
                frame = position, rows(matrix)
                status, axes = asked(one.robot.inverse, frame, own, sample.axes)
                found = one.controller.inverse(*frame, own, sample.axes)
                assert_same(found, (status, axes and axes + (0.0,) * (6 - len(axes))), one, matrix)
                assert found[0] == asked(one.robot.inverse, (position, rotation), own, sample.axes)[0]


def _is_inside(robot: softkin.Mechanism, axes: tuple[float, ...]) -> bool:
    """Whether a pose is so far from the end of its reach that a tilt by 1e-4 does not leave it."""
    return all(abs(m) > INSIDE for m in robot.singularity(axes).margins.values())


def test_beyond_that_it_is_refused_with_the_same_reason(pairs: tuple[Pair, ...]) -> None:
    """A rotation with a larger error is refused with the reason of Python."""
    one = pairs[0]
    sample = one.regular[0]
    (position, rotation), own = one.robot.forward(sample.axes)
    for matrix in (*too_far_off(np.array(rotation)), *mirrored(np.array(rotation))):
        found = one.controller.inverse(position, rows(matrix), own, sample.axes)
        assert found[0] == (BAD_INPUT if one.robot.READS_ROTATION else OK)
        compare_reason(one, Command(position, rows(matrix), own, sample.axes))
        if offered(one):
            assert one.controller.image_with_orientation(rows(matrix))[0] == BAD_INPUT


def test_the_image_is_the_rotation_that_the_inverse_gives_the_flange(serial_pairs: tuple[Pair, ...]) -> None:
    rng = np.random.default_rng(17)
    one = serial_pairs[0]
    for sample in one.regular[:3] if offered(one) else ():
        (position, rotation), own = one.robot.forward(sample.axes)
        turns = [np.array(rotation)]
        if one.mechanism.task.turning is Turning.ABOUT_Z:
            turns.append(np.array(tilted(rng)))
        for turn in turns:
            for matrix in slightly_off(turn):
                _agree(one, sample, position, matrix, own)


def _agree(one: Pair, sample: Sample, position: tuple[float, ...], matrix: np.ndarray, own: tuple[int, ...]) -> None:
    status, image = one.controller.image_with_orientation(rows(matrix))
    assert status == OK
    freedom, zero, base_axis, _ = image
    outcome, axes = one.controller.inverse(position, rows(matrix), own, sample.axes)
    if outcome != OK:
        return  # limits
    reached = np.array(one.controller.forward(axes[: len(sample.axes)])[1][1])
    assert np.abs(np.array(base_axis) - reached[:, 2]).max() < ROUNDING
    if one.mechanism.task.turning is not Turning.DIRECTION:
        assert np.abs(np.array(zero) - reached).max() < ROUNDING
    if one.mechanism.task.turning is Turning.FULL:
        np.testing.assert_allclose(zero, repaired(matrix), rtol=0, atol=1e-15)
