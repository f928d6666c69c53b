"""The variables of an FMU, in the order of their value references: `runtime/fmu/softkin_fmu.c` has the same groups."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite

from derive.description.mechanism import Parameter, Role
from derive.emit.c.description import in_words, inputs, range_of
from derive.kinematics.kinematics import Kinematics

_FRAME = ("x", "y", "z", *(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3)))
"""The coordinates of a frame: its position, then its rotation by rows."""
_PLAIN = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_OTHER = re.compile(r"[^\w !#$%&()*+,\-./:;<>=?@^{}|~]", re.ASCII)
"""What a quoted name cannot hold; also brackets, since a name that ends with one is an array."""
_TYPES = {Role.FLAG: "Boolean", Role.SIGN: "Int8"}


@dataclass(frozen=True)
class Variable:
    """A scalar variable of an FMU."""

    name: str
    type: str
    causality: str
    meaning: str
    unit: str = ""
    start: str = ""
    """As the schema spells it; an output has none."""
    low: str = ""
    high: str = ""

    @property
    def variability(self) -> str:
        """How the value may change."""
        if self.causality == "parameter":
            return "fixed"
        return "continuous" if self.type == "Float64" else "discrete"


def variables_of(kin: Kinematics) -> list[Variable]:
    """All variables of a machine; the value reference of each is its place."""
    return [
        Variable("time", "Float64", "independent", "Time, which no output depends on", "s"),
        *(_parameter(kin, p) for p in kin.parameters),
        *_axes(kin, "axes", "input", "value for forward kinematics, Jacobian and margins"),
        *_frame(kin, "target", "input", "of the frame that the inverse reaches"),
        *_axes(kin, "reference", "input", "the inverse chooses turns, and branches with byte 0, next to it"),
        *_bytes(kin, "configuration", "input"),
        *_frame(kin, "pose", "output", "of the frame at `axes`"),
        *_bytes(kin, "pose.configuration", "output"),
        *_status("pose"),
        *_axes(kin, "solution.axes", "output", "value that reaches `target`"),
        Variable("solution.missing", "Float64", "output", "By how much `target` is missed, in `solution.unit`"),
        Variable("solution.unit", "String", "output", "u, deg, or empty for a number without a unit"),
        Variable("solution.turn", "Int32", "output", "A turn inside the limits, if the turn is the reason; else 0"),
        *_status("solution"),
        *_jacobian(kin),
        *_status("jacobian"),
        *(
            Variable(f"margins.{_part(m.name)}", "Float64", "output", f"Margin: zero at its singularity, {m.kind}")
            for m in kin.margins
        ),
        Variable("singularity.is_singular", "Boolean", "output", "Whether `axes` are closer to a singularity than "
                 "the parameter for it says, or have no pose"),
        *_status("singularity"),
        *_status("limits"),
    ]  # fmt: skip


def _part(name: str) -> str:
    """A part of a structured name; what is no identifier is quoted."""
    return name if _PLAIN.fullmatch(name) else f"'{_OTHER.sub('_', name)}'"


def _number(value: float) -> str:
    return repr(float(value)) if isfinite(value) else ""


def _parameter(kin: Kinematics, p: Parameter) -> Variable:
    """An input that the initialization reads. Without a default it is 0, which the machine refuses of a length."""
    low, high, _ = range_of(p)
    given, kind = p.default or 0.0, _TYPES.get(p.role, "Float64")
    start = {"Boolean": str(bool(given)).lower(), "Int8": str(int(given) or 1)}.get(kind, _number(given))
    ends = {"Float64": (_number(low), _number(high)), "Int8": ("-1", "1")}.get(kind, ("", ""))
    unit = p.unit if kind == "Float64" else ""
    meaning = f"{p.meaning}: {in_words(p)}{'; it must be given' if p.default is None else ''}"
    name = f"parameters.{_part(inputs(kin).names[p.name])}"
    return Variable(name, kind, "parameter", meaning, unit, start, *ends)


def _start(causality: str, start: str) -> str:
    return start if causality == "input" else ""


def _axes(kin: Kinematics, group: str, causality: str, use: str) -> Iterator[Variable]:
    for joint in kin.mechanism.joints:
        unit, start = "deg" if joint.in_degrees else "u", _start(causality, "0.0")
        yield Variable(f"{group}.{_part(joint.name)}", "Float64", causality, f"{joint.meaning}: {use}", unit, start)


def _frame(kin: Kinematics, group: str, causality: str, use: str) -> Iterator[Variable]:
    for name in _FRAME:
        is_place = len(name) == 1
        meaning = f"{name} {use}" if is_place else f"row {name[1]}, column {name[2]} of the rotation {use}"
        start = _start(causality, "1.0" if name in ("r11", "r22", "r33") else "0.0")
        yield Variable(f"{group}.{name}", "Float64", causality, meaning, "u" if is_place else "", start)


def _bytes(kin: Kinematics, group: str, causality: str) -> Iterator[Variable]:
    for branch in kin.branches:
        meaning = f"1 = {branch.names[0]}, 2 = {branch.names[1]}, 0 = automatic, 3 = both meet"
        yield Variable(f"{group}.{_part(branch.name)}", "Int8", causality, meaning, "", _start(causality, "1"))
    for joint in kin.period_joints:
        meaning = f"Turn of {joint.name}: 0 = nearest to the reference, 1 = [-180, 180), 2 = [180, 540), ..."
        yield Variable(f"{group}.{_part(f'turn_{joint.name}')}", "Int8", causality, meaning, "", _start(causality, "0"))


def _jacobian(kin: Kinematics) -> Iterator[Variable]:
    for row in kin.rows:
        for joint in kin.mechanism.joints:
            name = f"jacobian.{_part(row.replace(' ', '_'))}.{_part(joint.name)}"
            per = "radian" if joint.in_degrees else "u"
            yield Variable(name, "Float64", "output", f"Derivative of {row} by {joint.name}, per {per}")


def _status(group: str) -> Iterator[Variable]:
    yield Variable(f"{group}.status", "Enumeration", "output", "Whether the values beside it are an answer")
    yield Variable(f"{group}.reason", "String", "output", "Why they are none; empty if they are")
