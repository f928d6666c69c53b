"""Mirrored branches and the sides of choices: the program before and after, and the same answers."""

import pytest
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select, Wrap
from derive.ir.program import Let, Output, Program, Require, Solve, Statement, Status
from derive.ir.symbols import real
from derive.ir.tree import If, Item
from derive.lowering.draft import Reader, changed, values_of
from derive.lowering.passes import structured
from derive.lowering.scheduling import scheduled
from derive.lowering.symmetry import Symmetry
from derive.lowering.writing import written
from derive.report.cost import cost_of
from tests.unit.answers import same, values

A, B, C, D, E, F, N, R, T, X, Y = (real(n) for n in "abcdefnrtxy")
C_DOWN, C_UP, S_DOWN, S_UP, M_DOWN, M_UP, AXIS_DOWN, AXIS_UP = map(
    real, "c_down c_up s_down s_up m_down m_up axis_down axis_up".split()
)
REGULAR = sp.Gt(R, 1)


def with_symmetry(program: Program) -> Program:
    reader = Reader()
    draft = reader.draft(program)
    starts = [value.node for value in values_of(draft)]
    return written(changed(draft, Symmetry(reader.graph, starts, draft.names)), {}, modulo_turns=True)


def axes(*lets: Let, down: sp.Expr, up: sp.Expr) -> Program:
    """A program with two axes on the turns that are nearest to N."""
    ends = [Let(AXIS_DOWN, NearestPeriod(down, N)), Let(AXIS_UP, NearestPeriod(up, N))]
    return normalise("axes", [*lets, *ends], [Output("down", AXIS_DOWN), Output("up", AXIS_UP)])


def wrist() -> Program:
    """A wrist and the same turned over: where it is not regular, both are at the same angle."""
    lets = [
        Let(C_DOWN, Select(REGULAR, X / 2, sp.cos(T))),
        Let(S_DOWN, Select(REGULAR, Y / 2, sp.sin(T))),
        Let(C_UP, Select(REGULAR, -X / 2, sp.cos(T))),
        Let(S_UP, Select(REGULAR, -Y / 2, sp.sin(T))),
        Let(M_DOWN, A * C_DOWN + B * S_DOWN),
        Let(M_UP, A * C_UP + B * S_UP),
    ]
    return axes(*lets, down=D + Atan2(M_DOWN, C_DOWN) / DEGREE, up=D + Atan2(M_UP, C_UP) / DEGREE)


def test_a_value_is_the_negative_of_another_where_a_condition_holds() -> None:
    found = values(with_symmetry(wrist()))
    assert found["m_up"] == Select(REGULAR, -M_DOWN, A * C_UP + B * S_UP)


def test_an_angle_is_half_a_turn_from_another_where_a_condition_holds() -> None:
    found = values(with_symmetry(wrist()))
    down = next(real(name) for name, value in found.items() if value == D + Atan2(M_DOWN, C_DOWN) / DEGREE)
    assert found["axis_up"] == NearestPeriod(Select(REGULAR, down + 180, D + Atan2(M_UP, C_UP) / DEGREE), N)
    same(wrist(), with_symmetry(wrist()))


@pytest.mark.parametrize("sine", [X, -X])
@pytest.mark.parametrize("cosine", [Y, -Y])
@pytest.mark.parametrize("sense", [1, -1])
def test_a_mirrored_or_opposite_direction_has_the_same_angle_but_for_half_a_turn(
    sine: sp.Expr, cosine: sp.Expr, sense: int
) -> None:
    """In a sum with another angle, too, and where the sum itself is taken negative."""
    angles = [Let(S_DOWN, Atan2(X, Y)), Let(S_UP, Atan2(sine, cosine))]
    program = axes(*angles, down=D + S_DOWN / DEGREE, up=A + (sense * S_UP + 3 * T * DEGREE) / DEGREE)
    found = with_symmetry(program)
    assert cost_of(found).trigonometric == 1
    same(program, found)


