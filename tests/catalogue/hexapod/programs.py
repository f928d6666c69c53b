"""The programs of the hexapod as the build gives them, run by the reference semantics."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from derive.ir.interpret import run
from derive.ir.program import Call, Iterate, Program, Require, Statement
from derive.ir.reason import Why, about_machine
from derive.kinematics.kinematics import Kinematics
from tests.catalogue.hexapod.machines import Array, Machine
from tests.mechanisms import kinematics_of, named

Statuses = NDArray[np.object_]


def kinematics() -> Kinematics:
    return kinematics_of(named("Kin_Hexapod"))


@cache
def constants(machine: Machine) -> Mapping[str, Array]:
    """What Initialize computes for a machine."""
    kin = kinematics()
    settings = {p.name: machine.given.get(p.name, p.default or 0.0) for p in kin.parameters}
    values, _ = run(kin.setup, {name: np.asarray(float(v)) for name, v in settings.items()})
    return values


def search_changed(change: Callable[[Statement], Statement | None]) -> Program:
    """Forward kinematics from a given start, with the statements of its search changed, or left out."""
    program = kinematics().forward

    def changed(search: Program) -> Program:
        return replace(search, body=tuple(new for s in search.body if (new := change(s)) is not None))

    return replace(
        program, body=tuple(replace(s, program=changed(s.program)) if isinstance(s, Call) else s for s in program.body)
    )


def found_from(
    program: Program, machine: Machine, axes: Array, positions: Array, turns: Array
) -> tuple[Array, Statuses]:
    """Positions and statuses, every row from a start of its own."""
    given = dict(constants(machine)) | {f"axis_l{i + 1}": axes[:, i] for i in range(6)}
    given |= {f"start_{c}": positions[:, i] for i, c in enumerate("xyz")}
    given |= {f"start_r{i + 1}{k + 1}": turns[:, i, k] for i in range(3) for k in range(3)}
    outputs, status = run(program, given)
    return np.stack([outputs[c] for c in "xyz"], axis=1), status


def bounded(passes: int) -> Program:
    """The same with another limit of passes."""
    return search_changed(lambda s: replace(s, limit=passes) if isinstance(s, Iterate) else s)


def without_mode() -> Program:
    """The same without the test of the assembly mode."""
    return search_changed(
        lambda s: None if isinstance(s, Require) and s.reason == about_machine(Why.OTHER_ASSEMBLY) else s
    )
