"""A private view of this computer, in which /usr and /etc have LinuxCNC as well."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

from prove.linuxcnc.packages import CannotRun, LinuxCNC

_SCRIPT = Path(__file__).with_name("room.sh")
_CHECK = """
for program in linuxcnc halcompile linuxcncsvr milltask io rtapi_app halcmd inivar tclsh8.6 ps fuser gcc make; do
  path=$(command -v $program) || { echo "there is no $program"; exit 1; }
  ! ldd "$path" 2>&1 | grep 'not found' || exit 1
done
python3 -c 'import hal, linuxcnc'
"""
"""Whether all that is used is there, with the libraries that it needs."""
_NAMESPACES = ("--mount", "--ipc", "--pid", "--net", "--fork", "--kill-child", "--mount-proc", "--propagation=private")


_PATIENCE = 30.0
"""Seconds."""


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


def require_room(linuxcnc: LinuxCNC, work: Path) -> None:
    """Raise `CannotRun` where LinuxCNC finds in its room not all that it needs, or gets no room."""
    work.mkdir(parents=True, exist_ok=True)
    log = work / "room.txt"
    if run_inside(linuxcnc, work, ["bash", "-c", _CHECK], log, _PATIENCE) != 0:
        words = log.read_text(encoding="utf-8", errors="replace").split("\n")
        raise CannotRun(f"LinuxCNC is not complete in its room: {[*filter(None, words), 'no reason given'][0].strip()}")
