"""Machines with lengths a million times apart, against the same formulas with sixty digits and against the closure.

The error of an answer may be a small multiple of the change that the last digits of parameters and positions cause. A
formula that squares lengths and then subtracts loses the square of their ratio, a thousand times as much and more.
"""

from collections.abc import Iterator, Mapping
from functools import cache, cached_property
from itertools import islice

import mpmath
import numpy as np
import pytest
import softkin
from softkin import KinematicsError

from derive.description.mechanism import Joint, Mechanism, Role
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from tests.catalogue.machines import LENGTHS
from tests.catalogue.many_digits import DIGITS, Number, evaluate_exactly, run_exactly
from tests.mechanisms import catalogue, kinematics_of, named
from tests.text.controller import OK, Controller
from tests.text.units import compiled

pytestmark = pytest.mark.slow

NAMES = ("MC_KIN_TYPE_12_XY", "Kin_Tripod_Rotary", "Kin_ArticulatedRobot_6DOF", "Kin_P2X_Type1", "Kin_P2C_Type1")
OTHERS = tuple(
    m.name for _, m in catalogue() if m.joints and not (m.is_platform or m.search or m.drives) and m.name not in NAMES
)
EXECUTED = ("MC_KIN_TYPE_12_XY", "Kin_Tripod_Rotary")
"""Mechanisms whose Structured Text is asked, too."""
DECADES = 3.0
FEWER_DECADES = {"Kin_Delta_P3C_Type3": 1.0}
"""Twelve lengths: of a wider spread hardly any machine closes."""
MACHINES, PERTURBED = 5, 4
ATTEMPTS, FEWEST = 1000, 4
"""Loops of random lengths seldom close."""
REGULAR = 0.01
"""The least margin."""
ALLOWED = 40.0
"""How many times what half a unit in the last place of the inputs does. Before: type 12 200 000, the robot 10 000, and
of the
rotary delta 1 500 000 near its origin, where short arms turn long rods."""
DIGIT = 2.0**-53
Numbers = Mapping[str, Number]


@cache
def built(name: str) -> Kinematics:
    """All programs of the mechanism of that name."""
    return kinematics_of(named(name))


def parameters_of(mechanism: Mechanism, rng: np.random.Generator) -> Iterator[dict[str, float]]:
    """Random machines, lengths by their decades, in units from micrometres to kilometres."""
    decades = FEWER_DECADES.get(mechanism.name, DECADES)
    while True:
        unit = 10.0 ** rng.uniform(-3.0, 3.0)
        given = {p.name: p.nominal for p in mechanism.parameters}
        for p in mechanism.parameters:
            if p.role in LENGTHS or (p.role is Role.DISTANCE and rng.integers(2)):
                sign = rng.choice([-1.0, 1.0]) if p.low < 0.0 else 1.0
                given[p.name] = float(sign * unit * 10.0 ** rng.uniform(-decades, decades))
            elif p.role is Role.DISTANCE:
                given[p.name] = 0.0
            elif p.role is Role.FLAG:
                given[p.name] = float(rng.integers(2))
        yield given


class Exact:
    """One machine with sixty digits, and what half a unit in the last place of everything changes."""

    def __init__(self, kinematics: Kinematics, robot: softkin.Mechanism, rng: np.random.Generator) -> None:
        self.kinematics, self.rng = kinematics, rng
        self.fixed = {p.name for p in kinematics.parameters if p.role in (Role.FLAG, Role.SIGN)}
        self.given = {n: Number(v) for n, v in robot.parameters.items()}
        self.machine = self._with_constants(self.given)

    @cached_property
    def others(self) -> list[dict[str, Number]]:
        """Machines whose parameters differ in their last place; made where the machine itself gives an answer."""
        return [
            self._with_constants({n: v if n in self.fixed else self.jittered(v) for n, v in self.given.items()})
            for _ in range(PERTURBED)
        ]

    def _with_constants(self, given: dict[str, Number]) -> dict[str, Number]:
        return given | run_exactly(self.kinematics.setup, given)[0]

    def jittered(self, value: Number) -> Number:
        """The value, changed by at most half a unit in the last place of a double."""
        return value * (1 + Number(float(self.rng.uniform(-1.0, 1.0))) * DIGIT)

    def at(self, name: str, inputs: Numbers, exactly: Numbers) -> tuple[Numbers, dict[str, float]] | None:
        """The outputs of a program, and how far each moves; None where it refuses one of them."""
        program = getattr(self.kinematics, name)
        truth, status = run_exactly(program, {**self.machine, **inputs, **exactly})
        if status is not Status.OK:
            return None
        runs = [
            run_exactly(program, {**m, **{n: self.jittered(v) for n, v in inputs.items()}, **exactly})
            for m in self.others
        ]
        if any(status is not Status.OK for _, status in runs):
            return None
        return truth, {n: float(max(abs(other[n] - v) for other, _ in runs)) for n, v in truth.items()}


@pytest.mark.parametrize("name", [*NAMES, *OTHERS])
def test_no_digit_is_lost_but_those_of_the_inputs(name: str) -> None:
    """Forward, and inverse on the branch of the pose: in Python, scalar and batch, and of some in Structured Text."""
    with mpmath.workdps(DIGITS):
        _check(name)


