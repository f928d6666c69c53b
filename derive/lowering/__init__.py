"""Programs with fewer operations, the same for every language: read into a graph, changed, and written again.

It may import the folders from `ir` to `solver`.

coefficients: coefficients of one value added, and constants multiplied into sums
decided: a condition that a refusal has decided, not asked again
draft: a program as values in the graph of `ir`, with their names and places
factoring: common factors and divisors of a sum, applied once
hoisting: what depends on parameters alone, computed once by the setup
lower: all changes to the programs of a mechanism, in their order
opening: a sum that one other sum reads, opened where terms of both make a known pair
readers: who reads a value in a draft
scheduling: what one side of a choice alone needs, computed on that side
sharing: pairs of terms or factors that several values have in common, computed once
stretches: choices by one condition gathered, between two refusals
symmetry: values that another one gives by a change of sign or half a turn
unrolling: all branches in one straight line, by substitution of their signs
wording: what a value without a name is called
writing: a draft, written as a program
"""
