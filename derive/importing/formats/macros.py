"""What is left of xacro in a URDF: a macro that the chain does not need is reported, not refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from shlex import quote
from xml.etree import ElementTree

from derive.importing.formats.documents import shown
from derive.importing.robot import UnreadableRobot

Element = ElementTree.Element
_NO_LINKS = ("property", "arg", "macro")
"""Macros that only state values, or that do nothing unless they are called."""
_NEEDED = ("parent", "child", "origin", "axis", "mimic", "limit")


def refuse_macros(path: Path, root: Element, ends: tuple[str | None, str | None]) -> None:
    """Refuse macros that may add links, unless base and tip say which links count."""
    adding = [_name(e) for e in root if (_is_macro(e) and _name(e) not in _NO_LINKS) or e.tag == "include"]
    if root.find("link") is None:
        adding += [_name(e) for e in root if _is_macro(e)]
    if adding and None in ends:
        raise UnreadableRobot(f"{path}: {adding[0]!r} may add links: {_expanded(path)}, or name --base and --tip")


def refuse_macros_inside(path: Path, joint: Element) -> None:
    """Refuse a joint whose place, axis, limits, or links are an expression."""
    read = [joint, *(e for e in joint if e.tag in _NEEDED)]
    texts = [text for e in read for key, text in e.attrib.items() if key not in ("effort", "velocity")]
    found = [text for text in texts if "${" in text or "$(" in text] or [_name(e) for e in joint.iter() if _is_macro(e)]
    if found:
        raise UnreadableRobot(
            f"{path}: joint {joint.get('name')!r} holds the macro {shown(found[0])}: {_expanded(path)}"
        )


def macro_notes(root: Element) -> Iterator[str]:
    """A note on the macros that were not read."""
    names = dict.fromkeys(_name(e) for e in root.iter() if _is_macro(e))
    if names:
        yield f"Not read, because nothing between base and tip needs them: macros ({', '.join(names)})."


def _is_macro(element: Element) -> bool:
    return "xacro" in element.tag


def _name(element: Element) -> str:
    return element.tag.rpartition("}")[2]


def _expanded(path: Path) -> str:
    """The advice for a file with macros; what the command writes is never the file itself."""
    stem = path.name.partition(".")[0]
    return f"expand it, `xacro {quote(path.name)} > {quote(f'{stem}_expanded.urdf')}`, and import that"
