"""Who takes part: for one task each, how the poses are put in, the call that is timed, and what came out.

Every contender gets the poses in the form that suits it best, made before the clock runs. Answers are rows of axes with
the index of their pose, in degrees of the Denavit-Hartenberg table, and are read when the clock has stopped.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
import py_opw_kinematics as opw
from eaik.IK_DH import DhRobot
from scipy.spatial.transform import RigidTransform

from bench.by_hand import Arm, all_solutions, batch, one_solution
from bench.chain import KR6_R900, UR5, Array, Table
from bench.cores import CORES

Answers = tuple[Array, Array]
"""Axes (M, 6), and the pose (M,) that each row is for."""
ALL, ONE, BATCH = "all solutions, one call", "one solution, one call", "a batch"
FORWARD = "a frame, or a Jacobian, one call"


@dataclass(frozen=True)
class Contender:
    """One way to solve a task. A batch is one call for all poses, any other task one call a pose.

    One solution is asked for with two arguments, the pose and what selects it; anything else with one.
    """

    name: str
    task: str
    inputs: Callable[[Array], Any]
    call: Callable[..., Any]
    answers: Callable[[Any], Answers]
    is_peer: bool = False


def contenders(table: Table) -> list[Contender]:
    """All of a robot."""
    found = [*(c for core in CORES for c in _ours(table, core)), *_eaik(table)]
    return [*found, *_opw(table)] if table is KR6_R900 else found


def robot_of(table: Table, core: str) -> Any:
    """Our machine, in millimetres, on a core."""
    softkin = CORES[core]
    a, d = ([1000.0 * v for v in values] for values in (table.a, table.d))
    if table is UR5:
        return softkin.Ac6ThreeParallel(d1=d[0], a2=a[1], a3=a[2], d4=d[3], d5=d[4], d6=d[5])
    return softkin.ArticulatedRobot6DOF(d1=d[0], a1=a[0], a2=a[1], a3=a[2], d4=d[3], d6=d[5])


def _ours(table: Table, core: str) -> list[Contender]:
    robot, softkin = robot_of(table, core), CORES[core]
    near = f"softkin, {core}:"

    def frames(poses: Array) -> list[Any]:
        return [
            softkin.Frame(*f) for f in zip(_tuples(1000.0 * poses[:, :3, 3]), _tuples(poses[:, :3, :3]), strict=True)
        ]

    def plain(poses: Array) -> list[Any]:
        return [tuple(frame) for frame in frames(poses)]

    def arrays(poses: Array) -> tuple[Array, Array]:
        return np.ascontiguousarray(1000.0 * poses[:, :3, 3]), np.ascontiguousarray(poses[:, :3, :3])

    def chosen(poses: Array) -> list[Any]:
        """Frames with the first branch that reaches them."""
        signs = [s for _, s in softkin._configuration.slots((0, 0, 0))]
        found = ((f, robot.branches(f)) for f in frames(poses))
        return [
            (tuple(f), next((s for s, a in zip(signs, axes, strict=True) if a is not None), signs[0]))
            for f, axes in found
        ]

    def named(poses: Array) -> list[Any]:
        return [
            (softkin.Frame(*f), (*(1 if s > 0 else 2 for s in signs), 0, 0, 0, 0, 0, 0)) for f, signs in chosen(poses)
        ]

    def configured(poses: Array) -> tuple[Array, Array, Array]:
        bytes_ = [[1 if s > 0 else 2 for s in signs] + [0] * 6 for _, signs in chosen(poses)]
        return *arrays(poses), np.array(bytes_)

    def every(table_of_slots: Any) -> Answers:
        axes, statuses = table_of_slots
        row, slot = np.nonzero(statuses == softkin.Status.OK)
        return axes[row, slot], row

    def looked_at(solutions: Sequence[Any]) -> Answers:
        return _rows([[s.axes for s in slots if s.axes is not None] for slots in solutions])

    def joints(poses: Array) -> list[Any]:
        """Axis values that reach the frames: those of the first branch."""
        found = (next((a for a in robot.branches(f) if a is not None), (0.0,) * 6) for f in frames(poses))
        return [tuple(map(float, axes)) for axes in found]

    return [
        Contender(f"{near} branches(frame)", ALL, plain, robot.branches, _slots),
        Contender(f"{near} inverse_all(frame), checked", ALL, frames, robot.inverse_all, looked_at),
        Contender(f"{near} tuple(inverse_all(frame))", ALL, frames, lambda f: tuple(robot.inverse_all(f)), looked_at),
        Contender(f"{near} branch(frame, signs)", ONE, chosen, robot.branch, _single),
        Contender(f"{near} inverse(frame, configuration)", ONE, named, robot.inverse, _single),
        Contender(f"{near} inverse_batch, one solution", BATCH, configured, lambda p: robot.inverse_batch(*p), _batch),
        Contender(f"{near} inverse_all_batch", BATCH, arrays, lambda p: robot.inverse_all_batch(*p), every),
        Contender(f"{near} forward(axes)", FORWARD, joints, robot.forward, _nothing),
        Contender(f"{near} jacobian(axes)", FORWARD, joints, robot.jacobian, _nothing),
    ]


def _eaik(table: Table) -> list[Contender]:
    robot = DhRobot(np.radians(table.alpha), np.array(table.a), np.array(table.d))

    def answers(solutions: Sequence[Any]) -> Answers:
        """What it calls a solution; what is one in the sense of least squares is none."""
        kept = [[q for q, is_nearest in zip(s.Q, s.is_LS, strict=True) if not is_nearest] for s in solutions]
        axes, pose = _rows(kept)
        return np.degrees(axes) - table.zero, pose

    return [
        Contender("eaik IK(pose)", ALL, list, robot.IK, answers, True),
        Contender("eaik IK(pose).Q", ALL, list, lambda pose: _read(robot.IK(pose)), answers, True),
        Contender("eaik IK_batched, all solutions", BATCH, np.ascontiguousarray, robot.IK_batched, answers, True),
    ]


def _read(solution: Any) -> Any:
    _ = solution.Q
    return solution


def _opw(table: Table) -> list[Contender]:
    a, d = table.a, table.d
    robot = opw.Robot(opw.KinematicModel(a1=a[0], a2=-a[2], b=0.0, c1=d[0], c2=a[1], c3=d[3], c4=d[5]))
    shift, sign = _opw_zero(robot, table)

    def axes(rows: Array) -> Array:
        return rows * sign + shift

    def every(solutions: Sequence[Any]) -> Answers:
        found, pose = _rows([list(np.atleast_2d(s)) if len(s) else [] for s in solutions])
        return axes(found), pose

    def nearest(rows: Array) -> Answers:
        solved = np.flatnonzero(~np.isnan(rows).any(axis=1))
        return axes(np.asarray(rows)[solved]), solved

    def transforms(poses: Array) -> list[Any]:
        return [RigidTransform.from_matrix(pose) for pose in poses]

    together, one = RigidTransform.from_matrix, "py-opw-kinematics batch_inverse, one solution"
    return [
        Contender("py-opw-kinematics inverse(pose)", ALL, transforms, robot.inverse, every, True),
        Contender(one, BATCH, together, robot.batch_inverse, nearest, True),
        *_by_hand(Arm(a1=a[0], a2=-a[2], c1=d[0], c2=a[1], c3=d[3], c4=d[5]), axes),
    ]


def _by_hand(arm: Arm, axes: Callable[[Array], Array]) -> list[Contender]:
    """The same formulas as py-opw-kinematics has, in Python and NumPy, with the same zero pose."""
    every = all_solutions(arm)

    def frames(poses: Array) -> list[Any]:
        return list(zip(_tuples(poses[:, :3, 3]), _tuples(poses[:, :3, :3]), strict=True))

    def chosen(poses: Array) -> list[Any]:
        """Frames with the first branch that reaches them: arm, then elbow, then wrist."""
        signs = list(product((1.0, -1.0), repeat=3))
        return [
            (f, next(s for s, found in zip(signs, every(f), strict=True) if found is not None)) for f in frames(poses)
        ]

    def rows(poses: Array) -> tuple[Array, Array, Array]:
        positions, rotations = (
            np.ascontiguousarray(poses[:, :3, 3]),
            np.ascontiguousarray(poses[:, :3, :3]).reshape(-1, 9),
        )
        return positions, rotations, np.array([signs for _, signs in chosen(poses)])

    def turned(answers: Answers) -> Answers:
        return axes(answers[0]), answers[1]

    def solved(found: Array) -> Answers:
        row = np.flatnonzero(~np.isnan(found).any(axis=1))
        return axes(found[row]), row

    return [
        Contender("by hand, without singular poses", ALL, frames, every, lambda a: turned(_slots(a))),
        Contender(
            "by hand, without singular poses, one solution",
            ONE,
            chosen,
            one_solution(arm),
            lambda a: turned(_single(a)),
        ),
        Contender("by hand in NumPy, one solution", BATCH, rows, batch(arm), solved),
    ]


def _opw_zero(robot: Any, table: Table) -> tuple[Array, Array]:
    """Its zero pose and directions in terms of the table: the quarter turns and signs with which both chains agree."""
    samples = np.random.default_rng(1).uniform(-80.0, 80.0, (7, 6))
    frames = np.array([robot.forward(tuple(q)).as_matrix() for q in samples])
    turns, signs = np.array([0.0, 90.0, 180.0, -90.0]), np.array([1.0, -1.0])
    for code in range(8**6):
        digits = np.array([code // 8**k % 8 for k in range(6)])
        shift, sign = turns[digits % 4], signs[digits // 4]
        if np.abs(table.frames(samples[:1] * sign + shift) - frames[:1]).max() < 1e-9 and (
            np.abs(table.frames(samples * sign + shift) - frames).max() < 1e-9
        ):
            return shift, sign
    raise AssertionError("py-opw-kinematics does not have this geometry")


def _tuples(rows: Array) -> list[Any]:
    return [tuple(tuple(v) if isinstance(v, list) else v for v in row) for row in rows.tolist()]


def _rows(found: Sequence[Sequence[Any]]) -> Answers:
    rows = [row for rows in found for row in rows]
    return np.array(rows, dtype=float).reshape(-1, 6), np.repeat(np.arange(len(found)), [len(rows) for rows in found])


def _nothing(_: Any) -> Answers:
    """What is no answer to a pose."""
    return np.empty((0, 6)), np.empty(0, int)


def _slots(solutions: Sequence[Any]) -> Answers:
    return _rows([[axes for axes in slots if axes is not None] for slots in solutions])


def _single(solutions: Sequence[Any]) -> Answers:
    return _rows([[] if axes is None else [axes] for axes in solutions])


def _batch(result: Any) -> Answers:
    axes, statuses = result
    solved = np.flatnonzero(statuses == 0)
    return axes[solved], solved
