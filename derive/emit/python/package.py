"""Python: the package `softkin`, which has a runtime and one module for each mechanism."""

from __future__ import annotations

from collections.abc import Sequence

from derive.emit import native
from derive.emit.language import Part
from derive.emit.python.entries import inputs
from derive.emit.python.layout import formatted
from derive.emit.python.mechanism_modules import in_order, index, modules
from derive.emit.python.runtime import NAME, templates
from derive.kinematics.kinematics import Kinematics

name = NAME
PACKAGE = "softkin"
"""The package of the catalogue."""
_FIXED = (
    "LICENSE",
    "MANIFEST.in",
    "pyproject.toml",
    "setup.py",
    "softkin/_array.py",
    "softkin/_array_coupled.py",
    "softkin/_array_mounted.py",
    "softkin/_array_programs/__init__.py",
    "softkin/_array_rotation.py",
    "softkin/_batch.py",
    "softkin/_cells.py",
    "softkin/_columns.py",
    "softkin/_configuration.py",
    "softkin/_core.py",
    "softkin/_coupled.py",
    "softkin/_differential.py",
    "softkin/_ends.py",
    "softkin/_frame.py",
    "softkin/_input.py",
    "softkin/_limits.py",
    "softkin/_mounted.py",
    "softkin/_names.py",
    "softkin/_native.py",
    "softkin/_native_batch.py",
    "softkin/_nearest.py",
    "softkin/_nearest_batch.py",
    "softkin/_offset.py",
    "softkin/_orientation.py",
    "softkin/_path.py",
    "softkin/_radians.py",
    "softkin/_radians_array.py",
    "softkin/_rotation.py",
    "softkin/_root.py",
    "softkin/_roots.py",
    "softkin/_scalar.py",
    "softkin/_search.py",
    "softkin/_slerp.py",
    "softkin/_solutions.py",
    "softkin/_start.py",
    "softkin/_table.py",
    "softkin/_tools.py",
    "softkin/_twist.py",
    "softkin/_types.py",
    "softkin/_unrolled/__init__.py",
    "softkin/_value.py",
    "softkin/_vectors.py",
    "softkin/_velocities.py",
    "softkin/py.typed",
)
"""The files that do not depend on the mechanisms."""
_INDEXED = ("README.md", "softkin/__init__.py")
"""The files that list the mechanisms."""
_EXPORTS = (
    "Axis", "Configuration", "ConfigurationByte", "Coupled", "Diagnosis", "Frame", "FrameLike", "KinematicsError",
    "Mechanism", "Mounted", "OrientationImage", "Parameter", "Rotation", "Singularity", "Solution", "Status",
    "__version__", "catalogue", "core", "orthonormalize",
)  # fmt: skip


def part(kinematics: Kinematics) -> Part:
    """The files of one mechanism, and its entries in the lists."""
    found = {"index": index(kinematics), "files": modules(kinematics) | native.sources(kinematics)}
    given = inputs(kinematics)
    return {**found, "notes": list(given.notes), "inputs": dict(given.names)}


def files(parts: Sequence[Part]) -> dict[str, str]:
    """All files of the package: path → text."""
    return formatted(texts(parts, PACKAGE))


def texts(parts: Sequence[Part], package: str) -> dict[str, str]:
    """All files before their layout, for a package of any name; modules import each other from `softkin`."""
    listed = [part["index"] for part in parts]
    listed.sort(key=lambda entry: entry["module"])
    exports = in_order({*_EXPORTS, *(entry["class_name"] for entry in listed)})
    known = {
        "package": package,
        "index": listed,
        "exports": exports,
        "extension": native.extension(package),
        "sources": native.digest_of_shared(),
    }
    files = {path: templates().get_template(f"{path}.j2").render(known) for path in (*_FIXED, *_INDEXED)}
    for part in parts:
        files |= part["files"]
    return files | native.shared(listed, package)
