"""Between which numbers the value of an integer expression lies, as far as the control variables of loops tell.

A test that cannot fail is left out of the translation: most indices of loops are inside their array by the bounds of
the loop.
"""

from itertools import product

from . import ast, constants
from . import st_types as types
from .facts import Facts

Interval = tuple[int | None, int | None]
"""The least and the largest value; None where it is not known."""
Known = dict[types.Variable, Interval]


def interval(node: ast.Expression, known: Known, facts: Facts, meaning: constants.Lookup) -> Interval:
    """The least and the largest value that an expression can have."""
    value = constants.evaluate(node, meaning)
    if isinstance(value, int):
        return value, value
    if isinstance(node, ast.Name):
        found = facts.meanings.get(node)
        return known.get(found, (None, None)) if isinstance(found, types.Variable) else (None, None)
    if isinstance(node, ast.Binary) and node.operator in ("+", "-", "*"):
        left, right = (interval(side, known, facts, meaning) for side in (node.left, node.right))
        return _combined(node.operator, left, right)
    return None, None


def _combined(operator: str, left: Interval, right: Interval) -> Interval:
    (a, b), (c, d) = left, right
    if operator == "+":
        return None if a is None or c is None else a + c, None if b is None or d is None else b + d
    if operator == "-":
        return None if a is None or d is None else a - d, None if b is None or c is None else b - c
    if a is None or b is None or c is None or d is None:
        return None, None
    ends = [one * other for one, other in product((a, b), (c, d))]
    return min(ends), max(ends)


def of_loop(start: Interval, stop: Interval, step: int) -> Interval:
    """The values that a control variable has in the body of its loop."""
    return (start[0], stop[1]) if step > 0 else (stop[0], start[1])


def is_written(variable: types.Variable, body: tuple[ast.Statement, ...], facts: Facts) -> bool:
    """Whether a statement assigns to a local variable, or a loop counts with it; one that is handed on by reference is
    boxed.
    """
    for statement in body:
        if isinstance(statement, ast.Assign | ast.For):
            target = statement.target if isinstance(statement, ast.Assign) else statement.control
            if facts.meanings.get(target) is variable:
                return True
        if any(is_written(variable, part, facts) for part in _bodies(statement)):
            return True
    return False


def _bodies(statement: ast.Statement) -> list[tuple[ast.Statement, ...]]:
    if isinstance(statement, ast.If | ast.Case):
        return [*(branch.body for branch in statement.branches), statement.otherwise]
    return [statement.body] if isinstance(statement, ast.For) else []
