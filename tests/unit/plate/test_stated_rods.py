"""Turning loops stated without rods, with cones of their joints, and with a home pose that is a length."""

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from derive.description.amounts import with_symbols
from derive.description.loops import FREE_TWIST
from derive.description.mechanism import (
    ROTATION,
    DescriptionError,
    Mechanism,
    Rod,
    Task,
    Turning,
    X,
    Y,
    Z,
    length,
    linear,
    on_plate,
    ring_rod,
)
from derive.description.validate import validate
from derive.form.roots import with_squared_roots
from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.program import Status
from derive.ir.symbols import real
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.mechanisms.kin_hexapod import BASE_CONE, MECHANISM, PLATFORM_CONE
from derive.mechanisms.kin_tripod_p3z import MECHANISM as TRIPOD
from derive.plate.stated_rods import with_free_twist, with_positive_lengths, with_stated_rods
from derive.witness import witness
from tests.mechanisms import kinematics_of, named
from tests.unit.form.test_chain import SIDE, delta, pen_arm
from tests.unit.kinematics.test_turning_inventions import TURNING_INVENTIONS, three_prr, three_rpr

MACHINES = {
    **{name: own for name, (own, _) in TURNING_INVENTIONS.items()},
    **{name: named(name) for name in ("Softkin_Planar_3RRR", "Softkin_Hexaglide", "Kin_Hexapod")},
}
RING, STRUT = length("ring_radius", "Ring", nominal=80.0), linear("L1", "Strut", domain=(0.0, 1e9), nominal=600.0)
QUICK = 20.0
"""Seconds, in which anything is refused."""


def stated(mechanism: Mechanism, factor: object = -3) -> Mechanism:
    """The same loop as equations alone, each times a factor."""
    return replace(mechanism, rods=(), closure=tuple(factor * r.equation for r in mechanism.rods))


@pytest.mark.long("cranks", "Kin_Hexapod")
@pytest.mark.parametrize("name", MACHINES)
def test_equations_that_are_rods_are_read_as_these(name: str) -> None:
    """Every machine that turns its platform, in space and in a plane, with joints in the length and in the base."""
    mechanism = MACHINES[name]
    read = with_stated_rods(stated(mechanism))
    assert read.closure == () and len(read.rods) == len(mechanism.rods)
    values = {s: sp.Rational(k + 3, 7) for k, s in enumerate(sorted(mechanism.rods[0].equation.free_symbols, key=str))}
    values |= dict(zip(ROTATION, sp.rot_axis3(-0.7), strict=True))
    if mechanism.task.turning is Turning.FULL:
        values |= dict(zip(ROTATION, sp.rot_axis1(0.4) * sp.rot_axis2(-0.9) * sp.rot_axis3(0.3), strict=True))
    for one, other in zip(read.rods, mechanism.rods, strict=True):
        rest = {s: sp.Rational(5, 3) for s in (one.equation.free_symbols | other.equation.free_symbols) - set(values)}
        difference = (one.equation - other.equation).subs(values | rest)
        assert abs(sp.N(difference)) <= 1e-9 * (1.0 + abs(sp.N(other.equation.subs(values | rest))))


@pytest.mark.parametrize("radius", [0, RING, -RING / 2])
def test_an_equation_in_the_frame_of_the_plate_is_read_too(radius: sp.Expr) -> None:
    """A strut that ends on a ring around the z axis of the plate, on its near or far side, or on the axis itself."""
    across, aside, along = ROTATION.T * sp.Matrix([300 - X, 40 - Y, 900 - Z])
    apart = sp.sqrt(across**2 + aside**2)
    equation = -3 * ((apart - radius) ** 2 + (along - 7) ** 2 - STRUT.symbol**2)
    machine = Mechanism("Spindle", (STRUT,), Task("xyz", Turning.DIRECTION), parameters=(RING,), closure=(equation,))
    (read,) = with_stated_rods(machine).rods
    assert read == ring_rod("1", (300, 40, 900), on_plate(0, 0, 7), radius, STRUT) if radius else read.ring is None
    assert FREE_TWIST in with_free_twist(with_stated_rods(machine)).guides


WORDS: dict[str, Callable[[Rod], sp.Expr]] = {
    "the squares": lambda r: r.equation,
    "a multiple in decimals": lambda r: -0.3 * r.equation,
    "multiplied out, over the length": lambda r: sp.expand(r.equation / r.length),
    "a root": lambda r: r.length - sp.sqrt(r.equation + r.length**2),
    "a multiple of a root": lambda r: 2 * sp.sqrt(r.equation + r.length**2) - 2 * r.length,
}
STRUTS = tuple(linear(f"S{k}", "strut", domain=(0.0, 1e9), nominal=400.0) for k in (1, 2))
FIVE_BAR = pen_arm(sp.Integer(0))
METRES = {p.symbol: sp.Float(p.nominal / 1000) for p in FIVE_BAR.parameters}
POINTED = {
    "a delta": delta(0, 120, 240),
    "a five-bar": FIVE_BAR,
    "a five-bar in metres": replace(FIVE_BAR, parameters=(), rods=with_symbols(FIVE_BAR.rods, METRES)),
}


