"""The choice of an elimination: which joint is searched, which two are eliminated first, and by which equations.

The link between the two must not hold the pose, so that no pose is singular for their equations. Where axes meet or
are parallel, fewer of the linear equations are independent: then powers of both half angles are multiplied, and there
are more equations than are needed. Of all that is possible the choice falls on what tells the roots best: where the
determinant vanishes it should be steep, compared with all of its waves.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from derive.description.mechanism import Joint, Mechanism
from derive.equations.closures.fixed_names import fixed_lets
from derive.ir.interpret import Array, evaluate
from derive.kinematics.forward import pose_at_axes
from derive.kinematics.search.elimination.line import SIZE
from derive.kinematics.search.elimination.numbers import Numbers, numbers_of
from derive.kinematics.search.elimination.ring import JOINTS, Ring, ring_of
from derive.kinematics.search.samples import samples_of
from derive.work import counted

SEARCHED, FREE = 2, 5
"""The place of c, the joint that is searched, and of f, whose axis is the line."""
PRODUCTS = 8
"""Products of what a and b are linear in, besides 1."""
EQUATIONS = 6
"""Equations without a and b."""
_SHAPES = ((3, 2), (3, 3))
_POSES, _POSES_OF_EACH, _SELECTIONS, _ANGLES, _BEGIN = 6, 2, 40, 32, 0.1
_RIGHT_ANGLES = (0.0, 90.0, 180.0, -90.0)
_REGULAR, _SINGULAR, _NOTHING = 1e-8, 1e-12, 1e-10
_POOR = 0.1
"""The share of the poses by which a choice is judged: those where roots are told worst."""
_DIGITS = 1.0
"""So many digits a larger matrix must tell more."""

Row = tuple[int, int, int]
"""An equation, and the powers of the half angles of d and e by which it is multiplied."""


@dataclass(frozen=True)
class Elimination:
    """A ring begun at a, and the equations that are taken."""

    ring: Ring
    solved: tuple[int, ...]
    """The values (see `line`) whose equations give the products of a and b."""
    highest: tuple[int, int]
    """The highest powers of the half angles of d and e."""
    rows: tuple[Row, ...]
    degree: int
    """That of the determinant as a wave in the searched joint."""

    @property
    def searched(self) -> Joint:
        """The joint that is searched."""
        return self.ring.places[SEARCHED].joint

    @property
    def words(self) -> str:
        """How the other joints follow, in words."""
        a, b, _, d, e, f = (place.joint.name for place in self.ring.places)
        return (
            f"of 14 linear equations for the axis of {f} eight eliminate {a} and {b}; {self.columns} products of "
            f"powers of the half angles of {d} and {e} satisfy the others where a determinant vanishes"
        )

    @property
    def left(self) -> tuple[int, ...]:
        """The values whose equations are left without a and b."""
        return tuple(k for k in range(1, SIZE) if k not in self.solved)

    @property
    def columns(self) -> int:
        """The number of products of powers of the half angles: the size of the matrix."""
        return (self.highest[0] + 1) * (self.highest[1] + 1)


@dataclass(frozen=True)
class _Found:
    elimination: Elimination
    steepness: float
    """The decimal logarithm of the slope of the determinant at a root over the sum of its waves, at poor poses."""

    @property
    def score(self) -> float:
        """Larger is better."""
        return self.steepness - _DIGITS * _SHAPES.index(self.elimination.highest)


@counted
def elimination_of(mechanism: Mechanism, searched: Joint | None = None) -> Elimination | None:
    """The best elimination of an arm; None for a mechanism that has none. searched: the joint, where it is given."""
    ring = ring_of(mechanism)
    if ring is None:
        return None
    values = _samples(mechanism)
    for let in (*fixed_lets(mechanism), *ring.lets):
        values[let.name.name] = np.asarray(evaluate(let.value, values))
    return best_order(ring, values, searched)


def _samples(mechanism: Mechanism) -> dict[str, Array]:
    """Poses of random machines. A joint that is held stands anywhere, and as often at each right angle: there axes may
    be parallel or meet, and it stays there.
    """
    is_held = any(j.is_angle for j in mechanism.held_joints)
    each = _POSES_OF_EACH if is_held else _POSES
    angles = (None, *_RIGHT_ANGLES) if is_held else (None,)
    parts = [samples_of(mechanism, pose_at_axes(mechanism), each, angle) for angle in angles]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def best_order(ring: Ring, values: Mapping[str, Array], searched: Joint | None = None) -> Elimination | None:
    """The best elimination; None where there is none. values: inputs, one number for each of some poses of machines.

    searched: the joint, where it is given.
    """
    tried = (_tried(one, values, highest) for highest in _SHAPES for one in _orders(ring, searched))
    found = max((f for f in tried if f is not None), key=lambda f: f.score, default=None)
    return None if found is None else found.elimination


def _orders(ring: Ring, searched: Joint | None) -> Iterator[Ring]:
    for way, first in product((ring, ring.reversed), range(JOINTS)):
        begun = way.begun_at(first)
        line, known = begun.places[FREE].joint, begun.places[SEARCHED].joint
        if begun.has_pose(0) or begun.has_pose(FREE) or not (line.is_angle and known.is_angle and not known.free):
            continue
        if searched is None or known == searched:
            yield begun


def _tried(ring: Ring, values: Mapping[str, Array], highest: tuple[int, int]) -> _Found | None:
    numbers, random = numbers_of(ring, values), np.random.default_rng(0)
    products = numbers.eliminated.reshape(len(numbers.eliminated), PRODUCTS + 1, SIZE)
    solved = _independent(np.swapaxes(products[:, 1:], 1, 2))
    if solved is None:
        return None
    equations, all_rows = _eliminated(numbers, solved), rows_of(highest)
    whole = [np.stack([matrix_at(equations, r, highest, a) for r in all_rows], axis=1) for a in _angles()]
    table = np.stack(whole, axis=1)  # pose, angle, row, column
    best: _Found | None = None
    size = table.shape[3]
    for _ in range(_SELECTIONS if len(all_rows) > size else 1):
        rows = np.sort(random.permutation(len(all_rows))[:size])
        determinant = np.linalg.det(table[:, :, rows])
        if not _are_regular(table[:, :, rows]):
            continue
        chosen = tuple(all_rows[k] for k in rows)
        degree, steepness = (
            _degree(determinant),
            _steepness(determinant, values[ring.places[SEARCHED].joint.symbol.name]),
        )
        found = _Found(Elimination(ring, solved, highest, chosen, degree), steepness)
        best = found if best is None or found.score > best.score else best
    return best


def _are_regular(matrices: Array) -> bool:
    """Whether the matrices of most poses are regular at some of their angles."""
    regular = (1.0 / np.linalg.cond(matrices[:, ::8])).max(axis=1)
    return bool(np.mean(regular > _SINGULAR) > 1.0 - _POOR)


def _steepness(determinant: Array, roots: Array) -> float:
    """How well the determinant tells its roots. determinant: pose, angle; roots: one of each pose."""
    waves = np.fft.rfft(determinant, axis=1)
    waves[:, 1:] *= 2.0
    numbers = np.arange(waves.shape[1])
    turned = np.exp(1j * numbers * (roots[:, None] - _BEGIN))
    slopes = np.abs(np.sum((1j * numbers * waves * turned).real, axis=1)) / np.abs(waves).sum(axis=1)
    return float(np.log10(np.quantile(slopes, _POOR) + 1e-30))


def rows_of(highest: tuple[int, int]) -> list[Row]:
    """All equations that hold powers up to the highest."""
    return [(k, i, j) for k in range(EQUATIONS) for i in range(highest[0] - 1) for j in range(highest[1] - 1)]


def _angles() -> Array:
    return _BEGIN + 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES


def _independent(equations: Array) -> tuple[int, ...] | None:
    """The values whose equations determine the products at all poses; None where none do.

    One after the other that value is taken whose equation is furthest from those before, at poor poses.
    """
    rest, chosen = equations.copy(), list[int]()
    for _ in range(PRODUCTS):
        sizes = np.quantile(np.linalg.norm(rest, axis=2), _POOR, axis=0)
        best = int(np.argmax(sizes))
        if not sizes[best] > _REGULAR:
            return None
        chosen.append(best)
        along = rest[:, best] / np.maximum(np.linalg.norm(rest[:, best], axis=1, keepdims=True), _REGULAR)
        rest = rest - np.einsum("nrk,nk->nr", rest, along)[:, :, None] * along[:, None]
    return tuple(sorted(chosen))


def _eliminated(numbers: Numbers, solved: tuple[int, ...]) -> Array:
    """The equations without a and b: pose, equation, then c, d and e as in `known`."""
    known, count = np.moveaxis(numbers.known, -1, 1), len(numbers.known)
    products = np.swapaxes(numbers.eliminated.reshape(count, PRODUCTS + 1, SIZE), 1, 2)
    known = known - products[:, :, 0, None, None, None] * known[:, :1]
    left = [k for k in range(1, SIZE) if k not in solved]
    inner, outer = products[:, solved, 1:], products[:, left, 1:]
    factors = np.swapaxes(np.linalg.solve(np.swapaxes(inner, 1, 2), np.swapaxes(outer, 1, 2)), 1, 2)
    found: Array = known[:, left] - np.einsum("nrs,ns...->nr...", factors, known[:, solved])
    return found


def matrix_at(equations: Array, row: Row, highest: tuple[int, int], angle: float) -> Array:
    """One row of the matrix for every pose, with the searched joint at an angle."""
    k, i, j = row
    at_angle = equations[:, k, 0] + np.cos(angle) * equations[:, k, 1] + np.sin(angle) * equations[:, k, 2]
    found = np.zeros((len(equations), highest[0] + 1, highest[1] + 1))
    found[:, i : i + 3, j : j + 3] = at_angle
    return found.reshape(len(equations), -1)


def _degree(values: NDArray[np.float64]) -> int:
    """The highest wave in values at equal distances."""
    sizes = np.abs(np.fft.rfft(values, axis=1))
    present = np.flatnonzero((sizes > _NOTHING * sizes.max(axis=1, keepdims=True)).any(axis=0))
    return int(present.max(initial=0))
