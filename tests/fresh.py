"""One fresh generation for all tests of a process."""

import os
import pickle
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from derive.command.catalogue import OUTPUT
from derive.kinematics.kinematics import Evidence


@dataclass(frozen=True)
class Generation:
    """What a fresh generation gives."""

    files: Mapping[str, bytes]
    evidence: Mapping[str, Evidence]
    """By mechanism."""
    modules: Mapping[str, bytes]
    """The same machines in JavaScript."""


def generated(folder: Path) -> Generation:
    """In the order of hashing of one seed; `make generate` and `make check` each have one that nobody chose."""
    output, evidence = folder / "generated", folder / "evidence"
    command = [sys.executable, "-m", "tests.generation", str(output), str(evidence)]
    environment = {**os.environ, "PYTHONHASHSEED": "1"}
    done = subprocess.run(command, cwd=OUTPUT.parent, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    files = {str(p.relative_to(output)): p.read_bytes() for p in output.rglob("*") if p.is_file()}
    found, modules = pickle.loads(evidence.read_bytes())
    return Generation(files, found, {name: text.encode() for name, text in modules.items()})
