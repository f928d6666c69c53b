"""The whole catalogue as `make generate` kept it; what changed since is derived anew."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from derive.cache import Cache, foundation
from derive.command.catalogue import OUTPUT
from derive.emit.javascript import package as javascript
from derive.kinematics.kinematics import Evidence
from derive.pipeline import Built, attempts, files_of, languages, work_of
from tests.mechanisms import catalogue


@dataclass(frozen=True)
class Generation:
    files: Mapping[str, bytes]
    evidence: Mapping[str, Evidence]
    """By mechanism."""
    modules: Mapping[str, bytes]
    """The same machines in JavaScript."""


def generated() -> Generation:
    """What the descriptions give, in memory."""
    work = work_of(catalogue(), Cache(Path(f"{OUTPUT}.cache")), foundation(None))
    built, evidence = [], {}
    for (_, mechanism), one in zip(work.entries, attempts(work, None), strict=True):
        assert isinstance(one, Built) and one.evidence is not None, one
        built.append(one)
        evidence[mechanism.name] = one.evidence
    modules = javascript.files([one.parts[javascript.name] for one in built])
    return Generation(files_of(built, languages()), evidence, {name: text.encode() for name, text in modules.items()})
