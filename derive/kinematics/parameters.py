"""All inputs of a machine, and the setup program that checks them and computes what depends on them alone.

Where a controller hands over the limits of its drives, `limits_of_axis` narrows those of the machine by them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

import sympy as sp

from derive.description.mechanism import Joint, Mechanism, Parameter, Role, rotary
from derive.equations.choices import converted, input_of
from derive.ir.constants import (
    LARGEST,
    LIMIT,
    ONE_TURN,
    TIE_SHARE,
    UNLIMITED,
)
from derive.ir.passes import renamed, without_assumptions
from derive.ir.primitives import (
    Select,
    ToReal,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
    Require,
    Statement,
    Status,
    rewritten,
)
from derive.ir.reason import Why, about_input, about_parameters
from derive.ir.symbols import (
    MIN_TYPE2_MARGIN,
    SCALE,
    called,
    flag,
    is_count,
    real,
)
from derive.ir.verify import verify
from derive.plate.plate import machine_constants, machine_statements

CHECK_LIMITS = "check_limits"
TIE_OF_LENGTHS = real("tie")
"""Squared distances of linear axes that differ by less than this are equal."""
_LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH)


def machine_parameters(mechanism: Mechanism) -> tuple[Parameter, ...]:
    """The description's parameters, then offset and limits of every axis and of every limited quantity."""
    parameters = list(mechanism.parameters)
    for joint in mechanism.joints:
        parameters.append(_number(joint, "offset", "axis value at the kinematic zero position", joint.offset_range))
    for joint in mechanism.joints:
        for word in ("lower", "upper"):
            meaning = f"{word} limit of the axis, both 0: {_without_limits(joint)}"
            parameters.append(_number(joint, word, meaning, joint.limit_range))
    for quantity in mechanism.limited:
        unit = "deg" if quantity.is_angle else "u"
        for word in ("lower", "upper"):
            meaning = f"{word} limit of {quantity.meaning}, both 0: no limit"
            parameters.append(_setting(f"{word}_{quantity.name}", meaning, unit, None))
    parameters += _assembly_parameters(mechanism)
    check = Parameter(
        flag(CHECK_LIMITS), CHECK_LIMITS, Role.FLAG, "inverse kinematics tests the limits", "", 0.0, 1.0, False, 1.0, 1.0
    )
    return (*parameters, check)


def _assembly_parameters(mechanism: Mechanism) -> list[Parameter]:
    """The assembly mode of a closed loop, and its least distance from a type 2 singularity."""
    if mechanism.is_platform:
        return [_least_margin()]
    if mechanism.assembly is None:
        return []
    name, chosen = mechanism.assembly.parameter, mechanism.assembly.names[1]
    meaning = f"assembly mode: {chosen} instead of {mechanism.assembly.names[0]}"
    return [
        Parameter(real(name), name, Role.FLAG, meaning, "", 0.0, 1.0, False, 0.0, 0.0),
        _least_margin(),
    ]


def _least_margin() -> Parameter:
    meaning = "least distance from a type 2 singularity, a number without a unit; 0: off"
    return Parameter(real(MIN_TYPE2_MARGIN), MIN_TYPE2_MARGIN, Role.RATIO, meaning, "1", 0.0, 1.0, False, 1e-3, 1e-3)


def _number(joint: Joint, word: str, meaning: str, interval: tuple[float, float] | None) -> Parameter:
    unit = "deg" if joint.is_angle else "u"
    return _setting(f"{word}_{joint.key}", f"{joint.name}: {meaning}", unit, interval)


def _setting(name: str, meaning: str, unit: str, interval: tuple[float, float] | None) -> Parameter:
    low, high = interval or (-1e9, 1e9)
    role = Role.ANGLE if unit == "deg" else Role.DISTANCE
    return Parameter(real(name), name, role, meaning, unit, low, high, False, 0.0, 0.0)


