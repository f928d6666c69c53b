"""Forward is that of the pose, but for what the import has moved. away, turned: what rounding may add."""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from numpy.typing import NDArray

from derive.description.catalogue import load
from derive.description.mechanism import Mechanism
from derive.geometry.frames import Motion
from derive.importing.importing import Imported, Options, import_robot
from derive.importing.robot import UnreadableRobot
from derive.ir.constants import DEGREE
from tests.orthonormal import rodrigues

Array = NDArray[np.float64]
Pose = Callable[[Mapping[str, float]], Array]
"""Values of the file's joints (radians, metres) -> the pose of the tip in the base (4 x 4, metres)."""
UNSNAPPED = 1e-8
"""Radians by which a tip turns because a description takes directions as equal that differ by less than 1e-9."""


def described(imported: Imported, folder: Path) -> Mechanism:
    """The mechanism of a description, read from the text that was written."""
    path = folder / f"{imported.name.lower()}.py"
    path.write_text(imported.text, encoding="utf-8")
    return load(path)


def imported(path: Path, base: str | None = None, tip: str | None = None, **options: object) -> Imported:
    """A robot file, imported."""
    return import_robot(path, Options(base, tip, **options))  # type: ignore[arg-type]


def imported_text(
    path: Path, text: str, base: str | None = None, tip: str | None = None, **options: object
) -> Imported:
    """A robot file with this text, imported."""
    path.write_text(text, encoding="utf-8")
    return imported(path, base, tip, **options)


def refused(
    path: Path, text: str | bytes | None, options: Options | None = None, *, is_of_the_file: bool = True
) -> str:
    """The one line in which a file is refused. text: what it holds; None where nothing is written."""
    if text is not None:
        path.write_bytes(text.encode() if isinstance(text, str) else text)
    with pytest.raises(UnreadableRobot) as refusal:
        import_robot(path, options or Options())
    said = str(refusal.value)
    assert "\n" not in said and said.startswith(str(path)) == is_of_the_file
    return said


@cache
def _amounts(mechanism: Mechanism) -> tuple[tuple[Motion, int, Callable[..., float]], ...]:
    """The factors of a chain at nominal lengths, as functions of the joints."""
    assert mechanism.chain is not None
    known: dict[sp.Symbol, float] = {p.symbol: p.nominal for p in mechanism.parameters} | {DEGREE: np.pi / 180.0}
    joints = [j.symbol for j in mechanism.joints]
    return tuple((f.motion, f.axis, sp.lambdify(joints, f.amount.xreplace(known))) for f in mechanism.chain.factors)


def chain_pose(mechanism: Mechanism, values: Mapping[str, float]) -> Array:
    """The product of the chain, at nominal lengths and values of the joints by their axes (radians, lengths)."""
    row = [values[j.name] for j in mechanism.joints]
    pose = np.eye(4)
    for motion, axis, amount in _amounts(mechanism):
        pose = pose @ elementary(motion, axis, float(amount(*row)))
    return pose


def elementary(motion: Motion, axis: int, amount: float) -> Array:
    """A turn about, or a shift along, x, y or z."""
    pose = np.eye(4)
    if motion is Motion.SHIFT:
        pose[axis, 3] = amount
        return pose
    pose[:3, :3] = rodrigues(np.eye(3)[axis], amount * np.pi if motion is Motion.FLIP else amount)
    return pose


def by_yourdfpy(path: Path, base: str, tip: str) -> Pose:
    """The file by a reader that shares nothing with ours."""
    import yourdfpy  # it brings a library of meshes, and most who import this module read no robot with it

    robot = yourdfpy.URDF.load(str(path), load_meshes=False, load_collision_meshes=False)

    def pose(values: Mapping[str, float]) -> Array:
        robot.update_cfg({name: values.get(name, 0.0) for name in robot.actuated_joint_names})
        return np.asarray(robot.get_transform(tip, base))

    return pose


def facing(found: Imported) -> Array:
    """From the file's tip (in metres) to the description's: onto the axis of the roll, then z along the tool."""
    shift = np.eye(4)
    shift[:3, 3] = np.array(found.task.beside or (0.0, 0.0, 0.0)) / 1000.0
    if found.task.facing == 2:
        return shift
    return shift @ elementary(Motion.TURN, *((1, np.pi / 2), (0, -np.pi / 2))[found.task.facing])


def samples(found: Imported, count: int = 12) -> list[dict[str, float]]:
    """Values of the file's joints: zero, and others up to a turn and half a metre."""
    rng = np.random.default_rng(11)
    size = np.array([0.5 if a.kind.value == "linear" else 2.0 * np.pi for a in found.robot.axes])
    rows = [np.zeros(len(size)), *(rng.uniform(-1.0, 1.0, (count, len(size))) * size)]
    return [dict(zip([a.name for a in found.robot.axes], map(float, row), strict=True)) for row in rows]


def differences(found: Imported, mechanism: Mechanism, pose: Pose, unit: float = 1000.0) -> tuple[float, float]:
    """The largest difference of positions (in the unit of the description) and of rotations, over all samples."""
    positions, rotations = [0.0], [0.0]
    for values in samples(found):
        scaled = {
            own: values[axis.name] * (unit if axis.kind.value == "linear" else 1.0)
            for own, axis in zip(found.axes, found.robot.axes, strict=True)
        }
        ours, theirs = chain_pose(mechanism, scaled), pose(values) @ facing(found)
        positions.append(float(np.linalg.norm(ours[:3, 3] - unit * theirs[:3, 3])))
        rotations.append(float(np.linalg.norm(ours[:3, :3] - theirs[:3, :3], 2)))
    return max(positions), max(rotations)


def assert_is(found: Imported, folder: Path, pose: Pose, away: float = 1e-9, turned: float = 1e-12) -> Mechanism:
    """Forward kinematics of the description is that of the pose, but for what the import says that it has moved.

    away, turned: what rounding may add, in the unit of the description and in radians.
    """
    mechanism = described(found, folder)
    position, rotation = differences(found, mechanism, pose)
    assert position <= found.bounds.position + away and rotation <= found.bounds.rotation + turned
    return mechanism
