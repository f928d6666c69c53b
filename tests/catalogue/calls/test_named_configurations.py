"""Configurations by names, and back; slots that a call refuses."""

import copy
import pickle
from functools import partial
from itertools import product

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from tests.catalogue.calls.mountings import EVERY, NAMES, limited, mounted, poses, radian, robots
from tests.catalogue.refusals import refusal


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("name", NAMES)
def test_names_and_back(name: str) -> None:
    """Every slot on turns: its names make it again, and it is a configuration as any tuple."""
    for number, one in enumerate(robots(name)):
        robot = one.made
        described = robot.CONFIGURATION
        for branches in product((0, 1, 2, 3), repeat=robot.BRANCHES):
            turns = iter((-3, 2, 0, 5, -1, 127, 1))
            signs = iter(branches)
            given = tuple(next(signs) if byte.kind == "branch" else next(turns) for byte in described)
            names = robot.names(given)
            assert list(names) == [byte.name for byte in described]
            made = robot.configuration(**{key.replace(" ", "_"): value for key, value in names.items()})
            assert made == given and made.names == names and isinstance(made, tuple)
            for other in (copy.copy(made), copy.deepcopy(made), pickle.loads(pickle.dumps(made))):
                assert other == made and repr(other) == repr(made)
            assert all(f"{key.replace(' ', '_')}={value!r}" in repr(made) for key, value in names.items())
        axes = poses(name, number, 1)[0]
        frame, own = robot.forward(axes)
        named = robot.configuration(**{key.replace(" ", "_"): value for key, value in robot.names(own).items()})
        answer = robot.inverse(frame, own, axes)
        sides = ", ".join(str(side) for side in list(robot.names(own).values())[: robot.BRANCHES])
        assert robot.inverse(frame, named, axes) == robot.inverse(frame, robot.names(own), axes) == answer
        assert robot.in_radians().diagnose(frame, robot.names(own), radian(robot, axes)).status is Status.OK
        if 3 not in own and not isinstance(robot, softkin.Coupled):
            words = robot.inverse(frame, sides, axes), robot.inverse_batch([frame], None, sides, axes)[0][0]
            assert robot.names(sides) == robot.names(own[: robot.BRANCHES] + (0,) * (len(own) - robot.BRANCHES))
            assert words[0] == pytest.approx(answer, abs=1e-6) and words[1] == pytest.approx(answer, abs=1e-6)
        assert robot.configuration() == robot.DEFAULT_CONFIGURATION


def test_what_is_refused() -> None:
    """Unknown names and values are told the known ones."""
    robot = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0)
    assert robot.configuration(elbow="left", A4=2) == (2, 2, 0, 0)
    assert repr(robot.configuration(elbow="left", A4=2)) == "configuration(elbow='left', A4=2, A1=0, A2=0)"
    for given, words in (
        ({"arm": "left"}, "elbow, A4, A1, A2"),
        ({"elbow": "up"}, "'right', 'left', 'automatic'"),
        ({"elbow": 4}, "0 to 3"),
        ({"elbow": True}, "0 to 3"),
        ({"A4": "two"}, "whole number"),
        ({"A4": 200}, "whole number"),
        ({"A4": 1.5}, "whole number"),
        ({"A3": 1}, "elbow, A4, A1, A2"),
    ):
        assert refusal(robot.configuration, **given, says=words) is Status.BAD_INPUT
    frame = robot.forward((10.0, 20.0, 5.0, 30.0))[0]
    for told, words in (
        ("up", r"'up' is no branch; its branches are elbow \(right or left\)"),
        ("left right", "'right' and another one are branches of one byte"),
        ({"elbow": "up"}, "'right', 'left', 'automatic'"),
        ({"arm": "left"}, "elbow, A4, A1, A2"),
        ({0: 1}, "no branch and no turn"),
    ):
        for one in (robot, robot.in_radians(), robot.with_tool(softkin.Frame((1.0, 0.0, 0.0)))):
            for call, given in (
                (one.inverse, frame),
                (one.diagnose, frame),
                (partial(one.inverse_batch, [frame]), None),
            ):
                assert refusal(call, given, told, says=words) is Status.BAD_INPUT
    with pytest.raises(KinematicsError, match="none"):
        softkin.Gantry2().configuration(elbow="left")
    for wrong in ((4, 0, 0, 0), (1, 0, 0)):
        with pytest.raises(KinematicsError):
            robot.names(wrong)


@pytest.mark.broad
@pytest.mark.parametrize("name", EVERY)
def test_a_slot_has_the_reason_of_diagnose(name: str) -> None:
    """Limits and reach refuse, bare and mounted, in degrees and in radians: the reason is that of the slot alone."""
    refused = 0
    for bare, axes, size in limited(name, np.random.default_rng(4)):
        made = mounted(bare)
        for robot in (bare, made, bare.in_radians(), made.in_radians()):
            near = axes if robot.in_degrees() is robot else radian(robot.in_degrees(), axes)
            frame = robot.forward(near)[0]
            for asked in (frame, frame.shifted(x=30.0 * size)):
                for slot in robot.inverse_all(asked, near):
                    assert (slot.refusal is None) == (slot.status is Status.OK) == (slot.axes is not None)
                    if slot.refusal is not None:
                        refused += 1
                        assert slot.refusal.status is slot.status
                        alone = robot.diagnose(asked, slot.configuration, near)
                        assert slot.refusal.reason == alone.reason or alone.status is Status.OK
                        assert slot.refusal.turn == alone.turn
                        assert abs(slot.refusal.missing - alone.missing) < 1e-9 * size
    assert refused or isinstance(bare, softkin.Coupled) or not bare.AXES


@pytest.mark.broad
def test_the_limit_and_the_amount() -> None:
    """An arm whose other elbow is 5 degrees beyond a limit; a rotation that is none refuses every slot."""
    robot = softkin.Scara4ZCcoupledType1(link_length_1=300.0, link_length_2=300.0, limits={"A2": (-15.0, 170.0)})
    frame = robot.forward((10.0, 20.0, 5.0, 30.0))[0]
    right, left = robot.inverse_all(frame)
    assert right.refusal is None and left.refusal is not None and left.axes is None
    assert left.refusal.in_words == "A2: below its lower limit, missing 5.0 deg"
    (first, second) = robot.in_radians().inverse_all(frame)
    assert first.axes and second.refusal and second.refusal.in_words == "A2: below its lower limit, missing 0.08727 rad"
    skewed = (frame.position, ((1.0, 0.1, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    with pytest.raises(KinematicsError, match="was the frame converted from REAL") as error:
        robot.inverse(skewed)
    assert [slot.refusal for slot in robot.inverse_all(skewed)] == [error.value.refusal] * 2
