"""C99: a header and a source a mechanism, on the one source that all share in `runtime/c`.

It may import no other folder of `emit`. It writes these files on demand, and the native core of the Python package.

description: the tables of a machine: axes, parameters, configuration, limits, margins
every_branch: all branches as one function
functions: the function of each program, with its arguments and the places of its results
lanes: several poses at a time, for the native core alone
package: the files of a mechanism, and those that all share
printer: expressions
program: a program as a function with early returns; the function that computes the constants of a machine
"""
