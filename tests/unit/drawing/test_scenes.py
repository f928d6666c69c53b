"""The drawing is right: the closure holds at the drawn tool frame, bars have their lengths, arrows their directions."""

from dataclasses import replace

import numpy as np
import pytest

from derive.description.mechanism import Mechanism
from derive.drawing.drawing import is_turned_round
from derive.drawing.labels import axis_name
from derive.drawing.scene import Body, Scene
from derive.emit.picture.ink import Line
from derive.emit.picture.symbols import rails, slide_arrow
from derive.emit.picture.view import Box, fitted
from tests.unit.drawing.machines import CATALOGUE, CHAINS, KINDS, RODS, Drawn, drawn

pytestmark = pytest.mark.broad

STEP = 1e-4
SLIDES = tuple(n for n, m in CATALOGUE.items() if m.chain is not None and any(not j.is_angle for j in m.joints))


@pytest.fixture(params=KINDS)
def one(request: pytest.FixtureRequest) -> Drawn:
    return drawn(request.param)


@pytest.fixture(params=CHAINS)
def chain(request: pytest.FixtureRequest) -> Drawn:
    return drawn(request.param)


@pytest.fixture(params=RODS)
def loop(request: pytest.FixtureRequest) -> Drawn:
    return drawn(request.param)


def test_the_closure_holds_at_the_drawn_tool_frame(one: Drawn) -> None:
    residual = one.closure.residual(one.joints, one.pose, one.parameters)
    scale = 1.0 + np.abs(one.pose).max() ** 2
    assert np.abs(residual).max() < 1e-5 * scale
    if one.mechanism.chain is not None:
        assert one.closure.frame(one.joints, one.parameters)[0, :, 0] == pytest.approx(one.pose[0], abs=1e-5)


def test_bars_and_links_have_the_lengths_of_parameters(one: Drawn) -> None:
    """Every dimension of one parameter is, between its ends, as long as the nominal parameter."""
    nominal = {p.name: p.nominal for p in one.mechanism.parameters}
    for dimension in one.drawing.scene.dimensions:
        stated = float(dimension.label.subs(nominal))
        between = np.linalg.norm(np.subtract(dimension.end, dimension.start))
        assert between == pytest.approx(abs(stated), rel=1e-9), dimension.label
        assert dimension.is_negative == (stated < 0)


@pytest.mark.parametrize(
    ("name", "angles"),
    [("Kin_Delta_P3C_Type3", {"azimuth_1", "azimuth_2", "azimuth_3"}), ("Kin_Tripod_Linear", {"rail_angle"})],
)
def test_angles_are_as_wide_as_their_parameters(name: str, angles: set[str]) -> None:
    one = drawn(name)
    scene = one.drawing.scene
    nominal = {p.name: p.nominal for p in one.mechanism.parameters}
    assert {str(arc.label) for arc in scene.arcs} == {a for a in angles if nominal[a] != 0}
    assert {a for a in angles if nominal[a] == 0} <= set(map(str, scene.hidden))
    for arc in scene.arcs:
        assert np.degrees(np.arccos(np.dot(arc.start, arc.end))) == pytest.approx(abs(nominal[str(arc.label)]))


def test_every_rod_is_drawn_with_its_length(one: Drawn) -> None:
    scene, mechanism = one.drawing.scene, one.mechanism
    bars = mechanism.bars or mechanism.rods
    rods = [s for s in scene.segments if s.body is Body.ROD]
    assert len(rods) == len(bars)
    nominal = {p.symbol: p.nominal for p in mechanism.parameters}
    nominal |= dict(zip([j.symbol for j in mechanism.joints], one.joints[0], strict=True))
    for segment, bar in zip(rods, bars, strict=True):
        assert np.linalg.norm(np.subtract(segment.end, segment.start)) == pytest.approx(
            float(bar.length.subs(nominal)), rel=1e-6
        )


def test_the_bodies_of_a_chain_reach_from_the_base_to_the_tool(chain: Drawn) -> None:
    scene = chain.drawing.scene
    origin = (0.0, 0.0, 0.0)
    ends = [(origin, origin), *((s.start, s.end) for s in scene.segments)]
    assert all(a[1] == pytest.approx(b[0]) for a, b in zip(ends, ends[1:], strict=False))
    assert ends[-1][1] == pytest.approx(scene.tool.position, abs=1e-6)


def _moved(one: Drawn, index: int) -> np.ndarray:
    """The pose of the tool where one axis went a little on; of a loop by its rates."""
    axes = one.axes.copy()
    axes[0, index] += STEP
    return one.closure.frame(one.joints_at(axes), one.parameters)[0, :, 0]


