"""The parts of a circle in which a wave may vanish: every root of a wave with known roots is in one, however near two
are to each other, and the way around the circle is short.
"""

import numpy as np
import pytest

from derive.ir.interpret import run
from derive.kinematics.scan.derivations import solve_both
from derive.kinematics.scan.parts import AHEAD_BY, DIRECTION, IS_ROUNDING, SAFE, look_program
from derive.kinematics.scan.programs import START
from derive.kinematics.scan.search import FIRST, LONGEST
from derive.kinematics.scan.wave import FIFTH, NOISE, names_of, wave_program
from derive.mechanisms import kin_ac6_rzryryrxryrz_j6offset as arm
from tests.machines.made import Array

TURN = 2.0 * np.pi


def wave(roots: Array) -> dict[str, Array]:
    """The wave with these roots, an even number, and the largest coefficient 1."""
    degree = len(roots) // 2
    t = np.arange(4 * degree) * TURN / (4 * degree)
    values = np.prod(np.sin((t[:, None] - roots) / 2.0), axis=1)
    found = 2.0 * np.fft.rfft(values)[: degree + 1] / len(t)
    cosines, sines = found.real, -found.imag[1:]
    cosines[0] /= 2.0
    coefficients = np.array([*cosines, *sines])
    coefficients /= np.abs(coefficients).max()
    orders = np.array([*range(degree + 1), *range(1, degree + 1)])
    given = {n.name: c for n, c in zip(names_of(degree), coefficients, strict=True)}
    return given | {NOISE.name: np.array(3e-14), FIFTH.name: np.sum(orders**5 / 120.0 * np.abs(coefficients))}


def parts(roots: Array, start: float, direction: int) -> tuple[list[tuple[float, float]], int]:
    """The parts as the search finds them (radians ahead of the start), and how often it looks at the wave."""
    program, given = look_program(len(roots) // 2), wave(roots)
    given |= {START.name: np.array(start), DIRECTION.name: np.array(direction)}
    place, width, looks, found = 0.0, 0.0, 0, []
    while place < TURN or width > 0.0:
        said, _ = run(program, {**given, AHEAD_BY.name: np.array(place + width)})
        looks += 1
        if width > 0.0 and (not said[IS_ROUNDING.name] or width >= float(LONGEST)):
            found.append((place, place + width))
            place, width = place + width, 0.0
        elif width > 0.0:
            width *= 2.0
        elif said[IS_ROUNDING.name]:
            width = float(FIRST)
        else:
            place += float(said[SAFE.name])
    return found, looks


@pytest.mark.parametrize("direction", (1, -1))
@pytest.mark.parametrize("apart", (0.3, 1e-1, 1e-3, 1e-6, 1e-9, 0.0))
@pytest.mark.parametrize("degree", (1, 2, 4, 8))
def test_every_root_is_in_a_part(degree: int, apart: float, direction: int) -> None:
    """Single roots, two and three close to each other."""
    rng = np.random.default_rng(degree)
    for _ in range(2):
        roots = rng.uniform(0.0, TURN, 2 * degree)
        roots[1] = roots[0] + apart
        roots[-1] = roots[0] - apart if degree > 2 else roots[-1]
        start = float(rng.uniform(-9.0, 9.0))
        found, looks = parts(roots, start, direction)
        ahead = (direction * (roots - start)) % TURN
        # roots that are two or three times the same are rounded by the second or third root of the rounding
        slack = 1e-10 if apart > 1e-2 else 1e-6 if degree <= 2 else 1e-3
        for root in ahead:
            assert any(low - slack <= root <= high + slack for low, high in found)
        assert looks <= 60 + 40 * degree
        assert all(high - low < 0.1 + 3.0 * apart for low, high in found)


def test_a_wave_without_roots_has_no_part() -> None:
    given = {n.name: np.array(v) for n, v in zip(names_of(1), (2.0, 0.5, 0.5), strict=True)}
    given |= {NOISE.name: np.array(1e-13), FIFTH.name: np.array(1.0 / 120.0), START.name: np.array(0.0)}
    angles = np.linspace(0.0, TURN, 50)
    said, _ = run(look_program(1), {**given, DIRECTION.name: np.array(1), AHEAD_BY.name: angles})
    assert not said[IS_ROUNDING.name].any() and (said[SAFE.name] > 0.3).all()


def test_the_residuals_of_all_branches_are_a_wave_of_degree_eight() -> None:
    """Of an arm with six turning axes: there are at most 16 solutions."""
    assert wave_program(solve_both(arm.MECHANISM))[1] == 8
