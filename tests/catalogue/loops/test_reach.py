"""What can be reached, leg by leg, against the equations of the legs; continuous motions out of a limit."""

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Mechanism
from tests.catalogue.both_ways import inverse
from tests.catalogue.closure import Array
from tests.catalogue.loop_machines import TURNED, LoopMachine, facing, facings, loop_machine
from tests.catalogue.test_path import TOLERANCE, follow
from tests.catalogue.test_round_trip import slots

PLACES = 300
SAMPLES = 720
"""Of a joint: a full turn, or as far as anything reaches."""
SWING, HAIR = "max_angle_ball_joint", 1e-9
CLEAR = 1e-4
"""Of the reach: a leg whose equation comes nearer to zero than this without crossing it is not judged."""


def places(machine: LoopMachine) -> Array:
    """Somewhat farther than regular poses are, in every direction."""
    far = 1.3 * np.abs(machine.closure.poses(machine.pool[:100])[0]).max(axis=0)
    return np.random.default_rng(11).uniform(-1.0, 1.0, (PLACES, 3)) * far


def answers(machine: LoopMachine, positions: Array) -> tuple[Array, Array]:
    """Axis values and whether there are any, by slot and place, with the least margin off."""
    robot = machine.changed(min_type2_margin=0.0)
    turned = facings(robot, len(positions))
    found = [robot.inverse_batch(positions, turned, slot + (0,) * len(robot.PERIOD_AXES)) for slot in slots(machine)]
    assert all(set(statuses.tolist()) <= {Status.OK, Status.UNREACHABLE} for _, statuses in found)
    return np.array([axes for axes, _ in found]), np.array([statuses == Status.OK for _, statuses in found])


def reaches(machine: LoopMachine, positions: Array, leg: int) -> tuple[Array, Array]:
    """Whether a leg reaches places, and whether that is clear: its equation over all values of its joint."""
    ends = np.pi if machine.closure.angles[leg] else 3 * machine.reach
    values = np.linspace(-ends, ends, SAMPLES)
    joints = np.zeros((SAMPLES, len(machine.closure.angles)))
    joints[:, leg] = values
    rows = [machine.closure.equations(joints, np.tile(p, (SAMPLES, 1)), np.eye(3))[:, leg] for p in positions]
    low, high = np.min(rows, axis=1), np.max(rows, axis=1)
    return (low < 0) & (high > 0), np.minimum(np.abs(low), np.abs(high)) > CLEAR * machine.reach


def test_every_answer_closes_the_loop_on_its_side(machines: tuple[LoopMachine, ...]) -> None:
    """Anywhere, reachable or not, in every slot."""
    for machine in machines:
        positions = places(machine)
        found, answered = answers(machine, positions)
        assert 0 < answered.sum() < answered.size
        for axes, there in zip(found, answered, strict=True):
            if there.any():
                turned = np.eye(3) if facing(machine.robot) is None else TURNED
                assert machine.miss(axes[there], positions[there], np.tile(turned, (there.sum(), 1, 1))).max() < 1e-9
                joints = machine.closure.joints(axes[there])
                assert (machine.closure.side(joints, positions[there]) > -1e-9).all()
                assert (machine.closure.room(joints, positions[there]) > -1e-9).all()


def test_a_slot_is_refused_where_a_leg_does_not_reach_and_belongs_to_one_mode_where_all_do(
    machines: tuple[LoopMachine, ...],
) -> None:
    """Of machines whose legs have a joint each."""
    mechanism = machines[0].mechanism
    equations = (*(r.equation for r in mechanism.rods), *mechanism.closure)
    symbols = [j.symbol for j in mechanism.joints if any(j.symbol in e.free_symbols for e in equations)]
    own = [{s for s in symbols if s in e.free_symbols} == {own} for e, own in zip(equations, symbols, strict=True)]
    if not all(own):
        assert mechanism.name in ("MC_KIN_TYPE_12_XY", "Kin_P2X_Type2")
        return
    for machine in machines[::2]:
        positions = places(machine)[:150]
        legs = [reaches(machine, positions, leg) for leg in range(len(symbols))]
        clear = np.all([sure for _, sure in legs], axis=0)
        all_reach = np.all([there for there, _ in legs], axis=0)
        modes = [answers(one, positions)[1].astype(int) for one in _both_modes(machine)]
        assert not (modes[0] + modes[1])[:, clear & ~all_reach].any()
        together = (modes[0] + modes[1])[:, clear & all_reach]
        assert (together <= 1).all()
        assert (together == 1).all() or machine.mechanism.bounds
        assert together.any()


