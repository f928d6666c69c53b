"""What tests have outside of their process: folders, which go when the tests are over, and programs, which end well."""

import atexit
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import mkdtemp
from typing import Any


def temporary(purpose: str) -> Path:
    made = Path(mkdtemp(prefix=f"{purpose}-"))
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    return made


def written(texts: Mapping[str, str], where: Path) -> Path:
    """The folder with files, by their paths in it."""
    for path, text in texts.items():
        (where / path).parent.mkdir(parents=True, exist_ok=True)
        (where / path).write_text(text, encoding="utf-8")
    return where


def output_of(command: Sequence[str | Path], **options: Any) -> str:
    """What a program writes. options: of `subprocess.run`."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout
