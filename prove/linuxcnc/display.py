#!/usr/bin/python3
"""What LinuxCNC runs as its screen: homes the machine, runs two programs, asks for what cannot be reached, records.

It runs inside the room alone, with the Python of Debian. `plan.json` says what to do; `record.json` and `samples.bin`
say what happened.
"""

from __future__ import annotations

import array
import json
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import hal
import linuxcnc

PATIENCE = 20.0
"""Seconds that one step may take."""
BRING_SPEED = 200.0
"""Of the fastest joint, in its unit a second."""
JOG, JOG_SPEED = 3.0, 15.0
"""Millimetres or degrees, and as many a second."""
TYPE = "motion.switchkins-type"
"""The pin that chooses between the kinematics and identity."""
NEAR = 1e-4
"""Degrees or millimetres: a jog ends as near as that."""


class Sampler:
    """Reads what the sampler of the HAL has recorded, all the time."""

    def __init__(self, kinds: str) -> None:
        self.component = hal.component("proof")
        self.component.ready()
        self.stream = hal.stream(self.component, hal.sampler_base, kinds)
        self.rows, self.values = 0, array.array("d")
        self._runs = True
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        while self._runs:
            while self.stream.readable:
                self.values.extend(float(value) for value in self.stream.read())
                self.rows += 1
            time.sleep(0.005)

    def end(self) -> int:
        """Stop; how many periods were lost."""
        self._runs = False
        self._thread.join()
        return int(self.stream.num_overruns)


