"""Meshes of a URDF: where an independent reader has them, on the body that moves as their link; what is left out."""

import json
import shutil
import struct
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from derive.command.line import main
from derive.importing import meshes
from derive.importing.importing import Imported, imported_meshes
from derive.importing.meshes import Meshes
from tests.importing.kinematics import by_yourdfpy, imported, imported_text
from tests.importing.robots import joint, urdf
from tests.orthonormal import rodrigues

Array = NDArray[np.float64]
X, Y, Z = np.eye(3)
CORNERS = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.2]])
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
ARM = urdf(
    "arm",
    joint("turn", "revolute", "0 0 0.4", "0 0 0.3"),
    joint("lift", "revolute", "0.1 0 0", axis="0 1 0"),
    joint("plate", "fixed", "0 0.02 0.5", "0 0.2 0"),
    joint("bend", "revolute", axis="0 1 0"),
    joint("tool", "fixed", "0 0 0.1"),
)
PLACED = '<origin xyz="0.01 0.02 0.03" rpy="0.1 0.2 0.3"/>'
SHAPES = {
    "link0": '<mesh filename="package://arm_description/meshes/Binary%20one.STL"/>',
    "link1": '<mesh filename="meshes/ascii.stl" scale="2 1 0.5"/>',
    "link2": '<mesh filename="meshes/one.obj" scale="-1 1 1"/>',
    "link3": '<box size="0.1 0.2 0.3"/>',
    "link4": '<mesh filename="meshes/inches.dae"/>',
}


def binary(corners: Array, faces: Any) -> bytes:
    """A binary STL."""
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *corners[list(face)].ravel(), 0) for face in faces)
    return bytes(80) + struct.pack("<I", len(faces)) + rows


def ascii_stl(corners: Array, faces: Any) -> str:
    """The same as text."""
    facet = "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n"
    rows = ["".join(f"vertex {x:g} {y:g} {z:g}\n" for x, y, z in corners[list(face)]) for face in faces]
    return f"solid one\n{''.join(map(facet.format, rows))}endsolid one\n"


def obj(corners: Array, faces: Any) -> str:
    """The same as OBJ, with a library of materials that nobody should look for."""
    points = "".join(f"v {x:g} {y:g} {z:g}\n" for x, y, z in corners)
    return f"mtllib /etc/hostname\n{points}" + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces)


def dae(corners: Array, faces: Any) -> str:
    """The same as COLLADA in inches, blue, with an axis Y that points up, which no reader of robots follows."""
    points = " ".join(f"{value / 0.0254:.9g}" for value in corners.ravel())
    return f"""<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.0254" name="inch"/><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse><color>0 0 1 1</color></diffuse>
</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">{points}</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION"
source="#p"/></vertices><triangles count="4" material="s"><input semantic="VERTEX" source="#v" offset="0"/>
<p>{" ".join(str(k) for face in faces for k in face)}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>"""


def robot(folder: Path, shapes: Mapping[str, str] = SHAPES, text: str = ARM) -> Path:
    """A robot file in a package, with a shape on some of its links, and the files of its meshes."""
    package = folder / "arm_description"
    files = package / "meshes"
    shutil.rmtree(package, ignore_errors=True)
    files.mkdir(parents=True)
    (files / "Binary one.STL").write_bytes(binary(CORNERS, FACES))
    (files / "ascii.stl").write_text(ascii_stl(CORNERS, FACES))
    (files / "one.obj").write_text(obj(CORNERS, FACES))
    (files / "inches.dae").write_text(dae(CORNERS, FACES))
    for link, shape in shapes.items():
        visual = f"<visual>{PLACED}<geometry>{shape}</geometry></visual>"
        text = text.replace(f'<link name="{link}"/>', f'<link name="{link}">{visual}</link>')
    path = package / "arm.urdf"
    path.write_text(text, encoding="utf-8")
    return path


def taken(path: Path, unit: str = "mm", **options: object) -> tuple[Imported, Meshes]:
    """An imported robot with its meshes."""
    found = imported(path, unit=unit, **options)
    return found, imported_meshes(path, found, unit)


