"""Which of two slides is nearer does not depend on the unit: in Python, scalar and batch, in couplings, in Structured
Text."""

import numpy as np
import pytest
import softkin

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import Array
from tests.mechanisms import catalogue
from tests.text.controller import OK, Controller
from tests.text.units import compiled

SLIDES = tuple(m for _, m in catalogue() if m.branches and not any(j.is_angle for j in m.joints))
UNITS = {"millimetres": 1.0, "metres": 1e-3}
IDENTITY = np.eye(3)
TIE = 1e-6
"""Of the machine's scale: its square is what squared distances tie within."""


@pytest.fixture(params=SLIDES, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    """A mechanism whose branches are told apart by slides alone."""
    return request.param


def robot_in(mechanism: Mechanism, unit: float) -> softkin.Mechanism:
    """Without limits and without a least margin, so that every branch answers."""
    kind = softkin.catalogue()[mechanism.name]
    lengths = {p.name for p in kind.PARAMETERS if p.unit == "u"}
    given = {p.name: p.nominal * (unit if p.name in lengths else 1.0) for p in mechanism.parameters}
    return kind(**given, check_limits=False, min_type2_margin=0.0)


def scale_of(robot: softkin.Mechanism) -> float:
    """The lengths of the machine together."""
    return sum(robot.parameters[p.name] for p in robot.PARAMETERS if p.unit == "u" and p.kind in ("length",
        "distance") and (
        p.kind == "length" or p.low == 0.0))  # fmt: skip


def two_solutions(robot: softkin.Mechanism, mechanism: Mechanism) -> tuple[Array, Array, Array]:
    """A position, and the axes of its two first slots that answer."""
    axes = np.array([j.nominal for j in mechanism.joints]) * scale_of(robot) / scale_of(robot_in(mechanism, 1.0))
    frame, _ = robot.forward(axes)
    found = [s.axes for s in robot.inverse_all(frame, axes) if s.axes is not None]
    assert len(found) >= 2
    return np.array(frame.position), np.array(found[0]), np.array(found[1])


@pytest.mark.parametrize("unit", UNITS.values(), ids=UNITS)
def test_the_nearer_slide_is_chosen_in_every_unit(mechanism: Mechanism, unit: float) -> None:
    """Half-way between two solutions the lower slot answers, a micrometre of a metre beside it the nearer one."""
    robot = robot_in(mechanism, unit)
    position, first, second = two_solutions(robot, mechanism)
    scale, apart = scale_of(robot), float(np.linalg.norm(second - first))
    controller = Controller(compiled(mechanism), mechanism)
    assert controller.initialise(robot.parameters) == OK
    towards = (second - first) / apart
    tie = (TIE * scale) ** 2
    for excess, chosen in (
        (0.0, first),
        (0.5 * tie, first),
        (3.0 * tie, second),
        (-3.0 * tie, first),
        (1e-5 * scale**2, second),
    ):
        near = (first + second) / 2 + towards * excess / (2.0 * apart)
        for found in answers(robot, controller, position, near):
            assert np.abs(found - chosen).max() < 1e-9 * scale


def answers(robot: softkin.Mechanism, controller: Controller, position: Array, near: Array) -> list[Array]:
    width = len(near)
    automatic = (0,) * len(robot.CONFIGURATION)
    found = [np.array(robot.inverse((position, IDENTITY), automatic, near))]
    found.append(robot.inverse_batch([position], [IDENTITY], automatic, near)[0][0])
    status, axes = controller.inverse(position, IDENTITY, automatic, near)
    assert status == OK
    found.append(np.array(axes[:width]))
    coupled = softkin.Coupled(robot, softkin.CAxis())
    opened = (0,) * len(coupled.CONFIGURATION)
    for turn in (0.0, 40.0):  # however far the rotary axis has to go: it has to in every branch
        reference = (*near, turn)
        found.append(np.array(coupled.inverse((position, IDENTITY), opened, reference))[:width])
        found.append(coupled.inverse_batch([position], [IDENTITY], opened, reference)[0][0, :width])
    return found


def test_half_a_millimetre_is_seen_in_metres() -> None:
    """Two solutions of a biglide at 0.5 mm and 1 mm from the reference, in metres: the nearer one,
    not the lower slot.
    """
    robot = softkin.P2XType1(arm_length_1=0.3, arm_length_2=0.4, min_type2_margin=0.0)
    height = np.sqrt(0.3**2 - 0.00075**2)  # both ends of the first rod 0.75 mm beside the plate
    position, automatic = (0.1, -float(height), 0.0), (0, 1)
    slots = [np.array(s.axes) for s in robot.inverse_all((position, IDENTITY)) if s.axes is not None]
    low, high = slots[0], slots[1]
    assert np.abs(high - low).max() == pytest.approx(0.0015, rel=1e-6)
    near = low + (high - low) * (1.0 / 1.5)
    assert np.linalg.norm(near - high) == pytest.approx(0.0005, rel=1e-6)
    assert robot.inverse((position, IDENTITY), automatic, near) == pytest.approx(tuple(high), abs=1e-12)
