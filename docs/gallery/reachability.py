"""A table of reachability: of a hundred directions of the tool, how many an arm reaches at each place."""

import numpy as np
import softkin
from scipy.spatial.transform import Rotation

limits = {"A1": (-170.0, 170.0), "A2": (-190.0, 45.0), "A3": (-120.0, 156.0), "A5": (-120.0, 120.0)}
arm = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0, limits=limits)
rotations = Rotation.random(100, rng=np.random.default_rng(2)).as_matrix()
radii, heights = (200.0, 400.0, 600.0, 800.0, 1000.0), (1200.0, 900.0, 600.0, 300.0, 0.0)
print("height \\ radius", *(f"{radius:6.0f}" for radius in radii))
for height in heights:
    row = []
    for radius in radii:
        positions = np.tile((radius, 0.0, height), (100, 1))
        _, statuses = arm.inverse_all_batch(positions, rotations)
        row.append((statuses == softkin.Status.OK).any(axis=1).sum())
    print(f"{height:15.0f}", *(f"{count:5d}%" for count in row))
