"""Values known from the text alone: array bounds, CASE labels, sizes, initial values of constants."""

from collections.abc import Callable

from . import ast
from . import st_types as types
from .faults import StError

Value = bool | int | float | str | types.EnumMember
Lookup = Callable[[ast.Expression], types.Meaning | None]


def evaluate(node: ast.Expression, meaning: Lookup) -> Value | None:
    """The value of a constant expression, or None when it is none."""
    if isinstance(node, ast.Literal):
        return node.value
    if isinstance(node, ast.Unary) and node.operator == "-":
        value = evaluate(node.operand, meaning)
        return -value if isinstance(value, (int, float)) else None
    if isinstance(node, ast.Binary):
        return _binary(node, meaning)
    if isinstance(node, (ast.Name, ast.Member)):
        found = meaning(node)
        if isinstance(found, types.EnumMember):
            return found
        if isinstance(found, types.Variable) and found.constant and not found.is_reference and found.initial:
            return evaluate(found.initial, meaning)
    return None


def _binary(node: ast.Binary, meaning: Lookup) -> Value | None:
    left, right = evaluate(node.left, meaning), evaluate(node.right, meaning)
    if not isinstance(left, (int, float)) or not isinstance(right, (int, float)):
        return None
    if node.operator == "+":
        return left + right
    if node.operator == "-":
        return left - right
    return left * right if node.operator == "*" else None


def whole(node: ast.Expression, meaning: Lookup) -> int:
    value = evaluate(node, meaning)
    if not isinstance(value, int) or isinstance(value, bool):
        raise StError(node.at, "an integer constant is needed here")
    return value
