"""What is written: one source that needs no other, without warnings under both versions and both standards."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from derive.emit.c import package as c
from derive.emit.language import runtime
from derive.emit.linuxcnc import package
from derive.emit.linuxcnc.words import LETTERS, Orientation, words_of
from derive.pipeline import Built, languages, unwritten
from tests.linuxcnc.machine import NAMES
from tests.linuxcnc.module import STRICT, STUBS, compiled, includes, loaded, part_of, run
from tests.machines.odd_names import ODD
from tests.mechanisms import kinematics_of, named
from tests.outside import written

ROOT = Path(__file__).parents[2]
HEADERS = {
    "<math.h>", "<stdbool.h>", "<stddef.h>", "<stdint.h>",
    '"rtapi.h"', '"rtapi_app.h"', '"hal.h"', '"emcmotcfg.h"', '"kinematics.h"',
}  # fmt: skip


@pytest.mark.broad
@pytest.mark.parametrize("name", NAMES)
def test_one_source(name: str) -> None:
    """Nothing is allocated or printed, no header stands after the code of LinuxCNC, no line is wider than a page."""
    ((path, text),) = part_of(name)["files"].items()
    assert path == f"{part_of(name)['index']['module']}.c" and len(path) <= 35
    wide = [line for line in text.splitlines() if len(line) > 110]
    assert not wide, wide[0]
    assert "\t" not in text and text.endswith("\n") and " \n" not in text
    assert set(re.findall(r"^#include (.*)$", text, re.MULTILINE)) == HEADERS
    code = re.sub(r"/\*.*?\*/|\"(\\.|[^\"])*\"", "", text, flags=re.DOTALL)
    assert not re.search(r"\b(malloc|calloc|alloca|printf|goto|errno|rand|time|GPL)\b|//", code)
    mechanism = text.partition('#include "rtapi.h"')[0]
    own = set(re.findall(r"^#define (\w+)", mechanism, re.MULTILINE))
    gone = set(re.findall(r"^#undef (\w+)", mechanism, re.MULTILINE))
    guards = (part_of(name)["index"]["module"].removesuffix("_kins").upper(), "SOFTKIN_")
    assert all(macro in gone or macro.startswith(guards) for macro in own)
    pins = re.findall(r'"(softkin\.[^"]*|kinstype[^"]*)"', text)
    assert len(pins) == len(set(pins)) >= 8 and max(map(len, pins)) <= 47
    assert ("#define MOST_ROOTS" in text) == (kinematics_of(named(name)).search_given is not None)


@pytest.mark.broad
@pytest.mark.parametrize("name", NAMES)
def test_no_warnings(name: str, tmp_path: Path) -> None:
    """As plain C99 against both versions; the other tests compile it as halcompile does, with extensions of GNU."""
    for path, text in part_of(name)["files"].items():
        (tmp_path / path).write_text(text)
        run(tmp_path, "-std=c99", *STRICT, *includes("master"), "-fsyntax-only", path)


@pytest.mark.parametrize("stub", STUBS)
def test_the_runtime_compiles_alone(stub: str, tmp_path: Path) -> None:
    """Where it stands: no warning, and no name that a module would have to bring beside its `softkin_this`."""
    folder = written({**c.shared(), **runtime("linuxcnc")}, tmp_path)
    run(folder, "-std=c99", *STRICT, *includes(stub), "-fsyntax-only", "softkin_linuxcnc.c")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "stub", "options"),
    [
        ("Kin_Ac6_RZRYRYRXRYRZ_J6Offset", "2_9", ("-std=gnu17",)),
        ("Softkin_TableTable_AC", "master", ("-std=c99", "-DKINS_JACOBIAN_STEP", "-DTOOL_FRAME_MAX_SOLUTIONS=8")),
    ],
)
def test_optimised(name: str, stub: str, options: tuple[str, ...], tmp_path: Path) -> None:
    """No warning where the compiler looks deeper, and none of large frames; with and without what is optional."""
    for path, text in part_of(name)["files"].items():
        (tmp_path / path).write_text(text)
        strict = [option for option in STRICT if not option.startswith("-DSOFTKIN")]
        run(tmp_path, *options, *strict, *includes(stub), "-Os", "-Wframe-larger-than=2560", "-c", path)


@pytest.mark.slow("coordinates of", "names of", "words of", "constants")
@pytest.mark.parametrize("stub", STUBS)
@pytest.mark.parametrize("name", ODD)
def test_natural_names(name: str, stub: str) -> None:
    """Pins are called as the description calls its parameters, also where C cannot."""
    mechanism = ODD[name].mechanism()
    part = package.part(kinematics_of(mechanism))
    assert part is not None
    module = loaded(compiled(part, stub), len(mechanism.joints))
    pins = package.pin_names(kinematics_of(mechanism))
    assert [f"softkin.{pin}" for pin in pins.values()] == list(module.numbers)[: len(pins)]


def test_long_names() -> None:
    """A name of the HAL has an end: what is longer is cut, and stays a name of its own."""
    mechanism = named("Kin_Gantry2")
    kin = kinematics_of(mechanism)
    assert max(map(len, package.pin_names(kin).values())) <= 39
    names = package.short_names([f"{'a_long_name_' * 5}{i}" for i in range(12)] + ["short_name", "_x_"])
    assert len(set(names)) == 14 and max(map(len, names)) <= 39 and names[-2:] == ["short-name", "x"]


@pytest.mark.parametrize(
    ("name", "orientation", "letters"),
    [
        ("Softkin_ScaraOnRail", Orientation.COUNTED, "XYZCU"),
        ("Softkin_TableTable_AC", Orientation.AXES, "XYZAC"),
        ("Softkin_HeadHead_CB", Orientation.AXES, "XYZBC"),
        ("Kin_5Axes", Orientation.AXES, "XYZAB"),
        ("Kin_ArticulatedRobot_6DOF", Orientation.ANGLES, "XYZABC"),
        ("Softkin_Planar_3RRR", Orientation.NEAREST, "XYC"),
        ("Kin_P2C_Type1", Orientation.NONE, "XY"),
        ("Kin_CAxis", Orientation.COUNTED, "C"),
        ("Kin_Wrist2", Orientation.AXES, "AB"),
    ],
)
def test_letters(name: str, orientation: Orientation, letters: str) -> None:
    """The letters of a pose; in identity mode each joint has one of its own."""
    words = words_of(kinematics_of(named(name)))
    assert words is not None and (words.orientation, "".join(words.letters)) == (orientation, letters)
    assert len(set(words.of_joints)) == len(words.of_joints) == len(named(name).joints)
    assert set(words.letters) <= set(words.of_joints) or len(words.letters) > len(words.of_joints)
    assert set(words.of_joints) <= set(LETTERS)


def test_a_mechanism_without_joints() -> None:
    """There is no module of it, and the command says why."""
    assert package.part(kinematics_of(named("Kin_Tool"))) is None
    built = Built("", "", None, {}, {})
    (said,) = unwritten(built, languages(wanted=["linuxcnc"]), named("Kin_Tool"))
    assert said.startswith("no module for LinuxCNC: it has 0 axes, a pose there 1 to 9")
