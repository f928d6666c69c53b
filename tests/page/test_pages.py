"""Every page of the catalogue: whole, well-formed, by itself; its programs, executed from the page, answer the same."""

import re

import numpy as np
import pytest

from derive.emit.page.names import Spelling
from derive.ir.interpret import run as interpreted
from derive.ir.program import Call, Iterate, Program, Require, Solve, Status
from derive.ir.symbols import Flag
from derive.kinematics.branches.assembly import with_derived_assembly
from derive.kinematics.inverse import solve_pose
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.lost_digits.doubts import without_meeting
from derive.kinematics.search.choice import with_search
from derive.kinematics.search.derivations import solve_both
from derive.kinematics.solution import prepared
from derive.plate.passive import solve_passive
from derive.report.derived import equations_of
from derive.solver.derivation import Step
from tests.mechanisms import kinematics_of, named
from tests.page.made import NAMES, page, samples, spelled, spelling, tree
from tests.page.reading import every, has_class, maths, parsed, residuals, run, section, value_of

pytestmark = pytest.mark.broad

_CLOSE = 1e-9
SEARCHED = "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"
EACH = pytest.mark.parametrize("name", NAMES)
WITH_AXES = pytest.mark.parametrize("name", [n for n in NAMES if named(n).joints])


@EACH
def test_a_page_stands_by_itself(name: str) -> None:
    """It is well-formed, has no script, asks for nothing else, and is small."""
    text = page(name).text
    assert tree(name).tag.endswith("html")
    assert "<script" not in text and "javascript:" not in text
    assert set(re.findall(r"https?://[\w./]+", text)) <= {"http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"}
    assert not re.search(r'(?:src|href)="(?!data:|#)', text)
    assert len(text.encode()) < 1_000_000
    anchors = re.findall(r'href="#([^"]+)"', text)
    assert anchors and all(f'id="{a}"' in text for a in anchors)
    identities = re.findall(r'\bid="([^"]+)"', text)
    assert len(identities) == len(set(identities))


@EACH
def test_parameters_and_singularities_are_named(name: str) -> None:
    """Every parameter with its meaning, its name in Python and its input; every margin by its name."""
    kinematics, spell = kinematics_of(named(name)), spelling(name)
    cells = [["".join(c.itertext()) for c in row] for row in every(section(tree(name), "machine"), "tr")]
    for parameter in kinematics.parameters:
        (row,) = [c for c in cells if len(c) == 8 and c[6] == parameter.name]
        assert row[:2] == [spell(parameter.name), parameter.meaning]
    shown = [s.get("id") for s in every(section(tree(name), "singularities"), "section")]
    assert shown == [f"margin-{m.name}" for m in kinematics.margins]


@EACH
def test_what_repeats_the_derivation_is_folded(name: str) -> None:
    """Programs stand folded, the lines of a step do not; lengths stand before limits, which are folded."""
    folded = {e.get("id"): e for e in every([tree(name)], "details") if e.get("open") is None}
    assert len(folded) == len(list(every([tree(name)], "details")))
    programs = list(every([tree(name)], "ol", "program"))
    inside = [p for one in folded.values() for p in every([one], "ol", "program")]
    assert inside
    own = [*every(section(tree(name), "derivation"), "ol", "program"), *every(section(tree(name), "jacobian"), "ol")]
    assert all(p in inside or p in own for p in programs)
    plain = [e for e in section(tree(name), "machine") if has_class(e, "wide")]
    tables = ["".join(t.itertext()) for t in every(plain, "table")]
    limits = [p.name for p in kinematics_of(named(name)).parameters if p.name.startswith(("lower_", "offset_"))]
    settings = "".join(folded["settings"].itertext())
    assert all(limit in settings and not any(limit in table for table in tables) for limit in limits)


@WITH_AXES
def test_the_meaning_of_a_branch_is_read(name: str) -> None:
    """Where the page says that a branch has its first name, and only there, its sign is that of byte 1."""
    mechanism, values = kinematics_of(named(name)).mechanism, samples(name)
    items = [item for shown in every(section(tree(name), "branches"), "ul", "signs") for item in shown]
    known = spelled(name, values)
    for joint in mechanism.joints:
        plain = values[joint.axis.name] - values[joint.offset.name]
        known[spelling(name)(str(joint.symbol))] = np.radians(plain) if joint.in_degrees else plain
    for branch, item in zip(mechanism.branches, items, strict=True):
        words = "".join(item.itertext())
        assert f"{branch.name}: 1 is {branch.names[0]}, 2 is {branch.names[1]}" in words
        if branch.is_crossing or branch.meanings[0]:
            assert f"In {branch.names[0]} " in words and branch.meanings[0] in words
        elif not mechanism.drives and not any(j.is_geared or j.coupling for j in mechanism.joints):
            first = value_of(maths(item), known)  # elsewhere a joint is not its axis less its offset
            np.testing.assert_array_equal(first, values[f"sigma_{branch.name}"] > 0, err_msg=branch.name)


