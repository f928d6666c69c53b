"""The check in a finite field: right formulas hold exactly in whatever numbers, and wrong ones are not proven."""

from collections.abc import Callable
from dataclasses import replace
from random import Random

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.description.mechanism import Mechanism, Task, X, Y, Z, assembly, branch, length, linear, rod, rotary
from derive.description.validate import validate
from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.ir.constants import DEGREE
from derive.ir.primitives import Atan2
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import real
from derive.kinematics.build import build
from derive.kinematics.kinematics import Exact, Kinematics
from derive.mechanism import Turning
from derive.vectors import minus, triple, vector
from derive.witness import Disagreement
from derive.witness.exact.field import PRIME, NoRoot, of_angle, on_circle, root, root_of_whole, times, turned
from derive.witness.exact.proof import check_exactly
from tests.machines.task_machines import DRIVEN
from tests.mechanisms import kinematics_of, named

NUMBERS = st.integers(1, PRIME - 1)
DEGREES = st.integers(-720_000, 720_000)


@given(NUMBERS)
def test_a_square_has_its_root(number: int) -> None:
    assert root(number * number) in (number, PRIME - number)


@given(NUMBERS)
def test_of_a_number_and_its_multiple_by_no_square_one_has_a_root(number: int) -> None:
    other = next(n for n in range(2, 50) if pow(n, (PRIME - 1) // 2, PRIME) == PRIME - 1)

    def has_root(value: int) -> bool:
        try:
            return root(value) ** 2 % PRIME == value % PRIME
        except NoRoot:
            return False

    assert has_root(number) is not has_root(number * other)


@given(DEGREES, DEGREES, NUMBERS)
def test_angles_add(one: int, other: int, slope: int) -> None:
    """Sines and cosines of fixed angles are on the circle, add, and have the roots that they have in real numbers."""
    cosine, sine = of_angle(one)
    assert (cosine**2 + sine**2) % PRIME == 1
    assert turned(of_angle(one), of_angle(other)) == of_angle(one + other)
    assert times(on_circle(slope), 3) == turned(on_circle(slope), turned(on_circle(slope), on_circle(slope)))
    assert of_angle(90_000) == (0, 1)
    assert (2 * of_angle(45_000)[1] - root_of_whole(2)) % PRIME == 0
    assert (2 * of_angle(60_000)[1] - root_of_whole(3)) % PRIME == 0


def test_a_length_may_have_the_name_of_a_joint() -> None:
    """As in tables of Denavit-Hartenberg parameters: the length a1 is not the angle of A1."""
    first, second = (length(f"a{k}", f"Link {k}", nominal=300.0) for k in (1, 2))
    joints = tuple(rotary(f"A{k}", f"Arm {k}") for k in (1, 2))
    chain = Rz(joints[0]) * Tx(first) * Rz(joints[1]) * Tx(second)
    arm = validate(Mechanism(name="Arm", parameters=(first, second), joints=joints, chain=chain, task=Task("xy")))
    exact = check_exactly(build(arm), arm)
    assert (exact.trials, exact.but, exact.what) == (3, "", "equations")


PROVEN = {
    "Kin_Scara4_ZCcoupled_Type1": "", "Kin_ArticulatedRobot_6DOF": "", "Kin_SCCC": "", "MC_KIN_TYPE_12_XY": "",
    "Kin_Crane": "", "Kin_Hexapod": "forward kinematics iterates",
}  # fmt: skip


@pytest.mark.parametrize("name", PROVEN)
def test_the_equations_hold_exactly(name: str) -> None:
    """Chains with couplings and pitches, loops, and the inverse of a platform."""
    exact = check_exactly(kinematics_of(named(name)), named(name))
    assert (exact.trials, exact.but) == (3, PROVEN[name])


@pytest.mark.long
@pytest.mark.parametrize("name", DRIVEN)
def test_gears_are_exact_too(name: str) -> None:
    """A turn of the axis is a fraction of one of the joint, or a multiple; screws read angles as numbers. A beam that
    two racks turn does so by a share of lengths, which is no angle there.
    """
    exact = check_exactly(kinematics_of(DRIVEN[name]), DRIVEN[name])
    but = "it turns by what is no sum of angles" if name == "beam on two racks" else ""
    assert (exact.trials, exact.but) == (0 if but else 3, but)


@pytest.mark.long
def test_what_cannot_be_asked_is_said() -> None:
    searched = "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"
    exact = check_exactly(kinematics_of(named(searched)), named(searched))
    assert exact.sentence == "The equations were not checked in a finite field: its roots are searched along a joint."


P1, A1, LINK = linear("P1", "rail"), rotary("A1", "turn"), length("link", "link", nominal=300.0)


@pytest.mark.long
def test_a_turn_behind_the_links_is_exact() -> None:
    chain = Tx(P1) * Rz(A1) * Tx(LINK) * Rz(sp.pi / 5)
    described = validate(Mechanism(name="Turned", parameters=(LINK,), joints=(P1, A1), chain=chain, task=Task("xy")))
    assert check_exactly(build(described), described).trials == 3


def changed(program: Program, change: Callable[[Let], Let]) -> Program:
    """The program with a change of the direction from which it takes an angle last."""
    place = max(k for k, s in enumerate(program.body) if isinstance(s, Let) and s.value.atoms(Atan2))
    body = list(program.body)
    last = body[place]
    assert isinstance(last, Let)
    body[place] = change(last)
    return replace(program, body=tuple(body))


def nearly(let: Let) -> Let:
    return replace(let, value=let.value.replace(Atan2, lambda y, x: Atan2((1 + sp.Rational(1, 10**14)) * y, x)))


NOMINAL = real("link_length_1") - 250
WRONG: dict[str, Callable[[Kinematics], Kinematics]] = {
    "a coefficient wrong by 1e-14": lambda k: replace(k, branch=changed(k.branch, nearly)),
    "a term that vanishes at the nominal machine": lambda k: replace(
        k,
        forward=replace(
            k.forward,
            outputs=tuple(
                Output(o.name, o.value + NOMINAL / 10**16) if o.name == "x" else o for o in k.forward.outputs
            ),
        ),
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_is_nearly_right_is_refused(what: str) -> None:
    """No measurement in floating-point numbers sees these."""
    name = "Kin_Scara4_ZCcoupled_Type1"
    spoiled = WRONG[what](kinematics_of(named(name)))
    with pytest.raises(Disagreement, match="does not meet the closure exactly"):
        check_exactly(spoiled, named(name))


SLIDES = S1, S2, S3 = tuple(linear(f"P{k}", "slide") for k in (1, 2, 3))
FIRST, A4, A5, A6 = (rotary(f"A{k}", "turn") for k in (1, 4, 5, 6))
ROD = length("rod", "rods", nominal=0.5)


def angle(rng: Random) -> sp.Expr:
    """An oblique angle, written in one of many ways."""
    ways = (sp.pi / 6, sp.pi / 5, 37 * DEGREE, sp.Float(rng.randint(200, 700) / 1000), sp.Float(rng.uniform(0.2, 0.7)))
    return rng.choice(ways)


def leaning_slides(rng: Random) -> Mechanism:
    """Slides that are not square to each other."""
    return Mechanism("Own", SLIDES, Task("xyz"), chain=Tx(S1) * Rz(angle(rng)) * Ty(S2) * Rx(angle(rng)) * Tz(S3))


def added_angles(rng: Random) -> Mechanism:
    """Decimal angles whose sum is turned back."""
    one, other = (sp.Rational(rng.randint(200, 700), 1000) for _ in range(2))
    first, both = Ry(sp.Float(one)) * Tx(S1), Ry(-sp.Float(one + other)) * Tx(S3)
    return Mechanism("Own", SLIDES, Task("xyz"), chain=first * both * Ry(sp.Float(other)) * Ty(S2))


def leaning_boom(rng: Random) -> Mechanism:
    """A boom that leans on a column, with a wrist."""
    chain = Rz(FIRST) * Tz(S1) * Ry(angle(rng)) * Tx(S2) * Rz(A4) * Ry(A5) * Rz(A6) * Tz(sp.Float(0.1))
    task, joints = Task("xyz", Turning.FULL), (FIRST, S1, S2, A4, A5, A6)
    return Mechanism("Own", joints, task, chain=chain, positive=(S2.symbol,), offset_interface=False)


def linear_delta(rng: Random) -> Mechanism:
    """Upright rails at places with decimals, in metres."""
    places = [(0.3, 0.02), (-0.17, 0.24), (-0.14, -0.27)]
    bases = [vector(round(x + rng.randint(-20, 20) / 1000, 3), y, s) for (x, y), s in zip(places, SLIDES, strict=True)]
    ends = [vector(X + 0.05, Y + 0.1), vector(X - 0.02, Y + 0.04), vector(X - rng.randint(20, 40) / 1000, Y - 0.05)]
    plates = [vector(e[0], e[1], Z) for e in ends]
    along = [minus(p, b) for p, b in zip(plates, bases, strict=True)]
    return Mechanism(
        "Own",
        SLIDES,
        Task("xyz"),
        parameters=(ROD,),
        rods=tuple(rod(str(k), b, p, ROD) for k, (b, p) in enumerate(zip(bases, plates, strict=True))),
        branches=tuple(branch(f"side_{k}", -v[2], above=1, below=-1) for k, v in enumerate(along)),
        assembly=assembly("tcp", triple(along), margin="coplanar", below=-1, above=1),
    )


def found(kin: Kinematics, described: Mechanism) -> Exact:
    try:
        return check_exactly(kin, described)
    except Disagreement:
        return Exact(0, "refused")


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("make", [leaning_slides, added_angles, leaning_boom, linear_delta])
def test_odd_numbers(make: Callable[[Random], Mechanism], seed: int) -> None:
    """What is right is proven, in the form where that computes numbers; what is wrong by 1e-14 never is."""
    described = validate(make(Random(seed)))
    kin = build(described)
    exact = check_exactly(kin, described)
    assert exact.trials == 3, exact.sentence
    outputs = tuple(
        Output(o.name, o.value * (1 + sp.Rational(1, 10**14))) for o in kin.forward.outputs if o.name == "x"
    )
    others = tuple(o for o in kin.forward.outputs if o.name != "x")
    spoiled = replace(kin, forward=replace(kin.forward, outputs=(*outputs, *others)))
    assert found(spoiled, described).trials == 0
