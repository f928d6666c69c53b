"""The questions of the corpus: drawn with seeds from what a package can reach, and recorded to the last bit."""

from collections.abc import Iterator
from math import inf, nan
from typing import Any

import numpy as np
import softkin

from tests.corpus import limits, poses
from tests.corpus.answers import Question
from tests.corpus.poses import Axes
from tests.corpus.robots import Recipe, Robot, recipes, robot

REGULAR = 10
RIGHT = 14
PLACES = 2
SEARCHED = 4
"""Of a mechanism whose inverse is a search, by this factor fewer: a search takes a thousand times as long."""
Asked = tuple[Recipe, list[Question]]
"""A robot, and what it is asked."""


def questions(name: str) -> Iterator[Asked]:
    """All questions about a mechanism, robot by robot."""
    every = list(recipes(name))
    for number, recipe in enumerate(every):
        one, rng = robot(recipe), np.random.default_rng([7, number])
        axes = poses.regular(one, REGULAR // _fewer(one), rng)
        asked = [*_facts(one), *_regular(one, axes, rng), *_singular(one, rng, PLACES if number < 2 else 1)]
        if number == 0:
            asked += [
                *_garbage(one, axes[0]),
                *_out_of_reach(one, axes[: 3 - min(2, _fewer(one))], rng),
                *_parameters(one),
            ]
        yield recipe, asked
    chosen = robot(every[-2] if len(every) > 1 else every[0])
    yield from limits.questions(chosen, poses.regular(chosen, 3 - min(2, _fewer(chosen)), np.random.default_rng(11)))


def _fewer(one: Robot) -> int:
    return SEARCHED if hasattr(one.made, "SIDES") else 1


def inverse(one: Robot, frame: Any, reference: Any, configurations: Any, kind: str, trusted: bool = True) -> Question:
    given = [list(frame[0]), [list(row) for row in frame[1]]]
    asked = {"call": "inverse", "kind": kind, "frame": given, "reference": reference}
    return asked | {"configurations": [list(c) for c in configurations], "trusted": trusted}


def _facts(one: Robot) -> Iterator[Question]:
    """What does not depend on a pose."""
    yield {"call": "image", "kind": "facts"}
    if hasattr(one.made, "image_on"):
        tilted = poses.rotation(np.random.default_rng(2)).tolist()
        for freedom in ("zero", "one", "three"):
            base, flange = tilted[2], [0.0, 0.0, 1.0]
            yield {"call": "on", "kind": "facts", "image": {
                "freedom": freedom, "rotation": np.array(tilted).T.tolist(), "base_axis": base, "flange_axis": flange,
            }}  # fmt: skip


def _regular(one: Robot, chosen: list[Axes], rng: np.random.Generator) -> Iterator[Question]:
    """Poses of the workspace with references near, far and none, every configuration, every turn."""
    for number, axes in enumerate(chosen):
        turned = _turned(one, axes, rng)
        yield {"call": "forward", "kind": "regular", "axes": list(turned), "jacobian": number < 3}
        frame, configuration = one.made.forward(turned)
        reference = (None, list(turned), _near(one, axes, rng), _far(one, axes, rng))[number % 4]
        chosen_bytes = _configurations(one, frame, configuration, number, _held_at(one, turned))
        yield inverse(one, frame, reference, chosen_bytes, "regular")
        if one.made.READS_ROTATION:
            tilted = (frame.position, poses.rotation(rng).tolist())
            yield inverse(one, tilted, list(axes), [_open(one)], "any rotation", trusted=False)
            if hasattr(one.made, "project"):
                yield {"call": "project", "kind": "regular", "rotation": tilted[1]}
        yield from _started(one, axes, frame)
        yield from _offsets(one, turned, frame, number)


def _singular(one: Robot, rng: np.random.Generator, places: int) -> Iterator[Question]:
    """Right angles, margins that vanish, and where assembly ends."""
    chosen = [
        *poses.right_angles(one, RIGHT // _fewer(one), rng),
        *poses.singular(one, places, rng),
        *poses.ends(one, 2, rng),
    ]
    for number, axes in enumerate(dict.fromkeys(chosen)):
        yield {"call": "forward", "kind": "singular", "axes": list(axes)}
        try:
            frame, configuration = one.made.forward(axes)
        except softkin.KinematicsError:
            continue
        reference = (list(axes), None, _far(one, axes, rng), _near(one, axes, rng))[number % 4]
        yield inverse(one, frame, reference, [configuration, _open(one)], "singular")


def _garbage(one: Robot, axes: Axes) -> Iterator[Question]:
    """What is no pose, no number, no rotation, no configuration."""
    frame, own = one.made.forward(axes)
    place, rows, near = list(frame.position), np.array(frame.rotation), list(axes)
    every = [own, _open(one)]
    for i, value in enumerate((nan, inf, -inf, 1e10, -1e300)):
        wrong = place[: i % 3] + [value] + place[i % 3 + 1 :]
        yield inverse(one, (wrong, rows.tolist()), near, every, "garbage", trusted=False)
        turned = rows.copy()
        turned[i % 3, (i + 1) % 3] = value
        yield inverse(one, (place, turned.tolist()), near, every, "garbage", trusted=False)
        if axes:
            reference = [*near[:-1], value]
            yield inverse(one, frame, reference, every, "garbage", trusted=False)
            yield {"call": "forward", "kind": "garbage", "axes": reference}
    for matrix in _rotations(rows):
        yield inverse(one, (place, matrix.tolist()), near, every, "rotation", trusted=False)
    yield inverse(one, ("text", rows.tolist()), near, [own], "garbage", trusted=False)
    yield inverse(one, (place[:2], rows.tolist()), near, [own], "garbage", trusted=False)
    yield inverse(one, (place, rows[:2].tolist()), near, [own], "garbage", trusted=False)
    yield inverse(one, frame, [*near, 0.0], [own], "garbage", trusted=False)
    yield {"call": "forward", "kind": "garbage", "axes": [*near, 0.0]}
    if own:
        wrong_bytes = [[byte, *own[1:]] for byte in (3, 4, -1, 127, 128, 200, 255, 256, -129, 1000)]
        yield inverse(one, frame, near, [*wrong_bytes, own[:-1], [*own, 0], [*own[:-1], -128]], "bytes", trusted=False)


def _rotations(rows: Any) -> Iterator[Any]:
    """Rotations of few digits, accepted and refused, and what is none."""
    yield rows.astype(np.float32).astype(float)
    noise = np.random.default_rng(4).uniform(-1.0, 1.0, (3, 3))
    for size in (1e-13, 1e-11, 1e-8, 2e-5, 3e-4, 0.1):
        yield rows + size * noise
    for scale in (1.0 + 4e-5, 1.0 + 6e-5, 1.01, 0.0, -1.0):
        yield scale * rows
    yield rows[:, [1, 0, 2]]


def _out_of_reach(one: Robot, chosen: list[Axes], rng: np.random.Generator) -> Iterator[Question]:
    """Straight ahead until what answers changes: before that end by 1e-6 of the way, behind it by 1e-6, 1e-3 and 1."""
    for axes in chosen:
        frame, configuration = one.made.forward(axes)
        ways = (rng.normal(size=3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]))
        for way in ways[: 4 // min(2, _fewer(one))]:
            step = one.reach * way / np.linalg.norm(way)
            end = _end(one, frame, step, _held_at(one, axes))
            for factor in (1.0 - 1e-6, 1.0 + 1e-6, 1.001, 2.0) if end is not None else (0.3, 1e4):
                place = (np.array(frame.position) + (end or 1.0) * factor * step).tolist()
                yield inverse(one, (place, frame.rotation), list(axes), [configuration, _open(one)], "reach")


def _end(one: Robot, frame: softkin.Frame, step: Any, near: Axes | None) -> float | None:
    """How many steps it takes until other slots answer; None where this is far away."""
    own = _answering(one, frame, 0.0 * step, near)
    good, bad = 0.0, 3.0
    if _answering(one, frame, bad * step, near) == own:
        return None
    for _ in range(52):
        middle = (good + bad) / 2.0
        good, bad = (middle, bad) if _answering(one, frame, middle * step, near) == own else (good, middle)
    return bad


def _answering(one: Robot, frame: softkin.Frame, shift: Any, near: Axes | None) -> list[int]:
    place = (np.array(frame.position) + shift).tolist()
    return [int(solution.status) for solution in one.made.inverse_all((place, frame.rotation), near)]


def _held_at(one: Robot, axes: Axes) -> Axes | None:
    """A reference for a machine that holds joints; the others need none."""
    return axes if getattr(one.made, "HELD", ()) else None


def _parameters(one: Robot) -> Iterator[Question]:
    for p in type(one.made).PARAMETERS:
        given = one.made.parameters[p.name]
        for value in (0.0, -given, nan, inf, 1e10, p.low, p.high):
            if not p.name.startswith(("lower_", "upper_")) or value != value:
                yield {"call": "make", "kind": "parameters", "parameters": {p.name: value}}


def _started(one: Robot, axes: Axes, frame: softkin.Frame) -> Iterator[Question]:
    """Forward kinematics that iterates: from the frame, and from one beside it."""
    if "home_z" in one.made.parameters:
        beside = [[x + 5.0 for x in frame.position], [list(row) for row in frame.rotation]]
        yield {"call": "forward", "kind": "started", "axes": list(axes), "start": beside}


def _offsets(one: Robot, axes: Axes, frame: softkin.Frame, number: int) -> Iterator[Question]:
    """A point off the flange."""
    if hasattr(one.made, "inverse_offset"):
        arm = [[0.0, 0.0, 0.0], [0.0, 0.0, -0.1], [0.05, -0.03, 0.07]][number % 3]
        offset = [one.reach * a for a in arm]
        point = (np.array(frame.position) + np.array(frame.rotation) @ offset).tolist()
        yield {
            "call": "offset",
            "kind": "offset",
            "axes": list(axes),
            "offset": offset,
            "point": point,
            "reference": list(axes),
        }


def _configurations(one: Robot, frame: softkin.Frame, own: Any, number: int, near: Axes | None) -> list[Any]:
    """The pose's own bytes, all open, other turns, "both coincide", some branches open; of some poses every branch."""
    branches = [i for i, byte in enumerate(one.made.CONFIGURATION) if byte.kind == "branch"]
    slots = [found.configuration for found in one.made.inverse_all(frame, near)]
    named = [[byte if i in branches else 0 for i, byte in enumerate(slot)] for slot in slots]
    other = [byte if i in branches else (2, -1, -3, 1, 127)[(number + i) % 5] for i, byte in enumerate(own)]
    coinciding = [3 if i in branches else byte for i, byte in enumerate(own)]
    some = [0 if i in branches and (number + i) % 2 else byte for i, byte in enumerate(own)]
    return [own, _open(one), other, coinciding, some, *(named if number < 3 else [])]


def _open(one: Robot) -> list[int]:
    return [0] * len(one.made.CONFIGURATION)


def _turned(one: Robot, axes: Axes, rng: np.random.Generator) -> Axes:
    """The same pose in other turns, where only the turn is another."""
    whole = [axis.multi_turn and axis.kind == "rotary" for axis in one.made.AXES]
    return tuple(a + 360.0 * int(rng.integers(-2, 3)) * w for a, w in zip(axes, whole, strict=True))


def _near(one: Robot, axes: Axes, rng: np.random.Generator) -> list[float]:
    return (np.array(axes) + np.where(one.is_angle, 3.0, 0.01 * one.reach) * rng.uniform(-1.0, 1.0, len(axes))).tolist()


def _far(one: Robot, axes: Axes, rng: np.random.Generator) -> list[float]:
    return (np.array(axes) + np.where(one.is_angle, 2000.0, one.reach) * rng.uniform(-1.0, 1.0, len(axes))).tolist()
