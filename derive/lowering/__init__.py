"""Programs with fewer operations: each is read into a graph, changed, and written again. `passes` lists all passes.

It may import the folders from `ir` to `optimize`.

cutting: a sum that takes many lines to write is a sum of shorter ones
draft: a program as values in the graph of `ir`, with their names and places; the readers of each value
factoring: a common factor, divisor or value of a sum is applied once; sums that open into others
hoisting: values that depend on parameters alone are computed once, by the setup
passes: the list of all passes, in their order; programs that are lowered together
scheduling: a value that only one side of a choice needs is computed on that side
sharing: a pair of terms or factors that several values have in common is computed once
stretches: choices with the same condition are gathered, between two refusals
symmetry: a value that follows from another by a change of sign or half a turn is not computed again
unrolling: all branches in one straight line, by substitution of their signs
wording: names for values without a name
writing: a draft, written as a program
"""
