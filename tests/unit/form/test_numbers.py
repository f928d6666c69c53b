"""Numbers in a chain: which are right angles, how the others are named, what is said of those that are almost right."""

import math
import re
from itertools import product

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import Rational, pi, sin

from derive.description.amounts import almost_right, as_right_angles, in_radians, with_exact_angles
from derive.description.mechanism import DescriptionError, Joint, Mechanism, Task, Turning, branch
from derive.description.validate import validate
from derive.form.machine import in_form
from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz, denavit_hartenberg
from derive.geometry.pose import pose_of
from derive.kinematics.build import build
from derive.mechanism import DEGREE, angle, length, linear, radians, rotary
from derive.solver.unsolved import Unsolved
from tests.unit.kinematics.inventions import described as invented

A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", "turn") for k in range(1, 7))
P1, P2, P3 = (linear(f"P{k}", "slide") for k in range(1, 4))
LINK = length("link", "link", nominal=300.0)
LEAN = angle("lean", "lean", nominal=40.0)

RIGHT = {"1.5708": 1, "-1.5708": -1, "3.1416": 2, "4.7124": 3, "1.5707963": 1, "1.570796325": 1, "3.14159": 2}
NOT_RIGHT = ("1.57", "1.571", "3.14", "1.57079", "1.570764", "1.5707", "1.5709", "0.0001", "0.785398")


@pytest.mark.parametrize(("text", "quarters"), RIGHT.items())
def test_right_angles_are_recognised(text: str, quarters: int) -> None:
    """Rounded to four decimals or more, or within 1e-6: the exact angle stands for them."""
    assert as_right_angles(sp.sympify(float(text))) == quarters * pi / 2


@pytest.mark.parametrize("text", NOT_RIGHT)
def test_no_other_angle_is_changed(text: str) -> None:
    """A calibrated angle, and one that is cut off, keep their value."""
    assert as_right_angles(sp.sympify(float(text))) is None


@pytest.mark.long
@given(st.integers(-4, 4), st.integers(4, 12))
def test_every_rounding_of_a_right_angle_is_one(quarters: int, decimals: int) -> None:
    written = sp.Float(round(quarters * math.pi / 2, decimals))
    assert sp.simplify(as_right_angles(written) - quarters * pi / 2) == 0


@pytest.mark.long
@given(st.integers(-360_000, 360_000), st.integers(10, 15))
def test_every_long_decimal_of_thousandths_of_a_degree_is_exact(thousandths: int, decimals: int) -> None:
    """The form names such an angle by its degrees, and what was written must not differ from that."""
    written = sp.Float(round(math.radians(thousandths / 1000), decimals))
    chain = with_exact_angles(described(Tx(300) * Rz(A1 + written), (A1,), Task("xy"))).chain
    assert chain is not None
    assert chain.factors[1].amount - A1.symbol == Rational(thousandths, 180_000) * pi


SENTENCES = {
    1.57: "1.57 is 0.0008 rad short of a right angle; write pi/2 or 90*DEGREE",
    -1.571: "-1.571 is 0.0002 rad more than a right angle; write -pi/2 or -90*DEGREE",
    3.14: "3.14 is 0.002 rad short of 2 right angles; write pi or 180*DEGREE",
}


XYZ = Task("xyz")


def described(chain: Chain, joints: tuple[Joint, ...], task: Task = XYZ, **stated: object) -> Mechanism:
    return invented(joints=joints, chain=chain, task=task, **stated)


def matrix(chain: Chain, values: dict[sp.Symbol, float]) -> sp.Matrix:
    """The frame at the end of a chain, as numbers."""
    pose = pose_of(chain)
    known = {**values, DEGREE: float(sp.pi / 180)}
    return sp.Matrix.hstack(sp.Matrix(pose.rotation), sp.Matrix(pose.position)).xreplace(known).evalf()


