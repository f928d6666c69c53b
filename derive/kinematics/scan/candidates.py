"""Candidates for the roots of a trial whose residual is a conic: all of them, in closed form.

They are the angles at which the conic meets the circle, each on the sides on which it leaves nearly no residual, and
the start, where it is a root itself: on a path that stands still, and where every angle is a root. There the other
candidates are the ends of the reach, because the start may be out of it. Only the complete closure decides whether a
candidate is a root.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import sympy as sp

from derive.ir.cells import TOUCHED
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Call, Let, Output, Program, Statement
from derive.ir.roots import VANISHING
from derive.ir.symbols import flag, real
from derive.kinematics.scan.conic import ANGLES, COEFFICIENTS, MEETS, conic_program
from derive.kinematics.scan.quartic import Quartic
from derive.kinematics.scan.waves import DEGREE_TWO, wave_at

_ZERO = sp.Integer(0)
_NEARLY = sp.Float("1e-3")
"""A candidate leaves no larger residual on its side, before it is refined there."""
_APART = sp.Float("1e-6")
"""Angles nearer than twice this may be one root on each side, or two of one side, by rounding."""
_BEGUN = tuple(real(f"begun_{k}") for k in range(1, len(ANGLES) + 1))


def candidates_program(quartic: Quartic, start: sp.Expr) -> tuple[Program, tuple[int, ...]]:
    """The program of the candidates: a joint value and whether it is one, for each angle and side; and the sides."""
    factors = [Let(real(f"given_{c.name}"), v) for c, v in zip(COEFFICIENTS, _conic(quartic), strict=True)]
    given = tuple((c, let.name) for c, let in zip(COEFFICIENTS, factors, strict=True))
    statements: list[Statement] = [*quartic.statements, *factors, Call(conic_program(), given, (*ANGLES, *MEETS))]
    angles, sides = (ANGLES, (1,)) if not quartic.has_sides else (_BEGUN, (1, -1))
    statements += _apart() if quartic.has_sides else ()
    outputs: list[Output] = []
    for number, angle in enumerate((*angles, start), 1):
        plain, root = real(f"plain_{number}"), real(f"root_{number}")
        c, s = sp.cos(angle), sp.sin(angle)
        statements.append(Let(plain, wave_at(quartic.plain, c, s)))
        statements.append(Let(root, quartic.factor * Root(wave_at(quartic.square, c, s))))
        for side in sides:
            left, offered = sp.Abs(plain + side * root), flag(f"offered_{number}{'' if side > 0 else '_other'}")
            is_start = number > len(ANGLES)
            is_one = sp.Le(left, _number(VANISHING)) if is_start else sp.And(MEETS[number - 1], sp.Le(left, _NEARLY))
            statements.append(Let(offered, is_one))
            outputs += [Output(f"joint_{len(outputs) // 2 + 1}", angle), Output(offered.name, offered)]
    program = normalise("list_candidates", statements, outputs)
    told = replace(program, summary="The angles at which the residual of the closure may vanish, in closed form")
    return told, sides * (len(ANGLES) + 1)


def _number(value: float) -> sp.Float:
    return sp.Float(str(value))


def _conic(quartic: Quartic) -> list[sp.Expr]:
    """The coefficients of P, or of P² - Q² D; where this vanishes everywhere, those of D."""
    if not quartic.has_sides:
        return [quartic.plain.get(n, _ZERO) for n in DEGREE_TWO]
    is_flat = sp.Le(quartic.terms, _number(TOUCHED))
    k, c, s = (quartic.plain.get(n, _ZERO) for n in (0, 1, -1))
    square = {2: (c - s) * (c + s) / 2, -2: c * s, 1: 2 * k * c, -1: 2 * k * s, 0: k**2 + (c**2 + s**2) / 2}
    own = {n: square[n] - quartic.factor**2 * quartic.square.get(n, _ZERO) for n in DEGREE_TWO}
    return [Select(is_flat, quartic.square.get(n, _ZERO), own[n]) for n in DEGREE_TWO]


def _apart() -> Iterator[Let]:
    """The angles, those that are nearly one moved apart: each is refined to the root next to it."""
    points = [(real(f"cosine_{k}"), real(f"sine_{k}")) for k in range(1, len(ANGLES) + 1)]
    for angle, (c, s) in zip(ANGLES, points, strict=True):
        yield from (Let(c, sp.cos(angle)), Let(s, sp.sin(angle)))
    for k, (x, y) in enumerate(points):
        distances = [(x - c) ** 2 + (y - s) ** 2 for c, s in points]
        near = [sp.And(m, sp.Le(d, (2 * _APART) ** 2)) for m, d in zip(MEETS, distances, strict=True)]
        before, behind = sp.Or(*near[:k]), sp.Or(*near[k + 1 :])
        yield Let(_BEGUN[k], ANGLES[k] + Select(behind, _APART, Select(before, -_APART, _ZERO)))
