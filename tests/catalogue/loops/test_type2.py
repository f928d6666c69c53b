"""Where nothing controls the plate: the closure is lost, paths stop before it, and the least margin is sharp."""

from dataclasses import dataclass

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import Array
from tests.catalogue.loop_machines import LoopMachine, facing, facings
from tests.catalogue.machines import few
from tests.catalogue.refusals import refusal
from tests.text.controller import OK, UNREACHABLE, Controller
from tests.text.units import compiled

pytestmark = pytest.mark.slow

POINTS = np.linspace(0.0, 1.0, 101)
PARTNERS = 3000
TRIES = 150
HALVINGS = 60


@dataclass(frozen=True)
class Crossing:
    """A line from a pose to one of the other assembly mode; every leg reaches all of it in one working mode."""

    machine: LoopMachine
    unlimited: softkin.Mechanism
    """The machine with no least margin."""
    other: softkin.Mechanism
    """The same, in the other assembly mode."""
    axes: Array
    """At the start."""
    configuration: tuple[int, ...]
    start: Array
    end: Array
    at: float
    """The place of the singularity on the line, from 0 to 1, where the assembly mode changes."""

    def positions(self, shares: Array) -> Array:
        return self.start + (self.end - self.start) * np.asarray(shares)[:, None]


def crossing_of(machine: LoopMachine) -> Crossing | None:
    """The first line that is found; None where no working mode has poses of both assembly modes."""
    assembly = machine.mechanism.assembly
    assert assembly is not None
    unlimited = machine.changed(min_type2_margin=0.0)
    other = machine.changed(**{assembly.parameter: not machine.given[assembly.parameter]}, min_type2_margin=0.0)
    far, modes = _poses(other, machine.candidates(PARTNERS, np.random.default_rng(5)), machine)
    near, configurations = _poses(unlimited, machine.pool, machine)
    for axes, start, configuration in list(zip(machine.pool, near, configurations, strict=True))[:TRIES]:
        same = np.flatnonzero((modes == configuration).all(axis=1))
        if len(same) == 0:
            continue
        end = far[same[np.linalg.norm(far[same] - start, axis=1).argmin()]]
        code = (*configuration.tolist(), *(0,) * len(machine.robot.PERIOD_AXES))
        line = Crossing(machine, unlimited, other, axes, code, start, end, 1.0)
        mine, theirs = (_answers(robot, line, POINTS) for robot in (unlimited, other))
        if (mine ^ theirs).all() and mine[0] and theirs[-1] and (np.diff(mine.astype(int)) != 0).sum() == 1:
            return Crossing(machine, unlimited, other, axes, code, start, end, _lost(line))
    return None


def _poses(robot: softkin.Mechanism, axes: Array, machine: LoopMachine) -> tuple[Array, Array]:
    positions, _, configurations, statuses = robot.forward_batch(axes)
    there = statuses == Status.OK
    return positions[there], configurations[there][:, : machine.robot.BRANCHES]


def _answers(robot: softkin.Mechanism, line: Crossing, shares: Array) -> Array:
    return (
        robot.inverse_batch(line.positions(shares), facings(robot, len(shares)), line.configuration, line.axes)[1]
        == Status.OK
    )


def _lost(line: Crossing) -> float:
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if _answers(line.unlimited, line, np.array([middle]))[0] else (low, middle)
    return low


LEAST, SINGULAR = 1e-3, 1e-3
"""The default of the least margin, and what `IsSingularity` calls singular."""
BEFORE = 10.0 ** -np.arange(2.0, 10.5, 0.5)
"""How far before the crossing a path is looked at, as parts of the line."""
NO_TURN = np.eye(3)


@pytest.fixture
def crossings(mechanism: Mechanism, machines: tuple[LoopMachine, ...]) -> list[Crossing]:
    """A way through the singularity for every machine with one; of type 12 as drawn they are of type 1 too."""
    found = [c for c in map(crossing_of, few(machines)) if c is not None]
    assert len(found) == (1 if mechanism.name == "MC_KIN_TYPE_12_XY" else 2)
    return found


def rotation_of(machine: LoopMachine) -> list[list[float]]:
    turned = facing(machine.robot)
    return (NO_TURN if turned is None else turned).tolist()


