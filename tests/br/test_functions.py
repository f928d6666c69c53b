"""Every machine that mapp Motion can have, in C: there and back, both derivatives, tools and refusals."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import softkin

from derive.emit.around_c.package import br, commands_all_axes
from derive.emit.c.description import inputs
from derive.emit.c.package import module_name
from tests.corpus.dimensions import DIMENSIONS
from tests.linuxcnc.machine import differs, recorded
from tests.mechanisms import catalogue, kinematics_of, named
from tests.orthonormal import about
from tests.outside import output_of, temporary, written

pytestmark = pytest.mark.broad

NAMES = [m.name for _, m in catalogue() if commands_all_axes(m) and m.name in DIMENSIONS]
GCC = ("gcc", "-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-ffp-contract=off", "-fPIC",
       "-isystem", str(Path(__file__).parent / "stub"))  # fmt: skip
SINGULAR, LENGTH = 0.02, 15
DIRECT, INVERSE, DIRECT_DERIVATIVE, INVERSE_DERIVATIVE = range(4)
_Fifteen, _Three = ctypes.c_double * LENGTH, ctypes.c_double * 3


@cache
def library(name: str) -> ctypes.CDLL:
    """The functions of a machine, compiled without a warning; so is the driver, which is no part of them."""
    part = br.part(kinematics_of(named(name)))
    assert part is not None
    folder = written(br.files([part]), temporary("br"))
    module = module_name(name)
    sources = [folder / file for file in (f"{module}_br.c", f"{module}.c")]
    driver = [f'-DMACHINE_HEADER="{module}_br.h"', f"-DMACHINE={module}", Path(__file__).parent / "driver.c"]
    driver += ["-DWIRE_FRAME"] if "_br_wire_frame" in part["files"][f"{module}_br.h"] else []
    output_of([*GCC, "-I", folder, "-shared", "-o", folder / "br.so", *driver, *sources, *shared(), "-lm"])
    return ctypes.CDLL(str(folder / "br.so"))


@cache
def shared() -> list[Path]:
    """The compiled sources that all machines share."""
    folder = written(br.files([]), temporary("br"))
    output_of([*GCC, "-O2", "-c", "softkin_br.c", "softkin.c"], cwd=folder)
    return [folder / "softkin_br.o", folder / "softkin.o"]


class Machine:
    """A machine with the dimensions of the corpus, and its twin in Python."""

    def __init__(self, name: str, configuration: Sequence[int] = ()) -> None:
        self.mechanism, self.functions = named(name), library(name)
        self.twin = softkin.catalogue()[name](**DIMENSIONS[name])
        kin = kinematics_of(self.mechanism)
        self.values = [float(self.twin.parameters[p.name]) for p in kin.parameters]
        assert list(inputs(kin).names) == [p.name for p in kin.parameters]
        self.choose(configuration)
        self.scale = 1.0 + max(map(abs, DIMENSIONS[name].values()), default=0.0)
        self.angles = {"none": 0, "about z": 1}.get(self.mechanism.task.turning.value, 3)

    def choose(self, configuration: Sequence[int]) -> None:
        count = len(self.values)
        given = (ctypes.c_double * count)(*self.values), (ctypes.c_int8 * len(configuration))(*configuration)
        assert self.functions.prepare(*given, len(configuration)) == count

    def call(self, which: int, *given: Sequence[float], tool: Sequence[float] = (0, 0, 0)) -> tuple[int, list[float]]:
        """The status, negative with an error, and the numbers."""
        filled = [_Fifteen(*[*row, *[0.0] * LENGTH][:LENGTH]) for row in (*given, given[-1])[:3]]
        found = _Fifteen()
        if len(given) == 2 and which >= DIRECT_DERIVATIVE:
            raise TypeError("a derivative needs three")
        status = self.functions.call(which, _Three(*tool), *filled, found)
        return status, list(found)

    def wire_frame(self, axes: Sequence[float], tool: Sequence[float] = (0, 0, 0)) -> tuple[int, Any]:
        """The number of edges, or the status, negative; and both points of each edge."""
        found = (ctypes.c_double * 96)()
        count = self.functions.wire_frame(_Three(*tool), _Fifteen(*axes), found)
        return count, np.array(found).reshape(16, 2, 3)[: max(count, 0)]

    def rotation(self, tcp: Sequence[float], own: Any) -> Any:
        """The rotation that a position of the TCP means."""
        if self.angles == 3:
            return about(2, tcp[5]) @ about(1, tcp[4]) @ about(0, tcp[3])
        down = about(0, 180.0) if own[2][2] < 0.0 else np.eye(3)
        return np.array(own) if self.angles == 0 else about(2, tcp[3]) @ down


@pytest.mark.slow("Ac6_RZ", "ThreeParallel", "Planar")
@pytest.mark.parametrize("name", NAMES)
def test_positions_and_rates(name: str) -> None:
    """Of recorded poses: positions, axes and both derivatives; what Python refuses is refused with its status."""
    machine = Machine(name)
    count = len(machine.mechanism.joints)
    rng = np.random.default_rng(3)
    compared = 0
    for axes in recorded(name):
        status, tcp = machine.call(DIRECT, axes, [0.0] * 6)
        try:
            frame, configuration = machine.twin.forward(axes)
        except softkin.KinematicsError as problem:
            assert status == -int(problem.status)
            continue
        assert status == 0
        commanded = ["xyz".index(letter) for letter in machine.mechanism.task.position]
        assert np.abs(np.subtract(tcp[:3], frame.position)[commanded]).max(initial=0.0) <= 1e-9 * machine.scale
        assert np.allclose(machine.rotation(tcp, frame.rotation), frame.rotation, atol=1e-9)
        assert tcp[3 + machine.angles :] == [0.0] * (LENGTH - 3 - machine.angles)
        margins = machine.twin.singularity(axes).margins.values()
        is_level = machine.angles == 3 and abs(abs(tcp[4]) - 90.0) < 1.0
        if is_level or min((abs(m) for m in margins), default=1.0) < SINGULAR:
            continue
        machine.choose(configuration[: machine.twin.BRANCHES])
        status, found = machine.call(INVERSE, tcp, axes)
        if status:
            with pytest.raises(softkin.KinematicsError):
                machine.twin.inverse(frame, configuration, axes)
            continue
        assert differs(found[:count], axes) < 1e-6
        rates = rng.uniform(-1.0, 1.0, count)
        status, moved = machine.call(DIRECT_DERIVATIVE, axes, rates.tolist(), tcp)
        assert status == 0
        step = 1e-4
        ends = [machine.call(DIRECT, (np.array(axes) + s * rates).tolist(), tcp) for s in (step, -step)]
        if any(status for status, _ in ends):
            continue
        slope = (np.array(ends[0][1]) - np.array(ends[1][1])) / (2.0 * step)
        assert np.allclose(moved, slope, rtol=1e-5, atol=1e-5 * (1.0 + np.abs(slope).max()))
        status, back = machine.call(INVERSE_DERIVATIVE, tcp, moved, axes)
        assert status == 0 and back[:count] == pytest.approx(rates, abs=1e-7 / SINGULAR**2)
        compared += 1
    assert compared >= 3


@pytest.mark.slow("Ac6_RZ", "ThreeParallel", "Planar")
@pytest.mark.parametrize("name", NAMES)
def test_wire_frame(name: str) -> None:
    """At recorded poses at most sixteen edges, which follow each other from the base to the tool."""
    machine, compared = Machine(name), 0
    for axes in recorded(name)[:16]:
        count, edges = machine.wire_frame(axes)
        try:
            frame, _ = machine.twin.forward(axes)
        except softkin.KinematicsError as problem:
            assert count == -int(problem.status)
            continue
        assert 0 < count <= 16
        close = 1e-6 * machine.scale
        assert np.abs(edges - frame.position).max(axis=2).min() < close or count == 16
        if machine.mechanism.chain is not None and not machine.mechanism.drives:
            assert np.abs(edges[1:, 0] - edges[:-1, 1]).max(initial=0.0) < close and np.abs(edges[0, 0]).max() < close
            assert np.abs(edges[-1, 1] - frame.position).max() < close
        compared += 1
    assert compared >= 3


def test_lengths_of_a_wire_frame() -> None:
    """Arms, rods and plates are as long as the machine's, at any pose; a tool moves the ends of the last alone."""
    delta, scara = Machine("Kin_Delta_P3C_Type3"), Machine("Kin_Scara3_Z")
    for axes in ([10.0, 20.0, 15.0], [-5.0, 40.0, 30.0]):
        count, edges = delta.wire_frame(axes)
        lengths = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
        sizes = [DIMENSIONS[delta.mechanism.name][f"{name}_1"] for name in ("inner_arm", "outer_arm", "tcp_radius")]
        assert count == 9 and np.sort(lengths) == pytest.approx(np.sort([*sizes, *sizes, *sizes]))
        longer = delta.wire_frame(axes, (0.0, 0.0, 30.0))[1]
        assert np.argwhere(np.abs(longer - edges).max(axis=2) > 1e-9)[:, 0].tolist() == [6, 7, 8]
    count, edges = scara.wire_frame([10.0, 20.0, 30.0, 5.0])
    sizes = [DIMENSIONS[scara.mechanism.name][f"arm_length_{k}"] for k in (1, 2, 3)]
    assert np.linalg.norm(edges[:3, 1] - edges[:3, 0], axis=1) == pytest.approx(sizes)


