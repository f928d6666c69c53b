"""Coupled machines: a gantry carries a wrist, which carries a tool, on a base."""

import softkin
from softkin import Frame

pair = softkin.Coupled(softkin.Gantry3(), softkin.Wrist3(tool_offset_z=75.0))
robot = pair.with_tool(Frame((20.0, 0.0, 110.0))).with_base(Frame.from_euler(90.0, 0.0, 0.0, (500.0, 0.0, 0.0)))
print("axes:", [axis.name for axis in robot.AXES])
frame, configuration = robot.forward((100.0, 200.0, 300.0, 25.0, 35.0, -50.0))
print("tool:", [round(value, 3) for value in frame.position])
print("hand:", robot.names(configuration)["hand"])
for solution in robot.inverse_all(frame):
    print([round(value, 3) + 0.0 for value in solution.axes])
print("the same in radians:", [round(v, 4) for v in robot.in_radians().inverse(frame, configuration)[3:]])
