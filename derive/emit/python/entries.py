"""The description of a machine in its class: axes, parameters and configuration bytes, as constructor calls."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count
from keyword import iskeyword

import sympy as sp

from derive.description.mechanism import Mechanism, Parameter, Role
from derive.emit.inputs import Inputs, Spelling, inputs_of, word_of
from derive.emit.language import short_name
from derive.emit.python.layout import documented, quoted
from derive.emit.python.printer import ScalarPrinter
from derive.geometry.frames import Motion
from derive.ir.constants import DEGREE, LARGEST
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.report.cost import Cost, costs_of

_UNITS = {
    Role.LENGTH: "u", Role.SIGNED_LENGTH: "u", Role.DISTANCE: "u", Role.PITCH: "u/rev", Role.GEAR: "u/deg",
    Role.COUPLING: "1", Role.TRANSMISSION: "1", Role.RATIO: "1", Role.FLAG: "", Role.SIGN: "", Role.ANGLE: "deg",
}  # fmt: skip
_WHOLE = (Role.FLAG, Role.SIGN)
"""The roles whose values are whole numbers."""
_USUAL: dict[Role, tuple[float, float, float | None]] = {
    Role.LENGTH: (0.0, float(LARGEST), None),
    Role.SIGNED_LENGTH: (-float(LARGEST), float(LARGEST), None),
    Role.TRANSMISSION: (-1e6, 1e6, None),
    Role.RATIO: (0.0, 1.0, 0.0),
    Role.FLAG: (0.0, 1.0, 0.0),
    Role.SIGN: (-1.0, 1.0, 1.0),
}
"""The range and the default of a parameter by its kind, where they are not "any number" and 0."""


_CLASSES = frozenset(
    "ArrayPrograms Axis Calibrated Calibration Configuration ConfigurationByte Coupled CoupledPrograms "
    "Criterion Diagnosis Frame FrameLike Image IterativeForward KinematicsError Limits Link Matrix "
    "Mechanism Mounted OffsetKinematics OrientationImage OrientationKinematics OrientationPrograms "
    "Parameter PlainFrame Pose Programs Reals Rotation SearchedInverse Signs Singularity Solution "
    "StartedPrograms Status TotalImage Turns TwistChoice Values Vector".split()
)
"""Names that the package offers or modules of mechanisms import: no class of a mechanism may have one."""
_MODULES = frozenset("annotations calibrate catalogue core import_module load orthonormalize propose".split())
"""Names in the package that are no modules: to import a module with one of these names would replace them."""


def class_name(name: str, better: str | None) -> str:
    """`Kin_Scara4_ZCcoupled_Type1` → `Scara4ZCcoupledType1`; `Kin_Frame` → `FrameMachine`, for `Frame` is taken."""
    found = better or "".join(word[:1].upper() + word[1:] for word in short_name(name).split("_"))
    return f"{found}Machine" if found in _CLASSES or iskeyword(found) else found


def module_name(name: str) -> str:
    """`Kin_Scara4_ZCcoupled_Type1` → `scara4_zccoupled_type1`; `Kin_Class` → `class_machine`, a word of Python."""
    found = short_name(name).lower()
    return f"{found}_machine" if found in _MODULES or iskeyword(found) else found


def role(mechanism: Mechanism) -> str:
    """The role of a mechanism in a coupling: "position", "orientation" or "complete"."""
    return "position" if mechanism.is_position else "orientation" if mechanism.is_orientation else "complete"


def axes(kin: Kinematics) -> list[str]:
    """The axes of the controller."""
    return _tuple(
        _call(
            "Axis", name=j.name, kind=j.kind.value, unit="deg" if j.in_degrees else "u",
            meaning=j.meaning, multi_turn=j.multi_turn,
        )
        for j in kin.mechanism.joints
    )  # fmt: skip


def usual(role: Role) -> dict[str, object]:
    """The unit, the range and the default that a parameter of a kind has unless its own entry states another."""
    low, high, default = _USUAL.get(role, (-float(LARGEST), float(LARGEST), 0.0))
    return {"unit": _UNITS[role], "low": low, "high": high, "low_is_open": role is Role.LENGTH, "default": default}


def parameters(kin: Kinematics) -> list[str]:
    """The parameters of the class: kind, name and meaning, then the values that are not usual for the kind."""
    names = inputs(kin).names
    return _tuple(_parameter(p, names[p.name]) for p in kin.parameters)


def _parameter(p: Parameter, name: str) -> str:
    given = {"unit": p.unit, "low": p.low, "high": p.high, "low_is_open": p.low_open, "default": p.default}
    unusual = {key: value for key, value in given.items() if value != usual(p.role)[key]}
    return _call("Parameter.of", *map(literal, (p.role.value, name, p.meaning)), **unusual)


def limit_keys(kin: Kinematics) -> str:
    """The axes and quantities with limits, by the last part of the names of their limits."""
    return literal((*(j.key for j in kin.mechanism.joints), *(q.name for q in kin.mechanism.limited)))


def configuration(kin: Kinematics) -> list[str]:
    """The bytes of the configuration: branches first, then periods."""
    branches = [
        _call("ConfigurationByte", name=b.name, kind="branch", branches=b.names, default=1) for b in kin.branches
    ]
    periods = [
        _call("ConfigurationByte", name=j.name, kind="period", branches=(), default=0) for j in kin.period_joints
    ]
    return _tuple([*branches, *periods])


def turn_sizes(kin: Kinematics) -> str:
    """The turns of the joint per turn of its axis, for every axis with a period byte; empty without gears."""
    if not any(j.is_geared for j in kin.period_joints):
        return ""
    sizes = (j.turns for j in kin.period_joints)
    named = [literal(float(s)) if s.is_number else f"self._constants.{s}" for s in sizes]
    return f"({', '.join(named)},)"


def costs(kin: Kinematics) -> list[str]:
    """The operations of forward and inverse kinematics, one line each, and the most passes of iterations."""
    found = costs_of(kin)
    rows = [f"forward: {_operations(found.forward)}", f"inverse: {_operations(found.inverse)}"]
    if kin.branches:
        rows.append(f"inverse, all {2 ** len(kin.branches)} branches: {_operations(found.automatic)}")
    more = {"repair of a frame, in addition": found.repair, f"{found.corner}, in addition": found.corners}
    rows += [f"{what}: {_operations(cost)}" for what, cost in more.items() if any(cost.counts)]
    return [*rows, *(f"{b.note}: at most {b.limit} passes, all of which are counted" for b in found.bounds)]


def _operations(cost: Cost) -> str:
    return (
        f"{cost.additions} additions, {cost.multiplications} multiplications, {cost.divisions} divisions, "
        f"{cost.roots} square roots, {cost.trigonometric} sines"
    )


def described(kin: Kinematics) -> list[str]:
    """A line for each parameter: its name in the class, its meaning, and its unit."""
    names = inputs(kin).names
    units = {p.name: f" [{p.unit}]" if p.unit else "" for p in kin.parameters}
    return [documented(f"{names[p.name]}: {p.meaning}{units[p.name]}") for p in kin.parameters]


def notes(kin: Kinematics) -> list[str]:
    """The notes on the mechanism, in the names of the class; those on parameters with another name here come last."""
    given = inputs(kin)
    return [*map(given.reworded, kin.mechanism.all_notes), *given.notes]


def default_configuration(kin: Kinematics) -> str:
    """The default configuration: branch 1 everywhere, and no period is commanded."""
    return literal((1,) * len(kin.branches) + (0,) * len(kin.period_joints))


def indices(kin: Kinematics, names: Sequence[str]) -> str:
    """The indices of the axes with these names."""
    order = [j.name for j in kin.mechanism.joints]
    return literal(tuple(order.index(name) for name in names))


def example(kin: Kinematics) -> list[str]:
    """The first lines of code of a user of this machine, with PACKAGE for the name of the package."""
    mechanism = kin.mechanism
    needed = [p for p in mechanism.parameters if p.default is None or p.nominal != p.default]
    names = inputs(kin).names
    given = [(names.get(p.name, p.name), int(p.nominal) if p.role in _WHOLE else p.nominal) for p in needed]
    values = (f"{name}={literal(value)}" for name, value in given)
    axes = literal(tuple(j.shown for j in mechanism.joints))
    return [
        f"robot = PACKAGE.{class_name(mechanism.name, mechanism.class_name)}({', '.join(values)})",
        f"frame, configuration = robot.forward({axes})",
        f"axes = robot.inverse(frame, configuration, reference={axes})",
    ]


def chain(kin: Kinematics) -> list[str]:
    """The factors of a serial chain as it is described, each with the part of its amount that no axis moves, and what
    each motor adds per unit. Empty for a loop, where loops move joints, and where an amount is not linear in motors.
    """
    described, joints = kin.mechanism.drawn or kin.mechanism.chain, kin.mechanism.joints
    if any(j.loops for j in joints):
        return []
    known = {j.symbol: sp.expand(j.ratio * j.motor + j.coupling) for j in joints} | {sp.pi: 180 * DEGREE}
    amounts = [] if described is None else [sp.expand(f.amount.xreplace(known)) for f in described.factors]
    moved = [[sp.diff(amount, j.motor) for j in joints] for amount in amounts]
    own = {j.motor for j in joints}
    if described is None or any(own & c.free_symbols for row in moved for c in row):
        return []
    printer, lines = _OfParameters(inputs(kin).names), []
    for factor, amount, row in zip(described.factors, amounts, moved, strict=True):
        rest = amount.xreplace(dict.fromkeys(own, sp.Integer(0)))
        fixed = 180 * DEGREE * rest if factor.motion is Motion.FLIP else rest
        by_motor = "".join(f"({k}, {printer.print(c.xreplace(known))}), " for k, c in enumerate(row) if c != 0)
        motion = "shift" if factor.motion is Motion.SHIFT else "turn"
        lines.append(f'Link("{motion}", {factor.axis}, {printer.print(fixed)}, ({by_motor})),')
    return lines


class _OfParameters(ScalarPrinter):
    """Writes expressions of the parameters of a machine, which stand in the mapping `p`."""

    def __init__(self, names: Mapping[str, str]) -> None:
        super().__init__()
        self.names = names

    def name(self, symbol: sp.Symbol) -> str:
        return f'p["{self.names[symbol.name]}"]' if symbol.name in self.names else super().name(symbol)


def literal(value: object) -> str:
    """A value as Python text, with double quotes."""
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, tuple):
        return f"({', '.join(map(literal, value))}{',' if len(value) == 1 else ''})"
    return repr(value)


def _call(constructor: str, *first: str, **values: object) -> str:
    return f"{constructor}({', '.join([*first, *(f'{key}={literal(value)}' for key, value in values.items())])})"


def _tuple(entries: Iterable[str]) -> list[str]:
    parts = [f"    {entry}," for entry in entries]
    return ["(", *parts, ")"] if parts else ["()"]


_OF_INIT = frozenset({"self", "locals", "unrolled", "Constants", "limits"})
"""The names that the text of `__init__` reads."""
OF_CLASS = frozenset(
    """
    ASSEMBLY AXES BRANCHES CONFIGURATION DEFAULT_CONFIGURATION DISTANCE_AXES FREEDOM HELD JACOBIAN_ROWS KEY LIMIT_KEYS
    LINES MARGINS NAME PARAMETERS PERIOD_AXES READS_ROTATION ROLE SURPLUS axis_accelerations axis_accelerations_batch
    axis_velocities axis_velocities_batch branch branches calibrated changed checks_limits condition configuration
    configuration_offset deviations diagnose forward forward_all forward_batch from_dict from_json image_on in_degrees
    in_radians inverse inverse_all inverse_all_batch inverse_batch inverse_offset is_compatible jacobian
    jacobian_batch largest_feed largest_feed_batch limits line manipulability misses move names nearest nearest_batch
    orientation orientation_image parameters path plot project singularity singularity_batch tilted_plane to_dict
    to_json twist twist_rate view with_base with_tool
    """.split()
)
"""The attributes of a class besides its parameters."""


@kept_by_identity(10)
def inputs(kinematics: Kinematics) -> Inputs:
    """The keywords of the class of a mechanism."""
    return inputs_of(kinematics, _PYTHON, {})


def _meaning(name: str) -> str | None:
    if iskeyword(name):
        return "a word of Python"
    if name in _OF_INIT or name in OF_CLASS:
        return "a name that the class itself needs"
    return "hidden inside the class" if name.startswith("_") else None


def _others(parameter: Parameter, wish: str) -> Iterator[str]:
    """Other names: first with an underscore, as usual for words of Python, then with the kind of the parameter."""
    plain = wish.lstrip("_") or "value"
    if _meaning(wish) is not None:
        yield f"{plain}_"
    yield f"{plain}_{word_of(parameter)}"
    yield from (f"{plain}_{word_of(parameter)}_{number}" for number in count(2))


_PYTHON = Spelling(lambda parameter: parameter.given_name, _others, _meaning)
