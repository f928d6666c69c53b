"""What is no gear is refused: in a description, and when a machine is set up."""

from dataclasses import replace

import pytest
from softkin import Status

from derive.description.mechanism import DescriptionError, Mechanism
from derive.frames import Ry, Rz, Tx, Ty, Tz
from derive.kinematics.build import build
from derive.mechanism import coupling, rotary
from tests.catalogue.refusals import refusal
from tests.machines.made import made
from tests.machines.task_machines import A1, A2, DRIVEN, G1, L1, L2, A, B, X, Y, Z
from tests.text.controller import OK

K = coupling("ratio", "a ratio that may be zero", nominal=0.5)


def _with(name: str, **changes: object) -> Mechanism:
    return replace(DRIVEN[name], **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("mechanism", "message"),
    [
        (
            _with("SCARA with gears", chain=Rz(A1 * K) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(Z), parameters=(L1, L2, K)),
            "the gear of joint 'A1' is ratio, which may be zero: state it by numbers,"
            " lengths and `transmission(...)` alone",
        ),
        (
            _with(
                "head on a differential",
                chain=Tx(X) * Ty(Y) * Tz(Z) * Rz(A / G1 + B) * Ry(A / G1 - B),
                parameters=(G1,),
                branches=(),
            ),
            "2 turns of the chain share 2 motors so that none follows from the ones before it; state every"
            " angle by motors of earlier axes and its own, or give the gears as numbers",
        ),
        (
            _with(
                "head on a differential",
                chain=Tx(X) * Ty(Y) * Tz(Z) * Rz(A) * Ry(B) * Rz(A / G1),
                parameters=(G1,),
                branches=(),
            ),
            "the chain turns by (1/gear_1, 0) of its motors, which is no sum of its other turns; state every"
            " angle by motors of earlier axes and its own, or give the gears as numbers",
        ),
        (
            _with("SCARA with gears", chain=Rz(A1 + Z / L1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(Z)),
            "the chain turns by 'Z', which is a length: declare it rotary, and let it move lengths, too",
        ),
        (
            _with("SCARA with gears", joints=(rotary("A1", "turn", domain=(-90.0, 90.0)), A2, Z)),
            "joint 'A1' has a gear and a domain: state the domain as limits of its axis",
        ),
    ],
)
def test_what_is_no_gear_is_refused(mechanism: Mechanism, message: str) -> None:
    with pytest.raises(DescriptionError) as refusal:
        build(mechanism)
    assert str(refusal.value) == message


@pytest.mark.parametrize("gear", [0.0, float("nan"), float("inf"), 1e7, -1e7])
def test_a_gear_that_is_none_is_refused_when_the_machine_is_set_up(gear: float) -> None:
    machine = made("SCARA with gears of any ratio")
    assert refusal(type(machine.robot), **{**machine.robot.parameters, "gear_1": gear}) is Status.NOT_INITIALIZED
    controller = machine.controller()
    assert controller.initialise({**machine.robot.parameters, "gear_1": gear}) != OK
