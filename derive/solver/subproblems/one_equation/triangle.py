"""The triangle in which the right side of an equation is the law of cosines, and its lengths in factored form."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import sympy as sp

from derive.algebra.normal_form import factored, reduce_units
from derive.equations.problem import Problem
from derive.ir.symbols import cosine, sine


@dataclass(frozen=True)
class Triangle:
    """Two sides, `distance` and `side`, which enclose the wanted angle, and the square of the third one."""

    distance: sp.Expr
    side: sp.Expr
    third: sp.Expr
    sense: int
    """+1 where the cosine of the angle grows with distance and side, -1 where it falls."""

    @property
    def right(self) -> sp.Expr:
        """The cosine of the angle, times twice the product of distance and side."""
        return sp.expand(self.sense * (self.distance**2 + self.side**2 - self.third))

    @property
    def factors(self) -> tuple[sp.Expr, sp.Expr]:
        """1 - cosine and 1 + cosine of the angle, times twice the product of distance and side."""
        less, more = self.third - (self.distance - self.side) ** 2, (self.distance + self.side) ** 2 - self.third
        if is_square(self.third):
            less, more = in_lengths(less), in_lengths(more)
        return (less, more) if self.sense > 0 else (more, less)


def triangle_of(problem: Problem, right: sp.Expr, turned: tuple[sp.Expr, sp.Expr, sp.Expr]) -> Triangle | None:
    """The triangle in which a right side is the law of cosines; None if the square of the third side is not simpler
    than the right side.
    """
    common, square, effective = turned
    number, arm = common.as_coeff_Mul()
    whole = reduce_units(right, problem.units, problem.signs)
    share = whole.as_coefficients_dict()[sp.expand(arm**2)]
    ratio = number / (2 * sp.sqrt(abs(share)))
    if share == 0 or not ratio.is_rational:
        return None
    sense, distance, side = sp.sign(share), ratio * effective, sp.sqrt(abs(share)) * arm
    third = reduce_units(ratio**2 * square + side**2 - sense * whole, problem.units, problem.signs)
    square_of_third = _factored(with_units(problem, third))
    if not (square_of_third.is_Mul or square_of_third.is_Pow) and len(sp.Add.make_args(third)) >= len(
        sp.Add.make_args(whole)
    ):
        return None
    return Triangle(distance, side, square_of_third, sense)


def with_units(problem: Problem, value: sp.Expr) -> sp.Expr:
    """A normal form in which cos^2 + sin^2 of known angles is inserted, so that squares can be recognised.

    The normal form of p^2 + q^2 - (p cos u + q sin u)^2 has 1 - cos^2 u for sin^2 u. With p^2 (cos^2 u + sin^2 u) for
    p^2, and the same for q^2, it is (p sin u - q cos u)^2.
    """
    for angle in problem.units:
        functions = {cosine(angle), sine(angle)}
        terms = sp.Add.make_args(sp.expand(value))
        turned = [t for t in terms if t.free_symbols & functions]
        seen = {s for t in turned for s in t.free_symbols} - functions
        unit = cosine(angle) ** 2 + sine(angle) ** 2
        value = sp.expand(
            sp.Add(*turned, *(t * unit if t.free_symbols & seen else t for t in terms if t not in turned))
        )
    return value


@cache
def _factored(value: sp.Expr) -> sp.Expr:
    """The value in factored form; the coefficients may be the roots of numbers that occur in it."""
    roots = [r for r in value.atoms(sp.Pow) if r.is_number and not r.is_rational]
    return sp.factor(value, extension=roots) if roots else sp.factor(value)


def is_square(value: sp.Expr) -> bool:
    """Whether a value is the square of a rational expression."""
    return all(f.as_base_exp()[1] % 2 == 0 or (f.is_number and f.is_positive) for f in sp.Mul.make_args(value))


def in_lengths(value: sp.Expr) -> sp.Expr:
    """The value in factored form, where each factor reads as a comparison of lengths."""
    return without_minus(factored(value))


def without_minus(product: sp.Expr) -> sp.Expr:
    """The product without a leading minus, which goes into the factor with the most minus signs."""
    factors = list(sp.Mul.make_args(product))
    sums = [f for f in factors if f.is_Add]
    if -1 not in factors or not sums:
        return product
    factors.remove(sp.Integer(-1))
    most = max(sums, key=lambda f: (sum(t.could_extract_minus_sign() for t in f.args), str(f)))
    return sp.Mul(*[-f if f is most else f for f in factors])
