"""All branches in a straight line: the program of every branch, then turns and limits.

Like `python`, it may import these folders of `emit`: `c`, `javascript`, `plcopen`, `picture`.

finish: the last steps of all branches: every axis on its turn, and inside its limits
unrolled: the functions on plain numbers, of all branches and of one
"""
