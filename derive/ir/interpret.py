"""The reference interpreter: it executes a program over arrays. `primitives` defines the primitives on arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache, partial
from itertools import groupby
from math import prod
from operator import itemgetter

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.ir.constants import DEGREE
from derive.ir.one_row import Refused, Repeats, function_of
from derive.ir.primitives import solve
from derive.ir.program import Call, Iterate, Let, Program, Require, Solve, Statement, Status
from derive.ir.python_text import ARRAYS, Expressions, declared
from derive.kept import kept_by_identity
from derive.work import spend_steps

Array = NDArray[np.float64]
FEW, FEW_OF_A_LOOP = 8, 150
"""So many rows run one by one, which takes less time; of a program that iterates each row then ends by itself."""


_REPEATS: ContextVar[Repeats | None] = ContextVar("repeats", default=None)


@contextmanager
def repeats_counted() -> Iterator[Repeats]:
    """A context in which the repeated bodies of loops are counted."""
    found = Repeats()
    token = _REPEATS.set(found)
    try:
        yield found
    finally:
        _REPEATS.reset(token)


_Evaluator = Callable[..., Array]


def evaluate(expression: sp.Basic, values: Mapping[str, Array]) -> Array:
    """The value of an expression for arrays of its symbols."""
    return _evaluator(expression)(values)


@cache
def _evaluator(expression: sp.Basic) -> _Evaluator:
    """The expression as a function of the values of its symbols; cached, because expressions are evaluated often."""
    if isinstance(expression, sp.Symbol) and expression != DEGREE:
        return itemgetter(expression.name)
    return _compiled((), expression)


def _compiled(lets: Sequence[Let], result: sp.Basic = sp.S.Zero) -> _Evaluator:
    """Assignments as a function that updates the known values, and gives a further one."""
    writer = Expressions(ARRAYS, {"asarray": np.asarray})
    lines, bound = ["def function(known, status=None):"], set[sp.Symbol]()
    for let in lets:
        lines += _read(writer, let.value.free_symbols - bound)
        value = f"asarray({writer.text(let.value)}, {declared(let.name).__name__})"
        lines += [*writer.before("    "), f"    known[{let.name.name!r}] = {writer.name(let.name)} = {value}"]
        bound |= let.value.free_symbols | {let.name}
    lines += _read(writer, result.free_symbols - bound)
    value = f"asarray({writer.text(result)})"
    return writer.executed([*lines, *writer.before("    "), f"    return {value}"], "<arrays>")


def _read(writer: Expressions, names: Iterable[sp.Basic]) -> list[str]:
    own = sorted((n for n in names if isinstance(n, sp.Symbol) and n != DEGREE), key=str)
    return [f"    {writer.name(name)} = known[{name.name!r}]" for name in own]


def run(program: Program, values: Mapping[str, Array]) -> tuple[dict[str, Array], NDArray[np.object_]]:
    """Outputs and statuses of a program for arrays of inputs; outputs are meaningful where the status is OK."""
    known = {**values, **{s.name: _as_declared(values[s.name], s) for s in program.inputs if s.name in values}}
    shape = _common_shape(v.shape if isinstance(v, np.ndarray) else np.shape(v) for v in values.values())
    if _iterates(program) and _is_run_by_rows(program, prod(shape)):
        return _one_by_one(program, known, shape)
    status = np.full(shape, Status.OK, dtype=object)
    with np.errstate(all="ignore"):
        _execute(program.body, known, status)
        outputs = {o.name: _broadcast(evaluate(o.value, known), shape) for o in program.outputs}
    return outputs, status


@kept_by_identity(500)
def _iterates(program: Program) -> bool:
    return any(isinstance(s, Iterate) for s in program.body) or any(_iterates(c.program) for c in program.calls())


def _is_run_by_rows(program: Program, rows: int) -> bool:
    return 0 < rows <= FEW or 0 < rows <= FEW_OF_A_LOOP and _iterates(program)


def _one_by_one(
    program: Program, known: Mapping[str, Array], shape: tuple[int, ...]
) -> tuple[dict[str, Array], NDArray[np.object_]]:
    """As `run`, row by row."""
    function, counted = function_of(program), _REPEATS.get() or Repeats()
    inputs = [_broadcast(known[s.name], shape).ravel().tolist() for s in program.inputs]
    status = np.full(prod(shape), Status.OK, dtype=object)
    found: list[tuple[float, ...] | None] = []
    with np.errstate(all="ignore"):
        for k in range(status.size):
            before = counted.steps
            try:
                found.append(function(counted, *(column[k] for column in inputs)))
            except Refused as refusal:
                status[k] = refusal.args[0]
                found.append(None)
            spend_steps((counted.steps - before) // FEW, 1)
    outputs = {}
    for place, output in enumerate(program.outputs):
        answers = np.array([row[place] for row in found if row is not None])
        outputs[output.name] = np.zeros(status.size, answers.dtype)
        outputs[output.name][status == Status.OK] = answers
    return {name: values.reshape(shape) for name, values in outputs.items()}, status.reshape(shape)


def _common_shape(all_shapes: Iterable[tuple[int, ...]]) -> tuple[int, ...]:
    """The common shape of values with these shapes; found quickly where all but plain numbers have the same one."""
    shapes = {*all_shapes} - {()}
    return np.broadcast_shapes(*shapes) if len(shapes) > 1 else next(iter(shapes), ())


def _broadcast(value: Array, shape: tuple[int, ...]) -> Array:
    """The value repeated for every entry of a shape."""
    return np.asarray(value) if np.shape(value) == shape else np.broadcast_to(value, shape)


def _as_declared(value: Array, name: sp.Symbol | None) -> Array:
    """The value of an input in the type of its name: a flag may be given as 0 or 1, an integer as a real number."""
    return np.asarray(value, dtype=declared(name))


_State = dict[str, Array]
_Statuses = NDArray[np.object_]
_Step = Callable[[_State, _Statuses], object]


def _execute(statements: Sequence[Statement], known: _State, status: _Statuses) -> None:
    spend_steps(len(statements), status.size)
    for step in _steps(statements):
        step(known, status)


@kept_by_identity(2000)
def _steps(statements: Sequence[Statement]) -> list[_Step]:
    """Statements as functions that update the known values; cached, because programs run often."""
    steps: list[_Step] = []
    for is_let, some in groupby(statements, lambda s: isinstance(s, Let)):
        own = list(some)
        steps += [_compiled([s for s in own if isinstance(s, Let)])] if is_let else map(_step, own)
    return steps


def _step(statement: Statement) -> _Step:
    if isinstance(statement, Require):
        condition, otherwise = _evaluator(statement.condition), statement.otherwise
        return lambda known, status: _require(condition(known), otherwise, status)
    if isinstance(statement, Solve):
        return _system(statement)
    if isinstance(statement, Call):
        return partial(_call, statement)
    assert isinstance(statement, Iterate)
    return _loop(statement)


def _require(condition: Array, otherwise: Status | None, status: NDArray[np.object_]) -> None:
    if not np.all(condition):
        fails = np.logical_not(np.broadcast_to(condition, status.shape))
        status[fails & (status == Status.OK)] = otherwise or Status.OK


def _call(call: Call, known: dict[str, Array], status: NDArray[np.object_]) -> None:
    """Run a shared program in rows where it is wanted and nothing has refused; a refused row has its status."""
    wanted = _broadcast(evaluate(call.wanted, known), status.shape) & (status == Status.OK)
    rows, own = (wanted, status[wanted]) if call.is_conditional else (..., status)
    counted = _REPEATS.get() or Repeats()
    counted.runs[call.program.name] += own.size
    given = {s.name: known[s.name] for s in call.constants} | {n.name: evaluate(v, known) for n, v in call.given}
    inner = {name: _broadcast(value, status.shape)[rows] for name, value in given.items()}
    outputs, own = _outputs(call.program, inner, own)
    status[rows] = own if call.refusal is None else [s if s is Status.OK else call.refusal[0] for s in own]
    for name in call.names:
        known[name.name] = np.zeros(status.shape, declared(name))
        known[name.name][rows] = outputs[name.name] if own.size else 0.0


def _outputs(program: Program, known: dict[str, Array], status: _Statuses) -> tuple[dict[str, Array], _Statuses]:
    """The outputs and the statuses of a program that is called."""
    if _is_run_by_rows(program, status.size):
        outputs, own = _one_by_one(program, known, status.shape)
        return outputs, np.where(status == Status.OK, own, status)
    _execute(program.body if status.size else (), known, status)
    return {o.name: evaluate(o.value, known) for o in program.outputs if status.size}, status


def _loop(loop: Iterate) -> _Step:
    """Run a loop: rows that are done keep their state and the names of the step, while the others go on."""
    is_done, names, step = _evaluator(loop.done), [name.name for name in loop.state], _step_of(loop)
    starts, followings = (
        [(_evaluator(value), declared(name)) for name, value in zip(loop.state, values, strict=True)]
        for values in (loop.start, loop.following)
    )

    def iterate(known: _State, status: _Statuses) -> None:
        start: list[Array] = [np.asarray(value(known), declared) for value, declared in starts]
        known.update(zip(names, start, strict=True))
        done = np.zeros(status.shape, dtype=bool)
        counted = _REPEATS.get() or Repeats()
        for _ in range(loop.limit):
            going = ~done & (status == Status.OK)
            counted.passes[loop.note] += int(np.sum(going))
            step(known, status, going)
            done = _broadcast(is_done(known), status.shape)
            if np.all(done | (status != Status.OK)):
                break
            following: list[Array] = [np.asarray(value(known), declared) for value, declared in followings]
            known.update({n: np.where(done, known[n], v) for n, v in zip(names, following, strict=True)})
        _require(done, loop.otherwise, status)

    return iterate


def _step_of(loop: Iterate) -> Callable[[_State, _Statuses, NDArray[np.bool_]], None]:
    """One pass. If the step runs other programs, they run only in the rows that go on."""
    if not loop.calls():
        return lambda known, status, _: _execute(loop.step, known, status)
    bound = [name for s in loop.step for name in s.bound()]
    read = {name.name for s in loop.step for name in s.reads().difference(bound, {DEGREE})}

    def one_pass(known: _State, status: _Statuses, going: NDArray[np.bool_]) -> None:
        inner, own = {name: _broadcast(known[name], status.shape)[going] for name in read}, status[going]
        for name in bound:
            known.setdefault(name.name, np.zeros(status.shape, declared(name)))
        if own.size:
            _execute(loop.step, inner, own)
            status[going] = own
            for name in bound:
                known[name.name][going] = inner[name.name]

    return one_pass


def _system(system: Solve) -> _Step:
    tables = [[_evaluator(e) for e in entries] for entries in (system.matrix, system.right)]

    def bind(known: _State, status: _Statuses) -> None:
        matrix, right = (_table(entries, known, system.size, status.shape) for entries in tables)
        determinant, solution = solve(matrix, right)
        known.update(zip((n.name for n in system.names), solution.reshape(-1, *status.shape), strict=True))
        if system.determinant is not None:
            known[system.determinant.name] = determinant

    return bind


def _table(entries: Sequence[_Evaluator], known: _State, rows: int, shape: tuple[int, ...]) -> Array:
    """Entries by rows: rows, columns, then the shape."""
    found = np.empty((len(entries), *shape))
    for place, entry in enumerate(entries):
        found[place] = entry(known)
    return found.reshape(rows, len(entries) // rows, *shape)