def content_of(data: bytes) -> tuple[dict[str, Any], bytes]:
    """The text and the numbers of a binary glTF."""
    size = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def nodes_of(data: bytes) -> dict[tuple[str, int], Array]:
    """By body and number: the corners of its triangles, row by row."""
    content, blob = content_of(data)

    def values(place: int) -> NDArray[Any]:
        accessor = content["accessors"][place]
        view = content["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5123: "<u2", 5125: "<u4"}[accessor["componentType"]]
        return np.frombuffer(blob[view["byteOffset"] :][: view["byteLength"]], kind)

    found = {}
    for node in content["nodes"]:
        shapes = [(p["attributes"]["POSITION"], p["indices"]) for p in content["meshes"][node["mesh"]]["primitives"]]
        points = [values(place).reshape(-1, 3)[values(index)] for place, index in shapes]
        found[node["extras"]["name"], node["extras"]["number"]] = np.concatenate(points).astype(float)
    return found


ORIGIN = np.eye(4)
ORIGIN[:3, :3] = rodrigues(Z, 0.3) @ rodrigues(Y, 0.2) @ rodrigues(X, 0.1)
ORIGIN[:3, 3] = (0.01, 0.02, 0.03)
BOX = np.array(list(product((-0.05, 0.05), (-0.1, 0.1), (-0.15, 0.15))))
POINTS: Mapping[str, Array] = {
    "link0": CORNERS,
    "link1": CORNERS * (2.0, 1.0, 0.5),
    "link2": CORNERS * (-1.0, 1.0, 1.0),
    "link3": BOX,
    "link4": CORNERS,
}
"""By link: the points of its shape, in metres and in the frame of the shape."""
LINKS = {("base", 0): ("link0",), ("A1", 0): ("link1",), ("A2", 0): ("link2", "link3"), ("A3", 0): ("link4",)}


def points_of(path: Path, link: str, points: Array, values: Mapping[str, float]) -> Array:
    """The points of a shape in the frame of the base (metres), the link by a reader that shares nothing with ours."""
    frame = by_yourdfpy(path, "link0", link)(values) @ ORIGIN
    return np.asarray(points @ frame[:3, :3].T + frame[:3, 3])


@pytest.mark.parametrize(("unit", "scale"), [("mm", 1000.0), ("m", 1.0)])
def test_they_stand_where_an_independent_reader_has_them(unit: str, scale: float, tmp_path: Path) -> None:
    """Binary and written STL, OBJ, COLLADA, a box: with origins, scales, mirrored, in inches, on fixed joints."""
    path = robot(tmp_path)
    _, found = taken(path, unit)
    ours = nodes_of(found.data)
    assert ours.keys() == LINKS.keys()
    for body, names in LINKS.items():
        wanted = scale * np.concatenate([points_of(path, name, POINTS[name], {}) for name in names])
        apart = np.linalg.norm(ours[body][:, None] - wanted, axis=2)
        assert apart.min(axis=0).max() < 1e-6 * scale and apart.min(axis=1).max() < 1e-6 * scale, body
    assert found.report == ("Meshes: 5 shapes of 28 triangles; 0.0 MB in the page.",)


@pytest.mark.parametrize(
    ("shape", "half"),
    [('<cylinder radius="0.03" length="0.2"/>', (0.03, 0.03, 0.1)), ('<sphere radius="0.03"/>', (0.03, 0.03, 0.03))],
)
def test_round_shapes(shape: str, half: Sequence[float], tmp_path: Path) -> None:
    _, found = taken(robot(tmp_path, {"link0": shape}), "m")
    inside = (nodes_of(found.data)["base", 0] - ORIGIN[:3, 3]) @ ORIGIN[:3, :3]
    assert np.allclose(np.abs(inside).max(axis=0), half, rtol=0.01)


def test_a_mirrored_mesh_is_seen_from_outside(tmp_path: Path) -> None:
    """The normals of its triangles point away from its middle."""
    _, found = taken(robot(tmp_path, {"link2": SHAPES["link2"]}))
    a, b, c = nodes_of(found.data)["A2", 0].reshape(-1, 3, 3).transpose(1, 0, 2)
    middle = (a + b + c).mean(axis=0) / 3
    assert np.all(np.einsum("ij,ij->i", np.cross(b - a, c - a), a - middle) > 0)


def test_colours_are_those_of_the_mesh_then_of_the_file(tmp_path: Path) -> None:
    """A COLLADA file is blue; a material of the robot file colours a mesh without; without any it has the body's."""
    path = robot(tmp_path)
    text = path.read_text().replace("</robot>", '<material name="green"><color rgba="0 1 0 1"/></material></robot>')
    path.write_text(
        text.replace("</visual>", '<material name="green"/></visual>').replace('<material name="green"/>', "", 1)
    )
    content, _ = content_of(taken(path)[1].data)
    colours = [
        [
            content["materials"][p["material"]]["pbrMetallicRoughness"]["baseColorFactor"]
            for p in mesh["primitives"]
            if "material" in p
        ]
        for mesh in content["meshes"]
    ]
    assert colours == [[], [[0, 1, 0, 1]], [[0, 1, 0, 1]], [[0, 0, 1, 1]]]


HOSTILE = {
    "it is not there": ('<mesh filename="package://arm_description/meshes/none.stl"/>', "is not there"),
    "of another computer": ('<mesh filename="https://example.org/a.stl"/>', "is not on this computer"),
    "no mesh": ('<mesh filename="arm.urdf"/>', "is none of .stl, .obj, .dae"),
    "broken": ('<mesh filename="meshes/broken.dae"/>', "broken.dae cannot be read"),
    "a device": ('<mesh filename="file:///dev/zero"/>', "is not there"),
    "no name": ("<mesh/>", "'' is not there"),
    "a long name": (f'<mesh filename="{"a" * 5000}.stl"/>', "aaa…' is not there"),
    "control characters": ('<mesh filename="&#10;&#9;a.stl"/>', "is not there"),
    "markup": ('<mesh filename="&lt;/script&gt;&quot;.stl"/>', "is not there"),
    "no number": ('<mesh filename="meshes/ascii.stl" scale="1 two 3"/>', "'two' is no number"),
    "far away": ('<mesh filename="meshes/far.obj" scale="1e6 1e6 1e6"/>', "its numbers are too large"),
    "unknown": ("<capsule/>", "<capsule> is no shape that is read"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_what_cannot_be_read_is_a_line(name: str, tmp_path: Path) -> None:
    """Never a refusal: the others are taken."""
    shape, told = HOSTILE[name]
    path = robot(tmp_path, {"link1": shape, "link3": SHAPES["link3"]})
    (path.parent / "meshes" / "broken.dae").write_text("<COLLADA")
    (path.parent / "meshes" / "far.obj").write_text(obj(1e9 * CORNERS, FACES))
    _, found = taken(path)
    left, read = found.report
    assert left.startswith("Left out: a shape of link 'link1': ") and told in left and len(left) < 200
    assert read == "Meshes: 1 shapes of 12 triangles; 0.0 MB in the page."


def test_links_beside_the_chain(tmp_path: Path) -> None:
    """Behind a joint that is not between base and tip a link stands at zero; one that follows an axis is left out."""
    hanging = '<joint name="{}" type="revolute"><parent link="link2"/><child link="{}"/>{}</joint><link name="{}"/>'
    more = hanging.format("finger", "f", '<origin xyz="0 0 0.1"/>', "f")
    more += hanging.format("bar", "b", '<mimic joint="lift" multiplier="-1"/>', "b")
    path = robot(tmp_path, {"f": SHAPES["link3"], "b": SHAPES["link3"]}, ARM.replace("</robot>", f"{more}</robot>"))
    _, found = taken(path, base="link0", tip="link5")
    assert list(nodes_of(found.data)) == [("A2", 0)]
    assert found.report[0].startswith("Left out: the shapes behind joint 'bar', which follows an axis beside the chain")
    wanted = 1000.0 * points_of(path, "f", BOX, {})
    apart = np.linalg.norm(nodes_of(found.data)["A2", 0][:, None] - wanted, axis=2)
    assert apart.min(axis=0).max() < 1e-3 and apart.min(axis=1).max() < 1e-3


def test_many_triangles_are_simplified(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The page has a bound; what was left is said, and looks the same."""
    path = robot(tmp_path, {"link1": '<mesh filename="meshes/ball.stl"/>', "link4": SHAPES["link4"]})
    ball = trimesh.creation.icosphere(5, 0.1)
    (path.parent / "meshes" / "ball.stl").write_bytes(binary(np.asarray(ball.vertices), np.asarray(ball.faces)))
    whole = taken(path)[1]
    monkeypatch.setattr(meshes, "TRIANGLES", 2000)
    found = taken(path)[1]
    assert whole.report[-1].startswith("Meshes: 2 shapes of 20,484 triangles; 0.3 MB")
    assert found.report[-1].startswith("Meshes: 2 shapes of 20,484 triangles, simplified to 2,0")
    assert len(found.data) < 0.15 * len(whole.data)
    one, other = (nodes_of(data)["A1", 0] for data in (found.data, whole.data))
    assert np.allclose(one.max(axis=0), other.max(axis=0), rtol=0, atol=2.0)
    assert np.allclose(one.min(axis=0), other.min(axis=0), rtol=0, atol=2.0)


@pytest.mark.parametrize(
    "counts", [[90_000, 90_000], [5, 200_000, 7], [1_000] * 500, [10, 20], [99_999, 1], [1] * 100_000]
)
def test_all_together_keep_to_the_bound(counts: list[int]) -> None:
    """Small shapes stay whole; what the large ones have is used up, but for the rest of a division."""
    most = meshes._most(counts)
    kept = sum(min(count, most) for count in counts)
    assert kept <= meshes.TRIANGLES and kept > min(sum(counts), meshes.TRIANGLES) - len(counts)


def test_limits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that is too large, and shapes that are too many, are left out, with the bound."""
    path = robot(tmp_path)
    monkeypatch.setattr(meshes, "_LARGEST_FILE", 10)
    assert all("has more than 0 MB" in line for line in taken(path)[1].report[:4])
    monkeypatch.undo()
    monkeypatch.setattr(meshes, "_MOST_SHAPES", 2)
    assert taken(path)[1].report[0] == "Left out: 3 shapes; 2 are read."


def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """It names the files that it writes, replaces none, and says which package reads meshes."""
    arguments = ["import", str(robot(tmp_path)), "--out", str(tmp_path / "own.py"), "--meshes"]
    (tmp_path / "own.glb").write_bytes(b"mine")
    assert main(arguments) == 2 and not (tmp_path / "own.py").exists()
    assert "own.glb: exists, and may have been edited: name another file with --out" in capsys.readouterr().err
    (tmp_path / "own.glb").unlink()
    monkeypatch.setattr(meshes, "_NEEDED", ("no_reader",))
    assert main(arguments) == 2
    wanted = "--meshes needs the package no_reader: pip install 'softkin-compiler[view]'"
    assert wanted in capsys.readouterr().err
    monkeypatch.undo()
    assert main(arguments) == 0 and (tmp_path / "own.glb").read_bytes().startswith(b"glTF")
    assert f"`softkin view {tmp_path / 'own.py'}` shows it on the machine" in capsys.readouterr().out


def test_only_a_urdf_has_them(tmp_path: Path) -> None:
    rows = "".join(
        f"A{k},{d},{a},{alpha},-9,9\n" for k, d, a, alpha in ((1, 100, 0, 90), (2, 0, 200, 0), (3, 0, 150, 0))
    )
    text = f"# convention: standard\n# angles: degrees\n# lengths: mm\nname,d,a,alpha,lower,upper\n{rows}"
    path = tmp_path / "arm.csv"
    found = imported_text(path, text)
    assert imported_meshes(path, found, "mm") == Meshes(b"", ("No mesh was read: meshes are taken from a URDF alone.",))
