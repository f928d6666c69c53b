"""Reading XML: one sentence for everything that is wrong with a file."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree import ElementTree

from derive.importing.robot import UnreadableRobot

Element = ElementTree.Element


def parsed(path: Path) -> Element:
    """The root of an XML file. Raises `UnreadableRobot` where there is none, or it is broken."""
    data = _bytes_of(path)
    try:
        return ElementTree.fromstring(data)
    except ElementTree.ParseError as problem:
        raise UnreadableRobot(f"{path}:{problem.position[0]}: broken XML: {problem.msg}") from None


def text_of(path: Path) -> str:
    """The text of a file. Raises `UnreadableRobot` where there is no such file, or it is no text."""
    try:
        return _bytes_of(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise UnreadableRobot(f"{path}: is no text in UTF-8") from None


def _bytes_of(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise UnreadableRobot(f"{path}: there is no such file") from None
    except IsADirectoryError:
        raise UnreadableRobot(f"{path}: is a folder; name the robot file in it") from None


def limit(path: Path, text: str, place: str) -> float:
    """A number that may be infinite: no limit on that side."""
    return float(text) if text.strip().lstrip("+-").lower() in ("inf", "infinity") else number(path, text, place)


def required(path: Path, element: Element, attribute: str) -> str:
    """An attribute that has to be there."""
    value = element.get(attribute)
    if not value:
        name = element.get("name")
        raise UnreadableRobot(f"{path}: <{element.tag}>{f' {name!r}' if name else ''} has no {attribute}")
    return value


def number(path: Path, text: str, place: str) -> float:
    """A finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise UnreadableRobot(f"{path}: {place}: {text!r} is no number")
    return value


def numbers(path: Path, element: Element, attribute: str, place: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """As many numbers as the default has, between blanks."""
    stated = element.get(attribute)
    if stated is None or not stated.strip():
        return default
    found = tuple(number(path, word, f"{place}, {attribute}") for word in stated.split())
    if len(found) != len(default):
        raise UnreadableRobot(f"{path}: {place}, {attribute}: {stated!r} has {len(found)} numbers, not {len(default)}")
    return found
