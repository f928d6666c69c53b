"""From mechanisms to files: derive, ask the witness, write. Two processes share the mechanisms that are not kept."""

from __future__ import annotations

import gc
import time
from base64 import b64decode, b64encode
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from functools import partial
from multiprocessing import get_all_start_methods, get_context
from pathlib import Path
from typing import Any

from derive.cache import Cache, entry_key, key_of
from derive.description.catalogue import Entry
from derive.description.mechanism import DescriptionError, Mechanism
from derive.description.remedies import with_remedy
from derive.emit.around_c.package import br, klipper
from derive.emit.c import package as c
from derive.emit.fmu import package as fmu
from derive.emit.javascript import package as javascript
from derive.emit.language import Language, Part
from derive.emit.linuxcnc import package as linuxcnc
from derive.emit.python import package as python
from derive.emit.python.package import NamedPackage
from derive.emit.softmotion.library import StructuredTextFiles, most_axes
from derive.faults import Failure, GenerationError, failure, one_line
from derive.kinematics.kinematics import Evidence, Kinematics, evidence_of
from derive.work import STEPS, TooMuchWork, at_most

_PROCESSES = 2
_ROOMS = ("emit.picture.page", "emit.softmotion.pictures", "kinematics.build", "report.self_test", "witness")
_LOADED = [__name__, *(f"derive.{room}" for room in _ROOMS)]
"""The modules that deriving needs, which the processes have before they begin."""
WRITTEN = (python.name, StructuredTextFiles.name)
"""The languages that are written unless others are asked for."""
_OTHERS: tuple[Language, ...] = (javascript, c, linuxcnc, fmu, klipper, br)
LANGUAGES = (*WRITTEN, *(language.name for language in _OTHERS))
_TITLES = {python.name: python.title, StructuredTextFiles.name: StructuredTextFiles.title} | {
    language.name: language.title for language in _OTHERS
}
_MOST_STEPS = 10_000_000
"""The work of the measurement of one machine, of all its stages (`derive.work`): some forty seconds."""
Report = Callable[[str, str], None]
"""A listener for stages: it gets the name of a stage, and its result, which is empty when the stage begins."""


@dataclass(frozen=True)
class Built:
    """What came of one mechanism, as plain data."""

    derived: str
    """What was derived, for the line that says so."""
    measured: str
    """What the witness measured, for the same line."""
    seconds: float | None
    """How long it took; None if it was kept from an earlier run."""
    parts: Mapping[str, Part]
    """What every language writes of it, by the name of the language."""
    pictures: Mapping[str, bytes]
    """Path below the output folder → bytes. They are made where the mechanism is derived: drawing takes as long."""
    evidence: Evidence | None = None
    """What the witness found."""
    undrawn: str = ""
    """Why there is no picture: a drawing is no part of the proof, and a machine without one is whole."""

    def notes(self, wanted: Sequence[str] = ()) -> tuple[str, ...]:
        """What the languages that are written say about names that they could not take from the description.

        wanted: their names; without one, those that are always written.
        """
        parts = ((name, part) for name, part in self.parts.items() if name in (wanted or WRITTEN))
        return tuple(f"{_TITLES[name]}: {n}" for name, part in parts for n in part["notes"])

    def as_plain(self) -> dict[str, Any]:
        """What JSON can hold."""
        pictures = {name: b64encode(data).decode() for name, data in self.pictures.items()}
        return {
            "derived": self.derived,
            "measured": self.measured,
            "parts": dict(self.parts),
            "pictures": pictures,
            "undrawn": self.undrawn,
            "evidence": self.evidence and asdict(self.evidence),
        }


def from_plain(data: Mapping[str, Any]) -> Built:
    """What `as_plain` gave."""
    pictures = {name: b64decode(text) for name, text in data["pictures"].items()}
    evidence = data["evidence"] and evidence_of(data["evidence"])
    return Built(data["derived"], data["measured"], None, data["parts"], pictures, evidence, data["undrawn"])


def _nobody(stage: str, found: str) -> None:
    """Tell nobody."""


@dataclass(frozen=True)
class Work:
    """What has to be derived, and what is kept from earlier runs; all in the order of the catalogue."""

    entries: tuple[Entry, ...]
    keys: tuple[str | None, ...]
    kept: tuple[Built | None, ...]

    @property
    def missing(self) -> tuple[Entry, ...]:
        """The mechanisms that have to be derived."""
        return tuple(entry for entry, kept in zip(self.entries, self.kept, strict=True) if kept is None)


