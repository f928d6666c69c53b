"""`Call`, `Solve` and `Iterate`: their semantics, their verification, and equal answers in every language."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from numpy.testing import assert_allclose
from softkin import _array, _scalar

from derive.ir.interpret import run
from derive.ir.passes import hoist, normalise
from derive.ir.primitives import Root, solve
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Solve, Status, shared
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import flag, real
from derive.ir.verify import BrokenProgram, verify
from tests.text.units import compiled_shared

A, B, X, Y, STEP, C, K, Q, W = map(real, ("a", "b", "x", "y", "step", "c", "k", "q", "w"))


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
    values = np.array([1.0, 2.0, 1e15, -1.0, np.nan])
    outputs, status = run(square_root(), {"a": values})
    assert list(status) == [Status.OK] * 2 + [Status.IMPOSSIBLE] * 3  # 1e15 is too far away
    assert_allclose(outputs["x"][:2], np.sqrt(values[:2]), rtol=1e-15)


def test_a_row_gets_the_same_answer_in_any_company() -> None:
    values = np.array([1.0, 2.0, 50.0, -1.0])
    together, _ = run(square_root(), {"a": values})
    for i, value in enumerate(values):
        alone, _ = run(square_root(), {"a": np.array([value])})
        assert i == 3 or alone["x"][0] == together["x"][i]


def test_a_status_that_was_there_first_stays() -> None:
    program = square_root()
    guarded = verify(replace(program, body=(Require(sp.Gt(A, 0), Status.BAD_INPUT), *program.body)))
    _, status = run(guarded, {"a": np.array([-1.0, 4.0])})
    assert list(status) == [Status.BAD_INPUT, Status.OK]


def test_the_limit_counts_passes() -> None:
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
    matrix, right = [np.nan] * 36, [np.nan] * 36
    for i, (row, side) in enumerate(zip(rows, sides, strict=True)):
        matrix[6 * i : 6 * i + len(row)] = row
        right[6 * i : 6 * i + len(side)] = side
    call = compiled_shared().function("Softkin_Solve")
    determinant = call(aMatrix=matrix, aRight=right, iSize=len(rows), iColumns=len(sides[0]))
    return determinant, [v for i, side in enumerate(sides) for v in right[6 * i : 6 * i + len(side)]]


def hypotenuse() -> Program:
    """x and y from a and b, with the machine's k; refuses what is negative."""
    body = (Require(sp.Ge(A, 0), Status.IMPOSSIBLE), Let(X, Root(A**2 + B**2)), Let(Y, X * K**2))
    return normalise("hypotenuse", body, [Output("x", X), Output("y", Y)])


def caller(name: str = "caller", given: sp.Expr = C, outputs: tuple[sp.Symbol, ...] = (X, Y)) -> Program:
    call = Call(hypotenuse(), ((A, given), (B, Q)), (X, Y))
    return normalise(name, (call, Require(sp.Le(X, 5), Status.UNREACHABLE)), [Output(o.name, o) for o in outputs])


def test_it_binds_what_the_shared_program_answers() -> None:
    values = {"c": np.array([3.0, 6.0, -3.0, np.nan]), "q": np.array(4.0), "k": np.array(2.0)}
    outputs, status = run(caller(), values)
    assert list(status) == [Status.OK, Status.UNREACHABLE, Status.IMPOSSIBLE, Status.IMPOSSIBLE]
    assert outputs["x"][0] == 5.0 and outputs["y"][0] == 20.0


def test_it_may_not_be_asked_and_may_refuse_in_its_own_way() -> None:
    """Where the condition does not hold, nothing refuses, and the names are zero; else the caller's status counts."""
    asked, reason = flag("asked"), about_machine(Why.NO_ROOT)
    call = Call(hypotenuse(), ((A, C), (B, Q)), (X,), wanted=asked, refusal=(Status.UNREACHABLE, reason))
    program = verify(normalise("p", (call, Let(W, X + 1)), [Output("w", W)]))
    assert asked in program.inputs
    values = {"c": np.array([3.0, -3.0]), "q": np.array(4.0), "k": np.array(2.0)}
    outputs, status = run(program, values | {"asked": np.array(True)})
    assert list(status) == [Status.OK, Status.UNREACHABLE] and outputs["w"][0] == 6.0
    outputs, status = run(program, values | {"asked": np.array(False)})
    assert list(status) == [Status.OK, Status.OK] and list(outputs["w"]) == [1.0, 1.0]
    outputs, status = run(program, {**values, "c": np.array([-3.0, -3.0]), "asked": np.array([True, False])})
    assert list(status) == [Status.UNREACHABLE, Status.OK] and outputs["w"][1] == 1.0


