"""`softkin live` as a user has it, and docs/LIVE.md: its files, its commands and its messages."""

import argparse
import asyncio
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from derive.command import live
from derive.command.line import main
from derive.command.new import description
from derive.controller import settings as told
from derive.controller.feed import Status
from derive.controller.reading import Quality
from derive.controller.settings import settings_of
from tests.command.files import RAIL, ROOT
from tests.controller.pages import GANTRY, PATIENCE, Served, message, message_where, page_of, served, settings
from tests.controller.test_server import Given
from tests.outside import output_of


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "machine.json").write_text(json.dumps({**GANTRY, "source": "-"}), encoding="utf-8")
    (tmp_path / "page.html").write_text("<p>viewer</p>", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
async def test_from_standard_input_to_the_page(folder: Path) -> None:
    """The address stands in the first line; what is written into it arrives, scaled; the end of the input is told."""
    options = ["--machine", "machine.json", "--page", "page.html", "--axis", "Y=Y*0.5"]
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "derive", "live", *options),
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    try:
        assert process.stdin is not None and process.stdout is not None
        first = (await asyncio.wait_for(process.stdout.readline(), 60)).decode().strip()
        assert first.startswith("http://127.0.0.1:") and "/#live=" in first
        running = Served(asyncio.create_task(process.wait()), [first])  # type: ignore[arg-type]
        async with page_of(running) as page:
            process.stdin.write(b"1,2\n")
            assert (await message_where(page, lambda m: m["complete"]))["axes"] == [1.0, 1.0]
            process.stdin.close()
            await message_where(page, lambda m: m["status"] == "ended")
        said = [(await asyncio.wait_for(process.stdout.readline(), PATIENCE)).decode().strip() for _ in range(3)]
        assert said == ["connecting", "live", "ended: the values are over"]
    finally:
        process.kill()
        await process.wait()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "build/viewer.html: there is no page; `make view` builds it, or name another one with --page"),
        (("--page", "page.html", "--axis", "Z=1"), "the machine has no axis 'Z'"),
        (("--page", "page.html", "--source", "none.csv"), "none.csv: No such file"),
        (("--page", "page.html", "--source", "opc.tcp://a:b@c"), "a user or a password in it"),
        (("--page", "page.html", "--source", "t.csv", "--bind", "192.0.2.1"), "cannot serve at 192.0.2.1"),
        (("--page", "page.html", "--rate", "0"), "rate is a number more than 0"),
    ],
)
def test_what_cannot_be_is_one_sentence(
    arguments: tuple[str, ...], said: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Status 2, and no server."""
    (folder / "t.csv").write_text("t,X,Y\n0,1,2\n", encoding="utf-8")
    assert main(["live", "--machine", "machine.json", *arguments]) == 2
    written = capsys.readouterr()
    assert written.err.startswith("error: ") and said in written.err and written.err.count("\n") == 1
    assert "#live=" not in written.out


def test_the_page_of_a_machine_of_ones_own(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Where none is named it is the one that `softkin view` writes; the sentence says so where there is none."""
    (folder / "my-slide.py").write_text(RAIL, encoding="utf-8")
    (folder / "t.csv").write_text("t,A1,A2\n0,1,2\n", encoding="utf-8")
    given = {"description": "my-slide.py", "source": "t.csv"}
    (folder / "own.json").write_text(json.dumps(given), encoding="utf-8")
    assert main(["live", "--machine", "own.json"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: build/my_slide.html: there is no page; `softkin view my-slide.py` builds it")
    (folder / "build").mkdir()
    (folder / "build" / "my_slide.html").write_text("<p>viewer</p>", encoding="utf-8")
    assert main(["live", "--machine", "own.json", "--bind", "192.0.2.1"]) == 2
    assert "cannot serve at 192.0.2.1" in capsys.readouterr().err


@pytest.mark.slow
def test_no_other_command_loads_the_servers() -> None:
    """Neither package is imported, nor needed, until a live connection wants it."""
    code = (
        "import sys; from derive.command import line; print({'aiohttp', 'asyncua', 'cryptography'} & set(sys.modules))"
    )
    assert output_of([sys.executable, "-c", code], cwd=ROOT) == "set()\n"


TEXT = (ROOT / "docs/LIVE.md").read_text(encoding="utf-8")
FILES = [json.loads(text) for text in re.findall(r"```json\n(.*?)```", TEXT, re.DOTALL)]
(TABLE,) = re.findall(r"```csv\n(.*?)```", TEXT, re.DOTALL)
COMMANDS = [
    line.split("  #")[0]
    for block in re.findall(r"```sh\n(.*?)```", TEXT, re.DOTALL)
    for line in block.splitlines()
    if "softkin live" in line
]


def parser() -> argparse.ArgumentParser:
    found = argparse.ArgumentParser()
    live.add_arguments(found)
    return found


def test_the_files_are_settings(tmp_path: Path) -> None:
    """The catalogue's SCARA at an OPC UA server, and a machine of a user's own with the recording that is shown."""
    scara, own = FILES[:2]
    first = settings(tmp_path, scara)
    assert first.channels[2].scale == 1000.0 and first.rate == 50.0 and first.machine.given == scara["machine"]
    (tmp_path / "my_machine.py").write_text(description("my_machine.py", "MyMachine"), encoding="utf-8")
    (tmp_path / "recording.csv").write_text(TABLE, encoding="utf-8")
    second = settings(tmp_path, own)

    async def run() -> dict[str, Any]:
        async with served(second) as running, page_of(running) as page:
            return await message_where(page, lambda m: m["axes"] == [1.0, 2.0, -4.0, 0.0])

    assert asyncio.run(run())["recorded"] == 0.04


@pytest.mark.parametrize("line", COMMANDS)
def test_the_commands_can_be_asked(line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each with a file of the name that it uses."""
    words = shlex.split(line.split("|")[-1])
    options = parser().parse_args(words[2:])
    scara = FILES[0] if options.machine.stem == "scara" else {**FILES[0]["machine"]}
    monkeypatch.chdir(tmp_path)
    options.machine.write_text(json.dumps(scara), encoding="utf-8")
    rest = [] if options.machine.stem == "scara" else ["A3=ns=4;s=a3", "A4=ns=4;s=a4"]
    found = settings_of(options.machine, [*options.axis, *rest], {"address": options.source, "loop": options.loop})
    assert len(found.channels) == 4


async def test_the_messages_are_those_that_arrive(tmp_path: Path) -> None:
    """The first in every word; of the others the names, the order, and what does not depend on time."""
    about_machine, about_axes = FILES[2:]
    given = {**GANTRY, "source": "-", "axes": {"Y": {"scale": 0.5}}}
    source = Given()
    async with served(settings(tmp_path, given), source=source) as running, page_of(running) as page:
        assert await message(page) == about_machine
        source.queue.put_nowait({"X": 12.5, "Y": float("nan")})
        found = await message_where(page, lambda m: m["status"] == "live")
        assert list(found) == list(about_axes)
        timed = ("number", "time", "ages")
        assert {k: v for k, v in found.items() if k not in timed} == {
            k: v for k, v in about_axes.items() if k not in timed
        }


def test_the_tables_name_what_there_is() -> None:
    """Every option stands in the guide, and every option of the guide is one; so do the states and the qualities."""
    options = {word for action in parser()._actions for word in action.option_strings if word.startswith("--")}
    named = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", TEXT))
    assert named == options - {"--help"}
    entries = set(re.findall(r"^\| `(\w+)` \| `--", TEXT, re.MULTILINE))
    assert entries == told._OF_SOURCE
    assert all(f"`{value.value}`" in TEXT for value in (*Status, *Quality))
