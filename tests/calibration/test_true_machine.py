"""A serial machine with deviations: every call of a machine, against its chain multiplied out."""

import copy
import pickle
from collections.abc import Sequence

import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError, Mechanism, Status
from softkin._start import IterativeForward

from tests.calibration.machines import LOOPS, SERIAL, Planted, Truth, drawn_axes, planted
from tests.catalogue.robots import KR6_R900
from tests.mechanisms import named

EXACT = 1e-11
"""Of the reach, and radians."""
TOOL = Frame.from_euler(10.0, 20.0, 30.0, (5.0, -10.0, 80.0))
BASE = Frame.from_euler(-30.0, 10.0, 5.0, (100.0, 200.0, 300.0))


def apart(robot: Mechanism, first: Frame, second: Frame) -> float:
    """How far two frames are apart in what the machine commands: lengths in shares of a metre."""
    inside = [i for i, row in enumerate("xyz") if row in robot.JACOBIAN_ROWS]
    found = [abs(first.position[i] - second.position[i]) / 1000.0 for i in inside]
    if "turn x" in robot.JACOBIAN_ROWS:
        found.append(float(np.abs(np.subtract(first.rotation, second.rotation)).max()))
    if "tilt x" in robot.JACOBIAN_ROWS:
        found.append(max(abs(a[2] - b[2]) for a, b in zip(first.rotation, second.rotation, strict=True)))
    return max(found)


def lost(robot: Mechanism, poses: Sequence[tuple[float, ...]]) -> list[tuple[float, ...]]:
    """The poses whose frame the inverse does not meet on their branch. Of the axes it is told those that are held."""
    found = []
    for axes in poses:
        frame, configuration = robot.forward(axes)
        held = [value if i in robot.HELD else 0.0 for i, value in enumerate(axes)]
        try:
            back = robot.inverse(frame, configuration, held)
        except KinematicsError:
            found.append(axes)
            continue
        if apart(robot, robot.forward(back)[0], frame) > EXACT:
            found.append(axes)
    return found


@pytest.mark.parametrize("name", SERIAL)
def test_forward_is_the_chain_and_inverse_meets_it(name: str) -> None:
    """With deviations of 5 mrad and 5 mm in all that a machine has."""
    rng = np.random.default_rng(7)
    machine = planted(name, rng)
    truth = Truth(name, machine.given, machine.deviations)
    poses = drawn_axes(machine.nominal, 12, rng)
    for axes in poses[:4]:
        wrong = machine.true.forward(axes)[0].matrix - truth.forward(axes)
        assert np.abs(wrong[:3, :3]).max() < EXACT and np.abs(wrong[:3, 3]).max() < 1000.0 * EXACT
    assert not lost(machine.true, poses)


@pytest.mark.parametrize("unit", (1.0, 1e-3))
def test_every_axis_stays_on_its_turn(unit: float) -> None:
    """A range of one turn for every axis, far references, both units; the true machine may be beyond 180 degrees."""
    rng = np.random.default_rng(3)
    lengths = {name: value * unit for name, value in KR6_R900.items()}
    robot = softkin.ArticulatedRobot6DOF(**lengths, limits={f"A{i}": (-180.0, 180.0) for i in range(1, 7)})
    sizes = {"tilt": 0.2, "offset": 0.2, "shift": 3.0 * unit}
    drawn = {n: rng.uniform(-s, s) for n in robot.deviations for word, s in sizes.items() if word in n}
    true = robot.calibrated(drawn)
    for number in range(150):
        axes = rng.uniform(-179.0, 179.0, 6)
        if number % 3 == 0:
            axes[rng.integers(6)] = rng.choice((-90.0, 0.0, 90.0)) + 10.0 ** -rng.integers(1, 12)
        frame, configuration = true.forward(tuple(axes))
        for reference in ((0.0,) * 6, (900.0, -700.0, 0.0, 0.0, 0.0, 400.0)):
            back = true.forward(true.inverse(frame, configuration, reference))[0]
            assert np.abs(np.subtract(back.position, frame.position)).max() < EXACT * 1000.0 * unit
            assert np.abs(np.subtract(back.rotation, frame.rotation)).max() < EXACT


