"""From a robot file (URDF, MJCF, a table of Denavit-Hartenberg parameters) to a description to be read and edited.

It may import the folders from `ir` to `mechanisms`.

arms/: the robot as lines in space, and its chain in the simple form
branches: the branches of common arms: shoulder, elbow, wrist
expressions: amounts of a chain as Python text
formats/: the readers of robot files
importing: the whole import: read, undo rounding, bring into the simple form, write, report
meshes: the meshes of a robot file for the viewer: read, joined by bodies, simplified, in one glTF
naming: names of axes, parameters and blocks, made of the names in the file
report: the report of an import for its user
robot: the content of a robot file, as data that are independent of the file format
rods: rods that meet in the tip: where they hang, in the axes, their lengths, their text, and their report
writing: a description as text
"""
