"""The singularity margins of a machine that is solved in closed form.

Like `kinematics`, it may import the folders from `ir` to `optimize`.

candidates: the candidates for margins: the determinants of steps and their conditioning, each over its scale
determinant: the margins that multiply, with integer exponents, to the determinant of the Jacobian
"""
