"""Machines as FMUs in FMPy: their variables by name, and the form of questions that the comparison of languages has."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import count
from pathlib import Path
from typing import Any

from fmpy import extract, read_model_description
from fmpy.fmi3 import FMU3Slave
from fmpy.model_description import ModelDescription

from derive.emit.fmu import package
from derive.emit.language import Part
from tests.c.machine import as_arrays
from tests.mechanisms import kinematics_of, named
from tests.outside import temporary

Answer = dict[str, Any]
_FRAME = ("x", "y", "z", *(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3)))


@dataclass(frozen=True)
class Fmu:
    """An archive, unpacked, with its variables by name."""

    file: Path
    folder: Path
    description: ModelDescription

    @property
    def references(self) -> dict[str, int]:
        """The value reference of every variable."""
        return {one.name: one.valueReference for one in self.description.modelVariables}

    def names(self, group: str) -> list[str]:
        """The variables of a group, in their order."""
        return [name for name in self.references if name.startswith(f"{group}.")]

    def begun(self, **settings: Any) -> FMU3Slave:
        """A new instance, before its initialization."""
        description, own = self.description, self.description.coSimulation.modelIdentifier
        found = FMU3Slave(
            guid=settings.pop("token", description.guid), unzipDirectory=str(self.folder), modelIdentifier=own,
            instanceName="machine",
        )  # fmt: skip
        found.instantiate(**settings)
        return found


@cache
def fmu_of(name: str) -> Fmu:
    """The FMU of a mechanism of the catalogue."""
    part = package.part(kinematics_of(named(name)))
    assert part is not None
    return written(part)


def written(part: Part) -> Fmu:
    """The FMU of what is written of a machine."""
    folder = temporary("fmu")
    ((path, data),) = package.finished(package.files([part])).items()
    file = folder / path
    file.write_bytes(data)
    return Fmu(file, Path(extract(str(file), str(folder / "unpacked"))), read_model_description(str(file)))


class Simulated:
    """An instance whose variables are read and written by name."""

    def __init__(self, fmu: Fmu, parameters: dict[str, float]) -> None:
        self.fmu, self.references = fmu, fmu.references
        self.types = {one.name: one.type for one in fmu.description.modelVariables}
        self.slave = fmu.begun()
        self.slave.enterInitializationMode()
        self.set({f"parameters.{name}": value for name, value in parameters.items()})
        self.slave.exitInitializationMode()

    def set(self, values: dict[str, Any]) -> None:
        """Write variables."""
        kinds = {"Float64": float, "Int8": int, "Boolean": bool}
        for name, value in values.items():
            kind = self.types[name]
            getattr(self.slave, f"set{kind}")([self.references[name]], [kinds[kind](value)])

    def get(self, *names: str) -> list[Any]:
        """Read variables of one type."""
        kind = {"Enumeration": "Int64"}.get(self.types[names[0]], self.types[names[0]]) if names else "Float64"
        found = getattr(self.slave, f"get{kind}")([self.references[name] for name in names]) if names else []
        return [one.decode() if isinstance(one, bytes) else one for one in found]

    def all_of(self, group: str) -> list[Any]:
        """The numbers of a group, without its status and reason."""
        ends = (".status", ".reason", ".is_singular", ".missing")
        return self.get(*(n for n in self.fmu.names(group) if not n.endswith(ends) and "configuration" not in n))

    def status(self, group: str) -> Answer:
        """The status of a group, and its reason where it has one."""
        (status,), (reason,) = self.get(f"{group}.status"), self.get(f"{group}.reason")
        assert bool(reason) == bool(status)
        return {"status": status} | ({"reason": reason} if status else {})

    def close(self) -> None:
        """End the simulation."""
        self.slave.terminate()
        self.slave.freeInstance()


def ask(fmu: Fmu, machines: Sequence[Answer]) -> list[Answer]:
    """What machines answer, {"parameters": …, "calls": …} each."""
    found = []
    for machine in machines:
        simulated = Simulated(fmu, machine["parameters"])
        answers = [_CALLS[call[0]](simulated, *call[1:]) for call in machine["calls"]]
        found.append({"made": {"status": 0}, "found": answers})
        simulated.close()
    return found


def asked(fmu: Fmu) -> Callable[[Answer], Answer | None]:
    """A question of the corpus as an FMU can be asked: numbers, one branch, no start; each second is asked."""
    places = count()
    axes, size = len(fmu.names("axes")), len(fmu.names("configuration"))
    starts = [int(one.start) for one in fmu.description.modelVariables if one.name.startswith("configuration.")]

    def of(question: Answer) -> Answer | None:
        if next(places) % 2 or "start" in question or question["call"] == "inverse" and question["reference"] is None:
            return None
        found = as_arrays(question, axes, size)
        if found is None or "configurations" not in found:
            return found and found | {"all": False}
        given = [starts if one is None else one for one in found["configurations"]]
        return found | {"all": False, "configurations": [one for one in given if all(-128 <= b < 128 for b in one)]}

    return of


def _forward(one: Simulated, axes: Sequence[float]) -> Answer:
    one.set(dict(zip(one.fmu.names("axes"), axes, strict=True)))
    entries = one.get(*(f"pose.{name}" for name in _FRAME))
    frame = {"position": entries[:3], "rotation": [entries[k : k + 3] for k in (3, 6, 9)]}
    return one.status("pose") | {"frame": frame, "configuration": one.get(*one.fmu.names("pose.configuration"))}


def _singularity(one: Simulated, axes: Sequence[float]) -> Answer:
    names = [name.removeprefix("margins.") for name in one.fmu.names("margins")]
    margins = dict(zip(names, one.all_of("margins"), strict=True))
    return one.status("singularity") | {"isSingular": one.get("singularity.is_singular")[0], "margins": margins}


def _jacobian(one: Simulated, axes: Sequence[float]) -> Answer:
    entries, width = one.all_of("jacobian"), len(axes)
    return one.status("jacobian") | {"rows": [entries[k : k + width] for k in range(0, len(entries), width or 1)]}


def _inverse(one: Simulated, frame: Answer, configuration: Sequence[int], reference: Sequence[float]) -> Answer:
    entries = [*frame["position"], *(entry for row in frame["rotation"] for entry in row)]
    one.set(dict(zip((f"target.{name}" for name in _FRAME), entries, strict=True)))
    one.set(dict(zip(one.fmu.names("configuration"), configuration, strict=True)))
    one.set(dict(zip(one.fmu.names("reference"), reference, strict=True)))
    why = {name: one.get(f"solution.{name}")[0] for name in ("missing", "unit", "turn")}
    return one.status("solution") | why | {"axes": one.all_of("solution.axes")}


_CALLS: dict[str, Callable[..., Answer]] = {
    "forward": _forward, "singularity": _singularity, "jacobian": _jacobian, "inverse": _inverse,
}  # fmt: skip
