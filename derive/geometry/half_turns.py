"""Fixed half turns of a chain that turns about z alone: they are moved to its end, as flips of the flange.

A ceiling SCARA begins with Rx(pi), a table of Denavit and Hartenberg has a twist of pi before the quill, a tool that
points down ends in Rx(pi). Since Rx(pi) Rz(a) = Rz(-a) Rx(pi), each equals a chain with the half turn behind its
joints.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import sympy as sp

from derive.geometry.frames import Chain, Factor, Motion


def with_half_turns_last(chain: Chain) -> Chain:
    """The chain with its fixed half turns about x and y moved to its end as flips. Where turns about other axes than z
    would be left, the chain is unchanged.
    """
    signs = [1, 1, 1]
    moved: list[Factor] = []
    for factor in chain.factors:
        if _is_half_turn(factor):
            signs = [s if axis == factor.axis else -s for axis, s in enumerate(signs)]
        elif factor.motion is Motion.FLIP:
            moved.append(factor)
        else:
            moved.append(factor if signs[factor.axis] > 0 else replace(factor, amount=-factor.amount))
    flipped = [f.motion is Motion.FLIP for f in moved]
    if (
        not any(map(_is_half_turn, chain.factors))
        or any(f.motion is Motion.TURN and f.axis != 2 for f in moved)
        or sorted(flipped) != flipped  # a flip must stand at the end
    ):
        return chain
    joints, flips = ([f for f in moved if (f.motion is Motion.FLIP) is is_flip] for is_flip in (False, True))
    return Chain((*joints, *_FIXED[tuple(signs)], *flips))


_FIXED: Mapping[tuple[int, ...], tuple[Factor, ...]] = {
    (1, 1, 1): (),
    (1, -1, -1): (Factor(Motion.FLIP, 0, sp.Integer(1)),),
    (-1, 1, -1): (Factor(Motion.FLIP, 1, sp.Integer(1)),),
    (-1, -1, 1): (Factor(Motion.TURN, 2, sp.pi),),
}
"""For the diagonal of each rotation by half turns, the factors that replace it at the end of a chain."""


def _is_half_turn(factor: Factor) -> bool:
    if factor.motion is not Motion.TURN or factor.axis == 2 or not isinstance(factor.amount, sp.Expr):
        return False  # an amount that is no angle is refused later, with its own message
    return bool((factor.amount / sp.pi).is_odd)
