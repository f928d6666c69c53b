"""A class of `softkin` from a description in the running program, for instance in a notebook: derived, measured, and
imported."""

from __future__ import annotations

import atexit
import importlib
import importlib.util
import re
import shutil
import sys
import tempfile
from collections.abc import Mapping
from functools import cache
from itertools import count
from pathlib import Path
from types import ModuleType
from typing import Any

from derive.description.catalogue import load
from derive.description.mechanism import Mechanism
from derive.description.places import in_place
from derive.description.remedies import with_remedy
from derive.description.validate import validate
from derive.emit.python import package
from derive.emit.python.entries import class_name, module_name
from derive.emit.python.layout import formatted
from derive.faults import UNFIT, GenerationError, one_line
from derive.pipeline import derive_and_measure

_PARTS = ("", "_array_programs", "_unrolled")
"""The packages that hold modules of a mechanism."""
_NUMBERS = count(1)


def compiled(description: Mechanism | str | Path) -> type[Any]:
    """The class of a mechanism, or of the file that describes it; see `derive.compile_mechanism`."""
    if not isinstance(description, Mechanism | str | Path):
        raise TypeError(f"compile_mechanism takes a Mechanism, or the path of its file, not {description!r}")
    path = None if isinstance(description, Mechanism) else Path(description)
    try:
        mechanism = validate(description) if isinstance(description, Mechanism) else load(Path(description))
        kinematics = derive_and_measure(mechanism)
    except UNFIT as problem:
        reason = one_line(problem)
        is_placed = path is not None and reason.startswith(str(path))
        raise type(problem)(reason if is_placed else in_place(path, reason) if path else with_remedy(reason)) from None
    runtime = _runtime()
    own = module_name(mechanism.name)
    unique = f"live_{next(_NUMBERS)}_{own}"
    for name, text in formatted(package.part(kinematics)["files"]).items():
        target = _folder() / name.replace(f"/{own}.py", f"/{unique}.py")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(_renamed(text, own, unique), encoding="utf-8")
    importlib.invalidate_caches()
    module = importlib.import_module(f"{runtime.__name__}.{unique}")
    found: type[Any] = getattr(module, class_name(mechanism.name, mechanism.class_name))
    return found


def _renamed(text: str, own: str, unique: str) -> str:
    """The text of a module with unique module names in it, so that two machines may have the same name."""
    return re.sub(rf"\b({package.PACKAGE}(?:\._array_programs|\._unrolled)?)\.{own}\b", rf"\1.{unique}", text)


@cache
def _folder() -> Path:
    """The folder of the modules while the program runs."""
    folder = Path(tempfile.mkdtemp(prefix="softkin-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


@cache
def _runtime() -> ModuleType:
    """The package `softkin`, which then finds live modules: the installed one, or else that of this compiler.

    Raises `GenerationError` if the installed one is not of this compiler.
    """
    files = formatted(package.texts((), package.PACKAGE))
    if importlib.util.find_spec(package.PACKAGE) is None:
        found = _made(files)
    else:
        found = importlib.import_module(package.PACKAGE)
        _refuse_another_runtime(found, files)
    for part in _PARTS:
        inner = importlib.import_module(".".join(filter(None, (package.PACKAGE, part))))
        inner.__path__.append(str(_folder() / package.PACKAGE / part))
    return found


def _made(files: Mapping[str, str]) -> ModuleType:
    """The package without mechanisms, in a folder of its own."""
    for name, text in files.items():
        target = _folder() / "runtime" / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    sys.path.append(str(_folder() / "runtime"))
    importlib.invalidate_caches()
    return importlib.import_module(package.PACKAGE)


def _refuse_another_runtime(found: ModuleType, files: Mapping[str, str]) -> None:
    """Compare the modules that live modules import; files that only build the package are not installed with it."""
    folder = Path(str(found.__file__)).parents[1]
    for name, text in files.items():
        path = folder / name
        is_imported = name.startswith(f"{package.PACKAGE}/") and name.endswith(".py")
        if not is_imported or name == f"{package.PACKAGE}/__init__.py":  # that file lists the mechanisms
            continue
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            raise GenerationError(
                f"the softkin in {folder} was written by another version of this compiler ({path.name} differs): "
                "install the one that `make generate` writes, or remove it"
            )
