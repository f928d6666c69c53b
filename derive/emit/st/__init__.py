"""Structured Text: expressions, statements, refusals, names, and the contract of SoftMotion.

It may import the folders of `emit` but `page`, `softmotion` and `linuxcnc`.

`templates/st/softmotion.toml` is the contract as data: type names, signatures, error names, profiles of libraries. A
name that no document gives stands nowhere else, with a comment that says so. Its enumerators become constants of one
list, `Softkin_Names`, and blocks use those. `templates/st/reserved.toml` holds the names that may not be declared. A
flag is a BOOL; a sign, the number of a turn and a count are an INT; a sign becomes a number once, where it multiplies.

contract: the contract of SoftMotion, read from its file
expression: expressions
layout: indents, and breaks in long statements
names: names as Structured Text writes them, no two of which differ in case alone
program: a program as statements
refusal: how a method refuses
refused_inputs: how the inputs of a block are refused, each with a text
reserved: names that may not be declared
rotation: the repair of the commanded rotation, and the part that a flange follows
shared: programs that several methods share, each as a private method
stretches: values that one branch has computed and the next one reads
"""
