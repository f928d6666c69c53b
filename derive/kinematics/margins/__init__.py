"""The singularity margins of a machine that is solved in closed form."""
