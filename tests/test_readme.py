"""What the README shows of generated code stands in the generated files."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def plain(text: str) -> str:
    """The text without layout and comments, in lower case."""
    return re.sub(r"\s+", "", re.sub(r"//[^\n]*", "", text)).lower()


def test_the_block_in_the_readme_is_the_block_that_comes_out() -> None:
    """The block in the README is the generated one."""
    (shown,) = re.findall(r"```iecst\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    block = plain((ROOT / "generated/st/scara/Kin_Scara4_ZCcoupled_Type1.st").read_text(encoding="utf-8"))
    parts = [plain(part) for part in shown.split("…")]
    assert len(parts) == 2
    for part in parts:
        assert part in block
