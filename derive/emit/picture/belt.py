"""A belt on its frame: the rails and the beam, the belt around its wheels, and the motors with their senses."""

from __future__ import annotations

import numpy as np

from derive.drawing.scene import Belt, Point
from derive.emit.picture import style
from derive.emit.picture.ink import Mark, Vector, area, arrow, line
from derive.emit.picture.symbols import bar, basis
from derive.emit.picture.view import View

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
