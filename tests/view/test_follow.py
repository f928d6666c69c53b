"""The page of `softkin live` in a real browser: a controller moves its machine, over OPC UA, and is lost and found."""

import asyncio
import json
import os
import subprocess
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import softkin

from derive.view.node import node
from tests.command.files import ROOT
from tests.controller.controllers import Plc, plc
from tests.controller.pages import PATIENCE
from tests.view.driver import available, prepared
from tests.view.pages import machine_page

pytestmark = pytest.mark.slow

SCARA = "Kin_Scara4_ZCcoupled_Type1"
LIMITS = {"A1": [-170, None], "A3": [None, 0]}
Shown = dict[str, Any]


@dataclass
class Followed:
    process: asyncio.subprocess.Process

    async def shown(self) -> Shown:
        """What the page shows now."""
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(b"now\n")
        found: Shown = json.loads(await asyncio.wait_for(self.process.stdout.readline(), 4 * PATIENCE))
        assert found["errors"] == []
        return found

    async def shown_where(self, holds: Callable[[Shown], bool]) -> Shown:
        """The same, as soon as this holds."""
        async with asyncio.timeout(4 * PATIENCE):
            while not holds(found := await self.shown()):
                await asyncio.sleep(0.05)
            return found


@asynccontextmanager
async def running(*command: object, folder: Path) -> AsyncIterator[asyncio.subprocess.Process]:
    """A process, which ends with the block."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
    pipe = subprocess.PIPE
    process = await asyncio.create_subprocess_exec(
        *map(str, command), cwd=folder, env=environment, stdin=pipe, stdout=pipe
    )
    try:
        yield process
    finally:
        assert process.stdin is not None
        process.stdin.close()
        try:
            await asyncio.wait_for(process.wait(), 2.0)
        except TimeoutError:
            process.kill()
            await process.wait()


@asynccontextmanager
async def followed(folder: Path, controller: Plc) -> AsyncIterator[Followed]:
    """A browser with the page that `softkin live` serves."""
    nodes = {"A1": "GVL.x", "A2": "GVL.y", "A3": "GVL.whole", "A4": "GVL.y"}
    given = {
        "machine": {"mechanism": SCARA, "link_length_1": 300.0, "link_length_2": 200.0, "limits": LIMITS},
        "axes": {axis: {"node": f"ns=2;s={name}", "scale": 0.01} for axis, name in nodes.items()},
        "source": {"address": controller.address, "stale_after": 0.5},
    }
    (folder / "machine.json").write_text(json.dumps(given), encoding="utf-8")
    page = machine_page(folder, SCARA)
    live = (sys.executable, "-m", "derive", "live", "--machine", "machine.json", "--page", page, "--unencrypted")
    async with running(*live, folder=folder) as server:
        assert server.stdout is not None
        address = (await asyncio.wait_for(server.stdout.readline(), 60)).decode().strip()
        assert address.startswith("http://127.0.0.1:")
        async with running(node(), prepared() / "follow.mjs", address, folder=folder) as browser:
            yield Followed(browser)


def turned(before: Shown, after: Shown, body: str) -> float:
    """By how many degrees a body has turned about Z, which is all that its frame has changed by in its rotation."""
    one, other = (np.array(shown["bodies"][body]["rotation"]) for shown in (before, after))
    change = other @ one.T
    angle = np.degrees(np.arctan2(change[1, 0], change[0, 0]))
    assert np.allclose(change[:, 2], [0, 0, 1], atol=1e-12)
    return float(angle)


def test_a_controller_moves_the_page(tmp_path: Path) -> None:
    """An OPC UA server turns A1 by 30 degrees: the bodies behind it turn by that, the base stays; Python says where.

    Stopped, it is told as lost, and nothing moves; started again, the machine follows by itself.
    """
    available(prepared)

    async def run() -> None:
        controller = await plc()
        robot = softkin.Scara4ZCcoupledType1(link_length_1=300.0, link_length_2=200.0, limits=LIMITS)
        async with followed(tmp_path, controller) as page:
            before = await page.shown_where(lambda shown: shown["axes"][0] == 10)
            assert before["machine"] == SCARA and before["said"] == "live"
            ends = {one["name"]: [one["lower"], one["upper"]] for one in before["limits"]}
            assert {name: ends[name] for name in LIMITS} == LIMITS
            await controller.write("GVL.x", 4000.0)
            after = await page.shown_where(lambda shown: shown["axes"][0] != 10)
            assert np.allclose(after["axes"], [40.0, 0.02, -0.03, 0.02], rtol=0, atol=1e-12)
            assert [float(text) for text in after["fields"]] == [40.0, 0.02, -0.03, 0.02]
            assert [round(turned(before, after, body), 9) for body in ("base", "A1", "A2", "tool")] == [0, 30, 30, 30]
            assert before["bodies"]["base"] == after["bodies"]["base"]
            assert np.allclose(after["frame"]["position"], robot.forward(after["axes"])[0].position, rtol=0, atol=1e-9)
            await controller.stop()
            lost = await page.shown_where(lambda shown: shown["said"].startswith("lost"))
            assert lost["axes"] == after["axes"] and "next try in " in lost["said"]
            await controller.start()
            await controller.write("GVL.x", -2000.0)
            again = await page.shown_where(lambda shown: shown["axes"][0] == -20)
            assert round(turned(after, again, "A1"), 9) == -60
            await page.shown_where(lambda shown: shown["said"] == "live")
        await controller.stop()

    asyncio.run(run())
