"""The command line."""

from __future__ import annotations

import os

# Processes share the mechanisms. The matrices are small: further threads of NumPy would wait for work, and take a tenth
# of the processor time with it. NumPy reads this when it is loaded, which is after this.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
