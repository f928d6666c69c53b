"""Mistakes that a type checker finds: each marked line has one."""

import softkin

softkin.Scara2Z(arm_length_1=300.0)  # mistake
robot = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=200.0, arm_length_3=1.0)  # mistake
robot.inverse_al(((0.0, 0.0, 0.0), robot.orientation((0.0, 0.0, 0.0))))  # mistake
robot.nearest(robot.forward((0.0, 0.0, 0.0))[0], (0.0, 0.0, 0.0), measure="sum")  # mistake
robot.speed = 3.0  # mistake
softkin.Scara5Z()  # mistake
