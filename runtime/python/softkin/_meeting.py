"""The inverse of a serial machine with deviations.

The closed form of the nominal machine takes the branch and the turns; from there steps of the true chain's own Jacobian
meet the frame. Where they do not, as next to a singular pose, the nominal machine is asked for a frame that is moved by
what was missed, and the steps begin again. All is bounded: what is not met is refused, with the amount that is missing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product as every
from math import atan2, hypot
from typing import TYPE_CHECKING, NamedTuple

from softkin._chain import Chain, Placed, columns, passed
from softkin._core import TWIST
from softkin._frame import IDENTITY, ORIGIN, Frame
from softkin._scalar import reasonable, solve
from softkin._tools import TILTS
from softkin._types import Diagnosis, Reals, Rotation, Signs, Status, Turns, Vector
from softkin._vectors import cross, dot, plus, product, times, transposed, turned

if TYPE_CHECKING:
    from softkin._calibrated import Calibrated

STEPS = 60
"""The most steps from one start."""
ROUNDS = 12
"""The most frames of which the nominal machine is asked, each moved by what was missed at the one before."""
MET, SETTLED = 1e-12, 1e-15
"""A frame is met where it is missed by at most this, in radians and in shares of the reach; steps end at the second."""
LONGEST = 0.3
"""The longest step, in radians and in shares of the reach."""
LEAST_DAMPED, MOST_DAMPED = 1e-9, 1e3
"""The damping of a step where the undamped one comes no nearer, and that with which no step does."""
IDLE, GAIN = 4, 0.95
"""Steps end after as many as the first that each leave more than this share of what was missed."""
SIZES = (0.1, 0.5, 2.0, 8.0)
"""Where the nominal machine does not reach a frame: how far it is moved, in shares of the size of the deviations."""
DIRECTIONS = tuple(d for d in every((0.0, 1.0, -1.0), repeat=3) if any(d))
"""The directions in which it is moved."""
STRAYED = 2e-6
"""A solution is on another branch where a margin has the other sign and is larger than this."""
NEAR = 0.05
"""A frame is near where it is missed by less, in radians and shares of the reach."""
FOLDED = (0.02, -0.02, 0.1, -0.1, 0.3, -0.3, 0.8, -0.8, 1.6, -1.6)
"""How far beside a pose where branches meet the steps begin again, in radians and shares of the reach."""
PASSES = 4
"""The passes in which a motion is found that moves the frame least."""
ANOTHER_TURN = 90.0
"""Axis values that differ by more than this are on different turns."""
FOLLOWED = ("pitch", "roll")
"""The rows of a Jacobian about the last axes of a chain."""
STARTS, LATTICE, TURN = 113, 3, 360.0
"""The starts all around: each turns the k-th axis by `LATTICE` to the power of k parts of `STARTS` more."""
ENOUGH = 16
"""After so many starts of which none leads near the frame, it is out of reach."""
PULLS, DAMPED = 30, 0.01
"""The most steps from such a start, and their damping, as a share of what is missed."""
BEYOND_ALL = 2.0
"""What is missed by more than the deviations times this is out of reach."""
BEYOND = "the machine as measured does not reach it [u]"
OTHER_BRANCH = "the machine as measured reaches it on another branch alone"
NO_AXIS = "the machine as measured has no axis for a coordinate that is commanded beside its plane [u]"


class Direction(NamedTuple):
    """A direction in which a frame must be met, for one row of the Jacobian."""

    turns: bool
    along: Vector


class At(NamedTuple):
    """The true machine at some axis values, and what it misses of a frame there."""

    axes: Reals
    tool: Placed
    lines: Sequence[Placed]
    missed: Reals
    """By direction; lengths in shares of the reach."""

    @property
    def size(self) -> float:
        """The size of what is missed."""
        return hypot(*self.missed)


class Meeting:
    """The inverse of one machine."""

    def __init__(self, machine: Calibrated, chain: Chain, base: Rotation, rows: Sequence[str]) -> None:
        """rows: those of the Jacobian of the bare machine, in the axes of its base."""
        self.machine, self.chain, self.rows = machine, chain, rows
        self.along: tuple[Vector, ...] = transposed(base)
        self.sliding = frozenset(i for i, axis in enumerate(machine.AXES) if axis.unit == "u")
        self.free = [i for i in range(len(machine.AXES)) if i not in machine.HELD]
        self.reach = sum(hypot(*position) for position, _ in chain.frames) or 1.0
        self.off = machine._size(self.reach)
        image, home = machine.nominal._image(), machine.nominal._forward(machine._zeros)
        about = (0.0, 0.0, 1.0) if isinstance(image, Status) else image[1]
        self.about = about if sum(name in TWIST[3:] for name in rows) == 1 else None
        self.home: Placed = (ORIGIN, IDENTITY) if isinstance(home, Status) else home[:2]
        self.fixed = tuple(d for name, d in zip(TWIST, self.along, strict=False) if name not in rows)
        self.lines = [k for k, joint in enumerate(chain.joints) if joint.turns][-sum(n in FOLLOWED for n in rows) :]

    def branch(self, target: Placed, signs: Signs, turns: Turns, reference: Reals) -> Reals | Diagnosis:
        """The axes on one branch, on their turns; limits are not tested."""
        found = self._met(target, signs, turns, reference)
        if isinstance(found, Diagnosis):
            return found
        if any(turns) or self._far(found.axes, reference) or self.machine._beyond_limits(found.axes):
            found = self._on_turns(found, target, signs, turns, reference)
            shifted = self._shifted(found.axes, turns, reference)
            is_other = any(n and n != own for n, own in zip(turns, self.machine._periods(found.axes), strict=True))
            if is_other or self.machine._beyond_limits(found.axes) and not self.machine._beyond_limits(shifted):
                found = found._replace(axes=shifted)
        return found.axes if len(self.fixed) == 3 else self._in_plane(found, target)

    def _on_turns(self, found: At, target: Placed, signs: Signs, turns: Turns, reference: Reals) -> At:
        """The same joints on the turns that the nominal machine takes: it is asked for its own frame there."""
        nominal = self.machine.nominal
        pose = nominal._forward(found.axes)
        axes = pose if isinstance(pose, Status) else nominal._branch(pose[0], pose[1], signs, turns, reference)
        if isinstance(axes, Status | Diagnosis) or not self._far(found.axes, axes):
            return found
        again = self._stepped(self._at(axes, target), target)
        return again if self._is_met(again, signs) else found

    def _shifted(self, axes: Reals, turns: Turns, reference: Reals) -> Reals:
        """The axes after whole turns of their joints: on the turns that are named, else next to the reference. Next to
        a singular pose the nominal machine, asked for its own frame, may have other joints, and not tell the turns.
        """
        found = list(axes)
        for i, number, size in zip(self.machine.PERIOD_AXES, turns, self.machine._turn_sizes(), strict=True):
            turn = 360.0 / (size * self.machine._gains[i])
            wanted = 360.0 * (number - 1 if number > 0 else number) / size if number else reference[i]
            found[i] += turn * round((wanted - found[i]) / turn) if reasonable(wanted) else 0.0
        return tuple(found)

    def _far(self, axes: Reals, others: Reals) -> bool:
        """Whether axes are so far from others that they may be on another turn."""
        return max((abs(a - b) for a, b in zip(axes, others, strict=True)), default=0.0) > ANOTHER_TURN

    def _met(self, target: Placed, signs: Signs, turns: Turns, reference: Reals) -> At | Diagnosis:
        """The true machine where it meets the frame on the branch: at last from anywhere. Of a searched machine a
        branch may have several solutions; and next to where branches meet one may be on the other branch.
        """
        found = self._met_on_branch(target, signs, turns, reference)
        if not isinstance(found, Diagnosis) or found.status is not Status.UNREACHABLE:
            return found
        least = BEYOND_ALL
        for number, axes in enumerate(self._anywhere(target, reference)):
            pulled = self._pulled(self._at(axes, target), target)
            at = self._across(self._stepped(pulled, target), target, signs, turns, reference)
            if self._is_met(at, signs):
                return at
            least = min(least, at.size)
            if number >= ENOUGH and least > NEAR:
                break
        return found

    def _anywhere(self, target: Placed, reference: Reals) -> Iterator[Reals]:
        """The axes of all solutions of the nominal machine; if it is searched, then axes all around."""
        for _, axes in self.machine.nominal._every_solution(*target, self.machine._actual(reference)):
            if not isinstance(axes, Diagnosis):
                yield self.machine._commanded(axes)
        if self.machine.nominal._has_one_solution_a_branch() or not reasonable(*reference, *target[0]):
            return
        angles = [i for i in self.free if i not in self.sliding]
        for number in range(STARTS):
            turned = {i: TURN * (number * LATTICE**k % STARTS) / STARTS for k, i in enumerate(angles)}
            yield tuple([value + turned.get(i, 0.0) for i, value in enumerate(reference)])

    def _pulled(self, at: At, target: Placed) -> At:
        """Where damped steps lead, however far that is; each is taken, whatever it leaves."""
        for _ in range(PULLS):
            step = None if at.size < NEAR else self._step(at, target, DAMPED * at.size)
            if step is None:
                break
            at = self._at(step, target)
        return at

    def _met_on_branch(self, target: Placed, signs: Signs, turns: Turns, reference: Reals) -> At | Diagnosis:
        """The true machine where it meets the frame on the branch: from the reference, if that is near; so a path goes
        on where two solutions of a branch are near to each other.
        """
        if reasonable(*reference, *target[0]):
            at = self._at(reference, target)
            if at.size < NEAR and self._is_met(found := self._stepped(at, target), signs):
                return found
        start = self._start(target, signs, turns, reference)
        if isinstance(start, Diagnosis):
            return start
        moved, at = target, self._at(start, target)
        least = self._stepped(at, target)
        if least.size > BEYOND_ALL * self.off:
            return self._refused(least, target)
        for _ in range(ROUNDS):
            if self._is_met(least, signs):
                return least
            moved = self._moved(moved, target, at)
            axes = self._nominal(moved, signs, turns, reference)
            if isinstance(axes, Diagnosis):
                break
            at = self._at(axes, target)
            least = self._better(least, self._across(self._stepped(at, target), target, signs, turns, reference), signs)
        for second, away in every((False, True), FOLDED):
            if self._is_met(least, signs):
                return least
            beside = self._stepped(self._aside(least, target, away, second), target)
            least = self._better(least, self._across(beside, target, signs, turns, reference), signs)
        for axes in self._nearby(SIZES[:2], target, signs, turns, reference):
            if self._is_met(least, signs):
                return least
            least = self._better(least, self._stepped(self._at(axes, target), target), signs)
        return least if self._is_met(least, signs) else self._refused(least, target)

    def _across(self, at: At, target: Placed, signs: Signs, turns: Turns, reference: Reals) -> At:
        """Where steps lead from the wanted branch, if others have met the frame on another one: the nominal machine is
        asked for the frame that it has there.
        """
        pose = self.machine.nominal._forward(self.machine._actual(at.axes))
        if at.size > MET or self._is_met(at, signs) or isinstance(pose, Status):
            return at
        axes = self._nominal((pose[0], pose[1]), signs, turns, reference)
        return at if isinstance(axes, Diagnosis) else self._stepped(self._at(axes, target), target)

    def _better(self, first: At, second: At, signs: Signs) -> At:
        """The one that meets the frame on the branch, or else misses it less."""
        if self._is_met(second, signs) or (second.size < first.size and first.size > MET):
            return second
        return first

    def _refused(self, least: At, target: Placed) -> Diagnosis:
        """The reason for a frame that is not met."""
        if least.size <= MET:
            return Diagnosis(Status.UNREACHABLE, OTHER_BRANCH, 0.0)
        missing = hypot(*plus(target[0], least.tool[0], -1.0))
        return Diagnosis(Status.UNREACHABLE, BEYOND, missing)

    def _nominal(self, target: Placed, signs: Signs, turns: Turns, reference: Reals) -> Reals | Diagnosis:
        """The axes of this machine at which it has the joints of the nominal one at a frame, which is put where the
        nominal one can be: in its plane.
        """
        machine, (position, rotation) = self.machine, target
        for along in self.fixed:
            position = plus(position, along, dot(along, plus(self.home[0], position, -1.0)))
        found = machine.nominal._branch(position, rotation, signs, turns, machine._actual(reference))
        return found if isinstance(found, Diagnosis) else machine._commanded(found)

    def _start(self, target: Placed, signs: Signs, turns: Turns, reference: Reals) -> Reals | Diagnosis:
        """The axes of the nominal machine at the frame; if it does not reach that, at one nearby that it reaches."""
        found = self._nominal(target, signs, turns, reference)
        if not isinstance(found, Diagnosis) or found.status is not Status.UNREACHABLE:
            return found
        return next(self._nearby(SIZES, target, signs, turns, reference), found)

    def _nearby(
        self, sizes: Sequence[float], target: Placed, signs: Signs, turns: Turns, reference: Reals
    ) -> Iterator[Reals]:
        """The axes of the nominal machine at frames around one, those of the least size first."""
        for size, (x, y, z) in every(sizes, DIRECTIONS):
            place = plus(target[0], (x, y, z), size * self.off * self.reach / hypot(x, y, z))
            found = self._nominal((place, target[1]), signs, turns, reference)
            if not isinstance(found, Diagnosis):
                yield found

    def _at(self, axes: Reals, target: Placed) -> At:
        """The machine at axis values, and what it misses."""
        tool, lines = passed(self.chain, self.machine._motors(axes))
        scale = self._scale(target)
        lacks, turn = plus(target[0], tool[0], -1.0), self._turn(tool, target)
        missed = [
            dot(d.along, turn) if d.turns else dot(d.along, lacks) / scale for d in self._directions(target, lines)
        ]
        return At(axes, tool, lines, tuple(missed))

    def _scale(self, target: Placed) -> float:
        return self.reach + hypot(*target[0])

    def _turn(self, tool: Placed, target: Placed) -> Vector:
        """The turn that is missing, in the part that the machine follows: its size is the sine where it is small."""
        if self.about is not None:
            return times(self.about, self._heading(product(target[1], transposed(tool[1]))))
        own, wanted = transposed(tool[1]), transposed(target[1])
        pairs = list(zip(own, wanted, strict=True))
        if TWIST[3] not in self.rows and "roll" not in self.rows:
            return cross(*pairs[2])  # the direction of the tool alone
        x, y, z = (cross(*pair) for pair in pairs)
        return times(plus(plus(x, y), z), 0.5)

    def _heading(self, turn: Rotation) -> float:
        """The turn of a rotation about the one axis about which the machine follows it."""
        assert self.about is not None
        (a, f, e), (c, b, d), (g, h, i) = turn
        sine = dot(self.about, (h - d, e - g, c - f))
        return atan2(sine, a + b + i - dot(self.about, turned(turn, self.about)))

    def _directions(self, target: Placed, lines: Sequence[Placed]) -> list[Direction]:
        """The direction of each row, in the order of the rows."""
        found = []
        followed = iter([lines[k][1] for k in self.lines])
        for name in self.rows:
            if name in TWIST[:3]:
                found.append(Direction(False, self.along[TWIST.index(name)]))
            elif name in TWIST[3:]:
                found.append(Direction(True, self.about or self.along[TWIST.index(name) - 3]))
            elif name in TILTS:
                found.append(Direction(True, transposed(target[1])[TILTS.index(name)]))
            else:
                found.append(Direction(True, transposed(next(followed))[2]))
        return found

    def _stepped(self, at: At, target: Placed) -> At:
        """Where damped steps of the Jacobian lead; they end where the last ones gained next to nothing."""
        damping, idle = 0.0, 0
        for _ in range(STEPS):
            if at.size <= SETTLED or damping > MOST_DAMPED or idle >= IDLE:
                break
            step = self._step(at, target, damping)
            further = None if step is None else self._at(step, target)
            if further is not None and further.size < at.size:
                idle = idle + 1 if further.size > GAIN * at.size else 0
                at, damping = further, 0.1 * damping if damping > LEAST_DAMPED else 0.0
            elif at.size <= MET:
                break
            else:
                damping = max(10.0 * damping, LEAST_DAMPED)
        return at

    def _step(self, at: At, target: Placed, damping: float) -> Reals | None:
        """The axes after one step; None where the pose is singular and the step is not damped."""
        share = _damped(self._matrix(at, target), at.missed, damping)
        return None if share is None else self._gone(at, target, share, LONGEST / max(LONGEST, *map(abs, share)))

    def _aside(self, at: At, target: Placed, away: float, second: bool) -> At:
        """The machine beside a pose where branches meet: there steps end, and no step leads along the motion in which
        the two solutions lie. Of all motions it moves the frame least, or second to least where two such poses meet.
        """
        matrix, first = self._matrix(at, target), [0.0] * len(self.free)
        for _ in range(2 if second else 1):
            motion, before = [1.0 + 0.1 * i for i in range(len(self.free))], first
            for _ in range(PASSES):
                along = _sum(motion, before)
                motion = _least(matrix, [m - along * b for m, b in zip(motion, before, strict=True)])
            first = motion
        return self._at(self._gone(at, target, first, away) or at.axes, target)

    def _matrix(self, at: At, target: Placed) -> list[list[float]]:
        """The derivative of what is missed: a row for each direction, a column for each axis that is solved for."""
        scale, moved = self._scale(target), columns(self.chain, at.lines, at.tool[0], len(at.axes))
        rows = [
            (d.along, 3) if d.turns else (times(d.along, 1.0 / scale), 0) for d in self._directions(target, at.lines)
        ]
        own = [(moved[i], scale if i in self.sliding else 1.0) for i in self.free]
        return [[size * dot(along, column[k : k + 3]) for column, size in own] for along, k in rows]

    def _gone(self, at: At, target: Placed, share: Sequence[float], length: float) -> Reals | None:
        """The axes after a motion in radians and shares of the reach; None where they are no reasonable numbers."""
        machine, axes, scale = self.machine, list(at.axes), self._scale(target)
        for i, amount in zip(self.free, share, strict=True):
            unit = scale if i in self.sliding else 1.0
            axes[i] += length * amount * unit / (machine._units[i] * machine._gains[i])
        return tuple(axes) if reasonable(*axes) else None

    def _is_met(self, at: At, signs: Signs) -> bool:
        """Whether the frame is met, and on the branch: where branches meet, either one is."""
        if at.size > MET:
            return False
        pose = self.machine.nominal._forward(self.machine._actual(at.axes))
        return not isinstance(pose, Status) and all(s * m > -STRAYED for s, m in zip(signs, pose[2], strict=True))

    def _moved(self, asked: Placed, target: Placed, at: At) -> Placed:
        """The frame of which the nominal machine is asked, moved by what was missed."""
        scale, place = self._scale(target), asked[0]
        turn = ORIGIN
        for direction, amount in zip(self._directions(target, at.lines), at.missed, strict=True):
            if direction.turns:
                turn = plus(turn, direction.along, amount)
            else:
                place = plus(place, direction.along, amount * scale)
        half = hypot(*turn, 2.0)
        quaternion = (*times(turn, 1.0 / half), 2.0 / half)
        return place, product(Frame.from_quaternion(quaternion).rotation, asked[1])

    def _in_plane(self, at: At, target: Placed) -> Reals | Diagnosis:
        """The axes, unless a coordinate that no axis moves is asked for further from the drawing than deviations of
        this size put it.
        """
        room = 2.0 * self.off * self._scale(target)
        for along in self.fixed:
            beyond = abs(dot(along, plus(target[0], self.home[0], -1.0))) - room
            if beyond > 0.0:
                return Diagnosis(Status.UNREACHABLE, NO_AXIS, beyond)
        return at.axes


def _damped(matrix: Sequence[Sequence[float]], right: Reals, damping: float) -> Sequence[float] | None:
    """The least squares of a linear system, damped; None where it is singular."""
    rows: Sequence[Sequence[float]] = matrix
    if damping > 0.0 or len(matrix) != len(matrix[0]):
        rows, right = _squared(matrix, damping), tuple(_sum(column, right) for column in zip(*matrix, strict=True))
    found = solve(rows, [(value,) for value in right])
    return found[1:] if found[0] != 0.0 else None


def _least(matrix: Sequence[Sequence[float]], motion: Sequence[float]) -> list[float]:
    """A motion of length one, nearer to the one that moves the frame least."""
    found = solve(_squared(matrix, LEAST_DAMPED), [(value,) for value in motion])[1:]
    return [value / (hypot(*found) or 1.0) for value in found]


def _squared(matrix: Sequence[Sequence[float]], damping: float) -> list[list[float]]:
    """The matrix times its transpose, with the damping on its diagonal."""
    across = list(zip(*matrix, strict=True))
    return [[_sum(a, b) + (damping if i == k else 0.0) for k, b in enumerate(across)] for i, a in enumerate(across)]


def _sum(first: Sequence[float], second: Sequence[float]) -> float:
    return sum(a * b for a, b in zip(first, second, strict=True))
