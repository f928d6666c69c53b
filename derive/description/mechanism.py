"""The vocabulary of a mechanism description: joints, parameters, closure, task, branches.

A description states equations and their meaning, and nothing that was solved by hand. Quantities stand
in SymPy expressions directly: `Rz(A1) * Tx(link)`, `branch("elbow", sin(A2), right=+1, left=-1)`.
Inside expressions angles are in radians; `TURN` is one revolution, for couplings given per revolution.
Joints, dimensions and branches have files of their own; descriptions import everything from here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from enum import Enum

import sympy as sp

from derive.description.branches import Assembly, Branch, assembly, branch, crossing
from derive.description.dimensions import (
    Constraint,
    Parameter,
    Role,
    angle,
    coordinate,
    coupling,
    distance,
    flag,
    gear,
    length,
    optional_length,
    pitch,
    radians,
    sign,
    signed_length,
    transmission,
)
from derive.description.drives import Drive, driven, with_loops
from derive.description.errors import DescriptionError
from derive.description.fields import as_stated, expressions
from derive.description.joints import Interval, Joint, Kind, arc, driving, helical, linear, notes_of, rotary
from derive.description.loops import (
    FREE_TWIST,
    ROTATION,
    Bound,
    Limited,
    Plane,
    Rod,
    X,
    Y,
    Z,
    bound,
    cable,
    guide,
    limited,
    on_plate,
    ring_rod,
    rod,
)
from derive.geometry.frames import Chain
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES

TURN = 2 * sp.pi
COORDINATE_NAMES_OF_A_PLANE = "xy"


__all__ = [
    "COORDINATE_NAMES", "ROTATION", "ROTATION_ENTRIES", "TURN", "Assembly", "Bound", "Branch", "Constraint",
    "DescriptionError", "Drive", "Interval", "Joint", "Kind", "Limited", "Mechanism", "Parameter", "Plane", "Rod",
    "Search", "Role", "Task", "Turning", "Vendor", "X", "Y", "Z", "angle", "arc", "assembly", "bound", "branch",
    "cable", "crossing", "coordinate", "coupling", "distance", "driven", "driving", "flag", "gear", "guide", "helical",
    "length", "limited", "linear", "on_plate", "optional_length", "pitch", "radians", "ring_rod", "rod", "rotary",
    "search", "sign", "signed_length", "transmission",
]  # fmt: skip


class Vendor(Enum):
    """The vendor of the geometry, which decides the name of the function block."""

    SINSEGYE = "Sinsegye SF512x"
    REXROTH = "Bosch Rexroth ctrlX"
    CODESYS = "CODESYS SM3_Transformation"
    TEXTBOOK = "textbook"


@dataclass(frozen=True)
class Search:
    """A joint that is searched for roots where no subproblem determines it."""

    joint: Joint
    where: Parameter | None = None
    """The parameter without which the closure has a closed form; None if it has none for any machine."""
    is_eliminated: bool = False
    """Whether the other joints follow from the searched one by elimination, not step by step."""


class Turning(Enum):
    """The part of the commanded rotation that a mechanism follows."""

    NONE = "none"
    """The rotation is fixed or follows from the position: the commanded one is never read."""
    ABOUT_Z = "about z"
    """A rotation about the z axis of the machine: the commanded one is projected to it, tool direction first."""
    DIRECTION = "direction"
    """The direction of the tool, which is the z axis of the commanded rotation; the rotation about it is passive."""
    PITCH = "pitch"
    """The last turn of a chain alone, about an axis that the joints before it turn as the position says: the tool's
    direction, which is the z axis of the commanded rotation, is projected to the plane in which the last turn moves it.
    """
    PITCH_ROLL = "pitch and roll"
    """The last two turns of a chain: the pitch of the axis of the last one, and the roll about it."""
    FULL = "full"
    """The whole rotation."""


@dataclass(frozen=True)
class Task:
    """The commanded coordinates ("xyz", "xy" or "xz" in a plane, "z" of a lift, "" of what only turns), and the part of
    the rotation.
    """

    position: str
    turning: Turning = Turning.NONE
    passive: str = ""
    """Coordinates of a chain that joints move and nobody commands: inverse kinematics does not read them."""

    def __post_init__(self) -> None:
        if not isinstance(self.turning, Turning):
            raise DescriptionError(f"task: {self.turning!r} is no Turning: as in task=Task('xyz', Turning.ABOUT_Z)")


@dataclass(frozen=True)
class Mechanism:
    """A mechanism: its equations, and what its quantities mean. The derivation reads nothing else."""

    name: str
    joints: tuple[Joint, ...]
    task: Task
    vendor: Vendor | None = None
    """None for a machine of the user's own."""
    family: str = "own"
    """The folder of its block, beside those of other families."""
    source: str = ""
    """Where the geometry is published; empty if it is published nowhere."""
    summary: str = ""
    """One sentence that says what machine this is; if it is empty, the names of the axes take its place."""
    parameters: tuple[Parameter, ...] = ()
    chain: Chain | None = None
    drawn: Chain | None = None
    """The chain of the description, which is drawn; None: `chain` is that."""
    closure: tuple[sp.Expr, ...] = ()
    rods: tuple[Rod, ...] = ()
    """Closure equations that say that a rod is rigid."""
    guides: tuple[Plane, ...] = ()
    """Planes in which points of a platform stay: as many without joints as the loop moves coordinates that the task
    does not command; one with a joint lifts the platform."""
    bars: tuple[Rod, ...] = ()
    """The bars to draw, where the machine's bodies are not the rods: each joins two points at the stated length."""
    belt: str | None = None
    """How the belt that two fixed drives share is drawn: "H" (a beam on two rails), "T" (an arm through a carriage)."""
    assembly: Assembly | None = None
    heading: sp.Expr | None = None
    """The turn of the flange about z, a sum of joints, of a loop whose equations hold the position alone: a joint that
    the plate carries turns the tool. Equations of rods may read it as `ROTATION`."""
    home: tuple[sp.Expr, ...] = ()
    """The start of an iterative forward kinematics: the coordinates that the platform moves, then the heading, or roll,
    pitch and yaw (Rz Ry Rx), in radians."""
    bounds: tuple[Bound, ...] = ()
    branches: tuple[Branch, ...] = ()
    search: Search | None = None
    held: tuple[Joint, ...] = ()
    """The joints that the inverse leaves where the reference has them, of a machine with more joints than its task."""
    surplus: tuple[Joint, ...] = ()
    """The lengths of rods beyond those that hold the point or the platform: they follow from its pose, and forward
    kinematics takes the other rods. Empty: those are chosen that leave the best conditioned ones."""
    load: tuple[sp.Expr, ...] = ()
    """The direction of the force on the tool, as (0, 0, -1), of a machine with cables: numbers, or parameters, which
    are all zero for no load. The inverse refuses poses at which a cable would push."""
    drives: tuple[Drive, ...] = ()
    """The loops that move joints of the chain: `joints` has the actuators, and the chain what they move."""
    positive: tuple[sp.Expr, ...] = ()
    """Quantities that are positive in this machine: their negative mirror solutions are excluded."""
    limited: tuple[Limited, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    periods: tuple[str, ...] | None = None
    """The multi-turn axes in the order of their configuration bytes; None: the order of the axes."""
    aliases: tuple[str, ...] = ()
    title: str | None = None
    """The answer of GetKinematicsName; None: the name of the block."""
    class_name: str | None = None
    offset_interface: bool | None = None
    """Whether positions of a point off the flange can be commanded (orientation mode "Axis"). None: if the machine
    can do it; True: a machine that cannot is refused."""
    notes: tuple[str, ...] = field(default=())
    """Sentences for the user's documentation: definitions of our own, and properties to know."""
    nominal: Mechanism | None = None
    """The machine as it is drawn, of one that has its deviations as inputs: see `form.deviations`."""

    def __post_init__(self) -> None:
        for name, value in as_stated(vars(self)).items():
            object.__setattr__(self, name, value)
        for what in ("positive", "closure", "home", "load"):
            object.__setattr__(self, what, expressions(what, getattr(self, what)))
        object.__setattr__(self, "heading", None if self.heading is None else sp.sympify(self.heading))
        held = {joint.name for joint in self.held}  # a held joint keeps the turn of the reference: it needs no byte
        joints = (replace(j, multi_turn=False) if j.name in held else j for j in self.joints)
        object.__setattr__(self, "joints", with_loops(tuple(joints), self.drives, self.parameters))
        if not self.summary:
            object.__setattr__(self, "summary", _axes_in_words(self.joints))

    @property
    def held_joints(self) -> tuple[Joint, ...]:
        """The joints that stay at the reference, in the order of the axes."""
        return tuple(j for j in self.joints if j.name in {joint.name for joint in self.held})

    @property
    def solved_joints(self) -> tuple[Joint, ...]:
        """The joints that the inverse solves for: as many as the task commands quantities."""
        names = {joint.name for joint in self.held}
        return tuple(j for j in self.joints if j.name not in names)

    @property
    def surplus_joints(self) -> tuple[Joint, ...]:
        """The lengths of surplus rods, in the order of the axes."""
        names = {joint.name for joint in self.surplus}
        return tuple(j for j in self.joints if j.name in names)

    @property
    def surplus_rods(self) -> tuple[Rod, ...]:
        """The rods whose lengths are surplus, in the order of the axes."""
        return tuple(r for j in self.surplus_joints for r in self.rods if j.symbol in r.length.free_symbols)

    @property
    def holding_rods(self) -> tuple[Rod, ...]:
        """The rods that hold the point or the platform: all that are not surplus."""
        surplus = self.surplus_rods
        return tuple(rod for rod in self.rods if rod not in surplus)

    @property
    def cables(self) -> tuple[Rod, ...]:
        """The rods that only pull."""
        return tuple(rod for rod in self.rods if rod.only_pulls)

    @property
    def all_notes(self) -> tuple[str, ...]:
        """The stated notes, after those on held and surplus joints, and on coordinates that are not commanded."""
        held, surplus = ([joint.name for joint in of] for of in (self.held_joints, self.surplus_joints))
        return (*notes_of(held, surplus, self.task.passive), *self.notes)

    @property
    def is_platform(self) -> bool:
        """Whether a closed loop turns its platform, as the commanded rotation says: its forward kinematics iterates."""
        return self.is_turning_loop and self.heading is None

    @property
    def fixed_guides(self) -> tuple[Plane, ...]:
        """The planes that no joint shifts: each fixes a coordinate that the task does not command."""
        joints = {j.symbol for j in self.joints}
        return tuple(g for g in self.guides if not g.turns_along and not g.equation.free_symbols & joints)

    @property
    def motion(self) -> Task:
        """The coordinates in which the platform of a loop moves: those of the task, and those that planes fix."""
        if not self.fixed_guides and FREE_TWIST not in self.guides:
            return self.task
        is_flat = all(len(end) == 2 for end in (*[r.plate for r in self.rods], *[g.plate for g in self.guides]))
        turning = Turning.ABOUT_Z if self.task.turning is Turning.ABOUT_Z else Turning.FULL
        return Task(COORDINATE_NAMES_OF_A_PLANE if is_flat else "".join(COORDINATE_NAMES), turning)

    @property
    def passive(self) -> tuple[str, ...]:
        """The motions of the loop that the task does not command: coordinates, and the twist about the tool."""
        own = tuple(c for c in self.motion.position if c not in self.task.position)
        return (
            (*own, "twist") if self.motion.turning is not self.task.turning and FREE_TWIST not in self.guides else own
        )

    @property
    def is_turning_loop(self) -> bool:
        """Whether the flange of a closed loop turns, by the loop itself or by a joint on the plate."""
        return self.chain is None and self.task.turning is not Turning.NONE

    @property
    def followed_turns(self) -> int:
        """The number of turns at the end of the chain that follow the commanded rotation, where the first turns do not;
        else 0.
        """
        return {Turning.PITCH: 1, Turning.PITCH_ROLL: 2}.get(self.task.turning, 0)

    @property
    def is_orientation(self) -> bool:
        """Whether this is an orientation kinematics: it turns the tool, and commands no position."""
        return self.chain is not None and not self.task.position

    @property
    def is_position(self) -> bool:
        """Whether this is a position kinematics: an orientation kinematics can follow it, and it commands no tool
        direction.
        """
        return bool(self.task.position) and self.task.turning in (Turning.NONE, Turning.ABOUT_Z)

    @property
    def equations(self) -> tuple[sp.Expr, ...]:
        """All stated closure equations."""
        planes = (plane.equation for plane in self.guides)
        return (*self.closure, *planes, *(rod.equation for rod in self.rods))

    @property
    def holding_equations(self) -> tuple[sp.Expr, ...]:
        """The equations that determine the pose at given joints: those of surplus rods are left out."""
        planes = (plane.equation for plane in self.guides)
        return (*self.closure, *planes, *(rod.equation for rod in self.holding_rods))

    @property
    def offers_points(self) -> bool:
        """Whether the inverse for a point off the flange is derived, or tried: not for a chain with a pitch or with
        passive coordinates, not for a loop that turns its platform; for a machine that follows the tool's direction
        only on request.
        """
        if self.offset_interface is None:
            return self.is_position and not self.is_platform and not self.task.passive
        return self.offset_interface and not self.followed_turns and not self.task.passive

    @property
    def block_name(self) -> str:
        """The function block: the vendor's name, but never one that CODESYS itself ships."""
        return self.name.replace("Kin_", "Softkin_", 1) if self.vendor is Vendor.CODESYS else self.name

    @property
    def period_joints(self) -> tuple[Joint, ...]:
        """The multi-turn joints in the order of their configuration bytes."""
        turning = {j.name: j for j in self.joints if j.multi_turn}
        return tuple(turning[n] for n in self.periods) if self.periods is not None else tuple(turning.values())


def _axes_in_words(joints: Sequence[Joint]) -> str:
    if not joints:
        return "A mechanism without axes."
    return f"A machine with {'the axis' if len(joints) == 1 else 'the axes'} {', '.join(j.name for j in joints)}."


def search(joint: Joint, *, where: Parameter) -> Search:
    """Search along a joint for roots where the parameter is not zero; if it is zero, the closure has a closed form."""
    return Search(joint, where)
