"""Axes have several poses: calls answer for the given one; the inverse accepts none that is not found again."""

import re
import sys
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from softkin import Frame, KinematicsError, Status

from tests.catalogue.refusals import refusal
from tests.languages.language import LANGUAGES, Language
from tests.machines.other_poses import CATALOGUE, OWN, TURNING, Platform, Solved, platform
from tests.text.controller import OK, UNREACHABLE, Controller
from tests.text.units import compiled_text, text_of

pytestmark = pytest.mark.slow

EVERY = pytest.mark.parametrize("name", (*CATALOGUE, *OWN))
WORDS = "forward kinematics from the home pose does not find this pose again"
_NEAR = 2e-4
"""Of central differences, as a part of the rows."""


def confirm(solved: Solved, rows: Any) -> None:
    """The Jacobian is that of the pose."""
    sizes = np.abs(solved.jacobian).max(axis=1, keepdims=True)
    assert_allclose(np.array(rows)[: len(sizes), : len(sizes)] / sizes, solved.jacobian / sizes, atol=_NEAR)


def lost_and_kept(name: str) -> tuple[Platform, list[Solved], list[Solved]]:
    """A machine with the poses of both kinds; without a start, at least one Jacobian of the lost ones is another."""
    one = platform(name)
    lost, kept = one.poses
    assert len(lost) >= 3 and len(kept) >= 3, (len(lost), len(kept))
    return one, lost, kept


@EVERY
def test_calls_answer_for_the_given_pose(name: str) -> None:
    """Jacobian, margins, velocities, condition, orientation: one by one, in arrays, in radians, on a base."""
    one, lost, kept = lost_and_kept(name)
    robot, based = one.open_robot, one.open_robot.with_base(Frame((10.0, -20.0, 30.0)))
    for solved in lost + kept:
        axes, start = solved.axes, solved.frame
        confirm(solved, robot.jacobian(axes, start))
        assert one.is_same(start, robot.forward(axes, start)[0], 1e-6)
        moved = robot.twist(axes, [1.0] * len(axes), start=start)
        assert_allclose(moved, np.array(robot.jacobian(axes, start)).sum(axis=1), atol=1e-12)
        assert_allclose(robot.axis_velocities(axes, moved, start=start), 1.0, atol=1e-6)
        assert robot.condition(axes, 100.0, start) >= 1.0
        radians = robot.in_radians()
        own = [a * np.pi / 180.0 if axis.unit == "deg" else a for a, axis in zip(axes, robot.AXES, strict=True)]
        assert_allclose(radians.jacobian(own, start), robot.jacobian(axes, start), rtol=1e-9, atol=1e-9)
        there = Frame((10.0, -20.0, 30.0)) @ start
        shown = [row for row, word in enumerate(robot.JACOBIAN_ROWS) if "tilt" not in word]
        found, own = (np.array(rows)[shown] for rows in (based.jacobian(axes, there), robot.jacobian(axes, start)))
        assert_allclose(found, own, rtol=1e-9, atol=1e-9)
    every = np.array([s.axes for s in lost + kept])
    starts = [s.frame.position for s in lost + kept], [s.frame.rotation for s in lost + kept]
    for made, begun in ((robot, starts), (based, _on(starts))):
        rows, statuses = made.jacobian_batch(every, begun)
        assert (statuses == Status.OK).all()
        for k, solved in enumerate(lost + kept):
            start = begun[0][k], begun[1][k]
            assert_allclose(rows[k], made.jacobian(solved.axes, start), rtol=1e-9, atol=1e-9)
    margins = robot.singularity_batch(every, starts)[1]
    for solved, found in zip(lost + kept, margins, strict=True):
        assert_allclose(found, list(robot.singularity(solved.axes, solved.frame).margins.values()), atol=1e-9)


def _on(starts: tuple[Any, Any]) -> tuple[Any, Any]:
    return [np.array(p) + (10.0, -20.0, 30.0) for p in starts[0]], starts[1]


@EVERY
def test_without_a_start_the_answer_is_another(name: str) -> None:
    """At some of these poses, which the open inverse accepts; else the test above would prove nothing."""
    one, lost, _ = lost_and_kept(name)
    differs = 0
    for solved in lost:
        try:
            confirm(solved, one.open_robot.jacobian(solved.axes))
        except (AssertionError, KinematicsError):
            differs += 1
    assert differs == len(lost)