def _both_modes(machine: LoopMachine) -> tuple[LoopMachine, LoopMachine]:
    assembly = machine.mechanism.assembly
    assert assembly is not None
    flag = assembly.parameter
    other = {**machine.given, flag: not machine.given[flag]}
    return machine, loop_machine(machine.mechanism, "other mode", other)


def test_a_ball_joint_ends_sharply(mechanism: Mechanism, machines: tuple[LoopMachine, ...]) -> None:
    """A limit a hair above the swing of a pose answers, a hair below refuses; forward kinematics does not ask."""
    assert bool(mechanism.bounds) == (SWING in machines[0].robot.parameters)
    for machine in machines if mechanism.bounds else ():
        axes = machine.draw(8, np.random.default_rng(1))
        positions, rotations = machine.closure.poses(axes)
        values = machine.closure.at(machine.closure.joints(axes), positions, [b.value for b in mechanism.bounds])
        swings = np.degrees(np.arcsin(np.abs(values).max(axis=1)))
        for row, swing in enumerate(swings):
            one = slice(row, row + 1)
            for share, expected in ((1 + HAIR, Status.OK), (1 - HAIR, Status.UNREACHABLE), (0.5, Status.UNREACHABLE)):
                robot = machine.changed(**{SWING: swing * share})
                _, statuses = inverse(
                    robot, positions[one], rotations[one], robot.forward_batch(axes[one])[2], axes[one]
                )
                assert statuses[0] == expected
                assert robot.forward(axes[row]) == machine.robot.forward(axes[row])


STEPS = 500
SIZES = (60.0, 30.0, 15.0, 8.0, 4.0, 2.0, 1.0)
"""The amplitude of the axes, in degrees or lengths: the path stays regular."""


def swing(machine: LoopMachine, axis: int) -> Array:
    """A way on which all axes swing, about a pose whose one axis stands at half a turn, or anywhere."""
    turns = machine.closure.angles[axis]
    centres = machine.with_axis_at(axis, 180.0, 5) if turns else machine.draw(5, np.random.default_rng(9))
    time = np.linspace(0.0, 2 * np.pi, STEPS)
    waves = np.stack([np.sin((i + 1) * time) for i in range(centres.shape[1])], axis=1)
    ways = (centre + size * waves for size in SIZES for centre in centres)
    return next(way for way in ways if machine.is_possible(way[::40]).all() and machine.is_possible(way[::4]).all())


@pytest.mark.slow
def test_across_half_turns(machines: tuple[LoopMachine, ...]) -> None:
    """No jump anywhere, whichever axis crosses; the way is regular, so automatic bytes keep to it as well."""
    for axis, machine in enumerate(machines[2:]):
        axes = swing(machine, axis)
        for branches in (None, (0,) * machine.robot.BRANCHES):
            way = axes[:: 1 if branches is None else 3]
            found, answered = follow(machine.robot, machine, way, branches)
            assert answered.all()
            assert np.abs(found - way).max() < TOLERANCE
        if machine.closure.angles[axis]:
            assert axes[:, axis].min() < 180.0 < axes[:, axis].max()
            periods = machine.robot.forward_batch(axes)[2][:, machine.robot.BRANCHES + axis]
            assert set(periods) == {1, 2}
