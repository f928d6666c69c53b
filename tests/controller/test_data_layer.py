"""The ctrlX data layer, against a small server of its REST interface over TLS: tokens, nodes, certificates, losses."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from derive.controller.refusal import Refused
from derive.controller.settings import Security
from tests.controller.controllers import PASSWORD, USER, Ctrlx, another_authority, ctrlx, trusted
from tests.controller.pages import GANTRY, PATIENCE, message_where, page_of, served, settings

POSITION = "motion/axs/AxisX/state/values/actual/pos"
SYMBOL = "plc/app/Application/sym/GVL/y a#1"
NODES = {"axes": {"X": POSITION, "Y": {"node": SYMBOL, "scale": 10}}}


@pytest.fixture(autouse=True)
def credentials(monkeypatch: pytest.MonkeyPatch) -> None:
    """The user, as the environment has it."""
    monkeypatch.setenv("SOFTKIN_USER", USER)
    monkeypatch.setenv("SOFTKIN_PASSWORD", PASSWORD)


def test_values_and_what_is_none(tmp_path: Path) -> None:
    """One log-in, then numbers of every type; other types, errors and what is no JSON number are bad, with a reason."""

    async def run() -> None:
        async with ctrlx({POSITION: 12.5, SYMBOL: {"type": "int16", "value": -3}}) as controller:
            given = {**GANTRY, **NODES, "source": controller.address}
            told = settings(tmp_path, given, Security(trusted(tmp_path)))
            async with served(told) as running, page_of(running) as page:
                good = await message_where(page, lambda m: m["complete"])
                assert (good["axes"], good["status"]) == ([12.5, -30.0], "live")
                for answer, reason in (
                    ({"type": "string", "value": "1"}, "no number, but of the type 'string'"),
                    ({"type": "bool8", "value": True}, "no number, but of the type 'bool8'"),
                    ({"type": "ardouble", "value": [1.0]}, "no number, but of the type 'ardouble'"),
                    ({"type": "double", "value": "NaN"}, "no number: 'NaN'"),
                    ({"type": "double"}, "no number: None"),
                    (404, "404 a problem of this node"),
                    (403, "403 a problem of this node"),
                    (500, "500 a problem of this node"),
                ):
                    controller.nodes[POSITION] = answer
                    bad = await message_where(page, lambda m: not m["complete"])
                    assert (bad["axes"], bad["reasons"]) == ([None, -30.0], [reason, ""])
                    controller.nodes[POSITION] = 1.0
                    await message_where(page, lambda m: m["complete"])
                assert controller.log_ins == 1
            assert not controller.tokens, "its session is ended, for there may be few"

    asyncio.run(run())


def test_a_token_that_has_run_out_is_renewed(tmp_path: Path) -> None:
    """Without a loss: the next answer comes with a new token."""

    async def run() -> None:
        async with ctrlx({POSITION: 1.0, SYMBOL: 2.0}) as controller:
            told = settings(tmp_path, {**GANTRY, **NODES, "source": controller.address}, Security(trusted(tmp_path)))
            async with served(told) as running, page_of(running) as page:
                await message_where(page, lambda m: m["complete"])
                controller.tokens.clear()
                controller.nodes[POSITION] = 5.0
                assert (await message_where(page, lambda m: m["axes"][0] == 5.0))["complete"]
                assert controller.log_ins == 2 and running.said[1:] == ["connecting", "live"]

    asyncio.run(run())


def test_a_lost_controller_is_found_again(tmp_path: Path) -> None:
    """Stopped and started again at the same place, where old tokens are no longer known."""

    async def run() -> None:
        async with ctrlx({POSITION: 1.0, SYMBOL: 2.0}) as controller:
            told = settings(tmp_path, {**GANTRY, **NODES, "source": controller.address}, Security(trusted(tmp_path)))
            async with served(told) as running, page_of(running) as page:
                await message_where(page, lambda m: m["complete"])
                await controller.stop()
                lost = await message_where(page, lambda m: m["status"] == "lost")
                assert lost["axes"] == [1.0, 20.0] and controller.address in lost["message"]
                controller.nodes[POSITION] = -7.0
                await controller.start()
                again = await message_where(page, lambda m: m["status"] == "live")
                assert again["axes"] == [-7.0, 20.0]

    asyncio.run(run())


def test_certificates_and_users(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whom nobody vouches for gets no password, unless that is switched off by name; a wrong password is told."""

    async def why_not(controller: Ctrlx, security: Security) -> str:
        told = settings(tmp_path, {**GANTRY, **NODES, "source": controller.address}, security)
        async with served(told) as running:
            with pytest.raises(Refused) as problem:
                await asyncio.wait_for(running.task, PATIENCE)
            assert running.said[-1] == f"refused: {problem.value}"
            return str(problem.value)

    async def run() -> None:
        async with ctrlx({POSITION: 1.0, SYMBOL: 2.0}) as controller:
            for wrong in (Security(), Security(trusted(tmp_path, another_authority()))):
                assert "the certificate of https://127.0.0.1" in await why_not(controller, wrong)
            assert not controller.asked
            told = settings(tmp_path, {**GANTRY, **NODES, "source": controller.address}, Security(is_unchecked=True))
            async with served(told) as running, page_of(running) as page:
                assert (await message_where(page, lambda m: m["complete"]))["axes"] == [1.0, 20.0]
            another = controller.address.replace("127.0.0.1", "localhost")
            told = settings(tmp_path, {**GANTRY, **NODES, "source": another}, Security(trusted(tmp_path)))
            async with served(told) as running:
                with pytest.raises(Refused, match="the certificate of https://localhost.* not valid for 'localhost'"):
                    await asyncio.wait_for(running.task, PATIENCE)
            monkeypatch.setenv("SOFTKIN_PASSWORD", "wrong one")
            said = await why_not(controller, Security(trusted(tmp_path)))
            assert "does not know this user and password: 401 Not authorized" in said and "wrong one" not in said

    asyncio.run(run())


def test_an_authority_that_cannot_be_read(tmp_path: Path) -> None:
    """The file is named."""

    async def run() -> None:
        told = settings(tmp_path, {**GANTRY, **NODES, "source": "https://localhost"}, Security(tmp_path / "none.pem"))
        async with served(told):
            raise AssertionError("it is served")

    with pytest.raises(Refused, match=r"none\.pem: no certificate \(PEM\) can be read"):
        asyncio.run(run())
