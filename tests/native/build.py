"""The extension of the generated package, compiled into `build/native`: each source again where it has changed."""

import fcntl
import os
import shlex
import subprocess
import sys
import sysconfig
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "generated" / "python" / "native"
FOLDER = ROOT / "build" / "native"
"""Not in `generated/`, which holds what is generated and nothing else; tests find it on the path."""
EXTENSION = "_softkin_native"
SHARED = (
    *("softkin.c", "softkin.h", "softkin_constants.h", "softkin_rotation.h", "batches.c", "batches.h"),
    *("lanes.h", "lane_programs.h", "machine.c", "machines.c", "machines.h"),
)
"""The files that hold no machine of their own."""
STRICT = (
    "-std=c99", "-Wall", "-Wextra", "-Werror", "-Wconversion", "-fvisibility=hidden", "-ffp-contract=off",
    "-fno-math-errno", "-fno-trapping-math",
)  # fmt: skip
SANITIZED = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer")


class Unbuildable(Exception):
    """There is no compiler, or no `Python.h`; the message says which."""


def compiler() -> list[str]:
    """The compiler's command. Raises `Unbuildable` where it, or what it needs, is missing."""
    command = shlex.split(os.environ.get("CC", "gcc"))
    try:
        subprocess.run([*command, "--version"], capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        raise Unbuildable(f"no C compiler ({' '.join(command)})") from None
    if not Path(headers(), "Python.h").is_file():
        raise Unbuildable(f"no Python.h in {headers()}")
    return command


def is_required() -> bool:
    """Whether it is a fault where there is no compiler: in CI."""
    return bool(os.environ.get("CI")) or os.environ.get("NATIVE") == "required"


def headers() -> str:
    """The folder of `Python.h`."""
    return sysconfig.get_path("include")


def built(folder: Path = FOLDER, options: Sequence[str] = ("-O3",), sources: Path = SOURCES) -> Path:
    """The folder that holds the extension, which is built first where a source has changed."""
    command = [*compiler(), *STRICT, *options, "-fPIC", f"-I{headers()}"]
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        shared = "".join(path.read_text() for path in sorted(sources.glob("*.h")) if path.name in SHARED)
        with ThreadPoolExecutor(2) as pool:
            objects = list(pool.map(lambda path: _object(path, folder, command, shared), sorted(sources.glob("*.c"))))
        target = folder / f"{EXTENSION}.abi3.so"
        stamp = sha256(" ".join([*command, *(path.name for path in objects)]).encode()).hexdigest()
        if _is_new(target, stamp):
            _run([*compiler(), *options, "-shared", "-o", str(target), *map(str, objects), "-lm"])
            _stamp(target).write_text(stamp)
        for old in set(folder.glob("*.o")) - set(objects):
            old.unlink()
    return folder


def _object(source: Path, folder: Path, command: Sequence[str], shared: str) -> Path:
    """The compiled source. Its name has the digest of all that it depends on."""
    own = source.with_name(f"{source.stem.removesuffix('-lanes')}.h")
    text = "\0".join([*command, shared, own.read_text() if own.is_file() else "", source.read_text()])
    target = folder / f"{source.stem}.{sha256(text.encode()).hexdigest()[:16]}.o"
    if not target.is_file():
        partial = target.with_suffix(".part")
        _run([*command, "-c", str(source), "-o", str(partial)])
        partial.rename(target)
    return target


def _stamp(target: Path) -> Path:
    return target.with_suffix(".stamp")


def _is_new(target: Path, stamp: str) -> bool:
    return not target.is_file() or not _stamp(target).is_file() or _stamp(target).read_text() != stamp


def _run(command: Sequence[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command[:3])} … fails:\n{done.stderr}")


if __name__ == "__main__":
    try:
        print(built())
    except Unbuildable as missing:
        print(f"The native core was not built: {missing}.")
        sys.exit(1 if is_required() else 0)
