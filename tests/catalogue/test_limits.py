"""Limits of axes, also helical ones, and of other quantities: tested last, with a tolerance; they never choose."""

from collections.abc import Iterator

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Kind, Mechanism
from tests.catalogue.closure import Array
from tests.catalogue.loci import loci
from tests.catalogue.machines import Machine, few
from tests.catalogue.machines import machine as machine_of
from tests.catalogue.references import held_at
from tests.catalogue.refusals import refusal

RELATIVE = 1e-9
INSIDE, OUTSIDE = 0.5, 3.0
"""Of the tolerance: beyond by the one is inside, by the other refused. Linear axes lie at up to a few hundred units."""


FIRST_TURN = 99.0
"""Degrees: axes that turn are on their first turn, and their limits too."""


def poses(machine: Machine, seed: int) -> Array:
    """Axis values that the vendor's limit ranges allow, on the first turn."""
    axes = machine.draw(500, np.random.default_rng(seed), farthest=FIRST_TURN)
    fits = np.ones(len(axes), dtype=bool)
    for i, joint in enumerate(machine.mechanism.joints):
        low, high = joint.limit_range or (-1e6, 1e6)
        fits &= (axes[:, i] > low + 60.0) & (axes[:, i] < high - 60.0)
    return axes[fits]


def one_pose(machine: Machine, seed: int) -> Array:
    """Axis values of a random pose."""
    return poses(machine, seed)[0]


def fitting(machines: tuple[Machine, ...]) -> tuple[Machine, ...]:
    """Machines whose poses fit the vendor's ranges: without random offsets."""
    return tuple(m for m in machines if not m.label.startswith("random"))


def outcome(robot: softkin.Mechanism, machine: Machine, axes: Array, reference: Array | None = None) -> Status:
    """The status of the way back, by a scalar call, the slots and a batch."""
    positions, rotations = machine.closure.poses(axes[None])
    configuration = robot.forward(axes)[1]
    near = axes if reference is None else reference
    found, statuses = robot.inverse_batch(positions, rotations, configuration, near)
    try:
        scalar = robot.inverse((positions[0], rotations[0]), configuration, near)
    except KinematicsError as error:
        assert error.status == statuses[0]
        assert np.isnan(found).all()
        assert "limit" in str(error)
    else:
        assert statuses[0] == Status.OK
        assert np.abs(np.subtract(scalar, found[0])).max() < 1e-10
        assert np.abs(np.subtract(scalar, axes)).max() < 1e-9
    slots = robot.inverse_all((positions[0], rotations[0]), near)
    (own,) = (s for s in slots if s.configuration[: robot.BRANCHES] == configuration[: robot.BRANCHES])
    assert own.status == statuses[0]
    assert (own.axes is None) == (own.status is not Status.OK)
    return Status(int(statuses[0]))


def check_both_ends(machine: Machine, axes: Array, key: str, value: float) -> None:
    """Limits that end at a value: at it, inside the tolerance, beyond it, far beyond it, and not tested at all."""
    far = 50.0
    for lower, upper, end in ((value - far, value, f"upper_{key}"), (value, value + far, f"lower_{key}")):
        tolerance = RELATIVE * (1.0 + abs(lower) + abs(upper))
        inward = -1.0 if end.startswith("upper") else 1.0
        for shift in (0.0, INSIDE * tolerance, OUTSIDE * tolerance, far / 2):
            limits = {f"lower_{key}": lower, f"upper_{key}": upper, end: value + inward * shift}
            expected = Status.OK if shift < tolerance else Status.UNREACHABLE
            assert outcome(machine.changed(**limits), machine, axes) is expected, (end, shift)
            assert outcome(machine.changed(**limits, check_limits=False), machine, axes) is Status.OK


