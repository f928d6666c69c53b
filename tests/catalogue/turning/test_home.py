"""The home pose: where forward kinematics starts, and what it tells of the assembly mode."""

from collections.abc import Iterable

import numpy as np
import pytest
from softkin import Frame, Status

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import Array
from tests.catalogue.refusals import refusal
from tests.catalogue.turning_machines import TurningMachine, turning_machine

COUNT = 1500
POSES = 2
"""At which all solutions are sought by brute force."""
TILT = np.array([[1.0, 0.0, 0.0], [0.0, 0.6, -0.8], [0.0, 0.8, 0.6]])


def home_slot(machine: TurningMachine) -> tuple[int, ...]:
    """The configuration at home, with open periods."""
    told = [machine.robot.parameters.get(f"home_{b.name}_{b.names[1]}") for b in machine.mechanism.branches]
    return (*(2 if flag else 1 for flag in told), *[0] * len(machine.robot.PERIOD_AXES))


def normalised(machine: TurningMachine, axes: Array, positions: Array, rotations: Array) -> Array:
    """det A of unit vectors and moments per root mean square distance of the joints on the platform: the margin. A turn
    that no leg feels is a row of its own.
    """
    rods, guides, joints = machine.mechanism.rods, machine.mechanism.guides, machine.closure.joints(axes)

    def points(ends: Iterable[tuple[object, ...]]) -> Array:
        found = [machine.closure.at(list(end), joints, positions, rotations) for end in ends]  # type: ignore[arg-type]
        padded = [np.hstack([one, np.zeros((len(axes), 3 - one.shape[1]))]) for one in found]
        return np.reshape(padded, (len(found), len(axes), 3)).swapaxes(0, 1)

    plates, ends = points(r.plate for r in rods), points(r.end for r in rods)
    along = np.hstack([ends - points(r.base for r in rods), points(g.normal for g in guides)])
    along /= np.linalg.norm(along, axis=2)[:, :, None]
    arms = np.hstack([ends, points(g.plate for g in guides)]) - positions[:, None]
    radius = np.sqrt(((plates - plates.mean(axis=1, keepdims=True)) ** 2).sum(axis=2).mean(axis=1))
    moments = np.cross(arms, along)[:, :, machine.closure.axes_of_turn] / radius[:, None, None]
    rows = np.concatenate([along[:, :, machine.closure.task], moments], axis=2)
    tool = rotations[:, None, :, 2]
    free = [np.concatenate([0.0 * tool, tool], axis=2)] if machine.closure.is_free else []
    return np.linalg.det(np.hstack([rows, *free]))


def test_every_pose_around_home_is_found_in_the_configuration_of_home(machines: tuple[TurningMachine, ...]) -> None:
    """Within a fifth of the reach and 20 degrees: what the description's notes say."""
    for machine in machines:
        positions, rotations = machine.closure.around_home(COUNT, np.random.default_rng(41))
        axes, statuses = machine.robot.inverse_batch(positions, rotations, home_slot(machine))
        good = statuses == Status.OK
        assert good.mean() > 0.3 and set(statuses[~good]) <= {Status.UNREACHABLE}
        back, turned, written, found = machine.robot.forward_batch(axes[good])
        assert (found == Status.OK).all()
        assert np.abs(back - positions[good]).max() < 1e-9 * machine.reach
        assert np.abs(turned - rotations[good]).max() < 1e-9
        assert (written[:, : machine.robot.BRANCHES] == home_slot(machine)[: machine.robot.BRANCHES]).all()


@pytest.mark.slow("Hexaglide")
def test_the_inverse_accepts_what_is_in_the_mode_of_home(machines: tuple[TurningMachine, ...]) -> None:
    """In every slot: the sign of det A, and its least size; what is refused is in the other mode or out of reach."""
    for machine in machines:
        free = machine.changed(min_type2_margin=0.0, check_forward=False)
        near = machine.changed(check_forward=False)
        positions, rotations = machine.closure.around_home(60, np.random.default_rng(43), size=2.0)
        axes, statuses = free.inverse_all_batch(positions, rotations)[:2]
        _, strict = near.inverse_all_batch(positions, rotations)[:2]
        for slot in range(axes.shape[1]):
            good = statuses[:, slot] == Status.OK
            if good.any():
                margin = machine.closure._mode * normalised(machine, axes[good, slot], positions[good], rotations[good])
                assert (margin >= -1e-12).all()
                assert ((strict[good, slot] == Status.OK) == (margin >= 1e-3)).all()
        count = [
            sum(machine.is_own(joints[None], p, r)[0] for joints in _solved(machine, p, r))
            for p, r in zip(positions[:POSES], rotations[:POSES], strict=True)
        ]
        assert [(statuses[k] == Status.OK).sum() for k in range(POSES)] == count


def _solved(machine: TurningMachine, position: Array, rotation: Array) -> list[Array]:
    """All joint values at a pose, by Newton's method from many starts."""
    starts = 600 if machine.robot.BRANCHES else 60
    where = np.tile(position, (starts, 1)), np.tile(rotation, (starts, 1, 1))
    joints, closed = machine.closure.joints_at(*where, np.random.default_rng(47))
    found: list[Array] = []
    for row in joints[closed]:
        apart = [np.where(machine.closure.angles, np.abs(np.exp(1j * row) - np.exp(1j * o)), np.abs(row - o) / 100.0)
                 for o in found]  # fmt: skip
        if all(a.max() > 1e-6 for a in apart):
            found.append(row)
    return found


