"""The one form of a machine: the rules, in their order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import sympy as sp

from derive.description.amounts import with_exact_angles
from derive.description.mechanism import Mechanism, Rod
from derive.form.chain import with_normal_chain
from derive.form.gears import with_gears
from derive.form.inner_names import with_inner_names
from derive.form.numbers import with_exact_numbers, with_named_loop_angles, with_named_numbers
from derive.form.roots import with_squared_roots
from derive.ir.symbols import COORDINATE_NAMES, real

_COORDINATES = tuple(map(real, COORDINATE_NAMES))


def in_form(mechanism: Mechanism, further: Mapping[str, int] | None = None) -> Mechanism:
    """The mechanism in its one form.

    further: the symbols of parameters and joints whose names equalled a derived one in earlier attempts, and how often.
    """
    own = with_normal_chain(with_exact_angles(with_inner_names(mechanism, further)))
    geared = with_gears(own)  # a turn written in two parts is one by now
    return with_named_numbers(with_named_loop_angles(with_plain_rods(with_squared_roots(with_exact_numbers(geared)))))


def with_plain_rods(mechanism: Mechanism) -> Mechanism:
    """The mechanism with rods that end at the commanded point itself: |k P - w| = L says that |P - w / k| = L / k, for
    k > 0. A pen on an extension of one rod moves the pin of another one by a share k of its way. The rods of the
    description are drawn.
    """
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
