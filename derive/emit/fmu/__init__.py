"""FMUs of FMI 3.0: the output of `c` with an interface for simulators, as one archive a machine.

It may import the folders of `emit` but `page`, `softmotion` and `st`. The functions of the interface are the same for
every machine: `runtime/fmu`.

archive: sources, description and the compiled library of a machine as one file
package: the description of a machine, and the header that names it
variables: the variables of a machine, in the order of their value references
"""
