"""The reference interpreter: the meaning of every primitive, a program, and its reasons."""

from dataclasses import replace
from math import atan2, cos, nextafter, pi, sin

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.ir.constants import DEGREE
from derive.ir.interpret import evaluate, run
from derive.ir.passes import hoist, normalise, with_inputs, without_reasons
from derive.ir.primitives import Atan2, Root, Select, nearest_on_arc, nearest_period
from derive.ir.program import Let, Output, Program, Require, Status, rewritten
from derive.ir.program import reason_expressions as told
from derive.ir.reason import Kind, OtherTurn, Reason, Subject, Unit, Why, about, about_joint
from derive.ir.symbols import real
from derive.ir.verify import BrokenProgram
from tests.unit.solver.execution import at, distance

A, B, C, D, K, X, Y, Z = (real(n) for n in "abcdkxyz")
NAN, INFINITY = float("nan"), float("inf")


def value(expression: sp.Basic, **numbers: float) -> float:
    return at(expression, {k: np.asarray(v) for k, v in numbers.items()})


@pytest.mark.parametrize("x, root", [(4.0, 2.0), (0.0, 0.0), (-1e-300, 0.0), (-9.0, 0.0), (1e18, 1e9)])
def test_root(x: float, root: float) -> None:
    assert value(Root(X), x=x) == root


@pytest.mark.parametrize("y", [-1.0, -0.0, 0.0, 2.0])
@pytest.mark.parametrize("x", [-3.0, -0.0, 0.0, 1.0])
def test_atan2_is_exact_in_all_quadrants_and_knows_no_negative_zero(y: float, x: float) -> None:
    assert value(Atan2(Y, X), y=y, x=x) == atan2(y + 0.0, x + 0.0)
    assert -pi < value(Atan2(Y, X), y=y, x=x) <= pi


def test_select_evaluates_both_and_takes_one() -> None:
    choice = Select(sp.Gt(X, 0), 1 / X, Y)
    with np.errstate(divide="ignore"):
        assert value(choice, x=2.0, y=7.0) == 0.5
        assert value(choice, x=0.0, y=7.0) == 7.0
        assert value(choice, x=NAN, y=7.0) == 7.0


def test_arithmetic_and_logic() -> None:
    assert value(X**-2 * 3 + sp.Rational(1, 4) - sp.Abs(Y), x=2.0, y=-5.0) == -4.0
    assert value(sp.cos(X * DEGREE) + sp.sin(Y * DEGREE), x=60.0, y=30.0) == pytest.approx(1.0)
    both, either = sp.And(sp.Ge(X, 1), sp.Lt(X, 2)), sp.Or(sp.Gt(X, 5), sp.Le(X, 0))
    numbers = {"x": np.asarray([0.0, 1.0, 2.0, 6.0])}
    assert list(evaluate(both, numbers)) == [False, True, False, False]
    assert list(evaluate(either, numbers)) == [True, False, False, True]
    assert bool(evaluate(sp.true, {})) and not bool(evaluate(sp.false, {}))


TURNS = st.floats(-1e5, 1e5)


@pytest.mark.long
@given(angle=TURNS, centre=TURNS)
def test_nearest_period(angle: float, centre: float) -> None:
    found = float(nearest_period(np.asarray(angle), np.asarray(centre)))
    turns = (found - angle) / 360
    assert abs(turns - round(turns)) <= 1e-11
    assert centre - 180 - 1.1e-9 <= found < centre + 180 - 0.9e-9


@pytest.mark.parametrize("centre", [0.0, -360.0, 1080.0, 17.5])
@pytest.mark.parametrize(
    "delta, expected",
    [
        (-180.0, -180.0), (180.0, -180.0), (540.0, -180.0), (-180.0 - 0.5e-9, -180.0 - 0.5e-9),
        (180.0 - 0.5e-9, -180.0 - 0.5e-9), (-180.0 - 2e-9, 180.0 - 2e-9), (180.0 - 2e-9, 180.0 - 2e-9), (0.0, 0.0),
        (360.0, 0.0),
    ],
)  # fmt: skip
def test_the_interval_of_a_period_is_half_open_and_shifted_down(centre: float, delta: float, expected: float) -> None:
    """Shifted by 1e-9 degrees: what rounding moves across an edge stays on its side."""
    found = float(nearest_period(np.asarray(centre + delta), np.asarray(centre)))
    assert found == pytest.approx(centre + expected, abs=1e-12 * (1 + abs(centre)))


