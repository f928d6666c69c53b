"""A generation as `make generate` does it, whose evidence is kept: `python -m tests.generation FOLDER FILE`."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from unittest.mock import patch

from derive import __main__ as command
from derive.description.catalogue import Entry
from derive.kinematics.kinematics import Evidence
from derive.pipeline import Built


def generate(output: str, evidence: str) -> int:
    """Generate into a folder, and write what the witness found, by mechanism, into a file; the status of the command."""
    found: dict[str, Evidence] = {}
    derive_all = command.derive_all

    def witnessed(entries: Sequence[Entry]) -> Iterator[Built]:
        for built in derive_all(entries):
            found[built.kinematics.mechanism.name] = built.evidence
            yield built

    with patch.object(command, "derive_all", witnessed):
        status = command.main(["generate", "--output", output])
    Path(evidence).write_bytes(pickle.dumps(found))
    return status


if __name__ == "__main__":
    sys.exit(generate(*sys.argv[1:]))
