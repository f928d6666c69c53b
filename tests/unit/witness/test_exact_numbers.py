"""The check in a finite field refuses no machine for how its numbers are written, and proves none that is wrong."""

from collections.abc import Callable
from dataclasses import replace
from random import Random

import pytest
import sympy as sp

from derive.description.mechanism import Mechanism, X, Y, Z, assembly, branch, length, linear, rod, rotary
from derive.description.validate import validate
from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.ir.constants import DEGREE
from derive.ir.program import Output
from derive.kinematics.build import build
from derive.kinematics.kinematics import Exact, Kinematics
from derive.mechanism import Task, Turning
from derive.vectors import minus, triple, vector
from derive.witness import Disagreement
from derive.witness.exact.proof import check_exactly

pytestmark = pytest.mark.slow

SLIDES = P1, P2, P3 = tuple(linear(f"P{k}", "slide") for k in (1, 2, 3))
A1, A4, A5, A6 = (rotary(f"A{k}", "turn") for k in (1, 4, 5, 6))
ROD = length("rod", "rods", nominal=0.5)


def angle(rng: Random) -> sp.Expr:
    """An oblique angle, written in one of many ways."""
    ways = (sp.pi / 6, sp.pi / 5, 37 * DEGREE, sp.Float(rng.randint(200, 700) / 1000), sp.Float(rng.uniform(0.2, 0.7)))
    return rng.choice(ways)


def leaning_slides(rng: Random) -> Mechanism:
    """Slides that are not square to each other."""
    return Mechanism("Own", SLIDES, Task("xyz"), chain=Tx(P1) * Rz(angle(rng)) * Ty(P2) * Rx(angle(rng)) * Tz(P3))


def added_angles(rng: Random) -> Mechanism:
    """Decimal angles whose sum is turned back."""
    one, other = (sp.Rational(rng.randint(200, 700), 1000) for _ in range(2))
    first, both = Ry(sp.Float(one)) * Tx(P1), Ry(-sp.Float(one + other)) * Tx(P3)
    return Mechanism("Own", SLIDES, Task("xyz"), chain=first * both * Ry(sp.Float(other)) * Ty(P2))


def leaning_boom(rng: Random) -> Mechanism:
    """A boom that leans on a column, with a wrist."""
    chain = Rz(A1) * Tz(P1) * Ry(angle(rng)) * Tx(P2) * Rz(A4) * Ry(A5) * Rz(A6) * Tz(sp.Float(0.1))
    task, joints = Task("xyz", Turning.FULL), (A1, P1, P2, A4, A5, A6)
    return Mechanism("Own", joints, task, chain=chain, positive=(P2.symbol,), offset_interface=False)


def linear_delta(rng: Random) -> Mechanism:
    """Upright rails at places with decimals, in metres."""
    places = [(0.3, 0.02), (-0.17, 0.24), (-0.14, -0.27)]
    bases = [vector(round(x + rng.randint(-20, 20) / 1000, 3), y, s) for (x, y), s in zip(places, SLIDES, strict=True)]
    ends = [vector(X + 0.05, Y + 0.1), vector(X - 0.02, Y + 0.04), vector(X - rng.randint(20, 40) / 1000, Y - 0.05)]
    plates = [vector(e[0], e[1], Z) for e in ends]
    along = [minus(p, b) for p, b in zip(plates, bases, strict=True)]
    return Mechanism(
        "Own",
        SLIDES,
        Task("xyz"),
        parameters=(ROD,),
        rods=tuple(rod(str(k), b, p, ROD) for k, (b, p) in enumerate(zip(bases, plates, strict=True))),
        branches=tuple(branch(f"side_{k}", -v[2], above=1, below=-1) for k, v in enumerate(along)),
        assembly=assembly("tcp", triple(along), margin="coplanar", below=-1, above=1),
    )


def found(kin: Kinematics, described: Mechanism) -> Exact:
    try:
        return check_exactly(kin, described)
    except Disagreement:
        return Exact(0, "refused")


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("make", [leaning_slides, added_angles, leaning_boom, linear_delta])
def test_odd_numbers(make: Callable[[Random], Mechanism], seed: int) -> None:
    """What is right is proven, in the form where that computes numbers; what is wrong by 1e-14 never is."""
    described = validate(make(Random(seed)))
    kin = build(described)
    exact = check_exactly(kin, described)
    assert exact.trials == 3, exact.sentence
    outputs = tuple(
        Output(o.name, o.value * (1 + sp.Rational(1, 10**14))) for o in kin.forward.outputs if o.name == "x"
    )
    others = tuple(o for o in kin.forward.outputs if o.name != "x")
    spoiled = replace(kin, forward=replace(kin.forward, outputs=(*outputs, *others)))
    assert found(spoiled, described).trials == 0
