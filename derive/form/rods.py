"""Rods that end at the commanded point itself: |k P - w| = L says that |P - w / k| = L / k, for k > 0.

The pen on an extension of one rod moves the pin of another one by a share k of its way: a parameter decides k, and the
equation is a circle about a known point once it is divided by it.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.description.mechanism import Mechanism, Rod
from derive.ir.symbols import COORDINATE_NAMES, real

_COORDINATES = tuple(map(real, COORDINATE_NAMES))


def with_plain_rods(mechanism: Mechanism) -> Mechanism:
    """The mechanism with rods that end at the commanded point itself; the rods of the description are drawn."""
    if mechanism.chain is not None or mechanism.is_turning_loop:
        return mechanism
    joints = {j.symbol for j in mechanism.joints}
    rods = tuple(_divided(one, joints) for one in mechanism.rods)
    return replace(mechanism, rods=rods, bars=mechanism.bars or (mechanism.rods if rods != mechanism.rods else ()))


def _divided(one: Rod, joints: set[sp.Symbol]) -> Rod:
    """The rod, divided by the share of the commanded point's way by which its vector moves."""
    between = [sp.expand(end - start) for end, start in zip(one.plate, one.base, strict=True)]
    shares = {sp.factor(sp.diff(v, c)) for v, c in zip(between, _COORDINATES, strict=False)} - {sp.Integer(0)}
    share = shares.pop() if len(shares) == 1 else sp.Integer(1)
    ends = [c if v.has(c) else sp.Integer(0) for v, c in zip(between, _COORDINATES, strict=False)]
    rest = [sp.expand(v - share * c) for v, c in zip(between, ends, strict=True)]
    moved = {s for v in rest for s in v.free_symbols}
    is_constant = share.free_symbols and not share.free_symbols & joints and sp.fraction(share)[0].is_positive
    if shares or not is_constant or moved & {*_COORDINATES}:
        return one
    base = tuple(sp.expand(sp.cancel(-v / share)) for v in rest)
    return replace(one, base=base, plate=tuple(ends), length=sp.factor(one.length / share))
