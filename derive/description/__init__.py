"""The vocabulary of a mechanism: joints, parameters, chains, rods, branches, the task; and the checks of a
description."""
