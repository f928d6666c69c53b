"""A description with other symbols."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

import sympy as sp

from derive.description.dimensions import Parameter


def with_symbols(value: Any, symbols: Mapping[Any, sp.Expr]) -> Any:
    """A copy of nested data in which symbols are replaced."""
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return value.xreplace(symbols)
    if isinstance(value, tuple):
        return tuple(with_symbols(one, symbols) for one in value)
    if isinstance(value, Parameter) and value.symbol in symbols:
        symbol = symbols[value.symbol]
        return replace(value, symbol=symbol, name=symbol.name, given=value.given_name)
    if is_dataclass(value) and not isinstance(value, type):
        own = {f.name: getattr(value, f.name) for f in fields(value) if f.init}
        changed = {name: with_symbols(one, symbols) for name, one in own.items()}
        return replace(value, **changed)
    return value
