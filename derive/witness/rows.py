"""CasADi functions over rows of samples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from derive.ir.interpret import Array
from derive.witness.terms import Term
from derive.work import STEPS, spend

_TOGETHER = 64
"""Rows that a CasADi function takes at a time."""
_AS_LONG = 20
"""So many instructions of it, for these rows, take about as long as one step of a program."""


class Rows:
    """A CasADi function over rows of samples: (samples, size) arrays in, (samples, rows, columns) out."""

    def __init__(self, name: str, arguments: tuple[Term, ...], result: Term) -> None:
        self._shape = result.shape
        self._function = ca.Function(name, arguments, [ca.densify(result)])
        self._steps = 1 + self._function.n_instructions() // _AS_LONG
        self._buffer: Any = None

    def __call__(self, *columns: Array) -> Array:
        rows, width = self._shape
        result = np.empty((len(columns[0]), width, rows))  # CasADi stores by columns
        if result.size:
            given = [np.ascontiguousarray(c, dtype=float) for c in columns]
            spend(-(-len(result) // _TOGETHER) * self._steps, STEPS)
            whole = len(result) - len(result) % _TOGETHER
            for first in range(0, whole, _TOGETHER):
                self._run([c[first : first + _TOGETHER] for c in given], result[first : first + _TOGETHER])
            if whole < len(result):
                last = np.empty((_TOGETHER, width, rows))
                self._run([_filled(c[whole:]) for c in given], last)
                result[whole:] = last[: len(result) - whole]
        return np.swapaxes(result, 1, 2)

    def _run(self, given: Sequence[Array], result: Array) -> None:
        if self._buffer is None:
            self._buffer = self._function.map(_TOGETHER).buffer()
        buffer, run = self._buffer
        for place, rows_of_samples in enumerate(given):
            if rows_of_samples.size:
                buffer.set_arg(place, rows_of_samples.data)
        buffer.set_res(0, result.data)
        run()


def _filled(rows: Array) -> Array:
    """So many rows as CasADi takes at a time: the first once more where there are fewer."""
    return np.concatenate([rows, np.repeat(rows[:1], _TOGETHER - len(rows), axis=0)])
