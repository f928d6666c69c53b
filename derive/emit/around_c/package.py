"""A controller as data: which machines it takes, where the C stands, and the file around the C of each machine.

What is the same for every machine is the runtime of the controller; it reads a machine by its description in C.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derive.description.mechanism import Mechanism, Turning
from derive.emit.around_c.wire_frame import wire_frame
from derive.emit.braced import harmless
from derive.emit.c import package as c
from derive.emit.c.description import inputs
from derive.emit.language import GENERATED, Part, environment, head_of, runtime
from derive.kinematics.kinematics import Kinematics

_FUNCTIONS = (
    ("direct", "Dir"), ("inverse", "Inv"), ("direct_derivative", "DirDer"), ("inverse_derivative", "InvDer"),
)  # fmt: skip
"""The functions of mapp Motion: our name, and the word in the name of their structure."""


@dataclass(frozen=True)
class AroundC:
    """The language of a controller."""

    name: str
    title: str
    bound: str
    takes: Callable[[Mechanism], bool]
    written: Mapping[str, str]
    """The file of a machine, with `{module}` in its path → its template."""
    folder: str = ""
    """Where the C stands."""

    def part(self, kinematics: Kinematics) -> Part | None:
        """The C of a machine, and the file around it; None if the controller does not take the machine."""
        inner = c.part(kinematics)
        if inner is None or not self.takes(kinematics.mechanism):
            return None
        module = inner["index"]["module"]
        own = {f"{self.folder}{path}": text for path, text in inner["files"].items()}
        templates = environment(self.name)
        for path, template in self.written.items():
            own[path.format(module=module)] = templates.get_template(template).render(_known(kinematics, module))
        return {"index": inner["index"], "files": own, "notes": list(inner["notes"])}

    def files(self, parts: Sequence[Part]) -> dict[str, str]:
        """All files: path → text."""
        found = runtime(self.name) | {f"{self.folder}{path}": text for path, text in c.shared().items()}
        for one in parts:
            found |= one["files"]
        return found


def _known(kin: Kinematics, module: str) -> dict[str, Any]:
    """The values that templates arrange."""
    names = inputs(kin).names
    return {
        "generated": GENERATED,
        "module": module,
        "name": kin.mechanism.name,
        "head": [harmless(line) for line in head_of(kin, inputs(kin).notes)],
        "position": kin.mechanism.task.position,
        "axes": [(joint.name, joint.in_degrees) for joint in kin.mechanism.joints],
        "branches": [(branch.name, branch.names) for branch in kin.branches],
        "functions": _FUNCTIONS,
        "wire_frame": lambda: wire_frame(kin, module),
        "parameters": [(names[p.name], p.default) for p in kin.parameters],
    }


def only_positions(mechanism: Mechanism) -> bool:
    """Whether a position decides the axes: no turn is commanded, and no joint is moved by hand."""
    is_whole = len(mechanism.joints) - len(mechanism.surplus) == len(mechanism.task.position) > 0
    return is_whole and mechanism.task.turning is Turning.NONE and not mechanism.held_joints


def commands_all_axes(mechanism: Mechanism) -> bool:
    """Whether a position, with no turn, one about z or a whole rotation, has as many coordinates as there are axes."""
    turns = {Turning.NONE: 0, Turning.ABOUT_Z: 1, Turning.FULL: 3}.get(mechanism.task.turning, -1)
    is_whole = len(mechanism.joints) == len(mechanism.task.position) + turns
    return turns >= 0 and is_whole and bool(mechanism.task.position) and not mechanism.held_joints


br = AroundC(
    "br", "B&R mapp Motion",
    "no functions for B&R: its {axes} axes are not those of a position with no turn, one about z, or a whole rotation",
    commands_all_axes, {"{module}_br.h": "machine.h.j2", "{module}_br.c": "machine.c.j2"},
)  # fmt: skip
klipper = AroundC(
    "klipper", "Klipper",
    "no module for Klipper: it takes machines whose position alone decides all {axes} axes",
    only_positions, {"softkin_{module}.py": "machine.py.j2"}, "softkin/",
)  # fmt: skip
