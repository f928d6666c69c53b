"""All programs of one mechanism: forward and inverse, branches, Jacobian, margins, limits, couplings."""
