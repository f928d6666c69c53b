"""Functions for B&R mapp Motion, compiled with declarations of our own and run on recorded poses."""
