"""Questions to the driver and its answers, in the form that the comparison of languages has: see `driver.c`."""

import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from struct import iter_unpack, pack
from typing import Any

Answer = dict[str, Any]
Call = list[Any]
_CALLS = (
    "forward", "singularity", "jacobian", "inverse", "inverseAll", "limits", "axisVelocities", "axisAccelerations",
)  # fmt: skip
_MOTIONS = {"axisVelocities": "velocities", "axisAccelerations": "accelerations"}
"""The calls whose answer has a value for each axis besides the inverse, with the word for it."""


@dataclass(frozen=True)
class Description:
    """What a mechanism says of itself: the sizes of its arrays, and the names that its answers have."""

    name: str
    axes: tuple[Answer, ...]
    parameters: tuple[Answer, ...]
    configuration: tuple[tuple[str, str, str, int], ...]
    branches: int
    margins: tuple[str, ...]
    rows: tuple[str, ...]
    quantities: int

    @property
    def bytes(self) -> int:
        """Of a configuration."""
        return len(self.configuration)


@cache
def described(program: Path) -> Description:
    """The description of the mechanism of a program."""
    stream = _Stream(_run(program, pack("d", len(_CALLS) + 1.0)))
    axes, branches, periods, rows, margins, _, parameters, quantities = map(int, stream.numbers(8))
    return Description(
        stream.text(),
        tuple(stream.named("name kind unit meaning", "multi_turn") for _ in range(axes)),
        tuple(
            stream.named("name kind unit meaning", "low high low_is_open default nominal") for _ in range(parameters)
        ),
        tuple((stream.text(), stream.text(), stream.text(), int(stream.number())) for _ in range(branches + periods)),
        branches,
        tuple(stream.text() for _ in range(margins)),
        tuple(stream.text() for _ in range(rows)),
        quantities,
    )


def said(question: Answer, known: Description) -> Answer | None:
    """A question of the corpus as C can put it."""
    return as_arrays(question, len(known.axes), known.bytes)


def as_arrays(question: Answer, axes: int, count: int) -> Answer | None:
    """A question of the corpus, if it can be put in arrays of so many axes, and so many bytes of a configuration."""
    frames = [question[key] for key in ("frame", "start") if key in question]
    lists = [question[key] for key in ("axes", "reference") if question.get(key) is not None]
    if not all(_is_frame(frame) for frame in frames) or not all(_is_row(row, axes) for row in lists):
        return None
    kept = [one for one in question.get("configurations", ()) if one is None or _is_bytes(one, count)]
    return question | ({"configurations": kept} if "configurations" in question else {})


def _is_frame(frame: Any) -> bool:
    position, rotation = frame
    return _is_row(position, 3) and isinstance(rotation, list) and len(rotation) == 3 and all(
        _is_row(row, 3) for row in rotation
    )  # fmt: skip


def _is_row(values: Any, count: int) -> bool:
    return isinstance(values, list) and len(values) == count and all(type(v) in (int, float) for v in values)


def _is_bytes(values: Any, count: int) -> bool:
    return _is_row(values, count) and all(value in range(-128, 256) for value in values)


@dataclass
class _Stream:
    """The answer of the driver, read from its begin."""

    data: bytes
    place: int = 0

    def number(self) -> float:
        return self.numbers(1)[0]

    def numbers(self, count: int) -> list[float]:
        start, self.place = self.place, self.place + 8 * count
        assert self.place <= len(self.data), "the driver says less than it is asked"
        return [value for (value,) in iter_unpack("d", self.data[start : self.place])]

    def text(self) -> str:
        start = self.place + 8
        self.place = start + int(self.number())
        return self.data[start : self.place].decode()

    def named(self, texts: str, numbers: str) -> Answer:
        """Texts, then numbers, by their names."""
        found: Answer = {name: self.text() for name in texts.split()}
        return found | {name: self.number() for name in numbers.split()}

    def refused(self) -> Answer:
        """The status, and where it is not 0 the refusal."""
        status = int(self.number())
        if status == 0:
            return {"status": 0}
        reason, unit, missing, turn = self.text(), self.text(), self.number(), int(self.number())
        return {
            "status": status, "reason": reason, "unit": unit, "missing": missing, "turn": turn,
            "parameters": self.text(),
        }  # fmt: skip


