"""Pages of the viewer: made, opened, and what is seen on them."""

import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import softkin
from PIL import Image

from derive.command.catalogue import OUTPUT
from derive.command.view import PACKAGES, content_of
from derive.emit.language import RUNTIME, Part
from derive.importing import meshes
from derive.view.page import Content, page
from tests.javascript.modules import files_of, part_of, written
from tests.mechanisms import catalogue
from tests.outside import output_of

_CORNERS = ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0))


def triangle() -> bytes:
    """A triangle with legs of 0.1, whose node is called "own"."""
    triangles = np.array([[0, 1, 2]], dtype=np.uint32)
    return meshes.glb([meshes.Part(meshes.Body("own"), np.array(_CORNERS), triangles, None)])


def catalogue_page(folder: Path, modules: Mapping[str, bytes]) -> Path:
    files = {name: data for name, data in sorted(modules.items()) if name.endswith(".js")}
    path = folder / "softkin.html"
    path.write_text(page(content_of(catalogue(), files), PACKAGES), encoding="utf-8")
    return path


def machine_page(folder: Path, name: str) -> Path:
    path = folder / "machine.html"
    files = {path: text.encode() for path, text in files_of(part_of(name)).items() if path.endswith(".js")}
    content = Content(name, files, "softkin", {name: ""}, reports={name: ""})
    path.write_text(page(content, PACKAGES), encoding="utf-8")
    return path


def own_page(folder: Path) -> Path:
    """The page of a machine of a user, as the command line makes it, and beside it, in `python`, its package.

    A1 has limits; A2 is a mesh in metres; the second link is called as no keyword of Python can be.
    """
    (folder / "own.glb").write_bytes(triangle())
    run_derive(folder, "new", "my_machine.py")
    path = folder / "my_machine.py"
    text = path.read_text(encoding="utf-8").replace('"link_length_2"', '"lambda"')
    path.write_text(text.replace('"Arm 1 about Z")', '"Arm 1 about Z", limits=(-150, 150))'), encoding="utf-8")
    run_derive(folder, "derive", "my_machine.py", "--out", "pages", "--language", "python")
    run_derive(folder, "view", "my_machine.py", "--out", "pages", "--model", "A2=own.glb*1000")
    return folder / "pages" / "my_machine.html"


def run_derive(folder: Path, *arguments: str) -> str:
    """Run a command; what it prints."""
    command = [sys.executable, "-m", "derive", *arguments]
    environment = {"PYTHONPATH": str(OUTPUT.parent), "PATH": "", "HOME": str(folder)}
    return output_of(command, cwd=folder, env=environment)


ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "build" / "view" / "laptop_light.png"
TARGET = ROOT / "docs" / "viewer.png"
COLOURS = 160


def main() -> None:
    """Write the picture with few colours, so that it is small."""
    with Image.open(SOURCE) as picture:
        picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(TARGET, optimize=True)


if __name__ == "__main__":
    main()


Seen = dict[str, Any]
ARM = "Kin_ArticulatedRobot_6DOF"


def robot_of(state: Seen) -> Any:
    return softkin.catalogue()[state["machine"]](**state["parameters"], limits=state["limits"])


def frame_of(state: Seen) -> Any:
    return state["frame"]["position"], state["frame"]["rotation"]


def confirm(state: Seen) -> None:
    """Python finds the same frame and configuration at the axes, and these axes from both; the fields show them."""
    robot = robot_of(state)
    frame, configuration = robot.forward(state["axes"])
    assert np.allclose(frame.position, state["frame"]["position"], rtol=0, atol=1e-9)
    assert np.allclose(frame.rotation, state["frame"]["rotation"], rtol=0, atol=1e-12)
    assert list(configuration) == state["configuration"]
    axes = robot.inverse(frame, configuration, reference=state["axes"])
    assert np.allclose(axes, state["axes"], rtol=0, atol=1e-8)
    shown = [float(text) for text in state["shownAxes"]]
    assert np.allclose(shown, state["axes"], rtol=0, atol=6e-5)
    margins = robot.singularity(state["axes"]).margins
    assert margins.keys() == state["margins"].keys()
    assert np.allclose(list(margins.values()), list(state["margins"].values()), rtol=0, atol=1e-11)


ASKED = Path(__file__).with_name("model.mjs")


def page_module(part: Part) -> Path:
    machines = written(part).parent
    folder = machines / "page"
    shutil.copytree(RUNTIME / "view", folder, ignore=shutil.ignore_patterns("package*"))
    (folder / "machines").symlink_to(machines, target_is_directory=True)
    (folder / "package.json").write_text('{"type": "module"}', encoding="utf-8")
    return Path(shutil.copy(ASKED, folder))
