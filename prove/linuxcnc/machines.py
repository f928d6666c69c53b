"""Seven machines, what each is asked to do in LinuxCNC, and where it has to refuse."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

LETTERS = "XYZABC"
Pose = Mapping[str, float]
"""Values of letters of LinuxCNC: X, Y, Z in millimetres, A, B, C in degrees."""


@dataclass(frozen=True)
class Move:
    """A line of a program."""

    code: str
    """G0, G1, or G2: an arc in the XY plane."""
    to: Pose
    """Where it ends; a letter that is not named stays."""
    centre: tuple[float, float] = (0.0, 0.0)
    """Of an arc, from where it begins: I and J."""


@dataclass(frozen=True)
class Stand:
    """A configuration that a machine is brought into by its joints, and what it does in it."""

    joints: tuple[float, ...]
    """Where it is brought: by homing at first, by jogging afterwards."""
    program: tuple[Move, ...]


@dataclass(frozen=True)
class Machine:
    """A machine, and what it is asked."""

    says: str
    """What the table calls it."""
    mechanism: str
    """Its name in the catalogue of the package."""
    sizes: Mapping[str, float]
    """Its parameters, by their names in the package."""
    letters: str
    """The letters that it moves in."""
    first: Stand
    second: Stand
    """In another configuration, where there is one."""
    unreachable: Pose
    """The end of a line that it has to refuse, from where the second program ends."""
    through: tuple[Pose, Pose] | None = None
    """Two poses that it reaches, on a line that leaves its workspace between them."""
    linear: tuple[int, ...] = ()
    """Which of its joints are lengths."""
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Limits that the module is given."""
    turns: tuple[tuple[str, float], ...] = ()
    """Of a five-axis machine, whose A, B, C are the values of its rotary axes: the turns from the work to the tool,
    each a letter with its factor, or X, Y, Z with degrees that are constant. Else A, B, C are roll, pitch and yaw.
    """
    tool: tuple[str, float] | None = None
    """The parameter that is the length of its tool, and by how much G43.1 makes it longer."""

    @property
    def raised(self) -> float:
        """What LinuxCNC adds to Z for the tool."""
        return 0.0 if self.tool is None else self.tool[1]


def g0(**to: float) -> Move:
    """The fastest line."""
    return Move("G0", _letters(to))


def g1(**to: float) -> Move:
    """A line at the programmed speed."""
    return Move("G1", _letters(to))


def g2(i: float, j: float, **to: float) -> Move:
    """An arc in the XY plane, clockwise, about the point i, j from its beginning."""
    return Move("G2", _letters(to), (i, j))


def _letters(to: Mapping[str, float]) -> Pose:
    return {letter.upper(): value for letter, value in to.items()}