def ask(program: Path, machines: Sequence[Answer]) -> list[Answer]:
    """What machines answer, {"parameters": …, "calls": …} each; the sanitizers have nothing to say."""
    known = described(program)
    asked = b"".join(_machine(known, machine) for machine in machines)
    stream = _Stream(_run(program, asked))
    found = []
    for machine in machines:
        made = stream.refused()
        found.append({"made": made, "found": [_answer(stream, known, call) for call in machine["calls"]]})
    assert stream.place == len(stream.data), "the driver says more than it is asked"
    return found


def _run(program: Path, asked: bytes) -> bytes:
    done = subprocess.run([program], input=asked, capture_output=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr.decode(errors="replace")[:3000]
    return done.stdout


def _machine(known: Description, machine: Answer) -> bytes:
    names = [p["name"] for p in known.parameters]
    given = [(names.index(name), float(value)) for name, value in machine["parameters"].items()]
    numbers = [0.0, *(part for pair in given for part in pair), -1.0]
    return pack(f"{len(numbers)}d", *numbers) + b"".join(_call(known, call) for call in machine["calls"])


def _call(known: Description, call: Call) -> bytes:
    name, *given = call
    numbers = [float(_CALLS.index(name) + 1)]
    if name in ("forward", "singularity", "jacobian", "limits"):
        numbers += given[0]
        numbers += [] if name == "limits" else _optional(_frame(given[1]) if len(given) > 1 else None)
    elif name in _MOTIONS:
        arrays = [one for one in given if not isinstance(one, dict)]
        numbers += [part for one in arrays for part in one]
        numbers += _optional(_frame(given[-1]) if len(given) > len(arrays) else None)
    else:
        numbers += _frame(given[0])
        for one in given[1:]:
            numbers += _optional(one)
    return pack(f"{len(numbers)}d", *numbers)


def _frame(frame: Answer) -> list[float]:
    return [*frame["position"], *(entry for row in frame["rotation"] for entry in row)]


def _optional(values: Sequence[float] | None) -> list[float]:
    return [0.0] if values is None else [1.0, *values]


def _answer(stream: _Stream, known: Description, call: Call) -> Answer:
    name = call[0]
    if name == "inverseAll":
        return _slots(stream, known)
    answer = stream.refused()
    if name == "singularity" and answer["status"]:
        return answer | {"isSingular": True}  # that is what such a status says
    if name == "limits":
        quantities = stream.refused()
        return answer | {"quantities": stream.numbers(known.quantities) if quantities["status"] == 0 else None}
    return answer if answer["status"] else answer | _results(stream, known, name)


def _results(stream: _Stream, known: Description, name: str) -> Answer:
    if name == "forward":
        position, entries = stream.numbers(3), stream.numbers(9)
        frame = {"position": position, "rotation": [entries[3 * i : 3 * i + 3] for i in range(3)]}
        configuration = list(map(int, stream.numbers(known.bytes)))
        return {"frame": frame, "configuration": configuration, "margins": stream.numbers(known.branches)}
    if name == "singularity":
        is_singular = bool(stream.number())
        margins = stream.numbers(len(known.margins))
        return {"isSingular": is_singular, "margins": dict(zip(known.margins, margins, strict=True))}
    if name == "jacobian":
        entries = stream.numbers(len(known.rows) * len(known.axes))
        return {"rows": [entries[len(known.axes) * i : len(known.axes) * (i + 1)] for i in range(len(known.rows))]}
    return {_MOTIONS.get(name, "axes"): stream.numbers(len(known.axes))}


def _slots(stream: _Stream, known: Description) -> Answer:
    status = int(stream.number())
    slots = []
    for _ in range(2**known.branches if status == 0 else 0):
        slot = stream.refused()
        slot |= {"axes": stream.numbers(len(known.axes))} if slot["status"] == 0 else {}
        slots.append(slot | {"configuration": list(map(int, stream.numbers(known.bytes))), "others": []})
    for _ in range(int(stream.number())):
        place = int(stream.number())
        slots[place]["others"].append(stream.numbers(len(known.axes)))
    return {"status": status, "slots": slots}
