"""One fresh generation for all tests of a process, whose evidence is kept: `python -m tests.generation FOLDER FILE`."""

import os
import pickle
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

from derive.command import catalogue as command
from derive.command.catalogue import OUTPUT
from derive.command.line import main
from derive.emit.javascript import package as javascript
from derive.emit.language import Part
from derive.faults import Failure
from derive.kinematics.kinematics import Evidence
from derive.pipeline import Built, Work
from tests.outside import output_of


@dataclass(frozen=True)
class Generation:
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
    output_of(command, cwd=OUTPUT.parent, env=environment)
    files = {str(p.relative_to(output)): p.read_bytes() for p in output.rglob("*") if p.is_file()}
    found, modules = pickle.loads(evidence.read_bytes())
    return Generation(files, found, {name: text.encode() for name, text in modules.items()})


def generate(output: str, evidence: str) -> int:
    """Generate into a folder, and write what the witness found, by mechanism, and the modules in
    JavaScript into a file; the status of the command.
    """
    found: dict[str, Evidence] = {}
    parts: list[Part] = []
    attempts = command.attempts

    def witnessed(work: Work, profile: str | None, wanted: Sequence[str]) -> Iterator[Built | Failure]:
        every = [*wanted, javascript.name]
        for (_, mechanism), built in zip(work.entries, attempts(work, profile, every), strict=True):
            assert isinstance(built, Built) and built.evidence is not None, "the cache was read"
            found[mechanism.name] = built.evidence
            parts.append(built.parts[javascript.name])
            yield built

    with patch.object(command, "attempts", witnessed):
        status = main(["generate", "--fresh", "--output", output])
    Path(evidence).write_bytes(pickle.dumps((found, javascript.files(parts))))
    return status


if __name__ == "__main__":
    sys.exit(generate(*sys.argv[1:]))
