"""The function block: every method answers as Python does, to the last digit, and every statement of it runs."""

from itertools import product

import numpy as np
import pytest
import softkin
from numpy.testing import assert_allclose
from softkin import Status

from derive.ir.program import Status as Outcome
from derive.mechanisms.kin_hexapod import MECHANISM
from tests.catalogue.hexapod import test_refusals
from tests.catalogue.hexapod.machines import Array, Machine, found_from, machines, without_mode
from tests.harness.library import Library
from tests.machines.other_poses import platform
from tests.text import values
from tests.text.controller import BAD_INPUT, IMPOSSIBLE, OK, UNREACHABLE, Controller
from tests.text.hexapod.blocks import controller, made
from tests.text.pairs import pairs_of
from tests.text.statements import Statements
from tests.text.test_every_statement import asked_of_every_block, compare_all, left_out
from tests.text.units import compiled, compiled_text, file_of, text_of


def compare(machine: Machine, block: Controller, position: Array, turn: Array) -> None:
    robot = machine.robot
    axes = robot.inverse((position, turn))
    assert block.inverse(position, turn, (), (0.0,) * 6) == (OK, axes)
    frame, _ = robot.forward(axes)
    status, pose = block.forward(axes)
    assert status == OK and pose[:2] == (frame.position, frame.rotation) and not any(pose[2])
    assert_allclose(frame.position, position, atol=1e-9 * machine.shift)
    assert block.jacobian(axes) == (OK, robot.jacobian(axes))
    assert block.is_singular(axes) == robot.singularity(axes).is_singular


def compare_some(machine: Machine, block: Controller, count: int = 12) -> None:
    """The same at poses all over the workspace."""
    positions, turns = machine.poses(count)
    for position, turn in zip(positions, turns, strict=True):
        compare(machine, block, position, turn)


def test_blocks_share_nothing() -> None:
    """Two machines of one library, asked in turns: the private method works for the one that calls it."""
    library = compiled(MECHANISM)
    pairs = [(machines()[name], made(machines()[name], library)) for name in ("nominal", "lopsided")]
    for _ in range(2):
        for machine, block in pairs:
            compare_some(machine, block, 3)


def in_the_other_mode() -> tuple[float, ...]:
    """Lengths for which the search from home ends beyond the singularity, where the machine is not."""
    machine = machines()["asymmetric"]
    axes = machine.axes(*machine.poses(3000, turn=100.0))[:300]
    home = np.tile(machine.home[:3], (300, 1)), np.tile(machine.home_turn, (300, 1, 1))
    _, anywhere = found_from(without_mode(), machine, axes, *home)
    refused = machine.robot.forward_batch(axes)[3] == Status.IMPOSSIBLE
    return tuple(axes[np.flatnonzero(refused & (anywhere == Outcome.OK))[0]])


@pytest.mark.long
def test_the_other_assembly_mode_is_refused() -> None:
    """The search finds a pose with these lengths, on the other side; the machine is not there."""
    machine, axes = machines()["asymmetric"], in_the_other_mode()
    assert machine.robot.forward_batch([axes])[3] == [Status.IMPOSSIBLE]
    assert controller("asymmetric").forward(axes) == (IMPOSSIBLE, None)


def ending_where_nothing_holds() -> Library:
    """The unit with a search that ends at a determinant of 0. Where two poses meet, a real one ends at about 1e-6."""
    written = "\nFindPlatform := Softkin_Names.NoError;"
    text = text_of(MECHANISM)
    assert text.count(written) == 1
    return compiled_text(file_of(MECHANISM), text.replace(written, "\nplatform.determinant := 0.0;" + written[1:]))


@pytest.mark.long
def test_without_control_there_is_no_jacobian() -> None:
    """Where the legs do not control the platform there is no Jacobian, and the pose is singular."""
    block, axes = made(machines()["nominal"], ending_where_nothing_holds()), (650.0,) * 6
    assert block.jacobian(axes) == (IMPOSSIBLE, None)
    assert accelerated(block, axes) == IMPOSSIBLE
    assert block.is_singular(axes)


def accelerated(block: Controller, axes: tuple[float, ...]) -> str:
    """The status of AxisAccelerations, with zeros where it refuses."""
    found, given = [1.0] * 6, {"aVelocities": [3.0] * 6, "aTwistRate": [0.0] * 6}
    status: str = block.block.call(
        "AxisAccelerations", aAccelerations=found, **given, a=values.axes(block.library, axes)
    )
    assert status == OK or found == [0.0] * 6
    return status


@pytest.mark.slow
def test_every_statement_runs() -> None:
    """This file, and what is asked of every block, execute every statement of this one."""
    loops, small = pairs_of(MECHANISM), compiled(MECHANISM, matrix_size=36)
    statements = Statements([file_of(MECHANISM)], [compiled(MECHANISM), small, ending_where_nothing_holds()])
    with statements.watched():
        for name in ("nominal", "lopsided"):
            compare_some(machines()[name], controller(name), 2)
        compare_all(loops[1], loops[1].regular[0])
        for test in asked_of_every_block(loops):
            test()
        test_the_other_assembly_mode_is_refused()
        test_without_control_there_is_no_jacobian()
        for turn in (np.eye(3) * 1.1, np.diag((1.0, 1.0, -1.0)), np.eye(3) * np.nan):
            test_refusals.test_what_is_no_rotation(turn)
        check_initialize()
        check_bounds()
        check_other_poses()
        assert (
            controller("nominal").forward((1e6,) * 6)
            == controller("nominal").forward((-1.0,) * 6)
            == (IMPOSSIBLE, None)
        )
        assert controller("nominal").jacobian((1e6,) * 6)[0] == IMPOSSIBLE
        assert accelerated(controller("nominal"), (1e6,) * 6) == IMPOSSIBLE
        assert accelerated(controller("nominal"), (650.0,) * 6) == OK
        assert controller("nominal").is_singular((1e6,) * 6)
    assert left_out(MECHANISM, statements) == []


