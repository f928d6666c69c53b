"""A machine in radians: every call of the machine in degrees, with converted angles."""

import copy
import math
import pickle
from typing import Any

import numpy as np
import pytest
import softkin
from softkin import KinematicsError

from tests.catalogue.calls.mountings import NAMES, Axes, drawn_limits, frame_at, poses, robots, with_limits


def radian(robot: softkin.Mechanism, values: Any) -> Any:
    """Axis values in degrees, or a table of them, in radians."""
    factors = [math.radians(1.0) if axis.unit == "deg" else 1.0 for axis in robot.AXES]
    return np.array(values) * np.array(factors) if len(factors) else np.array(values)


def same(robot: softkin.Mechanism, own: Any, degrees: Any) -> bool:
    """Whether axis values are those in degrees; where there are none, there are none."""
    if own is None or degrees is None:
        return own is degrees
    return np.allclose(np.array(own), radian(robot, degrees), rtol=1e-11, atol=1e-9, equal_nan=True)


def outcome(call: Any, *arguments: Any, **given: Any) -> Any:
    try:
        return call(*arguments, **given)
    except KinematicsError as error:
        return error


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("name", NAMES)
def test_every_call_is_that_of_the_machine_in_degrees(name: str) -> None:
    """Scalar calls, with limits that refuse some of them."""
    rng = np.random.default_rng(5)
    for number, one in enumerate(robots(name)):
        for axes in poses(name, number, 2):
            made = with_limits(one.made, drawn_limits(one, axes, rng))
            own, q = made.in_radians(), tuple(radian(made, axes).tolist())
            frame, configuration = made.forward(axes)
            assert np.allclose(own.forward(q)[0].position, frame.position, atol=1e-9 * one.reach)
            assert own.forward(q)[1] == configuration
            assert np.allclose(own.orientation(q), made.orientation(axes))
            assert np.allclose(own.jacobian(q), made.jacobian(axes), rtol=1e-9, atol=1e-9 * one.reach)
            assert np.allclose(list(own.singularity(q).margins.values()), list(made.singularity(axes).margins.values()))
            near = tuple(np.add(axes, np.where(one.is_angle, 250.0, 0.0)).tolist())
            close = tuple(radian(made, near).tolist())
            for call in ("inverse", "nearest"):
                first = outcome(getattr(made, call), frame, reference=near)
                second = outcome(getattr(own, call), frame, reference=close)
                assert type(first) is type(second)
                assert (
                    str(second).endswith(said(made, first))
                    if isinstance(first, Exception)
                    else same(made, second, first)
                )
            for mine, slot in zip(own.inverse_all(frame, close), made.inverse_all(frame, near), strict=True):
                assert mine.configuration == slot.configuration and mine.status == slot.status
                assert same(made, mine.axes, slot.axes) and len(mine.others) == len(slot.others)
            for mine_axes, slot_axes in zip(own.branches(frame, close), made.branches(frame, near), strict=True):
                assert same(made, mine_axes, slot_axes)
            if isinstance(made, softkin._offset.OffsetKinematics):  # type: ignore[attr-defined]
                offset = (3.0, 1.0, 0.0)
                point = tuple(np.array(frame.position) + np.array(frame.rotation) @ offset)
                named = made.configuration_offset(axes, offset)
                assert own.configuration_offset(q, offset) == named
                first = outcome(made.inverse_offset, point, offset, named, axes)
                second = outcome(own.inverse_offset, point, offset, named, q)
                assert isinstance(first, Exception) == isinstance(second, Exception)
                assert isinstance(first, Exception) or same(made, second, first)