def setup_program(
    mechanism: Mechanism,
    parameters: tuple[Parameter, ...],
    hoisted: tuple[Let, ...] = (),
    read: Collection[sp.Symbol] = (),
    *,
    has_settings: bool = False,
) -> Program:
    """Check every parameter; the outputs are the parameters, the effective limits, and the hoisted values that are `read`.

    has_settings: drives hand over limits, so that the outputs of `limits_of_axis` are left to it.
    """
    body: list[Statement] = [condition for p in parameters for condition in _range_of(p)]
    for constraint in mechanism.constraints:
        body += constraint.steps
        body.append(_needed(_inequality(constraint.condition), constraint.message))
    ends = {o.name for key in limited_keys(mechanism) for o in _limit_outputs(key)}
    outputs = [_as_constant(p) for p in parameters if p.name not in ends]
    for joint in mechanism.joints:
        body += [_ordered(joint.key), *_limits(joint.key, _fallback(joint))]
        outputs += _limit_outputs(joint.key)
        if not has_settings:
            body += [*_widened(joint.key), *_turn_window(joint)]
            outputs += _window_outputs(joint.key, has_turns=joint.multi_turn)
    for quantity in mechanism.limited:
        body += [_ordered(quantity.name), *_limits(quantity.name, ()), *_widened(quantity.name)]
        outputs += [*_limit_outputs(quantity.name), *_window_outputs(quantity.name, has_turns=False)]
    if mechanism.is_platform:
        body += machine_statements(mechanism)
        outputs += machine_constants(mechanism)
    else:
        body.append(Let(SCALE, machine_scale(parameters), "characteristic length of the machine"))
        outputs.append(Output(SCALE.name, SCALE))
    if chooses_by_lengths(mechanism):
        body.append(Let(TIE_OF_LENGTHS, TIE_SHARE**2 * SCALE**2, "squared distances closer than this are equal"))
        outputs.append(Output(TIE_OF_LENGTHS.name, TIE_OF_LENGTHS))
    body += hoisted
    outputs += [Output(let.name.name, let.name) for let in hoisted if let.name in read]
    inputs = tuple(input_of(p) for p in parameters)
    typed = tuple(converted(s, parameters) for s in without_assumptions(body))
    return verify(Program("setup", inputs, typed, tuple(outputs)))


def _as_constant(parameter: Parameter) -> Output:
    """The parameter as other programs read it: a sign is a real number, which multiplies."""
    own = input_of(parameter)
    return Output(parameter.name, ToReal(own) if is_count(own) else own)


def limited_keys(mechanism: Mechanism) -> tuple[str, ...]:
    """The keys of the axes and quantities with limits: the last part of the names of these limits."""
    return (*(joint.key for joint in mechanism.joints), *(quantity.name for quantity in mechanism.limited))


def chooses_by_lengths(mechanism: Mechanism) -> bool:
    """Whether the distance of a branch to the reference is measured by linear axes alone."""
    return bool(mechanism.branches) and not any(j.is_angle for j in mechanism.joints)


def machine_scale(parameters: Sequence[Parameter]) -> sp.Expr:
    """The sum of the lengths of the description; one unit of length where there is none."""
    own = [p for p in parameters if p.role in _LENGTHS or (p.role is Role.DISTANCE and p.symbol.is_nonnegative)]
    return sp.Add(*[sp.Abs(p.symbol) for p in own]) if has_length(parameters) else sp.Integer(1)


def has_length(parameters: Iterable[Parameter]) -> bool:
    """Whether a machine has a length that is never zero, by which others can be divided."""
    return any(p.role in _LENGTHS for p in parameters)


def _range_of(parameter: Parameter) -> tuple[Require, ...]:
    note = f"{parameter.name}: {parameter.meaning}"
    if parameter.role is Role.FLAG:
        return ()
    if parameter.role is Role.SIGN:
        condition = sp.Or(sp.Eq(input_of(parameter), 1), sp.Eq(input_of(parameter), -1))
        return (_needed(condition, note),)
    value = real(parameter.name)  # without assumptions: SymPy must not decide `length > 0` by itself
    low = sp.Float(parameter.low) if parameter.low % 1 else sp.Integer(int(parameter.low))
    high = sp.Float(parameter.high) if parameter.high % 1 else sp.Integer(int(parameter.high))
    if parameter.role is Role.SIGNED_LENGTH:
        nonzero = sp.Or(sp.Gt(value, 0), sp.Lt(value, 0))  # NaN fails a comparison; the absolute value of NaN is an error
        inside = sp.And(nonzero, sp.Ge(value, low), sp.Le(value, min(high, LARGEST)))
        return (_needed(inside, note),)
    above = sp.Gt(value, low) if parameter.low_open else sp.Ge(value, low)
    return (_needed(sp.And(above, sp.Le(value, min(high, LARGEST))), note),)


