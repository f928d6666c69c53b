"""Compile every C source of a folder with clang, each warning an error: `make clang`. The tests do so with gcc."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

COMPILE = (
    sys.executable, "-m", "ziglang", "cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-O0", "-c",
)  # fmt: skip
"""The clang that the package ziglang brings, for machines without one."""


def faults(folder: Path) -> list[str]:
    """What clang says of the sources that it does not compile."""
    sources = sorted(folder.glob("*.c"))
    if not sources:
        return [f"{folder} has no C source: run make c"]
    with TemporaryDirectory(prefix="clang-") as made, ThreadPoolExecutor(2) as threads:
        return [told for told in threads.map(lambda source: _fault(source, Path(made)), sources) if told]


def _fault(source: Path, made: Path) -> str:
    target = made / f"{source.stem}.o"
    found = subprocess.run([*COMPILE, "-o", str(target), str(source)], capture_output=True, text=True, check=False)
    return found.stderr if found.returncode else ""


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    told = faults(folder)
    print(
        "\n".join(told) or f"clang compiles the {len(list(folder.glob('*.c')))} sources of {folder} without a warning"
    )
    sys.exit(1 if told else 0)