def test_the_names_inside_are_its_own() -> None:
    """The caller's `a` is not the argument `a`, and is not changed by the call."""
    call = Call(hypotenuse(), ((A, A + 1), (B, A)), (X,))
    program = normalise("p", (call, Let(W, A * X)), [Output("w", W)])
    assert run(program, {"a": np.array(3.0), "k": np.array(1.0)})[0]["w"] == 15.0


def test_it_reads_arguments_and_constants() -> None:
    program = caller()
    (call, *_) = program.body
    assert isinstance(call, Call) and call.constants == (K,) and call.arguments == (C, Q)
    assert call.reads() == {C, Q, K} and program.inputs == (C, K, Q)


def test_only_what_is_read_is_bound() -> None:
    for outputs, bound in (((Y,), (X, Y)), ((), (X,))):
        call = caller(outputs=outputs).body[0]
        assert call.bound() == bound  # the condition reads x
    unread = normalise("p", (Call(hypotenuse(), ((A, C), (B, Q)), (X, Y)),), [Output("one", sp.Integer(1))])
    assert unread.body[0].bound() == ()
    assert run(unread, {n: np.array(-1.0) for n in ("c", "q", "k")})[1] == Status.IMPOSSIBLE  # it can still refuse


def test_an_alias_is_folded_into_the_arguments() -> None:
    call = Call(hypotenuse(), ((A, W), (B, Q)), (X, Y))
    program = normalise("p", (Let(W, C), call), [Output("y", Y)])
    assert [type(s) for s in program.body] == [Call]
    assert program.inputs == (C, K, Q)


def test_constants_are_hoisted_out_of_the_shared_program_once() -> None:
    programs = [caller("first"), caller("second", given=2 * C)]
    found = shared(programs)
    assert [p.name for p in found] == ["hypotenuse"]
    body = (
        Let(W, K**2),
        *(replace(s, value=X * W) if isinstance(s, Let) and s.name == Y else s for s in found[0].body),
    )
    inner = normalise("hypotenuse", body, found[0].outputs)
    programs = [replace(p, body=(replace(p.body[0], program=inner), *p.body[1:])) for p in programs]
    lowered, hoisted = hoist((*shared(programs), *programs), ["k"])
    assert [let.name for let in hoisted] == [W]
    assert [p.name for p in lowered] == ["hypotenuse", "first", "second"]
    for program in lowered[1:]:
        call = program.body[0]
        assert isinstance(call, Call) and call.program == lowered[0] and call.constants == (W,)
        values = {"c": np.array(1.5), "q": np.array(2.0), "w": np.array(4.0)}
        assert run(program, values)[0]["y"] == pytest.approx(
            4.0 * np.hypot(1.5 * (1 + (program.name == "second")), 2.0)
        )


def test_a_shared_program_comes_before_the_one_that_calls_it() -> None:
    outer = caller("outer")
    top = normalise("top", (Call(outer, ((C, C), (Q, Q)), (X,)),), [Output("x", X)])
    assert [p.name for p in shared([top, outer])] == ["hypotenuse", "outer"]


def test_the_verifier_refuses_wrong_calls() -> None:
    good = caller().body[0]
    assert isinstance(good, Call)
    for broken, inputs, word in (
        (replace(good, names=(W,)), (C, K, Q), "no output 'w'"),
        (replace(good, given=(*good.given, (W, C))), (C, K, Q), "does not read 'w'"),
        (replace(good, given=good.given[:1]), (C, K, Q), "reads 'b', which is neither given nor an input"),
        (good, (C, Q), "reads 'k', which is neither given nor an input"),
        (good, (C, K), "'q' is read before it is bound"),
        (good, (C, K, Q, X), "'x' is bound twice"),
    ):
        with pytest.raises(BrokenProgram, match=word):
            verify(Program("p", inputs, (broken,), ()))
    constant = (Let(K, C), good)
    with pytest.raises(BrokenProgram, match="reads 'k', which is neither given nor an input"):
        verify(Program("p", (C, Q), constant, ()))
