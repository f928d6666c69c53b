"""The modules of the proof are those that the compiler writes now."""

from dataclasses import replace
from pathlib import Path

import pytest

from prove.linuxcnc.machines import SCARA, TRUNNION
from prove.linuxcnc.modules import Module, NotWritten, written


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
