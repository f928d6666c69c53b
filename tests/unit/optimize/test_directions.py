"""Directions of angles, of scaled vectors and of cross products: the program before and after, and what it refuses."""

import numpy as np
import pytest
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select, ToReal, Wrap
from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.reason import Why, about
from derive.ir.symbols import Sign, count, real
from derive.ir.verify import BrokenProgram
from derive.lowering.passes import STRAIGHT_LINE, lowered
from derive.lowering.unrolling import unroll
from derive.optimize.angle_addition import with_added_angles
from derive.optimize.without_periods import angles_modulo_turns
from tests.unit.answers import plain_directions, same, shorter, values

C1, S1, C2, S2, C3, S3, C12, S12, C123, S123 = (
    real(f"{f}_{q}") for q in ("q1", "q2", "q3", "q12", "q123") for f in ("cos", "sin")
)
A, B, E, L, N, R, T, U, V, X, Y, K, COS, SIN, LENGTH, DIVISOR, AXIS, ANGLE = map(
    real, "a b e l n r t u v x y k cos_q sin_q length divisor axis_q angle_q1".split()
)
AXIS1, AXIS2, AXIS3 = (real(f"axis_a{i}") for i in (1, 2, 3))
REGULAR = sp.Gt(R, 1)


def axis(name: sp.Symbol, sine: sp.Expr, cosine: sp.Expr) -> Let:
    return Let(name, NearestPeriod(Atan2(sine, cosine) / DEGREE + A, N), "its turn")


def of(*lets: Let | Require, outputs: tuple[sp.Symbol, ...]) -> Program:
    return normalise("p", lets, [Output(o.name, o) for o in outputs])


def length(value: sp.Expr) -> Let:
    return Let(L, Select(REGULAR, Root(value), sp.Integer(1)))


DIRECTION = (
    length(U**2 + V**2),
    Let(C1, Select(REGULAR, U / L, sp.cos(T)), "q1"),
    Let(S1, Select(REGULAR, V / L, sp.sin(T))),
)
"""The direction (u, v), and that of an angle where it is none."""
SUM = (Let(C12, C1 * C2 - S1 * S2, "by the sum"), Let(S12, S1 * C2 + C1 * S2))


def test_nor_for_what_is_made_of_it_in_proportion() -> None:
    """The angle of a vector that is proportional to the direction needs no division, either."""
    made = (Let(real("made_y"), X * C1 - Y * S1), Let(real("made_x"), X * S1 + B * C1))
    program = of(*DIRECTION, *made, axis(AXIS1, made[0].name, made[1].name), outputs=(AXIS1,))
    assert "l" not in values(plain_directions(program))
    same(program, plain_directions(program))


@pytest.mark.parametrize(
    "read",
    [X + C1, C1**2, C1 * S1, Root(C1), Atan2(S1, X), Select(sp.Gt(C1, X), X, Y), Select(REGULAR, C1, X)],
    ids=str,
)
def test_what_else_is_made_of_it_keeps_the_division(read: sp.Expr) -> None:
    program = of(*DIRECTION, axis(AXIS1, S1, C1), Let(E, read), outputs=(AXIS1, E))
    assert "l" in values(plain_directions(program))


def test_a_divisor_that_is_no_length_is_kept() -> None:
    """It could be negative, and would turn the direction round."""
    program = of(Let(L, X - Y), Let(C1, U / L), Let(S1, V / L), axis(AXIS1, S1, C1), outputs=(AXIS1,))
    assert plain_directions(program) == program


