"""All branches in a straight line: the program of every branch, then turns and limits."""
