"""The Python package.

It may import these folders of `emit`: `c`, `javascript`, `plcopen`, `picture`. What no mechanism changes stands in
`templates/python/softkin`, where each module says what it holds. On arrays the program of one branch is all there is:
all branches at once are a call with both signs of each along an axis of the array. On plain numbers the branches are
unrolled (`straight_line`).

arrays: a program as a method on arrays: all rows at once, a refusal is a mask
calls: calls of programs that several programs share, and of the root scan
control_flow: a choice on arrays: one side for all rows, the other one for the rows on it
entries: what a class states about itself: axes, parameters, configuration bytes
layout: the layout, by `ruff format`
loops: systems of linear equations, and iterations
mechanism_modules: the modules of one mechanism
methods: which program becomes which method
package: all files of the package
printer: expressions, on plain numbers and on arrays
program: a program as a method on plain numbers, with early returns
refusal: how a method on plain numbers refuses
rotation: the repair of the commanded rotation
runtime: the templates, with the constants that they print
setup: the setup program, which computes the constants of a machine
straight_line/: all branches in a straight line
"""