EXACT = (pi / 4, 3 * pi / 4, pi / 3, -2 * pi / 3, 60 * DEGREE, 0.7853981634, pi / 7, sp.Integer(1), pi / 2)
WRITTEN = st.one_of(st.sampled_from(EXACT), st.floats(-3.0, 3.0, allow_nan=False).map(lambda v: sp.Float(round(v, 3))))
SIZES = st.one_of(st.integers(-400, 400), st.floats(-2, 2).map(lambda v: round(v, 3)), st.just(Rational(1, 3)))


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(WRITTEN, SIZES), min_size=1, max_size=4))
def test_a_chain_with_names_is_the_same_chain(numbers: list[tuple[object, object]]) -> None:
    """Whatever numbers it states: the frame at its end is the stated one, for the values of the names."""
    chain = Rz(A1)
    for turn, size in numbers:
        chain = chain * Rx(turn) * Tx(size) * Tz(P1 + size) * Tx(size)
    stated = described(chain, (A1, P1))
    named = in_form(stated)
    at = {A1.symbol: 0.3, P1.symbol: 0.7}
    fixed = {p.symbol: p.nominal for p in named.parameters if p.fixed is not None}
    apart = matrix(stated.chain, at) - matrix(named.chain, at | fixed)
    assert max(map(abs, apart)) < 1e-6 * (1 + sum(abs(s) for _, s in numbers))  # right angles are rounded
    left = {a for f in named.chain.factors for a in f.amount.atoms(sp.Float)}
    assert not left


def test_angles_that_belong_together_share_a_name() -> None:
    """45°, -45° and 135° have one name; 60° and 30° too; an angle that is a sum of two others has none."""
    chain = Rx(pi / 4) * Rz(A1) * Rx(-0.7853981634) * Rz(A2) * Ry(2.356194490192345) * Rz(A3) * Ry(pi / 3)
    named = in_form(described(chain * Rz(A4) * Rx(-30 * DEGREE), (A1, A2, A3, A4)))
    assert [p.name for p in named.parameters] == ["angle_30_deg", "angle_45_deg"]
    sums = in_form(described(Rx(0.35) * Rz(A1) * Rx(-0.85) * Rz(A2) * Rx(0.5) * Rz(A3), (A1, A2, A3)))
    assert [p.name for p in sums.parameters] == ["angle_0_35_rad", "angle_0_5_rad"]


def test_names_are_free_and_values_are_as_written() -> None:
    """A parameter of the user keeps its name; a length has the name of its first axis and one name for one size."""
    taken = length("shift_x_1", "link", nominal=1.0)
    chain = Tx(taken) * Rz(A1) * Tx(0.425) * Ry(A2) * Tz(-0.425) * Rz(22.5 * DEGREE) * Ty(Rational(1, 3))
    named = in_form(described(chain, (A1, A2), parameters=(taken,)))
    fixed = {p.name: p.fixed for p in named.parameters[1:]}
    assert fixed == {"shift_x_1_2": Rational(17, 40), "shift_y_1": Rational(1, 3), "angle_22_5_deg": Rational(45, 2)}


@pytest.mark.parametrize(("value", "sentence"), SENTENCES.items())
def test_almost_right_angles_are_told(value: float, sentence: str) -> None:
    assert almost_right(sp.Float(value)) == sentence


@pytest.mark.parametrize("value", [1.5708, 0.785, 0.003, 1.5, 1.6])
def test_nothing_is_told_of_other_angles(value: float) -> None:
    assert almost_right(sp.Float(value)) is None


def test_radians_of_degrees() -> None:
    assert in_radians(60 * DEGREE) == pytest.approx(math.pi / 3, abs=1e-15)


def three_parallel(twist: object) -> Mechanism:
    """An arm with three parallel axes, if the twist behind its base is a right angle or not; its wrist is not one."""
    rows = ((A1, 0.16, 0, pi / 2), (A2, 0, -0.425, 0), (A3, 0, -0.39, 0), (A4, 0.13, 0, twist), (A5, 0.1, 0, -pi / 2))
    chain = denavit_hartenberg(*rows, (A6, 0.1, 0, 0))
    return described(chain, (A1, A2, A3, A4, A5, A6), Task("xyz", Turning.FULL), offset_interface=False)


