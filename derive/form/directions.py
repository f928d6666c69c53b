"""Directions in decimals: the way d of a slide is a length times the x axis of a rotation, and what an arm turns,
u cos q + v sin q with |u| = |v| and u . v = 0, a length times its x and y axes.

Decimals meet these equations but for their last digit, and then no square of q drops out of the equation of a rod. As
sines and cosines of the angles of the rotation they meet them exactly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import sympy as sp

from derive.description.amounts import STATED, exact_angle, without_decimals
from derive.description.mechanism import Joint, Mechanism
from derive.form.headings import orientation, toward
from derive.form.lines import Array
from derive.geometry.frames import Factor, Motion

_SAME = 1e-14
"""A share of a length that is less is the rounding of decimals."""


def with_exact_directions(mechanism: Mechanism) -> Mechanism:
    """The mechanism whose rods have sines and cosines in place of long decimals in directions that joints move."""
    rods = tuple(replace(r, base=_exact(r.base, mechanism.joints)) for r in mechanism.rods)
    return replace(mechanism, rods=rods)


def _exact(stated: tuple[sp.Expr, ...], joints: Sequence[Joint]) -> tuple[sp.Expr, ...]:
    for joint in joints:
        end = sp.Matrix(stated).expand()
        functions = [sp.cos(joint.symbol), sp.sin(joint.symbol)] if joint.is_angle else [joint.symbol]
        ways = [end.applyfunc(lambda entry, way=way: entry.coeff(way)) for way in functions]
        exact = _directions(ways)
        if exact is not None:
            for function, new, old in zip(functions, exact, ways, strict=True):
                end = (end - function * old).expand() + function * new
            stated = tuple(end)
    return stated


def _directions(ways: Sequence[sp.Matrix]) -> list[sp.Matrix] | None:
    """One direction, or two that are square to each other and as long, without decimals; None for any others."""
    entries = [entry.as_coeff_Mul() for way in ways for entry in way if entry != 0]
    factors = {factor for _, factor in entries}
    if len(factors) != 1 or not any(n.is_Float and without_decimals(n).q > STATED for n, _ in entries):
        return None
    factor = factors.pop()
    numbers = np.zeros((3, len(ways)))
    numbers[: len(ways[0])] = [[float(e / factor) for e in row] for row in zip(*ways, strict=True)]
    size = float(np.linalg.norm(numbers[:, 0]))
    off = numbers.T @ numbers - size**2 * np.eye(len(ways))
    if np.abs(off).max() > _SAME * size**2:
        return None
    length = sp.Rational(f"{size:.14g}") * factor
    return [(length * turned)[: len(ways[0]), 0] for turned in _turned(numbers / size)]


def _turned(units: Array) -> list[sp.Matrix]:
    """Unit vectors, one or two, as columns of a product of turns about x, y and z."""
    if units.shape[1] == 1:
        turns, letter, sign = toward(units[:, 0], None)
        columns = [(letter, sign)]
    else:
        turns = orientation(np.column_stack([units, np.cross(*units.T)]), looks_down=False)
        columns = [(0, 1), (1, 1)]
    rotation = sp.eye(3)
    for axis, angle in turns:
        rotation = rotation * Factor(Motion.TURN, axis, exact_angle(angle)).matrix()[:3, :3]
    return [sign * rotation[:, letter] for letter, sign in columns]
