"""All solutions: the eight postures of a six-axis arm at one frame."""

import softkin

arm = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
frame, _ = arm.forward((10.0, -60.0, 120.0, 40.0, 50.0, 60.0))
for solution in arm.inverse_all(frame):
    names = arm.names(solution.configuration)
    posture = " ".join(f"{names[branch]:>8}" for branch in ("arm", "elbow", "hand"))
    axes = " ".join(f"{value:8.2f}" for value in solution.axes) if solution.axes else solution.status.meaning
    print(posture, axes)