@pytest.mark.parametrize("senses", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_angle_of_a_rotated_direction_is_a_sum(senses: tuple[int, int], sign: int) -> None:
    first, second = senses
    lets = (
        Let(C1, X / 2), Let(S1, Y / 2), Let(C2, U / 2), Let(S2, V / 2),
        Let(C12, sign * (C1 * C2 - first * second * S1 * S2), "by the sum"),
        Let(S12, sign * (first * S1 * C2 + second * C1 * S2)),
    )  # fmt: skip
    program = of(*lets, axis(AXIS1, S1, C1), axis(AXIS2, S2, C2), axis(AXIS3, S12, C12), outputs=(AXIS1, AXIS2, AXIS3))
    found = plain_directions(program)
    half = 180 * DEGREE if sign < 0 else 0
    wanted = A + (first * real("angle_q1") + second * real("angle_q2") + half) / DEGREE
    assert sp.expand(values(found)["axis_a3"].args[0] - wanted) == 0
    assert "cos_q12" not in values(found)
    assert [let.note for let in found.lets() if let.name == AXIS3] == ["by the sum; its turn"]
    same(program, found)


def test_a_sum_of_three_takes_one_new_angle() -> None:
    lets = (
        Let(C1, X / 2), Let(S1, Y / 2), Let(C2, U / 2), Let(S2, V / 2), Let(C12, C1 * C2 - S1 * S2),
        Let(S12, S1 * C2 + C1 * S2),
        Let(C3, B * C12 + E * S12), Let(S3, E * C12 - B * S12),
    )  # fmt: skip
    program = of(*lets, axis(AXIS1, S1, C1), axis(AXIS2, S2, C2), axis(AXIS3, S3, C3), outputs=(AXIS1, AXIS2, AXIS3))
    found = values(plain_directions(program))
    assert found["angle_with_q3"] == Atan2(E, B) and "cos_q12" not in found
    same(program, plain_directions(program))


def test_two_new_angles_for_one_are_no_gain() -> None:
    program = of(*SUM, axis(AXIS3, S12, C12), outputs=(AXIS3,))
    assert plain_directions(program) == program


def test_a_rotated_direction_that_something_else_reads_is_left_alone() -> None:
    program = of(
        *SUM, axis(AXIS1, S1, C1), axis(AXIS2, S2, C2), axis(AXIS3, S12, C12), outputs=(AXIS1, AXIS2, AXIS3, C12)
    )
    assert plain_directions(program) == program


def test_angles_first_where_nothing_reads_sines_but_the_sum() -> None:
    lets = (
        Let(real("along"), X * U + Y * V), Let(real("across"), Y * U - X * V),
        length(real("along") ** 2 + real("across") ** 2),
        Let(C1, Select(REGULAR, real("along") / L, sp.cos(T))), Let(S1, Select(REGULAR, real("across") / L, sp.sin(T))),
        Let(C3, sp.cos(X)), Let(S3, sp.sin(X)), Let(C2, A * C3 - B * S3), Let(S2, A * S3 + B * C3), *SUM,
    )  # fmt: skip
    program = of(*lets, axis(AXIS1, S1, C1), axis(AXIS2, S2, C2), outputs=(AXIS1, AXIS2, C12, S12))
    found = values(with_added_angles(program, frozenset("ab")))
    assert found["cos_q12"] == sp.cos(real("angle_q12")) and found["angle_q12"] == real("angle_q1") + real("angle_q2")
    assert isinstance(found["angle_q1"], Select) and found["angle_q1"].args[2] == T
    assert found["angle_q2"] == real("angle_of_a") + real("angle_of_q3") and found["angle_of_a"] == Atan2(B, A)
    assert not {"along", "across", "l", "cos_q1", "sin_q2"} & set(found)
    turn = (Let(A, sp.cos(E)), Let(B, sp.sin(E)))  # of length one
    same(*(normalise("p", (*turn, *p.body), p.outputs) for p in (program, with_added_angles(program, frozenset("ab")))))
    other = of(*lets, axis(AXIS1, S1, C1), axis(AXIS2, S2, C2), outputs=(AXIS1, AXIS2, C12, S12, C2))
    assert "cos_q2" in values(with_added_angles(other, frozenset("ab")))


def test_a_sum_of_mere_directions_is_no_cosine() -> None:
    """They need not be of length one."""
    first, second = (real("direction_y_q1"), real("direction_x_q1")), (real("direction_y_q2"), real("direction_x_q2"))
    turned = [Let(n, v) for (s, c), w in ((first, U), (second, V)) for n, v in ((c, A * X - B * w), (s, B * X + A * w))]
    (s1, c1), (s2, c2) = first, second
    total = (Let(C12, c1 * c2 - s1 * s2), Let(S12, s1 * c2 + c1 * s2))
    program = of(*turned, *total, axis(AXIS1, *first), axis(AXIS2, *second), outputs=(AXIS1, AXIS2, C12, S12))
    assert values(with_added_angles(program, frozenset("ab")))["cos_q12"] == c1 * c2 - s1 * s2


def test_an_angle_whose_turns_count_is_no_sum() -> None:
    """An angle that becomes a number by `wrap` is not replaced by a sum of angles."""
    lets = (Let(C1, X * U + Y * V), Let(S1, Y * U - X * V))
    counted = of(*lets, Let(AXIS1, Wrap(Atan2(S1, C1)) / DEGREE), outputs=(AXIS1,))
    assert with_added_angles(counted, frozenset()) == counted
    nearest = of(*lets, axis(AXIS1, S1, C1), outputs=(AXIS1,))
    assert len(values(with_added_angles(nearest, frozenset()))["angle_q1"].free_symbols) == 2
    same(nearest, with_added_angles(nearest, frozenset()))


def test_turns_count_wherever_more_than_a_sine_or_the_nearest_turn_is_taken() -> None:
    angle, other = real("angle"), real("other")
    bound = (Let(angle, Atan2(X, Y)), Let(other, angle - T))
    assert angles_modulo_turns(of(*bound, Let(R, sp.sin(other + X)), outputs=(R,))) == {angle, other}
    assert angles_modulo_turns(of(*bound, Let(R, NearestPeriod(A - other / DEGREE, N)), outputs=(R,))) == {angle, other}
    assert angles_modulo_turns(of(*bound, Let(R, Wrap(other)), outputs=(R,))) == {angle}
    counted = (sp.sin(other / 2), NearestPeriod(other * X, N), NearestPeriod(X, other), Select(sp.Gt(other, 0), X, Y))
    for value in counted:
        with pytest.raises(BrokenProgram):
            of(*bound, Let(R, value), outputs=(R,))
    assert angles_modulo_turns(of(*bound, outputs=(other,))) == {angle}


def test_a_divisor_that_can_be_negative_turns_the_angle() -> None:
    """It is no length: divided by a negative number a direction is the opposite one."""
    lets = (
        Let(C1, Select(sp.Gt(R**2, 1), (U * X - V * Y) / R, sp.cos(T))),
        Let(S1, Select(sp.Gt(R**2, 1), (U * Y + V * X) / R, sp.sin(T))),
    )
    program = of(*lets, axis(AXIS1, S1, C1), outputs=(AXIS1,))
    assert with_added_angles(program, frozenset()) == program


def test_a_quotient_that_reads_another_keeps_its_division() -> None:
    """It would grow with the square of the length, and the other with the length."""
    made = Let(real("made"), C1 * X / L)
    program = of(*DIRECTION[:1], Let(C1, U / L), Let(S1, V / L), made, axis(AXIS1, S1, made.name), outputs=(AXIS1,))
    assert "l" in values(plain_directions(program))
    same(program, plain_directions(program))


def test_an_angle_times_a_coordinate_of_its_direction_keeps_the_division() -> None:
    program = of(*DIRECTION, axis(AXIS1, S1, C1), Let(E, C1 * Wrap(Atan2(S1, C1))), outputs=(AXIS1, E))
    assert "l" in values(plain_directions(program))


def test_half_an_angle_counts_turns_though_its_sines_cancel() -> None:
    """Half of an angle modulo a turn is refused: it has two values."""
    angle = real("angle")
    halves = {half: sp.cos(half / 2) - sp.sin(half / 2) for half in (angle, Wrap(angle))}
    with pytest.raises(BrokenProgram):
        of(Let(angle, Atan2(X, Y)), Let(R, halves[angle]), outputs=(R,))
    assert angles_modulo_turns(of(Let(angle, Atan2(X, Y)), Let(R, halves[Wrap(angle)]), outputs=(R,))) == set()


RNG = np.random.default_rng(5)
SAMPLES = {name: RNG.uniform(-2.0, 2.0, 400) for name in ("x", "y", "k", "ref")}


def _scaled(length: sp.Expr, condition: sp.Basic) -> Program:
    axis = NearestPeriod(Atan2(SIN, COS) / DEGREE, real("ref"))
    divisor = Let(DIVISOR, Select(condition, LENGTH, 1))
    lets = [Let(LENGTH, length), divisor, Let(COS, X / DIVISOR), Let(SIN, Y / DIVISOR), Let(AXIS, axis)]
    return normalise("p", lets, [Output("axis_q", AXIS)])


def mirrored(program: Program) -> Program:
    """The program as a graph, of whose angles the turn is free."""
    (changed,), _ = lowered([program], (), STRAIGHT_LINE)
    return changed


def _agree(first: Program, second: Program) -> None:
    given = {
        name: values for name, values in SAMPLES.items() if name in {s.name for s in (*first.inputs, *second.inputs)}
    }
    np.testing.assert_allclose(run(second, given)[0]["axis_q"], run(first, given)[0]["axis_q"], atol=1e-9)


@pytest.mark.parametrize(
    "length, condition, is_proven",
    [
        (Root(X**2 + Y**2), sp.Float("1e-11") < LENGTH, True),
        (K, sp.Abs(LENGTH) > sp.Float("1e-11"), False),
        (X * K, sp.Abs(LENGTH) > sp.Float("1e-11"), False),
        (-Root(X**2 + K**2), -sp.Float("1e-11") > LENGTH, False),
        (Root(X**2 + K**2) - 1, sp.Abs(LENGTH) > sp.Float("1e-11"), False),
    ],
)
def test_a_divisor_leaves_a_direction_only_where_it_is_a_length(
    length: sp.Expr, condition: sp.Basic, is_proven: bool
) -> None:
    program = _scaled(length, condition)
    found = plain_directions(program)
    _agree(program, found)
    is_divided = any(1 / DIVISOR in sp.Mul.make_args(let.value) for let in found.lets())
    assert is_divided != is_proven


@pytest.mark.parametrize("factor", [K, -K, X * K, -Root(K**2), sp.Integer(-1)])
def test_a_factor_of_any_sign_turns_a_direction(factor: sp.Expr) -> None:
    axis = NearestPeriod(Atan2(SIN, COS) / DEGREE, real("ref"))
    program = normalise("p", [Let(COS, factor * X), Let(SIN, factor * Y), Let(AXIS, axis)], [Output("axis_q", AXIS)])
    for change in (plain_directions, mirrored):
        _agree(program, change(program))


def test_a_branch_sign_turns_a_direction() -> None:
    sigma = Sign(count("sigma_elbow"), ("up", "down"))
    sign, axis = real("sign_elbow"), NearestPeriod(Atan2(SIN, COS) / DEGREE, real("ref"))
    lets = [Let(sign, ToReal(sigma.symbol)), Let(COS, sign * X), Let(SIN, sign * Y), Let(AXIS, axis)]
    program = normalise("p", lets, [Output("axis_q", AXIS)])
    given = {name: SAMPLES[name] for name in ("x", "y", "ref")}
    every, _ = run(unroll(mirrored(program), (sigma,)), given)
    for number, word in ((1, "up"), (-1, "down")):
        wanted, _ = run(program, {**given, "sigma_elbow": np.asarray(number)})
        np.testing.assert_allclose(every[f"axis_q_{word}"], wanted["axis_q"], atol=1e-9)


def refusing(amount: sp.Expr) -> Program:
    require = Require(sp.Gt(R, 0), Status.UNREACHABLE, reason=about("it", Why.TOO_LARGE, amount))
    turned = NearestPeriod(ANGLE / DEGREE, sp.Integer(0))
    earlier = Require(sp.Le(turned, 175), Status.UNREACHABLE, reason=about("angle", Why.TOO_LARGE))
    turn = Let(AXIS1, NearestPeriod(Atan2(S1, C1) / DEGREE, N), turn_of="A1")
    return of(*DIRECTION, Let(ANGLE, Atan2(S1, C1)), earlier, require, turn, outputs=(AXIS1,))


def amounts(program: Program) -> np.ndarray:
    """The last amount at many numbers, by the statements before the refusal."""
    require = program.requires()[-1]
    assert require.reason is not None and require.reason.amount is not None
    before = [s for s in program.body[: program.body.index(require)] if isinstance(s, Let)]
    alone = normalise("amount", before, [Output("amount", require.reason.amount)])
    rng = np.random.default_rng(5)
    given = {name: rng.uniform(-2.0, 2.0, 200) for name in "lnrtuv"}
    return np.asarray(run(alone, {s.name: given[s.name] for s in alone.inputs})[0]["amount"])


def test_of_a_direction_that_is_taken_without_its_length() -> None:
    """The division disappears where the angle alone is asked for; an amount asks for more."""
    for amount in (C1, 2 * S1 + C1, L + S1):
        program = refusing(amount)
        for changed in (plain_directions(program), shorter(program)):
            np.testing.assert_allclose(amounts(changed), amounts(program), rtol=1e-12, atol=1e-12)


def test_an_amount_that_reads_nothing_of_it_changes_nothing() -> None:
    """A direction is not divided where the amount of a reason reads something else."""
    found = plain_directions(refusing(U + R))
    assert "direction_x_q1" in {name.name for name in found.bound()}
    np.testing.assert_allclose(amounts(found), amounts(refusing(U + R)))
