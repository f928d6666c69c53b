"""Whatever it is given, the native core answers as Python does, leaks nothing, and survives."""

import copy
import gc
import pickle
import sys
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import softkin
from softkin import Frame, Mechanism
from softkin._search import SearchedInverse

from tests.native.garbage import HUGE, frames, rows
from tests.native.machines import SOME, in_python, native, outcome, poses


def same(found: Any, expected: Any) -> bool:
    """To the letter, but for the last digits; NaN is equal to NaN, and a solution to the same in another container."""
    if isinstance(found, float) and isinstance(expected, float):
        return found == expected or abs(found - expected) <= 1e-7 or (found != found and expected != expected)
    if isinstance(expected, tuple | list) or type(expected).__name__ == "Solutions":
        return len(found) == len(expected) and all(same(a, b) for a, b in zip(found, expected, strict=True))
    return bool(found == expected or repr(found) == repr(expected))


@pytest.mark.parametrize("name", SOME)
def test_garbage(name: str) -> None:
    """The same exception with the same words, or the same result, as the core in Python."""
    robot, other = native(name), in_python(name)
    width = len(robot.AXES)
    good = poses(name, 1)[0]
    size = len(robot.CONFIGURATION)
    for axes in rows(width):
        for call in ("forward", "jacobian", "orientation", "singularity"):
            compare(robot, other, call, axes)
        compare(robot, other, "inverse", good[1], None, axes)
        compare(robot, other, "inverse_all", good[1], axes)
    for frame in frames():
        compare(robot, other, "inverse", frame, None, good[0])
        compare(robot, other, "inverse_all", frame, good[0])
    for bytes_ in (
        *rows(size),
        (300,) * size,
        (-129,) * size,
        (255,) * size,
        (4,) * size,
        (3,) * size,
        (True,) * size,
        range(99),
    ):
        compare(robot, other, "inverse", good[1], bytes_, good[0])


def compare(robot: Mechanism, other: Mechanism, call: str, *given: Any) -> None:
    """Ask both cores."""
    found, expected = (outcome(getattr(one, call), *given) for one in (robot, other))
    if call == "inverse_all" and isinstance(robot, SearchedInverse) and isinstance(expected[0], softkin.Solution):
        # where the arm can move while its tool rests there are infinitely many solutions; rounding says which are found
        found, expected = ([slot.configuration[:3] for slot in slots] for slots in (found, expected))
    assert same(found, expected), (call, given, found, expected)


@pytest.mark.parametrize("name", SOME)
def test_iterators(name: str) -> None:
    """What can be read once only is not used up before Python reads it."""
    robot = native(name)
    for axes, frame in poses(name, 2):
        assert robot.forward(v for v in axes) == robot.forward(axes)
        position, rotation = frame
        once = (iter(position), iter([iter(row) for row in rotation]))
        named = robot.forward(axes)[1]
        assert robot.inverse(once, iter(named), iter(axes)) == robot.inverse(frame, named, axes)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", SOME)
def test_trusted_garbage(name: str) -> None:
    """The calls for inner loops trust their input; they never crash, and what they cannot read goes to Python."""
    robot, other = native(name), in_python(name)
    signs = (1,) * robot.BRANCHES
    near = poses(name, 1)[0][0]
    share = 7 if hasattr(other, "_find_root") else 1  # Python searches for seconds where there is no solution
    for frame in list(frames())[::share]:
        for call, *given in (("branch", frame, signs, near), ("branches", frame, near)):
            found, expected = (outcome(getattr(one, call), *given) for one in (robot, other))
            failed = isinstance(expected, tuple) and expected and isinstance(expected[0], type)
            if failed and not (isinstance(found, tuple) and found and isinstance(found[0], type)):
                continue  # the native core divides by zero where Python raises an error
            assert not failed or found == expected, (call, frame, found, expected)
    for wrong in (
        (), (1, 1, 1, 1, 1, 1, 1), (0,) * robot.BRANCHES, (2,) * robot.BRANCHES, None, "111", [1] * robot.BRANCHES,
    ):  # fmt: skip
        outcome(robot.branch, ((1.0, 2.0, 3.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))), wrong, near)


def test_the_object_itself() -> None:
    """It cannot be made wrong, copied or changed; a machine of no name, or of wrong parameters, answers nothing."""
    from _softkin_native import Machine  # type: ignore[import-not-found]

    key, good = softkin.Crane.KEY, (Frame, softkin.Solution, softkin.Diagnosis, tuple(softkin.Status))
    count = len(softkin.Crane.PARAMETERS)
    for parameters in ((), (nan,) * count, (HUGE,) * count, ("1",) * count, None, 7):
        assert not Machine(key, parameters, *good).answers
    for wrong in ("", "crane", "crane 0", "\0"):
        try:
            assert not Machine(wrong, (), *good).answers
        except ValueError:
            assert wrong == "\0"
    for given in (
        (),
        (key,),
        (key, (), 1, 2, 3, ()),
        (key, (), int, str, int, ()),
        (key, (), tuple, tuple, int, ()),
        (key, (), *good, 1),
    ):
        with pytest.raises(TypeError):
            Machine(*given)
    machine = Machine("", (), *good)
    for call in ("branch", "branches", "inverse", "inverse_all", "solve"):
        assert getattr(machine, call)() is NotImplemented
        assert getattr(native("Kin_Crane")._machine, call)(1, 2, 3, 4, 5, 6, 7) is NotImplemented
    for call in ("forward", "pose", "jacobian", "margins"):
        assert getattr(machine, call)(()) is NotImplemented
    with pytest.raises(AttributeError):
        machine.answers = True
    with pytest.raises(TypeError):
        pickle.dumps(machine)


