"""A path across a singularity: halfway along a line the wrist of a six-axis arm is straight."""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import softkin  # noqa: E402

arm = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
straight, _ = arm.forward((0.0, -60.0, 120.0, 0.0, 0.0, 0.0))
below, above = (softkin.Frame((0.0, 0.0, z)) @ straight for z in (-50.0, 50.0))
down, up = (arm.configuration(arm="front", elbow="up", hand=hand) for hand in ("down", "up"))

line = arm.line(below, above, down, singular=0.05)
print(f"with the hand down it stops at {line.stop.place:.2f}: {line.stop.refusal.reason}")

first = arm.line(below, straight, down, singular=0.05)
second = arm.line(straight, above, up, first.axes[-1], singular=0.05)
print("changing the hand there reaches the end:", bool(first) and bool(second))
print("A5 in deg:", [round(axes[4], 1) + 0.0 for axes in (first.axes[0], first.axes[-1], second.axes[-1])])
for name, part in (("up to there", first), ("from there", second)):
    print(f"highest speed in 1 s {name}, deg/s:", [round(speed) for speed in part.fastest()])

beside = [softkin.Frame((0.0, 15.0, 0.0)) @ frame for frame in (below, above)]
around = arm.line(*beside, down, samples=200, singular=0.05)
for stretch in around.singular:
    print(f"15 beside: {stretch.margin} from {stretch.start:.3f} to {stretch.end:.3f}, down to {stretch.least:.4f}")
print("highest speed in 2 s, deg/s:", [round(speed) for speed in around.fastest(2.0)])

for number, axis in enumerate(arm.AXES):
    plt.plot(around.places, [speeds[number] for speeds in around.velocities(2.0)], label=axis.name)
plt.xlabel("share of the line beside the singularity")
plt.ylabel("speed [deg/s]")
plt.legend()
plt.savefig(f"{sys.argv[1]}/path_across_a_singularity.png", dpi=70)
