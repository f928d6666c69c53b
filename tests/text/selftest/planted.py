"""Faults in a block, all in one text: an input chooses which of them it has."""

import re
from dataclasses import dataclass

from derive.description.mechanism import Mechanism
from tests.text.units import text_of

_SWITCH = "iFault"
_POSE = (*(f"v.d{axis}" for axis in "XYZ"), *(f"rot[{row}, {column}]" for row in (1, 2, 3) for column in (1, 2, 3)))


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
        ("FindPose", r"^(aBranches\[\d\]) :=[^;]*;\n"),
        ("FindPose", r"^(FindPose) :=[^;]*;\n"),
        ("SolveBranch", rf"^(a\.a[0-{max(axes - 1, 0)}]) :=[^;]*;(?:  // .*)?\n"),
        ("FindMargins", r"^(FindMargins) :=[^;]*;\n"),
        ("ReadInputs", r"^(checkLimits) := xCheckLimits;\n"),
        ("SolveBranch", r"^(SolveBranch) := Softkin_Names\.NoError;\n"),
    ):
        is_own = method != "FindMargins" or f"METHOD PROTECTED {method} " in head  # else it is that of the base
        if is_own and (axes or method not in ("SolveBranch", "ReadInputs")):
            head = _in_method(head, method, pattern, faults)
    declared = head.replace("\nVAR_INPUT\n", f"\nVAR_INPUT\n  {_SWITCH} : INT := 0;\n", 1)
    return Planted(f"{declared}END_FUNCTION_BLOCK{tail}", dict(enumerate(faults, start=1)))


def _in_method(text: str, method: str, pattern: str, faults: list[str]) -> str:
    head = re.search(rf"METHOD (?:PUBLIC|PRIVATE|PROTECTED) {method}\b.*\n", text)
    assert head is not None
    start = head.start()
    end = text.index("END_METHOD", start)

    def wrong(found: re.Match[str]) -> str:
        place = found.group(1)
        if place == "FindPose":
            return "".join(larger(entry) for entry in _POSE) + found.group()
        if place.startswith("a.a"):
            return found.group() + larger(place)
        chosen = fault(place)
        if place.startswith("aBranches"):
            return f"{found.group()}{place} := {place}*SEL({chosen}, 1.0, -1.0);\n"
        if place == "checkLimits":
            return f"checkLimits := xCheckLimits AND NOT ({chosen});\n"
        error = {"FindMargins": "NotInitialized", "SolveBranch": "InvalidCoupling"}[place]
        return f"{found.group()}IF {chosen} THEN\n  {place} := Softkin_Names.{error};\nEND_IF\n"

    def fault(place: str) -> str:
        faults.append(f"{method}: {place}")
        return f"{_SWITCH} = {len(faults)}"

    def larger(place: str) -> str:
        return f"{place} := {place} + SEL({fault(place)}, 0.0, 0.0001);\n"

    changed, count = re.subn(pattern, wrong, text[start:end], flags=re.MULTILINE)
    assert count or "aBranches" in pattern, f"nothing to spoil in {method}"
    return text[:start] + changed + text[end:]
