"""All inputs of a machine, and the setup program that checks them and computes what depends on them alone."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from functools import cache

import sympy as sp

from derive.description.mechanism import Branch, Joint, Mechanism, Parameter, Role
from derive.equations.choices import converted, input_of
from derive.equations.windows import windows
from derive.geometry.frames import Motion
from derive.ir.constants import LARGEST, LEAST, SINGULAR, TIE_SHARE
from derive.ir.passes import plain, without_assumptions
from derive.ir.primitives import Select, ToReal
from derive.ir.program import Let, Output, Program, Require, Statement, Status
from derive.ir.reason import Reason, about_parameters
from derive.ir.symbols import CHECK_FORWARD, MAX_MISS, MIN_TYPE2_MARGIN, SCALE, compared, flag, is_count, real
from derive.ir.verify import verify
from derive.plate.plate import home_branches, machine_constants, machine_statements

CHECK_LIMITS, WARNING_DISTANCE = "check_limits", "warning_distance"
TIE_OF_LENGTHS = real("tie")
"""Squared distances of linear axes that differ by less than this are equal."""
_LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH)


def machine_parameters(mechanism: Mechanism) -> tuple[Parameter, ...]:
    """All inputs that users give: the parameters of the description, then offset and limits of every axis, then the
    limits of every limited quantity.
    """
    parameters = [p for p in mechanism.parameters if p.fixed is None]
    for joint in mechanism.joints:
        parameters.append(_number(joint, "offset", "axis value at the kinematic zero position", joint.offset_range))
    for joint in mechanism.joints:
        for word, end in zip(("lower", "upper"), joint.limits or (0.0, 0.0), strict=True):
            meaning = f"{word} limit of the axis, both 0: {_without_limits(joint)}"
            own = _number(joint, word, meaning, joint.limit_range)
            parameters.append(replace(own, default=end, nominal=end))
    for quantity in mechanism.limited:
        unit = "deg" if quantity.is_angle else "u"
        for word in ("lower", "upper"):
            meaning = f"{word} limit of {quantity.meaning}, both 0: no limit"
            parameters.append(_setting(f"{word}_{quantity.name}", meaning, unit, None))
    parameters += _assembly_parameters(mechanism)
    parameters += [_max_miss()] if mechanism.surplus else []
    check = Parameter(
        flag(CHECK_LIMITS),
        CHECK_LIMITS,
        Role.FLAG,
        "inverse kinematics tests the limits",
        "",
        0.0,
        1.0,
        False,
        1.0,
        1.0,
    )
    meaning = "poses count as singular where a margin (a number without a unit) is smaller than this"
    near = float(SINGULAR)
    warning = Parameter(real(WARNING_DISTANCE), WARNING_DISTANCE, Role.RATIO, meaning, "1", 0.0, 1.0, False, near, near)
    return (*parameters, check, warning)


def shown_values(mechanism: Mechanism) -> dict[str, float]:
    """The inputs of the machine that is drawn and shown: nominal dimensions, and the limits of the description."""
    return {p.name: p.nominal for p in machine_parameters(mechanism)}


def unlimited_values(mechanism: Mechanism) -> dict[str, float]:
    """The inputs of the machine by which formulas are measured: without limits, so that every pose counts."""
    any_miss = {MAX_MISS: float(LARGEST)} if mechanism.surplus else {}
    return shown_values(mechanism) | {end: 0.0 for window in windows(mechanism) for end in window.given} | any_miss


def _assembly_parameters(mechanism: Mechanism) -> list[Parameter]:
    """The assembly mode of a closed loop, and its least distance from a type 2 singularity."""
    if mechanism.is_platform:
        return [*map(_at_home, home_branches(mechanism)), _least_margin(), _check_forward()]
    if mechanism.assembly is None:
        return []
    name, chosen = mechanism.assembly.parameter, mechanism.assembly.names[1]
    meaning = f"assembly mode: {chosen} instead of {mechanism.assembly.names[0]}"
    return [Parameter(real(name), name, Role.FLAG, meaning, "", 0.0, 1.0, False, 0.0, 0.0), _least_margin()]


def _at_home(branch: Branch) -> Parameter:
    """The branch at the home pose, on which the assembly mode of the machine depends."""
    meaning = f"branch {branch.name} at the home pose: {branch.names[1]} instead of {branch.names[0]}"
    name = branch.home_flag
    return Parameter(real(name), name, Role.FLAG, meaning, "", 0.0, 1.0, False, 0.0, 0.0)


def _least_margin() -> Parameter:
    meaning = "least distance from a type 2 singularity, a number without a unit; 0: off"
    return Parameter(real(MIN_TYPE2_MARGIN), MIN_TYPE2_MARGIN, Role.RATIO, meaning, "1", 0.0, 1.0, False, 1e-3, 1e-3)


def _check_forward() -> Parameter:
    """Whether the inverse asks forward kinematics for the pose of the axes that it has found."""
    meaning = "inverse kinematics refuses a pose that forward kinematics from the home pose does not find again"
    return Parameter(flag(CHECK_FORWARD), CHECK_FORWARD, Role.FLAG, meaning, "", 0.0, 1.0, False, 1.0, 1.0)


def _max_miss() -> Parameter:
    meaning = "largest length by which a surplus rod may miss the pose of the others; 0: a thousandth of its length"
    return Parameter(real(MAX_MISS), MAX_MISS, Role.DISTANCE, meaning, "u", 0.0, float(LARGEST), False, 0.0, 0.0)


def _number(joint: Joint, word: str, meaning: str, interval: tuple[float, float] | None) -> Parameter:
    unit = "deg" if joint.in_degrees else "u"
    return _setting(f"{word}_{joint.key}", f"{joint.name}: {meaning}", unit, interval)


def _setting(name: str, meaning: str, unit: str, interval: tuple[float, float] | None) -> Parameter:
    ends = (-float(LARGEST), float(LARGEST))
    role = Role.ANGLE if unit == "deg" else Role.DISTANCE
    return Parameter(real(name), name, role, meaning, unit, *ends, False, 0.0, 0.0, usual=interval)


def setup_program(
    mechanism: Mechanism,
    parameters: tuple[Parameter, ...],
    hoisted: tuple[Let, ...] = (),
    read: Collection[sp.Symbol] = (),
    *,
    has_settings: bool = False,
    at_home: Sequence[Statement] = (),
) -> Program:
    """Check every parameter; the outputs are the parameters, the effective limits, and the hoisted values that are
    `read`.

    has_settings: drives hand over limits, so that the outputs of `limits_of_axis` are left to it. at_home: the joints
    at the home pose of a loop that turns its platform.
    """
    body, outputs = _of_machine(mechanism, parameters, has_settings, at_home)
    body += hoisted
    outputs += [Output(let.name.name, let.name) for let in hoisted if let.name in read]
    inputs = tuple(input_of(p) for p in parameters)
    typed = tuple(converted(s, parameters) for s in without_assumptions(body))
    answers = tuple(Output(o.name, plain(o.value)) for o in outputs)
    return verify(Program("setup", inputs, typed, answers))


def constants_of(mechanism: Mechanism, parameters: tuple[Parameter, ...], at_home: Sequence[Statement]) -> list[str]:
    """The outputs of the setup before anything is hoisted into it."""
    return [output.name for output in _of_machine(mechanism, parameters, False, at_home)[1]]


def _of_machine(
    mechanism: Mechanism, parameters: tuple[Parameter, ...], has_settings: bool, at_home: Sequence[Statement]
) -> tuple[list[Statement], list[Output]]:
    """Statements and outputs of the setup without hoisted values."""
    body: list[Statement] = [condition for p in parameters for condition in _range_of(p)]
    numbers = [Let(real(p.name), p.fixed, p.meaning) for p in mechanism.parameters if p.fixed is not None]
    body += numbers
    for constraint in mechanism.constraints:
        body += constraint.steps
        body.append(_needed(_inequality(constraint.condition), constraint.message))
    gears, outputs_of_gears = _gears(mechanism)
    body += gears
    found = windows(mechanism)
    ends = {name for window in found for name in window.given}
    outputs = [_as_constant(p) for p in parameters if p.name not in ends] + outputs_of_gears
    for window in found:
        body += [window.ordered, *window.limits]
        outputs += window.limit_outputs
        if not (has_settings and window.is_axis):
            body += window.ends
            outputs += window.outputs
    outputs += [Output(let.name.name, let.name) for let in numbers]
    sizes, constants = _size(mechanism, at_home)
    body += sizes
    outputs += constants
    if chooses_by_lengths(mechanism):
        body.append(Let(TIE_OF_LENGTHS, TIE_SHARE**2 * SCALE**2, "squared distances that differ by less are equal"))
        outputs.append(Output(TIE_OF_LENGTHS.name, TIE_OF_LENGTHS))
    return body, outputs


def _gears(mechanism: Mechanism) -> tuple[list[Let], list[Output]]:
    """The gears that are made of parameters: the turns of the joint per turn of its axis, and its sense."""
    lets: list[Let] = []
    for joint in mechanism.joints:
        if joint.multi_turn and not joint.ratio.is_number:
            note = f"{joint.name}: turns of the joint per turn of the axis"
            lets.append(Let(sp.Symbol(str(joint.turns), real=True), sp.Abs(joint.ratio), note))
            lets.append(Let(sp.Symbol(str(joint.sense), real=True), Select(sp.Gt(joint.ratio, 0), 1, -1)))
    return lets, [Output(let.name.name, let.name) for let in lets]


def _size(mechanism: Mechanism, at_home: Sequence[Statement]) -> tuple[tuple[Statement, ...], tuple[Output, ...]]:
    """The characteristic length of the machine; for a loop that turns its platform all constants of its home pose."""
    if mechanism.is_platform:
        return machine_statements(mechanism, at_home), machine_constants(mechanism)
    let = Let(SCALE, machine_scale(mechanism), "characteristic length of the machine")
    return (let,), (Output(SCALE.name, SCALE),)


def _as_constant(parameter: Parameter) -> Output:
    """The parameter as other programs read it: a sign is a real number, for products."""
    own = input_of(parameter)
    return Output(parameter.name, ToReal(own) if is_count(own) else own)


def chooses_by_lengths(mechanism: Mechanism) -> bool:
    """Whether the distance of a branch to the reference is measured by linear axes alone."""
    return bool(mechanism.branches) and not any(j.axis_is_angle for j in mechanism.joints)


def machine_scale(mechanism: Mechanism) -> sp.Expr:
    """The sum of the lengths of the description, given as parameters or as numbers; if there is none, one unit of
    length and all distances, which may be zero.
    """
    if not has_length(mechanism):
        own = [p for p in mechanism.parameters if p.role is Role.DISTANCE]
        return sp.Add(sp.Integer(1), *(sp.Abs(p.symbol) for p in own))
    own = [
        p for p in mechanism.parameters if p.role in _LENGTHS or (p.role is Role.DISTANCE and p.symbol.is_nonnegative)
    ]
    return sp.Add(*(sp.Abs(p.symbol) for p in own), *lengths_in_numbers(mechanism))


def has_length(mechanism: Mechanism) -> bool:
    """Whether a machine has a length that is never zero, by which others can be divided."""
    return any(p.role in _LENGTHS for p in mechanism.parameters) or bool(lengths_in_numbers(mechanism))


def lengths_in_numbers(mechanism: Mechanism) -> tuple[sp.Expr, ...]:
    """The lengths that the description states as numbers: shifts of the chain, lengths of rods."""
    factors = () if mechanism.chain is None else mechanism.chain.factors
    shifts = (f.amount for f in factors if f.motion is Motion.SHIFT)
    terms = [t for v in (*shifts, *(r.length for r in mechanism.rods)) for t in sp.Add.make_args(sp.sympify(v))]
    return tuple(sp.Abs(t) for t in terms if t.is_number and t != 0)


@cache
def _range_of(parameter: Parameter) -> tuple[Require, ...]:
    note = f"{parameter.name}: {parameter.meaning}"
    if parameter.role is Role.FLAG:
        return ()
    if parameter.role is Role.SIGN:
        condition = sp.Or(*(compared(sp.Eq, input_of(parameter), sign) for sign in (1, -1)))
        return (_needed(condition, note),)
    value = real(parameter.name)  # without assumptions: SymPy must not decide `length > 0` by itself
    low = sp.Float(parameter.low) if parameter.low % 1 else sp.Integer(int(parameter.low))
    high = sp.Float(parameter.high) if parameter.high % 1 else sp.Integer(int(parameter.high))
    if parameter.role in (Role.SIGNED_LENGTH, Role.TRANSMISSION):
        # NaN fails a comparison; the absolute value of NaN is an error
        nonzero = sp.Or(compared(sp.Gt, value, LEAST), compared(sp.Lt, value, -LEAST))
        inside = sp.And(nonzero, compared(sp.Ge, value, low), compared(sp.Le, value, min(high, LARGEST)))
        return (_needed(inside, note),)
    above = compared(sp.Gt, value, sp.Max(low, LEAST)) if parameter.low_open else compared(sp.Ge, value, low)
    return (_needed(sp.And(above, compared(sp.Le, value, min(high, LARGEST))), note),)


def ranges(parameters: Iterable[Parameter]) -> frozenset[Reason | None]:
    """The reasons that refuse a single parameter, whatever the others are."""
    return frozenset(condition.reason for p in parameters for condition in _range_of(p))


def _needed(condition: sp.Basic, what: str) -> Require:
    """A condition on parameters, with its sentence."""
    return Require(condition, Status.NOT_INITIALIZED, reason=about_parameters(what))


def _inequality(condition: sp.Basic) -> sp.Basic:
    """The condition with an equation as a positive comparison, which NaN fails."""
    return sp.Le(sp.Abs(condition.lhs - condition.rhs), 0) if isinstance(condition, sp.Eq) else condition


def _without_limits(joint: Joint) -> str:
    """The limits of an axis in words, for the case that none are given: see `windows`."""
    if joint.domain is not None:
        low, high = joint.domain
        return f"joint value {low:g} .. {high:g}" if high < float(LARGEST) else f"joint value {low:g} or more"
    if joint.pitch != 0 and joint.limit_range is not None:
        low, high = joint.limit_range
        return f"no limit, but {low:g} .. {high:g} while it has a pitch"
    return "no limit"