@pytest.mark.long
@given(axis=TURNS)
def test_the_commanded_period_brings_an_axis_back(axis: float) -> None:
    """Period n of an axis value, and the value in that period: the two shifts are the same."""
    turns = int(np.floor((axis + 180 + 1e-9) / 360))
    wrapped = np.degrees(atan2(sin(np.radians(axis)), cos(np.radians(axis))))
    assert float(nearest_period(np.asarray(wrapped), np.asarray(360.0 * turns))) == pytest.approx(axis, abs=1e-9)


@pytest.mark.parametrize("edge", [-900.0, -540.0, -180.0, 180.0, 540.0, 900.0])
def test_the_period_of_an_edge_is_stable(edge: float) -> None:
    for axis in (edge, nextafter(edge, -INFINITY), nextafter(edge, INFINITY), edge - 4e-10, edge + 4e-10):
        turns = int(np.floor((axis + 180 + 1e-9) / 360))
        assert turns == (edge + 180) / 360
        for wrapped in (180.0, -180.0, nextafter(180.0, 0.0)):
            assert float(nearest_period(np.asarray(wrapped), np.asarray(360.0 * turns))) == pytest.approx(
                edge, abs=1e-9
            )


HALVES = st.one_of(st.floats(0.0, pi), st.sampled_from([0.0, pi / 2, pi]))


@pytest.mark.long
@given(angle=st.floats(-50, 50), centre=st.floats(-50, 50), half=HALVES)
def test_nearest_on_arc(angle: float, centre: float, half: float) -> None:
    found = float(nearest_on_arc(*(np.asarray(v) for v in (angle, centre, half))))
    assert abs(found - centre) <= half + 1e-13
    off = distance(angle, centre)
    assert distance(angle, found) == pytest.approx(max(0.0, off - half), abs=1e-12)


def test_an_angle_on_the_arc_is_itself_up_to_turns() -> None:
    found = nearest_on_arc(np.asarray([0.3, 0.3 + 4 * pi, -1.2, 2.0, -2.0]), np.asarray(0.0), np.asarray(pi / 2))
    assert found == pytest.approx([0.3, 0.3, -1.2, pi / 2, -pi / 2], abs=1e-14)


def test_the_first_failing_condition_gives_the_status() -> None:
    program = Program(
        "p",
        (X,),
        (
            Require(sp.Le(X, 10), Status.BAD_INPUT),
            Let(Y, X + 1),
            Require(sp.Le(X, 5), Status.UNREACHABLE),
            Require(sp.Ge(X, 0), Status.IMPOSSIBLE),
        ),
        (Output("o", Y),),
    )
    outputs, status = run(program, {"x": np.asarray([1.0, 7.0, 20.0, -1.0])})
    assert list(status) == [Status.OK, Status.UNREACHABLE, Status.BAD_INPUT, Status.IMPOSSIBLE]
    assert list(outputs["o"]) == [2.0, 8.0, 21.0, 0.0]


@pytest.mark.parametrize("garbage", [NAN, INFINITY, -INFINITY])
@pytest.mark.parametrize(
    "condition",
    [sp.Le(sp.Abs(X), 10), sp.And(sp.Ge(X, -10), sp.Le(X, 10)), sp.And(sp.Lt(X, 10), sp.Gt(X, -10))],
    ids=str,
)
def test_garbage_fails_positive_conditions(garbage: float, condition: sp.Basic) -> None:
    _, status = run(Program("p", (X,), (Require(condition, Status.BAD_INPUT),), ()), {"x": np.asarray(garbage)})
    assert status.item() is Status.BAD_INPUT


def test_scalars_and_arrays_go_together() -> None:
    program = Program("p", (X, Y), (Let(Z, X * 2),), (Output("sum", Z + Y), Output("one", sp.Integer(1))))
    outputs, status = run(program, {"x": np.asarray(3.0), "y": np.arange(4.0)})
    assert list(outputs["sum"]) == [6.0, 7.0, 8.0, 9.0]
    assert outputs["one"].shape == status.shape == (4,)


