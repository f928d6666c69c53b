"""Samples of a calibration: the axes of a machine, and what was measured there."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike, fspath
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from softkin._core import Mechanism
from softkin._frame import Frame
from softkin._types import KinematicsError, Status

Array: TypeAlias = NDArray[np.float64]
Samples: TypeAlias = "str | PathLike[str] | Mapping[str, Any] | Iterable[Mapping[str, Any]]"
"""The path of a CSV file, columns by name, or rows by name. An entry that is empty or NaN was not measured."""
POINT, QUATERNION, EULER, DISTANCE = ("x", "y", "z"), ("qx", "qy", "qz", "qw"), ("a", "b", "c"), "distance"
SIGMAS = {
    "sigma_x": 0.01,
    "sigma_y": 0.01,
    "sigma_z": 0.01,
    "sigma_rotation": float(np.degrees(1e-4)),
    "sigma_distance": 0.01,
}
"""The standard deviations, in lengths and degrees, and those that weigh the samples where they are not given."""
ARRAYS = ("axes", "positions", "rotations")
"""Several columns at once, as batches have them."""
_COLUMNS = (*POINT, *QUATERNION, *EULER, DISTANCE, *SIGMAS)


class Measured(NamedTuple):
    """N samples; NaN for what was not measured."""

    axes: Array
    """(N, n), in degrees and lengths."""
    points: Array
    """(N, 3)."""
    rotations: Array
    """(N, 3, 3)."""
    distances: Array
    """(N,): from the point of the first sample."""
    sigmas: dict[str, Array]
    """By name, (N,): rotations in radians."""
    has_sigma: bool
    """Whether standard deviations are given."""


def measured(robot: Mechanism, samples: Samples) -> Measured:
    """The samples of a machine. Raises BAD_INPUT for a column that is missing or unknown, and for what is no number."""
    names = [axis.name for axis in robot.AXES]
    given, turned = _from_arrays(columns_of(samples), names)
    own = {name: f"axis_{name}" if name in _COLUMNS or f"axis_{name}" in given else name for name in names}
    unknown = [name for name in given if name not in (*_COLUMNS, *own.values())]
    missing = [column for column in own.values() if column not in given]
    if unknown or missing:
        what = f"there is no column {missing[0]!r}" if missing else f"the column {unknown[0]!r} is unknown"
        listed = ", ".join((*own.values(), *_COLUMNS))
        raise refused(f"{what}: axes, what was measured, and standard deviations have the columns {listed}")
    columns = {name: np.array([_number(name, k, v) for k, v in enumerate(given[name])]) for name in given}
    count = len(columns[own[names[0]]])
    nothing = np.full(count, np.nan)
    units = [np.degrees(1.0) if axis.unit == "rad" else 1.0 for axis in robot.AXES]
    axes = np.stack([columns[own[name]] * unit for name, unit in zip(names, units, strict=True)], axis=1)
    if not np.isfinite(axes).all():
        row = int(np.argmin(np.isfinite(axes).all(axis=1)))
        raise refused(f"row {row}: every sample needs the values of all axes")
    points = np.stack([columns.get(name, nothing) for name in POINT], axis=1)
    distances = columns.get(DISTANCE, nothing)
    rotations = _rotations(columns, count) if turned is None else turned
    if not (np.isfinite(points).any() or np.isfinite(rotations).any() or np.isfinite(distances).any()):
        raise refused("nothing was measured: x, y, z; qx, qy, qz, qw or a, b, c; or distance")
    sigmas = {name: np.where(np.isfinite(v := columns.get(name, nothing)), v, usual) for name, usual in SIGMAS.items()}
    for name, values in sigmas.items():
        if not (values > 0.0).all():
            raise refused(f"row {int(np.argmin(values > 0.0))}: {name} must be more than 0")
    sigmas["sigma_rotation"] = np.radians(sigmas["sigma_rotation"])
    return Measured(axes, points, rotations, distances, sigmas, any(name in given for name in SIGMAS))


def columns_of(samples: Samples) -> dict[str, Sequence[Any]]:
    """The samples by column. Raises BAD_INPUT for what is no table."""
    if isinstance(samples, str | PathLike):
        with open(fspath(samples), encoding="utf-8-sig", newline="") as file:
            text = file.read().splitlines()
        separator = ";" if text and ";" in text[0] else ","
        samples = list(csv.DictReader(text, delimiter=separator, skipinitialspace=True))
    if isinstance(samples, Mapping):
        found: dict[str, Sequence[Any]] = {str(name): list(values) for name, values in samples.items()}
    else:
        rows = list(samples)
        names = list(dict.fromkeys(name for row in rows for name in row))
        if any(not isinstance(name, str) for name in names):
            raise refused("a row has more entries than the table has columns")
        found = {name.strip(): [row.get(name) for row in rows] for name in names}
    if len({len(values) for values in found.values()}) != 1 or not next(iter(found.values())):
        raise refused("a table has at least one row, and columns of one length")
    return found


def _from_arrays(
    given: Mapping[str, Sequence[Any]], names: Sequence[str]
) -> tuple[dict[str, Sequence[Any]], Array | None]:
    """The columns of what is given as arrays: axes (N, n), positions (N, 3); and rotations (N, 3, 3) as they are."""
    found = {name: values for name, values in given.items() if name not in ARRAYS}
    turned = None
    for word, columns in zip(ARRAYS, ([f"axis_{name}" for name in names], POINT, None), strict=True):
        if word not in given:
            continue
        table, width = np.asarray(given[word], np.float64), (3, 3) if columns is None else (len(columns),)
        if table.shape[1:] != width:
            raise refused(f"{word} must have the shape (N, {', '.join(map(str, width))}), not {table.shape}")
        if columns is None:
            turned = table
        else:
            found |= dict(zip(columns, table.T.tolist(), strict=True))
    return found, turned


def _rotations(columns: Mapping[str, Array], count: int) -> Array:
    """The measured rotations: by quaternion, else by the angles of SoftMotion."""
    found = np.full((count, 3, 3), np.nan)
    for names, make in ((QUATERNION, Frame.from_quaternion), (EULER, lambda given: Frame.from_euler(*given))):
        given = [name for name in names if name in columns]
        if not given:
            continue
        if len(given) != len(names):
            raise refused(f"a rotation needs all of the columns {', '.join(names)}")
        for row, values in enumerate(zip(*(columns[name].tolist() for name in names), strict=True)):
            if np.isfinite(values).all():
                try:
                    found[row] = make(values).rotation
                except KinematicsError as error:
                    raise refused(f"row {row}: {error}") from error
    return found


def _number(name: str, row: int, value: Any) -> float:
    """A number; NaN for an empty entry."""
    if value is None or (isinstance(value, str) and not value.strip()):
        return float("nan")
    try:
        return float(value)
    except (TypeError, ValueError):
        raise refused(f"row {row}: {name} must be a number, not {value!r}") from None


def refused(message: str) -> KinematicsError:
    """The error for samples that cannot be used."""
    return KinematicsError(Status.BAD_INPUT, f"samples: {message}")
