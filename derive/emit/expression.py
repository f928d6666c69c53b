"""Expressions as text: every language walks over an expression in the same way, and differs in spelling only.

So all languages evaluate in the same order, and their results agree to the last digit wherever their elementary
functions do.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import ClassVar

import sympy as sp
from sympy.core.relational import Relational

from derive.ir.constants import DEGREE, LARGEST
from derive.ir.primitives import KEYS, Atan2, Root, Select, ToReal, Wrap
from derive.ir.symbols import is_condition, is_count, is_decided

_OR, _AND, COMPARE, _SUM, PRODUCT, _UNARY, ATOM = range(7)


def is_never_negative(radicand: sp.Expr) -> bool:
    """Whether a root needs no check of its radicand: a number, or a sum of squares, never a negative zero."""
    if radicand.is_Number:
        return bool(radicand >= 0)
    return bool(radicand.is_Add) and all(term.is_Pow and term.exp == 2 for term in radicand.args)


def is_larger(expression: sp.Basic) -> bool:
    """Whether a choice takes the larger of two values."""
    if not isinstance(expression, Select):
        return False
    condition, first, second = expression.args
    return isinstance(condition, sp.Gt) and condition.args == (first, second)


class ExpressionPrinter(ABC):
    """Writes an expression in a language. Subclasses spell names, numbers, functions, choices and logical words."""

    functions: ClassVar[Mapping[str, str]] = {}
    """The functions of the language, by their neutral names (`KEYS`)."""
    shared_function: ClassVar[str] = "{snake}"
    """The name of any other function, from its neutral name as `snake_case`, `camelCase` or `CapWords`."""
    square_root: ClassVar[str] = "sqrt"
    """The root of what is never negative; empty if it is the same function as any root."""
    radian: ClassVar[str] = "RADIAN"
    """The degrees of a radian, by which the language multiplies; empty if it divides by `DEGREE` instead."""

    def name(self, symbol: sp.Symbol) -> str:
        """The spelling of a symbol."""
        return str(symbol.name)

    def number(self, value: float) -> str:
        """A real literal."""
        return repr(value)

    @abstractmethod
    def choice(self, condition: str, first: str, second: str) -> str:
        """The first or the second of two printed values."""

    def call(self, key: str, arguments: Sequence[str]) -> str:
        """A primitive, by its neutral name, applied to printed arguments."""
        return self.choice(*arguments) if key == "select" else f"{self.function(key)}({', '.join(arguments)})"

    @classmethod
    def function(cls, key: str) -> str:
        """The name of the function of a primitive."""
        words = "".join(word.capitalize() for word in key.split("_"))
        made = cls.shared_function.format(snake=key, camel=words[:1].lower() + words[1:], words=words)
        return cls.functions.get(key, made)

    def larger(self, first: str, second: str) -> str:
        """The larger of two printed numbers, the second where one is NaN; "" where it is written as a choice."""
        return ""

    def logic(self, word: str) -> str:
        """The spelling of "and", "or", "not", "true", "false"."""
        return word

    def comparison(self, operator: str) -> str:
        """The spelling of a comparison, given as Python has it."""
        return operator

    def value(self, name: sp.Symbol, value: sp.Basic) -> str:
        """A value as the type of its name is written: a whole number without a decimal point."""
        return self.whole(value) if is_count(name) else self.print(value)

    def whole(self, expression: sp.Basic) -> str:
        """A whole number as text."""
        return _Whole(self).print(expression)

    def factor(self, expression: sp.Basic) -> str:
        """A whole number as a factor of real numbers, converted where the language does not do this by itself."""
        return _Whole(self)._text(expression, ATOM)

    def print(self, expression: sp.Basic) -> str:
        """The expression as text."""
        return self._text(expression, _OR)

    def _text(self, node: sp.Basic, context: int) -> str:
        text, level = self._spell(node)
        return f"({text})" if level < context else text

    def _spell(self, node: sp.Basic) -> tuple[str, int]:
        if is_decided(node):
            return self.logic("true" if node == sp.true else "false"), ATOM
        if node == DEGREE or isinstance(node, sp.Symbol):
            return self.name(node), ATOM
        if isinstance(node, sp.Number):
            return self._number(node)
        if isinstance(node, sp.Add):
            return self._sum(node), _SUM
        if self.radian and node.is_Mul and 1 / DEGREE in node.args:
            return f"{self._text(node * DEGREE, PRODUCT)}*{self.radian}", PRODUCT
        if isinstance(node, sp.Mul | sp.Pow):
            return self._product(node)
        if isinstance(node, Relational):
            sides = _Whole(self) if any(map(_is_whole, node.args)) else self
            return (
                f"{sides._text(node.lhs, _SUM)} {self.comparison(node.rel_op)} {sides._text(node.rhs, _SUM)}",
                COMPARE,
            )
        if isinstance(node, sp.Not):
            return f"{self.logic('not')} {self._text(node.args[0], ATOM)}", COMPARE
        if isinstance(node, Wrap):
            (angle,) = node.args
            return self._spell(angle if isinstance(angle, Atan2) else Atan2(sp.sin(angle), sp.cos(angle)))
        if isinstance(node, ToReal):
            return self.factor(node.args[0]), ATOM
        if isinstance(node, sp.And):
            return self._joined(node, "and", COMPARE), _AND
        if isinstance(node, sp.Or):
            return self._joined(node, "or", _AND), _OR
        if is_larger(node) and (text := self.larger(*(self._text(a, _OR) for a in node.args[1:]))):
            return text, ATOM
        if self.square_root and isinstance(node, Root) and is_never_negative(node.args[0]):
            return f"{self.square_root}({self.print(node.args[0])})", ATOM
        return self.call(KEYS[type(node)], [self._text(a, _OR) for a in node.args]), ATOM

    def _joined(self, node: sp.Basic, word: str, context: int) -> str:
        # Comparisons stand in parentheses, so that a reader need not know their precedence.
        parts = [self._text(a, _OR) if a.is_Symbol else f"({self._text(a, _OR)})" for a in sp.ordered(node.args)]
        return f" {self.logic(word)} ".join(parts)

    def _number(self, node: sp.Number) -> tuple[str, int]:
        value = _plain(float(node))
        text = self.number(abs(value))
        return (f"-{text}", _UNARY) if value < 0 else (text, ATOM)

    def _sum(self, node: sp.Add) -> str:
        terms = terms_of(node)
        text = self._text(terms[0], _SUM)
        for term in terms[1:]:
            if is_negative(term):
                text += f" - {self._text(-term, PRODUCT)}"
            else:
                text += f" + {self._text(term, PRODUCT)}"
        return text

    def _product(self, node: sp.Expr) -> tuple[str, int]:
        coefficient, rest = node.as_coeff_Mul()
        above, below = _fraction(rest)
        numerator, denominator = abs(float(coefficient)), 1
        if isinstance(coefficient, sp.Rational) and coefficient.q not in (1, 2, 4, 8, 16):
            numerator, denominator = float(abs(coefficient.p)), coefficient.q
        head = [] if numerator == 1.0 and above else [self.number(_plain(numerator))]
        text = "*".join(head + [self._text(f, _UNARY) for f in above])
        bottom = ([] if denominator == 1 else [self.number(float(denominator))]) + [
            self._text(f, _UNARY) for f in below
        ]
        if bottom:
            text += "/" + (bottom[0] if len(bottom) == 1 else f"({'*'.join(bottom)})")
        return (f"-{text}", _SUM) if coefficient.is_negative else (text, PRODUCT)


def _plain(value: float) -> float:
    """The number with fifteen digits where the remaining ones are rounding: 1e-22, not 9.999999999999999e-23."""
    short = float(f"{value:.15g}")
    return short if abs(short - value) <= abs(value) * 2.3e-16 else value


class _Whole(ExpressionPrinter):
    """Writes whole numbers in a language, and choices among them."""

    def __init__(self, language: ExpressionPrinter) -> None:
        self.language = language

    def name(self, symbol: sp.Symbol) -> str:
        return self.language.name(symbol)

    def number(self, value: float) -> str:
        return str(int(value))

    def choice(self, condition: str, first: str, second: str) -> str:
        return self.language.choice(condition, first, second)

    def call(self, key: str, arguments: Sequence[str]) -> str:
        return self.language.call(key, arguments)

    def logic(self, word: str) -> str:
        return self.language.logic(word)

    def _spell(self, node: sp.Basic) -> tuple[str, int]:
        return self.language._spell(node) if is_condition(node) else super()._spell(node)


def _is_whole(node: sp.Basic) -> bool:
    """Whether an expression is a whole number because all names and numbers in it are."""
    return bool(node.free_symbols) and all(map(is_count, node.free_symbols)) and not node.has(ToReal, sp.Float)


@cache
def terms_of(node: sp.Add) -> tuple[sp.Expr, ...]:
    """The terms of a sum in the order in which they are written; those that rank alike stay in the order of SymPy."""
    orders = {_term_order(term) for term in node.args}
    terms = node.args if len(orders) == len(node.args) else node.as_ordered_terms()  # which takes long
    return tuple(sorted(terms, key=_term_order))


@cache
def is_negative(term: sp.Expr) -> bool:
    return bool(term.could_extract_minus_sign()) if not term.is_Add else False


def _term_order(term: sp.Expr) -> tuple[bool, int]:
    """Positive terms first, then the shorter: `link_length_1 + link_length_2*cos_a2`."""
    return is_negative(term), sum(len(side) for side in _fraction(term.as_coeff_Mul()[1]))


@cache
def factor_order(factor: sp.Expr) -> tuple[bool, str]:
    """The sort key of a factor: sines and cosines come last, as in a textbook."""
    name = factor.name if isinstance(factor, sp.Symbol) else str(factor)
    return name.startswith(("sin_", "cos_", "Sin", "Cos")), name


@cache
def _fraction(node: sp.Expr) -> tuple[tuple[sp.Expr, ...], tuple[sp.Expr, ...]]:
    """The factors of numerator and denominator, with integer powers written out."""
    above: list[sp.Expr] = []
    below: list[sp.Expr] = []
    factors = sp.Mul.make_args(node)
    for factor in sorted(factors, key=factor_order) if len(factors) > 1 else factors:
        base, exponent = factor.as_base_exp()
        if isinstance(factor, sp.Pow):
            side = above if exponent.is_positive else below
            side.extend([base] * abs(int(exponent)))
        elif factor is not sp.S.One:
            above.append(factor)
    return tuple(above), tuple(below)


def parts_of(conditions: Iterable[sp.Basic]) -> list[sp.Basic]:
    """Conditions that must all hold, without an "and" in any of them."""
    return [p for c in conditions for p in (sp.ordered(c.args) if isinstance(c, sp.And) else [c])]


def is_size_test(condition: sp.Basic) -> bool:
    """Whether a condition tests that an input is a number of reasonable size."""
    if not isinstance(condition, sp.Le) or condition.rhs != LARGEST or not isinstance(condition.lhs, sp.Abs):
        return False
    return bool(condition.lhs.args[0].is_Symbol)


def magnitude_tests(conditions: Iterable[sp.Basic], least: int = 2) -> list[sp.Expr]:
    """The values, if the conditions test nothing but the size of this many values or more; else none."""
    parts = parts_of(conditions)
    return [part.lhs.args[0] for part in parts] if len(parts) >= least and all(map(is_size_test, parts)) else []
