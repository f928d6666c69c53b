"""The product of all residuals as a wave in the joint: its coefficients, from values at equal distances.

    W(t) = k_0 + k_1 cos t + l_1 sin t + … + k_d cos d t + l_d sin d t

Multiplied by powers of what its steps divide by, the product is a sum of waves up to some degree d; powers and degree
are found at poses of random machines, by a Fourier transform. So `2 d + 1` values are enough; a few more tell by how
much they are rounded: a wave beyond the degree is rounding.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import sympy as sp

from derive.ir.interpret import Array, evaluate
from derive.ir.passes import normalise
from derive.ir.primitives import ToReal, larger
from derive.ir.program import Iterate, Let, Output, Program, Solve, Statement
from derive.ir.symbols import TRIED, cosine, count, real, sine
from derive.kept import kept_by_identity
from derive.kinematics.search.derivations import Searched, trial_of_all_signs
from derive.kinematics.search.elimination.equations import Equations
from derive.kinematics.search.elimination.matrix import call_of, determinant_of
from derive.kinematics.search.product import Product, product_of
from derive.kinematics.search.programs import LOOKED_FOR
from derive.kinematics.search.samples import MACHINES, samples_of
from derive.solver.unsolved import Unsolved
from derive.work import stage

BEGIN = sp.Float("0.1")
"""The first angle (radians): a round one may be one at which much vanishes."""
NOISE, FIFTH = real("noise"), real("bound_of_fifth")
"""Where the wave is smaller, it is rounding; a bound of its fifth derivative, over 5!."""
_BEYOND = 2
"""The number of waves beyond the degree."""
_MORE, _ROUNDING = 1000, sp.Float("1e-14")
"""The rounding of a value is at most so many times that of a wave beyond the degree, and that share of all waves."""
_OF_TERMS, _LEAST = sp.Float("1e-16"), sp.Float("1e-12")
"""The rounding of a value is this share of its terms, added over all values; products below this are rounding."""
_ANGLES, _MOST_POWERS, _HIGHEST, _NOTHING = 96, 4, 16, 1e-10


def names_of(degree: int) -> list[sp.Symbol]:
    """The names of the coefficients: cosines from 0 to the degree, then sines from 1."""
    return [*(real(f"wave_cos_{n}") for n in range(degree + 1)), *(real(f"wave_sin_{n}") for n in range(1, degree + 1))]


def turned(degree: int, angle: sp.Expr) -> tuple[list[Let], list[sp.Expr], list[sp.Expr]]:
    """The statements that compute cosines and sines of multiples of an angle, up to the degree, and their names."""
    c, s = ([real(f"{f}_{n}") for n in range(degree + 1)] for f in ("cos", "sin"))
    c[0], s[0] = sp.Integer(1), sp.Integer(0)
    lets = [Let(c[1], sp.cos(angle)), Let(s[1], sp.sin(angle))]
    for n in range(2, degree + 1):
        lets += [Let(c[n], c[n - 1] * c[1] - s[n - 1] * s[1]), Let(s[n], s[n - 1] * c[1] + c[n - 1] * s[1])]
    return lets, c, s


@kept_by_identity(4)
@stage("the wave of a root search")
def wave_program(both: Searched) -> tuple[Program, int]:
    """The program that computes the coefficients, with the bound of their rounding; and the degree."""
    wave = _product(both) if both.eliminated is None else _determinant(both.eliminated)
    degree, most = wave.degree, wave.degree + _BEYOND
    points = 2 * most + 1
    number, names, size = count("sample"), names_of(most), real("size_of_terms")
    lets, c, s = turned(most, TRIED)
    share = sp.Float(2.0 / points)
    parts = [real("level") * c[0], *(real("taken") * f for f in (*c[1:], *s[1:]))]
    step: list[Let | Solve] = [
        Let(TRIED, BEGIN + ToReal(number) * sp.Float(2.0 * np.pi / points)),
        *wave.sampled,
        *lets,
        Let(real("taken"), share * wave.value),
        Let(real("level"), real("taken") / 2),
    ]
    is_last = sp.Ge(number, points)
    loop = Iterate(
        state=(number, size, *names),
        start=(sp.Integer(0),) * (2 + len(names)),
        step=tuple(step),
        following=(number + 1, size + wave.size, *(n + p for n, p in zip(names, parts, strict=True))),
        done=sp.Or(sp.Not(LOOKED_FOR), is_last) if both.closed is not None else is_last,
        limit=points + 1,
        otherwise=None,
        note=f"{_WHAT[both.eliminated is not None]}, at equal distances around the circle",
    )
    own = names_of(degree)
    beyond = [n for n in names if n not in own]
    fifth = Let(FIFTH, sp.Add(*[_fifth(k, degree) * sp.Abs(n) for k, n in enumerate(own) if k]))
    outputs = [Output(n.name, n) for n in (*own, NOISE, FIFTH)]
    program = normalise("compute_wave", (*wave.before, loop, *_noise(own, beyond, size), fifth), outputs)
    return replace(
        program, summary="The product of the residuals of all branches as a sum of waves, and its rounding"
    ), degree


_WHAT = ("the residuals of all branches, multiplied", "the determinant that vanishes where the arm closes")


@dataclass(frozen=True)
class _Sampled:
    """What the wave is made of."""

    before: tuple[Statement, ...]
    """Statements that are run once."""
    sampled: tuple[Let | Solve, ...]
    """Those that compute the wave at an angle."""
    value: sp.Expr
    size: sp.Expr
    """The size of what it is the difference of."""
    degree: int


def _product(both: Searched) -> _Sampled:
    """The residuals of all branches, multiplied."""
    samples, trial = _around(both), trial_of_all_signs(both)
    found = product_of(trial.statements, trial.value, samples)
    factor, degree = _cleared(found, samples)
    cleared = real("cleared_by")
    bound = {let.name: let.value for let in found.statements}
    terms = sp.Add.make_args(bound.get(found.value, found.value))
    size = sp.Abs(cleared) * (_LEAST + sp.Add(*map(sp.Abs, terms)))
    return _Sampled((), (*found.statements, Let(cleared, factor)), cleared * found.value, size, degree)


def _determinant(equations: Equations) -> _Sampled:
    """The determinant of the equations that an elimination leaves."""
    joint = equations.elimination.searched.symbol
    statements, value = determinant_of(equations)
    own = Let(cosine(joint), sp.cos(TRIED)), Let(sine(joint), sp.sin(TRIED))
    return _Sampled((call_of(equations),), (*own, *statements), value, sp.Integer(0), equations.elimination.degree)


def _around(both: Searched) -> dict[str, Array]:
    """Poses of some machines, a row for each, and the joint all around the circle."""
    found = {n: values[:, None] for n, values in samples_of(both.arm, both.forward).items()}
    return found | {TRIED.name: 0.1 + 2.0 * np.pi * np.arange(_ANGLES)[None, :] / _ANGLES}


def _fifth(place: int, degree: int) -> sp.Expr:
    """The fifth derivative, over 5!, of the wave of a coefficient, by its place among them."""
    return sp.Float((place if place <= degree else place - degree) ** 5 / 120)


def _noise(own: Sequence[sp.Symbol], beyond: Sequence[sp.Symbol], size: sp.Symbol) -> Iterator[Let]:
    """The bound of the rounding of the wave. size: that of what it is the difference of, which may be as good as equal
    everywhere.
    """
    largest: sp.Expr = real("rounding_0")
    yield Let(largest, _ROUNDING * sp.Add(*map(sp.Abs, own)) + _OF_TERMS * size)
    for k, n in enumerate(beyond, 1):
        yield Let(real(f"rounding_{k}"), larger(_MORE * sp.Abs(n), largest))
        largest = real(f"rounding_{k}")
    yield Let(NOISE, largest)


def _cleared(found: Product, samples: dict[str, Array]) -> tuple[sp.Expr, int]:
    """The powers of its divisors that make the degree of the product lowest, multiplied, and this degree."""
    known = dict(samples)
    for let in found.statements:
        known[let.name.name] = np.asarray(evaluate(let.value, known))
    value = np.broadcast_to(evaluate(found.value, known), (MACHINES, _ANGLES))
    divisors = [np.broadcast_to(known[d.name], value.shape) for d in found.divisors]
    best: tuple[int, int, tuple[int, ...]] | None = None
    for powers in product(range(_MOST_POWERS + 1), repeat=len(divisors)):
        cleared = value * np.prod([d**p for d, p in zip(divisors, powers, strict=True)], axis=0)
        degree = _degree(cleared)
        if degree <= _HIGHEST and (best is None or (degree, sum(powers)) < best[:2]):
            best = (degree, sum(powers), powers)
    if best is None:
        raise Unsolved("the residual is no wave of a low degree")
    factors = [d**p for d, p in zip(found.divisors, best[2], strict=True)]
    return sp.Mul(*factors), best[0]


def _degree(values: Array) -> int:
    """The degree of the waves of which the values are the sum; above the highest where they are no such sum."""
    sizes = np.abs(np.fft.rfft(values, axis=1)) / values.shape[1]
    largest = sizes.max(axis=1, keepdims=True)
    present = np.flatnonzero((sizes > _NOTHING * largest).any(axis=0))
    return int(present.max(initial=0))
