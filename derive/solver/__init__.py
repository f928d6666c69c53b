"""How the closure is solved: driver, derivation record, eliminations, parallel axes, feasible arcs, and the
subproblems."""
