"""At and near poses where branches meet or angles are free, block and Python give the same answers."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np
import pytest

from derive.description.mechanism import Mechanism, Role
from tests.catalogue.cornered import KR6_D3, PAIRED, places, poses
from tests.catalogue.machines import bare_machine, machine
from tests.catalogue.references import held_at
from tests.catalogue.test_offset import beside_the_first_axis, on_the_axis, turns_the_flange
from tests.mechanisms import named
from tests.text.comparisons import COMPARISONS
from tests.text.comparisons.offsets import point_at
from tests.text.comparisons.poses import assert_same_pose
from tests.text.controller import OK, UNREACHABLE, asked, assert_same
from tests.text.pairs import Pair, pair_of
from tests.text.samples import NO_TURN, Sample, coinciding, near

OF_TWO_LINKS = ("Kin_Pos_RRR", "Softkin_Palletizer")
"""Arms whose required lengths are two links."""
MACHINES = ("equal", "random 1")
"""With equal links every singular pose exists; with random offsets none of them is at a round number."""
METHODS = ("AxesToCartesian", "CartesianToAxes", "AxesToOrientation", "IsSingularity", "Jacobian")
COINCIDING_METHODS = ("AxesToCartesian", "CartesianToAxes")
OFFSET_METHODS = ("AxesToConfiguration_Offset", "CartesianToAxes_Offset")
FEW = 12
NEARLY = 1e-3
EVERY = 5
"""The share of the grid at which the slower comparisons are made."""


@pytest.mark.slow
@pytest.mark.parametrize("label", MACHINES)
def test_quarter_turns(serial_pairs: tuple[Pair, ...], label: str) -> None:
    (one,) = (t for t in serial_pairs if t.machine.label == label)
    assert len(one.grid) >= 9
    for sample in one.grid if label == "equal" else one.grid[::3]:
        for method in offered(one, METHODS):
            COMPARISONS[method](one, sample)


@pytest.mark.slow("ThreeParallel")
@pytest.mark.long("Scara4")
@pytest.mark.parametrize("label", MACHINES)
def test_near_quarter_turns(serial_pairs: tuple[Pair, ...], label: str) -> None:
    (one,) = (t for t in serial_pairs if t.machine.label == label)
    for sample in near(one.grid[::EVERY]):
        for method in offered(one, METHODS):
            COMPARISONS[method](one, sample)


@pytest.mark.long("Scara4")
@pytest.mark.parametrize("label", MACHINES)
def test_a_point_off_the_flange_at_quarter_turns(serial_pairs: tuple[Pair, ...], label: str) -> None:
    (one,) = (t for t in serial_pairs if t.machine.label == label)
    for sample in (*one.grid[::EVERY], *near(one.grid[::EVERY])):
        for method in offered(one, OFFSET_METHODS):
            COMPARISONS[method](one, sample)


@pytest.mark.slow("ThreeParallel")
@pytest.mark.long("Pos_RRR")
def test_singularities_that_coincide(serial_pairs: tuple[Pair, ...]) -> None:
    """Wrist on axis 1, elbow stretched or folded, wrist straight: several at once, exactly and nearly."""
    if not serial_pairs[1].machine.is_spatial or not serial_pairs[1].robot.BRANCHES:
        return
    for one in (serial_pairs[1], pair_of(bare_machine(serial_pairs[1].mechanism))):
        for sample in coinciding(one.machine):
            for method in COINCIDING_METHODS:
                COMPARISONS[method](one, sample)


def offered(one: Pair, methods: tuple[str, ...]) -> list[str]:
    """Those that the block has."""
    return [method for method in methods if method.lower() in one.controller.methods]


@pytest.mark.long
def test_a_point_on_the_axis_of_a_link_cannot_be_aimed(serial_pairs: tuple[Pair, ...]) -> None:
    """The effective link of the offset interface is then too short to have a direction."""
    for one in serial_pairs:
        if "cartesiantoaxes_offset" not in one.controller.methods:
            continue
        for sample in one.regular[:5]:
            for offset in fixed_points(one, sample):
                COMPARISONS["CartesianToAxes_Offset"](one, replace(sample, offset=offset))


@pytest.mark.slow("Palletizer", "Pos_RRR")
def test_a_point_beside_the_first_axis_of_a_stretched_arm(serial_pairs: tuple[Pair, ...]) -> None:
    """Branches meet at two edges of the workspace at once."""
    for one in serial_pairs:
        if "cartesiantoaxes_offset" not in one.controller.methods:
            continue
        sample = one.regular[0]
        for axes, offsets in beside_the_first_axis(one.machine):
            for values, offset in zip(axes.tolist(), offsets.tolist(), strict=True):
                COMPARISONS["CartesianToAxes_Offset"](one, replace(sample, axes=tuple(values), offset=tuple(offset)))


def test_a_point_far_off_the_flange_is_out_of_reach(serial_pairs: tuple[Pair, ...]) -> None:
    """In one direction or another: then the place is nearer to an axis than the arm passes it."""
    for one in serial_pairs:
        if "cartesiantoaxes_offset" not in one.controller.methods:
            continue
        sample, refused = one.regular[0], 0
        place, default = point_at(one, sample, (0.0, 0.0, 0.0)), one.robot.DEFAULT_CONFIGURATION
        every = (0,) * len(default)
        for index, size, asking in product(range(3), (-2.0, 2.0), (default, every)):
            offset = tuple(size * one.machine.reach if k == index else 0.0 for k in range(3))
            status, answer = asked(one.robot.inverse_offset, place, offset, asking, sample.axes)
            expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
            found = one.controller.inverse_offset(place, offset, asking, sample.axes)
            assert_same(found, (status, expected), one, offset)
            refused += status == UNREACHABLE
        assert refused > 0 or not one.machine.has_a_reach


@pytest.mark.parametrize("name", OF_TWO_LINKS)
def test_a_point_inside_the_shortest_reach(name: str) -> None:
    """Above the shoulder of an arm with two links that are nearly equal: two angles of the start are nearly free, and
    the steps on the closure meet nothing from any.
    """
    mechanism = named(name)
    links = [p.name for p in mechanism.parameters if p.role is Role.LENGTH]
    one = pair_of(machine(mechanism, "two links", {n: 250.0 + k for k, n in enumerate(links)}))
    arms = product((0.0,), (0.0, 180.0), (0.0, 180.0))
    flanges = [one.robot.forward((*arm, *one.machine.closure.offsets[3:]))[0].position for arm in arms]
    x, y, z = np.mean(flanges, axis=0).tolist()
    for above in (0.3, -0.3):
        place, asking = (x, y, z + above), (0,) * len(one.robot.DEFAULT_CONFIGURATION)
        reference = one.regular[0].axes
        assert asked(one.robot.inverse_offset, place, (0.0, 0.0, 0.0), asking, reference)[0] == UNREACHABLE
        assert_same(
            one.controller.inverse_offset(place, (0.0, 0.0, 0.0), asking, reference), (UNREACHABLE, None), one, place
        )


def fixed_points(one: Pair, sample: Sample) -> Iterator[tuple[float, ...]]:
    """For every rotary axis that turns the flange, the point of the flange about which it does."""
    jacobian, rotation = one.robot.jacobian(sample.axes), one.robot.orientation(sample.axes)
    for index, joint in enumerate(one.mechanism.joints):
        if joint.is_angle and not one.machine.is_spatial:
            arm = (-jacobian[1][index], jacobian[0][index], 0.0)
            yield tuple(sum(row[i] * v for row, v in zip(rotation, arm, strict=True)) for i in range(3))
        elif joint.is_angle and one.mechanism.chain is not None:
            values = np.array([sample.axes])
            if turns_the_flange(one.machine, values, index):
                yield tuple(on_the_axis(one.machine, values, index)[0].tolist())


def test_a_tie_goes_to_the_first_branch(serial_pairs: tuple[Pair, ...]) -> None:
    """A point straight ahead, and a reference that is as far from one solution as from its mirror image."""
    one = serial_pairs[0]
    if not one.robot.BRANCHES or one.machine.is_spatial:
        return
    count, size = len(one.mechanism.joints), len(one.robot.CONFIGURATION)
    point, nothing = (0.8 * one.machine.reach, 0.0, 0.0), (0.0,) * count
    first, opened = (1,) + (0,) * (size - 1), (0,) * size
    solvers = [partial(one.controller.inverse, point, NO_TURN)]
    if "cartesiantoaxes_offset" in one.controller.methods:
        solvers.append(partial(one.controller.inverse_offset, point, (0.0, 0.0, 0.0)))
    for solve in solvers:
        assert solve(first, nothing)[0] == OK
        assert solve(first, nothing) == solve(opened, nothing) != solve((2, *first[1:]), nothing)


def test_where_branches_coincide_the_first_answers(serial_pairs: tuple[Pair, ...]) -> None:
    """They are equally far from any reference."""
    one = serial_pairs[1]
    if not one.robot.BRANCHES:
        return
    periods = (0,) * len(one.robot.PERIOD_AXES)
    samples = [s for s in singular_samples(one) if one.controller.forward(s.axes)[0] == OK and 3 in branches_of(one, s)]
    compared = 0
    for sample in samples[:: max(1, len(samples) // FEW)]:
        written = branches_of(one, sample)
        position, rotation, _ = one.controller.forward(sample.axes)[1]
        first = tuple(1 if byte == 3 else byte for byte in written)
        opened = one.controller.inverse(position, rotation, written + periods, sample.axes)
        assert opened[0] == OK
        if written.count(3) == 1:
            found = one.controller.inverse(position, rotation, first + periods, sample.axes)
            if nearly_singular(one, sample) == 1:
                assert opened == found
                compared += 1
            else:  # what rounding leaves of one root decides half of the digits of the other
                assert_same_pose(one, opened, found, sample)
    assert compared


def nearly_singular(one: Pair, sample: Sample) -> int:
    """How many margins nearly vanish."""
    return sum(abs(margin) < NEARLY for margin in one.robot.singularity(sample.axes).margins.values())


def singular_samples(one: Pair) -> tuple[Sample, ...]:
    """Right angles; of an arm in space, whose elbow stretches at any angle, what is singular by its description too."""
    has_loci = one.machine.is_spatial and one.robot.BRANCHES > 0
    return (*one.grid, *coinciding(one.machine)) if has_loci else one.grid


def branches_of(one: Pair, sample: Sample) -> tuple[int, ...]:
    """The branch bytes that forward kinematics writes."""
    data: tuple[int, ...] = one.controller.forward(sample.axes)[1][2]
    return data[: one.robot.BRANCHES]


def test_the_grid_has_singular_poses(serial_pairs: tuple[Pair, ...]) -> None:
    """A mechanism with margins is singular somewhere on the grid, and not everywhere."""
    (equal,) = (t for t in serial_pairs if t.machine.label == "equal")
    found = [equal.controller.is_singular(sample.axes) for sample in singular_samples(equal)]
    assert any(found) == bool(equal.robot.MARGINS)
    assert not all(found)


BOUND = 1e-11
"""Of what is missed: two free angles at their thresholds of 2e-12, either of them a chord of 2, and rounding."""
SOME = 3
"""Poses of a corner: the package is tested on all of them."""


@pytest.mark.slow
@pytest.mark.parametrize("paired", PAIRED, ids=lambda m: m.name)
def test_no_pose_is_lost(paired: Mechanism) -> None:
    """Where two singularities coincide the block reaches every pose."""
    rng = np.random.default_rng(11)
    for one, corner in places(paired):
        given = {**one.given, "check_limits": 0.0}
        pair = pair_of(replace(one, robot=one.changed(check_limits=False), given=given))
        axes = poses(one, corner)
        for row in axes[rng.choice(len(axes), SOME)].tolist():
            status, answer = pair.controller.forward(row)
            assert status == OK
            position, rotation, own = answer
            opened = (0,) * len(one.robot.CONFIGURATION)
            branches = (*own[: one.robot.BRANCHES], *opened[one.robot.BRANCHES :])
            references = (row, [0.0] * len(row), rng.uniform(-180.0, 180.0, len(row)).tolist())
            for any_reference in references:
                reference = held_at(one.robot, row, any_reference).tolist()
                for configuration in (branches, opened):
                    status, found = pair.controller.inverse(position, rotation, configuration, reference)
                    assert status == OK, f"{pair} {corner.names} {row} {configuration} {reference}"
                    met = np.array([found[: len(row)]]), np.array([position]), np.array([rotation])
                    assert one.miss(*met)[0] < BOUND, f"{pair} {corner.names} {row} {configuration} {reference}"


@pytest.mark.slow
def test_a_shoulder_and_an_elbow_at_once() -> None:
    """The shoulder's root is rounding, 5.4e-9 too long for the elbow that is stretched."""
    (mechanism,) = (m for m in PAIRED if m.name == "Kin_ArticulatedRobot_6DOF")
    pair = pair_of(machine(mechanism, "shifted", KR6_D3))
    axes = (110.0, 1.6345249003522546, 85.23635830927383, -70.0, -30.0, 100.0)
    _, (position, rotation, own) = pair.controller.forward(axes)
    for configuration in (own, (0,) * len(own)):
        status, found = pair.controller.inverse(position, rotation, configuration, axes)
        assert status == OK
        assert pair.machine.miss(np.array([found]), np.array([position]), np.array([rotation]))[0] < 1e-12
