"""Every call on a machine with base and tool, in radians too: nearest, values, names, lines, velocities, batches.

The truth is the machine without both: the frame of its flange is base^-1 * frame * tool^-1.
"""

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Mechanism, Status
from softkin._core import PITCH
from softkin._start import IterativeForward

from tests.catalogue.calls.mountings import BASE, EVERY, Axes, frame_at, limited, machines, mounted, radian, tool_of
from tests.catalogue.refusals import refusal
from tests.mechanisms import in_the_task

pytestmark = pytest.mark.broad

EVERY_NAME = pytest.mark.parametrize("name", EVERY)


def apart(first: object, second: object) -> float:
    """The largest difference of numbers."""
    return float(np.abs(np.subtract(first, second)).max(initial=0.0))  # type: ignore[call-overload]


def missed(robot: Mechanism, place: object, goal: object) -> float:
    """The largest difference of places along the axes of a machine on its base, as far as it is commanded."""
    shift = BASE.matrix[:3, :3].T @ np.subtract(place, goal)  # type: ignore[call-overload]
    return float(np.abs(in_the_task(robot.NAME, shift)).max())


def answered(robot: Mechanism, frame: object, near: Axes) -> Axes | softkin.Diagnosis:
    try:
        return robot.nearest(frame, near)  # type: ignore[arg-type]
    except KinematicsError as error:
        assert error.refusal is not None
        return error.refusal


@pytest.mark.long("Ac6", "Hexapod")
@EVERY_NAME
def test_nearest(name: str) -> None:
    """The answer is that of the machine without base and tool at the frame of its flange, and so is the refusal."""
    rng = np.random.default_rng(11)
    for robot, axes, size in limited(name, rng):
        made = mounted(robot)
        for shift in (0.0, 0.3, 5.0):
            angles = rng.uniform(-400.0, 400.0, len(axes)) * (shift > 0.0)
            angles[list(robot.HELD)] = 0.0
            near = tuple((np.array(axes) + angles).tolist())
            flange = frame_at(robot, axes)
            frame = BASE.matrix @ flange.matrix @ tool_of(robot).matrix
            found, expected = answered(made, frame, near), answered(robot, flange, near)
            if made._follows() != PITCH:
                if isinstance(found, softkin.Diagnosis) or isinstance(expected, softkin.Diagnosis):
                    assert found[:2] == expected[:2]
                else:
                    assert apart(found, expected) < 1e-5
            if not isinstance(found, softkin.Diagnosis):
                assert made._beyond_limits(found) is None
                if robot.ROLE != "orientation" and not isinstance(robot, IterativeForward):
                    assert missed(robot, made.forward(found)[0].position, frame[:3, 3]) < 1e-8 * (size + 1000.0)
            own, at = made.in_radians(), radian(robot, near)
            same = answered(own, frame, at)
            assert isinstance(same, softkin.Diagnosis) == isinstance(found, softkin.Diagnosis)
            every, statuses = made.nearest_batch([frame] * 2, None, near)
            others, outcomes = own.nearest_batch([frame] * 2, None, at)
            if isinstance(found, softkin.Diagnosis):
                assert (statuses == found.status).all() and (outcomes == found.status).all()
            else:
                assert (statuses == Status.OK).all() and (outcomes == Status.OK).all()
                assert apart(every, [found] * 2) < 1e-5 and apart(same, radian(robot, found)) < 1e-6
                assert apart(others, [same] * 2) < 1e-6


@pytest.mark.long("Ac6", "Hexapod")
@EVERY_NAME
def test_radians_and_batches(name: str) -> None:
    """Frames, axes, Jacobians, margins and velocities in radians, each alone and in a batch."""
    for robot, axes, size in machines(name):
        made = mounted(robot)
        own, at = made.in_radians(), radian(robot, axes)
        frame, configuration = made.forward(axes)
        same = own.forward(at)
        assert apart(same[0].matrix, frame.matrix) < 1e-9 * size and same[1] == configuration
        back, expected = own.inverse(frame, configuration, at), made.inverse(frame, configuration, axes)
        assert apart(back, radian(robot, expected)) < 1e-9 * size
        near = own.inverse_batch([frame.matrix], None, configuration, at)
        assert near[1][0] == Status.OK and apart(near[0][0], back) < 1e-9 * size
        every, statuses = own.inverse_all_batch([frame.matrix], None, at)
        slots = own.inverse_all(frame, at)
        for slot, truth, code in zip(slots, made.inverse_all(frame, axes), statuses[0].tolist(), strict=True):
            assert slot.status == truth.status and slot.configuration == truth.configuration
            assert len(slot.others) == len(truth.others)
            if made._has_one_solution_a_branch():
                assert code == slot.status
            if slot.axes is not None and truth.axes is not None:
                assert apart(slot.axes, radian(robot, truth.axes)) < 1e-9 * size
        assert every.shape == (1, len(slots), len(at))
        rows = own.jacobian(at)
        assert own.JACOBIAN_ROWS == made.JACOBIAN_ROWS and apart(rows, made.jacobian(axes)) < 1e-9 * size
        matrices, outcomes = own.jacobian_batch([at, at])
        assert (outcomes == Status.OK).all() and matrices.shape == (2, len(own.JACOBIAN_ROWS), len(at))
        assert apart(matrices, np.reshape([rows, rows], matrices.shape)) < 1e-9 * size
        singular, margins = own.singularity_batch([at])
        alone = own.singularity(at)
        assert bool(singular[0]) == alone.is_singular and apart(margins[0], list(alone.margins.values())) < 1e-9
        assert alone.margins == pytest.approx(made.singularity(axes).margins, abs=1e-9)
        moved = tuple(0.1 * (i + 1) for i in range(len(at)))
        assert apart(own.twist(at, moved), made.twist(axes, moved)) < 1e-9 * size
        assert own.manipulability(at, 300.0) == pytest.approx(made.manipulability(axes, 300.0), rel=1e-6, abs=1e-12)
        if not alone.is_singular:
            held = tuple(moved[i] for i in robot.HELD)
            back = own.axis_velocities(at, own.twist(at, moved), held=held)
            assert apart(own.twist(at, back), own.twist(at, moved)) < 1e-6 * size
            assert own.condition(at, 300.0) == pytest.approx(made.condition(axes, 300.0), rel=1e-6)