def _steps(name: str) -> list[tuple[Step, ...]]:
    mechanism = with_derived_assembly(with_search(prepared(named(name))))
    if mechanism.search is None:
        first = [solve_passive(mechanism).steps] if mechanism.passive else []
        return [*first, solve_pose(mechanism).derivation.steps]
    both = solve_both(mechanism)
    return [found.derivation.steps for found in (both.closed, both.trial) if found is not None]


@EACH
def test_every_step_in_its_order(name: str) -> None:
    """The steps of the record: unknowns, rule and equations, in the order in which they were found."""
    mechanism = named(name)
    shown = [
        "".join(next(every([s], "h3")).itertext())
        for s in every(section(tree(name), "derivation"), "section", "step")
        if not str(s.get("id")).startswith("forward")
    ]
    joints = {j.symbol: j.name for j in mechanism.joints}
    expected = []
    for steps in _steps(name):
        for number, step in enumerate(steps, 1):
            unknowns = ", ".join(joints.get(u, str(u)) for u in step.found.unknowns) or "no unknown"
            labels = " and ".join(e.label for e in equations_of(step))
            labels = labels or ("sum of parallel angles" if step.found.rule == "sum" else "the equations above")
            expected.append(f"Step {number}: {unknowns} ← {step.found.rule} ← {labels}")
    assert shown == expected


@WITH_AXES
def test_the_derivation_holds(name: str) -> None:
    """Executed from the page at regular poses, the steps solve their equations, and all equations of the closure."""
    values = samples(name)
    known = spelled(name, values)
    known["assemblySign"] = known.get("assemblySign", np.asarray(0.0))
    checked = 0
    # A search has no steps at its poses: its trial knows the joint, its closed form is another machine.
    for shown in () if name == SEARCHED else [section(tree(name), "derivation")]:
        lines = [li for li in _lines(shown) if not _is_of_forward(li, shown)]
        found = run(lines, known)
        for block in every(shown, "div", "equations"):
            if _is_of_forward(block, shown) or has_class(block, "free") or has_class(block, "refused"):
                continue
            if has_class(block, "sum"):
                turns = np.stack(list(residuals(block, _with_angles(found)))) / (2.0 * np.pi)
                assert np.max(np.abs(turns - np.round(turns))) <= _CLOSE, name
                continue
            for residual in residuals(block, found):
                size = max(1.0, float(np.max(np.abs(known.get("x", 1.0)))), _size(name))
                assert np.max(np.abs(residual)) <= _CLOSE * size**2, (name, residual)
                checked += 1
    assert checked or name == SEARCHED