def work_of(entries: Sequence[Entry], cache: Cache, foundation: str) -> Work:
    """The mechanisms of a run, with what a cache has of them."""
    keys = tuple(entry_key(foundation, entry) for entry in entries)
    found = [cache.read(key) if key else None for key in keys]
    return Work(tuple(entries), keys, tuple(None if data is None else from_plain(data) for data in found))


def attempts(work: Work, profile: str | None) -> Iterator[Built | Failure]:
    """What came of every mechanism, in all languages, in the order of the catalogue."""
    attempt = partial(_attempt, profile)
    if len(work.missing) < 2:  # here: no process has to be started
        alone = map(attempt, work.missing)
        yield from (next(alone) if kept is None else kept for kept in work.kept)
        return
    with workers(len(work.missing)) as pool:
        derived = pool.map(attempt, work.missing)
        try:
            for kept in work.kept:
                yield next(derived) if kept is None else kept
        finally:
            pool.shutdown(cancel_futures=True)


def workers(tasks: int) -> ProcessPoolExecutor:
    """The processes for so many tasks. They are no copies of this one: a copy waits for ever for a lock that another
    thread holds at that moment.

    What is derived lives as long as its process: looking for garbage among it finds nothing, and takes a tenth of the
    time.
    """
    context = get_context("forkserver" if "forkserver" in get_all_start_methods() else "spawn")
    context.set_forkserver_preload(_LOADED)
    return ProcessPoolExecutor(min(_PROCESSES, tasks), mp_context=context, initializer=gc.disable)


def derive_one(
    mechanism: Mechanism, profile: str | None = None, report: Report = _nobody, wanted: Sequence[str] = LANGUAGES
) -> Built:
    """Derive one mechanism, measure it, draw it, and write it in the languages that are wanted.

    report: called at the begin of each of these stages with its name and "", at its end with its name and the result.
    """
    # Not loaded where nothing is derived: CasADi and matplotlib take longer to start than the rest of such a run.
    start = time.perf_counter()
    whole = derive_and_measure(mechanism, report)
    outputs = languages(profile, wanted=wanted)
    drawn: Mapping[str, bytes] = {}
    if StructuredTextFiles.name in wanted:  # the pictures stand beside the blocks
        report("draw", "")
        if len(mechanism.joints) <= most_axes(profile):
            drawn, undrawn = _pictures(whole)
            whole = replace(whole, undrawn=undrawn, has_choices=len(drawn) > 2)
        report("draw", whole.undrawn or ", ".join(drawn) or "nothing: it has no block")
    found = ((language.name, language.part(whole)) for language in outputs)
    parts = {name: part for name, part in found if part is not None}
    pictures = {str(Path(StructuredTextFiles.name) / name): data for name, data in drawn.items()}
    measured, seconds = _measured(whole), time.perf_counter() - start
    return Built(_derived(whole), measured, seconds, parts, pictures, whole.evidence, whole.undrawn)


def derive_and_measure(mechanism: Mechanism, report: Report = _nobody) -> Kinematics:
    """Derive one mechanism and measure it. Raises what `faults.UNFIT` lists, where one of them fails."""
    from derive.kinematics.build import build
    from derive.kinematics.refusals.no_pose import why_no_pose
    from derive.report.branch_meanings import with_meanings
    from derive.report.self_test import self_test
    from derive.solver.unsolved import Exhausted
    from derive.witness import Disagreement, NoPose, witness

    report("derive", "")
    derived = build(mechanism)
    try:
        with at_most(_MOST_STEPS, unit=STEPS):
            derived = with_meanings(derived)
            report("derive", _derived(derived).removeprefix(mechanism.name).strip())
            report("measure", "")
            whole = replace(derived, evidence=witness(derived, mechanism))
            report("measure", _measured(whole))
            return replace(whole, self_test=self_test(derived))
    except NoPose:
        raise Disagreement(f"{mechanism.name}: {why_no_pose(derived.mechanism)}") from None
    except TooMuchWork as problem:
        raise Exhausted(f"{mechanism.name}: {problem}") from None


