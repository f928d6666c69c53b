"""The methods of a function block: which methods it has, the spelling of what they read, and their refusals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from jinja2 import Environment

from derive.emit.softmotion.base import BASE_VARIABLES, INHERITED, Method
from derive.emit.softmotion.block import Block, constants, direct, setup_of, stored_as
from derive.emit.softmotion.calls import BranchCall, branch_call, checks, without_checks
from derive.emit.softmotion.inputs import inputs
from derive.emit.softmotion.layout import tidy
from derive.emit.softmotion.refused import refused_texts
from derive.emit.st.contract import Contract, Parameter, Signature
from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import commented, with_gathered
from derive.emit.st.names import parameter_name
from derive.emit.st.program import Printed, printed
from derive.emit.st.refusal import MISSING, REASON, TURN, Explained, Refusal, Tested, Told
from derive.emit.st.refused_inputs import OfInputs, chained, conditions_first
from derive.emit.st.scan import SEARCH, search_in, search_text, try_at_signature
from derive.emit.st.shared import method_name, own_names, signature_of
from derive.emit.st.stretches import shares_of
from derive.ir.program import FindRoot, Program, shared
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.report.reasons import reasons_of, texts

_BRANCHES = ("SolveBranch", "SolveOffsetBranch")

_FIRST = (
    "Describe",
    "ReadInputs",
    "AxesToCartesian",
    "CartesianToAxes",
    "TestLimits",
    "AxesToOrientation",
    "FindMargins",
    "FindJacobian",
    "Diagnose",
    "GetOrientationImage",
    "GetFlangeOrientationImageTotal",
    "GetFlangeOrientationImageWithOri",
    "AxesToConfiguration_Offset",
    "CartesianToAxes_Offset",
    "IsCompatibleWithPosKin",
    "GetPositionFromOrientation3",
    "GetPositionFromOrientation2",
    "GetPositionFromOrientation",
    "GetOrientationImageTotal",
    "GetOrientationImageWithOri",
)


@dataclass(frozen=True)
class _Source:
    """A method before it is written: its signature, its program, and its call of a branch."""

    signature: Signature
    program: Program | None = None
    call: BranchCall | None = None
    is_shared: bool = False
    search: FindRoot | None = None
    """The search, for the methods that search for a root."""


def methods_of(kinematics: Kinematics, block: Block, contract: Contract, templates: Environment) -> tuple[Method, ...]:
    """All methods in the order of the contract; a private method follows the method that calls it."""
    return tuple(
        _method(source, kinematics, block, contract, templates) for source in _sources(kinematics, block, contract)
    )


@kept_by_identity(10)
def spelled_inputs(kinematics: Kinematics) -> dict[str, str]:
    """The spelling in a method of every input of the programs other than `setup`."""
    spelled = {name: stored_as(kinematics, name) for name in constants(kinematics)}
    for index, joint in enumerate(kinematics.mechanism.joints):
        spelled[joint.axis.name] = f"a.a{index}"
        spelled[joint.reference.name] = f"aRef.a{index}"
        spelled[joint.turn.name] = parameter_name(joint.turn.name)
    for axis in "xyz":
        spelled[f"flange_axis_{axis}"], spelled[f"base_axis_{axis}"] = (
            f"flangeAxis.d{axis.upper()}",
            f"baseAxis.d{axis.upper()}",
        )
    spelled |= {f"sigma_{b.name}": parameter_name(f"sigma_{b.name}") for b in kinematics.branches}
    return spelled | {f"r{r}{c}": f"rot[{r}, {c}]" for r in (1, 2, 3) for c in (1, 2, 3)}


def _sources(kinematics: Kinematics, block: Block, contract: Contract) -> Iterator[_Source]:
    known = contract.signatures
    names = _names(block, contract)
    programs = _programs(kinematics, block, names)
    solved = {"CartesianToAxes": kinematics.branch, "CartesianToAxes_Offset": kinematics.offset_branch}
    ready: set[str] = set()
    for name in names:
        program = solved.get(name)
        if program is None:
            call = _call(name, kinematics.branch, kinematics, block, contract) if name == "Diagnose" else None
            yield _Source(known[name], programs.get(name), call)
            yield from _shared(programs.get(name), kinematics, contract, ready)
            if name == "GetPositionFromOrientation3":
                yield _Source(_end_point(known[name], block, contract))
            continue
        call = _call(name, program, kinematics, block, contract)
        yield _Source(known[name], call=call)
        is_plain = name == "CartesianToAxes"
        solving = without_checks(program)
        yield _Source(_explained(call.signature, block) if is_plain else call.signature, solving)
        yield from _shared(program, kinematics, contract, ready)


def _call(name: str, program: Program, kinematics: Kinematics, block: Block, contract: Contract) -> BranchCall:
    """The call of a branch in a public method, which checks the inputs first."""
    public = contract.signatures["CartesianToAxes" if name == "Diagnose" else name]
    errors, error = contract.spelling["errors"], contract.spelling["types"]["error"]
    refusal = Refusal(public, errors, error)
    if name == "Diagnose":
        refusal = Told(contract.signatures[name], errors, error, reasons_of(kinematics))
    printer = StructuredText(_positions(public) | spelled_inputs(kinematics))
    found = checks(program)
    lines = commented(refusal.lines(found, printer), found[0].comment) if found else []
    return branch_call(public, program, kinematics, block, tuple(lines))


def _programs(kinematics: Kinematics, block: Block, names: Sequence[str]) -> dict[str, Program | None]:
    """The programs of the methods that compute one, by the name of the method; those of a branch have their own
    method.
    """
    programs = {
        "ReadInputs": setup_of(kinematics),
        "AxesToCartesian": kinematics.forward,
        "AxesToOrientation": kinematics.orientation,
        "TestLimits": kinematics.limits,
        "FindMargins": kinematics.singularity,
        "GetOrientationImage": kinematics.image,
        "GetFlangeOrientationImageWithOri": kinematics.projection,
        "AxesToConfiguration_Offset": kinematics.offset_configuration,
        "FindJacobian": kinematics.jacobian,
        "IsCompatibleWithPosKin": kinematics.compatible,
        "GetPositionFromOrientation3": kinematics.end_point_shift,
        "GetOrientationImageTotal": kinematics.total_image,
        "GetOrientationImageWithOri": kinematics.image if kinematics.total_image else kinematics.projection,
    }
    total = {} if "GetOrientationImage" in names else {"GetFlangeOrientationImageTotal": kinematics.image}
    return {**programs, **total}


def _quotable(text: str) -> str:
    """The text as it is written between the quotes of a string."""
    return text.replace("$", "$$").replace("'", "$'")


def _explained(signature: Signature, block: Block) -> Signature:
    """The signature with the further outputs that Diagnose reads. A block without axes never refuses."""
    if not block.axes:
        return signature
    outputs = (Parameter("VAR_OUTPUT", REASON, "INT"), Parameter("VAR_OUTPUT", MISSING, "LREAL"))
    return replace(signature, parameters=(*signature.parameters, *outputs))


def _shared(program: Program | None, kinematics: Kinematics, contract: Contract, ready: set[str]) -> Iterator[_Source]:
    """The shared programs that no earlier method calls."""
    called = shared([program]) if program is not None else ()
    for inner in (p for p in called if p.name not in ready):
        ready.add(inner.name)
        if (search := search_in(inner)) is not None:
            yield _Source(try_at_signature(search), search=search)
        yield _Source(signature_of(inner, spelled_inputs(kinematics), contract), inner, is_shared=True, search=search)


def _names(block: Block, contract: Contract) -> list[str]:
    """The public methods of the implemented interfaces, and those of the block itself; the most important are first."""
    names = [m for i in contract.closure(block.interfaces) for m in i.methods]
    names = [n for n in dict.fromkeys([*names, *contract.own, *contract.supplied]) if n not in INHERITED]
    return sorted(names, key=lambda name: _FIRST.index(name) if name in _FIRST else len(_FIRST))


def _end_point(public: Signature, block: Block, contract: Contract) -> Signature:
    """The signature of the private method that finds the end point on a flange of known orientation. Of a block without
    axes it is the same point for every orientation.
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
    context: dict[str, object] = {"block": block, "method": name, "call": source.call, "reads_rotation": reads}
    if name == "Diagnose":
        context["reasons"] = [_quotable(text) for text in texts(kinematics)]
    if source.search is not None:
        context |= {"shared": search_text(source.search), "search": SEARCH}
    elif source.program is not None:
        context["program"] = program = _printed(source, source.program, kinematics, block, contract)
        own = own_names(source.program, spelled_inputs(kinematics))
        context["results"] = [(own[o], text) for o, text in program.outputs.items() if o in own and own[o] != text]
        context["unexplained"] = [
            (p.name, "0.0" if p.type == "LREAL" else "0")
            for p in source.signature.parameters
            if p.name in (REASON, MISSING, TURN) and f"{p.name} :=" not in program.body
        ]
    template = "Shared" if source.is_shared and source.search is None else name
    text = templates.get_template(f"methods/{template}.st.j2").render(contract.spelling, **context)
    return Method(source.signature.head(), with_gathered(tidy(text)))


def _printed(source: _Source, program: Program, kinematics: Kinematics, block: Block, contract: Contract) -> Printed:
    signature = source.signature
    taken = {i.name for i in block.inputs} | {name for name, _ in block.fields} | {p.name for p in signature.parameters}
    taken |= {"NumAxes", *BASE_VARIABLES, *contract.signatures}
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
        refused = OfInputs(signature, errors, error, refused_texts(kinematics))
        return chained(printed(conditions_first(program), given, stored, taken, refused))
    spelled = spelled_inputs(kinematics)
    if source.is_shared:
        own = own_names(program, spelled)
        return printed(program, spelled | own, {o.name: own[o.name] for o in program.outputs}, taken, refusal)
    shares = shares_of(program) if signature.name in _BRANCHES else None
    return printed(program, _positions(signature) | spelled, {}, taken, refusal, shares)


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
    point = "v_MCS" if "v_MCS" in names else "f.vT"
    spelled = {axis: f"{point}.d{axis.upper()}" for axis in "xyz"}
    if "vOffset_TCP" in names:
        spelled |= {f"point_{axis}": f"vOffset_TCP.d{axis.upper()}" for axis in "xyz"}
    return spelled
