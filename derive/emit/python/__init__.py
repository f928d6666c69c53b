"""The Python package.

It may import these folders of `emit`: `c`, `javascript`, `plcopen`, `picture`. What is the same for every
mechanism stands in `runtime/python/softkin`, where each module says what it holds. On arrays there is only the
program of one branch: all branches at once are a call in which each branch has both signs, along an axis of the array.
On plain numbers the branches are unrolled (`straight_line`).

arrays: a program as a method on arrays: all rows at once, a refusal is a mask
calls: calls of programs that several programs share, and of the root search
entries: the description of a machine in its class: axes, parameters, configuration bytes
layout: the layout, by `ruff format`
mechanism_modules: the modules of one mechanism
methods: the method of each program
package: all files of the package
printer: expressions, on plain numbers and on arrays
program: a program as a method on plain numbers, with early returns; systems of equations and loops
refusal: how a method on plain numbers refuses
runtime: the templates, with the constants that they and the runtime read, and the repair of a rotation
setup: the setup program, which computes the constants of a machine
straight_line: all branches in a straight line
"""