def test_arrays_of_a_batch_are_looked_at() -> None:
    """No array that is too small, of other numbers, or not writable gets to the loops."""
    machine = native("Kin_ArticulatedRobot_6DOF")._machine
    axes, places, turns = np.zeros((4, 6)), np.zeros((4, 3)), np.zeros((4, 3, 3))
    bytes_, status = np.zeros((4, 9), np.int8), np.zeros(4, np.uint8)
    machine.forward_rows(axes, places, turns, bytes_, status, 0, 4)
    frozen = np.zeros((4, 3))
    frozen.flags.writeable = False
    good = [axes, places, turns, bytes_, status, 0, 4]
    for at, wrong in [
        (0, axes[:3]),
        (0, axes[:, :5]),
        (0, axes.astype(np.float32)),
        (0, None),
        (0, "x"),
        (0, axes.ravel()),
        (0, axes.astype(">f8")),
        (1, frozen),
        (1, places[:3]),
        (1, places.T),
        (1, np.zeros((8, 3))[::2]),
        (2, turns[:, :2]),
        (3, bytes_.astype(np.int64)),
        (3, bytes_[:, :8]),
        (4, status[:2]),
        (4, status.astype(bool)),
        (5, -1),
        (5, 5),
        (6, 5),
        (6, 2**70),
        (6, "4"),
        (6, None),
    ]:
        given = [*good[:at], wrong, *good[at + 1 :]]
        with pytest.raises((TypeError, ValueError, OverflowError, BufferError)):
            machine.forward_rows(*given)
    with pytest.raises(TypeError):
        machine.inverse_rows(places, None, np.zeros((4, 9), np.int64), axes, axes, status, 0, 4)


def resident() -> int:
    """The memory of the process (bytes)."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


@pytest.mark.parametrize("name", SOME)
def test_nothing_leaks(name: str) -> None:
    """Memory is flat over many calls, refused ones and wrong ones too, and nobody keeps a reference."""
    robot = native(name)
    axes, frame = poses(name, 1)[0]
    far, signs, matrix = (Frame((1e8, 1e8, 1e8))), (1,) * robot.BRANCHES, np.eye(4)
    machine = robot._machine
    kept = (frame, axes, far, signs, matrix, Frame, softkin.Solution, softkin.Status.OK, machine, NotImplemented)

    def calls(count: int) -> None:
        for _ in range(count):
            machine.forward(axes), machine.pose(axes), machine.jacobian(axes), machine.margins(axes)
            machine.inverse(frame, None, axes), machine.inverse_all(frame, axes), machine.branches(frame, axes)
            machine.branch(frame, signs, axes), machine.inverse(far, None, axes), machine.forward((None,) * len(axes))
            machine.inverse(matrix, None, axes), machine.inverse_all(far, axes), machine.branch(1, 2, 3)

    few = 20 if name.endswith("J6Offset") else 300
    calls(few)
    gc.collect()
    before, counted = resident(), [sys.getrefcount(one) for one in kept]
    calls(30 * few if few > 20 else 5 * few)
    gc.collect()
    assert [sys.getrefcount(one) for one in kept] == counted
    assert resident() - before < 1_500_000


def test_machines_go_away() -> None:
    """The object and its constants are released with the machine."""
    make, given = softkin.ArticulatedRobot6DOF, native("Kin_ArticulatedRobot_6DOF").parameters
    for _ in range(50):
        make(**given)
    gc.collect()
    before, classes = resident(), sys.getrefcount(type(native("Kin_ArticulatedRobot_6DOF")._machine))
    for _ in range(3000):
        make(**given)
    gc.collect()
    assert sys.getrefcount(type(native("Kin_ArticulatedRobot_6DOF")._machine)) <= classes + 2
    assert resident() - before < 2_500_000


@pytest.mark.parametrize("name", SOME)
def test_copies(name: str) -> None:
    """A machine that is copied, pickled or changed asks the native core, too."""
    robot = native(name)
    for one in (copy.copy(robot), copy.deepcopy(robot), pickle.loads(pickle.dumps(robot)), robot.changed()):
        assert one == robot and one._machine.answers and hash(one) == hash(robot)
        assert name == "Kin_Hexapod" or one.forward((1.0,) * len(one.AXES)) == robot.forward((1.0,) * len(one.AXES))


def test_a_subclass_with_programs_of_its_own() -> None:
    """Its programs are asked by every call; one that only has further methods stays native."""

    class Longer(softkin.Crane):
        def _forward(self, axes: Any) -> Any:
            (x, y, z), *rest = super()._forward(axes)
            return ((x, y, z + 1.0), *rest)

    class Told(softkin.Crane):
        def told(self) -> str:
            return "a crane"

    axes = (10.0, 200.0, 30.0)
    plain, longer = softkin.Crane(), Longer()
    assert Told()._machine.answers and Told().forward(axes) == plain.forward(axes)
    assert not longer._machine.answers
    assert longer.forward(axes)[0].position[2] == plain.forward(axes)[0].position[2] + 1.0
    assert longer.forward_batch([axes])[3].tolist() == [0]
