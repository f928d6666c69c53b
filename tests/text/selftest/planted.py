"""Faults in a block, all in one text: an input chooses which of them it has."""

from __future__ import annotations

import re
from dataclasses import dataclass

from derive.description.mechanism import Mechanism
from tests.text.units import text_of

_SWITCH = "iFault"


@dataclass(frozen=True)
class Planted:
    """The text of a unit, and what goes wrong in it by the number of the fault."""

    text: str
    faults: dict[int, str]


def planted(mechanism: Mechanism) -> Planted:
    """Every number that forward and inverse kinematics write, a little larger; every byte, answer and limit wrong."""
    text = text_of(mechanism)
    head, tail = text.split("END_FUNCTION_BLOCK", 1)
    axes = len(mechanism.joints)
    faults: list[str] = []
    for method, pattern in (
        ("AxesToCartesian", r"^(f\.vT\.d[XYZ]|rot\[\d, \d\])() :=[^;]*;\n"),
        ("AxesToCartesian", r"^(configBytes\.abyData)(\[\d+\]) :=[^;]*;\n"),
        ("SolveBranch", rf"^(a\.a[0-{max(axes - 1, 0)}])() :=[^;]*;\n"),
        ("FindMargins", r"^(FindMargins)() :=[^;]*;\n"),
        ("TestLimits", r"^(IF NOT checkLimits)() THEN\n"),
        ("CartesianToAxes", r"^(a := solution)();\n"),
    ):
        if "abyData" in pattern and not (mechanism.branches or mechanism.period_joints):
            continue
        if axes or method not in ("SolveBranch", "TestLimits"):
            head = _in_method(head, method, pattern, faults)
    declared = head.replace("\nVAR_INPUT\n", f"\nVAR_INPUT\n  {_SWITCH} : INT := 0;\n", 1)
    return Planted(f"{declared}END_FUNCTION_BLOCK{tail}", dict(enumerate(faults, start=1)))


def _in_method(text: str, method: str, pattern: str, faults: list[str]) -> str:
    head = re.search(rf"METHOD (?:PUBLIC|PRIVATE|PROTECTED) {method}\b.*\n", text)
    assert head is not None
    start = head.start()
    end = text.index("END_METHOD", start)

    def wrong(found: re.Match[str]) -> str:
        place = "".join(found.groups())
        faults.append(f"{method}: {place}")
        chosen = f"{_SWITCH} = {len(faults)}"
        if "abyData" in place:
            return f"{found.group()}IF {chosen} THEN\n  {place} := 9;\nEND_IF\n"
        if place == "FindMargins":
            return f"{found.group()}IF {chosen} THEN\n  {place} := Softkin_Names.NotInitialized;\nEND_IF\n"
        if place.startswith("IF"):
            return f"IF NOT checkLimits OR ({chosen}) THEN\n"
        if place == "a := solution":
            refusal = "CartesianToAxes := Softkin_Names.InvalidCoupling;"
            return f"IF {chosen} THEN\n  {refusal}\n  RETURN;\nEND_IF\n{found.group()}"
        return f"{found.group()}{place} := {place} + SEL({chosen}, 0.0, 0.0001);\n"

    changed, count = re.subn(pattern, wrong, text[start:end], flags=re.MULTILINE)
    assert count, f"nothing to spoil in {method}"
    return text[:start] + changed + text[end:]