@pytest.mark.parametrize("name", ["Kin_ArticulatedRobot_6DOF", "Softkin_HeadTable_BC", "Kin_Scara4_ZCcoupled_Type1"])
def test_the_jacobian_is_the_derivative(name: str) -> None:
    """By differences of the chain."""
    rng = np.random.default_rng(3)
    machine = planted(name, rng)
    truth, (axes,) = Truth(name, machine.given, machine.deviations), drawn_axes(machine.nominal, 1, rng)
    step = 1e-4
    expected = []
    for i, axis in enumerate(machine.true.AXES):
        ends = [truth.forward([a + sign * step * (k == i) for k, a in enumerate(axes)]) for sign in (1.0, -1.0)]
        unit = np.pi / 180.0 if axis.unit == "deg" else 1.0
        turn = (ends[0] @ np.linalg.inv(ends[1]))[:3, :3]
        twist = np.array([turn[2, 1], turn[0, 2], turn[1, 0]])
        expected.append(np.concatenate([ends[0][:3, 3] - ends[1][:3, 3], twist]) / (2.0 * step * unit))
    columns = np.array(machine.true._twist(axes)).T
    assert columns == pytest.approx(np.array(expected), abs=1e-4)
    batch, statuses = machine.true.jacobian_batch([axes, axes])
    assert not statuses.any() and batch[1] == pytest.approx(np.array(machine.true.jacobian(axes)), abs=1e-9)


@pytest.mark.parametrize("name", [*SERIAL, *LOOPS])
def test_without_deviations_it_is_the_nominal_machine(name: str) -> None:
    """To the last bit: it is that machine itself."""
    nominal = Planted(name, SERIAL.get(name) or LOOPS.get(name) or {}, {}).nominal
    assert nominal.calibrated({}) == nominal == nominal.calibrated(dict.fromkeys(nominal.deviations, 0.0))
    assert nominal.calibrated({"tool_x": 1.0}).calibrated({"tool_x": 0.0}) == nominal


def test_names_are_checked() -> None:
    """An unknown name is refused with the one that was perhaps meant."""
    robot = softkin.ArticulatedRobot6DOF(**KR6_R900)
    assert len(robot.deviations) == 6 * 4 + 6 + 6 + 6 + 6 and not any(robot.deviations.values())
    for given, message in (
        ({"a2_tlt_x": 0.1}, "did you mean 'a2_tilt_x'"),
        ({"qqq": 0.1}, "the names are a1_tilt_x, "),
        ({"a2_tilt_x": float("nan")}, "must be finite numbers, and a2_tilt_x is nan"),
        ({"a2_tilt_x": "much"}, "a2_tilt_x is 'much'"),
        (3, "must be a mapping"),
    ):
        with pytest.raises(KinematicsError, match=message) as caught:
            robot.calibrated(given)  # type: ignore[arg-type]
        assert caught.value.status is Status.NOT_INITIALIZED
    assert robot.calibrated({"a2_tilt_x": 0.1}).deviations["a2_tilt_x"] == 0.1


@pytest.mark.parametrize("name", ["Kin_ArticulatedRobot_6DOF", *LOOPS])
def test_it_is_a_value(name: str, tmp_path: object) -> None:
    """On a base, with a tool, in radians; copied, pickled, written down and loaded."""
    from pathlib import Path

    true = planted(name, np.random.default_rng(1), 0.2).true
    for machine in (true, true.in_radians(), true.with_base(BASE), true.with_tool(((1.0, 2.0, 30.0), np.eye(3)))):
        path = Path(str(tmp_path)) / "machine.json"
        path.write_text(machine.to_json())
        assert softkin.load(path) == machine == copy.deepcopy(machine) == pickle.loads(pickle.dumps(machine))
        assert hash(softkin.load(path)) == hash(machine) and softkin.load(path) != true.calibrated({"tool_x": 9.0})
        assert eval(repr(machine), {**vars(softkin), **{type(true).__name__: type(true)}, "Frame": Frame}) == machine
    path.write_text('{"mechanism": "Calibrated", "nominal": 3}')
    with pytest.raises(KinematicsError, match="machine.json: Calibrated: the entries must be nominal and deviations"):
        softkin.load(path)


