"""What parameters alone decide is refused by the set-up, and asked again by no call; what ranges exclude by nobody."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from sympy import pi

from derive.description.catalogue import MECHANISMS, load
from derive.description.dimensions import angle, distance
from derive.description.mechanism import Mechanism, Task, Turning, linear, radians, rotary
from derive.geometry.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.ir.interpret import run
from derive.ir.program import Require, Status
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics

NUTATING = load(MECHANISMS / "softkin_nutatinghead_cb.py")
X, Y, Z = linear("X", "Rails"), linear("Y", "Beam"), linear("Z", "Up")
A1, A3, A4, A5 = (rotary(f"A{k}", f"turn {k}") for k in (1, 3, 4, 5))
SIDE, FORE, TOOL = (distance(name, name, nominal=100.0) for name in ("side", "fore", "tool"))


def nutating(low: float) -> Mechanism:
    """The head whose axis may be inclined by any angle from this one on."""
    parameters = tuple(replace(p, low=low) if p.name == "nutation" else p for p in NUTATING.parameters)
    return replace(NUTATING, parameters=parameters)


def skewed(low: float) -> Mechanism:
    """A gantry whose beam stands at any angle from this one on to its rails."""
    skew = angle("skew", "Rails to the beam", nominal=80.0, low=low, high=179.0)
    chain = Tx(X) * Rz(radians(skew)) * Tx(Y) * Rz(-radians(skew)) * Tz(Z)
    return Mechanism(name="Kin_Skewed", parameters=(skew,), joints=(X, Y, Z), chain=chain, task=Task("xyz"))


def constants_asked(kin: Kinematics) -> list[Require]:
    """The conditions of one branch that read nothing but constants of the machine."""
    constants = {o.name for o in kin.setup.outputs}
    return [s for s in kin.branch.body if isinstance(s, Require) and {n.name for n in s.reads()} <= constants]


def status(kin: Kinematics, **given: float) -> Status | None:
    inputs = {p.name: np.array([given.get(p.name, p.nominal)]) for p in kin.parameters}
    found: Status | None = run(kin.setup, inputs)[1][0]
    return found


@pytest.mark.parametrize(("described", "name"), [(nutating, "nutation"), (skewed, "skew")])
def test_the_set_up_refuses_what_parameters_decide(described: Callable[[float], Mechanism], name: str) -> None:
    open_range, closed_range = build(described(0.0)), build(described(1.0))
    assert constants_asked(open_range) == constants_asked(closed_range) == []
    assert len(open_range.mechanism.constraints) == 1 and closed_range.mechanism.constraints == ()
    assert status(open_range, **{name: 0.0}) is Status.NOT_INITIALIZED
    assert status(open_range, **{name: 0.1}) is status(closed_range, **{name: 1.0}) is Status.OK
    assert status(closed_range, **{name: 0.9}) is Status.NOT_INITIALIZED


def test_an_angle_that_the_description_states_as_a_number_has_no_range() -> None:
    """An angle in sevenths of a turn is a symbol over that of a degree; the set-up asks lengths beside it."""
    mechanism = Mechanism(
        name="Kin_Sevenths",
        joints=(A1, Z, A3, A4, A5),
        parameters=(SIDE, FORE, TOOL),
        chain=Rx(A1) * Ty(SIDE) * Tz(Z) * Rx(A3) * Ty(FORE) * Ry(A4) * Tx(FORE) * Rz(5 * pi / 7) * Ry(A5) * Tz(TOOL),
        task=Task("xyz", Turning.DIRECTION),
    )
    assert build(mechanism).mechanism.search is None
