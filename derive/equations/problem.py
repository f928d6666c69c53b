"""The problem that the solver works on, with unknowns and equations, and the binding that a subproblem returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace

import sympy as sp

from derive.algebra.normal_form import cancelled, reduce_units
from derive.geometry.frames import Factor
from derive.ir.constants import DEGREE
from derive.ir.program import Let, Statement
from derive.ir.symbols import cosine, names_in, real, sine
from derive.work import spend

_NUMBER = 1e-9
"""A sum of numbers counts as zero if it is at most this share of its terms."""


@dataclass(frozen=True)
class Column:
    """One column of a known rotation, whose squared entries add up to one."""

    entry: sp.Expr
    """One entry; or a polar radius, of one entry and another value."""
    others: sp.Expr
    """The sum of the squares of the other two entries; of a polar radius, less the square of the other value."""
    lets: tuple[Let, ...]
    """The statements that bind all three entries."""
    size: sp.Expr = sp.Integer(1)
    """The largest value of the entry: a length of the machine where the entry is multiplied by one."""
    is_bounded: bool = True
    """Whether the entry is never larger than this: a polar radius may be, if the other value is no entry."""


@dataclass(frozen=True)
class Equation:
    """expression = 0. `lets` bind the names in it; they are recorded when the equation is used."""

    label: str
    expression: sp.Expr
    lets: tuple[Let, ...] = ()
    scales: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """For an unknown, the largest derivative by it, where parameters alone determine it. Margins are divided by it."""
    is_length: bool = True
    """Whether its terms are lengths; those of a rotation have no unit."""
    is_squared: bool = False
    """Whether they are squares of lengths."""
    column: Column | None = None
    """The column of the entry of a rotation that it holds."""
    apart: tuple[sp.Expr, ...] = ()
    """The two equations without the length that was eliminated between them: they hold where both its coefficients
    vanish, and this equation says nothing."""


@dataclass(frozen=True)
class Legs:
    """The right triangle of a two-root step whose arm, with a lateral offset, points at a point (along, across).

    along cos u + across sin u = beside, along sin u - across cos u = root, and root² + beside² = distance².
    """

    root: sp.Symbol
    """The distance ahead: sigma times the root of `square`."""
    square: sp.Expr
    beside: sp.Expr
    distance: sp.Expr
    along: sp.Expr
    across: sp.Expr

    def renamed(self, names: Mapping[sp.Symbol, sp.Expr]) -> Legs:
        """A copy with other names."""
        return Legs(*(getattr(self, f.name).xreplace(names) for f in fields(self)))


@dataclass(frozen=True)
class StepDeterminant:
    """The determinant of the equations of a two-root step by its unknowns (of one equation: its derivative), with its
    scale. Its sign is the branch.
    """

    step: sp.Symbol
    """The unknown for which the step solves."""
    value: sp.Expr
    """At every solution sigma times a number that is not negative."""
    scale: sp.Expr
    legs: Legs | None = None
    """The triangle of an arm that points at a point: later statements read its legs."""

    @property
    def sigma(self) -> sp.Symbol:
        """The sign that chooses between the two roots: +1 or -1."""
        return sign_of(self.step)

    def renamed(self, names: Mapping[sp.Symbol, sp.Expr]) -> StepDeterminant:
        """A copy with other names for the values that earlier steps bind."""
        return replace(
            self, value=self.value.xreplace(names), legs=None if self.legs is None else self.legs.renamed(names)
        )


def sign_of(step: sp.Symbol) -> sp.Symbol:
    """The name of the sign that chooses between the two roots of a step, by its unknown."""
    return real(f"sigma_{step.name}")


@dataclass(frozen=True)
class Conditioning:
    """The conditioning of a step: the value that must not vanish for `angle` to be determined, and the scale by which
    it is divided.
    """

    angle: sp.Symbol
    value: sp.Expr
    scale: sp.Expr
    word: str = "free"
    """What happens where it vanishes: the angle is "free", or two solutions "meet" of which the machine has one."""
    missed: sp.Expr | None = None
    """The value is a length that is turned: its square less that of the length that it turns to, which is as long."""

    @property
    def name(self) -> str:
        """The name of the margin."""
        return f"{self.word}_{self.angle.name}"


@dataclass(frozen=True)
class Binding:
    """The result of a subproblem: statements that bind unknowns, and the determinant and the conditioning of the step,
    which vanish in its singularities.
    """

    rule: str
    unknowns: tuple[sp.Symbol, ...]
    statements: tuple[Statement, ...]
    determinant: StepDeterminant | None = None
    conditioning: Conditioning | None = None
    new_equations: tuple[Equation, ...] = ()
    residual: sp.Expr | None = None
    """An expression that vanishes if the equations used agree with each other: a squared length."""
    conditions: tuple[sp.Expr, ...] = ()
    """Values of parameters that must not vanish: a machine where one does is refused when it is set up."""
    cosine_alone: bool = False
    uncounted: int = 0
    """Operations that keep digits, and are no reason to take another step."""
    yields_to_a_sum: bool = False
    """Whether a sum of angles may be the better unknown."""

    @property
    def rank(self) -> tuple[bool, bool, bool, int]:
        """Smaller is better: cosine and sine known, an angle that is always determined, one root, few operations."""
        size = sum(int(sp.count_ops(s.value)) for s in self.statements if isinstance(s, Let))
        counted = size - self.uncounted
        return (self.cosine_alone, self.conditioning is not None, self.determinant is not None, counted)


@dataclass(frozen=True)
class Problem:
    """Equations in unknown angles and lengths; everything else in them is known."""

    angles: tuple[sp.Symbol, ...]
    lengths: tuple[sp.Symbol, ...]
    equations: tuple[Equation, ...]
    units: tuple[sp.Symbol, ...]
    """All angles, known ones too, whose sine and cosine symbols obey sin^2 + cos^2 = 1."""
    references: Mapping[sp.Symbol, sp.Expr]
    """The reference of each angle, in radians: its value where nothing determines it."""
    scale: sp.Expr
    """A length of the machine, made of parameters only, never zero."""
    signs: tuple[sp.Symbol, ...] = ()
    positive: tuple[sp.Expr, ...] = ()
    """Normal forms of the quantities that the description states to be positive."""
    pending: tuple[sp.Symbol, ...] = ()
    """Angles that follow from a sum once its other terms are known: unknown, but not solved for."""
    sums: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """The sums of angles that stand in place of one of their terms, by their names."""
    is_overdetermined: bool = False
    """Whether there is one equation too many: it is left as a residual, and no two-root step may use it."""
    turns: tuple[Factor, ...] = ()
    """The rotations whose product is the commanded one; they give further equations whenever angles become known."""
    rotation: tuple[sp.Symbol, ...] = ()
    """The entries of the commanded rotation, by rows; none if it is not commanded."""
    columns: tuple[int, ...] = (0, 1, 2)
    """The columns of the commanded rotation that the task prescribes."""
    followed: int = 0
    """How many of the last turns follow the commanded rotation, once those before are known; 0: all of them."""
    position: tuple[sp.Symbol, ...] = ()
    """The coordinates of the commanded position."""
    links: tuple[Factor, ...] = ()
    """The chain up to a commanded point; its equations are written again whenever joints become known."""
    point: tuple[sp.Expr, ...] = ()
    """The commanded point at the end of `links`."""
    point_lets: tuple[Let, ...] = ()
    """The statements that bind the names in it."""
    back: tuple[tuple[Factor, ...], tuple[sp.Expr, ...], tuple[Let, ...]] | None = None
    """The chain from its flange to the point in which its first joints intersect, this point seen from the flange, and
    the statements that bind the names in it."""
    squares: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """The squares of lengths that are roots of parameters."""
    parameters: tuple[sp.Symbol, ...] = ()
    """The names that are made of parameters alone."""
    numbers: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    """The values of names that stand for numbers: those of a chain, their sines and cosines."""
    fixed: tuple[sp.Symbol, ...] = ()
    """The names made of parameters alone, set once no other equation is left: a determinant made of them then becomes a
    condition on the machine."""
    definitions: Mapping[sp.Symbol, sp.Expr] | None = None
    """The polynomials that known names stand for, to test whether an expression is zero."""

    def scale_of(self, equation: Equation) -> sp.Expr:
        """The scale of the terms of an equation: a length of the machine, or one."""
        return self.scale if equation.is_length else sp.Integer(1)

    def atoms(self) -> tuple[sp.Symbol, ...]:
        """Every symbol that is unknown: lengths, angles, their sines and cosines."""
        angles = (*self.angles, *self.pending)
        return (*self.lengths, *angles, *(f(a) for a in angles for f in (cosine, sine)))

    def unknowns_of(self, expression: sp.Expr) -> tuple[sp.Symbol, ...]:
        """The unknown angles and lengths that occur, in a fixed order."""
        present = names_in(expression)
        angles = [a for a in (*self.angles, *self.pending) if present & {a, sine(a), cosine(a)}]
        return (*(u for u in self.lengths if u in present), *angles)

    def reduce(self, expression: sp.Expr) -> sp.Expr:
        """The normal form of an expression with known names written out: zero if and only if the expression is zero."""
        definitions = self.definitions or {}
        while expression.free_symbols & definitions.keys():
            expression = expression.xreplace(dict(definitions))
        return reduce_units(expression, self.units, self.signs)

    def tidy(self, expression: sp.Expr) -> sp.Expr:
        """The expression with the squares of signs replaced by one, and names not written out."""
        return reduce_units(expression, (), self.signs)

    def is_never_zero(self, expression: sp.Expr) -> bool:
        """Whether an expression of known names cannot vanish for any legal machine and pose."""
        reduced = self.reduce(expression).xreplace({DEGREE: sp.pi / 180})
        spend(len(sp.Add.make_args(reduced)))
        return bool(reduced.is_nonzero) or self._is_number(reduced)

    def _is_number(self, value: sp.Expr) -> bool:
        """Whether a value is a number of the chain other than zero, but for rounding."""
        if not value.free_symbols or not value.free_symbols <= self.numbers.keys():
            return False
        terms = [float(term.xreplace(dict(self.numbers))) for term in sp.Add.make_args(value)]
        return abs(sum(terms)) > _NUMBER * sum(map(abs, terms))

    def determines(self, determinant: sp.Expr) -> bool:
        """Whether equations with this determinant have one solution: it is never zero, or parameters alone decide."""
        return self.is_never_zero(determinant) or bool(self.conditions(determinant))

    def conditions(self, determinant: sp.Expr) -> tuple[sp.Expr, ...]:
        """The values that a machine must not have at zero, where a determinant is made of parameters alone."""
        if not self.fixed or self.is_never_zero(determinant):
            return ()
        reduced = self.reduce(determinant)
        return (reduced,) if reduced != 0 and reduced.free_symbols <= {*self.fixed, DEGREE} else ()

    def is_positive(self, value: sp.Expr) -> bool:
        """Whether a value is a positive multiple of a quantity that is stated to be positive, or a product of such
        quantities.
        """
        if all(factor in self.positive for factor in sp.Mul.make_args(value)):
            return True
        known = {**self.numbers, DEGREE: sp.pi / 180}
        ratios = [cancelled(value / quantity).xreplace(known) for quantity in self.positive]
        return any(ratio.is_number and ratio.is_positive for ratio in ratios)

    def with_equations(self, equations: tuple[Equation, ...]) -> Problem:
        """The same unknowns with other equations."""
        return replace(self, equations=equations)
