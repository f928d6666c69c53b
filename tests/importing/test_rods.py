"""MJCF: loops whose rods meet in the tip. Every solution of the derived inverse closes the loops as MuJoCo has them."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
import pytest

from derive.importing.importing import Options
from tests.importing.kinematics import Array, described, imported_text, refused
from tests.machines.made import built_of, imported_class

pytestmark = pytest.mark.slow


@dataclass(frozen=True)
class Loop:
    """A file, its base and tip, the task and the number of solutions that its description has."""

    file: str
    task: str
    solutions: int
    base: str | None = None
    tip: str | None = "tool"
    is_closed: bool = True
    """As the file draws it."""


def mjcf(bodies: str, equalities: str, rest: str = "") -> str:
    """A file; every body has a mass."""
    massive = bodies.replace("</body>", '<geom size="0.01" mass="1"/></body>')
    return f"<mujoco>{rest}<worldbody>{massive}</worldbody><equality>{equalities}</equality></mujoco>"


FIVE_BAR = mjcf(
    """<body name="arm1" pos="-0.05 0 0"><joint name="m1"/><body name="rod1" pos="0 0.12 0"><joint name="p1"/>
    <site name="tool" pos="0.05 0.15 0"/></body></body>
    <body name="arm2" pos="0.05 0 0.01"><joint name="m2"/><body name="rod2" pos="0 0.12 0"><joint name="p2"/></body>
    </body>""",
    '<connect body1="rod1" body2="rod2" anchor="0.05 0.15 0"/>',
    '<actuator><position joint="m1"/><position joint="m2"/></actuator>',
)
LOOPS: Mapping[str, Loop] = {
    "five-bar": Loop(FIVE_BAR, "xy", 4),
    "five-bar, one chain that a connect closes at an elbow": Loop(
        mjcf(
            """<body name="plate" pos="0.3 0.1 0.2" euler="0 0 1.5708">
            <body name="arm2" pos="0.4 0.01 0"><joint name="m2" axis="0 0 -1" ref="0.3"/></body>
            <body name="arm1" euler="0 0 0.4"><joint name="m1" range="-2 2"/><body name="rod1" pos="0.15 0 0.02">
            <joint name="p1"/><body name="rod2" pos="0.2 0.1 0"><joint name="p2" class="up"/><site name="tool"/>
            </body></body></body></body>""",
            '<connect body1="arm2" body2="rod2" anchor="0.03 0.15 0"/>',
            '<compiler angle="radian"/><default><default class="up"><joint axis="0 0 -1"/></default></default>',
        ),
        "xy",
        4,
        base="plate",
        tip=None,
    ),
    "five-bar, sites apart, joints about y": Loop(
        mjcf(
            """<body name="arm1" pos="-0.05 0 0"><joint name="m1" axis="0 1 0"/><body name="rod1" pos="0 0 0.12">
            <joint name="p1" axis="0 1 0"/><site name="tool" pos="0 0.01 0.17"/></body></body>
            <body name="arm2" pos="0.05 0 0"><joint name="m2" axis="0 1 0"/><body name="rod2" pos="0 0 0.12">
            <joint name="p2" axis="0 1 0"/><site name="end" pos="0.02 0.01 0.16"/></body></body>""",
            '<connect site1="tool" site2="end"/>',
        ),
        "xz",
        4,
        is_closed=False,
    ),
    "carriages": Loop(
        mjcf(
            """<body name="c1" pos="-0.2 0 0"><joint name="x1" type="slide" axis="1 0 0" range="-0.4 0.1"/>
            <body name="rod1"><joint name="p1"/><site name="tool" pos="0.2 0.25 0"/></body></body>
            <body name="c2" pos="0.3 0.02 0"><joint name="x2" type="slide" axis="1 0.2 0" ref="0.05"/>
            <body name="rod2"><joint name="p2"/></body></body>""",
            '<connect body1="rod2" body2="rod1" anchor="-0.3 0.23 0"/>',
        ),
        "xy",
        4,
    ),
    "three rods on slides": Loop(
        mjcf(
            """<body name="c1" pos="0.3 0 0"><joint name="z1" type="slide"/><body name="rod1">
            <joint name="b1" type="ball"/><site name="tool" pos="-0.3 0 -0.4"/></body></body>
            <body name="c2" pos="-0.15 0.25 0"><joint name="z2" type="slide"/><body name="rod2">
            <joint name="b2" type="ball"/></body></body>
            <body name="c3" pos="-0.15 -0.25 0.01"><joint name="z3" type="slide" axis="0 0.6 -0.8"/><body name="rod3">
            <joint name="b3" type="ball"/></body></body>""",
            """<connect body1="rod1" body2="rod2" anchor="-0.3 0 -0.4"/>
            <connect body1="rod3" body2="rod1" anchor="0.15 0.25 -0.41"/>""",
        ),
        "xyz",
        8,
    ),
    "three rods on arms, pairs of hinges": Loop(
        mjcf(
            "".join(
                f"""<body name="foot{k}" euler="0 0 {120 * k}"><body name="arm{k}" pos="0.2 0 0">
                <joint name="m{k}" axis="0 1 0"/><body name="rod{k}" pos="0.15 0 0"><joint name="u{k}" axis="0 1 0"/>
                <joint name="v{k}" axis="1 0 0"/>{'<site name="tool" pos="-0.35 0 -0.3"/>' if k == 1 else ""}
                </body></body></body>"""
                for k in (1, 2, 3)
            ),
            """<connect body1="rod1" body2="rod2" anchor="-0.35 0 -0.3"/>
            <connect body1="rod2" body2="rod3" anchor="-0.35 0 -0.3"/>""",
            "<actuator>" + "".join(f'<motor joint="m{k}"/>' for k in (1, 2, 3)) + "</actuator>",
        ),
        "xyz",
        8,
    ),
}


class Closure:
    """The loops of a file by MuJoCo: how far apart they hold its parts, with the tip at a place."""

    def __init__(self, path: Path, base: str) -> None:
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        self.base = base

    def place(self) -> Array:
        """The tip in the base (metres) at the present joint values."""
        mujoco.mj_kinematics(self.model, self.data)
        base = self.data.body(self.base)
        return np.asarray(base.xmat.reshape(3, 3).T @ (self.data.site("tool").xpos - base.xpos))

    def _gaps(self, kept: Array, wanted: Array) -> Array:
        found = [(self.place() - wanted)[kept]]
        for kind, first, second, at in zip(
            self.model.eq_objtype, self.model.eq_obj1id, self.model.eq_obj2id, self.model.eq_data, strict=True
        ):
            if kind == mujoco.mjtObj.mjOBJ_SITE:
                found.append(self.data.site_xpos[first] - self.data.site_xpos[second])
            else:
                ends = [
                    self.data.xpos[b] + self.data.xmat[b].reshape(3, 3) @ a
                    for b, a in ((first, at[:3]), (second, at[3:6]))
                ]
                found.append(ends[0] - ends[1])
        return np.concatenate(found)

    def missed(self, motors: Mapping[str, float], kept: Array, wanted: Array) -> float:
        """What is left of all gaps by Newton's method in the joints without a motor, from the best of some starts."""
        rng = np.random.default_rng(4)
        moved = [self.model.joint(name).dofadr[0] for name in motors]
        free = [k for k in range(self.model.nv) if k not in moved]
        return min(self._newton(motors, free, kept, wanted, rng.normal(size=self.model.nv)) for _ in range(12))

    def _newton(self, motors: Mapping[str, float], free: list[int], kept: Array, wanted: Array, start: Array) -> float:
        self.data.qpos[:] = self.model.qpos0
        self._move(start)
        for name, value in motors.items():
            self.data.joint(name).qpos[0] = value
        for _ in range(40):
            gaps, here = self._gaps(kept, wanted), self.data.qpos.copy()
            columns = []
            for k in free:
                self._move(1e-7 * np.eye(self.model.nv)[k])
                columns.append((self._gaps(kept, wanted) - gaps) / 1e-7)
                self.data.qpos[:] = here
            step = np.zeros(self.model.nv)
            step[free] = -np.linalg.lstsq(np.column_stack(columns), gaps, rcond=1e-5)[0]
            self._move(step / max(1.0, float(np.abs(step).max())))
            if np.abs(step).max() < 1e-12:
                break
        return float(np.abs(self._gaps(kept, wanted)).max())

    def _move(self, step: Array) -> None:
        mujoco.mj_integratePos(self.model, self.data.qpos, step, 1.0)