def margin(machine: LoopMachine, axes: Array) -> float:
    """The size of the type 2 margin at axis values."""
    assembly = machine.mechanism.assembly
    assert assembly is not None
    return abs(machine.robot.singularity(axes).margins[assembly.margin])


def asked(robot: softkin.Mechanism, position: Array, configuration: tuple[int, ...], reference: Array) -> Array | None:
    """The axes; None where the scalar call says that they are out of reach."""
    try:
        return np.array(robot.inverse((position, facing(robot)), configuration, reference))
    except KinematicsError as refusal:
        assert refusal.status is Status.UNREACHABLE
        return None


def determinant(machine: LoopMachine, axes: Array, position: Array) -> float:
    """det A of the closure alone."""
    joints = machine.closure.joints(axes[None])
    return float(np.linalg.det(machine.closure.by_position(joints, position[None]))[0])


def test_the_closure_itself_is_lost_there(crossings: list[Crossing]) -> None:
    """Just before and just behind, det A of the closure is next to nothing and has opposite signs; the legs move on."""
    for line in crossings:
        before, behind = line.positions(np.array([line.at - 1e-9, line.at + 1e-9]))
        here = asked(line.unlimited, before, line.configuration, line.axes)
        assert here is not None
        beyond = asked(line.other, behind, line.configuration, here)
        assert beyond is not None
        assert np.abs(here - beyond).max() < 1e-4 * line.machine.reach
        values = [determinant(line.machine, *p) for p in ((line.axes, line.start), (here, before), (beyond, behind))]
        assert np.abs(values[1:]).max() < 1e-5 * abs(values[0])
        assert np.sign(values[0]) == np.sign(values[1]) == -np.sign(values[2])


def test_a_path_is_stopped_before_the_crossing(crossings: list[Crossing]) -> None:
    """Small steps with the last answer as reference: answers without a jump, then refusals alone, in both languages."""
    for line in crossings:
        machine = line.machine
        controller = Controller(compiled(machine.mechanism), machine.mechanism)
        assert controller.initialise(machine.robot.parameters) == OK
        shares = np.unique(np.concatenate([np.linspace(0.0, 1.0, 81), line.at - BEFORE, line.at + BEFORE]))
        shares = shares[(shares >= 0.0) & (shares <= 1.0)]
        last, stopped = line.axes, False
        for share, position in zip(shares, line.positions(shares), strict=True):
            axes = asked(machine.robot, position, line.configuration, last)
            turned = rotation_of(machine)
            status, found = controller.inverse(tuple(position), turned, line.configuration, tuple(last))
            assert status == (UNREACHABLE if axes is None else OK)
            if axes is None:
                stopped = True
                continue
            assert not stopped
            assert share < line.at
            np.testing.assert_allclose(found[: len(axes)], axes, rtol=1e-9, atol=1e-9)
            joints = machine.closure.joints(axes[None])
            assert machine.miss(axes[None], position[None], np.array([turned]))[0] < 1e-12
            assert machine.closure.side(joints, position[None])[0] > 0
            assert margin(machine, axes) >= LEAST * (1 - 1e-6)
            last = axes
        assert stopped
        assert margin(machine, last) < 0.5  # the way goes far enough to be about this singularity


def test_nearer_than_the_threshold_it_is_flagged(crossings: list[Crossing]) -> None:
    """With the refusal switched off the inverse answers up to the crossing, and `IsSingularity` warns before it."""
    for line in crossings:
        machine, flagged = line.machine, 0
        for position in line.positions(line.at - BEFORE):
            axes = asked(line.unlimited, position, line.configuration, line.axes)
            assert axes is not None
            singularity = line.unlimited.singularity(axes)
            near = margin(machine, axes)
            assert singularity.is_singular == (min(map(abs, singularity.margins.values())) < SINGULAR)
            assert (asked(machine.robot, position, line.configuration, line.axes) is None) == (near < LEAST)
            flagged += near < SINGULAR
        assert flagged >= 3
        for position in line.positions(line.at + BEFORE):
            assert asked(line.unlimited, position, line.configuration, line.axes) is None
            assert asked(machine.robot, position, line.configuration, line.axes) is None


