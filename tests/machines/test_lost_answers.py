"""Near several right angles at once no pose of a machine is refused on its branch, whatever the reference is.

There several steps of a closed form lose digits at once: a root near zero has half of them, and a nearly free angle may
have none. A later step would then refuse poses that the machine has: of the arm whose parallel axes come last, every
twentieth.
"""

import numpy as np
import pytest
import softkin
from softkin import Frame, Status

from tests.machines.lost_answers import KINDS, REFERENCES, Sized, references, sized
from tests.machines.made import Array, made
from tests.machines.parallel_machines import LAST
from tests.machines.spoken import asked_in
from tests.text.controller import OK

WITHIN = 1e-11
"""Of what is missed: an angle is free below 2e-12 of its scale, and two may be, each with a chord of 2."""
EVERY = pytest.mark.parametrize("name", KINDS)
pytestmark = pytest.mark.slow


def lost(machine: Sized, count: int, seed: int, each: int = 1) -> list[tuple[str, str, list[float]]]:
    """The poses, of so many by this step, that are refused, or met with an error that is more than rounding."""
    rng = np.random.default_rng(seed)
    drawn = machine.axes(count, rng)
    axes, near = drawn[::each], np.concatenate([references(word, drawn, rng)[::each] for word in REFERENCES])
    rows = np.tile(np.arange(len(axes)), len(REFERENCES))
    positions, rotations, configurations, _ = (part[rows] for part in machine.robot.forward_batch(axes))
    answers, statuses = machine.robot.inverse_batch(positions, rotations, configurations, near)
    found = statuses != Status.OK
    found[~found] = machine.missed(axes[rows[~found]], answers[~found]) > WITHIN
    return [(machine.label, REFERENCES[k // len(axes)], axes[rows[k]].tolist()) for k in np.flatnonzero(found)]


@EVERY
def test_no_pose_is_lost(name: str) -> None:
    assert [pose for machine in sized(KINDS[name]) for pose in lost(machine, 8000, 32, each=11)] == []


CROSSING = ((0.0, 0.01, -1e-13, 0.0, 0.0, -90.0), (90.0, -0.003, 1e-12, 0.0, 0.0, 0.0))
"""Axes (degrees) of the arm whose parallel axes come last: if A3 is zero, the free A2 is parallel to them, and the arm
is stretched at one value of it alone. Steps on the closure leave this line for another one, which crosses it at A2 = 0.
"""


@pytest.mark.parametrize("axes", CROSSING)
def test_where_free_angles_cross_the_nearest_value_is_found(axes: tuple[float, ...]) -> None:
    """Only a value of the free angle that is near enough meets the pose."""
    machine = next(sized(KINDS["three parallel axes last"]))
    answer = machine.robot.inverse(*machine.robot.forward(axes), (0.0,) * 6)
    assert machine.missed(np.array([axes]), np.array([answer])).max() <= WITHIN


@EVERY
def test_no_pose_is_lost_one_by_one(name: str) -> None:
    """On plain numbers: on the branch, and among all solutions."""
    rng = np.random.default_rng(33)
    for machine in sized(KINDS[name]):
        for axes in machine.axes(30, rng).tolist():
            frame, configuration = machine.robot.forward(axes)
            for word in REFERENCES:
                near = references(word, np.array([axes]), rng)[0].tolist()
                answer = machine.robot.inverse(frame, configuration, near)
                assert machine.missed(np.array([axes]), np.array([answer])).max() <= WITHIN
                assert any(s.axes is not None for s in machine.robot.inverse_all(frame, near))


def asked(count: int) -> tuple[Sized, list[tuple[list[float], Frame, tuple[int, ...], list[float]]]]:
    """Poses of the arm whose parallel axes come last: axes, frame, configuration, reference."""
    rng, machine = np.random.default_rng(34), next(sized(KINDS["three parallel axes last"]))
    axes = machine.axes(count, rng)
    near = [references(REFERENCES[k % 3], axes[k : k + 1], rng)[0].tolist() for k in range(len(axes))]
    rows = [(row, *machine.robot.forward(row), r) for row, r in zip(axes.tolist(), near, strict=True)]
    return machine, rows


def is_met(machine: Sized, axes: list[float], answer: Array) -> bool:
    return bool(machine.missed(np.array([axes]), np.array([answer])).max() <= WITHIN)


def test_the_block_loses_no_pose() -> None:
    """In executed Structured Text."""
    machine, rows = asked(90)
    controller = made(LAST).controller()
    assert controller.initialise(machine.robot.parameters) == OK
    for axes, frame, configuration, near in rows:
        status, answer = controller.inverse(frame.position, frame.rotation, configuration, near)
        assert status == OK, axes
        assert is_met(machine, axes, answer[: len(axes)])


@pytest.mark.parametrize("language", ["c", "javascript"])
def test_other_languages_lose_no_pose(language: str) -> None:
    machine, rows = asked(600)
    poses = [{"position": list(f.position), "rotation": [list(r) for r in f.rotation]} for _, f, _, _ in rows]
    calls = [["inverse", pose, list(row[2]), row[3]] for pose, row in zip(poses, rows, strict=True)]
    sent = [{"parameters": dict(machine.robot.parameters), "calls": calls}]
    (found,) = asked_in(language, made(LAST).mechanism, sent)
    for row, answer in zip(rows, found["found"], strict=True):
        assert answer["status"] == 0, row[0]
        assert is_met(machine, row[0], answer["axes"])


def test_what_the_machine_does_not_reach_stays_refused() -> None:
    """Poses beyond the reach, next to where the branches meet and the wrist is free."""
    for machine in sized(KINDS["three parallel axes first"]):
        axes = machine.axes(30, np.random.default_rng(35))
        positions, rotations, configurations, _ = machine.robot.forward_batch(axes)
        beyond = positions + np.array([0.0, 0.0, 2.5 * machine.reach])
        statuses = machine.robot.inverse_batch(beyond, rotations, configurations, axes)[1]
        assert (statuses == softkin.Status.UNREACHABLE).all()
