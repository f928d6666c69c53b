"""From a robot file (URDF, MJCF, a table of Denavit-Hartenberg parameters) to a description to be read and edited."""