def test_arrows_of_a_chain_point_where_the_axis_goes(chain: Drawn) -> None:
    scene, mechanism = chain.drawing.scene, chain.mechanism
    for index, joint in enumerate(mechanism.joints):
        name = axis_name(joint)
        moved = (_moved(chain, index)[:3] - chain.pose[0, :3]) / STEP
        turns = [t for t in scene.turns if t.label == name]
        slides = [s for s in scene.slides if s.has_arrow and name in s.label.free_symbols]
        if joint.coupling != 0 or any(joint.motor in j.coupling.free_symbols for j in mechanism.joints):
            continue  # a gear turns several joints: the arrows are those of the joints
        if turns:
            (turn,) = turns
            following = scene.turns[scene.turns.index(turn) + 1 :]
            is_turned_back = sum(joint.symbol in f.amount.free_symbols for f in mechanism.chain.factors) > 1
            end = following[0].at if is_turned_back and following else scene.tool.position  # bars keep the rest
            expected = np.cross(turn.axis, np.subtract(end, turn.at)) * np.radians(1.0)
            along = sum(
                (s.axis * np.array(float(s.label.coeff(name).subs(_nominal(mechanism)))) for s in slides), np.zeros(3)
            )
            assert moved == pytest.approx(expected + along, abs=1e-3)
        else:
            (slide,) = slides
            assert moved / np.linalg.norm(moved) == pytest.approx(np.array(slide.axis), abs=1e-6)


def _nominal(mechanism: Mechanism) -> dict[str, float]:
    return {p.name: p.nominal for p in mechanism.parameters}


def test_arrows_of_a_loop_point_where_its_bars_go(loop: Drawn) -> None:
    """The rate of the plate by the closure is the rate that turning cranks and sliding carriages about the arrows
    gives.
    """
    mechanism, scene = loop.mechanism, loop.drawing.scene
    by_joints = loop.closure.by_joints(loop.joints, loop.pose, loop.parameters)[0]
    for index, joint in enumerate(mechanism.joints):
        bar = next(
            s
            for s, rod in zip(scene.segments, mechanism.rods, strict=False)
            if joint.symbol in rod.equation.free_symbols
        )
        span = np.subtract(bar.end, bar.start)
        name = axis_name(joint)
        turn = next((t for t in scene.turns if t.label == name), None)
        slide = next((s for s in scene.slides if s.label == name), None)
        if turn is not None:
            rate = -2 * span @ np.cross(turn.axis, np.subtract(bar.start, turn.at))
        else:
            assert slide is not None
            rate = (
                -2 * span @ np.array(slide.axis)
            )  # a carriage takes the base end along; a leg that grows has this rate too
        assert by_joints[:, index].sum() == pytest.approx(rate, rel=1e-6)


def test_every_axis_is_drawn(one: Drawn) -> None:
    scene = one.drawing.scene
    labels = {symbol for item in (*scene.turns, *scene.slides) for symbol in item.label.free_symbols}
    assert {axis_name(joint) for joint in one.mechanism.joints} <= labels


def test_both_scenes_of_a_choice_have_the_same_tool(one: Drawn) -> None:
    """The bytes of a configuration choose between ways to one pose; the way of assembly between
    poses of the same axes.
    """
    shown = [choice for choice in one.drawing.choices if choice.scenes is not None]
    for choice in shown:
        first, second = choice.scenes or ()
        if one.mechanism.task.position:
            assert first.tool.position == pytest.approx(second.tool.position, abs=1e-4)
        turned = any(is_turned_round(a, b) for a, b in zip(first.turns, second.turns, strict=True))  # a wrist flips
        assert turned or _skeleton(first) != pytest.approx(_skeleton(second), abs=1.0)
    if one.drawing.assembly is not None and one.drawing.assembly.scenes is not None:
        first, second = one.drawing.assembly.scenes
        assert first.tool != second.tool


def _skeleton(scene: Scene) -> np.ndarray:
    return np.array([(s.start, s.end) for s in scene.segments]).ravel()


def test_rails_that_begin_in_one_point_are_stacked() -> None:
    scene = drawn("Kin_Polar_Z").drawing.scene
    (_, end), (start, _) = rails(scene).values()
    assert start == pytest.approx(end)
    alone = replace(scene, slides=scene.slides[:1])
    assert next(iter(rails(alone).values()))[1] == pytest.approx(end)


@pytest.mark.long
@pytest.mark.parametrize("name", SLIDES)
def test_the_arrow_of_a_slide_runs_along_it(name: str) -> None:
    drawing = drawn(name).drawing
    assert drawing.scene.slides
    ends = rails(drawing.scene)
    view = fitted([p for pair in ends.values() for p in pair], Box(0.0, 0.0, 800.0, 500.0), plane=drawing.plane)
    for slide in (s for s in drawing.scene.slides if s.has_arrow):
        along = view.direction(slide.axis)
        shafts = [m for m in slide_arrow(slide, ends[slide], view, is_beside=False) if isinstance(m, Line)]
        assert shafts
        for mark in shafts:
            drawn_along = np.subtract(mark.points[-1], mark.points[0])
            assert drawn_along @ along == pytest.approx(np.linalg.norm(drawn_along) * np.linalg.norm(along), rel=1e-3)


@pytest.mark.long
def test_a_joint_that_bars_turn_back_has_no_arrow() -> None:
    """A palletizer: A3 drives the forearm against the base; nothing drives the wrist, which keeps the flange level."""
    scene = drawn("Softkin_Palletizer").drawing.scene
    assert [str(turn.label) for turn in scene.turns] == ["A1", "A2", "A3", "0", "A4"]
    assert [turn.axis for turn in scene.turns[1:3]] == [pytest.approx((0.0, 1.0, 0.0))] * 2