def test_base_and_tool_stand_around_the_deviations() -> None:
    """Whichever comes first, the tool or the calibration."""
    machine = planted("Kin_ArticulatedRobot_6DOF", np.random.default_rng(2))
    truth = Truth(machine.name, machine.given, machine.deviations)
    carrying = machine.true.with_base(BASE).with_tool(TOOL)
    assert carrying == machine.nominal.with_base(BASE).with_tool(TOOL).calibrated(machine.deviations)
    axes = (10.0, -80.0, 50.0, 20.0, 30.0, 40.0)
    frame, configuration = carrying.forward(axes)
    assert frame.matrix == pytest.approx(BASE.matrix @ truth.forward(axes) @ TOOL.matrix, abs=1e-9)
    assert carrying.inverse(frame, configuration, axes) == pytest.approx(axes, abs=1e-9)
    radians = carrying.in_radians()
    assert radians.inverse(frame, configuration, np.radians(axes)) == pytest.approx(np.radians(axes), abs=1e-11)


def test_batches_paths_and_choices_are_those_of_single_calls() -> None:
    """Rows, slots, the nearest solution, commanded turns, limits, a line."""
    machine = planted("Kin_ArticulatedRobot_6DOF", np.random.default_rng(4), 0.3)
    true = machine.true.changed(limits={"A6": (-200.0, 200.0), "A5": (None, 100.0)})
    axes = (10.0, -80.0, 50.0, 20.0, 30.0, 179.99)
    frame, configuration = true.forward(axes)
    positions, rotations, configurations, _ = true.forward_batch([axes])
    assert positions[0] == pytest.approx(frame.position, abs=1e-9) and tuple(configurations[0]) == configuration
    found, statuses = true.inverse_batch(positions, rotations, configuration, axes)
    assert not statuses.any() and found[0] == pytest.approx(axes, abs=1e-9)
    slots, codes = true.inverse_all_batch(positions, rotations, axes)
    single = true.inverse_all(frame, axes)
    assert [s.status for s in single] == codes[0].tolist() and single[0].axes == pytest.approx(slots[0, 0], abs=1e-9)
    for solution in single:
        if solution.axes is not None:
            assert apart(true, true.forward(solution.axes)[0], frame) < EXACT
    assert true.nearest(frame, axes) == pytest.approx(axes, abs=1e-9)
    # The axis is on the turn that is commanded, although the nominal machine would be on the other side of its edge.
    for turn in (1, 2):
        commanded = true.configuration(A6=turn)
        lowest = -180.0 if turn == 1 else 180.0
        for last in (179.9, 179.99, 180.01, 180.1):
            target, _ = true.forward((*axes[:5], last))
            free = true.calibrated({}).changed(limits={"A6": None})
            assert lowest - 1e-6 <= free.inverse(target, commanded)[5] <= lowest + 360.0
    bent = true.forward((10.0, -80.0, 50.0, 20.0, 110.0, 40.0))[0]
    with pytest.raises(KinematicsError, match="beyond the limits: A5: "):
        true.inverse(bent, reference=(10.0, -80.0, 50.0, 20.0, 110.0, 40.0))
    goal = Frame((frame.position[0], frame.position[1] + 100.0, frame.position[2]), frame.rotation)
    line = true.line(frame, goal, configuration, axes, samples=25)
    assert line.stop is None and len({true.forward(step)[1][:3] for step in line.axes}) == 1


@pytest.mark.parametrize("name", ["Kin_ArticulatedRobot_6DOF", "Kin_Scara4_ZCcoupled_Type1"])
def test_every_slot_is_on_its_branch(name: str) -> None:
    """Next to a reference that meets the frame on one branch the others have their own solutions."""
    machine = planted(name, np.random.default_rng(5))
    for axes in drawn_axes(machine.nominal, 15, np.random.default_rng(6)):
        frame, own = machine.true.forward(axes)
        found = [s for s in machine.true.inverse_all(frame, axes) if s.axes is not None]
        assert any(s.axes == pytest.approx(axes, abs=1e-7) for s in found)
        for solution in found:
            assert solution.axes is not None
            there = machine.true.forward(solution.axes)[1]
            pairs = zip(there, solution.configuration[: machine.true.BRANCHES], strict=False)
            assert all(byte in (slot, 3) for byte, slot in pairs)
        assert len({tuple(np.round(s.axes, 5)) for s in found if s.axes is not None}) == len(found) and own


