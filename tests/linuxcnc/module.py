"""A module of LinuxCNC in this process: compiled with stand-ins for the HAL, loaded, and called as motion calls it."""

from __future__ import annotations

import ctypes
import os
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from derive.emit.language import Part
from derive.emit.linuxcnc import package
from tests.mechanisms import kinematics_of, named
from tests.outside import output_of, temporary, written

COMPILER = os.environ.get("CC", "gcc")
HERE = Path(__file__).parent
STRICT = ("-Wall", "-Wextra", "-Werror", "-Wconversion", "-DSOFTKIN_WITH_JACOBIAN", "-DSOFTKIN_WITH_FRAMES")
LETTERS = "XYZABCUVW"
MOST_JOINTS = 16
STUBS = ("2_9", "master")

Pose = dict[str, float]


class _Pose(ctypes.Structure):
    _fields_ = [(letter, ctypes.c_double) for letter in LETTERS]


_Joints = ctypes.c_double * MOST_JOINTS
_Rows = (ctypes.c_double * len(LETTERS)) * MOST_JOINTS


@cache
def part_of(name: str) -> Part:
    """What is written of a mechanism of the catalogue."""
    part = package.part(kinematics_of(named(name)))
    assert part is not None
    return part


def compiled(part: Part, stub: str, standard: str = "gnu11", *options: str) -> Path:
    """The library of a module, with a new file for each call: a library that is loaded keeps its state."""
    folder, (path,) = written(part["files"], temporary("linuxcnc")), part["files"]
    run(folder, f"-std={standard}", *STRICT, *includes(stub), "-fPIC", "-shared", *(options or ("-O0",)), path,
        str(pins(stub)), "-lm", "-o", "module.so")  # fmt: skip
    return folder / "module.so"


def includes(stub: str) -> tuple[str, str]:
    """Where the compiler finds the headers of a version."""
    return f"-I{HERE / 'stub'}", f"-I{HERE / f'stub_{stub}'}"


@cache
def pins(stub: str) -> Path:
    """The stand-in for the HAL, compiled."""
    folder = temporary("linuxcnc")
    run(folder, "-std=gnu11", *STRICT, *includes(stub), "-fPIC", "-c", str(HERE / "stub" / "pins.c"))
    return folder / "pins.o"


def run(folder: Path, *options: str) -> None:
    """Compile in a folder; every warning is an error."""
    output_of([COMPILER, *options], cwd=folder)


@dataclass
class Module:
    """A module that is loaded: its pins by name, and its calls."""

    library: Any
    numbers: Mapping[str, int]
    joints: int
    forward_flags: int = 0
    flags: int = 0
    """What motion keeps between calls: forward kinematics writes them, the inverse reads them."""
    seen: list[int] = field(default_factory=list)

    def set(self, **values: float) -> None:
        """Set parameters, by their names in C."""
        for name, value in values.items():
            self.library.stub_set(self.numbers[f"softkin.{name.replace('_', '-')}"], ctypes.c_double(value))

    def get(self, name: str) -> float:
        """The value of a pin."""
        return float(self.library.stub_get(self.numbers[name]))

    def forward(self, joints: Sequence[float], before: Pose | None = None) -> Pose | None:
        """The pose, or None where the call refuses: then pose and flags are as they were."""
        given = before or {}
        pose = _Pose(**given)
        flags = ctypes.c_ulong(self.flags)
        status = self.library.kinematicsForward(_padded(joints), ctypes.byref(pose), ctypes.byref(ctypes.c_ulong(0)),
                                                ctypes.byref(flags))  # fmt: skip
        found = {letter: getattr(pose, letter) for letter in LETTERS}
        if status != 0:
            assert status == -1 and flags.value == self.flags
            assert bytes(pose) == bytes(_Pose(**given))
            return None
        self.flags = flags.value
        return found

    def inverse(self, pose: Pose, reference: Sequence[float], flags: int | None = None) -> list[float] | None:
        """The joints, or None where the call refuses: then the joints are as they were."""
        joints = _padded(reference)
        asked = ctypes.c_ulong(self.flags if flags is None else flags)
        written = ctypes.c_ulong(99)
        status = self.library.kinematicsInverse(ctypes.byref(_Pose(**pose)), joints, ctypes.byref(asked),
                                                ctypes.byref(written))  # fmt: skip
        if status != 0:
            assert status == -1 and written.value == 99 and bytes(joints) == bytes(_padded(reference))
            return None
        assert bytes(joints)[8 * self.joints :] == bytes(_padded(reference))[8 * self.joints :]
        return list(joints)[: self.joints]

    def jacobian(self, joints: Sequence[float], pose: Pose) -> list[list[float]] | None:
        """Rates of all joints, a row each, by those of the nine letters; None where the call refuses."""
        rows = _Rows()
        flags = ctypes.c_ulong(self.flags)
        status = self.library.kinematicsJacobian(_padded(joints), ctypes.byref(_Pose(**pose)), rows,
                                                 ctypes.byref(flags))  # fmt: skip
        return None if status != 0 else [list(row) for row in rows]


def _padded(values: Sequence[float]) -> Any:
    return _Joints(*values, *(77.0 + i for i in range(len(values), MOST_JOINTS)))


def loaded(library: Path, joints: int) -> Module:
    """Load a library as `loadrt` does."""
    found = ctypes.CDLL(str(library))
    found.stub_name.restype = found.stub_message.restype = found.stub_component.restype = ctypes.c_char_p
    found.stub_get.restype = ctypes.c_double
    assert found.rtapi_app_main() == 0 and found.stub_is_ready() == 1
    numbers = {found.stub_name(i).decode(): i for i in range(found.stub_count())}
    return Module(found, numbers, joints)


@cache
def _library(name: str, stub: str) -> Path:
    return compiled(part_of(name), stub)


def module_of(name: str, stub: str = "2_9") -> Module:
    """A module of the catalogue, freshly loaded, with no dimension set."""
    copy = _library(name, stub)
    own = Path(mkdtemp(prefix="linuxcnc-", dir=copy.parent)) / "module.so"
    shutil.copy(copy, own)
    return loaded(own, len(named(name).joints))