@pytest.mark.parametrize("name", ["Kin_Scara3_Z", "Kin_ArticulatedRobot_6DOF", "Kin_Scara4_CCZC_ZCcoupled"])
def test_a_tool_is_carried_by_the_flange(name: str) -> None:
    """Its point is that of the flange and the tool, turned; both ways, with rates of a tool that swings."""
    machine, tool = Machine(name), (10.0, -4.0, 25.0)
    count = len(machine.mechanism.joints)
    axes = [12.0, 33.0, -21.0, 15.0, 40.0, 8.0][:count]
    frame, configuration = machine.twin.forward(axes)
    machine.choose(configuration[: machine.twin.BRANCHES])
    status, tcp = machine.call(DIRECT, axes, [0.0] * 6, tool=tool)
    assert status == 0
    assert tcp[:3] == pytest.approx(np.array(frame.position) + np.array(frame.rotation) @ tool)
    status, found = machine.call(INVERSE, tcp, axes, tool=tool)
    assert status == 0 and found[:count] == pytest.approx(axes, abs=1e-7)
    rates = [1.0, -2.0, 0.5, 3.0, -1.0, 2.0][:count]
    status, moved = machine.call(DIRECT_DERIVATIVE, axes, rates, tcp, tool=tool)
    ends = [
        machine.call(DIRECT, [a + s * r for a, r in zip(axes, rates, strict=True)], tcp, tool=tool)[1]
        for s in (1e-4, -1e-4)
    ]
    assert status == 0 and moved == pytest.approx((np.array(ends[0]) - np.array(ends[1])) / 2e-4, abs=1e-4)
    status, back = machine.call(INVERSE_DERIVATIVE, tcp, moved, axes, tool=tool)
    assert status == 0 and back[:count] == pytest.approx(rates, abs=1e-7)