@pytest.mark.long
@pytest.mark.parametrize("words", WORDS)
@pytest.mark.parametrize("name", POINTED)
def test_a_point_is_held_by_rods_in_whatever_words(name: str, words: str) -> None:
    """The program of every wording is that of the rods, and meets the equations as they are written."""
    own = POINTED[name]
    other = replace(own, rods=(), closure=tuple(map(WORDS[words], own.rods)))
    kin = build(validate(other))
    assert kin.branch == build(validate(own)).branch
    assert witness(kin, other).poses


@pytest.mark.long
def test_a_root_says_which_sign_a_strut_has() -> None:
    """Squares allow both signs, whatever they are multiplied by; a root is the rod."""
    squares = [(X - 500 * k) ** 2 + Y**2 for k in range(2)]

    def built(*closure: sp.Expr) -> Kinematics:
        machine = Mechanism("Bipod", STRUTS, Task("xy"), closure=closure)
        kin = build(validate(machine))
        assert witness(kin, machine).poses
        return kin

    pairs = list(zip(squares, STRUTS, strict=True))
    assert built(*(3 * (e - s**2) for e, s in pairs)).branch == built(*(e - s**2 for e, s in pairs)).branch
    rooted = built(*(sp.sqrt(e) - s for e, s in pairs)).mechanism
    assert rooted.closure == () and rooted.positive == tuple(r.length for r in rooted.rods)


@pytest.mark.parametrize("side", [SIDE, RING - 50])
def test_a_root_of_either_sign_is_refused(side: sp.Expr) -> None:
    closure = (X - STRUTS[0], sp.sqrt(X**2 + Y**2) - side)
    machine = Mechanism("Bipod", STRUTS, Task("xy"), parameters=(RING, SIDE), closure=closure)
    with pytest.raises(
        DescriptionError, match=r"equation 2 of closure= says that a root is .*not known to be positive"
    ):
        with_squared_roots(machine)


@pytest.mark.long
def test_the_programs_are_those_of_the_rods() -> None:
    """The planar 3-RRR as equations is the 3-RRR of the catalogue."""
    mechanism = named("Softkin_Planar_3RRR")
    one, other = build(validate(stated(mechanism))), kinematics_of(mechanism)
    assert one.branch == other.branch
    assert one.forward == other.forward
    assert one.jacobian == other.jacobian
    assert one.margins == other.margins


@pytest.mark.long
def test_an_equation_that_is_multiplied_out_is_read_too() -> None:
    """With two entries of the rotation, as heading's cosine and sine, and every square expanded."""
    mechanism = named("Softkin_Planar_3RRR")
    table = {ROTATION[0, 1]: -ROTATION[1, 0], ROTATION[1, 1]: ROTATION[0, 0]}
    long = replace(mechanism, rods=(), closure=tuple(sp.expand(r.equation.xreplace(table)) / 2 for r in mechanism.rods))
    assert [(r.base, r.plate, r.length) for r in with_stated_rods(long).rods] == [
        (tuple(map(sp.expand, r.base)), r.plate, r.length) for r in mechanism.rods
    ]


def differences(mechanism: Mechanism) -> Mechanism:
    """The first equation as a difference of two: no rod."""
    first, second, *others = (r.equation for r in mechanism.rods)
    return replace(mechanism, rods=(), closure=(first - second, second, *others))


