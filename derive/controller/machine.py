"""The machine that is shown: its axes, and its parameters as the Python package writes them (`to_json`)."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from derive.controller.refusal import Refused
from derive.description.catalogue import MECHANISMS, catalogue, load
from derive.description.mechanism import DescriptionError, Mechanism
from derive.kinematics.parameters import machine_parameters

COUPLED, MOUNTED, LIMITS, RADIANS = "Coupled", "Mounted", "limits", "in_radians"
"""The names in `to_json` of machines made of more than one mechanism, and of two entries."""
_KIND = "mechanism"


@dataclass(frozen=True)
class MachineAxis:
    """An axis of the controller."""

    name: str
    unit: str
    """`deg` or `u`, the unit of length in which the machine's lengths are given."""


@dataclass(frozen=True)
class Machine:
    """A machine of the catalogue, or of a user's own."""

    name: str
    axes: tuple[MachineAxis, ...]
    given: Mapping[str, Any]
    """Its name (`mechanism`) and parameters, as `to_json` of the Python package writes them."""
    own: Path | None = None
    """The description or the package of a machine of a user's own."""

    @property
    def axis_names(self) -> tuple[str, ...]:
        """The names of the axes, in the order of the controller."""
        return tuple(axis.name for axis in self.axes)


def machine_of(given: object, description: Path | None, package: Path | None) -> Machine:
    """The machine that an entry of JSON names: a mechanism of the catalogue, of a description, or of a package.

    given: `{"mechanism": name, parameter: value, ...}`, or its name alone; a description and a package need no name.
    Raises `Refused` for an unknown mechanism or parameter, and for a length that is missing.
    """
    entries = {_KIND: given} if isinstance(given, str) else given
    if not isinstance(entries, Mapping):
        raise Refused(f'a machine is {{"mechanism": name, parameter: value, ...}}, not {given!r}')
    if description is not None and package is not None:
        raise Refused("a machine has a description or a package, not both")
    if package is not None:
        return replace(_of_package(dict(entries), package), own=package)
    if description is not None:
        return replace(_made(dict(entries), lambda name: _of_description(description, name)), own=description)
    return _made(dict(entries), _found)


def _made(given: dict[str, Any], find: Callable[[object], Mechanism]) -> Machine:
    """The machine of entries whose mechanisms are found by name."""
    if given.get(RADIANS):
        message = "leave in_radians out: axes are shown in degrees; a node in radians has the scale 57.29577951308232"
        raise Refused(message)
    parts = {COUPLED: ("position", "orientation"), MOUNTED: ("bare",)}.get(str(given.get(_KIND)), ())
    if not parts:
        mechanism = find(given.get(_KIND))
        _check_parameters(mechanism, given)
        axes = tuple(MachineAxis(j.name, "deg" if j.in_degrees else "u") for j in mechanism.joints)
        return Machine(mechanism.name, axes, {**given, _KIND: mechanism.name})
    missing = [part for part in parts if not isinstance(given.get(part), Mapping)]
    if missing:
        raise Refused(f'the machine {given[_KIND]} needs an entry "{missing[0]}", which is a machine')
    made = [_made(dict(given[part]), find) for part in parts]
    name = " + ".join(machine.name for machine in made)
    shown = {**given, **{part: machine.given for part, machine in zip(parts, made, strict=True)}}
    return Machine(name, _joined(made), shown)


def _joined(made: list[Machine]) -> tuple[MachineAxis, ...]:
    """The axes of all parts; one of the second part with a name that the first part has is called `orientation …`."""
    axes = list(made[0].axes)
    for axis in (axis for machine in made[1:] for axis in machine.axes):
        is_taken = axis.name in made[0].axis_names
        axes.append(MachineAxis(f"orientation {axis.name}", axis.unit) if is_taken else axis)
    return tuple(axes)


def _found(name: object) -> Mechanism:
    """The mechanism of the catalogue, by its name or by that of its block; most files are called as their mechanism."""
    path = MECHANISMS / f"{str(name).lower()}.py"
    is_file = isinstance(name, str) and name.isidentifier() and path.is_file()
    every = [load(path)] if is_file else [mechanism for _, mechanism in catalogue()]
    for mechanism in every:
        if name in (mechanism.name, mechanism.block_name):
            return mechanism
    message = f"{name!r} is no mechanism of the catalogue; a machine of your own has an entry description or package"
    raise Refused(message if name else 'which machine? Its entry "mechanism" names it')


def _of_description(path: Path, name: object) -> Mechanism:
    try:
        mechanism = load(path)
    except DescriptionError as problem:
        raise Refused(str(problem)) from None
    if name not in (None, mechanism.name, mechanism.block_name):
        raise Refused(f"{path} describes {mechanism.name}, not {name!r}")
    return mechanism


def _check_parameters(mechanism: Mechanism, given: Mapping[str, Any]) -> None:
    """Refuse parameters by name, as the class of the mechanism does, which tests the values itself."""
    limits = {f"{word}_{joint.name.lower()}" for joint in mechanism.joints for word in ("lower", "upper")}
    parameters = machine_parameters(mechanism)
    known = {p.name for p in parameters} | limits | {_KIND, LIMITS, RADIANS}
    for name, value in given.items():
        if name not in known:
            shown = ", ".join([*(p.name for p in mechanism.parameters if p.fixed is None), LIMITS])
            raise Refused(f"{mechanism.name} has no parameter {name!r}: it has {shown}")
        if name not in (_KIND, LIMITS) and not isinstance(value, int | float):
            raise Refused(f"{mechanism.name}: {name} is a number, not {value!r}")
    missing = [p.name for p in parameters if p.default is None and p.name not in given]
    if missing:
        raise Refused(f"{mechanism.name} needs {', '.join(missing)}")


def _of_package(given: dict[str, Any], path: Path) -> Machine:
    """The machine of a package that `softkin derive` wrote; the package's class tests names and values."""
    if not (path / "__init__.py").is_file():
        raise Refused(f"{path}: there is no package; `softkin derive my_machine.py --out build` writes one into build")
    sys.path.insert(0, str(path.resolve().parent))
    try:
        package = importlib.import_module(path.resolve().name)
    except ImportError as problem:
        raise Refused(f"{path}: {problem}") from None
    finally:
        del sys.path[0]
    if Path(str(package.__file__)).resolve().parent != path.resolve():
        raise Refused(f"{path}: the package {package.__name__} is that of {Path(str(package.__file__)).parent}")
    names = list(package.catalogue())
    name = given.setdefault(_KIND, names[0] if len(names) == 1 else None)
    if given.get(RADIANS):
        return _made(given, lambda _: _found(name))
    try:
        robot = package.Mechanism.from_dict(given)
    except (package.KinematicsError, TypeError) as problem:
        raise Refused(f"{path}: {problem}") from None
    return Machine(str(name), tuple(MachineAxis(a.name, a.unit) for a in robot.AXES), given)
