"""The number of operations of running Structured Text: the translated source counts each of them."""

from __future__ import annotations

import ast
import math
from collections import Counter
from collections.abc import Callable
from functools import cache
from typing import Any

from derive.description.mechanism import Mechanism
from derive.report.cost import Cost
from tests.harness.library import Library, compile_st
from tests.text.units import file_of, shared_texts, text_of

COUNTS: Counter[str] = Counter()
"""Operations so far, by the names of the fields of `Cost`."""

_OPERATORS = {ast.Add: "additions", ast.Sub: "additions", ast.Mult: "multiplications", ast.Div: "divisions"}
_FUNCTIONS = {"sin": "trigonometric", "cos": "trigonometric", "atan": "trigonometric", "sqrt": "roots"}


@cache
def counting_units(mechanism: Mechanism | None = None) -> Library:
    """The shared functions, with the unit of a mechanism if there is one, counting."""
    own = {} if mechanism is None else {file_of(mechanism): text_of(mechanism)}
    return compile_st({**shared_texts(), **own}, instrument=_instrumented)


def counted(call: Callable[..., Any], *arguments: Any, **named: Any) -> Cost:
    """What a call did."""
    COUNTS.clear()
    call(*arguments, **named)
    return Cost(**COUNTS)


def binary(kind: str, left: Any, right: Any, result: Any) -> Any:
    """Count an operation of two real numbers: indices and loop counters are integers."""
    if isinstance(left, float) and isinstance(right, float):
        COUNTS[kind] += 1
    return result


class CountingMath:
    """The module `math`, counting."""

    def __getattr__(self, name: str) -> Any:
        function = getattr(math, name)
        if name not in _FUNCTIONS:
            return function

        def called(value: float) -> Any:
            COUNTS[_FUNCTIONS[name]] += 1
            return function(value)

        return called


class _Instrument(ast.NodeTransformer):
    """`left + right` → `_binary("additions", l := left, r := right, l + r)`, except in the harness's own tests of a
    result.
    """

    def __init__(self) -> None:
        self.depth = 0

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        """An operation, as a call that counts it."""
        if _is_test(node) or type(node.op) not in _OPERATORS:
            return self.generic_visit(node)
        self.depth += 1
        names = f"_l{self.depth}", f"_r{self.depth}"
        sides = [self.visit(node.left), self.visit(node.right)]
        self.depth -= 1
        at = {name: getattr(node, name) for name in ("lineno", "col_offset", "end_lineno", "end_col_offset")}
        bound = [
            ast.NamedExpr(ast.Name(n, ast.Store(), **at), side, **at) for n, side in zip(names, sides, strict=True)
        ]
        left, right = (ast.Name(n, ast.Load(), **at) for n in names)
        kind = ast.Constant(_OPERATORS[type(node.op)], **at)
        result = ast.BinOp(left, node.op, right, **at)
        return ast.Call(ast.Name("_binary", ast.Load(), **at), [kind, *bound, result], [], **at)


def _is_test(node: ast.BinOp) -> bool:
    """`(_t := result) - _t == 0.0` asks whether a result is finite."""
    return (
        isinstance(node.left, ast.NamedExpr)
        and isinstance(node.right, ast.Name)
        and node.left.target.id == node.right.id
    )


def _instrumented(source: str) -> ast.Module:
    tree: ast.Module = _Instrument().visit(ast.parse(source))
    head = f"from {__name__} import CountingMath as _CountingMath, binary as _binary\nmath = _CountingMath()\n"
    tree.body[:0] = ast.parse(head).body
    return tree