@pytest.mark.parametrize("name", LOOPS)
def test_every_solution_closes_the_loops_of_the_file(name: str, tmp_path: Path) -> None:
    loop = LOOPS[name]
    path = tmp_path / f"rods_{[*LOOPS].index(name)}.xml"
    found = imported_text(path, loop.file, loop.base, loop.tip)
    mechanism = described(found, tmp_path)
    assert f'Task("{loop.task}")' in found.text
    built = built_of(mechanism)
    modes = [imported_class(mechanism, built)(check_limits=False)]
    flag = next(name for name in modes[0].parameters if name.startswith(("tcp_", "assembly_")))
    modes.append(modes[0].changed(**{flag: True}))
    closure = Closure(path, loop.base or "world")
    units = np.array([1000.0 if a.kind.value == "linear" else 180.0 / np.pi for a in found.robot.axes])
    zero = np.array([closure.model.joint(a.name).qpos0[0] for a in found.robot.axes]) * units
    kept = np.array(["xyz".index(c) for c in loop.task])
    if loop.is_closed:
        closure.data.qpos[:] = closure.model.qpos0
        frame, _ = modes[0].forward(zero)
        assert np.abs(np.array(frame.position) - 1000.0 * closure.place())[kept].max() <= 1e-6
        assert modes[0].inverse(frame) == pytest.approx(zero, abs=1e-6)
    for offset in np.random.default_rng(5).uniform(-9.0, 9.0, (3, len(zero))):
        frame, _ = modes[0].forward(zero + offset)
        solutions = [s.axes for mode in modes for s in mode.inverse_all(frame) if s.axes is not None]
        assert len(solutions) == loop.solutions
        for axes in solutions:
            motors = dict(zip([a.name for a in found.robot.axes], np.array(axes) / units, strict=True))
            assert closure.missed(motors, kept, np.array(frame.position) / 1000.0) <= 1e-9


