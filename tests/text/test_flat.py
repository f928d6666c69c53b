"""The flat profile: a block has all its methods, extends nothing, and answers what the block with a base answers."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import inf, nan
from typing import Any

import numpy as np
import pytest

from derive.description.mechanism import Mechanism
from derive.emit.plcopen.objects import objects_of
from derive.emit.softmotion.library import flattened
from tests.codesys.plcopen_reader import NAMESPACE
from tests.codesys.test_plcopen import errors
from tests.harness import ast
from tests.harness.blark_grammar import parse_with_blark
from tests.harness.contract import header
from tests.harness.library import Library, compile_st
from tests.harness.parse import parse
from tests.harness.pieces import split
from tests.harness.unused import unused
from tests.mechanisms import catalogue
from tests.text import values
from tests.text.controller import OK, Controller
from tests.text.flat import BASE, base, flat_library, flat_of, flat_text, objects_in
from tests.text.test_portable import lint
from tests.text.test_profiles import BLOCK, rendered
from tests.text.units import compiled, public_methods, text_of

pytestmark = pytest.mark.slow

MECHANISMS = {m.name: m for _, m in catalogue()}
KINDS = {
    "Kin_Scara4_ZCcoupled_Type1": "a serial arm with turns, drives with limits, and a coupled axis",
    "Softkin_Delta_C": "a loop of rods in space",
    "Kin_P2C_Type1": "a loop in a plane",
    "Kin_Hexapod": "a plate by Newton's method",
    "Kin_Ac6_RZRYRYRXRYRZ_J6Offset": "an arm that is searched along",
    "Kin_Wrist2": "an orientation kinematics, for a coupling",
    "Kin_Scara2_Z": "a position kinematics, for a coupling",
    "Kin_Tool": "a kinematics without axes",
}
POSES = 6
"""Regular poses, and as many of each kind of garbage."""


@pytest.mark.parametrize("name", MECHANISMS)
def test_a_flat_block_is_whole_and_clean(name: str) -> None:
    """It extends nothing, has every method of the block and of its base with the identical text, and the inputs in the
    order that they had; and it is portable.
    """
    mechanism = MECHANISMS[name]
    text = flat_text(mechanism)
    (flat, *others), (before, *same) = (objects_in(t) for t in ("// ====\n" + text, text_of(mechanism)))
    assert others == same and BASE not in text
    assert flat.declaration.count("VAR_INPUT") == before.declaration.count("VAR_INPUT") == 1
    inputs = re.compile(r"^VAR_INPUT$.*?^END_VAR$", re.DOTALL | re.MULTILINE)
    assert inputs.search(flat.declaration)[0] == inputs.search(before.declaration)[0]  # type: ignore[index]
    members = {m.name: m for m in flat.members}
    own = {m.name: m for m in before.members}
    assert len(members) == len(flat.members)
    assert members == {m.name: m for m in base().members} | own
    assert lint(text) == []


@pytest.mark.parametrize("name", KINDS)
def test_a_flat_block_compiles_alone(name: str) -> None:
    """Without a base it has all that its interfaces want, as the check of the contract says; nothing in it is unused
    but what the base keeps for other geometries; no local variable has the name of a member.
    """
    mechanism = MECHANISMS[name]
    library = flat_library(mechanism)
    block = library.objects[mechanism.block_name]
    inherited = compiled(mechanism).objects
    assert BASE not in library.objects and block.extends is None
    assert block.implements == inherited[mechanism.block_name].implements and block.implements[-1] == "ISoftkin"
    methods = {m.name: (m.access, header(m)) for m in block.methods}
    both = (*inherited[BASE].methods, *inherited[mechanism.block_name].methods)
    assert methods == {m.name: (m.access, header(m)) for m in both}
    kept = {f"{block.name}: {v.name}" for s in inherited[BASE].sections for v in s.variables}
    own = {m.name for m in inherited[mechanism.block_name].methods}
    others = [m for m in inherited[BASE].methods if m.access == "PROTECTED" and m.name not in own]
    kept |= {f"{block.name}.{m.name}: {v.name}" for m in others for s in m.sections for v in s.variables}
    assert set(unused(block)) <= kept


def test_names_of_locals_are_no_members() -> None:
    """In no flat block of the catalogue: the variables of a base's methods would hide them."""
    locals_of_the_base = set()
    (found,) = parse("\n".join(flat_source(base())), BASE)
    assert isinstance(found, ast.Block)
    for method in found.methods:
        locals_of_the_base |= {v.name.lower() for s in method.sections for v in s.variables}
    for mechanism in MECHANISMS.values():
        declared = re.findall(r"^  (\w+(?:, \w+)*) : ", objects_in(text_of(mechanism))[0].declaration, re.MULTILINE)
        members = {name.lower() for names in declared for name in names.split(", ")}
        assert not members & locals_of_the_base, mechanism.name


