"""`softkin like`: vendors' names, the blocks for them, and their parameters, which the documentation prints."""

import re

import pytest

from derive.command.like import known, table
from derive.five_axes import ORDERS
from tests.command.files import ROOT, Folder
from tests.mechanisms import catalogue

MECHANISMS = {m.name: m for _, m in catalogue()}


def test_it_finds_by_vendor_and_name(folder: Folder) -> None:
    said = folder.run("like", "linuxcnc", "XYZAC-trt")
    assert said.status == 0 and said.out.startswith("LinuxCNC xyzac-trt-kins: Softkin_TableTable_AC\n")
    assert "y-offset = -pivot_y" in said.out and "published in: 5-Axis Kinematics, and the source" in said.out
    assert folder.run("like", "klipper").out.count("Klipper") == sum(k.vendor == "Klipper" for k in known())
    said = folder.run("like", "perpetuum", "mobile")
    assert (
        said.status == 2 and "no kinematics with 'perpetuum mobile' is known: name one of CODESYS, Beckhoff" in said.err
    )


@pytest.mark.parametrize("name", [name for k in known() for name in k.names])
def test_every_block_and_parameter_is_there(name: str) -> None:
    """What stands behind an equals sign is a parameter of the block, or of one of its numbered kind."""
    for entry in (k for k in known() if name in k.names):
        blocks = re.findall(r"(?:Kin|Softkin)_\w*[a-z0-9A-Z]", entry.block)
        orders = re.findall(r"(?<!Softkin_)\b\w+Table_[ABC]{2}", entry.block)
        assert set(blocks) <= set(MECHANISMS) and {o for o in orders if not o.startswith("Softkin")} <= set(ORDERS)
        named = {p.name for block in blocks for p in MECHANISMS[block].parameters}
        named |= {f"offset_{j.key}" for block in blocks for j in MECHANISMS[block].joints}
        words = {
            w for w in re.findall(r"\b[a-z]+(?:_[a-z0-9]+)+\b", entry.meaning) if not w.startswith(("stepper", "delta"))
        }
        assert all(w in named or w.replace("_i", "_1") in named for w in words), words - named


def test_the_documentation_has_the_table() -> None:
    assert table() in (ROOT / "docs/MECHANISMS.md").read_text(encoding="utf-8")
