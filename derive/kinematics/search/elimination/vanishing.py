"""The joints at a value of the searched one, from a vector that the matrix takes to zero.

Bordered by two columns and two rows, the matrix is regular, and gives two vectors: all that it takes to zero where the
arm closes are sums of them, also where two solutions have the same value of the searched joint. In a solution each
power of the half angle of d is to the next as cosine to sine: this holds for two sums, which are told apart by `SIDE`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from derive.description.mechanism import Mechanism
from derive.equations.axes import held_lets
from derive.equations.closures.fixed_names import fixed_lets
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Root, Select, Wrap
from derive.ir.program import Let, Output, Program, Solve, Statement
from derive.ir.symbols import SCALE, SIDE, TRIED, cosine, flag, real, sine
from derive.kinematics.search.elimination.equations import Equations
from derive.kinematics.search.elimination.line import direction_of
from derive.kinematics.search.elimination.matrix import UNKNOWNS, VANISHING, call_of, entries_at, rows_of
from derive.kinematics.search.elimination.order import Elimination
from derive.kinematics.search.elimination.ring import Fixed, Place
from derive.kinematics.search.loop.tried import RATE, REMAINDER, ROOM
from derive.kinematics.search.programs import begun

_ASIDE = sp.Float("0.7")
"""The second share of the powers by which both are compared."""
_ONE, _ZERO = sp.Integer(1), sp.Integer(0)
Pair = tuple[sp.Expr, sp.Expr]
Four = tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr]
"""A matrix of two rows, by rows."""


def eliminated_trial(mechanism: Mechanism, equations: Equations) -> Program:
    """The trial: how well the arm closes at a value of the searched joint, and all joints there."""
    written = _Written(mechanism, equations)
    outputs = [Output(REMAINDER.name, real("deviation")), Output(RATE.name, _ZERO), Output(ROOM.name, real("room"))]
    outputs += [Output(begun(p.joint.symbol).name, written.value_of(p)) for p in equations.elimination.ring.places]
    trial = normalise("try_joint", written.all(), outputs)
    return replace(trial, summary="How well the other joints follow from the searched one, and what they are")


@dataclass(frozen=True)
class _Written:
    mechanism: Mechanism
    equations: Equations

    @property
    def elimination(self) -> Elimination:
        """What is eliminated."""
        return self.equations.elimination

    def all(self) -> list[Statement]:
        """All statements."""
        c = self.elimination.ring.places[2].joint.symbol
        own = [Let(cosine(c), sp.cos(TRIED)), Let(sine(c), sp.sin(TRIED))]
        every = range(VANISHING.start, UNKNOWNS.stop)
        lets, entries = entries_at(self.equations, cosine(c), sine(c), every)
        rows = list(rows_of(self.elimination, entries))
        held = [let for j in self.mechanism.held_joints for let in held_lets(j)]
        ring = self.elimination.ring
        return [
            *fixed_lets(self.mechanism),
            *held,
            *ring.lets,
            call_of(self.equations),
            *own,
            *lets,
            _bordered(rows),
            *_two_ways(self.elimination),
            *_half_angles(self.elimination),
            *self._of_unknowns(entries),
            *self._last(),
        ]

    def value_of(self, place: Place) -> sp.Expr:
        """The joint, from its unknowns."""
        first, second = place.unknowns
        if place.joint == self.elimination.searched:
            return Wrap(TRIED)
        return Wrap(Atan2(second, first)) if place.joint.is_angle else place.joint.symbol

    def _of_unknowns(self, entries: dict[tuple[int, int, int], sp.Expr]) -> Iterator[Let]:
        """The unknowns of d and e, and of a and b."""
        a, b, _, d, e, _ = self.elimination.ring.places
        squares = [_squares("d", d), _squares("e", e)]
        for place, (first, both, last) in zip((d, e), squares, strict=True):
            if place.joint.is_angle:
                yield Let(cosine(place.joint.symbol), first - last)
                yield Let(sine(place.joint.symbol), 2 * both)
            else:
                yield Let(place.joint.symbol, both * SCALE)
        values = [
            sp.Add(*(entries[k, x, y] * u * v for x, u in enumerate(squares[0]) for y, v in enumerate(squares[1])))
            for k in UNKNOWNS
        ]
        for place, (first, last) in zip((a, b), (values[:2], values[2:]), strict=True):
            if not place.joint.is_angle:
                yield Let(place.joint.symbol, first * SCALE)
                continue
            size = real(f"size_of_{place.joint.symbol.name}")
            names = real(f"along_{place.joint.symbol.name}"), real(f"across_{place.joint.symbol.name}")
            yield from (Let(n, v) for n, v in zip(names, (first, last), strict=True))
            yield Let(size, Root(names[0] ** 2 + names[1] ** 2))
            for function, value in zip((cosine, sine), names, strict=True):
                yield Let(function(place.joint.symbol), _over(value, size))

    def _last(self) -> Iterator[Let]:
        """Cosine and sine of f: what all other motions do to an axis across its own."""
        ring = self.elimination.ring
        f = ring.places[5]
        first, second = (f.axis + 1) % 3, (f.axis + 2) % 3
        vector: list[sp.Expr] = [sp.Integer(int(k == first)) for k in range(3)]
        path: list[Place | Fixed] = []
        for place, link in zip((None, *ring.places[:5]), (ring.links[5], *ring.links[:5]), strict=True):
            path += [place] if place is not None else []
            path += link
        for number, step in enumerate(reversed(path)):
            turned = list(direction_of(step.move) * sp.Matrix(vector))
            for k, value in enumerate(turned):
                if value != vector[k] and not value.is_Atom:
                    yield Let(real(f"across_{number}_{'xyz'[k]}"), value)
                    turned[k] = real(f"across_{number}_{'xyz'[k]}")
            vector = turned
        yield Let(cosine(f.joint.symbol), vector[first])
        yield Let(sine(f.joint.symbol), -f.sense * vector[second])


def _squares(word: str, place: Place) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """C², CS and S² of a joint; a slide has S = 1."""
    c, s = real(f"half_cos_{word}"), real(f"half_sin_{word}")
    if place.joint.is_angle:
        return c**2, c * s, s**2
    shift = _over(c, s)
    return shift**2, shift, _ONE


def _over(value: sp.Expr, divisor: sp.Expr) -> sp.Expr:
    """A quotient; the value itself where it would be divided by zero."""
    return value / Select(sp.Gt(sp.Abs(divisor), 0), divisor, _ONE)


def _vector(row: int, column: int) -> sp.Symbol:
    return real(f"vector_{row}_{column}")


def _bordered(rows: Sequence[Sequence[sp.Expr]]) -> Solve:
    """The two vectors, and what the matrix leaves of them."""
    size = len(rows)
    border = np.random.default_rng(1).integers(-99, 100, (4, size))
    numbers = [[sp.Rational(int(n), 100) for n in line] for line in border]
    matrix = [[*row, numbers[0][k], numbers[1][k]] for k, row in enumerate(rows)]
    matrix += [[*numbers[2], _ZERO, _ZERO], [*numbers[3], _ZERO, _ZERO]]
    right = [sp.Integer(int(k - size == j)) for k in range(size + 2) for j in range(2)]
    names = [_vector(k, j) if k < size else real(f"remains_{k - size}_{j}") for k in range(size + 2) for j in range(2)]
    entries = [e for row in matrix for e in row]
    return Solve(tuple(names), tuple(entries), tuple(right), None, "two vectors that the matrix nearly takes to zero")


def _two_ways(elimination: Elimination) -> Iterator[Let]:
    """The two sums of the vectors that may belong to solutions, and the one that `SIDE` chooses."""
    high, wide = elimination.highest[0], elimination.highest[1] + 1
    before = [k for k in range(elimination.columns) if k < high * wide]
    sums: dict[str, sp.Expr] = {}
    for word, pairs in (("tt", (0, 0)), ("tb", (0, wide)), ("bb", (wide, wide))):
        for i in range(2):
            for j in range(2):
                name = real(f"{word}_{i}{j}")
                yield Let(name, sp.Add(*(_vector(k + pairs[0], i) * _vector(k + pairs[1], j) for k in before)))
                sums[f"{word}{i}{j}"] = name
    for i, j in ((0, 0), (0, 1), (1, 1)):
        yield Let(real(f"gram_{i}{j}"), sp.Add(*(_vector(k, i) * _vector(k, j) for k in range(elimination.columns))))
    places = [(i, j) for i in range(2) for j in range(2)]
    for i, j in places:
        yield Let(real(f"upper_{i}{j}"), sums[f"tt{i}{j}"] + _ASIDE * sums[f"tb{j}{i}"])
        yield Let(real(f"lower_{i}{j}"), sums[f"tb{i}{j}"] + _ASIDE * sums[f"bb{i}{j}"])
    t00, t01, t10, t11 = (real(f"upper_{i}{j}") for i, j in places)
    b00, b01, b10, b11 = (real(f"lower_{i}{j}") for i, j in places)
    first, middle, last, half = (real(f"{word}_of_ways") for word in ("first", "middle", "last", "half"))
    yield Let(first, t00 * t11 - t01 * t10)
    yield Let(last, b00 * b11 - b01 * b10)
    yield Let(middle, t00 * b11 + t11 * b00 - t01 * b10 - t10 * b01)
    root = Root(middle**2 - 4 * first * last)
    yield Let(half, (middle + Select(sp.Lt(middle, 0), -root, root)) / 2)
    for number, (c, s) in enumerate(((first, half), (half, last)), 1):
        yield from _way(number, [s * t - c * b for t, b in ((t00, b00), (t01, b01), (t10, b10), (t11, b11))])
    is_first, wants = flag("first_is_nearer"), sp.Gt(SIDE, 0)
    yield Let(is_first, sp.Le(real("left_over_1"), real("left_over_2")))
    takes = flag("takes_first")
    yield Let(takes, sp.Or(sp.And(wants, is_first), sp.And(sp.Not(wants), sp.Not(is_first))))
    yield Let(real("room"), Root(Select(is_first, real("left_over_2"), real("left_over_1"))))
    for k in range(2):
        yield Let(real(f"share_{k}"), Select(takes, real(f"share_1_{k}"), real(f"share_2_{k}")))
    for k in range(elimination.columns):
        yield Let(real(f"power_{k}"), sp.Add(*(real(f"share_{j}") * _vector(k, j) for j in range(2))))


def _way(number: int, matrix: Sequence[sp.Expr]) -> Iterator[Let]:
    """The sum of the vectors that a matrix takes to zero, and how much the equations leave of it, squared."""
    names = [real(f"way_{number}_{k}") for k in range(4)]
    yield from (Let(n, v) for n, v in zip(names, matrix, strict=True))
    is_upper = flag(f"upper_is_longer_{number}")
    yield Let(is_upper, sp.Ge(names[0] ** 2 + names[1] ** 2, names[2] ** 2 + names[3] ** 2))
    shares = [real(f"share_{number}_{k}") for k in range(2)]
    yield Let(shares[0], Select(is_upper, names[1], names[3]))
    yield Let(shares[1], -Select(is_upper, names[0], names[2]))
    gram = real("gram_00") * shares[0] ** 2 + 2 * real("gram_01") * shares[0] * shares[1]
    size, left = (
        real(f"size_of_way_{number}"),
        [real(f"remains_{i}_0") * shares[0] + real(f"remains_{i}_1") * shares[1] for i in range(2)],
    )
    yield Let(size, gram + real("gram_11") * shares[1] ** 2)
    leaves = sp.Add(*(value**2 for value in left))
    yield Let(
        real(f"left_over_{number}"),
        Select(sp.Gt(size, 0), leaves / Select(sp.Gt(size, 0), size, _ONE), sp.Float("1e30")),
    )


def _half_angles(elimination: Elimination) -> Iterator[Let]:
    """Cosine and sine of half of d and of e, and how far the vector is from a product of their powers."""
    high, wide = elimination.highest[0] + 1, elimination.highest[1] + 1
    table = [[real(f"power_{i * wide + j}") for j in range(wide)] for i in range(high)]
    turned = [list(column) for column in zip(*table, strict=True)]
    for word, lines in (("d", table), ("e", turned)):
        pairs = [
            (u, v) for one, other in zip(lines[:-1], lines[1:], strict=True) for u, v in zip(one, other, strict=True)
        ]
        upper, mixed, lower = (real(f"{name}_of_{word}") for name in ("upper", "mixed", "lower"))
        yield Let(upper, sp.Add(*(u * u for u, _ in pairs)))
        yield Let(mixed, sp.Add(*(u * v for u, v in pairs)))
        yield Let(lower, sp.Add(*(v * v for _, v in pairs)))
        c, s, size = real(f"half_along_{word}"), real(f"half_across_{word}"), real(f"half_size_{word}")
        yield Let(c, Select(sp.Gt(upper, lower), upper, mixed))
        yield Let(s, Select(sp.Gt(upper, lower), mixed, lower))
        yield Let(size, Root(c**2 + s**2))
        yield Let(real(f"half_cos_{word}"), _over(c, size))
        yield Let(real(f"half_sin_{word}"), _over(s, size))
    powers = [
        [real(f"half_cos_{word}") ** (n - k) * real(f"half_sin_{word}") ** k for k in range(n + 1)]
        for word, n in zip("de", elimination.highest, strict=True)
    ]
    names = [[real(f"power_of_{word}_{k}") for k in range(len(p))] for word, p in zip("de", powers, strict=True)]
    for own, values in zip(names, powers, strict=True):
        yield from (Let(n, v) for n, v in zip(own, values, strict=True))
    along = sp.Add(*(table[i][j] * names[0][i] * names[1][j] for i in range(high) for j in range(wide)))
    sizes = [sp.Add(*(n**2 for n in own)) for own in names]
    whole = sp.Add(*(entry**2 for line in table for entry in line))
    yield Let(real("along_product"), along)
    yield Let(real("size_of_product"), whole * sizes[0] * sizes[1])
    yield Let(real("deviation"), 1 - _over(real("along_product") ** 2, real("size_of_product")))
