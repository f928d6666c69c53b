"""Blocks alone: every method, also inherited, and what was worked out by hand."""

import math

import numpy as np
import pytest

from bench.blocks import FOLDER, KINDS, Kind, measured
from derive.description.mechanism import Mechanism, Turning
from derive.emit.softmotion.base import INHERITED
from tests.catalogue.coupling.parts import ORIENTATIONS
from tests.catalogue.references import held_at
from tests.harness.library import Library
from tests.text.any_method import call_of, methods_of
from tests.text.comparisons import COMPARISONS, POSELESS
from tests.text.controller import IMPOSSIBLE, OK, UNREACHABLE, Controller
from tests.text.limits import EXACTLY_A_TURN, has_limits, is_inside
from tests.text.pairs import LOOPS, MECHANISMS, POSITION_KINEMATICS, Pair, pairs_of
from tests.text.units import compiled, compiled_text, file_of, public_methods, text_of

ROUND_TRIP = 1e-9
"""Away from singular poses: relative to a turn, or to the size of the machine."""


def unlimited(serial_pairs: tuple[Pair, ...]) -> list[Pair]:
    """The machines on which every pose is allowed."""
    return [t for t in serial_pairs if not has_limits(t.machine)]


def is_limited(one: Pair) -> bool:
    """Whether limits are given that some samples are beyond, checked or not."""
    if one.machine.label == EXACTLY_A_TURN:
        return any(joint.is_angle for joint in one.mechanism.joints)
    return one.machine.label.startswith("limit")


def test_inverse_kinematics_finds_the_axes_of_a_pose(serial_pairs: tuple[Pair, ...]) -> None:
    """With the bytes that forward kinematics writes, wherever the reference is where every byte can hold its turn."""
    for one in unlimited(serial_pairs):
        for sample in one.regular:
            status, pose = one.controller.forward(sample.axes)
            assert status == OK
            position, rotation, data = pose
            near = held_at(one.robot, sample.axes, sample.reference)
            status, axes = one.controller.inverse(position, rotation, data, near.tolist())
            assert status == OK, f"{one} {sample}"
            count = len(sample.axes)
            worst = max(abs(a - b) for a, b in zip(axes, sample.axes, strict=False))
            assert worst <= ROUND_TRIP * (one.machine.reach + 360.0), f"{one} {sample} {axes}"
            assert axes[count:] == (0.0,) * (6 - count)


def test_limits_refuse_what_is_beyond_them_and_nothing_else(serial_pairs: tuple[Pair, ...]) -> None:
    """Where every byte says what was chosen, and so no other solution is possible."""
    for one in serial_pairs:
        inside = is_inside(one.machine, np.array([sample.axes for sample in one.regular]))
        for sample, is_allowed in zip(one.regular, inside, strict=True):
            _, (position, rotation, data) = one.controller.forward(sample.axes)
            near = held_at(one.robot, sample.axes, sample.reference)
            status, _ = one.controller.inverse(position, rotation, data, near.tolist())
            assert status == (OK if is_allowed or not one.robot.checks_limits else UNREACHABLE), f"{one} {sample}"
        assert set(inside) == ({True, False} if is_limited(one) else {True})


def test_the_number_of_axes(serial_pairs: tuple[Pair, ...]) -> None:
    for one in serial_pairs:
        assert one.controller.block.get("NumAxes") == len(one.mechanism.joints)


def test_calling_the_block_itself_does_nothing(serial_pairs: tuple[Pair, ...]) -> None:
    one = serial_pairs[1]
    fields = [v.name for section in one.library.objects[one.mechanism.block_name].sections for v in section.variables]
    before = [getattr(one.controller.block, name) for name in fields]
    one.controller.block()
    assert [getattr(one.controller.block, name) for name in fields] == before


