"""The names that the inputs of a machine have inside a derivation, so that none equals a derived name.

A derivation names its values by their meaning: `cos_a2`, `reach`, `tool_x`. A parameter or joint of a description with
such a name gets another one inside the derivation, here `given_reach`. Users see its own name everywhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import sympy as sp

from derive.algebra.angle_sums import name_of
from derive.description.amounts import with_symbols
from derive.description.mechanism import Joint, Mechanism, Parameter
from derive.ir.symbols import (
    ASSEMBLY_SIGN,
    BASE_AXIS,
    CHECK_FORWARD,
    DETERMINANT,
    FLANGE_AXIS,
    HEADING,
    MAX_MISS,
    MIN_TYPE2_MARGIN,
    OFFSET,
    POSITION,
    REFUSAL,
    ROTATION_ENTRIES,
    SCALE,
    SIDE,
    START_POSITION,
    START_ROTATION,
    TRIED,
    cosine,
    real,
    sine,
)

_OF_AXES = (
    *("axis", "ref", "reference", "turn", "offset", "lower", "upper", "motor", "unlimited"),
    *("lowest", "highest", "mid", "single", "open", "near", "turns", "sense", "turned"),
    *("effective_lower", "effective_upper", "tolerance", "ref_motor", "drive_limited", "drive_lower", "drive_upper"),
)
"""The beginnings of names for values of an axis: `offset_a1`."""
_OF_BRANCHES = ("sigma", "branch", "sign", "margin")
_SHARED = frozenset(
    symbol.name
    for symbol in (
        *(ASSEMBLY_SIGN, DETERMINANT, HEADING, SCALE, *POSITION, *ROTATION_ENTRIES, *OFFSET),
        *(*START_POSITION, *START_ROTATION, *FLANGE_AXIS, *BASE_AXIS, TRIED, SIDE),
    )
) | {"check_limits", "warning_distance", "tie", "searched", "found", CHECK_FORWARD, MAX_MISS, MIN_TYPE2_MARGIN, REFUSAL}
"""Inputs and outputs of the programs of every mechanism."""
_WORDS = frozenset(
    """
    across along angle area assembly axis before between centre centres corner cos determinant direction divisor error
    fit flange foot fraction free goal guard heading height home in joint length link moment normal of orientation
    passes plane platform point power product projection radicand radius rate ratio reach residual root room scale
    shoulder side sin size spin spread square start step stretch swing sum tool tried turn value weight whole within
    wrist x y z
    """.split()
)
"""Words of which derived names are made; their other words are names of joints, and numbers."""
_PORTABLE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")
_GIVEN = "given"


def with_inner_names(mechanism: Mechanism, further: Mapping[str, int] | None = None) -> Mechanism:
    """The mechanism as it is derived: a parameter or joint whose name equals a derived name gets an inner name.

    further: the symbols of parameters and joints whose names equalled a derived one in earlier attempts, and how often.
    """
    symbols = _inner_symbols(mechanism, further or {})
    if not symbols:
        return mechanism
    renamed: Mechanism = with_symbols(mechanism, symbols)
    texts = {p.given: p.name for p in renamed.parameters if "_" in p.given}
    constraints = tuple(replace(c, message=_reworded(c.message, texts)) for c in renamed.constraints)
    return replace(renamed, constraints=constraints, notes=tuple(_reworded(note, texts) for note in renamed.notes))


def inputs_named(mechanism: Mechanism, inner: Mechanism, names: Sequence[str]) -> frozenset[str]:
    """The symbols, in the description, of the inputs that have one of these names inside the derivation."""
    wanted = {joined(name) for name in names}
    pairs = zip(_inputs(mechanism), _inputs(inner), strict=False)
    return frozenset(own.symbol.name for own, same in pairs if joined(same.symbol.name) in wanted)


def suspects(mechanism: Mechanism) -> frozenset[str]:
    """The symbols of inputs whose names are made of words for derived names alone: a derivation may use them, too."""
    keys = {j.symbol.name for j in mechanism.joints}
    plain = (i.symbol.name for i in _inputs(mechanism) if i.symbol == real(i.symbol.name))
    return frozenset(
        name
        for name in plain
        if name in _WORDS or (name not in keys and all(w in _WORDS | keys or w.isdigit() for w in name.split("_")))
    )


def in_given_names(text: str, mechanism: Mechanism) -> str:
    """A sentence about a mechanism with inner names, in the names of its description."""
    names = {p.name: p.given_name for p in mechanism.parameters} | {
        j.symbol.name: j.name for j in mechanism.joints if j.symbol.name == f"joint_{j.key}"
    }
    return _reworded(text, names)


def _reworded(text: str, names: Mapping[str, str]) -> str:
    """A text in which names are replaced."""
    return re.sub(r"[A-Za-z_]\w*", lambda found: names.get(found.group(), found.group()), text)


def joined(name: str) -> str:
    """The name as Structured Text compares it, where words are joined and case does not count."""
    return name.replace("_", "").lower()


def _inputs(mechanism: Mechanism) -> tuple[Parameter | Joint, ...]:
    return (*mechanism.joints, *mechanism.parameters)


def _inner_symbols(mechanism: Mechanism, further: Mapping[str, int]) -> dict[sp.Symbol, sp.Symbol]:
    """The symbols of a description that are derived under another name, with that name's symbol."""
    joints, found = _taken_joints(mechanism), {}
    own = {joined(i.symbol.name) for i in _inputs(mechanism)}
    for joint in mechanism.joints:
        if joint.symbol.name in joints or joint.symbol.name in further:
            number = further.get(joint.symbol.name, 1)
            found[joint.symbol] = _free(joint.symbol, f"joint_{joint.key}", number, own)
    taken = {joined(name) for name in (*_taken(mechanism), *_of_joints(mechanism, found))}
    for p in mechanism.parameters:
        key, name = joined(p.symbol.name), p.symbol.name
        is_met = key in taken or (f"{key}value" in own and f"{key}value" != key)
        if is_met or name in further or not _PORTABLE.match(name):
            plain = "_".join(word for word in p.name.lower().split("_") if word) or "number"
            found[p.symbol] = _free(p.symbol, f"{_GIVEN}_{plain}", further.get(name, 1), own | taken)
        taken.add(key)
    return found