def _with_angles(found: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The values, with every angle whose cosine and sine are known."""
    sines = [n.removeprefix("sin") for n in found if n.startswith("sin") and f"cos{n[3:]}" in found]
    return {n[:1].lower() + n[1:]: np.arctan2(found[f"sin{n}"], found[f"cos{n}"]) for n in sines} | found


def _size(name: str) -> float:
    return max((abs(p.nominal) for p in named(name).parameters if p.unit == "u"), default=1.0)


def _lines(elements: list) -> list:  # type: ignore[type-arg]
    return [li for program in every(elements, "ol", "program") for li in program]


def _is_of_forward(element: object, shown: list) -> bool:  # type: ignore[type-arg]
    """Whether an element belongs to forward kinematics, which has names of its own."""
    place = next((k for k, e in enumerate(shown) if e.text == "Forward kinematics"), len(shown))
    return any(element in list(e.iter()) for e in shown[place:])


def _is_straight(program: Program) -> bool:
    """Whether a page has all of it in formulas: no loop, no call, no unknowns of linear equations."""
    loops = (Iterate, Call)
    return not any(isinstance(s, loops) or (isinstance(s, Solve) and s.right) for s in program.body)


@WITH_AXES
def test_the_programs_are_those_of_the_block(name: str) -> None:
    """Constants, inverse, forward, Jacobian and margins, executed from the page, answer what the programs answer."""
    kinematics = kinematics_of(named(name))
    values = samples(name)
    known = spelled(name, {p.name: values[p.name] for p in kinematics.parameters})
    constants = run(_program(name, "constants"), known) if not _setup_iterates(kinematics) else {}
    everything = spelled(name, values)
    for spelled_name in constants.keys() & everything.keys():
        np.testing.assert_allclose(constants[spelled_name], everything[spelled_name], rtol=1e-12, err_msg=name)
    assert not _setup_iterates(kinematics) or name in PLATES
    for anchor, program in (
        ("inverse-program", without_meeting(kinematics.branch)),
        ("forward-program", kinematics.forward),
        ("singularities", kinematics.singularity),
    ):
        if not program.outputs:
            assert program is kinematics.singularity and not kinematics.margins
        elif _is_straight(program):
            _compare(name, anchor, program, everything | constants)
        else:
            assert name in (SEARCHED, *PLATES)
    if _is_straight(kinematics.jacobian):
        _compare_jacobian(name, kinematics, everything)


PLATES = tuple(n for n in NAMES if named(n).is_platform)


def _setup_iterates(kinematics: Kinematics) -> bool:
    return any(not isinstance(s, Require) and isinstance(s, Solve | Iterate | Call) for s in kinematics.setup.body)


def _program(name: str, anchor: str) -> list:  # type: ignore[type-arg]
    headings = {e.get("id") for e in tree(name).iter()}
    return _lines(section(tree(name), anchor)) if anchor in headings else []


def _compare(name: str, anchor: str, program: Program, known: dict[str, np.ndarray]) -> None:
    values, spell = samples(name), spelling(name)
    expected, status = interpreted(program, values)
    assert np.all(status == Status.OK), (name, program.name)
    inputs = {spell(s.name) for s in program.inputs}
    given = {n: v for n, v in known.items() if n in inputs} | _without_steps(name, spell)
    found = run(_program(name, anchor), given)
    compared = 0
    for output in program.outputs:
        if output.value.is_number:
            continue
        shown = found.get(spell(output.name))
        assert shown is not None, (name, program.name, output.name)
        scale = np.max(np.abs(expected[output.name]), initial=1.0)
        np.testing.assert_allclose(shown, expected[output.name], rtol=0, atol=1e-9 * scale, err_msg=output.name)
        compared += 1
    assert compared or program.name == "singularity"


def _without_steps(name: str, spell: Spelling) -> dict[str, np.ndarray]:
    """What the rare call that meets a pose binds, where it is not made: false and zeros."""
    calls = [s for s in kinematics_of(named(name)).branch.body if isinstance(s, Call) and s.is_rare]
    return {spell(n.name): np.array(False if isinstance(n, Flag) else 0.0) for s in calls for n in s.names}


def _compare_jacobian(name: str, kinematics: Kinematics, known: dict[str, np.ndarray]) -> None:
    shown = section(tree(name), "jacobian")
    programs = list(every(shown, "ol", "program"))
    body, entries = list(programs[-1]), list(programs[0])
    found = run([*body, *entries], known)
    expected, _ = interpreted(kinematics.jacobian, samples(name))
    (matrix,) = every(shown, "div", "matrix")
    outputs, cells = kinematics.jacobian.outputs, list(every([matrix], "mtd"))
    assert len(cells) == len(outputs)
    for cell, output in zip(cells, outputs, strict=True):
        scale = np.max(np.abs(expected[output.name]), initial=1.0)
        value = value_of([cell], found)
        np.testing.assert_allclose(value, expected[output.name], rtol=0, atol=1e-9 * scale, err_msg=output.name)


def test_a_wrong_sign_is_seen() -> None:
    """The reader is no sieve: a sign that is wrong on the page of a SCARA makes another program of it."""
    name = "Kin_Scara4_ZCcoupled_Type1"
    shown = section(tree(name), "derivation")
    assert len([m for e in shown for m in maths(e)]) > 60
    right, product = page(name).text, "<mi>armAlongA1</mi><mo>⋅</mo><mi>y</mi>"
    wrong = right.replace(f"{product}<mo>−</mo>", f"{product}<mo>+</mo>")
    assert wrong != right
    known, spell = spelled(name, samples(name)), spelling(name)
    found = [run(_lines(section(parsed(text), "inverse-program")), known)[spell("axis_a1")] for text in (right, wrong)]
    assert np.max(np.abs(found[0] - found[1])) > 1.0
