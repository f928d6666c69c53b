"""`make peers`: the same two arms in other packages, one pose a call: what is solved, how well, and in which time.

Every package reads the same robot file, or the same Denavit-Hartenberg table. A numerical solver starts at zero, and
has the settings of its own documentation. Prints the table of docs/COMPARE.md.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
from eaik.IK_DH import DhRobot

from bench.chain import KR6_R900, UR5, Array, Table, errors
from bench.contenders import robot_of
from bench.cores import CORES

POSES = 100
RIGHT = 1e-6
"""An answer is right where it misses by less (metres, parts of one)."""
Solver = Callable[[Array], Any]
"""A pose (4, 4) in metres → rows of axes in radians of the table, or an empty list."""


def urdf(table: Table) -> str:
    """The arm as a robot file whose joint values are those of the table."""
    from softkin import Frame

    here, texts = Frame((0.0, 0.0, 0.0)), []
    for k in range(6):
        here = here @ Frame.from_euler(table.zero[k], 0.0, 0.0)
        texts.append(_joint(k, "revolute", here))
        here = Frame((table.a[k], 0.0, table.d[k])) @ Frame.from_rpy(table.alpha[k], 0.0, 0.0)
    links = "".join(f'<link name="link{k}"/>' for k in range(8))
    return f'<robot name="arm">{links}{"".join(texts)}{_joint(6, "fixed", here)}</robot>'


def _joint(k: int, kind: str, frame: Any) -> str:
    place, turn = (" ".join(map(repr, v)) for v in (map(float, frame.position), np.radians(frame.rpy).tolist()))
    ends = f'<parent link="link{k}"/><child link="link{k + 1}"/><origin xyz="{place}" rpy="{turn}"/>'
    limits = '<axis xyz="0 0 1"/><limit lower="-3.1416" upper="3.1416" effort="1" velocity="1"/>'
    return f'<joint name="joint{k}" type="{kind}">{ends}{limits if kind == "revolute" else ""}</joint>'


def solvers(table: Table, file: Path) -> Iterator[tuple[str, str, Solver]]:
    """Package, what is called, and the call."""
    for core in CORES:
        yield "softkin", f"`inverse_all`, {core}", _softkin(table, core)
    dh = DhRobot(np.radians(table.alpha), np.array(table.a), np.array(table.d))
    yield "eaik", "`IK`", lambda pose: [q - np.radians(table.zero) for q in dh.IK(pose).Q]
    yield "ssik", "`Manipulator.solve`", _ssik(file)
    yield "roboticstoolbox-python", "`ikine_LM`", _toolbox(table)
    yield "pin", "the loop of its examples", _pinocchio(file)
    yield "ikpy", "`inverse_kinematics_frame`", _ikpy(file)


def _softkin(table: Table, core: str) -> Solver:
    robot, frame_of = robot_of(table, core), CORES[core].Frame

    def solve(pose: Array) -> Any:
        rows = pose[:3, :3].tolist()
        slots = robot.inverse_all(frame_of(tuple((1000.0 * pose[:3, 3]).tolist()), tuple(map(tuple, rows))))
        return [np.radians(slot.axes) for slot in slots if slot.axes is not None]

    return solve


def _ssik(file: Path) -> Solver:
    import ssik

    arm = ssik.Manipulator.from_urdf(str(file), base="link0", ee="link7")
    return lambda pose: [solution.q for solution in arm.solve(pose)]


def _toolbox(table: Table) -> Solver:
    import roboticstoolbox as rtb

    rows = zip(table.d, table.a, np.radians(table.alpha), np.radians(table.zero), strict=True)
    robot = rtb.DHRobot([rtb.RevoluteDH(d=d, a=a, alpha=alpha, offset=zero) for d, a, alpha, zero in rows])

    def solve(pose: Array) -> Any:
        found = robot.ikine_LM(pose, tol=1e-14, seed=0)
        return [found.q] if found.success else []

    return solve


def _pinocchio(file: Path) -> Solver:
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(file))
    data, tool = model.createData(), model.getFrameId("link7")

    def solve(pose: Array) -> Any:
        q, goal = pin.neutral(model), pin.SE3(pose)
        for _ in range(1000):
            pin.framesForwardKinematics(model, data, q)
            apart = data.oMf[tool].actInv(goal)
            missed = pin.log(apart).vector
            if np.linalg.norm(missed) < 1e-8:
                return [q]
            jacobian = -pin.Jlog6(apart.inverse()) @ pin.computeFrameJacobian(model, data, q, tool)
            step = -jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-12 * np.eye(6), missed)
            q = pin.integrate(model, q, 0.1 * step)
        return []

    return solve


def _ikpy(file: Path) -> Solver:
    from ikpy.chain import Chain

    chain = Chain.from_urdf_file(str(file), base_elements=["link0"], active_links_mask=[False, *[True] * 6, False])
    return lambda pose: [chain.inverse_kinematics_frame(pose, orientation_mode="all")[1:7]]


def measured(table: Table, solve: Solver, poses: Array) -> tuple[float, int, float, float]:
    """The median time of a call, how many poses have a right answer, right answers a pose, the worst of these.

    The time is that of the processor: other work on the machine interrupts a long call often, a short one hardly ever.
    """
    times, solved, answers, worst = [], 0, 0, 0.0
    solve(poses[0])
    for pose in poses:
        start = time.thread_time()
        found: Any = []
        with suppress(ArithmeticError, ValueError, np.linalg.LinAlgError):
            found = solve(pose)
        times.append(time.thread_time() - start)
        rows = np.degrees(np.array([np.asarray(row, float) for row in found]).reshape(-1, 6))
        missed = errors(table, rows, np.broadcast_to(pose, (len(rows), 4, 4)))
        right = missed[missed < RIGHT]
        solved, answers, worst = solved + bool(len(right)), answers + len(right), max(worst, *right, 0.0)
    return float(np.median(times)), solved, answers / len(poses), worst


def main() -> None:
    """Print the table, in Markdown."""
    print("| arm | package | call | time | solved | answers a pose | worst error |\n|---|---|---|---|---|---|---|")
    for table in (KR6_R900, UR5):
        poses = table.frames(np.random.default_rng(5).uniform(-170.0, 170.0, (POSES, 6)))
        first = None
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "arm.urdf"
            file.write_text(urdf(table))
            for package, call, solve in solvers(table, file):
                took, solved, answers, worst = measured(table, solve, poses)
                first = first or took
                version = "" if package == "softkin" else f" {metadata.version(package)}"
                ratio = f"{took / first:.2g}" if took < 100 * first else f"{took / first:.0f}"
                numbers = f"{ratio} | {solved} of {POSES} | {answers:.3g} | {worst:.0e}"
                print(f"| {table.name} | {package}{version} | {call} | {numbers} |", flush=True)


if __name__ == "__main__":
    main()
