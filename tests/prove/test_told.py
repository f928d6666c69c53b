"""What is said of the proof: its table in docs/LINUXCNC.md, and the modules that it proves."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from prove.linuxcnc.machines import MACHINES, SCARA, TRUNNION
from prove.linuxcnc.modules import Module, NotWritten, written
from prove.linuxcnc.table import HEAD, table
from prove.linuxcnc.twin import Twin
from prove.linuxcnc.verdict import ALIKE, ON_THE_WAY, SPEEDS_ALIKE, Verdict

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
        written([replace(SCARA, mechanism="Kin_None")], tmp_path, fresh=False)
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
