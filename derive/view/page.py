"""The page: modules and the viewer's own source become one program, and stand with style and licences in one file."""

from __future__ import annotations

import html
import json
import re
import tempfile
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from derive.emit.language import RUNTIME, TEMPLATES
from derive.view.node import installed, run

_SOURCE = RUNTIME / "view"
_PAGE = TEMPLATES / "view" / "page.html"
_TARGET = "es2022"
_POLICY = (
    "default-src 'none'; script-src {program}; worker-src blob:; style-src {style}; img-src data: blob:; "
    "connect-src 'self' ws: wss: data: blob:; base-uri 'none'; form-action 'none'"
)
"""The page runs its own program and nothing else: no other script, no attribute of an element, no text that is code."""
_FIELDS = re.compile(r"\{\{ (\w+) \}\}")


class BrokenPage(Exception):
    """The bundler refuses the source; the message is the bundler's."""


@dataclass(frozen=True)
class Model:
    """A mesh of the user's own that replaces a body, or those of an imported robot."""

    body: str
    """The name of the body in the viewer: "base", the axes that move it, "plate", "tool". Empty for a file of
    `softkin import --meshes`: its nodes name the bodies, and stand in the frame of the base, all axes at zero.
    """
    data: bytes
    """The file, binary glTF."""
    scale: float = 1.0
    """The user's length units per unit of the file."""


@dataclass(frozen=True)
class Content:
    """The content of a page."""

    title: str
    modules: Mapping[str, bytes]
    """The machines in JavaScript: path below their folder → text."""
    package: str
    """The Python package of the machines."""
    classes: Mapping[str, str]
    """The name of a machine → that of its class in Python."""
    families: Mapping[str, str] = field(default_factory=dict)
    """The name of a machine → its family."""
    first: str = ""
    """The machine that is shown where the address names none; empty for the first of the modules."""
    keywords: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    """The name of a machine → of its parameters in JavaScript → in Python, where they differ."""
    reports: Mapping[str, str] = field(default_factory=dict)
    """The name of a machine → the page of its derivation, from where this page stands."""
    models: Sequence[Model] = field(default=())


def page(content: Content, packages: Path) -> str:
    """The page. packages: the folder into which npm installs. Raises `MissingTool`, and `BrokenPage`."""
    modules = installed(_SOURCE, packages)
    licences = _licences(modules)
    data = {
        "package": content.package,
        "classes": dict(content.classes),
        "families": dict(content.families),
        "first": content.first or next(iter(content.classes)),
        "keywords": {name: dict(keywords) for name, keywords in content.keywords.items()},
        "reports": dict(content.reports),
        "models": [{"body": m.body, "scale": m.scale, "data": b64encode(m.data).decode()} for m in content.models],
        "licences": licences,
    }
    values = {
        "title": html.escape(content.title),
        "style": (_SOURCE / "page.css").read_text(encoding="utf-8").strip(),
        "licences": licences.replace("--", "- -"),
        "data": json.dumps(data, ensure_ascii=False).replace("<", "\\u003c"),
        "program": _program(content.modules, modules),
    }
    values["policy"] = _POLICY.format(program=_digest(values["program"]), style=_digest(values["style"]))
    return _FIELDS.sub(lambda found: values[found[1]], _PAGE.read_text(encoding="utf-8"))


def _digest(text: str) -> str:
    """The source of a policy that allows this text inside an element, and no other."""
    return f"'sha256-{b64encode(sha256(text.encode()).digest()).decode()}'"


def _program(machines: Mapping[str, bytes], modules: Path) -> str:
    """One script without imports. A text that would end its HTML element is written in another form."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path in sorted(_SOURCE.glob("*.js")):
            (folder / path.name).write_bytes(path.read_bytes())
        for file, data in machines.items():
            target = folder / "machines" / file
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(data)
        esbuild = modules / "esbuild" / "bin" / "esbuild"
        command = [str(_binary(modules) or esbuild), "main.js", "--bundle", "--minify", "--format=iife"]
        options = [f"--target={_TARGET}", "--legal-comments=none", "--charset=utf8", "--log-level=error"]
        done = run([*command, *options], folder, NODE_PATH=str(modules))
    if done.returncode:
        raise BrokenPage(f"the viewer could not be put together:\n{done.stderr.strip()}")
    return re.sub(r"<(/script|!--)", r"<\\\1", done.stdout.strip(), flags=re.IGNORECASE)


def _binary(modules: Path) -> Path | None:
    """The bundler for this platform: npm brings it as a package of its own."""
    found = sorted((modules / "@esbuild").glob("*/bin/esbuild")) + sorted((modules / "@esbuild").glob("*/esbuild.exe"))
    return found[0] if found else None


def _licences(modules: Path) -> str:
    """The licences of the code by others in the page."""
    version = json.loads((modules / "three" / "package.json").read_text(encoding="utf-8"))["version"]
    text = (modules / "three" / "LICENSE").read_text(encoding="utf-8").strip()
    return f"This page carries three.js {version}.\n\n{text}"
