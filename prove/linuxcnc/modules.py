"""The kinematics modules of the machines, as the compiler writes them."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from prove.linuxcnc.machines import Machine


class NotWritten(Exception):
    """The compiler did not write the modules: what it said."""


@dataclass(frozen=True)
class Module:
    """A kinematics module."""

    file: Path
    """Its source, which halcompile is given."""

    @property
    def name(self) -> str:
        """Its name in the HAL."""
        return self.file.stem

    def pin(self, parameter: str) -> str:
        """The pin of a parameter."""
        return f"softkin.{parameter.replace('_', '-')}"

    def setting(self, machine: Machine) -> list[str]:
        """The lines of HAL that give it the parameters of the machine, and its limits."""
        ends = {
            f"{side}_{axis.lower()}": value
            for axis, limits in machine.limits.items()
            for side, value in zip(("lower", "upper"), limits, strict=True)
        }
        return [f"setp {self.pin(name)} {float(value)!r}" for name, value in {**machine.sizes, **ends}.items()]


def written(machines: Sequence[Machine], folder: Path) -> dict[str, Module]:
    """The modules of these machines, by the names of their mechanisms, in this folder, which is made anew.

    What is derived already is taken. Raises `NotWritten` where the compiler fails.
    """
    shutil.rmtree(folder, ignore_errors=True)
    names = [machine.mechanism for machine in machines]
    command = [sys.executable, "-m", "derive", "generate", "--language", "linuxcnc", "--output", str(folder)]
    command += ["--only", *names]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise NotWritten(done.stderr or done.stdout)
    return {machine.mechanism: written_as(machine, folder) for machine in machines}


def written_as(machine: Machine, folder: Path) -> Module:
    """The one of a machine: its name is that of the mechanism without what is before the first underscore."""
    return Module(folder / "linuxcnc" / f"{machine.mechanism.partition('_')[2].lower()}_kins.c")
