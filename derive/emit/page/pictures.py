"""The pictures of a page: the machine as it is drawn, and in the poses where a margin vanishes."""

from __future__ import annotations

import io
from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from html import escape
from typing import Any

import matplotlib
import numpy as np
from markupsafe import Markup
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.figure import Figure

from derive.description.mechanism import DescriptionError
from derive.drawing.drawing import Drawing, drawing_of, scene_at
from derive.drawing.pose import Pose, drawn_pose, is_inside, nominal_machine, pose_at
from derive.drawing.scene import Scene
from derive.emit.picture import style
from derive.emit.picture.canvas import ALIKE, elements
from derive.emit.picture.ink import Mark
from derive.emit.picture.machine import Machine as Sketch
from derive.emit.picture.page import pages
from derive.emit.picture.view import Box
from derive.kinematics.kinematics import Kinematics
from derive.report.derived import Derived
from derive.report.reference_calls import Machine, margins
from derive.report.singular_poses import SingularPose, singular_pose
from derive.report.workspace_map import Slice, slices

_SIZE = (440.0, 340.0)
_TURNED = (25.0, 40.0, -30.0, 35.0, 50.0, 20.0)
"""Added to the drawn pose where it is singular itself, because a map of a singular pose is of no use."""
_SINGULAR = 1e-3


@dataclass(frozen=True)
class Pictured:
    """The machine, drawn."""

    machine: Machine
    pose: Pose | None
    drawing: Drawing | None
    picture: Markup
    undrawn: str
    """Why there is no picture; empty if there is one."""


def pictured(kinematics: Kinematics, names: Mapping[str, str]) -> Pictured:
    """The picture of a mechanism, as beside its block. names: the spelling of parameters."""
    machine = nominal_machine(kinematics)
    try:
        pose: Pose | None = drawn_pose(machine)
    except DescriptionError:
        pose = None
    try:
        drawing = drawing_of(kinematics)
        sheets = pages(drawing, kinematics.mechanism.block_name, names)
    except Exception as problem:  # the formulas are proven without a drawing, whatever its error
        return Pictured(machine, pose, None, Markup(""), " ".join(str(problem).split()))
    titles = (
        f"{kinematics.mechanism.block_name}: {what}" for what in ("joints, axes and dimensions", "configurations")
    )
    both = [drawn(s.marks, s.width, s.height, title) for s, title in zip(sheets, titles, strict=False)]
    return Pictured(machine, pose, drawing, Markup("").join(both), "")


@dataclass(frozen=True)
class Singularity:
    """A pose of the machine in which a margin vanishes, and its picture."""

    found: SingularPose | None
    picture: Markup
    axes: str


def singularities(found: Pictured, derived: Derived, names: Mapping[str, str]) -> Iterator[tuple[str, Singularity]]:
    """The margins by name, each with its pose."""
    kinematics = found.machine.kinematics
    start = found.pose.axes if found.pose is not None else tuple(j.shown for j in kinematics.mechanism.joints)
    for margin in kinematics.margins:
        at = singular_pose(found.machine, derived, margin.name, start)
        picture = Markup("") if at is None or found.drawing is None else _singular(found, at, names)
        axes_in_words = "" if at is None else ", ".join(_axes(kinematics, at))
        yield margin.name, Singularity(at, picture, axes_in_words)


def _axes(kinematics: Kinematics, at: SingularPose) -> Iterator[str]:
    for joint, value in zip(kinematics.mechanism.joints, at.axes, strict=True):
        yield f"{joint.name} = {round(value, 2) + 0.0:g}{'°' if joint.in_degrees else ''}"


def _singular(found: Pictured, at: SingularPose, names: Mapping[str, str]) -> Markup:
    scene = _scene(found.machine, at)
    if scene is None or found.drawing is None:
        return Markup("")
    turns = tuple(replace(t, zero=None) for t in scene.turns)
    bare = replace(scene, dimensions=(), arcs=(), spots=(), hidden=(), turns=turns)
    drawing = replace(found.drawing, scene=bare, choices=(), assembly=None)
    width, height = _SIZE
    marks = Sketch(drawing, Box(6.0, 6.0, width - 6.0, height - 6.0), names).drawn()
    return drawn(marks, width, height, f"the machine where {at.margin} is zero")


def _scene(machine: Machine, at: SingularPose) -> Scene | None:
    """The machine in this pose; if a bar has no direction there, in a pose very near to it."""
    for axes in (at.axes, at.beside):
        pose = pose_at(machine, axes) if at.frame is None else Pose(axes, at.frame, ())
        try:
            with np.errstate(invalid="ignore", divide="ignore"):
                if pose is not None:
                    return scene_at(machine, pose)
        except DescriptionError:
            continue
    return None


@dataclass(frozen=True)
class Map:
    """A slice of the workspace, in words and as a picture."""

    caption: str
    picture: Markup


