"""`softkin`: describe a machine, derive it, look at its derivation; and `generate`, which writes the whole catalogue.

softkin new my_machine.py                  write a commented description to start from
softkin like linuxcnc xyzac                name the block for kinematics as a vendor calls them
softkin import robot.urdf --meshes         write the description of a robot file, and take its meshes to the viewer
softkin explain my_machine.py              print each step of its derivation, and its branches to be named
softkin explain --html my_machine.py       the same as a page, with pictures, its Jacobian and its singularities
softkin check my_machine.py                derive and measure it, and write nothing
softkin derive my_machine.py --out build   derive it: Python package, Structured Text, PLCopenXML, picture
softkin view my_machine.py                 write a page that shows it in a browser
softkin live --machine my_machine.json     show it in the browser, moved by the axis values of its controller
softkin calibrate samples.csv --machine my_machine.json --out true.json   find its deviations from measurements

Status 0 is success; 2 a machine, or a command, that cannot be right; 1 a catalogue that is not as it should be;
3 a mistake of the compiler, which says what to report.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from derive.command import calibrate, catalogue, explain, like, live, new, own, report, view
from derive.description.catalogue import MECHANISMS
from derive.description.mechanism import DescriptionError
from derive.faults import GenerationError, error
from derive.importing import importing
from derive.output import ForeignFolder
from derive.pipeline import LANGUAGES

_STALE, _INTERRUPTED = 1, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command. Returns 0 where it succeeded, else 1, 2 or 3, with one message for each fault on stderr."""
    options = _options(arguments)
    is_catalogue = options.run in (catalogue.generate, catalogue.compare, report.report)
    try:
        return int(options.run(options))
    except (DescriptionError, GenerationError, ForeignFolder, OSError) as problem:
        return own.refused(problem, options.traceback, _STALE if is_catalogue else own.WRONG)
    except Exception as problem:
        return own.refused(error(None, problem), options.traceback)
    except KeyboardInterrupt:
        return _INTERRUPTED


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    is_script = Path(sys.argv[0]).stem == "softkin"
    parser = argparse.ArgumentParser(
        prog="softkin" if is_script else "python -m derive",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _own_commands(commands)
    _catalogue_commands(commands)
    for command in commands.choices.values():
        command.add_argument("--traceback", action="store_true", help="print where a mistake of the compiler was met")
    options = parser.parse_args(arguments)
    if options.command == "check":
        options.run = own.check if options.files else catalogue.compare
    if options.command == "report" and options.files:
        options.run = explain.explain
    return options


def _own_commands(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """The commands for machines of the user's own."""
    text = "derive machines, each from its file, and write what a user of it needs"
    derive = commands.add_parser("derive", help=text, description=text)
    derive.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a description, or a folder of them")
    derive.add_argument(
        "--out",
        type=Path,
        default=Path("build"),
        metavar="DIR",
        help="the output folder (default: build); of several machines each has a folder inside it",
    )
    derive.add_argument("--package", metavar="NAME", help="the Python package (default: the name of the file)")
    _languages(derive)
    derive.set_defaults(run=own.derive)
    text = "derive and measure machines, and write nothing; without a file: compare the output of the catalogue"
    check = commands.add_parser("check", help=text, description=text)
    check.add_argument("files", nargs="*", type=Path, metavar="FILE", help="a description, or a folder of them")
    _catalogue_options(check)
    check.set_defaults(only=[], fresh=True, package=None, keep_going=True, language=None)
    for parser in (derive, check):
        parser.add_argument("--calibrated", action="store_true", help=_CALIBRATED)
        parser.add_argument(
            "--keep-going",
            action=argparse.BooleanOptionalAction,
            default=True,
            help="go on with the next machine where one cannot be derived (the default)",
        )
    derive.add_argument("--profile", metavar="NAME", help=_PROFILE)
    text = "print each step of the derivation, its determinant, and the branch that it makes"
    explained = commands.add_parser("explain", help=text, description=text)
    explained.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a description, or a folder of them")
    explained.add_argument("--html", action="store_true", help="write it as a page, with pictures, and name the file")
    explained.add_argument("--programs", action="store_true", help="print the derived programs as text instead")
    explained.add_argument("--out", type=Path, default=report.OUTPUT, metavar="DIR", help=_PAGES)
    explained.set_defaults(run=explain.explain)
    _view_command(commands)
    text = "write a commented description to start from"
    new.arguments(commands.add_parser("new", help=text, description=text))
    text = "name the block for kinematics as a vendor calls them, and the meaning of the vendor's parameters"
    like.arguments(commands.add_parser("like", help=text, description=text))
    text = "write a description of a robot file (URDF, MJCF, a DH table), to be read, edited and derived"
    imported = commands.add_parser("import", help=text, description=text)
    importing.add_arguments(imported)
    imported.set_defaults(run=importing.run)
    text = "find the deviations of a machine from measured samples, or propose poses to measure"
    calibrate.add_arguments(commands.add_parser("calibrate", help=text, description=text))
    text = "serve the viewer on this computer, and move it with the axis values of a controller"
    live.add_arguments(commands.add_parser("live", help=text, description=text))


def _view_command(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    text = "write a page that shows machines in a browser, from disk; without a file: the whole catalogue in one page"
    shown = commands.add_parser("view", help=text, description=text)
    shown.add_argument("files", nargs="*", type=Path, metavar="FILE", help="a description, or a folder of them")
    shown.add_argument(
        "--out", type=Path, default=Path("build"), metavar="DIR", help="the folder of the page (default: build)"
    )
    shown.add_argument(
        "--model",
        action="append",
        default=[],
        metavar="BODY=FILE.glb[*SCALE]",
        help="a mesh (binary glTF) in the place of a body of one machine: base, the axes that move it, plate, tool",
    )
    shown.add_argument("--calibrated", action="store_true", help=_CALIBRATED)
    shown.set_defaults(
        run=view.view, mechanisms=MECHANISMS, only=[], profile=None, fresh=False, language=["javascript"],
        output=catalogue.OUTPUT,
    )  # fmt: skip


def _languages(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--language",
        action="append",
        choices=LANGUAGES,
        help="write this language, into its folder alone; may be given several times (default: python and st)",
    )


_CALIBRATED = "with the deviations of axes, base and tool as further inputs: the machine as it was measured"
_PROFILE = "a profile of templates/st/softmotion.toml, for an older library or flat blocks; several are joined by +"
_PAGES = f"the folder of pages (default: {report.OUTPUT})"


def _catalogue_commands(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """The commands for the catalogue as a whole."""
    text = "derive every mechanism of a folder, check it, and write all of them as one package and one library"
    generate = commands.add_parser("generate", help=text, description=text)
    _catalogue_options(generate)
    generate.add_argument(
        "--only", nargs="+", default=[], metavar="NAME", help="these mechanisms alone, into another folder"
    )
    _languages(generate)
    generate.add_argument("--fresh", action="store_true", help="derive everything, without the cache")
    generate.add_argument(
        "--keep-going",
        action="store_true",
        help="write the mechanisms that can be derived; without it, one fault leaves the output folder as it was",
    )
    generate.set_defaults(run=catalogue.generate)
    text = "write a page of machines, or of the whole catalogue: the derivation, step by step, with pictures and maps"
    pages = commands.add_parser("report", help=text, description=text)
    pages.add_argument("files", nargs="*", type=Path, metavar="FILE", help="a description, or a folder of them")
    pages.add_argument("--out", type=Path, default=report.OUTPUT, metavar="DIR", help=_PAGES)
    pages.add_argument("--mechanisms", type=Path, default=MECHANISMS, metavar="DIR", help="the folder of descriptions")
    pages.add_argument("--only", nargs="+", default=[], metavar="NAME", help="these mechanisms alone")
    pages.set_defaults(run=report.report, html=True, programs=False)


def _catalogue_options(parser: argparse.ArgumentParser) -> None:
    names = ("--out", "--output")
    parser.add_argument(
        *names, dest="output", type=Path, default=catalogue.OUTPUT, metavar="DIR", help="the output folder"
    )
    parser.add_argument("--mechanisms", type=Path, default=MECHANISMS, metavar="DIR", help="the folder of descriptions")
    parser.add_argument("--profile", metavar="NAME", help=_PROFILE)
