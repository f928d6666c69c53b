"""First steps: a SCARA goes to a frame, and comes back."""

import softkin

robot = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0)
frame, configuration = robot.forward((10.0, 20.0, -5.0, 30.0))
print("position", [round(value, 3) for value in frame.position])
print("configuration", robot.names(configuration))
print("axes", [round(value, 6) for value in robot.inverse(frame, configuration)])
print("too far:", robot.diagnose(((600.0, 0.0, 0.0), frame.rotation)).in_words)