@pytest.mark.long
def test_a_right_angle_with_two_decimals_is_noted() -> None:
    """It keeps its value, and the documentation of the machine says what may be meant."""
    assert (
        build(three_parallel(1.57)).mechanism.notes[0]
        == "1.57 is 0.0008 rad short of a right angle; write pi/2 or 90*DEGREE."
    )


REFUSED = {
    "a half turn with two decimals": (
        described(Rz(A1) * Tx(LINK) * Rx(3.14) * Rz(A2), (A1, A2), Task("xy"), parameters=(LINK,)),
        "3.14 is 0.002 rad short of 2 right angles; write pi or 180*DEGREE",
    ),
    "degrees for radians": (
        described(Rz(A1) * Tx(300) * Rz(90) * Rz(A2), (A1, A2), Task("xy")),
        "Rz(90) of the chain turns by 90 radians, more than a full turn: write radians(90), which derive.mechanism has",
    ),
    "an angle of the machine in degrees": (
        described(Tx(P1) * Rz(LEAN) * Ty(P2) * Tz(P3), (P1, P2, P3), parameters=(LEAN,)),
        "Rz(lean) of the chain has the angle lean in degrees: write radians(lean)",
    ),
    "a turn by a length": (
        described(Rz(A1) * Rx(LINK) * Tx(P1), (A1, P1), Task("xy"), parameters=(LINK,)),
        "Rx(link) of the chain turns by the length link: a turn needs an angle",
    ),
    "a joint that is converted": (
        described(Rz(radians(A1)) * Tx(P1), (A1, P1), Task("xy")),
        "Rz(DEGREE*a1) of the chain converts A1, which is in radians already: leave out radians()",
    ),
    "no number": (
        described(Rz(A1) * Tx(float("nan")) * Tx(P1), (A1, P1), Task("xy")),
        "Tx(nan) of the chain holds what is no number",
    ),
    "a truth value": (
        described(Rz(A1) * Tx(P1) * Tz(sp.true), (A1, P1), Task("xy")),
        "Tz(True) of the chain is given what is true or false",
    ),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_refused(kind: str) -> None:
    """A number that cannot be meant is refused with the factor that has it."""
    mechanism, message = REFUSED[kind]
    with pytest.raises((DescriptionError, Unsolved), match=re.escape(message)):
        build(validate(mechanism))


@pytest.mark.long
def test_an_angle_that_is_almost_right_is_kept_where_it_solves() -> None:
    """Nothing is snapped silently: a SCARA that stands turned by 1.57 is derived with that angle."""
    chain = Rz(A1 + 1.57) * Tx(0.35) * Rz(A2) * Tx(0.25)
    elbow = branch("elbow", sin(A2), right=+1, left=-1)
    built = build(validate(described(chain, (A1, A2), Task("xy"), branches=(elbow,))))
    assert [p.name for p in built.mechanism.parameters] == ["shift_x_1", "shift_x_2", "angle_1_57_rad"]
    assert {p.name for p in built.parameters} >= {"offset_a1"} and "shift_x_1" not in {p.name for p in built.parameters}


@pytest.mark.parametrize("signs", list(product((1, -1), repeat=2)))
def test_numbers_leave_no_condition(signs: tuple[int, int]) -> None:
    """The determinant of two skewed rails is a number: Initialize does not ask whether it vanishes."""
    chain = Tx(P1) * Rz(signs[0] * 0.7) * Ty(P2) * Rz(-signs[0] * 0.7) * Tz(signs[1] * P3)
    built = build(validate(described(chain, (P1, P2, P3), offset_interface=False)))
    assert built.mechanism.constraints == ()