def flat_source(one: Any) -> Iterator[str]:
    """An object as a text."""
    yield one.declaration
    for member in one.members:
        yield from (member.declaration, member.implementation, "END_METHOD")
    yield "END_FUNCTION_BLOCK"


@dataclass(frozen=True)
class Asked:
    """Numbers from which the arguments of any method are made."""

    axes: tuple[float, ...]
    reference: tuple[float, ...]
    position: tuple[float, ...]
    rotation: tuple[tuple[float, ...], ...]
    data: tuple[int, ...]
    freedom: str


def asked(mechanism: Mechanism, one: Controller) -> Iterator[Asked]:
    """Poses of a machine, axis values where it has none, singular ones, and garbage in every kind of argument."""
    rng = np.random.default_rng(7)
    for number in range(POSES):
        axes = tuple(float(j.nominal + rng.uniform(-40.0, 40.0) * (number != 0)) for j in mechanism.joints)
        status, pose = one.forward(axes)
        turned, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        other = (
            tuple(rng.uniform(-300.0, 300.0, 3)),
            tuple(map(tuple, turned * np.linalg.det(turned))),
            (1, 2, 1, 2, 1),
        )
        position, rotation, data = pose if status == OK else other
        size = len(mechanism.joints)
        near = tuple(float(v) for v in np.add(axes, rng.uniform(-30.0, 30.0, size)))
        yield Asked(axes, near, position, rotation, tuple(data[: size + 2]), ("zero", "one", "three")[number % 3])
        yield Asked(axes, near, position, rotation, (0,) * 8, "one")
        yield Asked(near, axes, tuple(1.3 * p + 9.0 for p in position), rotation, (0, 1, 0, 2, 0, 0), "zero")
        bad = (nan, inf, -1e300, 1e10)[number % 4]
        spoilt = tuple(bad if k == number % max(size, 1) else v for k, v in enumerate(axes))
        yield Asked(spoilt, near, position, rotation, data[:size], "three")
        yield Asked(axes, spoilt, (position[0], bad, position[2]), rotation, data[:size], "one")
        rows = [list(row) for row in rotation]
        rows[number % 3][1] = bad
        yield Asked(axes, near, position, tuple(map(tuple, rows)), (255, 3, 4, 200, 0, 7), "zero")


def arguments(library: Library, given: Asked) -> Mapping[str, Any]:
    """An argument for every parameter in the contract that a method reads, by its name."""
    axes, frame = values.axes(library, given.axes), values.frame(library, given.position, given.rotation)
    matrix, data = values.matrix(library, given.rotation), values.configuration(library, given.data)
    image = values.new(library, values.IMAGE_TYPE)
    image.dof = given.freedom
    library.set_rotation(image.mOriZero, given.rotation)
    image.vRot.dX, image.vRot.dY, image.vRot.dZ = (row[2] for row in given.rotation)
    limits = values.new(library, "TRAFO.Axis_Settings")
    limits.limits.dLower, limits.limits.dUpper = sorted((given.axes or (0.0,))[:1] + (given.reference or (0.0,))[:1])
    return {
        "a": axes, "aRef": values.axes(library, given.reference), "f": frame, "mR": matrix, "mR_Flange": matrix,
        "mR_flange": matrix, "v_MCS": values.vector(library, given.position),
        "vOffset_TCP": values.vector(library, (3.0, -4.0, 5.0)), "cd": data, "cd1": data, "cdSrc": data,
        "cd2": values.configuration(library, given.data[::-1]), "aTwist": [1.0, -20.0, 3.0, 40.0, 5.0, -6.0],
        "as": limits, "udiAxis": len(given.data) % 7, "oriInfo": image, "oriInfoBase": image,
    }  # fmt: skip


def answer(library: Library, block: Any, method: str, given: Asked) -> tuple[Any, ...]:
    """What a method returns and what it writes, in parameters that hold what means nothing before."""
    entry, known = block.routines[method.lower()], arguments(library, given)
    handed, written = {}, {}
    for parameter, make in zip(entry.routine.parameters, entry.defaults, strict=True):
        if parameter.scope == "VAR_OUTPUT":
            continue
        if parameter.is_reference and not parameter.constant:
            handed[parameter.name] = written[parameter.name] = values.filled(make())
        else:
            handed[parameter.name] = known[parameter.name]
    result, outputs = block.call_with_outputs(method, **handed)
    return result, {k: _kept(v) for k, v in {**written, **outputs}.items()}


def _kept(value: Any) -> Any:
    """What can be compared, NaN with NaN as well."""
    return repr(values.plain(value))


