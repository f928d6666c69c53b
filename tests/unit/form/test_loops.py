"""The one form of a closed loop: angles that stand as numbers, and rods that end beside the commanded point."""

import numpy as np
import pytest
from sympy import Expr, cos, pi, sin

from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.form.machine import in_form
from derive.ir.constants import DEGREE
from derive.ir.symbols import COORDINATE_NAMES, real
from derive.kinematics.build import build
from derive.mechanism import Task, X, Y, Z, distance, length, rod, rotary, signed_length
from derive.vectors import vector

BASE, PLATE = length("base", "base", nominal=180.0), length("plate", "plate", nominal=40.0)
ARM, ROD = length("arm", "arm", nominal=210.0), length("rod", "rod", nominal=480.0)
GROUND, LEFT, RIGHT = (length(n, n, nominal=v) for n, v in (("ground", 130.0), ("left", 90.0), ("right", 95.0)))
NEAR, FAR = length("near", "near", nominal=170.0), length("far", "far", nominal=185.0)
PEN, SIDE = distance("pen", "pin to pen", nominal=50.0), signed_length("side", "pin to pen", nominal=40.0)
AXES = tuple(rotary(f"A{k}", "arm") for k in (1, 2, 3))


def delta(*degrees: int) -> Mechanism:
    """A delta whose motors stand at these angles, in degrees."""

    def legs(axis: Expr, at: Expr) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
        reach = BASE + ARM * cos(axis)
        return vector(reach * cos(at), reach * sin(at), -ARM * sin(axis)), vector(
            X + PLATE * cos(at), Y + PLATE * sin(at), Z
        )

    ends = [legs(axis, degree * pi / 180) for axis, degree in zip(AXES, degrees, strict=True)]
    rods = tuple(rod(str(k), *end, ROD) for k, end in enumerate(ends, 1))
    return Mechanism("Own", AXES, Task("xyz"), parameters=(BASE, PLATE, ARM, ROD), rods=rods)


def pen_arm(beyond: Expr, *parameters: object) -> Mechanism:
    """A five-bar whose pen stands on the left rod, beyond the pin that both share."""
    first, second = (rotary(n, "crank", nominal=v) for n, v in (("A1", 125.0), ("A2", 55.0)))
    knees = (LEFT * cos(first), LEFT * sin(first), 0), (GROUND + RIGHT * cos(second), RIGHT * sin(second), 0)
    pin = tuple(k + NEAR / (NEAR + beyond) * (p - k) for k, p in zip(knees[0], (X, Y, 0), strict=True))
    rods = rod("1", knees[0], (X, Y, 0), NEAR + beyond), rod("2", knees[1], pin, FAR)
    parameters = (GROUND, LEFT, RIGHT, NEAR, FAR, *parameters)
    return Mechanism("Own", (first, second), Task("xy"), parameters=parameters, rods=rods)  # type: ignore[arg-type]


MACHINES = {
    "motors at odd angles": delta(0, 130, 251),
    "motors that share an angle": delta(10, 100, 235),
    "the pen on an extension": pen_arm(PEN, PEN),
    "the pen on either side of the pin": pen_arm(SIDE, SIDE),
}


@pytest.mark.long("motors")
@pytest.mark.quick
@pytest.mark.parametrize("name", MACHINES)
def test_it_is_the_same_machine(name: str) -> None:
    """At random poses, joints and parameters every equation is the stated one, times a value that no joint changes."""
    stated, form = MACHINES[name], in_form(MACHINES[name])
    fixed = {p.symbol: p.nominal for p in form.parameters if p.fixed is not None} | {DEGREE: np.pi / 180.0}
    rng = np.random.default_rng(3)
    given = {}
    for own, other in zip(form.parameters, stated.parameters, strict=False):
        given[own.symbol] = given[other.symbol] = own.nominal * rng.uniform(0.9, 1.1)
    ratios = []
    for _ in range(3):
        pose = {s: rng.uniform(-300.0, 300.0) for s in map(real, COORDINATE_NAMES)} | {
            j.symbol: rng.uniform(-3.0, 3.0) for j in AXES
        }
        pairs = zip(form.equations, stated.equations, strict=True)
        ratios.append([float((own / other).xreplace(given | fixed | pose)) for own, other in pairs])
    assert np.ptp(ratios, axis=0).max() < 1e-9 and np.min(ratios) > 0.0


@pytest.mark.long
@pytest.mark.quick
def test_names_of_angles() -> None:
    """10 degrees and 100 degrees have one name, and so have 35 and 235; 60 degrees are roots, and need none."""
    named = [p.name for p in in_form(MACHINES["motors that share an angle"]).parameters if p.fixed is not None]
    assert named == ["angle_10_deg", "angle_35_deg"]
    assert all(p.fixed is None for p in in_form(delta(0, 120, 240)).parameters)
    assert in_form(MACHINES["the pen on an extension"]).bars == MACHINES["the pen on an extension"].rods


@pytest.mark.slow
@pytest.mark.parametrize("name", MACHINES)
def test_it_derives(name: str) -> None:
    """The rods of the form are spheres, or circles, about known points."""
    assert build(validate(MACHINES[name])).branches
