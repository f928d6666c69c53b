"""The cache of `generate`: what is kept is the same, what changed is derived anew, and what is damaged is never
believed."""

import json
import os
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
import sympy as sp

from derive import cache as caching
from derive.cache import Cache, canonical, entry_key, foundation, key_of
from derive.command import catalogue as command_line
from derive.command.catalogue import OUTPUT
from derive.command.line import main
from derive.description.catalogue import MECHANISMS, load
from derive.output import differences

ROOT = MECHANISMS.parents[1]
FILES = ("kin_gantry2.py", "kin_polar.py")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A catalogue of two small mechanisms."""
    mechanisms = tmp_path / "mechanisms"
    mechanisms.mkdir()
    for name in FILES:
        shutil.copy(MECHANISMS / name, mechanisms)
    return mechanisms


def generated(folder: Path, capsys: pytest.CaptureFixture[str], *more: str) -> tuple[dict[str, bytes], list[str], str]:
    """The files after a run, the mechanisms that it derived, and its notes."""
    output = folder.parent / "generated"
    assert main(["generate", "--mechanisms", str(folder), "--output", str(output), *more]) == 0
    said = capsys.readouterr()
    derived = re.findall(r"^(\w+) +\d+ statements +[\d.]+ s ", said.out, re.MULTILINE)
    return {str(p.relative_to(output)): p.read_bytes() for p in output.rglob("*") if p.is_file()}, derived, said.err


@pytest.mark.slow
def test_what_did_not_change_is_kept_and_what_did_is_derived(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Only changed mechanisms are derived again, and the files are the same."""
    first, derived, _ = generated(folder, capsys)
    assert len(derived) == len(FILES)
    assert generated(folder, capsys) == (first, [], "")
    polar = folder / FILES[1]
    polar.write_text(polar.read_text() + "# another text\n")
    assert generated(folder, capsys) == (first, [derived[1]], "")
    polar.write_text(polar.read_text().replace('summary="', 'summary="Another. '))
    changed, again, _ = generated(folder, capsys)
    assert again == [derived[1]]
    fresh = folder.parent / "fresh"
    assert main(["generate", "--mechanisms", str(folder), "--output", str(fresh), "--fresh"]) == 0
    assert list(differences(fresh, changed)) == []
    assert changed != first


def damage_a_byte(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)


def cut_off(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-7])


def empty(path: Path) -> None:
    path.write_bytes(b"")


def swap(path: Path) -> None:
    """An entry that is whole, under the key of another one."""
    other = next(p for p in path.parent.iterdir() if p != path)
    path.write_bytes(other.read_bytes())


@pytest.mark.parametrize("damage", [damage_a_byte, cut_off, empty, swap])
def test_a_damaged_entry_is_noticed(tmp_path: Path, damage: Callable[[Path], None]) -> None:
    cache = Cache(tmp_path / "cache")
    for name in ("one", "two"):
        cache.write(key_of(name), {"name": name, "text": "x" * 100})
    damage(cache.folder / key_of("one"))
    assert cache.read(key_of("one")) is None
    assert cache.damaged == [cache.folder / key_of("one")]
    assert cache.read(key_of("two")) == {"name": "two", "text": "x" * 100}


def test_a_damaged_entry_is_derived_anew_and_said(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / FILES[1]).unlink()
    first, derived, _ = generated(folder, capsys)
    entries = list(Path(f"{folder.parent / 'generated'}.cache").iterdir())
    assert len(entries) == 2, "the mechanism, and the texts of all"
    for entry in entries:
        damage_a_byte(entry)
    found, again, notes = generated(folder, capsys)
    assert (found, again) == (first, derived)
    assert notes.count("is damaged, and was not used") == 2
    assert generated(folder, capsys) == (first, [], "")


