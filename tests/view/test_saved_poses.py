"""A pose as an address that opens it again, and as text that is copied."""

import csv
import io
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import softkin

from tests.view.states import ARM, Seen

pytestmark = pytest.mark.slow


def test_an_address_is_restored(seen: Seen) -> None:
    """The address of a pose opens the same pose, to the last digit; that of a refusal the refusal."""
    assert "view=" not in seen["address"]
    assert seen["restored"]["axes"] == seen["dragged"]["axes"]
    assert seen["restored"]["machine"] == ARM
    assert seen["refusedRestored"]["refusal"] == seen["refused"]["refusal"] is not None


def test_an_unknown_machine_is_told(seen: Seen) -> None:
    """The page shows a machine that it has, and says that it does not have the one of the address."""
    assert seen["own"]["unknown"] == "unknown machine: nonsense"


def test_where_one_looks_from_is_in_the_address(seen: Seen) -> None:
    """A picture that was turned opens as it is seen, to the digits of the address; the whole machine needs none."""
    camera = seen["camera"]
    assert "view=" not in camera["fitted"] and "view=" not in camera["again"]
    assert camera["turned"].startswith(f"{camera['fitted']}&view=")
    size = np.linalg.norm(np.subtract(camera["here"][:3], camera["here"][3:]))
    assert np.allclose(camera["here"], camera["there"], rtol=0, atol=1e-4 * size)


def test_a_pose_of_a_machine_of_ones_own_is_copied(
    seen: Seen, pages: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the package that `softkin derive` writes: a dimension called as a word of Python has its keyword."""
    monkeypatch.syspath_prepend(str(pages[1].parent / "python"))
    names: dict[str, Any] = {}
    exec(seen["own"]["copied"], names)  # the text of the viewer
    assert names["robot"].parameters["lambda_"] == seen["own"]["pose"]["parameters"]["lambda"] == 225
    assert np.allclose(names["axes"], seen["own"]["pose"]["axes"], rtol=0, atol=1e-9)


def test_a_pose_is_copied(seen: Seen) -> None:
    """The Python is executed and gives the axes; the block's bytes and the CSV are those of the pose."""
    pose, names = seen["copied"]["pose"], {}
    exec(seen["copied"]["Python"], names)  # the text of the viewer
    assert np.allclose(names["axes"], pose["axes"], rtol=0, atol=1e-9)
    assert np.allclose(names["frame"].matrix[:3, 3], pose["frame"]["position"], rtol=0, atol=1e-12)
    text = seen["copied"]["Structured Text"]
    written = [int(value) for value in re.findall(r"Config\.abyData\[\d\] := (\d+);", text)]
    assert written == [byte % 256 for byte in pose["configuration"]]
    values = [float(value) for value in re.findall(r"target\.c\.[XYZABC] := (-?[\d.]+);", text)]
    there = softkin.Frame.from_euler(*values[3:], values[:3])
    assert np.allclose(there.matrix[:3], np.column_stack([pose["frame"]["rotation"], pose["frame"]["position"]]))
    header, row = csv.reader(io.StringIO(seen["copied"]["CSV"]))
    assert [float(value) for value in row[:6]] == pose["axes"]
    assert header[:6] == [f"axis A{i}" for i in range(1, 7)]
    assert [int(value) for value in row[12:]] == pose["configuration"]
