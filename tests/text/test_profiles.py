"""Profiles of the SoftMotion contract: which interfaces an older library gets, and one line that changes one
spelling."""

import re
import subprocess
from functools import lru_cache
from pathlib import Path

import pytest

from derive.command.line import main
from derive.description.catalogue import MECHANISMS, load
from derive.emit.softmotion.library import StructuredTextFiles
from derive.emit.st.contract import _FILE
from derive.emit.st.contract import load as contract
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from tests.harness import ast
from tests.harness.library import compile_st
from tests.text.controller import OK, UNREACHABLE, Controller

BLOCK = "scara/Kin_Scara4_ZCcoupled_Type1.st"
LEFT_OUT = (
    "ISMKinematicAxisSettings",
    "ISMKinematicWithConfigurations4",
    "ISMKinPeriodHandling",
    "ISMKinematicsWithOrientationImage2",
)


@lru_cache
def kinematics() -> Kinematics:
    """A mechanism that implements every interface of a position kinematics."""
    return build(load(MECHANISMS / "kin_scara4_zccoupled_type1.py"))


def files_of(profile: str | None, one: Kinematics) -> dict[str, str]:
    """All files of Structured Text for one mechanism, without its sample project, which needs an axis group."""
    language = StructuredTextFiles(profile)
    return {n: t for n, t in language.files([language.part(one)]).items() if not n.startswith("samples/")}


@lru_cache
def rendered(profile: str | None) -> dict[str, str]:
    """The files of a profile."""
    return files_of(profile, kinematics())


def block(profile: str | None) -> ast.Block:
    """The SCARA as a profile declares it."""
    return _block_in(rendered(profile))


def _block_in(files: dict[str, str]) -> ast.Block:
    """The block of the one SCARA in these files."""
    (name,) = (file.split("/")[1].removesuffix(".st") for file in files if re.fullmatch(r"scara/\w+\.st", file))
    found = compile_st({name: text for name, text in files.items() if name.endswith(".st")}).objects[name]
    assert isinstance(found, ast.Block)
    return found


def base(profile: str | None) -> ast.Block:
    """The base block as a profile declares it."""
    files = {name: text for name, text in rendered(profile).items() if name.endswith(".st")}
    found = compile_st(files).objects["Softkin_Kinematics"]
    assert isinstance(found, ast.Block)
    return found


def test_an_older_library_gets_the_predecessors() -> None:
    current, older = block(None), block("before_4_11")
    assert {f"TRAFO.{name}" for name in LEFT_OUT} <= set(current.implements)
    assert [name for name in older.implements if name.removeprefix("TRAFO.") in LEFT_OUT] == []
    assert "TRAFO.ISMKinematicWithConfigurations3" in older.implements
    assert current.implements[-1] == "ISoftkin" and "ISoftkin" not in older.implements
    assert len(older.implements) == len(current.implements) - 4
    for name in ("ISoftkin", "Softkin_CheckLine"):  # and what asks a block by it
        assert f"softkin/{name}.st" in rendered(None) and f"softkin/{name}.st" not in rendered("before_4_11")
    assert "softkin/Softkin_Teach.st" in rendered("before_4_11"), "it asks by an interface of every library"


def test_the_methods_of_what_is_left_out_are_left_out() -> None:
    upside_down = build(load(MECHANISMS / "kin_scara4_cczc_zccoupled.py"))
    current, older = ({m.name for m in _block_in(files_of(p, upside_down)).methods} for p in (None, "before_4_11"))
    assert current - older == {"FindProjection"}
    assert {m.name for m in block(None).methods} == {m.name for m in block("before_4_11").methods}
    gone = {m.name for m in base(None).methods} - {m.name for m in base("before_4_11").methods}
    flange = {"GetFlangeOrientationImageTotal", "GetFlangeOrientationImageWithOri"}
    assert gone == flange | {"IsConfigSingular", "GetPeriods", "AxisSettings"}


def test_without_settings_drives_pass_nothing() -> None:
    """No method takes the settings of a drive, so that the limits of the block are all there are."""
    files = {name: text for name, text in rendered("before_4_11").items() if name.endswith(".st")}
    assert not any("AxisSettings" in re.sub(r"//[^\n]*", "", text) for text in files.values())
    assert not any("Axis_Settings" in text for text in files.values())


@pytest.mark.parametrize("profile", [None, "before_4_11"])
def test_limits_of_a_block_alone_are_the_same_with_every_profile(profile: str | None) -> None:
    """The turn that is inside, and what is beyond."""
    mechanism = load(MECHANISMS / "kin_scara4_zccoupled_type1.py")
    machine = Controller(compile_st({n: t for n, t in rendered(profile).items() if n.endswith(".st")}), mechanism)
    given = {p.name: p.nominal for p in mechanism.parameters} | {"lower_a1": -170.0, "upper_a1": 170.0}
    axes, beyond, reference = (-160.0, 60.0, 10.0, 20.0), (-175.0, 60.0, 10.0, 20.0), (160.0, 60.0, 10.0, 20.0)
    for wanted, expected in ((axes, OK), (beyond, UNREACHABLE)):
        assert machine.initialise(given) == OK
        position, rotation, data = machine.forward(wanted)[1]
        status, found = machine.inverse(position, rotation, (data[0], 0, 0, 0), reference)
        assert status == expected
        assert status != OK or found[:4] == pytest.approx(wanted)


