"""Cross products of columns: the program before and after, on rotations, and where the direction is free."""

import numpy as np
import pytest
import sympy as sp

from derive.ir.constants import FREE_ANGLE, KNOWN_ANGLE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import ROTATION_ENTRIES, real
from derive.ir.tree import If
from derive.lowering.scheduling import scheduled
from derive.optimize.rotation_identities import with_rotation_identities

R = sp.Matrix(3, 3, ROTATION_ENTRIES)
T, U, MADE_X, MADE_Y = (real(n) for n in ("t", "u", "made_x", "made_y"))
C1, S1 = real("cos_q1"), real("sin_q1")
RADIUS, DX, DY = real("radius"), real("direction_x_q2"), real("direction_y_q2")
A, B = real("a_from_q1"), real("b_from_q1")
REGULAR = sp.Gt(RADIUS, FREE_ANGLE)


def crossed(row: int, column: int, other: int, sign: int = 1) -> Program:
    """A column turned about the axis of a row: its direction about that axis, and what it makes of another column."""
    i, j = (row + 1) % 3, (row + 2) % 3
    third = real("third_from_q1")
    lets = [
        Let(C1, sp.cos(T)),
        Let(S1, sp.sin(T)),
        Let(A, C1 * R[i, column] + S1 * R[j, column]),
        Let(B, C1 * R[j, column] - S1 * R[i, column]),
        Let(third, C1 * R[j, other] - S1 * R[i, other]),
        Let(RADIUS, Root(B**2 + R[row, column] ** 2)),
        Let(DX, Select(REGULAR, -sign * B, sp.cos(U))),
        Let(DY, Select(REGULAR, sign * R[row, column], sp.sin(U))),
        Let(MADE_Y, DX * R[row, other] + DY * third),
    ]
    return normalise("p", lets, [Output("y", MADE_Y), Output("a", A)])


def rotations(count: int) -> dict[str, np.ndarray]:
    drawn = np.linalg.qr(np.random.default_rng(1).normal(size=(count, 3, 3)))[0]
    entries = (drawn * np.linalg.det(drawn)[:, None, None]).reshape(count, 9)
    return {symbol.name: entries[:, k] for k, symbol in enumerate(ROTATION_ENTRIES)}


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("columns", [(2, 0), (2, 1), (0, 1), (1, 0)])
@pytest.mark.parametrize("row", range(3))
def test_the_third_column_takes_its_place(row: int, columns: tuple[int, int], sign: int) -> None:
    """An entry of the cross product of two columns is the entry of the third column."""
    program = crossed(row, *columns, sign)
    found = with_rotation_identities(program)
    (value,) = (let.value for let in found.lets() if let.name == MADE_Y)
    assert isinstance(value, Select) and value.args[0] == sp.Gt(RADIUS, KNOWN_ANGLE)
    assert not value.args[1].free_symbols & {DX, DY} and value.args[2].free_symbols >= {DX, DY}
    random = np.random.default_rng(2)
    given = rotations(500) | {"t": random.uniform(-3, 3, 500), "u": random.uniform(-3, 3, 500)}
    (wanted, _), (there, _) = (run(p, {s.name: given[s.name] for s in p.inputs}) for p in (program, found))
    np.testing.assert_allclose(there["y"], wanted["y"], atol=1e-14)


def test_what_is_no_such_product_is_left_alone() -> None:
    program = crossed(0, 2, 0)
    made = [s for s in program.body if isinstance(s, Let) and s.name == MADE_Y][0].value
    dx, dy = sp.Add.make_args(made)
    for other in (dx - dy, dx + 2 * dy, dx + dy + R[0, 0], dx * R[1, 1], dx):
        body = [Let(MADE_Y, other) if isinstance(s, Let) and s.name == MADE_Y else s for s in program.body]
        changed = normalise("p", body, program.outputs)
        assert with_rotation_identities(changed) == changed


def test_what_follows_from_a_condition_is_decided_with_it() -> None:
    """Above a tenth is above a smaller number, and so on: no side asks again what it knows."""
    known = sp.Gt(RADIUS, KNOWN_ANGLE)
    body = [
        Let(A, Select(REGULAR, T, U)),
        Let(B, Select(REGULAR, U, T)),
        Let(MADE_X, Select(known, T + 1, A + B)),
        Let(MADE_Y, Select(known, U + 1, A - B)),
    ]
    (arms,) = scheduled(body, [MADE_X, MADE_Y])
    assert isinstance(arms, If) and arms.condition == REGULAR
    (inner,) = (item for item in arms.holds if isinstance(item, If))
    assert inner.condition == known and inner.holds == (Let(MADE_X, T + 1), Let(MADE_Y, U + 1))
    assert not any(isinstance(item, If) for item in (*arms.fails, *inner.fails))
