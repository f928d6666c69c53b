"""The command line.

It may import every other folder.

calibrate: `calibrate`: the deviations of a machine from measured samples, or poses to measure
catalogue: `generate` and `check` without a file: all mechanisms, one output folder
explain: `explain`: the derivation of a machine, step by step
like: `like`: the block for kinematics as a vendor calls them, and the meaning of the vendor's parameters
line: the commands and their options, and the status of a run
live: `live`: serve the page of a machine, and move it with the values of a controller
new: `new`: a commented description to start from
own: `derive` and `check` with files: machines of the user's own, each by itself
process: the process of a command, without garbage collection, which would find nothing
report: `report`: a page for every mechanism, and an index; and the page of one machine
stages: the lines that a run prints about one machine
view: `view`: machines in one page for the browser
"""

from __future__ import annotations

import os

# Processes share the mechanisms. The matrices are small: further threads of NumPy would only wait for work, which takes
# a tenth of the processor time. NumPy reads this variable when it is loaded, which is later.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
