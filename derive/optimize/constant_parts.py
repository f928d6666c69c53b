"""Constant parts: what an expression has of constants alone is computed once, under a name that says what it is.

    (a2 + effective_q3 - reach) * x / (s * s)    →  (a2_plus_effective_q3 - reach) * x / s_squared
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

import sympy as sp

from derive.ir.constants import (
    DEGREE,
    FREE_ANGLE,
    PLANE,
    ROUNDING,
    SHORTEST_LINK,
)
from derive.ir.names import Names
from derive.ir.passes import with_inputs
from derive.ir.primitives import (
    Atan2,
    Root,
)
from derive.ir.program import (
    Let,
    Output,
    Program,
    rewritten,
)
from derive.ir.symbols import (
    symbols_of,
)

_WORDS = {
    sp.Integer(1): "one",
    sp.Rational(1, 2): "half",
    FREE_ANGLE: "free_angle",
    ROUNDING: "rounding",
    SHORTEST_LINK: "shortest_link",
    PLANE: "plane",
}
_READABLE = re.compile(r"(?=.{1,50}$)[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")


def constant_parts(programs: Iterable[Program], constants: Iterable[str]) -> tuple[tuple[Program, ...], tuple[Let, ...]]:
    """The programs that read their constant parts by name, and the bindings of these, which read constants alone."""
    before = tuple(programs)
    parts = _Parts(frozenset(constants), {name.name for p in before for name in p.bound()})
    changed = [
        replace(
            p,
            body=tuple(rewritten(s, parts.taken) for s in p.body),
            outputs=tuple(Output(o.name, parts.taken(o.value)) for o in p.outputs),
        )
        for p in before
    ]
    return tuple(with_inputs(p) for p in changed), tuple(Let(name, value) for value, name in parts.names.items())


class _Parts:
    def __init__(self, constants: frozenset[str], taken: set[str]) -> None:
        self.constants = constants
        self.taken_names = Names(constants | taken)
        self.names: dict[sp.Expr, sp.Symbol] = {}

    def taken(self, value: sp.Basic) -> sp.Basic:
        """The expression with its constant parts by name."""
        if not value.args or not symbols_of(value):
            return value
        if self._is_constant(value):
            return self._named(value)
        if isinstance(value, sp.Add | sp.Mul):
            fixed = [a for a in value.args if self._is_constant(a)]
            others = [self.taken(a) for a in value.args if a not in fixed]
            if any(symbols_of(a) for a in fixed):
                return value.func(self._named(value.func(*fixed)), *others)
            return value.func(*fixed, *others)
        return value.func(*(self.taken(a) for a in value.args))

    def _is_constant(self, value: sp.Basic) -> bool:
        return isinstance(value, sp.Expr) and DEGREE not in value.free_symbols and (
            {s.name for s in symbols_of(value)} <= self.constants
        )

    def _named(self, value: sp.Expr) -> sp.Expr:
        has_name = value.is_Symbol or (-value).is_Symbol or (1 / value).is_Symbol
        if has_name or not isinstance(value, sp.Add | sp.Mul | sp.Pow | Atan2):
            return value
        if value.could_extract_minus_sign():
            return -self._named(-value)
        if value.is_Pow and value.exp < 0 or (value.is_Mul and all(f.as_base_exp()[1] < 0 for f in value.args)):
            return 1 / self._named(1 / value)
        if value not in self.names:
            said = words(value)
            self.names[value] = self.taken_names.fresh(said if _READABLE.match(said) else "constant_part")
        return self.names[value]


def words(value: sp.Expr) -> str:
    """An expression in words: `a2_plus_a3`, `a3_by_effective_q3`, `a2_squared`."""
    if value.is_Symbol:
        return str(value.name)
    if value.is_Number:
        return _WORDS.get(value, str(value).replace("/", "_by_"))
    if value.is_Pow and value.exp == 2:
        return f"{words(value.base)}_squared"
    if value.is_Add:
        terms = sorted(value.args, key=lambda t: (t.could_extract_minus_sign(), t.is_Number, str(t)))
        said = [("_minus_" if t.could_extract_minus_sign() else "_plus_") + words(without_sign(t)) for t in terms]
        return "".join(said).removeprefix("_plus_")
    if isinstance(value, Root):
        return f"root_of_{words(value.args[0])}"
    if value.is_Mul and value.args[0].is_Float and value.args[0] not in _WORDS:
        return f"share_of_{words(sp.Mul(*value.args[1:]))}"
    if value.is_Mul:
        above, below = value.as_numer_denom()
        factors = sorted(sp.Mul.make_args(above), key=lambda f: (f.is_Number, str(f)))
        text = "_times_".join(map(words, factors))
        return text if below == 1 else f"{text}_by_{'_by_'.join(words(f) for f in sp.Mul.make_args(below))}"
    if isinstance(value, Atan2):
        return f"angle_of_{words(value.args[1])}"
    return "constant_part"


def without_sign(term: sp.Expr) -> sp.Expr:
    """The term without its minus sign."""
    return -term if term.could_extract_minus_sign() else term
