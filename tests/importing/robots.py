"""Robot files: those of `rtb-data`, and some written here from published dimensions, with a rounded pi."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rtbdata

from derive.mechanism import Turning

XACRO = Path(rtbdata.__file__).parent / "xacro"


@dataclass(frozen=True)
class File:
    path: Path
    base: str
    tip: str


COLLECTION: Mapping[str, File] = {
    name: File(XACRO / path, base, tip)
    for name, path, base, tip in (
        ("IRB 140", "abb_irb140_description/urdf/irb140.urdf", "base_link", "tool0"),
        ("IRB 140 QT", "abb_irb140_description/urdf/irb140QT.urdf", "base", "tool0"),
        ("KR 16", "kuka_description/kuka_kr16/urdf/kr16_2.urdf", "base_link", "tool0"),
        ("KR 120", "kuka_description/kuka_kr120/urdf/kr120r2500pro.urdf", "base_link", "tool0"),
        ("KR 210", "kuka_description/kuka_kr210/urdf/kr210l150.urdf", "base_link", "tool0"),
        ("iiwa", "kuka_description/kuka_lbr_iiwa/urdf/lbr_iiwa_14_r820.urdf", "base_link", "tool0"),
        ("Puma 560", "unimation_puma560_description/urdf/puma560_robot.urdf", "link1", "link7"),
        ("AL5D", "lynxmotion_al5d_description/urdf/al5d_robot.urdf", "base", "link4"),
    )
    if name != "AL5D" or "PITCH" in Turning.__members__  # four axes that command a position and a pitch
}


def joint(
    name: str,
    kind: str,
    xyz: str = "0 0 0",
    rpy: str = "0 0 0",
    axis: str = "0 0 1",
    limits: tuple[float, float] | None = (-3.0, 3.0),
    mimic: str = "",
) -> tuple[str, ...]:
    """A joint, as the builder of a file takes it."""
    bounds = f'<limit lower="{limits[0]}" upper="{limits[1]}" effort="1" velocity="1"/>' if limits else ""
    moving = "" if kind == "fixed" else f'<axis xyz="{axis}"/>{bounds}'
    return name, f'type="{kind}"', f'<origin xyz="{xyz}" rpy="{rpy}"/>{moving}{mimic}'


def urdf(name: str, *joints: tuple[str, ...]) -> str:
    """A chain of links link0, link1 ... with these joints between them."""
    links = "".join(f'<link name="link{k}"/>\n' for k in range(len(joints) + 1))
    texts = "".join(
        f'<joint name="{own}" {kind}><parent link="link{k}"/><child link="link{k + 1}"/>{rest}</joint>\n'
        for k, (own, kind, rest) in enumerate(joints)
    )
    return f'<?xml version="1.0"?>\n<robot name="{name}">\n{links}{texts}</robot>\n'


def rounded(digits: int) -> tuple[str, str]:
    """Half of pi, and pi, as a file writes them with so many digits."""
    return f"{np.pi / 2:.{digits - 1}f}", f"{np.pi:.{digits - 1}f}"


def ur5e(digits: int) -> str:
    """Universal Robots UR5e, from the Denavit-Hartenberg parameters that the maker publishes."""
    half, pi = rounded(digits)
    return urdf(
        "ur5e",
        joint("shoulder_pan_joint", "revolute", "0 0 0.1625", f"0 0 {pi}"),
        joint("shoulder_lift_joint", "revolute", rpy=f"{half} 0 0"),
        joint("elbow_joint", "revolute", "-0.425 0 0"),
        joint("wrist_1_joint", "revolute", "-0.3922 0 0.1333"),
        joint("wrist_2_joint", "revolute", "0 -0.0997 0", f"{half} 0 0"),
        joint("wrist_3_joint", "revolute", "0 0.0996 0", f"{half} {pi} {pi}"),
        joint("flange", "fixed", rpy=f"0 -{half} -{half}"),
    )


def fanuc(digits: int) -> str:
    """Fanuc LR Mate 200iD, whose J3 is measured against the ground: J2 is taken back before it."""
    half, pi = rounded(digits)
    return urdf(
        "fanuc_lrmate200id",
        joint("joint_1", "revolute", "0 0 0.330"),
        joint("joint_2", "revolute", "0.050 0 0", axis="0 1 0"),
        joint("joint_2_back", "revolute", "0 0 0.330", axis="0 1 0", mimic='<mimic joint="joint_2" multiplier="-1"/>'),
        joint("joint_3", "revolute", axis="0 -1 0"),
        joint("joint_4", "revolute", "0 0 0.035", axis="-1 0 0"),
        joint("joint_5", "revolute", "0.335 0 0", axis="0 -1 0"),
        joint("joint_6", "revolute", "0.080 0 0", axis="-1 0 0"),
        joint("tool", "fixed", rpy=f"{pi} -{half} 0"),
    )


def staubli(digits: int) -> str:
    """Staubli TX2-60, which stands upright at zero."""
    half, _ = rounded(digits)
    return urdf(
        "staubli_tx2_60",
        joint("joint_1", "revolute", "0 0 0.375"),
        joint("joint_2", "revolute", rpy=f"-{half} 0 0"),
        joint("joint_3", "revolute", "0 -0.290 0.020"),
        joint("joint_4", "revolute", rpy=f"{half} 0 0"),
        joint("joint_5", "revolute", "0 0 0.310", f"-{half} 0 0"),
        joint("joint_6", "revolute", rpy=f"{half} 0 0"),
        joint("flange", "fixed", "0 0 0.070"),
    )


def xarm6(digits: int) -> str:
    """UFACTORY xArm 6: axis 6 is beside the point where axes 4 and 5 meet."""
    half, _ = rounded(digits)
    return urdf(
        "xarm6",
        joint("joint1", "revolute", "0 0 0.267"),
        joint("joint2", "revolute", rpy=f"-{half} 0 0"),
        joint("joint3", "revolute", "0.053 -0.2845 0"),
        joint("joint4", "revolute", "0.0775 0.3425 0", f"-{half} 0 0"),
        joint("joint5", "revolute", rpy=f"{half} 0 0"),
        joint("joint6", "revolute", "0.076 0.097 0", f"-{half} 0 0"),
    )


def written(name: str, digits: int, folder: Path) -> File:
    """One of those that are written here, as a file."""
    path = folder / f"{name.lower()}.urdf"
    path.write_text(text := WRITTEN[name](digits), encoding="utf-8")
    return File(path, "link0", f"link{text.count('<joint')}")


WRITTEN = {"UR5e": ur5e, "Fanuc": fanuc, "Staubli": staubli, "xArm6": xarm6}
