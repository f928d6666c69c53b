"""Arms that no rule solves: refused with the reason, before large expressions are written out."""

import re
from collections.abc import Sequence

import pytest
import sympy as sp

from derive.description.mechanism import (
    DescriptionError,
    Joint,
    Mechanism,
    Parameter,
    Task,
    Turning,
    length,
    linear,
    rotary,
)
from derive.geometry.frames import Chain, Rx, Ry, Rz, Tx, Txyz, Ty, Tz
from derive.kinematics.build import build
from derive.solver import eliminations, solve
from derive.solver.unsolved import Unsolved
from tests.unit.kinematics.inventions import described

pytestmark = pytest.mark.slow

LENGTHS = tuple(length(f"l{k}", f"length {k}", nominal=100.0 + 17.0 * k) for k in range(14))
JOINTS = tuple(rotary(f"A{k}", f"axis {k}", value=f"q{k}") for k in range(1, 7))
A1, A2, A3, A4, A5, A6 = JOINTS
TRACK, QUILL = linear("E1", "track"), linear("E2", "quill")
L = LENGTHS

_SHOULDER_AND_ARM = Rz(A1) * Tz(L[0]) * Ry(A2) * Tz(L[1]) * Ry(A3) * Txyz(L[3], 0, L[2])
_WRIST_BETWEEN_SLIDES = Rz(A1) * Ty(L[0]) * Ry(A2) * Tx(L[1]) * Rx(A3) * Ty(L[2])
_NO_POINT = (
    "it would help if the axes of A1, A2, A3 met in one point, which they miss by 100, "
    'or if the axes of A1, A2, A3 were parallel, which they miss by 90°; with task=Task("xyz", Turning.NONE), '
    "held=(A3, E2) these joints are solved"
)
_TOO_MANY = (
    "one joint too many: the task commands 6 quantities (x, y, z, turn x, turn y, turn z), and 7 joints are to be "
    "solved for; name the one that is held at the reference: held=(E1,)"
)


def arm(chain: Chain, joints: Sequence[Joint], turning: Turning = Turning.FULL) -> Mechanism:
    """An arm for the whole pose, or for its direction."""
    used = {s for factor in chain.factors for s in factor.amount.free_symbols}
    parameters: tuple[Parameter, ...] = tuple(p for p in LENGTHS if p.symbol in used)
    return described(
        parameters=parameters, joints=tuple(joints), chain=chain, task=Task("xyz", turning), offset_interface=False
    )


REFUSED = {
    "three turns between two slides": (
        arm(
            Tx(TRACK) * _WRIST_BETWEEN_SLIDES * Tz(QUILL) * Tx(L[3]) * Ry(1),
            (TRACK, A1, A2, A3, QUILL),
            Turning.PITCH_ROLL,
        ),
        _NO_POINT,
    ),
    "an arm on a track": (
        arm(Tx(TRACK) * _SHOULDER_AND_ARM * Rx(A4) * Ry(A5) * Rx(A6) * Tx(L[5]), (TRACK, *JOINTS)),
        _TOO_MANY,
    ),
}
_MOST_PRODUCTS = 3000
"""Products of terms that are written out; one sum of squares of the general arm has 15,000."""
_MOST_ROUNDS = 200
"""Sets of equations in which every rule looks for a step."""


@pytest.mark.parametrize("kind", REFUSED)
def test_refused_with_the_reason_and_within_bounds(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    mechanism, message = REFUSED[kind]
    products, rounds = 0, 0
    reduce_units, candidates = eliminations.reduce_units, solve._candidates

    def reduced(expression: sp.Expr, *rest: object) -> sp.Expr:
        nonlocal products
        squared = [p for p in expression.atoms(sp.Pow) if p.base.is_Add]
        products += sum(len(p.base.args) ** 2 for p in squared)
        return reduce_units(expression, *rest)  # type: ignore[arg-type]

    def asked(*arguments: object) -> object:
        nonlocal rounds
        rounds += 1
        return candidates(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(eliminations, "reduce_units", reduced)
    monkeypatch.setattr(solve, "_candidates", asked)
    with pytest.raises((Unsolved, DescriptionError), match=re.escape(message)) as refusal:
        build(mechanism)
    assert products <= _MOST_PRODUCTS and rounds <= _MOST_ROUNDS
    assert len(str(refusal.value)) <= 600
