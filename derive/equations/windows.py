"""The range of every axis: the part of the setup program that computes constants from its limits.

Where a controller hands over the limits of its drives, `limits_of_axis` narrows those of the machine by them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from derive.description.mechanism import Joint, Mechanism, rotary
from derive.ir.constants import GEARED_TURN, LARGEST, LIMIT, ONE_TURN
from derive.ir.passes import plain, renamed
from derive.ir.primitives import Select
from derive.ir.program import Let, Output, Program, Require, Statement, Status, rewritten
from derive.ir.reason import Reason, Why, about_input, about_parameters
from derive.ir.symbols import called, compared, flag, real
from derive.ir.verify import verify
from derive.kept import kept_by_identity

Fallback = tuple[tuple[sp.Basic, sp.Expr, sp.Expr], ...]
"""(condition, lower, upper) for the case that no limit is given; only the last one counts."""


@dataclass(frozen=True)
class Window:
    """The range of an axis or of a limited quantity. `key` is the last part of the names of its limits."""

    key: str
    fallback: Fallback = ()
    has_turns: bool = False
    is_axis: bool = False
    turns: sp.Expr = sp.Integer(1)
    """The turns of the joint per turn of the axis."""

    @property
    def given(self) -> tuple[str, str]:
        """The names of the parameters: the lower and the upper limit."""
        return f"lower_{self.key}", f"upper_{self.key}"

    @property
    def refusal(self) -> Reason:
        """The reason why parameters are refused that are no limits."""
        return about_parameters(f"lower_{self.key} below upper_{self.key}, or both 0")

    @cached_property
    def ordered(self) -> Require:
        """The condition that the parameters are limits."""
        lower, upper = map(real, self.given)
        condition = sp.Or(compared(sp.Lt, lower, upper), compared(sp.Le, sp.Abs(lower) + sp.Abs(upper), 0))
        return Require(condition, Status.NOT_INITIALIZED, reason=self.refusal)

    @cached_property
    def limits(self) -> tuple[Let, ...]:
        """The limits in force, whether they were given or not."""
        lower, upper = map(real, self.given)
        low, high, unlimited = self._effective
        low_value, high_value, free = lower, upper, compared(sp.Le, sp.Abs(lower) + sp.Abs(upper), 0)
        for condition, bottom, top in self.fallback:
            given = compared(sp.Gt, sp.Abs(lower) + sp.Abs(upper), 0)
            low_value = Select(
                given, lower, Select(condition, bottom, sp.Integer(0)) if condition != sp.true else bottom
            )
            high_value = Select(given, upper, Select(condition, top, sp.Integer(0)) if condition != sp.true else top)
            free = sp.And(free, sp.Not(condition))
        return (
            Let(unlimited, free, f"{self.key}: whether it has no limits"),
            Let(low, low_value),
            Let(high, high_value),
        )

    @property
    def limit_outputs(self) -> list[Output]:
        """The limits in force, as constants."""
        low, high, unlimited = self._effective
        names = (*self.given, f"unlimited_{self.key}")
        return [Output(name, value) for name, value in zip(names, (low, high, unlimited), strict=True)]

    @cached_property
    def ends(self) -> tuple[Let, ...]:
        """The ends that are tested, which are the limits widened by their tolerance. For an axis with periods also the
        values that choose one: whether at most one value of the axis lies inside its limits, with a gap that no step
        crosses, and the middle of its range.
        """
        low, high, unlimited = self._effective
        tolerance = real(f"tolerance_{self.key}")
        widened = (
            Let(tolerance, LIMIT * (1 + sp.Abs(low) + sp.Abs(high))),
            Let(real(f"lowest_{self.key}"), Select(unlimited, -LARGEST, low - tolerance)),
            Let(real(f"highest_{self.key}"), Select(unlimited, LARGEST, high + tolerance)),
        )
        if not self.has_turns:
            return widened
        one_turn = sp.And(sp.Not(unlimited), compared(sp.Le, high - low, ONE_TURN + tolerance))
        if self.turns != 1:
            lowest, highest = (real(f"{word}_{self.key}") for word in ("lowest", "highest"))
            one_turn = sp.And(sp.Lt(highest, LARGEST), sp.Le((highest - lowest) * self.turns, GEARED_TURN))
        return (
            *widened,
            Let(flag(f"single_{self.key}"), one_turn, "at most one turn is inside the limits"),
            Let(real(f"mid_{self.key}"), (low + high) / 2),
        )

    @property
    def outputs(self) -> list[Output]:
        """The values of `ends`, as constants."""
        words = ("lowest", "highest", "single", "mid") if self.has_turns else ("lowest", "highest")
        named = {"single": flag}
        return [Output(f"{word}_{self.key}", named.get(word, real)(f"{word}_{self.key}")) for word in words]

    @property
    def _effective(self) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
        """The names of the lower and the upper limit, and of whether there is none."""
        return real(f"effective_lower_{self.key}"), real(f"effective_upper_{self.key}"), flag(f"unlimited_{self.key}")


@kept_by_identity(10)
def windows(mechanism: Mechanism) -> tuple[Window, ...]:
    """The windows of all axes, then of all limited quantities."""
    axes = (Window(j.key, _fallback(j), has_turns=j.multi_turn, is_axis=True, turns=j.turns) for j in mechanism.joints)
    return (*axes, *(Window(quantity.name) for quantity in mechanism.limited))


def _fallback(joint: Joint) -> Fallback:
    """The limits where none is given: those of a helical joint, or the range that the closure allows."""
    found: list[tuple[sp.Basic, sp.Expr, sp.Expr]] = []
    if joint.pitch != 0 and joint.limit_range is not None:
        low, high = (sp.Integer(int(v)) for v in joint.limit_range)
        found.append((plain(sp.Gt(sp.Abs(joint.pitch), 0)), low, high))
    if joint.domain is not None:
        low, high = (plain(sp.Integer(int(v)) + joint.offset) for v in joint.domain)
        found.append((sp.true, low, high))
    return tuple(found)


def limits_of_axis() -> Program:
    """The limits of an axis of the machine and those of its drive together, for any axis.

    own_unlimited own_lower own_upper, drive_limited drive_lower drive_upper → lowest highest single middle: both ends
    with their tolerance, whether at most one turn is inside, and the middle. A drive that has reported nothing has
    no limits: `drive_limited` is false, and its ends are not read.
    """
    axis = rotary("axis", "any axis")
    window = Window(axis.key, has_turns=axis.multi_turn, is_axis=True)
    unlimited, low, high = (let.name for let in window.limits)
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
        Let(
            low,
            Select(sp.And(drive_limited, sp.Gt(drive_lower, own_low)), drive_lower, own_low),
            "the narrower of both limits",
        ),
        Let(high, Select(sp.And(drive_limited, sp.Lt(drive_upper, own_high)), drive_upper, own_high)),
        Require(sp.Le(low, high), Status.NOT_INITIALIZED, reason=about_input(Why.NO_AXIS_VALUE)),
        Let(unlimited, sp.And(sp.Not(drive_limited), own_unlimited)),
        *window.ends,
    )
    general = {called(f"{word}_{axis.key}", like): called(name, like) for word, (name, like) in _OF_ANY_AXIS.items()}
    named = tuple(
        renamed(rewritten(s, lambda e: e.xreplace(general)), lambda name: general.get(name, name)) for s in body
    )
    outputs = (*(Output(name, real(name)) for name in ("lowest", "highest")), Output("single", flag("single")))
    outputs = (*outputs, Output("middle", real("middle")))
    inputs = (own_unlimited, own_lower, own_upper, drive_limited, drive_lower, drive_upper)
    return verify(Program("limits_of_axis", inputs, named, outputs))


_REAL, _FLAG = real("any_number"), flag("any_flag")
_OF_ANY_AXIS = {
    "effective_lower": ("lower_end", _REAL), "effective_upper": ("upper_end", _REAL), "unlimited": ("unlimited", _FLAG),
    "tolerance": ("tolerance", _REAL), "lowest": ("lowest", _REAL), "highest": ("highest", _REAL),
    "single": ("single", _FLAG),
    "mid": ("middle", _REAL),
}  # fmt: skip
"""The names of the limits of an axis in a program that serves every axis."""