def test_half_a_turn_in_a_sine_is_written_out() -> None:
    angles = [Let(S_DOWN, Atan2(X, Y)), Let(S_UP, Atan2(-X, -Y))]
    ends = [Let(A, sp.sin(S_UP + R * DEGREE)), Let(B, sp.cos(S_DOWN - R * DEGREE))]
    program = normalise("sines", [*angles, *ends], [Output("a", A), Output("b", B)])
    same(program, with_symmetry(program))


def test_another_value_on_the_other_side_is_kept() -> None:
    """The second sides of C differ: what is made of it is the negative on the first side alone."""
    lets = [
        Let(C_DOWN, Select(REGULAR, X / 2, sp.cos(T))),
        Let(C_UP, Select(REGULAR, -X / 2, sp.sin(T))),
        Let(M_DOWN, A * C_DOWN),
        Let(M_UP, A * C_UP),
    ]
    program = normalise("other", lets, [Output("down", M_DOWN + 1), Output("up", M_UP + 1)])
    assert values(with_symmetry(program))["m_up"] == Select(REGULAR, -M_DOWN, A * C_UP)
    same(program, with_symmetry(program))


def test_values_that_differ_on_the_first_side_stay() -> None:
    lets = [Let(C_DOWN, Select(REGULAR, X, T)), Let(C_UP, Select(REGULAR, -2 * X, T))]
    lets += [Let(M_DOWN, Root(A + C_DOWN)), Let(M_UP, Root(A + C_UP))]
    program = normalise("other", lets, [Output("down", M_DOWN + 1), Output("up", M_UP + 1)])
    assert values(with_symmetry(program)) == values(program)


def test_a_choice_is_the_negative_of_another_whatever_the_signs_of_its_sides() -> None:
    """Also one with a zero on a side."""
    far = sp.Gt(T, 0)
    lets = [Let(C_DOWN, Select(REGULAR, X, T)), Let(C_UP, Select(REGULAR, -X, T))]
    for second in (Y, sp.Integer(0)):
        ends = [Let(M_DOWN, Select(far, A * C_DOWN, -second)), Let(M_UP, Select(far, A * C_UP, second))]
        program = normalise("signs", [*lets, *ends], [Output(str(s), s) for s in (C_DOWN, C_UP, M_DOWN, M_UP)])
        found = values(with_symmetry(program))["m_up"]
        assert found.args[:2] == (REGULAR, -M_DOWN)
        same(program, with_symmetry(program))


def test_the_condition_that_gives_most_values_decides() -> None:
    """R above 2 would give M alone; R above 1 gives A, too."""
    lets = [Let(C_DOWN, Select(REGULAR, X, T)), Let(C_UP, Select(REGULAR, -X, T))]
    lets += [Let(M_DOWN, Select(sp.Gt(R, 2), X, A * C_DOWN)), Let(M_UP, Select(sp.Gt(R, 2), -X, A * C_UP))]
    ends = [Let(S_DOWN, M_DOWN * Y), Let(S_UP, M_UP * Y), Let(AXIS_DOWN, C_DOWN * Y), Let(AXIS_UP, C_UP * Y)]
    outputs = [Output(str(s), s) for s in (S_DOWN, S_UP, AXIS_DOWN, AXIS_UP)]
    program = normalise("most", [*lets, *ends], outputs)
    found = values(with_symmetry(program))
    assert all(found[name].args[0] == REGULAR for name in ("s_up", "axis_up"))
    same(program, with_symmetry(program))


def test_what_one_side_of_a_choice_alone_reads_is_not_computed_for_another_value() -> None:
    """M of the first wrist is needed where R is large alone: the second one does not wait for it."""
    far = sp.Gt(R, 2)
    lets = [Let(C_DOWN, Select(REGULAR, X, T)), Let(C_UP, Select(REGULAR, -X, T))]
    lets += [Let(M_DOWN, A * C_DOWN + 1), Let(M_UP, -A * C_UP + 1), Let(B, Select(far, M_DOWN, Y))]
    program = normalise("rare", lets, [Output("down", B), Output("up", M_UP)])
    assert values(with_symmetry(program))["m_up"] == 1 - A * C_UP
    same(program, with_symmetry(program))