SCARA = Machine(
    says="SCARA",
    mechanism="Kin_Scara4_ZCcoupled_Type1",
    sizes={"link_length_1": 325.0, "link_length_2": 225.0, "pitch_zc": 20.0},
    letters="XYZC",
    linear=(2,),
    first=Stand(
        (30.0, 40.0, -50.0, 60.0),
        (g0(x=400, y=200, z=-60, c=90), g1(x=300, y=300, z=-80, c=160), g2(50, -50, x=400, y=300, c=120)),
    ),
    second=Stand(
        (75.0, -50.0, -45.0, 80.0),
        (g1(x=400, y=200, z=-60, c=90), g2(-100, -50, x=400, y=100), g0(x=200, y=250, z=-40, c=200)),
    ),
    unreachable={"X": 600.0, "Y": 100.0},
    through=({"X": 200.0, "Y": 150.0}, {"X": -200.0, "Y": -150.0}),
)
DELTA = Machine(
    says="rotary delta",
    mechanism="Kin_Delta_P3C_Type3",
    sizes={
        **{f"azimuth_{i}": 120.0 * (i - 1) for i in (1, 2, 3)},
        **{
            f"{name}_{i}": value
            for name, value in {"base_radius": 200, "inner_arm": 140, "outer_arm": 400, "tcp_radius": 45}.items()
            for i in (1, 2, 3)
        },
    },
    letters="XYZ",
    first=Stand(
        (20.0, 20.0, 20.0), (g0(x=80, y=60, z=-330), g1(x=-90, y=50, z=-380), g2(60, -50, x=30, y=-50, z=-350))
    ),
    second=Stand(
        (150.0, 30.0, 30.0), (g1(x=-190, y=30, z=-390), g2(-20, -20, x=-190, y=-10, z=-380), g0(x=-210, y=15, z=-370))
    ),
    unreachable={"X": 0.0, "Y": 0.0, "Z": -700.0},
    through=({"X": 108.0, "Y": -99.0, "Z": -274.0}, {"X": -158.0, "Y": 285.0, "Z": -229.0}),
)
FIVE_BAR = Machine(
    says="five-bar",
    mechanism="Kin_P2C_Type1",
    sizes={"inner_arm": 250.0, "outer_arm": 500.0, "displacement": 120.0, "tcp_displacement": 40.0},
    letters="XY",
    first=Stand((40.0, 40.0), (g0(x=120, y=-560), g1(x=-130, y=-500), g2(70, -60, x=0, y=-630))),
    second=Stand((40.0, 150.0), (g1(x=60, y=-600), g2(-30, 40, x=-10, y=-590), g0(x=0, y=-580))),
    unreachable={"X": 500.0, "Y": -600.0},
    through=({"X": 70.0, "Y": -380.0}, {"X": -400.0, "Y": -110.0}),  # its arms would be aligned on the way
)
SIX_AXES = Machine(
    says="six-axis arm",
    mechanism="Kin_ArticulatedRobot_6DOF",
    sizes={"d1": 350.0, "a1": 80.0, "a2": 310.0, "d3": 50.0, "a3": 30.0, "d4": 290.0, "d6": 75.0},
    letters="XYZABC",
    first=Stand(
        (10.0, -110.0, 120.0, 20.0, 60.0, 30.0),
        (
            g0(x=620, y=120, z=300, a=-140, b=-20, c=-30),
            g1(x=500, y=260, z=380, a=-150, b=-35, c=10),
            g2(30, -40, x=570, y=250, z=350, a=-130, b=-20, c=-20),
        ),
    ),
    second=Stand(
        (10.0, -75.0, 48.0, -140.0, -60.0, 180.0),
        (
            g1(x=600, y=150, z=280, a=-145, b=0, c=-5),
            g2(-40, -30, x=590, y=80, z=300, b=-8),
            g0(x=620, y=-60, z=330, a=-150, b=5, c=-30),
        ),
    ),
    unreachable={"X": 900.0, "Y": 200.0},
)
TRUNNION = Machine(
    says="trunnion, five axes",
    mechanism="Softkin_TableTable_AC",
    sizes={"pivot_y": 40.0, "pivot_z": -60.0, "tool_length": 120.0},
    letters="XYZAC",
    linear=(0, 1, 2),
    limits={"A": (-100.0, 100.0)},
    turns=(("C", -1.0), ("A", -1.0)),
    first=Stand(
        (0.0, 0.0, 80.0, 30.0, 40.0),
        (
            g0(x=20, y=10, z=20, a=20, c=10),
            g1(x=-30, y=25, z=5, a=60, c=80),
            g2(30, -25, x=30, y=25, z=15, a=45, c=150),
        ),
    ),
    second=Stand(
        (10.0, 20.0, 90.0, -40.0, 60.0),
        (g1(x=15, y=-10, z=10, a=-20, c=90), g2(-15, 10, x=-15, y=10, a=-50), g0(x=0, y=5, z=30, a=-70, c=-20)),
    ),
    unreachable={"A": -130.0},
)
TRUNNION_B = Machine(
    says="trunnion with B and C",
    mechanism="Softkin_TableTable_BC",
    sizes={"pivot_x": 35.0, "pivot_z": -55.0, "tool_length": 110.0},
    letters="XYZBC",
    linear=(0, 1, 2),
    limits={"B": (-100.0, 100.0)},
    turns=(("C", -1.0), ("B", -1.0)),
    first=Stand(
        (0.0, 0.0, 80.0, 30.0, 40.0),
        (
            g0(x=20, y=10, z=20, b=20, c=10),
            g1(x=-30, y=25, z=5, b=60, c=80),
            g2(30, -25, x=30, y=25, z=15, b=45, c=150),
        ),
    ),
    second=Stand(
        (10.0, 20.0, 90.0, -40.0, 60.0),
        (g1(x=15, y=-10, z=10, b=-20, c=90), g2(-15, 10, x=-15, y=10, b=-50), g0(x=0, y=5, z=30, b=-70, c=-20)),
    ),
    unreachable={"B": -130.0},
)
NUTATING = Machine(
    says="nutating head, five axes",
    mechanism="Softkin_NutatingHead_CB",
    sizes={"fork_offset": 30.0, "head_offset": 15.0, "pivot_length": 150.0, "nutation": 45.0},
    letters="XYZCB",
    linear=(0, 1, 2),
    turns=(("C", 1.0), ("X", 45.0), ("B", 1.0), ("X", -45.0)),
    tool=("pivot_length", 60.0),
    first=Stand(
        (100.0, 50.0, 300.0, 30.0, 40.0),
        (
            g1(x=140, b=80, c=60),
            g1(x=160, y=90, b=60, c=-20),
            g2(40, -30, x=200, y=110, b=95, c=40),
            g0(z=40, b=30, c=10),
        ),
    ),
    second=Stand(
        (120.0, 60.0, 310.0, 20.0, -60.0),
        (
            g1(x=140, b=-80, c=-20),
            g1(x=150, y=90, z=60, b=-55),
            g2(-20, 15, x=130, y=130, c=30),
            g0(x=130, y=70, z=80, b=-70),
        ),
    ),
    unreachable={"B": -130.0},
    limits={"B": (-100.0, 100.0)},
)
HEXAPOD = Machine(
    says="hexapod",
    mechanism="Kin_Hexapod",
    sizes={
        **{
            f"{side}_{number}_{letter}": value
            for side, points in (
                ("base", ((338, -91), (338, 91), (-90, 338), (-248, 247), (-248, -247), (-90, -338))),
                ("platform", ((142, -141), (142, 141), (52, 193), (-193, 52), (-193, -52), (52, -193))),
            )
            for number, point in enumerate(points, 1)
            for letter, value in zip("xy", point, strict=True)
        },
        "home_z": 600.0,
    },
    letters="XYZABC",
    linear=(0, 1, 2, 3, 4, 5),
    limits={f"L{number}": (450.0, 850.0) for number in range(1, 7)},
    first=Stand(
        (630.0, 640.0, 635.0, 625.0, 632.0, 638.0),
        (
            g0(x=40, y=-30, z=620, a=5, b=-4, c=3),
            g1(x=-50, y=40, z=580, a=-8, b=6, c=-5),
            g2(40, -30, x=20, y=50, z=600, a=0, b=10, c=8),
        ),
    ),
    second=Stand(
        (650.0, 600.0, 640.0, 660.0, 610.0, 620.0),
        (g1(x=30, y=40, z=560, a=4, b=-6, c=10), g2(-30, -40, x=0, y=-50, c=-6), g0(x=0, y=-20, z=640, a=-3, b=3)),
    ),
    unreachable={"Z": 1000.0},
)
MACHINES = (SCARA, DELTA, FIVE_BAR, SIX_AXES, TRUNNION, TRUNNION_B, NUTATING, HEXAPOD)
