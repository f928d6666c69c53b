"""The command line: `python -m derive generate` writes `generated/`, `python -m derive check` compares it."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from derive.description.catalogue import MECHANISMS, Entry, catalogue
from derive.description.mechanism import DescriptionError
from derive.output import ForeignFolder, differences, replace_folder
from derive.pipeline import Built, GenerationError, derive_all, languages, render_all

OUTPUT = MECHANISMS.parents[1] / "generated"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; 0 where it succeeded, else one message on stderr and 1."""
    options = _options(arguments)
    try:
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
        command.add_argument("--profile", metavar="NAME", help="a profile of templates/st/softmotion.toml, for an older library")
        command.set_defaults(only=[])
        if name == "generate":
            command.add_argument("--only", nargs="+", metavar="NAME", help="these mechanisms alone, into another folder")
    return parser.parse_args(arguments)


def _generate(options: argparse.Namespace) -> int:
    if options.only and options.output == OUTPUT:
        raise GenerationError("--only needs --output: the output folder of the project holds every mechanism")
    files = _files(options)
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
    outputs = languages(options.profile)
    built = []
    for one in derive_all(_chosen(catalogue(options.mechanisms), options.only)):
        print(_progress(one), flush=True)
        built.append(one)
    return render_all(built, outputs)


def _chosen(entries: tuple[Entry, ...], names: Sequence[str]) -> tuple[Entry, ...]:
    known = [mechanism.name for _, mechanism in entries]
    for name in names:
        if name not in known:
            raise GenerationError(f"no mechanism is called {name!r}; there are {', '.join(known)}")
    return tuple(e for e in entries if not names or e[1].name in names)


def _progress(one: Built) -> str:
    seen = one.evidence
    cost = f"{one.kinematics.mechanism.name:28}{one.statements:5} statements {one.seconds:6.2f} s"
    poses = f"   {seen.poses} poses  closure {seen.closure_residual:.0e}"
    if seen.inverted is None:
        return cost + poses
    found = seen.inverted
    solutions = f"{found.solutions} solution{'' if found.solutions == 1 else 's'}"
    return f"{cost}{poses}  round trip {found.round_trip:.0e}  Jacobian {found.jacobian:.0e}  {solutions}"


if __name__ == "__main__":
    sys.exit(main())
