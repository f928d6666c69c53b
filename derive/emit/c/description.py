"""The tables with which a source describes its machine: axes, parameters, configuration, limits, margins."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import count

from derive.description.mechanism import Parameter, Role
from derive.emit.braced import block
from derive.emit.c.printer import is_reserved, list_of, number, text
from derive.emit.inputs import Inputs, Spelling, inputs_of, word_of
from derive.ir.constants import LARGEST, LEAST
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
_NONZERO = (Role.SIGNED_LENGTH, Role.TRANSMISSION)
_TWO = {Role.FLAG: (0.0, 1.0), Role.SIGN: (-1.0, 1.0)}


@kept_by_identity(10)
def inputs(kinematics: Kinematics) -> Inputs:
    """The names of the parameters, which are members of a struct."""
    return inputs_of(kinematics, _C, {})


def _meaning(name: str) -> str | None:
    if not _NAME.fullmatch(name):
        return "no name in C"
    return "a word of C, of C++ or of their libraries" if is_reserved(name) else None


def _others(parameter: Parameter, wish: str) -> Iterator[str]:
    found = re.sub(r"[^A-Za-z0-9]+", "_", wish, flags=re.ASCII).strip("_")
    plain = f"{found}_{word_of(parameter)}" if found and not found[0].isdigit() else f"{word_of(parameter)}_{found}"
    yield plain
    yield from (f"{plain}_{k}" for k in count(2))


_C = Spelling(lambda parameter: parameter.given_name, _others, _meaning)


def range_of(p: Parameter) -> tuple[float, float, bool]:
    """The ends of the range of a parameter, and whether the lower one is open."""
    low, high = _TWO.get(p.role, (p.low, min(p.high, float(LARGEST))))
    return (max(low, float(LEAST)) if p.low_open else low), high, p.low_open


def in_words(p: Parameter) -> str:
    """The values that a parameter may have."""
    low, high, is_open = range_of(p)
    if p.role in _TWO:
        return f"{low:g} or {high:g}"
    nonzero = ", not 0" if p.role in _NONZERO else ""
    return f"{'more than' if is_open else 'at least'} {low:g} and at most {high:g}{nonzero}"


def tables(kin: Kinematics, prefix: str) -> list[str]:
    """The constant arrays of a source, without empty ones."""
    mechanism, given = kin.mechanism, inputs(kin)
    order = [joint.name for joint in mechanism.joints]
    held = {joint.name for joint in mechanism.held_joints}
    axes = [
        [text(j.name), text(j.kind.value), text("deg" if j.in_degrees else "u"), text(j.meaning),
         _flag(j.multi_turn), _flag(j.name in held)]
        for j in mechanism.joints
    ]  # fmt: skip
    branches = [[text(b.name), text(b.names[0]), text(b.names[1]), "1"] for b in kin.branches]
    turns = [[text(j.name), '""', '""', "0"] for j in kin.period_joints]
    margins = [[text(m.name), text(m.kind)] for m in kin.margins]
    return [
        *_table("softkin_axis", "AXES", axes),
        *_table("softkin_parameter", "PARAMETERS", (_parameter(kin, p, given, prefix) for p in kin.parameters)),
        *_table("softkin_byte", "CONFIGURATION", [*branches, *turns]),
        *_table("softkin_limit", "LIMITS", _limits(kin, given)),
        *_table("softkin_margin", "MARGINS", margins),
        *_row("char *const", "ROWS", map(text, kin.rows)),
        *_row("int", "PERIOD_AXES", [str(order.index(j.name)) for j in kin.period_joints]),
        *_row("int", "DISTANCE_AXES", [str(order.index(j.name)) for j in kin.distance_joints]),
    ]


def counts(kin: Kinematics) -> dict[str, int]:
    """The sizes of all tables."""
    return {
        "axis": len(kin.mechanism.joints),
        "branch": len(kin.branches),
        "period": len(kin.period_joints),
        "row": len(kin.rows),
        "margin": len(kin.margins),
        "limit": len(kin.mechanism.joints) + len(kin.mechanism.limited),
        "parameter": len(kin.parameters),
        "quantity": len(kin.mechanism.limited),
        "distance": len(kin.distance_joints),
        "side": kin.tried_branches,
    }


def _parameter(kin: Kinematics, p: Parameter, given: Inputs, prefix: str) -> list[str]:
    low, high, is_open = range_of(p)
    name = given.names[p.name]
    ends = {f"{word}_{one.key}": end for one in kin.mechanism.joints for word, end in (("lower", -1), ("upper", 1))}
    ends |= {f"{word}_{q.name}": end for q in kin.mechanism.limited for word, end in (("lower", -1), ("upper", 1))}
    return [
        text(name), text(p.role.value), text(p.unit), text(p.meaning), number(low), number(high), _flag(is_open),
        _flag(p.role in _NONZERO), _flag(p.role in _TWO), str(ends.get(p.name, 0)),
        "NAN" if p.default is None else number(p.default), number(p.nominal),
        text(f"{name} must be {in_words(p)} ({p.meaning})"), f"offsetof({prefix}_parameters, {name})",
    ]  # fmt: skip


def _limits(kin: Kinematics, given: Inputs) -> Iterator[list[str]]:
    found = [(j.name, j.key, j.in_degrees) for j in kin.mechanism.joints]
    found += [(q.name, q.name, q.is_angle) for q in kin.mechanism.limited]
    for name, key, is_angle in found:
        lower, upper = (given.names[f"{word}_{key}"] for word in ("lower", "upper"))
        unit = "deg" if is_angle else "u"
        yield [text(name), text(unit), text(f"{lower}, {upper}"), text(f"{lower} below {upper}, or both 0")]


def _table(kind: str, name: str, rows: Iterable[list[str]]) -> list[str]:
    lines = [f"{list_of(row)}," for row in rows]
    return [*block(f"static const {kind} {name}[] =", lines)[:-1], "};", ""] if lines else []


def _row(kind: str, name: str, values: Iterable[str]) -> list[str]:
    found = list(values)
    return [f"static const {kind} {name}[] = {list_of(found)};", ""] if found else []


def _flag(value: object) -> str:
    return "true" if value else "false"
