"""`new`: a commented description to start from, which can be derived as it is; or that of a five-axis machine."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from derive.description.mechanism import DescriptionError
from derive.five_axes import ORDERS

_TEXT = '''\
"""My machine: two links in a plane, a quill, and a turn of the tool (a SCARA). Change it into yours.

    softkin check {file}                   derive and measure it
    softkin explain {file}                 each step of the derivation, and the branches to be named
    softkin derive {file} --out build      Python package and function block
"""

from sympy import sin  # and cos: for branches, closed loops, and lengths that depend on angles

from derive.frames import Rz, Tx, Tz  # and Rx, Ry, Ty: turns about x, y, z, and shifts along them
from derive.mechanism import Mechanism, Task, Turning, branch, distance, length, linear, rotary

# Lengths. `length` must be given and be more than 0; `distance` may be 0 or negative, and is 0 when not given;
# `angle` is in degrees, `radians(ANGLE)` inside a chain. `nominal` is the value for pictures and tests.
L1 = length("link_length_1", "Axis A1 to axis A2", nominal=325.0)
L2 = length("link_length_2", "Axis A2 to axis A4", nominal=225.0)
HEIGHT = distance("height", "Base to the tool with A3 at 0, along Z", nominal=0.0)

# Axes, in the order of the controller. `rotary` may turn more than once, `arc` never does, `linear` slides.
A1 = rotary("A1", "Arm 1 about Z")
A2 = rotary("A2", "Arm 2 about Z")
A3 = linear("A3", "Quill along Z, up")
A4 = rotary("A4", "Tool about Z")

MECHANISM = Mechanism(
    name="{name}",  # the function block, and the class in Python
    parameters=(L1, L2, HEIGHT),
    joints=(A1, A2, A3, A4),
    # From the base to the tool: each factor turns or shifts what stands to the right of it.
    chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(HEIGHT + A3) * Rz(A4),
    # What a program commands: as many quantities as there are axes. "xyz" and a turn about Z are four. Turning.NONE
    # commands no rotation, Turning.DIRECTION the direction of the tool (two), Turning.FULL all three.
    task=Task("xyz", Turning.ABOUT_Z),
    # Two solutions are told apart by the sign of an expression. Leave branches out at first: they are then derived,
    # and `softkin explain` prints them, to be named.
    branches=(branch("elbow", sin(A2), right=+1, left=-1),),
)
'''

_FIVE_AXES = '''\
"""My five-axis machine: {order}. `five_axes` makes the description of its letters.

    softkin explain {file}                 its parameters and axes, and each step of the derivation
    softkin check {file}                   derive and measure it
    softkin derive {file} --out build      Python package and function block
"""

from derive.five_axes import five_axes

MECHANISM = five_axes("{name}", {words})
'''
_FURTHER = ("nutating", "location_errors", "tool_vector")
"""What a machine with five axes may have beside its order."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """What `new` takes."""
    parser.add_argument("file", type=Path, nargs="?", default=Path("my_machine.py"), metavar="FILE")
    text = f"a machine with five axes, by the order of its turning axes: {', '.join(ORDERS)}"
    parser.add_argument("--five-axis", choices=ORDERS, metavar="ORDER", help=text)
    text = "with --five-axis: the trunnion, or the axis of the head next to the tool, is inclined"
    parser.add_argument("--nutating", action="store_true", help=text)
    text = "with --five-axis: parameters for the errors of the place and the direction of each turning axis"
    parser.add_argument("--location-errors", action="store_true", help=text)
    text = "with --five-axis: parameters tool_x and tool_y, for a tip of the tool beside the axis of the spindle"
    parser.add_argument("--tool-vector", action="store_true", help=text)
    parser.set_defaults(run=new)


def new(options: argparse.Namespace) -> int:
    """Write the description; raises `DescriptionError` where there is a file already, or a word stands alone."""
    if options.five_axis is None and any(getattr(options, word) for word in _FURTHER):
        raise DescriptionError("--nutating, --location-errors and --tool-vector say more of --five-axis ORDER: add it")
    path: Path = options.file
    path = path if path.suffix == ".py" else path.with_name(f"{path.name}.py")
    name = "".join(word[:1].upper() + word[1:] for word in re.split(r"[^A-Za-z0-9]+", path.stem))
    name = name if name[:1].isalpha() else f"Machine{name}"
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(_five_axes(path.name, name, options) if options.five_axis else description(path.name, name))
    except FileExistsError:
        raise DescriptionError(f"{path} is there already: name another file") from None
    print(f"{path}: a description to change. Next: softkin check {path}")
    return 0


def description(file: str, name: str) -> str:
    """The text of a description in a file, of a machine with a name."""
    return _TEXT.format(file=file, name=name)


def _five_axes(file: str, name: str, options: argparse.Namespace) -> str:
    head, table = ORDERS[options.five_axis]
    words = [f'{place}="{axes}"' for place, axes in (("head", head), ("table", table)) if axes]
    words += [f"{word}=True" for word in _FURTHER if getattr(options, word)]
    return _FIVE_AXES.format(file=file, name=name, order=options.five_axis, words=", ".join(words))
