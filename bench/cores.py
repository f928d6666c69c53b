"""The package once for each core, side by side in one process, so that all contenders take turns."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from types import ModuleType


def _loaded(core: str) -> ModuleType:
    """The package with its modules, on a core."""
    for name in [name for name in sys.modules if name.partition(".")[0] == "softkin"]:
        del sys.modules[name]
    os.environ["SOFTKIN_CORE"] = core
    softkin = import_module("softkin")
    softkin.catalogue()  # nothing is imported later, when the other core is in its place
    for name in ("_batch", "_native_batch", "_configuration", "_differential"):
        import_module(f"softkin.{name}")
    return softkin


def _every() -> dict[str, ModuleType]:
    found = {"python": _loaded("python")}
    try:
        found["native"] = _loaded("native")
    except ImportError as error:
        print(f"Python alone is measured: {error}")
        found["python"] = _loaded("python")
    return found


CORES = _every()
