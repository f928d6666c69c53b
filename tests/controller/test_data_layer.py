"""The ctrlX data layer, against a small server of its REST interface over TLS: tokens, nodes, certificates, losses."""

import asyncio
import contextlib
from pathlib import Path

import pytest

from derive.controller.feed import Feed
from derive.controller.refusal import Lost, Refused
from derive.controller.run import source_of, who
from derive.controller.settings import Security
from tests.controller.controllers import PASSWORD, USER, Ctrlx, another_authority, ctrlx, trusted, wire
from tests.controller.pages import GANTRY, PATIENCE, found_again, message_where, page_of, served, settings

POSITION = "motion/axs/AxisX/state/values/actual/pos"
SYMBOL = "plc/app/Application/sym/GVL/y a#1"
NODES = {"axes": {"X": POSITION, "Y": {"node": SYMBOL, "scale": 10}}}


@pytest.fixture(autouse=True)
def credentials(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOFTKIN_USER", USER)
    monkeypatch.setenv("SOFTKIN_PASSWORD", PASSWORD)


async def test_values_and_what_is_none(tmp_path: Path) -> None:
    """One log-in, then numbers of every type; other types, errors and what is no JSON number are bad, with a reason."""
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


async def test_a_token_that_has_run_out_is_renewed(tmp_path: Path) -> None:
    """Without a loss: the next answer comes with a new token."""
    async with ctrlx({POSITION: 1.0, SYMBOL: 2.0}) as controller:
        told = settings(tmp_path, {**GANTRY, **NODES, "source": controller.address}, Security(trusted(tmp_path)))
        async with served(told) as running, page_of(running) as page:
            await message_where(page, lambda m: m["complete"])
            controller.tokens.clear()
            controller.nodes[POSITION] = 5.0
            assert (await message_where(page, lambda m: m["axes"][0] == 5.0))["complete"]
            assert controller.log_ins == 2 and running.said[1:] == ["connecting", "live"]


async def test_a_lost_controller_is_found_again(tmp_path: Path) -> None:
    """Stopped and started again at the same place, where old tokens are no longer known."""
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


@pytest.mark.slow
async def test_a_controller_that_does_not_answer_any_more(tmp_path: Path) -> None:
    """Noticed, and found again, as quickly as by OPC UA."""
    async with ctrlx({POSITION: 1.0, SYMBOL: 2.0}) as controller, wire(controller.port) as cable:
        given = {**GANTRY, **NODES, "source": f"https://127.0.0.1:{cable.port}"}
        assert await found_again(settings(tmp_path, given, Security(trusted(tmp_path))), cable) == [1.0, 20.0]


DEEP = 60_000
_VALUES = (b"[" * DEEP + b"]" * DEEP, b"9" * 9000, b"1e999", b"NaN", b"{}")
_TYPES = (b"[]", b'["double"]', b"{}", b"null", b"7", b"true", b'"' + b"x" * DEEP + b'"')
_TITLES = (b"[" * 900 + b"]" * 900, b'"\\ud800\\u001b[2J"', b"7")
ODD = [
    *(bytes([one]) * DEEP for one in b'[{"9-'),
    *(b'{"type":"double","value":' + one + b"}" for one in _VALUES),
    *(b'{"type":' + one + b',"value":1}' for one in _TYPES),
    *(b'{"title":' + one + b"}" for one in _TITLES),
    *(b"", b"null", b"7", b'"\xff"', b"\xff\xfe", b"\xff\xfe[\x00", b"\0", b"<html>", b"x" * 10_000_000),
]
"""Bodies of answers that no controller should give: too deep, too long, of other types, not of UTF-8, no JSON."""


@pytest.mark.parametrize("place", ["log-in", "node"])
async def test_odd_answers_end_nothing(place: str, tmp_path: Path) -> None:
    """Where a node answers so, its value is bad; where a log-in does, the connection is lost."""
    async with ctrlx({POSITION: 1.0, SYMBOL: 2.0}) as controller:
        told = settings(tmp_path, {**GANTRY, **NODES, "source": controller.address}, Security(trusted(tmp_path)))
        data_layer = source_of(told, who(told))
        feed = Feed(told.channels)
        for code, body in ((code, body) for body in ODD for code in (200, 201, 401, 500)):
            controller.raw[place] = (code, body)
            reading, told_of = map(asyncio.ensure_future, (data_layer.run(feed), feed.changed(PATIENCE)))
            await asyncio.wait((reading, told_of), return_when=asyncio.FIRST_COMPLETED)
            reading.cancel()
            told_of.cancel()
            with contextlib.suppress(Lost, Refused, asyncio.CancelledError):
                await reading
            said = [feed.condition.message, *(reading.reason for reading in feed.readings.values())]
            assert all(len(one) < 400 for one in said)
            assert place == "log-in" or code == 401 or feed.readings["X"].value is None
        controller.raw.clear()
        async with served(told) as running, page_of(running) as page:
            assert (await message_where(page, lambda m: m["complete"]))["axes"] == [1.0, 20.0]


async def test_certificates_and_users(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whom nobody vouches for gets no password, unless that is switched off by name; a wrong password is told."""

    async def why_not(controller: Ctrlx, security: Security) -> str:
        told = settings(tmp_path, {**GANTRY, **NODES, "source": controller.address}, security)
        async with served(told) as running:
            with pytest.raises(Refused) as problem:
                await asyncio.wait_for(running.task, PATIENCE)
            assert running.said[-1] == f"refused: {problem.value}"
            return str(problem.value)

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


def test_an_authority_that_cannot_be_read(tmp_path: Path) -> None:
    """The file is named."""

    async def run() -> None:
        told = settings(tmp_path, {**GANTRY, **NODES, "source": "https://localhost"}, Security(tmp_path / "none.pem"))
        async with served(told):
            raise AssertionError("it is served")

    with pytest.raises(Refused, match=r"none\.pem: no certificate \(PEM\) can be read"):
        asyncio.run(run())
