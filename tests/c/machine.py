"""Questions to the driver and its answers, in the form that the comparison of languages has: see `driver.c`."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from struct import iter_unpack, pack
from typing import Any

from derive.kinematics.kinematics import Kinematics

Answer = dict[str, Any]
Call = list[Any]
_CALLS = ("forward", "singularity", "jacobian", "inverse", "inverseAll", "limits")


@dataclass(frozen=True)
class Counts:
    """The sizes of the arrays of a mechanism, and the names that its answers have."""

    parameters: tuple[str, ...]
    axes: int
    branches: int
    periods: int
    rows: int
    margins: tuple[str, ...]
    quantities: int

    @property
    def bytes(self) -> int:
        """Of a configuration."""
        return self.branches + self.periods


def counts_of(kin: Kinematics, names: Sequence[str]) -> Counts:
    """The sizes of a derived mechanism. names: what its parameters are called in C."""
    return Counts(
        tuple(names), len(kin.mechanism.joints), len(kin.branches), len(kin.period_joints), len(kin.rows),
        tuple(m.name for m in kin.margins), len(kin.limited),
    )  # fmt: skip


def said(question: Answer, counts: Counts) -> Answer | None:
    """A question of the corpus as C can put it: what has another form than its arrays cannot be asked."""
    frames = [question[key] for key in ("frame", "start") if key in question]
    lists = [question[key] for key in ("axes", "reference") if question.get(key) is not None]
    if not all(_is_frame(frame) for frame in frames) or not all(_is_row(row, counts.axes) for row in lists):
        return None
    kept = [one for one in question.get("configurations", ()) if one is None or _is_bytes(one, counts.bytes)]
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


def ask(program: Path, counts: Counts, machines: Sequence[Answer]) -> list[Answer]:
    """What machines answer, {"parameters": …, "calls": …} each; the sanitizers have nothing to say."""
    asked = b"".join(_machine(counts, machine) for machine in machines)
    done = subprocess.run([program], input=asked, capture_output=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr.decode(errors="replace")[:3000]
    stream = _Stream(done.stdout)
    found = []
    for machine in machines:
        made = stream.refused()
        found.append({"made": made, "found": [_answer(stream, counts, call) for call in machine["calls"]]})
    assert stream.place == len(done.stdout), "the driver says more than it is asked"
    return found


def _machine(counts: Counts, machine: Answer) -> bytes:
    given = [(counts.parameters.index(name), float(value)) for name, value in machine["parameters"].items()]
    numbers = [0.0, *(part for pair in given for part in pair), -1.0]
    return pack(f"{len(numbers)}d", *numbers) + b"".join(_call(counts, call) for call in machine["calls"])


def _call(counts: Counts, call: Call) -> bytes:
    name, *given = call
    numbers = [float(_CALLS.index(name) + 1)]
    if name in ("forward", "singularity", "jacobian", "limits"):
        numbers += given[0]
        numbers += (_optional(_frame(given[1]) if len(given) > 1 else None)) if name == "forward" else []
    else:
        numbers += _frame(given[0])
        for one in given[1:]:
            numbers += _optional(one)
    return pack(f"{len(numbers)}d", *numbers)


def _frame(frame: Answer) -> list[float]:
    return [*frame["position"], *(entry for row in frame["rotation"] for entry in row)]


def _optional(values: Sequence[float] | None) -> list[float]:
    return [0.0] if values is None else [1.0, *values]


def _answer(stream: _Stream, counts: Counts, call: Call) -> Answer:
    name = call[0]
    if name == "inverseAll":
        return _slots(stream, counts)
    answer = stream.refused()
    if name == "singularity" and answer["status"]:
        return answer | {"isSingular": True}  # that is what such a status says
    if name == "limits":
        quantities = stream.refused()
        return answer | {"quantities": stream.numbers(counts.quantities) if quantities["status"] == 0 else None}
    return answer if answer["status"] else answer | _results(stream, counts, name)


def _results(stream: _Stream, counts: Counts, name: str) -> Answer:
    if name == "forward":
        position, entries = stream.numbers(3), stream.numbers(9)
        frame = {"position": position, "rotation": [entries[3 * i : 3 * i + 3] for i in range(3)]}
        configuration = list(map(int, stream.numbers(counts.bytes)))
        return {"frame": frame, "configuration": configuration, "margins": stream.numbers(counts.branches)}
    if name == "singularity":
        is_singular = bool(stream.number())
        margins = stream.numbers(len(counts.margins))
        return {"isSingular": is_singular, "margins": dict(zip(counts.margins, margins, strict=True))}
    if name == "jacobian":
        entries = stream.numbers(counts.rows * counts.axes)
        return {"rows": [entries[counts.axes * i : counts.axes * (i + 1)] for i in range(counts.rows)]}
    return {"axes": stream.numbers(counts.axes)}


def _slots(stream: _Stream, counts: Counts) -> Answer:
    status = int(stream.number())
    slots = []
    for _ in range(2**counts.branches if status == 0 else 0):
        slot = stream.refused()
        slot |= {"axes": stream.numbers(counts.axes)} if slot["status"] == 0 else {}
        slots.append(slot | {"configuration": list(map(int, stream.numbers(counts.bytes))), "others": []})
    for _ in range(int(stream.number())):
        place = int(stream.number())
        slots[place]["others"].append(stream.numbers(counts.axes))
    return {"status": status, "slots": slots}
