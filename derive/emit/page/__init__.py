"""The page of a machine: its derivation in HTML with MathML, to be read on a screen and on paper.

It may import every other folder of `emit`.

jacobian: the matrices A and B of the closure, the program of the Jacobian, its determinant
lines: programs as lines of a page
mathml: expressions in presentation MathML
names: the names on a page, in the spelling of the function block and of Python
page: the page of a machine, and the index of all pages
pictures: the machine as it is drawn, poses where a margin vanishes, maps of the workspace
steps: the steps of the derivation, and the tree of its branches
tables: axes, parameters, names, margins, measurements, operations
"""
