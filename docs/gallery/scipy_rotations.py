"""Rotations of SciPy: a tool swings about a point, by slerp, and the arm follows."""

import numpy as np
import softkin
from scipy.spatial.transform import Rotation, Slerp
from softkin import Frame

arm = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
frame, configuration = arm.forward((10.0, -60.0, 80.0, 40.0, 50.0, 60.0))
start = Rotation.from_quat(frame.quaternion)  # x, y, z, w in both
swing = Slerp([0.0, 1.0], Rotation.concatenate([start, start * Rotation.from_euler("x", 30.0, degrees=True)]))
turns = swing(np.linspace(0.0, 1.0, 5))
for rotation in turns:
    axes = arm.inverse(Frame.from_quaternion(rotation.as_quat(), frame.position), configuration)
    print(" ".join(f"{value:8.3f}" for value in axes))
positions = np.tile(frame.position, (5, 1))
_, statuses = arm.inverse_batch(positions, turns.as_matrix(), configuration)
print("all reached:", bool((statuses == softkin.Status.OK).all()))