@EVERY_NAME
def test_names_and_lines(name: str) -> None:
    """Configurations have the names of the bare machine; the tool is on the line at every sample."""
    for robot, axes, size in machines(name):
        made = mounted(robot)
        frame, configuration = made.forward(axes)
        assert made.names(configuration) == robot.names(configuration) == made.in_radians().names(configuration)
        named = {key.replace(" ", "_"): value for key, value in made.names(configuration).items()}
        assert made.configuration(**named) == robot.configuration(**named) == configuration
        beside = [[a if i in robot.HELD else a + step for i, a in enumerate(axes)] for step in (2.0, -2.0)]
        goal = made.forward(beside[np.argmax(made.forward_batch(beside)[3] == Status.OK)])[0]
        line = made.line(frame.matrix, goal, configuration, axes, samples=3)
        assert line.axes and apart(line.axes[0], axes) < 1e-5 * size
        start, end = np.array(frame.position), np.array(goal.position)
        met = 1e-8 if {"x", "y", "z"} <= {*robot.JACOBIAN_ROWS} else 1e-6  # outside the task it is tolerated
        for place, own, reached in zip(line.places, line.axes, line.frames, strict=True):
            assert apart(reached.position, start + place * (end - start)) < 1e-9 * (size + 1000.0)
            if robot.ROLE != "orientation" and not isinstance(robot, IterativeForward):
                assert missed(robot, made.forward(own)[0].position, reached.position) < met * (size + 1000.0)
        other = made.in_radians().line(frame, goal, configuration, radian(robot, axes), samples=3)
        assert bool(other) == bool(line) and apart(other.places, line.places) < 1e-6
        for own, same in zip(line.axes, other.axes, strict=True):
            assert apart(radian(robot, own), same) < 1e-6 * size


def test_a_coupling_of_parts_in_radians() -> None:
    """It answers as the coupling in radians; its automatic choice counts the same axes, and a mixed pair is refused."""
    scara = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0)
    wrist = softkin.Wrist3(tool_offset_z=75.0)
    pair, near = softkin.Coupled(scara, wrist), (-50.0, -40.0, 20.0, 5.0, -60.0, 100.0)
    own = softkin.Coupled(scara.in_radians(), wrist.in_radians())
    frame, _ = pair.forward((20.0, 30.0, 40.0, 25.0, 35.0, -50.0))
    for call, arguments in (("inverse", ((0,) * len(pair.CONFIGURATION),)), ("nearest", ())):
        expected = getattr(pair, call)(frame, *arguments, reference=near)
        found = getattr(own, call)(frame, *arguments, reference=radian(pair, near))
        assert apart(found, radian(pair, expected)) < 1e-9
    assert own.in_degrees() == pair and own.in_radians() is own and Mechanism.from_json(own.to_json()) == own
    assert own.with_base(BASE) == pair.with_base(BASE).in_radians()
    assert refusal(softkin.Coupled, scara.in_radians(), wrist, says="same unit") is Status.INVALID_COUPLING


def test_what_a_dictionary_may_be() -> None:
    """A base or a tool in any form of a frame; other entries are refused, and so is a tool that cannot be carried."""
    gantry = softkin.Gantry3().to_dict()
    made = Mechanism.from_dict({"mechanism": "Mounted", "bare": gantry, "base": BASE.matrix.tolist()})
    assert made == softkin.Gantry3().with_base(BASE)
    for given in (
        {},
        {"bare": 3},
        {"bare": gantry, "tools": 1},
        {"bare": gantry, "tool": {"position": (0.0, 0.0, 0.0)}},
    ):
        wrong = {"mechanism": "Mounted", **given}
        assert refusal(Mechanism.from_dict, wrong, says="Mounted: the entries") is Status.NOT_INITIALIZED
    arm = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=250.0).to_dict()
    with pytest.raises(KinematicsError, match="cannot carry"):
        softkin.Mounted.from_dict({"bare": arm, "tool": ((30.0, 0.0, 0.0), np.eye(3))})


def test_limits_of_other_quantities_in_radians() -> None:
    """An angle beside the axes is in radians behind a base and in a coupling, and `changed` takes it so."""
    arm = softkin.PCC(link_length_1=300.0, link_length_2=200.0, limits={"elbow": (0.0, 90.0)})
    for one in (arm, arm.with_base(BASE)):
        own = one.in_radians()
        assert own.limits["elbow"] == pytest.approx((0.0, np.pi / 2.0))
        assert own.changed(limits={"elbow": (0.0, np.pi)}).in_degrees().limits["elbow"] == pytest.approx((0.0, 180.0))
        assert own.changed(offset_a1=np.pi).in_degrees() == one.changed(offset_a1=180.0)
    pair = softkin.Coupled(softkin.PCC(link_length_1=300.0, link_length_2=200.0), softkin.Tool())
    assert "elbow" in pair.limits and pair.in_radians()._parameter_units()["lower_elbow"] == "rad"
    limited = pair.changed(position=arm)
    assert limited.in_radians().limits["elbow"] == pytest.approx((0.0, np.pi / 2.0))
