"""`calibrate`: the deviations of a machine from a file of samples; or the poses that are best measured next."""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import sys
from pathlib import Path
from typing import Any

from derive.cache import ROOT
from derive.command.own import WRONG, complain

_PACKAGE, _CATALOGUE = "softkin", ROOT / "generated" / "python"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `calibrate`."""
    text = "the samples: a column for each axis, x, y, z, a rotation, sigma_…: docs/CALIBRATION.md"
    parser.add_argument("samples", type=Path, nargs="?", metavar="FILE.csv", help=text)
    parser.add_argument("--machine", type=Path, required=True, metavar="FILE", help="the machine, as JSON")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the machine that was found, as JSON")
    text = "what to find: names, or tilt, shift, offset, gain, tool, base; the first ones come first"
    parser.add_argument("--parameters", nargs="+", metavar="NAME", help=text)
    text = "print this many poses to measure, besides those of the samples, as CSV, and find nothing"
    parser.add_argument("--propose", type=int, metavar="N", help=text)
    text = "the package of a machine of your own, as `softkin derive` writes it"
    parser.add_argument("--package", type=Path, metavar="FOLDER", help=text)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Calibrate a machine; returns 2 for samples or a machine that cannot be used."""
    if options.samples is None and options.propose is None:
        complain("which samples? softkin calibrate samples.csv --machine machine.json --out true.json")
        return WRONG
    try:
        softkin = _package(options.package)
        robot = softkin.load(options.machine)
        return _propose(softkin, robot, options) if options.propose else _calibrate(softkin, robot, options)
    except ImportError as problem:
        complain(f"{problem}; the package softkin must be installed beside the compiler, with SciPy")
    except ValueError as problem:  # `KinematicsError` of the package is one
        complain(str(problem))
    return WRONG


def _calibrate(softkin: Any, robot: Any, options: argparse.Namespace) -> int:
    found = softkin.calibrate(robot, options.samples, parameters=options.parameters)
    print(found)
    if options.out is not None:
        options.out.write_text(found.machine.to_json() + "\n", encoding="utf-8")
        print(f"\nwritten: {options.out}")
    return 0


def _propose(softkin: Any, robot: Any, options: argparse.Namespace) -> int:
    names = [axis.name for axis in robot.AXES]
    poses = softkin.propose(robot, options.propose, parameters=options.parameters, samples=options.samples)
    print(",".join(names))
    for pose in poses:
        print(",".join(f"{value:.3f}" for value in pose))
    return 0


def _package(own: Path | None) -> Any:
    """The package with the machines, and the one of a machine of the user's own, which it then knows."""
    if importlib.util.find_spec(_PACKAGE) is None and (_CATALOGUE / _PACKAGE).is_dir():
        sys.path.append(str(_CATALOGUE))
    found = importlib.import_module(_PACKAGE)
    if own is not None:
        sys.path.append(str(own.resolve().parent))
        importlib.import_module(own.resolve().name).catalogue()
    return found
