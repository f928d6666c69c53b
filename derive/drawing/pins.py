"""The pins of a loop: where a crank or a lever turns, and its end."""

from __future__ import annotations

import sympy as sp

from derive.geometry.frames import Chain, Motion
from derive.geometry.pose import pose_of


def pins_of(chain: Chain) -> tuple[tuple[sp.Expr, ...], ...]:
    """The positions in front of every turn of an end of a loop, and of the end itself; equal neighbours once."""
    places = [k for k, f in enumerate(chain.factors) if f.motion is Motion.TURN]
    frames = (Chain(chain.factors[:k]) for k in (*places, len(chain.factors)))
    return tuple(dict.fromkeys(tuple(pose_of(frame).position) for frame in frames))
