"""`report`: a page for every mechanism of the catalogue, and an index; and the page of a machine of the user's own."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from derive.command.catalogue import chosen
from derive.command.own import package_of, refused
from derive.command.stages import Stages
from derive.description.catalogue import Entry, catalogue
from derive.description.mechanism import Mechanism
from derive.faults import Failure, GenerationError, error, failure
from derive.pipeline import Report, derive_and_measure, workers
from derive.progress import Progress

if TYPE_CHECKING:
    import argparse

    from derive.emit.page.page import Page

OUTPUT = Path("build/report")
_INDEX = "index.html"
_DESKTOPS = ("DISPLAY", "WAYLAND_DISPLAY")


def report(options: argparse.Namespace) -> int:
    """Write the pages and their index; returns 1 where a mechanism could not be derived, 3 for a mistake of the
    compiler.
    """
    from derive.emit.page.page import index_of

    with Stages(sys.stdout):
        entries = chosen(catalogue(options.mechanisms), options.only)
    pages: list[Page] = []
    progress, status = Progress(len(entries), sys.stdout), 0
    for made in _pages(entries, _is_beside_viewer(options.out)):
        if isinstance(made, Failure):
            status = max(status, refused(made.error, options.traceback, status=1))
            continue
        path = _write(options.out, made.file, made.text)
        progress.step(f"{path}  {path.stat().st_size // 1000} kB", took_time=True)
        pages.append(made)
    progress.end()
    if pages:
        index = _write(options.out, _INDEX, index_of(pages))
        print(f"{len(pages)} page{'' if len(pages) == 1 else 's'}, listed in {index}")
    return status


def written(path: Path, mechanism: Mechanism, folder: Path, stages: Stages) -> Path:
    """Write the page of a machine, and name its file. Raises `GenerationError` with file, line and remedy."""
    try:
        page = _page(mechanism, stages.report, _viewer(path) if _is_beside_viewer(folder) else "")
    except Exception as problem:
        raise error(path, problem) from None
    target = _write(folder, page.file, page.text)
    stages.line(f"  {target}  {target.stat().st_size // 1000} kB")
    return target


def opened(target: Path) -> None:
    """Show a page in the browser, if a user sits at this terminal; do nothing in a script, or without a desktop."""
    has_desktop = sys.platform in ("darwin", "win32") or any(os.environ.get(name) for name in _DESKTOPS)
    if sys.stdout.isatty() and has_desktop:
        webbrowser.open(target.resolve().as_uri())


def _is_beside_viewer(folder: Path) -> bool:
    """Whether the folder of pages is one to which the viewer above it links."""
    return folder.name == OUTPUT.name


def _viewer(path: Path) -> str:
    """The page that `view` writes of a machine; empty if its file has a name that no package can have."""
    try:
        return f"../{package_of(path, None)}.html"
    except GenerationError:
        return ""


def _page(mechanism: Mechanism, stage: Report, viewer: str) -> Page:
    from derive.emit.page.page import page_of

    kinematics = derive_and_measure(mechanism, stage)
    stage("page", "")
    page = page_of(mechanism, kinematics, viewer=viewer)
    ElementTree.fromstring(page.text)  # some readers show a page that is not well-formed only in part
    stage("page", f"{len(page.text.encode()) // 1000} kB")
    return page


def _pages(entries: tuple[Entry, ...], has_viewer: bool) -> Iterator[Page | Failure]:
    """The pages in the order of the catalogue."""
    with workers(len(entries)) as pool:
        yield from pool.map(partial(_attempt, has_viewer), entries)


def _attempt(has_viewer: bool, entry: Entry) -> Page | Failure:
    """A page made in a worker process: a problem comes back as text, because not every exception can travel."""
    path, mechanism = entry
    try:
        viewer = f"../viewer.html#machine={mechanism.name}" if has_viewer else ""
        return _page(mechanism, lambda stage, found: None, viewer)
    except Exception as problem:
        return failure(path, problem)


def _write(folder: Path, name: str, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / name
    target.write_text(text, encoding="utf-8")
    return target