def test_sources_that_change_during_a_run_leave_nothing_behind(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was derived then belongs to neither state."""
    states = iter(["before", *["after"] * 10])
    monkeypatch.setattr(command_line, "foundation", lambda _: next(states))
    _, derived, _ = generated(folder, capsys)
    assert len(derived) == len(FILES)
    assert not Path(f"{folder.parent / 'generated'}.cache").exists()


@pytest.mark.slow
def test_check_and_fresh_never_look_and_keep_what_they_derive(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    generated(folder, capsys)

    def refuse(*_: object) -> None:
        raise AssertionError("the cache was looked at")

    monkeypatch.setattr(caching, "json", SimpleNamespace(loads=refuse, dumps=json.dumps))
    options = ["--mechanisms", str(folder), "--output", str(folder.parent / "generated")]
    assert main(["check", *options]) == 0
    shutil.rmtree(folder.parent / "generated.cache")
    assert main(["generate", *options, "--fresh"]) == 0
    capsys.readouterr()
    assert main(["generate", *options]) == 3  # as a mistake of the compiler
    assert "AssertionError: the cache was looked at" in capsys.readouterr().err
    monkeypatch.undo()
    assert generated(folder, capsys)[1:] == ([], "")


def test_continuous_integration_derives_everything() -> None:
    """The script sets FRESH, which the Makefile hands over as the option; no cache is committed."""
    assert "\nFRESH=1 make generate\n" in (ROOT / ".ci" / "run").read_text()
    assert "$(if $(FRESH),--fresh)" in (ROOT / "Makefile").read_text()
    assert "/generated.*/" in (ROOT / ".gitignore").read_text().splitlines()
    assert f"{OUTPUT}.cache".startswith(f"{OUTPUT}.")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    for name in (
        "derive/solver/solve.py",
        "derive/mechanisms/kin_a.py",
        "derive/mechanisms/_shared.py",
        "templates/st/a.toml",
        "runtime/python/a.py",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("x = 1\n")
    (tmp_path / "pyproject.toml").write_text("")
    return tmp_path


FOUNDATIONS = (
    *("derive/solver/solve.py", "derive/mechanisms/_shared.py", "templates/st/a.toml", "runtime/python/a.py"),
    "pyproject.toml",
)


@pytest.mark.parametrize("name", FOUNDATIONS)
def test_everything_stands_on_sources(project: Path, name: str) -> None:
    before = foundation(None, project)
    assert foundation(None, project) == before
    (project / name).write_text("x = 2\n")
    assert foundation(None, project) != before
    (project / name).unlink()
    assert foundation(None, project) != before


def test_a_description_is_no_foundation(project: Path) -> None:
    before = foundation(None, project)
    (project / "derive" / "mechanisms" / "kin_a.py").write_text("x = 2\n")
    assert foundation(None, project) == before


@pytest.mark.parametrize("what", ["profile", "library", "interpreter", "platform"])
def test_everything_stands_on_what_runs_it(project: Path, monkeypatch: pytest.MonkeyPatch, what: str) -> None:
    before = foundation(None, project)
    if what == "library":
        monkeypatch.setattr(caching, "_libraries", lambda: ("sympy 0",))
    elif what == "interpreter":
        monkeypatch.setattr(caching.sys, "version", "3.99")
    elif what == "platform":
        monkeypatch.setattr(caching.platform, "platform", lambda: "another one")
    assert foundation("before_4_11" if what == "profile" else None, project) != before


def test_libraries_are_those_of_libraries_too() -> None:
    """The key of the cache includes the libraries that libraries use."""
    found = {line.split()[0] for line in caching._libraries()}
    assert found >= {"sympy", "mpmath", "casadi", "numpy", "jinja2", "markupsafe", "matplotlib", "pillow"}


def test_a_description_counts_by_what_it_evaluates_to() -> None:
    """So a value that another file gives counts as well: an assumption, a number, a name."""
    path = MECHANISMS / FILES[0]
    mechanism = load(path)
    assert entry_key("f", (path, mechanism)) == entry_key("f", (path, load(path)))
    for other in (replace(mechanism, summary="Another."), replace(mechanism, joints=mechanism.joints[::-1])):
        assert entry_key("f", (path, mechanism)) != entry_key("f", (path, other))
    assert canonical(sp.Symbol("a", real=True)) != canonical(sp.Symbol("a", real=True, positive=True))
    assert canonical((1.0,)) != canonical((1,))
    with pytest.raises(TypeError):
        canonical(lambda: 1)


def test_keys_tell_their_parts_apart() -> None:
    assert key_of("ab", "c") != key_of("a", "bc")


def test_the_entries_last_used_stay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(caching, "_KEPT", 2)
    cache = Cache(tmp_path)
    for age, name in enumerate(("new", "old", "oldest")):
        cache.write(key_of(name), name)
        os.utime(tmp_path / key_of(name), (1000 - age, 1000 - age))
    cache.tidy()
    assert [cache.read(key_of(name)) for name in ("new", "old", "oldest")] == ["new", "old", None]
