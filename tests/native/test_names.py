"""Machines that are called like files of the core: each has its own files, and all of them make one extension."""

import sys
from pathlib import Path

from sympy import sin

from derive.emit import native
from derive.emit.python.mechanism_modules import index
from derive.frames import Rz, Tx, Tz
from derive.kinematics.build import build
from derive.mechanism import Mechanism, Task, branch, length, linear, rotary
from tests.native.build import built
from tests.outside import output_of, written

NAMES = ("Arm", "Arm_Lanes", "Batches", "Lanes", "Machine", "Machines", "Math", "Python", "Softkin")


def named(name: str) -> Mechanism:
    """An arm in the plane, and a slide, under this name."""
    first, second, slide = rotary("A1", "arm 1"), rotary("A2", "arm 2"), linear("Z", "slide")
    one, other = (length(name, name, nominal=300.0) for name in ("upper", "lower"))
    return Mechanism(
        name=f"Kin_{name}", family="odd", source="the tests", summary="An arm.", joints=(first, second, slide),
        parameters=(one, other), chain=Rz(first) * Tx(one) * Rz(second) * Tx(other) * Tz(slide),
        task=Task("xyz"), branches=(branch("elbow", sin(second), right=1, left=-1),),
    )  # fmt: skip


def test_files_of_their_own(tmp_path: Path) -> None:
    """No file takes the place of another, and the extension that they make is loaded and knows every machine."""
    found = [build(named(name)) for name in NAMES]
    listed = [index(kin) for kin in found]
    parts = [native.shared(listed, "softkin"), *map(native.sources, found)]
    paths = [path for one in parts for path in one]
    assert len({path.lower() for path in paths}) == len(paths)
    sources = tmp_path / native.FOLDER
    sources.mkdir()
    for one in parts:
        written(one, tmp_path)
    folder = built(tmp_path / "built", ("-O0",), sources)
    code = "from _softkin_native import MACHINES; print(*MACHINES, sep='\\n')"
    assert output_of([sys.executable, "-c", code], cwd=folder).splitlines() == [native.key(kin) for kin in found]
