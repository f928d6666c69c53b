"""The meshes of a robot file for the viewer: read, joined by the bodies of the description, simplified, in one glTF."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import numpy as np
from numpy.typing import NDArray

from derive.description.joints import Kind
from derive.importing.arms.lines import Line, arm_of, moved
from derive.importing.arms.pieces import Simple
from derive.importing.formats.documents import number, numbers, shown
from derive.importing.formats.visuals import Colour, Visual, visuals_of
from derive.importing.robot import Array, Robot, UnreadableRobot

_SUFFIXES = (".stl", ".obj", ".dae")
_LARGEST_FILE = 200_000_000
"""Bytes of a mesh file; a larger one is left out."""
_MOST_SHAPES = 500
TRIANGLES = 100_000
"""Of all meshes together: if there are more, the shapes with the most are simplified."""
_NEEDED = ("trimesh", "fast_simplification", "collada")
Indices = NDArray[np.uint32]


@dataclass(frozen=True)
class Move:
    """A movement along or about a directed line, by multiples of joint values: numbers of axes, with multipliers."""

    is_slide: bool
    at: tuple[float, ...]
    along: tuple[float, ...]
    drives: tuple[tuple[int, float], ...]


@dataclass(frozen=True)
class Body:
    """A body of a machine: the axes that move it against the one before it, and which of the bodies of that name."""

    name: str
    number: int = 0
    moves: tuple[Move, ...] = ()
    """The movements of the file by which a link moves against that body, where no body of the machine moves as it does:
    slides, and turns beside them, have an order of their own in a description.
    """


@dataclass(frozen=True)
class Part:
    """Triangles of one colour, in the frame of the base, all axes at zero."""

    body: Body
    points: Array
    triangles: Indices
    colour: Colour | None


@dataclass(frozen=True)
class Meshes:
    """The meshes of a robot: a binary glTF, empty if none could be read, and sentences for the report."""

    data: bytes
    report: tuple[str, ...]


def meshes_of(path: Path, robot: Robot, axes: Sequence[str], chain: Simple, scale: float, slack: float) -> Meshes:
    """The meshes of a URDF, by the bodies of the chain that was written.

    scale: our unit in metres. slack: how far the chain may be from the file, in our unit. What cannot be read is a
    sentence. Raises `UnreadableRobot` if the packages that read meshes are not there.
    """
    for name in _NEEDED:
        try:
            import_module(name)
        except ImportError:
            raise UnreadableRobot(f"--meshes needs the package {name}: pip install 'softkin-compiler[view]'") from None
    visuals, left = visuals_of(path, robot, scale)
    bodies = _bodies(robot, axes, chain, slack)
    read = lru_cache(maxsize=None)(_read)
    parts: list[Part] = []
    said = list(left)
    for visual in visuals[:_MOST_SHAPES]:
        try:
            parts += _parts(path, visual, bodies[visual.movers], read, scale)
        except UnreadableRobot as problem:
            said.append(f"Left out: a shape of link {visual.link!r}: {problem}.")
    if len(visuals) > _MOST_SHAPES:
        said.append(f"Left out: {len(visuals) - _MOST_SHAPES} shapes; {_MOST_SHAPES} are read.")
    if not parts:
        return Meshes(b"", (*said, "No mesh was read."))
    before = sum(len(part.triangles) for part in parts)
    parts = list(_simplified(parts))
    data = glb(parts)
    after = sum(len(part.triangles) for part in parts)
    less = f", simplified to {after:,}" if after < before else ""
    text = f"Meshes: {len(parts)} shapes of {before:,} triangles{less}; {4 / 3 * len(data) / 1e6:.1f} MB in the page."
    return Meshes(data, (*said, text))


def _bodies(robot: Robot, axes: Sequence[str], chain: Simple, slack: float) -> list[Body]:
    """By the number of moving joints passed: the body of the chain that moves as what is behind them, or the last one
    before it that does, and the movements since.
    """
    lines = arm_of(robot).lines
    rng = np.random.default_rng(5)
    rows = [np.zeros(len(axes)), *rng.uniform(-1.0, 1.0, (3, len(axes)))]
    known: list[tuple[Body, list[Array]]] = [(Body("base"), [np.eye(4)] * len(rows))]
    frames = [np.eye(4)] * len(rows)
    for piece in chain.pieces:
        frames = [frame @ piece.matrix(row) for frame, row in zip(frames, rows, strict=True)]
        if piece.drives:
            name = " ".join(axes[k] for k, _ in sorted(piece.drives))
            same = sum(body.name == name for body, _ in known)
            known.append((Body(name, same), [frame @ np.linalg.inv(frames[0]) for frame in frames]))
    found = [Body("base")]
    motions = [np.eye(4)] * len(rows)
    for line in lines:
        motions = [
            motion @ moved(line, sum(row[k] * multiplier for k, multiplier in line.drives))
            for motion, row in zip(motions, rows, strict=True)
        ]
        away, body = min(((_apart(motions, frames), body) for body, frames in known), key=lambda one: one[0])
        found.append(body if away <= slack else replace(found[-1], moves=(*found[-1].moves, _move(line))))
    return found


def _move(line: Line) -> Move:
    return Move(line.kind is Kind.LINEAR, tuple(line.point.tolist()), tuple(line.direction.tolist()), line.drives)


def _apart(motions: Sequence[Array], others: Sequence[Array]) -> float:
    return max(float(np.abs(one - other).max()) for one, other in zip(motions, others, strict=True))


def _parts(
    path: Path, visual: Visual, body: Body, read: Callable[[Path], tuple[Any, ...]], scale: float
) -> Iterator[Part]:
    for mesh, colour, unit in _shapes(path, visual, read):
        frame = visual.place.copy()
        frame[:3, :3] = frame[:3, :3] * (unit * scale)
        points = np.asarray(mesh.vertices, dtype=float) @ frame[:3, :3].T + frame[:3, 3]
        triangles = np.asarray(mesh.faces, dtype=np.uint32)
        if not len(triangles) or not np.all(np.abs(points) < 1e9):
            raise UnreadableRobot("its mesh has no triangles" if not len(triangles) else "its numbers are too large")
        is_mirrored = np.linalg.det(frame[:3, :3]) < 0.0
        yield Part(body, points, triangles[:, ::-1] if is_mirrored else triangles, colour or visual.colour)


def _shapes(path: Path, visual: Visual, read: Callable[[Path], tuple[Any, ...]]) -> Iterator[tuple[Any, Any, Array]]:
    """The meshes of a shape, each with its colour, and with its scale along x, y and z."""
    made = import_module("trimesh").creation
    one, shape = np.ones(3), visual.geometry
    if shape.tag == "mesh":
        by = np.array(numbers(path, shape, "scale", "its scale", (1.0, 1.0, 1.0)))
        for mesh, colour in read(_file(path, shape.get("filename", ""))):
            yield mesh, colour, by
    elif shape.tag == "box":
        yield made.box(extents=numbers(path, shape, "size", "its size", (1.0, 1.0, 1.0))), None, one
    elif shape.tag in ("cylinder", "sphere"):
        radius, height = (number(path, shape.get(word, "1"), word) for word in ("radius", "length"))
        is_ball = shape.tag == "sphere"
        yield made.icosphere(3, radius) if is_ball else made.cylinder(radius, height, sections=48), None, one
    else:
        raise UnreadableRobot(f"<{shown(shape.tag)[1:-1]}> is no shape that is read")


def _file(path: Path, name: str) -> Path:
    """The file of a mesh: an address on this computer, or a path from the robot file, or of a package."""
    address = urlsplit(name)
    if address.scheme not in ("", "file", "package", "model"):
        raise UnreadableRobot(f"{shown(name)} is not on this computer")
    is_below = address.scheme in ("package", "model")
    rest = unquote(address.path) if address.scheme else name
    tried = [path.parent / rest]
    if is_below:
        rest = rest.lstrip("/")
        tried = [place for above in path.resolve().parents for place in (above / address.netloc / rest, above / rest)]
    found = next((place for place in tried if _is_file(place)), None)
    if found is None:
        raise UnreadableRobot(f"{shown(name)} is not there")
    if found.suffix.lower() not in _SUFFIXES:
        raise UnreadableRobot(f"{shown(name)} is none of {', '.join(_SUFFIXES)}")
    if found.stat().st_size > _LARGEST_FILE:
        raise UnreadableRobot(f"{shown(name)} has more than {_LARGEST_FILE // 1_000_000} MB")
    return found


def _is_file(place: Path) -> bool:
    try:
        return place.is_file()
    except (OSError, ValueError):  # a name that no file can have
        return False


def _read(file: Path) -> tuple[tuple[Any, Colour | None], ...]:
    """The meshes of a file in metres, each with its colour. What it refers to, such as textures, is not read."""
    trimesh = import_module("trimesh")
    kind = file.suffix.lower()[1:]
    more = {"skip_materials": True} if kind == "obj" else {}
    try:
        scene = trimesh.load_scene(BytesIO(file.read_bytes()), file_type=kind, resolver=None, **more)
        unit = trimesh.units.unit_conversion(scene.units, "meters") if scene.units else 1.0
        found = []
        for node in scene.graph.nodes_geometry:
            frame, name = scene.graph[node]
            mesh = scene.geometry[name].copy()
            mesh.apply_transform(frame)
            mesh.apply_scale(unit)
            colour = getattr(getattr(mesh.visual, "material", None), "main_color", None) if kind == "dae" else None
            mesh.merge_vertices(merge_tex=True, merge_norm=True)
            found.append((mesh, None if colour is None else _share(colour)))
    except Exception as problem:  # whatever a library meets in a broken file
        raise UnreadableRobot(f"{file.name} cannot be read ({shown(str(problem) or type(problem).__name__)})") from None
    if not found:
        raise UnreadableRobot(f"{file.name} has no mesh")
    return tuple(found)


def _share(colour: NDArray[np.uint8]) -> Colour:
    red, green, blue = (float(part) / 255.0 for part in colour[:3])
    return (red, green, blue)


def _simplified(parts: Sequence[Part]) -> Iterator[Part]:
    most = _most([len(part.triangles) for part in parts])
    for part in parts:
        points, triangles = part.points, part.triangles
        if len(triangles) > most:
            simplify = import_module("fast_simplification").simplify
            points, triangles = simplify(points.astype(np.float32), triangles.astype(np.int32), target_count=most)
        yield Part(part.body, points, np.asarray(triangles, dtype=np.uint32), part.colour)


def _most(counts: Sequence[int]) -> int:
    """The most triangles that a shape may have, so that all together have no more than `TRIANGLES`."""
    left = TRIANGLES
    for k, count in enumerate(sorted(counts)):
        share = left // (len(counts) - k)
        if count > share:
            return share
        left -= count
    return TRIANGLES


def _joined(parts: Sequence[Part]) -> Iterator[Part]:
    """The parts of one body and one colour as one: each is drawn by a call of its own."""
    groups: dict[tuple[Body, Colour | None], list[Part]] = {}
    for part in parts:
        groups.setdefault((part.body, part.colour), []).append(part)
    for (body, colour), alike in groups.items():
        starts = np.cumsum([0, *(len(part.points) for part in alike)])
        triangles = [part.triangles + np.uint32(start) for part, start in zip(alike, starts, strict=False)]
        yield Part(body, np.concatenate([part.points for part in alike]), np.concatenate(triangles), colour)


def glb(parts: Sequence[Part]) -> bytes:
    """A binary glTF: a node for each body, named in its `extras`, with its triangles in the frame of the base."""
    blob = bytearray()
    views: list[dict[str, int]] = []
    accessors: list[dict[str, Any]] = []
    materials: list[dict[str, Any]] = []
    nodes: dict[Body, list[dict[str, Any]]] = {}

    def kept(data: bytes, **more: Any) -> int:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        blob.extend(data + bytes(-len(data) % 4))
        accessors.append({"bufferView": len(views) - 1, **more})
        return len(accessors) - 1

    for part in _joined(parts):
        points = part.points.astype("<f4")
        kind = ("<u2", 5123) if len(points) < 2**16 else ("<u4", 5125)
        ends = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
        place = kept(points.tobytes(), componentType=5126, count=len(points), type="VEC3", **ends)
        rows = part.triangles.astype(kind[0])
        index = kept(rows.tobytes(), componentType=kind[1], count=rows.size, type="SCALAR")
        shape: dict[str, Any] = {"attributes": {"POSITION": place}, "indices": index}
        if part.colour is not None:
            linear = [round(value**2.2, 4) for value in part.colour]
            paint = {
                "name": "painted",
                "pbrMetallicRoughness": {"baseColorFactor": [*linear, 1.0], "metallicFactor": 0.0},
            }
            if paint not in materials:
                materials.append(paint)
            shape["material"] = materials.index(paint)
        nodes.setdefault(part.body, []).append(shape)
    data = {
        "asset": {"version": "2.0", "generator": "softkin import --meshes"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": [{"mesh": k, "name": body.name, "extras": asdict(body)} for k, body in enumerate(nodes)],
        "meshes": [{"primitives": shapes} for shapes in nodes.values()],
        **({"materials": materials} if materials else {}),
        "buffers": [{"byteLength": len(blob)}],
        "bufferViews": views,
        "accessors": accessors,
    }
    text = json.dumps(data).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(blob), b"BIN\0") + bytes(blob)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
