"""Six-axis arms whose joints no subproblem solves: two are eliminated, and on the circle of one no root is lost."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from numpy.typing import NDArray
from sympy import pi

from derive.description.mechanism import Mechanism, Task, Turning, linear
from derive.description.validate import validate
from derive.geometry.frames import Chain, Rx, Rz, Tx, Ty, Tz, denavit_hartenberg
from derive.ir.interpret import run
from derive.ir.program import Status
from derive.ir.symbols import ROTATION_ENTRIES, branch_sign
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.sampling import machine_at
from derive.kinematics.search.derivations import solve_both
from derive.kinematics.search.elimination.line import Move, rotation, shift, turn
from derive.kinematics.search.loop.find import FIRST, LONGEST
from derive.kinematics.search.loop.parts import AHEAD_BY, DIRECTION, IS_ROUNDING, SAFE, look_program
from derive.kinematics.search.programs import START
from derive.kinematics.search.wave import FIFTH, NOISE, names_of, wave_program
from derive.mechanisms import kin_ac6_rzryryrxryrz_j6offset as arm
from derive.witness import witness
from derive.witness.onward import every_root
from tests.unit.kinematics.test_refusals import J, random_arm

Array = NDArray[np.float64]
A1, A2, A3, A4, A5, A6 = J[:6]
X3 = linear("X3", "slide")
SLIDING = (
    Rz(A1) * Tx(200) * Rx(2 * pi / 9) * Rz(A2) * Tx(150) * Ty(70) * Ty(-X3) * Rz(A4) * Tx(90) * Rx(pi / 3) * Rz(A5)
)
CHAINS = {
    "general": random_arm(2, 6, has_parameters=False).chain,
    "right angles": denavit_hartenberg(
        (A1, 300, 100, pi / 2), (A2, 50, 300, pi / 2), (A3, 60, 100, pi / 2), (A4, 200, 80, -pi / 2),
        (A5, 50, 60, pi / 2), (A6, 100, 0, 0),
    ),
    "slide": SLIDING * Tx(70) * Ty(90) * Rx(pi / 3) * Rz(A6),
    "oblique slide": Rz(A1) * Tx(200) * Rx(2 * pi / 9) * Rz(A2) * Tx(150) * Rx(pi / 5) * Tz(X3) * Tx(80) * Rx(pi / 7)
    * Rz(A4) * Tx(90) * Rx(pi / 3) * Rz(A5) * Tx(70) * Tz(90) * Rx(pi / 3) * Rz(A6),
}  # fmt: skip
DOTY = denavit_hartenberg(
    *((angle, d, a, sp.pi * twist / 180) for angle, d, a, twist in (
        (A1, 0, 300, 90), (A2, 0, 1000, 1), (A3, 200, 0, 90), (A4, 0, 1500, 1), (A5, 0, 0, 90), (A6, 0, 0, 1),
    ))
)  # fmt: skip
"""The arm of Manseur and Doty (1989), in mm, and a pose with 16 solutions, to six digits."""
SIXTEEN = np.array([[-0.760117, -0.641689, 0.102262], [0.133333, 0.0, 0.991071], [-0.635959, 0.766965, 0.085558]])
AT = (-1140.175, 0.0, 0.0)


@cache
def described(name: str) -> Mechanism:
    chain = DOTY if name == "Doty" else CHAINS[name]
    joints = tuple(j if j.symbol in {s for f in chain.factors for s in f.amount.free_symbols} else X3 for j in J[:6])
    return validate(Mechanism(name="Arm", joints=joints, chain=chain, task=Task("xyz", Turning.FULL)))


@cache
def built(name: str) -> Kinematics:
    return build(described(name))


def poses_of(chain: Chain, mechanism: Mechanism, joints: Array) -> Array:
    """The pose at joint values (radians, lengths), by the product of the chain alone."""
    symbols = [j.symbol for j in mechanism.joints]
    compute = sp.lambdify(symbols, chain.matrix().tolist(), "numpy")
    found = compute(*joints.T)
    return np.array([[np.broadcast_to(v, len(joints)) for v in row] for row in found], dtype=float).transpose(2, 0, 1)


def commanded(kin: Kinematics, poses: Array, axes: Array) -> dict[str, Array]:
    """Inputs of the programs of a machine. axes: the references."""
    machine = {n: np.broadcast_to(v, len(poses)) for n, v in machine_at(kin.mechanism).items()}
    constants, _ = run(kin.setup, machine)
    frame = {r.name: poses[:, k // 3, k % 3] for k, r in enumerate(ROTATION_ENTRIES)}
    frame |= {c: poses[:, k, 3] for k, c in enumerate("xyz")}
    references = {j.reference.name: axes[:, k] for k, j in enumerate(kin.mechanism.joints)}
    turns = {j.turn.name: np.zeros(len(poses)) for j in kin.period_joints}
    return machine | constants | frame | references | turns


@pytest.mark.slow
def test_every_motion_changes_the_values_of_a_line_linearly() -> None:

    def values(point: sp.Matrix, line: sp.Matrix) -> sp.Matrix:
        square, along = point.dot(point), point.dot(line)
        return sp.Matrix([1, *point, *line, square, along, *point.cross(line), *(square * line - 2 * along * point)])

    def agrees(move: Move, turned: sp.Matrix, shifted: sp.Matrix) -> bool:
        point, line = sp.Matrix(sp.symbols("p1:4")), sp.Matrix(sp.symbols("l1:4"))
        gap = move.matrix * values(point, line) - values(turned * point + shifted, turned * line)
        return gap.expand() == sp.zeros(15, 1)

    cosine, sine, amount = sp.Rational(3, 5), sp.Rational(4, 5), sp.Symbol("t")
    for axis in range(3):
        unit = sp.eye(3)[:, axis]
        matrix = cosine * sp.eye(3) + (1 - cosine) * unit * unit.T
        matrix += sine * sp.Matrix(3, 3, lambda i, j, k=axis: -sp.LeviCivita(i, j, k))
        assert agrees(turn(axis, cosine, sine), matrix, sp.zeros(3, 1))
        assert agrees(rotation(list(matrix)), matrix, sp.zeros(3, 1))
        assert agrees(shift(axis, amount), sp.eye(3), amount * unit)


@pytest.mark.slow
@pytest.mark.parametrize("name", CHAINS)
def test_the_solutions_are_those_that_many_starts_find(name: str) -> None:
    """The witness compares them at random poses of random machines, and plants poses next to singular ones."""
    evidence = witness(built(name), described(name))
    assert built(name).mechanism.search is not None and built(name).mechanism.search.is_eliminated
    assert evidence.inverted is not None and evidence.inverted.missed is not None
    assert evidence.inverted.missed[0] == 0 and evidence.inverted.solutions >= 4


@pytest.mark.slow
def test_sixteen_solutions() -> None:
    """A pose that is known to have as many as an arm can have; each leads to the pose."""
    kin = built("Doty")
    left, _, right = np.linalg.svd(SIXTEEN)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = left @ right, AT
    values = commanded(kin, pose[None], np.zeros((1, 6)))
    axes, found = every_root(kin, values)
    solutions = np.radians(axes[found[:, 0], 0])
    assert len(solutions) == 16
    apart = np.abs(np.exp(1j * solutions[:, None]) - np.exp(1j * solutions[None])).max(axis=2)
    assert np.all(apart + 2 * np.eye(16) > 1e-3)
    gaps = poses_of(DOTY, kin.mechanism, solutions) - pose
    assert np.abs(gaps[:, :3, :3]).max() < 1e-9 and np.abs(gaps[:, :3, 3]).max() < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("name", CHAINS)
def test_no_planted_pose_is_refused(name: str) -> None:
    """Joints near 180°, at right angles and anywhere, with the reference far away: the side of the planted joints has
    an answer, and it leads to the pose.
    """
    kin, rng, count = built(name), np.random.default_rng(3), 48
    joints = rng.uniform(-np.pi, np.pi, (count, 6))
    near = np.pi + 10.0 ** rng.uniform(-12.0, -1.0, joints.shape)
    joints = np.where(rng.random(joints.shape) < 0.4, near, joints)
    joints[::3] = np.round(joints[::3] / (np.pi / 2)) * np.pi / 2 + rng.choice([0.0, 1e-9], (len(joints[::3]), 6))
    joints[:, [not j.is_angle for j in kin.mechanism.joints]] *= 100.0
    axes = np.where([j.is_angle for j in kin.mechanism.joints], np.degrees(joints), joints)
    poses = poses_of(described(name).chain or Chain(()), kin.mechanism, joints)
    far = axes + rng.uniform(-170.0, 170.0, axes.shape)
    values = commanded(kin, poses, far)
    margins, _ = run(kin.forward, values | {j.axis.name: axes[:, k] for k, j in enumerate(kin.mechanism.joints)})
    side = np.where(margins["branch_crossing"] >= 0, 1.0, -1.0)
    answers, status = run(kin.branch, values | {branch_sign("crossing").name: side})
    # next to some poses of the slide a whole circle of the searched joint is rounding: of singular ones few are lost
    is_asked = np.abs(margins["branch_crossing"]) >= (1e-7 if "slide" in name else 0.0)
    assert np.all(status[is_asked] == Status.OK) and np.mean(status == Status.OK) > 0.9
    answered = np.stack([answers[j.axis.name] for j in kin.mechanism.joints], axis=1)
    answered = np.where([j.is_angle for j in kin.mechanism.joints], np.radians(answered), answered)
    gaps = poses_of(described(name).chain or Chain(()), kin.mechanism, answered) - poses
    gaps = gaps[status == Status.OK]
    assert np.abs(gaps[:, :3, :3]).max() < 1e-9 and np.abs(gaps[:, :3, 3]).max() < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize(("axes", "seed", "has_parameters"), [(6, 2, True), (7, 3, False), (8, 4, True)])
def test_random_arms_derive(axes: int, seed: int, has_parameters: bool) -> None:
    """Also those with joints that are held."""
    search = build(validate(random_arm(seed, axes, has_parameters=has_parameters))).mechanism.search
    assert search is not None and search.is_eliminated


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
