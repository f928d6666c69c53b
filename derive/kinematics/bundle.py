"""All programs of a mechanism as one bundle: lowered together, checked, with constants moved into the setup."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from derive.description.mechanism import Mechanism, Parameter, Turning
from derive.equations.choices import with_choices
from derive.equations.windows import windows
from derive.ir.passes import hoist
from derive.ir.program import Let, Program, Statement, shared
from derive.ir.symbols import (
    BASE_AXIS,
    FLANGE_AXIS,
    ROTATION_ENTRIES,
    START_POSITION,
    START_ROTATION,
    branch_sign,
    symbols_of,
)
from derive.ir.types import Type, output_types
from derive.ir.verify import BrokenProgram
from derive.kinematics.differential import jacobian_rows
from derive.kinematics.flange_rotation import freedom_of
from derive.kinematics.kinematics import Kinematics, Margin
from derive.kinematics.parameters import constants_of, machine_parameters, setup_program
from derive.kinematics.shared_names import refuse_names
from derive.kinematics.solution import Solution
from derive.lowering.passes import lowered
from derive.work import stage


@dataclass(frozen=True)
class _Hoisted:
    """All programs, with the values that depend on parameters alone moved into the setup."""

    setup: Program
    setup_less_windows: Program
    derived_branch: Program
    """The branch before the lowering."""
    programs: tuple[Program, ...]


def _hoisted(
    mechanism: Mechanism, parameters: tuple[Parameter, ...], programs: Sequence[Program], at_home: Sequence[Statement]
) -> _Hoisted:
    """The lowered programs; refuses a name that no program may read or return."""
    constants = constants_of(mechanism, parameters, at_home)
    unsettled = {o.name for window in windows(mechanism) for o in window.outputs}  # drives may change these later
    unsettled |= {s.name for s in (*START_POSITION, *START_ROTATION)}  # and callers these
    settled = [name for name in constants if name not in unsettled]
    whole, first = hoist([with_choices(p, parameters) for p in (*shared(programs), *programs)], settled)
    known = (*_given(setup_program(mechanism, parameters, at_home=at_home), settled), *first)
    shorter, second = lowered(whole, [*settled, *(let.name.name for let in first)], known=known)
    hoisted = (*first, *second)
    derived = next(program for program in whole if program.name == "branch")
    read = frozenset(s for program in (*shorter, derived) for s in program.inputs)
    setup = setup_program(mechanism, parameters, hoisted, read, at_home=at_home)
    settable = setup_program(mechanism, parameters, hoisted, read, has_settings=True, at_home=at_home)
    called = {program.name for program in shared(shorter)}
    for program in (p for p in shorter if p.name not in called):  # a caller passes the inputs of the others
        _check_inputs(mechanism, program, {o.name for o in setup.outputs})
        _check_outputs(program)
    return _Hoisted(setup, settable, derived, tuple(shorter))


def _given(setup: Program, settled: Sequence[str]) -> Iterator[Let]:
    """What the setup computes of constants alone before anything is moved into it: it is not computed again."""
    names = frozenset(settled)
    for let in setup.lets():
        if {let.name.name, *(s.name for s in symbols_of(let.value))} <= names:
            yield let


@stage("the rewriting of the programs")
def bundle_of(
    solution: Solution, programs: Sequence[Program], margins: tuple[Margin, ...], at_home: Sequence[Statement] = ()
) -> Kinematics:
    """The bundle of all programs."""
    mechanism = solution.mechanism
    refuse_names(mechanism, (name for program in (*shared(programs), *programs) for name in program.bound()))
    parameters = machine_parameters(mechanism)
    moved = _hoisted(mechanism, parameters, programs, at_home)
    finished = {program.name: program for program in moved.programs}
    return Kinematics(
        mechanism=mechanism,
        solution=solution,
        parameters=parameters,
        setup=moved.setup,
        forward=finished["forward"],
        orientation=finished["orientation"],
        branch=finished["branch"],
        derived_branch=moved.derived_branch,
        limits=finished["limits"],
        singularity=finished["singularity"],
        jacobian=finished["jacobian"],
        bias=finished["bias"],
        image=finished["image"],
        projection=finished.get("projection"),
        offset_branch=finished.get("offset_branch"),
        offset_configuration=finished.get("offset_configuration"),
        rows=jacobian_rows(mechanism),
        margins=margins,
        freedom=freedom_of(mechanism),
        reads_rotation=mechanism.task.turning is not Turning.NONE,
        setup_less_windows=moved.setup_less_windows,
        search_given=finished.get("search_given"),
        from_joints=finished.get("from_joints"),
        twist=finished.get("twist"),
        twist_bias=finished.get("twist_bias"),
        compatible=finished.get("compatible"),
        end_point_shift=finished.get("end_point_shift"),
        total_image=finished.get("total_image"),
    )


def _check_inputs(mechanism: Mechanism, program: Program, constants: set[str]) -> None:
    """Refuse a name that is read but is no input: a mistake of the derivation, found here before it reaches a generated
    file.
    """
    allowed = constants | {"x", "y", "z", "point_x", "point_y", "point_z"} | {r.name for r in ROTATION_ENTRIES}
    allowed |= {branch_sign(b.name).name for b in mechanism.branches}
    allowed |= {j.symbol.name for j in mechanism.joints} if program.name == "from_joints" else set()
    allowed |= {s.name for j in mechanism.joints for s in (j.axis, j.speed, j.reference, j.turn)}
    allowed |= {s.name for s in (*START_POSITION, *START_ROTATION, *FLANGE_AXIS, *BASE_AXIS)}
    strangers = [s.name for s in program.inputs if s.name not in allowed]
    if strangers:
        raise BrokenProgram(f"the {program.name} program reads {', '.join(strangers)}, which nothing gives")


def _check_outputs(program: Program) -> None:
    """Refuse an output that is an angle modulo a turn: a call returns numbers."""
    if angles := [name for name, kind in output_types(program).items() if kind in (Type.ANGLE, Type.HEADING)]:
        raise BrokenProgram(f"{program.name}: nothing has chosen a turn of {', '.join(angles)}")