def test_what_the_nominal_machine_does_not_reach_is_answered() -> None:
    """Beyond the reach of the drawing a longer arm answers; beyond its own reach it refuses with what is missing."""
    nominal = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0)
    longer = nominal.calibrated({"a4_shift_x": 3.0, "a3_tilt_x": 0.1, "tool_x": 3.0})
    target = longer.forward((20.0, 1.0, 10.0, 5.0))[0]
    assert nominal.diagnose(target).status is Status.UNREACHABLE
    assert apart(longer, longer.forward(longer.inverse(target))[0], target) < EXACT
    refused = longer.diagnose(((554.0, 0.0, 0.0), np.eye(3)))
    assert refused.status is Status.UNREACHABLE and refused.in_words.startswith("the machine as measured")
    assert refused.missing == pytest.approx(554.0 - 553.0, abs=0.2)


def test_a_plane_is_commanded_as_it_is_drawn_or_as_it_is() -> None:
    """A planar machine has no axis for z: neither its own z nor the drawing's is refused, any other is."""
    tilted = softkin.Gantry2().calibrated({"x_tilt_y": 0.2, "base_b": 0.1})
    at = tilted.forward((400.0, 100.0))[0]
    assert abs(at.position[2]) > 0.5
    for z in (at.position[2], 0.0, 0.5 * at.position[2]):
        assert tilted.inverse(((*at.position[:2], z), at.rotation)) == pytest.approx((400.0, 100.0), abs=1e-9)
    assert "no axis" in tilted.diagnose(((*at.position[:2], 5.0), at.rotation)).reason


def test_a_delta_has_other_dimensions_and_stays_in_closed_form() -> None:
    """Dimensions by arm, offsets and gains of axes, a base that is turned."""
    machine = planted("Kin_Delta_P3C_Type3", np.random.default_rng(5), 0.3)
    off = machine.deviations
    own = {n: v + off.get(n, 0.0) for n, v in machine.given.items()}
    base = Frame((off["base_x"], off["base_y"], off["base_z"]), Truth("Kin_Gantry3", {}, off)._end("base")[:3, :3])
    tool = Frame((off["tool_x"], off["tool_y"], off["tool_z"]), Truth("Kin_Gantry3", {}, off)._end("tool")[:3, :3])
    axes = (20.0, 25.0, 30.0)
    moved = [a * (1.0 + off[f"a{i}_gain"]) + off[f"a{i}_offset"] for i, a in enumerate(axes, 1)]
    expected = softkin.DeltaP3CType3(**own).with_base(base).with_tool(tool).forward(moved)[0]
    frame, configuration = machine.true.forward(axes)
    assert frame.matrix == pytest.approx(expected.matrix, abs=1e-9)
    assert machine.true.inverse(frame, configuration) == pytest.approx(axes, abs=1e-9)
    found, statuses = machine.true.inverse_batch([frame.position], [frame.rotation], configuration)
    assert not statuses.any() and found[0] == pytest.approx(axes, abs=1e-9)