def test_limits_and_lengths_are_those_of_the_file(tmp_path: Path) -> None:
    mechanism = described(imported_text(tmp_path / "loop.xml", LOOPS["carriages"].file, tip="tool"), tmp_path)
    assert [j.limits for j in mechanism.joints] == [(-400.0, 100.0), None]
    lengths = {p.name: p.nominal for p in mechanism.parameters if p.name.startswith("rod")}
    assert lengths == pytest.approx({"rod_length_1": np.hypot(200, 250), "rod_length_2": np.hypot(300, 230)})


SAME: Mapping[str, tuple[tuple[str, str], ...]] = {
    "the bodies in the other order": (
        ('body1="rod1" body2="rod2" anchor="0.05 0.15 0"', 'body1="rod2" body2="rod1" anchor="-0.05 0.15 0"'),
    ),
    "two connects, as for a hinge": (
        ("</equality>", '<connect body1="rod2" body2="rod1" anchor="-0.05 0.15 0.02"/></equality>'),
    ),
    "sites": (
        ('<joint name="p2"/>', '<joint name="p2"/><site name="end" pos="-0.05 0.15 -0.01"/>'),
        ('body1="rod1" body2="rod2" anchor="0.05 0.15 0"', 'site1="end" site2="tool"'),
    ),
    "no actuators": (('<actuator><position joint="m1"/><position joint="m2"/></actuator>', ""),),
}


@pytest.mark.parametrize("name", SAME)
def test_a_loop_is_the_same_in_other_words(name: str, tmp_path: Path) -> None:
    path, text = tmp_path / "loop.xml", FIVE_BAR
    plain = imported_text(path, text, tip="tool").text
    for old, new in SAME[name]:
        assert old in text
        text = text.replace(old, new)
    assert imported_text(path, text, tip="tool").text == plain
    assert "drawn=" in plain


REFUSED: Mapping[str, tuple[str, str, str]] = {
    "a tip beside": (
        '<site name="tool" pos="0.05 0.15 0"/>',
        '<site name="tool" pos="0.05 0.1 0"/>',
        "'tool' is not in",
    ),
    "a tip on an arm": (
        '<body name="rod1"',
        '<site name="knee" pos="0 0.12 0"/><body name="rod1"',
        "'knee' is not in the point",
    ),
    "a hinge aslant": (
        '<joint name="p2"/>',
        '<joint name="p2" axis="0 0.02 1"/>',
        "2 rods meet in space (not all joints are parallel",
    ),
    "a weld": ("<connect ", "<weld ", "a weld holds the orientation, too"),
    "a passive joint on the base": ('<position joint="m2"/>', "", "joint 'm2' is on the base: a rod hangs on"),
    "a motor too many": ('<position joint="m2"/>', '<motor joint="m2"/><motor joint="p2"/>', "'rod2' has 2 motors"),
    "a passive slide": ('<joint name="p2"/>', '<joint name="p2" type="slide"/>', "joint 'p2' slides without a motor"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_other_loops_are_refused_with_what_is_missing(name: str, tmp_path: Path) -> None:
    old, new, sentence = REFUSED[name]
    assert old in FIVE_BAR
    tip = "knee" if "knee" in new else "tool"
    said = refused(tmp_path / "loop.xml", FIVE_BAR.replace(old, new), Options(tip=tip))
    assert re.search(r"passive.*describe it with rods.*no rods that meet in the tip: ", said) and sentence in said


def test_an_axis_of_five_digits_in_a_turned_frame_is_parallel_to_the_others(tmp_path: Path) -> None:
    old = '<body name="arm2" pos="0.05 0 0.01"><joint name="m2"/><body name="rod2" pos="0 0.12 0">'
    new = (
        '<body name="arm2" pos="0.05 0 0.01" euler="40 0 0"><joint name="m2" axis="0 0.64279 0.76604"/>'
        '<body name="rod2" pos="0 0.0919253 -0.0771345" euler="-40 0 0">'
    )
    assert old in FIVE_BAR
    found = imported_text(tmp_path / "loop.xml", FIVE_BAR.replace(old, new), tip="tool")
    assert found.bounds.position <= 0.01
    lengths = [p.nominal for p in described(found, tmp_path).parameters]
    plain = [p.nominal for p in described(imported_text(tmp_path / "plain.xml", FIVE_BAR), tmp_path).parameters]
    assert lengths == pytest.approx(plain, abs=0.01)


def test_balls_whose_rods_do_not_meet_are_refused_with_what_is_missing(tmp_path: Path) -> None:
    text = FIVE_BAR.replace('<joint name="p1"/>', '<joint name="p1" type="ball"/>')
    said = refused(tmp_path / "loop.xml", text, Options(tip="tool"))
    assert "'p1' turns freely about a point" in said and "no rods that meet in the tip: 2 rods meet in space" in said
