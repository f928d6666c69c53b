"""The INI and HAL files of a machine that has neither motors nor a screen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from prove.linuxcnc.machines import Machine

PERIOD = 0.001
"""Seconds between two calls of the kinematics."""
FEED = 15_000
"""Millimetres a minute."""
_FOLLOWING = 5.0
"""Degrees or millimetres that a motor may be behind: those here follow at once."""
_WIDE = 10_000.0
_LINEAR = (400.0, 3000.0)
_ANGULAR = (300.0, 3000.0)
"""Velocity and acceleration."""


def ini(machine: Machine, module: str, home: Mapping[str, float]) -> str:
    """The INI file: the joints home where the machine's first program begins, at the pose `home`."""
    sections: dict[str, dict[str, object]] = {
        "EMC": {"VERSION": "1.1", "MACHINE": module},
        "DISPLAY": {"DISPLAY": "./display.py"},
        "TASK": {"TASK": "milltask", "CYCLE_TIME": 0.005},
        "RS274NGC": {"PARAMETER_FILE": "machine.var"},
        "EMCMOT": {"EMCMOT": "motmod", "SERVO_PERIOD": round(PERIOD * 1e9), "COMM_TIMEOUT": 1.0},
        "EMCIO": {"EMCIO": "io", "CYCLE_TIME": 0.1},
        "HAL": {"HALFILE": "machine.hal"},
        "TRAJ": {
            "COORDINATES": machine.letters,
            "LINEAR_UNITS": "mm",
            "ANGULAR_UNITS": "degree",
            "DEFAULT_LINEAR_VELOCITY": _LINEAR[0],
            "MAX_LINEAR_VELOCITY": _LINEAR[0],
            "MAX_LINEAR_ACCELERATION": _LINEAR[1],
            "HOME": " ".join(f"{home.get(letter, 0.0):.12g}" for letter in "XYZABC"),
        },
        "KINS": {"KINEMATICS": module, "JOINTS": len(machine.first.joints)},
    }
    sections |= {f"AXIS_{letter}": _range(_LINEAR if letter in "XYZ" else _ANGULAR) for letter in machine.letters}
    sections |= {f"JOINT_{number}": _joint(machine, number) for number in range(len(machine.first.joints))}
    return "\n".join(
        line
        for section, entries in sections.items()
        for line in (f"[{section}]", *(f"{name} = {value}" for name, value in entries.items()), "")
    )


def _joint(machine: Machine, number: int) -> dict[str, object]:
    """A joint that is where it homes as soon as it is told to."""
    linear, value = number in machine.linear, machine.first.joints[number]
    return {
        "TYPE": "LINEAR" if linear else "ANGULAR",
        "HOME": value,
        "HOME_OFFSET": value,
        "HOME_SEQUENCE": 0,
        "FERROR": _FOLLOWING,
        "MIN_FERROR": _FOLLOWING,
        **_range(_LINEAR if linear else _ANGULAR),
    }


def _range(speed: tuple[float, float]) -> dict[str, object]:
    return {"MIN_LIMIT": -_WIDE, "MAX_LIMIT": _WIDE, "MAX_VELOCITY": speed[0], "MAX_ACCELERATION": speed[1]}


def sampled(machine: Machine) -> list[str]:
    """The pins whose values are recorded every period, in this order; the last two say what moves the machine."""
    joints = range(len(machine.first.joints))
    return [
        *(f"joint.{joint}.coarse-pos-cmd" for joint in joints),
        *(f"joint.{joint}.pos-cmd" for joint in joints),
        *(f"axis.{letter.lower()}.pos-cmd" for letter in machine.letters),
        "motion.coord-mode",
        "motion.teleop-mode",
    ]


def kinds(machine: Machine) -> str:
    """What each of these pins holds: f a number, b yes or no."""
    return "f" * (len(sampled(machine)) - 2) + "bb"


def hal(machine: Machine, sizes: Sequence[str]) -> str:
    """The HAL file: `sizes` are the lines that give the module its parameters; motors follow at once."""
    pins = sampled(machine)
    lines = [
        "loadrt [KINS]KINEMATICS",
        "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS",
        f"loadrt sampler depth=20000 cfg={kinds(machine)}",
        *sizes,
        "addf motion-command-handler servo-thread",
        "addf motion-controller servo-thread",
        "addf sampler.0 servo-thread",
        *(f"net motor-{k} joint.{k}.motor-pos-cmd => joint.{k}.motor-pos-fb" for k in range(len(machine.first.joints))),
        *(f"net {pin.replace('.', '-')} {pin} => sampler.0.pin.{number}" for number, pin in enumerate(pins)),
        *(["net tool-length motion.tooloffset.z => softkin.tool-offset"] if machine.tool else []),
        "net stop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in",
        "setp sampler.0.enable 0",
    ]
    return "\n".join(lines) + "\n"


def program(machine: Machine, second: bool) -> str:
    """The program of a stand, every corner met exactly."""
    stand = machine.second if second else machine.first
    lines = ["G21 G90 G17 G61 G94", f"F{FEED}"]
    for move in stand.program:
        words = [move.code, *(f"{letter}{value:.9g}" for letter, value in move.to.items())]
        words += [f"{letter}{value:.9g}" for letter, value in zip("IJ", move.centre, strict=True) if move.code == "G2"]
        lines.append(" ".join(words))
    return "\n".join([*lines, "M2", ""])
