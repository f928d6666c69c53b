"""`generate` and `check` without a file: the catalogue as a whole, and its output folder.

`generate` keeps its results in a cache beside the output folder, and derives a mechanism again only where something
changed on which it depends; `--fresh` and `check` derive everything, and keep it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from derive.cache import Cache, foundation
from derive.command.own import complain, refused
from derive.command.stages import Stages
from derive.description.catalogue import MECHANISMS, Entry, catalogue, catalogue_and_faults
from derive.faults import Failure, GenerationError
from derive.output import differences, replace_folder, replace_parts
from derive.pipeline import WRITTEN, Built, Work, attempts, files_of, languages, work_of
from derive.progress import Progress

_ROOT = MECHANISMS.parents[1]
OUTPUT = _ROOT / "generated" if (_ROOT / "pyproject.toml").is_file() else Path("generated")


def generate(options: argparse.Namespace) -> int:
    """Write the output folder; returns 1 where a mechanism could not be derived, 3 for a mistake of the compiler."""
    if options.output == OUTPUT and (options.only or options.language):
        what = "--only" if options.only else "--language"
        raise GenerationError(f"{what} needs --output: the output folder of the project holds every mechanism")
    with Stages(sys.stdout):
        entries, unread = catalogue_and_faults(options.mechanisms)
    for fault in unread:
        complain(fault)
    if unread and not (options.keep_going and entries):
        return 1
    files, underived = _files(options, entries)
    statuses = [refused(fault.error, options.traceback, status=1) for fault in underived]
    if underived and not (options.keep_going and files):
        return max(statuses)
    if options.language:
        replace_parts(options.output, files)
    elif any(differences(options.output, files)):
        replace_folder(options.output, files)
    only = next(iter(files)) if len(files) == 1 else None
    print(f"{len(files)} files in {options.output}" if only is None else f"written: {options.output / only}")
    return max([*statuses, 1 if unread else 0])


def compare(options: argparse.Namespace) -> int:
    """Compare the output folder; raises `GenerationError` where it differs from a fresh generation."""
    files = machine_files(options)
    found = list(differences(options.output, files))
    if found:
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        raise GenerationError(f"{found[0]}{more}: run `make generate`")
    print(f"{options.output} is up to date")
    return 0


def machine_files(options: argparse.Namespace) -> dict[str, bytes]:
    """The files of all mechanisms in the languages that are asked for. Raises `GenerationError` at the first fault."""
    with Stages(sys.stdout):
        entries = catalogue(options.mechanisms)
    files, faults = _files(options, entries)
    if faults:
        raise faults[0].error
    return files


def _files(options: argparse.Namespace, entries: tuple[Entry, ...]) -> tuple[dict[str, bytes], list[Failure]]:
    """All files of a run, from the cache where it has them, and the mechanisms that could not be derived."""
    outputs = languages(options.profile, wanted=options.language or WRITTEN)
    cache = Cache(Path(f"{OUTPUT if options.language else options.output}.cache"), fresh=options.fresh)
    before = foundation(options.profile)
    work = work_of(chosen(entries, options.only), cache, before)
    built, keys, faults = _derived(work, options.profile, cache, before)
    is_unchanged = foundation(options.profile) == before
    files = files_of(built, outputs, cache, keys if is_unchanged else ()) if built else {}
    cache.tidy()
    for path in cache.damaged:
        print(f"note: {path} is damaged, and was not used", file=sys.stderr)
    return files, faults


def _derived(
    work: Work, profile: str | None, cache: Cache, before: str
) -> tuple[list[Built], list[str | None], list[Failure]]:
    """The results with their keys, and the failures; new results are put in the cache."""
    built: list[Built] = []
    keys: list[str | None] = []
    faults: list[Failure] = []
    progress = Progress(len(work.missing), sys.stdout)
    for key, one in zip(work.keys, attempts(work, profile), strict=True):
        if isinstance(one, Failure):
            faults.append(one)
            continue
        progress.step(_line(one), one.seconds is not None)
        if key and one.seconds is not None and foundation(profile) == before:
            cache.write(key, one.as_plain())
        built.append(one)
        keys.append(key)
    progress.end()
    return built, keys, faults


def _line(one: Built) -> str:
    time = "kept" if one.seconds is None else f"{one.seconds:.2f} s"
    warning = f"\n    warning: not drawn: {one.undrawn}" if one.undrawn else ""
    notes = "".join(f"\n    note: {note}" for note in one.notes())
    return f"{one.derived} {time:>8}   {one.measured}{warning}{notes}"


def chosen(entries: tuple[Entry, ...], names: Sequence[str]) -> tuple[Entry, ...]:
    """The mechanisms of these names, or all. Raises `GenerationError` for a name that none has."""
    known = [mechanism.name for _, mechanism in entries]
    for name in names:
        if name not in known:
            raise GenerationError(f"no mechanism is called {name!r}; there are {', '.join(known)}")
    return tuple(e for e in entries if not names or e[1].name in names)