def test_an_angle_whose_value_is_taken_is_left_alone() -> None:
    """Its value counts, not its direction: half a turn more would be another value."""
    program = axes(down=Wrap(Atan2(X, Y)) / DEGREE, up=Wrap(Atan2(-X, -Y)) / DEGREE / 3)
    assert cost_of(with_symmetry(program)).trigonometric == 2
    same(program, with_symmetry(program))


LARGE, NEAR = sp.Gt(R, 1), sp.Lt(X, 2)


def shape(items: tuple[Item, ...]) -> list[object]:
    """Names in order; a choice as its condition and its two sides."""
    found: list[object] = []
    for item in items:
        if isinstance(item, If):
            found.append((item.condition, shape(item.holds), shape(item.fails)))
        else:
            found.append(item.name if isinstance(item, Let) else "require")
    return found


def test_a_choice_that_a_number_decides_is_decided_with_it() -> None:
    """`stays` is 1 where X is near, and then nobody needs the long way round."""
    stays, long_way = real("stays"), real("long_way")
    body = [
        Let(long_way, sp.sin(Y)),
        Let(stays, Select(NEAR, sp.Integer(1), Select(sp.Gt(long_way, 0), sp.Integer(1), sp.Integer(0)))),
        Let(A, Select(sp.Gt(stays, 0), Y, long_way)),
        Let(B, Select(sp.Gt(stays, 0), R, long_way + 1)),
    ]
    (arms,) = scheduled(body, [A, B])
    assert isinstance(arms, If) and arms.condition == NEAR
    assert arms.holds == (Let(A, Y), Let(B, R))
    assert shape(arms.fails)[0] == long_way


def test_what_needs_a_choice_before_it_is_not_gathered_with_that() -> None:
    """E needs F, which needs C and is needed outside: there are two choices."""
    body = [
        Let(A, Select(LARGE, X, Y)),
        Let(C, Select(LARGE, X + 1, Y + 1)),
        Let(F, A + C),
        Let(D, Select(LARGE, F, Y)),
        Let(E, Select(LARGE, F + 1, X)),
    ]
    assert shape(scheduled(body, [D, E, F])) == [(LARGE, [A, C], [A, C]), F, (LARGE, [D, E], [D, E])]


def test_a_condition_is_not_crossed() -> None:
    """Choices on both sides of a refusal stay on their sides."""
    refused = Require(NEAR, Status.UNREACHABLE)
    body = [Let(A, Select(LARGE, X, Y)), refused, Let(B, Select(LARGE, Y, X))]
    assert scheduled(body, [A, B]) == tuple(body)


def test_what_only_second_sides_read_is_bound_on_each_of_them() -> None:
    body = [
        Let(D, sp.sin(Y)),
        Let(A, Select(LARGE, X, D)),
        Let(B, Select(LARGE, X + 1, D + 1)),
        Let(C, Select(NEAR, Y, D + A)),
        Let(E, Select(NEAR, Y + 1, D + B)),
    ]
    assert shape(scheduled(body, [A, B, C, E])) == [(LARGE, [A, B], [D, A, B]), (NEAR, [C, E], [D, C, E])]


def refusing(*body: Statement) -> Program:
    return normalise("branch", body, [Output("a", A), Output("b", B)])


def test_a_choice_waits_for_what_it_needs() -> None:
    """B needs the solution of an equation, which stays behind the refusal."""
    first, refused, last = (
        Let(A, Select(LARGE, X, Y)),
        Require(sp.Gt(A, 0), Status.UNREACHABLE),
        Let(B, Select(LARGE, Y, D)),
    )
    program = refusing(first, refused, Solve((D,), (E,), (F,)), last)
    assert [type(item).__name__ for item in structured(program)] == ["Let", "Require", "Solve", "Let"]


def test_what_a_later_choice_needs_does_not_go_before_an_earlier_one() -> None:
    """C stands first, and only the second side of the second choice needs it."""
    body = [
        Let(C, sp.sin(Y)),
        Let(A, Select(NEAR, X, Y)),
        Let(D, Select(NEAR, X + 1, Y + 1)),
        Let(B, Select(LARGE, A, C)),
        Let(E, Select(LARGE, D, C + 1)),
    ]
    assert shape(scheduled(body, [A, B, D, E])) == [(NEAR, [A, D], [A, D]), (LARGE, [B, E], [B, E])]
