"""The pose of the true chain: between two turns stands one rigid frame, which the setup computes.

It is Rz(about) Rx(inclination) Rz(rest). The turn in front of it takes the first of these, and the rest stands in the
next frame: so a turn takes two rotations in a plane. A slide between two turns shifts the frame along a line.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from derive.algebra.normal_form import is_compound
from derive.description.mechanism import Mechanism, Turning
from derive.equations.closures.fixed_names import fixed_angles
from derive.equations.named_pose import NamedPose
from derive.form.deviations import true_factors
from derive.geometry.frames import Factor, Motion
from derive.geometry.pose import Screw
from derive.ir.constants import DEGREE
from derive.ir.primitives import Atan2
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, POSITION, ROTATION_ENTRIES, cosine, real, sine
from derive.kinematics.lost_digits.starts import GOAL

INNER = {name: real(f"{name.name}_inner") for name in GOAL}
"""The names of the commanded pose as it is between the first turn and the last one."""


@dataclass(frozen=True)
class Inner:
    """The pose that steps take: if the whole frame is commanded, that of the last turn as seen from the first one."""

    pose: NamedPose
    goal: tuple[Let, ...]
    """The statements for the goal as seen there: `INNER`; none if the pose is that of the flange."""
    sines: dict[sp.Basic, sp.Expr]
    """Sines and cosines of joints by those of the angles of the pose."""


def true_pose(mechanism: Mechanism) -> NamedPose:
    """The pose of a machine with deviations at its joint values; its screws are the motions alone."""
    return _whole(mechanism).pose()


def inner_pose(mechanism: Mechanism) -> Inner:
    """The pose that steps take. Slides in front of all turns, or behind them, stand in the pose of the flange."""
    frames = _passed(mechanism, is_inner=True)
    if mechanism.task.turning is not Turning.FULL or frames.base is None or frames.slides:
        frames = _whole(mechanism)
        return Inner(frames.pose(), (), frames.sines)
    turned = frames.with_names(_about_z(frames.pending), "end")
    frames.rotation = frames.named("at_end", frames.rotation * turned)
    pose, (base, back) = frames.pose(), frames.base
    tool = frames.with_names(frames.rigid, "end")
    place, turn = (frames.named("rigid_end", part) for part in (tool[:3, 3], tool[:3, :3]))
    goal = sp.Matrix(3, 3, [GOAL[n] for n in ROTATION_ENTRIES])
    rotation = frames.named("inner", back.T * goal * turn.T)
    frames.named("inner", back.T * (sp.Matrix([GOAL[n] for n in POSITION]) - base) - rotation * place)
    own = set(pose.statements)
    return Inner(pose, tuple(let for let in frames.lets.values() if let not in own), frames.sines)


def _whole(mechanism: Mechanism) -> _Frames:
    """The frames up to the flange."""
    frames = _passed(mechanism, is_inner=False)
    frames.close("tool")
    frames.rotation = frames.named("at_end", frames.rotation * frames.rigid[:3, :3])
    return frames


def _passed(mechanism: Mechanism, *, is_inner: bool) -> _Frames:
    """The frames up to the last motion. is_inner: as seen from the first turn."""
    off = {p.given_name: p.symbol for p in mechanism.parameters}
    moved = {j.symbol for j in mechanism.joints}
    frames = _Frames({a: a * DEGREE for a in fixed_angles(mechanism)}, is_inner)
    for factor in true_factors(mechanism, off):
        if not factor.amount.free_symbols & moved:
            frames.rigid = frames.rigid * factor.matrix()
        elif factor.motion is Motion.SHIFT:
            frames.slide(factor)
        else:
            frames.turn(factor)
    return frames


@dataclass
class _Frames:
    fixed: dict[sp.Symbol, sp.Expr]
    """The angles of the machine in radians."""
    is_inner: bool
    """Whether the pose is that as seen from the first turn."""
    lets: dict[sp.Symbol, Let] = field(default_factory=dict)
    position: sp.Matrix = field(default_factory=lambda: sp.zeros(3, 1))
    rotation: sp.Matrix = field(default_factory=lambda: sp.eye(3))
    screws: list[Screw] = field(default_factory=list)
    rigid: sp.Matrix = field(default_factory=lambda: sp.eye(4))
    """The rigid frame since the last turn."""
    slides: list[tuple[Factor, sp.Matrix]] = field(default_factory=list)
    """The slides since the last turn, each with its direction."""
    pending: sp.Expr | None = None
    """The angle of the last turn, which is about z."""
    sines: dict[sp.Basic, sp.Expr] = field(default_factory=dict)
    """Those of the turns so far, by the sines of what the frames behind them add and of the sums."""
    base: tuple[sp.Matrix, sp.Matrix] | None = None
    """If the first turn is the base: its position and rotation."""

    def pose(self) -> NamedPose:
        """The pose so far."""
        return NamedPose(tuple(self.lets.values()), tuple(self.position), tuple(self.rotation), tuple(self.screws))

    def turn(self, factor: Factor) -> None:
        """Go on to a turn: its axis is the z axis of the frame."""
        own = sp.eye(4).extract(range(4), [*((factor.axis + k) % 3 for k in (1, 2, 3)), 3])
        self.rigid = self.rigid * own
        self.close(f"motion_{sum(s.motion is not Motion.SHIFT for s in self.screws) + 1}")
        direction, origin = sp.ImmutableMatrix(self.rotation[:, 2]), sp.ImmutableMatrix(self.position)
        self.screws.append(Screw(factor.motion, factor.amount, direction, origin))
        self.rigid, self.pending = self.rigid * own.T, factor.amount

    def slide(self, factor: Factor) -> None:
        """Go on to a slide. The rigid frame in front of it has names: it stands in those of all further slides."""
        turn, place = self._rigid_named(f"slide_{len(self.slides)}_of_motion_{len(self.screws) + 1}")
        self.rigid = turn.row_join(place).col_join(sp.Matrix([[0, 0, 0, 1]]))
        self.slides.append((factor, turn[:, factor.axis]))

    def _rigid_named(self, word: str) -> tuple[sp.Matrix, sp.Matrix]:
        """Rotation and position of the rigid frame, with names."""
        frame = self.with_names(self.rigid, word)
        return self.named(f"rigid_{word}", frame[:3, :3]), self.named(f"rigid_{word}", frame[:3, 3])

    def close(self, word: str) -> None:
        """Compose with the last turn and with the rigid frame behind it; the rest of it begins the next one."""
        turn, place = self._rigid_named(word)
        lines = [line for _, line in self.slides]
        self.rigid, inclined = sp.eye(4), turn
        if self.is_inner and self.pending is None and not self.slides:
            self.base = place, turn
            return
        if self.pending is not None:
            about, angle = real(f"angle_about_{word}"), real(f"angle_{word}")
            self.lets[about] = Let(about, Atan2(turn[0, 2], -turn[1, 2]))
            back = self.with_names(_about_z(-about), word)
            turn, place = self.named(f"rest_{word}", back * turn), self.named(f"rest_{word}", back * place)
            lines = [self.named(f"rest_{k}_{word}", back * line) for k, line in enumerate(lines)]
            self.rigid[:2, :2] = sp.Matrix([[turn[0, 0], turn[0, 1]], [-turn[0, 1], turn[0, 0]]])
            inclined = sp.Matrix([[1, 0, 0], [0, turn[2, 2], turn[1, 2]], [0, -turn[1, 2], turn[2, 2]]])
            self.lets[angle] = Let(angle, self.pending + about)
            turned = self.with_names(_about_z(angle), word)
            own = self.with_names(_about_z(-about), word) * turned
            self.sines |= {sp.cos(self.pending): own[0, 0], sp.sin(self.pending): own[1, 0]}
            self.rotation = self.named(f"turned_{word}", self.rotation * turned)
        for k, (slide, _) in enumerate(self.slides):
            direction = sp.ImmutableMatrix(self.named(f"line_{k}_{word}", self.rotation * lines[k]))
            self.screws.append(Screw(slide.motion, slide.amount, direction, sp.ImmutableMatrix(self.position)))
            place = place + lines[k] * slide.amount
        place = self.named(f"slid_{word}", place)
        self.position = self.named(f"at_{word}", self.position + self.rotation * place)
        self.rotation, self.slides = self.named(f"at_{word}", self.rotation * inclined), []

    def with_names(self, matrix: sp.Matrix, word: str) -> sp.Matrix:
        """The matrix with names for its sines and cosines."""
        table: dict[sp.Basic, sp.Symbol] = {}
        known = {value: a for a, value in self.fixed.items()}
        for function in sorted(matrix.atoms(sp.sin, sp.cos), key=sp.default_sort_key):
            angle = function.args[0]
            own = known.setdefault(angle, angle if angle.is_Symbol else real(f"angle_{len(known)}_of_{word}"))
            name = (sine if isinstance(function, sp.sin) else cosine)(own)
            table[function], self.lets[name] = name, Let(name, function)
        return matrix.xreplace(table)

    def named(self, word: str, matrix: sp.Matrix) -> sp.Matrix:
        """The matrix with a name for each compound entry."""
        names = COORDINATE_NAMES if matrix.cols == 1 else [f"r{i}{j}" for i in "123" for j in "123"]
        found = []
        for name, value in zip(names, matrix, strict=True):
            symbol = real(f"{name}_{word}")
            if is_compound(value):
                self.lets[symbol] = Let(symbol, value)
            found.append(symbol if is_compound(value) else value)
        return sp.Matrix(matrix.rows, matrix.cols, found)


def _about_z(angle: sp.Expr) -> sp.Matrix:
    return sp.Matrix([[sp.cos(angle), -sp.sin(angle), 0], [sp.sin(angle), sp.cos(angle), 0], [0, 0, 1]])