class Driver:
    """The machine, as a person at its panel has it."""

    def __init__(self, joints: int) -> None:
        self.joints = joints
        self.state, self.command, self.errors = linuxcnc.stat(), linuxcnc.command(), linuxcnc.error_channel()

    def said(self) -> list[str]:
        """What LinuxCNC has complained about since this was asked."""
        found = []
        while message := self.errors.poll():
            found.append(str(message[1]))
        return found

    def until(self, is_so: Callable[[Any], bool], what: str) -> None:
        """Wait until the status says so."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.state.poll()
            if is_so(self.state):
                return
            time.sleep(0.005)
        raise TimeoutError(f"LinuxCNC did not come to this: {what}; it says {self.said()}")

    def seen(self) -> dict[str, Any]:
        """What the status says now."""
        self.state.poll()
        return {
            "joints": list(self.state.joint_position[: self.joints]),
            "pose": list(self.state.position[:6]),
            "on": self.state.task_state == linuxcnc.STATE_ON,
            "homed": all(self.state.homed[: self.joints]),
            "parameters refused": bool(hal.get_value("softkin.parameters-refused")),
        }

    def mode(self, mode: int) -> None:
        """Choose manual, single lines, or a program."""
        self.command.mode(mode)
        self.command.wait_complete(PATIENCE)
        self.until(lambda state: state.task_mode == mode, "the mode")

    def switch_on(self) -> None:
        """Out of the emergency stop, and on."""
        for state in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
            self.command.state(state)
            self.command.wait_complete(PATIENCE)
        self.until(lambda state: state.task_state == linuxcnc.STATE_ON, "switched on")

    def home(self) -> None:
        """All joints."""
        self.mode(linuxcnc.MODE_MANUAL)
        self.command.home(-1)
        self.until(lambda state: all(state.homed[: self.joints]), "homed")
        self.rest()

    def rest(self) -> None:
        """Wait until nothing moves, and nothing is about to."""
        self.until(
            lambda state: state.inpos and state.queue == 0 and state.interp_state == linuxcnc.INTERP_IDLE, "at rest"
        )
        time.sleep(0.05)

    def run(self, program: str) -> None:
        """A program, to its end."""
        self.mode(linuxcnc.MODE_AUTO)
        self.command.program_open(program)
        self.command.wait_complete(PATIENCE)
        self.command.auto(linuxcnc.AUTO_RUN, 0)
        self.command.wait_complete(PATIENCE)
        self.rest()

    def line(self, text: str) -> None:
        """A single line of a program."""
        self.mode(linuxcnc.MODE_MDI)
        self.command.mdi(text)
        self.command.wait_complete(PATIENCE)
        self.rest()

    def jog(self, letters: list[int]) -> None:
        """Each of these coordinates of the pose, all at once."""
        self.mode(linuxcnc.MODE_MANUAL)
        self.command.teleop_enable(1)
        self.until(lambda state: state.motion_mode == linuxcnc.TRAJ_MODE_TELEOP, "in the world's coordinates")
        before = self.seen()["pose"]
        for letter in letters:
            self.command.jog(linuxcnc.JOG_INCREMENT, False, letter, JOG_SPEED, JOG)
        self.until(
            lambda state: all(abs(state.position[letter] - before[letter] - JOG) < NEAR for letter in letters), "jogged"
        )
        self.rest()

    def bring(self, joints: list[float], slowest: float) -> None:
        """Each joint by itself, all within the same seconds, to these values."""
        self.mode(linuxcnc.MODE_MANUAL)
        self.command.teleop_enable(0)
        self.command.wait_complete(PATIENCE)
        self.until(lambda state: state.motion_mode == linuxcnc.TRAJ_MODE_FREE, "joint by joint")
        now = list(self.state.joint_position[: self.joints])
        seconds = max(abs(to - at) for to, at in zip(joints, now, strict=True)) / slowest
        for joint, (to, at) in enumerate(zip(joints, now, strict=True)):
            if to != at:
                self.command.jog(linuxcnc.JOG_INCREMENT, True, joint, (to - at) / seconds, abs(to - at))
        self.until(
            lambda state: all(abs(is_ - to) < NEAR for is_, to in zip(state.joint_position, joints, strict=False)),
            f"at {joints}",
        )
        self.rest()
        self.command.teleop_enable(1)
        self.command.wait_complete(PATIENCE)


def give(pin: str, value: str) -> None:
    """Give a pin a value, and the kinematics some periods to read it."""
    hal.set_p(pin, value)
    time.sleep(0.05)


class Recorder:
    """Does one thing after the other, and notes what the machine said of itself before and behind each."""

    def __init__(self, driver: Driver, sampler: Sampler) -> None:
        self.driver, self.sampler = driver, sampler
        self.stages: list[dict[str, object]] = []

    def stage(self, name: str, act: Callable[..., None], *given: Any) -> None:
        """Do this, and call it so."""
        first, before = self.sampler.rows, self.driver.seen()
        act(*given)
        time.sleep(0.05)
        self.stages.append(
            {"name": name, "rows": [first, self.sampler.rows], "before": before, "after": self.driver.seen(),
             "said": self.driver.said()}
        )  # fmt: skip

    def move(self, plan: dict[str, Any]) -> None:
        """Home, the two programs with a way between them, and a way by hand."""
        self.driver.switch_on()
        self.stage("home", self.driver.home)
        if plan["tool"]:
            upright, longer = plan["tool"]
            self.driver.bring(upright, BRING_SPEED)
            self.driver.line(longer)
            self.driver.bring(plan["first"], BRING_SPEED)
        hal.set_p("sampler.0.enable", "1")
        self.stage("first", self.driver.run, "first.ngc")
        self.stage("bring", self.driver.bring, plan["second"], BRING_SPEED)
        self.stage("second", self.driver.run, "second.ngc")
        self.stage("jog", self.driver.jog, plan["jog"])

    def refuse(self, plan: dict[str, Any]) -> None:
        """An end that cannot be reached, a parameter that is not allowed."""
        pin, good, wrong = plan["parameter"]
        self.stage("unreachable", self.driver.line, plan["unreachable"])
        self.stage("behind it", self.driver.line, plan["back"])
        give(pin, wrong)
        self.stage("wrong parameter", self.driver.line, plan["on"])
        give(pin, good)
        self.stage("right parameter", self.driver.line, plan["back"])

    def switch(self, plan: dict[str, Any]) -> None:
        """Identity, and the kinematics again."""
        there, home = plan["identity"]
        give(TYPE, "1")
        self.stage("identity", self.driver.line, there)
        self.stage("identity back", self.driver.line, home)
        give(TYPE, "0")
        self.stage("kinematics again", self.driver.line, plan["on"])

    def leave(self, beside: str, beyond: str) -> None:
        """A line that leaves the workspace halfway, and a way back."""
        self.stage("beside", self.driver.line, beside)
        self.stage("through", self.driver.line, beyond)
        self.stage("on again", self.driver.switch_on)
        self.stage("behind that", self.driver.line, beside)


def run_alone(joints: int, program: str) -> dict[str, Any]:
    """Home, and run a program to its end: what the machine then says of itself."""
    component = hal.component("proof")  # without one no pin can be read
    component.ready()
    driver = Driver(joints)
    try:
        driver.switch_on()
        driver.home()
        driver.run(program)
    except TimeoutError as error:
        return {"said": [str(error)]}
    return {"said": driver.said(), **driver.seen()}


def main() -> None:
    """Do the plan."""
    plan = json.loads(Path("plan.json").read_text(encoding="utf-8"))
    if "program" in plan:
        Path("record.json").write_text(json.dumps(run_alone(plan["joints"], plan["program"])), encoding="utf-8")
        return
    sampler = Sampler(plan["kinds"])
    recorder = Recorder(Driver(plan["joints"]), sampler)
    fault = ""
    try:
        recorder.move(plan)
        recorder.refuse(plan)
        recorder.switch(plan)
        if plan["through"]:
            recorder.leave(*plan["through"])
    except TimeoutError as error:
        fault = str(error)
    record = {"stages": recorder.stages, "fault": fault, "lost": sampler.end()}
    Path("samples.bin").write_bytes(sampler.values.tobytes())
    Path("record.json").write_text(json.dumps(record), encoding="utf-8")


if __name__ == "__main__":
    main()
