"""A reader of pages: the value of a formula from its MathML, and a program of a page, executed line by line.

It knows nothing of how pages are written: it reads the tags of presentation MathML with the precedence of a textbook.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from xml.etree import ElementTree as ET

import numpy as np

_XHTML = "{http://www.w3.org/1999/xhtml}"
Value = np.ndarray
Values = Mapping[str, Value]
_COMPARED = {"≤": np.less_equal, "<": np.less, "≥": np.greater_equal, ">": np.greater, "=": np.equal, "≠": np.not_equal}


def tag(element: ET.Element) -> str:
    return element.tag.removeprefix(_XHTML)


def has_class(element: ET.Element, name: str) -> bool:
    return name in element.get("class", "").split()


def parsed(text: str) -> ET.Element:
    """A page as a tree; raises where it is not well-formed."""
    return ET.fromstring(text)


def section(page: ET.Element, anchor: str) -> list[ET.Element]:
    """The elements from the heading with an id to the next heading of its rank, at most; what is folded under an id."""
    body = next(e for e in page if tag(e) == "body")
    children = list(body)
    start = next(k for k, e in enumerate(children) if e.get("id") == anchor)
    if tag(children[start]) == "details":
        return [children[start]]
    ranks = ("h2",) if tag(children[start]) == "h2" else ("h2", "h3")
    end = next((k for k in range(start + 1, len(children)) if tag(children[k]) in ranks), len(children))
    return children[start:end]


def every(elements: Iterable[ET.Element], name: str, of: str = "") -> Iterator[ET.Element]:
    """All elements of a tag (and a class) in these, in the order of the page."""
    for element in elements:
        yield from (e for e in element.iter(_XHTML + name) if not of or has_class(e, of))


@dataclass
class _Tokens:
    items: list[ET.Element]
    place: int = 0

    def sign(self) -> str:
        """The operator that comes next; empty where none does."""
        if self.place >= len(self.items):
            return ""
        item = self.items[self.place]
        if tag(item) == "msup" and tag(item[0]) == "mo":
            item = item[0]
        form = item.get("form", "") if item.text == "|" else ""
        return f"{item.text}{form}" if tag(item) == "mo" else ""

    def take(self) -> ET.Element:
        self.place += 1
        return self.items[self.place - 1]


def value_of(maths: Iterable[ET.Element], values: Values) -> Value:
    """The value of a formula that stands on some lines."""
    tokens = _Tokens([item for math in maths for item in _flat(math)])
    found = _or(tokens, values)
    assert tokens.place == len(tokens.items), f"not read: {[ET.tostring(t) for t in tokens.items[tokens.place :]]}"
    return found


def _flat(element: ET.Element) -> Iterator[ET.Element]:
    """The tokens of a row: an outer row is no token."""
    for child in element:
        if tag(child) == "mrow" and tag(element) == "math":
            yield from _flat(child)
        else:
            yield child


def _or(tokens: _Tokens, values: Values) -> Value:
    found = _and(tokens, values)
    while tokens.sign() == "or":
        tokens.take()
        found = np.logical_or(found, _and(tokens, values))
    return found


def _and(tokens: _Tokens, values: Values) -> Value:
    found = _compared(tokens, values)
    while tokens.sign() == "and":
        tokens.take()
        found = np.logical_and(found, _compared(tokens, values))
    return found


def _compared(tokens: _Tokens, values: Values) -> Value:
    if tokens.sign() == "not":
        tokens.take()
        return np.logical_not(_compared(tokens, values))
    found = _sum(tokens, values)
    if tokens.sign() in _COMPARED:
        compare = _COMPARED[tokens.sign()]
        tokens.take()
        return np.asarray(compare(found, _sum(tokens, values)))
    return found


def _sum(tokens: _Tokens, values: Values) -> Value:
    minus = tokens.sign() == "−"
    if minus:
        tokens.take()
    found = _product(tokens, values)
    found = -found if minus else found
    while tokens.sign() in ("+", "−"):
        sign = 1.0 if tokens.take().text == "+" else -1.0
        found = found + sign * _product(tokens, values)
    return found


def _product(tokens: _Tokens, values: Values) -> Value:
    found = _atom(tokens, values)
    while tokens.sign() in ("⋅", "/"):
        over = tokens.take().text == "/"
        factor = _atom(tokens, values)
        found = found / factor if over else found * factor
    return found


def _atom(tokens: _Tokens, values: Values) -> Value:
    sign = tokens.sign()
    if sign in ("(", "|prefix"):
        tokens.take()
        found = _or(tokens, values)
        closing = tokens.take()
        if sign == "|prefix":
            assert closing.text == "|", ET.tostring(closing)
            return np.abs(found)
        if tag(closing) == "msup":
            return np.asarray(found ** _element(closing[1], values))
        assert closing.text == ")", ET.tostring(closing)
        return found
    if sign == "√":
        tokens.take()
        return np.sqrt(np.maximum(_atom(tokens, values), 0.0))
    item = tokens.take()
    if tag(item) == "mi" and tokens.sign() == "\u2061":
        tokens.take()
        return _called(str(item.text), _arguments(tokens, values))
    return _element(item, values)


def _arguments(tokens: _Tokens, values: Values) -> list[Value]:
    assert tokens.take().text == "("
    found = [_or(tokens, values)]
    while tokens.sign() == ",":
        tokens.take()
        found.append(_or(tokens, values))
    assert tokens.take().text == ")"
    return found


def _called(name: str, given: list[Value]) -> Value:
    turn = 2.0 * np.pi
    match name, given:
        case "sin" | "cos" | "tan", [angle]:
            return np.asarray({"sin": np.sin, "cos": np.cos, "tan": np.tan}[name](angle))
        case "atan2", [y, x]:
            return np.asarray(np.arctan2(y + 0.0, x + 0.0))
        case "select", [condition, one, other]:
            return np.asarray(np.where(condition, one, other))
        case "nearestPeriod", [value, centre]:
            return np.asarray(value - 360.0 * np.floor((value - centre + 180.0 + 1e-9) / 360.0))
        case "wrap", [angle]:
            return np.asarray(angle - turn * np.ceil((angle - np.pi) / turn))
        case "nearestOnArc", [angle, centre, half]:
            away = angle - centre - turn * np.floor((angle - centre + np.pi) / turn)
            return np.asarray(centre + np.clip(away, -half, half))
    raise AssertionError(f"no function {name} of {len(given)}")


def _element(item: ET.Element, values: Values) -> Value:
    match tag(item):
        case "mn":
            return np.asarray(float(str(item.text)))
        case "mi":
            known = {"DEGREE": np.pi / 180.0, "π": np.pi, "true": True, "false": False}
            name = str(item.text)
            return np.asarray(known[name]) if name in known else values[name]
        case "mfrac":
            return _element(item[0], values) / _element(item[1], values)
        case "msup":
            return np.asarray(_element(item[0], values) ** _element(item[1], values))
        case "msqrt":
            return np.sqrt(np.maximum(_or(_Tokens(list(item)), values), 0.0))
        case "mrow":
            return _or(_Tokens(list(item)), values)
    raise AssertionError(f"no value: {ET.tostring(item)!r}")


def maths(element: ET.Element) -> list[ET.Element]:
    """The formulas in an element, line by line."""
    return list(element.iter(f"{_XHTML}math"))


def residuals(shown: ET.Element, values: Values) -> Iterator[Value]:
    """Left minus right of all equations that an element shows."""
    for equation in every([shown], "div", "equation"):
        yield difference(maths(equation), values)


def difference(lines: Iterable[ET.Element], values: Values) -> Value:
    tokens = _Tokens([item for math in lines for item in _flat(math)])
    left = _sum(tokens, values)
    assert tokens.take().text == "="
    right = _sum(tokens, values)
    assert tokens.place == len(tokens.items)
    return np.asarray(left - right)


def names_of(lines: Iterable[ET.Element]) -> list[str]:
    """The names that lines of a program bind, as the page spells them."""
    found = []
    for line in lines:
        name = next(every([line], "span", "name"), None)
        if name is not None:
            found.append("".join(name.itertext()))
    return found


def run(lines: Iterable[ET.Element], values: Values) -> dict[str, Value]:
    """The values of all names when the lines of a program are executed in their order."""
    known = dict(values)
    items = list(lines)
    _run(items, 0, known)
    return known


def _depth(line: ET.Element) -> int:
    return int(line.get("style", "--depth: 0").removeprefix("--depth: "))


def _run(lines: list[ET.Element], depth: int, known: dict[str, Value]) -> None:
    place = 0
    while place < len(lines):
        line = lines[place]
        place += 1
        if has_class(line, "refuse") or has_class(line, "call"):
            continue
        if not has_class(line, "where"):
            (name,) = names_of([line])
            known[name] = _value(line, known)
            continue
        condition = value_of(maths(line), known)
        sides = []
        for _ in range(2):
            end = next((k for k in range(place, len(lines)) if _depth(lines[k]) <= depth), len(lines))
            side = dict(known)
            _run(lines[place:end], depth + 1, side)
            sides.append(side)
            place = end + 1  # the line that says "otherwise"
        place -= 1
        for name in sides[0].keys() & sides[1].keys():
            known[name] = np.where(condition, sides[0][name], sides[1][name])


def _value(line: ET.Element, known: Values) -> Value:
    content = next(every([line], "div", "value"))
    with np.errstate(all="ignore"):
        if has_class(line, "matrix"):
            rows = [[_or(_Tokens(list(_flat_cell(c))), known) for c in row] for row in content.iter(f"{_XHTML}mtr")]
            size = np.broadcast_shapes(*(v.shape for row in rows for v in row))
            full = np.array([[np.broadcast_to(v, size) for v in row] for row in rows])
            return np.asarray(np.linalg.det(np.moveaxis(full, (0, 1), (-2, -1))))
        if not has_class(line, "cases"):
            return value_of(maths(content), known)
        found: Value | None = None
        for case in reversed(list(every([content], "div", "case"))):
            own = value_of(maths(next(every([case], "div", "is"))), known)
            where = next(every([case], "div", "if"), None)
            found = own if where is None or found is None else np.where(value_of(maths(where), known), own, found)
        assert found is not None
        return found


def _flat_cell(cell: ET.Element) -> Iterator[ET.Element]:
    for child in cell:
        yield from child if tag(child) == "mrow" else (child,)
