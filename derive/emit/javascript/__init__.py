"""JavaScript: an ES module a mechanism, written on demand, on the runtime in `runtime/javascript`.

It may import no other folder of `emit`.

description: the description of a machine in its module, as plain data
functions: the function of each program
package: the files of a mechanism, and those of the runtime
printer: expressions
program: a program as a function with early returns; the function that computes the constants of a machine
"""
