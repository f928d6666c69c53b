"""Poses in which one margin of the nominal machine vanishes: found by Newton's method from regular poses.

A margin is a function of the axis values. For a loop that turns its platform it is a function of the pose instead, and
the inverse gives the axis values, because the iteration of forward kinematics fails if the margin vanishes. A step
goes along the gradient, to where the margin would be zero if it were linear; it is halved until the machine reaches
that pose, inside its limits, and the margin there is smaller. So the search also ends on the boundary of what a loop
can reach, where the
margin falls as a root. Where every such path ends at the boundary of another leg, a cloud of random poses is used.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism
from derive.equations.axes import axis_lets
from derive.ir.interpret import evaluate, run
from derive.ir.passes import normalise
from derive.ir.program import Let, Output, Program, Require, Statement, Status
from derive.ir.reason import Why
from derive.ir.symbols import COORDINATE_NAMES, HEADING, ROTATION_ENTRIES, branch_sign, cosine, real, sine
from derive.kinematics.kinematics import Reals
from derive.kinematics.sampling import sample_axes, size_of
from derive.plate.legs import angles, by_angles
from derive.plate.passive import commanded, renamed_in
from derive.plate.plate import platform_checks
from derive.report.derived import Derived
from derive.report.reference_calls import FRAME, Machine, are_inside, fitted, with_any_miss

SINGULAR = 1e-6
"""A margin of at most this size cannot be distinguished from zero in a picture."""
_PASSES, _HALVES, _STEP = 80, 24, 1e-6
_SAMPLES, _STARTS, _ENOUGH = 600, 60, 3
_DEGREES = 90.0
"""A turn by this many degrees counts as a motion by the length of the machine."""
_TURNS = (25.0, 60.0, -40.0, 35.0, 50.0, 20.0)
_STUCK = 0.95
"""The search stops where a step leaves more than this share of the margin."""
_CLOUD, _NARROWER, _CLOUDS, _TRIALS = 0.2, 0.95, 60, 20
"""The width of the first cloud of poses over the scales, how each is narrower than the one before, and their sizes."""
_WIDTHS = (0.45, 2.0)
"""How far poses of a platform are drawn from home, in scales; farther where the margin vanishes nowhere near it."""
_BESIDE = 1e-6
_CLEAR = 0.05
"""Another margin larger than this does not vanish in the same pose."""

Array = NDArray[np.float64]
Measure = Callable[[Array], Array]
"""A function from rows of coordinates to the margins, a column for every row; NaN if the machine has no pose."""


@dataclass(frozen=True)
class SingularPose:
    """A pose in which a margin vanishes."""

    margin: str
    axes: Reals
    value: float
    """The margin there."""
    beside: Reals
    """Axis values that look the same in a picture, for bars that have no direction in the pose itself."""
    frame: Reals | None = None
    """The frame, for a loop that turns its platform."""


def singular_pose(machine: Machine, derived: Derived, name: str, start: Reals) -> SingularPose | None:
    """A pose in which the margin of that name vanishes, as near to the start as one is found; None if none is.

    start: axis values, from which the search begins.
    """
    if machine.kinematics.mechanism.is_platform:
        return _of_platform(machine, derived, name)
    place, loose = [m.name for m in machine.kinematics.margins].index(name), with_any_miss(machine)

    def measure(rows: Array) -> Array:
        return _measured(loose, rows)

    found = _clearest(measure, place, _starts(machine, np.array(start), measure, place), _scales(machine))
    if found is None:
        return None
    at, begun = found
    at, beside = (np.array(axes) for axes in fitted(machine, [tuple(at), tuple(at + _BESIDE * (begun - at))]))
    return SingularPose(name, tuple(at.tolist()), float(measure(at[None])[place, 0]), tuple(beside.tolist()))


def _clearest(measure: Measure, place: int, starts: Iterable[Array], scales: Array) -> tuple[Array, Array] | None:
    """Among a few poses in which the margin vanishes, one in which no other does, if there is one; and its start."""
    found: list[tuple[float, Array, Array]] = []
    for start in starts:
        at = _descended(measure, place, start, scales)
        if at is None:
            continue
        others = np.delete(measure(at[None])[:, 0], place)
        found.append((min(float(np.min(others)) if others.size else 1.0, _CLEAR), at, start))
        if found[-1][0] >= _CLEAR or len(found) >= _ENOUGH:
            break
    return max(found, key=lambda one: one[0])[1:] if found else None


def _smallest_first(rows: Array, measured: Array, place: int) -> Iterator[Array]:
    """The rows where the margin is smallest beside the others."""
    own, others = measured[place], np.delete(measured, place, axis=0)
    share = own / np.clip(np.min(others, axis=0, initial=1.0), SINGULAR, 1.0)
    order = np.argsort(np.where(np.isfinite(share), share, np.inf), kind="stable")
    yield from (rows[k] for k in order[:_STARTS] if np.isfinite(share[k]))


def _gathered(measure: Measure, place: int, rows: Array, scales: Array) -> Array:
    """Poses near a zero of a margin: around the best of a cloud the next, slightly narrower cloud is drawn.

    Shape (n, coordinates), like the rows. Unlike steps along the gradient, clouds get around poses that the machine
    cannot reach.
    """
    random, best, width = np.random.default_rng(5), rows, _CLOUD
    for _ in range(_CLOUDS):
        around = np.repeat(best[:_STARTS], _TRIALS, axis=0)
        cloud = np.concatenate([best, around + width * scales * random.standard_normal(around.shape)])
        values = measure(cloud)[place]
        best = cloud[np.argsort(np.where(np.isfinite(values), values, np.inf), kind="stable")[:_STARTS]]
        width *= _NARROWER
    return best


def _measured(machine: Machine, rows: Array) -> Array:
    """The sizes of all margins at axis values; a margin with a unit is given in lengths of the machine."""
    kinematics = machine.kinematics
    size = size_of(kinematics.mechanism, machine.values)
    axes = {j.axis.name: rows[:, k] for k, j in enumerate(kinematics.mechanism.joints)}
    found, status = run(kinematics.singularity, {**machine.values, **axes})
    scaled = [np.broadcast_to(found[m.factor], (len(rows),)) / (size if m.length else 1.0) for m in kinematics.margins]
    good = np.asarray(np.broadcast_to(status == Status.OK, (len(rows),)), dtype=bool) & are_inside(machine, axes)
    return np.where(good, np.abs(np.stack(scaled)), np.nan)


def _scales(machine: Machine) -> Array:
    """The motion of each axis in a step of one."""
    mechanism = machine.kinematics.mechanism
    size = size_of(mechanism, machine.values)
    return np.array([_DEGREES if j.in_degrees else size for j in mechanism.joints])


def _starts(machine: Machine, start: Array, measure: Measure, place: int) -> Iterator[Array]:
    """The starts of the search: the given one, poses near it, and sampled poses, those with small margins first."""
    mechanism = machine.kinematics.mechanism
    turned = np.array([_TURNS[k % 6] if j.axis_is_angle else 0.0 for k, j in enumerate(mechanism.joints)])
    near = [start + part * turned for part in (0.4, 1.0, -0.4, 0.0)]
    good = measure(np.stack(near))[place]
    yield from (row for row, value in zip(near, good, strict=True) if np.isfinite(value) and value > SINGULAR)
    drawn = sample_axes(mechanism, dict(machine.values), _SAMPLES, 7)
    rows = np.stack([drawn[j.axis.name] for j in mechanism.joints], axis=1)
    yield from _smallest_first(rows, measure(rows), place)


def _descended(measure: Measure, place: int, start: Array, scales: Array) -> Array | None:
    """A pose where the margin vanishes, found from a start; None if none is found."""
    at = start.copy()
    value = float(measure(at[None])[place, 0])
    for _ in range(_PASSES):
        if value <= SINGULAR * 1e-3:
            break
        gradient = _gradient(measure, place, at, scales)
        square = float(gradient @ gradient)
        if not square > 0.0:
            break
        parts = 0.5 ** np.arange(_HALVES)
        trials = at - np.outer(parts, scales * gradient * value / square)
        found = measure(trials)[place]
        better = np.flatnonzero(found < value)
        if not better.size:
            break
        first, before = int(better[np.argmin(found[better])]), value
        at, value = trials[first], float(found[first])
        if value > _STUCK * before:
            break
    return at if value <= SINGULAR else None


def _gradient(measure: Measure, place: int, at: Array, scales: Array) -> Array:
    """The slopes of the margin, on whichever side the machine has a pose."""
    steps = np.diag(scales * _STEP)
    values = measure(np.concatenate([at + steps, at - steps, at[None]]))[place]
    ahead, behind, here = values[: len(at)], values[len(at) : -1], values[-1]
    both = (ahead - behind) / 2
    one = np.where(np.isfinite(ahead), ahead - here, here - behind)
    slopes = np.where(np.isfinite(both), both, one) / _STEP
    return np.asarray(np.where(np.isfinite(slopes), slopes, 0.0))


def _of_platform(machine: Machine, derived: Derived, name: str) -> SingularPose | None:
    """`singular_pose` for a platform, by its pose, in the branches of the home pose."""
    mechanism = derived.mechanism
    program, width = _program_at_pose(derived), len(mechanism.motion.position)
    home = np.array([float(evaluate(v, machine.values)) for v in mechanism.home])
    size = size_of(mechanism, machine.values)
    scales = np.array([size if k < width else 1.0 for k in range(len(home))])
    kept = [m.name for m in machine.kinematics.margins]
    place = kept.index(name)
    ways = {b.name: machine.given.get(b.home_flag, 0.0) for b in mechanism.branches}
    signs = {branch_sign(name).name: np.asarray(1.0 - 2.0 * way) for name, way in ways.items()}

    def solved(rows: Array) -> tuple[Array, dict[str, Array]]:
        values = {**machine.values, **signs, **_named_frames(mechanism, rows)}
        values |= {s.name: np.asarray(0.0) for s in program.inputs if s.name not in values}
        found, status = run(program, values)
        every = {n: np.broadcast_to(v, (len(rows),)) for n, v in found.items()}
        good = np.asarray(np.broadcast_to(status == Status.OK, (len(rows),)), dtype=bool)
        good = good & are_inside(machine, {j.axis.name: every[j.axis.name] for j in mechanism.joints})
        return np.where(good, np.abs(np.stack([every[one] for one in kept])), np.nan), every

    def measure(rows: Array) -> Array:
        return solved(rows)[0]

    spread = scales * np.random.default_rng(3).uniform(-1.0, 1.0, (_SAMPLES, len(home)))
    reached = None
    for far in _WIDTHS:
        rows = np.concatenate([home + 0.05 * spread[:1], home + far * spread])
        starts = _smallest_first(rows, measure(rows), place)
        reached = _clearest(measure, place, starts, scales)
        reached = reached or _clearest(measure, place, _gathered(measure, place, rows, scales), scales)
        if reached is not None:
            break
    if reached is None:
        return None
    at, _ = reached
    measured, found = solved(at[None])
    axes = tuple(float(found[j.axis.name][0]) for j in mechanism.joints)
    frame = tuple(float(found[n][0]) for n in FRAME)
    return SingularPose(name, axes, float(measured[place, 0]), axes, frame)


def _program_at_pose(derived: Derived) -> Program:
    """The program of the margins of a platform at a commanded pose, by the inverse and the lines of the legs, of its
    axis values, and of its whole pose.
    """
    mechanism, route = derived.mechanism, derived.inverse[-1]
    statements = (*route.known, *(s for step in route.steps for s in step.statements))
    lets = [let for factor in derived.factors for let in factor.lets]
    own = {s.name for s in statements if isinstance(s, Let)}
    axes = [let for j in mechanism.joints for let in axis_lets(j) if let.name not in own]
    pose = {c: commanded(mechanism).get(c, c) for c in (*map(real, COORDINATE_NAMES), *ROTATION_ENTRIES)}
    body = renamed_in((*statements, *platform_checks(mechanism, statements), *lets, *axes), commanded(mechanism))
    kept = [s for s in body if not _is_far_from_type_2(s)]
    margins_told = [Output(f.name, f.lets[-1].name) for f in derived.factors]
    told = [*margins_told, *(Output(j.axis.name, j.axis) for j in mechanism.joints)]
    return normalise("margins", kept, [*told, *(Output(c.name, value) for c, value in pose.items())])


def _is_far_from_type_2(statement: Statement) -> bool:
    """Whether a statement refuses poses close to a type 2 singularity, which are sought here."""
    return isinstance(statement, Require) and statement.reason is not None and statement.reason.why is Why.NEAR_TYPE_2


def _named_frames(mechanism: Mechanism, rows: Array) -> dict[str, Array]:
    """The frames at coordinates of the platform (positions, then heading, or roll, pitch and yaw), by names."""
    width, count = len(mechanism.motion.position), len(rows)
    values = {c: np.zeros(count) for c in COORDINATE_NAMES}
    values |= {c: rows[:, k] for k, c in enumerate(mechanism.motion.position)}
    turns = dict(zip(angles(mechanism), rows[:, width:].T, strict=True))
    named = {f"{w}_{a}": f(v) for a, v in turns.items() for w, f in (("cos", np.cos), ("sin", np.sin))}
    for name, entry in zip(ROTATION_ENTRIES, by_angles(angles(mechanism)), strict=True):
        values[name.name] = np.asarray(np.broadcast_to(evaluate(entry, named), (count,)))
    return values | {cosine(HEADING).name: values["r11"], sine(HEADING).name: values["r21"]}
