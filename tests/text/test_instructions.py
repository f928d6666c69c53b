"""What headers and guides say of instructions is what `make costs` has measured, of machines as they are now."""

import re
from pathlib import Path

import pytest

from bench.costs import __main__ as tool
from derive.description.mechanism import Mechanism
from derive.emit.softmotion import instructions
from derive.emit.softmotion.instructions import CALLS, Counted, cores, counted, grouped, sentences, table
from derive.report.cost import costs_of
from tests.mechanisms import catalogue, kinematics_of, named
from tests.text.units import text_of

ALL = tuple(m for _, m in catalogue())
ROW = r"^(?:AxesToCartesian|CartesianToAxes(?:, one branch)?)" + 5 * r" +(\d+)" + "$"
NOW = "run `make costs`, then `make generate`"


@pytest.mark.parametrize("mechanism", ALL, ids=lambda m: m.name)
def test_a_header_states_what_was_counted(mechanism: Mechanism) -> None:
    """The operations of today are those of the measurement, or nearly; and the header has its numbers."""
    text = text_of(mechanism)
    forward, inverse = (sum(map(int, row)) for row in re.findall(ROW, text, re.MULTILINE))
    known = counted().get(mechanism.block_name)
    assert known is not None, f"{mechanism.block_name} is not in {instructions.FILE.name}: {NOW}"
    assert known.is_of(forward, inverse), f"{known.operations} operations are {forward}, {inverse} now: {NOW}"
    first = known.cores[cores()[0].name]
    forward, inverse, jacobian = (grouped(usual) for usual, _ in first)
    told = f"{forward} instructions for AxesToCartesian, {inverse} for CartesianToAxes on one branch, {jacobian} for"
    times = ", ".join(cores()[0].microseconds(usual) for usual, _ in first[:2])
    assert f"{told} Jacobian: {times} and " in " ".join(text.split()), NOW
    assert all(0 < usual <= most for calls in known.cores.values() for usual, most in calls)


def test_nothing_else_was_measured() -> None:
    """Every machine of the file is in the catalogue, on every processor."""
    assert list(counted()) == [m.block_name for m in ALL], NOW
    assert all(len(calls) == len(CALLS) for one in counted().values() for calls in one.cores.values())


def test_another_machine_of_the_same_name_is_not_told_of() -> None:
    """Nor one that was never measured, nor one that has changed by more than a twentieth."""
    scara, gantry = (costs_of(kinematics_of(named(name))) for name in ("Kin_Scara3_Z", "Kin_Gantry3"))
    assert sentences("Softkin_Scara3_Z", scara)
    assert not sentences("Softkin_Scara3_Z", gantry) and not sentences("Kin_Own", scara)
    known = Counted((100, 1000), {})
    assert known.is_of(105, 950) and not known.is_of(106, 1000) and not known.is_of(100, 940)


@pytest.mark.parametrize("page", tool.PAGES, ids=lambda page: Path(page).stem)
def test_the_guides_have_the_table(page: str) -> None:
    """All of it, or the rows of some machines; and the speeds that it assumes."""
    text = Path(tool.ROOT, page).read_text(encoding="utf-8")
    assert all(f"{core.name}: {core.speed}" in " ".join(text.split()) for core in cores())
    assert "\n".join(table(tool.PAGES[page])) in text and tool.with_table(text, tool.PAGES[page]) == text, NOW


def test_a_missing_tool_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Before anything is derived or written."""
    before = instructions.FILE.read_bytes()
    monkeypatch.setattr(tool, "which", lambda name: None if "aarch64" in name else name)
    assert tool.main() == 1
    said = capsys.readouterr().err
    assert said.startswith("make costs: aarch64-linux-gnu-gcc, aarch64-linux-gnu-nm, qemu-aarch64 not found")
    assert "apt install" in said and instructions.FILE.read_bytes() == before
