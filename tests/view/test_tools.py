"""What npm installs, once, whoever else installs it; and what a missing browser is: a fault in CI, else one line."""

import subprocess
from pathlib import Path

import pytest

from derive.command import view
from derive.command.line import main
from derive.command.new import description
from derive.view import node
from derive.view.node import PACKAGES, MissingTool, installed
from tests.view import driver as told
from tests.view.driver import available


@pytest.fixture
def npm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """npm, played: it makes the folder of modules where it runs; the folders in which it ran."""
    ran: list[Path] = []

    def run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
        assert command[2:4] == ["ci", "--ignore-scripts"]
        (folder / "node_modules").mkdir()
        (folder / "node_modules" / "three.js").write_text(f"{len(ran)}")
        ran.append(folder)
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr(node, "run", run)
    for name in PACKAGES:
        (tmp_path / name).write_text("{}")
    return ran


def test_packages_are_installed_once(tmp_path: Path, npm: list[Path]) -> None:
    """A second time nothing runs; another lockfile installs again; nothing is left of the folder where npm ran."""
    target = tmp_path / "packages"
    assert installed(tmp_path, target) == installed(tmp_path, target) == target / "node_modules"
    assert len(npm) == 1
    (tmp_path / PACKAGES[1]).write_text("{ }")
    assert (installed(tmp_path, target) / "three.js").read_text() == "1"
    assert [path.name for path in target.iterdir()] == ["node_modules"]


def test_another_process_was_faster(tmp_path: Path, npm: list[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    """What it has installed meanwhile is kept, and not taken away from under it."""
    target, play = tmp_path / "packages", node.run
    faster = iter([True])

    def run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
        if next(faster, False):
            installed(tmp_path, target)  # which runs npm itself
        return play(command, folder)

    monkeypatch.setattr(node, "run", run)
    assert (installed(tmp_path, target) / "three.js").read_text() == "0"
    assert len(npm) == 2


def test_what_npm_cannot_bring_is_told(tmp_path: Path, npm: list[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    """In its own words, and nothing stands there that would count as installed."""
    failed = subprocess.CompletedProcess([], 1, "", "no network\n")
    monkeypatch.setattr(node, "run", lambda command, folder: failed)
    with pytest.raises(MissingTool, match="no network"):
        installed(tmp_path, tmp_path / "packages")
    assert list((tmp_path / "packages").iterdir()) == []


def test_what_does_not_end_has_failed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As npm does where a network does not answer."""
    monkeypatch.setattr(node, "_LONGEST", 0.5)
    with pytest.raises(subprocess.CalledProcessError):
        node.run([str(node.node()), "-e", "setTimeout(() => {}, 60000)"], tmp_path).check_returncode()


@pytest.mark.parametrize("is_ci", [True, False])
def test_a_missing_browser(is_ci: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In CI it is a fault; elsewhere the tests of the viewer are left out, and the summary says so in one line."""
    monkeypatch.setattr(told, "BROWSER", tmp_path / "build" / "browser.txt")
    monkeypatch.setenv("CI", "1" if is_ci else "")

    def nothing() -> None:
        raise MissingTool("no browser: ENOTFOUND\n at a line\n at another")

    with pytest.raises(MissingTool if is_ci else pytest.skip.Exception):
        available(nothing)
    line = "the viewer was not shown: no browser: ENOTFOUND at a line at another\n"
    assert (tmp_path / "build" / "browser.txt").read_text() == line


def test_a_missing_tool_is_told_before_anything_is_derived(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing() -> Path:
        raise MissingTool("the viewer needs Node.js: get it")

    monkeypatch.setattr(view, "node", missing)
    (tmp_path / "my_machine.py").write_text(description("my_machine.py", "MyMachine"))
    assert main(["view", str(tmp_path / "my_machine.py")]) == 2
    out, err = capsys.readouterr()
    assert out == "" and "error: the viewer needs Node.js: get it" in err