def test_the_least_margin_is_sharp(machines: tuple[LoopMachine, ...]) -> None:
    """A hair below the margin of a pose answers, a hair above refuses: every call that solves, in both languages."""
    for machine in few(machines):
        block = Controller(compiled(machine.mechanism), machine.mechanism)
        for axes in machine.draw(6, np.random.default_rng(3)):
            (x, y, z), configuration = machine.robot.forward(axes)[0].position, machine.robot.forward(axes)[1]
            position, there = (x, y, z), margin(machine, axes)
            for share, expected in ((1 - 1e-9, Status.OK), (1 + 1e-9, Status.UNREACHABLE)):
                robot = machine.changed(min_type2_margin=there * share)
                assert block.initialise(robot.parameters) == OK
                status = block.inverse(position, rotation_of(machine), configuration, tuple(axes))[0]
                assert status == expected.softmotion
                assert robot.inverse_batch([position], facings(robot, 1), configuration, axes)[1][0] == expected
                branches = configuration[: robot.BRANCHES]
                (own,) = (
                    s
                    for s in robot.inverse_all((position, facing(robot)), axes)
                    if s.configuration[: robot.BRANCHES] == branches
                )
                assert own.status is expected
                assert (asked(robot, np.array(position), configuration, axes) is not None) == (expected is Status.OK)
                offset = (0.0, 0.0, 0.0)
                assert block.inverse_offset(position, offset, configuration, tuple(axes))[0] == expected.softmotion
            assert asked(machine.changed(min_type2_margin=0.0), np.array(position), configuration, axes) is not None


def test_the_other_assembly_mode_is_refused(machines: tuple[LoopMachine, ...]) -> None:
    """Poses of the same machine assembled the other way: their very slot is refused, with the least margin off too."""
    for nominal, other in (machines[:2], machines[1::-1]):
        axes = other.draw(60, np.random.default_rng(4))
        positions, rotations, configurations, _ = other.robot.forward_batch(axes)
        for robot in (nominal.robot, nominal.changed(min_type2_margin=0.0)):
            found, statuses = robot.inverse_batch(positions, rotations, configurations, axes)
            assert (statuses == Status.UNREACHABLE).all()
            assert np.isnan(found).all()
            assert asked(robot, positions[0], tuple(configurations[0].tolist()), axes[0]) is None
        assert (other.robot.inverse_batch(positions, rotations, configurations, axes)[1] == Status.OK).all()


def test_forward_has_one_solution_a_side(machines: tuple[LoopMachine, ...]) -> None:
    """Newton's method finds two poses at regular axis values, and each assembly mode is one of them."""
    rng = np.random.default_rng(6)
    for machine in machines:
        assembly = machine.mechanism.assembly
        assert assembly is not None
        axes = machine.draw(12, rng)
        joints = machine.closure.joints(axes)
        ends = [machine.closure.assembly_from(joints, d / np.linalg.norm(d)) for d in rng.normal(size=(24, 3))]
        other = machine.changed(**{assembly.parameter: not machine.given[assembly.parameter]})
        both = [robot.forward_batch(axes)[0] for robot in (machine.robot, other)]
        for row in range(len(axes)):
            found: list[Array] = []
            for positions, closed in ends:
                if closed[row] and all(np.abs(positions[row] - f).max() > 1e-6 * machine.reach for f in found):
                    found.append(positions[row])
            assert len(found) == 2
            for answered in both:
                assert min(np.abs(answered[row] - f).max() for f in found) < 1e-9 * machine.reach
            sides = [machine.closure.side(joints[row : row + 1], answered[row : row + 1])[0] for answered in both]
            assert sides[0] > 0 > sides[1]


def test_forward_answers_where_the_loop_closes_and_nowhere_else(machines: tuple[LoopMachine, ...]) -> None:
    for machine in few(machines):
        axes = machine.candidates(300, np.random.default_rng(8))
        expected = np.isfinite(machine.closure.poses(axes)[0]).all(axis=1)
        positions, rotations, _, statuses = machine.robot.forward_batch(axes)
        assert (statuses == np.where(expected, Status.OK, Status.IMPOSSIBLE)).all()
        assert machine.miss(axes[expected], positions[expected], rotations[expected]).max() < 1e-11
        for row in axes[~expected][:5]:
            assert refusal(machine.robot.forward, row) is Status.IMPOSSIBLE
            assert machine.robot.singularity(row).is_singular
