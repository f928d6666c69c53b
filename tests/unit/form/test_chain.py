"""The one form of a chain and of a closed loop: the same machine, and other words for it have the same form."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from sympy import Expr, cos, pi, sin

from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.form.chain import with_normal_chain
from derive.form.machine import in_form
from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz
from derive.geometry.frames import LETTERS
from derive.ir.constants import DEGREE
from derive.ir.symbols import COORDINATE_NAMES, real
from derive.kinematics.build import build
from derive.mechanism import Task, X, Y, Z, distance, length, rod, rotary, signed_length
from derive.vectors import vector
from tests.importing.kinematics import elementary
from tests.mechanisms import catalogue
from tests.unit.form.chains import A1, A2, A3, CHAINS, LINK, P1, SIX
from tests.unit.form.rewording import reworded

MACHINES = {**CHAINS, **{m.name: m for _, m in catalogue() if m.chain is not None}}


def in_words(chain: Chain | None) -> str:
    """A chain as a description writes it."""
    assert chain is not None
    return " * ".join(f"{LETTERS[f.motion]}{'xyz'[f.axis]}({f.amount})" for f in chain.factors)


def frame(chain: Chain | None, values: dict[sp.Symbol, float]) -> np.ndarray:
    """The frame at the end of a chain (4 x 4)."""
    assert chain is not None
    found = np.eye(4)
    for factor in chain.factors:
        amount = float(factor.amount.xreplace(values | {DEGREE: np.pi / 180.0}))
        found = found @ elementary(factor.motion, factor.axis, amount)
    return found


@pytest.mark.parametrize("name", MACHINES)
def test_it_is_the_same_machine(name: str) -> None:
    """At joint values and parameters at random, with its numbers in place of their names: the same pose."""
    mechanism = MACHINES[name]
    form, rng = in_form(mechanism), np.random.default_rng(8)
    given = {p.symbol: p.nominal * rng.uniform(0.9, 1.1) for p in form.parameters if p.fixed is None}
    fixed = {p.symbol: p.nominal for p in form.parameters if p.fixed is not None}
    joints = {j.symbol: rng.uniform(-3.0, 3.0) for j in mechanism.joints}
    for seed in range(3):
        stated, words = (frame(reworded(mechanism, seed), given | joints), frame(form.chain, given | fixed | joints))
        assert np.abs(stated[:3, :3] - words[:3, :3]).max() < 1e-12
        assert np.abs(stated[:3, 3] - words[:3, 3]).max() < 1e-13 * (1.0 + np.abs(stated[:3, 3]).max())


@pytest.mark.parametrize("name", MACHINES)
def test_the_form_is_its_own_form(name: str) -> None:
    form = with_normal_chain(MACHINES[name])
    assert in_words(with_normal_chain(form).chain) == in_words(form.chain)


def formed(chain: Chain, *, turning: Mechanism = CHAINS["SCARA"]) -> str:
    """The form of the chain of a machine, in words."""
    return in_words(with_normal_chain(replace(turning, joints=(*SIX, P1), chain=chain)).chain)


FORMS = {
    "a shift stands behind the turns about its direction": (
        CHAINS["ball wrist"],
        Rz(A1) * Tx(540) * Ty(-150) * Ry(-A2) * Rx(A3),
        "Rz(a1) * Tx(540) * Ry(-a2) * Ty(-150) * Rx(a3)",
    ),
    "a right angle stands at the end": (
        CHAINS["ball wrist"],
        Rz(A1) * Rx(sp.pi / 2) * Rz(A2 + sp.pi / 2) * Tx(LINK) * Rz(A3),
        "Rz(a1) * Ry(-a2) * Tz(link) * Ry(-a3) * Rz(pi/2) * Ry(-pi/2)",
    ),
    "an arm that hangs ends in a flip": (CHAINS["SCARA"], Rx(sp.pi) * Rz(A1) * Tx(3), "Rz(-a1) * Tx(3) * flip_x(1)"),
    "a flip in front is half a turn": (CHAINS["SCARA"], Rz(A1) * Ry(sp.pi) * Tz(P1), "Rz(a1) * Tz(-p1) * flip_y(1)"),
    "turns about one line are one": (
        CHAINS["ball wrist"],
        Rz(A1) * Tz(7) * Rz(A2) * Tx(1) * Ry(A3) * Ry(-A3),
        "Rz(a1 + a2) * Tx(1) * Tz(7)",
    ),
    "turns that a slide parts are two": (CHAINS["SCARA"], Rz(A1) * Tx(P1) * Rz(A2), "Rz(a1) * Tx(p1) * Rz(a2)"),
    "an oblique link keeps its length": (
        CHAINS["SCARA"],
        Rz(A1 + 1.57) * Tx(35) * Rz(A2),
        "Rz(a1 + 1.57) * Tx(35) * Rz(a2)",
    ),
    "what twelve decimals of oblique frames leave is rounding": (
        CHAINS["ball wrist"],
        Rz(A1)
        * Tz(90.364485984607)
        * Tz(-90.364485984606)
        * Rz(-0.001)
        * Tx(-0.021999996333)
        * Ty(21.999989000001)
        * Rz(0.001)
        * Ry(A2)
        * Tz(LINK),
        "Rz(a1) * Ry(a2) * Ty(22) * Tz(link)",
    ),
    "a link stands in front of the turn behind it": (
        CHAINS["SCARA"],
        Rz(A1) * Tx(P1) * Rz(A2) * Tx(LINK) * Rz(0.5),
        "Rz(a1) * Tx(p1) * Rz(a2) * Tx(link) * Rz(0.500000000000000)",
    ),
}


@pytest.mark.parametrize("kind", FORMS)
def test_forms(kind: str) -> None:
    machine, chain, words = FORMS[kind]
    assert formed(chain, turning=machine) == words


def test_a_machine_that_differs_has_another_form() -> None:
    """What is not the same machine: the order of turns, the sense of a joint, a length, the pose of the tip."""
    chain = Rz(A1) * Tx(300) * Ry(A2) * Tz(200) * Ry(A3) * Tx(100)
    others = (
        Rz(A1) * Tx(300) * Ry(A3) * Tz(200) * Ry(A2) * Tx(100),
        Rz(A1) * Tx(300) * Ry(-A2) * Tz(200) * Ry(A3) * Tx(100),
        Rz(A1) * Tx(300) * Ry(A2) * Tz(200.001) * Ry(A3) * Tx(100),
        Rz(A1) * Tx(300) * Ry(A2 + 1e-6) * Tz(200) * Ry(A3) * Tx(100),
        chain * Rx(sp.pi / 2),
        chain * Ty(1e-3),
    )
    ball = CHAINS["ball wrist"]
    assert all(formed(other, turning=ball) != formed(chain, turning=ball) for other in others)


EXACT = {
    "decimals add up": (Tx(0.1) * Ty(P1 / 2) * Tx(0.2) * Rz(A1), "Tx(3/10) * Ty(p1/2) * Rz(a1)"),
    "a spindle": (Tx(P1 / 3000) * Rz(sp.pi / 2) * Tx(P1 / 7000) * Rz(A1), "Tx(p1/3000) * Ty(p1/7000) * Rz(a1 + pi/2)"),
    "a pitch": (Rz(A1) * Tz(-A1 * LINK / (2 * sp.pi)), "Rz(a1) * Tz(-a1*link/(2*pi))"),
    "a drive in decimals": (Tx(0.123456789012345 * P1) * Rz(A1), "Tx(24691357802469*p1/200000000000000) * Rz(a1)"),
}


@pytest.mark.parametrize("kind", EXACT)
def test_lengths_of_a_right_angled_machine_stay_exact(kind: str) -> None:
    """Whatever their digits: no length is rounded, or becomes a decimal."""
    chain, words = EXACT[kind]
    assert formed(chain) == words


BASE, PLATE = length("base", "base", nominal=180.0), length("plate", "plate", nominal=40.0)
ARM, ROD = length("arm", "arm", nominal=210.0), length("rod", "rod", nominal=480.0)
GROUND, LEFT, RIGHT = (length(n, n, nominal=v) for n, v in (("ground", 130.0), ("left", 90.0), ("right", 95.0)))
NEAR, FAR = length("near", "near", nominal=170.0), length("far", "far", nominal=185.0)
PEN, SIDE = distance("pen", "pin to pen", nominal=50.0), signed_length("side", "pin to pen", nominal=40.0)
AXES = tuple(rotary(f"A{k}", "arm") for k in (1, 2, 3))


def delta(*degrees: Expr | float, unit: Expr = pi / 180) -> Mechanism:
    """A delta whose motors stand at these angles, in degrees; unit: how a degree is written."""

    def legs(axis: Expr, at: Expr) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
        reach = BASE + ARM * cos(axis)
        return vector(reach * cos(at), reach * sin(at), -ARM * sin(axis)), vector(
            X + PLATE * cos(at), Y + PLATE * sin(at), Z
        )

    ends = [legs(axis, degree * unit) for axis, degree in zip(AXES, degrees, strict=True)]
    rods = tuple(rod(str(k), *end, ROD) for k, end in enumerate(ends, 1))
    return Mechanism("Own", AXES, Task("xyz"), parameters=(BASE, PLATE, ARM, ROD), rods=rods)


def pen_arm(beyond: Expr, *parameters: object) -> Mechanism:
    """A five-bar whose pen stands on the left rod, beyond the pin that both share."""
    first, second = (rotary(n, "crank", nominal=v) for n, v in (("A1", 125.0), ("A2", 55.0)))
    knees = (LEFT * cos(first), LEFT * sin(first), 0), (GROUND + RIGHT * cos(second), RIGHT * sin(second), 0)
    pin = tuple(k + NEAR / (NEAR + beyond) * (p - k) for k, p in zip(knees[0], (X, Y, 0), strict=True))
    rods = rod("1", knees[0], (X, Y, 0), NEAR + beyond), rod("2", knees[1], pin, FAR)
    parameters = (GROUND, LEFT, RIGHT, NEAR, FAR, *parameters)
    return Mechanism("Own", (first, second), Task("xy"), parameters=parameters, rods=rods)  # type: ignore[arg-type]


LOOPS = {
    "motors at odd angles": delta(0, 130, 251),
    "motors that share an angle": delta(10, 100, 235),
    "the pen on an extension": pen_arm(PEN, PEN),
    "the pen on either side of the pin": pen_arm(SIDE, SIDE),
}


@pytest.mark.long("motors")
@pytest.mark.quick
@pytest.mark.parametrize("name", LOOPS)
def test_a_loop_is_the_same_machine(name: str) -> None:
    """At random poses, joints and parameters every equation is the stated one, times a value that no joint changes."""
    stated, form = LOOPS[name], in_form(LOOPS[name])
    fixed = {p.symbol: p.nominal for p in form.parameters if p.fixed is not None} | {DEGREE: np.pi / 180.0}
    rng = np.random.default_rng(3)
    given = {}
    for own, other in zip(form.parameters, stated.parameters, strict=False):
        given[own.symbol] = given[other.symbol] = own.nominal * rng.uniform(0.9, 1.1)
    ratios = []
    for _ in range(3):
        pose = {s: rng.uniform(-300.0, 300.0) for s in map(real, COORDINATE_NAMES)} | {
            j.symbol: rng.uniform(-3.0, 3.0) for j in AXES
        }
        pairs = zip(form.equations, stated.equations, strict=True)
        ratios.append([float((own / other).xreplace(given | fixed | pose)) for own, other in pairs])
    assert np.ptp(ratios, axis=0).max() < 1e-9 and np.min(ratios) > 0.0


@pytest.mark.long
@pytest.mark.quick
def test_angles_in_a_loop_are_exact() -> None:
    """In radians, in degrees, and as decimals that are its cosine and its sine."""
    for degrees in ((0, 120, 250), (10, 100, 235), (45, 133.7, 260)):
        stated = in_form(delta(*map(sp.Rational, map(str, degrees))))
        assert in_form(delta(*map(sp.Rational, map(str, degrees)), unit=DEGREE)) == stated
        decimals = in_form(delta(*degrees, unit=sp.Float(np.pi / 180))).equations
        assert all(sp.expand(one - other) == 0 for one, other in zip(decimals, stated.equations, strict=True))


def test_names_of_angles() -> None:
    """10 degrees and 100 degrees have one name, and so have 35 and 235; 60 degrees are roots, and need none."""
    named = [p.name for p in in_form(LOOPS["motors that share an angle"]).parameters if p.fixed is not None]
    assert named == ["angle_10_deg", "angle_35_deg"]
    assert all(p.fixed is None for p in in_form(delta(0, 120, 240)).parameters)
    assert in_form(LOOPS["the pen on an extension"]).bars == LOOPS["the pen on an extension"].rods


@pytest.mark.slow
@pytest.mark.parametrize("name", LOOPS)
def test_it_derives(name: str) -> None:
    """The rods of the form are spheres, or circles, about known points."""
    assert build(validate(LOOPS[name])).branches
