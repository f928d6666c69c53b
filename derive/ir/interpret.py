"""The reference interpreter: it executes a program over arrays, and defines every primitive."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import cache, partial
from operator import itemgetter

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.ir.cells import At
from derive.ir.constants import DEGREE, EDGE, PIVOT, SOLVABLE
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select, ToReal, Wrap
from derive.ir.program import Call, FindRoot, Iterate, Let, Program, Require, Solve, Statement, Status
from derive.ir.roots import nearest, nearest_listed
from derive.ir.symbols import PLACE, Flag, is_condition, is_count, is_decided
from derive.kept import kept_by_identity

Array = NDArray[np.float64]
_SHIFT = 180.0 + float(EDGE)


@dataclass
class Repeats:
    """How often the bodies of loops have run, for all rows together."""

    trials: int = 0
    """Trials of searches for a root."""
    finished: int = 0
    """Roots that were looked at."""
    passes: int = 0
    """Passes of iterations."""


_REPEATS: ContextVar[Repeats | None] = ContextVar("repeats", default=None)


@contextmanager
def repeats_counted() -> Iterator[Repeats]:
    """What runs inside is counted."""
    found = Repeats()
    token = _REPEATS.set(found)
    try:
        yield found
    finally:
        _REPEATS.reset(token)


def nearest_period(value: Array, centre: Array) -> Array:
    """value + 360 k in [centre - 180 - EDGE, centre + 180 - EDGE)."""
    return value - 360.0 * np.floor((value - centre + _SHIFT) / 360.0)


def wrap(angle: Array) -> Array:
    """The value of an angle in (-pi, pi]."""
    return np.asarray(angle - 2 * np.pi * np.ceil((angle - np.pi) / (2 * np.pi)))


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
    ToReal: lambda n: np.asarray(n, dtype=float),
    Wrap: wrap,
    NearestPeriod: nearest_period,
    NearestOnArc: nearest_on_arc,
    sp.Le: np.less_equal,
    sp.Lt: np.less,
    sp.Ge: np.greater_equal,
    sp.Gt: np.greater,
    sp.Eq: np.equal,
    sp.Ne: np.not_equal,
    sp.And: np.logical_and,
    sp.Or: np.logical_or,
    sp.Not: np.logical_not,
    sp.Add: np.add,
    sp.Mul: np.multiply,
    sp.Pow: np.power,
}
_Values = Mapping[str, Array]
_Evaluator = Callable[[_Values], Array]


def evaluate(expression: sp.Basic, values: Mapping[str, Array]) -> Array:
    """The value of an expression for arrays of its symbols."""
    return _evaluator(expression)(values)


@cache
def _evaluator(expression: sp.Basic) -> _Evaluator:
    """The expression as a function of the values of its symbols; cached, because expressions are evaluated often."""
    if isinstance(expression, sp.Symbol) and expression != DEGREE:
        return itemgetter(expression.name)
    if is_decided(expression):
        return _constant(expression == sp.true)
    if expression == DEGREE or isinstance(expression, sp.Number | sp.NumberSymbol):
        return _constant(np.pi / 180.0 if expression == DEGREE else float(expression))
    function, first, *others = _FUNCTIONS[type(expression)], *map(_evaluator, expression.args)
    if others and isinstance(expression, sp.Add | sp.Mul | sp.And | sp.Or):
        return _chained(function, first, others)
    if not others:
        return lambda values: function(first(values))
    return _of_two(function, first, others[0]) if len(others) == 1 else _of_more(function, first, others)


def _chained(function: Callable[..., Array], first: _Evaluator, others: Sequence[_Evaluator]) -> _Evaluator:
    """An operation from left to right."""
    if len(others) == 1:
        return _of_two(function, first, others[0])

    def chained(values: _Values) -> Array:
        result = first(values)
        for other in others:
            result = function(result, other(values))
        return result

    return chained


def _of_two(function: Callable[..., Array], one: _Evaluator, other: _Evaluator) -> _Evaluator:
    return lambda values: function(one(values), other(values))


def _of_more(function: Callable[..., Array], first: _Evaluator, others: Sequence[_Evaluator]) -> _Evaluator:
    return lambda values: function(first(values), *[other(values) for other in others])


def _constant(value: float | bool) -> Callable[[Mapping[str, Array]], Array]:
    array = np.asarray(value)
    array.setflags(write=False)
    return lambda _: array


def run(program: Program, values: Mapping[str, Array]) -> tuple[dict[str, Array], NDArray[np.object_]]:
    """Outputs and statuses of a program for arrays of inputs; outputs are meaningful where the status is OK."""
    known = {**values, **{s.name: _as_declared(values[s.name], s) for s in program.inputs if s.name in values}}
    shape = _common_shape(v.shape if isinstance(v, np.ndarray) else np.shape(v) for v in values.values())
    status = np.full(shape, Status.OK, dtype=object)
    with np.errstate(all="ignore"):
        _execute(program.body, known, status)
        outputs = {o.name: _broadcast(evaluate(o.value, known), shape) for o in program.outputs}
    return outputs, status


def _common_shape(all_shapes: Iterable[tuple[int, ...]]) -> tuple[int, ...]:
    """The shape of what is computed with values of these: at once where they have one, apart from plain numbers."""
    shapes = {*all_shapes} - {()}
    return np.broadcast_shapes(*shapes) if len(shapes) > 1 else next(iter(shapes), ())


def _broadcast(value: Array, shape: tuple[int, ...]) -> Array:
    """A value for every entry of a shape."""
    return np.asarray(value) if np.shape(value) == shape else np.broadcast_to(value, shape)


def _as_declared(value: Array, name: sp.Symbol | None) -> Array:
    """The value of an input in the type of its name: a flag may be given as 0 or 1, an integer as a real number."""
    return np.asarray(value, dtype=_declared(name))


@cache
def _declared(name: sp.Symbol | None) -> type:
    return bool if isinstance(name, Flag) else np.int64 if is_count(name) else float


_State = dict[str, Array]
_Statuses = NDArray[np.object_]
_Step = Callable[[_State, _Statuses], None]


def _execute(statements: Sequence[Statement], known: _State, status: _Statuses) -> None:
    for step in _steps(statements):
        step(known, status)


@kept_by_identity(2000)
def _steps(statements: Sequence[Statement]) -> list[_Step]:
    """Statements as functions that change what is known; kept, because programs run often."""
    return [_step(s) for s in statements]


def _step(statement: Statement) -> _Step:
    if isinstance(statement, Let):
        return _let(statement)
    if isinstance(statement, Require):
        condition, otherwise = _evaluator(statement.condition), statement.otherwise
        return lambda known, status: _require(condition(known), otherwise, status)
    if isinstance(statement, Solve):
        return lambda known, status: _solve(statement, known, status.shape)
    if isinstance(statement, Call):
        return partial(_call, statement)
    return partial(_find, statement) if isinstance(statement, FindRoot) else partial(_iterate, statement)


def _let(let: Let) -> _Step:
    name, value, declared, convert = let.name.name, _evaluator(let.value), _declared(let.name), np.asarray

    def bind(known: _State, _: _Statuses) -> None:
        known[name] = convert(value(known), declared)

    return bind


def _require(condition: Array, otherwise: Status, status: NDArray[np.object_]) -> None:
    if not np.all(condition):
        fails = np.logical_not(np.broadcast_to(condition, status.shape))
        status[fails & (status == Status.OK)] = otherwise


def _call(call: Call, known: dict[str, Array], status: NDArray[np.object_]) -> None:
    """Run a shared program with its arguments and constants; a row that it refuses gets its status."""
    inner = {s.name: known[s.name] for s in call.constants}
    inner |= {name.name: evaluate(value, known) for name, value in call.given}
    _execute(call.program.body, inner, status)
    outputs = {o.name: o.value for o in call.program.outputs}
    known.update({name.name: evaluate(outputs[name.name], inner) for name in call.names})


def _find(search: FindRoot, known: dict[str, Array], status: NDArray[np.object_]) -> None:
    """Find roots, only where they are wanted and nothing has refused before."""
    shape = status.shape
    looked = np.broadcast_to(evaluate(search.wanted, known), shape) & (status == Status.OK)
    rows = {k: np.broadcast_to(v, shape)[looked] for k, v in known.items()}
    places = [s.name for s in PLACE]
    read = {p.name: [s.name for s in p.inputs if s.name not in places] for p in (search.trial, search.finish)}
    counted = _REPEATS.get() or Repeats()

    def at(program: Program, place: At) -> list[Array]:
        if not len(place.rows):
            return [np.zeros(0, dtype=bool if is_condition(o.value) else float) for o in program.outputs]
        there = {name: rows[name][place.rows] for name in read[program.name]}
        outputs, _ = run(program, there | dict(zip(places, place[1:], strict=True)))
        return [np.broadcast_to(outputs[o.name], place.joint.shape) for o in program.outputs]

    def tried(place: At) -> Array:
        counted.trials += len(place.rows)
        return np.stack(at(search.trial, place), axis=1)

    def finished(place: At) -> tuple[NDArray[np.bool_], Array]:
        counted.finished += len(place.rows)
        fits, *values = at(search.finish, place)
        return np.asarray(fits, dtype=bool), np.stack(values, axis=1)

    def listed() -> list[tuple[Array, NDArray[np.bool_], int]]:
        counted.trials += len(start)
        outputs, _ = run(search.trial, {name: rows[name] for name in read[search.trial.name]})
        joints, offered = ([np.broadcast_to(v, start.shape) for v in [*outputs.values()][k::2]] for k in (0, 1))
        return [(j, o.astype(np.bool_), s) for j, o, s in zip(joints, offered, search.sides, strict=True)]

    start = np.broadcast_to(evaluate(search.start, known), shape)[looked]
    if search.is_listed:
        found, values = nearest_listed(listed(), finished, start)
    else:
        found, values = nearest(tried, finished, start)
    for name, column in zip(search.names, (found, *values.T), strict=True):
        known[name.name] = np.zeros(shape, dtype=column.dtype)
        known[name.name][looked] = column


def _iterate(loop: Iterate, known: dict[str, Array], status: NDArray[np.object_]) -> None:
    """Run a loop: rows that are done keep their state and the names of the step, while the others go on."""
    start = [_as_declared(evaluate(value, known), name) for name, value in zip(loop.state, loop.start, strict=True)]
    known.update(zip((name.name for name in loop.state), start, strict=True))
    done = np.zeros(status.shape, dtype=bool)
    counted = _REPEATS.get() or Repeats()
    for _ in range(loop.limit):
        counted.passes += int(np.sum(~done & (status == Status.OK)))
        _execute(loop.step, known, status)
        done = np.broadcast_to(evaluate(loop.done, known), status.shape)
        if np.all(done | (status != Status.OK)):
            break
        following = [_as_declared(evaluate(v, known), n) for n, v in zip(loop.state, loop.following, strict=True)]
        known.update({n.name: np.where(done, known[n.name], v) for n, v in zip(loop.state, following, strict=True)})
    _require(done, loop.otherwise, status)


def _solve(system: Solve, known: dict[str, Array], shape: tuple[int, ...]) -> None:
    matrix, right = (
        np.array([np.broadcast_to(evaluate(e, known), shape) for e in entries], dtype=float).reshape(
            system.size, -1, *shape
        )
        for entries in (system.matrix, system.right)
    )
    determinant, solution = solve(matrix, right)
    known.update(zip((n.name for n in system.names), solution.reshape(-1, *shape), strict=True))
    if system.determinant is not None:
        known[system.determinant.name] = determinant


def solve(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Determinant and solution by LU decomposition with partial pivoting: rows, columns, then any shape. Unsolvable:
    zeros.
    """
    matrix, right, size = matrix.copy(), right.copy(), len(matrix)
    largest, most = np.max(np.abs(matrix), axis=(0, 1)), float(SOLVABLE)
    tiny = float(PIVOT) * largest
    regular = (largest >= 1.0 / most) & (largest <= most) & np.all(np.abs(right) <= most, axis=(0, 1))
    determinant = np.ones(matrix.shape[2:])
    for k in range(size):
        best = k + np.argmax(np.abs(matrix[k:, k]), axis=0)
        for table in (matrix, right):
            table[k], lifted = np.take_along_axis(table, best[None, None], axis=0)[0], table[k].copy()
            np.put_along_axis(table, np.broadcast_to(best[None, None], (1, *lifted.shape)), lifted[None], axis=0)
        determinant = np.where(best == k, determinant, -determinant) * matrix[k, k]
        regular &= np.abs(matrix[k, k]) > tiny
        matrix[k, k] = 1.0 / np.where(regular, matrix[k, k], 1.0)
        for i in range(k + 1, size):
            factor = matrix[i, k] * matrix[k, k]
            matrix[i, k + 1 :] -= factor * matrix[k, k + 1 :]
            right[i] -= factor * right[k]
    for k in reversed(range(size)):
        for i in range(k + 1, size):
            right[k] -= matrix[k, i] * right[i]
        right[k] *= matrix[k, k]
    return np.where(regular, determinant, 0.0), np.where(regular, right, 0.0)
