"""Other words for the same chain: what does not change the machine, done at random places, one after the other."""

from collections.abc import Callable
from random import Random

import sympy as sp

from derive.description.mechanism import Mechanism
from derive.form.headings import product
from derive.geometry.frames import Chain, Factor, Motion

_TURNS = (sp.pi / 6, sp.pi / 4, sp.Rational(3, 10), sp.Float(0.4))
_SHIFTS = (sp.Integer(7), sp.Rational(5, 2), sp.Integer(125))
Factors = list[Factor]


def reworded(mechanism: Mechanism, seed: int, steps: int = 10) -> Chain:
    """The same machine in other words. Flips, which stand at the end, stay."""
    rng, chain = Random(seed), mechanism.chain
    assert chain is not None
    end = sum(f.motion is not Motion.FLIP for f in chain.factors)
    factors = list(chain.factors[:end])
    for _ in range(steps if factors else 0):
        factors = rng.choice(WAYS)(factors, rng)
    return Chain((*(f for f in factors if f.amount != 0), *chain.factors[end:]))


def _exchanged(factors: Factors, rng: Random) -> Factors:
    """Two neighbours that commute: shifts, or what turns and shifts along one axis."""
    places = [
        k
        for k, (a, b) in enumerate(zip(factors, factors[1:], strict=False))
        if a.axis == b.axis or a.motion is b.motion is Motion.SHIFT
    ]
    for k in rng.sample(places, min(3, len(places))):
        a, b = factors[k : k + 2]
        if a.axis == b.axis or a.motion is b.motion is Motion.SHIFT:
            factors = [*factors[:k], b, a, *factors[k + 2 :]]
    return factors


def _split(factors: Factors, rng: Random) -> Factors:
    k = rng.randrange(len(factors))
    one = factors[k]
    part = rng.choice((one.amount / 3, *(_SHIFTS if one.motion is Motion.SHIFT else (sp.pi / 2, sp.Float(0.3)))))
    halves = (Factor(one.motion, one.axis, a) for a in (one.amount - part, part))
    return [*factors[:k], *halves, *factors[k + 1 :]]


def _in_a_turned_frame(factors: Factors, rng: Random) -> Factors:
    """A part of the chain in a frame that right angles turn, and turn back."""
    start = rng.randrange(len(factors))
    end = rng.randrange(start, len(factors) + 1)
    axis, quarters = rng.randrange(3), rng.choice((1, 2, 3))
    turn = Factor(Motion.TURN, axis, quarters * sp.pi / 2)
    seen = product(((axis, -quarters * float(sp.pi) / 2),))
    inner = []
    for one in factors[start:end]:
        column = [round(v) for v in seen[:, one.axis]]
        letter = next(k for k, v in enumerate(column) if v)
        inner.append(Factor(one.motion, letter, column[letter] * one.amount))
    return [*factors[:start], turn, *inner, turn.inverse(), *factors[end:]]


def _there_and_back(factors: Factors, rng: Random) -> Factors:
    """Turns or shifts, and their inverses, before a factor."""
    motion = rng.choice((Motion.TURN, Motion.SHIFT))
    amounts = _TURNS if motion is Motion.TURN else _SHIFTS
    own = [Factor(motion, rng.randrange(3), rng.choice(amounts)) for _ in range(rng.choice((1, 2)))]
    k = rng.randrange(len(factors) + 1)
    return [*factors[:k], *own, *(f.inverse() for f in reversed(own)), *factors[k:]]


def _shift_in_an_oblique_frame(factors: Factors, rng: Random) -> Factors:
    places = [k for k, f in enumerate(factors) if f.motion is Motion.SHIFT]
    if not places:
        return factors
    k = rng.choice(places)
    one, angle = factors[k], rng.choice(_TURNS)
    turn = Factor(Motion.TURN, (one.axis + rng.choice((1, 2))) % 3, angle)
    seen = turn.inverse().matrix()[:3, one.axis] * one.amount
    shifts = (Factor(Motion.SHIFT, axis, amount) for axis, amount in enumerate(seen))
    return [*factors[:k], turn, *(f for f in shifts if f.amount != 0), turn.inverse(), *factors[k + 1 :]]


WAYS: tuple[Callable[[Factors, Random], Factors], ...] = (
    _exchanged,
    _split,
    _in_a_turned_frame,
    _there_and_back,
    _shift_in_an_oblique_frame,
)
