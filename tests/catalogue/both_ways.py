"""Batch calls whose rows are compared with scalar calls: at every boundary both must decide the same."""

from typing import Any

import numpy as np
import softkin
from numpy.typing import ArrayLike
from softkin import KinematicsError, Status

from tests.catalogue.closure import Array

SAME = 1e-4
"""Tolerance in degrees or lengths: at a stretched arm rounding costs half of the digits."""


def forward(robot: Any, axes: Array, start: tuple[Array, Array] | None = None) -> tuple[Array, Array, Array, Array]:
    """`forward_batch`; frames, configurations and statuses are those of the scalar calls, and so are orientations.

    start: positions and rotations where forward kinematics starts, of a machine that iterates.
    """
    starts = [()] * len(axes) if start is None else [(one,) for one in zip(*start, strict=True)]
    positions, rotations, configurations, statuses = robot.forward_batch(axes, *(() if start is None else (start,)))
    single, said, written = np.full(positions.shape, np.nan), statuses.tolist(), configurations.tolist()
    turned = np.full(rotations.shape, np.nan)
    for row, values in enumerate(axes.tolist()):
        try:
            frame, configuration = robot.forward(values, *starts[row])
        except KinematicsError as error:
            assert error.status == said[row]
        else:
            assert said[row] == Status.OK
            assert list(configuration) == written[row]
            single[row], turned[row] = frame
            assert robot.orientation(values, *starts[row]) == frame.rotation
    answered = statuses == Status.OK
    size = 1e-14 * (np.abs(axes[answered]).max(initial=0.0) + np.abs(positions[answered]).max(initial=0.0) + 1000.0)
    assert np.allclose(single[answered], positions[answered], rtol=0.0, atol=size)
    assert np.allclose(turned[answered], rotations[answered], rtol=0.0, atol=1e-14)
    return positions, rotations, configurations, statuses


def inverse(
    robot: softkin.Mechanism,
    positions: Array,
    rotations: Array,
    configurations: ArrayLike | None = None,
    references: ArrayLike | None = None,
) -> tuple[Array, Array]:
    """`inverse_batch`; axes and statuses are those of the scalar calls."""
    found, statuses = robot.inverse_batch(positions, rotations, configurations, references)
    count = len(positions)
    given = robot.DEFAULT_CONFIGURATION if configurations is None else configurations
    codes = np.broadcast_to(given, (count, len(robot.CONFIGURATION))).tolist()
    near = np.broadcast_to(np.zeros(len(robot.AXES)) if references is None else references, found.shape).tolist()
    single, said = np.full(found.shape, np.nan), statuses.tolist()
    for row, frame in enumerate(zip(positions.tolist(), rotations.tolist(), strict=True)):
        try:
            single[row] = robot.inverse(frame, codes[row], near[row])
        except KinematicsError as error:
            assert error.status == said[row]
        else:
            assert said[row] == Status.OK
    answered = statuses == Status.OK
    assert (np.abs(single - found)[answered] < SAME).all()
    return found, statuses


def missed(robot: softkin.Mechanism, axes: Array, references: ArrayLike) -> tuple[float, float]:
    """The largest errors of places and of rotations with which poses are answered on their branch; none is refused."""
    positions, rotations, configurations, _ = robot.forward_batch(axes)
    found, statuses = robot.inverse_batch(positions, rotations, configurations, references)
    assert (statuses == Status.OK).all(), f"{robot}: {axes[statuses != Status.OK][:1].tolist()}"
    reached, turned, _, _ = robot.forward_batch(found)
    return float(np.abs(reached - positions).max()), float(np.abs(turned - rotations).max())
