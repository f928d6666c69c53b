"""Questions and what the package answers, as plain data; of a refusal the status, and the message without numbers."""

import re
from collections.abc import Callable, Iterable
from math import isfinite
from typing import Any

import softkin

from tests.corpus.robots import Robot

Question = dict[str, Any]
Answer = dict[str, Any]

_AS_THEY_ARE = (str, bool)
_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w.]*\w)")


def answer(one: Robot, question: Question) -> Answer:
    return _CALLS[question["call"]](one, question)


APPENDED = "warning_distance"
"""The last parameter of every mechanism, newer than the recordings and with a default; `test_package` holds it."""


def facts(one: Robot) -> Answer:
    """What a class says of itself."""
    made = one.made
    names = (
        "NAME", "DEFAULT_CONFIGURATION", "JACOBIAN_ROWS", "MARGINS", "READS_ROTATION", "FREEDOM", "ROLE", "BRANCHES",
    )  # fmt: skip
    found = {name: getattr(made, name) for name in (*names, "PERIOD_AXES", "DISTANCE_AXES")}
    lists = {name: [str(one) for one in getattr(made, name)] for name in ("AXES", "PARAMETERS", "CONFIGURATION")}
    if made.PARAMETERS and made.PARAMETERS[-1].name == APPENDED:
        lists["PARAMETERS"].pop()
    return plain(found | lists | {"text": repr(made)})


def plain(value: Any) -> Any:
    """Lists, dictionaries, text and numbers; of a real the digits that matter."""
    if isinstance(value, float):
        return round(float(f"{value:.12g}"), 12) + 0.0 if isfinite(value) else value
    if isinstance(value, dict):
        return {key: plain(part) for key, part in value.items()}
    if value is None or isinstance(value, _AS_THEY_ARE):
        return value
    if isinstance(value, int):
        return int(value)
    return [plain(part) for part in value]


def smallest_margin(one: Robot, axes: Iterable[float], **start: Any) -> float:
    """The smallest margin in size at axis values, to three digits; 1 where there is none, 0 where one is no number."""
    found = [abs(margin) for margin in one.made.singularity(axes, **start).margins.values()]
    return float(f"{min(found, default=1.0):.3g}") if all(map(isfinite, found)) else 0.0


def _made(one: Robot, question: Question) -> Answer:
    """Whether parameters are allowed."""
    return _caught(lambda: {"text": repr(one.changed(**question["parameters"]).made)})


def _forward(one: Robot, question: Question) -> Answer:
    axes = question["axes"]

    def found() -> Answer:
        start = {"start": question["start"]} if "start" in question else {}
        frame, configuration = one.made.forward(axes, **start)
        singularity = one.made.singularity(axes, **start)
        turned = _same(one.made.orientation(axes, **start), frame.rotation)
        more = {"jacobian": one.made.jacobian(axes, **start)} if question.get("jacobian") else {}
        return {
            "position": frame.position, "rotation": frame.rotation, "configuration": configuration,
            "margins": dict(singularity.margins), "singular": singularity.is_singular,
            "margin": smallest_margin(one, axes, **start), "turned": turned, **more,
        }  # fmt: skip

    return _caught(found)


def _same(rows: Any, others: Any) -> bool:
    return all(abs(a - b) <= 1e-12 for r, o in zip(rows, others, strict=True) for a, b in zip(r, o, strict=True))


def _inverse(one: Robot, question: Question) -> Answer:
    """Every slot with the reason of those that refuse, then the configurations that are named."""
    frame, reference = question["frame"], question["reference"]

    def slots() -> Answer:
        found = one.made.inverse_all(frame, reference)
        return {"slots": [_slot(one, frame, reference, solution) for solution in found]}

    named = [_named(one, frame, given, reference) for given in question["configurations"]]
    more = {"trusted": _trusted(one, frame, reference)} if question.get("trusted") else {}
    return _caught(slots) | {"named": named} | more


def _slot(one: Robot, frame: Any, reference: Any, solution: softkin.Solution) -> Answer:
    found: Answer = {"status": int(solution.status), "configuration": plain(solution.configuration)}
    if solution.axes is None:
        return found | {"why": _why(one, frame, solution.configuration, reference)}
    more = {"others": plain(solution.others)} if solution.others else {}
    return found | {"axes": plain(solution.axes), "margin": smallest_margin(one, solution.axes)} | more


def _named(one: Robot, frame: Any, configuration: Any, reference: Any) -> Answer:
    def found() -> Answer:
        axes = one.made.inverse(frame, configuration, reference)
        return {"status": 0, "axes": axes, "margin": smallest_margin(one, axes)}

    answered = _caught(found)
    return answered | {"why": _why(one, frame, configuration, reference)}


def _why(one: Robot, frame: Any, configuration: Any, reference: Any) -> Answer:
    """What `diagnose` says, without the projection, which is newer than the recordings; `test_projection` holds it."""
    return _caught(lambda: _told(one, frame, configuration, reference))


def _told(one: Robot, frame: Any, configuration: Any, reference: Any) -> Answer:
    found = one.made.diagnose(frame, configuration, reference)._asdict()
    del found["projection"]
    return found


def _trusted(one: Robot, frame: Any, reference: Any) -> Any:
    """The calls for inner loops, of plain tuples."""
    position, rows = frame
    given = tuple(position), tuple(map(tuple, rows))
    near = None if reference is None else tuple(map(float, reference))
    return plain(one.made.branches(given, near))


def _offset(one: Robot, question: Question) -> Answer:
    def found() -> Answer:
        axes, arm = question["axes"], question["offset"]
        configuration = one.made.configuration_offset(axes, arm)
        back = one.made.inverse_offset(question["point"], arm, configuration, question["reference"])
        return {"status": 0, "configuration": configuration, "axes": back, "margin": smallest_margin(one, back)}

    return _caught(found)


def _image(one: Robot, question: Question) -> Answer:
    return _caught(lambda: one.made.orientation_image()._asdict())


def _projected(one: Robot, question: Question) -> Answer:
    return _caught(lambda: {"rotation": one.made.project(question["rotation"])})


def _on(one: Robot, question: Question) -> Answer:
    """An orientation kinematics on a flange."""

    def found() -> Answer:
        image = softkin.OrientationImage(**question["image"])
        return {"compatible": one.made.is_compatible(image)} | one.made.image_on(image)._asdict()

    return _caught(found)


_CALLS: dict[str, Callable[[Robot, Question], Answer]] = {
    "make": _made, "forward": _forward, "inverse": _inverse, "offset": _offset, "image": _image, "project": _projected,
    "on": _on,
}  # fmt: skip


def _caught(call: Callable[[], Answer]) -> Answer:
    """What a call gives, or the error that it raises."""
    try:
        return {key: plain(value) for key, value in call().items()}
    except softkin.KinematicsError as error:
        return {"status": int(error.status), "message": _NUMBER.sub("#", _message(error))}


def _message(error: softkin.KinematicsError) -> str:
    """The message, with the reason as data in it: its unit stands behind the reason, however a reader is told."""
    why = error.refusal
    if why is None:
        return str(error)
    amount = f", missing {why.missing:.4g}" if why.missing else ""
    turn = f", which is turn {why.turn}" if why.turn else ""
    return str(error).replace(why.in_words, f"{why.reason}{amount}{turn}")
