"""The shapes of links, joints, rails and frames on the page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from derive.drawing.scene import Arc, Belt, Body, Frame, Point, Scene, Segment, Slide, Turn
from derive.emit.picture import style
from derive.emit.picture.ink import Area, Mark, Vector, area, arrow, line
from derive.emit.picture.view import View

_WIDTHS = {
    Body.LINK: style.LINK_WIDTH,
    Body.ROD: style.ROD_WIDTH,
    Body.PLATE: style.PLATE_WIDTH,
    Body.BASE: style.BASE_WIDTH,
}
_COLOURS = {Body.LINK: style.LINK, Body.ROD: style.ROD, Body.PLATE: style.PLATE, Body.BASE: style.BASE}
_SWEEP = np.radians(75.0)
"""The angle of an arrow about an axis in the plane; in space an arrow goes most of the way around."""
_AROUND = np.radians(250.0)
STEPS = 28
BESIDE = 22.0
"""The distance of the arrow about an axis in space from its joint."""
PAIR_WIDTH = 3.4
"""The width of each of two parallel rods."""


def bar(segment: Segment, view: View) -> list[Mark]:
    """A body, drawn as a stroke with an edge."""
    if segment.across is not None:
        return _parallelogram(segment, segment.across, view)
    ends = [view.page(segment.start), view.page(segment.end)]
    width = _WIDTHS[segment.body]
    if segment.body is Body.BASE:
        return [line(ends, _COLOURS[segment.body], width)]
    return [line(ends, style.LINK_EDGE, width + 1.6), line(ends, _COLOURS[segment.body], width)]


def _parallelogram(segment: Segment, across: Sequence[float], view: View) -> list[Mark]:
    """Two parallel rods, and the short bars that join them at both ends."""
    start, end, side = np.array(segment.start), np.array(segment.end), np.array(across)
    corners = [view.page(p) for p in (start - side, end - side, end + side, start + side)]
    marks: list[Mark] = []
    for one, other in ((0, 3), (1, 2), (0, 1), (3, 2)):
        ends = [corners[one], corners[other]]
        marks += [line(ends, style.LINK_EDGE, PAIR_WIDTH + 1.6), line(ends, style.ROD, PAIR_WIDTH)]
    return [*marks, *(area(_circle(corner, 3.0), style.JOINT, style.LINK_EDGE) for corner in corners)]


def meeting(at: Vector) -> list[Mark]:
    """The one centre of joints whose axes meet: a ball."""
    return [area(_circle(at, 8.0), style.JOINT, style.TURN, 1.6), area(_circle(at, 2.4), style.TURN, style.TURN)]


def ground(at: Vector, view: View) -> list[Mark]:
    """The base of the machine: a plate in space, a triangle with hatching in the plane."""
    if not view.is_planar:
        corners = [at + 26.0 * (view.axes @ np.array([x, y, 0.0])) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
        return [area(corners, style.BASE, style.FAINT)]
    foot = at + np.array([0.0, -20.0])
    marks: list[Mark] = [area([at, foot + [-13.0, 0.0], foot + [13.0, 0.0]], style.BASE, style.FAINT)]
    marks.append(line([foot + [-19.0, 0.0], foot + [19.0, 0.0]], style.INK, 1.4))
    return marks + [
        line([foot + [x, 0.0], foot + [x - 6.0, -6.0]], style.INK, 1.0) for x in (-12.0, -4.0, 4.0, 12.0, 19.0)
    ]


def basis(axis: Sequence[float], toward: Sequence[float] | Vector | None) -> tuple[Vector, Vector, Vector]:
    """The axis, a direction perpendicular to it, and that direction turned by 90 degrees about the axis."""
    z = np.array(axis, dtype=float)
    z /= np.linalg.norm(z)
    guess = np.array(
        toward if toward is not None else ([1.0, 0.0, 0.0] if abs(z[0]) < 0.9 else [0.0, 1.0, 0.0]), dtype=float
    )
    x = guess - (guess @ z) * z
    x /= np.linalg.norm(x)
    return z, x, np.cross(z, x)


def arc(turn: Turn, at: Vector, radius: float, view: View) -> list[Vector]:
    """The points of an arc in the positive sense about the axis through a point of the page."""
    if view.is_planar:
        z, x, y = basis(turn.axis, turn.zero or turn.toward)
        turned = _angle(x, y, turn.toward) if turn.zero is not None and turn.toward is not None else 0.0
        angles = np.linspace(0.0, turned if turned > _SWEEP / 2 else _SWEEP, STEPS)
    else:
        z, x, y = basis(turn.axis, view.eye)
        angles = np.linspace(-_AROUND / 2, _AROUND / 2, STEPS)
    return [at + radius * (view.axes @ (np.cos(a) * x + np.sin(a) * y)) for a in angles]


def _angle(x: Vector, y: Vector, toward: Sequence[float]) -> float:
    vector = np.array(toward)
    return float(np.arctan2(vector @ y, vector @ x))


def turning(
    turn: Turn, at: Vector, radius: float, view: View, through: Sequence[Vector] = (), *, has_body: bool = True
) -> list[Mark]:
    """A rotary joint: its body, its axis as far as it goes `through` points of the page, and an arrow in its positive
    direction where something drives it.
    """
    if view.is_planar:
        r = style.JOINT_RADIUS - 2.0
        marks: list[Mark] = [
            area(_circle(at, r), style.JOINT, style.TURN, 1.6),
            area(_circle(at, 2.0), style.TURN, style.TURN),
        ]
        marks += _reference(turn, turn.zero or turn.toward, at, radius + 14.0, view)
        return [*marks, *(arrow(arc(turn, at, radius, view), style.TURN, 2.2) if turn.label != 0 else ())]
    z = view.axes @ np.array(turn.axis)
    length = float(z @ z)
    along = [float((place - at) @ z) / length for place in through if length > 1e-9]
    ends = (min([-34.0, *(a - 20.0 for a in along)]), max([44.0, *(a + 20.0 for a in along)]))
    marks = [line([at + end * z for end in ends], style.TURN, 1.0, (9.0, 3.0, 2.0, 3.0))]
    marks += _cylinder(turn, at, view) if has_body else []
    marks += _reference(turn, turn.zero, at, 3.0 * radius, view)
    around = arc(turn, at + BESIDE * z, radius * 0.85, view)
    return [*marks, *(arrow(around, style.TURN, 2.2) if turn.label != 0 else ())]


def _reference(turn: Turn, direction: Sequence[float] | None, at: Vector, length: float, view: View) -> list[Mark]:
    """A dashed line at the zero of a turn."""
    if direction is None:
        return []
    _, x, _ = basis(turn.axis, direction)
    return [line([at, at + length * (view.axes @ x)], style.TURN, 1.0, (4.0, 3.0))]


def opening(arc_: Arc, radius: float, view: View) -> list[Vector]:
    """The points of the arc between two directions, along the smaller angle."""
    start, end = np.array(arc_.start), np.array(arc_.end)
    angle = float(np.arccos(np.clip(start @ end, -1.0, 1.0)))
    across = end - (end @ start) * start
    across /= np.linalg.norm(across)
    at = view.page(arc_.at)
    return [
        at + radius * (view.axes @ (np.cos(a) * start + np.sin(a) * across)) for a in np.linspace(0.0, angle, STEPS)
    ]


def angle_lines(arc_: Arc, radius: float, view: View) -> list[Mark]:
    """An angle of the machine: both of its directions, and an arrow from the first to the second."""
    at, points = view.page(arc_.at), opening(arc_, radius, view)
    sides: list[Mark] = [
        line([at, at + 1.25 * (p - at)], style.FAINT, 0.9, (3.0, 3.0)) for p in (points[0], points[-1])
    ]
    return [*sides, *arrow(points, style.FAINT, 1.2, 0.8)]


def _cylinder(turn: Turn, at: Vector, view: View) -> list[Area]:
    z, x, y = basis(turn.axis, view.eye)
    half = 12.0 * (view.axes @ z)
    ring = [
        style.JOINT_RADIUS * (view.axes @ (np.cos(a) * x + np.sin(a) * y)) for a in np.linspace(0, 2 * np.pi, 25)[:-1]
    ]
    near = half if float(z @ view.eye) >= 0 else -half
    body = hull([at + side + p for side in (half, -half) for p in ring])
    return [area(body, style.JOINT, style.TURN, 1.4), area([at + near + p for p in ring], "#eef4fb", style.TURN, 1.2)]


def hull(points: Sequence[Vector]) -> list[Vector]:
    """The convex hull of points of the page, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted(tuple(np.round(p, 6)) for p in points)
    chains = []
    for side in (ordered, ordered[::-1]):
        chain: list[tuple[float, ...]] = []
        for p in side:
            while len(chain) > 1 and _left(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    return [np.array(p) for p in (*chains[0], *chains[1])]


def _left(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _circle(at: Vector, radius: float) -> list[Vector]:
    return [at + radius * np.array([np.cos(a), np.sin(a)]) for a in np.linspace(0, 2 * np.pi, 29)[:-1]]


def rail(ends: tuple[Vector, Vector], at: Vector) -> list[Mark]:
    """A rail, and the carriage on it."""
    along = ends[1] - ends[0]
    length = float(np.linalg.norm(along))
    x = along / length if length > 1e-9 else np.array([1.0, 0.0])
    y = np.array([-x[1], x[0]])
    corners = [at + a * x + b * y for a, b in ((11, 7), (-11, 7), (-11, -7), (11, -7))]
    return [line(ends, style.SLIDE, 6.4), line(ends, style.RAIL, 4.4), area(corners, "#f7ece2", style.SLIDE, 1.4)]


def triad(frame: Frame, size: float, width: float, view: View) -> list[tuple[Vector, list[Mark]]]:
    """The axes of a frame, each with its tip."""
    found = []
    origin = view.page(frame.position)
    for index in range(3):
        direction = view.direction([row[index] for row in frame.rotation])
        tip = origin + size * direction
        if np.linalg.norm(direction) > 0.1:
            found.append((tip, arrow([origin, tip], style.AXES[index], width)))
        else:
            found.append((origin, []))
    return found


_FROM, _TO = np.radians(150.0), np.radians(390.0)
"""Where the arrow at a motor begins and ends."""
_ASIDE = 13.0
"""In pixels: the distance of the arrow at a motor from its wheel."""


def motor_radius(drawn: Belt, view: View) -> float:
    """The radius of the arrow at a motor, in pixels."""
    return _ASIDE + drawn.radius * view.scale


def belt(drawn: Belt, view: View) -> list[Mark]:
    """The frame, the wheels, the belt, the carriage that holds its ends, and the motors."""
    marks = [mark for segment in drawn.frame for mark in bar(segment, view)]
    for centre in drawn.wheels:
        marks.append(area(_ring(drawn, centre, view), style.PAPER, style.LINK_EDGE, 1.2))
    for motor in drawn.motors:
        marks.append(area(_ring(drawn, motor.at, view), style.JOINT, style.TURN, 2.0))
    marks.append(line([view.page(p) for p in drawn.path], style.BELT, 2.0))
    held = [view.page(p) for p in (drawn.path[0], drawn.path[-1])]
    over = np.array([5.0, 0.0])
    marks.append(line([held[0] - over, held[1] + over], style.BELT, 8.0))
    for motor in drawn.motors:
        _, x, y = basis(motor.axis, None)
        points = [
            view.page(motor.at) + motor_radius(drawn, view) * (view.axes @ (np.cos(a) * x + np.sin(a) * y))
            for a in np.linspace(_FROM, _TO, 24)
        ]
        marks += arrow(points, style.TURN, 2.4)
    return marks


def _ring(drawn: Belt, centre: Point, view: View) -> list[Vector]:
    _, x, y = basis(drawn.normal, None)
    return [
        view.page(np.array(centre) + drawn.radius * (np.cos(a) * x + np.sin(a) * y))
        for a in np.linspace(0.0, 2.0 * np.pi, 25)[:-1]
    ]


_TRAVEL = 0.5
"""The length of a rail over the size of the machine."""
FREE = 100.0
"""The size with which a machine without lengths is drawn."""
_BACK = 0.25
"""The part of a rail that lies behind its zero."""
_ARROW_ASIDE, _ALONE = 15.0, 64.0
"""In pixels: the distance of an arrow from its rail, and the length of an arrow without a rail."""

Ends = tuple[Point, Point]


def rails(scene: Scene) -> dict[Slide, Ends]:
    """The ends of every rail. Rails that begin at one point are drawn one on the other, as slides are mounted."""
    travel = _TRAVEL * (scene.size or FREE)
    above: dict[Point, Vector] = {}
    found = {}
    for slide in scene.slides:
        axis, at = np.array(slide.axis), np.array(slide.at)
        start = above.get(slide.at)
        back = 0.0 if start is not None else _BACK if slide.has_arrow else 1.0
        first = at + (np.zeros(3) if start is None else start)
        found[slide] = (_point(first - back * travel * axis), _point(first + travel * axis))
        if slide.has_rail and slide.has_arrow:
            above[slide.at] = first - at + travel * axis
    return found


def is_stacked(scene: Scene) -> bool:
    """Whether several rails begin at one point."""
    places = [slide.at for slide in scene.slides if slide.has_rail and slide.has_arrow]
    return len(set(places)) < len(places)


def slide_arrow(slide: Slide, ends: Ends, view: View, *, is_beside: bool) -> Iterator[Mark]:
    """The arrow in the positive direction, along the rail if there is one; else `is_beside` moves it off a bar."""
    if not slide.has_arrow:
        return
    along = view.direction(slide.axis)
    unit = along / max(float(np.linalg.norm(along)), 1e-9)
    aside = _ARROW_ASIDE * np.array([-unit[1], unit[0]])
    if slide.has_rail:
        start, end = view.page(_on_rail(slide.at, ends)), view.page(ends[1])
        yield from arrow([start + 0.2 * (end - start) + aside, start + 0.9 * (end - start) + aside], style.SLIDE, 2.4)
        return
    first = view.page(slide.at) + (aside if is_beside else 0.0)
    yield from arrow([first, first + _ALONE * along / max(float(np.linalg.norm(along)), 0.5)], style.SLIDE, 2.4)


def _on_rail(place: Point, ends: Ends) -> Point:
    """The point of a rail nearest to a place: its zero, or the beginning of a rail that stands on another."""
    begin, end = map(np.array, ends)
    along = end - begin
    return _point(begin + np.clip((np.array(place) - begin) @ along / (along @ along), 0.0, 1.0) * along)


def _point(values: Vector) -> Point:
    x, y, z = (float(v) for v in values)
    return (x, y, z)
