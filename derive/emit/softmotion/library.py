"""Structured Text: a function block for every mechanism, and the objects that the blocks share."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from typing import ClassVar

from jinja2 import Environment

from derive.description.mechanism import DescriptionError
from derive.emit.language import GENERATED, TEMPLATES, Part, environment, runtime
from derive.emit.plcopen import document as plcopen
from derive.emit.plcopen.objects import Object, as_text, needed, objects_of, uses
from derive.emit.softmotion.base import base_text
from derive.emit.softmotion.block import Block, block_of
from derive.emit.softmotion.description import description
from derive.emit.softmotion.inputs import inputs
from derive.emit.softmotion.methods import called, methods_of
from derive.emit.softmotion.pictures import row_of
from derive.emit.softmotion.sample import FOLDER as SAMPLES
from derive.emit.softmotion.sample import sample_of
from derive.emit.softmotion.self_test import FOLDER as SELF_TESTS
from derive.emit.softmotion.self_test import PROGRAM as SELF_TEST_PROGRAM
from derive.emit.softmotion.self_test import TOLERANCE, test_of
from derive.emit.st.contract import Contract, load
from derive.emit.st.expression import literal
from derive.emit.st.layout import assigned, beside, case, gathered, quoted
from derive.emit.st.reserved import refuse_clashes
from derive.emit.st.rotation import limits_function, rotation_function
from derive.emit.st.shared import method_name, structures_of
from derive.ir.constants import COINCIDENT, EDGE, HELD, LARGEST, LEAST, PIVOT, SAME_ROTATION, SOLVABLE
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from derive.report.branch_stretches import MOST_KEPT, MOST_SIDES
from derive.report.reasons import NO_MEANING, NOT_INITIALIZED

_FOLDER = "st"
_SHARED = "softkin"
"""The folder of the objects that all blocks share."""
_TRANSFORMATIONS = "pacdrive"
"""The folder of what user transformations need beside."""
_PREAMBLE = f"""\
// {GENERATED}
// To paste: the text below a ruler, up to the next line with a ruler or the end of one, is the declaration or
// implementation of the object that the ruler names.
"""


@dataclass(frozen=True)
class StructuredTextFiles:
    """The language: text, PLCopenXML and the import script, for a profile of the SoftMotion contract, the default
    one if `None`."""

    profile: str | None = None
    name: ClassVar[str] = _FOLDER
    title: ClassVar[str] = "Structured Text"
    bound: ClassVar[str] = "no block: it has {axes} axes, and SoftMotion knows six"

    def __post_init__(self) -> None:
        """Refuse a profile that the contract does not have, before anything is derived."""
        load(self.profile)

    def part(self, kinematics: Kinematics) -> Part | None:
        """The block of one mechanism, its self-test, and its row of the overview; None of one with more axes than a
        position in SoftMotion has.
        """
        contract, templates = load(self.profile), _templates()
        if len(kinematics.mechanism.joints) > most_axes(self.profile):
            return None
        block = block_of(kinematics, contract)
        found: Part = {"row": row_of(kinematics), "text": _unit(kinematics, block, contract, templates)}
        found |= {"test": None, "sample": None}
        found["notes"] = list(inputs(kinematics).notes)
        test = test_of(kinematics, block)
        if test is not None:
            text = templates.get_template("selftest.st.j2").render(contract.spelling, test=test)
            found["test"] = {"name": test.name, "block": test.block, "text": text}
        sample = sample_of(kinematics, block, contract)
        if sample is not None:
            found["sample"] = templates.get_template("sample.st.j2").render(contract.spelling, sample=sample)
        return found

    def files(self, parts: Sequence[Part]) -> dict[str, str]:
        """All files of the language: path below its folder → text. Raises `DescriptionError` for a
        name that clashes.
        """
        contract, templates = load(self.profile), _templates()
        objects = dict(_objects(parts, contract, templates))
        refuse_clashes({f"{path}.st": inside for path, inside in objects.items()})
        samples = dict(_samples(parts, objects, contract))
        files = {f"{path}.st": f"{_PREAMBLE}\n{as_text(inside)}" for path, inside in (objects | samples).items()}
        files |= {f"{path}.xml": text for path, text in _documents(objects, contract)}
        files |= {f"{p}.xml": plcopen.document(p.split("/")[1], GENERATED, {SAMPLES: s}) for p, s in samples.items()}
        rows = sorted((part["row"] for part in parts), key=lambda row: (row["family"], row["block"]))
        for name in ("import_softkin.py", "README.md"):
            files[name] = templates.get_template(f"{name}.j2").render(
                contract.spelling,
                overview=rows,
                own=contract.own_interface,
                flat=contract.is_flat,
                sampled=bool(samples),
                teaches=f"{_SHARED}/Softkin_Teach" in objects,
                words={
                    "methods": sorted({*contract.own}.union(*(one.methods for one in contract.interfaces.values()))),
                    "own": [contract.spelling["own_interface"]["name"], "IQueryInterface"],
                    "interfaces": sorted(contract.interfaces),
                },
            )
        return dict(sorted(files.items()))


def most_axes(profile: str | None) -> int:
    """The most axes that a position in SoftMotion has."""
    return len(load(profile).spelling["axes"]["fields"])


def _objects(
    parts: Sequence[Part], contract: Contract, templates: Environment
) -> Iterator[tuple[str, tuple[Object, ...]]]:
    """The objects of every file, by the path without its ending."""
    rotation, limits = rotation_function(contract), limits_function(contract)
    further = runtime(_TRANSFORMATIONS) if contract.transformations else {}
    enumerations = templates.get_template("enumerations.st.j2").render(names=contract.names)
    yield from ((f"{_SHARED}/{one.name}", (one,)) for one in objects_of(enumerations))
    shared = {path.removesuffix(".st"): text for path, text in {**runtime(_FOLDER), **further}.items()}
    for path in (TEMPLATES / _FOLDER / _SHARED).glob("*.st.j2"):
        shared[f"{_SHARED}/{path.name.removesuffix('.st.j2')}"] = templates.get_template(
            f"{_SHARED}/{path.name}"
        ).render(contract.spelling, rotation=rotation, limits=limits, names=contract.names)
    for name, text in sorted(shared.items()):
        objects = objects_of(text, name.removeprefix(f"{_SHARED}/"))
        if not uses(objects, _absent(contract)):
            yield name, objects
    if (own := contract.own_interface) is not None:
        yield f"{_SHARED}/{own}", objects_of(interface_text(contract, templates))
    base = objects_of(base_text(contract, templates))
    if not contract.is_flat:
        yield f"{_SHARED}/{contract.spelling['base']['name']}", base
    for part in parts:
        objects = objects_of(part["text"])
        yield part["row"]["path"], flattened(objects, base[0]) if contract.is_flat else objects
    yield from _self_tests([part["test"] for part in parts if part["test"] is not None], contract, templates)


def _absent(contract: Contract) -> frozenset[str]:
    """The interfaces that a profile does not have: a shared object that names one of them is left out, too."""
    of_softmotion = contract.interfaces.keys() if contract.transformations else ()
    return contract.omits.union(of_softmotion)


def _self_tests(
    tests: Sequence[Part], contract: Contract, templates: Environment
) -> Iterator[tuple[str, tuple[Object, ...]]]:
    """A self-test for every block that has test cases, and the program that runs all of them."""
    for test in tests:
        yield f"{SELF_TESTS}/{test['name']}", objects_of(test["text"])
    if tests:
        text = templates.get_template("program_selftest.st.j2").render(contract.spelling, tests=tests)
        yield f"{SELF_TESTS}/{SELF_TEST_PROGRAM}", objects_of(text)


def _samples(
    parts: Sequence[Part], objects: Mapping[str, tuple[Object, ...]], contract: Contract
) -> Iterator[tuple[str, tuple[Object, ...]]]:
    """The objects of the sample projects: of the catalogue those that the contract names, and of a single machine its
    own. Each is for a project of its own: their programs have the same names. A machine whose block has the name of
    something in its sample comes without.
    """
    wanted = contract.spelling["samples"]["blocks"]
    for part in parts:
        block = part["row"]["block"]
        if part["sample"] and (len(parts) == 1 or block in wanted):
            inside = {f"{SAMPLES}/{block}": objects_of(part["sample"])}
            with suppress(DescriptionError):
                refuse_clashes({**objects, **inside})
                yield from inside.items()


def _documents(objects: Mapping[str, Sequence[Object]], contract: Contract) -> Iterator[tuple[str, str]]:
    """The PLCopenXML files: one with all objects, and one for every mechanism with the objects that it needs. There it
    is flat: it has the methods of the base block itself.
    """
    base = f"{_SHARED}/{contract.spelling['base']['name']}"
    yield "softkin", plcopen.document("Softkin", GENERATED, _by_folder(objects))
    for path in objects:
        if not path.startswith((f"{_SHARED}/", f"{SELF_TESTS}/")):
            alone = dict(objects)
            if base in objects and not contract.transformations:
                alone[path] = flattened(objects[path], objects[base][0])
            chosen = {p: alone[p] for p in needed(path, alone)}
            yield path, plcopen.document("Softkin", GENERATED, _by_folder(chosen))


def _by_folder(objects: Mapping[str, Sequence[Object]]) -> dict[str, list[Object]]:
    folders: dict[str, list[Object]] = {}
    for path, inside in sorted(objects.items()):
        folders.setdefault(path.split("/")[0], []).extend(inside)
    return folders


@cache
def _templates() -> Environment:
    templates = environment(_FOLDER)
    templates.globals.update(
        assigned=assigned,
        beside=beside,
        case=case,
        gathered=gathered,
        quoted=quoted,
        generated=GENERATED,
        degree=literal(math.pi / 180.0),
        radian=literal(180.0 / math.pi),
        coincident=literal(float(COINCIDENT)),
        edge=literal(float(EDGE)),
        half_turn=literal(180.0 + float(EDGE)),
        per_turn=literal(1.0 / 360.0),
        largest=literal(float(LARGEST)),
        least=literal(float(LEAST)),
        held=literal(float(HELD)),
        pivot=literal(float(PIVOT)),
        solvable=literal(float(SOLVABLE)),
        smallest=literal(1.0 / float(SOLVABLE)),
        tolerance=literal(TOLERANCE),
        statuses=[status.name for status in Status],
        not_initialized=NOT_INITIALIZED,
        same_rotation=literal(float(SAME_ROTATION)),
        no_meaning=NO_MEANING,
        most_sides=MOST_SIDES,
        most_kept=MOST_KEPT,
    )
    return templates


def _unit(kinematics: Kinematics, block: Block, contract: Contract, templates: Environment) -> str:
    methods = methods_of(kinematics, block, contract, templates)
    return templates.get_template("block.st.j2").render(
        contract.spelling,
        block=block,
        own=contract.own_interface,
        description=description(kinematics, block, contract.spelling["pictures"]["reference"], templates),
        methods=methods,
        structures=[
            (structure.type_in(block.name), method_name(program), structure.types)
            for program, structure in structures_of(called(kinematics))
        ],
    )


def interface_text(contract: Contract, templates: Environment) -> str:
    """The text of the interface: the methods of the contract that are our own, with the headers that blocks have."""
    heads = [replace(signature, access="").head() for signature in contract.own.values()]
    return templates.get_template("interface.st.j2").render(contract.spelling, heads=heads)


_SECTION = re.compile(r"^VAR\b.*?^END_VAR$", re.DOTALL | re.MULTILINE)
_INPUTS = re.compile(r"^VAR_INPUT$.*?^END_VAR$", re.DOTALL | re.MULTILINE)


def flattened(objects: Sequence[Object], base: Object) -> tuple[Object, ...]:
    """The objects, of which those that extend the base have its variables and methods instead.

    Raises `ValueError` for a block that calls what it overrides.
    """
    return tuple(_flat(one, base) if _head(one, base) in one.declaration else one for one in objects)


def _head(block: Object, base: Object) -> str:
    return f"\nFUNCTION_BLOCK {block.name} EXTENDS {base.name}"


def _flat(block: Object, base: Object) -> Object:
    for part in block.parts():
        if "SUPER" in part.implementation:
            raise ValueError(f"{block.name}.{part.name} calls what the base has, and a flat block has no base")
    alone = block.declaration.replace(_head(block, base), f"\nFUNCTION_BLOCK {block.name}")
    declaration = _with_variables(alone, "\n".join(_SECTION.findall(base.declaration)))
    return replace(block, declaration=declaration, members=(*block.members, *_inherited(block, base)))


def _with_variables(declaration: str, variables: str) -> str:
    """The declaration with these sections behind its inputs, which every block has."""
    inputs = _INPUTS.search(declaration)
    assert inputs is not None
    return f"{declaration[: inputs.end()]}\n{variables}{declaration[inputs.end() :]}"


def _inherited(block: Object, base: Object) -> Iterator[Object]:
    own = {member.name for member in block.members}
    return (member for member in base.members if member.name not in own)
