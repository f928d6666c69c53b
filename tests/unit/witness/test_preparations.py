"""A fault in what the compiler makes of a description before it derives: the witness notices each, by itself.

It compares with the description as it is written. So a length that is read as another one, a gear that is turned round
and a rod that is read elsewhere contradict it, however consistent all that is derived from them.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import pytest
import sympy as sp

from derive.description.mechanism import Mechanism, Parameter, Role, Task, branch, length, linear, rotary
from derive.description.validate import validate
from derive.form import machine as form
from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.geometry.frames import Motion
from derive.kinematics import solution as stages
from derive.kinematics.build import build
from derive.mechanism import Turning
from derive.witness import Disagreement, witness
from tests.machines.guided import GUIDED
from tests.machines.spherical_machines import SPHERICAL
from tests.mechanisms import named
from tests.unit.form.test_chain import LOOPS, delta
from tests.unit.plate.test_stated_rods import stated

A1, A2, A3 = (rotary(f"A{k}", "turn") for k in (1, 2, 3))
Z = linear("Z", "quill")
REACH, FIRST = (length(n, "link", nominal=v) for n, v in (("reach", 320.0), ("first", 250.0)))
ELBOW = branch("elbow", sp.sin(A2), right=+1, left=-1)
Spoil = Callable[[Mechanism], Mechanism]


def scara(chain: Chain, *parameters: Parameter, **stated: object) -> Mechanism:
    common = {"joints": (A1, A2, A3, Z), "task": Task("xyz", Turning.ABOUT_Z), "branches": (ELBOW,)}
    made = Mechanism(name="Prepared", chain=chain, parameters=parameters, **{**common, **stated})  # type: ignore[arg-type]
    return validate(made)


def numbers(mechanism: Mechanism, role: Role, change: Callable[[sp.Expr], sp.Expr]) -> Mechanism:
    """The mechanism with the value of its first named number changed."""
    first = next(p for p in mechanism.parameters if p.fixed is not None and p.role is role)
    value = change(first.fixed)
    changed = replace(first, fixed=value, nominal=float(value))
    return replace(mechanism, parameters=tuple(changed if p is first else p for p in mechanism.parameters))


def exchanged(mechanism: Mechanism) -> Mechanism:
    """The mechanism with its first two parameters exchanged in the chain."""
    one, other = (p.symbol for p in mechanism.parameters[:2])
    return in_chain(mechanism, {one: other, other: one})


def in_chain(mechanism: Mechanism, table: Mapping[sp.Expr, sp.Expr]) -> Mechanism:
    assert mechanism.chain is not None
    factors = (replace(f, amount=f.amount.subs(table, simultaneous=True)) for f in mechanism.chain.factors)
    return replace(mechanism, chain=Chain(tuple(factors)))


def turned_round(mechanism: Mechanism) -> Mechanism:
    """The mechanism with the gear of its first joint turned round."""
    first, *others = mechanism.joints
    assert first.ratio != 1
    return replace(mechanism, joints=(replace(first, ratio=-first.ratio), *others))


def without_a_sign(mechanism: Mechanism) -> Mechanism:
    """The mechanism with its last shift turned round."""
    assert mechanism.chain is not None
    factors = list(mechanism.chain.factors)
    last = max(k for k, f in enumerate(factors) if f.motion is Motion.SHIFT)
    factors[last] = replace(factors[last], amount=-factors[last].amount)
    return replace(mechanism, chain=Chain(tuple(factors)))


def other_rod(mechanism: Mechanism) -> Mechanism:
    """The mechanism with its first rod a tenth longer."""
    first, *others = mechanism.rods
    return replace(mechanism, rods=(replace(first, length=first.length * sp.Rational(11, 10)), *others))


def other_plane(mechanism: Mechanism) -> Mechanism:
    """The mechanism with the points of its last two planes exchanged."""
    *others, first, second = mechanism.guides
    ends = replace(first, plate=second.plate), replace(second, plate=first.plate)
    return replace(mechanism, guides=(*others, *ends))


@dataclass(frozen=True)
class Planted:
    """A preparation, by its name, a machine that it prepares, and a fault in what it makes of it."""

    preparation: str
    machine: Mechanism
    spoil: Spoil


ARM = Rz(A1) * Tx(250) * Rz(A2) * Tx(200) * Rz(A3) * Tz(Z)
HANGING = Rx(sp.pi) * Rz(A1) * Tx(REACH) * Rz(A2) * Tx(FIRST) * Rz(A3) * Ty(35) * Tz(Z)
PLANTED: Mapping[str, Planted] = {
    "250 read as 500": Planted(
        "with_named_numbers", scara(ARM), lambda m: numbers(m, Role.LENGTH, lambda v: 2 * v)
    ),
    "30 degrees read as 60": Planted(
        "with_named_numbers",
        scara(Rz(A1) * Tx(250) * Rz(A2) * Tx(200) * Rz(A3 + sp.pi / 6) * Ty(40) * Tz(Z)),
        lambda m: numbers(m, Role.ANGLE, lambda v: 2 * v),
    ),
    "two names exchanged": Planted(
        "with_inner_names", scara(Rz(A1) * Tx(REACH) * Rz(A2) * Tx(FIRST) * Rz(A3) * Tz(Z), REACH, FIRST), exchanged
    ),
    "a joint named as another": Planted(
        "with_inner_names",
        scara(Rz(A1) * Tx(REACH) * Rz(A2) * Tx(FIRST) * Rz(A3) * Tz(Z), REACH, FIRST, branches=()),
        lambda m: in_chain(m, {A1.symbol: A2.symbol, A2.symbol: A1.symbol}),
    ),
    "a gear turned round": Planted(
        "with_gears", scara(Rz(A1 / 3) * Tx(250) * Rz(A2) * Tx(200) * Rz(A3) * Tz(Z)), turned_round
    ),
    "a half turn that turns one sign too few": Planted(
        "with_normal_chain", scara(HANGING, REACH, FIRST), without_a_sign
    ),
    "a frame turned the other way": Planted(
        "with_normal_chain",
        scara(Rz(A1) * Tx(REACH) * Rx(sp.pi / 2) * Ry(A2) * Tx(FIRST) * Ty(Z) * Ry(A3) * Rx(-sp.pi / 2), REACH, FIRST),
        lambda m: in_chain(m, {A2.symbol: -A2.symbol}),
    ),
    "a right angle read as two": Planted(
        "with_exact_angles",
        scara(Rz(A1 + 1.5708) * Tx(REACH) * Rz(A2) * Tx(FIRST) * Rz(A3) * Tz(Z), REACH, FIRST),
        lambda m: in_chain(m, {sp.pi: 2 * sp.pi}),
    ),
    "250 degrees read as another angle": Planted(
        "with_named_loop_angles", delta(0, 120, 250), lambda m: numbers(m, Role.ANGLE, lambda v: v + 1)
    ),
    "a pen on another extension": Planted(
        "with_plain_rods",
        LOOPS["the pen on an extension"],
        lambda m: replace(m, rods=(m.rods[0], *other_rod(replace(m, rods=m.rods[1:])).rods)),
    ),
    "a rod read as another": Planted(
        "with_stated_rods", stated(named("Softkin_Planar_3RRR")), other_rod
    ),
    "planes read at each other's points": Planted(
        "with_stated_rods", GUIDED["head in metres whose planes form a T, stated as equations"], other_plane
    ),
    "a fixed angle read as another": Planted(
        "with_fixed_point", SPHERICAL["camera on three curved arms"], other_rod
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("what", PLANTED)
def test_a_fault_of_a_preparation_is_noticed(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is derived from the spoiled mechanism agrees with itself, and contradicts the description."""
    planted = PLANTED[what]
    place = form if hasattr(form, planted.preparation) else stages
    prepare = getattr(place, planted.preparation)
    assert witness(build(planted.machine), planted.machine).poses
    monkeypatch.setattr(place, planted.preparation, lambda *given: planted.spoil(prepare(*given)))
    spoiled = build(planted.machine)
    assert witness(spoiled, spoiled.mechanism).poses, "the fault is one that only the description shows"
    with pytest.raises(Disagreement):
        witness(spoiled, planted.machine)
