"""A MuJoCo model with its included files inserted."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from derive.importing.formats.documents import parsed, required
from derive.importing.robot import UnreadableRobot

Element = ElementTree.Element


def whole(path: Path, root: Element) -> Element:
    """The root with the children of every included file where its `include` stood; each file may come once.

    Their names are relative to the folder of the model, as MuJoCo reads them.
    """
    _fill(path, root, {path.resolve()})
    return root


def _fill(model: Path, element: Element, seen: set[Path]) -> None:
    children: list[Element] = []
    for child in element:
        if child.tag == "include":
            children += _included(model, child, seen)
        else:
            _fill(model, child, seen)
            children.append(child)
    element[:] = children


def _included(model: Path, include: Element, seen: set[Path]) -> list[Element]:
    path = model.parent / required(model, include, "file")
    if not path.is_file():
        raise UnreadableRobot(f"{model}: includes {path}, and there is no such file: put it beside the model")
    if path.resolve() in seen:
        raise UnreadableRobot(f"{model}: includes {path} twice: write it once")
    seen.add(path.resolve())
    inner = parsed(path)
    _fill(model, inner, seen)
    return list(inner)