def _pictures(kinematics: Kinematics) -> tuple[Mapping[str, bytes], str]:
    """The pictures by their paths, or the reason why there are none."""
    from derive.emit.softmotion.pictures import pictures_of

    try:
        return pictures_of(kinematics), ""
    except DescriptionError as problem:
        return {}, with_remedy(one_line(problem))
    except Exception as problem:  # whatever a drawing meets, the formulas are proven without it
        return {}, f"{type(problem).__name__}: {one_line(problem)}"


def languages(
    profile: str | None = None, package: str = python.PACKAGE, wanted: Sequence[str] = WRITTEN
) -> tuple[Language, ...]:
    """Output languages by their names, for a profile of the SoftMotion contract (its own if `None`), and a name of the
    package.

    Raises `GenerationError` for a profile that the contract has not.
    """
    try:
        every: tuple[Language, ...] = (
            python if package == python.PACKAGE else NamedPackage(package),
            StructuredTextFiles(profile),
            *_OTHERS,
        )
    except ValueError as problem:
        raise GenerationError(str(problem)) from None
    return tuple(language for language in every if language.name in wanted)


def unwritten(built: Built, outputs: Sequence[Language], mechanism: Mechanism) -> Iterator[str]:
    """Why a language that is asked for does not have this machine, a sentence each."""
    for language in outputs:
        if language.name not in built.parts:
            yield language.bound.format(axes=len(mechanism.joints))


def files_of(
    built: Sequence[Built], outputs: Sequence[Language], cache: Cache | None = None, keys: Sequence[str | None] = ()
) -> dict[str, bytes]:
    """All generated files: path below the output folder → bytes. The texts of a run with the same keys are kept as a
    whole.
    """
    known = [key for key in keys if key]
    names = [language.name for language in outputs]
    whole = key_of("texts", *names, *known) if cache and len(known) == len(built) else None
    texts: dict[str, str] | None = cache.read(whole) if cache and whole else None
    if texts is None:
        texts = _texts(built, outputs)
        if cache and whole:
            cache.write(whole, texts)
    found = {n: data for one in built for n, data in one.pictures.items() if Path(n).parts[0] in names}
    found |= {path: text.encode() for path, text in texts.items() if Path(path).parts[0] != fmu.name}
    archived = {str(Path(path).relative_to(fmu.name)): text for path, text in texts.items() if path not in found}
    found |= {str(Path(fmu.name) / path): data for path, data in fmu.finished(archived).items()}
    return found | dict(_drawings(built, outputs))


def _drawings(built: Sequence[Built], outputs: Sequence[Language]) -> Iterator[tuple[str, bytes]]:
    """The drawings beside the classes of the Python package, with their paths, if blocks are drawn, too."""
    for language in (one for one in outputs if isinstance(one, NamedPackage) or one is python):
        for one in built:
            for data in [data for n, data in one.pictures.items() if n.endswith(".svg")][:1]:  # that of the machine
                yield f"{language.name}/{language.drawing(one.parts[language.name])}", data


def _texts(built: Sequence[Built], outputs: Sequence[Language]) -> dict[str, str]:
    return {
        str(Path(language.name) / name): text
        for language in outputs
        for name, text in sorted(language.files(_parts(built, language)).items())
    }


def _parts(built: Sequence[Built], language: Language) -> list[Part]:
    return [one.parts[language.name] for one in built if language.name in one.parts]


def _derived(kinematics: Kinematics) -> str:
    statements = sum(len(p.body) for p in (kinematics.setup, *kinematics.shared, *kinematics.programs))
    return f"{kinematics.mechanism.name:28}{statements:5} statements"


def _measured(kinematics: Kinematics) -> str:
    seen = kinematics.evidence
    assert seen is not None
    poses = f"{seen.poses} poses  closure {seen.closure_residual:.0e}"
    if seen.inverted is None:
        return poses
    found = seen.inverted
    solutions = f"{found.solutions} solution{'' if found.solutions == 1 else 's'}"
    branches = 2 ** len(kinematics.branches)
    if found.solutions < branches:  # as where some are in the other assembly mode, or out of reach
        solutions = f"up to {solutions} seen, of {branches} branches"
    exact = "  exact" if seen.exact.trials else ""
    return f"{poses}  round trip {found.round_trip:.0e}  Jacobian {found.jacobian:.0e}  {solutions}{exact}"


def _attempt(profile: str | None, entry: Entry) -> Built | Failure:
    """Derive in a worker process: a problem comes back as text, because not every exception can travel."""
    path, mechanism = entry
    try:
        return derive_one(mechanism, profile)
    except Exception as problem:
        return failure(path, problem)
