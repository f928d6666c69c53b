"""Twins: two solutions that stand at one root, where joints are eliminated. The first that is met is kept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import sympy as sp

from derive.description.mechanism import Joint
from derive.equations.axes import reference_value
from derive.ir.primitives import Select, Wrap
from derive.ir.program import Let
from derive.ir.symbols import SCALE, flag, real
from derive.kinematics.search.loop.tried import ROOM

HAS_TWIN, TWO_WAYS = flag("has_twin"), flag("had_two_ways")
"""Whether there is a twin so far; whether the last trial told two ways to solve the others."""
TWIN = "twin"
"""The output that tells whether there is a twin; those behind it are its joints."""
_APART = sp.Float("1e-5")
"""Twins are further apart than this (radians and lengths, added)."""


def kept(joint: sp.Symbol) -> sp.Symbol:
    """A joint at the nearest root so far."""
    return real(f"kept_{joint.name}")


def kept_now(joint: sp.Symbol) -> sp.Symbol:
    """The same behind a pass."""
    return real(f"kept_now_{joint.name}")


def twin(joint: sp.Symbol) -> sp.Symbol:
    """A joint of the twin of the nearest root so far."""
    return real(f"other_{joint.name}")


def twin_now(joint: sp.Symbol) -> sp.Symbol:
    """The same behind a pass."""
    return real(f"other_now_{joint.name}")


def is_twin(joints: Sequence[Joint], nearest: sp.Symbol, near: sp.Expr) -> Iterator[Let]:
    """Whether joints that fit stand where the nearest ones do, and are others.

    nearest: how far these are away; near: what is as near.
    """
    beside = sp.Le(sp.Abs(real("way_ahead") - nearest), near)
    ways = [sp.Abs(_between(j, j.symbol, kept(j.symbol))) for j in joints]
    yield Let(flag("is_twin"), sp.And(flag("is_answer"), beside, sp.Gt(sp.Add(*ways), _APART)))


def twins_now(joints: Sequence[Joint], nearest: sp.Expr, settles: sp.Basic, room: sp.Expr) -> Iterator[Let]:
    """The twin so far, and whether a root may have one: a trial that settles leaves no room.

    nearest: a root that is nearer than this is another one.
    """
    stays = sp.Or(sp.Not(flag("is_better")), sp.Gt(real("way_ahead"), nearest))
    yield Let(flag("has_twin_now"), sp.Or(flag("is_twin"), sp.And(HAS_TWIN, stays)))
    yield from (Let(twin_now(j.symbol), Select(flag("is_twin"), j.symbol, twin(j.symbol))) for j in joints)
    yield Let(flag("has_two_ways"), sp.Or(sp.And(settles, sp.Le(ROOM, room)), sp.And(sp.Not(settles), TWO_WAYS)))


def nearer_twin(joints: Sequence[Joint], near: sp.Expr, is_onward: sp.Basic) -> Iterator[Let]:
    """Whether a twin is nearer to the reference; none is asked for where roots are, one after the other."""
    ways = [real(f"way_of_{word}") for word in ("kept", TWIN)]
    for way, named in zip(ways, (kept_now, twin_now), strict=True):
        yield Let(way, sp.Add(*[_between(j, named(j.symbol), reference_value(j)) ** 2 for j in joints if not j.free]))
    takes = sp.And(sp.Not(is_onward), flag("has_twin_now"), sp.Lt(ways[1], ways[0] - near))
    yield Let(flag("takes_twin"), takes)


def _between(joint: Joint, value: sp.Expr, other: sp.Expr) -> sp.Expr:
    """How far two values of a joint are apart, without turns; those of a slide in lengths of the machine."""
    return Wrap(value - other) if joint.is_angle else (value - other) / SCALE
