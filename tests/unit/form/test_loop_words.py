"""Loops in other words: in metres, with motors at odd angles in decimals. Their verdict and their cost are the same."""

import numpy as np
import pytest
import sympy as sp

from derive.description.validate import validate
from derive.ir.program import Let
from derive.kinematics.build import build
from derive.mechanism import ROTATION, Joint, Mechanism, Rod, Task, Turning, X, Y, Z, linear, on_plate, rod, rotary
from derive.pipeline import derive_and_measure

MILLIMETRES, METRES = sp.Integer(1), sp.Float("0.001")
FEET = [sp.rot_axis3(-a) * sp.Matrix([300, 20 * k, 0]) for k, a in enumerate((0.2, 1.9, 2.3, 4.0, 4.4, 6.1))]
PINS = [sp.rot_axis3(-a) * sp.Matrix([150, 0, 3 * k]) for k, a in enumerate((0.8, 1.3, 2.9, 3.4, 5.0, 5.5))]


def short(value: object) -> sp.Float:
    """A number with at most six decimals."""
    return sp.Float(repr(round(float(value), 6)))  # type: ignore[arg-type]


def five_bar(unit: sp.Expr, plane: str = "xy", *, is_multiplied_out: bool = False) -> Mechanism:
    left, right = rotary("A1", "left", nominal=125.0), rotary("A2", "right", nominal=55.0)
    ground, first, second, near, far = (short(v * unit) for v in (130, 90, 95, 170, 185))
    ends = [(first * sp.cos(left.symbol), first * sp.sin(left.symbol))]
    ends.append((ground + second * sp.cos(right.symbol), second * sp.sin(right.symbol)))
    point = [{"x": X, "y": Y, "z": Z}[c] for c in plane]
    rods = [rod(str(k), end, point, size) for k, (end, size) in enumerate(zip(ends, (near, far), strict=True), 1)]
    if is_multiplied_out:
        closure = tuple(sp.expand(r.equation * sp.Rational(7, 3)) for r in rods)
        return Mechanism("Own_Five", (left, right), Task(plane), closure=closure)
    return Mechanism("Own_Five", (left, right), Task(plane), rods=tuple(rods))


def platform(joints: tuple[Joint, ...], rods: list[Rod], height: sp.Expr) -> Mechanism:
    return Mechanism("Own_Six", joints, Task("xyz", Turning.FULL), rods=tuple(rods), home=(0, 0, height, 0, 0, 0))


def hexaglide(unit: sp.Expr) -> Mechanism:
    slides = tuple(linear(f"A{k}", "slide") for k in range(1, 7))
    rods = []
    for k, (slide, foot, pin) in enumerate(zip(slides, FEET, PINS, strict=True), 1):
        x, y, z = (short(v * unit) for v in foot)
        rods.append(rod(str(k), (x, y, z + slide.symbol), on_plate(*(short(v * unit) for v in pin)), short(500 * unit)))
    return platform(slides, rods, short(500 * unit))


def with_cranks() -> Mechanism:
    cranks = tuple(rotary(f"A{k}", "crank") for k in range(1, 7))
    rods = []
    for k, (crank, foot, pin) in enumerate(zip(cranks, FEET, PINS, strict=True), 1):
        swing = 120.0 * np.cos(1.1 * k) * sp.cos(crank.symbol), 120.0 * np.sin(1.1 * k) * sp.cos(crank.symbol)
        end = (*(short(v) + s for v, s in zip(foot, swing, strict=False)), short(foot[2]) + 120 * sp.sin(crank.symbol))
        rods.append(rod(str(k), end, on_plate(*map(short, pin)), 480))
    return platform(cranks, rods, sp.Integer(430))


def operations(mechanism: Mechanism) -> int:
    """The operations of the inverse for one branch; a fraction is one number."""
    values = [s.value for s in build(validate(mechanism)).branch.body if isinstance(s, Let)]
    numbers = {r: sp.Float(r) for v in values for r in v.atoms(sp.Rational) if r.q > 1}
    return sum(int(sp.count_ops(v.xreplace(numbers))) for v in values)


def test_a_five_bar_costs_the_same_in_metres() -> None:
    assert operations(five_bar(MILLIMETRES)) == operations(five_bar(METRES))


@pytest.mark.parametrize("plane", ["xz", "yz"])
def test_equations_in_any_plane_are_rods(plane: str) -> None:
    words = five_bar(MILLIMETRES, plane, is_multiplied_out=True)
    assert operations(words) == operations(five_bar(MILLIMETRES))


@pytest.mark.slow
@pytest.mark.parametrize("machine", [five_bar(METRES), hexaglide(METRES)], ids=["five-bar", "hexaglide"])
def test_it_is_measured_in_metres(machine: Mechanism) -> None:
    """Its lengths are fractions, which the finite field squares; and of 64 solutions at home one is found."""
    evidence = derive_and_measure(validate(machine)).evidence
    assert evidence is not None and evidence.inverted is not None


@pytest.mark.slow
def test_cranks_at_odd_angles_in_decimals_carry_a_platform() -> None:
    found = build(validate(with_cranks()))
    assert len(found.mechanism.branches) == 6 and not any(e.has(*ROTATION, X, Y, Z) for e in found.mechanism.positive)
