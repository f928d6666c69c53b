"""What a user calls a parameter, a joint or a branch is never refused because something inside is called so."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from inspect import signature

import numpy as np
import pytest
import softkin
from softkin import Status

from derive.description.amounts import with_symbols
from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.emit.python.entries import OF_CLASS
from derive.emit.softmotion.description import literal
from derive.emit.softmotion.inputs import wanted_name
from derive.kinematics.build import build
from derive.kinematics.parameters import machine_parameters
from derive.pipeline import files_of, languages
from tests.catalogue.closure import Closure
from tests.catalogue.loop_machines import LoopClosure
from tests.harness.blark_grammar import parse_with_blark
from tests.harness.pieces import split
from tests.machines.both import forward_in_both, inverse_in_both
from tests.machines.made import Array, Made, built_of, imported_class
from tests.machines.odd_names import ODD, Odd
from tests.mechanisms import kinematics_of, named
from tests.text.controller import OK, Controller, input_value
from tests.text.shapes import names as names_in
from tests.text.test_second_grammar import declaring
from tests.text.units import compiled_text

pytestmark = pytest.mark.slow("coordinates of", "names of", "words of", "constants")

EVERY = pytest.mark.parametrize("name", ODD)
REACH = 700.0


class Named(Controller):
    """A block whose inputs are set by what they stand for, whatever they are called."""

    def __init__(self, odd: Odd, text: str) -> None:
        mechanism = odd.mechanism()
        super().__init__(compiled_text(f"{mechanism.name}.st", text), mechanism)
        self._inputs = odd.text

    def set_inputs(self, given: Mapping[str, float]) -> None:
        for k, p in enumerate(machine_parameters(self.mechanism)):
            is_own = k < len(self.mechanism.parameters)
            called = self._inputs.get(p.name, wanted_name(p)) if is_own else wanted_name(p)
            setattr(self.block, called, input_value(p, given.get(key(p.name, is_own), p.default or 0.0)))


def key(name: str, is_own: bool) -> str:
    """Two inputs may be called the same by the description: that of every machine has a mark."""
    return name if is_own else f"every {name}"


@dataclass(frozen=True)
class Both:
    """A machine with odd names in Python and in Structured Text, and its closure by the description of its twin."""

    made: Made
    controller: Named
    offsets: tuple[float, ...]


@cache
def both(name: str) -> Both:
    odd = ODD[name]
    mechanism, twin = validate(odd.mechanism()), validate(odd.twin())
    built = built_of(mechanism)
    own = {p.name: p.nominal for p in mechanism.parameters}
    offsets = {f"offset_{j.key}": 7.0 * k - 20.0 for k, j in enumerate(mechanism.joints)}
    robot = imported_class(mechanism, built)(**{odd.python.get(n, n): v for n, v in own.items()}, **offsets)
    controller = Named(odd, built.parts["st"]["text"])
    assert controller.initialise({**own, **{key(n, is_own=False): v for n, v in offsets.items()}}) == OK
    of_twin = {p.name: p.nominal for p in twin.parameters}
    of_twin |= {f"offset_{j.key}": v for j, v in zip(twin.joints, offsets.values(), strict=True)}
    of_twin |= {"tcp_above": 0.0}
    closure = LoopClosure(twin, of_twin, REACH) if twin.rods else Closure(twin, of_twin)
    return Both(Made(twin, built, robot, closure, REACH), controller, tuple(offsets.values()))


def poses(machine: Both, count: int = 60) -> Array:
    """Axis values, anywhere."""
    rng = np.random.default_rng(12)
    angles = machine.made.closure.angles
    return machine.made.axes(rng.uniform(-1.0, 1.0, (count, len(angles))) * np.where(angles, 170.0, 0.5))


@EVERY
def test_every_input_is_called_as_a_user_expects(name: str) -> None:
    """Its own name wherever the language permits; else one with a word behind it, which header and command tell."""
    odd, machine = ODD[name], both(name)
    keywords = signature(type(machine.made.robot).__init__).parameters
    expected = [odd.python.get(p.name, p.name) for p in odd.mechanism().parameters]
    assert list(keywords)[1 : 1 + len(expected)] == expected
    assert [p.name for p in type(machine.made.robot).PARAMETERS][: len(expected)] == expected
    notes = machine.made.built.notes()
    assert len(notes) == len(odd.python) + len([n for n in odd.text if n in odd.names.values()])
    python, block = (" ".join(text.split()) for text in (_module(machine), machine.made.built.parts["st"]["text"]))
    for note in notes:
        language, sentence = note.split(": ", 1)
        assert sentence in python if language == "Python" else literal(sentence) in block


def _module(machine: Both) -> str:
    found = files_of([machine.made.built], languages())
    name = machine.controller.mechanism.name.removeprefix("Kin_").lower()
    return found[f"python/softkin/{name}.py"].decode()


@EVERY
def test_both_languages_solve_the_closure(name: str) -> None:
    """Of the twin, which knows none of the odd names: both directions, every branch, and both languages alike."""
    machine = both(name)
    made, answered = machine.made, 0
    for axes in poses(machine).tolist():
        there = forward_in_both(machine.controller, made.robot, axes, REACH)
        if there is None:
            continue
        frame, configuration = there
        pose = np.array([frame.position]), np.array([frame.rotation])
        for found in inverse_in_both(machine.controller, made.robot, frame, axes):
            answered += 1
            assert made.error(np.array([found]), *pose).max() <= 1e-9
        if configuration:
            assert np.allclose(made.robot.inverse(frame, configuration, axes), axes, rtol=0.0, atol=1e-6)
    assert answered > 60


@EVERY
def test_batches_answer_the_same(name: str) -> None:
    machine = both(name)
    robot, axes = machine.made.robot, poses(machine, 20)
    positions, rotations, configurations, statuses = robot.forward_batch(axes)
    rows = statuses == Status.OK
    back, again = robot.inverse_batch(positions[rows], rotations[rows], configurations[rows], axes[rows])
    assert rows.sum() > 5 and (again == Status.OK).all()
    assert np.abs(back - axes[rows]).max() <= 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("name", ["Kin_P2X_Type1", "Kin_Scara4_ZCcoupled_Type1", "Softkin_DualScara"])
def test_parameters_with_the_names_of_what_their_own_derivation_finds(name: str) -> None:
    """The worst that can be asked for: the parameters of a mechanism are called like values of its own programs."""
    mechanism = named(name)
    usual = kinematics_of(mechanism)
    joints = {j.symbol.name for j in mechanism.joints}
    derived = sorted({s.name for p in (usual.setup, *usual.programs) for s in p.bound()} - joints)
    rng = np.random.default_rng(3)
    for _ in range(2):
        names = rng.choice(derived, len(mechanism.parameters), replace=False).tolist()
        odd = build(validate(called_otherwise(mechanism, names)))
        assert [p.given_name for p in odd.parameters[: len(names)]] == names
        for one, other in zip(odd.programs, usual.programs, strict=True):
            # names order the terms of a sum, and with them what rates have in common
            assert abs(len(one.body) - len(other.body)) <= (2 if one.name == "bias" else 0), one.name


def called_otherwise(mechanism: Mechanism, names: Sequence[str]) -> Mechanism:
    """The mechanism with other names of its parameters."""
    pairs = zip(mechanism.parameters, names, strict=True)
    symbols = {p.symbol: type(p.symbol)(name, **p.symbol.assumptions0) for p, name in pairs}
    renamed: Mechanism = with_symbols(mechanism, symbols)
    return replace(renamed, parameters=tuple(replace(p, given="") for p in renamed.parameters))


@EVERY
def test_the_second_grammar_reads_every_name(name: str) -> None:
    text = both(name).made.built.parts["st"]["text"]
    found: set[str] = set()
    for piece in split(text, name):
        for part in (piece, *piece.members):
            found |= names_in(part.text)
    assert parse_with_blark(declaring(sorted(found, key=str.lower)), "METHOD")


@pytest.mark.parametrize("name", ["Kin_Scara4_ZCcoupled_Type1", "Kin_Hexapod", "Kin_Wrist3"])
def test_every_name_of_a_class_is_taken(name: str) -> None:
    """A parameter called like a method would hide it, or could not be read as an attribute."""
    made = softkin.catalogue()[name]
    own = {p.name for p in made.PARAMETERS}
    assert {n for n in dir(made) if not n.startswith("_")} - own <= OF_CLASS
