"""Output languages: a printer writes expressions, a template arranges text, and neither computes.

It may import the folders from `ir` to `drawing`. No other folder knows a language, except `view`. Its own folders form
layers, each of which may import those before it: first `c`, `javascript`, `plcopen` and `picture`, then `python`, then
`st`, `linuxcnc`, `fmu` and `around_c`, then `softmotion`, then `page`.

What is the same for every mechanism stands in `runtime/`, in a folder for each language: it is copied, and reads the
constants of the compiler from one file that the language writes. `runtime/native` has the extension module that joins
the C of machines with Python.

around_c/: controllers that take C with a file around it
braced: how C and JavaScript spell expressions and statements; indents, blocks, long statements broken into lines
c/: C99
every_branch: all branches of the inverse as one straight line, for Python and C
expression: the walk over an expression that all languages share; the conditions of a refusal
fmu/: FMUs of FMI 3.0, around the output of `c`
inputs: the names of the inputs of a machine in a language
interface: the programs of a machine as functions: summary, arguments and results
javascript/: JavaScript
language: the protocol of an output language, and the constants that runtimes read
linuxcnc/: kinematics modules of LinuxCNC
native: the native core of the Python package: the C of its machines
page/: the derivation of a machine as HTML
picture/: the drawing of a machine as PNG and SVG
plcopen/: objects of a Structured Text project, and PLCopenXML
python/: the Python package
refusals: how a function of C or JavaScript refuses
setup: the setup program of a machine, for Python, C and JavaScript
softmotion/: function blocks for SoftMotion
st/: Structured Text
walk: the walk over the statements of a program, and the statements of C and JavaScript
"""
