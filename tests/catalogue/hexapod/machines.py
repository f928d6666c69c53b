"""Hexapods, symmetric and not, by definition alone, and the programs that the build gives."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray
from softkin import Hexapod

from derive.ir.interpret import run
from derive.ir.program import Call, Iterate, Program, Require, Statement
from derive.ir.reason import Why, about_machine
from derive.kinematics.kinematics import Kinematics
from derive.mechanisms.kin_hexapod import MECHANISM
from tests.mechanisms import kinematics_of, named
from tests.orthonormal import turned

Array = NDArray[np.float64]

# LinuxCNC, genhexkins, its default geometry (inch)
INCH_BASE = ((-22.95, 13.25), (22.95, 13.25), (22.95, 13.25), (0, -26.5), (0, -26.5), (-22.95, 13.25))
INCH_PLATFORM = ((-1, 11.5), (1, 11.5), (10.459, -4.884), (9.459, -6.616), (-9.459, -6.616), (-10.459, -4.884))


class Machine:
    """A hexapod: where its joints are, its home pose, and how far a realistic workspace reaches around that."""

    def __init__(self, base: Array, platform: Array, home: tuple[float, ...], shift: float, **more: float) -> None:
        self.base, self.platform, self.home, self.shift = base, platform, np.array(home, dtype=float), shift
        self.given = {
            f"{side}_{i + 1}_{c}": float(points[i][k])
            for side, points in (("base", base), ("platform", platform))
            for i in range(6)
            for k, c in enumerate("xyz")
        }
        self.given |= {f"home_{n}": float(v) for n, v in zip("x y z roll pitch yaw".split(), home, strict=True)} | more
        self.robot = Hexapod(**self.given)
        self.offsets = np.array([self.given.get(f"offset_l{i}", 0.0) for i in range(1, 7)])

    @property
    def home_turn(self) -> Array:
        return rotation(*self.home[3:])

    def poses(self, count: int, turn: float = 25.0) -> tuple[Array, Array]:
        """Poses all over a realistic workspace: shifted each way, and turned by each angle, away from home."""
        away = np.random.default_rng(count).uniform(-1.0, 1.0, (count, 6)) * ([self.shift] * 3 + [turn] * 3)
        return self.home[:3] + away[:, :3], rotations(away[:, 3:]) @ self.home_turn

    def path(self, count: int = 1000) -> tuple[Array, Array]:
        """A closed path through home that moves all coordinates at once."""
        phase = np.linspace(0.0, 2 * np.pi, count)[:, None] * (1, 2, 3, 2, 1, 3)
        away = np.sin(phase) * ([self.shift] * 3 + [20.0] * 3)
        return self.home[:3] + away[:, :3], rotations(away[:, 3:]) @ self.home_turn

    def spans(self, positions: Array, turns: Array) -> Array:
        """From the joints on the base to those on the platform."""
        return positions[..., None, :] + np.einsum("...ij,kj->...ki", turns, self.platform) - self.base

    def axes(self, positions: Array, turns: Array) -> Array:
        """Axis values by definition: the lengths of the spans, and the offsets."""
        return np.linalg.norm(self.spans(positions, turns), axis=-1) + self.offsets

    def rows(self, position: Array, turn: Array) -> Array:
        """How lengths change with a twist of the platform: direction, and moment, of every leg."""
        spans = self.spans(position, turn)
        along = spans / np.linalg.norm(spans, axis=1)[:, None]
        return np.concatenate([along, np.cross(self.platform @ turn.T, along)], axis=1)

    def side(self, position: Array, turn: Array) -> float:
        """The sign of the determinant: the assembly mode."""
        return float(np.sign(np.linalg.det(self.rows(position, turn))))

    def normalised(self, position: Array, turn: Array) -> float:
        """The determinant with moments over the platform's radius."""
        centred = self.platform - self.platform.mean(axis=0)
        radius = np.sqrt((centred**2).sum(axis=1).mean())
        return float(np.linalg.det(self.rows(position, turn)) / radius**3)


