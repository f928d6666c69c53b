"""Every position kinematics with every orientation kinematics: round trips, or a refusal for the stated reason."""

import re

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.coupling.determined import is_determined
from tests.catalogue.coupling.parts import ORIENTATIONS, POSITIONS, Part, frames, orientation_parts, position_part
from tests.catalogue.mounted.test_velocities import rows_of
from tests.catalogue.references import held_at
from tests.mechanisms import in_the_task
from tests.orthonormal import rodrigues
from tests.text.samples import tilted

POSES = 2
TOLERANCE = 1e-9
"""Of positions, in a user's unit: the machines are about a metre large."""
PAIRS = [(p, o) for p in POSITIONS for o in ORIENTATIONS]


def test_the_catalogue_has_both_kinds() -> None:
    """The catalogue has the expected numbers of position and orientation kinematics."""
    assert len(POSITIONS) == 47 and len(ORIENTATIONS) == 5


@pytest.mark.parametrize(("carrier", "wrist"), PAIRS, ids=[f"{p.name}-{o.name}" for p, o in PAIRS])
def test_a_pair_goes_round_or_is_refused(carrier: Mechanism, wrist: Mechanism) -> None:
    """Every pair either inverts its own forward kinematics, or is refused where a frame does not determine its axes."""
    first = position_part(carrier)
    for second in orientation_parts(wrist):
        try:
            coupled = softkin.Coupled(first.robot, second.robot)
        except KinematicsError as refusal:
            assert refusal.status is Status.INVALID_COUPLING
            assert carrier.name in str(refusal) and re.search("may have no axes|does not determine", str(refusal))
            assert not is_determined(first, second), str(refusal)
        else:
            assert is_determined(first, second), coupled
            _goes_round(coupled, first, second)


def _goes_round(coupled: softkin.Coupled, first: Part, second: Part) -> None:
    rng = np.random.default_rng(17)
    carrying, own = first.draw(POSES, rng), second.draw(POSES, rng)
    axes = np.hstack([carrying, own])
    places, turns, ends, rotations = frames(first, carrying, second, own)
    positions, commanded = places + np.einsum("nij,nj->ni", turns, ends), turns @ rotations
    found_positions, found_rotations, configurations, statuses = coupled.forward_batch(axes)
    assert (statuses == Status.OK).all()
    assert np.abs(found_positions - positions).max() < TOLERANCE and np.abs(found_rotations - commanded).max() < 1e-12
    back, statuses = coupled.inverse_batch(positions, commanded, configurations, axes)
    assert (statuses == Status.OK).all() and np.abs(back - axes).max() < 1e-6
    for k, values in enumerate(axes.tolist()):
        frame, configuration = coupled.forward(values)
        assert np.abs(np.subtract(frame.position, positions[k])).max() < TOLERANCE
        assert configuration == tuple(configurations[k])
        scalar = coupled.inverse(frame, configuration, values)
        assert scalar == pytest.approx(values, abs=1e-8) and scalar == pytest.approx(tuple(back[k]), abs=1e-8)
        opened = (0,) * len(configuration)
        near = held_at(coupled, values, [v + 1e-3 for v in values])
        assert coupled.inverse(frame, opened, near) == pytest.approx(values, abs=1e-8)
        _every_slot(coupled, first, second, frame, values)
        _what_cannot_be_had(coupled, second, turns[k], rotations[k], frame, configuration, values, rng)
        _jacobian(coupled, values)


