"""How it is solved: the driver, its record, eliminations, sums of parallel axes, feasible arcs, and the subproblems."""
