"""FMUs: a description in XML and the sources in C, from which `archive` makes one file a machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from hashlib import sha256
from typing import Any
from uuid import UUID

from jinja2 import Environment

from derive.emit.c import package as c
from derive.emit.c.printer import text
from derive.emit.fmu.archive import archive
from derive.emit.fmu.variables import variables_of
from derive.emit.language import STATUSES, Part, environment, runtime
from derive.kinematics.kinematics import Kinematics

name, title = "fmu", "FMI"
bound = f"no FMU: {c.bound}"
_TEXTS = {"modelDescription.xml": "modelDescription.xml.j2", "sources/buildDescription.xml": "buildDescription.xml.j2"}


def part(kinematics: Kinematics) -> Part | None:
    """The texts of one FMU, by their paths in it; None if the machine has no C."""
    inner = c.part(kinematics)
    if inner is None:
        return None
    module = inner["index"]["module"]
    sources = {f"sources/{path}": source for path, source in {**_shared(), **inner["files"]}.items()}
    variables = variables_of(kinematics)
    known: dict[str, Any] = {
        "module": module,
        "name": kinematics.mechanism.name,
        "summary": kinematics.mechanism.summary,
        "variables": variables,
        "outputs": [place for place, one in enumerate(variables) if one.causality == "output"],
        "sources": sorted(path.removeprefix("sources/") for path in sources if path.endswith(".c")),
    }
    # An instance of another FMU is refused by its token, so this changes with all that an FMU has.
    written = [*sources.values(), *(_rendered(one, known | {"token": ""}) for one in _TEXTS.values())]
    known["token"] = f"{{{UUID(sha256(chr(0).join(written).encode()).hexdigest()[:32])}}}"
    header = _rendered("softkin_fmu.h.j2", known | {"token": text(known["token"])})
    texts = {path: _rendered(template, known) for path, template in _TEXTS.items()}
    own = {f"sources/{path}": source for path, source in inner["files"].items()} | {"sources/softkin_fmu.h": header}
    return {
        "index": {"name": kinematics.mechanism.name, "module": module},
        "files": {f"{module}/{path}": one for path, one in {**texts, **own}.items()},
        "notes": list(inner["notes"]),
    }


def files(parts: Sequence[Part]) -> dict[str, str]:
    """The texts of all FMUs: path → text."""
    found: dict[str, str] = {}
    for one in parts:
        found |= one["files"]
        found |= {f"{one['index']['module']}/sources/{path}": source for path, source in _shared().items()}
    return found


def finished(texts: Mapping[str, str]) -> dict[str, bytes]:
    """The files that a user gets: an archive a machine, with its library for this platform if there is a compiler."""
    of_machines: dict[str, dict[str, str]] = {}
    for path, one in texts.items():
        module, _, place = path.partition("/")
        of_machines.setdefault(module, {})[place] = one
    return {f"{module}.fmu": archive(module, own) for module, own in of_machines.items()}


@cache
def _shared() -> Mapping[str, str]:
    """The sources that all machines share."""
    return {**c.shared(), **runtime(name)}


@cache
def _templates() -> Environment:
    templates = environment(name)
    templates.globals["statuses"] = STATUSES
    return templates


def _rendered(template: str, known: Mapping[str, Any]) -> str:
    return _templates().get_template(template).render(known)