def test_a_hexapod_has_its_joint_centres() -> None:
    """Each coordinate of each, in a machine whose forward kinematics iterates from a start."""
    described = named("Kin_Hexapod")
    nominal = softkin.Hexapod(**{p.name: p.nominal for p in described.parameters})
    centres = {name: value for name, value in nominal.parameters.items() if name.startswith(("base_", "platform_"))}
    assert len(centres) == 36 and set(centres) < set(nominal.deviations) and "home_z" not in nominal.deviations
    off = dict(zip(centres, np.random.default_rng(6).uniform(-0.5, 0.5, 36).tolist(), strict=True))
    true = nominal.calibrated({**off, "l1_offset": 0.2, "l2_gain": 1e-3})
    axes = tuple(float(j.shown) + k for k, j in enumerate(described.joints))
    frame, configuration = true.forward(axes)
    own = nominal.changed(**{name: value + off[name] for name, value in centres.items()})
    moved = (axes[0] + 0.2, axes[1] * 1.001, *axes[2:])
    assert frame.matrix == pytest.approx(own.forward(moved)[0].matrix, abs=1e-8)
    assert isinstance(true, IterativeForward)
    assert true.forward(axes, start=frame)[0].matrix == pytest.approx(frame.matrix, abs=1e-8)
    assert true.inverse(frame, configuration) == pytest.approx(axes, abs=1e-9)
    matrices, statuses = true.jacobian_batch([axes], start=frame)
    assert not statuses.any() and matrices[0] == pytest.approx(np.array(true.jacobian(axes)), abs=1e-8)
    assert true.in_radians().with_tool(TOOL) == true.with_tool(TOOL).in_radians()
    assert true.in_radians().deviations["l1_offset"] == 0.2


def test_a_branch_stays_along_a_path() -> None:
    """A curve in the joints that comes near to a straight wrist, followed from step to step."""
    machine = planted("Kin_Ac6_ThreeParallel", np.random.default_rng(0))
    t = np.linspace(0.0, 2.0 * np.pi, 300)
    waves = (40 * np.sin(t), 20 * np.sin(2 * t), 25 * np.cos(t), 60 * np.sin(t), 29 * np.sin(3 * t), 90 * np.cos(t))
    curve = np.array((10.0, -80.0, 50.0, 20.0, 30.0, 40.0)) + np.stack(waves, axis=1)
    positions, rotations, configurations, _ = machine.true.forward_batch(curve)
    near, branch = tuple(curve[0]), (*configurations[0][:3].tolist(), *(0,) * 6)
    for position, rotation in zip(positions, rotations, strict=True):
        axes = machine.true.inverse((position, rotation), branch, near)
        assert np.abs(np.subtract(axes, near)).max() < 15.0
        near = axes


def test_garbage_is_refused() -> None:
    """Numbers that are none, in the frame and in the reference."""
    true = planted("Kin_ArticulatedRobot_6DOF", np.random.default_rng(1)).true
    frame = true.forward((10.0, -80.0, 50.0, 20.0, 30.0, 40.0))[0]
    for wrong in (float("nan"), float("inf"), 1e300):
        assert true.diagnose(((wrong, 0.0, 0.0), frame.rotation)).status is Status.BAD_INPUT
        assert true.diagnose(frame, reference=(wrong, *(0.0,) * 5)).status is Status.BAD_INPUT
        with pytest.raises(KinematicsError, match="numbers must be finite"):
            true.forward((wrong, *(0.0,) * 5))
        assert true.forward_batch([(wrong, *(0.0,) * 5)])[3].tolist() == [Status.BAD_INPUT]
        assert true.inverse_batch([(wrong, 0.0, 0.0)], [frame.rotation])[1].tolist() == [Status.BAD_INPUT]
    gantry = softkin.Gantry3().calibrated({"y_tilt_x": 0.1})
    target = gantry.forward((100.0, 200.0, 300.0))[0]
    assert gantry.inverse(target, reference=(float("nan"),) * 3) == pytest.approx((100.0, 200.0, 300.0), abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["Kin_ArticulatedRobot_6DOF", "Kin_Ac6_ThreeParallel", "Kin_Scara3_Z", "Softkin_TableTable_AC"]
)
def test_no_pose_is_lost(name: str) -> None:
    """Random poses; and poses at and beside singular ones: there one in five hundred may be."""
    rng, beyond = np.random.default_rng(11), 0
    for _ in range(10):
        machine = planted(name, rng)
        poses = drawn_axes(machine.nominal, 130, rng)
        assert not lost(machine.true, poses[:80])
        beside = [
            tuple(
                90.0 * round(a / 90.0) + rng.normal() * 10.0 ** rng.uniform(-6.0, 0.5)
                if axis.unit == "deg" and rng.random() < 0.5
                else a
                for a, axis in zip(axes, machine.nominal.AXES, strict=True)
            )
            for axes in poses[80:]
        ]
        beyond += len(lost(machine.true, beside))
    assert beyond <= 1
