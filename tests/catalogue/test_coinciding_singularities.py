"""Robots in space where several singularities coincide, exactly and nearly: every pose is answered, no branch is lost.

The wrist centre on axis 1, the elbow stretched and folded, the wrist straight, each alone and all together, and every
pose of a grid of right angles: with dimensions of arms that are sold, and with links that make all of it possible at
once.
"""

from functools import cache
from itertools import product

import numpy as np
import pytest
from softkin import Status

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import Array
from tests.catalogue.loci import Locus, coinciding, loci
from tests.catalogue.machines import MECHANISMS, Machine, bare_machine, is_spatial, machine, machines_of
from tests.catalogue.references import held_at
from tests.catalogue.robots import ROBOTS
from tests.catalogue.self_motion import is_free
from tests.catalogue.shares import share
from tests.catalogue.test_boundary import alone

pytestmark = pytest.mark.slow

RIGHT_ANGLES = (-90.0, 0.0, 90.0, 180.0)
REGULAR, NEAR = 1e-12, 1e-10
WELL_REGULAR = 0.2
CORNER = 2e-3
"""Margins that are near zero, per their largest."""
ENOUGH = 20
CLOSEST = 1e-11
"""Where a margin is smaller, a byte is 3."""
SPATIAL = tuple(m for m in MECHANISMS if is_spatial(m) and m.branches)


CASES = [(m, label) for m in SPATIAL for label in (*ROBOTS.get(m.name, {}), "bare", "random")]
"""Robots by their published dimensions; with equal links and nothing else; random ones."""


@pytest.fixture(params=CASES, ids=lambda c: f"{c[0].name}-{c[1]}")
def one(request: pytest.FixtureRequest) -> Machine:
    mechanism, label = request.param
    return robot_of(mechanism, label)


@cache
def robot_of(mechanism: Mechanism, label: str) -> Machine:
    if label in ("bare", "random"):
        return bare_machine(mechanism) if label == "bare" else machines_of(mechanism)[-1]
    return machine(mechanism, label, ROBOTS[mechanism.name][label])


def grid(one: Machine) -> Array:
    """Every combination of right angles: 4096 poses of six axes."""
    columns = [RIGHT_ANGLES if j.is_angle else (-one.reach / 2, 0.0, one.reach) for j in one.mechanism.joints]
    return np.array(list(product(*columns))) + one.closure.offsets


@cache
def folds(one: Machine) -> list[Locus]:
    """Where branches meet at an edge of the workspace; the others leave something free there."""
    first = [locus for locus in loci(one) if not locus.second]
    return [locus for locus in first if not is_free(one, alone(one, locus)[:1]).any()]


def is_corner(one: Machine, axes: Array, *, named: bool) -> Array:
    """Where a pose may be refused, though it may not be answered wrongly: half of the digits are lost, and more needed.

    Two edges of the workspace meet; or, where a branch is named, something is nearly free at an edge that several
    joints decide, such as a wrist nearly straight and nearly on axis 1.
    """
    near = np.abs(one.closure.indicators(one.closure.joints(axes))) < CORNER * one.largest
    edges = folds(one)
    corner = near[:, [f.branch for f in edges]].sum(axis=1) > 1
    if named:
        corner |= near[:, [f.branch for f in edges if f.joints > 1]].any(axis=1) & (near.sum(axis=1) > 1)
    return corner


def check(one: Machine, axes: Array, references: Array) -> None:
    """Nothing is lost and everything is met: as reported, with open branches, and on every slot that answers."""
    robot = one.changed(check_limits=False)
    frames = one.closure.poses(axes)
    written = robot.forward_batch(axes)[2]
    written[:, robot.BRANCHES :] = 0
    opened = np.zeros_like(written)
    regular = (np.abs(one.closure.indicators(one.closure.joints(axes))) > WELL_REGULAR * one.largest).all(axis=1)
    for configuration in (written, opened):
        found, statuses = robot.inverse_batch(*frames, configuration, references)
        answered = statuses == Status.OK
        corner = is_corner(one, axes, named=configuration is written)
        assert (~corner).sum() > ENOUGH
        assert answered[~corner].all()
        errors = one.miss(found, *frames)
        assert errors[answered].max() < NEAR
        assert errors[regular].max(initial=0.0) < REGULAR
    branches = written[:, : robot.BRANCHES]
    corner = is_corner(one, axes, named=True)
    slots = np.array(list(product((1, 2), repeat=robot.BRANCHES)))
    rows = np.tile(np.arange(len(axes)), len(slots))
    named = np.repeat(slots, len(axes), axis=0)
    configurations = np.hstack([named, opened[rows][:, robot.BRANCHES :]])
    found, statuses = robot.inverse_batch(*(f[rows] for f in frames), configurations, references[rows])
    answered = one.answers(statuses)
    own = ((branches[rows] == named) | (branches[rows] == 3)).all(axis=1)  # where branches coincide both have it
    assert answered[own & ~corner[rows]].all()
    assert one.miss(found[answered], *(f[rows[answered]] for f in frames)).max() < NEAR


@pytest.mark.parametrize("around", ["own", "zero", "anywhere"])
def test_every_pose_of_the_grid(one: Machine, around: str) -> None:
    """Every pose with joints at right angles is solved, with references at the pose and elsewhere."""
    axes = grid(one)
    assert len(axes) == (4096 if one.closure.angles.sum() == 6 else len({*map(tuple, axes.tolist())}))
    anywhere = np.random.default_rng(1).uniform(-180.0, 180.0, axes.shape)
    references = held_at(one.robot, axes, {"own": axes, "zero": 0 * axes, "anywhere": anywhere}[around])
    check(one, axes[share(len(axes))], references[share(len(axes))])


def test_singularities_that_coincide(one: Machine) -> None:
    axes = np.concatenate(list(coinciding(one)))
    near = np.abs(one.closure.indicators(one.closure.joints(axes))) < CLOSEST * one.largest
    assert near.any(axis=0).all()  # every branch, and several at once
    assert near.sum(axis=1).max() >= min(2, one.robot.BRANCHES)
    rng = np.random.default_rng(2)
    for references in (axes, rng.uniform(-180.0, 180.0, axes.shape)):
        asked = share(len(axes))
        check(one, axes[asked], held_at(one.robot, axes, references)[asked])
