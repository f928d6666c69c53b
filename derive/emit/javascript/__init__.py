"""JavaScript: an ES module a mechanism, written on demand, on the runtime in `templates/javascript`.

It may import no other folder of `emit`.

description: what a module states about its machine, as plain data
functions: which program becomes which function
layout: indents, comments and long statements
package: the files of a mechanism, and those of the runtime
printer: expressions
program: a program as a function with early returns
refusal: how a function refuses
setup: the function that computes the constants of a machine
"""
