"""From mechanisms to files: derive, ask the witness, render. Two processes share the mechanisms, then the languages."""

from __future__ import annotations

import time
import traceback
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path

from derive.description.catalogue import Entry
from derive.description.mechanism import DescriptionError, Mechanism
from derive.emit.language import Language
from derive.emit.python import package as python
from derive.emit.softmotion.library import StructuredTextFiles
from derive.emit.softmotion.pictures import pictures_of
from derive.ir.verify import BrokenProgram
from derive.kinematics.build import build
from derive.kinematics.kinematics import Evidence, Kinematics
from derive.report.self_test import self_test
from derive.solver.solve import Unsolved
from derive.witness import Disagreement, witness

PROCESSES = 2
_EXPECTED = (DescriptionError, Unsolved, BrokenProgram, Disagreement)
"""What a wrong description leads to: the message says enough."""


class GenerationError(Exception):
    """Nothing can be generated; the message names the file and the thing."""


@dataclass(frozen=True)
class Built:
    """One derived mechanism, witnessed, and what it took."""

    kinematics: Kinematics
    evidence: Evidence
    seconds: float
    pictures: Mapping[str, bytes] = field(default_factory=dict)
    """Path below the output folder → bytes. They are made where the mechanism is derived: drawing takes as long."""

    @property
    def statements(self) -> int:
        """The statements of all programs."""
        kinematics = self.kinematics
        return sum(len(p.body) for p in (kinematics.setup, *kinematics.shared, *kinematics.programs))


def derive_all(entries: Sequence[Entry]) -> Iterator[Built]:
    """Derive every mechanism, in the order of the catalogue; raises `GenerationError` at the first that cannot be."""
    with ProcessPoolExecutor(max_workers=min(PROCESSES, len(entries))) as pool:
        for (path, _), result in zip(entries, pool.map(_attempt, entries), strict=True):
            if isinstance(result, str):
                pool.shutdown(cancel_futures=True)
                raise GenerationError(f"{path}: {result}")
            yield result


def derive_one(mechanism: Mechanism) -> Built:
    """Derive one mechanism, measure it and draw it."""
    start = time.perf_counter()
    kinematics = build(mechanism)
    evidence = witness(kinematics)
    whole = replace(kinematics, evidence=evidence, self_test=self_test(kinematics))
    pictures = {str(Path(StructuredTextFiles.name) / name): data for name, data in pictures_of(kinematics).items()}
    return Built(whole, evidence, time.perf_counter() - start, pictures)


def languages(profile: str | None = None) -> tuple[Language, ...]:
    """All output languages, for a profile of the SoftMotion contract (its own if `None`).

    Raises `GenerationError` for a profile that the contract has not.
    """
    try:
        return python, StructuredTextFiles(profile)
    except ValueError as problem:
        raise GenerationError(str(problem)) from None


def render_all(built: Sequence[Built], outputs: Sequence[Language]) -> dict[str, bytes]:
    """All generated files: path below the output folder → bytes. Every language is rendered in a process of its own."""
    kinematics = tuple(b.kinematics for b in built)
    with ProcessPoolExecutor(max_workers=min(PROCESSES, len(outputs))) as pool:
        rendered = [pool.submit(language.render, kinematics) for language in outputs]
        texts = {
            str(Path(language.name) / name): text.encode()
            for language, files in zip(outputs, rendered, strict=True)
            for name, text in sorted(files.result().items())
        }
    return texts | {name: data for one in built for name, data in one.pictures.items()}


def _attempt(entry: Entry) -> Built | str:
    """Derive in a worker process: a problem comes back as text, because not every exception can travel."""
    try:
        return derive_one(entry[1])
    except _EXPECTED as problem:
        return _one_line(problem)
    except Exception as problem:
        place = traceback.extract_tb(problem.__traceback__)[-1]
        return f"{type(problem).__name__}: {_one_line(problem)} ({Path(place.filename).name}:{place.lineno})"


def _one_line(problem: Exception) -> str:
    return " ".join(str(problem).split())