TURNS = ROTATION[0, 0] * sp.sin(three_rpr().joints[2].symbol) - ROTATION[1, 0] * sp.cos(three_rpr().joints[2].symbol)
REFUSED = {
    "a difference of two": (
        lambda: differences(three_prr()),
        "it has 2 rods and 1 other equations: closure= of a loop that turns its platform must say that a point of the "
        "platform keeps its distance from one that joints move",
    ),
    "a length that depends on the pose": (
        lambda: replace(three_rpr(), rods=three_rpr().rods[1:], closure=(three_rpr().rods[0].equation + X * Y,)),
        "it has 2 rods and 1 other equations",
    ),
    "a joint that turns the platform": (
        lambda: replace(three_rpr(), rods=three_rpr().rods[:2], closure=(TURNS,)),
        "an equation that only turns it: where a joint on the plate (P3) does, say so by heading=",
    ),
    "a platform that moves where it is not commanded": (
        lambda: replace(named("Kin_Hexapod"), task=Task("z", Turning.DIRECTION)),
        "the task commands 'z', and the loop moves x, y as well: coordinates that are not commanded must be held by "
        "guides=",
    ),
    "a task without x": (
        lambda: replace(three_rpr(), task=Task("yz", Turning.ABOUT_Z), closure=(Z - 1,)),
        "the task commands 'yz', and the loop moves x as well",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_no_rule_derives_is_refused_with_the_reason(what: str) -> None:
    change, said = REFUSED[what]
    began = time.process_time()
    with pytest.raises(DescriptionError) as refused:
        build(validate(change()))
    assert said in str(refused.value)
    assert time.process_time() - began < QUICK


def test_a_length_under_a_square_has_the_sign_that_makes_it_positive() -> None:
    """A winch that pays out less than the whole cable: the equation holds the square of the rest."""
    total = length("cable", "whole length of a cable", nominal=2000.0)
    own = three_rpr()
    taut = tuple(r.equation + r.length**2 - (r.length - total) ** 2 for r in own.rods)
    stated = replace(own, parameters=(*own.parameters, total), rods=(), closure=taut, positive=())
    rods = with_stated_rods(stated).rods
    assert [r.length for r in rods] == [total.symbol - r.length for r in own.rods]
    assert with_positive_lengths(with_stated_rods(stated)).positive == tuple(r.length for r in rods)


def with_cones(mechanism: Mechanism, base: list[sp.Expr | None], plate: list[sp.Expr | None]) -> Mechanism:
    rods = (replace(r, base_cone=b, plate_cone=p) for r, b, p in zip(mechanism.rods, base, plate, strict=True))
    return replace(mechanism, rods=tuple(rods))


@pytest.mark.parametrize(
    ("mechanism", "cone", "word"),
    [
        (TRIPOD, sp.Integer(1), "about the rod at the home pose, and the mechanism has none"),
        (MECHANISM, real("width"), "reads 'width', which is not a parameter"),
        (MECHANISM, real("l1"), "reads 'l1', which is not a parameter"),
    ],
)
def test_what_cannot_be_a_cone(mechanism: Mechanism, cone: sp.Expr, word: str) -> None:
    """A cone without a home pose, or with a width that is no parameter, is refused."""
    nothing = [None] * (len(mechanism.rods) - 1)
    for side in (([cone, *nothing], [None, *nothing]), ([None, *nothing], [*nothing, cone])):
        with pytest.raises(DescriptionError, match=word):
            validate(with_cones(mechanism, *side))


@pytest.mark.long
def test_a_rod_without_a_cone_is_free_and_others_have_their_own() -> None:
    """One base joint with one width, one with another; nothing is asked of the others, nor of the platform."""
    wide, narrow = BASE_CONE * DEGREE, PLATFORM_CONE * DEGREE
    kin = build(with_cones(MECHANISM, [None, wide, narrow, None, None, None], [None] * 6))
    names = [s.name for s in kin.branch.inputs]
    assert [n for n in names if "least_cos" in n] == ["least_cos_base_1", "least_cos_base_2"]
    assert [n for n in names if n.startswith("home_along")] == [f"home_along_{rod}_{c}" for rod in "23" for c in "xyz"]
    assert not [n for n in names if n.startswith("plate_axis")]
    for base, plate, status in (
        (90.0, 90.0, Status.OK),
        (1.0, 90.0, Status.UNREACHABLE),
        (90.0, 1.0, Status.UNREACHABLE),
    ):
        given = {p.name: np.asarray(float(p.nominal)) for p in kin.parameters}
        given |= {BASE_CONE.name: np.asarray(base), PLATFORM_CONE.name: np.asarray(plate)}
        constants, _ = run(kin.setup, given)
        pose = {f"r{i}{k}": np.asarray(float(i == k)) for i in (1, 2, 3) for k in (1, 2, 3)}
        pose |= {"x": np.asarray(60.0), "y": np.asarray(0.0), "z": np.asarray(600.0)}
        assert run(kin.branch, {**constants, **pose})[1] == status


def test_the_hexapod_has_them() -> None:
    assert {r.base_cone for r in MECHANISM.rods} == {BASE_CONE * DEGREE}
    assert {r.plate_cone for r in MECHANISM.rods} == {PLATFORM_CONE * DEGREE}


@pytest.mark.long
def test_a_home_pose_may_be_a_length() -> None:
    described = named("Kin_Hexapod")
    read = {s for v in described.home for s in sp.sympify(v).free_symbols}
    own = next(p for p in described.parameters if p.symbol in read)
    height = length(own.name, own.meaning, nominal=abs(own.nominal) or 100.0)
    stated = with_symbols(described, {own.symbol: height.symbol})
    assert own.symbol != height.symbol and stated.home != described.home
    assert build(stated).forward.outputs
