"""Reading XML: any fault of a file is reported in one sentence."""

from __future__ import annotations

import math
from decimal import Decimal, InvalidOperation
from pathlib import Path
from xml.etree import ElementTree

from derive.importing.robot import UnreadableRobot

Element = ElementTree.Element
_FEWEST_DECIMALS = 3
"""1.57 may be an angle of its own; 1.571 is a right angle, rounded."""


def parsed(path: Path) -> Element:
    """The root of an XML file. Raises `UnreadableRobot` where there is none, or it is broken."""
    data = _bytes_of(path)
    try:
        return ElementTree.fromstring(data)
    except ElementTree.ParseError as problem:
        raise UnreadableRobot(f"{path}:{problem.position[0]}: broken XML: {problem.msg}") from None


def without_namespace(root: Element) -> Element:
    """The root with its elements named without the namespace of the root, which has no meaning for a robot."""
    space, closing, _ = root.tag.rpartition("}")
    for element in root.iter() if closing else ():
        element.tag = element.tag.removeprefix(space + closing)
    return root


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
    """A required attribute."""
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


def rounding(text: str) -> float:
    """The largest distance of a number from the exact one that the file has rounded, by its number of decimals.

    With three decimals it is half a unit of the last one; with more a whole unit, because 3.1415 is cut off; with fewer
    it is 0, because nothing is known. Zeros behind the fourth decimal only pad a number that was rounded before.
    """
    try:
        exponent = Decimal(text).as_tuple().exponent
    except InvalidOperation:
        return 0.0
    decimals = -exponent if isinstance(exponent, int) else 0
    if decimals > _FEWEST_DECIMALS:
        digits = f"{Decimal(text).copy_abs():f}".partition(".")[2].rstrip("0")
        return float(10.0 ** -max(len(digits), _FEWEST_DECIMALS + 1))
    return 0.5 * 10.0**-decimals if decimals == _FEWEST_DECIMALS else 0.0


def roundings(element: Element, attribute: str, count: int) -> tuple[float, ...]:
    """The `rounding` of each of the `count` numbers of an attribute; 0 where the attribute is missing."""
    words = (element.get(attribute) or "").split()
    return tuple(rounding(word) for word in words) if words else (0.0,) * count