def test_the_orientation_is_that_of_the_frame_and_in_the_image(serial_pairs: tuple[Pair, ...]) -> None:
    """A flange with one degree of freedom turns about its axis; one with none does not turn."""
    for one in serial_pairs:
        whole = "GetOrientationImage".lower() not in one.controller.methods
        method = "GetFlangeOrientationImageTotal" if whole else "GetOrientationImage"
        _, (freedom, zero, base, flange) = one.controller.image(method)
        assert freedom == one.robot.FREEDOM
        for sample in one.regular:
            rotation = one.controller.forward(sample.axes)[1][1]
            assert whole or one.controller.orientation(sample.axes) == (OK, rotation)
            if freedom == "three":
                continue  # anything
            turned = [sum(r * u for r, u in zip(row, flange, strict=True)) for row in rotation]
            assert turned == pytest.approx(base, abs=1e-12)
            if freedom == "zero":
                assert rotation == zero


def test_the_projected_orientation_is_the_one_that_the_axes_reach(serial_pairs: tuple[Pair, ...]) -> None:
    """For tilted commands: GetFlangeOrientationImageWithOri, and forward kinematics of inverse kinematics."""
    for one in unlimited(serial_pairs):
        if "getflangeorientationimagewithori" not in one.controller.methods:
            continue
        for sample in one.regular:
            position = one.controller.forward(sample.axes)[1][0]
            default = one.robot.DEFAULT_CONFIGURATION
            status, axes = one.controller.inverse(position, sample.rotation, default, sample.axes)
            image_status, image = one.controller.image_with_orientation(sample.rotation)
            assert image_status == OK
            if status != OK:  # the last link swings with the commanded orientation
                assert status == UNREACHABLE
                continue
            reached = one.controller.forward(axes)[1][1]
            followed = slice(2, 3) if one.mechanism.task.turning is Turning.DIRECTION else slice(3)
            for row, wanted in zip(reached, image[1], strict=True):
                assert row[followed] == pytest.approx(wanted[followed], abs=1e-12)


@pytest.mark.long
def test_a_point_off_the_flange_comes_to_its_place(serial_pairs: tuple[Pair, ...]) -> None:
    """Round trip of the offset interface, with the configuration that it gives itself."""
    for one in unlimited(serial_pairs):
        if "cartesiantoaxes_offset" not in one.controller.methods:
            continue
        for sample in one.regular:
            for offset in ((0.0, 0.0, 0.0), sample.offset):
                point = place(one, sample.axes, offset)
                data = (0,) * 32
                if one.robot.CONFIGURATION:
                    data = one.controller.configuration_offset(sample.axes, offset)
                status, axes = one.controller.inverse_offset(point, offset, data, sample.axes)
                assert status == OK, f"{one} {sample}"
                found = place(one, axes[: len(sample.axes)], offset)
                size = one.machine.reach + math.hypot(*point)
                assert found == pytest.approx(point, abs=1e-9 * size), f"{one} {sample} {offset}"


def place(one: Pair, axes: tuple[float, ...], offset: tuple[float, ...]) -> list[float]:
    """Where a point of the flange is at axis values, by the block's own forward kinematics."""
    position, rotation, _ = one.controller.forward(axes)[1]
    turned = [sum(r * o for r, o in zip(row, offset, strict=True)) for row in rotation]
    return [p + t for p, t in zip(position, turned, strict=True)]


def geared(mechanism: Mechanism) -> Library:
    """A unit whose first axis has a gear, of one turn per turn."""
    text, place = text_of(mechanism), "layout.iRows :="
    assert place in text
    return compiled_text(file_of(mechanism), text.replace(place, f"layout.aGeared[0] := TRUE;\n{place}", 1))


def test_a_gear_of_one_turn_changes_nothing() -> None:
    """The turns of a joint behind a gear are counted by the base block; with one turn per turn they are those of the
    axis.
    """
    mechanism = next(m for m in MECHANISMS if m.name == "Kin_Scara4_ZCcoupled_Type1")
    one = pairs_of(mechanism)[0]
    other = Controller(geared(mechanism), mechanism)
    assert other.initialise(one.robot.parameters) == OK
    for sample in one.regular[:10]:
        axes = [value + 360.0 * k for k, value in enumerate(sample.axes)]
        assert other.forward(axes) == one.controller.forward(axes)


