"""`view`: machines in one page for the browser, the whole catalogue or those of a user."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from derive.command import own
from derive.command.catalogue import machine_files
from derive.command.report import OUTPUT as REPORTS
from derive.command.stages import Stages
from derive.description.catalogue import MECHANISMS, Entry, catalogue, load
from derive.description.mechanism import DescriptionError, Mechanism
from derive.emit.python.entries import class_name
from derive.faults import GenerationError
from derive.form.deviations import with_deviations
from derive.output import write_file
from derive.pipeline import Built, derive_one, files_of, languages
from derive.view.node import MissingTool, node
from derive.view.page import BrokenPage, Content, Model, page

_LANGUAGE = "javascript"
_FIRST = "Kin_ArticulatedRobot_6DOF"
"""The machine of a catalogue that has it which most readers know: its page opens with it."""
_ROOT = MECHANISMS.parents[1]
PACKAGES = _ROOT / ".view" if (_ROOT / "pyproject.toml").is_file() else Path.home() / ".cache" / "softkin" / "view"
"""The folder into which npm installs the packages of the page, once."""


def view(options: argparse.Namespace) -> int:
    """Write a page for the whole catalogue, or one for each given machine; returns 2 where one cannot be made."""
    if not options.files:
        if options.model:
            raise GenerationError("--model names a body of one machine: give its file")
        modules = _modules(machine_files(options))
        _write(options.out / "viewer.html", content_of(catalogue(options.mechanisms), modules))
        return 0
    _node()  # before anything is derived
    files_given = own.described(options.files)
    if options.model and len(files_given) > 1:
        raise GenerationError("--model names a body of one machine: view one file at a time")
    models = tuple(map(_model, options.model))
    return own.each(
        files_given,
        lambda path, stages: _own(path, stages, options, models),
        keep_going=True,
        with_trace=options.traceback,
    )


def content_of(entries: Sequence[Entry], modules: Mapping[str, bytes]) -> Content:
    """The content of the page of a catalogue."""
    classes = {mechanism.name: _class(mechanism) for _, mechanism in entries}
    reports = {mechanism.name: _report(mechanism) for _, mechanism in entries}
    families = {mechanism.name: mechanism.family for _, mechanism in entries}
    first = _FIRST if _FIRST in classes else ""
    return Content("Softkin", modules, "softkin", classes, families, first, reports=reports)


def _own(path: Path, stages: Stages, options: argparse.Namespace, models: tuple[Model, ...]) -> None:
    """The page of one machine of a user."""
    mechanism = with_deviations(load(path)) if options.calibrated else load(path)
    beside = path.with_suffix(".glb")
    if beside.is_file():
        stages.line(f"  with the meshes of {beside}")
        models = (Model("", _binary_gltf(beside)), *models)
    package = own.package_of(path, None)
    built = derive_one(mechanism, None, stages.report, [_LANGUAGE, "python"])
    files = files_of([built], languages(None, package, [_LANGUAGE]))
    content = Content(
        f"{mechanism.name}: Softkin",
        _modules(files),
        package,
        classes={mechanism.name: _class(mechanism)},
        keywords={mechanism.name: _keywords(built)},
        reports={mechanism.name: _report(mechanism)},
        models=models,
    )
    _write(options.out / f"{package}.html", content, stages.line)


def _node() -> None:
    try:
        node()
    except MissingTool as problem:
        raise GenerationError(str(problem)) from None


def _write(path: Path, content: Content, say: Callable[[str], None] = print) -> None:
    try:
        text = page(content, PACKAGES)
    except (MissingTool, BrokenPage) as problem:
        raise GenerationError(str(problem)) from None
    write_file(path, text.encode())
    say(f"{path}: {len(text.encode()) / 1e6:.2f} MB, opens in a browser")


def _keywords(built: Built) -> dict[str, str]:
    """The names in Python of parameters that have another name in JavaScript."""
    here, there = (built.parts[language]["inputs"] for language in (_LANGUAGE, "python"))
    return {here[name]: there[name] for name in here if here[name] != there[name]}


def _report(mechanism: Mechanism) -> str:
    """The page of the derivation, where `report` and `explain --html` write it beside this page."""
    return f"{REPORTS.name}/{mechanism.block_name}.html"


def _class(mechanism: Mechanism) -> str:
    return class_name(mechanism.name, mechanism.class_name)


def _modules(files: dict[str, bytes]) -> dict[str, bytes]:
    """The modules alone, by their paths below the folder of the language."""
    names = sorted(name for name in files if name.endswith(".js"))
    return {str(Path(name).relative_to(_LANGUAGE)): files[name] for name in names}


def _model(text: str) -> Model:
    """`body=file.glb`, or `body=file.glb*scale`. Raises `GenerationError`."""
    found = re.fullmatch(r"([^=]+)=(.+?)(?:\*([\d.eE+-]+))?", text)
    if not found:
        raise GenerationError(f"--model {text}: write body=file.glb, or body=file.glb*1000 for a file in metres")
    try:
        scale = float(found[3] or 1)
    except ValueError:
        raise GenerationError(f"--model {text}: {found[3]!r} is no scale") from None
    return Model(found[1], _binary_gltf(Path(found[2])), scale)


def _binary_gltf(path: Path) -> bytes:
    data = path.read_bytes()
    if data[:4] != b"glTF":
        raise DescriptionError(f"{path} is no binary glTF (.glb)")
    return data