def _every_slot(coupled: softkin.Coupled, first: Part, second: Part, frame: softkin.Frame, values: list[float]) -> None:
    """All branches of the one times all of the other, each with its status; each answer has the frame."""
    slots = coupled.inverse_all(frame, values)
    assert len(slots) == 2 ** (first.robot.BRANCHES + second.robot.BRANCHES)
    answers = [s for s in slots if s.status is Status.OK]
    assert any(s.axes == pytest.approx(values, abs=1e-8) for s in answers)
    for slot in slots:
        assert (slot.axes is None) == (slot.status is not Status.OK)
        assert slot.status in (Status.OK, Status.UNREACHABLE, Status.IMPOSSIBLE)
    if first.mechanism.is_platform:
        answers = [s for s in answers if _is_found_again(coupled, s.axes, frame)]
    for slot in answers:
        again, configuration = coupled.forward(slot.axes)
        apart = in_the_task(first.mechanism.name, np.subtract(again.position, frame.position))
        assert np.abs(apart).max() < TOLERANCE
        _meets_the_rotation(coupled, second, slot.axes, np.array(again.rotation), np.array(frame.rotation))
        assert configuration == slot.configuration
        assert coupled.inverse(frame, configuration, slot.axes) == pytest.approx(slot.axes, abs=1e-8)
    if second.mechanism.task.turning in (
        Turning.NONE,
        Turning.FULL,
    ):  # one place of the flange for all branches behind it
        flange = first.robot.forward(values[: len(first.robot.AXES)])[0]
        alone = [s for s in first.robot.inverse_all(flange, values[: len(first.robot.AXES)]) if s.status is Status.OK]
        alone = [s for s in alone if not first.mechanism.is_platform or _is_found_again(first.robot, s.axes, flange)]
        assert len(answers) == len(alone) * 2**second.robot.BRANCHES


def _is_found_again(robot: softkin.Mechanism, axes: tuple[float, ...] | None, flange: softkin.Frame) -> bool:
    """Whether forward kinematics, which iterates from home, comes to the flange."""
    assert axes is not None
    try:
        found = robot.forward(axes)[0]
    except KinematicsError:
        return False
    return bool(np.abs(np.subtract(found.position, flange.position)).max() < TOLERANCE)


def _meets_the_rotation(
    coupled: softkin.Coupled, second: Part, axes: tuple[float, ...], found: np.ndarray, commanded: np.ndarray
) -> None:
    """All of it, or the direction of the tool; on another branch, whose flange points elsewhere, the nearest."""
    count = len(second.robot.AXES)
    if second.mechanism.task.turning is Turning.DIRECTION:
        assert np.abs(found[:, 2] - commanded[:, 2]).max() < 1e-11
        return
    exact = second.mechanism.task.turning is Turning.FULL or coupled.position_part.FREEDOM == "zero"
    if exact or (coupled.FREEDOM == "one" and coupled.READS_ROTATION):
        assert np.abs(found - commanded).max() < 1e-11
    elif count:
        for step in (-0.5, 0.5):
            beside = np.array(coupled.orientation((*axes[:-1], axes[-1] + step)))
            assert np.trace(beside.T @ commanded) < np.trace(found.T @ commanded)


def _what_cannot_be_had(
    coupled: softkin.Coupled,
    second: Part,
    flange: np.ndarray,
    own: np.ndarray,
    frame: softkin.Frame,
    configuration: tuple[int, ...],
    values: list[float],
    rng: np.random.Generator,
) -> None:
    """A rotation that the tool can be swung to, or that differs in what is passive: the same axes."""
    if second.mechanism.task.turning is Turning.FULL:
        return
    if second.mechanism.task.turning is Turning.ABOUT_Z:
        commanded = flange @ _swing(rng) @ own
    elif second.mechanism.task.turning is Turning.DIRECTION:
        angle = rng.uniform(-np.pi, np.pi)
        commanded = flange @ own @ rodrigues((0.0, 0.0, 1.0), angle)
    else:
        commanded = np.array(tilted(rng))
        if coupled.READS_ROTATION:
            commanded = flange @ own  # the flange follows a turn itself
    found = coupled.inverse((frame.position, commanded.tolist()), configuration, values)
    assert found == pytest.approx(values, abs=1e-8)


def _swing(rng: np.random.Generator) -> np.ndarray:
    """A turn about a horizontal axis: it tilts z and has no twist."""
    azimuth, tilt = rng.uniform(-np.pi, np.pi), rng.uniform(-2.5, 2.5)
    return rodrigues((np.cos(azimuth), np.sin(azimuth), 0.0), tilt)


def _jacobian(coupled: softkin.Coupled, values: list[float]) -> None:
    """All six rows against differences of the frames."""
    rows = np.array(coupled.jacobian(values))
    assert rows.shape == (6, len(values)) and coupled.JACOBIAN_ROWS == ("x", "y", "z", "turn x", "turn y", "turn z")
    expected = rows_of(coupled, np.array(values), 600.0)
    sizes = np.abs(expected[:3]).max(axis=0, initial=0.0)
    assert (np.abs(rows - expected) <= 1e-5 * np.maximum(np.abs(expected), 1.0 + sizes)).all()