METHODS = [(mechanism, method) for mechanism in POSITION_KINEMATICS for method in public_methods(mechanism)]
"""Every method that stands in the emitted text. That private ones run is shown statement by statement elsewhere."""
ITERATED = ("Hexapod", "Hexaglide", "Pentapod", "3RRR", "ThreeParallel")
DEAR = tuple(f"{name}.{method}" for name in ITERATED for method in ("CartesianToAxes", "Diagnose"))
"""What takes long: inverse kinematics of machines that iterate."""
EVERYWHERE = (
    "AxesToCartesian", "CartesianToAxes", "AxesToOrientation", "IsSingularity", "Jacobian",
    "AxesToConfiguration_Offset", "CartesianToAxes_Offset",
)  # fmt: skip
"""Methods of loops that are asked for axis values at which no loop closes as well."""


def test_every_loop_is_here() -> None:
    assert len(LOOPS) == 20


@pytest.mark.parametrize("mechanism", (*POSITION_KINEMATICS, *ORIENTATIONS), ids=lambda m: m.name)
def test_every_method_is_here(mechanism: Mechanism) -> None:
    library = compiled(mechanism)
    block, base = library.objects[mechanism.block_name], library.objects["Softkin_Kinematics"]
    own, inherited = ([m.name for m in b.methods if m.access == "PUBLIC"] for b in (block, base))
    found = public_methods(mechanism)
    assert list(found[: len(own)]) == own and set(found[len(own) :]) <= set(inherited)
    assert {"Initialize", "Jacobian", "AxisVelocities"} <= set(found) or mechanism in ORIENTATIONS


@pytest.mark.slow(*DEAR)
@pytest.mark.long("Hexapod", "P2C_Type1.CartesianToAxes", "Pos_RRR.CartesianToAxes", "ToAxes_Offset", "Diagnose")
@pytest.mark.parametrize(("mechanism", "method"), METHODS, ids=[f"{m.block_name}.{method}" for m, method in METHODS])
def test_a_method_answers_as_in_python(mechanism: Mechanism, method: str) -> None:
    compare = COMPARISONS[method]
    for pair in pairs_of(mechanism):
        regular = pair.regular[:: 2 if mechanism.rods else 1]  # which has many, for its limits
        for sample in regular[: 3 if method in POSELESS else None]:
            compare(pair, sample)
        for sample in pair.anywhere if method in EVERYWHERE else ():
            compare(pair, sample)


def further_methods(controller: Controller) -> list[str]:
    """The public methods of the base that no interface of the block has."""
    known = {"Initialize", *methods_of(controller)}
    return sorted(INHERITED - known)


@pytest.mark.long("Hexa", "3RRR", "P2C", "Pos_RRR")
def test_a_further_method_answers_or_is_impossible(pairs: tuple[Pair, ...]) -> None:
    """What forward kinematics tells is answered; what a flange does not do is impossible, and writes nothing."""
    one = pairs[0]
    for method in further_methods(one.controller):
        call = call_of(one, one.controller, method, one.regular[0])
        before = call.state()
        result, after = call.run()
        if call.has_status:
            assert result in (OK, IMPOSSIBLE), method
            assert result == OK or after == before, method


def test_every_block_knows_its_orientation(pairs: tuple[Pair, ...]) -> None:
    for one in pairs[:2]:
        for sample in one.regular[:3]:
            status, found = one.controller.orientation(sample.axes)
            assert status == OK
            np.testing.assert_allclose(found, one.controller.forward(sample.axes)[1][1], rtol=0, atol=1e-12)


RATIO = 1.3
"""The algebra to that by hand, at most."""
CALLS = 30
"""Calls of functions a solution, at most."""
ROUNDING = 1e-13


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.name)
def test_the_text_by_hand_is_right(kind: Kind) -> None:
    """Forward kinematics, which the closure has proven, leads from its answers back to the pose, on its branch."""
    found = measured(kind)
    assert found.poses >= 40
    assert found.missed < ROUNDING


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.name)
def test_a_call_costs_no_more_than_promised(kind: Kind) -> None:
    """The whole call, all calls of functions, and the algebra beside that by hand."""
    found = measured(kind)
    assert found.call <= kind.most
    assert found.calls <= CALLS
    assert found.ratio <= RATIO
    assert min(found.by_hand) > 30, "something was counted"


def test_every_text_by_hand_is_measured() -> None:
    assert {path.stem for path in FOLDER.glob("*.st")} == {kind.by_hand for kind in KINDS}
