"""A machine of Softkin as a kinematics of Klipper: parameters, branches and axes from the configuration file.

The C beside this file is compiled when a printer is loaded, as Klipper compiles its own.
"""

import ctypes
import math
import os
import subprocess
from collections import namedtuple

import chelper
import stepper

Machine = namedtuple("Machine", "module letters axes branches parameters")
_FOLDER = os.path.dirname(os.path.abspath(__file__))
_SPACING = 0.5  # of the points at which a line is tested, at most, mm
_Three = ctypes.c_double * 3


class Kinematics:
    """What Klipper's toolhead calls."""

    def __init__(self, toolhead, config, machine):
        self._machine, self._printer = machine, config.get_printer()
        sections = [config.getsection("stepper_" + name.lower()) for name, _ in machine.axes]
        self._axes = [
            stepper.PrinterStepper(sections[i], units_in_radians=turns) for i, (_, turns) in enumerate(machine.axes)
        ]
        self._units = [math.pi / 180.0 if turns else 1.0 for _, turns in machine.axes]
        home = [section.getfloat("position_home", 0.0) for section in sections]
        self._library = _loaded(machine.module, config)
        self._made = self._new(config, home)
        ffi, _ = chelper.get_ffi()
        # They live as long as the printer: nothing frees them.
        self._solvers = [self._library.softkin_klipper_stepper(self._made, i, u) for i, u in enumerate(self._units)]
        for i, one in enumerate(self._axes):
            one.set_stepper_kinematics(ffi.cast("struct stepper_kinematics *", self._solvers[i]))
        self._plain = {}
        for letter in "xyz":
            if letter not in machine.letters and config.has_section("stepper_" + letter):
                section = config.getsection("stepper_" + letter)
                self._plain[letter] = one = stepper.PrinterStepper(section)
                one.setup_itersolve("cartesian_stepper_alloc", letter.encode())
                self._home["xyz".index(letter)] = section.getfloat("position_home", 0.0)
        for one in self.get_steppers():
            one.set_trapq(toolhead.get_trapq())
        self._lowest = config.getfloatlist("axis_minimum", (-1e4,) * 3, count=3)
        self._highest = config.getfloatlist("axis_maximum", (1e4,) * 3, count=3)
        self._minimum, self._maximum = toolhead.Coord(self._lowest), toolhead.Coord(self._highest)
        self._homed = ""
        self.set_position(self._home, "")

    def _new(self, config, home):
        values = [
            config.getfloat(name) if default is None else config.getfloat(name, default)
            for name, default in self._machine.parameters
        ]
        bytes_of = [
            config.getchoice(name, {words[0]: 1, words[1]: 2}, words[0]) for name, words in self._machine.branches
        ]
        pose, reason = _Three(), ctypes.create_string_buffer(200)
        made = self._library.softkin_klipper_new(
            (ctypes.c_double * len(values))(*values),
            (ctypes.c_int8 * max(1, len(bytes_of)))(*bytes_of),
            (ctypes.c_double * len(home))(*home),
            pose,
            reason,
            200,
        )
        if not made:
            raise config.error(f"{config.get_name()}: {reason.value.decode()}")
        self._home = list(pose)
        return made

    def get_steppers(self):
        return self._axes + list(self._plain.values())

    def calc_position(self, stepper_positions):
        values = [stepper_positions[one.get_name()] / self._units[i] for i, one in enumerate(self._axes)]
        found = _Three(*[math.nan] * 3)
        self._library.softkin_klipper_position(self._made, (ctypes.c_double * len(values))(*values), found)
        for letter, one in self._plain.items():
            found["xyz".index(letter)] = stepper_positions[one.get_name()]
        return list(found)

    def set_position(self, newpos, homing_axes):
        reason = self._reaches(newpos, newpos, 1)
        if reason:
            # Steppers cannot stand there: from here a move would make all their steps at once.
            self._homed = ""
            raise self._printer.command_error(reason)
        for address in self._solvers:
            self._library.softkin_klipper_keep(address)
        for one in self.get_steppers():
            one.set_position(newpos)
        self._homed = "".join(a for a in "xyz" if a in self._homed or a in homing_axes)

    def clear_homing_state(self, clear_axes):
        if clear_axes:
            self._homed = ""

    def home(self, homing_state):
        # Nothing moves: the machine stands at the positions position_home of its axes, whichever letters are asked for.
        # Klipper's events tell others, as G92, which ends there.
        homing_state.set_axes([0, 1, 2])
        self._printer.send_event("homing:home_rails_begin", homing_state, [])
        self._library.softkin_klipper_home(self._made)
        homing_state.set_homed_position(self._home)
        self._homed = "xyz"
        self._printer.send_event("homing:home_rails_end", homing_state, [])

    def check_move(self, move):
        if len(self._homed) < 3:
            raise move.move_error("Must home first")
        for i, letter in enumerate("xyz"):
            if move.axes_d[i] and letter not in self._machine.letters and letter not in self._plain:
                raise move.move_error(f"The machine does not move in {letter.upper()}")
            if not self._lowest[i] <= move.end_pos[i] <= self._highest[i]:
                raise move.move_error()
        reason = self._reaches(move.start_pos, move.end_pos, math.ceil(move.move_d / _SPACING))
        if reason:
            raise move.move_error(reason)

    def _reaches(self, start, end, points):
        reason = ctypes.create_string_buffer(200)
        ends = _Three(*start[:3]), _Three(*end[:3])
        is_reached = self._library.softkin_klipper_reaches(self._made, *ends, points, reason, 200)
        return "" if is_reached else reason.value.decode()

    def get_status(self, eventtime):
        return {"homed_axes": self._homed, "axis_minimum": self._minimum, "axis_maximum": self._maximum}


def _loaded(module, config):
    """The C of the machine, compiled if its sources are newer, or Klipper's headers: their structs may change."""
    library = os.path.join(_FOLDER, f"softkin_{module}.so")
    sources = [os.path.join(_FOLDER, name) for name in ("softkin_klipper.c", "softkin.c", module + ".c")]
    headers = [os.path.join(_FOLDER, name) for name in ("softkin.h", "softkin_constants.h", module + ".h")]
    theirs = os.path.dirname(chelper.__file__)
    headers += [os.path.join(theirs, name) for name in sorted(os.listdir(theirs)) if name.endswith(".h")]
    newest = max(map(os.path.getmtime, sources + headers))
    if not os.path.exists(library) or newest > os.path.getmtime(library):
        command = ["gcc", "-std=gnu99", "-O2", "-fPIC", "-shared", "-ffp-contract=off", "-o", library + ".new"]
        command += ["-I", theirs, "-I", _FOLDER, "-include", module + ".h"]
        command += [f"-DSOFTKIN_MECHANISM={module}_mechanism", *sources, "-lm"]
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            raise config.error(f"gcc does not compile {module}: {done.stderr[:500]}")
        os.rename(library + ".new", library)
    found = ctypes.CDLL(library)
    address, text, number = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int
    for name, result, arguments in (
        ("new", address, [address, address, address, address, text, number]),
        ("stepper", address, [address, number, ctypes.c_double]),
        ("keep", None, [address]),
        ("home", None, [address]),
        ("reaches", ctypes.c_bool, [address, address, address, number, text, number]),
        ("position", ctypes.c_bool, [address, address, address]),
    ):
        function = getattr(found, "softkin_klipper_" + name)
        function.restype, function.argtypes = result, arguments
    return found
