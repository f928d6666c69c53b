"""From measurements to deviations: least squares, and what the measurements determine."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from softkin._calibrated import Calibrated, bare_of
from softkin._core import Mechanism
from softkin._deviations import ENDS, units_of
from softkin._identification import SCALES, determined
from softkin._input import suggestion
from softkin._samples import Measured, Samples, measured, refused
from softkin._sensitivity import model
from softkin._types import KinematicsError, Status

Array: TypeAlias = NDArray[np.float64]
_SUSPECT, _LOSS = 4.0, 3.0
"""Where a residual is larger than the first, in standard deviations, there may be outliers: then residuals larger than
the second count less than their square."""
_LATER = ("tool", "base", "offset", "gain")
"""What is found behind lines and dimensions, in this order, unless a caller has another."""
_PASSES = 100
"""The most evaluations of a fit."""
_MEDIAN = 1.4826
"""The standard deviation of normal numbers, by the median of their sizes."""


class Errors(NamedTuple):
    """Root mean squares of what is missed; NaN for what was not measured."""

    position: float
    """The distance of points, or the missing part of the coordinates that were measured."""
    rotation: float
    """In degrees."""
    distance: float
    """Of distances from the first point."""


@dataclass(frozen=True, eq=False, repr=False)
class Calibration:
    """What measurements say of a machine. `print` shows it as a table."""

    machine: Mechanism
    """The machine with the deviations that were found."""
    deviations: Mapping[str, float]
    """Those that the samples determine, by name, in degrees and lengths."""
    sigma: Mapping[str, float]
    """Their standard deviations."""
    held: Mapping[str, Mapping[str, float]]
    """Those that the samples do not determine, which stay as they were: by name, the deviations that move the samples
    as one unit of it does. Nothing where it moves no sample."""
    correlation: Mapping[tuple[str, str], float]
    """The correlation of each pair, by names."""
    outliers: tuple[int, ...]
    """The rows, counted from 0, that were left out: they are missed by far more than the others."""
    before: Errors
    """With the machine as it was given."""
    after: Errors
    """With the machine that was found, without outliers."""
    left_out: Errors
    """Each sample predicted by all others: what to expect of new poses."""
    condition: float
    """The ratio of the largest to the least singular value of the scaled Jacobian: above some hundred, poses are few or
    alike."""
    observability: float
    """The geometric mean of the singular values, by the root of the number of samples (Borm and Menq): larger is
    better, for as many deviations."""
    samples: int

    def __repr__(self) -> str:
        """The machine, the number of deviations, and the errors that are left."""
        found = f"{len(self.deviations)} deviations from {self.samples} samples"
        return f"<Calibration of {self.machine.NAME}: {found}, {self.after.position:.3g} u left>"

    def __str__(self) -> str:
        """The table."""
        from softkin._calibration_table import table

        return table(self)


def calibrate(
    robot: Mechanism, samples: Samples, *, parameters: Iterable[str] | None = None, outlier: float = 5.0
) -> Calibration:
    """The deviations of a machine from samples of its axes and of where it was.

    samples: the path of a CSV file, columns by name, or rows. Columns: each axis by its name, in its unit; x, y, z of
    the tool, or some of them; its rotation as qx, qy, qz, qw or as SoftMotion's a, b, c in degrees; `distance` from
    the point of the first sample; and sigma_x, sigma_y, sigma_z, sigma_rotation (degrees), sigma_distance where they
    are known; or arrays as batches have them: axes, positions, rotations. An empty entry was not measured. Where no
    sigma is given, their size is taken from the residuals.
    parameters: names of `robot.deviations`, or words for several of them: `tilt`, `shift`, `offset`, `gain`, `tool`,
    `base`, `a2`. What follows from the words before it is held. None stands for all: lines of axes, or dimensions, then
    tool, base, offsets, gains.
    outlier: rows that are missed by more than this many standard deviations are left out, and named.
    Raises BAD_INPUT for samples and names that cannot be used, ImportError without SciPy: softkin[calibration].
    """
    given, fit = robot.in_degrees(), measured(robot, samples)
    nominal = given.nominal if isinstance(given, Calibrated) else given
    start = {name: value for name, value in given.deviations.items() if value}
    names, groups = _chosen(nominal, parameters)
    units = units_of(bare_of(nominal))
    sizes = np.array([SCALES[units[name]] for name in names])
    problem = Problem(nominal, fit, names, start, sizes)
    zero: Array = np.array([start.get(name, 0.0) for name in names]) / sizes
    every = np.ones(len(fit.axes), bool)
    found = determined(problem.jacobian(zero, every), groups)
    if not found.kept:
        raise refused("they determine no deviation")
    from scipy.optimize import least_squares

    def fitted(first: Array, rows: NDArray[np.bool_], loss: str, scale: float) -> Array:
        def whole(values: Array) -> Array:
            full = zero.copy()
            full[found.kept] = values
            return full

        done = least_squares(
            lambda x: problem.residuals(whole(x), rows),
            first[found.kept],
            jac=lambda x: problem.jacobian(whole(x), rows)[:, found.kept],
            method="trf", loss=loss, f_scale=scale, x_scale="jac", xtol=1e-11, ftol=1e-11, gtol=1e-11, max_nfev=_PASSES,
        )  # fmt: skip
        return whole(np.asarray(done.x, np.float64))

    best, rows = fitted(zero, every, "linear", 1.0), every
    if problem.by_row(best).max() > _SUSPECT * problem.noise(best, every, len(found.kept)):
        best = fitted(best, every, "soft_l1", _LOSS * problem.noise(best, every, len(found.kept)))
        rows = problem.by_row(best) <= outlier * problem.noise(best, every, len(found.kept))
        if rows.sum() * 2 < len(rows):
            raise refused("more than half are outliers: is the machine, or the frame of the instrument, another?")
        best = fitted(best, rows, "linear", 1.0)
    return _result(problem, best, zero, rows, found.kept, found.held)


class Problem:
    """The residuals of samples, in standard deviations, by deviations in usual sizes."""

    def __init__(
        self, nominal: Mechanism, fit: Measured, names: Sequence[str], start: Mapping[str, float], sizes: Array
    ) -> None:
        """start: all deviations of the machine as it is given."""
        self.nominal, self.fit, self.names, self.start, self.sizes = nominal, fit, names, start, sizes
        sigmas = fit.sigmas
        self.points = np.stack([sigmas[f"sigma_{k}"] for k in "xyz"], axis=1)
        whole = [fit.points / self.points, np.repeat(fit.rotations[:, :1, 0], 3, axis=1), fit.distances[:, None]]
        self.is_measured = np.isfinite(np.concatenate(whole, axis=1))
        """(N, 7): x, y, z, three turns, the distance."""

    def deviations(self, values: Array) -> dict[str, float]:
        """The deviations in their units."""
        return {**self.start, **dict(zip(self.names, (values * self.sizes).tolist(), strict=True))}

    def table(self, values: Array, names: Sequence[str]) -> tuple[Array, Array]:
        """The residuals (N, 7) and their derivatives (N, 7, m)."""
        fit = self.fit
        at = model(self.nominal, self.deviations(values), names, fit.axes)
        if not np.isfinite(at.positions).all():
            row = int(np.argmin(np.isfinite(at.positions).all(axis=1)))
            raise refused(f"row {row}: the machine cannot be at these axes")
        turns = _vectors(at.rotations @ np.where(np.isfinite(fit.rotations), fit.rotations, 0.0).transpose(0, 2, 1))
        apart = at.positions - at.positions[0]
        length = np.linalg.norm(apart, axis=1)
        along = apart / np.where(length > 0.0, length, 1.0)[:, None]
        away = np.einsum("ni,nim->nm", along, at.twists[:, :3] - at.twists[:1, :3])
        missed = np.concatenate(
            [
                (at.positions - fit.points) / self.points,
                turns / fit.sigmas["sigma_rotation"][:, None],
                ((length - fit.distances) / fit.sigmas["sigma_distance"])[:, None],
            ],
            axis=1,
        )
        moved = np.concatenate(
            [
                at.twists[:, :3] / self.points[:, :, None],
                at.twists[:, 3:] / fit.sigmas["sigma_rotation"][:, None, None],
                (away / fit.sigmas["sigma_distance"][:, None])[:, None],
            ],
            axis=1,
        )
        return missed, moved

    def residuals(self, values: Array, rows: NDArray[np.bool_]) -> Array:
        """The residuals of some samples."""
        return self.table(values, ())[0][self.is_measured & rows[:, None]]

    def jacobian(self, values: Array, rows: NDArray[np.bool_]) -> Array:
        """Their derivatives, by deviations in usual sizes."""
        found: Array = self.table(values, self.names)[1][self.is_measured & rows[:, None]] * self.sizes
        return found

    def by_row(self, values: Array) -> Array:
        """The largest residual of every sample."""
        found: Array = np.where(self.is_measured, np.abs(self.table(values, ())[0]), 0.0).max(axis=1)
        return found

    def noise(self, values: Array, rows: NDArray[np.bool_], count: int) -> float:
        """The size of the residuals, in the standard deviations that are given: 1 where they are right."""
        found = self.residuals(values, rows)
        if self.fit.has_sigma:
            return 1.0
        return float(_MEDIAN * np.median(np.abs(found)) * np.sqrt(len(found) / max(len(found) - count, 1))) + 1e-12

    def errors(self, missed: Array, rows: NDArray[np.bool_]) -> Errors:
        """Root mean squares of residuals (N, 7) in standard deviations."""
        known = self.is_measured & rows[:, None]
        scales = [self.points, self.fit.sigmas["sigma_rotation"][:, None], self.fit.sigmas["sigma_distance"][:, None]]
        found = []
        for columns, scale in zip((slice(0, 3), slice(3, 6), slice(6, 7)), scales, strict=True):
            inside, own = known[:, columns], missed[:, columns] * scale
            squares = np.where(inside, own, 0.0) ** 2
            has = inside.any(axis=1)
            found.append(float(np.sqrt(squares.sum() / has.sum())) if has.any() else float("nan"))
        return Errors(found[0], float(np.degrees(found[1])), found[2])


def _result(
    problem: Problem, best: Array, start: Array, rows: NDArray[np.bool_], kept: list[int],
    held: Mapping[int, Mapping[int, float]],
) -> Calibration:  # fmt: skip
    """All that is told of a fit."""
    names, sizes = problem.names, problem.sizes
    known = problem.is_measured & rows[:, None]
    missed, moved = problem.table(best, names)
    jacobian = (moved * sizes)[:, :, kept]
    flat, residuals = jacobian[known], missed[known]
    singular = np.linalg.svd(flat, compute_uv=False)
    inverse = np.linalg.pinv(flat.T @ flat)
    freedom = max(len(residuals) - len(kept), 1)
    scale = 1.0 if problem.fit.has_sigma else float(residuals @ residuals) / freedom
    spread = np.sqrt(np.diag(inverse))
    related = inverse / np.outer(spread, spread)
    predicted = missed.copy()
    for row in np.flatnonzero(rows):
        inside = problem.is_measured[row]
        own = jacobian[row][inside]
        share = np.eye(len(own)) - own @ inverse @ own.T
        predicted[row][inside] = np.linalg.lstsq(share, missed[row][inside])[0]
    own_names = [names[k] for k in kept]
    found = problem.deviations(best)
    combined = {
        names[k]: MappingProxyType({names[i]: float(share * sizes[i] / sizes[k]) for i, share in shares.items()})
        for k, shares in held.items()
    }
    return Calibration(
        machine=problem.nominal.calibrated(found),
        deviations=MappingProxyType({name: found[name] for name in own_names}),
        sigma=MappingProxyType(
            {n: float(s) for n, s in zip(own_names, spread * sizes[kept] * np.sqrt(scale), strict=True)}
        ),
        held=MappingProxyType(combined),
        correlation=MappingProxyType(
            {
                (first, second): float(related[i, k])
                for i, first in enumerate(own_names)
                for k, second in enumerate(own_names)
                if i < k
            }
        ),
        outliers=tuple(np.flatnonzero(~rows).tolist()),
        before=problem.errors(problem.table(start, ())[0], rows),
        after=problem.errors(missed, rows),
        left_out=problem.errors(predicted, rows),
        condition=float(singular[0] / singular[-1]),
        observability=float(np.exp(np.log(singular).mean()) / np.sqrt(rows.sum())),
        samples=len(rows),
    )


def _chosen(nominal: Mechanism, parameters: Iterable[str] | None) -> tuple[list[str], list[int]]:
    """The names of the deviations to be found, and the group of each: those of the first word come first."""
    units = units_of(bare_of(nominal))
    if parameters is None:
        return list(units), [next((g for g, w in enumerate(_LATER, 1) if _means(w, n)), 0) for n in units]
    found: dict[str, int] = {}
    for group, word in enumerate([parameters] if isinstance(parameters, str) else parameters):
        meant = [n for n in units if n == word] or [n for n in units if _means(word, n)]
        if not meant:
            wrong = f"parameters: {nominal.NAME} has no deviation {word!r}: {suggestion(word, units)}"
            raise KinematicsError(Status.BAD_INPUT, wrong)
        for name in meant:
            found.setdefault(name, group)
    return list(found), list(found.values())


def _means(word: str, name: str) -> bool:
    """Whether a word stands for a deviation: `tilt` for `a2_tilt_x`, `a2` for all of that axis; `base` not for
    `base_radius`.
    """
    if word in ENDS:
        return name in {f"{word}_{k}" for k in "xyzabc"}
    return name.startswith(f"{word}_") or f"_{word}_" in name or name.endswith(f"_{word}")


def _vectors(rotations: Array) -> Array:
    """The rotation vectors (N, 3) of rotations (N, 3, 3)."""
    r = rotations
    sines = 0.5 * np.stack([r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]], axis=1)
    sine, cosine = np.linalg.norm(sines, axis=1), 0.5 * (np.trace(r, axis1=1, axis2=2) - 1.0)
    angle = np.arctan2(sine, cosine)
    found: Array = sines * np.where(sine > 1e-9, angle / np.where(sine > 1e-9, sine, 1.0), 1.0)[:, None]
    return found
