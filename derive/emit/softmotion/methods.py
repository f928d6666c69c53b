"""The methods of a function block: their list, the spelling of the values that they read, and their refusals."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from jinja2 import Environment

from derive.description.mechanism import Parameter as Dimension
from derive.description.mechanism import Role
from derive.emit.softmotion.base import BASE_VARIABLES, INHERITED, Method, inherited_texts, statements_of
from derive.emit.softmotion.block import Block, constants, direct, setup_of, start_in, stored_as
from derive.emit.softmotion.calls import branch_of, commanded, from_home, offset_branch_of, without_axes
from derive.emit.softmotion.inputs import inputs
from derive.emit.st.contract import Contract, Parameter, Signature
from derive.emit.st.layout import tidy, with_gathered
from derive.emit.st.names import respelled
from derive.emit.st.program import Printed, printed
from derive.emit.st.refusal import MISSING, REASON, TURN, Explained, Refusal, Tested
from derive.emit.st.refused_inputs import OfInputs, conditions_first, pairs_of_limits, without_limits
from derive.emit.st.shared import method_name, own_names, signature_of
from derive.equations.windows import windows
from derive.ir.constants import LEAST
from derive.ir.program import Program, shared
from derive.ir.symbols import branch_sign
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.report.reasons import reasons_of, texts

_FIRST = (
    "Describe",
    "ReadInputs",
    "FindPose",
    "FindAxes",
    "SolveBranch",
    "TestLimits",
    "ReasonOf",
    "FindJacobian",
    "FindBias",
    "FindMargins",
    "FindOrientation",
    "FindImage",
    "FindProjection",
    "FindOffsetBranches",
    "SolveOffsetBranch",
    "IsCompatibleWithPosKin",
    "GetPositionFromOrientation3",
    "GetPositionFromOrientation2",
    "GetPositionFromOrientation",
    "GetOrientationImageTotal",
    "GetOrientationImageWithOri",
)


@dataclass(frozen=True)
class _Source:
    """A method before it is written: its signature and its program."""

    signature: Signature
    program: Program | None = None
    is_shared: bool = False


def methods_of(kinematics: Kinematics, block: Block, contract: Contract, templates: Environment) -> tuple[Method, ...]:
    """All methods in the order of the contract; a private method follows the method that calls it."""
    known = inherited_texts(contract, templates)
    written = (
        _method(source, kinematics, block, contract, templates) for source in _sources(kinematics, block, contract)
    )
    return tuple(method for method in written if statements_of(method) not in known)


@kept_by_identity(10)
def spelled_inputs(kinematics: Kinematics) -> dict[str, str]:
    """The spelling in a method of every input of the programs other than `setup`."""
    spelled = {name: stored_as(kinematics, name) for name in constants(kinematics)}
    for index, joint in enumerate(kinematics.mechanism.joints):
        spelled[joint.axis.name] = f"a.a{index}"
        spelled[joint.speed.name] = f"aSpeeds[{index}]"
        spelled[joint.reference.name] = f"aRef.a{index}"
    for axis in "xyz":
        spelled[f"flange_axis_{axis}"], spelled[f"base_axis_{axis}"] = (
            f"flangeAxis.d{axis.upper()}",
            f"baseAxis.d{axis.upper()}",
        )
    spelled |= {branch_sign(b.name).name: f"choice.aSigns[{k}]" for k, b in enumerate(kinematics.branches)}
    for byte, joint in enumerate(kinematics.period_joints, start=len(kinematics.branches)):
        spelled[joint.turn.name] = f"Softkin_PeriodOfByte(cd.abyData[{byte}])"
        index = kinematics.mechanism.joints.index(joint)
        spelled[commanded(joint.key).name] = f"choice.aNear[{index}]"
    return spelled | {f"r{r}{c}": f"rot[{r}, {c}]" for r in (1, 2, 3) for c in (1, 2, 3)}


def _sources(kinematics: Kinematics, block: Block, contract: Contract) -> Iterator[_Source]:
    known = contract.signatures | {n: s for i in contract.closure(block.interfaces) for n, s in i.methods.items()}
    names = _names(block, contract)
    programs = _programs(kinematics)
    ready: set[str] = set()
    for name in names:
        program = programs.get(name)
        yield _Source(known[name], program)
        yield from _shared(program, kinematics, contract, ready, block.name)
        if name == "GetPositionFromOrientation3":
            yield _Source(_end_point(known[name], block, contract))


def _programs(kinematics: Kinematics) -> dict[str, Program | None]:
    """The programs of the methods that compute one, by the name of the method."""

    def of_axes(program: Program | None) -> Program | None:
        return without_axes(program, kinematics)

    return {
        "ReadInputs": setup_of(kinematics),
        "FindPose": from_home(kinematics.forward, kinematics),
        "SolveBranch": branch_of(kinematics),
        "SolveOffsetBranch": offset_branch_of(kinematics),
        "FindOrientation": from_home(kinematics.orientation, kinematics),
        "TestLimits": kinematics.limits,
        "FindMargins": of_axes(kinematics.singularity),
        "FindImage": kinematics.image,
        "FindProjection": kinematics.projection,
        "FindOffsetBranches": of_axes(kinematics.offset_configuration),
        "FindJacobian": of_axes(kinematics.jacobian),
        "FindBias": of_axes(kinematics.bias),
        "IsCompatibleWithPosKin": kinematics.compatible,
        "GetPositionFromOrientation3": kinematics.end_point_shift,
        "GetOrientationImageTotal": kinematics.total_image,
        "GetOrientationImageWithOri": kinematics.image if kinematics.total_image else kinematics.projection,
    }


def called(kinematics: Kinematics) -> tuple[Program, ...]:
    """The shared programs that methods of the block call."""
    return shared(program for program in _programs(kinematics).values() if program is not None)


def _shared(
    program: Program | None, kinematics: Kinematics, contract: Contract, ready: set[str], block: str
) -> Iterator[_Source]:
    """The shared programs that no earlier method calls."""
    inside = shared([program]) if program is not None else ()
    for inner in (p for p in inside if p.name not in ready):
        ready.add(inner.name)
        signature = signature_of(inner, spelled_inputs(kinematics), contract, block)
        yield _Source(signature, inner, is_shared=True)


def _names(block: Block, contract: Contract) -> list[str]:
    """The public methods of the implemented interfaces, and those that the base block asks for; the most important are
    first.
    """
    public = [m for i in contract.closure(block.interfaces) for m in i.methods]
    asked = {**contract.supplied_for, **contract.overridable_for}
    needed = [n for n in (*contract.supplied, *contract.overridable) if n not in asked or asked[n] & set(public)]
    unneeded = contract.supplied_turning if block.keeps_orientation else frozenset()
    if block.limit_reasons or not block.axes:
        unneeded |= {"TestLimits"}
    names = [*public, *contract.own, *(n for n in needed if n not in unneeded)]
    names = [n for n in dict.fromkeys(names) if n not in INHERITED]
    return sorted(names, key=lambda name: _FIRST.index(name) if name in _FIRST else len(_FIRST))


def _end_point(public: Signature, block: Block, contract: Contract) -> Signature:
    """The signature of the private method that finds the end point on a flange of known orientation. In a block without
    axes the point is the same for every orientation.
    """
    unread = () if block.axes else ("mR", "aRef", "cd")
    flange = Parameter("VAR_IN_OUT CONSTANT", "mFlange", contract.spelling["types"]["matrix"])
    kept = (p for p in public.parameters if p.name not in {"oriInfo", *unread})
    ordered = sorted((*kept, flange), key=lambda p: p.name != "v")
    return Signature("EndPointOnFlange", public.returns, tuple(ordered), "PRIVATE")


def _method(
    source: _Source, kinematics: Kinematics, block: Block, contract: Contract, templates: Environment
) -> Method:
    name = source.signature.name
    reads = kinematics.reads_rotation
    context: dict[str, object] = {"block": block, "method": name, "reads_rotation": reads}
    context["turns"] = not set(block.interfaces).isdisjoint(contract.transformations[1:])
    if name == "ReasonOf":
        context["reasons"] = texts(kinematics)
    if source.program is not None:
        context["program"] = program = _printed(source, source.program, kinematics, block, contract)
        own = own_names(source.program, spelled_inputs(kinematics))
        context["results"] = [(own[o], text) for o, text in program.outputs.items() if o in own and own[o] != text]
        context["unexplained"] = [
            (p.name, "0.0" if p.type == "LREAL" else "0")
            for p in source.signature.parameters
            if p.name in (REASON, MISSING, TURN) and f"{p.name} :=" not in program.body
        ]
    template = "Shared" if source.is_shared else name
    text = templates.get_template(f"methods/{template}.st.j2").render(contract.spelling, **context)
    return Method(source.signature.head(), with_gathered(tidy(text)))


def _printed(source: _Source, program: Program, kinematics: Kinematics, block: Block, contract: Contract) -> Printed:
    signature = source.signature
    taken = {i.name for i in block.inputs} | {name for name, _ in block.fields} | {p.name for p in signature.parameters}
    taken |= {"NumAxes", *BASE_VARIABLES, *contract.private, *contract.signatures}
    taken |= {method_name(inner) for inner in kinematics.shared}
    errors, error = contract.spelling["errors"], contract.spelling["types"]["error"]
    refusal = Refusal(signature, errors, error)
    if REASON in {p.name for p in signature.parameters}:
        refusal = Explained(
            signature, errors, error, reasons_of(kinematics), texts(kinematics), _axes(kinematics, block)
        )
    if signature.name == "ReadInputs":
        given = dict(inputs(kinematics).names)
        stored = {let: stored_as(kinematics, output) for let, output in direct(kinematics, program).items()}
        limits = pairs_of_limits(program, windows(kinematics.mechanism))
        axes = [axis.name for axis in block.axes]
        refused = OfInputs(signature, errors, error, refused_texts(kinematics), limits, axes)
        return printed(conditions_first(without_limits(program, limits)), given, stored, taken, refused)
    spelled = dict(spelled_inputs(kinematics))
    if "start" in {p.name for p in signature.parameters}:
        spelled |= start_in("start")
    if source.is_shared:
        own = own_names(program, spelled)
        results = {o.name: own[o.name] for o in program.outputs}
        return printed(program, spelled | own, results, taken, refusal, block=block.name)
    is_branch = signature.name == "SolveBranch"
    stored = _coordinates(program) if signature.name == "FindPose" else {}
    if is_branch and program.calls():  # a call takes the axes as a whole
        stored = {j.axis.name: spelled[j.axis.name] for j in kinematics.mechanism.joints}
    given = _positions(signature) | spelled
    return printed(program, given, stored, taken, refusal, is_branch=is_branch, block=block.name)


def _coordinates(program: Program) -> dict[str, str]:
    """The values that are just a coordinate of the pose: they are assigned to it as soon as they are known."""
    bound = {let.name.name for let in program.lets()}
    values = [str(o.value) for o in program.outputs]
    named = {o.name: str(o.value) for o in program.outputs if o.name in "xyz"}
    return {v: f"v.d{axis.upper()}" for axis, v in named.items() if v in bound and values.count(v) == 1}


def _axes(kinematics: Kinematics, block: Block) -> dict[str, Tested]:
    """The axes whose limits the program tests, by the names of their values."""
    return {
        joint.axis.name: Tested(
            f"axes[{index}]", f"a.{axis.field}", f"lowest_{joint.key}", f"highest_{joint.key}", axis.has_turns
        )
        for index, (joint, axis) in enumerate(zip(kinematics.mechanism.joints, block.axes, strict=True))
    }


def _positions(signature: Signature) -> dict[str, str]:
    """The spelling of the commanded position and of the tool offset, given the parameters that hold them."""
    names = {p.name for p in signature.parameters}
    point = "v" if "v" in names else "f.vT"
    spelled = {axis: f"{point}.d{axis.upper()}" for axis in "xyz"}
    if "vOffset_TCP" in names:
        spelled |= {f"point_{axis}": f"vOffset_TCP.d{axis.upper()}" for axis in "xyz"}
    return spelled


_MOST_NAMED = 3


@kept_by_identity(10)
def refused_texts(kinematics: Kinematics) -> dict[str, str]:
    """The text of every refusal, by the sentence of its condition: the inputs, then the condition on them.

    A condition on a single input gives the range of that input and the condition.
    """
    spelled = inputs(kinematics).names
    found: dict[str, str] = {}
    for require in kinematics.setup_less_windows.requires():
        assert require.reason is not None
        sentence = require.reason.subject.name
        read = {symbol.name for symbol in require.condition.free_symbols}
        named = [p for p in kinematics.parameters if p.name in read]
        needed = sentence
        if len(named) == 1:
            is_its_range = sentence == f"{named[0].name}: {named[0].meaning}"
            needed = f"it must be {_allowed(named[0])}" + ("" if is_its_range else f" ({sentence})")
        names = _listed([spelled[p.name] for p in named])
        wrong = "is not allowed: " if len(named) == 1 else ": "
        text = f"{names} {wrong}{needed}".replace(" :", ":") if named else f"the parameters must give {needed}"
        if len(named) > 1:
            text = _spelled(text, named, spelled)
        found[sentence] = respelled(text, spelled)
    return found


def _spelled(text: str, named: Sequence[Dimension], spelled: Mapping[str, str]) -> str:
    """The text with the spelling of the inputs that it is about, also of an input whose name is one plain word."""
    names = {p.name: spelled[p.name] for p in named if "_" not in p.name}
    return re.sub(r"\b[a-z]+\b", lambda found: names.get(found[0], found[0]), text)


def _listed(names: Sequence[str]) -> str:
    """The names, at most three of them."""
    if len(names) <= _MOST_NAMED:
        return ", ".join(names)
    return f"{names[0]} and {len(names) - 1} others"


def _allowed(parameter: Dimension) -> str:
    """The values that are allowed, in words."""
    if parameter.role is Role.SIGN:
        return "1 or -1"
    least = max(parameter.low, float(LEAST))
    low = f"more than {least:g}" if parameter.low_open else f"at least {parameter.low:g}"
    is_never_zero = parameter.role in (Role.SIGNED_LENGTH, Role.TRANSMISSION)
    size = f", and more than {float(LEAST):g} in size" if is_never_zero else ""
    return f"{low} and at most {parameter.high:g}{size}"
