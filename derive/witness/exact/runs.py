"""Programs in the field: their regular side, one value after the other.

A choice by a flag of the machine, or between known numbers, is decided. Nothing in a field is positive: a comparison of
other numbers is taken to hold, which is the regular side, unless the opposite was taken before. A root, and an angle
whose direction has a length, may have either sign: a run asks for each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache, reduce
from operator import add, mul
from types import MappingProxyType

import sympy as sp
from sympy.core.relational import Relational
from sympy.logic.boolalg import BooleanFalse, BooleanTrue

from derive.ir.constants import DEGREE
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select, ToReal, Wrap
from derive.ir.program import Call, Iterate, Let, Program, Solve, Statement
from derive.ir.symbols import Flag, is_condition
from derive.witness.exact.field import PRIME, element, inverse, root, root_of_whole
from derive.witness.exact.values import MINUS_ONE, ONE, ZERO, Angles, NotAlgebraic, Value, fraction
from derive.work import STEPS, spend

Known = dict[str, Value | bool]
"""The values of names, those of flags among them."""
InputOf = Callable[[str], Value | bool]
_HALF = sp.Rational(1, 2)


class _Missing(Exception):
    """A name has to be computed first."""


class Signs:
    """The signs that a run may choose: those that are given first, then positive ones; and what it has compared."""

    def __init__(self, first: Sequence[int] = ()) -> None:
        self.taken: list[int] = []
        self._first = first
        self._positive: set[int] = set()

    def is_positive(self, number: int) -> bool:
        """Whether a number is positive: it is, unless its negative was."""
        if -number % PRIME in self._positive:
            return False
        self._positive.add(number)
        return True

    def next(self) -> int:
        """The next sign."""
        place = len(self.taken)
        self.taken.append(self._first[place] if place < len(self._first) else 1)
        return self.taken[-1]

    def others(self) -> Signs | None:
        """The next signs to try; None if all have been tried."""
        left = list(self.taken)
        while left and left[-1] < 0:
            left.pop()
        return Signs((*left[:-1], -1)) if left else None


class Run:
    """One run of a program. known: the values of its inputs, to which a run adds. inputs: asked for an input that is
    not among them, when it is read.
    """

    def __init__(
        self,
        program: Program,
        known: Known,
        angles: Angles,
        signs: Signs,
        degree: Value,
        input_of: InputOf | None = None,
    ) -> None:
        self.known, self._angles, self._signs, self._degree = known, angles, signs, degree
        self._input_of = input_of
        self._sources: dict[str, Statement] = {n.name: s for s in program.body for n in s.bound()}
        self._program = program

    def output(self, name: str) -> Value:
        """The value of one output."""
        expression = next(o.value for o in self._program.outputs if o.name == name)
        waiting: list[str] = []
        while True:
            try:
                if not waiting:
                    return self.number(expression)
                self._run(self._sources[waiting[-1]])
                waiting.pop()
            except _Missing as missing:
                waiting.append(str(missing))

    def _run(self, statement: Statement) -> None:
        spend(1, STEPS)
        if isinstance(statement, Let):
            for name in _read(statement.value):  # first, as every root that is begun twice takes two signs
                if name in self._sources and name not in self.known:
                    raise _Missing(name)
            if is_condition(statement.value):
                self.known[statement.name.name] = self.truth(statement.value)
            else:
                self.known[statement.name.name] = self.number(statement.value)
        elif isinstance(statement, Solve):
            self._solve(statement)
        elif isinstance(statement, Call) and (statement.is_rare or not self.truth(statement.wanted)):
            self.known |= {n.name: False if is_condition(n) else ZERO for n in statement.names}  # no regular pose asks
        elif isinstance(statement, Call):
            given: Known = {name.name: self.number(value) for name, value in statement.given}
            inner = Run(statement.program, given, self._angles, self._signs, self._degree, self._input_of)
            outputs = zip(statement.names, statement.program.outputs, strict=False)
            self.known |= {name.name: inner.output(o.name) for name, o in outputs}
        elif isinstance(statement, Iterate):
            raise NotAlgebraic("it iterates")

    def _constant(self, symbol: sp.Symbol) -> Value | bool:
        name = symbol.name
        if name not in self.known:
            if name in self._sources or self._input_of is None:
                raise _Missing(name)
            self.known[name] = self._input_of(name)
        return self.known[name]

    def _settled(self, value: Value) -> Value:
        """The value, or the one that is taken for its angle."""
        if value.form is None or all(atom == "" for atom, _ in value.form):
            return value
        in_degrees = all(power == (-1 if atom else 0) for atom, power in value.form)
        angle = value * self._degree if in_degrees else value
        if any(m.denominator != 1 or (atom and power != 0) for (atom, power), m in (angle.form or {}).items()):
            return value
        known = self._angles.known(self._angles.pair(angle))
        return value if known is None else known * self._degree.inverted() if in_degrees else known

    def truth(self, condition: sp.Basic) -> bool:
        """The truth of a condition."""
        if isinstance(condition, BooleanTrue | BooleanFalse):
            return bool(condition)
        if isinstance(condition, Flag):
            found = self._constant(condition)
            return found if not isinstance(found, Value) else found.rational != 0
        if isinstance(condition, sp.And | sp.Or):
            parts, decided = [self.truth(a) for a in condition.args], isinstance(condition, sp.Or)
            return decided if decided in parts else not decided
        if isinstance(condition, sp.Not):
            return not self.truth(condition.args[0])
        left, right = map(self.number, condition.args)
        if isinstance(condition, sp.Eq | sp.Ne):
            return (left.number == right.number) is isinstance(condition, sp.Eq)
        is_larger = isinstance(condition, sp.Gt | sp.Ge)
        if left.rational is not None and right.rational is not None:
            return bool(condition.func(sp.Rational(left.rational), sp.Rational(right.rational)))
        difference = (left.number - right.number) % PRIME
        return self._signs.is_positive(difference if is_larger else -difference % PRIME)

    def number(self, value: sp.Basic) -> Value:
        """The value of an expression."""
        if isinstance(value, sp.Symbol):
            return self._degree if value == DEGREE else self._named(value)
        if isinstance(value, sp.Float | sp.Rational):
            return fraction(Fraction(repr(float(value))) if isinstance(value, sp.Float) else Fraction(value.p, value.q))
        if value is sp.pi:
            return self._degree * fraction(Fraction(180))
        if isinstance(value, sp.Add):
            return self._settled(reduce(add, map(self.number, value.args)))
        if isinstance(value, sp.Mul):
            return reduce(mul, map(self.number, value.args))
        return self._power(value) if isinstance(value, sp.Pow) else self._called(value)

    def _named(self, symbol: sp.Symbol) -> Value:
        found = self._constant(symbol)
        return fraction(Fraction(int(found))) if isinstance(found, bool) else found

    def _power(self, value: sp.Pow) -> Value:
        base, exponent = self.number(value.base), value.exp
        if exponent in (_HALF, -_HALF):
            found = self._root(base)
            return found if exponent > 0 else found.inverted()
        if not exponent.is_Integer:
            raise NotAlgebraic(f"it holds {value.func.__name__}")
        power = base if exponent > 0 else base.inverted()
        found = power
        for _ in range(abs(int(exponent)) - 1):
            found = found * power
        return found

    def _called(self, value: sp.Basic) -> Value:
        if isinstance(value, sp.sin | sp.cos):
            return Value(self._angles.pair(self.number(value.args[0]))[isinstance(value, sp.sin)])
        if isinstance(value, Select):
            return self._chosen(*value.args)
        if isinstance(value, ToReal | Wrap | NearestPeriod | NearestOnArc):
            return self.number(value.args[0])
        if isinstance(value, Root):
            return self._root(self.number(value.args[0]))
        if isinstance(value, Atan2):
            return self._angle(*map(self.number, value.args))
        if isinstance(value, sp.Abs | sp.sign):
            return self._size(self.number(value.args[0]), isinstance(value, sp.sign))
        raise NotAlgebraic(f"it holds {value.func.__name__}")

    def _chosen(self, condition: sp.Basic, first: sp.Basic, second: sp.Basic) -> Value:
        """The side of a choice. A plain number in place of a value limits it, which is not regular: 1 for 1.0001."""
        is_limit = isinstance(condition, Relational) and first.is_number and not second.is_number
        if is_limit and any(self.number(a).rational is None for a in condition.args):
            return self.number(second)
        return self.number(first if self.truth(condition) else second)

    def _size(self, value: Value, is_sign: bool) -> Value:
        """The absolute value or the sign of a number."""
        exact = value.rational
        is_positive = self._signs.is_positive(value.number) if exact is None else exact >= 0
        if is_sign:
            return ONE if is_positive else MINUS_ONE
        return value if is_positive else -value

    def _root(self, value: Value) -> Value:
        exact = value.rational
        if exact is not None and exact >= 0:
            whole = root_of_whole(exact.numerator * exact.denominator) if exact else 0
            return Value(whole * element(Fraction(1, exact.denominator)) % PRIME)
        return Value(root(value.number) * self._signs.next() % PRIME)

    def _angle(self, across: Value, along: Value) -> Value:
        """The angle of a direction: atan2(across, along)."""
        square = (across.number**2 + along.number**2) % PRIME
        length = 1
        if square != 1:
            length = inverse(root(square) * self._signs.next() % PRIME)
        pair = along.number * length % PRIME, across.number * length % PRIME
        return self._angles.found(pair)

    def _solve(self, statement: Solve) -> None:
        size, columns = statement.size, statement.columns
        matrix = [[self.number(v).number for v in statement.matrix[size * i : size * i + size]] for i in range(size)]
        right = [
            [self.number(v).number for v in statement.right[columns * i : columns * i + columns]] for i in range(size)
        ]
        determinant = _eliminated(matrix, right)
        names = statement.names
        self.known |= {n.name: Value(right[k // columns][k % columns]) for k, n in enumerate(names)}
        if statement.determinant is not None:
            self.known[statement.determinant.name] = Value(determinant)


@cache
def _read(value: sp.Basic) -> tuple[str, ...]:
    """The names that a value reads, whatever is chosen."""
    return () if value.has(Select) else tuple(sorted(s.name for s in value.free_symbols))


def _eliminated(matrix: list[list[int]], right: list[list[int]]) -> int:
    """The determinant; the right sides become the solution."""
    determinant = 1
    for k in range(len(matrix)):
        pivot = next((i for i in range(k, len(matrix)) if matrix[i][k]), k)
        if pivot != k:
            matrix[k], matrix[pivot], right[k], right[pivot] = matrix[pivot], matrix[k], right[pivot], right[k]
            determinant = -determinant
        determinant = determinant * matrix[k][k] % PRIME
        scale = inverse(matrix[k][k])
        for rows in (matrix, right):
            rows[k] = [v * scale % PRIME for v in rows[k]]
        for i in range(len(matrix)):
            factor = matrix[i][k]
            if i != k and factor:
                for rows in (matrix, right):
                    rows[i] = [(a - factor * b) % PRIME for a, b in zip(rows[i], rows[k], strict=True)]
    return determinant % PRIME


def evaluated(
    expressions: Sequence[sp.Basic],
    values: Mapping[str, Value],
    angles: Angles,
    degree: Value,
    own: Mapping[sp.Symbol, Value] = MappingProxyType({}),
) -> list[Value]:
    """Expressions of a description. own: values of symbols that may share their names with others."""
    apart = {symbol: sp.Symbol(f"own {symbol.name}") for symbol in own}
    known: Known = {**values, **{apart[symbol].name: value for symbol, value in own.items()}}
    run = Run(Program("", (), (), ()), known, angles, Signs(), degree)
    return [run.number(sp.sympify(e).xreplace(apart)) for e in expressions]
