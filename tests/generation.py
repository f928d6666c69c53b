"""A generation as `make generate` does it, whose evidence is kept: `python -m tests.generation FOLDER FILE`.

The JavaScript of the same machines is kept, too: it was written with them, and `generated/` does not hold it.
"""

import pickle
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from unittest.mock import patch

from derive.command import catalogue as command
from derive.command.line import main
from derive.emit.javascript import package as javascript
from derive.emit.language import Part
from derive.faults import Failure
from derive.kinematics.kinematics import Evidence
from derive.pipeline import Built, Work


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
