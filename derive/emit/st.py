"""Structured Text: a function block for every mechanism, and the objects they share."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment

from derive.emit.language import GENERATED, TEMPLATES, environment
from derive.emit.st_block import block_of
from derive.emit.st_contract import Contract, load
from derive.emit.st_description import description
from derive.emit.st_expression import literal
from derive.emit.st_layout import assigned
from derive.emit.st_methods import methods_of
from derive.kinematics import Kinematics
from derive.program import EDGE, FREE_ANGLE, HELD, LARGEST, PIVOT, ROTATION, TIE

name = "st"

_PREAMBLE = f"// {GENERATED}\n\n"


def render(kinematics: Sequence[Kinematics]) -> dict[str, str]:
    """All files of the language: path below its folder → text."""
    contract, templates = load(), _templates()
    files = {f"softkin/{path.stem}": _shared(path.name, contract, templates) for path in _shared_objects()}
    for one in kinematics:
        files[f"{one.mechanism.family}/{one.mechanism.block_name}.st"] = _unit(one, contract, templates)
    return dict(sorted(files.items()))


def _templates() -> Environment:
    templates = environment(name)
    templates.globals.update(
        assigned=assigned,
        degree=literal(math.pi / 180.0),
        free_angle=literal(float(FREE_ANGLE)),
        edge=literal(float(EDGE)),
        largest=literal(float(LARGEST)),
        held=literal(float(HELD)),
        rotation=literal(float(ROTATION)),
        pivot=literal(float(PIVOT)),
        tie=literal(float(TIE)),
    )
    return templates


def _shared_objects() -> list[Path]:
    return sorted((TEMPLATES / name / "softkin").glob("*.st.j2"))


def _shared(file: str, contract: Contract, templates: Environment) -> str:
    return _PREAMBLE + templates.get_template(f"softkin/{file}").render(contract.spelling)


def _unit(kinematics: Kinematics, contract: Contract, templates: Environment) -> str:
    block = block_of(kinematics, contract)
    text = templates.get_template("block.st.j2").render(
        contract.spelling,
        block=block,
        description=description(kinematics, block, templates),
        methods=methods_of(kinematics, block, contract, templates),
    )
    return _PREAMBLE + text.rstrip("\n") + "\n"
