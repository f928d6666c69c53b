"""A record as a faultless LinuxCNC would leave it, made by the Python package."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from prove.linuxcnc.machines import LETTERS, Machine, Pose, Stand
from prove.linuxcnc.poses import Reals, Segment, filled, frames, segments
from prove.linuxcnc.session import BESIDE, Record, Stage
from prove.linuxcnc.twin import Twin
from prove.linuxcnc.verdict import REFUSED, STOPPED

ROWS = 400
"""Rows of a line."""
JOG = 3.0
JOGGED = 400
"""Rows of a way from one configuration to the other."""


def stage(name: str, joints: Reals, poses: Reals, *said: str, moves: str = "program", on: bool = True) -> Stage:
    """A stage whose motors follow at once."""

    def status(row: int) -> Mapping[str, Any]:
        seen = {"joints": joints[row].tolist(), "pose": poses[row].tolist(), "on": on, "homed": True}
        return {**seen, "parameters refused": False}

    in_program, in_world = (np.full(len(joints), moves == by) for by in ("program", "world"))
    return Stage(name, joints, joints, poses, in_program, in_world, status(0), status(-1), list(said))


def answers(twin: Twin, stand: Stand, poses: Reals, near: Reals) -> Reals:
    """The joints (N, joints) at these poses, each near the one before, up to the first pose that is refused."""
    branches = twin.branches(stand)
    configuration = (*branches, *(0,) * (len(twin.robot.CONFIGURATION) - len(branches)))
    positions, rotations = frames(twin.machine, poses)
    found: list[Any] = [near]
    for frame in zip(positions, rotations, strict=True):
        try:
            found.append(twin.robot.inverse(frame, configuration, found[-1]))
        except ValueError:
            break
    return np.array(found[1:]).reshape(-1, len(stand.joints))


def ran(twin: Twin, name: str, stand: Stand) -> Stage:
    way = segments(twin.pose(stand.joints) - twin.raised, stand.program)
    poses = np.concatenate([part.at(np.linspace(0.0, 1.0, ROWS)) for part in way]) + twin.raised
    return stage(name, answers(twin, stand, poses, np.array(stand.joints)), poses)


def brought(twin: Twin, begin: Stage) -> Stage:
    """From where a program ended into the second configuration, joint by joint; the pose is a row late."""
    one, other = begin.joints[-1], np.array(twin.machine.second.joints)
    joints = one + np.linspace(0.0, 1.0, JOGGED)[:, None] * (other - one)
    poses = np.array([twin.pose(row) for row in joints])
    return stage("bring", joints, np.concatenate([poses[:1], poses[:-1]]), moves="joints")


def line(twin: Twin, name: str, begin: Stage, to: Pose, *said: str, on: bool = True) -> Stage:
    """A line from where another stage ended, up to the first pose that is refused."""
    way = Segment(begin.poses[-1], filled(begin.poses[-1], to)).at(np.linspace(0.0, 1.0, 10 * ROWS))
    joints = answers(twin, twin.machine.second, way, begin.joints[-1])
    return stage(name, joints, way[: len(joints)], *said, on=on)


def jogged(twin: Twin, begin: Stage) -> Stage:
    there = line(twin, "jog", begin, {"X": begin.poses[-1, 0] + JOG})
    return stage("jog", there.joints, there.poses, moves="world")


def refused(name: str, begin: Stage) -> Stage:
    """A line that is refused where another stage ended."""
    still = np.repeat(begin.joints[-1:], 10, axis=0), np.repeat(begin.poses[-1:], 10, axis=0)
    return stage(name, *still, f"Linear move on line 6 {REFUSED}")


def told(was: Stage) -> Stage:
    """The stage with a parameter that is not allowed: the module says so, once."""
    after = {**was.after, "parameters refused": True}
    return replace(was, after=after, said=["scara_kins: link_length_1 must be at most 1"])


def identical(twin: Twin, name: str, begin: Reals, by: float) -> Stage:
    """A line in which letters are joints."""
    joints = begin + np.linspace(0.0, by, ROWS)[:, None]
    poses = np.zeros((ROWS, len(LETTERS)))
    poses[:, [LETTERS.index(letter) for letter in twin.machine.letters]] = joints
    return stage(name, joints, poses)


def pretended(machine: Machine) -> Record:
    """What the proof would record if all were right."""
    twin = Twin(machine)
    first, second = ran(twin, "first", machine.first), ran(twin, "second", machine.second)
    by_hand = jogged(twin, second)
    asked = refused("unreachable", by_hand)
    end, beside = ({"X": asked.poses[-1, 0] + by} for by in (0.0, BESIDE))
    behind = line(twin, "behind it", asked, beside)
    wrong = told(line(twin, "wrong parameter", behind, end))
    right = line(twin, "right parameter", wrong, beside)
    there = identical(twin, "identity", right.joints[-1], BESIDE)
    stages = [
        stage("home", first.joints[:1], first.poses[:1]),
        first,
        brought(twin, first),
        second,
        by_hand,
        asked,
        behind,
        wrong,
        right,
        there,
        identical(twin, "identity back", there.joints[-1], -BESIDE),
        line(twin, "kinematics again", right, end),
    ]
    if machine.through is not None:
        beside = line(twin, "beside", stages[-1], machine.through[0])
        stopped = line(twin, "through", beside, machine.through[1], STOPPED, on=False)
        stages += [beside, stopped, line(twin, "behind that", stopped, machine.through[0])]
    return Record({one.name: one for one in stages}, "", 0, 1.0)
