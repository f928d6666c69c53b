"""The drawing of a mechanism, as data computed from its description. `emit/picture` decides how it looks.

It may import the folders from `ir` to `report`.

belts: a belt that two fixed motors share: its path, and the sense in which a drive turns its motor
chain: the scene of a chain
drawing: the whole drawing: a scene, and two poses for each choice of the configuration
labels: the labels of dimensions
loop: the scene of a closed loop
parts: the drawn parts at any pose: a program, and the meaning of each of its numbers
pins: the pins of a loop that moves a joint of a chain
pose: the pose that is drawn
scene: a drawing as data: bodies, joints, dimensions, frames
"""
