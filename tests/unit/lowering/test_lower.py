"""Fewer operations, the same values: what is hoisted, factored, shared and divided once; random programs before and
after."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Status
from derive.ir.symbols import real
from derive.lowering.passes import lowered
from derive.report.cost import cost_of

A, B, C, D, F, G, H, X, Y, Z = (real(n) for n in ("a", "b", "c", "d", "f", "g", "h", "x", "y", "z"))
CONSTANTS = ("c", "d")


def program(*lets: Let | Require, outputs: tuple[sp.Symbol, ...]) -> Program:
    return normalise("program", lets, [Output(o.name, o) for o in outputs])


def lets_of(one: Program) -> dict[str, sp.Expr]:
    return {let.name.name: let.value for let in one.lets()}


def test_two_programs_share_what_is_hoisted() -> None:
    """Equal constants of two programs are hoisted once."""
    first, second = program(Let(F, C * D * X), outputs=(F,)), program(Let(G, C * D * Y), outputs=(G,))
    _, hoisted = lowered([first, Program("other", second.inputs, second.body, second.outputs)], CONSTANTS)
    assert len(hoisted) == 1


def test_the_words_of_a_name_are_those_of_its_value() -> None:
    """Names that are bound to negatives in the graph change neither the sign in a text nor the
    words of another name.
    """
    lets = (
        Let(F, -X * A - Y * B),
        Let(G, F * D * X),
        Let(H, 2 * F * D * Y),
        Let(real("k"), (F - D) * X / (Y * (F - D) + 1)),
    )
    (shorter,), _ = lowered([program(*lets, outputs=(G, H, real("k")))], ())
    found = lets_of(shorter)
    assert found["f"] == -X * A - Y * B
    assert found["f_times_d"] == D * F and found["f_minus_d"] == F - D


def test_a_factor_takes_the_sign_that_leaves_no_minus_in_front() -> None:
    """Signs are distributed so that a product has no minus sign in front."""
    lets = (Let(F, -X * A - Y * B), Let(G, Y * A - X * B), Let(H, (F * Y - G * X) * A))
    (shorter,), _ = lowered([program(*lets, outputs=(F, G, H))], ())
    assert lets_of(shorter)["h"] == A * (F * Y - G * X)


def test_a_loop_keeps_what_moves_inside_and_what_stays_outside() -> None:
    """Values that do not depend on the state of an iteration are computed before it."""
    step = (Let(F, X * Y * A), Let(G, F + X * Y))
    loop = Iterate((A,), (B,), step, (A + F,), sp.Le(G, 1), 3, Status.UNREACHABLE)
    one = program(loop, outputs=(G,))
    (shorter,), _ = lowered([one], ())
    assert [let.name.name for let in shorter.lets()] == ["x_times_y"]
    (inner,) = (s for s in shorter.body if isinstance(s, Iterate))
    assert {name.name for s in inner.step if isinstance(s, Let) for name in (s.name,)} == {"f", "g"}


def test_a_caller_calls_the_program_as_it_is_now() -> None:
    """A call refers to the lowered program, and passes the constants that it now reads."""
    shared = Program("shared", (X, C), (Let(F, X * C * C),), (Output("f", F),))
    caller = normalise("caller", [Call(shared, ((X, Y),), (F,))], [Output("f", F)])
    (inner, outer), _ = lowered([shared, caller], CONSTANTS)
    (call,) = (s for s in outer.body if isinstance(s, Call))
    assert call.program == inner and "c_squared" in {s.name for s in outer.inputs}


LEAVES = st.sampled_from([X, Y, Z, C, D, sp.Integer(2), sp.Rational(1, 2), sp.Integer(-1)])


@st.composite
def expression(draw: st.DrawFn, names: list[sp.Symbol], depth: int = 3) -> sp.Expr:
    """A total expression of these names: sums, products, quotients by what is at least one, choices, roots."""
    leaf = st.one_of(LEAVES, st.sampled_from(names)) if names else LEAVES
    if depth == 0 or draw(st.integers(0, 4)) == 0:
        return draw(leaf)
    parts = [draw(expression(names, depth - 1)) for _ in range(draw(st.integers(2, 3)))]
    kind = draw(st.sampled_from(["sum", "product", "quotient", "choice", "root", "turn"]))
    if kind == "sum":
        return sp.Add(*(draw(st.sampled_from([1, -1])) * p for p in parts))
    if kind == "product":
        return sp.Mul(*parts)
    if kind == "quotient":
        return parts[0] / (1 + parts[1] ** 2)
    if kind == "choice":
        return Select(sp.Gt(X, sp.Rational(1, 3)), parts[0], parts[1])
    return Root(parts[0] ** 2 + parts[1] ** 2) if kind == "root" else sp.cos(parts[0]) + sp.sin(parts[1])


@st.composite
def random_program(draw: st.DrawFn) -> Program:
    names: list[sp.Symbol] = []
    lets = []
    for k in range(draw(st.integers(2, 7))):
        lets.append(Let(real(f"value_{k}"), draw(expression(list(names)))))
        names.append(lets[-1].name)
    return normalise("program", lets, [Output(name.name, name) for name in names[-3:]])


@pytest.mark.slow
@settings(max_examples=50)
@given(random_program(), st.integers(0, 2**16))
def test_values_stay_the_same(one: Program, seed: int) -> None:
    """A lowered program has the outputs of the program before."""
    (shorter,), hoisted = lowered([one], CONSTANTS)
    rng = np.random.default_rng(seed)
    given_ = {name: rng.uniform(-2.0, 2.0, 5) for name in "xyzcd"}
    constants, _ = run(normalise("setup", hoisted, [Output(let.name.name, let.name) for let in hoisted]), given_)
    before, _ = run(one, given_)
    after, _ = run(shorter, {**given_, **constants})
    for name, value in before.items():
        size = 1.0 + np.max(np.abs(value))
        assert np.allclose(np.broadcast_to(after[name], np.shape(value)), value, rtol=1e-9, atol=1e-9 * size)
    assert sum(vars(cost_of(shorter)).values()) <= sum(vars(cost_of(one)).values())
