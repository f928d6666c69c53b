"""One profile for all property tests: the same examples on every machine, and no time limit on a shared one.

Every test is given its mechanism, where it has one. Tests of one mechanism run in one process, so that what they share
is made once, and so do those of one machine that is in no catalogue. `make quick` runs units, and of the catalogue one
mechanism for each path through the compiler; tests that are marked `slow` or `long` it leaves out.
`make test` leaves out the slow ones, and `make sweep` runs them.

The process that only hands the tests out reads this file, too: the compiler is imported where it is needed.
"""

from __future__ import annotations

import gc
import os
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

from tests.view.driver import BROWSER

if TYPE_CHECKING:
    from tests.generation import Generation

settings.register_profile("softkin", deadline=None, derandomize=True)
# Every property is tried in `make quick`; `make test` tries a hundred examples of it.
settings.register_profile("quick", settings.get_profile("softkin"), max_examples=10)
settings.load_profile("softkin")
# What is derived and compiled for a mechanism lives as long as its process: looking for garbage among it after every
# 700 new objects took a fifth of the time, and looking through all of it once more at each hundredth pass is enough.
gc.set_threshold(50_000, 100, 100)
# The core that is asked is Python's, unless `python -m tests.native` has built the other one and asks for it.
IS_NATIVE = os.environ.setdefault("SOFTKIN_CORE", "python") == "native"
collect_ignore = [] if IS_NATIVE else ["native"]

ROOT = Path(__file__).parent
FOLDERS_OF_QUICK = ("unit", "harness", "catalogue", "text", "languages")
"""Where `make quick` looks for tests."""
SLOW, BROAD, NOT_QUICK = ("slow",), ("broad",), ("slow", "long")
"""The markers of tests that `make test` leaves out, in all cases or for most mechanisms, and that `make quick` does."""
LEFT_OUT_AS_A_WHOLE = re.compile(r"^pytestmark = pytest\.mark\.(slow|long)$", re.MULTILINE)
"""What says of a file that none of its tests is quick."""
ALL_OF_THEM_QUICK = (("unit",), ("harness",))
"""The folders whose tests are quick where they are about no mechanism of the catalogue, and neither slow nor long."""
ASKED_WHOLE = (("native",), ("corpus",))
"""The folders that are asked about all mechanisms with the native core, where the catalogue is about the quick ones."""
OF_ONE_MECHANISM = {"hexapod": "Kin_Hexapod", "search": "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"}
"""Folders of tests about one mechanism, which their parameters do not name."""
SHARED_BY_A_FILE = ("codesys/", "text/selftest/", "text/test_portable.py", "text/test_second_grammar.py", "unit/")
"""Tests that share more with those of their file than with those of their mechanism: all units compiled together, a
grammar."""
SHARED_BY_A_FOLDER = ("text/contract/",)
"""Folders whose files share all units compiled together: their tests run in one process."""
OF_A_GENERATION = ("test_generated_is_fresh.py", "view/")
"""Tests that share a generation of the whole catalogue, and the browser that shows it."""
OF_A_TYPE_CHECKER = ("test_style.py", "typing/")
"""Tests that share what mypy keeps of the types that it read, where two processes must not write at once."""
WITH_THEIR_MECHANISM = ("unit/drawing/", "unit/optimize/test_regular.py")
"""Units that need all programs of a mechanism, which its other tests have built."""
PATHS = {
    "Kin_Scara4_ZCcoupled_Type1": "a serial arm in a plane, with turns and a coupled axis",
    "Kin_Pos_RRR": "a serial arm in space",
    "Kin_P2C_Type1": "a closed loop",
    "Kin_Hexapod": "a plate that moves with its whole pose",
    "Kin_Ac6_RZRYRYRXRYRZ_J6Offset": "an arm that is searched along",
    "Kin_Wrist2": "orientation kinematics, and couplings with it",
}
"""The paths through the compiler, and a mechanism that goes along each."""


