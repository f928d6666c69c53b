"""Fewer operations, the same values; long statements are cut, and programs of which every axis may be in any turn."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derive.algebra.angle_sums import name_of
from derive.equations.known_turns import Side
from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select, ToReal, Wrap
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Status
from derive.ir.symbols import Names, Sign, count, real
from derive.lowering.passes import STRAIGHT_LINE, lowered
from derive.lowering.unrolling import unroll
from derive.report.cost import cost_of
from tests.unit.answers import same, values

A, B, C, D, F, G, H, X, Y, Z, RESULT, L, N, P, Q, R, S, ANGLE, AXIS = map(
    real, ("a", "b", "c", "d", "f", "g", "h", "x", "y", "z", "result", "l", "n", "p", "q", "r", "s", "angle", "axis")
)
CONSTANTS = ("c", "d")


def program(*lets: Let | Require, outputs: tuple[sp.Symbol, ...]) -> Program:
    return normalise("program", lets, [Output(o.name, o) for o in outputs])


def test_two_programs_share_what_is_hoisted() -> None:
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
    found = values(shorter)
    assert found["f"] == -X * A - Y * B
    assert found["f_times_d"] == D * F and found["f_minus_d"] == F - D


def test_a_factor_takes_the_sign_that_leaves_no_minus_in_front() -> None:
    lets = (Let(F, -X * A - Y * B), Let(G, Y * A - X * B), Let(H, (F * Y - G * X) * A))
    (shorter,), _ = lowered([program(*lets, outputs=(F, G, H))], ())
    assert values(shorter)["h"] == A * (F * Y - G * X)


def test_a_loop_keeps_what_moves_inside_and_what_stays_outside() -> None:
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


INPUTS = [real(f"measured_length_{i}") for i in range(150)]
NESTED = Root(sum((a * Root(b + c) for a, b, c in zip(INPUTS, INPUTS[50:], INPUTS[100:], strict=False)), INPUTS[0]))
LONG = {
    "a sum": sum((a * b - 2 for a, b in zip(INPUTS, INPUTS[75:], strict=False)), sp.S.Zero),
    "deep": Root(NESTED + INPUTS[7]) / (NESTED + 3),
    "a choice": Select(sp.Gt(sum(INPUTS[:60]), 0), NESTED, sum(INPUTS[90:])),
}


def long_program(value: sp.Expr) -> Program:
    return normalise("program", [Let(RESULT, value, "what it is")], [Output("result", RESULT)])


@pytest.mark.parametrize("kind", LONG)
def test_a_long_statement_is_cut_into_named_parts(kind: str) -> None:
    """Each part is short, has a name of its own, and the result is the same."""
    whole = long_program(LONG[kind])
    (cut,), _ = lowered([whole], ())
    assert len(str(LONG[kind])) > 1500
    assert max(len(str(let.value)) for let in cut.lets()) < 450
    assert len(cut.body) > 4 and sum(let.note == "what it is" for let in cut.lets()) == 1
    values = {s.name: np.linspace(1.0, 2.0, 5) + k for k, s in enumerate(INPUTS)}
    before, after = (run(p, {s.name: values[s.name] for s in p.inputs})[0]["result"] for p in (whole, cut))
    assert np.allclose(before, after, rtol=1e-13)


def test_what_is_short_stays_as_it_is() -> None:
    (same,), _ = lowered([long_program(sum(INPUTS[:8]))], ())
    assert len(same.body) == 1


def test_a_long_name_is_shortened_and_stays_unique() -> None:
    names = Names(())
    first, second = (names.fresh(f"sum_in_r22_from_{word * 20}_{'turn_x_' * 9}tried").name for word in ("ab_", "cd_"))
    third = names.fresh(f"sum_in_r22_from_{'ab_' * 21}{'turn_x_' * 9}tried").name
    assert len({first, second, third}) == 3 and max(map(len, (first, second, third))) <= 84
    assert first.startswith("sum_in_r22_from_ab") and first.endswith("turn_x_tried") and "__" not in first
    assert names.fresh("cos_a2").name == "cos_a2" and names.fresh("x" * 200).name == f"{'x' * 40}_{'x' * 40}"


def test_the_name_of_a_frame_does_not_grow_with_the_chain() -> None:
    """A frame behind many joints with long names is named by the last of them, one before many by the first."""
    joints = tuple(f"a{k}_base_turn_z" for k in range(1, 6))
    assert Side("from", "base", joints[:1]).suffix == "_from_a1_base_turn_z"
    assert Side("from", "base", joints).suffix == "_from_base_to_a5_base_turn_z"
    assert Side("before", "flange", joints, 1).suffix == "_before_a1_base_turn_z_to_flange_turned"
    again = (*joints, joints[0])  # an angle of two links
    assert Side("from", "base", again).suffix == "_from_base_to_a1_base_turn_z_2"
    assert Side("before", "flange", again).suffix == "_before_a1_base_turn_z_2_to_flange"
    short = tuple(f"a{k}" for k in range(1, 7))
    assert Side("before", "flange", short).suffix == f"_before_{name_of(tuple((real(n), 1) for n in short))}"


ELBOW = Sign(count("sigma_elbow"), ("down", "up"))


def of(*lets: Let, outputs: tuple[sp.Symbol, ...]) -> Program:
    return normalise("p", lets, [Output(o.name, o) for o in outputs])


def shorter(program: Program, constants: str = "") -> Program:
    (found,), _ = lowered([program], tuple(constants), STRAIGHT_LINE)
    return found


def test_products_of_both_branches_are_computed_once() -> None:
    swing = Let(R, ToReal(ELBOW.symbol) * Root(X))
    program = unroll(of(swing, Let(C, P * Y - Q * R), Let(S, Q * Y + P * R), outputs=(C, S)), (ELBOW,))
    found = shorter(program)
    assert cost_of(program).multiplications == cost_of(found).multiplications == 4
    same(program, found)


def test_the_angle_of_a_mirrored_direction_is_the_negative() -> None:
    swing = (
        Let(R, ToReal(ELBOW.symbol) * Root(X)),
        Let(ANGLE, Atan2(R, C)),
        Let(AXIS, NearestPeriod(A + ANGLE / DEGREE, N)),
    )
    program = unroll(of(*swing, outputs=(AXIS,)), (ELBOW,))
    found = shorter(program)
    assert cost_of(program).trigonometric == 2 and cost_of(found).trigonometric == 1
    same(program, found)


def test_an_angle_whose_turn_counts_stays() -> None:
    """The value of atan2(0, -1) is pi on both sides: its negative would be a turn less."""
    swing = (Let(R, ToReal(ELBOW.symbol) * Root(X)), Let(AXIS, A + Wrap(Atan2(R, C)) / DEGREE))
    program = unroll(of(*swing, outputs=(AXIS,)), (ELBOW,))
    assert cost_of(shorter(program)).trigonometric == 2
    same(program, shorter(program))


def test_minus_signs_that_meet_are_not_written() -> None:
    """S is read by its name, which is the negative of the product, and so is the angle."""
    program = of(Let(S, -X * Y), Let(ANGLE, Atan2(S, C)), Let(A, ANGLE + P), Let(B, S + 1), outputs=(A, B))
    assert values(shorter(program))["angle"] == Atan2(S, C)
