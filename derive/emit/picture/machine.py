"""The machine on its part of the page: bodies are drawn first, joints next, names last."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import sympy as sp

from derive.drawing.drawing import Drawing
from derive.drawing.scene import ORIGIN, Body, Dimension, Point, Segment, Slide, Turn
from derive.emit.picture import style
from derive.emit.picture.ink import Area, Mark, Vector
from derive.emit.picture.naming import (
    in_short,
    name_angle,
    name_axes,
    name_length,
    name_motor,
    name_point,
    name_slide,
    name_turn,
    spelled,
)
from derive.emit.picture.placing import Sheet, around
from derive.emit.picture.symbols import (
    BESIDE,
    FREE,
    angle_lines,
    bar,
    belt,
    ground,
    meeting,
    motor_radius,
    opening,
    rail,
    rails,
    slide_arrow,
    triad,
    turning,
)
from derive.emit.picture.view import Box, fitted

Margins = tuple[float, float, float, float]
MARGINS: Margins = (78.0, 62.0, 84.0, 58.0)
"""Room for names around the machine: left, below, right, above."""
_ANGLE_RADIUS = 46.0
_SHIFTS, _AROUND = (0.0, 52.0, -52.0, 104.0, -104.0), (46.0, -46.0, 72.0, -72.0, 98.0, -98.0)
"""The distances along its axis at which a joint is drawn, and its arrow from the centre of several joints."""
_PARALLEL = 1e-6
_CLOSE = 30.0
"""Joints at a smaller distance than this would cover each other."""


class Machine:
    """Draws a machine on a sheet; `names` holds the spelling of parameters."""

    def __init__(self, drawing: Drawing, box: Box, names: Mapping[str, str], margins: Margins = MARGINS) -> None:
        self._scene, self._names = drawing.scene, names
        self._sheet = Sheet(box)
        self._rails = rails(self._scene)
        points = self._points()
        left, below, right, above = margins
        inside = Box(box.left + left, box.bottom + below, box.right - right, box.top - above)
        self._view = fitted(points, inside, plane=drawing.plane)
        seen = np.array([self._view.page(p) for p in points])
        self.extent = Box(*map(float, (*seen.min(axis=0), *seen.max(axis=0))))
        """The rectangle of the machine without its names."""
        self._taken: list[Vector] = []
        """The positions at which joints are drawn."""

    def _points(self) -> list[Point]:
        """The points that must be on the page."""
        points = [ORIGIN.position, self._scene.tool.position]
        points += [p for s in self._scene.segments for p in (s.start, s.end)]
        points += [
            p for slide, ends in self._rails.items() if slide.has_rail and not self._is_on_belt(slide) for p in ends
        ]
        points += self._scene.belt.path if self._scene.belt is not None else ()
        everywhere = [(FREE * x, 0.0, FREE * x) for x in (-0.5, 0.5)]
        return points if len(set(points)) > 1 else [*points, *everywhere]

    def drawn(self) -> list[Mark]:
        """The marks of the machine."""
        view, scene, sheet = self._view, self._scene, self._sheet
        for segment in sorted(scene.segments, key=self._order):
            sheet.draw(bar(segment, view))
        if scene.belt is not None:
            sheet.draw(belt(scene.belt, view))
        for place in () if scene.belt is not None else scene.grounds:
            sheet.draw(ground(view.page(place), view))
        for slide in scene.slides:
            if slide.has_rail and not self._is_on_belt(slide):
                first, last = (view.page(end) for end in self._rails[slide])
                sheet.draw(rail((first, last), view.page(slide.at)))
        joints = [(turn, *self._anchored(turn)) for turn in scene.turns]
        for turn, at, radius in joints:
            sheet.draw(turning(turn, at, radius, view, self._through(turn), has_body=self._centre(turn) is None))
        for place in dict.fromkeys(c for c in map(self._centre, scene.turns) if c is not None):
            sheet.draw(meeting(view.page(place)))
        self._frames_and_names(joints)
        for index, arc in enumerate(scene.arcs):
            radius = _ANGLE_RADIUS + 15.0 * index
            sheet.draw(angle_lines(arc, radius, view))
            name_angle(sheet, self._spelled(arc.label), view.page(arc.at), opening(arc, radius, view))
        for dimension in sorted(scene.dimensions, key=lambda d: -self._length(d)):
            text = self._spelled(dimension.label) + (" < 0" if dimension.is_negative else "")
            name_length(sheet, view, dimension, text)
        for spot in scene.spots:
            name_point(sheet, f"({in_short([self._spelled(label) for label in spot.labels])})", view.page(spot.at))
        if scene.belt is not None:
            radius = motor_radius(scene.belt, view)
            for motor in scene.belt.motors:
                name_motor(sheet, f"Motor {self._spelled(motor.label)}", view.page(motor.at), radius)
        return sheet.settled()

    def _ends_of(self, slide: Slide) -> Point:
        """Where the name of a slide without an arrow stands: at the end of its rail, or of its beam with a belt."""
        belted = [s for s in self._scene.slides if self._is_on_belt(s)]
        if slide in belted and self._scene.belt is not None:
            return self._scene.belt.tips[belted.index(slide)]
        return self._rails[slide][1]

    def _through(self, turn: Turn) -> list[Vector]:
        """The points through which the axis of a joint is drawn: its own place, and where it meets others."""
        return [self._view.page(self._centre(turn) or turn.at)]

    def _centre(self, turn: Turn) -> Point | None:
        """The point in space in which this axis meets others, where these joints are drawn as one; None for others."""
        if self._view.is_planar or turn.label == 0:
            return None
        meetings = [place for place, names in self._scene.meetings if turn.label in names]
        others = [
            t for t in self._scene.turns if t.label != 0 and np.any(np.abs(np.cross(t.axis, turn.axis)) > _PARALLEL)
        ]
        return meetings[0] if meetings else turn.at if any(np.allclose(t.at, turn.at) for t in others) else None

    def _is_on_belt(self, slide: Slide) -> bool:
        return self._scene.belt is not None and not slide.has_arrow

    def _frames_and_names(self, joints: list[tuple[Turn, Vector, float]]) -> None:
        view, scene, sheet = self._view, self._scene, self._sheet
        base, tool = triad(ORIGIN, style.FRAME, 1.8, view), triad(scene.tool, 0.72 * style.FRAME, 2.8, view)
        arrows = [list(slide_arrow(s, self._rails[s], view, is_beside=bool(scene.segments))) for s in scene.slides]
        sheet.draw(mark for marks in (*arrows, *(m for _, m in (*base, *tool))) for mark in marks)
        for turn, at, radius in joints:
            if turn.label != 0:
                name_turn(sheet, view, turn, self._spelled(turn.label), at, radius)
        for slide, marks in zip(scene.slides, arrows, strict=True):
            tips = [np.array(mark.points[0]) for mark in marks if isinstance(mark, Area)]
            end = view.page(self._ends_of(slide))
            name_slide(sheet, view, slide, self._spelled(slide.label), tips[0] if tips else end)
        name_axes(sheet, "XYZ", base)
        name_axes(sheet, "xyz", tool)
        places = around(view.page(scene.tool.position), (24.0, 34.0, 46.0, 60.0))
        sheet.label("TCP", style.LABEL, style.INK, places, is_bold=True)

    def _anchored(self, turn: Turn) -> tuple[Vector, float]:
        """The position on its axis at which a joint covers no other; in a plane its arrow is larger instead."""
        centre, radius, along = self._centre(turn), style.ARC_RADIUS, self._view.direction(turn.axis)
        at = self._view.page(centre or turn.at)
        shifts = _SHIFTS if centre is None else tuple(self._side(turn, centre) * s - BESIDE for s in _AROUND)
        for shift in shifts:
            place = at + shift * along
            seen = place if centre is None else place + BESIDE * along
            if self._is_inside(seen) and all(np.linalg.norm(seen - other) > _CLOSE for other in self._taken):
                self._taken.append(seen)
                return place, radius
        self._taken.append(at)
        alike = sum(1 for other in self._taken if np.linalg.norm(other - at) < 1.0)
        return at, radius + 13.0 * (alike - 1)

    def _side(self, turn: Turn, centre: Point) -> int:
        """On which side of the centre an axis has its arrow: the first one on the side of the body in front of the
        joints, the others on that of the body behind them.
        """
        is_first = next(t for t in self._scene.turns if self._centre(t) == centre) is turn
        bodies = [(s.start, s.end) if is_first else (s.end, s.start) for s in self._scene.segments]
        far = next((one for one, at in bodies if np.allclose(at, centre) and np.subtract(one, at) @ turn.axis), turn.at)
        return -1 if np.subtract(far, centre) @ turn.axis < -1e-6 else 1

    def _is_inside(self, place: Vector) -> bool:
        box, room = self._sheet.box, 20.0
        x, y = (float(v) for v in place)
        return box.left + room < x < box.right - room and box.bottom + room < y < box.top - room

    def _order(self, segment: Segment) -> tuple[bool, float]:
        """The sort key of a segment: the base first, then from far to near."""
        depth = sum(float(self._view.eye @ np.array(p)) for p in (segment.start, segment.end))
        return segment.body is not Body.BASE, round(depth, 6)

    def _length(self, dimension: Dimension) -> float:
        return round(float(np.linalg.norm(self._view.page(dimension.end) - self._view.page(dimension.start))), 3)

    def _spelled(self, label: sp.Expr) -> str:
        return spelled(label, self._names)