@pytest.mark.slow("Hexaglide")
@pytest.mark.long
def test_every_axis_has_limits(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    for machine in fitting(machines)[::2]:
        axes = one_pose(machine, 1)
        for i, joint in enumerate(mechanism.joints):
            check_both_ends(machine, axes, joint.key, float(axes[i]))


def test_quantities_that_no_axis_sees_have_limits(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """The relative elbow of an arm driven from its base, the joints of a coupled arm, the carriage of a belt gantry."""
    for machine in few(machines):
        axes = one_pose(machine, 2)
        values = machine.closure.limited(machine.closure.joints(axes[None]))[0]
        for quantity, value in zip(mechanism.limited, values, strict=True):
            check_both_ends(machine, axes, quantity.name, float(value))
    expected = dict.fromkeys(["Kin_PCC", "Softkin_Palletizer", "Softkin_Palletizer5"], {"elbow"})
    expected |= dict.fromkeys(["Kin_P2Y", "Kin_HGantry2", "Kin_HGantry3", "Kin_TGantry2", "Kin_TGantry3"], {"x", "y"})
    expected["Kin_SCCC"] = {"joint_2", "joint_3"}
    offered = {p.name.removeprefix("lower_") for p in machines[0].robot.PARAMETERS if p.name.startswith("lower_")}
    assert offered - {j.key for j in mechanism.joints} == expected.get(mechanism.name, set())


def test_forward_does_not_test_limits(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    for machine in fitting(machines):
        axes = machine.draw(20, np.random.default_rng(3))
        limits = {f"{word}_{j.key}": v for j in mechanism.joints for word, v in (("lower", 1.0), ("upper", 2.0))}
        found = machine.changed(**limits).forward_batch(axes)
        for narrow, wide in zip(found, machine.robot.forward_batch(axes), strict=True):
            assert (narrow == wide).all()


def test_both_zero_is_no_limit(machines: tuple[Machine, ...]) -> None:
    """One zero alone is a limit."""
    for machine in fitting(machines)[::2]:
        axes = one_pose(machine, 4)
        for i, joint in enumerate(machine.mechanism.joints):
            key = joint.key
            assert outcome(machine.changed(**{f"lower_{key}": 0.0, f"upper_{key}": 0.0}), machine, axes) is Status.OK
            one_sided = machine.changed(**{f"lower_{key}": 0.0, f"upper_{key}": 300.0})
            expected = Status.OK if 0 <= axes[i] <= 300 else Status.UNREACHABLE
            other_turn = joint.multi_turn and axes[i] < -60.0  # its one value inside is a turn further
            if not other_turn:
                assert outcome(one_sided, machine, axes) is expected


@pytest.mark.serial
def test_an_open_branch_is_chosen_before_limits(machines: tuple[Machine, ...]) -> None:
    """The nearest branch is outside, the other inside: refused, by name it would have been found."""
    for machine in fitting(machines):
        if machine.robot.BRANCHES == 0:
            continue
        bent = loci(machine)[0].joint
        key = machine.mechanism.joints[bent].key
        axes, other = next(_bent_a_little(machine, bent))
        middle = (axes[bent] + other[bent]) / 2
        low, high = (middle - 200, middle) if axes[bent] > middle else (middle, middle + 200)
        robot = machine.changed(**{f"lower_{key}": low, f"upper_{key}": high})
        positions, rotations = machine.closure.poses(axes[None])
        frame = positions[0], rotations[0]
        periods = (0,) * len(robot.PERIOD_AXES)
        for automatic in ((0,) * robot.BRANCHES + periods, (3,) * robot.BRANCHES + periods):
            assert refusal(robot.inverse, frame, automatic, axes) is Status.UNREACHABLE
            assert robot.inverse_batch(positions, rotations, automatic, axes)[1][0] == Status.UNREACHABLE
        named = [s.axes for s in robot.inverse_all(frame, axes) if s.status is Status.OK]
        assert other.tolist() in [pytest.approx(a) for a in named]
        assert len(named) < 2**robot.BRANCHES
        assert axes.tolist() not in [pytest.approx(a) for a in named]


def _bent_a_little(machine: Machine, bent: int) -> Iterator[tuple[Array, Array]]:
    """Poses whose joint is little different on two branches: no turn of it falls into the limits by chance."""
    robot = machine.changed(check_limits=False)
    for axes in poses(machine, 7):
        position, rotation = (part[0] for part in machine.closure.poses(axes[None]))
        found = [np.array(s.axes) for s in robot.inverse_all((position, rotation), axes) if s.axes is not None]
        for other in found:
            if 5.0 < abs(axes[bent] - other[bent]) / 2 < 50.0 and abs(axes[bent] + other[bent]) / 2 < 100.0:
                yield axes, other


def climbing(machine: Machine) -> float:
    """How far the carried axis travels per turn: zero where there is no such axis, or no pitch."""
    parameters = machine.robot.parameters
    return parameters.get("pitch_zc", 0.0) or parameters.get("gear_coupling", 0.0)


@pytest.mark.serial
@pytest.mark.long
def test_an_axis_that_carries_another_is_always_limited(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """To two turns either way where no limit is given; without a pitch it turns without end, as any other axis."""
    helical = [i for i, j in enumerate(mechanism.joints) if j.kind is Kind.HELICAL]
    assert bool(helical) == mechanism.name.endswith(("ZCcoupled", "ZCcoupled_Type1"))
    chosen = list(few(machines))
    if "gear_coupling" in machines[0].robot.parameters:
        chosen.append(machine_of(mechanism, "geared", {**machines[0].given, "gear_coupling": -0.05}))
    limited = set()
    for machine in chosen:
        axes = machine.draw(1, np.random.default_rng(8))[0]
        for i, joint in enumerate(mechanism.joints):
            if not joint.multi_turn:
                continue
            ends = i in helical and climbing(machine) != 0.0
            limited.add(ends)
            for value in (719.99, 720.0, -720.0, 720.0 + 1e-5, 720.01, -720.01, 5000.0, -5000.0):
                axes[i] = value
                expected = Status.UNREACHABLE if ends and abs(value) > 720.0 else Status.OK
                positions, rotations = machine.closure.poses(axes[None])
                configuration, near = machine.robot.forward(axes)[1], held_at(machine.robot, axes)
                assert machine.robot.inverse_batch(positions, rotations, configuration, near)[1][0] == expected
                unchecked = machine.changed(check_limits=False)
                assert unchecked.inverse_batch(positions, rotations, configuration, near)[1][0] == Status.OK
            axes[i] = 20.0
    assert (True in limited) == bool(helical)


@pytest.mark.serial
def test_limits_of_its_own_replace_the_two_turns(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    for machine in fitting(machines):
        for i, joint in enumerate(mechanism.joints):
            if joint.kind is not Kind.HELICAL:
                continue
            robot = machine.changed(**{f"lower_{joint.key}": -90.0, f"upper_{joint.key}": 400.0})
            axes = one_pose(machine, 9)
            for value in (399.0, -89.0, 401.0, -91.0):
                axes[i] = value
                assert outcome(robot, machine, axes) is (Status.OK if -90 < value < 400 else Status.UNREACHABLE)
