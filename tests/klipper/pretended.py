"""Klipper, as far as a kinematics calls it: a configuration, steppers that ask, a toolhead, a move."""

from __future__ import annotations

import ctypes
import importlib.util
import sys
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

from derive.emit.around_c.package import klipper
from derive.emit.c.package import module_name
from derive.kinematics.kinematics import Kinematics
from prove.klipper.path import Way, way_of
from tests.mechanisms import kinematics_of, named
from tests.outside import output_of, temporary, written

STUB = Path(__file__).parent / "stub"
_Three = ctypes.c_double * 3


class Refused(Exception):
    """What Klipper's configuration or toolhead is told."""


@cache
def solver() -> ctypes.CDLL:
    """The compiled stand-in."""
    library = temporary("klipper") / "solver.so"
    output_of(["gcc", "-shared", "-fPIC", "-I", STUB, "-o", library, STUB / "solver.c"])
    found = ctypes.CDLL(str(library))
    address, real = ctypes.c_void_p, ctypes.c_double
    found.ask.restype, found.ask.argtypes = real, [address, address, address, real, real, real]
    found.flags.argtypes = [address]
    return found


class Stepper:
    """A stepper: its kinematics is asked."""

    def __init__(self, config: Any, units_in_radians: bool = False) -> None:
        self.name, self.turns, self.solver, self.queue = config.get_name(), units_in_radians, 0, None
        self.position = 0.0

    def get_name(self) -> str:
        return str(self.name)

    def set_stepper_kinematics(self, address: int) -> None:
        self.solver = address

    def setup_itersolve(self, name: str, *given: Any) -> None:
        self.plain = name, given

    def set_trapq(self, queue: Any) -> None:
        self.queue = queue

    def set_position(self, position: Sequence[float]) -> None:
        self.position = self.at(position) if self.solver else position["xyz".index(self.plain[1][0].decode())]

    def at(self, position: Sequence[float]) -> float:
        return self.along(position, (0.0, 0.0, 0.0), 0.0, 0.0, 0.0)

    def along(
        self, start: Sequence[float], direction: Sequence[float], speed: float, half: float, time: float
    ) -> float:
        return float(solver().ask(self.solver, _Three(*start[:3]), _Three(*direction), speed, half, time))


class Config:
    """A section of a configuration; a value that is not given raises `Refused`."""

    error = Refused

    def __init__(self, sections: Mapping[str, Mapping[str, Any]], name: str = "printer") -> None:
        self.sections, self.name = sections, name

    def get_name(self) -> str:
        return self.name

    def get_printer(self) -> Any:
        return SimpleNamespace(command_error=Refused, send_event=lambda name, *given: EVENTS.append(name))

    def getsection(self, name: str) -> Config:
        if name not in self.sections:
            raise Refused(f"no section {name}")
        return Config(self.sections, name)

    def has_section(self, name: str) -> bool:
        return name in self.sections

    def getfloat(self, name: str, *default: float) -> float:
        return float(self._get(name, *default))

    def getfloatlist(self, name: str, default: Sequence[float], count: int) -> Sequence[float]:
        found: Sequence[float] = self._get(name, default)
        assert len(found) == count
        return found

    def getchoice(self, name: str, choices: Mapping[str, int], default: str) -> int:
        return choices[self._get(name, default)]

    def _get(self, name: str, *default: Any) -> Any:
        if name in self.sections[self.name]:
            return self.sections[self.name][name]
        if not default:
            raise Refused(f"option {name} must be given")
        return default[0]


EVENTS: list[str] = []
"""What was told to all parts of Klipper."""
TOOLHEAD = SimpleNamespace(get_trapq=lambda: "queue", Coord=tuple)


@cache
def loaded(name: str) -> ModuleType:
    """The module of a machine of the catalogue."""
    return imported(kinematics_of(named(name)))


def imported(kinematics: Kinematics) -> ModuleType:
    """The module of a machine, imported as Klipper does."""
    folder, name = temporary("klipper"), kinematics.mechanism.name
    part = klipper.part(kinematics)
    assert part is not None
    written(klipper.files([part]), folder / "kinematics")
    chelper = ModuleType("chelper")
    chelper.__file__ = str(STUB / "__init__.py")
    chelper.get_ffi = lambda: (SimpleNamespace(cast=lambda kind, address: address), None)  # type: ignore[attr-defined]
    stepper = ModuleType("stepper")
    stepper.PrinterStepper = Stepper  # type: ignore[attr-defined]
    package = f"kinematics_{module_name(name)}"
    (folder / "kinematics" / "__init__.py").write_text("")
    spec = importlib.util.spec_from_file_location(package, folder / "kinematics" / "__init__.py")
    assert spec is not None
    sys.modules |= {"chelper": chelper, "stepper": stepper, package: importlib.util.module_from_spec(spec)}
    try:
        return importlib.import_module(f"{package}.softkin_{module_name(name)}")
    finally:
        del sys.modules["chelper"], sys.modules["stepper"]


def sections_of(way: Way) -> dict[str, dict[str, Any]]:
    """The configuration of a machine at the begin of a way."""
    branches = zip(way.robot.CONFIGURATION[: way.robot.BRANCHES], way.configuration, strict=False)
    found: dict[str, dict[str, Any]] = {"printer": {**way.sizes, **{b.name: b.branches[k - 1] for b, k in branches}}}
    for axis, home in zip(way.robot.AXES, way.home, strict=True):
        found[f"stepper_{axis.name.lower()}"] = {"position_home": home}
    return found


def move(start: Sequence[float], end: Sequence[float]) -> Any:
    apart = [b - a for a, b in zip(start, end, strict=True)]
    length = sum(a * a for a in apart) ** 0.5
    return SimpleNamespace(
        start_pos=start, end_pos=end, axes_d=apart, move_d=length,
        move_error=lambda said="Move out of range": Refused(said),
    )  # fmt: skip


@cache
def way(name: str) -> Way:
    return way_of(named(name))


class Homing:
    """A G28."""

    def __init__(self, kinematics: Any) -> None:
        self.kinematics = kinematics

    def set_axes(self, axes: Sequence[int]) -> None:
        assert axes == [0, 1, 2]

    def set_homed_position(self, position: Sequence[float]) -> None:
        self.kinematics.set_position(position, "")


def made(name: str, **further: Any) -> Any:
    """The kinematics of a machine, homed at the begin of its way."""
    sections = sections_of(way(name))
    kinematics = loaded(name).load_kinematics(TOOLHEAD, Config({**sections, "printer": sections["printer"] | further}))
    kinematics.home(Homing(kinematics))
    return kinematics