def test_the_margin_is_the_determinant_by_definition(machines: tuple[TurningMachine, ...]) -> None:
    for machine in machines:
        axes = machine.draw(40, np.random.default_rng(5))
        expected = normalised(machine, axes, *machine.closure.poses(axes))
        found = [machine.robot.singularity(row).margins["rods_dependent"] for row in axes]
        np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_a_home_pose_out_of_reach_or_singular_is_refused(machines: tuple[TurningMachine, ...]) -> None:
    machine = machines[0]
    points = [n for n in machine.given if n.startswith(("platform_", "ring_"))]
    far = {"home_y" if "home_y" in machine.given else "rod_length_1": 1e5}
    for given in (far, dict.fromkeys(points, 0.0), dict.fromkeys(points, 7.0)):
        assert refusal(machine.changed, **given) is Status.NOT_INITIALIZED


def test_a_start_leads_to_the_pose_beside_it(machines: tuple[TurningMachine, ...]) -> None:
    """In every configuration that the inverse accepts; a start that is tilted counts by its heading."""
    for machine in machines:
        positions, rotations = machine.closure.around_home(12, np.random.default_rng(53))
        axes, statuses = machine.robot.inverse_all_batch(positions, rotations)[:2]
        shift = 1e-3 * machine.reach * np.isin([0, 1, 2], machine.closure.task)
        tilt = TILT if len(machine.closure.axes_of_turn) == 1 else np.eye(3)
        for row, slot in np.argwhere(statuses == Status.OK):
            beside = (positions[row] + shift, tilt @ rotations[row])
            frame, configuration = machine.robot.forward(axes[row, slot], start=beside)
            assert np.abs(np.subtract(frame.position, positions[row])).max() < 1e-8 * machine.reach
            expected = [1 + (slot >> k & 1) for k in range(machine.robot.BRANCHES)]
            assert [*configuration[: machine.robot.BRANCHES]] == expected


def test_a_start_upside_down_has_no_heading(mechanism: Mechanism, machines: tuple[TurningMachine, ...]) -> None:
    """Of a platform that turns about z, a start that is upside down is refused."""
    if len(machines[0].closure.axes_of_turn) == 1:
        axes = tuple(machines[0].draw(1, np.random.default_rng(1))[0])
        start = (0.0, 0.0, 0.0), np.diag((1.0, -1.0, -1.0))
        assert refusal(machines[0].robot.forward, axes, start=start) is Status.BAD_INPUT


def test_legs_numbered_the_other_way_round(machines: tuple[TurningMachine, ...]) -> None:
    """The same machine: the same answers in another order, whatever the sign of its determinant."""
    for machine in machines:
        legs = len(machine.mechanism.rods)
        other = {_renumbered(name, legs): value for name, value in machine.given.items()}
        robot = type(machine.robot)(**other)
        axes = machine.draw(20, np.random.default_rng(59))
        frames = machine.robot.forward_batch(axes)
        again = robot.forward_batch(axes[:, ::-1])
        assert (frames[3] == again[3]).all()
        assert np.abs(frames[0] - again[0]).max() < 1e-9 * machine.reach
        first, statuses = machine.robot.inverse_all_batch(*frames[:2], axes)[:2]
        second, others = robot.inverse_all_batch(*again[:2], axes[:, ::-1])[:2]
        order = [int(format(k, f"0{machine.robot.BRANCHES}b")[::-1], 2) for k in range(first.shape[1])]
        assert (statuses == others[:, order]).all()
        good = statuses == Status.OK
        assert np.abs(first[good] - second[:, order][good][:, ::-1]).max() < 1e-6


def _renumbered(name: str, legs: int) -> str:
    parts = name.split("_")
    return "_".join(str(legs + 1 - int(p)) if p.isdigit() else _axis(p, legs) for p in parts)


def _axis(part: str, legs: int) -> str:
    return f"{part[0]}{legs + 1 - int(part[1:])}" if part[1:].isdigit() else part


def test_a_machine_that_stands_far_away(machines: tuple[TurningMachine, ...]) -> None:
    """Its base and its home shifted by a hundred times its size: the same axes for shifted poses."""
    machine = machines[1]
    shift = 100.0 * round(machine.reach)
    ours = {n for n in machine.given if n.startswith(("base_", "rail_", "home_")) and n.endswith("_y")}
    moved = {n: v + shift if "home_y" in ours and n in ours else v for n, v in machine.given.items()}
    there = turning_machine(machine.mechanism, "far", moved).robot
    there = there if "home_y" in moved else there.with_base(Frame((0.0, shift, 0.0)))
    positions, rotations = machine.closure.around_home(50, np.random.default_rng(61))
    axes, statuses = machine.robot.inverse_batch(positions, rotations, home_slot(machine))
    found, others = there.inverse_batch(positions + [0.0, shift, 0.0], rotations, home_slot(machine))
    assert (statuses == others).all() and (statuses == Status.OK).any()
    good = statuses == Status.OK
    assert np.abs(found - axes)[good].max() < 1e-7
    back = there.forward_batch(found[good])[0]
    assert np.abs(back - positions[good] - [0.0, shift, 0.0]).max() < 1e-8 * machine.reach