def said(robot: softkin.Mechanism, error: KinematicsError) -> str:
    """The end of a message in radians."""
    assert error.refusal is not None
    reason, missing = error.refusal.reason, error.refusal.missing
    if not reason.endswith(" [deg]"):
        return error.refusal.in_words
    return error.refusal._replace(reason=f"{reason[:-6]} [rad]", missing=math.radians(missing)).in_words


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("name", NAMES)
def test_batches(name: str) -> None:
    for number, one in enumerate(robots(name)):
        chosen = np.array(poses(name, number, 3))
        made, own = one.made, one.made.in_radians()
        positions, rotations, configurations, _ = made.forward_batch(chosen)
        mine = own.forward_batch(radian(made, chosen))
        assert np.allclose(mine[0], positions, atol=1e-9 * one.reach) and np.allclose(mine[1], rotations)
        assert (mine[2] == configurations).all()
        near = chosen + np.where(one.is_angle, 250.0, 0.0)
        close = radian(made, near)
        calls = (
            ("inverse_batch", (positions, rotations, configurations)),
            ("inverse_all_batch", (positions, rotations)),
            ("nearest_batch", (positions, rotations)),
        )
        for call, arguments in calls:
            first, status = getattr(made, call)(*arguments, references=near)
            second, outcomes = getattr(own, call)(*arguments, references=close)
            assert (status == outcomes).all() and same(made, second, first)


def test_what_it_is() -> None:
    """Limits, offsets, parameters, axes and reasons are in radians; it is a value, too."""
    robot = softkin.Scara4ZCcoupledType1(
        link_length_1=325.0,
        link_length_2=225.0,
        pitch_zc=20.0,
        offset_a1=90.0,
        limits={"A1": (-90.0, 180.0), "A2": (None, 90.0)},
    )
    own = robot.in_radians()
    assert own.limits["A1"] == pytest.approx((-math.pi / 2, math.pi)) and own.limits["A2"] == (None, math.pi / 2)
    assert own.offset_a1 == pytest.approx(math.pi / 2) and own.pitch_zc == 20.0
    assert [axis.unit for axis in own.AXES] == ["rad", "rad", "u", "rad"]
    assert {p.unit for p in own.PARAMETERS} == {"u", "rad", "u/rev", "1", ""}
    assert own.in_degrees() is robot and own.in_radians() is own and repr(own) == f"{robot!r}.in_radians()"
    for other in (copy.copy(own), copy.deepcopy(own), pickle.loads(pickle.dumps(own)), robot.in_radians()):
        assert other == own and hash(other) == hash(own) and other != robot
    assert softkin.Mechanism.from_json(own.to_json()) == own
    assert own.changed(offset_a1=math.pi, limits={"A2": (0.0, math.pi)}).in_degrees() == robot.changed(
        offset_a1=180.0, limits={"A2": (0.0, 180.0)}
    )
    with pytest.raises(AttributeError):
        own.part = robot  # type: ignore[attr-defined]
    frame = robot.forward((100.0, 80.0, 0.0, 0.0))[0]
    narrow = robot.changed(limits={"A2": (0.0, 60.0)})
    degrees, found = narrow.diagnose(frame), narrow.in_radians().diagnose(frame)
    assert found.reason == degrees.reason.replace("[deg]", "[rad]") and "[rad]" in found.reason
    assert found.missing == pytest.approx(math.radians(degrees.missing))
    assert "rad" in found.in_words


def test_projection_and_iteration_from_a_start() -> None:
    """Calls that only some machines have."""
    scara = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0)
    tilted = scara.forward((10.0, 20.0, 0.0, 5.0))[0].rotation
    assert scara.in_radians().project(tilted) == scara.project(tilted)
    plate = next(one for one in robots("Softkin_Planar_3RRR"))
    axes: Axes = poses("Softkin_Planar_3RRR", 0, 1)[0]
    start = frame_at(plate.made, axes)
    own: Any = plate.made.in_radians()
    assert own.forward(radian(plate.made, axes), start)[0].position == pytest.approx(start.position, abs=1e-6)
    assert own.forward_batch([radian(plate.made, axes)], start)[3][0] == 0
    wrist: Any = softkin.Wrist2().in_radians()
    image = softkin.Gantry3().orientation_image()
    assert wrist.image_on(image) == softkin.Wrist2().image_on(image) and wrist.is_compatible(image)
    coupled = softkin.Coupled(softkin.Gantry3().in_radians(), wrist)
    assert coupled.forward((1.0, 2.0, 3.0, 0.1, 0.2))[0].position == (1.0, 2.0, 3.0)