def _check(name: str) -> None:
    kinematics, rng = built(name), np.random.default_rng(5)
    mechanism = kinematics.mechanism
    controller = Controller(compiled(mechanism), mechanism) if name in EXECUTED else None
    tried = 0
    for given in islice(parameters_of(mechanism, rng), ATTEMPTS):
        if tried == MACHINES:
            break
        try:
            robot = softkin.catalogue()[name](**given, **_unchecked(mechanism))
        except KinematicsError:
            continue
        found = _pose(Exact(kinematics, robot, rng), robot)
        if found is None:
            continue
        exact, axes, position, moved = found
        least = min((abs(m) for m in robot.singularity(axes).margins.values()), default=1.0)
        _close_to(
            robot.forward(axes)[0].position, position, [m / min(least, 1.0) for m in moved]
        )  # rods in nearly one direction
        tried += _inverse(exact, robot, axes, controller)
    assert tried >= FEWEST


def _unchecked(mechanism: Mechanism) -> dict[str, float]:
    return {"check_limits": False} | ({"min_type2_margin": 0.0} if mechanism.assembly else {})


def _pose(exact: Exact, robot: softkin.Mechanism) -> tuple[Exact, list[float], list[Number], list[float]] | None:
    """Regular axis values, of every second machine near its origin; its position, and how far that moves."""
    scale = float(exact.machine["machine_scale"])
    near = 10.0 ** exact.rng.uniform(-6.0, 0.0) if exact.rng.integers(2) else 1.0
    for _ in range(60):
        axes = [near * float(exact.rng.uniform(*_range(j, scale))) for j in exact.kinematics.mechanism.joints]
        if not _is_regular(robot, axes):
            continue
        named = {j.axis.name: Number(v) for j, v in zip(exact.kinematics.mechanism.joints, axes, strict=True)}
        found = exact.at("forward", named, {})
        if found is not None:
            truth, moved = found
            return exact, axes, [truth[c] for c in "xyz"], [moved[c] + DIGIT * scale for c in "xyz"]
    return None


def _range(joint: Joint, scale: float) -> tuple[float, float]:
    farthest = 180.0 if joint.is_angle else scale
    low, high = joint.domain or (-farthest, farthest)
    return max(low, -farthest), min(high, farthest)


def _is_regular(robot: softkin.Mechanism, axes: list[float]) -> bool:
    try:
        margins = robot.singularity(axes).margins.values()
    except KinematicsError:
        return False
    return all(abs(m) > REGULAR for m in margins)


def _inverse(exact: Exact, robot: softkin.Mechanism, axes: list[float], controller: Controller | None) -> bool:
    """Whether the machine may be there: a ball joint ends, a plate is in the other assembly mode."""
    mechanism = exact.kinematics.mechanism
    frame, configuration = robot.forward(axes)
    inputs = {c: Number(v) for c, v in zip("xyz", frame.position, strict=True)}
    inputs |= {f"r{i + 1}{k + 1}": Number(v) for i, row in enumerate(frame.rotation) for k, v in enumerate(row)}
    exactly = {j.reference.name: Number(v) for j, v in zip(mechanism.joints, axes, strict=True)}
    exactly |= {j.turn.name: Number(0) for j in mechanism.joints}
    exactly |= {f"sigma_{b.name}": Number(3 - 2 * k) for b, k in zip(mechanism.branches, configuration, strict=False)}
    found = exact.at("branch", inputs, exactly)
    if found is None:
        return False
    truth = [found[0][j.axis.name] for j in mechanism.joints]
    sizes = [DIGIT * (180.0 if j.is_angle else float(exact.machine["machine_scale"])) for j in mechanism.joints]
    moved = [found[1][j.axis.name] + size for j, size in zip(mechanism.joints, sizes, strict=True)]
    _closes(exact, truth, inputs)
    chosen = configuration[: robot.BRANCHES] + (0,) * len(robot.PERIOD_AXES)
    _close_to(robot.inverse(frame, chosen, axes), truth, moved)
    batch, _ = robot.inverse_batch([frame.position], [frame.rotation], chosen, axes)
    _close_to(batch[0], truth, moved)
    if controller is not None:
        assert controller.initialise(robot.parameters) == OK
        status, answer = controller.inverse(frame.position, frame.rotation, chosen, axes)
        assert status == OK
        _close_to(answer[: len(truth)], truth, moved)
    return True


def _closes(exact: Exact, axes: list[Number], position: Numbers) -> None:
    """The answer with sixty digits is one of the closure: of equations as the description states them."""
    mechanism = exact.kinematics.mechanism
    joints = {
        j.symbol.name: (v - exact.machine[j.offset.name]) * (mpmath.pi / 180 if j.is_angle else 1)
        for j, v in zip(mechanism.joints, axes, strict=True)
    }
    largest = max(exact.machine["machine_scale"], *map(abs, position.values()))
    for equation in mechanism.equations:
        assert (
            abs(evaluate_exactly(equation, {**exact.machine, **joints, **position}))
            < Number(10) ** (20 - DIGITS) * largest**2
        )


def _close_to(found: object, truth: list[Number], moved: list[float]) -> None:
    for value, exact, far in zip(np.asarray(found), truth, moved, strict=True):
        assert abs(Number(float(value)) - exact) <= ALLOWED * far
