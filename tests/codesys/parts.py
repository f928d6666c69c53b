"""The parts of objects, as an editor of CODESYS holds them, read from `.st` files by their rulers alone."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from derive.command.catalogue import OUTPUT

_EVERY = {
    str(p.relative_to(OUTPUT / "st")): p.read_text(encoding="utf-8") for p in sorted((OUTPUT / "st").rglob("*.st"))
}
SAMPLES = {name.split("/")[1].removesuffix(".st"): t for name, t in _EVERY.items() if name.startswith("samples/")}
"""The sample projects by their blocks: their programs have the same names, and are no part of a library."""
FILES = {name: text for name, text in _EVERY.items() if not name.startswith("samples/")}
_RULER = re.compile(r"// ==== ([A-Z_]+) (\w+(?:\.\w+)?): (declaration|implementation) =+")
_END = re.compile(r"(?:(?:GET|END_\w+)  )?// =+")


@dataclass
class Part:
    """An object or a member of it: its keyword, and the text of its two panes."""

    kind: str
    path: str
    declaration: str = ""
    implementation: str = ""


@dataclass
class Whole:
    """An object with its members, in their order."""

    own: Part
    members: list[Part] = field(default_factory=list)

    def text(self) -> str:
        """The object as a text with the closing words that no editor holds."""
        inner = [_member(one, self.members) for one in self.members if one.kind != "GET"]
        closing = "" if self.own.kind in ("TYPE", "VAR_GLOBAL") else f"END_{self.own.kind}"
        return "\n".join([self.own.declaration, *inner, self.own.implementation, closing])


def _member(one: Part, members: Iterable[Part]) -> str:
    if one.kind == "METHOD":
        return f"{one.declaration}\n{one.implementation}\nEND_METHOD"
    (getter,) = (m for m in members if m.kind == "GET" and m.path == one.path)
    return f"{one.declaration}\nGET\n{getter.implementation}\nEND_GET\nEND_PROPERTY"


def parts_of(text: str) -> list[Part]:
    """The parts below the rulers of a file: what a user would paste."""
    found: dict[tuple[str, str], Part] = {}
    blocks = re.split(r"^((?:(?:GET|END_\w+)  )?// ====.*)$", text, flags=re.MULTILINE)
    for ruler, below in zip(blocks[1::2], blocks[2::2], strict=True):
        if _END.fullmatch(ruler):
            continue
        match = _RULER.fullmatch(ruler)
        assert match is not None, ruler
        kind, path, pane = match.groups()
        part = found.setdefault((kind, path), Part(kind, path))
        assert not getattr(part, pane), f"{ruler} stands there twice"
        setattr(part, pane, below.strip("\n"))
    return list(found.values())


def all_parts(files: Mapping[str, str]) -> dict[tuple[str, str], Part]:
    """The parts of many files, by kind and path."""
    return {(part.kind, part.path): part for text in files.values() for part in parts_of(text)}
