"""The node of the controller for each axis, and its scale."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from derive.controller.reading import judged, shown
from derive.controller.refusal import Refused


@dataclass(frozen=True)
class Channel:
    """An axis, its node, and the factor from the node's number to degrees, or to units of length of the machine."""

    axis: str
    node: str
    scale: float = 1.0


def of_argument(text: str) -> Channel:
    """`A1=<node>` or `A1=<node>*<scale>`. Raises `Refused`."""
    axis, equals, right = text.partition("=")
    node, star, scale = right.rpartition("*")
    node = (node if star else right).strip()
    if not equals or not axis.strip() or not node:
        raise Refused(f"--axis {text}: write it as A1=node or A1=node*scale")
    if not star:
        return Channel(axis.strip(), node)
    try:
        number = float(scale)
    except ValueError:
        message = f"--axis {text}: {scale!r} after the * is no number; a node with a * in its name goes into the JSON"
        raise Refused(message) from None
    return Channel(axis.strip(), node, checked_scale(number, f"--axis {text}"))


def of_entry(axis: str, given: object, where: str) -> Channel:
    """An entry of the JSON: a node, or an object with `node` and `scale`. Raises `Refused`."""
    place = f"{where}: axes.{axis}"
    if isinstance(given, str) and given:
        return Channel(axis, given)
    if not isinstance(given, Mapping) or not set(given) <= {"node", "scale"}:
        raise Refused(f'{place}: a node, or {{"node": ..., "scale": ...}}, not {given!r}')
    node, scale = given.get("node", axis), given.get("scale", 1.0)
    if not isinstance(node, str) or not node:
        raise Refused(f"{place}: a node is a text, not {node!r}")
    return Channel(axis, node, checked_scale(scale, place))


def checked_scale(scale: object, where: str) -> float:
    """The scale as a number. Raises `Refused` if it is not finite, or 0."""
    read = judged(scale, 1.0, 0.0)
    if not read.value:
        raise Refused(f"{where}: a scale is a number other than 0, not {shown(scale)}")
    return read.value


def in_order(given: Iterable[Channel], axes: tuple[str, ...], *, named: bool) -> tuple[Channel, ...]:
    """The channels in the order of the machine's axes; later ones replace earlier ones.

    named: a node that is not given has the name of its axis (a column of a table). Raises `Refused` for an axis that
    the machine does not have, or one without a node.
    """
    found = {axis: Channel(axis, axis) for axis in axes} if named else {}
    for channel in given:
        if channel.axis not in axes:
            raise Refused(f"the machine has no axis {channel.axis!r}: its axes are {', '.join(axes)}")
        found[channel.axis] = channel
    missing = [axis for axis in axes if axis not in found]
    if missing:
        raise Refused(f"which node is {', '.join(missing)}? Name it with --axis {missing[0]}=node, or in the JSON")
    return tuple(found[axis] for axis in axes)
