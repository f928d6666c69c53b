"""The object of Python under the sanitizers of the compiler: garbage in every place, and batches of any form."""

import os
import re
import subprocess
import sys
from pathlib import Path

from tests.native.build import EXTENSION, ROOT, SANITIZED, SHARED, SOURCES, built, compiler
from tests.outside import output_of

FEW = ("ac6_txtytzryrxrz", "crane", "wrist2", "scara4_zccoupled_type1", "pos_rrr")
"""The machines of the extension that is built for this: their formulas are tested elsewhere, in all machines."""
CODE = """
import warnings
warnings.simplefilter("ignore")
import numpy as np
import softkin
from tests.native import machines
from tests.native.garbage import frames, rows
from tests.native.machines import native, outcome
for name in ("Kin_Ac6_TXTYTZRYRXRZ", "Kin_Crane", "Kin_Wrist2", "Kin_Scara4_ZCcoupled_Type1", "Kin_Pos_RRR"):
    robot, width = native(name), len(softkin.catalogue()[name].AXES)
    machine, good = robot._machine, machines.poses(name, 2)
    for axes in rows(width):
        for call in (machine.forward, machine.pose, machine.jacobian, machine.margins):
            call(axes)
        machine.branches(good[0][1], axes), machine.inverse_all(good[0][1], axes)
        machine.inverse(good[0][1], None, axes)
    for frame in frames():
        machine.inverse(frame, None, good[0][0]), machine.inverse_all(frame, good[0][0])
        machine.branches(frame, good[0][0]), machine.branch(frame, (1,) * robot.BRANCHES, good[0][0])
    for bytes_ in rows(len(robot.CONFIGURATION)) + rows(robot.BRANCHES):
        machine.inverse(good[0][1], bytes_, good[0][0]), machine.branch(good[0][1], bytes_, good[0][0])
    for count in (0, 1, 5):
        axes = np.array([good[0][0]] * count).reshape(count, width)
        found = robot.forward_batch(axes)
        robot.inverse_batch(*found[:3], axes), robot.inverse_all_batch(*found[:2], axes), robot.jacobian_batch(axes)
        strided = np.zeros((2 * count + 1, 3, 3, 2))[1::2, ..., 1][:count]
        outcome(robot.inverse_batch, found[0], strided, None, axes)
print("nothing found")
"""


def test_nothing_is_found(tmp_path: Path) -> None:
    """No access beyond an array, no use of what is released, no undefined arithmetic."""
    sources = tmp_path / "sources"
    sources.mkdir()
    own = (f"{machine}{end}" for machine in FEW for end in (".c", ".h", "-lanes.c"))
    for name in (*SHARED, *(name for name in own if (SOURCES / name).is_file())):
        (sources / name).write_text((SOURCES / name).read_text())
    table = (sources / "machines.c").read_text()
    table = re.sub(r'#include "(\w+)\.h"\n', lambda m: m[0] if m[1] in (*FEW, "machines") else "", table)
    table = re.sub(r'    \{"(\w+) .*?\}\},\n', lambda m: m[0] if m[1] in FEW else "", table, flags=re.DOTALL)
    (sources / "machines.c").write_text(table)
    header = (sources / "machines.h").read_text()
    (sources / "machines.h").write_text(re.sub(r"SOFTKIN_MACHINES \d+", f"SOFTKIN_MACHINES {len(FEW)}", header))
    folder = built(tmp_path / "built", SANITIZED, sources)
    assert (folder / f"{EXTENSION}.abi3.so").is_file()
    library = output_of([*compiler(), "-print-file-name=libasan.so"])
    done = subprocess.run(
        [sys.executable, "-c", CODE],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        env={
            **os.environ,
            "LD_PRELOAD": library.strip(),
            "PYTHONMALLOC": "malloc",
            "SOFTKIN_CORE": "native",
            "SOFTKIN_THREADS": "2",
            "ASAN_OPTIONS": "detect_leaks=0",
            "PYTHONPATH": os.pathsep.join(map(str, (folder, ROOT / "generated/python", ROOT))),
        },
    )
    assert done.stdout.strip() == "nothing found", done.stderr[-3000:]
