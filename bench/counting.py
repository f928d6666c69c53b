"""Operations and calls of running Structured Text, by the function or method that did them."""

from __future__ import annotations

import ast
import math
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from tests.harness.library import Library, compile_st

FLOATING = ("additions", "multiplications", "divisions", "roots")
"""What counts as a floating operation; a subtraction is an addition, a comparison is none."""
_OPERATORS = {ast.Add: "additions", ast.Sub: "additions", ast.Mult: "multiplications", ast.Div: "divisions"}
_FUNCTIONS = {"sin": "trigonometric", "cos": "trigonometric", "atan": "trigonometric", "sqrt": "roots"}
_PREFIXES = "function_", "method_"
"""How the harness begins the names of what it translates."""


@dataclass
class Counts:
    """What has run so far."""

    operations: dict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    """By function or method, the operations of each kind that its own text did."""
    calls: Counter[str] = field(default_factory=Counter)
    """How often each was called; SIN, COS, SQRT, ATAN, conversions and SEL are part of the language."""
    running: list[Counter[str]] = field(default_factory=lambda: [Counter()])
    """The operations of the functions that are running, those of the innermost last."""

    def add(self, kind: str) -> None:
        """Count an operation of the function that is running."""
        self.running[-1][kind] += 1

    def floating(self, *without: str) -> int:
        """All floating operations, but those of some functions."""
        return sum(found[k] for name, found in self.operations.items() if name not in without for k in FLOATING)

    def of_kinds(self) -> Counter[str]:
        """The operations of each kind."""
        return sum(self.operations.values(), start=Counter())


COUNTS = Counts()


def counted(call: Callable[..., Any], *arguments: Any, **named: Any) -> tuple[Any, Counts]:
    """What a call returns, and what it did."""
    COUNTS.operations, COUNTS.calls = defaultdict(Counter), Counter()
    COUNTS.running = [COUNTS.operations[""]]
    result = call(*arguments, **named)
    return result, Counts({name: found for name, found in COUNTS.operations.items() if found}, COUNTS.calls)


def counting_library(texts: Mapping[str, str]) -> Library:
    """Texts, compiled by the harness of the tests so that they count."""
    return compile_st(texts, instrument=_instrumented)


def binary(kind: str, left: Any, right: Any, result: Any) -> Any:
    """Count an operation of two real numbers: indices and loop counters are integers."""
    if isinstance(left, float) and isinstance(right, float):
        COUNTS.add(kind)
    return result


def enter(name: str) -> None:
    """A function begins."""
    COUNTS.calls[name] += 1
    COUNTS.running.append(COUNTS.operations[name])


def leave() -> None:
    """A function ends."""
    COUNTS.running.pop()


class CountingMath:
    """The module `math`, counting."""

    def __getattr__(self, name: str) -> Any:
        function = getattr(math, name)
        if name not in _FUNCTIONS:
            return function

        def called(value: float) -> Any:
            COUNTS.add(_FUNCTIONS[name])
            return function(value)

        return called


class _Instrument(ast.NodeTransformer):
    """`left + right` → `_binary("additions", l := left, r := right, l + r)`, except in the harness's own tests of a
    result; the body of a function between `_enter` and `_leave`.
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
        bound = [ast.NamedExpr(ast.Name(n, ast.Store()), side) for n, side in zip(names, sides, strict=True)]
        left, right = (ast.Name(n, ast.Load()) for n in names)
        result = ast.BinOp(left, node.op, right)
        return ast.Call(ast.Name("_binary", ast.Load()), [ast.Constant(_OPERATORS[type(node.op)]), *bound, result], [])

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        """A function or method of the text, as one that counts its calls."""
        self.generic_visit(node)
        prefix = next((p for p in _PREFIXES if node.name.startswith(p)), None)
        if prefix is not None:
            first = ast.parse(f"_enter({node.name.removeprefix(prefix)!r})").body
            last = ast.parse("_leave()").body
            node.body = [*first, ast.Try(node.body, [], [], last)]
        return node


def _is_test(node: ast.BinOp) -> bool:
    """`(_t := result) - _t == 0.0` asks whether a result is finite."""
    return (
        isinstance(node.left, ast.NamedExpr)
        and isinstance(node.right, ast.Name)
        and node.left.target.id == node.right.id
    )


def _instrumented(source: str) -> ast.Module:
    tree: ast.Module = _Instrument().visit(ast.parse(source))
    names = "CountingMath as _CountingMath, binary as _binary, enter as _enter, leave as _leave"
    tree.body[:0] = ast.parse(f"from {__name__} import {names}\nmath = _CountingMath()\n").body
    return ast.fix_missing_locations(tree)
