"""A conic and the unit circle alone: against roots with sixty digits, and at roots that are not simple."""

from collections.abc import Sequence

import mpmath as mp
import numpy as np
import pytest
from numpy.typing import NDArray

from derive.ir.interpret import run
from derive.ir.program import Status
from derive.kinematics.scan.conic import ANGLES, COEFFICIENTS, MEETS, conic_program

Array = NDArray[np.float64]
PROGRAM = conic_program()


def meetings(conics: Array) -> tuple[Array, NDArray[np.bool_]]:
    """The four angles of every conic, and whether each is one."""
    outputs, status = run(PROGRAM, {name.name: conics[:, k] for k, name in enumerate(COEFFICIENTS)})
    assert (status == Status.OK).all()
    angles, meets = (
        np.stack([np.broadcast_to(outputs[n.name], len(conics)) for n in names], axis=1) for names in (ANGLES, MEETS)
    )
    assert np.isfinite(angles).all() and (np.abs(angles) <= np.pi + 0.03).all()
    return angles, meets.astype(bool)


def residuals(conics: Array, angles: Array) -> Array:
    """What is left at the angles, over the sum of the coefficients."""
    a, b, d, e, g = conics.T[:, :, None]
    left = a * np.cos(2 * angles) + b * np.sin(2 * angles) + d * np.cos(angles) + e * np.sin(angles) + g
    return np.asarray(np.abs(left) / np.abs(conics).sum(axis=1)[:, None])


def with_roots(angles: Sequence[float]) -> list[float]:
    """The conic that meets the circle at four angles: the product of the sines of half the distances from them.

    Of the product of z - exp(i angle), which half the sum of the angles turns until it is real on the circle.
    """
    with mp.workdps(60):
        product, turned = [mp.mpc(1)], mp.mpf(0)
        for angle in map(float, angles):
            root = mp.expj(angle)
            product = [p - root * q for p, q in zip([*product, 0], [0, *product], strict=True)]
            turned += mp.mpf(angle) / 2
        second, first, constant = (mp.expj(-turned) * p / 8 for p in product[:3])
        return [float(v) for v in (second.real, -second.imag, first.real, -first.imag, constant.real / 2)]


def exact(conic: Array) -> list[float]:
    """The angles of the roots, with sixty digits: those of a polynomial in exp(i t), refined from what NumPy finds."""
    with mp.workdps(60):
        a, b, d, e, g = (mp.mpf(float(v)) for v in conic)
        i = mp.mpc(0, 1)
        coefficients = [(a - i * b) / 2, (d - i * e) / 2, g, (d + i * e) / 2, (a + i * b) / 2]
        start = [*np.roots([complex(c) for c in coefficients])]
        roots = mp.polyroots(coefficients, 500, extraprec=400, roots_init=start)
        return [float(mp.arg(z)) for z in roots if abs(abs(z) - 1) < mp.mpf(10) ** -25]


def distance(one: Array | float, other: Array | float) -> Array:
    return np.abs(np.angle(np.exp(1j * (np.asarray(one) - np.asarray(other)))))


@pytest.mark.long
def test_all_roots_of_random_conics() -> None:
    """As many as there are, to rounding."""
    rng = np.random.default_rng(1)
    conics = rng.normal(size=(400, 5)) * 10.0 ** rng.uniform(-1.0, 1.0, (400, 5))
    angles, meets = meetings(conics)
    assert residuals(conics, angles)[meets].max() < 2e-15
    for conic, found in zip(conics, (a[m] for a, m in zip(angles, meets, strict=True)), strict=True):
        roots = exact(conic)
        assert len(found) == len(roots), conic
        assert all(distance(found, root).min() < 1e-13 for root in roots), conic


KINDS = {
    "double": lambda t, e: (t[0], t[0] + e, t[1], t[2]),
    "two double": lambda t, e: (t[0], t[0] + e, t[1], t[1] + e),
    "triple": lambda t, e: (t[0], t[0] + e, t[0] - 0.7 * e, t[1]),
    "fourfold": lambda t, e: (t[0], t[0] + e, t[0] - 0.7 * e, t[0] + 3 * e),
}
DIGITS = {"double": 5e-7, "two double": 5e-6, "triple": 2e-4, "fourfold": 5e-4}
"""The root, the third root and the fourth root of rounding, with what the other roots add."""


