"""The command line: `python -m derive generate` writes `generated/`, `python -m derive check` compares it.

`generate` keeps what it derived beside the output folder, and derives again only what depends on something that
changed; `--fresh` neither reads nor writes that cache, and `check` never does. `import` writes a description of a robot
file.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from derive.cache import Cache, foundation
from derive.description.catalogue import MECHANISMS, Entry, catalogue
from derive.description.mechanism import DescriptionError
from derive.importing import line as importing
from derive.output import ForeignFolder, differences, replace_folder
from derive.pipeline import Built, GenerationError, derive_all, files_of, languages, work_of
from derive.progress import Progress

OUTPUT = MECHANISMS.parents[1] / "generated"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; 0 where it succeeded, else one message on stderr and 1."""
    options = _options(arguments)
    try:
        if options.command == "import":
            return importing.run(options)
        return _check(options) if options.command == "check" else _generate(options)
    except (DescriptionError, GenerationError, ForeignFolder, OSError) as problem:
        message = str(problem).replace(f"{Path.cwd()}/", "")  # paths as the user would type them
        print(f"error: {message}", file=sys.stderr)
        return 1


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m derive", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    for name, text in (
        ("generate", "derive every mechanism, check it, and write both languages"),
        ("check", "fail where the output folder is not what a fresh generation gives"),
    ):
        command = commands.add_parser(name, help=text, description=text)
        command.add_argument("--output", type=Path, default=OUTPUT, metavar="DIR", help="the output folder")
        command.add_argument("--mechanisms", type=Path, default=MECHANISMS, metavar="DIR", help="the descriptions")
        command.add_argument(
            "--profile", metavar="NAME", help="a profile of templates/st/softmotion.toml, for an older library"
        )
        command.set_defaults(only=[], fresh=True)
        if name == "generate":
            command.add_argument(
                "--only", nargs="+", metavar="NAME", help="these mechanisms alone, into another folder"
            )
            command.add_argument(
                "--fresh", action="store_true", default=False, help="derive everything, without the cache"
            )
    text = "write a description of a robot file, to be read, edited and derived"
    importing.add_arguments(commands.add_parser("import", help=text, description=text))
    return parser.parse_args(arguments)


def _generate(options: argparse.Namespace) -> int:
    if options.only and options.output == OUTPUT:
        raise GenerationError("--only needs --output: the output folder of the project holds every mechanism")
    files = _files(options)
    if any(differences(options.output, files)):
        replace_folder(options.output, files)
    print(f"{len(files)} files in {options.output}")
    return 0


def _check(options: argparse.Namespace) -> int:
    found = list(differences(options.output, _files(options)))
    if found:
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        raise GenerationError(f"{found[0]}{more}: run `make generate`")
    print(f"{options.output} is up to date")
    return 0


def _files(options: argparse.Namespace) -> dict[str, bytes]:
    """All files of a run, from the cache what it has."""
    outputs = languages(options.profile)
    cache = None if options.fresh else Cache(Path(f"{options.output}.cache"))
    before = foundation(options.profile) if cache else ""
    work = work_of(_chosen(catalogue(options.mechanisms), options.only), cache, before)
    built = []
    progress = Progress(len(work.missing), sys.stdout)
    for key, one in zip(work.keys, derive_all(work, options.profile), strict=True):
        progress.step(_line(one), one.seconds is not None)
        if cache and key and one.seconds is not None and foundation(options.profile) == before:
            cache.write(key, one.as_plain())
        built.append(one)
    progress.end()
    is_unchanged = cache is not None and foundation(options.profile) == before
    files = files_of(built, outputs, cache, work.keys if is_unchanged else ())
    if cache:
        cache.tidy()
        for path in cache.damaged:
            print(f"note: {path} is damaged, and was not used", file=sys.stderr)
    return files


def _line(one: Built) -> str:
    time = "kept" if one.seconds is None else f"{one.seconds:.2f} s"
    return f"{one.derived} {time:>8}   {one.measured}"


def _chosen(entries: tuple[Entry, ...], names: Sequence[str]) -> tuple[Entry, ...]:
    known = [mechanism.name for _, mechanism in entries]
    for name in names:
        if name not in known:
            raise GenerationError(f"no mechanism is called {name!r}; there are {', '.join(known)}")
    return tuple(e for e in entries if not names or e[1].name in names)


if __name__ == "__main__":
    sys.exit(main())