def maps(found: Pictured) -> Iterator[Map]:
    """The maps of the workspace; none if no pose of the machine is drawn, or its task has too few coordinates."""
    if found.pose is None:
        return
    pose = _regular(found.machine, found.pose)
    for part in slices(found.machine, pose.frame, pose.axes):
        where = ", ".join(f"{c} = {round(v, 3) + 0.0:g}" for c, v in part.at)
        plane = f"plane {part.along[0]}, {part.along[1]}{f' at {where}' if where else ''}"
        axes = ", ".join(
            f"{j.name} = {round(v, 3) + 0.0:g}"
            for j, v in zip(found.machine.kinematics.mechanism.joints, pose.axes, strict=True)
        )
        turned = f"with the rotation of the tool at {axes}" if found.machine.kinematics.reads_rotation else ""
        if part.is_everywhere and not found.machine.kinematics.margins:
            yield Map(f"{plane}: every point is reached, with one solution.", Markup(""))
        else:
            yield Map(f"{plane} {turned}".rstrip() + ".", mapped(part, f"workspace, {plane}"))


def _regular(machine: Machine, pose: Pose) -> Pose:
    """The pose, or if it is singular one that is turned, inside the limits."""
    if not machine.kinematics.margins or float(np.abs(margins(machine, [pose.axes])).min()) > _SINGULAR:
        return pose
    joints = machine.kinematics.mechanism.joints
    shifts = [_TURNED[k % len(_TURNED)] if j.is_angle else 0.0 for k, j in enumerate(joints)]
    for part in (1.0, -1.0, 0.5, -0.5):
        turned = pose_at(machine, tuple(a + part * s for a, s in zip(pose.axes, shifts, strict=True)))
        if turned is not None and is_inside(machine, turned):
            return turned
    return pose


_SETTINGS: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "softkin",
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.edgecolor": style.FAINT,
    "image.interpolation": "nearest",
}
_COUNTS = ("#ffffff", "#c6dbef", "#9ecae1", "#6baed6", "#4292c6", "#2171b5", "#08519c", "#08306b", "#041c40")
"""The colours of no solution, one, two, and so on."""
_LEAST = 1e-3
"""Margins below this have the darkest colour: there a pose is singular."""


def drawn(marks: Iterable[Mark], width: float, height: float, title: str) -> Markup:
    """Marks as one element, in their order."""
    inside = "".join(elements(marks, height))
    return Markup(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" role="img" '
        f"{ALIKE}><title>{escape(title)}</title>{inside}</svg>"
    )


def mapped(found: Slice, title: str) -> Markup:
    """A slice as a picture: the number of solutions, and the margin of the best."""
    with matplotlib.rc_context(_SETTINGS):
        figure = Figure(figsize=(8.6, 4.1), dpi=100, layout="constrained", facecolor=style.PAPER)
        left, right = figure.subplots(1, 2)
        _counted(figure, left, found)
        _measured(figure, right, found)
        for axes in (left, right):
            axes.set_xlabel(f"{found.along[0]} [u]")
            axes.set_ylabel(f"{found.along[1]} [u]")
            axes.plot(*found.tool, marker="o", markersize=5, markerfacecolor="#ffffff", markeredgecolor="#c23b30")
            axes.plot(0.0, 0.0, marker="+", markersize=9, color="#c23b30")
            axes.set_xlim(*found.ends[0])
            axes.set_ylim(*found.ends[1])
        file = io.BytesIO()
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(file, metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    data = b64encode(file.getvalue()).decode()
    return Markup(f'<img alt="{escape(title)}" src="data:image/svg+xml;base64,{data}"/>')


def _counted(figure: Figure, axes: Any, found: Slice) -> None:
    most = max(int(found.solutions.max()), 1)
    colours = [_COUNTS[min(k, len(_COUNTS) - 1)] for k in range(most + 1)]
    norm = BoundaryNorm(np.arange(-0.5, most + 1), most + 1)
    image = _image(axes, found, found.solutions, cmap=ListedColormap(colours), norm=norm)
    axes.set_title("Number of solutions")
    figure.colorbar(image, ax=axes, ticks=sorted({*range(0, most + 1, max(1, most // 8)), most}), shrink=0.85)


def _measured(figure: Figure, axes: Any, found: Slice) -> None:
    values = np.where(np.isnan(found.margin), np.nan, np.maximum(found.margin, _LEAST))
    top = float(np.nanmax(values)) if np.isfinite(values).any() else 1.0
    image = _image(axes, found, values, cmap="viridis", norm=LogNorm(_LEAST, max(top, 10.0 * _LEAST)))
    axes.set_title("Smallest margin, of the best solution")
    figure.colorbar(image, ax=axes, shrink=0.85)


def _image(axes: Any, found: Slice, values: Any, **colours: Any) -> Any:
    (left, right), (low, high) = found.ends
    return axes.imshow(values, origin="lower", extent=(left, right, low, high), aspect="equal", **colours)
