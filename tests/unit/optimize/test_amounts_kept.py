"""Programs that are rewritten tell the same amounts."""

import numpy as np
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select
from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.reason import Why, about
from derive.ir.symbols import real
from tests.unit.answers import plain_directions, shorter

C, S, L, N, R, T, U, V, ANGLE, AXIS = map(
    real, ("cos_q1", "sin_q1", "l", "n", "r", "t", "u", "v", "angle_q1", "axis_a1")
)
REGULAR = sp.Gt(R, 1)
DIRECTION = (
    Let(L, Select(REGULAR, Root(U**2 + V**2), sp.Integer(1))),
    Let(C, Select(REGULAR, U / L, sp.cos(T))),
    Let(S, Select(REGULAR, V / L, sp.sin(T))),
)
TURN = Let(AXIS, NearestPeriod(Atan2(S, C) / DEGREE, N), turn_of="A1")


def refusing(amount: sp.Expr) -> Program:
    require = Require(sp.Gt(R, 0), Status.UNREACHABLE, reason=about("it", Why.TOO_LARGE, amount))
    turned = NearestPeriod(ANGLE / DEGREE, sp.Integer(0))
    earlier = Require(sp.Le(turned, 175), Status.UNREACHABLE, reason=about("angle", Why.TOO_LARGE))
    return normalise("p", [*DIRECTION, Let(ANGLE, Atan2(S, C)), earlier, require, TURN], [Output("axis", AXIS)])


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
    for amount in (C, 2 * S + C, L + S):
        program = refusing(amount)
        for changed in (plain_directions(program), shorter(program)):
            np.testing.assert_allclose(amounts(changed), amounts(program), rtol=1e-12, atol=1e-12)


def test_an_amount_that_reads_nothing_of_it_changes_nothing() -> None:
    """A direction is not divided where the amount of a reason reads something else."""
    found = plain_directions(refusing(U + R))
    assert "direction_x_q1" in {name.name for name in found.bound()}
    np.testing.assert_allclose(amounts(found), amounts(refusing(U + R)))
