"""`Call`: a program that several programs share, in all passes and in the verifier."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from derive.ir.interpret import run
from derive.ir.passes import hoist, normalise
from derive.ir.primitives import Root
from derive.ir.program import Call, Let, Output, Program, Require, Status, shared
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import flag, real
from derive.ir.verify import BrokenProgram, verify

A, B, C, K, Q, W, X, Y = map(real, ("a", "b", "c", "k", "q", "w", "x", "y"))


def hypotenuse() -> Program:
    """x and y from a and b, with the machine's k; refuses what is negative."""
    body = (Require(sp.Ge(A, 0), Status.IMPOSSIBLE), Let(X, Root(A**2 + B**2)), Let(Y, X * K**2))
    return normalise("hypotenuse", body, [Output("x", X), Output("y", Y)])


def caller(name: str = "caller", given: sp.Expr = C, outputs: tuple[sp.Symbol, ...] = (X, Y)) -> Program:
    call = Call(hypotenuse(), ((A, given), (B, Q)), (X, Y))
    return normalise(name, (call, Require(sp.Le(X, 5), Status.UNREACHABLE)), [Output(o.name, o) for o in outputs])


def test_it_binds_what_the_shared_program_answers() -> None:
    """A call binds the outputs of the shared program, or passes on its status."""
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
    """A call reads its arguments, and the constants of the shared program."""
    program = caller()
    (call, *_) = program.body
    assert isinstance(call, Call) and call.constants == (K,) and call.arguments == (C, Q)
    assert call.reads() == {C, Q, K} and program.inputs == (C, K, Q)


def test_only_what_is_read_is_bound() -> None:
    """A call binds only the results that something reads, and stays for its status where nothing reads any."""
    for outputs, bound in (((Y,), (X, Y)), ((), (X,))):
        call = caller(outputs=outputs).body[0]
        assert call.bound() == bound  # the condition reads x
    unread = normalise("p", (Call(hypotenuse(), ((A, C), (B, Q)), (X, Y)),), [Output("one", sp.Integer(1))])
    assert unread.body[0].bound() == ()
    assert run(unread, {n: np.array(-1.0) for n in ("c", "q", "k")})[1] == Status.IMPOSSIBLE  # it can still refuse


def test_an_alias_is_folded_into_the_arguments() -> None:
    """An argument that is a name for another name is replaced by that name."""
    call = Call(hypotenuse(), ((A, W), (B, Q)), (X, Y))
    program = normalise("p", (Let(W, C), call), [Output("y", Y)])
    assert [type(s) for s in program.body] == [Call]
    assert program.inputs == (C, K, Q)


def test_constants_are_hoisted_out_of_the_shared_program_once() -> None:
    """A constant of a shared program is hoisted once for all of its callers."""
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
    """Shared programs are listed before the programs that call them."""
    outer = caller("outer")
    top = normalise("top", (Call(outer, ((C, C), (Q, Q)), (X,)),), [Output("x", X)])
    assert [p.name for p in shared([top, outer])] == ["hypotenuse", "outer"]


def test_the_verifier_refuses() -> None:
    """A call with wrong names, arguments or results is refused."""
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
