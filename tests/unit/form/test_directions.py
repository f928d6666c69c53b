"""Directions in decimals: as sines and cosines they are unit vectors, square to each other, to any number of digits."""

import numpy as np
import pytest
import sympy as sp
from numpy.typing import ArrayLike

from derive.description.validate import validate
from derive.form.directions import with_exact_directions
from derive.kinematics.build import build
from derive.mechanism import Mechanism, Task, X, Y, Z, linear, rod, rotary
from tests.orthonormal import random_rotations

ARM, SLIDE = rotary("A1", "arm"), linear("S1", "slide")
Vector = tuple[sp.Expr, ...]


def ends(end: Vector) -> Vector:
    """The end of a rod in the form."""
    machine = Mechanism("Own", (ARM, SLIDE), Task("xyz"), rods=(rod("1", end, (X, Y, Z), 100),))
    return with_exact_directions(machine).rods[0].base


def numbers(values: ArrayLike) -> list[sp.Float]:
    return [sp.Float(float(v)) for v in np.ravel(values)]


@pytest.mark.quick
@pytest.mark.parametrize("seed", range(4))
def test_they_are_exact(seed: int) -> None:
    """Random ones, and those of an arm that swings in a plane that is turned about z."""
    rotation = random_rotations(1, np.random.default_rng(seed))[0]
    if seed % 2:
        flat = np.hypot(*rotation[:2, 0])
        u, v = numbers([*210.0 * rotation[:2, 0] / flat, 0.0]), numbers([0.0, 0.0, -210.0])
    else:
        u, v = numbers(210.0 * rotation[:, 0]), numbers(210.0 * rotation[:, 1])
    way = numbers(rotation[:, 2])
    a, s = ARM.symbol, SLIDE.symbol
    stated = sp.Matrix([p + c * sp.cos(a) + d * sp.sin(a) for p, c, d in zip((1, 2, 3), u, v, strict=True)])
    found = sp.Matrix(ends(tuple(stated))).expand()
    first, second = (found.applyfunc(lambda e, f=f: e.coeff(f)) for f in (sp.cos(a), sp.sin(a)))
    for value, exact in ((first.dot(first), 44100), (second.dot(second), 44100), (first.dot(second), 0)):
        assert abs((value - exact).evalf(40)) < 1e-30
    assert np.abs(sp.matrix2numpy((found - stated).subs(a, 0.7), dtype=float)).max() < 1e-11
    slid = sp.Matrix(ends(tuple(s * w for w in way))) / s
    assert abs((slid.dot(slid) - 1).evalf(40)) < 1e-30


@pytest.mark.quick
def test_others_stay() -> None:
    """An ellipse, a skew pair, and numbers as a person writes them."""
    c, s = sp.cos(ARM.symbol), sp.sin(ARM.symbol)
    for u, v in (((60.1234567, 80.7654321), (-80.7654321, 60.1234569)), ((60.1234567, 80.0), (60.1, 80.0))):
        end = (u[0] * c + v[0] * s, u[1] * c + v[1] * s, sp.Integer(0))
        assert ends(end) == end
    plain = (60 * c - 80 * s, 80 * c + 60 * s, sp.Integer(5))
    assert ends(plain) == plain


def delta(*turns: float, share: float = 0.0) -> Mechanism:
    """A delta whose motors stand at these angles, all in decimals. share: each equation, multiplied out, times this."""
    joints = tuple(rotary(f"A{k}", "motor") for k in range(1, 1 + len(turns)))
    rods, closure = [], []
    for k, turn in enumerate(turns):
        q, (x, y) = joints[k].symbol, np.array([np.cos(turn), np.sin(turn)])
        end = (140 * x + 210 * x * sp.cos(q), 140 * y + 210 * y * sp.cos(q), -210 * sp.sin(q))
        rods.append(rod(str(k + 1), end, (X, Y, Z), 480))
        closure.append(sp.expand(rods[-1].equation * share))
    if share:
        return Mechanism("Own", joints, Task("xyz"), closure=tuple(closure))
    return Mechanism("Own", joints, Task("xyz"), rods=tuple(rods))


@pytest.mark.parametrize("share", [0.0, 1.0, 1 / 420])
def test_a_delta_in_decimals_derives(share: float) -> None:
    """Its rods are spheres, whatever its equations were divided by."""
    assert len(build(validate(delta(0.3, 2.5, 4.4, share=share))).mechanism.branches) == 3
