"""The equations at poses of random machines, as arrays: to choose what is eliminated, and how."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from derive.ir.interpret import Array, evaluate
from derive.kinematics.search.elimination.line import SIZE, Move, axis_line
from derive.kinematics.search.elimination.ring import Fixed, Place, Ring

Values = Mapping[str, Array]


@dataclass(frozen=True)
class Numbers:
    """Both sides of the equations of a ring, for some poses.

    known: pose, power of the unknowns of c, of d, of e, value; with half angles of d and e
    eliminated: pose, power of the unknowns of a, of b, value
    """

    known: Array
    eliminated: Array


def numbers_of(ring: Ring, values: Values) -> Numbers:
    """The numbers of a ring. values: inputs, each with one number a pose."""
    a, b, c, d, e, f = ring.places
    line = _column(np.array(axis_line(f.axis), dtype=float)[:, 0], values)
    left = _through(line, ring.links[4], values)
    for place, link in ((e, 3), (d, 2)):
        left = _through(_halved(_spread(left, place), place), ring.links[link], values)
    left = _through(_spread(left, c), ring.links[1], values)
    right = _through(line, [x.inverse for x in reversed(ring.links[5])], values)
    right = _through(_spread(right, a.inverse), [x.inverse for x in reversed(ring.links[0])], values)
    right = _spread(right, b.inverse)
    return Numbers(left, np.swapaxes(right, 1, 2))


def halves(place: Place) -> Array:
    """How what a motion is linear in, 1 and two unknowns, is a sum of C², CS and S²; a column each. Cosine and sine of
    half the angle stand for C and S: so is no angle lost. Of a slide, C over S is the shift.
    """
    if place.joint.is_angle:
        return np.array([[1.0, 1.0, 0.0], [0.0, 0.0, 2.0], [1.0, -1.0, 0.0]])
    return np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])


def _column(line: Array, values: Values) -> Array:
    count = max(np.size(v) for v in values.values())
    return np.broadcast_to(line, (count, SIZE))


def _matrix(move: Move, values: Values, count: int) -> Array:
    """The change of a motion for every pose."""
    found = np.zeros((count, SIZE, SIZE))
    for part, factor in zip(move.parts, move.factors, strict=True):
        for (i, j), entry in sp.SparseMatrix(part).todok().items():
            found[:, i, j] += np.asarray(evaluate(sp.sympify(entry * factor), values), dtype=float)
    return found


def _through(lines: Array, link: Iterable[Fixed], values: Values) -> Array:
    """Lines behind a link: poses, any axes, values."""
    for fixed in reversed(tuple(link)):
        matrix = _matrix(fixed.move, values, len(lines))
        lines = np.einsum("nij,n...j->n...i", matrix, lines)
    return lines


def _spread(lines: Array, place: Place) -> Array:
    """Lines behind a joint: a new axis, in front of the others, for 1 and its two unknowns."""
    parts = [np.array(p, dtype=float) for p in place.move.parts]
    return np.stack([np.einsum("ij,n...j->n...i", p, lines) for p in parts], axis=1)


def _halved(lines: Array, place: Place) -> Array:
    found: Array = np.einsum("xk,nk...->nx...", halves(place), lines)
    return found
