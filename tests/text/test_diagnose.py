"""The answers of Diagnose against known properties of a machine. Other tests compare both languages."""

import pytest
from softkin import Diagnosis, Scara2Z, Status

from derive.description.catalogue import MECHANISMS, load
from tests.text.controller import Controller
from tests.text.samples import NO_TURN
from tests.text.units import compiled

SCARA = load(MECHANISMS / "kin_scara2_z.py")
GIVEN = {
    "arm_length_1": 300.0, "arm_length_2": 200.0, "lower_a1": -10.0, "upper_a1": 40.0, "lower_z": 0.0,
    "upper_z": 100.0,
}  # fmt: skip
ROBOT = Scara2Z(**GIVEN)
REFERENCE = (0.0, 0.0, 0.0)
NAN = float("nan")


def frame(axes: tuple[float, ...]) -> tuple[tuple[float, ...], tuple[int, ...]]:
    (position, _), configuration = ROBOT.forward(axes)
    return position, configuration


def both(position: tuple[float, ...], configuration: tuple[int, ...]) -> Diagnosis:
    """What Python says, after the block has said the same."""
    controller = Controller(compiled(SCARA), SCARA)
    controller.initialise(ROBOT.parameters)
    found = ROBOT.diagnose((position, NO_TURN), configuration, REFERENCE)
    reason, missing, turn, _ = controller.explain(position, NO_TURN, configuration, REFERENCE)
    assert (reason, turn) == (found.reason, found.turn)
    assert missing == pytest.approx(found.missing, rel=1e-12, abs=1e-12)
    return found


@pytest.mark.parametrize(
    ("axes", "reason", "missing"),
    [
        ((42.5, 30.0, 50.0), "A1: above its upper limit [deg]", 2.5),
        ((-13.0, 30.0, 50.0), "A1: below its lower limit [deg]", 3.0),
        ((5.0, 30.0, 108.0), "Z: above its upper limit [u]", 8.0),
        ((5.0, 30.0, -0.25), "Z: below its lower limit [u]", 0.25),
    ],
)
def test_the_axis_beyond_its_limit_and_how_far(axes: tuple[float, ...], reason: str, missing: float) -> None:
    """Diagnose names the axis beyond its limit, the missing amount, and a turn that is inside."""
    found = both(*frame(axes))
    assert (found.status, found.reason) == (Status.UNREACHABLE, reason)
    assert found.missing == pytest.approx(missing, rel=1e-6)


def test_nothing_to_say() -> None:
    assert both(*frame((5.0, 30.0, 50.0))) == (Status.OK, "", 0.0, 0, 0.0)


@pytest.mark.parametrize(("distance", "missing"), [(501.0, 1.0), (510.0, 10.0), (60.0, 40.0), (99.0, 1.0)])
def test_out_of_reach_by_a_length(distance: float, missing: float) -> None:
    """The arms are 300 and 200 long: nothing beyond 500, and nothing nearer than 100."""
    found = both((0.0, distance, 50.0), (1, 0, 0))
    assert (found.status, found.reason) == (Status.UNREACHABLE, "A2: out of reach [u]")
    assert found.missing == pytest.approx(missing, rel=1e-9)


def test_what_is_no_number() -> None:
    assert both((1.0, NAN, 0.0), (1, 0, 0)) == (Status.BAD_INPUT, "not given: numbers of reasonable size", 0.0, 0, 0.0)


def test_a_byte_without_a_meaning() -> None:
    assert both((400.0, 0.0, 50.0), (7, 0, 0)) == (
        Status.BAD_INPUT,
        "byte 0 of the configuration means nothing",
        0.0,
        0,
        0.0,
    )


def test_it_changes_nothing() -> None:
    robot = Scara2Z(**GIVEN)
    position, configuration = frame((5.0, 30.0, 50.0))
    before = robot.inverse((position, NO_TURN), configuration, REFERENCE)
    assert robot.diagnose(((900.0, 0.0, 0.0), NO_TURN)) == robot.diagnose(((900.0, 0.0, 0.0), NO_TURN))
    assert robot.inverse((position, NO_TURN), configuration, REFERENCE) == before
