"""A private view of this computer, in which /usr and /etc have LinuxCNC as well."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

from prove.linuxcnc.packages import LinuxCNC

WORK = Path("/mnt/work")
"""Where the folder that a command works in is seen inside."""
_SCRIPT = Path(__file__).with_name("room.sh")
_NAMESPACES = ("--mount", "--ipc", "--pid", "--net", "--fork", "--kill-child", "--mount-proc", "--propagation=private")


def run_inside(linuxcnc: LinuxCNC, work: Path, command: Sequence[str], log: Path, seconds: float) -> int:
    """Run a command with LinuxCNC around it, in `work`, and write all that it says into `log`.

    The exit code of the command, or -1 where it took longer than `seconds`: then all that it started is ended.
    """
    inside = ["unshare", *_NAMESPACES, "bash", str(_SCRIPT), str(linuxcnc.root), str(work), *command]
    with log.open("wb") as said:
        try:
            return subprocess.run(inside, stdin=subprocess.DEVNULL, stdout=said, stderr=said, check=False,
                                  timeout=seconds).returncode  # fmt: skip
        except subprocess.TimeoutExpired:
            return -1
