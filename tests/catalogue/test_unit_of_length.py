"""A machine in metres is the machine in millimetres: nothing that has no unit may depend on the unit of length.

The units are powers of two apart. Rounding is then the same in both, and so every digit of every answer.
"""

from collections.abc import Mapping

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism, Role
from derive.plate.plate import home_position
from tests.catalogue.closure import Array
from tests.catalogue.machines import LENGTHS
from tests.mechanisms import catalogue

CATALOGUE = tuple(m for _, m in catalogue() if m.joints)
SHARED = {"Kin_Delta_P3C_Type3": {"azimuth_1": 0.0, "azimuth_2": 110.0, "azimuth_3": -120.0}}
UNITS = (2.0**-10, 2.0**10)
"""From millimetres to metres, nearly, and back."""
CASES = [pytest.param(m, u, id=f"{m.name}-{u:g}") for m in CATALOGUE for u in UNITS if m.search is None or u < 1.0]
POSES = 12
EXACTLY = {"rtol": 0.0, "atol": 0.0}
ROUNDED = {"rtol": 1e-9, "atol": 1e-9}


def given_to(mechanism: Mechanism) -> dict[str, float]:
    """A machine with all its lengths, distances too."""
    given = {p.name: p.nominal for p in mechanism.parameters} | SHARED.get(mechanism.name, {})
    for k, parameter in enumerate(p for p in mechanism.parameters if p.role in LENGTHS):
        given[parameter.name] *= 1.0 + 0.03 * k
    return given


def in_unit(robot: softkin.Mechanism, given: Mapping[str, float], unit: float) -> softkin.Mechanism:
    """The robot with its lengths and pitches in another unit, as far as the vendor's ranges allow."""
    lengths = {p.name for p in robot.PARAMETERS if p.unit.startswith("u")}
    return type(robot)(**{name: v * unit if name in lengths else v for name, v in given.items()})


def allowed(robot: softkin.Mechanism, given: Mapping[str, float], unit: float) -> float:
    """The unit, or 2 where a vendor's range ends before."""
    bounded = [p for p in robot.PARAMETERS if p.unit.startswith("u") and p.name in given]
    return unit if all(abs(given[p.name]) * unit <= p.high for p in bounded) else 2.0


def axes_of(mechanism: Mechanism, robot: softkin.Mechanism, scale: float) -> Array:
    """Axis values at which the machine is somewhere, singular poses with them."""
    rng = np.random.default_rng(3)
    if mechanism.is_platform:
        values = {p.symbol: given_to(mechanism)[p.name] for p in mechanism.parameters}
        position = np.array([float(v.xreplace(values)) for v in home_position(mechanism)])
        own = [c in mechanism.task.position for c in "xyz"]
        frames = position + rng.uniform(-0.02, 0.02, (POSES, 3)) * scale * own
        return robot.inverse_batch(frames, np.tile(np.eye(3), (POSES, 1, 1)))[0]
    columns = []
    for joint in mechanism.joints:
        low, high = joint.domain or ((-180.0, 180.0) if joint.axis_is_angle else (-scale, scale))
        if joint.loops:
            low, high = sorted((0.8 * joint.nominal, 1.2 * joint.nominal))
        columns.append(rng.uniform(low, min(high, 2.0 * scale), 4000))
    drawn = np.stack(columns, axis=1)
    drawn[::50] = np.round(drawn[::50] / 90.0) * 90.0
    statuses = robot.forward_batch(drawn)[3]
    return drawn[np.flatnonzero(statuses == Status.OK)[:POSES]]


