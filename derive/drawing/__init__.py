"""The drawing of a mechanism, as data computed from its description. `emit/picture` decides how it looks.

It may import the folders from `ir` to `report`.

belts: a belt that two fixed motors share: where it runs, and in which sense a drive turns its motor
chain: the scene of a chain
drawing: the whole drawing: a scene, and two poses for each choice of the configuration
labels: the labels of dimensions
loop: the scene of a closed loop
parts: what is drawn at any pose: a program, and what each of its numbers is
pose: the pose that is drawn
scene: a drawing as data: bodies, joints, dimensions, frames
"""