@EVERY
def test_the_inverse_refuses_what_is_not_found_again(name: str) -> None:
    """In every call, with its own reason; it accepts the others with the same axes."""
    one, lost, kept = lost_and_kept(name)
    robot, size = one.robot, len(one.robot.AXES)
    for solved in lost:
        asked = solved.frame, solved.configuration, solved.axes
        with pytest.raises(KinematicsError, match=WORDS) as refused:
            robot.inverse(*asked)
        assert refused.value.status is Status.UNREACHABLE and robot.diagnose(*asked).reason == WORDS
        slots = {s.configuration[: robot.BRANCHES]: s for s in robot.inverse_all(solved.frame, solved.axes)}
        assert slots[solved.configuration[: robot.BRANCHES]].status is Status.UNREACHABLE
        assert not robot.path([solved.frame] * 2, solved.configuration, solved.axes).axes
    for solved in kept:
        assert_allclose(robot.inverse(solved.frame, solved.configuration, solved.axes), solved.axes, atol=1e-9)
    for group, status in ((lost, Status.UNREACHABLE), (kept, Status.OK)):
        frames = [s.frame.position for s in group], [s.frame.rotation for s in group]
        references = np.array([s.axes for s in group]).reshape(-1, size)
        found = robot.inverse_batch(*frames, np.array([s.configuration for s in group]), references)
        assert (found[1] == status).all()


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_header_states_how_many_are_found_again(name: str) -> None:
    """The larger of its two shares is what counting in the package gives, with other poses."""
    one = platform(name)
    words = " ".join(str(sys.modules[type(one.robot).__module__].__doc__).split())
    stated = re.search(r"and (\d+) % within twice as much", words)
    assert stated is not None and "forward kinematics a start" in words
    reached = found = 0
    for frame in one.frames(1.0, one.largest_turn):
        slots = [s.status is Status.OK for s in one.open_robot.inverse_all(frame)]
        if any(slots):
            reached += sum(slots)
            found += sum(s.status is Status.OK for s in one.robot.inverse_all(frame))
    assert reached >= 60
    assert abs(100.0 * found / reached - float(stated[1])) < 150.0 / np.sqrt(reached) + 1.0


@pytest.mark.parametrize("name", TURNING)
def test_of_what_only_turns_every_pose_is_found_again(name: str) -> None:
    one = platform(name)
    assert "and all within twice as much" in " ".join(str(sys.modules[type(one.robot).__module__].__doc__).split())
    lost, kept = one.poses
    assert not lost and len(kept) >= 3


def test_a_rod_at_its_fold_is_kept() -> None:
    """Where a rod stands square to its rail, two carriages meet: the inverse must not refuse that."""
    robot = platform("Softkin_Hexaglide").robot
    given = robot.parameters
    away = [given[f"platform_{k}_y"] - given[f"rail_{k}_y"] for k in range(1, 7)]
    leg = int(np.argmax(np.abs(away)))
    height = -float(np.sqrt(given[f"rod_length_{leg + 1}"] ** 2 - away[leg] ** 2))
    for x in np.linspace(-40.0, 40.0, 41).tolist():
        frame = Frame((x, 0.0, height))
        axes = robot.changed(check_forward=False).inverse(frame)
        assert abs(axes[leg] - x - given[f"platform_{leg + 1}_x"]) < 1e-4
        assert_allclose(robot.inverse(frame), axes)


@EVERY
@pytest.mark.parametrize("language", LANGUAGES, ids=str)
def test_other_languages(name: str, language: Language) -> None:
    """The Jacobian at the given pose, and the decision of the inverse."""
    one, lost, kept = lost_and_kept(name)
    frames = [{"position": s.frame.position, "rotation": s.frame.rotation} for s in lost + kept]
    calls = [["jacobian", s.axes, f] for s, f in zip(lost + kept, frames, strict=True)]
    asked = [["inverse", f, s.configuration, s.axes] for s, f in zip(lost + kept, frames, strict=True)]
    machines = [{"parameters": dict(made.parameters), "calls": calls + asked} for made in (one.open_robot, one.robot)]
    answers = language.ask(language.of(one.mechanism), machines)
    for answer, is_open in zip(answers, (True, False), strict=True):
        rows, found = answer["found"][: len(calls)], answer["found"][len(calls) :]
        for solved, told, inverse in zip(lost + kept, rows, found, strict=True):
            assert told["status"] == Status.OK
            confirm(solved, told["rows"])
            accepted = is_open or any(solved is other for other in kept)
            assert inverse["status"] == (Status.OK if accepted else Status.UNREACHABLE)
            assert accepted or inverse["reason"] == WORDS


@EVERY
def test_structured_text(name: str) -> None:
    """The Jacobian at the given pose, and the decision of CartesianToAxes."""
    one, lost, kept = lost_and_kept(name)
    text = one.parts["st"]["text"] if one.parts else text_of(one.mechanism)
    library = compiled_text(f"{one.mechanism.block_name}.st", text)
    for made, refused in ((one.open_robot, []), (one.robot, lost)):
        block = Controller(library, one.mechanism)
        assert block.initialise(made.parameters) == OK
        for solved in lost + kept:
            position, rotation = solved.frame.position, solved.frame.rotation
            status, rows = block.jacobian(solved.axes, (position, rotation))
            assert status == OK
            confirm(solved, rows)
            asked = position, rotation, solved.configuration, solved.axes
            is_refused = any(solved is other for other in refused)
            assert block.inverse(*asked)[0] == (UNREACHABLE if is_refused else OK)
            assert not is_refused or block.diagnose(*asked)[0] == WORDS


def test_a_start_that_is_none_is_refused() -> None:
    """No rotation, or no number: one by one with its status, in arrays by rows."""
    one, lost, _ = lost_and_kept(CATALOGUE[0])
    axes, frame = lost[0].axes, lost[0].frame
    stretched = tuple(tuple(2.0 * v for v in row) for row in frame.rotation)
    for start in ((frame.position, stretched), ((np.nan, 0.0, 0.0), frame.rotation)):
        assert refusal(one.open_robot.jacobian, axes, start) is Status.BAD_INPUT
        pair = [start[0], frame.position], [start[1], frame.rotation]
        assert one.open_robot.jacobian_batch([axes] * 2, pair)[1].tolist() == [Status.BAD_INPUT, Status.OK]