def state_of(block: Any) -> list[str]:
    """Every instance variable, by its name in small letters."""
    names = {name for made in type(block).__mro__ for name in getattr(made, "__slots__", ())}
    return sorted(f"{name}: {_kept(getattr(block, name))}" for name in names)


@pytest.mark.parametrize("name", KINDS)
def test_every_method_answers_exactly_the_same(name: str) -> None:
    """Before Initialize, after it, and after limits of drives: results, what is written, the state of the instance."""
    mechanism = MECHANISMS[name]
    libraries = (compiled(mechanism), flat_library(mechanism))
    pair = [Controller(library, mechanism) for library in libraries]
    methods = public_methods(mechanism)
    assert set(methods) <= {m.name for m in libraries[1].objects[mechanism.block_name].methods}
    statuses: set[Any] = set()
    nominal = {p.name: p.nominal for p in mechanism.parameters}
    for given in ({}, {**nominal, **{next(iter(nominal), "offset"): nan}}, nominal):
        assert len({one.initialise(given) for one in pair}) == 1
        samples = list(asked(mechanism, pair[0]))
        for method in (m for m in methods if m != "AxisSettings"):
            for sample in samples if given is nominal else samples[:3]:
                inherited, flat = (answer(one.library, one.block, method, sample) for one in pair)
                assert inherited == flat, (name, method, sample)
                statuses.add((method, inherited[0] if isinstance(inherited[0], str) else ""))
        assert state_of(pair[0].block) == state_of(pair[1].block)
    if "AxisSettings" in methods:
        for sample in samples:
            results = [answer(one.library, one.block, "AxisSettings", sample) for one in pair]
            assert results[0] == results[1] and state_of(pair[0].block) == state_of(pair[1].block)
            assert len({one.initialise(nominal) for one in pair}) == 1
            assert state_of(pair[0].block) == state_of(pair[1].block)
    if mechanism.joints:
        assert {status for method, status in statuses if method == "CartesianToAxes"} > {OK}
        assert len({status for method, status in statuses if method == "Diagnose"}) > 2


def test_the_second_grammar_reads_a_flat_block() -> None:
    """The block as it is written, without its members: these are those of the block with a base, and of the base."""
    (block, *_) = split(flat_text(MECHANISMS["Kin_Gantry2"]), "Softkin_Gantry2")
    assert block.text.startswith("FUNCTION_BLOCK Softkin_Gantry2 IMPLEMENTS") and len(block.members) > 20
    assert parse_with_blark(block.text, block.kind)


def test_the_profile_writes_these_texts() -> None:
    """What the language writes for the profile is what is tested here, and nothing of a base is left in any file."""
    files = rendered("flat")
    assert set(rendered(None)) - set(files) == {f"softkin/{BASE}.st"}
    assert files[BLOCK].endswith(f"\n{flat_of(rendered(None)[BLOCK])}")
    assert not any(BASE in text for text in files.values())
    shared = {name: text for name, text in files.items() if name.startswith("softkin/") and name.endswith(".st")}
    assert shared == {name: rendered(None)[name] for name in shared}
    assert errors(files["softkin.xml"]) == []
    assert NAMESPACE in files["softkin.xml"]


def test_it_goes_together_with_an_older_library() -> None:
    """Both leave out what they leave out."""
    both, older = rendered("before_4_11+flat"), rendered("before_4_11")
    assert set(older) - set(both) == {f"softkin/{BASE}.st"} and "softkin/ISoftkin.st" not in both
    own = {n: t for n, t in both.items() if n.endswith(".st")}
    block = compile_st(own).objects["Kin_Scara4_ZCcoupled_Type1"]
    assert block.extends is None and not any("AxisSettings" in m.name for m in block.methods)


def test_a_call_of_the_base_is_refused() -> None:
    """A flat block has nothing to call where its method calls that of the base."""
    lines = "METHOD PUBLIC Run\nVAR\n  x : LREAL;\nEND_VAR\n\n{}\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
    above = objects_of("FUNCTION_BLOCK Above\nVAR\n  y : LREAL;\nEND_VAR\n\n" + lines.format("x := y;"))[0]
    head = "// It\nFUNCTION_BLOCK Below EXTENDS Above IMPLEMENTS\n  I1\nVAR_INPUT\n  z : LREAL;\nEND_VAR\n\n"
    with pytest.raises(ValueError, match=r"Below\.Run calls what the base has"):
        flattened(objects_of(head + lines.format("SUPER^.Run();")), above)
    (flat,) = flattened(objects_of(head + lines.format("x := 1.0;")), above)
    assert flat.declaration == (
        "// It\nFUNCTION_BLOCK Below IMPLEMENTS\n  I1\nVAR_INPUT\n  z : LREAL;\nEND_VAR\nVAR\n  y : LREAL;\nEND_VAR"
    )
    assert [m.implementation for m in flat.members] == ["x := 1.0;"]
