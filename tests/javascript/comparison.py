"""What another language answers, held against the Python package that is asked the same.

Statuses, bytes, slots, reasons, units and turns are equal, but for a solution at a multiple root. Reals
are equal within 1e-12 of their scale over the smallest margin of the pose. Where that margin is below `SINGULAR`, axes
are not known to that: both bring the machine to one frame.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import isfinite, remainder
from typing import Any

import softkin

from tests.corpus.comparison import ROUNDED, SINGULAR
from tests.corpus.robots import Robot, robot

SHOWN = 5
SAME = 1e-12
FRAME = 1e-11
"""Of two solutions of a singular pose, as a part of its size."""
JOINED = 1e-2
"""Two solutions are nearer (degrees, but for turns) at a multiple root: rounding leaves a third of its digits."""
_MACHINES = 80
"""So many machines are kept with their answers: more than a mechanism has."""
Answer = dict[str, Any]
Call = list[Any]


def calls_of(question: Answer, rows: int) -> list[Call]:
    """The calls that a question of the corpus asks for; none for what JavaScript has not. rows: of the Jacobian."""
    if question["call"] == "forward":
        start = [_frame(question["start"])] if "start" in question else []
        axes = question["axes"]
        plain = [[call, axes, *start] for call in ("forward", "singularity", "jacobian")]
        return [*plain, *([call, axes, *given, *start] for call, given in _motions(question, rows))]
    if question["call"] == "inverse":
        frame, reference = _frame(question["frame"]), question["reference"]
        named = [["inverse", frame, given, reference] for given in question["configurations"]]
        return [*([["inverseAll", frame, reference]] if _asks_all(question) else []), *named]
    return []


def _motions(question: Answer, rows: int) -> list[tuple[str, list[list[float]]]]:
    """The calls for the motion of the axes, with what each is given after these. An FMU has none."""
    if not _asks_all(question):
        return []
    speeds, rate = ([0.5 * (2 + k) for k, _ in enumerate(question["axes"])], [-3.0 * (2 + k) for k in range(rows)])
    return [("axisVelocities", [rate]), ("axisAccelerations", [speeds, rate])]


def _asks_all(question: Answer) -> bool:
    """Whether all branches are asked for together, and motions of the axes: an FMU has no such calls."""
    return question.get("all", True) is True


def _of_axes(question: Answer) -> list[Any]:
    """The arguments of a call that takes axes, and the start where the question has one."""
    return [question[key] for key in ("axes", "start") if key in question]


def _frame(frame: Sequence[Any]) -> Answer:
    return {"position": frame[0], "rotation": frame[1]}


@dataclass
class Comparison:
    """The differences of one machine."""

    robot: Robot
    found: list[str] = field(default_factory=list)
    regular: int = 0
    """The solutions that were compared axis by axis."""
    refused: int = 0
    sentences: int = 0
    """The refusals whose sentences were compared: those whose four digits do not hang on rounding."""
    known: dict[tuple[str, str], Any] = field(init=False)
    """What the package answered."""

    def __post_init__(self) -> None:
        self.known = _answers(json.dumps(self.robot.recipe))

    def compare(self, question: Answer, answers: Iterator[Answer]) -> None:
        before = len(self.found)
        if question["call"] == "forward":
            self._forward(question, next(answers))
            self._singularity(question, next(answers))
            self._jacobian(question, next(answers))
            for call, given in _motions(question, len(self.robot.made.JACOBIAN_ROWS)):
                self._motion(question, call, given, next(answers))
        elif question["call"] == "inverse":
            if _asks_all(question):
                self._slots(question, next(answers))
            for given in question["configurations"]:
                self._named(question, given, next(answers))
        self.found[before:] = [f"{found}; asked of {self.robot.made!r}: {question}" for found in self.found[before:]]

    def _forward(self, question: Answer, answer: Answer) -> None:
        axes = question["axes"]
        expected = self._asked("forward", *_of_axes(question))
        if not self._same_status("forward", expected, answer):
            return
        frame, configuration = expected
        margin = self._margin(axes)
        size = self.robot.reach + max(map(abs, frame.position))
        self._reals("position", frame.position, answer["frame"]["position"], size, margin)
        for row, other in zip(frame.rotation, answer["frame"]["rotation"], strict=True):
            self._reals("rotation", row, other, 1.0, margin)
        if margin > ROUNDED:
            self._equal("configuration", list(configuration), answer["configuration"])

    def _singularity(self, question: Answer, answer: Answer) -> None:
        axes = question["axes"]
        expected = self._asked("singularity", *_of_axes(question))
        if isinstance(expected, softkin.KinematicsError):
            self._same_status("singularity", expected, answer)
            return
        known = list(expected.margins.values())
        is_possible = all(map(isfinite, known)) if known else not expected.is_singular
        self._equal("singularity: status is 0", is_possible, answer["status"] == 0)
        if abs(self._margin(axes) - 1e-3) > ROUNDED:
            self._equal("is singular", expected.is_singular, answer["isSingular"])
        if is_possible and answer["status"] == 0:
            self._equal("margins", list(expected.margins), list(answer["margins"]))
            values = list(answer["margins"].values())
            self._reals("margins", list(expected.margins.values()), values, 1.0, self._margin(axes))

    def _jacobian(self, question: Answer, answer: Answer) -> None:
        """A singular pose is found with an error over the margin, and the Jacobian divides by that again."""
        axes = question["axes"]
        expected = self._asked("jacobian", *_of_axes(question))
        is_refused = isinstance(expected, softkin.KinematicsError)
        if not is_refused and answer["status"] == 4 and self._margin(axes) < ROUNDED:
            return  # rounding decides whether a pose next to the singularity is one
        if not self._same_status("jacobian", expected, answer):
            return
        if not axes:
            return  # it has no entries
        size = max((1.0, self.robot.reach, *(abs(entry) for row in expected for entry in row)))
        self._equal("rows", len(expected), len(answer["rows"]))
        margin = self._margin(axes) ** (2 if question["kind"] == "singular" else 1)
        for row, other in zip(expected, answer["rows"], strict=True):
            self._reals("jacobian", row, other, size, margin)

    def _motion(self, question: Answer, call: str, given: list[list[float]], answer: Answer) -> None:
        """Velocities and accelerations of the axes: the margin divides the error of a pose for each derivative."""
        words = {"axisVelocities": "axis_velocities", "axisAccelerations": "axis_accelerations"}
        start = {"start": question["start"]} if "start" in question else {}
        expected = self._asked(words[call], question["axes"], *given, **start)
        is_refused = isinstance(expected, softkin.KinematicsError)
        if is_refused and expected.status is not softkin.Status.IMPOSSIBLE:
            self._same_status(call, expected, answer)
            return
        margin = self._margin(question["axes"])
        if abs(margin - 1e-3) < ROUNDED or not self._same_status(call, expected, answer):
            return
        size = max((1.0, self.robot.reach, *map(abs, expected)))
        (found,) = (answer[key] for key in ("velocities", "accelerations") if key in answer)
        self._equal(f"{call}: axes", len(expected), len(found))
        self._reals(call, expected, found, size, margin**3)

    def _slots(self, question: Answer, answer: Answer) -> None:
        frame, reference = question["frame"], question["reference"]
        expected = self._asked("inverse_all", frame, reference)
        if not self._same_status("inverseAll", expected, answer):
            return
        self._equal("slots", len(expected), len(answer["slots"]))
        for number, (one, other) in enumerate(zip(expected, answer["slots"], strict=True)):
            place = f"slot {number}"
            if self._rounding_decides(one, other, expected, answer["slots"]):
                continue
            self._equal(f"{place}, status", int(one.status), other["status"])
            is_known = one.axes is None or self._margin(one.axes) > SINGULAR
            count = None if is_known else self.robot.made.BRANCHES  # turns are those of axes that are known
            known, told = (list(given[:count]) for given in (one.configuration, other["configuration"]))
            self._equal(f"{place}, configuration", known, told)
            if one.axes is None:
                self._reason(place, question, one.configuration, other)
            elif other["status"] == 0:
                self._axes(place, one.axes, other["axes"])
                self._equal(f"{place}, others", len(one.others), len(other["others"]))
                for further, found in zip(one.others, other["others"], strict=False):
                    self._axes(f"{place}, further", further, found)

    def _rounding_decides(self, one: Any, other: Answer, known: Sequence[Any], told: Sequence[Answer]) -> bool:
        """Whether only one has the solution of a slot, at a multiple root: the other has it in another slot."""
        if {int(one.status), other["status"]} != {0, int(softkin.Status.UNREACHABLE)}:
            return False
        axes = other["axes"] if one.axes is None else one.axes
        rest = [s.axes for s in known] if one.axes is None else [s["axes"] for s in told if s["status"] == 0]
        apart = [[remainder(a - b, 360.0) for a, b in zip(f, axes, strict=True)] for f in rest if f is not None]
        return any(max(map(abs, a)) < JOINED for a in apart) and self._margin(axes) < ROUNDED

    def _named(self, question: Answer, given: Any, answer: Answer) -> None:
        place = f"configuration {given}"
        expected = self._asked("inverse", question["frame"], given, question["reference"])
        if self._same_status(place, expected, answer):
            self._axes(place, expected, answer["axes"])
        elif isinstance(expected, softkin.KinematicsError):
            self._reason(place, question, given, answer)

    def _reason(self, place: str, question: Answer, configuration: Any, answer: Answer) -> None:
        """The reason of a refusal; what has not the form of a call is told in other words."""
        why = self._asked("diagnose", question["frame"], configuration, question["reference"])
        if isinstance(why, softkin.KinematicsError) or why.status is softkin.Status.OK or answer["status"] == 0:
            return
        self.refused += 1
        reason, unit = why.reason, ""
        for known in ("u", "deg"):
            if reason.endswith(f" [{known}]"):
                reason, unit = reason.removesuffix(f" [{known}]"), known
        told = (int(why.status), reason, unit, why.turn)
        self._equal(place, told, tuple(answer[key] for key in ("status", "reason", "unit", "turn")))
        scale = {"u": self.robot.reach, "deg": 180.0}.get(unit, 1.0)
        if not abs(why.missing - answer["missing"]) <= 10.0 * SAME * max(scale, abs(why.missing)):
            self.found.append(f"{place}: missing {answer['missing']!r}, expected {why.missing!r}")
        if "words" in answer and f"{why.missing:.4g}" == f"{answer['missing']:.4g}":  # C has no sentences
            self.sentences += 1
            self._equal(f"{place}, in words", why.in_words, answer["words"])

    def _asked(self, call: str, *given: Any, **start: Any) -> Any:
        """The answer of the package, or its refusal."""
        key = call, repr((given, start))
        if key not in self.known:
            try:
                self.known[key] = getattr(self.robot.made, call)(*given, **start)
            except softkin.KinematicsError as error:
                self.known[key] = error
        return self.known[key]

    def _axes(self, place: str, expected: Sequence[float], found: Sequence[float]) -> None:
        margin = self._margin(expected)
        if margin < SINGULAR:
            self._one_frame(place, expected, found)
            return
        self.regular += 1
        for angle, a, b in zip(self.robot.is_angle, expected, found, strict=True):
            self._reals(place, [a], [b], 180.0 if angle else self.robot.reach + abs(a), margin)

    def _one_frame(self, place: str, expected: Sequence[float], found: Sequence[float]) -> None:
        one, other = (self._asked("forward", axes) for axes in (expected, found))
        if isinstance(one, softkin.KinematicsError) or isinstance(other, softkin.KinematicsError):
            self._equal(place, type(one), type(other))
            return
        size = self.robot.reach + max(map(abs, one[0].position))
        pairs = [(a / size, b / size) for a, b in zip(one[0].position, other[0].position, strict=True)]
        rows = zip(one[0].rotation, other[0].rotation, strict=True)
        pairs += [pair for a, b in rows for pair in zip(a, b, strict=True)]
        if not all(abs(a - b) <= FRAME for a, b in pairs):
            self.found.append(f"{place}: axes {found} lead elsewhere than {expected}")

    def _margin(self, axes: Sequence[float]) -> float:
        """The smallest margin in size; 1 where there is none, and where the axes allow no pose."""
        singularity = self._asked("singularity", axes)
        if isinstance(singularity, softkin.KinematicsError):
            raise singularity
        margins = [abs(m) for m in singularity.margins.values()]
        return min((1.0, *margins)) if all(map(isfinite, margins)) else 1.0

    def _reals(self, place: str, expected: Sequence[float], found: Sequence[float], size: float, margin: float) -> None:
        allowed = SAME * size / max(margin, 1e-300)
        for a, b in zip(expected, found, strict=True):
            if not abs(a - b) <= allowed:
                self.found.append(f"{place}: {b!r}, expected {a!r}, margin {margin:.1e}")

    def _same_status(self, place: str, expected: Any, answer: Answer) -> bool:
        """Whether both succeed; a difference is noted."""
        status = int(expected.status) if isinstance(expected, softkin.KinematicsError) else 0
        self._equal(f"{place}: status", status, answer["status"])
        return status == answer["status"] == 0

    def _equal(self, place: str, expected: Any, found: Any) -> None:
        if expected != found:
            self.found.append(f"{place}: {found!r}, expected {expected!r}")


@lru_cache(_MACHINES)
def _answers(recipe: str) -> dict[tuple[str, str], Any]:
    """What the package answered of a machine: JavaScript, C and every planted fault are held against the same."""
    return {}


def compared(
    recording: list[Answer], ask: Callable[[list[Answer]], list[Answer]], said: Callable[[Answer], Answer | None]
) -> list[Comparison]:
    """The machines of a recording, each compared. ask: the language; said: a question as it can be put there."""
    asked = [[q for q in map(said, part["asked"]) if q is not None] for part in recording]
    robots = [robot(part["recipe"]) for part in recording]
    rows = [len(one.made.JACOBIAN_ROWS) for one in robots]
    machines = [
        {"parameters": part["recipe"][0]["parameters"], "calls": [call for q in own for call in calls_of(q, count)]}
        for part, own, count in zip(recording, asked, rows, strict=True)
    ]
    found = []
    for made, own, answer in zip(robots, asked, ask(machines), strict=True):
        one = Comparison(made)
        assert answer["made"] == {"status": 0}
        answers = iter(answer["found"])
        for question in own:
            one.compare(question, answers)
        assert next(answers, None) is None
        found.append(one)
    return found


def differences(every: list[Comparison]) -> list[str]:
    return [text for one in every for text in one.found]


def check(name: str, every: list[Comparison], least: int = 10) -> None:
    """Every answer is that of the package, and enough of them are solutions and refusals with reasons."""
    found = differences(every)
    assert not found, f"{len(found)} differences:\n" + "\n".join(found[:SHOWN])
    least = 0 if name == "Kin_Tool" else least
    assert sum(one.regular for one in every) >= least
    assert sum(one.refused for one in every) >= least
