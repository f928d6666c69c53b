"""A SCARA against its limits: what refuses, what another turn would do, and the nearest answer that is inside."""

import softkin

robot = softkin.Scara4ZCcoupledType1(
    link_length_1=325.0,
    link_length_2=225.0,
    limits={"A1": (-130.0, 130.0), "A2": (-145.0, 145.0), "A3": (-200.0, 0.0), "A4": (-360.0, 360.0)},
)
frame, configuration = robot.forward((120.0, 60.0, -50.0, 340.0))
present = (-100.0, -20.0, -50.0, 0.0)

print("nearest turn:", robot.diagnose(frame, robot.configuration(elbow="left"), present).in_words)
nearest = robot.nearest(frame, present)
print("nearest inside:", [round(value, 3) + 0.0 for value in nearest], robot.names(robot.forward(nearest)[1])["elbow"])
speeds = (1 / 300, 1 / 450, 1 / 1000, 1 / 1500)
fastest = robot.nearest(frame, present, weights=speeds, measure="largest")
seconds = max(abs(a - b) * w for a, b, w in zip(fastest, present, speeds, strict=True))
print("fastest:", [round(value, 3) + 0.0 for value in fastest], f"in {seconds:.3f} s")
line = robot.line(frame, softkin.Frame((0.0, -400.0, 0.0)) @ frame, configuration, (120.0, 60.0, -50.0, 340.0))
print(f"a line stops at {line.stop.place:.3f}: {line.stop.refusal.reason}" if line.stop else "a line is free")
