"""Programs of regular poses: what they answer is what the whole program answers, and elsewhere they say so."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism
from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, NearestPeriod, Select
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Solve, Status
from derive.ir.symbols import flag, real
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.sampling import machine_at, sample_axes
from derive.optimize.regular import regular
from derive.optimize.without_periods import specialised
from tests.mechanisms import catalogue, kinematics_of

X, Y, LENGTH, ANGLE, AXIS, HIGH = (real(name) for name in ("x", "y", "length", "angle", "axis", "high"))
Array = NDArray[np.float64]
POSES = 200
CLOSE = 1e-9
NEWTON_OR_SOLVE = (Solve, Iterate, Call)


def seen(program: Program) -> Program:
    """The program with a status of its own where it has no answer, which the interpreter shows."""
    body = [replace(s, otherwise=Status.IMPOSSIBLE) if isinstance(s, Require) else s for s in program.body]
    return replace(program, body=tuple(body))


def conditions(program: Program) -> list[sp.Basic]:
    return [r.condition for r in program.requires()]


def test_a_choice_of_the_machine_stays() -> None:
    """It does not depend on the pose."""
    lies = flag("lies")
    one = normalise("p", [Let(AXIS, Select(lies, X, Y))], [Output("axis", AXIS)])
    found = regular(one, {"lies"})
    assert found is not None and not conditions(found) and found.lets()[0].value == Select(lies, X, Y)


def test_a_turn_is_asked_for() -> None:
    """An axis that was put on its turn is within half a turn of its centre; a number that is none is not."""
    turn = NearestPeriod(Atan2(Y, X) / DEGREE, HIGH)
    one = normalise("p", [Let(AXIS, turn)], [Output("axis", AXIS)])
    found = regular(one, {"high"})
    assert found is not None
    values = {"x": np.array([1.0, -1.0, np.nan]), "y": np.array([0.0, 1e-3, 0.0]), "high": np.full(3, 700.0)}
    _, statuses = run(seen(found), values)
    assert [s is Status.OK for s in statuses] == [True, True, False]


def test_what_is_no_arithmetic() -> None:
    """Linear equations, and a sine that the first side itself takes."""
    solved = Solve((X,), (Y,), (Y,))
    assert regular(Program("p", (Y,), (solved,), (Output("x", X),)), ()) is None
    assert regular(normalise("p", [Let(AXIS, sp.sin(X))], [Output("axis", AXIS)]), ()) is None


@pytest.mark.broad
@pytest.mark.long("Ac6", "P2C", "Pos_RRR", "Wrist2")
@pytest.mark.parametrize("mechanism", [m for _, m in catalogue()], ids=lambda m: m.name)
def test_the_same_answers(mechanism: Mechanism) -> None:
    """At random poses, and where axes are at multiples of 90 degrees: the answer of the whole program, or none. Most
    random poses have one.
    """
    kin = kinematics_of(mechanism)
    one = specialised(kin.branch, {j.turn: sp.Integer(0) for j in kin.period_joints})
    found = regular(one, {o.name for o in kin.setup.outputs})
    if found is None:  # then the whole program has more than arithmetic
        assert any(isinstance(s, NEWTON_OR_SOLVE) for s in one.body) or any(let.value.has(sp.sin) for let in one.lets())
        return
    for seed, cornered in ((1, False), (2, True)):
        values = asked(kin, seed, cornered)
        for signs in product((1, -1), repeat=len(kin.branches)):
            given = values | {f"sigma_{b.name}": np.asarray(s) for b, s in zip(kin.branches, signs, strict=True)}
            expected, whole = run(one, given)
            answers, statuses = run(seen(found), given)
            good = statuses == Status.OK
            assert (whole[good] == Status.OK).all()
            for name, value in answers.items():
                own, other = (np.broadcast_to(v, good.shape)[good] for v in (value, expected[name]))
                assert np.abs(own - other).max(initial=0.0) <= CLOSE * (1.0 + np.abs(other).max(initial=0.0))
            if not cornered:
                assert good.sum() >= 0.8 * (whole == Status.OK).sum()


def asked(kin: Kinematics, seed: int, cornered: bool) -> dict[str, Array]:
    mechanism = kin.mechanism
    parameters = machine_at(mechanism)
    axes = sample_axes(mechanism, parameters, POSES, seed)
    for joint in mechanism.joints if cornered else ():
        if joint.in_degrees:
            axes[joint.axis.name] = 90.0 * np.round(axes[joint.axis.name] / 90.0)
    constants, _ = run(kin.setup, parameters)
    pose, _ = run(kin.forward, constants | axes)
    references = {j.reference.name: axes[j.axis.name] + 400.0 for j in mechanism.joints}
    return {**constants, **pose, **references}
