"""Machines with deviations from their drawing: what they do, and how their deviations are found from measurements."""
