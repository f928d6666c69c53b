"""Expressions in presentation MathML, in the order in which the code has them; long ones in several lines.

An expression is written as a row of tokens. A fraction, a root and a power are one token while they are short; where
they would not fit into a line they are written with `/`, `√( )` and `( )²`, so that a line can break at any operator.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from typing import TypeAlias

import sympy as sp
from markupsafe import Markup
from sympy.core.relational import Relational

from derive.emit.expression import factor_order, is_negative, terms_of
from derive.ir.constants import DEGREE
from derive.ir.primitives import Root, ToReal
from derive.ir.symbols import is_decided

WIDTH = 108
"""The most letters of a line."""
_SHORT = 46
"""The most letters of a fraction or a root that is written as one."""
_OR, _AND, _COMPARE, _SUM, _PRODUCT, _ATOM = range(6)
_RELATIONS = {"==": "=", "!=": "≠", "<=": "≤", ">=": "≥", "<": "<", ">": ">"}
_NEVER, _BADLY, _WELL = range(3)
"""How well a line begins: a factor is better on the line of its product."""
_ZEROS = "000000"
"""A whole number with so many zeros is written with a power of ten."""
_INVISIBLE, _TIMES, _MINUS = "⁡", "⋅", "−"

Names = Callable[[str], str]
"""The spelling of a neutral name."""


@dataclass(frozen=True)
class Token:
    """A piece of a line that is never broken: its MathML, its width in letters, and how well a line begins with it."""

    text: str
    width: int
    begins: int = _NEVER


Row: TypeAlias = tuple[Token, ...]


def operator(sign: str, begins: int = _NEVER) -> Token:
    """An operator between two values."""
    return Token(f"<mo>{escape(sign)}</mo>", len(sign) + 2, begins)


def word(name: str) -> Token:
    """A name."""
    return Token(f"<mi>{escape(name)}</mi>", len(name))


def _fence(sign: str) -> Token:
    return Token(f'<mo stretchy="false">{sign}</mo>', 1)


def _bar(form: str) -> Token:
    return Token(f'<mo stretchy="false" form="{form}" lspace="0" rspace="0">|</mo>', 1)


class MathML:
    """Writes expressions, given the spelling of names."""

    def __init__(self, names: Names) -> None:
        self._names = names

    def row(self, node: sp.Basic) -> Row:
        """The tokens of an expression."""
        return self._row(node, _OR)

    def inline(self, node: sp.Basic) -> str:
        """An expression in one line, as an element of HTML."""
        return element(self.row(node))

    def lines(self, node: sp.Basic, width: int = WIDTH) -> tuple[str, ...]:
        """An expression as elements of HTML, one for each line of at most so many letters."""
        return tuple(map(element, broken(self.row(node), width)))

    def equation(self, left: sp.Basic, right: sp.Basic) -> tuple[str, ...]:
        """left = right, as elements of HTML, one for each line."""
        return tuple(map(element, broken((*self.row(left), operator("=", _WELL), *self.row(right)), WIDTH)))

    def _row(self, node: sp.Basic, context: int) -> Row:
        row, level = self._spell(node)
        return (_fence("("), *row, _fence(")")) if level < context else row

    def _spell(self, node: sp.Basic) -> tuple[Row, int]:
        if is_decided(node):
            return (word("true" if node == sp.true else "false"),), _ATOM
        if isinstance(node, sp.Symbol):
            return (word("DEGREE" if node == DEGREE else self._names(node.name)),), _ATOM
        if isinstance(node, sp.Number) or node is sp.pi:
            return _number(node)
        if isinstance(node, sp.Add):
            return self._sum(node), _SUM
        if isinstance(node, sp.Mul | sp.Pow):
            return self._product(node)
        if isinstance(node, Relational):
            sign = operator(_RELATIONS[node.rel_op], _BADLY)
            return (*self._row(node.lhs, _SUM), sign, *self._row(node.rhs, _SUM)), _COMPARE
        if isinstance(node, sp.And):
            return self._joined(node.args, "and"), _AND
        if isinstance(node, sp.Or):
            return self._joined(node.args, "or"), _OR
        return self._applied(node)

    def _applied(self, node: sp.Basic) -> tuple[Row, int]:
        if isinstance(node, sp.Not):
            return (operator("not"), *self._row(node.args[0], _ATOM)), _COMPARE
        if isinstance(node, ToReal):
            return self._spell(node.args[0])
        if isinstance(node, Root):
            return self._root(node.args[0])
        if isinstance(node, sp.Abs):
            inside = self._row(node.args[0], _OR)
            return (_bar("prefix"), *inside, _bar("postfix")), _ATOM
        arguments: list[Token] = []
        for argument in node.args:
            arguments += [*([operator(",")] if arguments else []), *self._row(argument, _OR)]
        kind = type(node).__name__
        name = Token(f"<mi>{kind[0].lower()}{kind[1:]}</mi><mo>{_INVISIBLE}</mo>", len(kind))
        return (name, _fence("("), *arguments, _fence(")")), _ATOM

    def _joined(self, parts: Sequence[sp.Basic], sign: str) -> Row:
        found: list[Token] = []
        for part in sp.ordered(parts):
            inside = self._row(part, _OR)
            found += [operator(sign, _WELL)] if found else []
            found += inside if part.is_Symbol else (_fence("("), *inside, _fence(")"))
        return tuple(found)

    def _sum(self, node: sp.Add) -> Row:
        found: list[Token] = []
        for term in terms_of(node):
            minus = is_negative(term)
            if found:
                found.append(operator(_MINUS if minus else "+", _WELL))
            elif minus:
                found.append(Token(f"<mo>{_MINUS}</mo>", 1))
            found += self._row(-term if minus else term, _PRODUCT)
        return tuple(found)

    def _product(self, node: sp.Expr) -> tuple[Row, int]:
        if isinstance(node, sp.Pow) and node.exp == sp.Rational(1, 2):
            return self._root(node.base)
        coefficient, rest = node.as_coeff_Mul()
        above, below = self._factors(rest)
        minus: Row = (Token(f"<mo>{_MINUS}</mo>", 1),) if coefficient < 0 else ()
        size = abs(coefficient)
        top, bottom = (sp.fraction(size)) if isinstance(size, sp.Rational) else (size, sp.Integer(1))
        if top != 1 or not above:
            above.insert(0, _number(top)[0])
        if bottom != 1:
            below.insert(0, _number(bottom)[0])
        if len(above) == 1 and not below and not minus and isinstance(node, sp.Pow):
            return above[0], _ATOM
        numerator = _times(above)
        if not below:
            return (*minus, *numerator), _SUM if minus else _PRODUCT
        return (*minus, *_over(numerator, _times(below), len(above), len(below))), _SUM if minus else _PRODUCT

    def _factors(self, rest: sp.Expr) -> tuple[list[Row], list[Row]]:
        """The factors of numerator and denominator."""
        above: list[Row] = []
        below: list[Row] = []
        for factor in sorted(sp.Mul.make_args(rest), key=factor_order):
            base, exponent = factor.as_base_exp() if isinstance(factor, sp.Pow) else (factor, sp.Integer(1))
            if factor != 1:
                (below if exponent.is_negative else above).append(self._power(base, abs(exponent)))
        return above, below

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> Row:
        if exponent == sp.Rational(1, 2):
            return self._root(base)[0]
        inside = self._row(base, _PRODUCT if exponent == 1 else _ATOM)
        if exponent == 1:
            return inside
        if len(inside) > 1 and _width(inside) > _SHORT and _bare(inside) == inside:
            inside = (_fence("("), *inside, _fence(")"))
        *before, last = inside
        if before and _width(inside) <= _SHORT:
            before, last = [], Token(f"<mrow>{_text(inside)}</mrow>", _width(inside))
        high = _text(self._row(exponent, _OR))
        return (*before, Token(f"<msup>{last.text}{high}</msup>", last.width + 1))

    def _root(self, radicand: sp.Expr) -> tuple[Row, int]:
        inside = self._row(radicand, _OR)
        if _width(inside) <= _SHORT:
            return (Token(f"<msqrt>{_text(inside)}</msqrt>", _width(inside) + 2),), _ATOM
        return (Token("<mo>√</mo>", 1), _fence("("), *inside, _fence(")")), _ATOM


def _number(value: sp.Expr) -> tuple[Row, int]:
    if value is sp.pi:
        return (Token("<mi>π</mi>", 1),), _ATOM
    if isinstance(value, sp.Rational) and value.q != 1:
        row = (Token(f"<mfrac><mn>{abs(value.p)}</mn><mn>{value.q}</mn></mfrac>", 3),)
        return ((Token(f"<mo>{_MINUS}</mo>", 1), *row), _SUM) if value < 0 else (row, _PRODUCT)
    plain = f"{float(abs(value)):.15g}"
    mantissa, _, power = plain.partition("e")
    if value.is_Integer and plain.endswith(_ZEROS):
        mantissa = plain.rstrip("0")
        power = str(len(plain) - len(mantissa))
    if power:
        high = f"{_MINUS if power.startswith('-') else ''}{int(power.lstrip('+-'))}"
        sign = f"<mo>{_MINUS}</mo>" if high.startswith(_MINUS) else ""
        ten = f"<msup><mn>10</mn><mrow>{sign}<mn>{high.lstrip(_MINUS)}</mn></mrow></msup>"
        first = "" if mantissa == "1" else f"<mn>{mantissa}</mn><mo>{_TIMES}</mo>"
        row = (Token(f"{first}{ten}", len(mantissa) + 5),)
        level = _ATOM if not first else _PRODUCT
    else:
        row, level = (Token(f"<mn>{plain}</mn>", len(plain)),), _ATOM
    return ((Token(f"<mo>{_MINUS}</mo>", 1), *row), _SUM) if value < 0 else (row, level)


def _times(factors: Sequence[Row]) -> Row:
    found: list[Token] = []
    for factor in factors:
        found += [operator(_TIMES, _BADLY)] if found else []
        found += factor
    return tuple(found)


def _over(numerator: Row, denominator: Row, above: int, below: int) -> Row:
    """A fraction; if it is wide, with a slash."""
    wide = max(_width(numerator), _width(denominator))
    if wide <= _SHORT:
        return (Token(f"<mfrac>{_grouped(numerator)}{_grouped(denominator)}</mfrac>", wide + 1),)
    under = (_fence("("), *denominator, _fence(")")) if below > 1 or len(denominator) > 1 else denominator
    return (*numerator, operator("/", _BADLY), *under)


def _grouped(row: Row) -> str:
    """A row as one element, without the parentheses that a bar makes needless."""
    return f"<mrow>{_text(_bare(row))}</mrow>"


def _bare(row: Row) -> Row:
    opening, closing = _fence("("), _fence(")")
    if len(row) < 2 or row[0] != opening or row[-1] != closing:
        return row
    depth = 0
    for token in row[:-1]:
        depth += (token == opening) - (token == closing)
        if depth == 0:
            return row
    return row[1:-1]


def _text(row: Row) -> str:
    return "".join(token.text for token in row)


def _width(row: Row) -> int:
    return sum(token.width for token in row)


def broken(row: Row, width: int) -> Iterator[Row]:
    """The lines of a row, each begun by an operator: as long as it can be, but a product breaks only where the line
    would else be shorter than half.
    """
    line: list[Row] = []
    for piece in _pieces(row):
        while line and _width(sum(line, ())) + _width(piece) > width:
            place = _place([*line, piece], width)
            yield sum(line[:place], ())
            line = line[place:]
        line.append(piece)
    if line:
        yield sum(line, ())


def _place(pieces: Sequence[Row], width: int) -> int:
    """Before which of the pieces the line is broken; the last one does not fit."""
    for place in range(len(pieces) - 1, 0, -1):
        if pieces[place][0].begins == _WELL and _width(sum(pieces[:place], ())) >= width / 2:
            return place
    return len(pieces) - 1


def _pieces(row: Row) -> Iterator[Row]:
    """The parts of a row between which it may break."""
    piece: list[Token] = []
    for token in row:
        if token.begins and piece:
            yield tuple(piece)
            piece = []
        piece.append(token)
    if piece:
        yield tuple(piece)


def element(row: Row) -> Markup:
    """A row as an element of HTML."""
    return Markup(f'<math displaystyle="true"><mrow>{_text(row)}</mrow></math>')