def check_other_poses() -> None:
    """Poses that forward kinematics does not find again, and starts that are no numbers."""
    one = platform(MECHANISM.name)
    block = Controller(compiled(MECHANISM), MECHANISM)
    assert block.initialise(one.robot.parameters) == OK
    for lost in one.poses[0]:
        assert block.inverse(lost.frame.position, lost.frame.rotation, (), lost.axes) == (UNREACHABLE, None)
    nowhere = values.frame(block.library, (np.nan, 0.0, 0.0), np.eye(3).tolist())
    at_home = values.axes(block.library, (650.0,) * 6)
    still = {"aAccelerations": [0.0] * 6, "aVelocities": [0.0] * 6, "aTwistRate": [0.0] * 6}
    given_to = {
        "JacobianFrom": {"J": [0.0] * 36},
        "MarginsFrom": {"aMargins": [0.0] * 8},
        "AxisAccelerationsFrom": still,
    }
    for method, given in given_to.items():
        assert block.block.call(method, **given, a=at_home, f=nowhere) == BAD_INPUT


def check_initialize() -> None:
    """Machines that cannot work, and limits that change nothing."""
    for case in test_refusals.refused_parameters():
        test_refusals.test_machines_that_cannot_work(case)
    limits = {f"{end}_l{k}": value for k in range(1, 7) for end, value in (("lower", 1.0), ("upper", 1e4))}
    for more in ({"lower_l1": 1.0, "upper_l1": 1e3}, limits | {"max_angle_base_joint": 30.0}):
        assert made(machines()["nominal"], compiled(MECHANISM), **more).forward((650.0,) * 6)[0] == OK


def check_bounds() -> None:
    """Limits, cones, the singularity, and a leg without length refuse in the inverse, and Diagnose names the leg."""
    machine = machines()["nominal"]
    pose, reference = (machine.home[:3] + 20.0, machine.home_turn), (0.0,) * 6
    limits = [{f"lower_l{k}": low, f"upper_l{k}": low + 1.0} for k in range(1, 7) for low in (1.0, 1e4)]
    for more in (*limits, {"min_type2_margin": 1.0}):
        block = made(machine, compiled(MECHANISM), **more)
        assert block.inverse(*pose, (), reference) == (UNREACHABLE, None)
        reason, missing = block.diagnose(*pose, (), reference)
        said = "rods_dependent" if "min_type2_margin" in more else next(iter(more)).removeprefix("lower_").upper()
        assert reason.startswith(f"{said}: ") and missing > 0.0
    check_cones(machine)
    unchecked = made(machine, compiled(MECHANISM), **limits[0], check_limits=False)
    assert unchecked.inverse(*pose, (), reference) == (OK, machine.robot.inverse(pose))
    for k, on_base in enumerate(machine.base - machine.platform, 1):
        assert controller("nominal").inverse(on_base, np.eye(3), (), reference) == (UNREACHABLE, None)
        without = controller("nominal").diagnose(on_base, np.eye(3), (), reference)
        assert without == (f"leg {k}: without length it has no direction", 0.0)
    beyond = (0.0, 0.0, np.nan), np.eye(3), (), reference
    assert controller("nominal").inverse(*beyond) == (BAD_INPUT, None)
    assert controller("nominal").diagnose(*beyond) == ("not given: numbers of reasonable size", 0.0)


def check_cones(machine: Machine) -> None:
    """Every leg leans more than those before it at some place, and a cone between them refuses it alone.

    A platform that keeps its rotation sees the same leans as the base.
    """
    rng = np.random.default_rng(5)
    along = _directions(machine, machine.home[:3])
    for leg, side in product(range(6), ("base", "plate")):
        before = lean = 0.0
        while lean <= before + 0.1:
            place = machine.home[:3] + rng.uniform(-60.0, 60.0, 3)
            leans = np.degrees(np.arccos(np.minimum(np.sum(along * _directions(machine, place), axis=1), 1.0)))
            lean, before = float(leans[leg]), float(leans[:leg].max(initial=0.0))
        cone = {f"max_angle_{side.replace('plate', 'platform')}_joint": 0.5 * (lean + before)}
        block, robot = made(machine, compiled(MECHANISM), **cone), softkin.Hexapod(**{**machine.given, **cone})
        reason, missing = block.diagnose(place, machine.home_turn, (), (0.0,) * 6)
        assert (reason, pytest.approx(missing, rel=1e-12)) == robot.diagnose((place, machine.home_turn))[1:3]
        assert reason == f"leg {leg + 1}: its joint on the {side} bends beyond its cone [deg]"
        assert missing == pytest.approx(0.5 * (lean - before), rel=1e-6)


def _directions(machine: Machine, position: Array) -> Array:
    """Of the legs, with the rotation of the home pose."""
    spans = machine.spans(position, machine.home_turn)
    return np.asarray(spans / np.linalg.norm(spans, axis=1)[:, None])
