"""The readers of robot files.

Like `importing`, it may import the folders from `ir` to `mechanisms`.

bodies: the bodies and sites of an MJCF, the way between two of them, their places and orientations
documents: XML, an MJCF with its included files, and the numbers in it; any fault is reported in one sentence
legs: the legs of such a loop: motor, arm, and a rod to the point where all rods meet
loops: closed loops of a file, of an MJCF too: an arm is not imported without one that binds its joints
mjcf: MJCF: the chain between two bodies or sites
tables: tables of Denavit-Hartenberg parameters, in TOML or CSV
transmissions: the transmissions of a URDF, which are reported but do not enter the chain, and joints that follow others
trees: a robot as a tree of links, and the joints on the path between two links
urdf: URDF: the chain between two links
visuals: the shapes of a URDF's links: where each stands at joint values of zero, and how many joints move it
"""
