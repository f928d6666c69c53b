"""Refuse a description that cannot be right, before anything is derived from it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from keyword import iskeyword

import sympy as sp

from derive.algebra.angle_sums import terms_of
from derive.description.amounts import wrong_amounts
from derive.description.fields import number, pair
from derive.description.mechanism import (
    ROTATION,
    DescriptionError,
    Interval,
    Joint,
    Mechanism,
    Parameter,
    Turning,
    X,
    Y,
    Z,
)
from derive.description.reach import wrong_load, wrong_passive, wrong_surplus
from derive.ir.constants import DEGREE

_BLOCK = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*\Z")
_CLASS = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z")
_PARAMETER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_BRANCH = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")
_LEG = re.compile(r"[a-z0-9]+(_[a-z0-9]+)*\Z")
_FAMILY = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*\Z")
_AXIS = re.compile(r"[A-Z][A-Za-z0-9]*\Z")
_UNIT = re.compile(r"([\w°^.%]+([/·-][\w°^.%]+)*)?\Z")

Expressions = tuple[tuple[str, sp.Basic], ...]


def validate(mechanism: Mechanism, names: Mapping[str, str] | None = None) -> Mechanism:
    """The mechanism, or a `DescriptionError` with one sentence. names: of what the file has, by their symbols."""
    for problem in _problems(mechanism, names or {}):
        raise DescriptionError(problem)
    return mechanism


def _problems(mechanism: Mechanism, names: Mapping[str, str]) -> Iterator[str]:
    yield from _names(mechanism)
    yield from _texts(mechanism)
    for parameter in mechanism.parameters:
        yield from _parameter(parameter)
    for joint in mechanism.joints:
        yield from _joint(mechanism, joint)
    yield from _held(mechanism)
    for wrong in (wrong_surplus, wrong_load, wrong_passive):
        yield from wrong(mechanism)
    yield from _periods(mechanism)
    yield from wrong_amounts(mechanism)
    yield from _shape(mechanism)
    yield from _symbols(mechanism, names)
    yield from _constraints(mechanism)


def _texts(mechanism: Mechanism) -> Iterator[str]:
    """Texts are lines. What else they hold is data in every language: each has a function that escapes."""
    stated = [
        *((f"the {word}", getattr(mechanism, word) or "") for word in ("summary", "source", "title")),
        *((f"parameter {p.name!r}", p.meaning) for p in mechanism.parameters),
        *((f"joint {j.name!r}", j.meaning) for j in mechanism.joints),
        *((f"limited quantity {q.name!r}", q.meaning) for q in mechanism.limited),
        *(("a bound", bound.meaning) for bound in mechanism.bounds),
        *((f"branch {b.name!r}", meaning) for b in mechanism.branches for meaning in b.meanings),
        *(("the assembly", meaning) for meaning in (mechanism.assembly.meanings if mechanism.assembly else ())),
        *(("a note", note) for note in mechanism.notes),
        *(("a constraint", c.message) for c in mechanism.constraints),
    ]
    for place, text in stated:
        for wrong in (letter for letter in text if not letter.isprintable()):
            yield f"{place}: its text holds {wrong!r}, a line break or a character that is not printed: leave it out"


def _names(mechanism: Mechanism) -> Iterator[str]:
    for name in (mechanism.name, *mechanism.aliases):
        if not _BLOCK.match(name):
            yield f"{name!r} cannot name a function block"
    if mechanism.class_name is not None and (not _CLASS.match(mechanism.class_name) or iskeyword(mechanism.class_name)):
        yield f"{mechanism.class_name!r} cannot name a class of Python"
    if not _FAMILY.match(mechanism.family):
        yield f"{mechanism.family!r} cannot name a family, which is a folder of CODESYS: words joined by _"
    if not mechanism.joints and (mechanism.task.position or mechanism.task.turning is not Turning.NONE):
        yield "the mechanism has no joints"
    for kind, names in (
        ("joint", [j.name for j in mechanism.joints]),
        ("parameter", [p.name for p in mechanism.parameters]),
        ("branch", [b.name for b in mechanism.branches]),
        ("limited quantity", [q.name for q in mechanism.limited]),
        ("name", [mechanism.name, *mechanism.aliases]),
    ):
        for name, count in Counter(names).items():
            if count > 1:
                yield f"{kind} {name!r} is given {count} times"
        yield from _alike(kind, names)
    yield from _joints_and_parameters(mechanism)
    sides = [("branch", (b.name, *b.names, b.margin)) for b in mechanism.branches]
    sides += [("assembly", (a.name, *a.names, a.margin)) for a in (mechanism.assembly,) if a is not None]
    for kind, words in sides:
        yield from (
            f"{kind} {words[0]!r}: {word!r} cannot name it, a side or the margin of it: lower-case words joined by _"
            for word in words
            if not _BRANCH.match(word)
        )
    legs_of = {
        "rod": [leg.name for leg in mechanism.rods],
        "guide": [leg.name for leg in mechanism.guides],
        "bar": [bar.name for bar in mechanism.bars],
        "limited quantity": [quantity.name for quantity in mechanism.limited],
    }
    for kind, own in legs_of.items():
        yield from (
            f"{name!r} cannot name a {kind}: lower-case letters and digits, words joined by _"
            for name in own
            if not _LEG.match(name)
        )
    for joint in mechanism.joints:
        if not _AXIS.match(joint.name):
            yield f"{joint.name!r} cannot name a joint: a capital letter, then letters and digits"


def _alike(kind: str, names: Sequence[str]) -> Iterator[str]:
    """Names that differ in case alone, which Structured Text takes for one name."""
    first: dict[str, str] = {}
    for name in names:
        other = first.setdefault(name.lower(), name)
        if other != name:
            yield f"{kind} {name!r} and {kind} {other!r} differ in case alone: Structured Text reads them as one name"


def _joints_and_parameters(mechanism: Mechanism) -> Iterator[str]:
    """A joint and a parameter whose names differ in case alone, so that they are one symbol in every equation."""
    joints = {j.symbol: j for j in mechanism.joints}
    for parameter in mechanism.parameters:
        if (joint := joints.get(parameter.symbol)) is not None:
            yield (
                f"joint {joint.name!r} and parameter {parameter.name!r} differ in case alone: equations would read "
                "them as one"
            )


def _parameter(parameter: Parameter) -> Iterator[str]:
    name = parameter.name
    for word in (name, parameter.given_name):
        if not _PARAMETER.match(word):
            yield f"{word!r} cannot name a parameter: letters, digits and _, and no digit first"
    if not _UNIT.match(parameter.unit):
        yield f"parameter {name!r}: {parameter.unit!r} is no unit: letters, digits, / and ^"
    stated = (parameter.nominal, *parameter.shown, *(() if parameter.default is None else (parameter.default,)))
    if strange := [value for value in stated if not isinstance(value, int | float)]:
        yield f"parameter {name!r}: {strange[0]!r} is not a number"
        return
    low, high = parameter.shown
    if not low < high:
        yield f"parameter {name!r}: its range {_interval(parameter)} is empty"
    for word, value in (("nominal value", parameter.nominal), ("default", parameter.default)):
        if value is not None and (wrong := number(f"its {word}", value)) is not None:
            yield f"parameter {name!r}: {wrong}"
        elif value is not None and not _contains(parameter, value):
            yield f"parameter {name!r}: its {word} {value:g} is outside its range {_interval(parameter)}"


def _contains(parameter: Parameter, value: float) -> bool:
    low, high = parameter.shown
    return low <= value <= high and not (parameter.low_open and value == low)


def _interval(parameter: Parameter) -> str:
    low, high = parameter.shown
    return f"{']' if parameter.low_open else '['}{low:g} .. {high:g}]"


def _joint(mechanism: Mechanism, joint: Joint) -> Iterator[str]:
    ranges: dict[str, Interval | None] = {
        "offset_range": joint.offset_range,
        "limit_range": joint.limit_range,
        "limits": joint.limits,
        "domain": joint.domain,
    }
    wrong = [
        number("its nominal value", joint.nominal),
        *(pair(word, i) for word, i in ranges.items() if i is not None),
    ]
    if any(wrong):
        yield from (f"joint {joint.name!r}: {said}" for said in wrong if said is not None)
        return
    for word, interval in ranges.items():
        if interval is not None and not interval[0] < interval[1]:
            yield f"joint {joint.name!r}: its {word} {interval} {'are' if word == 'limits' else 'is'} empty"
    if joint.domain is not None and not joint.domain[0] <= joint.nominal <= joint.domain[1]:
        yield f"joint {joint.name!r}: its nominal value {joint.nominal:g} is outside its domain {joint.domain}"
    if joint.pitch != 0 and joint.limit_range is None:
        yield f"joint {joint.name!r} carries a pitch: it needs a limit_range"
    earlier = mechanism.joints[: mechanism.joints.index(joint)]
    motors = {other.motor for other in earlier} | _parameters(mechanism)
    yield from _unknown(f"coupling of joint {joint.name!r}", joint.coupling, motors, "the motor of an earlier joint")
    yield from _unknown(f"pitch of joint {joint.name!r}", joint.pitch, _parameters(mechanism), "a parameter")


def _held(mechanism: Mechanism) -> Iterator[str]:
    names = [j.name for j in mechanism.joints]
    for joint in mechanism.held:
        if joint.name not in names:
            yield f"held names {joint.name!r}, which is no joint of this mechanism"
    for joint in mechanism.held_joints:
        if joint.coupling != 0:
            yield f"joint {joint.name!r} is held and geared to other axes: hold a joint that has a motor of its own"
    if mechanism.held and mechanism.chain is None:
        yield "held joints need a chain: of a closed loop every joint follows from the pose"


def _periods(mechanism: Mechanism) -> Iterator[str]:
    if mechanism.periods is None:
        return
    turning = [j.name for j in mechanism.joints if j.multi_turn]
    for name in mechanism.periods:
        if name not in turning:
            yield f"periods names {name!r}, which is no multi-turn joint of this mechanism"
    if sorted(mechanism.periods) != sorted(turning):
        yield f"periods must name every multi-turn joint once: {', '.join(turning)}"


def _shape(mechanism: Mechanism) -> Iterator[str]:
    if mechanism.drives and mechanism.chain is None:
        yield "drives= are loops that move joints of a chain: a closed loop states its rods"
    if (mechanism.chain is None) == (not mechanism.equations):
        yield "the mechanism needs either a chain or closure equations"
    yield from _position(mechanism)
    yield from _heading(mechanism)
    if mechanism.search is not None and not any(b.is_crossing for b in mechanism.branches):
        yield "search needs a branch that tells its roots apart: as in crossing('side', rising=+1, falling=-1)"
    cones = [cone for rod in mechanism.rods for cone in (rod.base_cone, rod.plate_cone) if cone is not None]
    if cones and not mechanism.home:
        yield "a cone of a rod's joint is about the rod at the home pose, and the mechanism has none"
    for cone in cones:
        yield from _unknown("a cone of a rod's joint", cone, _parameters(mechanism), "a parameter of this mechanism")
    used = {s for _, e in _equations(mechanism) for s in e.free_symbols}
    for joint in mechanism.joints:
        if joint.symbol not in used:
            is_carried = joint.is_angle and mechanism.is_turning_loop and mechanism.heading is None
            hint = f": where it turns the tool on the plate, say so by heading={joint.name}" if is_carried else ""
            yield f"joint {joint.name!r} occurs nowhere in the closure{hint}"


def _position(mechanism: Mechanism) -> Iterator[str]:
    position = mechanism.task.position
    if mechanism.is_orientation:
        return
    is_in_order = position == "".join(c for c in "xyz" if c in position)
    if not is_in_order or (not position and not mechanism.is_platform):
        yield (
            f"the task commands {position!r}: it must be coordinates in the order x, y, z, or '' of a machine that "
            "only turns"
        )
        return
    if position in ("xy", "xyz") or mechanism.chain is not None:
        return
    joints = {j.symbol for j in mechanism.joints}
    is_held = any(not sp.sympify(e).free_symbols & joints for e in mechanism.equations)
    if mechanism.is_platform and is_held:
        return  # the build counts what holds the others
    moved = {c.name for c in (X.symbol, Y.symbol, Z.symbol) for e in mechanism.equations if c in e.free_symbols}
    if uncommanded := [c for c in "xyz" if c in moved and c not in position]:
        yield (
            f"the task commands {position!r}, and the loop moves {', '.join(uncommanded)} as well: coordinates "
            "that are not commanded must be held by guides=, planes in which points of a platform that turns stay; "
            "else command them too"
        )


def _heading(mechanism: Mechanism) -> Iterator[str]:
    if mechanism.heading is None:
        return
    if mechanism.chain is not None:
        yield "a chain tells the heading of its flange itself: heading= is for a loop whose plate carries a joint"
    if mechanism.task.turning is not Turning.ABOUT_Z:
        yield "heading= turns the flange about z: the task must command that, Turning.ABOUT_Z"
    turning = [j.symbol for j in mechanism.joints if j.is_angle]
    if terms_of(sp.expand(mechanism.heading), turning) is None:
        yield f"heading={mechanism.heading} must be a sum of rotary joints, each of them added or subtracted once"
    if mechanism.home:
        yield "a loop with heading= needs no home pose: its position is solved in closed form"


def _equations(mechanism: Mechanism) -> Expressions:
    if mechanism.chain is not None:
        return tuple(("chain", factor.amount) for factor in mechanism.chain.factors)
    heading = () if mechanism.heading is None else (("heading", mechanism.heading),)
    return (*(("closure", sp.sympify(equation)) for equation in mechanism.equations), *heading)


def _symbols(mechanism: Mechanism, names: Mapping[str, str]) -> Iterator[str]:
    joints = {j.symbol for j in mechanism.joints}
    known = joints | _parameters(mechanism)
    if mechanism.chain is None:
        known |= {quantity.symbol for quantity in (X, Y, Z)}
    if mechanism.is_turning_loop or mechanism.task.turning is Turning.FULL:
        known |= set(ROTATION)
    named = [
        *_equations(mechanism),
        *((f"branch {b.name!r}", b.indicator) for b in mechanism.branches),
        *(("positive", sp.sympify(e)) for e in mechanism.positive),
        *(("load", e) for e in mechanism.load),
        *((f"limited quantity {q.name!r}", q.value) for q in mechanism.limited),
        *((f"bar {bar.name!r}", e) for bar in mechanism.bars for e in (*bar.base, *bar.plate, bar.length)),
    ]
    for place, expression in named:
        yield from _unknown(place, expression, known, "a joint or a parameter of this mechanism", names)
    for branch in mechanism.branches:
        if not branch.is_crossing and not joints & branch.indicator.free_symbols:
            yield f"branch {branch.name!r}: its indicator {branch.indicator} depends on no joint"


def _constraints(mechanism: Mechanism) -> Iterator[str]:
    values: dict[str, sp.Expr] = {p.symbol.name: sp.Float(p.nominal) for p in mechanism.parameters} | {
        DEGREE.name: sp.pi / 180
    }

    def at_nominal(expression: sp.Basic) -> sp.Basic:
        return expression.xreplace({s: values.get(s.name, sp.Integer(0)) for s in expression.free_symbols})

    for constraint in mechanism.constraints:
        for step in constraint.steps:
            values[step.name.name] = sp.Float(at_nominal(step.value))
        strange = sorted(s.name for s in constraint.condition.free_symbols if s.name not in values)
        if strange:
            yield f"constraint {constraint.message!r} reads {strange[0]!r}, which is no parameter of this mechanism"
        if at_nominal(constraint.condition) != sp.true:
            yield f"the nominal parameters break the constraint {constraint.message!r}"


def _parameters(mechanism: Mechanism) -> set[sp.Basic]:
    return {p.symbol for p in mechanism.parameters}


def _unknown(
    place: str, expression: sp.Basic, known: Iterable[sp.Basic], wanted: str, names: Mapping[str, str] | None = None
) -> Iterator[str]:
    strange = expression.free_symbols - set(known) - {DEGREE}
    for symbol in sorted(strange, key=str):
        yield f"{place} reads {(names or {}).get(str(symbol), str(symbol))!r}, which is not {wanted}"
