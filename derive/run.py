"""Execute a program over arrays: the reference semantics of every primitive, and what the checks run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.program import (
    DEGREE,
    EDGE,
    Atan2,
    Let,
    NearestOnArc,
    NearestPeriod,
    Program,
    Root,
    Select,
    Status,
)

Array = NDArray[np.float64]
_SHIFT = 180.0 + float(EDGE)


def nearest_period(value: Array, centre: Array) -> Array:
    """value + 360 k in [centre - 180 - EDGE, centre + 180 - EDGE)."""
    return value - 360.0 * np.floor((value - centre + _SHIFT) / 360.0)


def nearest_on_arc(angle: Array, centre: Array, half: Array) -> Array:
    """The angle of the arc centre ± half nearest to `angle`, counted from the centre."""
    delta = angle - centre - 2 * np.pi * np.floor((angle - centre + np.pi) / (2 * np.pi))
    return centre + np.clip(delta, -half, half)


_FUNCTIONS: dict[type[sp.Basic], Callable[..., Array]] = {
    sp.sin: np.sin,
    sp.cos: np.cos,
    sp.Abs: np.abs,
    Root: lambda x: np.sqrt(np.maximum(x, 0.0)),
    Atan2: lambda y, x: np.arctan2(y + 0.0, x + 0.0),  # a zero has no sign
    Select: np.where,
    NearestPeriod: nearest_period,
    NearestOnArc: nearest_on_arc,
    sp.Le: np.less_equal,
    sp.Lt: np.less,
    sp.Ge: np.greater_equal,
    sp.Gt: np.greater,
    sp.And: lambda *c: reduce(np.logical_and, c),
    sp.Or: lambda *c: reduce(np.logical_or, c),
    sp.Add: lambda *t: reduce(np.add, t),
    sp.Mul: lambda *t: reduce(np.multiply, t),
    sp.Pow: lambda b, e: np.power(b, e),
}


def evaluate(expression: sp.Basic, values: Mapping[str, Array]) -> Array:
    """The value of an expression for arrays of its symbols."""
    if isinstance(expression, sp.Symbol):
        return np.asarray(np.pi / 180.0) if expression == DEGREE else values[expression.name]
    if expression in (sp.true, sp.false):
        return np.asarray(expression == sp.true)
    if isinstance(expression, sp.Number | sp.NumberSymbol):
        return np.asarray(float(expression))
    arguments = [evaluate(a, values) for a in expression.args]
    return _FUNCTIONS[type(expression)](*arguments)


def run(program: Program, values: Mapping[str, Array]) -> tuple[dict[str, Array], NDArray[np.object_]]:
    """Outputs and statuses of a program for arrays of inputs; outputs are meaningful where the status is OK."""
    known: dict[str, Array] = {k: np.asarray(v, dtype=float) for k, v in values.items()}
    shape = np.broadcast_shapes(*(v.shape for v in known.values())) if known else ()
    status = np.full(shape, Status.OK, dtype=object)
    with np.errstate(all="ignore"):
        for statement in program.body:
            if isinstance(statement, Let):
                known[statement.name.name] = evaluate(statement.value, known)
            else:
                fails = np.logical_not(np.broadcast_to(evaluate(statement.condition, known), shape))
                status[fails & (status == Status.OK)] = statement.otherwise
        outputs = {o.name: np.broadcast_to(evaluate(o.value, known), shape) for o in program.outputs}
    return outputs, status
