"""A machine of the catalogue as it is measured: its C, and a header with regular poses for `machine.c`."""

from __future__ import annotations

from dataclasses import dataclass

from derive.description.catalogue import catalogue
from derive.emit.c import package
from derive.kinematics.build import build
from derive.report.cost import costs_of
from derive.report.reference_calls import machine_with
from derive.report.self_test import candidates, regular_poses


@dataclass(frozen=True)
class Machine:
    """Sources by their paths, and the operations of forward and inverse kinematics."""

    name: str
    files: dict[str, str]
    operations: tuple[int, int]


def machine_at(place: int) -> Machine:
    """The machine at a place of the catalogue."""
    kinematics = build(catalogue()[place][1])
    part = package.part(kinematics)
    assert part is not None, "every machine of the catalogue is written in C"
    machine, module = machine_with(kinematics, kinematics.unlimited_values), part["index"]["module"]
    poses = [axes or (0.0,) for axes in regular_poses(machine, candidates(machine))]
    header = (
        f'#include "{module}.h"',
        f"#define KIND {module}_mechanism",
        f"#define MACHINE {module}_machine",
        f"#define PARAMETERS {module}_parameters",
        f"#define AXES {len(poses[0])}",
        f"#define SET {' '.join(f'parameters.{name} = {float(value)!r};' for name, value in machine.given.items())}",
        f"#define POSES {', '.join('{' + ', '.join(map(repr, axes)) + '}' for axes in poses)}",
    )
    costs = costs_of(kinematics)
    operations = sum(costs.forward.counts), sum(costs.inverse.counts)
    files = package.files([part]) | {"measured.h": "\n".join(header) + "\n"}
    return Machine(kinematics.mechanism.block_name, dict(files), operations)
