"""Mirrored branches: the program before and after has the same answers, with fewer operations."""

from __future__ import annotations

import numpy as np
import sympy as sp

from derive.ir.constants import (
    DEGREE,
)
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import (
    Atan2,
    NearestPeriod,
    Select,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
)
from derive.ir.symbols import (
    real,
)
from derive.optimize.symmetry import with_mirrored_branches

A, B, C, D, N, R, T, X, Y = (real(n) for n in "abcdnrtxy")
C_DOWN, C_UP, S_DOWN, S_UP, M_DOWN, M_UP = (real(n) for n in ("c_down", "c_up", "s_down", "s_up", "m_down", "m_up"))
AXIS_DOWN, AXIS_UP = real("axis_down"), real("axis_up")
REGULAR = sp.Gt(R, 1)


def wrist() -> Program:
    """A wrist and the same turned over: where it is not regular, both are at the same angle."""
    lets = [
        Let(C_DOWN, Select(REGULAR, X / 2, sp.cos(T))),
        Let(S_DOWN, Select(REGULAR, Y / 2, sp.sin(T))),
        Let(C_UP, Select(REGULAR, -X / 2, sp.cos(T))),
        Let(S_UP, Select(REGULAR, -Y / 2, sp.sin(T))),
        Let(M_DOWN, A * C_DOWN + B * S_DOWN),
        Let(M_UP, A * C_UP + B * S_UP),
        Let(AXIS_DOWN, NearestPeriod(D + Atan2(M_DOWN, C_DOWN) / DEGREE, N)),
        Let(AXIS_UP, NearestPeriod(D + Atan2(M_UP, C_UP) / DEGREE, N)),
    ]
    return normalise("wrist", lets, [Output("down", AXIS_DOWN), Output("up", AXIS_UP)])


def values(program: Program) -> dict[str, sp.Expr]:
    return {let.name.name: let.value for let in program.lets()}


def same(first: Program, second: Program) -> None:
    random = np.random.default_rng(3)
    given = {s.name: random.uniform(-3, 3, 200) for s in {*first.inputs, *second.inputs}}
    (wanted, _), (found, _) = (run(p, {s.name: given[s.name] for s in p.inputs}) for p in (first, second))
    for name, value in wanted.items():
        np.testing.assert_allclose(found[name], value, rtol=1e-12, atol=1e-11)


def test_a_value_is_the_negative_of_its_mirror_image_where_that_is_so() -> None:
    """A value of the mirrored branch is the negative of the other one where the condition of the symmetry holds."""
    found = values(with_mirrored_branches(wrist()))
    assert found["m_up"] == Select(REGULAR, -M_DOWN, A * C_UP + B * S_UP)


def test_an_angle_is_half_a_turn_from_its_mirror_image() -> None:
    """The angle of the mirrored branch is the other angle plus half a turn where the symmetry holds."""
    found = values(with_mirrored_branches(wrist()))
    direction, other = real("direction_of_axis_up"), D + Atan2(M_UP, C_UP) / DEGREE
    assert found[direction.name] == Select(REGULAR, AXIS_DOWN + 180, other)
    assert found["axis_up"] == NearestPeriod(direction, N)
    same(wrist(), with_mirrored_branches(wrist()))


def test_an_angle_mirrored_at_its_shift_needs_no_condition() -> None:
    """An angle with the opposite sine is mirrored at its shift, on all poses."""
    lets = [
        Let(AXIS_DOWN, NearestPeriod(D + Atan2(X, Y) / DEGREE, N)),
        Let(AXIS_UP, NearestPeriod(D + Atan2(-X, Y) / DEGREE, N)),
    ]
    program = normalise("mirrored", lets, [Output("down", AXIS_DOWN), Output("up", AXIS_UP)])
    assert values(with_mirrored_branches(program))["axis_up"] == NearestPeriod(2 * D - AXIS_DOWN, N)
    same(program, with_mirrored_branches(program))


def test_another_value_on_the_other_side_is_no_mirror_image() -> None:
    """The second sides of C differ: then nothing is known of it, and the sum stays as it is."""
    lets = [
        Let(C_DOWN, Select(REGULAR, X / 2, sp.cos(T))),
        Let(C_UP, Select(REGULAR, -X / 2, sp.sin(T))),
        Let(M_DOWN, A * C_DOWN),
        Let(M_UP, A * C_UP),
    ]
    program = normalise("other", lets, [Output("down", M_DOWN + 1), Output("up", M_UP + 1)])
    assert with_mirrored_branches(program) == program


def test_an_angle_that_is_no_turn_is_left_alone() -> None:
    """Its value counts, not its direction: half a turn more would be another value."""
    lets = [Let(AXIS_DOWN, Atan2(X, Y) / DEGREE), Let(AXIS_UP, Atan2(-X, -Y) / DEGREE)]
    program = normalise("single", lets, [Output("down", AXIS_DOWN + 1), Output("up", AXIS_UP + 1)])
    assert with_mirrored_branches(program) == program