@pytest.mark.long("Ac6")
@pytest.mark.parametrize(("described", "unit"), CASES)
def test_only_lengths_change_with_the_unit(described: Mechanism, unit: float) -> None:
    """Margins, bytes, statuses and slots are the same; positions, slides and the Jacobian change as they should."""
    given = given_to(described)
    robot = softkin.catalogue()[described.name](**given)
    unit = allowed(robot, given, unit)
    other = in_unit(robot, given, unit)
    scale = sum(abs(v) for n, v in given.items() for p in robot.PARAMETERS if p.name == n and p.unit == "u") or 300.0
    slides = np.array([1.0 if axis.unit == "deg" else unit for axis in robot.AXES])
    axes = axes_of(described, robot, scale)
    assert len(axes) == POSES
    axes = axes[: 2 if described.search is not None else POSES]
    close = ROUNDED if described.is_platform or described.search is not None else EXACTLY
    positions, rotations, configurations, _ = robot.forward_batch(axes)
    found = other.forward_batch(axes * slides)
    assert (found[2] == configurations).all() and (found[3] == Status.OK).all()
    np.testing.assert_allclose(found[0], positions * unit, **close)
    np.testing.assert_allclose(found[1], rotations, **close)
    rows = np.array([unit if r in "xyz" else 1.0 for r in robot.JACOBIAN_ROWS])
    for row in axes:
        here, there = robot.singularity(row), other.singularity(row * slides)
        assert here.is_singular == there.is_singular
        np.testing.assert_allclose(list(there.margins.values()), list(here.margins.values()), **close)
        expected = _jacobian(robot, row)
        np.testing.assert_allclose(_jacobian(other, row * slides) * slides, expected * rows[:, None], **close)
    references = axes + np.random.default_rng(4).uniform(-1.0, 1.0, axes.shape) * np.where(slides == 1.0, 300.0, scale)
    automatic = [] if described.search is not None else [np.zeros_like(configurations)]  # a search takes its time
    for configuration in (configurations, *automatic):
        own, statuses = robot.inverse_batch(positions, rotations, configuration, references)
        same, others = other.inverse_batch(positions * unit, rotations, configuration, references * slides)
        assert (statuses == others).all()
        np.testing.assert_allclose(same, own * slides, **close)
    for row in range(0, len(axes), 4):
        slots = robot.inverse_all((positions[row], rotations[row]), references[row])
        others = other.inverse_all((positions[row] * unit, rotations[row]), references[row] * slides)
        assert [s.status for s in slots] == [s.status for s in others]


def _jacobian(robot: softkin.Mechanism, axes: Array) -> Array:
    try:
        return np.array(robot.jacobian(axes))
    except KinematicsError as refused:
        assert refused.status is Status.IMPOSSIBLE
        return np.full((len(robot.JACOBIAN_ROWS), len(robot.AXES)), np.nan)


@pytest.mark.parametrize("name", ["Kin_Polar", "Kin_Polar_Z", "Kin_Crane"])
def test_without_a_length_a_distance_has_no_margin(name: str) -> None:
    """There is nothing to compare a radius with: 1, and 0 where an axis is free; a sine has its margin all the same."""
    robot = softkin.catalogue()[name]()
    place = [axis.name for axis in robot.AXES].index("R")
    free = "free_phi" if name == "Kin_Crane" else "free_c"
    for radius, expected in ((250.0, 1.0), (0.25, 1.0), (1e-6, 1.0), (1e-12, 0.0), (0.0, 0.0)):
        axes = [30.0] * len(robot.AXES)
        axes[place] = radius
        found = robot.singularity(axes)
        assert found.margins[free] == expected and found.is_singular == (expected == 0.0)
    if name == "Kin_Crane":
        assert robot.singularity((250.0, 10.0, 30.0)).margins["free_theta"] == pytest.approx(0.5)
        assert robot.singularity((250.0, 10.0, 0.01)).is_singular


def test_every_margin_is_of_the_order_of_one() -> None:
    """Whatever the dimensions are: of a machine a thousand times as large, and a thousand times as small."""
    for mechanism in CATALOGUE:
        given, most = given_to(mechanism), 2.0 + 1e-9 if mechanism.assembly is not None else 4.0
        plain = softkin.catalogue()[mechanism.name](**given)
        scale = sum(abs(given[p.name]) for p in mechanism.parameters if p.role in (*LENGTHS, Role.DISTANCE)) or 1.0
        for size in (1e-3, allowed(plain, given, 1e3)):
            robot = in_unit(plain, given, size)
            slides = np.array([1.0 if axis.unit == "deg" else size for axis in robot.AXES])
            for row in axes_of(mechanism, plain, scale):
                found = robot.singularity(row * slides).margins
                assert all(abs(m) <= most for m in found.values()), (mechanism.name, found)