@pytest.mark.parametrize("apart", [0.0, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2])
@pytest.mark.parametrize("kind", KINDS)
def test_roots_that_are_nearly_one(kind: str, apart: float) -> None:
    """None is lost. The residual is at rounding, the angle has the digits that such a root has."""
    rng = np.random.default_rng(3)
    planted = [KINDS[kind](rng.uniform(-np.pi, np.pi) + np.array([0.0, 1.5, 3.5]), apart) for _ in range(60)]
    conics = np.array([with_roots(roots) for roots in planted])
    angles, meets = meetings(conics)
    assert meets.all() and residuals(conics, angles).max() < 2e-15
    for found, roots in zip(angles, planted, strict=True):
        assert all(distance(found, root).min() < DIGITS[kind] for root in roots)


@pytest.mark.parametrize("apart", [1e-6, 1e-5, 1e-4, 1e-3])
def test_both_of_two_near_roots_are_found(apart: float) -> None:
    rng = np.random.default_rng(4)
    planted = [KINDS["double"](rng.uniform(-np.pi, np.pi) + np.array([0.0, 1.5, 3.5]), apart) for _ in range(60)]
    angles, _ = meetings(np.array([with_roots(roots) for roots in planted]))
    for found, roots in zip(angles, planted, strict=True):
        assert all(distance(found, root).min() < apart / 3.0 for root in roots)


def test_every_change_of_sign_has_a_root() -> None:
    """Conics of zeros, ones and tiny numbers: without squares, degenerate, next to such."""
    rng = np.random.default_rng(5)
    sizes = np.array([0.0, 0.0, 1.0, -1.0, 0.5, -0.5, 2.0, 1e-3, -1e-3, 1e-8, -1e-8, 1e-12, 1e-16, -1e-16, 1e-30])
    conics = rng.choice(sizes, size=(4000, 5))
    conics = conics[np.abs(conics).max(axis=1) > 0.0]
    angles, meets = meetings(conics)
    grid = np.linspace(-np.pi, np.pi, 361) + 1e-3
    a, b, d, e, g = conics.T[:, :, None]
    values = a * np.cos(2 * grid) + b * np.sin(2 * grid) + d * np.cos(grid) + e * np.sin(grid) + g
    for row, k in np.argwhere((values[:, 1:] > 0.0) != (values[:, :-1] > 0.0)):
        found = angles[row][meets[row]]
        assert len(found) and distance(found, 0.5 * (grid[k] + grid[k + 1])).min() < 0.01, conics[row]


@pytest.mark.parametrize("scale", [1e-150, 1e-9, 1e9, 1e150, 1e300])
def test_the_scale_does_not_matter(scale: float) -> None:
    conics = np.random.default_rng(6).normal(size=(200, 5))
    (angles, meets), (again, met) = meetings(conics), meetings(conics * scale)
    assert (meets == met).all() and distance(angles, again)[meets].max() < 1e-12


def test_a_pair_of_lines_through_the_centre() -> None:
    """The resolvent has its root at an end, or two equal ones."""
    angles, meets = meetings(
        np.array([[1.0, 0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0, -1.0], [0.0, 1.0, 0.0, 0.0, 0.0]])
    )
    assert meets.all()
    wanted = np.array([[-135.0, -45.0, 45.0, 135.0], [0.0, 0.0, 180.0, 180.0], [0.0, 90.0, 180.0, 270.0]])
    for found, roots in zip(angles, np.radians(wanted), strict=True):
        assert max(distance(found, root).min() for root in roots) < 1e-15


@pytest.mark.parametrize("level", [0.0, 1.0, -1e-30, 1e-300])
def test_where_every_angle_is_a_root_or_none_no_angle_is_one(level: float) -> None:
    """The zero conic, which a conic that contains the circle is after its trace has been taken out, and a constant."""
    _, meets = meetings(np.array([[0.0, 0.0, 0.0, 0.0, level]]))
    assert not meets.any()