def test_a_program_without_inputs() -> None:
    outputs, status = run(Program("p", (), (), (Output("one", sp.Integer(1)),)), {})
    assert outputs["one"] == 1.0
    assert status.item() is Status.OK


OUT = [Output("o", X + 1)]
POSITIVE = sp.Gt(X, 0)


def refusing(amount: sp.Expr, condition: sp.Basic = POSITIVE) -> Require:
    return Require(condition, Status.UNREACHABLE, reason=about_joint(A, Why.OUT_OF_REACH, amount, Unit.LENGTH))


def amount_of(program: Program) -> sp.Expr | None:
    (require,) = program.requires()
    assert require.reason is not None
    return require.reason.amount


def test_what_only_an_amount_reads_is_written_out_in_it() -> None:
    program = normalise("p", [Let(B, 2 * X), Let(C, B + Y), refusing(C**2)], OUT)
    assert program.bound() == ()
    assert amount_of(program) == (2 * X + Y) ** 2
    assert program.inputs == (X, Y)


def test_what_is_bound_before_the_refusal_is_read() -> None:
    """An amount reads a value that is bound before its condition by its name."""
    program = normalise("p", [Let(B, 2 * X), refusing(B + 1, sp.Gt(B, 0))], [Output("o", B)])
    assert program.bound() == (B,)
    assert amount_of(program) == B + 1


def test_what_is_bound_behind_the_refusal_is_written_out() -> None:
    """The order is that of the values that are needed: an amount moves none of them."""
    program = normalise("p", [Let(B, 2 * X), refusing(B + 1)], [Output("o", B**2 + B)])
    assert [type(s) for s in program.body] == [Require, Let]
    assert amount_of(program) == 2 * X + 1


def test_aliases_are_folded_in_amounts() -> None:
    assert amount_of(normalise("p", [Let(B, X), refusing(B + Y)], OUT)) == X + Y


def test_amounts_read_constants_that_are_hoisted() -> None:
    program = normalise("p", [Let(B, 2 * K), Let(C, B + X), refusing(B, sp.Gt(C, 0))], [Output("o", C)])
    (lowered,), hoisted = hoist([program], ["k"])
    assert [let.value for let in hoisted] == [2 * K]
    assert amount_of(lowered) == hoisted[0].name


def test_an_amount_does_not_count_as_read() -> None:
    """It is computed where the program refuses, and nowhere else."""
    statement = refusing(Y)
    assert statement.reads() == {X}
    assert list(told(statement)) == [Y]


def test_a_name_that_an_amount_reads_is_an_input() -> None:
    assert with_inputs(Program("p", (), (refusing(Y),), ())).inputs == (X, Y)


def test_an_amount_of_nothing_is_found() -> None:
    with pytest.raises(BrokenProgram, match="'y' is read before it is bound"):
        with_inputs(Program("p", (), (refusing(Y), Let(Y, X)), ()))


def test_every_expression_of_a_reason_is_rewritten() -> None:
    turns = (OtherTurn("A", X, (X, X + 1), (2 * X,)),)
    statement = replace(refusing(X), reason=Reason(Subject(Kind.JOINT, "a"), Why.BELOW, X, Unit.ANGLE, turns))
    changed = rewritten(statement, lambda e: e.xreplace({X: Y}))
    assert list(told(changed)) == [Y, Y, Y, Y + 1, 2 * Y]


def test_who_is_told_nothing_computes_nothing() -> None:
    program = without_reasons(normalise("p", [Let(B, Select(sp.Gt(Y, 0), Y, X)), refusing(B)], OUT))
    assert amount_of(program) is None
    assert program.inputs == (X,)
    assert program.requires()[0].condition == sp.Gt(X, 0)
    assert program.requires()[0].comment == "a: out of reach"


def test_the_reader_is_told_the_reason_or_the_note() -> None:
    assert refusing(X).comment == "a: out of reach"
    assert replace(refusing(X), note="limits of A").comment == "limits of A"
    assert Let(A, X, "by the sum", turn_of="A1").comment == "by the sum; A1: whole turns added"


def test_every_sentence_takes_one_name() -> None:
    for why in Why:
        assert why.value.count("{}") <= 1
        assert about("NAME", why).words.count("NAME") == why.value.count("{}")
