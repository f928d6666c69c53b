"""A path across a singularity: the wrist of a six-axis arm is nearly straight halfway along a line."""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import softkin  # noqa: E402

arm = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
straight, configuration = arm.forward((0.0, -60.0, 120.0, 0.0, 2.0, 0.0))
start = softkin.Frame((0.0, -150.0, 0.0)) @ straight
goal = softkin.Frame((0.0, 150.0, 0.0)) @ straight
line = arm.line(start, goal, configuration, samples=200, singular=0.05)
print("reaches the end:", bool(line))
for stretch in line.singular:
    print(f"{stretch.margin}: from {stretch.start:.3f} to {stretch.end:.3f}, margin down to {stretch.least:.4f}")
print("highest speed in 2 s, deg/s:", [round(speed) for speed in line.fastest(2.0)])

for number, axis in enumerate(arm.AXES):
    plt.plot(line.places, [speeds[number] for speeds in line.velocities(2.0)], label=axis.name)
plt.xlabel("share of the line")
plt.ylabel("speed [deg/s]")
plt.legend()
plt.savefig(f"{sys.argv[1]}/path_across_a_singularity.png", dpi=70)
