"""Loops whose description names neither branches nor their assembly: both are derived, and mean what they say."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sympy import cos, pi, sin

from derive.description.joints import Joint
from derive.description.loops import Rod
from derive.description.mechanism import (
    DescriptionError,
    Mechanism,
    Parameter,
    Task,
    X,
    Y,
    Z,
    assembly,
    length,
    linear,
    rod,
    rotary,
)
from derive.description.validate import validate
from derive.ir.interpret import evaluate
from derive.ir.program import Status
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.pipeline import derive_and_measure
from derive.report.reference_calls import Machine, forward, machine_with

pytestmark = pytest.mark.slow

R, F, ARM = (length(n, n, nominal=v) for n, v in (("rod", 400.0), ("base", 300.0), ("arm", 180.0)))
S1, S2, S3 = (linear(f"S{k}", "slide") for k in (1, 2, 3))
J1, J2 = (rotary(f"J{k}", "arm") for k in (1, 2))
C1, C2, C3 = (linear(f"C{k}", "cylinder", domain=(0.0, 1e9)) for k in (1, 2, 3))


def _feet(k: int) -> tuple[object, object, int]:
    return F * cos(2 * pi * k / 3), F * sin(2 * pi * k / 3), 0


def _loop(joints: Sequence[Joint], parameters: Sequence[Parameter], *rods: Rod, **more: Any) -> Mechanism:
    """A loop in a plane, or in space."""
    task = Task("xy" if len(joints) == 2 else "xyz")
    return Mechanism("Loop", tuple(joints), task, parameters=tuple(parameters), rods=rods, **more)


def _crank(joint: Joint) -> tuple[object, object]:
    """The end of an arm."""
    return ARM * cos(joint), ARM * sin(joint)


PLAIN, STANDING = ("positive", "negative"), ("above", "below")
TIP, CYLINDERS = (X, Y, Z), (C1, C2, C3)
LOOPS: dict[str, tuple[Callable[[], Mechanism], str, int, tuple[str, str]]] = {
    "orthoglide": (
        lambda: _loop(
            (S1, S2, S3), (R,), rod("1", (S1, 0, 0), TIP, R), rod("2", (0, S2, 0), TIP, R), rod("3", (0, 0, S3), TIP, R)
        ),
        "rods_coplanar", 8, PLAIN,
    ),
    "three cylinders": (
        lambda: _loop(
            CYLINDERS, (F,), *(rod(str(k + 1), _feet(k), TIP, c) for k, c in enumerate(CYLINDERS)), positive=CYLINDERS
        ),
        "rods_coplanar", 1, STANDING,
    ),
    "two cords": (
        lambda: _loop(
            (C1, C2), (F,), rod("1", (-F, 0), (X, Y), C1), rod("2", (F, 0), (X, Y), C2), positive=(C1, C2)
        ),
        "rods_aligned", 1, PLAIN,
    ),
    "slides in one line": (
        lambda: _loop((S1, S2), (R,), rod("1", (S1, 0), (X, Y), R), rod("2", (S2, 0), (X, Y), R)),
        "rods_aligned", 1, PLAIN,
    ),
    "motors in one axis": (
        lambda: _loop((J1, J2), (ARM, R), rod("1", _crank(J1), (X, Y), R), rod("2", _crank(J2), (X, Y), R)),
        "rods_aligned", 1, PLAIN,
    ),
    "a crank and a slide on a quill": (
        lambda: _loop(
            (J1, S1, S3), (ARM, R), rod("1", _crank(J1), (X, Y), R), rod("2", (S1, 0), (X, Y), R), closure=(Z - S3,)
        ),
        "rods_aligned", 4, PLAIN,
    ),
}  # fmt: skip
"""The description, where its two positions meet, and the most solutions that a pose has: of slides in one line, and of
motors in one axis, equal rods lean to opposite sides."""


def _machines(kin: Kinematics) -> tuple[Machine, Machine]:
    """The nominal machine in both of its assemblies."""
    nominal, way = {p.name: p.nominal for p in kin.parameters}, kin.mechanism.assembly
    assert way is not None
    first, second = (machine_with(kin, nominal | {way.parameter: v}) for v in (0.0, 1.0))
    return first, second


@pytest.mark.parametrize("name", LOOPS)
def test_both_assemblies_are_derived_and_measured(name: str) -> None:
    """The witness finds as many solutions as the loop has. At the same axes both machines have a position, and the
    indicator has the stated sign.
    """
    described, margin, solutions, names = LOOPS[name]
    kin = derive_and_measure(described())
    way = kin.mechanism.assembly
    assert way is not None and way.margin == margin and way.names == names
    assert kin.evidence is not None and kin.evidence.inverted is not None
    assert kin.evidence.inverted.solutions == solutions
    assert any(f"{way.parameter} chooses" in note for note in kin.mechanism.notes)
    pair, found = _machines(kin), 0
    for axes in np.random.default_rng(5).uniform(-90.0, 700.0, (300, len(kin.mechanism.joints))).tolist():
        poses = [forward(machine, tuple(axes)) for machine in pair]
        assert poses[0][0] is poses[1][0], "one is as possible as the other"
        if poses[0][0] is not Status.OK:
            continue
        units = [np.pi / 180 if j.is_angle else 1.0 for j in kin.mechanism.joints]
        known = {p.name: np.asarray(p.nominal) for p in kin.parameters}
        known |= {j.symbol.name: np.asarray(v * u) for j, v, u in zip(kin.mechanism.joints, axes, units, strict=True)}
        signs = [
            float(evaluate(way.indicator, known | {c: np.asarray(p[k]) for k, c in enumerate("xyz")}))
            for _, p, _ in poses
        ]
        assert way.signs[0] * signs[0] >= 0 >= way.signs[0] * signs[1]
        assert np.isclose(signs[0], -signs[1], rtol=1e-6, atol=1e-3 * abs(signs[0]))
        found += 1
    assert found > 5


@pytest.mark.parametrize("order", [(0, 1, 2), (0, 2, 1)])
@pytest.mark.parametrize("height", [250.0, 0.0])
def test_what_hangs_on_arms_or_carriages_is_below_them(order: tuple[int, ...], height: float) -> None:
    """Whichever way its towers are numbered: the first mode has the plate below the carriages of the nominal pose."""
    carriages = tuple(linear(f"C{k}", "carriage, up", nominal=height) for k in (1, 2, 3))
    feet = [_feet(k)[:2] for k in order]
    rods = tuple(rod(c.key, (*foot, c), (X, Y, Z), R) for foot, c in zip(feet, carriages, strict=True))
    kin = build(validate(Mechanism(name="Towers", joints=carriages, parameters=(R, F), task=Task("xyz"), rods=rods)))
    way = kin.mechanism.assembly
    assert way is not None and (way.names, way.parameter) == (("below", "above"), "assembly_above")
    drop = float(np.sqrt(400.0**2 - 300.0**2))
    for machine, side in zip(_machines(kin), (-1, 1), strict=True):
        _, frame, _ = forward(machine, (height, height, height))
        assert frame[:3] == pytest.approx((0.0, 0.0, height + side * drop), abs=1e-6)


def test_a_loop_with_one_assembly_needs_no_name() -> None:
    """Two equations, linear in the position."""
    slides = Mechanism(name="Slides", joints=(S1, S2), task=Task("xy"), closure=(X - S1 - S2, Y - S1 + S2))
    kin = derive_and_measure(slides)
    assert kin.mechanism.assembly is None
    named = replace(slides, assembly=assembly("tool", Y - S1, margin="aligned", up=+1, down=-1))
    with pytest.raises(DescriptionError, match="assembly 'tool': the loop can be assembled in one way alone"):
        derive_and_measure(named)
