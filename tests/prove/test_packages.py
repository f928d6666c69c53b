"""What the proofs install, and what they tell."""

import os
import re
import shutil
import stat
from dataclasses import replace
from pathlib import Path

import pytest

from prove.linuxcnc import packages
from prove.linuxcnc.__main__ import CANNOT, main
from prove.linuxcnc.machines import MACHINES, SCARA, TRUNNION
from prove.linuxcnc.modules import Module, NotWritten, written
from prove.linuxcnc.packages import CannotRun, require_computer, unpacked
from prove.linuxcnc.table import HEAD, table
from prove.linuxcnc.twin import Twin
from prove.linuxcnc.verdict import ALIKE, ON_THE_WAY, SPEEDS_ALIKE, Verdict


def test_without_root_it_says_so(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """One sentence, and an exit code of its own; where it is asked for if possible alone, none."""
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert main([]) == CANNOT
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1 and said.err.count(".\n") == 1
    assert "needs root" in said.err and said.err.startswith("The proof on LinuxCNC did not run: ")
    assert main(["--if-possible"]) == 0
    assert "did not run" in capsys.readouterr().err


@pytest.mark.parametrize(
    "release", ["ID=ubuntu\nVERSION_ID=\"24.04\"\n", "ID=debian\nVERSION_ID=\"13\"\n", "NAME=another\n"]
)  # fmt: skip
def test_on_another_system_it_says_so(release: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "os-release"
    file.write_text(release, encoding="utf-8")
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.setattr(packages, "RELEASE_FILE", file)
    with pytest.raises(CannotRun, match="it needs Debian 12"):
        require_computer()


def _debian(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, **commands: str) -> Path:
    """A Debian 12 whose commands are these scripts alone."""
    file, folder = tmp_path / "os-release", tmp_path / "commands"
    file.write_text('ID=debian\nVERSION_ID="12"\n', encoding="utf-8")
    folder.mkdir()
    for name, text in commands.items():
        command = folder / name.replace("_", "-")
        command.write_text(f"#!{shutil.which('sh')}\n{text}\n", encoding="utf-8")
        command.chmod(command.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.setattr(packages, "RELEASE_FILE", file)
    monkeypatch.setenv("PATH", str(folder))
    return folder


def test_missing_commands_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All of them, in one sentence."""
    _debian(tmp_path, monkeypatch, gcc="true", make="true", mount="true")
    with pytest.raises(CannotRun, match="unshare, apt-get"):
        require_computer()


def test_a_computer_without_namespaces_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a container without the right to mount."""
    every = dict.fromkeys((name.replace("-", "_") for name in packages.COMMANDS), "true")
    _debian(tmp_path, monkeypatch, **{**every, "unshare": "echo 'Operation not permitted' >&2; exit 1"})
    with pytest.raises(CannotRun, match="no namespaces: Operation not permitted"):
        require_computer()


def test_packages_that_cannot_be_had_are_a_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first error of apt-get is in the sentence, and nothing half done is taken for whole the next time."""
    _debian(tmp_path, monkeypatch, apt_get="echo 'W: old'; echo 'E: no network' >&2; exit 100", dpkg_query="exit 1")
    folder = tmp_path / "linuxcnc"
    for _ in range(2):
        with pytest.raises(CannotRun, match="cannot be downloaded: no network$"):
            unpacked(folder)
        assert not (folder / "version").exists()


def test_old_lists_of_packages_are_read_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A first download that fails is followed by an update into a folder of ours, and by another one."""
    log, shell = tmp_path / "log", shutil.which("sh")
    _debian(
        tmp_path, monkeypatch, dpkg_query="exit 1", dpkg_deb="true",
        apt_get=f"""echo "$@" >> {log}
case "$*" in
  *State*update*) exit 0 ;;
  *State*download*) : > linuxcnc-uspace_2.9.1%3ax_amd64.deb; exit 0 ;;
esac
echo 'E: 404' >&2; exit 100""",
    )  # fmt: skip
    assert shell is not None
    found = unpacked(tmp_path / "linuxcnc")
    assert found.version == "2.9.1:x"
    said = log.read_text(encoding="utf-8").splitlines()
    assert [line.split()[-1] == "update" for line in said] == [False, True, False]
    assert all(f"Dir::State::Lists={tmp_path}" in line for line in said[1:])
    assert unpacked(tmp_path / "linuxcnc") == found
    assert log.read_text(encoding="utf-8").splitlines() == said


def test_a_room_that_cannot_be_made_is_a_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Where a mount is refused, or a library is missing, the proof did not run: it did not fail."""
    every = dict.fromkeys((name.replace("-", "_") for name in packages.COMMANDS), "true")
    room = "case \"$*\" in *room.sh*) echo 'mount: /usr: wrong fs type.'; exit 32 ;; esac"
    apt = 'case "$*" in *download*) : > linuxcnc-uspace_2.9.1_amd64.deb ;; esac'
    _debian(tmp_path, monkeypatch, **{**every, "unshare": room, "apt_get": apt, "dpkg_query": "exit 1"})
    assert main(["--folder", str(tmp_path / "build")]) == CANNOT
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "LinuxCNC is not complete in its room: mount: /usr: wrong fs type" in said


ROOT = Path(__file__).resolve().parents[2]


def shown() -> list[list[str]]:
    """The rows of the table in docs/LINUXCNC.md."""
    page = (ROOT / "docs/LINUXCNC.md").read_text(encoding="utf-8")
    part = page.partition("## On the real LinuxCNC")[2].partition("\n## ")[0]
    assert re.search(r"On 20\d\d-\d\d-\d\d, LinuxCNC 2\.9", part)
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines() if line[:1] == "|"]


def test_the_guide_shows_every_machine_proven() -> None:
    """Its head is that of the printed table, and no row claims what the verdict would call a fault."""
    head, _, *rows = shown()
    assert tuple(head) == HEAD
    assert [row[0] for row in rows] == [machine.says for machine in MACHINES]
    for row, machine in zip(rows, MACHINES, strict=True):
        samples, joints, poses, speeds, away = (float(cell.replace(",", "")) for cell in row[1:6])
        assert samples > 1000 and max(joints, poses) <= ALIKE and speeds <= SPEEDS_ALIKE and away <= ON_THE_WAY
        assert row[6:8] == ["yes" if Twin(machine).robot.BRANCHES else "has one", "yes"]


def test_a_table_says_what_failed() -> None:
    """A machine that did not run has no number, and is not said to have refused anything."""
    nan = float("nan")
    failed = Verdict("SCARA", 0, nan, nan, nan, nan, False, False, 7.4, ("why",))
    proven = Verdict("hexapod", 12345, 1e-13, 0.0, 3e-5, 2e-4, None, True, 12.0, ())
    assert table([failed, proven]).splitlines()[2:] == [
        "| SCARA | 0 | nan | nan | nan | nan | NO | NO | 7 |",
        "| hexapod | 12,345 | 1.0e-13 | 0.0e+00 | 3.0e-05 | 2.0e-04 | has one | yes | 12 |",
    ]


def test_continuous_integration_runs_it_before_the_tests() -> None:
    """The closing lines stay those of the tests."""
    lines = (ROOT / ".ci/run").read_text(encoding="utf-8").splitlines()
    assert lines[-2:] == ["make test", "make sweep"]
    assert lines.index("make prove-linuxcnc IF_POSSIBLE=1") < lines.index("make test")


def test_what_the_compiler_refuses_is_told(tmp_path: Path) -> None:
    """Its own words, and nothing of an earlier run is left to be taken for a module."""
    old = tmp_path / "linuxcnc" / "none_kins.c"
    old.parent.mkdir()
    old.write_text("old", encoding="utf-8")
    with pytest.raises(NotWritten, match="Kin_None"):
        written([replace(SCARA, mechanism="Kin_None")], tmp_path)
    assert not old.exists()


def test_parameters_and_limits_are_set_by_their_pins() -> None:
    """Every one of them, as the HAL reads it."""
    lines = Module(Path("tabletable_ac_kins.c")).setting(TRUNNION)
    assert lines == [
        "setp softkin.pivot-y 40.0",
        "setp softkin.pivot-z -60.0",
        "setp softkin.tool-length 120.0",
        "setp softkin.lower-a -100.0",
        "setp softkin.upper-a 100.0",
    ]