@pytest.mark.parametrize("name", ["kin_scara4_zccoupled_type1", "kin_wrist2", "kin_p2x_type1"])
def test_what_is_left_is_executed(name: str) -> None:
    """A position kinematics, an orientation kinematics and a loop, in the text for an older library: there and back."""
    mechanism = load(MECHANISMS / f"{name}.py")
    files = files_of("before_4_11", kinematics() if "scara4" in name else build(mechanism))
    machine = Controller(compile_st({n: t for n, t in files.items() if n.endswith(".st")}), mechanism)
    assert machine.initialise({p.name: p.nominal for p in mechanism.parameters}) == OK
    axes = tuple(30.0 if j.is_angle else 5.0 + j.nominal for j in mechanism.joints)
    status, pose = machine.forward(axes)
    assert status == OK
    answered, back = machine.inverse(*pose, axes)
    assert answered == OK and back[: len(axes)] == pytest.approx(axes)
    assert machine.diagnose(*pose, axes) == ("", 0.0)


def test_plcopen_follows_the_profile() -> None:
    text = rendered("before_4_11")["softkin.xml"]
    assert "ISMKinematicWithConfigurations3" in text
    assert not any(name in text for name in LEFT_OUT)


def test_profiles_are_joined() -> None:
    """The oldest of their libraries, what any of them leaves out, and flat where one of them is."""
    both, older, flat = contract("before_4_11+flat"), contract("before_4_11"), contract("flat")
    assert both.is_flat and flat.is_flat and not older.is_flat and not contract(None).is_flat
    assert both.omits == older.omits and flat.omits == frozenset() == contract("flat+current").omits
    with pytest.raises(ValueError, match="no profile is called 'round'"):
        contract("flat+round")


def test_the_oldest_documented_library_has_them_all() -> None:
    assert contract("4.11").omits == contract(None).omits == frozenset()
    assert rendered("4.11") == rendered(None)


def test_an_interface_comes_with_its_library(tmp_path: Path) -> None:
    """What the documentation first lists for a later library, a profile for an earlier one leaves out."""
    table = "[interfaces.ISMKinPeriodHandling]\nsince = "
    text = _FILE.read_text(encoding="utf-8")
    assert f'{table}"4.11"' in text
    changed = tmp_path / "softmotion.toml"
    changed.write_text(text.replace(f'{table}"4.11"', f'{table}"4.14"'), encoding="utf-8")
    assert contract("4.11", changed).omits == {"ISMKinPeriodHandling"}
    assert contract("current", changed).omits == frozenset()
    assert contract("4.11", changed).available("ISMKinPeriodHandling") is None


def test_what_is_not_documented_says_so() -> None:
    """A spelling that no document settles is a constant that says so, or stands under its heading; each has a comment
    above it.
    """
    head, _, rest = _FILE.read_text(encoding="utf-8").partition("# ---- Not documented ")
    names = head.partition("# ---- Softkin_Names ")[2]
    doubtful = re.findall(r"^(\w+) = .*documented = false", names, re.MULTILINE)
    assert sorted(doubtful) == ["BAD_INPUT", "NOT_INITIALIZED", "linear", "nothing_turns"]
    for section, keys in (
        (names, (*doubtful, "UNREACHABLE")),
        (rest.partition("# ---- ")[0], ("access", "description")),
    ):
        lines = section.split("\n")
        for key in keys:
            (at,) = (n for n, line in enumerate(lines) if line.startswith(f"{key} ="))
            above = next(line for line in reversed(lines[:at]) if line.startswith(("#", "[")))
            assert above.startswith("#"), key
    assert "Not documented" in head, "the profile of an older library"


@pytest.mark.parametrize("command", ["generate", "check"])
def test_an_unknown_profile_is_refused_at_once(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = [command, "--output", str(tmp_path / "out"), "--profile", "4.99"]
    assert main(arguments) == 1
    printed = capsys.readouterr()
    assert printed.err == "error: no profile is called '4.99'; there are current, 4.11, before_4_11, flat, pacdrive\n"
    assert printed.out == "", "before anything is derived"


@pytest.mark.slow
def test_a_profile_is_generated_and_checked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, output = tmp_path / "mechanisms", tmp_path / "out"
    folder.mkdir()
    source = (MECHANISMS / "kin_scara2_z.py").read_text(encoding="utf-8")
    (folder / "kin_scara2_z.py").write_text(source, encoding="utf-8")
    given = ["--output", str(output), "--mechanisms", str(folder)]
    assert main(["generate", *given, "--profile", "before_4_11"]) == 0
    assert main(["check", *given, "--profile", "before_4_11"]) == 0
    assert main(["check", *given]) == 1
    assert "differs from a fresh generation" in capsys.readouterr().err


@pytest.mark.parametrize(("given", "wanted"), [("PROFILE=before_4_11", " --profile before_4_11"), ("PROFILE=", "")])
@pytest.mark.parametrize("target", ["generate", "check"])
def test_make_hands_the_profile_on(target: str, given: str, wanted: str) -> None:
    command = ["make", "--dry-run", target, given, "FRESH="]
    done = subprocess.run(command, cwd=MECHANISMS.parents[1], capture_output=True, text=True, check=True)
    assert re.search(rf"-m derive {target}{wanted} *\n", done.stdout)
