"""A program as data: symbols, statements and values, and how a program is checked, executed and rearranged.

It may import `kept` and `work`, and no folder.

constants: the numerical constants of the product, except those of the root search
graph: values as a graph, in which equal values are one node
interpret: the reference interpreter, which executes a program over arrays
one_row: a program as a function of Python's own numbers, for few rows
passes: passes over programs: aliases folded, statements in the order of their use, constants hoisted
primitives: the functions that every language implements, and their values on arrays
python_text: expressions as text in Python, of plain numbers or of arrays, and functions made of such text
program: programs, their statements and their statuses
reason: why a program refuses: what is at fault, what is wrong with it, and how much is missing
statement: what all kinds of statements have in common
symbols: every name that programs share, the signs of branches, and new names
text: programs as plain text
tree: a program as a structured tree, with choices of which only one side is run
types: the types of values, the operations on each, and the check of a whole program
verify: the verifier, which finds a broken program at once
"""
