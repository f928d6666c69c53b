"""What the reference decides, and what it does not: open branches and open periods."""

from itertools import combinations

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Role
from tests.catalogue.closure import Array
from tests.catalogue.machines import LENGTHS, Machine, few
from tests.catalogue.references import held_at
from tests.catalogue.test_round_trip import FRAME, slots

SQUARE_DEGREES = 1e-6
"""Below this two squared distances of rotary axes are equal."""
SHARE = 1e-6
"""Of the machine's scale: below the square of this length two squared distances of linear axes are equal."""


def tie_of(machine: Machine) -> float:
    """What squared distances tie within."""
    if machine.closure.angles.any():
        return SQUARE_DEGREES
    lengths = [p for p in machine.mechanism.parameters if p.role in LENGTHS or p.role is Role.DISTANCE and p.low >= 0.0]
    return (SHARE * sum(abs(machine.robot.parameters[p.name]) for p in lengths)) ** 2


def squared(machine: Machine, axes: Array, references: Array) -> Array:
    """The squared distance over the rotary axes in degrees, over the linear ones where there is none."""
    angles = machine.closure.angles
    counted = angles if angles.any() else ~angles
    return np.sum((axes - references)[:, counted] ** 2, axis=1)


def by_slot(machine: Machine, frames: tuple[Array, Array], references: Array) -> list[Array]:
    """The axes of every slot with all periods open; not a number where a slot does not answer."""
    robot = machine.changed(check_limits=False)
    found = []
    for slot in slots(machine):
        axes, statuses = robot.inverse_batch(*frames, slot + (0,) * len(robot.PERIOD_AXES), references)
        assert np.isnan(axes[~machine.answers(statuses)]).all()
        found.append(axes)
    return found


def distances_of(machine: Machine, answers: list[Array], references: Array) -> Array:
    """Of every slot from the reference; a slot that does not answer is infinitely far."""
    return np.nan_to_num(np.stack([squared(machine, a, references) for a in answers]), nan=np.inf)


@pytest.mark.slow("Hexaglide", "Planar", "ThreeParallel")
def test_an_open_branch_is_the_nearest(machines: tuple[Machine, ...]) -> None:
    for machine in few(machines):
        robot = machine.changed(check_limits=False)
        axes = machine.draw(300, np.random.default_rng(1))
        frames = machine.closure.poses(axes)
        references = held_at(robot, axes, np.random.default_rng(2).uniform(-400, 400, axes.shape))
        answers = by_slot(machine, frames, references)
        distances = distances_of(machine, answers, references)
        nearest = np.choose(distances.argmin(axis=0)[:, None], answers)
        for byte in (0, 3):
            configuration = (byte,) * robot.BRANCHES + (0,) * len(robot.PERIOD_AXES)
            found, statuses = robot.inverse_batch(*frames, configuration, references)
            assert (statuses == Status.OK).all()
            assert np.abs(found - nearest).max() < 1e-11  # but for rounding: what branches share is computed once
            for row in range(0, 300, 30):
                frame = frames[0][row], frames[1][row]
                single = robot.inverse(frame, configuration, references[row])
                assert np.abs(np.subtract(single, found[row])).max() < 1e-10
        nearest_slots = set(distances.argmin(axis=0))
        if machine.mechanism.rods or machine.mechanism.drives:  # some working modes are rare on the side of a loop
            assert len(nearest_slots) >= len(answers) / 2
        else:
            assert nearest_slots == set(range(len(answers)))


@pytest.mark.slow("Planar", "ThreeParallel")
@pytest.mark.long("Pos_RRR")
def test_a_tie_goes_to_the_lowest_slot(machines: tuple[Machine, ...]) -> None:
    """Half-way between two slots, and less than the tie's width off it, slot 0 answers; beyond it the nearer one."""
    for machine in few(machines):
        tie, count = tie_of(machine), 60
        axes = machine.draw(count, np.random.default_rng(3))
        frames = machine.closure.poses(axes)
        answers = np.array(by_slot(machine, frames, axes))
        if np.isfinite(answers).all(axis=2).sum(axis=0).max() == 1:
            continue  # one slot alone answers, whatever is asked: there is no tie
        pairs = list(combinations(range(len(answers)), 2))
        (low, high), owners = np.repeat(pairs, count, axis=0).T, np.arange(count * len(pairs)) % count
        # slots that differ in cylinders alone are equally far from any reference
        differ = ~(squared(machine, answers[low, owners], answers[high, owners]) < 1e-9)
        low, high, owners = low[differ], high[differ], owners[differ]
        first, second = answers[low, owners], answers[high, owners]
        middle = (first + second) / 2
        width = np.sqrt(squared(machine, first, second))
        towards = (second - first) / width[:, None]
        at_middle = np.array(by_slot(machine, (frames[0][owners], frames[1][owners]), np.nan_to_num(middle)))
        each = np.arange(len(owners))
        same = np.abs(at_middle[low, each] - first).max(axis=1) < 1e-9
        same &= np.abs(at_middle[high, each] - second).max(axis=1) < 1e-9
        away = distances_of(machine, list(at_middle), middle)
        nearest = away[low, each]
        same &= (away >= nearest - tie / 10).all(axis=0) & ((away < nearest + 10 * tie).sum(axis=0) == 2)
        # shifted by s towards the second slot, the squared distances differ by 2 * s * width
        asked = []
        for excess, chosen in ((0.0, first), (0.5 * tie, first), (3 * tie, second), (-3 * tie, first)):
            references = middle + towards * (excess / (2 * width))[:, None]
            asked.append((owners[same], references[same], chosen[same]))
        _check_chosen(machine, frames, asked)
        assert len(set(owners[same])) > (20 if machine.branches_meet_together or not machine.mechanism.drives else 0)


