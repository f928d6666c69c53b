"""Six-axis arms whose joints no subproblem solves: two are eliminated, the others follow, and no solution is lost."""

from functools import cache

import numpy as np
import pytest
import sympy as sp
from numpy.typing import NDArray
from sympy import pi

from derive.description.mechanism import Mechanism, Task, Turning, linear
from derive.description.validate import validate
from derive.geometry.frames import Chain, Rx, Rz, Tx, Ty, denavit_hartenberg
from derive.ir.interpret import run
from derive.ir.program import Status
from derive.ir.symbols import ROTATION_ENTRIES, branch_sign
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.sampling import machine_at
from derive.kinematics.scan.elimination.line import Move, rotation, shift, turn
from derive.witness import witness
from derive.witness.onward import every_root
from tests.unit.kinematics.test_refused_within_bounds import J, random_arm

pytestmark = pytest.mark.slow
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


def test_every_motion_changes_the_values_of_a_line_linearly() -> None:
    """The values behind a motion are those of the moved line, exactly."""

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


@pytest.mark.parametrize("name", CHAINS)
def test_the_solutions_are_those_that_many_starts_find(name: str) -> None:
    """The witness compares them at random poses of random machines, and plants poses next to singular ones."""
    evidence = witness(built(name), described(name))
    assert built(name).mechanism.search is not None and built(name).mechanism.search.is_eliminated
    assert evidence.inverted is not None and evidence.inverted.missed is not None
    assert evidence.inverted.missed[0] == 0 and evidence.inverted.solutions >= 4


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
    is_asked = np.abs(margins["branch_crossing"]) >= (1e-7 if name == "slide" else 0.0)
    assert np.all(status[is_asked] == Status.OK) and np.mean(status == Status.OK) > 0.9
    answered = np.stack([answers[j.axis.name] for j in kin.mechanism.joints], axis=1)
    answered = np.where([j.is_angle for j in kin.mechanism.joints], np.radians(answered), answered)
    gaps = poses_of(described(name).chain or Chain(()), kin.mechanism, answered) - poses
    gaps = gaps[status == Status.OK]
    assert np.abs(gaps[:, :3, :3]).max() < 1e-9 and np.abs(gaps[:, :3, 3]).max() < 1e-6


@pytest.mark.parametrize(("axes", "seed", "has_parameters"), [(6, 2, True), (7, 3, False), (8, 4, True)])
def test_random_arms_derive(axes: int, seed: int, has_parameters: bool) -> None:
    """Also those with joints that are held."""
    search = build(validate(random_arm(seed, axes, has_parameters=has_parameters))).mechanism.search
    assert search is not None and search.is_eliminated
