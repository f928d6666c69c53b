"""The verdict finds nothing in a faultless record, and every fault that is planted in one."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from prove.linuxcnc.machines import MACHINES, SCARA, Machine
from prove.linuxcnc.poses import filled, frames
from prove.linuxcnc.session import Record, Stage
from prove.linuxcnc.twin import Twin
from prove.linuxcnc.verdict import ALIKE, verdict
from tests.prove.pretended import ROWS, answers, pretended, stage

pytestmark = pytest.mark.slow("Hexapod")

CHOSEN = [machine.mechanism for machine in MACHINES if Twin(machine).robot.BRANCHES]
NAMED = {machine.mechanism: machine for machine in MACHINES}


@cache
def faultless(machine: str) -> Record:
    return pretended(NAMED[machine])


def changed(record: Record, name: str, change: Callable[[Stage], Stage]) -> Record:
    return replace(record, stages={**record.stages, name: change(record.stages[name])})


@pytest.mark.parametrize("machine", NAMED)
def test_a_faultless_record_is_proven(machine: str) -> None:
    """Each of the machines reaches all that it is asked for, and the verdict says so."""
    found = verdict(Twin(NAMED[machine]), faultless(machine))
    assert found.faults == ()
    assert found.elbow_kept is not False and found.refused
    assert found.joints <= ALIKE and found.poses <= ALIKE
    assert found.samples >= 1000


@pytest.mark.parametrize("machine", NAMED)
def test_what_cannot_be_reached_cannot_be_reached(machine: str) -> None:
    """The package refuses the pose that LinuxCNC has to refuse, in every configuration."""
    twin = Twin(NAMED[machine])
    end = filled(faultless(machine).stages["second"].poses[-1], twin.machine.unreachable)
    positions, rotations = frames(twin.machine, end[None])
    assert not any(one.axes for one in twin.robot.inverse_all((positions[0], rotations[0])))


@pytest.mark.parametrize("machine", [machine.mechanism for machine in MACHINES if machine.through])
def test_a_line_leaves_the_workspace_between_two_poses_that_are_reached(machine: str) -> None:
    """The package refuses a pose in the middle, and answers at both ends."""
    twin, stages = Twin(NAMED[machine]), faultless(machine).stages
    assert ROWS < len(stages["through"].joints) < 9 * ROWS
    assert twin.machine.through is not None
    end = filled(stages["beside"].poses[-1], twin.machine.through[1])
    assert len(answers(twin, twin.machine.second, end[None], stages["beside"].joints[-1])) == 1


@pytest.mark.parametrize("machine", NAMED)
def test_a_joint_that_differs_is_found(machine: str) -> None:
    """One joint in one row, by a millionth."""

    def wrong(was: Stage) -> Stage:
        joints = was.joints.copy()
        joints[150, -1] += 1e-6
        return replace(was, joints=joints)

    for name in ("first", "second"):
        found = verdict(Twin(NAMED[machine]), changed(faultless(machine), name, wrong))
        assert any(fault.startswith("a joint differs") for fault in found.faults)


@pytest.mark.parametrize("machine", NAMED)
def test_a_pose_of_the_wrong_sign_is_found(machine: str) -> None:
    """A letter of the forward kinematics whose sign is wrong."""
    record = faultless(machine)
    for column in np.flatnonzero(np.ptp(record.stages["bring"].poses, axis=0) > 1.0):
        sign = np.where(np.arange(6) == column, -1.0, 1.0)
        found = verdict(
            Twin(NAMED[machine]), changed(record, "bring", lambda was, sign=sign: replace(was, poses=was.poses * sign))
        )
        assert any(fault.startswith("a pose differs") for fault in found.faults), column


@pytest.mark.parametrize("machine", CHOSEN)
def test_another_configuration_is_found(machine: str) -> None:
    """Both programs in the configuration of the other one."""
    record, twin = faultless(machine), Twin(NAMED[machine])
    stages = {**record.stages, "first": record.stages["second"], "second": record.stages["first"]}
    found = verdict(twin, replace(record, stages=stages))
    assert not found.elbow_kept
    alike = replace(twin.machine, second=twin.machine.first)
    assert not verdict(Twin(alike), replace(record, stages={**stages, "second": stages["first"]})).elbow_kept


def _cut(was: Stage) -> Stage:
    rows = slice(0, 401)
    return stage(was.name, was.joints[rows], was.poses[rows])


def _moving(was: Stage) -> Stage:
    joints = was.joints.copy()
    joints[-1, 2] += 1e-3
    return replace(was, joints=joints)


def _leaving(was: Stage) -> Stage:
    motors = was.motors.copy()
    motors[100] += 0.02
    return replace(was, motors=motors)


def _staying(was: Stage) -> Stage:
    joints, poses = was.joints.copy(), was.poses.copy()
    joints[:, 0], poses[:, 0] = joints[0, 0], joints[0, 0]
    return stage(was.name, joints, poses)


def _turned(was: Stage) -> Stage:
    pose = np.array(was.before["pose"])
    return replace(was, before={**was.before, "pose": (pose + [0.0, 0.0, 0.0, 0.0, 0.0, 360.0]).tolist()})


PLANTED: dict[str, tuple[str, Callable[[Stage], Stage], str]] = {
    "a program that is not ended": ("second", _cut, "the end of a line is missed"),
    "a program with a complaint": ("first", lambda was: replace(was, said=["following error"]), "following error"),
    "a joint that jumps": ("second", lambda was: replace(was, joints=was.joints * 20.0), "program: a joint jumps"),
    "a joint too fast": ("first", lambda was: replace(was, joints=was.joints * 1.01), "a speed differs"),
    "motors beside the way": ("first", _leaving, "the motors leave the programmed way"),
    "jogged elsewhere": ("jog", lambda was: replace(was, poses=was.poses + 1e-3), "is jogged: a joint differs"),
    "not jogged": ("jog", lambda was: replace(was, in_world=was.in_program), "the pose is jogged: a joint differs"),
    "not refused": ("unreachable", lambda was: replace(was, said=[]), "is not refused"),
    "moved": ("unreachable", _moving, "the machine moves"),
    "switched off": (
        "unreachable", lambda was: replace(was, after={**was.after, "on": False}), "switches the machine off"
    ),
    "stuck": ("behind it", lambda was: replace(was, after=was.before), "does not go on"),
    "not told": (
        "wrong parameter", lambda was: replace(was, after=was.before), "the pin parameters-refused says False"
    ),
    "told for ever": (
        "right parameter", lambda was: replace(was, after={**was.after, "parameters refused": True}),
        "the pin parameters-refused says True"
    ),
    "taken all the same": (
        "wrong parameter", lambda was: replace(was, joints=was.joints + 1e-3), "wrong parameter: a joint differs"
    ),
    "another complaint": ("right parameter", lambda was: replace(was, said=["x_kins: no"]), "does not go on"),
    "letters that are not joints": (
        "identity", lambda was: replace(was, poses=was.poses[:, [1, 0, 2, 3, 4, 5]]), "identity: a joint differs"
    ),
    "a joint that stays": ("identity", _staying, "identity: a joint misses its end"),
    "another turn": ("kinematics again", _turned, "back from identity, the pose differs"),
    "not stopped": ("through", lambda was: replace(was, said=[]), "is not stopped"),
    "thrown": ("through", lambda was: replace(was, joints=was.joints * 8.0), "a joint jumps"),
    "home lost": ("through", lambda was: replace(was, after={**was.after, "homed": False}), "loses its home"),
    "stuck at the edge": ("behind that", lambda was: replace(was, after=was.before), "does not go on"),
}  # fmt: skip


@pytest.mark.parametrize("planted", PLANTED)
def test_a_planted_fault_is_found(planted: str) -> None:
    """The verdict says what was planted."""
    name, change, words = PLANTED[planted]
    found = verdict(Twin(SCARA), changed(faultless(SCARA.mechanism), name, change))
    assert any(words in fault for fault in found.faults), found.faults


def test_lost_periods_and_a_start_that_fails_are_found() -> None:
    """What was not recorded proves nothing."""
    record, twin = faultless(SCARA.mechanism), Twin(SCARA)
    assert "3 periods were not recorded" in verdict(twin, replace(record, lost=3)).faults
    fallen = verdict(twin, Record({}, "LinuxCNC did not come up", 0, 1.0))
    assert fallen.faults == ("LinuxCNC did not come up",)
    assert not fallen.elbow_kept and not fallen.refused and fallen.samples == 0


@pytest.mark.parametrize("machine", NAMED)
def test_a_pose_is_its_frame(machine: str) -> None:
    twin = Twin(NAMED[machine])
    for stand in (twin.machine.first, twin.machine.second):
        positions, rotations = frames(twin.machine, twin.pose(stand.joints)[None])
        frame, _ = twin.robot.forward(stand.joints)
        assert np.abs(positions[0] - frame.position).max() < 1e-9
        assert np.abs(rotations[0] - np.array(frame.rotation)).max() < 1e-12


def test_a_machine_says_where_it_cannot_go() -> None:
    """Every machine is asked for two configurations, and G0, G1 and G2 in each."""
    machines: tuple[Machine, ...] = MACHINES
    assert len(machines) == 8 and len(CHOSEN) == 7
    for machine in machines:
        for stand in (machine.first, machine.second):
            assert {move.code for move in stand.program} == {"G0", "G1", "G2"}
