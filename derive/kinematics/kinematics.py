"""The bundle that the build gives to the emitters: every program of one mechanism, and the meanings of its names.

Names that programs share:

    link_length_1, offset_a1, ...   parameters and constants: outputs of `setup`, free in all other programs
    axis_a1, ref_a1                 axis value and its reference (degrees or user's length unit)
    turn_a1                         commanded period number, an integer; 0 = none is commanded
    sigma_elbow                     branch sign: +1 is byte 1, -1 is byte 2
    x, y, z, r11 … r33              frame: position, rotation by rows (columns are the axes of the frame). A caller's
                                    rotation has passed `rotation_program` before: no other program checks it
    point_x, point_y, point_z       the point off the flange (the tool offset), in flange coordinates
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Any

from derive.description.mechanism import Branch, Joint, Limited, Mechanism, Parameter
from derive.ir.constants import LARGEST
from derive.ir.program import Program, Status, shared
from derive.ir.symbols import MAX_MISS

if TYPE_CHECKING:  # the witness reads programs alone, and nothing of how they were derived is loaded with it
    from derive.kinematics.solution import Solution


class Freedom(Enum):
    """The orientations a flange can have (SoftMotion's OrientationDOF)."""

    ZERO = "zero"
    ONE = "one"
    THREE = "three"


@dataclass(frozen=True)
class Margin:
    """A dimensionless distance from a singularity, with its exponent in sqrt(det(J^T J))."""

    name: str
    exponent: int
    kind: str
    """"type 1" (serial) or "type 2" (parallel)."""
    length: str | None = None
    """For a machine without a length to divide by: the output that is the distance, in the user's unit. The margin
    itself is then 1, or 0 where the distance leaves an axis free: it has no unit, and is no measure of distance."""

    @property
    def factor(self) -> str:
        """The output that is a factor of sqrt(det(J^T J))."""
        return self.length or self.name


@dataclass(frozen=True)
class Inverted:
    """The measured errors of the inverse and of the Jacobian."""

    round_trip: float
    jacobian: float
    solutions: int
    """Real solutions found by multi-start root finding, agreeing with the slots at every sampled pose."""
    missed: tuple[int, int] | None = None
    """With a root search: the number of solutions that no slot held, and the number of all solutions."""


@dataclass(frozen=True)
class Exact:
    """The check in a finite field, where equations hold exactly or not at all."""

    trials: int
    """Random machines and poses at which they hold; 0 where nothing can be asked."""
    but: str = ""
    """Why not, or what is not asked."""
    what: str = "equations"
    """What holds."""

    @property
    def sentence(self) -> str:
        """What was found."""
        if not self.trials:
            return f"The equations were not checked in a finite field: {self.but}."
        where = f"(checked in a finite field at {self.trials} random machines and poses)"
        return f"The {self.what} hold exactly {where}{f'; {self.but}' if self.but else ''}."


@dataclass(frozen=True)
class Evidence:
    """The measurements of the independent witness, rounded up so that every computer prints the same."""

    poses: int
    closure_residual: float
    inverted: Inverted | None
    """None for a mechanism without joints: there is nothing to invert."""
    exact: Exact


def evidence_of(plain: Mapping[str, Any]) -> Evidence:
    """The evidence of which `asdict` gave this, as JSON has it."""
    found = plain["inverted"]
    inverted = found and Inverted(**{**found, "missed": found["missed"] and tuple(found["missed"])})
    return Evidence(plain["poses"], plain["closure_residual"], inverted, Exact(**plain["exact"]))


@dataclass(frozen=True)
class Kinematics:
    """All programs of one mechanism.

    setup            parameters (all of `parameters`, flags Boolean, signs integers) → every constant that other
                     programs read. Its conditions are what Initialize refuses; all carry NOT_INITIALIZED. Among its
                     outputs per axis: `unlimited_a1` (a flag), `lower_a1`, `upper_a1` (effective limits as
                     GetAxisProperties reports them), and `check_limits` (a flag).
    setup_less_windows   as setup, without `lowest_a1` `highest_a1` `single_a1` `mid_a1` of the axes: drives may hand
                         over limits of their own, so `windows.limits_of_axis` computes these
    forward          axis_* → x y z r11…r33, and `branch_<name>` per branch: the signed margin, positive = byte 1, at
                     most 1e-11 in size = byte 3 (the branches coincide). If it iterates, it and all other programs
                     of axis_* begin at the pose start_x … start_z, start_r11 … start_r33: outputs of `setup`, which
                     a caller may replace
    orientation      axis_* → r11…r33
    branch           x y z r11…r33 (those it reads), sigma_*, turn_*, ref_* → axis_*: one branch, with periods, without
                     limits
    search_given     as branch → the arguments of the root search of that branch; None if there is a closed form
    from_joints      angles and lengths of the joints, turn_*, ref_* → axis_*; None without a root search
    derived_branch   as branch, step by step as it was derived; the optimiser unrolls it
    limits           axis_* → no outputs; its conditions are the axis limits and the limits of coupled quantities
    singularity      axis_* → one output per margin, by name; singular where one is below 1e-3 in size; and the length
                     of a margin that has one
    jacobian         axis_* → j11, j12, … (row, column from 1): rows are `rows`, columns the axes; per radian
    bias             axis_*, speed_* → bias_x … bias_turn_z, one for each of `rows`: the acceleration where the axes
                     keep these speeds (radians or lengths per time), J' q'
    image            no inputs → zero_r11…zero_r33, rot_x rot_y rot_z (base), u_x u_y u_z (flange): R·u = rot
    projection       r11…r33 → the nearest rotation that the flange can take; None if the task has no rotation
    offset_branch    x y z of the point, point_*, sigma_*, turn_*, ref_* → axis_*; None without the offset interface
    offset_configuration   axis_*, point_* → `branch_<name>`; None likewise
    twist            axis_* → j11 … of all six rows, x y z turn x turn y turn z; None where `jacobian` has all six, and
                     where the flange keeps its orientation: then the rows that it lacks are zero
    twist_bias       as bias, of all six rows; None where `twist` is

    For an orientation kinematics, None for any other. The flange under it turns about the axis flange_axis_* in the
    frame of the flange, base_axis_* in that of the machine; both are zero for a flange that turns freely:

    compatible       flange_axis_* → no outputs; its conditions say which offsets a flange that turns allows
    end_point_shift  flange_axis_*, base_axis_*, r11…r33 commanded (those it reads) → x y z from the flange to the end
                     point
    total_image      r11…r33 one orientation of the flange, flange_axis_*, base_axis_* → the image of both together, as
                     in `image`, if the flange keeps its orientation or turns about the same axis: it does where
                     `apart`, the sine of the angle between the two axes, is zero
    """

    mechanism: Mechanism
    solution: Solution = field(repr=False, compare=False)
    """What was solved, for those who explain it."""
    parameters: tuple[Parameter, ...]
    setup: Program
    forward: Program
    orientation: Program
    branch: Program
    derived_branch: Program
    limits: Program
    singularity: Program
    jacobian: Program
    bias: Program
    image: Program
    projection: Program | None
    offset_branch: Program | None
    offset_configuration: Program | None
    rows: tuple[str, ...]
    """The rows of the Jacobian: "x", "y", "z", "turn z"."""
    margins: tuple[Margin, ...]
    freedom: Freedom
    reads_rotation: bool
    setup_less_windows: Program
    search_given: Program | None = None
    from_joints: Program | None = None
    tried_branches: int = 0
    """With a root search: the number of first branches that are signs of the steps of a trial; the others tell roots
    apart."""
    twist: Program | None = None
    twist_bias: Program | None = None
    compatible: Program | None = None
    end_point_shift: Program | None = None
    total_image: Program | None = None
    evidence: Evidence | None = None
    self_test: SelfTest | None = None
    """The cases of the self-test on the controller; None until they are made."""
    undrawn: str = ""
    """The reason why there is no drawing; empty if there is one."""
    has_choices: bool = False
    """Whether a second drawing shows the choices of the configuration."""
    further: Mapping[str, int] = field(default_factory=dict)
    """The inputs that got another name inside because the derivation uses theirs: see `with_inner_names`."""

    @property
    def shared(self) -> tuple[Program, ...]:
        """The programs that several programs call, each before its callers."""
        return shared(self.programs)

    @property
    def programs(self) -> tuple[Program, ...]:
        """All programs except `setup` and the shared ones."""
        found = (
            self.forward, self.orientation, self.branch, self.limits, self.singularity,
            self.jacobian, self.bias,
            self.image, self.projection, self.offset_branch, self.offset_configuration,
        )  # fmt: skip
        return tuple(program for program in found if program is not None)

    @property
    def starts(self) -> bool:
        """Whether forward kinematics iterates from a start that a caller may give."""
        return self.mechanism.is_platform

    @property
    def branches(self) -> tuple[Branch, ...]:
        """The branches, in the order of their bytes: the first bytes of the configuration."""
        return self.mechanism.branches

    @property
    def period_joints(self) -> tuple[Joint, ...]:
        """The multi-turn axes, in the order of their bytes, which follow the branch bytes."""
        return self.mechanism.period_joints

    @property
    def configuration_size(self) -> int:
        """Bytes of the configuration; 0 where the mechanism has none."""
        return len(self.branches) + len(self.period_joints)

    @property
    def chooses_twist(self) -> bool:
        """Whether the mechanism follows a turn of the commanded rotation and projects the rest."""
        return self.projection is not None and self.freedom is not Freedom.THREE

    @property
    def limit_inputs(self) -> frozenset[str]:
        """The inputs that are limits: of axes, and of quantities with limits of their own."""
        keys = (*(j.key for j in self.mechanism.joints), *(q.name for q in self.mechanism.limited))
        return frozenset(f"{end}_{key}" for end in ("lower", "upper") for key in keys)

    @property
    def unlimited_values(self) -> dict[str, float]:
        """The inputs of the machine by which formulas are measured: without limits, so that every pose counts."""
        unlimited = dict.fromkeys(self.limit_inputs, 0.0) | {MAX_MISS: float(LARGEST)}
        return {p.name: unlimited.get(p.name, p.tested) for p in self.parameters}

    @property
    def limited(self) -> tuple[Limited, ...]:
        """Quantities with limits of their own."""
        return self.mechanism.limited

    @property
    def distance_joints(self) -> tuple[Joint, ...]:
        """The axes whose squared differences decide an automatic choice: the rotary ones, or all
        if there is none.
        """
        angles = tuple(j for j in self.mechanism.joints if j.axis_is_angle)
        return angles or self.mechanism.joints


Reals = tuple[float, ...]
Bytes = tuple[int, ...]


class Called(Enum):
    """The method that a case calls."""

    INITIALIZE = 0
    FORWARD = 1
    INVERSE = 2
    SINGULARITY = 3


@dataclass(frozen=True)
class Case:
    """A call with its expected answer: frame and configuration of forward kinematics, the axes of the inverse."""

    called: Called
    machine: int
    status: Status = Status.OK
    axes: Reals = ()
    reference: Reals = ()
    frame: Reals = ()
    """The position, then the rotation by rows."""
    configuration: Bytes = ()
    is_singular: bool = False
    operations: int = 0
    """The largest number of floating operations of the call; a loop counts as often as the reference ran it."""
    budget: int = 0
    """The operations that a cycle of a controller may need for the case: more than those of the call."""


@dataclass(frozen=True)
class SelfTest:
    """Machines by their parameters, and cases in the order in which they run: the first case of a machine initialises
    it.
    """

    machines: tuple[Mapping[str, float], ...]
    cases: tuple[Case, ...]
