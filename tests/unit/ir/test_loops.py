"""`Solve` and `Iterate`: their semantics, their verification, and equal answers in every language."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from numpy.testing import assert_allclose
from softkin import _array, _scalar

from derive.ir.interpret import run
from derive.ir.passes import hoist, normalise
from derive.ir.primitives import solve
from derive.ir.program import Iterate, Let, Output, Program, Require, Solve, Status
from derive.ir.symbols import real
from derive.ir.verify import BrokenProgram, verify
from tests.text.units import compiled_shared

A, B, X, Y, STEP = map(real, ("a", "b", "x", "y", "step"))


def square_root(limit: int = 20) -> Program:
    """Heron's method for the square root of a; a negative one has none."""
    loop = Iterate(
        state=(X,),
        start=(sp.Integer(1),),
        step=(Let(STEP, (A - X**2) / (2 * X)),),
        following=(X + STEP,),
        done=sp.Le(sp.Abs(STEP), sp.Float("1e-12")),
        limit=limit,
        otherwise=Status.IMPOSSIBLE,
    )
    return normalise("heron", (loop,), [Output("x", X), Output("step", STEP)])


def test_every_row_iterates_until_it_is_done() -> None:
    """Every row iterates until it converges, or is refused after the most passes."""
    values = np.array([1.0, 2.0, 1e15, -1.0, np.nan])
    outputs, status = run(square_root(), {"a": values})
    assert list(status) == [Status.OK] * 2 + [Status.IMPOSSIBLE] * 3  # 1e15 is too far away
    assert_allclose(outputs["x"][:2], np.sqrt(values[:2]), rtol=1e-15)


def test_a_row_gets_the_same_answer_in_any_company() -> None:
    """The result of a row does not depend on the other rows."""
    values = np.array([1.0, 2.0, 50.0, -1.0])
    together, _ = run(square_root(), {"a": values})
    for i, value in enumerate(values):
        alone, _ = run(square_root(), {"a": np.array([value])})
        assert i == 3 or alone["x"][0] == together["x"][i]


def test_a_status_that_was_there_first_stays() -> None:
    """A row that was refused before the iteration keeps its status."""
    program = square_root()
    guarded = verify(replace(program, body=(Require(sp.Gt(A, 0), Status.BAD_INPUT), *program.body)))
    _, status = run(guarded, {"a": np.array([-1.0, 4.0])})
    assert list(status) == [Status.BAD_INPUT, Status.OK]


def test_the_limit_counts_passes() -> None:
    """The limit of an iteration is the number of its passes."""
    assert run(square_root(1), {"a": np.array(1.0)})[1] == Status.OK
    assert run(square_root(1), {"a": np.array(2.0)})[1] == Status.IMPOSSIBLE


def test_passes_see_into_a_loop() -> None:
    """An alias is folded inside; a constant outside is hoisted; what only the loop needs stands before it."""
    loop = square_root().body[0]
    assert isinstance(loop, Iterate)
    alias = replace(loop, step=(Let(Y, B), Let(STEP, (A - Y * X**2) / (2 * X))))
    program = normalise("p", (Let(B, A**2), alias), [Output("x", X)])
    assert [type(s) for s in program.body] == [Let, Iterate]
    (lowered,), hoisted = hoist([program], ["a"])
    assert [h.name for h in hoisted] == [B] and [type(s) for s in lowered.body] == [Iterate]


def test_the_verifier_refuses() -> None:
    """An iteration with wrong names, counts or equations is refused."""
    (loop,) = square_root().body
    assert isinstance(loop, Iterate)
    two = replace(loop, state=(X, Y), start=(A, A), following=(X + STEP, X))
    odd = Solve((X,), (A, A, A), (B,))
    for broken, word in (
        (two, "may have been assigned"),
        (replace(loop, following=()), "as many"),
        (replace(loop, done=sp.Le(Y, 1)), "before it is bound"),
        (odd, "fit together"),
    ):
        with pytest.raises(BrokenProgram, match=word):
            verify(Program("p", (A, B), (broken,), ()))


def systems(size: int, columns: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    generator = np.random.default_rng(10 * size + columns)
    matrix = generator.normal(size=(size, size, count))
    matrix[0, 0, ::3] = 0.0  # pivots are needed
    matrix[-1, :, ::7] = 0.0 if size == 1 else matrix[0, :, ::7]  # singular
    return matrix, generator.normal(size=(size, columns, count))


@pytest.mark.parametrize(("size", "columns"), [(1, 1), (2, 3), (3, 0), (6, 1), (6, 6)])
def test_systems_in_every_language(size: int, columns: int) -> None:
    """Linear systems have the determinant and the solution of NumPy, and zeros where they are singular."""
    matrix, right = systems(size, columns, 42)
    determinant, solution = solve(matrix, right)
    singular = np.arange(42) % 7 == 0 if size > 1 else np.abs(matrix[0, 0]) == 0
    wanted = np.linalg.det(np.moveaxis(matrix, 2, 0))
    assert_allclose(determinant, np.where(singular, 0.0, wanted), rtol=1e-10, atol=1e-13)
    assert not determinant[singular].any() and not solution[..., singular].any()
    residual = np.einsum("ijn,jkn->ikn", matrix, solution) - right
    assert_allclose(residual[..., ~singular], 0.0, atol=1e-9)
    batch = _array.solve(tuple(tuple(row) for row in matrix), tuple(tuple(row) for row in right) if columns else ())
    assert np.array_equal(batch[0], determinant)
    assert np.array_equal(np.array(batch[1:]).reshape(solution.shape), solution)
    for n in range(42):
        alone = solve(matrix[..., n : n + 1], right[..., n : n + 1])  # a few are solved another way than many
        assert alone[0] == determinant[n] and np.array_equal(alone[1][..., 0], solution[..., n])
        rows, sides = matrix[..., n].tolist(), right[..., n].tolist()
        answer = _scalar.solve(rows, sides if columns else ())
        assert answer[0] == determinant[n] and np.array_equal(np.array(answer[1:]), solution[..., n].ravel())
        assert controller(rows, sides) == (determinant[n], solution[..., n].ravel().tolist())


def controller(rows: list[list[float]], sides: list[list[float]]) -> tuple[float, list[float]]:
    """Softkin_Solve, with its arrays of six by six."""
    matrix, right = [np.nan] * 36, [np.nan] * 36
    for i, (row, side) in enumerate(zip(rows, sides, strict=True)):
        matrix[6 * i : 6 * i + len(row)] = row
        right[6 * i : 6 * i + len(side)] = side
    call = compiled_shared().function("Softkin_Solve")
    determinant = call(aMatrix=matrix, aRight=right, iSize=len(rows), iColumns=len(sides[0]))
    return determinant, [v for i, side in enumerate(sides) for v in right[6 * i : 6 * i + len(side)]]
