"""Every Python listing of the guides and the README runs: as a program, or in the context that the guide gives."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from derive.command.line import main
from derive.description.catalogue import load
from derive.description.mechanism import Mechanism
from derive.mechanisms.kin_scara4_zccoupled_type1 import MECHANISM as SCARA
from derive.pipeline import derive_one

ROOT = Path(__file__).resolve().parents[2]
RUN_ELSEWHERE = ("CALIBRATION.md", "COMPILER.md", "GALLERY.md", "PYTHON.md")
"""test_compiler_guide, test_gallery and test_python_guide run these; test_guide runs what begins with the name of a
file."""
LISTINGS = [
    (path.name, text)
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
    if path.name not in RUN_ELSEWHERE
    for text in re.findall(r"```python\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL)
    if not re.match(r"# \w+\.py\n", text)
]
PLATFORM = """
from sympy import cos, pi, sin
from derive.mechanism import Mechanism, Task, Turning, guide, length, linear, on_plate, rod
BASE, PLATE = length("base_radius", "Base", nominal=300.0), length("plate_radius", "Plate", nominal=200.0)
CORNERS = [(PLATE * cos(2 * pi * k / 3), PLATE * sin(2 * pi * k / 3), 0) for k in range(3)]
FEET = [(BASE * cos(2 * pi * k / 3), BASE * sin(2 * pi * k / 3), 0) for k in range(3)]
LEGS = [linear(f"L{k}", f"Leg {k}", domain=(0.0, 1e9), nominal=460.0) for k in (1, 2, 3)]
"""
PLATFORM_USES = """
MECHANISM = Mechanism(
    name="TiltingTable", parameters=(BASE, PLATE), joints=tuple(LEGS), task=Task("z", Turning.DIRECTION),
    guides=guides, home=home, positive=tuple(LEGS),
    rods=tuple(rod(str(k), a, on_plate(*b), l) for k, (a, b, l) in enumerate(zip(FEET, CORNERS, LEGS), 1)),
)
"""
SCARA_GIVEN = """
from sympy import sin
from derive.frames import Rz, Tx, Tz
from derive.mechanism import TURN, Mechanism, Task, Turning, branch, helical, length, linear, pitch, rotary
from derive.mechanisms.kin_scara4_zccoupled_type1 import L1, L2, P
"""
GIVEN: Mapping[tuple[str, str], tuple[str, str]] = {
    ("README.md", 'A1 = rotary("A1", "Arm 1 about Z", …)'): (SCARA_GIVEN, ""),
    ("README.md", "import softkin"): ("", ""),
    ("OWN_MACHINE.md", "from derive import compile_mechanism"): ("", ""),
    ("OWN_MACHINE.md", "guides = tuple("): (PLATFORM, PLATFORM_USES),
}
"""What stands before and behind a fragment, by its document and its first line."""


def _run(document: str, first: str) -> dict[str, Any]:
    (text,) = [text for name, text in LISTINGS if (name, text.split("\n")[0]) == (document, first)]
    before, behind = GIVEN[document, first]
    names: dict[str, Any] = {}
    exec(compile(before + text.replace(", …", ",") + behind, document, "exec"), names)
    return names


def test_every_listing_has_its_context() -> None:
    assert {(name, text.split("\n")[0]) for name, text in LISTINGS} == set(GIVEN) and len(LISTINGS) == len(GIVEN)


def test_the_description_in_the_readme_is_that_of_the_catalogue() -> None:
    shown: Mechanism = _run("README.md", 'A1 = rotary("A1", "Arm 1 about Z", …)')["MECHANISM"]
    assert (shown.chain, shown.task, shown.branches) == (SCARA.chain, SCARA.task, SCARA.branches)
    assert (shown.name, shown.parameters, shown.periods) == (SCARA.name, SCARA.parameters, SCARA.periods)


def test_the_program_of_the_readme_prints_what_it_says(capsys: pytest.CaptureFixture[str]) -> None:
    _run("README.md", "import softkin")
    shown = re.search(r"```text\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert shown and capsys.readouterr().out == shown[1]


def test_a_description_becomes_a_class(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "my_machine.py"]) == 0
    made = _run("OWN_MACHINE.md", "from derive import compile_mechanism")["MyMachine"]
    given = {p.name: p.nominal for p in load(tmp_path / "my_machine.py").parameters}
    assert made(**given).forward((10.0,) * len(made.AXES))[0].position


@pytest.mark.slow
def test_the_planes_of_a_platform_derive() -> None:
    derived = derive_one(_run("OWN_MACHINE.md", "guides = tuple(")["MECHANISM"])
    assert derived.evidence is not None


def test_a_comma_too_many_is_no_refusal() -> None:
    """Keyword arguments that were pasted as statements end with a comma, and hold a tuple in a tuple."""
    names = _run("OWN_MACHINE.md", "guides = tuple(")
    stated = vars(names["MECHANISM"])
    fields = {k: stated[k] for k in ("name", "parameters", "joints", "task", "rods", "positive")}
    again = Mechanism(**fields, guides=(names["guides"],), home=(names["home"],))
    assert (again.guides, again.home) == (stated["guides"], stated["home"])
