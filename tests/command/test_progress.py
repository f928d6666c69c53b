"""What a command prints while it works: lines, on a terminal a running line, and what takes long."""

import sys
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path

import pytest

from derive.command import stages as of_machine
from derive.command.stages import Stages, doing
from derive.lowering import writing
from derive.progress import Patience, Progress
from tests.command.files import RAIL, ROOT, Folder
from tests.outside import output_of

CLEARED = "\r\033[K"


class Terminal(StringIO):
    def isatty(self) -> bool:
        return True


@dataclass
class Clock:
    now: float = 0.0

    def __call__(self) -> float:
        return self.now


@dataclass
class Watched:
    """What a run prints about one machine, at times that are set by hand."""

    stream: StringIO
    clock: Clock = field(default_factory=Clock)

    def __post_init__(self) -> None:
        self.stages = Stages(self.stream, self.clock)

    def at(self, *seconds: float) -> None:
        for self.clock.now in seconds:
            self.stages._patience.look()


def test_a_terminal_shows_a_bar_and_the_time_left() -> None:
    stream, clock = Terminal(), Clock()
    progress = Progress(4, stream, clock)
    for clock.now, line in ((5.0, "first"), (10.0, "second")):
        progress.step(line, took_time=True)
    progress.end()
    assert [part for part in stream.getvalue().split(CLEARED) if part] == [
        "[........................] 0 of 4, 0 s",
        "first\n",
        "[######..................] 1 of 4, 5 s, about 15 s left",
        "second\n",
        "[############............] 2 of 4, 10 s, about 10 s left",
    ]


def test_a_file_gets_lines_alone() -> None:
    stream = StringIO()
    progress = Progress(2, stream)
    progress.step("first", took_time=False)
    progress.step("second", took_time=True)
    progress.end()
    assert stream.getvalue() == "first\nsecond\n"


def test_a_long_stage_on_a_terminal_counts_its_seconds() -> None:
    """The running line is replaced each second, and by the result."""
    run = Watched(Terminal())
    run.stages.report("derive", "")
    run.at(1.0, 2.0)
    run.stages.report("derive", "5 statements")
    assert run.stream.getvalue().split(CLEARED)[1:] == [
        "  derive   …", "  derive       1 s …", "  derive       2 s …", "  derive     2.0 s   5 statements\n",
    ]  # fmt: skip


def test_a_long_stage_in_a_file_is_told_after_ten_seconds_and_then_rarely(monkeypatch: pytest.MonkeyPatch) -> None:
    """A log gets one line after 10 s, then after 20, 40, …; a line of the run itself starts again."""
    monkeypatch.setattr(of_machine, "doing", lambda: "solving its equations")
    run = Watched(StringIO())
    run.stages.report("derive", "")
    run.at(*map(float, range(1, 50)))
    assert run.stream.getvalue().splitlines() == [
        f"  derive   {seconds:5} s … solving its equations" for seconds in (10, 20, 40)
    ]
    run.stages.report("derive", "5 statements")
    run.at(52.0)
    run.at(*map(float, range(58, 62)))
    assert run.stream.getvalue().splitlines()[3:] == [
        "  derive    49.0 s   5 statements", "  write       10 s … solving its equations",
    ]  # fmt: skip


def test_the_thread_ends_with_its_run() -> None:
    """After the end no line comes, whatever the thread still does."""
    stream, clock = StringIO(), Clock()
    patience = Patience(stream, lambda: "late", clock)
    patience.begin()
    patience.end()
    clock.now = 100.0
    patience.look()
    assert stream.getvalue() == ""


def test_what_the_compiler_is_doing(folder: Folder, monkeypatch: pytest.MonkeyPatch) -> None:
    """The words come from the folder of the compiler that is at work."""
    seen: list[str] = []
    bindings = writing._Writer._bindings

    def noted(*given: object) -> object:
        seen.append(doing())
        return bindings(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(writing._Writer, "_bindings", noted)
    folder.write("rail.py", RAIL)
    assert folder.run("check", "rail.py").status == 0
    assert "saving operations" in seen and doing() == ""


ENDLESS = """
import threading
from derive.command.stages import doing
from derive.description.catalogue import load
from pathlib import Path
import os, time

def told():
    while "line 4" not in (text := doing()):
        time.sleep(0.01)
    print(text, flush=True)
    os._exit(0)

threading.Thread(target=told).start()
load(Path("loop.py"))
"""


def test_a_description_that_does_not_end_is_told_with_its_line(tmp_path: Path) -> None:
    """A description is a program; the line is that of the file, also while it calls something else."""
    (tmp_path / "loop.py").write_text("import time\nx = 0\nwhile True:\n    time.sleep(0.01)\n")
    command, env = [sys.executable, "-c", ENDLESS], {"PYTHONPATH": str(ROOT)}
    assert (
        output_of(command, cwd=tmp_path, env=env, timeout=120) == "still running the description: line 4 of loop.py\n"
    )