def test_a_tool_without_a_commanded_turn() -> None:
    """A delta carries any tool as it is; a SCARA whose flange turns with its arms only one along its axis."""
    delta, scara = Machine("Kin_Delta_P3C_Type3"), Machine("Kin_Scara2_Z")
    status, tcp = delta.call(DIRECT, [10.0, 20.0, 15.0], [0.0] * 3, tool=(5.0, 6.0, 7.0))
    plain = delta.call(DIRECT, [10.0, 20.0, 15.0], [0.0] * 3)[1]
    assert status == 0 and np.array(tcp[:3]) - plain[:3] == pytest.approx([5.0, 6.0, 7.0])
    status, found = delta.call(INVERSE, tcp, [10.0, 20.0, 15.0], tool=(5.0, 6.0, 7.0))
    assert status == 0 and found[:3] == pytest.approx([10.0, 20.0, 15.0])
    axes = [10.0, 40.0, 5.0]
    assert scara.call(DIRECT, axes, [0.0] * 3, tool=(0.0, 0.0, 9.0))[1][2] == pytest.approx(14.0)
    assert scara.call(DIRECT, axes, [0.0] * 3, tool=(1.0, 0.0, 9.0))[0] == -100
    tcp = scara.call(DIRECT, axes, [0.0] * 3)[1]
    assert scara.call(INVERSE, tcp, axes, tool=(1.0, 0.0, 0.0))[0] == -100


def test_refusals_have_codes() -> None:
    """No dimensions that are allowed, no numbers, out of reach; what was written stays."""
    machine = Machine("Kin_Scara3_Z")
    assert machine.call(INVERSE, [5000.0, 0.0, 0.0, 0.0], [0.0] * 4) == (-3, [0.0] * LENGTH)
    assert machine.call(DIRECT, [float("nan")] * 4, [0.0] * 4)[0] == -2
    assert machine.call(INVERSE, [400.0, 0.0, 0.0, float("inf")], [0.0] * 4)[0] == -2
    machine.values[0] = -1.0
    machine.choose(())
    assert machine.call(DIRECT, [0.0] * 4, [0.0] * 4)[0] == -1


def test_five_axes_have_no_functions() -> None:
    """What a TCP of two commanded angles would be is not known."""
    assert br.part(kinematics_of(named("Softkin_TableTable_AC"))) is None
    assert {"Kin_Scara3_Z", "Kin_Hexapod", "Kin_Delta_P3C_Type3", "Kin_ArticulatedRobot_6DOF"} <= set(NAMES)
