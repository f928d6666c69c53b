"""The compiler of robot kinematics: from a mechanism's equations to proven Python and Structured Text."""

import os

# SymPy remembers what it computed, as a rule the last thousand results: a derivation asks again for more than that.
os.environ.setdefault("SYMPY_CACHE_SIZE", "None")
