"""Reading XML: any fault of a file is reported in one sentence."""

from __future__ import annotations

import math
from decimal import Decimal, InvalidOperation
from pathlib import Path
from xml.etree import ElementTree

from derive.importing.robot import UnreadableRobot

Element = ElementTree.Element
_LARGEST = 1e6
"""In size, of the numbers of a file (metres, millimetres, degrees, radians): a larger one is a slip."""
_SHOWN = 40
_FEWEST_DECIMALS = 3
"""1.57 may be an angle of its own; 1.571 is a right angle, rounded."""
COARSE = 5e-3
"""The `rounding` of an angle with two decimals: whether it is one, the user says."""


def parsed(path: Path) -> Element:
    """The root of an XML file. Raises `UnreadableRobot` if there is none, or it is broken."""
    data = _bytes_of(path)
    try:
        return ElementTree.fromstring(data)
    except ElementTree.ParseError as problem:
        raise UnreadableRobot(f"{path}:{problem.position[0]}: broken XML: {problem.msg}") from None
    except (LookupError, ValueError) as problem:
        raise UnreadableRobot(f"{path}: its encoding cannot be read ({problem}): save it in UTF-8") from None


def without_namespace(root: Element) -> Element:
    """The root with its elements named without the namespace of the root, which has no meaning for a robot."""
    space, closing, _ = root.tag.rpartition("}")
    for element in root.iter() if closing else ():
        element.tag = element.tag.removeprefix(space + closing)
    return root


def text_of(path: Path) -> str:
    """The text of a file. Raises `UnreadableRobot` if there is no such file, or it is no text."""
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
    """A number that may be as large as it likes, or infinite: no limit on that side."""
    return number(path, text, place, math.inf)


def required(path: Path, element: Element, attribute: str) -> str:
    """A required attribute."""
    value = element.get(attribute)
    if not value:
        name = element.get("name")
        raise UnreadableRobot(f"{path}: <{element.tag}>{f' {name!r}' if name else ''} has no {attribute}")
    return value


def number(path: Path, text: str, place: str, largest: float = _LARGEST) -> float:
    """A number, at most the largest in size."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= largest:
        why = "is no number" if math.isnan(value) else f"is more than {largest:g}"
        raise UnreadableRobot(f"{path}: {place}: {shown(text)} {why}")
    return value


def between(path: Path, place: str, low: float, high: float, unit: float) -> tuple[float, float] | None:
    """The limits of a joint in our unit; None if both ends are the same, which files write for no limits."""
    if low > high:
        raise UnreadableRobot(f"{path}: {place}: its lower limit {low:g} is above its upper limit {high:g}")
    return (low * unit, high * unit) if low < high else None


def shown(text: str) -> str:
    """A text of a file as a message quotes it: its beginning, where it is long."""
    return repr(text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…")


def numbers(path: Path, element: Element, attribute: str, place: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """As many numbers as the default has, between blanks."""
    stated = element.get(attribute)
    if stated is None or not stated.strip():
        return default
    found = tuple(number(path, word, f"{place}, {attribute}") for word in stated.split())
    if len(found) != len(default):
        said = f"{shown(stated)} has {len(found)} numbers, not {len(default)}"
        raise UnreadableRobot(f"{path}: {place}, {attribute}: {said}")
    return found


def rounding(text: str, with_coarse: bool = False) -> float:
    """The largest distance of a number from the exact one that the file has rounded, by its number of decimals.

    With three decimals it is half a unit of the last one; with more a whole unit, because 3.1415 is cut off; with fewer
    it is 0, because nothing is known, or with two `COARSE`, if that is asked for. Zeros behind the fourth decimal only
    pad a number that was rounded before.
    """
    try:
        stated = Decimal(text).as_tuple()
    except InvalidOperation:
        return 0.0
    decimals = -stated.exponent if isinstance(stated.exponent, int) else 0
    if decimals > _FEWEST_DECIMALS:
        digits = "".join(map(str, stated.digits))
        padding = len(digits) - len(digits.rstrip("0"))
        return float(10.0 ** -max(decimals - padding, _FEWEST_DECIMALS + 1))
    return 0.5 * 10.0**-decimals if decimals == _FEWEST_DECIMALS else COARSE if decimals == 2 and with_coarse else 0.0


def roundings(element: Element, attribute: str, count: int, with_coarse: bool = False) -> tuple[float, ...]:
    """The `rounding` of each of the `count` numbers of an attribute; 0 where the attribute is missing."""
    words = (element.get(attribute) or "").split()
    return tuple(rounding(word, with_coarse) for word in words) if words else (0.0,) * count


def direction_rounding(element: Element, attribute: str, size: float) -> float:
    """The largest angle (radians) by which the file has rounded a direction of that size."""
    return math.hypot(*roundings(element, attribute, 3)) / size


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