def _needed(condition: sp.Basic, what: str) -> Require:
    """A condition on parameters, with its sentence."""
    return Require(condition, Status.NOT_INITIALIZED, reason=about_parameters(what))


def _inequality(condition: sp.Basic) -> sp.Basic:
    """The condition with an equation as a positive comparison, which NaN fails."""
    return sp.Le(sp.Abs(condition.lhs - condition.rhs), 0) if isinstance(condition, sp.Eq) else condition


def _ordered(key: str) -> Require:
    lower, upper = real(f"lower_{key}"), real(f"upper_{key}")
    condition = sp.Or(sp.Lt(lower, upper), sp.Le(sp.Abs(lower) + sp.Abs(upper), 0))
    return _needed(condition, f"lower_{key} below upper_{key}, or both 0")


Fallback = tuple[tuple[sp.Basic, sp.Expr, sp.Expr], ...]


def _fallback(joint: Joint) -> Fallback:
    """(condition, lower, upper) where no limit is given: the range of an axis with a pitch, or the domain of its joint."""
    found: list[tuple[sp.Basic, sp.Expr, sp.Expr]] = []
    if joint.pitch != 0 and joint.limit_range is not None:
        low, high = (sp.Integer(int(v)) for v in joint.limit_range)
        found.append((sp.Gt(sp.Abs(joint.pitch), 0), low, high))
    if joint.domain is not None:
        low, high = (sp.Integer(int(v)) + joint.offset for v in joint.domain)
        found.append((sp.true, low, high))
    return tuple(found)


def _without_limits(joint: Joint) -> str:
    """The limits of an axis for which none are given, in words: see `_fallback`."""
    if joint.domain is not None:
        low, high = joint.domain
        return f"joint value {low:g} .. {high:g}" if high < float(LARGEST) else f"joint value {low:g} or more"
    if joint.pitch != 0 and joint.limit_range is not None:
        low, high = joint.limit_range
        return f"no limit, but {low:g} .. {high:g} while it has a pitch"
    return "no limit"


def _limits(key: str, fallback: Fallback) -> tuple[Let, ...]:
    lower, upper = real(f"lower_{key}"), real(f"upper_{key}")
    low, high, unlimited = _effective(key)
    low_value, high_value, without = lower, upper, sp.Le(sp.Abs(lower) + sp.Abs(upper), 0)
    for condition, bottom, top in fallback:
        given = sp.Gt(sp.Abs(lower) + sp.Abs(upper), 0)
        low_value = Select(given, lower, Select(condition, bottom, sp.Integer(0)) if condition != sp.true else bottom)
        high_value = Select(given, upper, Select(condition, top, sp.Integer(0)) if condition != sp.true else top)
        without = sp.And(without, sp.Not(condition))
    return (
        Let(unlimited, without, f"{key}: whether it has no limits"),
        Let(low, low_value),
        Let(high, high_value),
    )


def _effective(key: str) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
    """The names of the lower limit, of the upper limit, and of the flag that there is none."""
    return real(f"effective_lower_{key}"), real(f"effective_upper_{key}"), flag(f"unlimited_{key}")


def _widened(key: str) -> tuple[Let, ...]:
    """The ends that are tested: the limits with their tolerance."""
    low, high, unlimited = _effective(key)
    tolerance = real(f"tolerance_{key}")
    return (
        Let(tolerance, LIMIT * (1 + sp.Abs(low) + sp.Abs(high))),
        Let(real(f"lowest_{key}"), Select(unlimited, -UNLIMITED, low - tolerance)),
        Let(real(f"highest_{key}"), Select(unlimited, UNLIMITED, high + tolerance)),
    )


def _limit_outputs(key: str) -> list[Output]:
    return [
        Output(f"lower_{key}", real(f"effective_lower_{key}")),
        Output(f"upper_{key}", real(f"effective_upper_{key}")),
        Output(f"unlimited_{key}", flag(f"unlimited_{key}")),
    ]