def rotations(degrees: Array) -> Array:
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    roll, pitch, yaw = np.radians(degrees).T
    return np.asarray(turned(2, yaw) @ turned(1, pitch) @ turned(0, roll))


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """The same of one pose."""
    return np.asarray(rotations(np.array([[roll, pitch, yaw]], dtype=float))[0])


def flat(points: tuple[tuple[float, float], ...]) -> Array:
    return np.array([(x, y, 0.0) for x, y in points])


@cache
def machines() -> dict[str, Machine]:
    """Symmetric ones, and one without any symmetry; hanging, sideways, with a tool, with offsets."""
    nominal = {p.name: p.nominal for p in MECHANISM.parameters}
    base, platform = (
        np.array([[nominal[f"{s}_{i}_{c}"] for c in "xyz"] for i in range(1, 7)]) for s in ("base", "platform")
    )
    strange = np.random.default_rng(5).uniform(-60.0, 60.0, (2, 6, 3))
    tool = np.array([0.0, 0.0, -120.0])
    return {
        "inch": Machine(flat(INCH_BASE), flat(INCH_PLATFORM), (0, 0, 20, 0, 0, 0), 7.0),
        "nominal": Machine(base, platform, (0, 0, 600, 0, 0, 0), 180.0),
        "asymmetric": Machine(
            base + strange[0], platform + strange[1], (30, -20, 580, 5, -4, 10), 150.0, offset_l1=12.0, offset_l5=-40.0
        ),
        "lopsided": Machine(
            base + 2.0 * strange[1],
            platform - strange[0],
            (-60, 40, 520, -6, 8, -12),
            110.0,
            offset_l2=-300.0,
            offset_l4=5.0,
        ),
        "hanging, with a tool": Machine(base, (platform + tool) * (1, -1, -1), (0, 0, -600, 180, 0, 0), 120.0),
        "sideways": Machine(base[:, [2, 1, 0]] * (1, 1, -1), platform, (600, 0, 0, 0, 90, 0), 120.0),
    }


NAMES = ("inch", "nominal", "asymmetric", "lopsided", "hanging, with a tool", "sideways")


Statuses = NDArray[np.object_]


def kinematics() -> Kinematics:
    return kinematics_of(named("Kin_Hexapod"))


@cache
def constants(machine: Machine) -> Mapping[str, Array]:
    """What Initialize computes for a machine."""
    kin = kinematics()
    settings = {p.name: machine.given.get(p.name, p.default or 0.0) for p in kin.parameters}
    values, _ = run(kin.setup, {name: np.asarray(float(v)) for name, v in settings.items()})
    return values


def search_changed(change: Callable[[Statement], Statement | None]) -> Program:
    """Forward kinematics from a given start, with the statements of its search changed, or left out."""
    program = kinematics().forward

    def changed(search: Program) -> Program:
        return replace(search, body=tuple(new for s in search.body if (new := change(s)) is not None))

    return replace(
        program, body=tuple(replace(s, program=changed(s.program)) if isinstance(s, Call) else s for s in program.body)
    )


def found_from(
    program: Program, machine: Machine, axes: Array, positions: Array, turns: Array
) -> tuple[Array, Statuses]:
    """Positions and statuses, every row from a start of its own."""
    given = dict(constants(machine)) | {f"axis_l{i + 1}": axes[:, i] for i in range(6)}
    given |= {f"start_{c}": positions[:, i] for i, c in enumerate("xyz")}
    given |= {f"start_r{i + 1}{k + 1}": turns[:, i, k] for i in range(3) for k in range(3)}
    outputs, status = run(program, given)
    return np.stack([outputs[c] for c in "xyz"], axis=1), status


def bounded(passes: int) -> Program:
    """The same with another limit of passes."""
    return search_changed(lambda s: replace(s, limit=passes) if isinstance(s, Iterate) else s)


def without_mode() -> Program:
    """The same without the test of the assembly mode."""
    return search_changed(
        lambda s: None if isinstance(s, Require) and s.reason == about_machine(Why.OTHER_ASSEMBLY) else s
    )
