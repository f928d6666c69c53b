"""The refusals of inputs: each is kept as a text, which names the input and its allowed range.

A method of the base block checks a range or a pair of limits, in one statement for an input; the first refusal counts.
Other conditions stand behind these statements, where every number is known to be of reasonable size.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import sympy as sp

from derive.emit.braced import indented
from derive.emit.expression import is_size_test
from derive.emit.st.expression import StructuredText, literal
from derive.emit.st.layout import WIDTH, assigned, conjunction, quoted
from derive.emit.st.refusal import Refusal
from derive.equations.windows import Window
from derive.ir.constants import LARGEST, LEAST
from derive.ir.passes import plain
from derive.ir.program import Let, Program, Require

REFUSAL = "refusal"
"""The instance variable that holds the reason why Initialize refused."""
_BEHIND = (f"IF {REFUSAL} <> '' THEN", "  RETURN;", "END_IF")


_Called = tuple[str, tuple[str, ...]]
"""A method that checks, and its arguments."""


@dataclass(frozen=True)
class OfInputs(Refusal):
    """Writes refusals of inputs, which are kept as texts."""

    texts: Mapping[str, str]
    """The text of every refusal, by the sentence of its condition."""
    limits: Mapping[sp.Basic, tuple[Window, int]]
    """The pairs of limits, by the conditions on them, and the axes whose limits they are."""

    axes: Sequence[str]
    """The names of the axes."""

    def key(self, require: Require) -> object:
        """All successive conditions come together."""
        return None

    def note(self, require: Require) -> str:
        """No comment: the texts of the refusals say what is refused."""
        return ""

    def lines(self, requires: Sequence[Require], printer: StructuredText) -> list[str]:
        """The calls that check inputs, and other conditions in chains of ELSIF, each followed by RETURN where one of
        them has refused; behind the calls that read limits the limits of the machine, of which the last rule counts.
        """
        found: list[str] = []
        called = {require: self._called(require.condition, printer) for require in requires}
        last = max((k for k, r in enumerate(requires) if (called[r] or ("",))[0] == "ReadLimits"), default=-1)
        for is_call, group in groupby(enumerate(requires), lambda numbered: called[numbered[1]] is not None):
            numbers, alike = zip(*group, strict=True)
            for number, require in zip(numbers, alike, strict=True):
                first, *others = self._refusing(require, called[require], printer)
                found += [first if is_call or number == numbers[0] else f"ELS{first}", *others]
            found += [*([] if is_call else ["END_IF"]), *_BEHIND]
            found += _limits_of_machine(self.limits, self.axes, printer) if last in numbers else []
        return found

    def _refusing(self, require: Require, called: _Called | None, printer: StructuredText) -> list[str]:
        """The call, or the condition with what is done where it does not hold."""
        assert require.reason is not None
        text = quoted(self.texts[require.reason.subject.name])
        if called is not None:
            method, given = called
            head, tail = f"{method}({', '.join(given)},", f"{text});"
            return [f"{head} {tail}"] if len(head) + len(tail) < WIDTH else [head, f"    {tail}"]
        parts = [printer.print(part) for part in sp.ordered(sp.And.make_args(require.condition))]
        whole = f"  {REFUSAL} := {text};"
        refused = [whole] if len(whole) <= WIDTH else [f"  {REFUSAL} :=", f"    {text};"]
        return [*conjunction("IF NOT (", parts, ") THEN"), *refused]

    def _called(self, condition: sp.Basic, printer: StructuredText) -> _Called | None:
        """The method that checks the condition, and its arguments; None if no method checks it."""
        if condition in self.limits:
            window, axis = self.limits[condition]
            given = tuple(printer.names[name] for name in window.given)
            return ("ReadLimits", (str(axis), *given)) if window.is_axis else ("CheckPair", given)
        if (found := _range_of(condition)) is not None:
            symbol, low, high, is_open = found
            value = printer.name(symbol)
            if (low, high, is_open) == (-LARGEST, LARGEST, False):
                return "CheckNumber", (value,)
            if is_open:
                return ("CheckLength", (value, literal(float(high)))) if low == LEAST else None
            return "CheckSpan", (value, literal(float(low)), literal(float(high)))
        is_plain = len(condition.free_symbols) == 1 and all(map(_is_plain, sp.Or.make_args(condition)))
        return ("Check", (printer.print(condition),)) if is_plain else None


def _range_of(condition: sp.Basic) -> tuple[sp.Symbol, sp.Expr, sp.Expr, bool] | None:
    """The input of which a condition is the range, both ends, and whether the lower one is outside."""
    if is_size_test(condition):
        return condition.lhs.args[0], -LARGEST, LARGEST, False
    parts = {type(part): part for part in sp.And.make_args(condition) if _is_plain(part)}
    low = parts.get(sp.Ge, parts.get(sp.Gt))
    if len(sp.And.make_args(condition)) != 2 or low is None or sp.Le not in parts or low.lhs != parts[sp.Le].lhs:
        return None
    return low.lhs, low.rhs, parts[sp.Le].rhs, isinstance(low, sp.Gt)


def _is_plain(condition: sp.Basic) -> bool:
    """Whether a condition compares an input with a number."""
    return isinstance(condition, sp.Rel) and condition.lhs.is_Symbol and condition.rhs.is_number


def conditions_first(program: Program) -> Program:
    """The program with the conditions on inputs alone before all others, so that they stand together."""
    inputs = set(program.inputs)
    first = [s for s in program.body if isinstance(s, Require) and s.condition.free_symbols <= inputs]
    return replace(program, body=(*first, *(s for s in program.body if s not in first)))


def pairs_of_limits(program: Program, windows: Sequence[Window]) -> dict[sp.Basic, tuple[Window, int]]:
    """The pairs of limits, by the conditions on them, and the axes whose limits they are."""
    conditions = {s.condition for s in program.requires()}
    pairs = ((plain(window.ordered.condition), window, place) for place, window in enumerate(windows))
    return {condition: (window, place) for condition, window, place in pairs if condition in conditions}


def without_limits(program: Program, limits: Mapping[sp.Basic, tuple[Window, int]]) -> Program:
    """The program without the constants that the calls for pairs of limits write."""
    read = [window for window, _ in limits.values() if window.is_axis]
    names = {let.name.name for window in read for let in window.limits}
    outputs = {output.name for window in read for output in window.limit_outputs}
    return replace(
        program,
        body=tuple(s for s in program.body if not (isinstance(s, Let) and s.name.name in names)),
        outputs=tuple(o for o in program.outputs if o.name not in outputs),
    )


def _limits_of_machine(
    limits: Mapping[sp.Basic, tuple[Window, int]], axes: Sequence[str], printer: StructuredText
) -> list[str]:
    lines: list[str] = []
    for window, place in limits.values():
        axis = f"axes[{place}]"
        for condition, low, high in window.fallback[-1:]:
            needed = "" if condition == sp.true else f" AND ({printer.print(condition)})"
            values = (assigned(f"{axis}.{end}", printer.print(v)) for end, v in (("lower", low), ("upper", high)))
            lines += [
                f"// Without given limits, {axes[place]} has the limits of its mechanism",
                f"IF {axis}.unlimited{needed} THEN",
                *indented([*"\n".join(values).split("\n"), f"{axis}.unlimited := FALSE;"]),
                "END_IF",
            ]
    return lines