def windows(mechanism: Mechanism) -> frozenset[str]:
    """The names of the constants that say where an axis may be: its widened limits, and the turn inside them."""
    found = [o for j in mechanism.joints for o in _window_outputs(j.key, has_turns=j.multi_turn)]
    found += [o for quantity in mechanism.limited for o in _window_outputs(quantity.name, has_turns=False)]
    return frozenset(o.name for o in found)


def _window_outputs(key: str, *, has_turns: bool) -> list[Output]:
    words = ("lowest", "highest", "single", "mid") if has_turns else ("lowest", "highest")
    named = {"single": flag}
    return [Output(f"{word}_{key}", named.get(word, real)(f"{word}_{key}")) for word in words]


def _turn_window(joint: Joint) -> tuple[Let, ...]:
    """Whether at most one value of the axis is inside its limits, with a gap that no step crosses; the middle of its limits."""
    if not joint.multi_turn:
        return ()
    low, high, unlimited = _effective(joint.key)
    one_turn = sp.And(sp.Not(unlimited), sp.Le(high - low, ONE_TURN + real(f"tolerance_{joint.key}")))
    return (
        Let(flag(f"single_{joint.key}"), one_turn, "at most one turn is inside the limits"),
        Let(real(f"mid_{joint.key}"), (low + high) / 2),
    )


def limits_of_axis() -> Program:
    """The limits of an axis of the machine and those of its drive together, for any axis.

    own_unlimited own_lower own_upper, drive_limited drive_lower drive_upper → lowest highest single middle: both ends with
    their tolerance, whether at most one turn is inside, and the middle. A drive that has handed over nothing has no limits:
    `drive_limited` is false, and its ends are not read.
    """
    axis = rotary("axis", "any axis")
    low, high, unlimited = _effective(axis.key)
    own_unlimited, own_lower, own_upper = flag("own_unlimited"), real("own_lower"), real("own_upper")
    drive_limited, drive_lower, drive_upper = flag("drive_limited"), real("drive_lower"), real("drive_upper")
    own_low, own_high = real("own_low"), real("own_high")
    body: tuple[Statement, ...] = (
        Require(
            sp.Or(sp.Not(drive_limited), sp.Le(drive_lower, drive_upper)),
            Status.BAD_INPUT,
            reason=about_input(Why.DRIVE_LIMITS_CROSSED),
        ),
        Let(own_low, Select(own_unlimited, -LARGEST, own_lower), "own limits; without any, the largest axis value"),
        Let(own_high, Select(own_unlimited, LARGEST, own_upper)),
        Let(low, Select(sp.And(drive_limited, sp.Gt(drive_lower, own_low)), drive_lower, own_low), "the narrower of both limits"),
        Let(high, Select(sp.And(drive_limited, sp.Lt(drive_upper, own_high)), drive_upper, own_high)),
        Require(sp.Le(low, high), Status.NOT_INITIALIZED, reason=about_input(Why.NO_AXIS_VALUE)),
        Let(unlimited, sp.And(sp.Not(drive_limited), own_unlimited)),
        *_widened(axis.key),
        *_turn_window(axis),
    )
    plain = {called(f"{word}_{axis.key}", like): called(name, like) for word, (name, like) in _OF_ANY_AXIS.items()}
    named = tuple(renamed(rewritten(s, lambda e: e.xreplace(plain)), lambda name: plain.get(name, name)) for s in body)
    outputs = (*(Output(name, real(name)) for name in ("lowest", "highest")), Output("single", flag("single")))
    outputs = (*outputs, Output("middle", real("middle")))
    inputs = (own_unlimited, own_lower, own_upper, drive_limited, drive_lower, drive_upper)
    return verify(Program("limits_of_axis", inputs, named, outputs))


_REAL, _FLAG = real("any_number"), flag("any_flag")
_OF_ANY_AXIS = {
    "effective_lower": ("lower_end", _REAL), "effective_upper": ("upper_end", _REAL), "unlimited": ("unlimited", _FLAG),
    "tolerance": ("tolerance", _REAL), "lowest": ("lowest", _REAL), "highest": ("highest", _REAL), "single": ("single", _FLAG),
    "mid": ("middle", _REAL),
}  # fmt: skip
"""The names of the limits of an axis, where no axis is named."""
