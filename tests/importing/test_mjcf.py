"""MJCF: forward kinematics of the description is that of MuJoCo, in every way in which a file can say it."""

from collections.abc import Mapping
from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.importing.kinematics import Array, Pose, assert_is, described, imported_text

MODELS = {
    "degrees, quaternions, a site": """
        <mujoco model="arm"><compiler angle="degree"/>
        <default><joint axis="0 0 1" range="-170 170"/><default class="tilt"><joint axis="0 1 0"/></default></default>
        <worldbody><body name="base" pos="0.1 0 0.2" quat="0.7071068 0 0 0.7071068">
          <body name="l1" pos="0 0 0.3"><joint name="j1"/><geom size="0.1" mass="1"/>
          <body name="l2" pos="0.05 0 0.1"><joint name="j2" class="tilt" range="-90 90"/><geom size="0.1" mass="1"/>
          <body name="l3" pos="0 0 0.4" childclass="tilt"><joint name="j3" ref="15"/><geom size="0.1" mass="1"/>
          <body name="l4" pos="0.4 0 0.03"><joint name="j4" axis="-1 0 0"/><geom size="0.1" mass="1"/>
          <body name="l5"><joint name="j5"/><geom size="0.1" mass="1"/>
          <body name="l6" pos="0.08 0 0"><joint name="j6" axis="1 0 0"/><geom size="0.1" mass="1"/>
          <site name="tool" pos="0.02 0 0" zaxis="1 0 0"/></body></body></body></body></body></body></body>
        </worldbody></mujoco>""",
    "radians, Euler angles, joints beside their bodies, two joints in one body": """
        <mujoco model="gantry"><compiler angle="radian" eulerseq="XYZ" autolimits="false"/><worldbody>
        <body name="a" euler="0.3 -0.2 1.1"><joint name="x" type="slide" axis="1 0 0" range="-1 1" limited="true"/>
          <joint name="y" type="slide" axis="0 2 0" ref="0.05"/><geom size="0.1" mass="1"/>
          <body name="b" pos="0.1 0.2 0.3" axisangle="0 1 1 0.4">
            <joint name="z" type="slide" axis="0 0 -1"/><geom size="0.1" mass="1"/>
            <body name="c" xyaxes="0 1 0 -1 0 0.2"><joint name="w" pos="0.05 0.01 0" axis="0 0 1" ref="0.2"/>
              <joint name="v" pos="0 0.01 0" axis="0 1 0"/><joint name="u" pos="0 0 -0.1" axis="1 0 1" ref="-0.1"/>
              <geom size="0.1" mass="1"/><site name="tool" pos="0 0.1 -0.3" euler="0 0.7 0"/></body></body></body>
        </worldbody></mujoco>""",
    "a joint that follows another, the other way round and shifted": """
        <mujoco model="level"><compiler angle="degree"/><worldbody>
        <body name="a"><joint name="turn"/><geom size="0.1" mass="1"/>
        <body name="b" pos="0.1 0 0.2"><joint name="lift" axis="0 1 0" ref="10"/><geom size="0.1" mass="1"/>
        <body name="c" pos="0 0 0.5"><joint name="keep" axis="0 1 0" ref="-5"/><geom size="0.1" mass="1"/>
        <body name="d" pos="0.4 0 0"><joint name="down" type="slide" axis="0 0 1"/><geom size="0.1" mass="1"/>
        <site name="tool" pos="0 0 -0.1"/></body></body></body></body></worldbody>
        <equality><joint joint1="keep" joint2="lift" polycoef="0.2 -1 0 0 0"/></equality></mujoco>""",
}


def by_mujoco(path: Path, base: str, tip: str) -> Pose:
    """The file by MuJoCo; a joint that follows another is set as its equality says."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)

    def frame(name: str) -> Array:
        pose = np.eye(4)
        if name != "world":
            is_site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name) >= 0
            found = data.site(name) if is_site else data.body(name)
            pose[:3, :3] = found.xmat.reshape(3, 3)
            pose[:3, 3] = found.xpos
        return pose

    def pose(values: Mapping[str, float]) -> Array:
        data.qpos[:] = model.qpos0
        for name, value in values.items():
            data.joint(name).qpos[0] = value
        for k in range(model.neq):
            own, leader = model.eq_obj1id[k], model.eq_obj2id[k]
            a0, a1 = model.eq_data[k][:2]
            first, second = model.jnt_qposadr[own], model.jnt_qposadr[leader]
            data.qpos[first] = model.qpos0[first] + a0 + a1 * (data.qpos[second] - model.qpos0[second])
        mujoco.mj_kinematics(model, data)
        return np.asarray(np.linalg.inv(frame(base)) @ frame(tip))

    return pose


@pytest.mark.parametrize("base", ["world", "base"])
@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("snap", [0.0, 1e-6])
def test_it_is_what_mujoco_says(name: str, base: str, snap: float, tmp_path: Path) -> None:
    path = tmp_path / "robot.xml"
    base = base if 'name="base"' in MODELS[name] else "world"
    found = imported_text(path, MODELS[name], base, "tool", snap=snap)
    assert_is(found, tmp_path, by_mujoco(path, base, "tool"))
    assert (snap == 0.0) <= (found.bounds.position == found.bounds.rotation == 0.0)


def test_limits_come_along_in_degrees(tmp_path: Path) -> None:
    found = imported_text(tmp_path / "robot.xml", MODELS["degrees, quaternions, a site"], "base", "tool")
    joints = described(found, tmp_path).joints
    assert [j.limits for j in joints] == [(-170.0, 170.0), (-90.0, 90.0), *[(-170.0, 170.0)] * 4]
