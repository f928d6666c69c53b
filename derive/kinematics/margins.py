"""The singularity margins: their product, with integer exponents, is the determinant of the Jacobian."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import DescriptionError, Mechanism
from derive.equations.problem import Conditioning
from derive.ir.constants import COINCIDENT
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Select
from derive.ir.program import Let, Output, Program, Statement, Status
from derive.ir.symbols import SCALE, real
from derive.kinematics.branches.assignment import Assignment
from derive.kinematics.differential import is_of_length, jacobian_rows
from derive.kinematics.kinematics import Margin
from derive.kinematics.parameters import has_length
from derive.kinematics.sampling import ENOUGH, possible_axes, sample_machine, size_of
from derive.work import stage

_EXACT = 1e-6
"""The largest difference between the logarithms of equal products."""


_DIGITS = 1e-6
"""The determinant of a Jacobian has digits where its least singular value is at least this share of its largest."""


@stage("the distance from singular poses")
def singularity_program(
    mechanism: Mechanism,
    statements: Sequence[Statement],
    factors: Sequence[Factor],
    jacobian: Program,
    samples: Mapping[str, NDArray[np.float64]],
) -> tuple[Program, tuple[Margin, ...]]:
    """The margins whose product, with integer exponents, is the determinant of the Jacobian: found at the samples."""
    lets = [let for f in factors for let in f.lets]
    lengths = {f.name: Output(f"length_{f.name}", f.lets[0].name) for f in factors if f.is_length}
    output_of = {f.name: Output(f.name, f.lets[-1].name) for f in factors}
    outputs = [lengths.get(f.name, output_of[f.name]) for f in factors]
    if not mechanism.joints:
        return normalise("singularity", statements, []), ()
    draft = normalise("singularity", (*statements, *lets), outputs)
    exponents = _exponents(mechanism, draft, jacobian, samples)
    kept = [(f.name, e) for f, e in zip(factors, exponents, strict=True) if e != 0]
    shown = [o for name, _ in kept for o in (output_of[name], *([lengths[name]] if name in lengths else []))]
    program = normalise("singularity", (*statements, *lets), shown)
    of_length = {name: output.name for name, output in lengths.items()}
    return program, tuple(Margin(n, e, "type 1" if e > 0 else "type 2", of_length.get(n)) for n, e in kept)


def samples_anywhere(mechanism: Mechanism, program: Program) -> dict[str, NDArray[np.float64]]:
    """One machine with axis values over its whole range, of which a program accepts at least some."""
    return possible_axes(mechanism, sample_machine(mechanism, 11), 64, 12, program)


def _exponents(
    mechanism: Mechanism, margins: Program, jacobian: Program, samples: Mapping[str, NDArray[np.float64]]
) -> list[int]:
    """Fit log|det J| = c + Σ e_k log|m_k| over poses of one machine; the e_k must be integers and the fit exact.

    Lengths are measured in lengths of the machine, which changes only c, so that the unit of length has no influence.
    """
    count = max(v.size for v in samples.values())
    values, status = run(margins, samples)
    good = np.broadcast_to(status == Status.OK, (count,))
    matrix = _scaled_jacobian(mechanism, jacobian, samples, count)[good]
    volume, clear = _log_volume(matrix)
    logs = [np.log(np.abs(np.broadcast_to(values[o.name], (count,))[good]))[clear] for o in margins.outputs]
    own = _independent(logs)
    design = np.stack([*(logs[k] for k in own), np.ones_like(volume)], axis=-1)
    solution, *_ = np.linalg.lstsq(design, volume, rcond=None)
    found = dict(zip(own, (int(round(e)) for e in solution[:-1]), strict=True))
    exponents = [found.get(k, 0) for k in range(len(logs))]
    fitted = sum((e * log for e, log in zip(exponents, logs, strict=True)), np.zeros_like(volume))
    spread = float(np.ptp(volume - fitted)) if volume.size else 0.0
    if spread > _EXACT:
        names = ", ".join(o.name for o in margins.outputs)
        raise DescriptionError(f"the margins {names} do not multiply to the determinant of the Jacobian")
    return exponents


def _scaled_jacobian(
    mechanism: Mechanism, jacobian: Program, samples: Mapping[str, NDArray[np.float64]], count: int
) -> NDArray[np.float64]:
    """The Jacobian by the joints that are solved for, with lengths in lengths of the machine."""
    entries, _ = run(jacobian, samples)
    rows, columns = jacobian_rows(mechanism), mechanism.joints
    flat = np.stack([np.broadcast_to(v, (count,)) for v in entries.values()], axis=-1)
    size = size_of(mechanism, samples)
    by_rows = np.array([1.0 / size if is_of_length(row) else 1.0 for row in rows])
    by_columns = np.array([1.0 if j.axis_is_angle else size for j in columns])
    matrix = flat.reshape(count, len(rows), len(columns)) * by_rows[:, None] * by_columns
    return np.asarray(matrix[:, :, [j in mechanism.solved_joints for j in columns]])


def _log_volume(matrix: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """The logarithm of |det J| at the poses where it has enough digits for the fit, and which these are."""
    sizes = np.linalg.svd(matrix, compute_uv=False)
    share = sizes[:, -1] / np.where(sizes[:, 0] > 0, sizes[:, 0], 1.0)
    best = np.sort(share)[-min(len(share), ENOUGH) :]
    clear = share >= min(_DIGITS, best[0]) if len(best) else np.zeros(0, dtype=bool)
    return np.linalg.slogdet(matrix[clear])[1], clear


def _independent(logs: Sequence[NDArray[np.float64]]) -> list[int]:
    """The margins that are no product of earlier ones: the conditioning of a two-root step is the absolute value of its
    determinant.
    """
    own: list[int] = []
    for k in range(len(logs)):
        columns = np.stack([logs[i] for i in (*own, k)] + [np.ones_like(logs[k])], axis=-1)
        if np.linalg.matrix_rank(columns, tol=1e-6) == len(own) + 2:
            own.append(k)
    return own


@dataclass(frozen=True)
class Factor:
    """A candidate for a margin: the determinant or the conditioning of a step over its scale, at axis values."""

    name: str
    value: sp.Expr
    is_length: bool = False
    """Whether it is in the user's unit of length, because the machine has no length to divide it by."""
    is_signed: bool = True

    @property
    def lets(self) -> tuple[Let, ...]:
        """The margin; for a length, 1 where it determines the axis and 0 where it does not."""
        margin = real(f"margin_{self.name}")
        if not self.is_length:
            return (Let(margin, self.value),)
        length = real(f"length_{self.name}")
        other = Select(sp.Lt(length, -COINCIDENT), sp.Integer(-1), sp.Integer(0)) if self.is_signed else sp.Integer(0)
        value = Select(sp.Gt(length, COINCIDENT), sp.Integer(1), other)
        return Let(length, self.value), Let(margin, value, "0 where no equation determines the axis, else 1 or -1")


def factor_of(mechanism: Mechanism, found: Assignment | Conditioning) -> Factor:
    """The determinant of a branch, or the conditioning of a step, over its scale."""
    has_unit = not has_length(mechanism)
    if isinstance(found, Assignment):
        return Factor(found.branch.margin, found.margin(mechanism), has_unit and found.determinant.scale.has(SCALE))
    return Factor(found.name, found.value / found.scale, has_unit and found.scale.has(SCALE), is_signed=False)
