"""For every refusal that the guide lists, a description that is refused so: a machine of the guide, changed."""

from derive.command.new import description
from tests.command.files import RAIL
from tests.command.guide import MACHINES

SCARA = description("scara.py", "MyScara")
ARM, PALLETIZER, FIVE_BAR, MILL, PLATFORM = (
    MACHINES[name] for name in ("arm_on_track", "palletizer", "five_bar", "trunnion", "planar_3rrr")
)
ELBOW = 'branch("elbow", sin(A2), left=+1, right=-1)'
Change = tuple[str, str]


def changed(text: str, *changes: Change) -> str:
    """The text with parts replaced; each stands in it once."""
    for old, new in changes:
        assert text.count(old) == 1, (old, text.count(old))
        text = text.replace(old, new)
    return text


def arm(old: str, new: str) -> str:
    """The arm with one part replaced."""
    return changed(ARM, (old, new))


def with_parameter(name: str) -> str:
    """The arm, with another name for its first length."""
    return arm('"link_length_1"', repr(name))


WRONG: dict[str, str] = {
    "SyntaxError: …": arm("MECHANISM = Mechanism(", "MECHANISM = Mechanism(("),
    "NameError: name '…' is not defined; define it above this line": arm("Rz(A2)", "Rz(A3)"),
    "…Error: …; did you mean '…'?": arm("Rz(A2)", "Rz(a2)"),
    "… of the chain shifts by …, which is no length": arm("Tx(L1)", "Tx(L1**2)"),
    "ImportError: cannot import name …; joints and lengths are in derive.mechanism": arm("rotary\n", "knee\n"),
    "TypeError: … got an unexpected keyword argument '…'; did you mean '…'?": arm("chain=", "chian="),
    "TypeError: … missing 1 required positional argument: '…'; state what is missing": arm(
        '    task=Task("xy"),\n', ""
    ),
    "defines no MECHANISM; assign the description": arm("MECHANISM =", "ARM ="),
    "the description ends the program; let the file define MECHANISM": ARM + "\nexit()\n",
    "branch '…' needs two names with the signs +1 and -1": arm("right=-1", "right=+1"),
    "… must be a tuple, not a …: a comma makes the tuple": arm("held=(E1,)", "held=(E1)"),
    "… must not be …: as in …": arm('Task("xy")', '"xy"'),
    "… must not hold …: as in …": arm("joints=(E1, A1, A2)", 'joints=("E1", "A1", "A2")'),
    "task: '…' is no Turning": changed(MILL, ("Turning.DIRECTION),", '"direction"),')),
    "TypeError: …; take sin, cos and sqrt from sympy": arm("from sympy", "from math"),
    "TypeError: …; a chain is a product": arm("Tx(L1) * Rz", "Tx(L1) + Rz"),
    "TypeError: length() missing 1 required …; as in length(": arm(", nominal=400.0", ""),
    "TypeError: rod() missing 1 required …; call it as rod(name, base, plate, length)": changed(
        FIVE_BAR, (", TOOL, ROD_1)", ", TOOL)")
    ),
    "NameError: name '…' is not defined; write above it: from derive.frames import …": arm(", Tx", ""),
    "parameter '…': '…' is not a number": arm("nominal=400.0", 'nominal="400"'),
    "…: its text holds …, a line break or a character that is not printed": arm("Axis A1 to axis A2", "A1 to\\nA2"),
    "branch '…': '…' cannot name it, a side or the margin of it: lower-case words": arm('"elbow"', '"my elbow"'),
    "rod '…': its ends have 2 and 3 coordinates": changed(
        FIVE_BAR, ('rod("1", KNEE_1, TOOL, ROD_1)', 'rod("1", KNEE_1, (X, Y, 0), ROD_1)')
    ),
    "… is taken by …: choose another name": arm('"ArmOnTrack"', '"Softkin_Root"'),
    "… declares …, which is a word of IEC 61131-3": arm('"ArmOnTrack"', '"Array"'),
    "'…' cannot name a function block; take letters, digits and single _": arm('"ArmOnTrack"', '"Arm on track"'),
    "'…' cannot name a family": arm('"ArmOnTrack",', '"ArmOnTrack", family="my machines",'),
    "'…' cannot name a joint: a capital letter, then letters and digits": arm('rotary("A1"', 'rotary("a_1"'),
    "'…' cannot name a parameter: letters, digits and _": with_parameter("link length"),
    "joint '…' and parameter '…' differ in case alone: equations would read them as one": changed(
        ARM, ('length("link_length_1"', 'distance("a1"'), ("import Mechanism,", "import distance, Mechanism,")
    ),
    "parameter '…' and parameter '…' differ in case alone: Structured Text reads them as one name": with_parameter(
        "LINK_length_2"
    ),
    "joint '…' is given 2 times; give each thing a name of its own": arm('rotary("A2"', 'rotary("A1"'),
    "parameter '…': its nominal value … is outside its range …": arm("nominal=400.0", "nominal=0.0"),
    "joint '…': its limit_range … is empty; state the lower end first": arm(
        '"Link 1 about Z, from +X"', '"Link 1", limit_range=(90.0, -90.0)'
    ),
    "joint '…': its … is …, and not two numbers: as in": arm('"Link 1 about Z, from +X"', '"Link 1", limits=90.0'),
    "joint '…' carries a pitch: it needs a limit_range": arm('"Link 2 about Z, from link 1"', '"2", pitch=L1'),
    "coupling of joint '…' reads '…', which is not the motor of an earlier joint": arm(
        '"Link 2 about Z, from link 1"', '"2", coupling=rotary("A3", "later").motor'
    ),
    "chain reads '…', which is not a joint or a parameter of this mechanism; list it": arm(
        "parameters=(L1, L2)", "parameters=(L1,)"
    ),
    "joint '…' occurs nowhere in the closure; use it": arm("chain=Tx(E1) * ", "chain="),
    "periods names '…', which is no multi-turn joint of this mechanism; leave out periods=": arm(
        "held=(E1,),", 'held=(E1,), periods=("E1", "A1", "A2"),'
    ),
    "the nominal parameters break the constraint '…'; choose nominal values": changed(
        FIVE_BAR, ("BASE < ARM_1", "BASE > ARM_1")
    ),
    "one joint too many: the task commands …": arm("    held=(E1,),\n", ""),
    "the task commands …, and there are only … joints; command less of the pose, or add joints": changed(
        SCARA, ("Turning.ABOUT_Z),", "Turning.FULL),")
    ),
    "held names '…', which is no joint of this mechanism": arm("joints=(E1, A1", "joints=(A1"),
    "held joints need a chain: of a closed loop every joint follows from the pose": changed(
        FIVE_BAR, ("joints=(A1, A2),", "joints=(A1, A2), held=(A1,),")
    ),
    "surplus joint '…' must be the length of one rod without cones, and occur nowhere else": changed(
        FIVE_BAR, ("joints=(A1, A2),", "joints=(A1, A2), surplus=(A1,),")
    ),
    "load= is for rods that only pull: state them by cable(...)": changed(
        FIVE_BAR, ("joints=(A1, A2),", "joints=(A1, A2), load=(0, -1),")
    ),
    "the closure has … equations, and the task commands only …": changed(
        FIVE_BAR, ('rod("2", KNEE_2, TOOL, ROD_2)', 'rod("2", KNEE_2, TOOL, ROD_2), rod("3", KNEE_2, TOOL, ROD_1)')
    ),
    "the mechanism needs either a chain or closure equations; state chain=": changed(
        RAIL, ("chain=Tx(A1) * Ty(A2), ", "")
    ),
    "the task commands '…': it must be coordinates in the order x, y, z, or ''": arm('Task("xy")', 'Task("zx")'),
    "passive='…' must be coordinates that are not commanded, in the order x, y, z": arm(
        'Task("xy")', 'Task("xy", passive="y")'
    ),
    "… is not commanded but the joints move it; command it too": changed(
        SCARA,
        ('Task("xyz", Turning', 'Task("xy", Turning'),
        ("    joints=(A1, A2, A3, A4),", "    joints=(A1, A2, A4),"),
        ("Tz(HEIGHT + A3)", "Tz(L2 * sin(A2))"),
    ),
    "the chain must turn the flange about z alone: …": changed(
        SCARA, ("import Rz,", "import Rx, Rz,"), ("* Rz(A4),", "* Rx(A4),")
    ),
    "the closure does not determine …": changed(RAIL, ("Ty(A2)", "Tx(A2)")),
    "no subproblem determines …": changed(
        SCARA,
        ("import Rz,", "import Rx, Ry, Rz, Ty,"),
        ("MECHANISM =", 'A5 = linear("A5", "quill")\nMECHANISM ='),
        ("Rz(A1) * ", "Tx(A3) * Rz(A1) * Ty(50) * "),
        ("Rz(A2) * ", "Ry(A2) * "),
        ("Tz(HEIGHT + A3) * Rz(A4),", "Rx(A4) * Ty(80) * Tz(HEIGHT + A5) * Tx(30) * Ry(1),"),
        ("joints=(A1, A2, A3, A4)", "joints=(A3, A1, A2, A4, A5)"),
        (", Turning.ABOUT_Z),", ", Turning.PITCH_ROLL),"),
        ('branches=(branch("elbow", sin(A2), right=+1, left=-1),),', ""),
    ),
    "with offset_interface=False it could be built, but for a point off the flange …": changed(
        MILL, ("    task=", "    offset_interface=True,\n    task=")
    ),
    "branch '…': its indicator agrees with 0 steps, not one: …softkin explain…": arm("sin(A2)", "sin(A1)"),
    "branches '…' and '…' name the same two solutions; leave one of them out": changed(
        ARM, (f"branches=({ELBOW},)", f'branches=({ELBOW}, branch("bend", -sin(A2), inward=+1, outward=-1))')
    ),
    "assembly '…': the loop can be assembled in one way alone: leave it out": changed(
        FIVE_BAR,
        ('rod("1", KNEE_1, TOOL, ROD_1), rod("2", KNEE_2, TOOL, ROD_2)', ""),
        ("rods=(),", "closure=(X - ARM_1 * cos(A1), Y - ARM_2 * sin(A2)),"),
    ),
    "assembly '…': its indicator does not tell the two solutions apart": changed(
        FIVE_BAR, ("cross(BAR_1, BAR_2), margin", "cross(REACH_1, REACH_2), margin")
    ),
    "… must be positive, and is at most …: check the nominal values of parameters": arm(
        "held=(E1,),", "held=(E1,), positive=(sin(A2) - 2,),"
    ),
    "a loop that turns its platform needs offset_interface=False": changed(
        PLATFORM, ("    task=", "    offset_interface=True,\n    task=")
    ),
    "a loop that turns its platform needs no assembly: its home pose tells the mode": changed(
        PLATFORM,
        ("rotary\n", "rotary, assembly\n"),
        ("home=(0, 0, 0),", 'home=(0, 0, 0), assembly=assembly("p", ROD, margin="m", a=+1, b=-1),'),
    ),
    "a platform that a loop turns needs a rod for each of the … quantities of the task": changed(
        PLATFORM,
        (
            "for k, (knee, end) in enumerate(zip(KNEES, ENDS), 1)),",
            "for k, (knee, end) in enumerate(zip(KNEES[1:], ENDS[1:]), 1)), closure=(KNEES[0][0] * ENDS[0][0],),",
        ),
    ),
    "the task commands '…', and the loop moves … as well: …guides=…": changed(PLATFORM, ('Task("xy"', 'Task("x"')),
    "the platform moves … quantities, and the task commands all…: as many guides without joints must hold the others": (
        changed(
            PLATFORM,
            ("rotary\n", "rotary, guide\n"),
            ("home=(0, 0, 0),", 'home=(0, 0, 0), guides=(guide("1", (0, 1), on_plate(0, 0)),),'),
        )
    ),
    "with nominal dimensions its home pose is not where the legs reach it: at best rod '…' is …": changed(
        PLATFORM, ("home=(0, 0, 0),", "home=(0, 2000, 0),")
    ),
}
"""Refusal of the guide → description. The parts of the guide that a machine, or a folder, says are tested elsewhere."""
