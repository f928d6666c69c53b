"""Machines on a base and with a tool: every mechanism of the catalogue, and couplings."""
