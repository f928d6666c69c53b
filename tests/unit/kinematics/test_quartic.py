"""Residuals of trials as waves in the scanned joint: which are a conic, and that they are the residuals."""

import numpy as np
import pytest
import sympy as sp

from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select, ToReal
from derive.ir.program import FindRoot, Let, Output, Program, shared
from derive.ir.symbols import SIDE, TRIED, real
from derive.kinematics.build import build
from derive.kinematics.scan.choice import with_search
from derive.kinematics.scan.derivations import solve_both, trial_on_branch
from derive.kinematics.scan.quartic import Quartic, quartic_of
from derive.kinematics.scan.waves import wave_at
from derive.kinematics.solution import prepared
from tests.machines.chain_machines import ANGLES_AS_NUMBERS, OF_DEGREE_FOUR
from tests.machines.searched_machines import POINTS, SEARCHED

C, S, W, A, B = (real(n) for n in ("c", "s", "w", "a", "b"))
SIGN = real("sign")
OWN = (Let(C, sp.cos(TRIED)), Let(S, sp.sin(TRIED)), Let(SIGN, ToReal(SIDE)))
ARMS = {**OF_DEGREE_FOUR, **POINTS}


def values(program: Program, samples: dict[str, np.ndarray]) -> np.ndarray:
    outputs, _ = run(program, samples)
    return np.asarray(outputs["value"])


def of_quartic(quartic: Quartic) -> Program:
    c, s = sp.cos(TRIED), sp.sin(TRIED)
    value = wave_at(quartic.plain, c, s) + ToReal(SIDE) * quartic.factor * Root(wave_at(quartic.square, c, s))
    return normalise("conic", quartic.statements, [Output("value", value)])


def searched(mechanism: Mechanism) -> Mechanism:
    return with_search(prepared(validate(mechanism)))


@pytest.mark.parametrize(
    ("statements", "value"),
    [
        ((), (A + B * C) * (S - 2 * B) + C**2 / B),
        ((Let(W, Root((A * C + B) ** 2 + S**2)),), W**2 - A * C),
        ((Let(W, Root(1 - A**2 * C**2)),), (A - W * SIGN) ** 2 + B * S + A**2 * C**2),
        ((Let(W, SIGN * Root(1 - A * C)), Let(B, A - W)), (A - W) ** 2 - B**2 + W * A),
        ((Let(W, Root(B - C)), Let(A, W**2 - B)), A**2 + S * A),
    ],
)
def test_the_conic_is_the_value(statements: tuple[Let, ...], value: sp.Expr) -> None:
    """Products, squares, roots that are squared, one root alone, names in between."""
    quartic = quartic_of((*OWN, *statements), value)
    assert quartic is not None
    program = normalise("value", (*OWN, *statements), [Output("value", value)])
    rng = np.random.default_rng(1)
    samples = {"tried": rng.uniform(-3.0, 3.0, 50), "side": rng.choice([-1.0, 1.0], 50)}
    samples |= {"a": rng.uniform(0.1, 0.9, 50), "b": rng.uniform(1.0, 2.0, 50)}
    assert np.abs(values(program, samples) - values(of_quartic(quartic), samples)).max() < 1e-13


@pytest.mark.parametrize(
    ("statements", "value"),
    [
        ((), C**3 - A),
        ((), A / (B + C)),
        ((Let(W, Root(B + C)),), C**2 + W),
        ((Let(W, Root(B + C)),), A + W * S),
        ((Let(W, Root(B + C**2 * S)),), A + W),
        ((Let(W, Select(sp.Gt(C, 0), C, A)),), A + W),
        ((Let(W, Root(2 + C)), Let(B, Root(2 + S))), A + W * B),
        ((Let(W, Root(2 + C)), Let(B, Root(2 + S + W))), A + B),
    ],
)
def test_what_is_no_conic_is_none(statements: tuple[Let, ...], value: sp.Expr) -> None:
    assert quartic_of((*OWN, *statements), value) is None


def test_what_cancels_is_seen() -> None:
    """Two cubes that are equal, though their coefficients have other names."""
    first, second = real("first"), real("second")
    cubes = (Let(W, (A * C + B) * (C + 1)), Let(first, W * S), Let(second, (A * C * (C + 1) + B * (C + 1)) * S))
    quartic = quartic_of((*OWN, *cubes), first - second + C)
    assert quartic is not None and {*quartic.plain} == {1}


@pytest.mark.long
@pytest.mark.parametrize("name", ARMS)
def test_the_residual_of_an_arm_is_its_conic(name: str) -> None:
    """On both sides, where the arm is within its reach."""
    mechanism = searched(ARMS[name])
    trial = trial_on_branch(solve_both(mechanism))
    quartic = quartic_of(trial.statements, trial.value)
    assert quartic is not None and quartic.has_sides == (name in POINTS)
    outputs = [Output("value", trial.value), Output("guard", trial.guard)]
    program, conic = normalise("trial", trial.statements, outputs), of_quartic(quartic)
    rng = np.random.default_rng(2)
    read = {s.name for p in (program, conic) for s in p.inputs}
    samples = {n: rng.uniform(50.0, 300.0, 80) for n in sorted(read)} | {"reach_a": np.full(80, 250.0)}
    samples |= {
        "tried": rng.uniform(-3.0, 3.0, 80),
        "side": rng.choice([-1.0, 1.0], 80),
        "machine_scale": np.full(80, 500.0),
    }
    samples |= {n: rng.choice([-1.0, 1.0], 80) for n in read if n.startswith("wanted")}
    samples |= {n: np.full(80, 60.0) for n in read if n.startswith("angle")}
    apart = np.abs(values(program, samples) - values(conic, samples))
    is_within = np.broadcast_to(run(program, samples)[0]["guard"] >= 0.0, 80)
    assert is_within.sum() > 30 and apart[is_within].max() < 1e-11


@pytest.mark.slow
@pytest.mark.parametrize("name", [*ARMS, *SEARCHED])
def test_an_arm_whose_residual_is_a_conic_is_not_scanned(name: str) -> None:
    """And its notes say so; all others are scanned as before."""
    kinematics = build(validate({**ARMS, **SEARCHED}[name]))
    (search,) = (s for p in shared([kinematics.branch]) for s in p.body if isinstance(s, FindRoot))
    assert search.is_listed == (name in ARMS)
    assert len(search.sides) == {True: 5, False: 0}[name in OF_DEGREE_FOUR] + 10 * (name in POINTS)
    told = " ".join(kinematics.mechanism.notes)
    assert ("four roots in closed form" in told) == search.is_listed
    assert ("No closed form is known" in told) != search.is_listed


@pytest.mark.long
def test_an_arm_of_six_axes_by_a_table_is_scanned() -> None:
    trial = trial_on_branch(solve_both(searched(ANGLES_AS_NUMBERS)))
    assert quartic_of(trial.statements, trial.value) is None
