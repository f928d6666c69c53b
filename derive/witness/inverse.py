"""The inverse against the closure: every slot is a solution, the slot of forward kinematics leads back, none is
missing."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from derive.description.mechanism import Joint, Mechanism, Search
from derive.ir.interpret import Array, run
from derive.ir.program import Program, Status
from derive.ir.symbols import COORDINATE_NAMES, branch_sign
from derive.kinematics.kinematics import Kinematics
from derive.witness.checks import CLOSURE_TOLERANCE, clear_of_zero, how_far, least_move, worst
from derive.witness.closure import Closure
from derive.witness.disagreement import Disagreement
from derive.witness.home_samples import joints_at, measured_legs, on_guides, poses_at_home, touched
from derive.witness.onward import every_root
from derive.witness.planted import refused_when_planted
from derive.witness.roots import STARTS, Problem, all_solutions, distinct, is_solution, polished, problem_at, same
from derive.witness.samples import SEED, Samples, describe, turns_of

AXES_TOLERANCE = 1e-9
_NEAR = 15.0
"""The largest distance of references from the axes, in degrees: with gear couplings, too, the turn stays the same."""
_EVERY, _MOST_MISSED = 6, 0.01
"""With a root search all solutions are sought at every n-th pose, and at most this share of them may be missed."""
_AROUND = 8
"""References from which a root search is started to find all solutions."""
_TOOL = 0.03
"""The size of the point off the flange, in reaches: less than REGULAR, so that it does not reach a mirror solution."""

Slots = tuple[Array, NDArray[np.bool_]]
"""Axis values (slots, samples, axes) and whether each slot answered OK."""


def all_slots(kin: Kinematics, samples: Samples) -> Slots:
    """What the inverse answers in every slot of every sample, with the turns of the samples."""
    return run_slots(kin, kin.branch, samples, _commands(kin, samples))


def check_inverse(kin: Kinematics, closure: Closure, samples: Samples, slots: Slots) -> tuple[float, float]:
    """The answer of every slot closes Φ and lies on its branch; the slot of forward kinematics gives back the axes with
    turns.
    """
    axes, ok = slots
    residual = 0.0
    for slot, signs in enumerate(_signs(kin)):
        chosen = np.flatnonzero(ok[slot])
        if not len(chosen):
            continue
        part = samples.take(chosen)
        joints = closure.joints(axes[slot, chosen], part.parameters)[:, :, 0]
        errors = least_move(kin, closure, part, joints)
        far = how_far(kin, part, joints)
        residual = max(residual, worst(kin, "inverse kinematics", errors / far, part, CLOSURE_TOLERANCE))
        indicators = closure.indicators(joints, part.pose, part.parameters)[:, :, 0]
        if (indicators * signs <= 0).any():
            place = describe(kin, part, int(np.argmax(np.any(indicators * signs <= 0, axis=1))))
            raise Disagreement(f"inverse kinematics: slot {slot} answers on another branch, for the pose {place}")
    return residual, _round_trip(kin, closure, samples, (axes, ok), samples.values, "the way back")


def check_solutions(
    kin: Kinematics, closure: Closure, samples: Samples, answers: Slots
) -> tuple[int, tuple[int, int] | None]:
    """Multi-start root finding finds the solutions in the slots, no more and no less. Returns the largest number of
    solutions.

    A search may miss some: then also how many, of how many.
    """
    search = kin.mechanism.search
    rows = np.arange(0, len(samples), _EVERY) if search else _first_and_richest(samples, answers[1].sum(axis=0))
    part = samples.take(rows)
    problem = problem_at(closure, part)
    axes, ok = _searched(kin, part, search) if search else (answers[0][:, rows], answers[1][:, rows])
    offered = [polished(problem, closure.joints(a, part.parameters)[:, :, 0] / problem.units) for a in axes]
    counts, missed = [], 0
    held = [np.stack(offered)[ok[:, row], row] for row in range(len(part))]
    solutions = all_solutions(problem, starts_for(kin.mechanism))
    solutions = [_with_slots(problem, row, *both) for row, both in enumerate(zip(solutions, held, strict=True))]
    own = in_own_mode(kin, closure, part, solutions, problem.units)
    for row, found in enumerate(f[kept] for f, kept in zip(solutions, own, strict=True)):
        slots = distinct(problem, row, held[row]) if search else held[row]  # opposite the reference: found twice
        missing = _compare(kin, problem, row, (found, slots), describe(kin, part, row))
        missed += missing
        counts.append(len(found))
    if missed > _MOST_MISSED * sum(counts):
        raise Disagreement(f"the search misses {missed} of {sum(counts)} solutions")
    if not search:
        return max(counts), None
    refused, planted = refused_when_planted(kin, closure, samples)
    if refused > _MOST_MISSED * planted:
        raise Disagreement(f"the search refuses {refused} of {planted} poses next to where branches meet")
    return max(counts), (missed + refused, sum(counts) + planted)


def _first_and_richest(samples: Samples, count: NDArray[np.int64]) -> NDArray[np.int64]:
    """Of every machine the first pose, and the first one with the most solutions. count: in the slots of each pose."""
    first = np.unique(samples.machine, return_index=True)[1]
    most = np.lexsort((-count, samples.machine))[first]
    return np.unique([*first, *most])


def _with_slots(problem: Problem, row: int, found: Array, slots: Array) -> Array:
    """The solutions that were found, and the slots that are solutions too: no start may have led there."""
    good = is_solution(problem.take(np.full(len(slots), row)), slots)
    return distinct(problem, row, np.concatenate([found, slots[good]]))


def check_offset(kin: Kinematics, closure: Closure, samples: Samples) -> tuple[float, float]:
    """The offset interface reaches the commanded point, and gives back the axes on the branch that it names."""
    if kin.offset_branch is None or kin.offset_configuration is None:
        return 0.0, 0.0
    size = _TOOL * samples.reach / samples.ease
    offset = size[:, None] * np.random.default_rng(SEED + 3).uniform(-1.0, 1.0, (len(samples), 3))
    rotation = samples.pose[:, 3:].reshape(-1, 3, 3)
    offset = _in_reach(kin, rotation, offset)
    point = samples.pose[:, :3] + (rotation @ offset[:, :, None])[:, :, 0]
    named = {f"point_{c}": offset[:, i] for i, c in enumerate("xyz")} | {c: point[:, i] for i, c in enumerate("xyz")}
    references = {j.reference.name: samples.axes[:, i] for i, j in enumerate(kin.mechanism.joints)}
    turns = {j.turn.name: np.zeros(len(samples)) for j in kin.period_joints}
    axes, ok = run_slots(kin, kin.offset_branch, samples, named | references | turns)
    residual = 0.0
    for slot in range(len(axes)):
        chosen = np.flatnonzero(ok[slot])
        if len(chosen):
            part = samples.take(chosen)
            joints = closure.joints(axes[slot, chosen], part.parameters)[:, :, 0]
            errors = _point_error(kin, closure, part, joints, point[chosen], offset[chosen])
            residual = max(residual, worst(kin, "offset interface", errors, part, CLOSURE_TOLERANCE))
    branches, _ = run(kin.offset_configuration, samples.values | named)
    return residual, _round_trip(kin, closure, samples, (axes, ok), branches, "the way back of the offset interface")


def _in_reach(kin: Kinematics, rotation: Array, offset: Array) -> Array:
    """The offsets without what would move a coordinate that the task does not command."""
    for c in (k for k, name in enumerate(COORDINATE_NAMES) if name not in kin.mechanism.task.position):
        across = rotation[:, c, :]
        offset = offset - np.sum(across * offset, axis=1, keepdims=True) * across
    return offset


def run_slots(kin: Kinematics, program: Program, samples: Samples, commands: dict[str, Array]) -> Slots:
    """Run an inverse program for all slots at once: a root search takes as many passes for one row as for all."""
    slots, count = np.array(_signs(kin)), len(samples)
    sigmas = {branch_sign(b.name).name: np.repeat(slots[:, i], count) for i, b in enumerate(kin.branches)}
    repeated = {name: np.tile(column, len(slots)) for name, column in (samples.values | commands).items()}
    outputs, status = run(program, repeated | sigmas)
    axes = np.stack([outputs[j.axis.name] for j in kin.mechanism.joints], axis=1)
    ok = np.asarray(np.broadcast_to(status == Status.OK, len(slots) * count), dtype=bool)
    return axes.reshape(len(slots), count, -1), ok.reshape(len(slots), count)


def _searched(kin: Kinematics, samples: Samples, search: Search) -> Slots:
    """The solutions that a search offers. Where the side alone tells roots apart, many have the same: one after the
    other is asked for.
    """
    if search.is_eliminated:
        return every_root(kin, samples.values | _commands(kin, samples))
    return _around(kin, samples, search.joint)


def _around(kin: Kinematics, samples: Samples, searched: Joint) -> Slots:
    """The solutions of every slot with a root search, from references around the circle: a branch may have several."""
    commands = _commands(kin, samples)
    # The poses once for every reference, in one run: a root search takes as many passes for one row as for all.
    around, count = np.linspace(0.0, 360.0, _AROUND, endpoint=False), len(samples)
    many = samples.take(np.tile(np.arange(count), _AROUND))
    commands = {name: np.tile(column, _AROUND) for name, column in commands.items()}
    axes, ok = run_slots(kin, kin.branch, many, commands | {searched.reference.name: np.repeat(around, count)})
    slots = len(axes) * _AROUND
    by_reference = axes.reshape(len(axes), _AROUND, count, -1).swapaxes(0, 1)
    return by_reference.reshape(slots, count, -1), ok.reshape(-1, _AROUND, count).swapaxes(0, 1).reshape(slots, count)


def _signs(kin: Kinematics) -> list[tuple[float, ...]]:
    """The branch signs of every slot, slot = Σ (byte - 1)·2^i."""
    return [tuple(reversed(signs)) for signs in product((1.0, -1.0), repeat=len(kin.branches))]


def _commands(kin: Kinematics, samples: Samples) -> dict[str, Array]:
    """Turns and references that lead to the sampled axes: explicit turns on even rows, near references on odd ones."""
    rng = np.random.default_rng(SEED + 2)
    explicit = np.arange(len(samples)) % 2 == 0
    search = kin.mechanism.search
    searched = search.joint if search is not None else None
    commands = {}
    for i, joint in enumerate(kin.mechanism.joints):
        axis = samples.axes[:, i]
        turns = turns_of(joint, samples.values) if joint.is_angle else 1.0
        near = axis + rng.uniform(-_NEAR, _NEAR, len(samples)) / turns
        if search is not None and search.is_eliminated and joint == searched:
            near = axis  # another root of the same side may be near
        anywhere = rng.uniform(-720.0, 720.0, len(samples)) / turns
        held = joint in kin.mechanism.held_joints
        far = explicit & joint.multi_turn & (joint != searched)  # the reference tells roots of one branch apart
        commands[joint.reference.name] = axis if held else np.where(far, anywhere, near)
        if joint.multi_turn:
            count = np.floor((axis * turns + 180.0) / 360.0)
            commands[joint.turn.name] = np.where(explicit, np.where(count >= 0, count + 1, count), 0.0)
    return commands | _beside(kin, samples, rng)


def _beside(kin: Kinematics, samples: Samples, rng: np.random.Generator) -> dict[str, Array]:
    """Other values of what the task does not command: no answer may depend on them."""
    passive = kin.mechanism.passive
    moved = {c: rng.uniform(-1.0, 1.0, len(samples)) * samples.reach for c in passive if c != "twist"}
    if "twist" in passive:
        angle, rotation = rng.uniform(-np.pi, np.pi, len(samples)), samples.pose[:, 3:].reshape(-1, 3, 3)
        first, second = rotation[:, :, 0], rotation[:, :, 1]
        cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
        columns = (cosine * first + sine * second, cosine * second - sine * first)
        moved |= {f"r{i + 1}{k + 1}": columns[k][:, i] for k in (0, 1) for i in range(3)}
    return moved


def _round_trip(
    kin: Kinematics, closure: Closure, samples: Samples, slots: Slots, branches: Mapping[str, Array], what: str
) -> float:
    """The error of the axes in the slot that the branch signs name, where they are clear."""
    axes, ok = slots
    slot, clear = np.zeros(len(samples), dtype=np.int64), np.ones(len(samples), dtype=bool)
    for i, branch in enumerate(kin.branches):
        margin = branches[f"branch_{branch.name}"]
        slot += np.where(margin > 0, 0, 2**i)
        clear &= clear_of_zero(margin, samples)
    rows = np.arange(len(samples))
    errors = np.max(np.abs(axes[slot, rows] - samples.axes) / closure.axis_scale(samples.reach), axis=1)
    errors = np.where(ok[slot, rows], errors, np.inf)
    if not clear.any():
        raise Disagreement(f"{what}: no sample has clear branches")
    part = samples.take(clear)
    return worst(kin, what, errors[clear], part, AXES_TOLERANCE, part.ease * part.pose_ease)


def _compare(kin: Kinematics, problem: Problem, row: int, solutions: tuple[Array, Array], place: str) -> int:
    """The number of solutions that a root search misses. Raises `Disagreement` for any other difference."""
    found, offered = solutions
    places = problem.places_at(row, offered)
    missing = [f for f in problem.places_at(row, found) if not same(f, places).any()]
    count = len(distinct(problem, row, offered))
    is_search = kin.mechanism.search is not None
    expected = len(found) - (len(missing) if is_search else 0)
    if (missing and not is_search) or expected != len(offered) or count != len(offered):
        raise Disagreement(
            f"number of solutions: the closure has {len(found)}, the slots hold {len(offered)}"
            f" ({count} distinct), for the pose {place}"
        )
    return len(missing)


def _point_error(
    kin: Kinematics, closure: Closure, samples: Samples, joints: Array, point: Array, offset: Array
) -> Array:
    if kin.mechanism.chain is None:  # the flange keeps the orientation of the reference: the offset shifts the pose
        return least_move(kin, closure, samples, joints)
    frame = closure.frame(joints, samples.parameters)[:, :, 0]
    reached = frame[:, :3] + (frame[:, 3:].reshape(-1, 3, 3) @ offset[:, :, None])[:, :, 0]
    return np.asarray(np.linalg.norm(reached - point, axis=1) / samples.reach)


_EASY = 3
"""Legs with two solutions each, of which `STARTS` starts find all; with each leg more it takes twice as many."""
_WITHOUT_BRANCHES = 20
"""Starts at home that are enough where `joints_at` starts again until positive quantities are positive."""
_CLOSED = 1e-9


def starts_for(mechanism: Mechanism) -> int:
    """The number of starts from which all solutions are sought."""
    if not mechanism.is_platform:
        return STARTS
    return int(STARTS * 2 ** max(0, len(mechanism.rods) - len(measured_legs(mechanism)) - _EASY))


def in_own_mode(
    kin: Kinematics, closure: Closure, samples: Samples, solutions: list[Array], units: Array
) -> list[NDArray[np.bool_]]:
    """Which solutions at each sample are in the assembly mode of the machine; all, where nothing iterates.

    At the home pose the closure is solved for the joints from many starts. The solution with the branches that the
    parameters tell for home has the sign of det A that every other pose of this machine must have.
    """
    if not kin.mechanism.is_platform:
        return [np.ones(len(found), dtype=bool) for found in solutions]
    own: list[NDArray[np.bool_]] = []
    for row, found in enumerate(solutions):
        part = samples.take(np.full(len(found), row))
        sides = _sides(closure, found * units[row], part.pose, part.parameters)
        own.append(np.asarray(sides == _home_side(kin, closure, samples, row), dtype=bool))
    return own


def _sides(closure: Closure, joints: Array, pose: Array, parameters: Array) -> Array:
    if not len(joints):
        return np.zeros(0)
    return np.asarray(np.sign(np.linalg.det(closure.by_pose(joints, pose, parameters))))


def _home_side(kin: Kinematics, closure: Closure, samples: Samples, row: int) -> float:
    """The sign of det A at the home pose of the machine of a sample."""
    part = samples.take(np.full(starts_for(kin.mechanism) if kin.branches else _WITHOUT_BRANCHES, row))
    pose = on_guides(closure, poses_at_home(closure, part.values, part.reach), part.parameters)
    joints = joints_at(kin.mechanism, closure, pose, part.parameters, part.reach, np.random.default_rng(SEED + 5))
    state = (joints, pose, part.parameters)
    flags = [(k, b.home_flag) for k, b in enumerate(kin.branches) if b.home_flag in part.values]
    own, signs = [k for k, _ in flags], [1.0 - 2.0 * part.values[flag][0] for _, flag in flags]
    if flags:  # every leg has two solutions: there may be no start that leads to those of all branches
        told = closure.indicators(*state)[:, own, 0] * signs > 0
        apart = touched(closure.indicators, *state)[own] > 0
        first = [int(np.argmax(told[:, column].all(axis=1))) for column in apart.T]
        joints[0] = joints[first, range(len(first))]
    closed = np.abs(closure.residual(*state)[:, :, 0]).max(axis=1) < _CLOSED * part.reach**2
    closed &= np.all(closure.positive(*state)[:, :, 0] > 0, axis=1)
    closed &= np.all(closure.indicators(*state)[:, own, 0] * signs > 0, axis=1)
    sides = np.unique(_sides(closure, joints, pose, part.parameters)[closed])
    if len(sides) != 1:
        raise Disagreement(f"the home pose has {len(sides)} assembly modes, {describe(kin, samples, row)}")
    return float(sides[0])
