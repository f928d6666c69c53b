"""`softkin live` as a user has it: a process of its own, from the address that it prints to the values on the page."""

import asyncio
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from derive.command.line import main
from tests.command.files import RAIL, ROOT
from tests.controller.pages import GANTRY, PATIENCE, Served, message_where, page_of


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
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"
