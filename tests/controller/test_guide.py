"""docs/LIVE.md: its files and commands are read, its messages are those that arrive, its tables name what there is."""

import argparse
import asyncio
import json
import re
import shlex
from pathlib import Path
from typing import Any

import pytest

from derive.command import live
from derive.command.new import description
from derive.controller import settings as told
from derive.controller.feed import Status
from derive.controller.reading import Quality
from derive.controller.settings import settings_of
from tests.command.files import ROOT
from tests.controller.pages import GANTRY, message, message_where, page_of, served, settings
from tests.controller.test_server import Given

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
