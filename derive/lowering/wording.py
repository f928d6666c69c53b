"""Names for values without a name: `a2_plus_a3`, `x_by_reach`, `product_in_axis_a1`."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable

import sympy as sp

from derive.ir.constants import FREE_ANGLE, PLANE, ROUNDING, SHORTEST_LINK
from derive.ir.graph import PRODUCT, SUM, Node, Value
from derive.ir.primitives import Atan2, Root, ToReal

_WORDS = {
    sp.Integer(1): "one",
    sp.Rational(1, 2): "half",
    FREE_ANGLE: "free_angle",
    ROUNDING: "rounding",
    SHORTEST_LINK: "shortest_link",
    PLANE: "plane",
}
_MULTIPLES = {sp.Integer(2): "twice", sp.Rational(1, 2): "half"}
_READABLE = re.compile(r"(?=.{1,40}$)[a-z][a-z0-9]*(_[a-z0-9]+)*\Z")
_FUNCTIONS = {sp.sin: "sin", sp.cos: "cos", sp.Abs: "size", Root: "root", Atan2: "angle", ToReal: "real"}
_OPERATIONS = {**_FUNCTIONS, SUM: "sum", PRODUCT: "product"}
_OPERATION_IN = re.compile(r"\A(sin|cos|size|root|angle|real|sum|product|quotient|value)_in_")
"""The beginning of a name that was made from an operation; it is not repeated in further names."""

Called = Callable[[Node], sp.Expr | None]
"""The name of a node, with a minus sign where it is that of the negative."""


def name_for(value: Value, called: Called, reader: str) -> str:
    """Make a name from the formula of a value; if it is too long, from the operation and the reader of the value.

    called: the names of nodes; reader: the name of the value that reads it, "" if none has a name.
    """
    text = _words(value, called)
    if text is not None and _READABLE.match(text):
        return text
    return (
        f"{_operation(value.node)}_in_{_OPERATION_IN.sub('', reader)}" if reader else f"shared_{_operation(value.node)}"
    )


def _operation(node: Node) -> str:
    """The word for the operation that computes a value: a sum, a product, a quotient, a function; else "value"."""
    if node.head is PRODUCT and node.divisors:
        return "quotient"
    return _OPERATIONS.get(node.head, "value")


def _words(value: Value, called: Called) -> str | None:
    """A sum of names, a product of names, a function of a name; None for what would need parentheses."""
    node = value.node
    if node.head is SUM:
        signed = (Value(t.node, value.sign * t.sign * _sign(t.node, called)) for t in node.parts)
        terms = sorted(signed, key=lambda t: t.sign < 0)
        said_terms = [(t.sign, _factor(t.node, called)) for t in terms]
        if any(word is None for _, word in said_terms):
            return None
        return "".join(("_minus_" if sign < 0 else "_plus_") + str(word) for sign, word in said_terms).removeprefix(
            "_plus_"
        )
    return _factor(node, called)


def _sign(node: Node, called: Called) -> int:
    """The sign of a term; the name in it may be that of the negative."""
    own = called(node)
    if own is not None:
        return 1 if own.is_Symbol else -1
    return math.prod(_sign(n, called) for n in node.read) if node.head is PRODUCT else 1


def _factor(node: Node, called: Called) -> str | None:
    """The words of a term."""
    atom = _atom(node, called)
    if node.head is not PRODUCT or atom is not None:
        return atom
    above = sorted((f.node for f in node.parts), key=lambda n: n.is_number)
    if len(above) == 2 and above[1].head in _MULTIPLES and not node.divisors:
        word = _atom(above[0], called)
        return None if word is None else f"{_MULTIPLES[above[1].head]}_{word}"
    words, below = ([_power(f, times, called) for f, times in Counter(side).items()] for side in (above, node.divisors))
    if any(word is None for word in (*words, *below)):
        return None
    return "_by_".join(["_times_".join(map(str, words)) or "one", *map(str, below)])


def _power(node: Node, times: int, called: Called) -> str | None:
    """The words of a factor that occurs some number of times."""
    word = _atom(node, called)
    return word if word is None or times == 1 else f"{word}_squared" if times == 2 else None


def _atom(node: Node, called: Called) -> str | None:
    """The words of a factor."""
    own = called(node)
    if own is not None:
        return str(own if own.is_Symbol else -own)
    if node.head is PRODUCT and len(node.parts) == 2 and node.parts[0] == node.parts[1] and not node.divisors:
        inner = _atom(node.parts[0].node, called)
        return None if inner is None else f"{inner}_squared"
    if node.is_leaf:
        return _WORDS.get(node.head, str(node.head).replace("/", "_by_"))
    word = _FUNCTIONS.get(node.head)
    inner = None if word is None else _atom(node.parts[-1].node, called)
    return None if inner is None else f"{word}_of_{inner}"