def _free(symbol: sp.Symbol, name: str, number: int, taken: set[str]) -> sp.Symbol:
    """A copy of a symbol with a name that is not in use: the given one, with a number if needed. It is then in use."""
    proposal = name if number == 1 else f"{name}_{number}"
    while joined(proposal) in taken:
        number += 1
        proposal = f"{name}_{number}"
    taken.add(joined(proposal))
    return type(symbol)(proposal, **symbol.assumptions0)


def _taken(mechanism: Mechanism) -> Iterator[str]:
    """The names that the programs of this mechanism give to derived values."""
    yield from _SHARED
    axes = [*(j.key for j in mechanism.joints), *(q.name for q in mechanism.limited)]
    yield from (f"{word}_{key}" for word in _OF_AXES for key in axes)
    yield from (f"{word}_{b.name}" for word in _OF_BRANCHES for b in mechanism.branches)
    yield from (step.name.name for constraint in mechanism.constraints for step in constraint.steps)


def _of_joints(mechanism: Mechanism, inner: Mapping[sp.Symbol, sp.Symbol]) -> Iterator[str]:
    for joint in mechanism.joints:
        symbol = inner.get(joint.symbol, joint.symbol)
        yield from (s.name for s in (symbol, sine(symbol), cosine(symbol)))


def _taken_joints(mechanism: Mechanism) -> set[str]:
    """The names of joint values that a derivation uses for other values: the commanded pose, sums of joints."""
    turning = [j.symbol for j in mechanism.joints if j.is_angle]
    sums = {
        name_of(tuple((s, 1) for s in some)) for n in range(2, len(turning) + 1) for some in combinations(turning, n)
    }
    return sums | set(_SHARED)