def _check_chosen(machine: Machine, frames: tuple[Array, ...], asked: list[tuple[Array, Array, Array]]) -> None:
    """An open configuration answers for frames by their rows as expected: as one batch, some by single calls."""
    robot = machine.changed(check_limits=False)
    opened = (0,) * len(robot.CONFIGURATION)
    rows, references, expected = (np.concatenate(part) for part in zip(*asked, strict=True))
    found, statuses = robot.inverse_batch(frames[0][rows], frames[1][rows], opened, references)
    assert (statuses == Status.OK).all()
    assert np.abs(found - expected).max(initial=0.0) < 1e-9
    first = 0
    for owners, *_ in asked:
        for row in range(first, first + len(owners), 20):
            scalar = robot.inverse((frames[0][rows[row]], frames[1][rows[row]]), opened, references[row])
            assert np.abs(np.subtract(scalar, found[row])).max() < 1e-9
        first += len(owners)


def test_an_open_period_is_the_nearest_to_the_reference(machines: tuple[Machine, ...]) -> None:
    """Within half a turn: of the joint, where a coupling moves the axis with its neighbours."""
    for machine in few(machines):
        axes = machine.draw(300, np.random.default_rng(4))
        references = held_at(machine.robot, axes, np.random.default_rng(5).uniform(-3000, 3000, axes.shape))
        turning = [i for i, j in enumerate(machine.mechanism.joints) if j.multi_turn]
        frames = machine.closure.poses(axes)
        for found in by_slot(machine, frames, references):
            solved = ~np.isnan(found).any(axis=1)
            assert machine.miss(found[solved], *(f[solved] for f in frames)).max(initial=0.0) < FRAME
            apart = np.degrees(machine.closure.joints(found) - machine.closure.joints(references))[solved][:, turning]
            assert np.abs(apart).max(initial=0.0) <= 180.0 + 1e-8


def test_where_nothing_is_open_the_reference_has_no_influence(machines: tuple[Machine, ...]) -> None:
    """Not in the last bit."""
    rng = np.random.default_rng(6)
    for machine in few(machines):
        axes = machine.draw(100, rng)
        frames = machine.closure.poses(axes)
        configurations = machine.robot.forward_batch(axes)[2]
        answers = []
        for size in (0.0, 1.0, 1e3, 1e8):
            references = held_at(machine.robot, axes, rng.uniform(-size, size, axes.shape))
            answers.append(machine.robot.inverse_batch(*frames, configurations, references)[0])
            frame = frames[0][0], frames[1][0]
            scalar = machine.robot.inverse(frame, configurations[0].tolist(), references[0])
            assert scalar == machine.robot.inverse(frame, configurations[0].tolist(), held_at(machine.robot, axes[0]))
        assert all((a == answers[0]).all() for a in answers)


def test_without_a_configuration_branch_1_and_the_nearest_turn(machines: tuple[Machine, ...]) -> None:
    for machine in few(machines):
        robot = machine.changed(check_limits=False)
        branches, periods = robot.DEFAULT_CONFIGURATION[: robot.BRANCHES], robot.DEFAULT_CONFIGURATION[robot.BRANCHES :]
        assert set(branches) <= {1} and set(periods) <= {0}
        assert len(periods) == len(robot.PERIOD_AXES)
        axes = machine.draw(30, np.random.default_rng(7))
        frames = machine.closure.poses(axes)
        first = by_slot(machine, frames, held_at(robot, axes, np.zeros_like(axes)))[0]
        found = robot.inverse_batch(*frames, references=held_at(robot, axes))[0]
        assert np.array_equal(found, first, equal_nan=True)
        for row in np.flatnonzero(~np.isnan(first).any(axis=1))[:5]:
            scalar = robot.inverse((frames[0][row], frames[1][row]), reference=held_at(robot, axes[row]))
            assert np.abs(np.subtract(scalar, first[row])).max() < 1e-10