def pytest_configure(config: pytest.Config) -> None:
    """Take fewer examples where only the quick tests are asked for, and forget which browser an earlier run had."""
    if _is_quick(config):
        settings.load_profile("quick")
    if not hasattr(config, "workerinput"):
        BROWSER.unlink(missing_ok=True)


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    """Look for garbage once more, so that a file that nobody closed is told, and not again: pytest and Python would go
    through all that is derived five times, and take it apart object by object, in a fifteenth of the time of a run.
    `make quick` leaves that one look to `make test`.
    """
    if not _is_quick(session.config):
        gc.collect()
    gc.freeze()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say in one line which browser showed the viewer, or that none could be had."""
    if BROWSER.is_file():
        terminalreporter.line(BROWSER.read_text(encoding="utf-8").splitlines()[0])


@pytest.fixture(scope="session")
def generation() -> Generation:
    """What the descriptions of the whole catalogue give."""
    from tests.generation import generated

    return generated()


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Where only the quick tests are asked for, leave out the files that have none: they are not even imported."""
    if not _is_quick(config) or not collection_path.is_relative_to(ROOT) or collection_path == ROOT:
        return None
    if collection_path.relative_to(ROOT).parts[0] not in FOLDERS_OF_QUICK:
        return True
    is_test = collection_path.match("test_*.py")
    return True if is_test and LEFT_OUT_AS_A_WHOLE.search(collection_path.read_text(encoding="utf-8")) else None


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the quick tests, and tell xdist which tests share what they make: before xdist looks."""
    is_shared_out = hasattr(config, "workerinput")
    for item in items:
        folders, file = _place_of(item.path)
        names = mechanisms_of(item, folders)
        place = f"{file}::{item.name}"
        is_quick = set(names) <= PATHS.keys() if names else folders[:1] in ALL_OF_THEM_QUICK
        is_quick |= IS_NATIVE and folders[:1] in ASKED_WHOLE
        is_broad = _is_marked(item, BROAD) and not set(names) <= PATHS.keys()
        if is_quick and not _is_marked(item, SLOW if IS_NATIVE else NOT_QUICK):
            item.add_marker("quick")
        elif IS_NATIVE or is_broad or _is_marked(item, SLOW):
            item.add_marker("sweep")
        if is_shared_out:
            item.add_marker(pytest.mark.xdist_group(_group_of(item, place, folders, names)))


def _is_quick(config: pytest.Config) -> bool:
    """Whether this is `make quick`."""
    return config.option.markexpr == "quick"


def _is_marked(item: pytest.Item, names: tuple[str, ...]) -> bool:
    """Whether a test has one of these markers: in all of its cases, or in those that a word of its marker stands in."""
    callspec = getattr(item, "callspec", None)
    case = callspec.id if callspec is not None else ""
    marks = [mark for name in names for mark in item.iter_markers(name)]
    return any(not m.args or any(word in case for word in m.args) for m in marks)


def _group_of(item: pytest.Item, place: str, folders: tuple[str, ...], names: list[str]) -> str:
    """The name of what a test shares with others, which run in the same process."""
    for together in (OF_A_GENERATION, OF_A_TYPE_CHECKER, SHARED_BY_A_FOLDER):
        if place.startswith(together):
            return together[0]
    shared = [] if not folders or _is_shared_by_its_file(place) else names or machines_of(item, folders)
    return shared[0] if shared else place.partition("::")[0]


@cache
def _place_of(path: Path) -> tuple[tuple[str, ...], str]:
    """The folders that a file is in, and where it stands, from here."""
    found = path.relative_to(ROOT)
    return found.parts[:-1], "" if found == Path() else found.as_posix()


def _is_shared_by_its_file(place: str) -> bool:
    return place.startswith(SHARED_BY_A_FILE) and not place.startswith(WITH_THEIR_MECHANISM)


def mechanisms_of(item: pytest.Item, folders: tuple[str, ...]) -> list[str]:
    """The names of the mechanisms that a test's parameters name, or that its folder is about."""
    callspec = getattr(item, "callspec", None)
    words = re.findall(r"\w+", callspec.id) if callspec is not None else []
    found = [_names()[word] for word in words if word in _names()]
    return found or [OF_ONE_MECHANISM[folder] for folder in folders if folder in OF_ONE_MECHANISM]


def machines_of(item: pytest.Item, folders: tuple[str, ...]) -> list[str]:
    """The names of the machines in no catalogue that a test's parameters name, or that its text does."""
    if folders[:1] not in (("machines",), ("languages",)):
        return []
    callspec = getattr(item, "callspec", None)
    words = list(callspec.params.values()) if callspec is not None else []
    said = [*words, *item.function.__code__.co_consts]  # type: ignore[attr-defined]
    told = [word for part in said for word in (part if isinstance(part, tuple) else (part,))]
    return [word for word in told if isinstance(word, str) and word in _machines()]


@cache
def _machines() -> frozenset[str]:
    """The names of the machines that are derived once a process, which several files ask."""
    from tests.machines.carried import CARRIED
    from tests.machines.collection import MACHINES
    from tests.machines.free_machines import FREED
    from tests.machines.guided import GUIDED
    from tests.machines.parallel_machines import PARALLEL

    return frozenset({**MACHINES, **CARRIED, **GUIDED, **FREED, **PARALLEL})


@cache
def _names() -> dict[str, str]:
    """The name of a mechanism by its own and by that of its block."""
    from tests.mechanisms import catalogue

    mechanisms = [mechanism for _, mechanism in catalogue()]
    return {word: m.name for m in mechanisms for word in (m.name, m.block_name, f"{m.block_name}_SelfTest")}
