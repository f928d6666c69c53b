"""A machine of the collection, made: derived with every check, its package imported, its block compiled."""

import ast
from dataclasses import dataclass
from functools import cache
from importlib import import_module

import numpy as np
import softkin
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism, Role
from derive.description.validate import validate
from derive.geometry.frames import Motion
from derive.pipeline import Built, derive_and_measure, languages
from tests.catalogue.closure import Closure
from tests.catalogue.loop_machines import LoopClosure
from tests.kept import kept
from tests.machines.angle_machines import MEANT
from tests.machines.carried import CARRIED
from tests.machines.collection import MACHINES
from tests.machines.free_machines import FREED
from tests.machines.parallel_machines import PARALLEL
from tests.machines.subset_machines import SUBSETS
from tests.outside import temporary, written
from tests.text.controller import OK, Controller
from tests.text.units import compiled_text

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Made:
    """One machine: what was derived, and both languages with the same parameters."""

    mechanism: Mechanism
    built: Built
    robot: softkin.Mechanism
    closure: Closure
    reach: float

    @property
    def has_block(self) -> bool:
        """Whether it has a block: one with more than six axes has none."""
        return "st" in self.built.parts

    @property
    def is_searched(self) -> bool:
        """Whether its solutions are found by a search along a joint."""
        return hasattr(self.robot, "SIDES")

    def controller(self) -> Controller:
        """Its block, initialised."""
        text = self.built.parts["st"]["text"]
        controller = Controller(compiled_text(f"{self.mechanism.name}.st", text), self.mechanism)
        assert controller.initialise(self.robot.parameters) == OK
        return controller

    def axes(self, joints: Array) -> Array:
        """Axis values of joints in degrees and reaches; a positive quantity that is a joint is positive."""
        sizes = np.where(self.closure.angles, 1.0, self.reach)
        positive = np.array([j.symbol in self.mechanism.positive for j in self.mechanism.joints])
        scaled = np.where(positive, np.abs(joints), joints) * sizes
        return np.asarray(scaled + self.closure.offsets)

    def error(self, axes: Array, positions: Array, rotations: Array) -> Array:
        """The largest residual of the commanded closure in every row, with lengths in reaches."""
        residual = np.abs(self.closure.equations(self.closure.joints(axes), positions, rotations))
        slides = np.abs(axes - self.closure.offsets)[:, ~self.closure.angles].sum(axis=1)
        residual[:, : len(self.mechanism.task.position)] /= (self.reach + slides)[:, None]
        return np.asarray(residual.max(axis=1))

    def worst(self, slots: Array, statuses: Array, positions: Array, rotations: Array) -> float:
        """The largest error of all answers of a batch, which are in the assembly mode of the machine."""
        rows, columns = np.nonzero(statuses == softkin.Status.OK)
        answers = slots[rows, columns]
        if isinstance(self.closure, LoopClosure):
            assert (self.closure.side(self.closure.joints(answers), positions[rows]) > 0).all()
        return float(self.error(answers, positions[rows], rotations[rows]).max(initial=0.0))


@cache
def made(name: str) -> Made:
    """Derive and load a machine; its offsets are not zero."""
    mechanism = validate({**MACHINES, **CARRIED, **SUBSETS, **FREED, **PARALLEL}[name])
    built = built_of(mechanism)
    robot_class = imported_class(mechanism, built)
    offsets = {j.offset.name: 7.0 * k - 20.0 for k, j in enumerate(mechanism.joints)}
    robot = robot_class(**{p.name: p.nominal for p in mechanism.parameters}, **offsets)
    lengths = [abs(p.nominal) for p in mechanism.parameters if p.role in (Role.LENGTH, Role.DISTANCE)]
    shifts = mechanism.chain.factors if mechanism.chain is not None else ()
    terms = [t for f in shifts if f.motion is Motion.SHIFT for t in f.amount.as_ordered_terms()]
    lengths += [abs(float(t)) for t in terms if t.is_number]
    meant = MEANT.get(name, mechanism)
    reach = sum(lengths) or 500.0
    closure = LoopClosure(mechanism, robot.parameters, reach) if mechanism.rods else Closure(meant, robot.parameters)
    return Made(mechanism, built, robot, closure, reach)


@cache
def built_of(mechanism: Mechanism) -> Built:
    """What `derive_one` makes of a mechanism, with every check but without pictures."""
    return kept("built", mechanism, _derived)


def _derived(mechanism: Mechanism) -> Built:
    whole = derive_and_measure(mechanism)
    parts = {language.name: language.part(whole) for language in languages()}
    written = {name: part for name, part in parts.items() if part is not None}
    return Built("", "", None, written, {}, whole.evidence)


def imported_class(mechanism: Mechanism, built: Built) -> type[softkin.Mechanism]:
    """The class of the generated package, whose modules, not laid out, are read beside those of the catalogue."""
    texts = {path: text for path, text in built.parts["python"]["files"].items() if path.startswith("softkin/")}
    for path, text in texts.items():
        ast.parse(text, path)
    folder = written(texts, temporary("machine"))
    for package in ("softkin", "softkin._array_programs", "softkin._unrolled"):
        paths = import_module(package).__path__
        paths.append(str(folder / package.replace(".", "/")))
    module = import_module(f"softkin.{mechanism.name.removeprefix('Kin_').lower()}")
    return next(v for v in vars(module).values() if getattr(v, "NAME", None) == mechanism.name)
